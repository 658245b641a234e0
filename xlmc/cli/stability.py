"""`xlmc stability`: which cells lose digits or blow up, where in the ranges, and by how much."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option, jobs_option, seed_option, trials_option
from xlmc.cli.study_output import (
    NOT_TO_BE_USED,
    STUDY_OF_A_RUN,
    StudyOutput,
    end_early,
    finishing,
    study_options,
)

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["stability"]


@click.command()
@click.argument("book", type=FilePath())
@click.option("--cells", "all_cells", is_flag=True, help="List every needed cell, not only forecasts and filters.")
@trials_option("the run")
@seed_option("the run")
@jobs_option
@study_options(STUDY_OF_A_RUN)
@functions_option
def stability(
    book: Path,
    all_cells: bool,
    trials: int | None,
    seed: int | None,
    jobs: int,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Find where BOOK loses digits, or its numbers are not what they seem, within the ranges of its assumptions."""
    from xlmc.analysis.studies import stability as study
    from xlmc.cli.printing import warnings
    from xlmc.cli.progress_bar import step_line
    from xlmc.outputs.studies.stability import stability_report

    model, files = output.open(book, functions, of_run=True)
    with step_line() as tell:
        result = study.stability(model, trials=trials, seed=seed, jobs=jobs, tell=tell)
    with finishing():
        written = output.give(stability_report(result, all_cells), files)
    warnings(result.run.warnings, result.run.refused)
    written.check()
    end_early(result.ended)
    if result.wrong or result.run.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)
