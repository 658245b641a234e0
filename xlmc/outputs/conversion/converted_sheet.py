"""The sheet that `xlmc convert` adds: the tables, and a list of everything that was found, and where it stands now."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, quote_sheet
from xlmc.montecarlo.definitions.crystal_ball.refused import REFUSED_CELL
from xlmc.montecarlo.definitions.new_tables import Block, Entry, Formula, NewTable, text_of
from xlmc.montecarlo.definitions.tables.reserved_tables import CONVERTED
from xlmc.outputs.sheets.exact_book import ExactBook
from xlmc.outputs.sheets.styles import CREATED

if TYPE_CHECKING:
    from xlmc.outputs.sheets.exact_book import ExactSheet

__all__ = ["SHEET", "Left", "built_sheet"]

SHEET: Final = "xlmc"

_TOP: Final = 5
"""The row of the first table's headings, counted from 0."""

_GAP: Final = 3
"""Rows from the end of a table to the headings of the next: one for its title, and room to add a row."""

_LINE: Final = 15
"""Points: the height of a line."""

_WIDTHS: Final = (30, 24, 24, 24, 34, 16, *([14] * 14))

_INTRODUCTION: Final = (
    "What Crystal Ball's dialogs and functions in cells define, as xlmc's tables. The other sheets are as they were.",
    "A row with Call in and Call replaces that call in the cell's formula: the formula uses what the row's cell under "
    "Value draws. Lines in red could not be converted.",
)

_DRAWN: Final[dict[str, Any]] = {"bg_color": "#DDEEDD", "valign": "top", "align": "left"}
"""How cells look that stand for calls."""


class Left(NamedTuple):
    """What could not be converted: what it is, its name, its cell, what it was, and why.

    Attributes:
        refused: a cell that must not be taken for a constant.
    """

    what: str
    name: str
    stood_in: str
    was: str
    why: str
    refused: Cell | None = None


def built_sheet(
    tables: Sequence[NewTable], left: Sequence[Left], name: str = SHEET, formats: Mapping[Cell, str] | None = None
) -> dict[str, bytes]:
    """Return the sheet as the parts of a workbook that holds it alone.

    Args:
        tables: to write.
        left: what could not be converted.
        name: of the sheet; the workbook must have none of that name.
        formats: call in a formula -> the number format of its value, where that is a date, a percentage or money.
    """
    with ExactBook() as book:
        book.set_properties({"created": CREATED})
        sheet = book.add_worksheet(name)
        sheet.use_future_functions = True
        _Sheet(book, sheet, tables, formats or {}).write(left)
    parts: dict[str, bytes] = book.parts
    return parts


