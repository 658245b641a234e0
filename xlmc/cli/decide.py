"""`xlmc decide`: the answers for every combination of decisions, over the same random numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from xlmc.cli.options import (
    FilePath,
)
from xlmc.cli.study_output import StudyOutput, conclude, study_run_options

if TYPE_CHECKING:
    from xlmc.analysis.studies.decisions import Decided
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["decide"]


@click.command()
@click.argument("book", type=FilePath())
@click.option(
    "--table",
    multiple=True,
    metavar="DECISION",
    help="Vary these decisions, three at most: names joined by commas, * for any letters; may be given several times."
    "  [default: all]",
)
@study_run_options("each run")
def decide(
    book: Path,
    table: tuple[str, ...],
    output: StudyOutput,
    functions: OwnFunctions | None,
    **run: Any,
) -> None:
    """Tell the answers of BOOK for every combination of its decisions, over the same random numbers."""
    from xlmc.analysis.studies import decisions as study
    from xlmc.cli.progress_bar import step_line
    from xlmc.outputs.studies.decide import decide_report

    model, files = output.open(book, functions, of_run=True)
    with step_line() as tell:
        result = study.decide(model, table, **run, tell=tell)
    report = decide_report(result)
    written = output.give(report, files)
    conclude(written, result.run, _doubts(result), result.ended)


def _doubts(result: Decided) -> list[str]:
    """Return why the answers of combinations must not be used."""
    from xlmc.analysis.studies.decisions import values_text

    doubts = [f"{each.answers.name}: {warning}" for each in result.combinations for warning in each.answers.warnings]
    return [
        *doubts,
        *(
            f"{values_text(result.decisions, each)}: not possible: {why.rstrip('.')}"
            for each, why in result.impossible.items()
        ),
    ]
