"""`xlmc scenario`: type a scenario into a workbook, a copy of it or the workbook itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option, number_style_option
from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.analysis.studies.scenario_workbook import EditedWorkbook
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["scenario"]

_MOST_LISTED = 8


@click.command()
@click.argument("book", type=FilePath())
@click.argument("name", required=False)
@click.option("-o", "--output", type=FilePath(), help="Write a copy of BOOK with NAME typed in.")
@click.option("--in-place", is_flag=True, help="Type it into BOOK itself.")
@click.option("--overwrite", is_flag=True, help="Replace an existing file, whoever wrote it.")
@number_style_option
@functions_option
def scenario(
    book: Path,
    name: str | None,
    output: Path | None,
    in_place: bool,
    overwrite: bool,
    functions: OwnFunctions | None,
) -> None:
    """Type the scenario NAME of BOOK's table xlmc_scenarios into a workbook; without NAME, list the scenarios.

    The cells that the scenario changes get its contents, and the formulas that depend on them get their new values.
    Without --output and --in-place nothing is written; the cells are only shown.
    """
    from xlmc.analysis.studies.scenario_answers import refuse_no_scenarios, scenario_faults
    from xlmc.analysis.studies.scenario_workbook import edited_workbook, write_edited
    from xlmc.cli.check import scenario_table
    from xlmc.cli.printing import use_number_style
    from xlmc.excel.workbook.writer import refuse_if_open
    from xlmc.montecarlo.model.loading import load

    if in_place and output is not None:
        raise click.UsageError("--in-place and --output cannot both be given.")
    if name is None and (in_place or output is not None):
        raise click.UsageError(f"which scenario? xlmc scenario {book} lists them.")
    if in_place:
        refuse_if_open(book)
    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    if name is None:
        refuse_no_scenarios(model)
        scenario_table(model.definitions)
        impossible = scenario_faults(model)
        for fault in impossible.values():
            say(f"warning: {fault}", err=True)
        raise click.exceptions.Exit(1 if impossible else 0)
    edited = edited_workbook(model, name)
    target = book if in_place else output
    if target is not None:
        write_edited(edited, target, overwrite=overwrite or in_place)
    _show(edited, model)
    nothing = "Nothing was written: -o NEW.xlsx writes a copy, --in-place the workbook itself."
    say(nothing if target is None else f"Written: {target}")


def _show(edited: EditedWorkbook, model: CompiledModel) -> None:
    """Print the cells with what they held and hold, and what could not be computed."""
    from xlmc.cli.printing import table
    from xlmc.montecarlo.model.cell_forms import content_in, forms_of
    from xlmc.montecarlo.number_text import count_text

    cells = list(edited.cells)
    rows = [
        (str(cell), *(content_in(form, each) or "nothing" for each in edited.cells[cell]))
        for cell, form in zip(cells, forms_of(model.workbook, cells), strict=True)
    ]
    title = f"{model.workbook.name}: the cells of the scenario {edited.scenario.name!r}"
    if rows:
        table(title, ("Cell", "Holds", "Is to hold"), rows)
    else:
        say(f"{title}: the workbook holds all of them already.")
    many = (
        "1 formula gets a new value"
        if edited.computed == 1
        else f"{count_text(edited.computed)} formulas get new values"
    )
    if edited.computed:
        say(paragraph(f"{many}, computed by xlmc."))
    if edited.left:
        skipped = [f"{cell} ({why})" for cell, why in list(edited.left.items())[:_MOST_LISTED]]
        more = f" and {count_text(len(edited.left) - _MOST_LISTED)} more" if len(edited.left) > _MOST_LISTED else ""
        message = f"could not be computed: {'; '.join(skipped)}{more}. Excel calculates the workbook when it opens it"
        say(f"note: {message}", err=True)
    if edited.has_results:
        say("note: the workbook's result sheets are those of the run before, and stay as they are.", err=True)
