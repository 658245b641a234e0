"""`xlmc convert`: a workbook of Crystal Ball, @RISK or XLRisk with its definitions as xlmc's tables."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from xlmc.cli.options import FilePath, functions_option, number_style_option
from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["convert"]


@click.command()
@click.argument("book", type=FilePath())
@click.option(
    "-o",
    "--output",
    type=FilePath(),
    help="The new workbook.  [default: BOOK-converted.xlsx]",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing file, whoever wrote it.")
@number_style_option
@functions_option
def convert(
    book: Path,
    output: Path | None,
    overwrite: bool,
    functions: OwnFunctions | None,
) -> None:
    """Turn what Crystal Ball's dialogs and calls in cells define in BOOK into tables, on a new sheet of a copy.

    The copy gives the same accepted trials as BOOK, to the last bit.
    """
    from xlmc.cli.printing import notices, table, use_number_style
    from xlmc.excel.workbook.target import copy_ending
    from xlmc.montecarlo.model.loading import load
    from xlmc.outputs.conversion.convert import convert as write
    from xlmc.outputs.sheets.save import check_ending

    path = output or book.with_name(f"{book.stem}-converted{copy_ending(book)}")
    check_ending(path, book)
    model = load(book, functions=functions)
    use_number_style(model.definitions.settings.number_style)
    converted = write(model, path, overwrite=overwrite)
    notices(model.notices)
    counts: dict[str, int] = {}
    for each in converted.tables:
        counts[each.kind] = counts.get(each.kind, 0) + len(each.rows)
    table("Written into tables", ("Table", "Rows"), [(kind, str(rows)) for kind, rows in counts.items()], right=(1,))
    if converted.left:
        rows = [(each.stood_in, each.name, each.why) for each in converted.left]
        table("Not converted, in red on the sheet", ("Cell", "Name", "Stands in"), rows)
    say(
        paragraph(f"{path} gives the same accepted trials as {book}. Look at its last sheet, and run xlmc check on it.")
    )
