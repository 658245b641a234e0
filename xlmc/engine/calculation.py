"""Every formula of a workbook, computed once from the values that are typed into its cells."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from xlmc.engine.graph.arrays import size_of
from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.errors import Notice
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.formula.graph import downstream
from xlmc.excel.workbook.lazy_sheets import with_contents
from xlmc.excel.workbook.workbook import CellContent, CellValue, Workbook

__all__ = ["calculated"]


def calculated(book: Workbook) -> Workbook:
    """Compute every formula; see `xlmc.engine.calculate`."""
    lowering = _lowered(book)
    faults = dict(_faults(lowering))
    unknown = downstream(lowering.graph.needs, [cell for cell in faults if book.content(cell).value is None])
    contents: dict[Cell, CellContent] = {}
    for cell in lowering.graph.formulas:
        for place, value in _values(lowering, cell, cell in faults):
            contents[place] = replace(book.content(place), value=None if cell in unknown else value)
    notices = [*_notices(book, faults, unknown), *_table_notices(book)]
    return replace(with_contents(book, contents), may_be_stale=False, notices=(*book.notices, *notices))


def _lowered(book: Workbook) -> Lowering:
    """Lower all formulas; nothing varies, so that every node is a constant."""
    resolver, formulas = Resolver(book, strict=False), list(_formulas(book))

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        return Lowering(build_graph(resolver, formulas, frozenset(), more=more, strict=False), {}, {}, strict=False)

    return lower_until_complete(lower)


def _formulas(book: Workbook) -> Iterator[Cell]:
    for sheet in book.sheets.values():
        yield from (Cell(sheet.name, *at) for at, content in sheet.cells.items() if content.formula is not None)


def _faults(lowering: Lowering) -> Iterator[tuple[Cell, str]]:
    """Each formula that has no value of its own, and why."""
    for cell in lowering.graph.formulas:
        formula = lowering.graph.workbook.content(cell).formula
        if cell in lowering.faults:
            yield cell, lowering.faults[cell].message
        elif lowering.value(cell) is None:
            yield cell, "the formula has no one value"
        elif formula is not None and formula.dynamic and formula.array is not None:
            size = size_of(lowering.dag, lowering.array(cell)) or (1, 1)
            if size != (formula.array.rows, formula.array.columns):
                yield cell, "the formula spills into another area than when the file was saved"


def _values(lowering: Lowering, cell: Cell, faulty: bool) -> Iterator[tuple[Cell, CellValue]]:
    """The value of a formula's cell, and of the others that it fills as an array formula."""
    book = lowering.graph.workbook
    formula = book.content(cell).formula
    filled = () if formula is None or formula.array is None else formula.array.cells()
    for place in {cell: None, **dict.fromkeys(filled)}:
        value = None if faulty else lowering.value(cell) if place == cell else lowering.filled(place, cell)
        yield place, book.content(place).value if value is None else value.objects().ravel()[0]


def _notices(book: Workbook, faults: Mapping[Cell, str], unknown: frozenset[Cell]) -> Iterator[Notice]:
    for cell, reason in faults.items():
        saved = "it has no value" if cell in unknown else "the saved value stays"
        yield Notice(f"{reason}; {saved}", cell)
    for cell in sorted(unknown - faults.keys()):
        yield Notice("the formula depends on a cell that could not be computed; it has no value", cell)


def _table_notices(book: Workbook) -> Iterator[Notice]:
    for table in book.data_tables:
        corner = Cell(table.area.sheet, table.area.top, table.area.left)
        yield Notice("what-if tables are not computed; the saved values stay", corner)
