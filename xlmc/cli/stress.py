"""`xlmc stress`: the answers where assumptions lie in their tails, and the inputs that set some answers apart."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import (
    FilePath,
)
from xlmc.cli.study_output import StudyOutput, conclude, study_run_options

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["stress"]


@click.command()
@click.argument("book", type=FilePath())
@click.option(
    "--share",
    type=float,
    default=10.0,
    show_default=True,
    metavar="PERCENT",
    help="Percent of the trials in each tail.",
)
@click.option(
    "--scenario",
    multiple=True,
    metavar="RANGE",
    help="Which inputs distinguish the trials of these answers: 'above P90', 'below 20' in the unit of the forecast,"
    " 'between P5 and P10'; may be given several times.  [default: above P90]",
)
@click.option(
    "--assumption",
    multiple=True,
    help="Stress these assumptions only: names joined by commas, * for any letters; may be given several times.",
)
@click.option(
    "--forecast",
    multiple=True,
    help="Tell of these forecasts only: names joined by commas, * for any letters; may be given several times.",
)
@study_run_options("the run")
def stress(
    book: Path,
    share: float,
    scenario: tuple[str, ...],
    assumption: tuple[str, ...],
    forecast: tuple[str, ...],
    output: StudyOutput,
    functions: OwnFunctions | None,
    **run: Any,
) -> None:
    """Tell the answers of BOOK with each assumption in its low and high tail, and what distinguishes high answers."""
    from xlmc.analysis.studies import stress as study
    from xlmc.cli.progress_bar import step_line
    from xlmc.outputs.studies.stress import stress_report

    model, files = output.open(book, functions, of_run=True)
    with step_line() as tell:
        result = study.stress(
            model,
            share=share,
            assumptions=assumption,
            forecasts=forecast,
            scenarios=scenario or (study.SCENARIO,),
            **run,
            tell=tell,
        )
    report = stress_report(result)
    written = output.give(report, files)
    conclude(written, result.run)
