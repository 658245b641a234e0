"""`xlmc decide`: the answers for every combination of decisions, over the same random numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import (
    FilePath,
    engine_option,
    functions_option,
    jobs_option,
    quiet_option,
    seed_option,
    trials_option,
)
from xlmc.cli.study_output import STUDY_OF_A_RUN, conclude, give_out, study_options

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
@trials_option("each run")
@seed_option("each run")
@engine_option
@jobs_option
@study_options(STUDY_OF_A_RUN)
@quiet_option
@functions_option
def decide(
    book: Path,
    table: tuple[str, ...],
    trials: int | None,
    seed: int | None,
    engine: str | None,
    jobs: int,
    output: tuple[Path, ...],
    also: tuple[Path, ...],
    overwrite: bool,
    as_json: bool,
    quiet: bool,
    functions: OwnFunctions | None,
) -> None:
    """Tell the answers of BOOK for every combination of its decisions, over the same random numbers."""
    from xlmc.analysis.studies import decisions as study
    from xlmc.cli.printing import use_number_style
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.studies.decide import decide_report
    from xlmc.outputs.study_report import Files

    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    files = Files((*output, *also), [book], overwrite=overwrite, functions=functions, of_run=True)
    files.check()
    with step_line(quiet) as tell:
        found = study.decide(model, table, trials=trials, seed=seed, engine=engine, jobs=jobs, tell=tell)
    report = decide_report(found)
    written = give_out(report, files.writers(report), as_json, [f"{report.below}.", *report.blocks])
    conclude(written, found.run, _doubts(found), found.ended)


def _doubts(found: Decided) -> list[str]:
    """Return why the answers of combinations must not be used."""
    from xlmc.analysis.studies.decisions import values_text

    doubts = [f"{each.answers.name}: {warning}" for each in found.combinations for warning in each.answers.warnings]
    return [
        *doubts,
        *(f"{values_text(found.decisions, each)}: not possible: {why}" for each, why in found.impossible.items()),
    ]
