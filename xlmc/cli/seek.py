"""`xlmc seek`: the value of one cell at which another has the value it is to have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option
from xlmc.cli.study_output import STUDY, StudyOutput, study_options

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["seek"]

NOT_FOUND = 1


@click.command()
@click.argument("book", type=FilePath())
@click.option("--cell", required=True, help="The cell that is to have a value: Model!D9, or a defined name.")
@click.option("--to", type=float, required=True, help="The value that it is to have.")
@click.option("--by", required=True, help="The cell to vary, which holds no formula: Inputs!B4, or a defined name.")
@click.option("--low", type=float, help="The least value of that cell.  [default: search outwards from its own value]")
@click.option("--high", type=float, help="The largest value of that cell.")
@study_options(STUDY)
@functions_option
def seek(
    book: Path,
    cell: str,
    to: float,
    by: str,
    low: float | None,
    high: float | None,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Find the value of one cell of BOOK at which another has a given value, all else as it is in the workbook."""
    from xlmc.analysis.studies import seek as study
    from xlmc.cli.printing import use_number_style
    from xlmc.outputs.studies.seek import seek_report

    files = output.files(book, functions=functions)
    result = study.seek(book, cell, to, by, low=low, high=high, functions=functions)
    use_number_style(result.number_style)
    report = seek_report(result)
    written = output.give(report, files)
    written.check()
    if not result.values.size:
        raise click.exceptions.Exit(NOT_FOUND)
