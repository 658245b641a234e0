"""`xlmc methods`: what each method of uncertainty analysis costs on a workbook, and what it misses."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import FilePath, WholeNumber, functions_option, seed_option
from xlmc.cli.study_output import NOT_TO_BE_USED, StudyOutput, end_early, finishing, study_options

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["methods"]


@click.command()
@click.argument("book", type=FilePath())
@click.option(
    "--accuracy",
    default="1%",
    show_default=True,
    help="The accuracy wanted of mean, standard deviation and both ends of the central range, in 95 of 100 runs: 1% of"
    " each forecast's range from 5 % to 95 %, or 0.1 in the forecasts' units.",
)
@click.option(
    "--reference-trials",
    type=WholeNumber(1_024),
    help="Trials of the reference, the long run that errors are measured against.  [default: what takes about eight"
    " seconds, 33554432 at most]",
)
@click.option(
    "-n",
    "--trials",
    type=WholeNumber(1_024),
    help="Trials of the longest runs; others have a fourth of them, a sixteenth, and so on.  [default: 16384 times as"
    " many as the shortest runs, or what takes two and a half seconds]",
)
@click.option("--replicates", type=WholeNumber(2), help="How many runs of each length.  [default: 24]")
@click.option(
    "--time-limit",
    help="About how long it may take at most, such as 60s or 5m; what takes too much of it is left out, and named."
    "  [default: 1 min with more than 20 assumptions, else none]",
)
@click.option("--quick", is_flag=True, help="Few and short runs: a first look, in about half a minute.")
@seed_option("the reference; the runs have others", "the book's")
@study_options("the figure (.png), a workbook (.xlsx), a document (.pdf, .docx), a page (.html), JSON (.json)")
@functions_option
def methods(
    book: Path,
    accuracy: str,
    reference_trials: int | None,
    trials: int | None,
    replicates: int | None,
    time_limit: str | None,
    quick: bool,
    seed: int | None,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Measure every method of uncertainty analysis on BOOK: time, evaluations, errors, and which to use."""
    from xlmc.analysis.studies.methods import quick_settings, recommendation, study
    from xlmc.cli.progress_bar import plan_note, step_line
    from xlmc.outputs.methods import in_short, methods_report

    model, files = output.open(book, functions, drawn=True)
    asked: dict[str, Any] = {
        "reference_trials": reference_trials,
        "trials": trials,
        "replicates": replicates,
        "time_limit": time_limit,
    }
    given = {name: value for name, value in asked.items() if value is not None}
    if quick:
        given = quick_settings(model, given)
    with step_line() as tell:
        result = study(model, accuracy=accuracy, seed=seed, tell=tell, plan=plan_note, **given)
    with finishing():
        report = methods_report(result, figures=files.show_figures)
        advice = (line for each in recommendation(result) for line in (each, ""))
        written = output.give(report, files, [*in_short(result), "", *advice])
    written.check()
    end_early(result.ended)
    if result.reference.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)
