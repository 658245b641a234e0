"""`xlmc optimise`: the decisions with which a statistic is largest, or smallest, and how sure that is."""

from __future__ import annotations

import math
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import (
    FilePath,
)
from xlmc.cli.study_output import STUDY, StudyOutput, conclude, study_run_options

if TYPE_CHECKING:
    from xlmc.analysis.studies.optimising import Optimised
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["optimise"]

_KINDS = f"{STUDY}, the accepted trials of the best decisions' run (.csv, .parquet), that run (.xlmcrun)"


@click.command()
@click.argument("book", type=FilePath())
@click.option("--maximise", "--maximize", metavar="GOAL", help='What is to be largest, such as "mean of NPV".')
@click.option("--minimise", "--minimize", metavar="GOAL", help='What is to be smallest, such as "SD of NPV".')
@click.option(
    "--subject-to",
    multiple=True,
    metavar="REQUIREMENT",
    help='What must hold, such as "P5 of NPV >= 0", "probability of NPV above 0 >= 90%" or, of decisions, '
    '"A + 2*B <= 10"; may be given several times.',
)
@click.option(
    "--decision",
    multiple=True,
    help="Choose these decisions only, and leave the others: names joined by commas, * for any letters; may be given "
    "several times.  [default: all]",
)
@click.option(
    "--indifference",
    type=float,
    help="A difference of the goal that does not matter.  [default: 1 % of what a good choice gains]",
)
@click.option(
    "--allow-lost",
    type=float,
    default=0.1,
    show_default=True,
    metavar="PERCENT",
    help="Percent of its trials that a candidate may lose to errors in cells; one that loses more cannot be the best.",
)
@click.option("--runs", type=float, default=60.0, show_default=True, help="Runs whose trials the search may take.")
@study_run_options("each run", _KINDS)
def optimise(
    book: Path,
    maximise: str | None,
    minimise: str | None,
    subject_to: tuple[str, ...],
    decision: tuple[str, ...],
    indifference: float | None,
    allow_lost: float,
    runs: float,
    output: StudyOutput,
    functions: OwnFunctions | None,
    **run: Any,
) -> None:
    """Find the decisions of BOOK with which a statistic is largest, or smallest, and say how sure that is.

    Ctrl-C ends the search with the best that was found by then.
    """
    from xlmc.analysis.studies.optimising import optimise as study
    from xlmc.cli.progress_bar import step_line
    from xlmc.outputs.studies.optimise import optimise_report

    model, files = output.open(book, functions, of_run=True)
    with step_line() as tell:
        result = study(
            model,
            maximise=maximise,
            minimise=minimise,
            subject_to=subject_to,
            decisions=decision,
            indifference=indifference,
            allow_lost=allow_lost,
            runs=runs,
            **run,
            tell=tell,
        )
    report = optimise_report(result, _again(book, decision, indifference, allow_lost, runs, result))
    written = output.give(report, files)
    conclude(written, result.run, _doubts(result))


def _again(
    book: Path,
    decision: tuple[str, ...],
    indifference: float | None,
    allow_lost: float,
    runs: float,
    result: Optimised,
) -> str:
    """Return the command that gives the same again."""
    goal = result.goal
    parts = ["xlmc", "optimise", book.name, "--maximise" if goal.maximise else "--minimise", goal.measure.text]
    parts += [part for each in result.requirements for part in ("--subject-to", each.requirement.text)]
    parts += [part for name in decision for part in ("--decision", name)]
    parts += [] if indifference is None else ["--indifference", repr(indifference)]
    parts += [] if allow_lost == 0.1 else ["--allow-lost", repr(allow_lost)]
    parts += [] if runs == 60.0 else ["--runs", repr(runs)]
    settings = result.run.settings
    return shlex.join([*parts, "-n", str(result.run.trials), "--seed", str(settings.seed), "--engine", settings.engine])


def _doubts(result: Optimised) -> list[str]:
    """Return why the answer must not be used."""
    from xlmc.outputs.studies.optimise import lost_sentences

    missed = [each.requirement.text for each in result.requirements if each.chance <= 0.5]
    found_one = any(each.meets for each in result.rivals)
    none = "The best of the search" if found_one else "No candidate that was found"
    verb = "does not meet" if found_one else "meets"
    doubts = [f"{none} {verb} what is required: {text} fails" for text in missed]
    if math.isnan(result.estimate.value) and not result.run.warnings:
        doubts.append("No candidate gives a number for what is asked")
    if not result.is_whole or any(each.looks_better for each in result.excluded):
        doubts += [each.rstrip(".") for each in lost_sentences(result)]
    return doubts
