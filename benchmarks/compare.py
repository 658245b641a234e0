"""Everything that docs/speed.md says, measured: `python benchmarks/compare.py --install`.

Six parts, each optional: `rates` (trials per second of all contestants on the books), `scaling` (one thread against
two), `accuracy` (error against seconds), `whole-command`, `memory`, `growth` (cost over the size of book and run).
Every contestant runs in a fresh process, one after another, round by round; figures are medians, ratios are of the same
round. A whole run writes `results/*.json`, draws `results/*.png` and makes the tables of docs/speed.md anew. `--quick`,
or a choice of books or contestants, writes into a folder of its own instead and leaves the committed results alone.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import accuracy
import figures
import growth
import hand_c
import machine
import memory
import peers
import rates
import scaling
import tables
import whole_command
from books import BOOKS, CASE_STUDY, make_books
from line_up import Entry, line_up

RESULTS = HERE / "results"
QUICK_BOOKS = ("case-study", "skid")


@dataclass(frozen=True)
class Plan:
    """How thoroughly to measure.

    Attributes:
        rounds, seconds, limit: see `rates.measure`.
        turns: see `scaling.measure`.
        ladder, seeds: see `accuracy.measure`.
        trials: of the runs for `memory`.
        variants: whether to look for the best chunk of those written by hand.
    """

    rounds: int = 3
    seconds: float = 1.0
    limit: float = 300.0
    ladder: Sequence[int] = accuracy.LADDER
    seeds: int = accuracy.SEEDS
    trials: Sequence[int] = memory.TRIALS
    whole_rounds: int = whole_command.ROUNDS
    variants: bool = True
    turns: int = scaling.TURNS


QUICK = Plan(1, 0.05, 30.0, (2_000, 8_000), 3, (100_000, 400_000), 1, False, 1)
"""Enough to see that everything runs; its figures mean nothing."""


def main(arguments: Sequence[str] | None = None) -> Path:
    """Measure, print, write; the folder of the results."""
    chosen = _parser().parse_args(arguments)
    books = chosen.books or (QUICK_BOOKS if chosen.quick else list(BOOKS))
    plan = QUICK if chosen.quick else Plan(rounds=chosen.rounds, seconds=chosen.seconds, limit=chosen.limit)
    partial = chosen.quick or bool(chosen.contestants) or len(books) < len(BOOKS)
    output = chosen.output or (Path(tempfile.mkdtemp(prefix="xlmc-compare-")) if partial else RESULTS)
    output.mkdir(parents=True, exist_ok=True)
    if not chosen.redraw:
        if chosen.install:
            peers.install(chosen.peers)
        _measure(chosen, books, plan, output)
    draw(output)
    if output == RESULTS:
        tables.write(RESULTS)
        _say(f"the tables of {tables.PAGE} are new")
    _say(f"results are in {output}")
    return output


def draw(results: Path) -> None:
    """Draw the figures of the results there are, if matplotlib is installed."""
    if importlib.util.find_spec("matplotlib") is None:
        _say("no figures are drawn: matplotlib is not installed (pip install 'xlmc[plots]')")
        return
    for part, drawn, name in (
        ("accuracy", figures.draw_accuracy, "speed-against-accuracy.png"),
        ("rates", figures.draw_rates, "rates.png"),
        ("growth", figures.draw_growth, "growth.png"),
    ):
        if (results / f"{part}.json").exists():
            drawn(results / f"{part}.json", results / name)


def _measure(chosen: argparse.Namespace, books: Sequence[str], plan: Plan, output: Path) -> None:
    start = perf_counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        library = _library(folder)
        entries, absent = line_up(library, _engines(), chosen.peers)
        for reason in absent:
            _say(f"missing: {reason}")
        if chosen.contestants:
            entries = [entry for entry in entries if entry.name in chosen.contestants]
        if not plan.variants:
            entries = [_with_one_variant(entry) for entry in entries]
        paths = make_books(folder, [book for book in BOOKS if book in books])
        described = machine.describe(hand_c.compiler())
        for part in chosen.parts:
            result = _PARTS[part](_Measured(entries, paths, plan, output, folder, chosen.series, chosen.most))
            _write(output / f"{part}.json", described, result)
            _say(f"--- {part}, {perf_counter() - start:.0f} s so far\n{tables.TABLES[part](result)}")


@dataclass(frozen=True)
class _Measured:
    """What every part is given; `output` holds the results of the parts before it, `folder` is for books."""

    entries: list[Entry]
    paths: dict[str, Path]
    plan: Plan
    output: Path
    folder: Path
    series: Sequence[str]
    most: int | None


def _rates(given: _Measured) -> dict[str, Any]:
    plan = given.plan
    return rates.measure(given.entries, given.paths, plan.rounds, plan.seconds, plan.limit, _say)


def _scaling(given: _Measured) -> dict[str, Any]:
    plan = given.plan
    return scaling.measure(given.entries, CASE_STUDY, plan.rounds, plan.turns, 2 * plan.seconds, plan.limit, _say)


def _accuracy(given: _Measured) -> dict[str, Any]:
    path = given.output / "rates.json"
    if not path.exists():
        sys.exit(f"the part `accuracy` needs the rates: {path} does not exist; run the part `rates` first")
    known = json.loads(path.read_text(encoding="utf-8"))["found"]["case-study"]
    plan = given.plan
    return accuracy.measure(given.entries, CASE_STUDY, known, plan.ladder, plan.seeds, plan.limit, _say)


def _growth(given: _Measured) -> dict[str, Any]:
    path = given.output / "growth.json"
    known = json.loads(path.read_text(encoding="utf-8"))["found"] if path.exists() else {}
    plan = given.plan
    return growth.measure(given.series, known, given.folder, plan.seconds / 2, plan.limit, _say, given.most)


_PARTS: dict[str, Callable[[_Measured], dict[str, Any]]] = {
    "rates": _rates,
    "scaling": _scaling,
    "accuracy": _accuracy,
    "whole-command": lambda given: whole_command.measure(given.plan.whole_rounds),
    "memory": lambda given: memory.measure(given.plan.trials),
    "growth": _growth,
}


def _engines() -> list[str]:
    from xlmc.engine.engines import ENGINES

    return list(ENGINES)


def _library(folder: Path) -> Path | None:
    return hand_c.build(folder) if hand_c.compiler() else None


def _with_one_variant(entry: Entry) -> Entry:
    return Entry(**{**vars(entry), "variants": {book: given[:1] for book, given in entry.variants.items()}})


def _write(path: Path, described: dict[str, Any], result: dict[str, Any]) -> None:
    path.write_text(
        json.dumps({"machine": described, "found": result}, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
    )


def _say(text: str) -> None:
    print(text, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--install", action="store_true", help="install missing peers into the benchmark's environment")
    parser.add_argument("--peers", type=Path, default=peers.HOME, metavar="FOLDER", help="that environment")
    parser.add_argument("--quick", action="store_true", help="see that everything runs; the figures mean nothing")
    parser.add_argument("--parts", nargs="+", choices=list(_PARTS), default=list(_PARTS))
    parser.add_argument("--books", nargs="+", choices=list(BOOKS))
    parser.add_argument("--contestants", nargs="+", metavar="NAME", help="names as in the tables, such as xlmc/numpy")
    parser.add_argument("--series", nargs="+", choices=growth.SERIES, default=list(growth.SERIES), help="of the growth")
    parser.add_argument("--most", type=int, metavar="N", help="leave out larger sizes of the growth")
    parser.add_argument("--rounds", type=int, default=Plan.rounds)
    parser.add_argument("--seconds", type=float, default=Plan.seconds, help="for one measurement, about")
    parser.add_argument("--limit", type=float, default=Plan.limit, help="seconds that one process may take")
    parser.add_argument("--output", type=Path, help="folder for the results")
    parser.add_argument("--redraw", action="store_true", help="measure nothing: figures and tables from the results")
    return parser


if __name__ == "__main__":
    main()
