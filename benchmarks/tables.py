"""The tables of docs/speed.md, made from the results and put between its markers."""

from __future__ import annotations

import json
import re
import statistics
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from accuracy import STATISTICS
from figures import TITLES
from growth import COLUMNS, TRIALS, seconds_of, slope
from machine import sentence
from scaling import ANEW, APART

__all__ = ["PAGE", "TABLES", "filled", "placed", "write"]

PAGE = Path(__file__).resolve().parents[1] / "docs" / "speed.md"


QUIET = 0.2
"""More cores at work than this, just before the start, mean that other work was running."""

PROVISIONAL = (
    "**These figures are provisional**: other work was running on the machine, which slows now one contestant, now "
    "another, by a factor of up to three. Read the ratios, and those with a grain of salt."
)


def write(results: Path, page: Path = PAGE) -> None:
    """Put the tables of all results there are into the page."""
    page.write_text(filled(page.read_text(encoding="utf-8"), results), encoding="utf-8")


def filled(text: str, results: Path) -> str:
    """The page with its tables made anew: each stands between `<!-- name -->` and `<!-- /name -->`.

    Raises:
        ValueError: a table's markers are missing.
    """
    paths = {name: results / f"{name}.json" for name in TABLES}
    result = {name: json.loads(path.read_text(encoding="utf-8")) for name, path in paths.items() if path.exists()}
    if not result:
        return text
    machine = next(iter(result.values()))["machine"]
    text = placed(text, "machine", _machine(machine))
    for name, given in result.items():
        table = TABLES[name](given["found"])
        text = placed(text, name, table if given["machine"] == machine else f"{table}\n\n{_machine(given['machine'])}")
    return text


def placed(text: str, name: str, body: str) -> str:
    marked = re.compile(rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)", re.DOTALL)
    if not marked.search(text):
        raise ValueError(f"the page has no markers for the table {name!r}")
    return marked.sub(lambda match: f"{match[1]}\n{body}\n\n{match[2]}", text)


def _machine(machine: dict[str, Any]) -> str:
    """The machine in words, with a warning where other work was running on it."""
    busy = machine["busy before"] is not None and machine["busy before"] > QUIET
    return f"{PROVISIONAL}\n\n{sentence(machine)}" if busy else sentence(machine)


def _rates(result: dict[str, Any]) -> str:
    return "\n\n".join(f"**{TITLES[book]}** (`{book}`)\n\n{_of_book(records)}" for book, records in result.items())


_OTHERS = ("xlmc/numpy", "xlmc/jit", "hand/NumPy", "hand/C")
"""Those to whose rates the others' are compared; tables of results from before 0.6 have the first and third alone."""


def _of_book(records: dict[str, Any]) -> str:
    hand = any("to hand/NumPy" in record for record in records.values())
    cost = any("ns a cell" in record for record in records.values())
    others = [other for other in _OTHERS if other in ("xlmc/numpy", *(["hand/NumPy"] if hand else [])) or cost]
    others = [other for other in others if any(f"to {other}" in record for record in records.values())]
    headings = ["contestant", "trials/s", *(["ns a cell"] if cost else []), *(f"× {other}" for other in others)]
    headings += ["ready, s", "rounds", "same forecasts"]
    rows = []
    for name, record in sorted(records.items(), key=lambda item: -item[1].get("rate", 0)):
        if record["absent"]:
            rows.append([name, record["absent"], *[""] * (len(headings) - 2)])
            continue
        ratios = [_number(record["ns a cell"])] if cost else []
        ratios += [_ratio(record.get(f"to {other}")) for other in others]
        ready, rounds = f"{record['ready_median']:.2f}", str(len(record["rates"]))
        rows.append([name, _number(record["rate"]), *ratios, ready, rounds, _same(record)])
    return f"{_table(headings, rows, 'lr' + 'r' * (len(headings) - 3) + 'l')}\n\n{_notes(records)}"


def _notes(records: dict[str, Any]) -> str:
    """How those were used that can be used in several ways, and the peers' versions."""
    shown = [(name, record) for name, record in records.items() if not record["absent"]]
    ways = [
        f"{name}: {record['note']}" for name, record in shown if record["family"] == "hand" or name == "formualizer"
    ]
    peers = [record["versions"] for _, record in shown if record["family"] == "peer"]
    versions = [f"{package} {number}" for result in peers for package, number in result.items()]
    return f"{'; '.join([*ways, *versions])}."


def _same(record: dict[str, Any]) -> str:
    trials = f"{record['checked']} trial{'s' * (record['checked'] > 1)}"
    return f"yes, {trials}" if not record["differs"] else f"**no**: {record['differs'][0]}"


