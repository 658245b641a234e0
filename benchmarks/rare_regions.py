"""Does rare acceptance lose a region in silence? Twenty books with exact answers, many runs of each.

`python benchmarks/rare_regions.py` runs the books of rare_books.py by turns, and writes `results/rare-regions.json` as
it goes: stopped and started again, it goes on where it was. `--as before` keeps the runs of another version of xlmc
(the one that PYTHONPATH names) beside them, to compare the work and the intervals; `--table` fills the table of
docs/rare-acceptance.md. A run wants 10,000 accepted trials, everything else as it is by default.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from rare_books import ORDINARY, SEVERAL, RareBook
from tables import placed

from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.simulation.simulate import run_model

__all__ = ["Run", "faults", "lines", "table", "uncovered", "wrong"]

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results" / "rare-regions.json"
PAGE = HERE.parent / "docs" / "rare-acceptance.md"
BOOKS = {**SEVERAL, **ORDINARY}
WANTED = 10_000
SEEDS = 1_000
"""That a book has to itself: the same seed gives the same trials in books that differ in a scale only."""

WRONG = 3.0
"""Half-widths of an interval that it must not miss by."""

LEAST_COVERED, MOST_WARNED, MOST_WIDER, MOST_WORK = 0.92, 0.03, 1.5, 2.0


class Run(NamedTuple):
    """What one run says: the probability of acceptance, its interval, whether it warns, and the trials it computed."""

    value: float
    low: float
    high: float
    warned: bool
    evaluations: int

    def misses(self, truth: float) -> float:
        """By how many half-widths of its interval the truth lies outside of it."""
        half = 0.5 * (self.high - self.low)
        return max(self.low - truth, truth - self.high, 0.0) / half if half else float("inf")


def one(book: RareBook, seed: int) -> Run:
    """A run of that seed."""
    result = run_model(book.model, RunOptions.of(seed=seed, until_accepted=WANTED))
    low, high = result.acceptance.interval or (0.0, 0.0)
    return Run(result.acceptance.value, low, high, bool(result.warnings), result.evaluated)


class Judged(NamedTuple):
    """The runs of a book."""

    runs: int
    warned: int
    held: int
    wrong: int
    width: float
    work: float

    @property
    def silent(self) -> int:
        """Runs without a warning, which `held` and `wrong` are of."""
        return self.runs - self.warned


def judged(runs: Sequence[Run], truth: float) -> Judged:
    """Count them; the width and the work are medians, the width relative to the truth."""
    silent = [run for run in runs if not run.warned]
    misses = [run.misses(truth) for run in silent]
    width = statistics.median((run.high - run.low) / truth for run in runs)
    work = statistics.median(run.evaluations for run in runs)
    return Judged(
        len(runs), len(runs) - len(silent), misses.count(0.0), sum(m > WRONG for m in misses), width, float(work)
    )


def wrong(result: Mapping[str, Judged]) -> Iterator[str]:
    """The books with runs that are wrong without a warning."""
    for name, each in result.items():
        if each.wrong:
            yield f"{name}: {each.wrong} runs of {each.runs} are wrong without a warning"


def uncovered(result: Mapping[str, Judged]) -> Iterator[str]:
    """Whether too few intervals of the runs without a warning hold the truth."""
    silent = sum(each.silent for each in result.values())
    held = sum(each.held for each in result.values())
    if held < LEAST_COVERED * silent:
        yield f"of {silent} runs without a warning {held} hold the truth"


def faults(result: Mapping[str, Judged], before: Mapping[str, Judged]) -> Iterator[str]:
    """What misses the bar."""
    yield from wrong(result)
    for name, each in result.items():
        if name in ORDINARY and each.warned > MOST_WARNED * each.runs:
            yield f"{name}: {each.warned} runs of {each.runs} warn"
        if name in ORDINARY and name in before and each.width > MOST_WIDER * before[name].width:
            yield f"{name}: intervals are {each.width / before[name].width:.2f} times as wide"
        if name in ORDINARY and name in before and each.work > MOST_WORK * before[name].work:
            yield f"{name}: the work is {each.work / before[name].work:.2f} times as much"
    yield from uncovered(result)
    quiet = sum(result[name].warned * 2 < result[name].runs for name in SEVERAL if name in result)
    if quiet < 8:
        yield f"only {quiet} of the books with several regions end without a warning in most runs"


def lines(books: Mapping[str, RareBook], result: Mapping[str, Judged], last: str, cells: Mapping[str, str]) -> str:
    """As Markdown, a line a book; the last column has a heading and a cell for each book."""
    made = [
        f"| book | probability | runs | warned | interval holds | wrong, unwarned | evaluations | {last} |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name, each in result.items():
        held = f"{each.held / each.silent:.0%}" if each.silent else "–"
        made.append(
            f"| {books[name].words} | {books[name].truth:.2e} | {each.runs} | {each.warned} | {held} | {each.wrong} "
            f"| {each.work:,.0f} | {cells[name]} |"
        )
    return "\n".join(made)


def table(result: Mapping[str, Judged], before: Mapping[str, Judged]) -> str:
    """A line a book, beside the version of before where it was run."""

    def beside(name: str, each: Judged) -> str:
        old = before.get(name)
        return "–" if old is None else f"{each.width / old.width:.2f}, {each.work / old.work:.2f}"

    return lines(BOOKS, result, "width, work: ×", {name: beside(name, each) for name, each in result.items()})


Kept = dict[str, dict[str, list[list[Any]]]]
"""Version -> book -> runs by seed."""


def measured(kept: Kept, version: str, names: Sequence[str], runs: int, until: float, results: Path) -> None:
    """Run the books by turns until each has so many runs, or the time is over."""
    mine = kept.setdefault(version, {})
    for number in range(runs):
        for name in names:
            done = mine.setdefault(name, [])
            if len(done) > number or time.monotonic() > until:
                continue
            done.append(list(one(BOOKS[name], SEEDS * list(BOOKS).index(name) + number)))
            results.write_text(json.dumps(kept, indent=None).replace("]], ", "]],\n") + "\n", encoding="utf-8")


def read(results: Path) -> Kept:
    """What there is so far."""
    result: Kept = json.loads(results.read_text(encoding="utf-8")) if results.exists() else {}
    return result


def main() -> None:
    """Measure, write, and end with 1 where the bar is missed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--runs", type=int, default=200, help="of each book")
    parser.add_argument("--only", choices=BOOKS, action="append", help="of the books; may be given again")
    parser.add_argument("--ordinary", action="store_true", help="those of one region only")
    parser.add_argument("--as", dest="version", default="now", help="the version that runs: `before` to compare with")
    parser.add_argument("--minutes", type=float, default=1e9, help="at most")
    parser.add_argument("--results", type=Path, default=RESULTS)
    parser.add_argument("--table", action="store_true", help="only fill the table of the page")
    given = parser.parse_args()
    kept = read(given.results)
    names = given.only or list(ORDINARY if given.ordinary else BOOKS)
    if not given.table:
        measured(kept, given.version, names, given.runs, time.monotonic() + 60.0 * given.minutes, given.results)
    versions = [
        {
            name: judged([Run(*run) for run in kept[version][name]], BOOKS[name].truth)
            for name in BOOKS
            if kept[version].get(name)
        }
        if version in kept
        else {}
        for version in ("now", "before")
    ]
    text = table(*versions)
    print(text)
    if given.table:
        PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), "rare-regions", text), encoding="utf-8")
    missed = list(faults(*versions))
    fewest = min((each.runs for each in versions[0].values()), default=0)
    print("\n".join(missed) or f"nothing misses the bar so far, with {fewest} runs of each book or more")
    raise SystemExit(1 if missed else 0)


if __name__ == "__main__":
    main()
