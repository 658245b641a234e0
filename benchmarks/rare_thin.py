"""Are thin bent layers found, and are their intervals honest? Small books with exact answers, many runs of each.

`python benchmarks/rare_thin.py` runs the books THIN of rare_books.py by turns, 30 runs of each, and writes
`results/rare-thin.json` as it goes: stopped and started again, it goes on where it was. `--table` fills the table of
docs/rare-acceptance.md. A run wants 10,000 accepted trials, everything else as it is by default.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rare_books import THIN
from rare_regions import SEEDS, Judged, Run, judged, lines, one, uncovered, wrong
from tables import placed

__all__ = ["faults", "table"]

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results" / "rare-thin.json"
PAGE = HERE.parent / "docs" / "rare-acceptance.md"

FIRST_SEED = 100_000
"""Of the runs: none that the twenty other books have."""

SLOWEST = 60.0
"""Seconds of processor time, on an idle core."""

Kept = dict[str, list[list[Any]]]
"""Book -> runs by seed: what `Run` holds, and the seconds of processor time."""


def faults(result: Mapping[str, Judged], seconds: Mapping[str, float]) -> Iterator[str]:
    """What misses the bar."""
    yield from wrong(result)
    for name in result:
        if seconds[name] > SLOWEST:
            yield f"{name}: a run takes {seconds[name]:.0f} s of processor time"
    yield from uncovered(result)


def table(result: Mapping[str, Judged], seconds: Mapping[str, float]) -> str:
    """As Markdown, a line a book, with the processor time of its slowest run."""
    return lines(THIN, result, "slowest, s", {name: f"{seconds[name]:.0f}" for name in result})


def measured(kept: Kept, names: Sequence[str], runs: int, until: float, results: Path) -> None:
    """Run the books by turns until each has so many runs, or the time is over."""
    for number in range(runs):
        for name in names:
            done = kept.setdefault(name, [])
            if len(done) > number or time.monotonic() > until:
                continue
            start = time.process_time()
            run = one(THIN[name], FIRST_SEED + SEEDS * list(THIN).index(name) + number)
            done.append([*run, round(time.process_time() - start, 1)])
            results.write_text(json.dumps(kept).replace("]], ", "]],\n") + "\n", encoding="utf-8")


def main() -> None:
    """Measure, write, and end with 1 where the bar is missed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=30, help="of each book")
    parser.add_argument("--only", choices=THIN, action="append", help="of the books; may be given again")
    parser.add_argument("--minutes", type=float, default=1e9, help="at most")
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--table", action="store_true", help="only fill the table of the page")
    given = parser.parse_args()
    kept: Kept = json.loads(given.results.read_text(encoding="utf-8")) if given.results.exists() else {}
    if not given.table:
        measured(kept, given.only or list(THIN), given.runs, time.monotonic() + 60.0 * given.minutes, given.results)
    runs = {name: kept[name] for name in THIN if kept.get(name)}
    result = {name: judged([Run(*run[:-1]) for run in each], THIN[name].truth) for name, each in runs.items()}
    seconds = {name: max(float(run[-1]) for run in each) for name, each in runs.items()}
    text = table(result, seconds)
    print(text)
    print(f"seconds, medians: { {name: statistics.median(run[-1] for run in each) for name, each in runs.items()} }")
    if given.table:
        PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), "rare-thin", text), encoding="utf-8")
    missed = list(faults(result, seconds))
    print("\n".join(missed) or "nothing misses the bar so far")
    raise SystemExit(1 if missed else 0)


if __name__ == "__main__":
    main()