class _Sheet:
    def __init__(
        self, book: ExactBook, sheet: ExactSheet, tables: Sequence[NewTable], formats: Mapping[Cell, str]
    ) -> None:
        self._book, self._sheet, self._tables = book, sheet, tables
        self._blocks = 0
        self._tops = [_TOP]
        for table in tables:
            self._tops.append(self._tops[-1] + len(table.rows) + 1 + _GAP)
        self._styles: dict[str, Any] = {
            "title": book.add_format({"bold": True, "font_size": 14, "font_color": "#1F3044"}),
            "heading": book.add_format({"bold": True, "font_color": "#1F3044"}),
            "header": book.add_format({"bold": True, "bg_color": "#1F3044", "font_color": "#FFFFFF"}),
            "text": book.add_format({"valign": "top", "align": "left"}),
            "wrapped": book.add_format({"valign": "top", "align": "left", "text_wrap": True}),
            "drawn": book.add_format(_DRAWN),
            "red": book.add_format(
                {"font_color": "#C00000", "bold": True, "valign": "top", "align": "left", "text_wrap": True}
            ),
            "grey": book.add_format({"font_color": "#52606D"}),
        }
        self._drawn = {
            call: book.add_format(_DRAWN | {"num_format": code}) for call, code in sorted(formats.items(), key=str)
        }
        self._calls: dict[Cell, str] = {}
        for table, top in zip(tables, self._tops, strict=False):
            for number, row in enumerate(table.rows, top + 1):
                if row.call is not None:
                    self._calls[row.call] = xl_rowcol_to_cell(number, table.headings.index("Value"), True, True)
        self._named: list[str] = []
        self._next = 0  # the row of the next block of data

    def write(self, left: Sequence[Left]) -> None:
        """Write everything."""
        for column, width in enumerate(_WIDTHS):
            self._sheet.set_column(column, column, width)
        self._sheet.hide_gridlines(2)
        self._sheet.set_landscape()
        self._sheet.fit_to_pages(1, 0)
        self._sheet.write_string(0, 0, "Definitions for xlmc", self._styles["title"])
        for row, text in enumerate(_INTRODUCTION, 1):
            self._sheet.write_string(row, 0, text, self._styles["grey"])
        listed = self._tops[len(self._tables)]
        rows: list[Left | tuple[str, str, str, str, str]] = [*self._listed(), *left]
        self._next = listed + len(rows) + 1 + _GAP
        for table, top in zip(self._tables, self._tops, strict=False):
            self._table(table, top)
        self._list(rows, listed)

    def _table(self, table: NewTable, top: int) -> None:
        self._sheet.write_string(top - 1, 0, _TITLES[table.kind], self._styles["heading"])
        for number, row in enumerate(table.rows, top + 1):
            for column, heading in enumerate(table.headings):
                style = self._styles["text"]
                if heading == "Value" and row.call is not None:
                    style = self._drawn.get(row.call, self._styles["drawn"])
                self._entry(number, column, row.cells.get(heading, ""), style)
        self._add_table(table.kind, top, len(table.rows), table.headings)

    def _entry(self, row: int, column: int, entry: Entry | None, style: Any) -> None:
        match entry:
            case None | "":
                self._sheet.write_blank(row, column, None, style)
            case bool():
                self._sheet.write_boolean(row, column, entry, style)
            case int() | float():
                self._sheet.write_number(row, column, entry, style)
            case str():
                self._sheet.write_string(row, column, entry, style)
            case Formula():
                text = text_of(entry, self._calls)
                self._sheet.write_formula(row, column, text, style, _saved(entry.value))
            case Block():
                self._sheet.write_string(row, column, self._block(entry), style)

    def _block(self, block: Block) -> str:
        """Write numbers below the tables; the name of their range."""
        top, width = self._next, max(len(row) for row in block.rows)
        for number, row in enumerate(block.rows, top):
            for column, value in enumerate(row):
                self._entry(number, column, value, self._styles["text"])
        self._next += len(block.rows) + 1
        self._blocks += 1
        home = quote_sheet(self._sheet.get_name())
        range_ = f"$A${top + 1}:${xl_col_to_name(width - 1)}${top + len(block.rows)}"
        self._book.define_name(f"{home}!data_{self._blocks}", f"={home}!{range_}")
        return f"data_{self._blocks}"

    def _listed(self) -> list[tuple[str, str, str, str, str]]:
        return [
            (row.what, row.name, str(row.where), row.was, f"{table.kind}, row {number + 1}")
            for table, top in zip(self._tables, self._tops, strict=False)
            for number, row in enumerate(table.rows, top + 1)
        ]

    def _list(self, rows: Sequence[Left | tuple[str, str, str, str, str]], top: int) -> None:
        self._sheet.write_string(top - 1, 0, _TITLES[CONVERTED], self._styles["heading"])
        for number, row in enumerate(rows, top + 1):
            style = self._styles["red" if isinstance(row, Left) else "wrapped"]
            texts = [str(text) for text in row[:5]]
            lines = max(len(wrap(text, width - 2)) for text, width in zip(texts, _WIDTHS, strict=False))
            if lines > 1:
                self._sheet.set_row(number, _LINE * lines)
            for column, text in enumerate(texts):
                self._sheet.write_string(number, column, text, style)
            if isinstance(row, Left) and row.refused is not None:
                self._sheet.write_formula(number, 5, f"={row.refused}", style, "")
        self._add_table(CONVERTED, top, max(len(rows), 1), _LISTED)

    def _add_table(self, kind: str, top: int, rows: int, headings: Sequence[str]) -> None:
        columns = [{"header": heading, "header_format": self._styles["header"]} for heading in headings]
        options: dict[str, object] = {
            "name": kind if kind not in self._named else f"{kind}_{len(self._named)}",
            "columns": columns,
        }
        self._named.append(str(options["name"]))
        options |= {"autofilter": False, "style": "Table Style Light 9"}
        self._sheet.add_table(top, 0, top + rows, len(headings) - 1, options)


_LISTED: Final = ("What", "Definition", "Stood in", "Was", "Stands in", REFUSED_CELL)

_TITLES: Final[Mapping[str, str]] = {
    "xlmc_assumptions": "Assumptions",
    "xlmc_forecasts": "Forecasts",
    "xlmc_filters": "Filters",
    "xlmc_correlations": "Rank correlations",
    "xlmc_decisions": "Decisions",
    "xlmc_settings": "Settings of the run",
    CONVERTED: "What was converted, and from where",
}


def _saved(value: object) -> Any:
    """Return the value of a formula as the workbook has it; nothing where it is not known."""
    if isinstance(value, ErrorCode):
        return value.text
    return "" if value is None else value
