"""Put other cached values into formula cells of a sheet, and leave every other byte as it is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Final

from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.workbook.injection.cell_edit import saved_value, with_contents
from xlmc.excel.workbook.injection.splice import Element, SplicedXml, render
from xlmc.excel.workbook.workbook import CellValue

__all__ = ["with_values", "without_formula_values"]

_FUNCTION: Final = re.compile(rb"(?:Risk\w+|CB\.\w+)\s*\(", re.IGNORECASE)
_FORMULA_CELL: Final = re.compile(
    rb"(?P<cell><(?:\w+:)?c\b[^>]*>)"
    rb"(?P<formula><(?:\w+:)?f\b(?:[^>]*/>|[^>]*>[^<]*</(?:\w+:)?f>))"
    rb"(?:<(?:\w+:)?v\b(?:[^>]*/>|[^>]*>[^<]*</(?:\w+:)?v>))?"
)
_DATA_TABLE: Final = re.compile(rb"""<(?:\w+:)?f\b[^>]*\bt\s*=\s*["']dataTable["'][^>]*>""")
_REFERENCE: Final = re.compile(rb"""\bref\s*=\s*(["'])(.*?)\1""")
_VALUE_CELL: Final = re.compile(
    rb"""(?P<cell><(?:\w+:)?c\b[^>]*?\br\s*=\s*["'](?P<position>[A-Z]{1,3}[1-9][0-9]*)["'][^>]*>)"""
    rb"(?:<(?:\w+:)?v\b(?:[^>]*/>|[^>]*>[^<]*</(?:\w+:)?v>))"
)
_TYPE: Final = re.compile(rb"""\s+t\s*=\s*(?:"[^"]*"|'[^']*')""")


def with_values(
    xml: bytes,
    part: str,
    values: Mapping[tuple[int, int], CellValue],
    without: Collection[tuple[int, int]] = (),
    *,
    complete: bool = False,
) -> bytes:
    """Return a sheet's part with these values cached in cells that are there.

    Args:
        xml: the part.
        part: its name, for messages.
        values: by row and column, from 1.
        without: the cells that are to have no value.
        complete: add the cells that are not there, which an array formula fills.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    missing = dict(values)
    for position, cell in _cells(document.root):
        if position in values:
            _put(document, cell, missing.pop(position))
        elif position in without:
            _clear(document, cell)
    return with_contents(document.result(), part, part, missing) if missing and complete else document.result()


def without_formula_values(parts: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the parts, without the cached values of formulas where a run may write others.

    These are workbooks whose cells or names call a function of @RISK or Crystal Ball, or that hold a what-if data
    table. A run may fill in results, and all that is computed from them, or #N/A where it cannot; what Excel itself
    cached there was one random draw, or is what it last calculated.
    """
    xmls = {name: xml for name, xml in parts.items() if name.casefold().endswith(".xml")}
    sheets = {name: xml for name, xml in xmls.items() if b"sheetData" in xml}
    callers = [*sheets.values(), *(xml for xml in xmls.values() if b"definedNames" in xml)]
    if not any(_FUNCTION.search(xml) or _DATA_TABLE.search(xml) for xml in callers):
        return dict(parts)
    return {**parts, **{name: _without_tables(_FORMULA_CELL.sub(_bare, xml)) for name, xml in sheets.items()}}


def _without_tables(xml: bytes) -> bytes:
    """Return a sheet without the values of its data tables, whose cells hold no formulas but for the first."""
    areas = [
        area
        for result in _DATA_TABLE.finditer(xml)
        if (reference := _REFERENCE.search(result[0])) and (area := _area(reference[2].decode()))
    ]
    if not areas:
        return xml

    def bare(match: re.Match[bytes]) -> bytes:
        cell = parse_address(match["position"].decode(), "-")
        inside = isinstance(cell, Cell) and any(cell in area for area in areas)
        return _TYPE.sub(b"", match["cell"]) if inside else match[0]

    return _VALUE_CELL.sub(bare, xml)


def _area(text: str) -> Area | None:
    try:
        cell = parse_address(text, "-")
    except ValueError:
        return None
    return Area("-", cell.row, cell.column, cell.row, cell.column) if isinstance(cell, Cell) else cell


def _bare(match: re.Match[bytes]) -> bytes:
    return _TYPE.sub(b"", match["cell"]) + match["formula"]


def _cells(root: Element) -> Iterator[tuple[tuple[int, int], Element]]:
    """Every cell with its position; rows and cells that name none follow the one before."""
    data = root.find("sheetData")
    row_number = 0
    for row in data.find_all("row") if data is not None else ():
        row_number = int(row.attributes.get("r", row_number + 1))
        column = 0
        for cell in row.find_all("c"):
            name = cell.attributes.get("r")
            column = column + 1 if name is None else parse_address(name, "-").column  # type: ignore[union-attr]
            yield (row_number, column), cell


def _put(document: SplicedXml, cell: Element, value: CellValue) -> None:
    kind, text = saved_value(value)
    if cell.attributes.get("t", "n") != kind:
        document.set(cell, "t", kind)
    old = cell.find("v")
    new = render(document.prefix(cell) + "v", {}, text)
    if old is not None:
        document.before(old, new)
        document.remove(old)
        return
    formula = cell.find("f")
    if formula is not None:
        document.after(formula, new)
    else:
        document.append(cell, new)


def _clear(document: SplicedXml, cell: Element) -> None:
    old = cell.find("v")
    if old is not None:
        document.remove(old)
    if cell.attributes.get("t", "n") != "n":
        document.set(cell, "t", "n")