def _scaling(result: dict[str, Any]) -> str:
    words = {ANEW: "`-j 2`, a process started in every run", APART: "two programs at once, one job each", "2": "`-j 2`"}
    rows = []
    for name, rates in result.items():
        rows.append([name, "`-j 1`", _number(statistics.median(rates["1"])), "1"])
        for way, ratio in rates["ratios"].items():
            rows.append([name, words[way], _number(statistics.median(rates[way])), f"{ratio:.2f}"])
    return _table(["engine", "how", "trials/s", "ratio"], rows, "llrr")


def _accuracy(result: dict[str, Any]) -> str:
    headings = ["contestant", "trials", "seconds", *(f"error of {name}, mph" for name in STATISTICS)]
    rows = []
    for name, curve in result.items():
        if not curve["by rate"]:
            for trials, seconds, error in zip(curve["trials"], curve["seconds"], curve["errors"], strict=True):
                rows.append([name, f"{trials:,}", f"{seconds:.3g}", *(f"{value:.4f}" for value in error)])
    return _table(headings, rows, "lrr" + "r" * len(STATISTICS))


def _memory(result: dict[str, Any]) -> str:
    rows = [
        [
            f"{run['trials']:,}",
            f"{run['seconds']:.1f}",
            f"{1e9 * run['seconds'] / run['trials']:.0f}",
            f"{run['peak'] / 1e6:.0f}",
            f"{run['before'] / 1e6:.0f}",
        ]
        for run in result["runs"]
    ]
    headings = ["trials", "seconds", "ns a trial", "peak memory, MB", "before the run, MB"]
    close = f"Longest over shortest run: cost of a trial {result['cost']:.3f}, peak memory {result['memory']:.2f}."
    return f"{_table(headings, rows, 'rrrrr')}\n\n{close}"


def _growth(result: dict[str, Any]) -> str:
    return "\n\n".join(_growth_of(name, engines) for name, engines in result.items())


def _growth_of(series: str, engines: dict[str, Any]) -> str:
    """Seconds by size, and below them the slopes at the upper end."""
    columns = ("run",) if series == "trials" else COLUMNS
    shown = [(engine, column) for column in columns for engine in (engines if column != "loading" else ["numpy"])]
    sizes = sorted({point["size"] for points in engines.values() for point in points})
    result = {(engine, column): seconds_of(engines[engine], column) for engine, column in shown}
    rows = [[f"{size:,}", *(_seconds_at(*result[each], size) for each in shown)] for size in sizes]
    slopes = [slope(*result[each]) if result[each][0] else None for each in shown]
    rows.append(["*slope*", *("–" if value is None else f"*{value:.2f}*" for value in slopes)])
    headings = [series, *(_GROWTH_WORDS[column].format(engine) for engine, column in shown)]
    absent = [
        f"{engine}, {point['size']:,}: {point['absent']}."
        for engine, points in engines.items()
        for point in points
        if "absent" in point
    ]
    return "\n\n".join([_table(headings, rows, "r" * len(headings)), *absent])


def _seconds_at(sizes: Sequence[int], seconds: Sequence[float], size: int) -> str:
    return f"{seconds[sizes.index(size)]:.3g}" if size in sizes else "–"


_GROWTH_WORDS = {
    "loading": "loading, s",
    "program": "program, {}, s",
    "first": "first block, {}, s",
    "a trial": f"{TRIALS:,} trials, {{}}, s",
    "run": "{}, s",
}


def _whole_command(result: dict[str, Any]) -> str:
    labels = {
        "xlmc": f"`xlmc simulate`, {result['trials']:,} trials, workbook written",
        "baseline": "the three imports, and the same sheets written from recorded calls",
        "imports": "of it the three imports alone",
    }
    rows = [[label, f"{statistics.median(result[name]):.3f}"] for name, label in labels.items()]
    close = f"Ratio of the first to the second, median of {len(result['xlmc'])} rounds: **{result['ratio']:.2f}**."
    return f"{_table(['process', 'seconds'], rows, 'lr')}\n\n{close}"


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]], aligned: str) -> str:
    rules = ["---:" if side == "r" else "---" for side in aligned]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (headings, rules, *rows))


def _number(value: float) -> str:
    """Three digits."""
    rounded = float(f"{value:.3g}")
    return f"{rounded:,.0f}" if rounded >= 100 else f"{rounded:g}"


def _ratio(value: float | None) -> str:
    if value is None:
        return "–"
    return f"{value:.2f}" if value >= 0.095 else f"1/{_number(1 / value)}"


TABLES: dict[str, Callable[[dict[str, Any]], str]] = {
    "rates": _rates,
    "scaling": _scaling,
    "accuracy": _accuracy,
    "memory": _memory,
    "whole-command": _whole_command,
    "growth": _growth,
}
"""Name of a part, of its results and of its place in the page -> what makes its table."""
