"""`xlmc screen`: which assumptions the answer does not need."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import (
    FilePath,
    chance_option,
    tolerance_option,
)
from xlmc.cli.study_output import StudyOutput, conclude, finishing, study_run_options

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["screen"]


@click.command()
@click.argument("book", type=FilePath())
@tolerance_option
@chance_option
@click.option(
    "--acceptance",
    type=click.FloatRange(0, min_open=True),
    default=10.0,
    show_default=True,
    help="The largest change of the share of accepted trials that counts as none, in % of it.",
)
@click.option(
    "--freeze",
    multiple=True,
    help="Also say what holding all of these assumptions at once costs: names joined by commas, * for any letters;"
    " may be given several times.",
)
@click.option(
    "--forecast",
    multiple=True,
    help="Judge by these forecasts only: names joined by commas, * for any letters; may be given several times.",
)
@click.option(
    "--ends",
    is_flag=True,
    help="Also hold each assumption that may be held at the ends of its range: does it have to be known better?",
)
@study_run_options("each run")
def screen(
    book: Path,
    tolerance: tuple[str, ...],
    chance: float | None,
    acceptance: float,
    freeze: tuple[str, ...],
    forecast: tuple[str, ...],
    ends: bool,
    output: StudyOutput,
    functions: OwnFunctions | None,
    **run: Any,
) -> None:
    """Find which assumptions of BOOK may be held at their base values, and which filters may be left out, without
    changing its answers.
    """
    from xlmc.analysis.studies import screening
    from xlmc.cli.progress_bar import plan_note, step_line
    from xlmc.outputs.studies.screen import printed, screen_report

    model, files = output.open(book, functions, of_run=True)
    with step_line() as tell:
        result = screening.screen(
            model,
            tolerance,
            chance=chance,
            acceptance_tolerance=acceptance / 100.0,
            sets=freeze,
            judged_by=forecast,
            ends=ends,
            **run,
            tell=tell,
            plan=plan_note,
        )
    with finishing():
        report = screen_report(result)
        message = f"{report.below.partition(':')[0]}: what it could do without"
        written = output.give(report, files, [message, *printed(result)])
    conclude(written, result.run, ended=result.ended)
