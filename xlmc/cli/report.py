"""`xlmc report`: result sheets, page, report, JSON and tables of a saved run, without simulating."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.output_options import NOT_WRITTEN, Outputs, output_options, results_beside
from xlmc.cli.terminal import say

if TYPE_CHECKING:
    from xlmc.report.document import Choice

__all__ = ["report"]

NOT_TO_BE_USED = 1


@click.command()
@click.argument("run", metavar="RUN.xlmcrun", type=click.Path(readable=False, path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(readable=False, path_type=Path),
    help="Result workbook.  [default: RUN-results.xlsx, unless another file is asked for]",
)
@output_options
@click.option("--sections", metavar="LIST", help="Of the report, such as answer,forecasts.  [default: all]")
@click.option("--forecasts", "named", multiple=True, metavar="NAME", help="Of the report; may be given several times.")
@click.option("--paper", default="letter", show_default=True, help="Of the report: letter or a4.")
@click.option(
    "--case",
    multiple=True,
    metavar="FIELD=TEXT",
    help="Of the report's cover: title, number, analyst, organisation, date; may be given several times."
    "  [default: the book's table xlmc_case]",
)
@click.option("--quiet", is_flag=True, help="Print no notes.")
def report(
    run: Path,
    output: Path | None,
    html: Path | None,
    pdf: Path | None,
    docx: Path | None,
    json_path: Path | None,
    extract: tuple[Path, ...],
    overwrite: bool,
    sections: str | None,
    named: tuple[str, ...],
    paper: str,
    case: tuple[str, ...],
    quiet: bool,
) -> None:
    """Write the results of a saved run, without simulating again: the same as when it was run."""
    from xlmc.api import open_run
    from xlmc.cli.printing import notices, warnings
    from xlmc.cli.simulate import show_run

    found = open_run(run)
    choice = _choice(sections, named, paper, case)
    choice.check(found)
    if not quiet:
        notices(found.model.notices)
    target = output
    if output is None and not (html or pdf or docx or json_path or extract):
        target = results_beside(run, found.model.path.suffix)
    asked = Outputs(
        *(run, found.model.workbook.name, target, None, html, pdf, docx, json_path, extract, overwrite),
        named=output is not None,
        choice=choice,
    )
    outputs = asked.check(found.model.path)
    written, lines = outputs.write(found)  # before the answer is printed, so that no terminal can cost a run
    show_run(found)
    for line in lines:
        say(line)
    warnings(found.warnings)
    if not written:
        raise click.exceptions.Exit(NOT_WRITTEN)
    if found.warnings:
        raise click.exceptions.Exit(NOT_TO_BE_USED)


def _choice(sections: str | None, forecasts: tuple[str, ...], paper: str, case: tuple[str, ...]) -> Choice:
    """What the report is to hold."""
    from xlmc.report.document import Choice, case_details

    given = {}
    for each in case:
        field, equals, text = each.partition("=")
        if not equals:
            raise click.UsageError(f"--case {each}: write FIELD=TEXT, such as number=2026-17.")
        given[field.strip().casefold()] = text.strip()
    asked = () if sections is None else tuple(each.strip().casefold() for each in sections.split(","))
    return Choice(asked, forecasts, paper.casefold(), case_details(given))
