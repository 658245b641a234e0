"""What a study found, as paragraphs and tables of texts: one content for the terminal, a page and a sheet."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.page import Page
from xlmc.report.sheets.styles import CREATED, Styles

__all__ = ["Block", "Table", "Told", "book", "page"]

_WIDTHS: Final = (44.0, *[17.0] * 7)
_LAST: Final = 5
"""The column to which paragraphs reach."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table of texts.

    Attributes:
        title: above it.
        headings: of its columns.
        rows: their cells.
        right: the columns of numbers.
    """

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    right: tuple[int, ...] = ()


Block = str | Table


@dataclass(frozen=True, slots=True)
class Told:
    """What a study found.

    Attributes:
        title: what it is.
        below: of which book, from how many trials.
        blocks: paragraphs and tables in their order.
    """

    title: str
    below: str
    blocks: Sequence[Block]


def page(told: Told) -> str:
    """As one HTML page that needs nothing else."""
    body = "".join(_table(each) if isinstance(each, Table) else f"<p>{escape(each)}</p>\n" for each in told.blocks)
    return (
        "<!DOCTYPE html>\n"
        f'<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(told.title)}</title>\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<h1>{escape(told.title)}</h1>\n<p class="below">{escape(told.below)}</p>\n{body}</body>\n</html>\n'
    )


def _table(table: Table) -> str:
    def row(cells_: Sequence[str], tag: str) -> str:
        found = (
            f"<{tag}>{escape(cell)}</{tag}>" if place in table.right else f'<{tag} class="left">{escape(cell)}</{tag}>'
            for place, cell in enumerate(cells_)
        )
        return f"<tr>{''.join(found)}</tr>\n"

    rows = "".join(row(each, "td") for each in table.rows)
    return (
        f'<h2>{escape(table.title)}</h2>\n<div class="wide"><table><thead>{row(table.headings, "th")}</thead>\n'
        f"<tbody>{rows}</tbody></table></div>\n"
    )


_STYLE: Final = """
body { font: 15px/1.5 "Segoe UI", "Helvetica Neue", Arial, sans-serif; color: #1F3044; margin: 2em auto;
  max-width: 1000px; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: 0; }
h2 { font-size: 1.1em; margin-top: 1.8em; }
p { max-width: 60em; overflow-wrap: anywhere; }
p.below { color: #52606D; margin-top: .2em; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; }
th { background: #1F3044; color: #fff; font-weight: 600; text-align: right; padding: .35em .6em; }
td { border-bottom: 1px solid #D5DBE3; padding: .3em .6em; text-align: right; font-variant-numeric: tabular-nums; }
th.left, td.left { text-align: left; }
td:not(.left) { white-space: nowrap; }
@media print {
  body { margin: 0; max-width: none; font-size: 11px; }
  table { font-size: 9px; }
  h2 { break-after: avoid; }
}
"""


def book(told: Told, sheet: str) -> bytes:
    """As a workbook of one sheet."""
    from xlsxwriter import Workbook

    packed = io.BytesIO()
    with Workbook(packed, {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}) as made:
        made.set_properties({"created": CREATED})
        written = Page(made.add_worksheet(sheet), Styles(made), _WIDTHS)
        written.title(told.title, told.below)
        written.row += 1
        for each in told.blocks:
            if isinstance(each, Table):
                written.heading(each.title)
                written.table(each.headings, [_cells(row, each.right) for row in each.rows])
                written.row += 1
            else:
                written.wide(each, "paragraph", _LAST)
        written.printed(told.title)
    return packed.getvalue()


def _cells(row: Sequence[str], right: Sequence[int]) -> list[Shown]:
    """A text that is a number becomes one; a number with its error stays as it is printed."""
    return [_cell(text, place, place in right) for place, text in enumerate(row)]


def _cell(text: str, place: int, is_number: bool) -> Shown:
    if not is_number:
        return cells.text(text, "name" if place == 0 else "text")
    try:
        return Shown(float(text))
    except ValueError:
        return cells.text(text, "number")
