"""`xlmc stability`: which cells lose digits or blow up, where in the ranges, and by how much."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.blocks import show
from xlmc.cli.options import FilePath, functions_option, jobs_option, quiet_option, seed_option, trials_option
from xlmc.cli.study_output import NOT_TO_BE_USED, STUDY_OF_A_RUN, end_early, study_options
from xlmc.cli.terminal import paragraph, say, say_json
from xlmc.cli.writing import write_files

if TYPE_CHECKING:
    from xlmc.analysis.studies.stability import Finding, Stability
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["stability"]


@click.command()
@click.argument("book", type=FilePath())
@click.option("--cells", "all_cells", is_flag=True, help="List every needed cell, not only forecasts and filters.")
@trials_option("the run")
@seed_option("the run")
@jobs_option
@study_options(STUDY_OF_A_RUN)
@quiet_option
@functions_option
def stability(
    book: Path,
    all_cells: bool,
    trials: int | None,
    seed: int | None,
    jobs: int,
    output: tuple[Path, ...],
    also: tuple[Path, ...],
    overwrite: bool,
    as_json: bool,
    quiet: bool,
    functions: OwnFunctions | None,
) -> None:
    """Find where BOOK loses digits, or its numbers are not what they seem, within the ranges of its assumptions."""
    from xlmc.analysis.studies import stability as study
    from xlmc.cli.printing import use_number_style, warnings
    from xlmc.cli.progress_bar import step_line
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.studies.stability import stability_report
    from xlmc.outputs.study_report import Files

    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    files = Files((*output, *also), [book], overwrite=overwrite, functions=functions, of_run=True)
    files.check()
    with step_line(quiet) as tell:
        found = study.stability(model, trials=trials, seed=seed, jobs=jobs, tell=tell)
    report = stability_report(found, all_cells)
    written = write_files(files.writers(report))
    if as_json:
        say_json(report.json())
    else:
        _show(found, all_cells)
        written.print_paths()
    warnings(found.run.warnings, found.run.refused)
    written.check()
    end_early(found.ended)
    if found.wrong or found.run.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _show(found: Stability, all_cells: bool) -> None:
    from xlmc.outputs.studies.stability import count, sentences

    say(f"{found.run.model.workbook.name}: {count(found)}\n")
    for number, finding in enumerate(found.findings, start=1):
        _show_finding(number, finding)
    if found.cells:
        _show_cells(found, all_cells)
    for sentence in sentences(found):
        say(paragraph(sentence))


def _show_finding(number: int, finding: Finding) -> None:
    from xlmc.outputs.studies.stability import finding_heading, finding_sentences

    say(finding_heading(number, finding, _cut(finding.formula)))
    for text in finding_sentences(finding):
        say(paragraph(text, indent="   "))
    if finding.instead:
        say(f"   Instead: {finding.instead}")
    say()


def _cut(formula: str, width: int = 90) -> str:
    return formula if len(formula) <= width else f"{formula[: width - 1]}…"


def _show_cells(found: Stability, all_cells: bool) -> None:
    from xlmc.outputs.studies.stability import cells

    show([cells(found, all_cells)])
