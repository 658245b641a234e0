"""What xlmc knows of a workbook: cells with formulas and cached values, names, tables. No file is touched here."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from xlmc.errors import ErrorCode, Notice
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.iteration import Iteration

if TYPE_CHECKING:
    from xlmc.excel.own_functions import OwnFunctions

__all__ = [
    "CellContent",
    "CellValue",
    "DataTable",
    "DefinedName",
    "Formula",
    "LinkedBook",
    "PivotField",
    "PivotTable",
    "Place",
    "Sheet",
    "Table",
    "Workbook",
]

CellValue = float | bool | str | ErrorCode | None
"""A number, a logical, a text, an error or nothing, as a cell holds it."""


@dataclass(frozen=True, slots=True)
class Formula:
    """A cell's formula as the file holds it.

    Attributes:
        text: the formula without its leading `=`.
        row, column: the cell `text` is written for. A shared formula's children carry their master's text and position,
            and mean it shifted to themselves.
        array: the area an array formula (`t="array"`) fills; None for a plain formula.
        dynamic: a dynamic-array formula (`cm` names the XLDAPR metadata): it spills.
    """

    text: str
    row: int
    column: int
    array: Area | None = None
    dynamic: bool = False


@dataclass(frozen=True, slots=True)
class CellContent:
    """One cell: its value (typed in, or as Excel cached it) and its formula, if any."""

    value: CellValue = None
    formula: Formula | None = None

    @property
    def is_blank(self) -> bool:
        """Whether the cell looks empty: no value and no formula, or a text of blanks."""
        if isinstance(self.value, str):
            return not self.value.strip()
        return self.value is None and self.formula is None

    @property
    def is_uncalculated(self) -> bool:
        """Whether the cell has a formula of its own, and the file does not say what it gives."""
        return self.formula is not None and self.formula.array is None and self.value is None


@dataclass(frozen=True, slots=True)
class Sheet:
    """One worksheet. `cells` holds only what the file holds; everything else is blank.

    Attributes:
        hidden_rows: hidden by hand or by a filter; the file marks both alike.
        filtered: the rows, with the heading, of each filter that leaves rows out.
        data_tables: Excel's what-if tables on it.
    """

    name: str
    part: str
    cells: Mapping[tuple[int, int], CellContent]
    merged: tuple[Area, ...] = ()
    visible: bool = True
    hidden_rows: frozenset[int] = frozenset()
    filtered: tuple[Area, ...] = ()
    data_tables: tuple[DataTable, ...] = ()

    @property
    def arrays(self) -> dict[Cell, Area]:
        """The cell of each array formula -> the area that it fills."""
        formulas = ((at, content.formula) for at, content in self.cells.items() if content.formula is not None)
        return {Cell(self.name, *at): formula.array for at, formula in formulas if formula.array is not None}


@dataclass(frozen=True, slots=True)
class DefinedName:
    """A defined name. `sheet` is None for the whole workbook; `text` is what it stands for, without `=`."""

    name: str
    text: str
    sheet: str | None = None


@dataclass(frozen=True, slots=True)
class LinkedBook:
    """What Excel stored of another workbook when it last read it.

    Attributes:
        file: its name, without a folder.
        sheets: with the cells that were read, under their names as formulas write them: `[1]Prices`.
        names: with what they stand for in that workbook; `sheet` is such a name, too.
        broken: the names of sheets that Excel could not read again: their cells are `#REF!`.
    """

    file: str
    sheets: Mapping[str, Sheet]
    names: tuple[DefinedName, ...] = ()
    broken: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Table:
    """An Excel table. `area` includes header and totals rows, `filtered` is that of a filter that leaves rows out."""

    name: str
    area: Area
    columns: tuple[str, ...]
    header_rows: int = 1
    totals_rows: int = 0
    filtered: Area | None = None

    @property
    def body(self) -> Area:
        """The data rows."""
        a = self.area
        return Area(a.sheet, a.top + self.header_rows, a.left, a.bottom - self.totals_rows, a.right)


@dataclass(frozen=True, slots=True)
class DataTable:
    """A what-if data table, `{=TABLE(A1,B1)}`: an area that Excel fills by putting values into its input cells.

    Attributes:
        area: the cells that it fills; no formula of their own stands in them.
        inputs: the cells that it puts values into; none of one that was deleted. Of two the first takes the values of
            the row above.
        two_inputs: one value from the row above and one from the column on the left, for the formula in the corner.
        by_row: of one input, whether its values stand in the row above, and the formulas in the column on the left.
    """

    area: Area
    inputs: tuple[Cell, ...] = ()
    two_inputs: bool = False
    by_row: bool = False

    def formula_of(self, cell: Cell) -> Cell:
        """Return the cell with the formula that is computed for a cell of the table."""
        above, left = self.area.top - 1, self.area.left - 1
        if self.two_inputs:
            return Cell(cell.sheet, above, left)
        return Cell(cell.sheet, cell.row, left) if self.by_row else Cell(cell.sheet, above, cell.column)

    def values_of(self, cell: Cell) -> tuple[Cell, ...]:
        """Return the cells whose values are put into the inputs for a cell of the table."""
        above, left = (
            Cell(cell.sheet, self.area.top - 1, cell.column),
            Cell(cell.sheet, cell.row, self.area.left - 1),
        )
        if self.two_inputs:
            return above, left
        return (above,) if self.by_row else (left,)

    def margins(self) -> Iterator[Cell]:
        """Yield the cells above it and on its left: the formulas it computes, and the values that it puts in."""
        above, left = self.area.top - 1, self.area.left - 1
        if self.two_inputs and above and left:
            yield Cell(self.area.sheet, above, left)
        for column in range(self.area.left, self.area.right + 1) if above else ():
            yield Cell(self.area.sheet, above, column)
        for row in range(self.area.top, self.area.bottom + 1) if left else ():
            yield Cell(self.area.sheet, row, left)


@dataclass(frozen=True, slots=True)
class Place:
    """What a row or column of a pivot table shows.

    Attributes:
        items: (field, item), both counted from 0; what no pair names is added up.
        data: which of several data fields, from 0; None if the other axis says that, or there is one.
    """

    items: frozenset[tuple[int, int]]
    data: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class PivotField:
    """A field: its names, as shown and as in the source, and its items; `grouped` where these are parts of dates."""

    names: tuple[str, ...]
    items: tuple[tuple[int, CellValue], ...] = ()
    grouped: bool = False


@dataclass(frozen=True, eq=False)
class PivotTable:
    """A pivot table as it was last refreshed.

    Attributes:
        area: all its cells, those of report filters among them.
        origin: the first cell with a value.
        fields: of its source, in order.
        data: the names of each data field, as shown and as in the source.
        rows, columns: what the rows from the origin down, and the columns to the right, show; None for a blank one.
        filters: field of a report filter -> its item; None if all are shown, or several.
        source: the cells that it is made from, as text for `INDIRECT`; None if these are not in the workbook.
    """

    area: Area
    origin: Cell
    fields: tuple[PivotField, ...]
    data: tuple[tuple[str, ...], ...]
    rows: tuple[Place | None, ...]
    columns: tuple[Place | None, ...]
    filters: Mapping[int, int | None]
    source: str | None

    @cached_property
    def cells(self) -> Mapping[tuple[int, frozenset[tuple[int, int]]], tuple[Cell, ...]]:
        """Data field and the items that are shown -> where; a total may stand above its items, or below."""
        result: dict[tuple[int, frozenset[tuple[int, int]]], tuple[Cell, ...]] = {}
        for down, row in enumerate(self.rows):
            for right, column in enumerate(self.columns):
                if row is not None and column is not None:
                    data = next((place.data for place in (row, column) if place.data is not None), 0)
                    cell = Cell(self.origin.sheet, self.origin.row + down, self.origin.column + right)
                    key = data, row.items | column.items
                    result[key] = (*result.get(key, ()), cell)
        return result

    @cached_property
    def _by_item(self) -> Mapping[tuple[int, int], list[tuple[int, frozenset[tuple[int, int]]]]]:
        result: dict[tuple[int, int], list[tuple[int, frozenset[tuple[int, int]]]]] = {}
        for key in self.cells:
            for pair in key[1]:
                result.setdefault(pair, []).append(key)
        return result

    def cells_with(self, data: int, items: frozenset[tuple[int, int]]) -> Iterator[tuple[Cell, ...]]:
        """Return the cells that show these items of a data field, and items of other fields."""
        among = min((self._by_item.get(pair, []) for pair in items), key=len, default=list(self.cells))
        yield from (self.cells[key] for key in among if key[0] == data and items < key[1])


@dataclass(frozen=True)
class Workbook:
    """A workbook as read: nothing evaluated, nothing changed.

    Attributes:
        sheets: worksheets in tab order, by name as written.
        data_tables: the what-if tables of all sheets.
        pivots: the pivot tables, where a formula asks for one.
        links: to other workbooks, as formulas write them (`[1]`), with the values that Excel stored.
        saved_by: the program that saved it last, `Excel`; empty where the file does not say.
        libreoffice: last saved by LibreOffice, which saves TRUE and FALSE as 1 and 0.
        macintosh: last saved by Excel for the Macintosh, whose CHAR and CODE use its own character set.
        iteration: how cells that need each other in a circle are computed; None if they are an error.
        may_be_stale: saved values may be older than the formulas: calculation is manual, or Excel has yet to do it.
        category: the category in its properties; empty if there is none.
        parts: every part of the zip package in its order, name -> bytes, as in the file.
        origin: the parts of the file that it was read from, where values have been typed since and it has no `parts`.
        sha256: of the file.
        data: the file itself, byte for byte; otherwise empty.
        functions: what its formulas call beside Excel's functions; None for nothing.
        typed: the cells that hold something else than the file: what is saved for formulas that need them is of another
            state of the workbook.
    """

    name: str
    sheets: Mapping[str, Sheet]
    names: tuple[DefinedName, ...] = ()
    tables: tuple[Table, ...] = ()
    data_tables: tuple[DataTable, ...] = ()
    pivots: tuple[PivotTable, ...] = ()
    links: Mapping[str, LinkedBook] = field(default_factory=dict)
    date1904: bool = False
    saved_by: str = ""
    libreoffice: bool = False
    macintosh: bool = False
    iteration: Iteration | None = None
    may_be_stale: bool = False
    category: str = ""
    notices: tuple[Notice, ...] = ()
    parts: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    origin: Mapping[str, bytes] = field(default_factory=dict, repr=False)
    sha256: str = ""
    data: bytes = field(default=b"", repr=False)
    functions: OwnFunctions | None = None
    typed: frozenset[Cell] = frozenset()

    def __getitem__(self, place: str) -> CellValue:
        """Return the value that is saved in a cell: a number, True or False, a text, an error, None if it is blank.

        Dates are serial numbers, as Excel counts them. A formula's value is the one that Excel saved; None if the
        program that wrote the file saved none: `xlmc.engine.calculate` computes it.

        Args:
            place: `Sheet!B4`, `'My sheet'!$B$4`, or a defined name that stands for one cell.

        Raises:
            KeyError: there is no such sheet or name, or it is not one cell.
        """
        name = self.defined_name(place.strip())
        try:
            cell = parse_address(place if name is None else name.text)
        except ValueError as error:
            hint = "write Sheet!Cell, or a defined name that stands for one cell"
            raise KeyError(f"{place!r} is no cell of {self.name}: {hint}") from error
        if isinstance(cell, Area):
            raise KeyError(f"{place!r} is not one cell, but {cell}")
        sheet = self.sheet_named(cell.sheet)
        if sheet is None:
            raise KeyError(f"there is no sheet {cell.sheet!r} in {self.name}; there are {', '.join(self.sheets)}")
        return self.content(cell._replace(sheet=sheet.name)).value

    @cached_property
    def _folded(self) -> dict[str, str]:
        return {name.casefold(): name for name in self.sheets}

    @cached_property
    def _cells(self) -> dict[str, Mapping[tuple[int, int], CellContent]]:
        return {}

    @cached_property
    def _tables(self) -> dict[str, Table]:
        return {table.name.casefold(): table for table in self.tables}

    @cached_property
    def _names(self) -> dict[tuple[str | None, str], DefinedName]:
        return {(n.sheet and n.sheet.casefold(), n.name.casefold()): n for n in self.names}

    def sheet_named(self, name: str) -> Sheet | None:
        """Return the sheet of that name, whatever its case."""
        text = self._folded.get(name.casefold())
        return None if text is None else self.sheets[text]

    def filtered_rows(self, sheet: Sheet) -> frozenset[int]:
        """Return the hidden rows of a sheet where a filter of it, or of a table on it, leaves rows out; else none.

        Excel takes all of them for filtered then, also those outside the filter's range.
        """
        of_tables = any(table.filtered is not None and table.filtered.sheet == sheet.name for table in self.tables)
        return sheet.hidden_rows if sheet.filtered or of_tables else frozenset()

    def table_named(self, name: str) -> Table | None:
        """Return the table of that name, whatever its case."""
        return self._tables.get(name.casefold())

    def defined_name(self, name: str, sheet: str | None = None) -> DefinedName | None:
        """Return the name as `sheet` sees it: its own first, then the workbook's."""
        if sheet is not None:
            local = self._names.get((sheet.casefold(), name.casefold()))
            if local is not None:
                return local
        return self._names.get((None, name.casefold()))

    def formula_cells(self) -> Iterator[Cell]:
        """Yield the cells that hold a formula, sheet by sheet."""
        for sheet in self.sheets.values():
            yield from (Cell(sheet.name, *at) for at, content in sheet.cells.items() if content.formula is not None)

    def sheet_of(self, cell: Cell | Area) -> Sheet | None:
        """Return the sheet that a resolved cell or area stands on, one of a linked workbook among them."""
        sheet = self.sheets.get(cell.sheet)
        if sheet is None and cell.sheet.startswith("["):
            book = cell.sheet[: cell.sheet.find("]") + 1]
            sheet = self.links[book].sheets.get(cell.sheet) if book in self.links else None
        return sheet

    def content(self, cell: Cell) -> CellContent:
        """Return what the cell holds; blank where the file holds nothing or has no such sheet."""
        cells = self._cells.get(cell.sheet)
        if cells is None:
            sheet = self.sheet_of(cell)
            self._cells[cell.sheet] = cells = {} if sheet is None else sheet.cells
        return cells.get(cell[1:], _BLANK)


_BLANK = CellContent()
