"""Does `xlmc methods` give one advice a workbook, whatever the seed?

`python benchmarks/method_advice.py` measures every shipped workbook with 20 seeds, and writes
`results/method-advice.json` as it goes: stopped, it goes on where it was. Its runs are shorter and fewer than those of
`--quick`, and know less: what does not change with them does not change with more. `--table` only fills in the table of
docs/methods.md. `--truth` compares what is said of the eight books of `known_books.py` with what is true of them
(`method_truth.py`). The seconds in it depend on the machine; the advice must not.

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
from typing import Any, NoReturn

from known_books import KNOWN
from method_truth import compare_with_truth
from tables import placed

from xlmc.analysis.studies.methods import study
from xlmc.analysis.studies.methods.need import ENGINE_READY, choice, chosen_of
from xlmc.montecarlo.model.loading import load

__all__ = ["BOOKS", "PAGE", "RESULTS", "SEEDS", "advice", "faults", "other_today", "table"]

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
    model = load(ROOT / book)
    if not model.live:
        return {
            "recommended": NOTHING,
            "trials": 0,
            "cheapest": [NOTHING],
            "seconds": {},
            "never": [],
            "cannot tell": [],
        }
    result = study(model, seed=seed, reference_trials=REFERENCE, trials=TRIALS, replicates=REPLICATES)
    best = choice(result)
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
    result: dict[str, dict[str, Record]] = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
    return result


def _write(records: dict[str, dict[str, Record]]) -> None:
    """Whole or not at all, so that a run that is stopped loses nothing."""
    half = RESULTS.with_suffix(".part")
    half.write_text(json.dumps(records, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    os.replace(half, RESULTS)


def faults(records: dict[str, dict[str, Record]]) -> list[str]:
    """Where the advice changes with the seed, or denies that a method converges which does."""
    result = []
    for book, seeds in records.items():
        message = {each["recommended"] for each in seeds.values()}
        if len(message) != 1 or None in message:
            result.append(f"{book}: recommends {sorted(map(str, message))}")
        if not _always_cheapest(seeds):
            result.append(f"{book}: no method is among the cheapest with every seed")
        denied = {key for each in seeds.values() for key in each["never"]} & {"mc", "lhs", "sobol", "grid"}
        if denied:
            result.append(f"{book}: says that {sorted(denied)} never come to it")
    return result


def _always_cheapest(seeds: dict[str, Record]) -> set[str]:
    return set.intersection(*(set(each["cheapest"]) for each in seeds.values()))


def other_today(records: dict[str, dict[str, Record]]) -> list[str]:
    """Where the rule of `need.choice` would now recommend something else for the recorded seconds."""
    result = []
    for book, seeds in records.items():
        for seed, each in seeds.items():
            costs = {key: s + ENGINE_READY * (key.startswith("mc/")) for key, s in each["seconds"].items()}
            if costs and (now := chosen_of(costs, "mc" if "mc" in costs else min(costs))) != each["recommended"]:
                result.append(f"{book}, seed {seed}: {now} instead of {each['recommended']}")
    return result


def table(records: dict[str, dict[str, Record]]) -> str:
    """One row a workbook."""
    rows = [
        "| Workbook | Seeds | Recommended | Trials | Always among the cheapest |",
        "| --- | ---: | --- | ---: | --- |",
    ]
    for book, seeds in sorted(records.items()):
        message = Counter(each["recommended"] for each in seeds.values())
        trials = sorted(each["trials"] for each in seeds.values())
        always = ", ".join(sorted(_always_cheapest(seeds))) or "–"
        names = ", ".join(
            f"{name} ({count})" if len(message) > 1 else str(name) for name, count in message.most_common()
        )
        rows.append(f"| `{book}` | {len(seeds)} | {names} | {trials[0]:,} to {trials[-1]:,} | {always} |")
    return "\n".join(rows)


def main(given: Sequence[str] | None = None) -> None:
    """Measure, write the table, and say whether the bar is met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--table", action="store_true", help="measure nothing")
    parser.add_argument("--truth", action="store_true", help="only compare the known books with their truth")
    asked = parser.parse_args(given)
    if asked.truth:
        with TemporaryDirectory() as folder:
            _end(compare_with_truth(Path(folder)), f"both bars are met, {len(KNOWN)} books")
    if not asked.table:
        measure(BOOKS, asked.seeds)
    records = _known()
    PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), "advice", table(records)), encoding="utf-8")
    print("\n".join(other_today(records)) or "the present rule recommends the same")
    _end(faults(records), f"{len(records)} workbooks, one advice each")


def _end(result: Sequence[str], otherwise: str) -> NoReturn:
    print("\n".join(result) or otherwise)
    raise SystemExit(1 if result else 0)


if __name__ == "__main__":
    main()
