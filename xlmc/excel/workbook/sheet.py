"""One worksheet's XML to its cells, merged areas and data tables, in one pass; and what a cell's text stands for."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, column_letters, column_number
from xlmc.excel.workbook.safe_xml import REPAIR, decode, expat_parser, feed, is_true, run_text, whole_number
from xlmc.excel.workbook.structure import SheetEntry, area_of
from xlmc.excel.workbook.workbook import CellContent, CellValue, DataTable, Formula, Sheet

__all__ = ["CellContext", "convert", "parse_sheet"]

_NAMESPACES = (
    "http://schemas.openxmlformats.org/spreadsheetml/2006/main",
    "http://purl.oclc.org/ooxml/spreadsheetml/main",  # strict
)
_CONDITIONS = ("filters", "customFilters", "dynamicFilter", "top10", "colorFilter", "iconFilter")
"""What a column of a filter holds that leaves rows out."""
_SPACE = "http://www.w3.org/XML/1998/namespace space"
_ROW = re.compile("[1-9][0-9]{0,6}")
_A1 = re.compile("([A-Z]{1,3})([1-9][0-9]{0,6})")

_NUMBER = re.compile(r"[ \t\r\n]*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?[ \t\r\n]*")
"""A number as XML Schema writes it: Python's `1_5`, digits of other scripts and no-break spaces are none."""

_LOGICAL = {"1": True, "0": False, "true": True, "false": False}

_Attributes = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class CellContext:
    """What the cells of a sheet need from the rest of the workbook.

    Attributes:
        strings: the shared string table.
        dynamic_marks: the values of `cm` that mark a dynamic-array formula.
        date1904: dates count from 1904 instead of 1900.
        placeholders: what is saved beside formulas only stands for values that were never calculated.
    """

    strings: Sequence[str] = ()
    dynamic_marks: frozenset[str] = frozenset()
    date1904: bool = False
    placeholders: bool = False


def parse_sheet(xml: bytes, entry: SheetEntry, context: CellContext) -> Sheet:
    """Read the worksheet of one tab.

    Raises:
        WorkbookError: the part is not XML, or is a worksheet in a foreign namespace, whose cells would all be blank;
            or a cell holds what no cell can; the message names it.
    """
    reading = _Pass(entry.name, context)
    parser = expat_parser()

    def start_part(tag: str, attributes: _Attributes) -> None:
        parser.StartElementHandler = reading.start
        reading.start_part(tag, attributes)

    parser.StartElementHandler = start_part
    parser.EndElementHandler = reading.end
    parser.CharacterDataHandler = reading.text.append
    feed(parser, xml, entry.part)
    return Sheet(
        *(entry.name, entry.part, reading.cells, tuple(reading.merged), entry.visible),
        frozenset(reading.hidden_rows),
        tuple(reading.filtered),
        tuple(reading.data_tables),
    )


_WHOLE = re.compile(r"(?:([A-Z]{1,3}):([A-Z]{1,3})|([1-9][0-9]{0,6}):([1-9][0-9]{0,6}))")
"""Whole columns, `A:B`, or whole rows, `1:3`, which Excel writes where all of them are merged."""


def _with_ends(whole: re.Match[str]) -> str:
    if whole[0] != whole.string:
        return whole[0]
    left, right, top, bottom = whole.groups()
    return f"{left}1:{right}{MAX_ROW}" if left else f"A{top}:{column_letters(MAX_COLUMN)}{bottom}"


