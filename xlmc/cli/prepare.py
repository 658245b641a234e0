"""`xlmc prepare`: xlmc's tables in a workbook of one's own, with proposed rows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from xlmc.cli.options import FilePath, functions_option, number_style_option
from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.excel.address import Area
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.outputs.prepared.prepare import Prepared

__all__ = ["prepare_book"]

_MOST_LISTED: Final = 40


@click.command(name="prepare")
@click.argument("book", type=FilePath())
@click.option("--assumption", "assumptions", metavar="CELLS", multiple=True, help="Uncertain numbers; may be repeated.")
@click.option("--forecast", "forecasts", metavar="CELLS", multiple=True, help="Answers; may be repeated.")
@click.option("-o", "--output", type=FilePath(), help="The copy.  [default: BOOK-prepared.xlsx]")
@click.option("--in-place", is_flag=True, help="Add the tables to BOOK itself.")
@click.option("--overwrite", is_flag=True, help="Replace an existing file, whoever wrote it.")
@number_style_option
@functions_option
def prepare_book(
    book: Path,
    assumptions: tuple[str, ...],
    forecasts: tuple[str, ...],
    output: Path | None,
    in_place: bool,
    overwrite: bool,
    functions: OwnFunctions | None,
) -> None:
    """Add a sheet with xlmc's tables to a copy of BOOK, with the inputs and answers that its formulas have.

    Numbers that formulas use become assumptions, frozen until you choose a distribution; formulas that no other formula
    uses become forecasts. Nothing else in the file changes. Run again on such a workbook, it adds what is new.
    """
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.excel.workbook.target import (
        Target,
        copy_ending,
        is_same_file,
        refuse_into_other_format,
        refuse_into_source,
    )
    from xlmc.excel.workbook.writer import refuse_if_open, write_workbook
    from xlmc.outputs.prepared.prepare import prepared
    from xlmc.outputs.sheets.save import check_ending

    if in_place and output is not None:
        raise click.UsageError("--in-place and --output cannot both be given.")
    if in_place:
        refuse_if_open(book)
    workbook = read_workbook(book, functions=functions)
    read = [book, *([] if functions is None else [functions.path])]
    target = book if in_place else output or book.with_name(f"{book.stem}-prepared{copy_ending(book)}")
    check_ending(target, book)
    if in_place:
        refuse_into_other_format(book)
    else:
        Target(target, "", overwrite, read=read).check()
    result = prepared(book, _areas(workbook, assumptions), _areas(workbook, forecasts), workbook)
    _show(result, workbook)
    if not result.is_new:
        say(paragraph(f"{book} has all of this in its tables already: nothing was written."))
        return

    def check() -> None:
        if in_place and is_same_file(target, book):
            refuse_into_source(target, workbook.sha256, "Try again")
        else:
            Target(target, "", overwrite, read=read).check()

    write_workbook(target, result.data, check)
    given = "" if functions is None else f" --functions {functions.path}"
    where = f"its last sheet, {result.sheet!r}," if result.sheet else "its tables"
    say(
        paragraph(
            f"{target} is written. Open it, and on {where} choose a Distribution for what is uncertain, and type its "
            f"numbers; delete rows that are of no interest. Then run:"
        )
    )
    say(f"  xlmc simulate {target}{given}")  # in one line, to be copied


def _areas(book: Workbook, places: Sequence[str]) -> list[Area] | None:
    from xlmc.errors import WorkbookError
    from xlmc.excel.workbook.places import area_named

    if not places:
        return None
    try:
        return [area_named(book, place) for place in places]
    except KeyError as error:
        raise WorkbookError(str(error.args[0])) from None


def _show(prepared: Prepared, workbook: Workbook) -> None:
    from xlmc.cli.printing import table
    from xlmc.montecarlo.model.cell_forms import content_in, forms_of
    from xlmc.montecarlo.number_text import count_text

    for title, rows in (
        ("Assumptions, frozen", prepared.proposals.assumptions),
        ("Forecasts", prepared.proposals.forecasts),
    ):
        if not rows:
            continue
        shown = rows[:_MOST_LISTED]
        forms = forms_of(workbook, [each.cell for each in shown])
        lines = [
            (each.name, str(each.cell), content_in(form, each.value), each.units)
            for each, form in zip(shown, forms, strict=True)
        ]
        table(title, ("Name", "Cell", "Value", "Units"), lines, right=(2,))
        if len(rows) > _MOST_LISTED:
            say(f"… and {count_text(len(rows) - _MOST_LISTED)} more.")
    if prepared.proposals.further:
        more = prepared.proposals.further
        many = f"{count_text(more)} more formulas are" if more > 1 else "1 more formula is"
        say(
            paragraph(f"note: {many} used by no other: name answers with --forecast Sheet!Cell."),
            err=True,
        )
    for cell, why in prepared.proposals.passed_over[:_MOST_LISTED]:
        say(f"note: {cell} {why}, and has no row.", err=True)
    if not prepared.proposals.assumptions and not prepared.proposals.forecasts and prepared.sheet:
        say("note: no formula uses a number that is typed into a cell: the tables are empty.", err=True)
    elif not prepared.proposals.forecasts and prepared.sheet and not prepared.proposals.passed_over:
        message = "no formula that gives a number depends on these cells: name an answer with --forecast Sheet!Cell"
        say(f"note: {message}.", err=True)
