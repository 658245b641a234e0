"""Pivot tables: which cell of a sheet shows which value of which items (ISO/IEC 29500-1, 18.10).

The cells of a pivot table are constants of its sheet: Excel writes them when a person refreshes it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Final

from xlmc.errors import WorkbookError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.package import relationships
from xlmc.excel.workbook.safe_xml import decode, is_true, tree, whole_number
from xlmc.excel.workbook.structure import SheetEntry, area_of
from xlmc.excel.workbook.workbook import CellValue, PivotField, PivotTable, Place

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["pivot_tables"]

_VALUES: Final = -2
"""What stands for the data fields among the fields of an axis."""


def pivot_tables(parts: Mapping[str, bytes], sheets: Sequence[SheetEntry], date1904: bool) -> tuple[PivotTable, ...]:
    """Return the pivot tables of a workbook that are whole, if a formula asks for one."""
    if not any(b"GETPIVOTDATA" in parts.get(part, b"") for part in (*(s.part for s in sheets), "xl/workbook.xml")):
        return ()
    result = (
        _whole(parts, relation.target, sheet.name, date1904)
        for sheet in sheets
        for relation in relationships(parts, sheet.part).values()
        if relation.kind == "pivotTable"
    )
    return tuple(table for table in result if table is not None)


def _whole(parts: Mapping[str, bytes], part: str, sheet: str, date1904: bool) -> PivotTable | None:
    """Return the pivot table; None if its definition is damaged, which is of concern to GETPIVOTDATA alone."""
    try:
        return _Reading(parts, part, sheet, date1904).table()
    except (WorkbookError, IndexError, ValueError):
        return None


class _Reading:
    """The definition of one pivot table and its cache."""

    def __init__(self, parts: Mapping[str, bytes], part: str, sheet: str, date1904: bool) -> None:
        self._sheet, self._date1904 = sheet, date1904
        self._root = self._read(parts, part)
        result = (rel.target for rel in relationships(parts, part).values() if rel.kind == "pivotCacheDefinition")
        self._cache = self._read(parts, next(result, ""))

    def _read(self, parts: Mapping[str, bytes], part: str) -> Element:
        if part not in parts:
            raise ValueError(f"there is no {part!r}")
        return tree(parts[part], part)

    def table(self) -> PivotTable:
        """Read what it says.

        Raises:
            WorkbookError, IndexError, ValueError: it is damaged.
        """
        location = self._root.find("{*}location")
        if location is None:
            raise ValueError("no location")
        area = area_of(location.get("ref"), self._sheet, "pivot table")
        top = area.top + _number(location, "firstDataRow")
        left = area.left + _number(location, "firstDataCol")
        pages = _number(location, "rowPageCount")
        fields = tuple(self._fields())
        data = self._root.findall("{*}dataFields/{*}dataField")
        return PivotTable(
            area=Area(area.sheet, max(1, area.top - pages - bool(pages)), area.left, area.bottom, area.right),
            origin=Cell(self._sheet, top, left),
            fields=fields,
            data=tuple((decode(each.get("name", "")), fields[_number(each, "fld")].names[-1]) for each in data),
            rows=tuple(self._places("row")),
            columns=tuple(self._places("col")),
            filters=dict(self._filters()),
            source=self._source(),
        )

    def _fields(self) -> Iterator[PivotField]:
        own = self._root.findall("{*}pivotFields/{*}pivotField")
        for field, cached in zip(own, self._cache.findall("{*}cacheFields/{*}cacheField"), strict=True):
            groups = cached.find("{*}fieldGroup/{*}groupItems")
            items = cached.find("{*}sharedItems") if groups is None else groups
            values = [self._value(item) for item in (() if items is None else items)]
            named = [decode(name) for name in (field.get("name"), cached.get("name")) if name]
            by_part = cached.find("{*}fieldGroup/{*}rangePr")
            yield PivotField(
                tuple(named),
                tuple(_items(field, values)),
                grouped=by_part is not None and by_part.get("groupBy", "range") not in ("range", "years"),
            )

    def _value(self, item: Element) -> CellValue:
        kind, text = item.tag.rpartition("}")[2], item.get("v", "")
        match kind:
            case "n":
                return float(text)
            case "b":
                return is_true(text)
            case "d":
                return self._serial(text)
            case "m":
                return None
            case _:
                return decode(text)

    def _serial(self, text: str) -> float:
        """Turn a date into a number."""
        first = datetime(1904, 1, 1) if self._date1904 else datetime(1899, 12, 30)
        return (datetime.fromisoformat(text).replace(tzinfo=None) - first).total_seconds() / 86_400

    def _places(self, axis: str) -> Iterator[Place | None]:
        fields = [_number(each, "x") for each in self._root.findall(f"{{*}}{axis}Fields/{{*}}field")]
        before: list[int] = []
        for line in self._root.findall(f"{{*}}{axis}Items/{{*}}i"):
            before = [*before[: _number(line, "r")], *(_number(x, "v") for x in line.findall("{*}x"))]
            kind = line.get("t", "data")
            data = _number(line, "i") if _VALUES in fields else None
            if kind == "grand":
                yield Place(frozenset(), data)
            elif kind in ("data", "default"):
                pairs = ((field, item) for field, item in zip(fields, before, strict=False) if field != _VALUES)
                yield Place(frozenset(pairs), data)
            else:
                yield None

    def _filters(self) -> Iterator[tuple[int, int | None]]:
        for page in self._root.findall("{*}pageFields/{*}pageField"):
            yield _number(page, "fld"), whole_number(page.get("item"))

    def _source(self) -> str | None:
        source = self._cache.find("{*}cacheSource/{*}worksheetSource")
        if source is None or any(key.endswith("}id") for key in source.attrib):
            return None
        reference, name, sheet = source.get("ref"), source.get("name"), source.get("sheet")
        if reference is None or sheet is None:
            return name
        return f"'{decode(sheet).replace(chr(39), chr(39) * 2)}'!{reference}"


def _number(element: Element, key: str) -> int:
    """Return an attribute that is a whole number; 0 where it is left out."""
    return int(element.get(key, "0"))


def _items(field: Element, values: Sequence[CellValue]) -> Iterator[tuple[int, CellValue]]:
    """Return number of an item among the cache's, and what it is; a caption that a person typed instead of that."""
    for item in field.findall("{*}items/{*}item"):
        if item.get("t", "data") != "data":
            continue
        number, caption = _number(item, "x"), item.get("n")
        yield number, values[number] if caption is None else decode(caption)
