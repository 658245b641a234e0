"""`xlmc stress`: the answers where assumptions lie in their tails, and the inputs that set some answers apart."""

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
@trials_option("the run")
@seed_option("the run")
@engine_option
@jobs_option
@study_options(STUDY_OF_A_RUN)
@quiet_option
@functions_option
def stress(
    book: Path,
    share: float,
    scenario: tuple[str, ...],
    assumption: tuple[str, ...],
    forecast: tuple[str, ...],
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
    """Tell the answers of BOOK with each assumption in its low and high tail, and what distinguishes high answers."""
    from xlmc.analysis.studies import stress as study
    from xlmc.cli.printing import use_number_style
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.studies.stress import stress_report
    from xlmc.outputs.study_report import Files

    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    files = Files((*output, *also), [book], overwrite=overwrite, functions=functions, of_run=True)
    files.check()
    with step_line(quiet) as tell:
        found = study.stress(
            model,
            share=share,
            assumptions=assumption,
            forecasts=forecast,
            scenarios=scenario or (study.SCENARIO,),
            trials=trials,
            seed=seed,
            engine=engine,
            jobs=jobs,
            tell=tell,
        )
    report = stress_report(found)
    written = give_out(report, files.writers(report), as_json, [f"{report.below}.", *report.blocks])
    conclude(written, found.run)
