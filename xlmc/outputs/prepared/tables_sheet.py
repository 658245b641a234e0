"""The sheet with xlmc's tables that `xlmc prepare` and `xlmc new blank` add: rows to fill in, lists to choose from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from xlsxwriter.utility import xl_col_to_name, xl_rowcol_to_cell

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellValue
from xlmc.montecarlo.definitions.tables.settings import setting_names
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.outputs.sheets.exact_book import ExactBook
from xlmc.outputs.sheets.styles import CREATED

__all__ = ["HEADINGS", "SHEET", "NewRow", "frozen_formula", "tables_sheet"]

SHEET: Final = "xlmc"

HEADINGS: Final[Mapping[str, tuple[str, ...]]] = {
    "xlmc_assumptions": (
        "Name",
        "Cell",
        "Distribution",
        "Low",
        "Likeliest",
        "High",
        "Mean",
        "Std dev",
        "Lower cutoff",
        "Upper cutoff",
        "Units",
        "Source",
        "Frozen",
    ),
    "xlmc_forecasts": ("Name", "Cell", "Units", "Threshold"),
    "xlmc_filters": ("Name", "Cell", "At least", "At most", "Because"),
    "xlmc_correlations": ("First", "Second", "Correlation"),
    "xlmc_decisions": ("Name", "Cell", "Low", "High", "Step", "Values", "Units"),
    "xlmc_solve": ("Name", "Cell", "To", "By", "Low", "High", "Root"),
    "xlmc_settings": ("Setting", "Value"),
}
"""The tables from left to right, with their columns."""

_TITLES: Final = {
    "xlmc_assumptions": "Assumptions: the uncertain inputs",
    "xlmc_forecasts": "Forecasts: the answers",
    "xlmc_filters": "Filters: which trials are possible",
    "xlmc_correlations": "Rank correlations",
    "xlmc_decisions": "Decisions: what is chosen",
    "xlmc_solve": "Cells that are solved for in every trial",
    "xlmc_settings": "Settings of the run",
}

_NOTES: Final = {
    "xlmc_assumptions": "Choose a Distribution and type its numbers. A row without any is frozen: it keeps its value.",
    "xlmc_forecasts": "Delete rows that are of no interest; Threshold asks for the probability above it.",
    "xlmc_filters": "A trial outside At least and At most is rejected. No row: all trials count.",
    "xlmc_correlations": "Names of two assumptions, and their rank correlation from -1 to 1.",
    "xlmc_decisions": "Low, High and Step, or Values such as 10; 20; 50. For xlmc decide and xlmc optimise.",
    "xlmc_solve": "Cell becomes To by changing By, between Low and High. Root: only (blank), first or last.",
    "xlmc_settings": "Blank means the usual value.",
}

_HEADING_ROW: Final = 5
"""The row of all headings, counted from 0."""

_LAST_CHECKED: Final = 1_000
"""The last row that lists and checks are made for: rows that are added below have them, too."""

_WIDTHS: Final = {"Name": 34, "First": 24, "Second": 24, "Distribution": 16, "Source": 34, "Because": 34, "Setting": 18}
_WIDTH: Final = 12
_NUMBERS: Final = ("Low", "Likeliest", "High", "Mean", "Std dev", "Lower cutoff", "Upper cutoff")


@dataclass(frozen=True, slots=True)
class NewRow:
    """A row of a table: heading -> what is typed into its cell; `cell` is what `Cell` points to, with its value."""

    given: Mapping[str, CellValue] = field(default_factory=dict)
    cell: Cell | None = None
    value: CellValue = None


def frozen_formula(row: int, column: int) -> str:
    """Return the formula that freezes a row until something is typed from its `Distribution` to its `Upper cutoff`.

    Args:
        row: counted from 0.
        column: of the heading `Distribution`, counted from 0.
    """
    headings = HEADINGS["xlmc_assumptions"]
    last = column + headings.index("Upper cutoff") - headings.index("Distribution")
    return f"=COUNTA({xl_rowcol_to_cell(row, column)}:{xl_rowcol_to_cell(row, last)})=0"


def tables_sheet(rows: Mapping[str, Sequence[NewRow]], kinds: Sequence[str], name: str, title: str) -> dict[str, bytes]:
    """Return the sheet as the parts of a workbook that holds it alone.

    Args:
        rows: kind of table -> its rows; a table without any has a blank one.
        kinds: the tables that are written.
        name: of the sheet.
        title: the line at its top.
    """
    with ExactBook() as book:
        book.set_properties({"created": CREATED})
        sheet = book.add_worksheet(name)
        _Sheet(book, sheet).write(rows, kinds, title)
    parts: dict[str, bytes] = book.parts
    return parts


class _Sheet:
    def __init__(self, book: Any, sheet: Any) -> None:
        self._sheet = sheet
        self._styles: dict[str, Any] = {
            "title": book.add_format({"bold": True, "font_size": 14, "font_color": "#1F3044"}),
            "heading": book.add_format({"bold": True, "font_color": "#1F3044"}),
            "header": book.add_format({"bold": True, "bg_color": "#1F3044", "font_color": "#FFFFFF"}),
            "note": book.add_format({"font_color": "#52606D", "italic": True}),
            "input": book.add_format({"bg_color": "#E6F4E6"}),
            "plain": book.add_format({}),
            "grey": book.add_format({"font_color": "#52606D"}),
        }

    def write(self, rows: Mapping[str, Sequence[NewRow]], kinds: Sequence[str], title: str) -> None:
        self._sheet.write_string(0, 0, title, self._styles["title"])
        self._sheet.write_string(
            1,
            0,
            "xlmc reads these tables, which may lie on any sheet. Add rows below; xlmc check says what it understood.",
            self._styles["grey"],
        )
        left, lefts = 0, {}
        for kind in kinds:
            lefts[kind] = left
            left += len(HEADINGS[kind]) + 1
        lists = {"Distribution": [*FAMILIES], "Root": ["only", "first", "last"], "Setting": setting_names()}
        sources = {
            heading: self._list(left + at + 1, heading, words) for at, (heading, words) in enumerate(lists.items())
        }
        for kind, column in lefts.items():
            self._table(kind, column, rows.get(kind, ()), sources)
        self._sheet.freeze_panes(_HEADING_ROW + 1, 1)
        self._sheet.hide_gridlines(2)
        self._sheet.set_landscape()
        self._sheet.fit_to_pages(1, 0)

    def _list(self, column: int, heading: str, words: Sequence[str]) -> str:
        """Write the words of a list into a hidden column, and return where they stand."""
        self._sheet.write_string(_HEADING_ROW, column, f"{heading}: words", self._styles["grey"])
        for row, word in enumerate(words, _HEADING_ROW + 1):
            self._sheet.write_string(row, column, word)
        self._sheet.set_column(column, column, None, None, {"hidden": True})
        letters = xl_col_to_name(column)
        return f"=${letters}${_HEADING_ROW + 2}:${letters}${_HEADING_ROW + 1 + len(words)}"

    def _table(self, kind: str, left: int, rows: Sequence[NewRow], sources: Mapping[str, str]) -> None:
        headings = HEADINGS[kind]
        self._sheet.write_string(_HEADING_ROW - 2, left, _TITLES[kind], self._styles["heading"])
        self._sheet.write_string(_HEADING_ROW - 1, left, _NOTES[kind], self._styles["note"])
        shown = rows or [NewRow()]
        for number, row in enumerate(shown, _HEADING_ROW + 1):
            for at, heading in enumerate(headings, left):
                self._cell(
                    number, at, heading, row, left + headings.index("Distribution") if "Distribution" in headings else 0
                )
        for at, heading in enumerate(headings, left):
            self._sheet.set_column(at, at, _WIDTHS.get(heading, _WIDTH))
            self._check(kind, at, heading, left, sources)
        columns = [{"header": heading, "header_format": self._styles["header"]} for heading in headings]
        bottom, right = _HEADING_ROW + len(shown), left + len(headings) - 1
        options = {"name": kind, "columns": columns, "autofilter": False, "style": "Table Style Light 9"}
        self._sheet.add_table(_HEADING_ROW, left, bottom, right, options)

    def _cell(self, row: int, column: int, heading: str, new: NewRow, distribution: int) -> None:
        if heading == "Cell" and new.cell is not None:
            self._sheet.write_formula(row, column, f"={new.cell}", self._styles["grey"], _saved(new.value))
            return
        if heading == "Frozen" and new.cell is not None:
            frozen = not any(new.given.get(each) is not None for each in ("Distribution", *_NUMBERS))
            self._sheet.write_formula(row, column, frozen_formula(row, distribution), self._styles["grey"], frozen)
            return
        style = self._styles["input" if heading in ("Distribution", *_NUMBERS) else "plain"]
        match new.given.get(heading):
            case None:
                self._sheet.write_blank(row, column, None, style)
            case bool() as logical:
                self._sheet.write_boolean(row, column, logical, style)
            case int() | float() as number:
                self._sheet.write_number(row, column, number, style)
            case text:
                self._sheet.write_string(row, column, str(text), style)

    def _check(self, kind: str, column: int, heading: str, left: int, sources: Mapping[str, str]) -> None:
        """Let Excel offer the words of a column, or say what does not fit in it."""
        first = _HEADING_ROW + 1
        options: dict[str, object] | None = None
        if heading in sources:
            options = {"validate": "list", "source": sources[heading], "error_type": "information"}
            options |= {
                "error_title": heading,
                "error_message": "This word is not in the list: xlmc check says if it knows it.",
            }
        elif heading == "Correlation":
            options = {"validate": "decimal", "criteria": "between", "minimum": -1, "maximum": 1}
            options |= {"error_title": heading, "error_message": "A rank correlation lies from -1 to 1."}
        elif heading in ("High", "At most"):
            low = left + HEADINGS[kind].index("Low" if heading == "High" else "At least")
            ends = xl_rowcol_to_cell(first, low), xl_rowcol_to_cell(first, column)
            options = {
                "validate": "custom",
                "value": f'=OR({ends[0]}="",{ends[0]}<={ends[1]})',
                "error_type": "warning",
            }
            options |= {"error_title": heading, "error_message": "This is below the other end of the range."}
        elif heading == "Std dev":
            cell = xl_rowcol_to_cell(first, column)
            options = {"validate": "custom", "value": f"={cell}>=0", "error_type": "warning"}
            options |= {"error_title": heading, "error_message": "A standard deviation is not negative."}
        if options is not None:
            self._sheet.data_validation(first, column, _LAST_CHECKED, column, options)


def _saved(value: CellValue) -> Any:
    from xlmc.errors import ErrorCode

    if isinstance(value, ErrorCode):
        return value.text
    return "" if value is None else value
