"""`xlmc screen`: which assumptions the answer does not need."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import (
    FilePath,
    chance_option,
    engine_option,
    functions_option,
    jobs_option,
    quiet_option,
    seed_option,
    tolerance_option,
    trials_option,
)
from xlmc.cli.study_output import STUDY_OF_A_RUN, conclude, give_out, study_options

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
@trials_option("each run")
@seed_option("each run")
@engine_option
@jobs_option
@study_options(STUDY_OF_A_RUN)
@quiet_option
@functions_option
def screen(
    book: Path,
    tolerance: tuple[str, ...],
    chance: float | None,
    acceptance: float,
    freeze: tuple[str, ...],
    forecast: tuple[str, ...],
    ends: bool,
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
    """Find which assumptions of BOOK may be held at their base values, and which filters may be left out, without
    changing its answers.
    """
    from xlmc.analysis.studies import screening
    from xlmc.cli.printing import use_number_style
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.studies.screen import printed, screen_report
    from xlmc.outputs.study_report import Files

    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    files = Files((*output, *also), [book], overwrite=overwrite, functions=functions, of_run=True)
    files.check()
    with step_line(quiet) as tell:
        found = screening.screen(
            model,
            tolerance,
            chance=chance,
            acceptance_tolerance=acceptance / 100.0,
            sets=freeze,
            judged_by=forecast,
            ends=ends,
            trials=trials,
            seed=seed,
            engine=engine,
            jobs=jobs,
            tell=tell,
        )
    report = screen_report(found)
    written = give_out(
        report,
        files.writers(report),
        as_json,
        [f"{report.below.partition(':')[0]}: what it could do without", *printed(found)],
    )
    conclude(written, found.run, ended=found.ended)
