"""`xlmc uncertainty`: how far an answer's distribution is uncertain where some inputs are not known."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import (
    FilePath,
    WholeNumber,
    engine_option,
    functions_option,
    jobs_option,
    seed_option,
)
from xlmc.cli.study_output import STUDY, StudyOutput, conclude, study_options

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["uncertainty"]


@click.command()
@click.argument("book", type=FilePath())
@click.option("--outer", type=WholeNumber(1), default=250, show_default=True, help="Draws of what is uncertain.")
@click.option(
    "--inner", type=WholeNumber(1), default=1_000, show_default=True, help="Trials of what varies, for each of them."
)
@click.option("--confidence", type=float, default=90.0, show_default=True, help="Of the bands, in percent.")
@click.option(
    "--percentile",
    type=float,
    multiple=True,
    help="A percentile whose band is shown; may be given several times.  [default: 5, 50, 95]",
)
@click.option(
    "--uncertain",
    multiple=True,
    metavar="ASSUMPTION",
    help="These assumptions are uncertain, whatever their rows say: names joined by commas, * for any letters; may be"
    " given several times.",
)
@click.option(
    "--forecast",
    multiple=True,
    help="Tell of these forecasts only: names joined by commas, * for any letters; may be given several times.",
)
@seed_option("the run")
@engine_option
@jobs_option
@study_options(f"{STUDY}, the accepted trials, each with its outer draw (.csv, .parquet)")
@functions_option
def uncertainty(
    book: Path,
    outer: int,
    inner: int,
    confidence: float,
    percentile: tuple[float, ...],
    uncertain: tuple[str, ...],
    forecast: tuple[str, ...],
    seed: int | None,
    engine: str | None,
    jobs: int,
    output: StudyOutput,
    functions: OwnFunctions | None,
) -> None:
    """Tell how uncertain the distributions of BOOK's answers are: what is not known is drawn in an outer loop, what
    varies in an inner one.
    """
    from xlmc.analysis.studies import uncertainty as study
    from xlmc.cli.progress_bar import step_line
    from xlmc.outputs.studies.uncertainty import uncertainty_report
    from xlmc.outputs.study_report import TWO_LOOPS_NOT_KEPT

    model, files = output.open(book, functions, of_run=True, not_kept=TWO_LOOPS_NOT_KEPT)
    with step_line() as tell:
        loops = study.uncertainty(
            model,
            outer=outer,
            inner=inner,
            confidence=confidence,
            percents=percentile or study.PERCENTS,
            uncertain=uncertain,
            judged=forecast,
            seed=seed,
            engine=engine,
            jobs=jobs,
            keep_trials=any(path.suffix.casefold() in (".csv", ".parquet") for path in output.paths),
            tell=tell,
        )
    report = uncertainty_report(loops)
    written = output.give(report, files)
    conclude(written, loops.run)
