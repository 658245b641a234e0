"""`xlmc verify`: recomputed values beside those that Excel saved."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option
from xlmc.cli.study_output import STUDY, StudyOutput, study_options
from xlmc.cli.terminal import plain

if TYPE_CHECKING:
    from xlmc.analysis.studies.verify import CellCheck, Verification
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.outputs.document.parts import Block

__all__ = ["verify"]

DIFFERS = 1
_SHOWN, _WRITTEN = 50, 2_000
"""Differing cells that are printed, and those that are written to a file."""


@click.command()
@click.argument("book", type=FilePath())
@click.option("--all", "everything", is_flag=True, help="Check every formula cell, not only the needed ones.")
@study_options(STUDY)
@functions_option
def verify(
    book: Path,
    everything: bool,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Recompute the formulas of BOOK at the base case and compare with the values that are saved in it."""
    from xlmc.analysis.studies.verify import Status
    from xlmc.analysis.studies.verify import verify as check
    from xlmc.cli.printing import use_number_style
    from xlmc.engine.engines import ENGINES
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import number_style_of, read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    workbook = read_workbook(book, functions=functions)
    use_number_style(number_style_of(workbook))
    definitions = None if everything else read_definitions(calculate_labels(workbook), ENGINES)
    if definitions is not None and not definitions.forecasts and not definitions.filters:
        raise click.UsageError(f"{book} has no forecasts and no filters; give --all to check every formula cell.")
    files = output.files(book, functions=functions)
    verification = check(workbook, definitions)
    cells = "every formula cell" if everything else "the formula cells that forecasts and filters need"
    report = StudyReport(
        "Recomputed values beside those that are saved",
        f"{book.name}: {cells}",
        blocks_of(_blocks(verification, workbook.saved_by, _WRITTEN)),
        "Verification",
        partial(_as_json, verification),
    )
    written = output.give(report, files, _blocks(verification, workbook.saved_by, _SHOWN))
    written.check()
    if verification.count(Status.DIFFERING):
        raise click.exceptions.Exit(DIFFERS)


def _as_json(verification: Verification) -> dict[str, object]:
    from xlmc.analysis.studies.verify import Status

    counts = {status.value.replace(" ", "_"): verification.count(status) for status in Status}
    listed = [_entry(cell) for cell in verification.cells if cell.status is not Status.MATCHED]
    return {"formula_cells": len(verification.cells), **counts, "cells": listed}


def _entry(cell: CellCheck) -> dict[str, object]:
    entry = {
        "cell": str(cell.cell),
        "formula": cell.formula,
        "status": cell.status.value,
        "expected": plain(cell.expected),
        "got": plain(cell.got),
        "relative_difference": cell.difference,
        "reason": cell.reason,
    }
    return {key: value for key, value in entry.items() if value not in (None, "")}


def _blocks(verification: Verification, saved_by: str, most: int) -> list[str | Block]:
    """Return what was found, with `most` differing cells; `saved_by` is the program that saved their values."""
    from xlmc.analysis.studies.verify import Status, groups
    from xlmc.montecarlo.number_text import count_text, counted_text
    from xlmc.outputs.document.parts import Table

    counts = [
        f"{count_text(verification.count(status))} {status.value}" for status in Status if verification.count(status)
    ]
    blocks: list[str | Block] = [
        f"{counted_text(len(verification.cells), 'formula cell')}: {', '.join(counts) or 'nothing to check'}."
    ]
    if missing := verification.count(Status.NOT_CACHED):
        blocks.append(
            f"{counted_text(missing, 'cell')} cannot be compared, because no value is saved there. Save the workbook "
            "in Excel or LibreOffice, then verify it again."
        )
    differing = verification.of(Status.DIFFERING)
    if differing:
        rows = tuple(
            (str(c.cell), c.formula, _written(c.expected), _written(c.got), _percent(c.difference))
            for c in differing[:most]
        )
        blocks.append(
            Table(
                "Differing",
                ("Cell", "Formula", f"{saved_by} saved" if saved_by else "Saved", "xlmc", "Relative"),
                rows,
                (4,),
            )
        )
    if len(differing) > most:
        blocks.append(f"… and {count_text(len(differing) - most)} more; --json lists them all.")
    volatile = [cell for cell in verification.of(Status.VOLATILE) if cell.reason]
    for status, listed in ((Status.UNSUPPORTED, verification.of(Status.UNSUPPORTED)), (Status.VOLATILE, volatile)):
        for reason, cells in groups(listed):
            where = ", ".join(str(cell.cell) for cell in cells[:5])
            more = f" and {count_text(len(cells) - 5)} more" if len(cells) > 5 else ""
            blocks.append(f"{status.value}: {reason} ({where}{more})")
    return blocks


def _written(value: object) -> str:
    """Write a value with all digits that it has, which may differ in the last ones."""
    from xlmc.montecarlo.number_text import whole_text

    result = plain(value)
    return whole_text(result) if isinstance(result, float) else str(result)


def _percent(difference: float | None) -> str:
    from xlmc.montecarlo.number_text import number_text

    return "" if difference is None else number_text(difference, 2)