class _Pass:
    """The state of a pass over the sheet: the place, the cell, and what was found."""

    def __init__(self, sheet: str, context: CellContext) -> None:
        self.cells: dict[tuple[int, int], CellContent] = {}
        self.merged: list[Area] = []
        self.data_tables: list[DataTable] = []
        self.hidden_rows: set[int] = set()
        self.filtered: list[Area] = []
        self.text: list[str] = []  # pieces of the text at hand
        self._sheet = sheet
        self._context = context
        self._row = self._column = 0
        self._cell: _Attributes = {}
        self._raw: str | None = None
        self._formula: Formula | None = None
        self._attributes: _Attributes = {}  # of the element last opened; `v`, `f` and `t` hold no others
        self._masters: dict[str | None, Formula] = {}
        self._runs: list[str] = []
        self._phonetic = False
        self._filter: str | None = None
        self._has_condition = False

    def start_part(self, tag: str, attributes: _Attributes) -> None:
        namespace, _, local = tag.rpartition(" ")
        if local == "worksheet" and namespace not in _NAMESPACES:
            what = f"in the XML namespace {namespace!r}" if namespace else "in no XML namespace"
            raise WorkbookError(f"the sheet {self._sheet!r} is {what}, and worksheets are not", hint=REPAIR)
        self.start(tag, attributes)

    def start(self, tag: str, attributes: _Attributes) -> None:
        self._attributes = attributes
        self.text.clear()
        handle = _STARTS.get(tag)
        if handle is not None:
            handle(self)

    def end(self, tag: str) -> None:
        handle = _ENDS.get(tag)
        if handle is not None:
            handle(self)

    def start_row(self) -> None:
        self._column = 0
        number = self._attributes.get("r")
        if number is None:
            self._row += 1
        elif _ROW.fullmatch(number):
            self._row = int(number)
        else:
            raise WorkbookError(f"a row of sheet {self._sheet!r} has the number {number!r}", hint=REPAIR)
        if is_true(self._attributes.get("hidden", "0")):
            self.hidden_rows.add(self._row)

    def start_cell(self) -> None:
        self._cell = self._attributes
        self._raw = self._formula = None
        reference = self._cell.get("r")
        if reference is None:
            self._column += 1
        else:
            self._go_to(reference)
        if not (0 < self._row <= MAX_ROW and self._column <= MAX_COLUMN):
            raise WorkbookError(f"a cell of sheet {self._sheet!r} lies outside the sheet", hint=REPAIR)

    def end_cell(self) -> None:
        position = (self._row, self._column)
        if self._raw is None and self._formula is None:
            return  # a blank cell with a style
        if position in self.cells:
            raise self._faulty("stands in the file twice")
        value: CellValue = None
        if self._raw is not None and not (self._formula is not None and self._context.placeholders):
            try:
                value = convert(self._cell.get("t", "n"), self._raw, self._context)
            except ValueError as error:
                raise self._faulty(str(error)) from None
        self.cells[position] = CellContent(value, self._formula)

    def end_value(self) -> None:
        if self._cell.get("t") != "inlineStr":  # whose text stands in `is`; other readers ignore a value, too
            self._raw = "".join(self.text)

    def end_run(self) -> None:
        if not self._phonetic:
            keep_space = self._attributes.get(_SPACE) == "preserve"
            self._runs.append(run_text("".join(self.text), keep_space))

    def end_inline(self) -> None:
        self._raw = "".join(self._runs)
        self._runs.clear()

    def start_phonetic(self) -> None:
        self._phonetic = True

    def end_phonetic(self) -> None:
        self._phonetic = False

    def end_formula(self) -> None:
        kind = self._attributes.get("t", "normal")
        text = decode("".join(self.text)).removeprefix("=")
        if kind == "dataTable":
            self.data_tables.append(self._data_table())
        elif kind == "shared":
            self._formula = self._shared(text)
        elif text:
            self._formula = self._array(text) if kind == "array" else Formula(text, self._row, self._column)

    def start_merged(self) -> None:
        reference = _WHOLE.sub(_with_ends, self._attributes.get("ref", ""))
        self.merged.append(area_of(reference, self._sheet, "a merged cell"))

    def start_filter(self) -> None:
        self._filter, self._has_condition = self._attributes.get("ref"), False

    def start_condition(self) -> None:
        self._has_condition = True

    def end_filter(self) -> None:
        if self._has_condition:
            self.filtered.append(area_of(self._filter, self._sheet, "a filter"))
        self._has_condition = False

    def _go_to(self, reference: str) -> None:
        match = _A1.fullmatch(reference)
        if match is None:
            raise WorkbookError(f"a cell of sheet {self._sheet!r} has the address {reference!r}", hint=REPAIR)
        self._column = column_number(match[1])
        self._row = int(match[2])

    def _shared(self, text: str) -> Formula:
        """Note a master's text and the area it is shared over; a child's own text, if any, does not count."""
        index = self._attributes.get("si")
        if text and ("ref" in self._attributes or index not in self._masters):
            self._masters[index] = Formula(text, self._row, self._column)
        if index not in self._masters:
            which = "a formula without a number" if index is None else f"formula {index}"
            raise self._faulty(f"shares {which}, which no earlier cell holds")
        return self._masters[index]

    def _data_table(self) -> DataTable:
        result = self._attributes
        existing = (key for key, deleted in (("r1", "del1"), ("r2", "del2")) if not is_true(result.get(deleted, "0")))
        inputs = (result[key] for key in existing if key in result)
        cells = [area_of(each, self._sheet, "an input of a data table") for each in inputs]
        return DataTable(
            area_of(result.get("ref"), self._sheet, "a data table"),
            tuple(Cell(area.sheet, area.top, area.left) for area in cells),
            two_inputs=is_true(result.get("dt2D", "0")),
            by_row=is_true(result.get("dtr", "0")),
        )

    def _array(self, text: str) -> Formula:
        area = area_of(self._attributes.get("ref"), self._sheet, "an array formula")
        dynamic = self._cell.get("cm") in self._context.dynamic_marks
        return Formula(text, self._row, self._column, area, dynamic)

    def _faulty(self, what: str) -> WorkbookError:
        return WorkbookError(f"the cell {what}", where=Cell(self._sheet, self._row, self._column), hint=REPAIR)


