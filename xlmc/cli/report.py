"""`xlmc report`: result sheets, page, JSON and tables of a saved run, without simulating."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, detailed_option, functions_option, number_style_option
from xlmc.cli.output_options import Outputs, ReportContents, output_options, results_beside
from xlmc.cli.terminal import say
from xlmc.cli.writing import NOT_WRITTEN

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["report"]

NOT_TO_BE_USED = 1


@click.command()
@click.argument("run", metavar="RUN|RESULTS", type=FilePath())
@click.argument("second", metavar="[RUN]", required=False, type=FilePath())
@output_options("RUN-results.xlsx", without=["save_run"])
@detailed_option
@number_style_option
@functions_option
def report(
    run: Path,
    second: Path | None,
    output: tuple[Path, ...],
    also: tuple[Path, ...],
    overwrite: bool,
    contents: ReportContents,
    detailed: int | None,
    functions: OwnFunctions | None,
) -> None:
    """Write the results of a saved run, without simulating again: the same as when it was run.

    RESULTS is a result workbook; its run is repeated, and must be identical. A second RUN stands beside the first on
    the page that -o names.
    """
    from xlmc.analysis.results.saved import open_run
    from xlmc.cli.printing import notices, use_number_style, warnings
    from xlmc.cli.simulate import show_run
    from xlmc.excel.workbook.package import WORKBOOKS
    from xlmc.excel.workbook.seal import read_seal
    from xlmc.excel.workbook.target import copy_ending

    asked = Outputs(
        run, run.name, (*output, *also), overwrite=overwrite, contents=contents, beside=second, functions=functions
    )
    if second is not None and not asked.is_one_page:
        raise click.UsageError(
            "A second run is shown on a page, and there alone: give -o PAGE.html, and no other file."
        )
    seal = read_seal(run) if os.path.isfile(run) else None
    if run.suffix.casefold() in WORKBOOKS:
        if not asked.files:
            raise click.UsageError("The sheets of a result workbook are there already: name a file, as -o REPORT.pdf.")
        if asked.runs:
            raise click.UsageError(
                "A saved run holds the workbook as it was run, which a result workbook has not kept: save it with"
                " xlmc simulate BOOK -o RUN.xlmcrun."
            )
        asked._replace(name=run.name if seal is None else seal.book).check(run)  # before the run
        result = _repeated(run, functions)
    else:
        result = open_run(run, functions=functions)
        if seal is None or not seal.whole:
            say(f"warning: {run}: this saved run was changed since xlmc wrote it (its seal is broken).", err=True)
    if detailed is not None:
        result = replace(result, settings=replace(result.settings, detailed=detailed))
    use_number_style(result.settings.number_style)
    notices(result.model.notices)
    default = None if asked.files else results_beside(run, copy_ending(result.model.path))
    outputs = asked._replace(name=result.model.workbook.name, default=default).check(result.model.path)
    outputs.check_against(result.model)
    written, lines = outputs.write(result)  # before the answer is printed, so that no terminal can cost a run
    show_run(result)
    for line in lines:
        say(line)
    warnings(result.warnings, result.refused)
    if not written:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if result.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _repeated(results: Path, functions: OwnFunctions | None) -> RunResult:
    """Return the run that a result workbook records.

    Raises:
        WorkbookError: it holds no record, or its run cannot be repeated as it was.
    """
    from xlmc.cli.progress_bar import progress_bar
    from xlmc.outputs.replay import recorded_run

    with progress_bar() as progress:
        return recorded_run(results, progress=progress, functions=functions)
