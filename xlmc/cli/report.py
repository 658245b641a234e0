"""`xlmc report`: result sheets, page, JSON and tables of a saved run, without simulating."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.output_options import Outputs, Reports, Wishes, output_options, results_beside
from xlmc.cli.terminal import say
from xlmc.cli.writing import NOT_WRITTEN

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["report"]

NOT_TO_BE_USED = 1


@click.command()
@click.argument("run", metavar="RUN|RESULTS", type=click.Path(readable=False, path_type=Path))
@click.argument("second", metavar="[RUN]", required=False, type=click.Path(readable=False, path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(readable=False, path_type=Path),
    help="Result workbook.  [default: RUN-results.xlsx, unless another file is asked for]",
)
@output_options
@click.option("--quiet", is_flag=True, help="Print no notes.")
def report(
    run: Path,
    second: Path | None,
    output: Path | None,
    html: Path | None,
    json_path: Path | None,
    extract: tuple[Path, ...],
    overwrite: bool,
    reports: Reports,
    wishes: Wishes,
    quiet: bool,
) -> None:
    """Write the results of a saved run, without simulating again: the same as when it was run.

    RESULTS is a result workbook; its run is repeated for --pdf and --docx, and must be identical. A second RUN stands
    beside the first on the page that --html names.
    """
    if second is not None and (html is None or output or json_path or extract or reports.paths):
        raise click.UsageError(
            "A second run is shown on a page, and there alone: give --html PAGE.html, and no other file."
        )
    from xlmc.analysis.results.saved import open_run
    from xlmc.cli.printing import notices, warnings
    from xlmc.cli.simulate import show_run
    from xlmc.excel.workbook.package import WORKBOOKS
    from xlmc.excel.workbook.seal import read_seal
    from xlmc.excel.workbook.target import copy_ending

    if run.suffix.casefold() in WORKBOOKS:
        if output or html or json_path or extract or not reports.paths:
            raise click.UsageError(
                "Of a result workbook, --pdf and --docx alone are written; the rest needs a saved run."
            )
        Outputs(run, run.name, overwrite=overwrite, reports=reports, wishes=wishes).check(run)  # before the run
        found = _repeated(run, quiet)
    else:
        found = open_run(run)
        seal = read_seal(run)
        if seal is None or not seal.whole:
            say(f"warning: {run}: this saved run was changed since xlmc wrote it (its seal is broken).", err=True)
    if not quiet:
        notices(found.model.notices)
    target = output
    if output is None and not (html or json_path or extract or reports.paths):
        target = results_beside(run, copy_ending(found.model.path))
    name, named = found.model.workbook.name, output is not None
    asked = Outputs(run, name, target, None, html, json_path, extract, overwrite, named=named)
    outputs = asked._replace(reports=reports, wishes=wishes, beside=second).check(found.model.path)
    outputs.check_against(found.model)
    written, lines = outputs.write(found)  # before the answer is printed, so that no terminal can cost a run
    show_run(found)
    for line in lines:
        say(line)
    warnings(found.warnings, found.refused)
    if not written:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if found.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _repeated(results: Path, quiet: bool) -> RunResult:
    """The run that a result workbook records.

    Raises:
        WorkbookError: it holds no record, or its run cannot be repeated as it was.
    """
    from xlmc.cli.progress_bar import progress_bar
    from xlmc.outputs.replay import recorded_run

    with progress_bar(quiet) as progress:
        return recorded_run(results, progress=progress)
