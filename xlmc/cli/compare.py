"""`xlmc compare`: do two models of a crash give the same answer?"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import (
    FilePath,
    chance_option,
    engine_option,
    functions_option,
    jobs_option,
    seed_option,
    tolerance_option,
    trials_option,
)
from xlmc.cli.study_output import STUDY, StudyOutput, end_early, finishing, study_options

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison import ForecastComparison
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["compare"]

UNDECIDED = 1


@click.command()
@click.argument("first", type=FilePath())
@click.argument("second", type=FilePath())
@tolerance_option
@chance_option
@click.option("--pair", multiple=True, help="'A=B': forecast A of the first book is forecast B of the second.")
@click.option(
    "--feed",
    multiple=True,
    help="'A=B': ask whether FIRST needs SECOND, whose forecast B would give FIRST's assumption A; may be given several"
    " times.",
)
@trials_option("each run", "the books' larger number")
@seed_option("each run", "the first book's")
@engine_option
@jobs_option
@click.option("--no-causes", is_flag=True, help="Do not look for what makes the difference.")
@study_options(STUDY)
@functions_option
def compare(
    first: Path,
    second: Path,
    tolerance: tuple[str, ...],
    chance: float | None,
    pair: tuple[str, ...],
    feed: tuple[str, ...],
    trials: int | None,
    seed: int | None,
    engine: str | None,
    jobs: int,
    no_causes: bool,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Run the workbooks FIRST and SECOND over the same trials, and say whether the simpler one is enough."""
    from xlmc.analysis.studies import comparison
    from xlmc.analysis.studies.comparison.verdicts import book_names
    from xlmc.cli.printing import notices, use_number_style, warnings
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.diagnostics.directions import direction_notices
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.studies.compare import compare_report

    books = load(first, functions=functions), load(second, functions=functions)
    use_number_style(books[0].definitions.settings.number_style)
    files = output.files(first, second, functions=functions)
    with step_line() as tell:
        result = comparison.compare(
            *books,
            tolerance,
            chance=chance,
            pairs=_pairs(pair, "--pair", "name in the first=name in the second"),
            feeds=_pairs(feed, "--feed", "assumption of the first=forecast of the second"),
            trials=trials,
            seed=seed,
            engine=engine,
            jobs=jobs,
            causes=not no_causes,
            tell=tell,
        )
    with finishing():
        written = output.give(compare_report(result), files)
    runs = list(zip(book_names(result), (result.first, result.second), strict=True))
    notices([replace(notice, where=name) for name, run in runs for notice in direction_notices(run.results.values())])
    doubts = [f"{name}: {warning}" for name, run in runs for warning in run.warnings]
    warnings(doubts, [f"{name}: {warning}" for name, run in runs for warning in run.refused])
    written.check()
    end_early(result.ended)
    if doubts or result.of(comparison.Verdict.UNDECIDED) or any(_contradict(each) for each in result.rivals):
        raise click.exceptions.Exit(UNDECIDED)


def _contradict(each: ForecastComparison) -> bool:
    from xlmc.analysis.studies.comparison.rivalry import RivalVerdict

    return each.rivalry is not None and each.rivalry.agreement is RivalVerdict.CONTRADICT


def _pairs(given: tuple[str, ...], option: str, form: str) -> dict[str, str]:
    """Name in the first book -> name in the second.

    Raises:
        UsageError: a pair is not written as one, or a name is in two.
    """
    result: dict[str, str] = {}
    for text in given:
        mine, equals, theirs = (part.strip() for part in text.partition("="))
        if not (mine and equals and theirs):
            raise click.UsageError(f"{option} {text!r} must be written '{form}'.")
        if mine in result or theirs in result.values():
            raise click.UsageError(f"{option} {text!r} has a name that another {option} has.")
        result[mine] = theirs
    return result
