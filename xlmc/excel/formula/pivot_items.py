"""What the items of a pivot table's fields may be called in a formula."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from xlmc.excel.formula import ir
from xlmc.excel.functions.number_text import parse_number
from xlmc.excel.workbook.workbook import CellValue, PivotField, PivotTable

__all__ = ["PivotTable", "items_named", "names_of", "position_of"]


def position_of(names: Sequence[Sequence[str]], wanted: str) -> int | None:
    """Which of several has that name, whatever its case; the first kind of name goes before the second."""
    key = wanted.strip().casefold()
    for kind in (0, -1):
        for i, each in enumerate(names):
            if each and each[kind].strip().casefold() == key:
                return i
    return None


def items_named(field: PivotField, asked: CellValue) -> Sequence[int]:
    """Return the items of a field that a value names, counted from 0."""
    return _items_by_name(field).get(_key(asked), ())


@lru_cache(maxsize=1024)
def _items_by_name(field: PivotField) -> Mapping[object, Sequence[int]]:
    """Return what an item may be called -> the items that are."""
    result: dict[object, list[int]] = {}
    for item in range(len(field.items)):
        for name in names_of(field, item):
            result.setdefault(_key(name.value), []).append(item)
    return result


def _key(name: CellValue) -> object:
    """Texts whatever their case; a text that is a number as that."""
    if isinstance(name, float):
        return name
    text = "" if name is None else str(name)
    number = parse_number(text)
    return text.casefold() if number is None else number


def names_of(field: PivotField, item: int) -> Iterator[ir.Text | ir.Number | ir.Logical]:
    """Return what an item may be called."""
    number, value = field.items[item]
    if isinstance(value, bool):
        yield ir.Logical(value=value)
    elif isinstance(value, float):
        yield ir.Number(value)
    elif isinstance(value, str):
        yield ir.Text(value)
        read = float(number) if field.grouped else parse_number(value)
        if read is not None:
            yield ir.Number(read)
    else:
        yield ir.Text("")
        yield ir.Text("(blank)")
