"""What `xlmc stability` found, as a document: which cells lose digits, and what to write instead."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from xlmc.analysis.studies.steps import ended_early
from xlmc.errors import capitalised

if TYPE_CHECKING:
    from xlmc.analysis.studies.stability import CellDigits, Finding, Stability
    from xlmc.excel.address import Cell
    from xlmc.outputs.document.parts import Block, Table
    from xlmc.outputs.study_report import StudyReport

__all__ = ["stability_report"]


_LISTED = 20
"""Cells of a sentence that names cells."""

_LEVELS = {"WRONG": "Wrong", "DOUBTFUL": "Doubtful", "NOTE": "Note"}


def _count(stability: Stability) -> str:
    """Say how many findings there are; of a search that was ended early no more than that it had none by then."""
    levels = [finding.level.name for finding in stability.findings]
    counts = {word.lower(): levels.count(level) for level, word in _LEVELS.items() if level in levels}
    parts = [f"{count} {word}{'s' * (word == 'note' and count > 1)}" for word, count in counts.items()]
    if parts:
        return f"{len(levels)} finding{'s' * (len(levels) != 1)}: {', '.join(parts)}"
    if stability.ended:
        return "no finding by the time the search was ended"
    return "no finding: no cell loses digits, and none gives a misleading number"


def stability_report(stability: Stability, all_cells: bool = False) -> StudyReport:
    """Make the report; with `all_cells` its table has every cell, and not those alone that lose digits."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    findings = [
        block for number, one in enumerate(stability.findings, start=1) for block in _finding_blocks(number, one)
    ]
    blocks = blocks_of(
        [
            f"{_count(stability).capitalize()}.",
            *findings,
            *([_cells(stability, all_cells)] if stability.cells else []),
            *_sentences(stability),
        ]
    )
    run = stability.run
    below = f"{run.model.workbook.name}: {count_text(run.trials)} trials, seed {run.settings.seed}"
    return StudyReport("Can the digits be trusted?", below, blocks, "Stability", partial(_as_json, stability), run)


def _finding_blocks(number: int, finding: Finding) -> Iterator[str | Block]:
    from xlmc.outputs.document.parts import Code, Heading

    name = f" {finding.name}" if finding.name else ""
    yield Heading(f"{number}. {_LEVELS[finding.level.name]}: {finding.cell}{name}")
    yield Code(finding.formula)
    yield from (f"{capitalised(text)}." for text in (finding.what, finding.effect))
    if finding.where:
        yield f"Where: {'; '.join(map(str, finding.where))}"
    if finding.instead:
        yield "Instead:"
        yield Code(finding.instead)


def _cells(stability: Stability, all_cells: bool) -> Table:
    from xlmc.montecarlo.number_text import number_text
    from xlmc.outputs.document.parts import Table

    model = stability.run.model
    targets = {row.cell for row in model.forecasts} | {row.cell for row in model.filters}
    rows = tuple(
        (
            cell.name or str(cell.cell),
            *([str(cell.cell)] if all_cells else []),
            number_text(cell.amplification, 3),
            number_text(cell.most, 3),
            cell.through,
            number_text(cell.rounding, 1),
            number_text(cell.excess, 2),
        )
        for cell in stability.cells
        if all_cells or cell.cell in targets
    )
    headings = (
        "Cell",
        *(["Address"] if all_cells else []),
        "Amplifies",
        "In 1 of 100",
        "Through",
        "Rounding",
        "Excess",
    )
    first = 3 if all_cells else 2
    return Table("What cells amplify and lose", headings, rows, (first - 1, first, first + 2, first + 3))


def _sentences(stability: Stability) -> Iterator[str]:
    from xlmc.montecarlo.number_text import count_text

    yield (
        "Amplifies: if each assumption changes by 1 %, the cell changes by up to so many percent, in the median trial "
        "and in one trial of 100. Through: the assumption that causes most of it. No other form of a formula makes it "
        "less. Rounding: the largest error by rounding, as a share of the central range or of the value. Excess: how "
        "many times larger that error is than the effect of rounding the assumptions alone; up to 7 in sound formulas."
    )
    if stability.ended:
        left = ", ".join((*stability.not_looked_for, "what every cell amplifies"))
        yield ended_early("search", stability.ended, f"Not looked for: {left}.")
    trials = f"{count_text(stability.points)} trial{'s' * (stability.points != 1)}"
    yield (
        f"Examined: {trials} of a run of {count_text(stability.run.trials)}, seed "
        f"{stability.run.settings.seed}, among them the base "
        f"case and the ends of all ranges; {count_text(stability.recomputed)} were computed again with 50 digits."
    )
    cells: dict[str, list[Cell]] = {}
    for cell, functions in stability.unchecked:
        cells.setdefault(", ".join(functions), []).append(cell)
    for functions, where in cells.items():
        more = f" and {count_text(len(where) - _LISTED)} more cells" if len(where) > _LISTED else ""
        yield f"Not checked with 50 digits: {functions} in {', '.join(map(str, where[:_LISTED]))}{more}."


def _as_json(stability: Stability) -> dict[str, object]:
    return {
        "book": str(stability.run.model.path),
        "trials": stability.run.trials,
        "seed": stability.run.settings.seed,
        "points": stability.points,
        "recomputed": stability.recomputed,
        "findings": [_finding_json(finding) for finding in stability.findings],
        "cells": [_cell_json(cell) for cell in stability.cells],
        "ended_early": stability.ended or None,
        "unchecked": [{"cell": str(cell), "functions": list(names)} for cell, names in stability.unchecked],
    }


def _finding_json(finding: Finding) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "level": finding.level.name.lower(),
        "kind": finding.kind,
        "cell": str(finding.cell),
        "name": finding.name,
        "formula": finding.formula,
        "what": finding.what,
        "effect": finding.effect,
        "where": [
            {"assumption": one.name, "low": one.low, "high": one.high, "units": one.units} for one in finding.where
        ],
        "instead": finding.instead,
        "size": finite(finding.size),
    }


def _cell_json(cell: CellDigits) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {
        "cell": str(cell.cell),
        "name": cell.name,
        "amplification": finite(cell.amplification),
        "amplification_1_of_100": finite(cell.most),
        "through": cell.through,
        "rounding": finite(cell.rounding),
        "excess": finite(cell.excess),
        "checked": cell.checked,
    }
