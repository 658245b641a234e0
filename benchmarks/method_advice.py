"""Does `xlmc methods` give one advice a workbook, whatever the seed?

`python benchmarks/method_advice.py` measures every shipped workbook with 20 seeds, and writes
`results/method-advice.json` as it goes: stopped, it goes on where it was. Its runs are shorter and fewer than those of
`--quick`, and know less: what does not change with them does not change with more. `--table` only fills in the table of
docs/methods.md. `--truth` compares what is stated of the eight books of `known_books.py` with what is true of them. The
seconds in it depend on the machine; the advice must not.

The bar: for every workbook one recommended method, and one method at least that is among the cheapest with every seed.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from known_books import KNOWN, KnownBook
from tables import placed

import xlmc
from xlmc.analysis.studies.methods import quick_settings, study
from xlmc.analysis.studies.methods.need import choice
from xlmc.analysis.studies.methods.quantile_need import quantile_need
from xlmc.api import Model

__all__ = ["BOOKS", "PAGE", "RESULTS", "SEEDS", "advice", "faults", "table"]

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PAGE = ROOT / "docs" / "methods.md"
RESULTS = HERE / "results" / "method-advice.json"
SEEDS = 20
REFERENCE, TRIALS, REPLICATES = 1 << 17, 1 << 14, 3
BOOKS = tuple(
    sorted(str(path.relative_to(ROOT)) for part in ("examples", "templates") for path in (ROOT / part).glob("*.xlsx"))
)

NOTHING = "nothing is drawn"
"""A workbook that draws nothing has nothing to advise on: the command refuses it."""

Record = dict[str, Any]


def advice(book: str, seed: int) -> Record:
    """What the quick test says of one workbook with one seed."""
    model = xlmc.load(ROOT / book)
    if not model.live:
        return {
            "recommended": NOTHING,
            "trials": 0,
            "cheapest": [NOTHING],
            "seconds": {},
            "never": [],
            "cannot tell": [],
        }
    found = study(model, seed=seed, reference_trials=REFERENCE, trials=TRIALS, replicates=REPLICATES)
    best = choice(found)
    needs = {curve.method.key: each for curve, each in best.needs.items()}
    return {
        "recommended": best.chosen and best.chosen.method.key,
        "trials": best.chosen and round(best.needs[best.chosen].trials),
        "cheapest": [curve.method.key for curve in best.cheapest],
        "seconds": {key: float(f"{each.seconds:.3g}") for key, each in needs.items() if each.usable},
        "never": sorted(key for key, each in needs.items() if each.reaches == "no"),
        "cannot tell": sorted(key for key, each in needs.items() if each.reaches == "unknown"),
    }


def measure(books: Iterable[str], seeds: int) -> None:
    """All books with one seed, then with the next."""
    records = _known()
    books = tuple(books)
    for seed in range(1, seeds + 1):
        for book in books:
            if str(seed) not in records.setdefault(book, {}):
                records[book][str(seed)] = advice(book, seed)
                _write(records)
                print(f"{book}, seed {seed}: {records[book][str(seed)]['recommended']}", file=sys.stderr, flush=True)


def _known() -> dict[str, dict[str, Record]]:
    found: dict[str, dict[str, Record]] = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    return found


def _write(records: dict[str, dict[str, Record]]) -> None:
    """Whole or not at all, so that a run that is stopped loses nothing."""
    half = RESULTS.with_suffix(".part")
    half.write_text(json.dumps(records, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    os.replace(half, RESULTS)


def faults(records: dict[str, dict[str, Record]]) -> list[str]:
    """Where the advice changes with the seed, or denies that a method converges which does."""
    found = []
    for book, seeds in records.items():
        said = {each["recommended"] for each in seeds.values()}
        if len(said) != 1 or None in said:
            found.append(f"{book}: recommends {sorted(map(str, said))}")
        if not _always_cheapest(seeds):
            found.append(f"{book}: no method is among the cheapest with every seed")
        denied = {key for each in seeds.values() for key in each["never"]} & {"mc", "lhs", "sobol", "grid"}
        if denied:
            found.append(f"{book}: says that {sorted(denied)} never come to it")
    return found


def _always_cheapest(seeds: dict[str, Record]) -> set[str]:
    return set.intersection(*(set(each["cheapest"]) for each in seeds.values()))


def table(records: dict[str, dict[str, Record]]) -> str:
    """One row a workbook."""
    rows = [
        "| Workbook | Seeds | Recommended | Trials | Always among the cheapest |",
        "| --- | ---: | --- | ---: | --- |",
    ]
    for book, seeds in sorted(records.items()):
        said = Counter(each["recommended"] for each in seeds.values())
        trials = sorted(each["trials"] for each in seeds.values())
        always = ", ".join(sorted(_always_cheapest(seeds))) or "–"
        names = ", ".join(f"{name} ({count})" if len(said) > 1 else str(name) for name, count in said.most_common())
        rows.append(f"| `{book}` | {len(seeds)} | {names} | {trials[0]:,} to {trials[-1]:,} | {always} |")
    return "\n".join(rows)


NORMAL_95, SHARES = 1.959964, (np.arange(1 << 22) + 0.5) / (1 << 22)


def truth_of(book: KnownBook, share: float = 0.51) -> tuple[tuple[float, ...], float, float]:
    """Mean, SD and both ends of a known forecast, the tolerance of 1 %, and the accepted trials that Monte Carlo
    needs.
    """
    y = book.quantile(SHARES)
    mean, deviation = float(y.mean()), float(y.std())
    low, high, five, ninety_five = (float(q) for q in np.quantile(y, [(1 - share) / 2, (1 + share) / 2, 0.05, 0.95]))
    tolerance = 0.01 * (ninety_five - five)
    kurtosis = float(np.mean((y - mean) ** 4)) / deviation**4
    needs = [(NORMAL_95 * deviation * each / tolerance) ** 2 for each in (1.0, (kurtosis - 1.0) ** 0.5 / 2.0)]
    for p in ((1 - share) / 2, (1 + share) / 2):
        found = quantile_need(y, p, tolerance, y.size, gain=1e-6)
        assert found is not None
        needs.append(found.trials)
    return (mean, deviation, low, high), tolerance, max(needs)


def kept_share(model: Model, method: Any, trials: int, truth: tuple[tuple[float, ...], float, float]) -> float:
    """The share of 200 runs with all four numbers within the tolerance."""
    numbers, tolerance, _ = truth
    kept = 0.0
    for seed in range(RUNS):
        answer = method.run(model, trials, 10_000 + seed).answers["y"]
        off = np.abs(np.subtract((answer.mean, answer.sd, answer.low, answer.high), numbers))
        kept += bool((off <= tolerance).all())
    return kept / RUNS


RUNS, MOST_RUN = 200, 1_000_000


def compare_with_truth(folder: Path) -> list[str]:
    """A line a book: Monte Carlo's stated need over the true one, and what twice and half the stated needs keep."""
    lines = []
    for book in KNOWN:
        model, truth = xlmc.load(book.write(folder)), truth_of(book)
        found = study(model, seed=1, **quick_settings({}))
        best = choice(found)
        share = found.reference.acceptance.value
        stated = next(each.trials for curve, each in best.needs.items() if curve.method.key == "mc")
        line = f"{book.name}: {best.chosen and best.chosen.method.key}; mc stated/true {stated * share / truth[2]:.2f}"
        for curve in found.curves:
            need = best.needs[curve]
            if curve.method.key in ("lhs", "sobol") and need.usable and 2 * need.trials <= MOST_RUN:
                twice, half = (kept_share(model, curve.method, round(k * need.trials), truth) for k in (2.0, 0.5))
                line += f"; {curve.method.key} {need.trials:,.0f}: twice keeps {twice:.3f}, half {half:.3f}"
        lines.append(line)
        print(line, flush=True)
    return lines


def main(given: Sequence[str] | None = None) -> None:
    """Measure, write the table, and say whether the bar is met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--table", action="store_true", help="measure nothing")
    parser.add_argument("--truth", action="store_true", help="only compare the known books with their truth")
    asked = parser.parse_args(given)
    if asked.truth:
        with TemporaryDirectory() as folder:
            compare_with_truth(Path(folder))
        return
    if not asked.table:
        measure(BOOKS, asked.seeds)
    records = _known()
    PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), "advice", table(records)), encoding="utf-8")
    found = faults(records)
    print("\n".join(found) or f"{len(records)} workbooks, one advice each")
    raise SystemExit(1 if found else 0)


if __name__ == "__main__":
    main()
