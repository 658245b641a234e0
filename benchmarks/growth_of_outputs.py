"""How the cost of all that is asked of a run grows: `python benchmarks/growth_of_outputs.py --output FOLDER`.

One thing at a time grows from a middle point: assumptions, forecasts, formula cells, trials, and how rare an accepted
trial is. Each point is a book of its own in a process of its own, which loads, checks and runs it and then asks for
statistics, sensitivities, the result sheets, the page, the report and the saved run, opens that, and replays it. What
counts is processor time, so that the measurement may share a machine, and the largest memory of each step. Other work
still makes caches colder and figures larger.

`--docs` puts the table into docs/speed.md. `--point assumptions=3000,forecasts=500,trials=1000000` measures one book,
and prints what all default outputs cost as a multiple of the run.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
import tempfile
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import machine
from growth import slope
from processes import answer_of

__all__ = ["AXES", "MIDDLE", "STEPS", "main", "measure", "measure_point", "point_of", "summary", "table", "write_book"]

MIDDLE: Final = {"assumptions": 30, "forecasts": 10, "cells": 300, "trials": 10_000, "rejected": 1}
"""The point from which each axis starts; `rejected`: of so many trials one is accepted."""

AXES: Final = {
    "assumptions": (10, 30, 100, 300, 1_000, 3_000),
    "forecasts": (1, 3, 10, 30, 100, 300),
    "cells": (100, 300, 1_000, 3_000, 10_000, 30_000, 100_000),
    "trials": (1_000, 10_000, 100_000, 1_000_000, 10_000_000),
    "rejected": (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000),
}
STEPS: Final = (
    "load",
    "check",
    "run",
    "statistics",
    "sensitivity",
    "sheets",
    "page",
    "report",
    "save",
    "open",
    "replay",
)

DEFAULT_OUTPUTS: Final = ("statistics", "sensitivity", "sheets", "page")
"""What `xlmc simulate BOOK --html PAGE` makes beside the run."""

ACCEPTED: Final = 1_000
"""Trials that runs with rejected ones go on for."""

_DOCS: Final = Path(__file__).resolve().parents[1] / "docs" / "speed.md"
_MARK: Final = "growth of outputs"
_COLOURS: Final = (
    "#6B7785",
    "#A6AEB8",
    "#1F3044",
    "#2E6DA4",
    "#B8500F",
    "#1B7F5C",
    "#8A3B8F",
    "#C29A1B",
    "#5C8FBF",
    "#7FB69E",
    "#D06A6A",
)


def write_book(path: Path, assumptions: int, forecasts: int, cells: int, rejected: int) -> None:
    """A term of every assumption, forecasts that add some of them up, and a chain of further cells that one needs.

    Args:
        path: of the book.
        assumptions: uniform numbers from 0 to 1.
        forecasts: each the sum of its share of the terms, and the root of another one.
        cells: formula cells in all; at least so many as terms and forecasts.
        rejected: of so many trials a filter of the first assumption accepts one; 1 for no filter.
    """
    from xlsxwriter import Workbook

    with Workbook(path) as book:
        sheet, answers = book.add_worksheet("Inputs"), book.add_worksheet("Answers")
        headings = [{"header": heading} for heading in ("Name", "Value", "Low", "High")]
        data = [[f"Input {k}", 0.5, 0.0, 1.0] for k in range(1, assumptions + 1)]
        sheet.add_table(0, 0, assumptions, 3, {"name": "xlmc_assumptions", "columns": headings, "data": data})
        model = book.add_worksheet("Model")
        for row in range(assumptions):
            model.write_formula(row, 0, f"=Inputs!B{row + 2}+Inputs!B{row + 2}^2/10")
        chain = max(cells - assumptions - forecasts, 1)
        for row in range(chain):
            before = f"+B{row}/2" if row else ""
            model.write_formula(row, 1, f"=A{row % assumptions + 1}*0.5{before}")
        starts = [k * assumptions // forecasts for k in range(forecasts + 1)]
        made = [
            f"=SUM(Model!A{first + 1}:A{max(first + 1, end)})+SQRT(Model!A{7 * k % assumptions + 1})"
            for k, (first, end) in enumerate(pairwise(starts))
        ]
        made[0] += f"+Model!B{chain}/1000"
        columns = [{"header": "Name"}, {"header": "Value"}]
        names = [[f"Answer {k}", 0] for k in range(1, forecasts + 1)]
        answers.add_table(0, 0, forecasts, 1, {"name": "xlmc_forecasts", "columns": columns, "data": names})
        for row, formula in enumerate(made, start=1):
            answers.write_formula(row, 1, formula)
        if rejected > 1:
            columns = [{"header": heading} for heading in ("Name", "Value", "At most")]
            row = [["Seen", 0, 1.0 / rejected]]
            answers.add_table(0, 4, 1, 6, {"name": "xlmc_filters", "columns": columns, "data": row})
            answers.write_formula(1, 5, "=Inputs!B2")


def measure(
    axes: dict[str, Sequence[int]], folder: Path, limit: float, *, steps: Sequence[str] = STEPS
) -> dict[str, Any]:
    """Axis -> points, one {"size", step -> seconds and megabytes, …} or {"size", "absent"} a size.

    Args:
        axes: sizes of each.
        folder: for the books.
        limit: seconds that one process may take.
        steps: that are wanted; books are loaded and run in any case.
    """
    result: dict[str, Any] = {}
    middle: dict[str, Any] | None = None
    for axis, sizes in axes.items():
        result[axis] = []
        for size in sizes:
            about = {**MIDDLE, axis: size}
            if about == MIDDLE and middle is not None:
                result[axis].append({**middle, "size": size})
                continue
            point = measure_point(about, folder, limit, steps)
            result[axis].append({"size": size, **point})
            if size == MIDDLE[axis]:
                middle = result[axis][-1]
            print(f"{axis} {size:,}: {_line(point)}", flush=True)
    return result


def measure_point(about: dict[str, int], folder: Path, limit: float, steps: Sequence[str]) -> dict[str, Any]:
    """Return step -> seconds and megabytes of one book, or {"absent": why}; the folder is empty afterwards."""
    trials, book = about["trials"], folder / "book.xlsx"
    write_book(book, **{name: number for name, number in about.items() if name != "trials"})
    options = {"trials": trials} if about["rejected"] == 1 else {"until_accepted": ACCEPTED}
    given = {"path": str(book), "folder": str(folder), "options": options, "steps": steps}
    answer = answer_of(Path(sys.executable), "one_growth_of_outputs.py", given, limit)
    for each in folder.glob("*"):
        each.unlink()
    return {"absent": answer} if isinstance(answer, str) else answer


def point_of(text: str) -> dict[str, int]:
    """Read a point: `assumptions=3000,forecasts=500`; what is not named is as in the middle point, or as many cells as
    are needed.

    Raises:
        ArgumentTypeError: a part is no axis with a whole number from 1.
    """
    given: dict[str, int] = {}
    for part in text.split(","):
        name, _, number = part.partition("=")
        if name not in AXES or not number.isdecimal() or not int(number):
            raise argparse.ArgumentTypeError(f"{part}: write one of {', '.join(AXES)}, =, and a whole number from 1")
        given[name] = int(number)
    about = {**MIDDLE, **given}
    needed = about["assumptions"] + about["forecasts"] + 1
    return {**about, "cells": max(about["cells"], needed)}


def summary(point: dict[str, Any]) -> str:
    """Return a line a step, and what the default outputs cost together as a multiple of the run."""
    if "absent" in point:
        return str(point["absent"])
    lines = [
        f"{step:12} {point[step]['seconds']:8.2f} s {point[step]['megabytes'] or 0.0:8,.0f} MB"
        for step in STEPS
        if step in point
    ]
    asked = [step for step in DEFAULT_OUTPUTS if step in point]
    together = sum(point[step]["seconds"] for step in asked)
    lines.append(f"{', '.join(asked)}: {together:.1f} s, {together / point['run']['seconds']:.2f} times the run")
    return "\n".join(lines)


def _line(point: dict[str, Any]) -> str:
    if "absent" in point:
        return str(point["absent"])
    return ", ".join(f"{step} {point[step]['seconds']:.2f}" for step in STEPS if step in point)


def table(result: dict[str, Any]) -> str:
    """Every axis as a table of Markdown: seconds of each step, the slope of its last decade, and the largest memory."""
    return "\n\n".join(_table_of(axis, points) for axis, points in result.items())


def _table_of(axis: str, points: Sequence[dict[str, Any]]) -> str:
    named = "trials for one accepted" if axis == "rejected" else axis
    lines = [f"| {named} | {' | '.join(STEPS)} | most memory, MB |", "| ---: " * (len(STEPS) + 2) + "|"]
    for point in points:
        if "absent" in point:
            lines.append(f"| {point['size']:,} | {point['absent']} |{' |' * len(STEPS)}")
            continue
        seconds = [f"{point[step]['seconds']:.2f}" if step in point else "" for step in STEPS]
        most = max((point[step]["megabytes"] or 0.0 for step in STEPS if step in point), default=0.0)
        lines.append(f"| {point['size']:,} | {' | '.join(seconds)} | {most:,.0f} |")
    slopes = [slope(*_curve(points, step)) for step in STEPS]
    lines.append(f"| slope | {' | '.join('' if each is None else f'{each:.2f}' for each in slopes)} | |")
    return "\n".join(lines)


def _curve(points: Sequence[dict[str, Any]], step: str) -> tuple[list[int], list[float]]:
    have = [point for point in points if step in point]
    return [point["size"] for point in have], [max(point[step]["seconds"], 1e-3) for point in have]


def draw(result: dict[str, Any], target: Path) -> None:
    """Processor time over size, log–log, one panel an axis."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plot

    figure, axes = plot.subplots(2, 3, figsize=(15, 9), layout="constrained")
    for panel, (axis, points) in zip(axes.flat, result.items(), strict=False):
        for step, colour in zip(STEPS, _COLOURS, strict=True):
            sizes, seconds = _curve(points, step)
            panel.plot(sizes, seconds, "o-", color=colour, ms=4, lw=1.4, label=step)
        named = "trials for one accepted" if axis == "rejected" else axis
        panel.set(xscale="log", yscale="log", xlabel=named, ylabel="seconds of the processor")
        panel.grid(which="major", color="#D5DBE3", lw=0.7)
    for panel in axes.flat[len(result) :]:
        panel.set_axis_off()
    handles, labels = axes.flat[0].get_legend_handles_labels()
    axes.flat[-1].legend(handles, labels, frameon=False, loc="center", ncols=2)
    figure.savefig(target, dpi=110)
    plot.close(figure)


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, and write JSON, picture and table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    target = parser.add_mutually_exclusive_group(required=True)
    target.add_argument("--output", type=Path, help="folder for the results")
    target.add_argument(
        "--point",
        type=point_of,
        metavar="AXIS=NUMBER,...",
        help="measure one book only, and print what each step costs: assumptions=3000,forecasts=500,trials=1000000",
    )
    parser.add_argument("--steps", nargs="+", choices=STEPS, default=STEPS, help="ask for these only")
    parser.add_argument("--axes", nargs="+", choices=AXES, default=list(AXES))
    parser.add_argument("--most", type=int, metavar="N", help="leave out larger sizes")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds that one process may take")
    parser.add_argument("--docs", action="store_true", help="put the table into docs/speed.md")
    chosen = parser.parse_args(arguments)
    if chosen.point:
        with tempfile.TemporaryDirectory(prefix="growth-") as name:
            print(summary(measure_point(chosen.point, Path(name), chosen.limit, chosen.steps)))
        return
    axes = {axis: [size for size in AXES[axis] if not chosen.most or size <= chosen.most] for axis in chosen.axes}
    chosen.output.mkdir(parents=True, exist_ok=True)
    results = chosen.output / "growth-of-outputs.json"
    known = json.loads(results.read_text(encoding="utf-8"))["found"] if results.exists() else {}
    about = machine.describe()
    folder = Path(tempfile.mkdtemp(prefix="growth-"))
    try:
        result = {**known, **measure(axes, folder, chosen.limit, steps=chosen.steps)}
    finally:
        shutil.rmtree(folder)
    result = {axis: result[axis] for axis in AXES if axis in result}
    text = json.dumps({"machine": about, "middle": MIDDLE, "found": result}, indent=1)
    results.write_text(text + "\n", encoding="utf-8")
    draw(result, chosen.output / "growth-of-outputs.png")
    if chosen.docs:
        text = _DOCS.read_text(encoding="utf-8")
        before, _, rest = text.partition(f"<!-- {_MARK} -->")
        after = rest.partition(f"<!-- /{_MARK} -->")[2]
        made = f"<!-- {_MARK} -->\n\n{table(result)}\n\n{machine.sentence(about)}\n\n<!-- /{_MARK} -->"
        _DOCS.write_text(f"{before}{made}{after}", encoding="utf-8")
    print(table(result))


if __name__ == "__main__":
    main()
