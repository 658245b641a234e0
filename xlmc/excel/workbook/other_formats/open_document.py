"""The cells of an OpenDocument spreadsheet (`.ods`): their numbers, to the last digit, and how it is calculated.

Source: OpenDocument 1.3, part 3: tables with rows and cells that may be repeated, values as `office:value`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.formats import ODS
from xlmc.excel.workbook.other_formats.old_workbook import OldBook, OldSheet
from xlmc.excel.workbook.safe_xml import tree, whole_number

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["read_open_document"]

_CONTENT: Final = "content.xml"
_TABLE: Final = "{urn:oasis:names:tc:opendocument:xmlns:table:1.0}"
_OFFICE: Final = "{urn:oasis:names:tc:opendocument:xmlns:office:1.0}"
_GROUPS: Final = ("table-row-group", "table-header-rows", "table-rows")
_NUMBERS: Final = ("float", "percentage", "currency")
_MOST_REPEATED: Final = 2_000_000
"""Cells with a number that repeated rows and columns may stand for."""


def read_open_document(parts: Mapping[str, bytes]) -> OldBook:
    """Read the content of the parts.

    Raises:
        WorkbookError: it is encrypted, damaged, or no spreadsheet.
    """
    if b":encryption-data" in parts.get("META-INF/manifest.xml", b""):
        hint = "Remove its password in LibreOffice (File > Save As, without 'Save with password') and save it"
        raise WorkbookError("the workbook is encrypted", hint=hint)
    if _CONTENT not in parts:
        raise _damaged(f"it lacks its part {_CONTENT}")
    content = tree(parts[_CONTENT], _CONTENT).find(f"{_OFFICE}body/{_OFFICE}spreadsheet")
    if content is None:
        raise _damaged("it holds no spreadsheet")
    settings = content.find(f"{_TABLE}calculation-settings")
    as_displayed = settings is not None and settings.get(f"{_TABLE}precision-as-shown") == "true"
    macros = any(name.startswith("Basic/") and not name.endswith(("script-lc.xml", "script-lb.xml")) for name in parts)
    manual = b'"AutoCalculate" config:type="boolean">false<' in parts.get("settings.xml", b"")
    sheets = tuple(_sheet(table) for table in content.findall(f"{_TABLE}table"))
    return OldBook(sheets, macros, as_displayed, manual, tells_logicals=False)


def _sheet(table: Element) -> OldSheet:
    sheet, row, many = OldSheet(table.get(f"{_TABLE}name", "")), 1, 0
    for element in _rows(table):
        rows = _count(element, "number-rows-repeated")
        column = 1
        for cell in element:
            if cell.tag not in (f"{_TABLE}table-cell", f"{_TABLE}covered-table-cell"):
                continue
            columns = _count(cell, "number-columns-repeated")
            value = _value(cell)
            if value is not None:
                many += rows * columns
                if many > _MOST_REPEATED:
                    raise _damaged(f"the repeated cells of the sheet {sheet.name!r} are too many")
                _put(
                    sheet,
                    cell,
                    value,
                    [(r, c) for r in range(row, row + rows) for c in range(column, column + columns)],
                )
            column += columns
        row += rows
    return sheet


def _rows(table: Element) -> Iterator[Element]:
    """Return the rows in their order, also those in groups."""
    for each in table:
        if each.tag == f"{_TABLE}table-row":
            yield each
        elif each.tag in {f"{_TABLE}{name}" for name in _GROUPS}:
            yield from _rows(each)


def _count(element: Element, name: str) -> int:
    return max(whole_number(element.get(f"{_TABLE}{name}", "1")) or 1, 1)


def _value(cell: Element) -> float | bool | None:
    """Return the number or logical in a cell; otherwise None, as for a date, whose serial number it does not hold."""
    kind = cell.get(f"{_OFFICE}value-type")
    if kind == "boolean":
        return cell.get(f"{_OFFICE}boolean-value") == "true"
    if kind not in _NUMBERS:
        return None
    try:
        value = float(cell.get(f"{_OFFICE}value", ""))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _put(sheet: OldSheet, cell: Element, value: float | bool, places: list[tuple[int, int]]) -> None:
    if cell.get(f"{_TABLE}formula") is None:
        if not isinstance(value, bool):
            sheet.numbers.update(dict.fromkeys(places, value))
        return
    sheet.results.update(dict.fromkeys(places, value))
    down, across = _count(cell, "number-matrix-rows-spanned"), _count(cell, "number-matrix-columns-spanned")
    for row, column in places if down > 1 or across > 1 else ():
        sheet.areas.append((row, column, row + down - 1, column + across - 1))


def _damaged(reason: str) -> WorkbookError:
    return WorkbookError(f"the file is {ODS.noun}, and it is damaged: {reason}", hint=ODS.hint)