def _in_each_namespace(handlers: Mapping[str, Callable[[_Pass], None]]) -> dict[str, Callable[[_Pass], None]]:
    return {f"{space} {local}": handle for space in _NAMESPACES for local, handle in handlers.items()}


_STARTS = _in_each_namespace(
    {
        "row": _Pass.start_row,
        "c": _Pass.start_cell,
        "rPh": _Pass.start_phonetic,
        "mergeCell": _Pass.start_merged,
        "autoFilter": _Pass.start_filter,
        **dict.fromkeys(_CONDITIONS, _Pass.start_condition),
    }
)
_ENDS = _in_each_namespace(
    {
        "c": _Pass.end_cell,
        "v": _Pass.end_value,
        "f": _Pass.end_formula,
        "t": _Pass.end_run,
        "is": _Pass.end_inline,
        "rPh": _Pass.end_phonetic,
        "autoFilter": _Pass.end_filter,
    }
)


def convert(kind: str, raw: str, context: CellContext) -> CellValue:
    """Return the value that `raw` stands for in a cell of type `kind` (the attribute `t`).

    Raises:
        ValueError: `raw` is no value of that type, or there is no such type.
    """
    converter = _CONVERTERS.get(kind)
    if converter is None:
        raise ValueError(f"is of the unknown type {kind!r}")
    return converter(raw, context)


def _number(raw: str, _: CellContext) -> CellValue:
    if not raw:
        return None
    value = float(raw) if _NUMBER.fullmatch(raw) else float("nan")
    if not isfinite(value):
        raise ValueError(f"holds {raw!r} where a number should be")
    return value


def _logical(raw: str, _: CellContext) -> CellValue:
    if raw not in _LOGICAL:
        raise ValueError(f"holds {raw!r} where TRUE (1) or FALSE (0) should be")
    return _LOGICAL[raw]


def _error(raw: str, _: CellContext) -> CellValue:
    # Excel has error values without a number of their own (#FIELD!, #BUSY!, #PYTHON!): for a model all are #VALUE!.
    try:
        return ErrorCode.from_text(raw)
    except ValueError:
        return ErrorCode.VALUE


def _shared(raw: str, context: CellContext) -> CellValue:
    if not raw:
        return None
    number = whole_number(raw)
    if number is None or number >= len(context.strings):
        raise ValueError(f"holds a text that the workbook does not (number {raw!r} of {len(context.strings)})")
    return context.strings[number]


def _date(raw: str, context: CellContext) -> CellValue:
    from openpyxl.utils.datetime import MAC_EPOCH, WINDOWS_EPOCH, from_ISO8601, to_excel  # slow to import

    try:
        return float(to_excel(from_ISO8601(raw), MAC_EPOCH if context.date1904 else WINDOWS_EPOCH))
    except (ValueError, TypeError, OverflowError):
        raise ValueError(f"holds {raw!r} where a date should be") from None


def _text(raw: str, _: CellContext) -> CellValue:
    return decode(raw)


def _inline(raw: str, _: CellContext) -> CellValue:
    return raw  # its runs were decoded one by one


_CONVERTERS: dict[str, Callable[[str, CellContext], CellValue]] = {
    "n": _number,
    "b": _logical,
    "e": _error,
    "s": _shared,
    "str": _text,
    "inlineStr": _inline,
    "d": _date,
}
