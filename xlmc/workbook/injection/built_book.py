"""Read the workbook that XlsxWriter built: its sheets, the names that belong to them, its styles and texts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from xlmc.workbook.injection.result_sheet import shared_items
from xlmc.workbook.injection.roles import roles
from xlmc.workbook.injection.spans import Element, parse_spans
from xlmc.workbook.package import Relationship, relationships

__all__ = ["BuiltBook", "BuiltSheet", "SheetName", "read_built"]


@dataclass(frozen=True, slots=True)
class SheetName:
    """A defined name of one sheet, such as its print titles; `text` is what it stands for."""

    name: str
    text: str
    hidden: bool = False


@dataclass(frozen=True, slots=True)
class BuiltSheet:
    """A worksheet as built. `type` is the relationship type that leads to it, `state` is None where it is visible."""

    name: str
    part: str
    type: str
    state: str | None
    names: tuple[SheetName, ...]


@dataclass(frozen=True, slots=True)
class BuiltBook:
    """A built workbook. `strings` are the contents of its shared strings, as XML."""

    parts: Mapping[str, bytes]
    sheets: tuple[BuiltSheet, ...]
    styles: bytes
    strings: tuple[bytes, ...]


def read_built(parts: Mapping[str, bytes]) -> BuiltBook:
    """The built workbook of a package.

    Raises:
        ValueError: it has names for the whole workbook, which might be the user's own, or chart sheets, to which no
            name can belong.
    """
    role = roles(parts)
    assert role.styles is not None  # XlsxWriter always writes styles
    pointers = relationships(parts, role.workbook)
    root = parse_spans(parts[role.workbook], role.workbook)
    sheets, names = root.find("sheets"), root.find("definedNames")
    assert sheets is not None
    strings = next((parts[pointer.target] for pointer in pointers.values() if pointer.kind == "sharedStrings"), None)
    return BuiltBook(
        parts=parts,
        sheets=tuple(_sheet(element, place, names, pointers) for place, element in enumerate(sheets.children)),
        styles=parts[role.styles],
        strings=tuple(shared_items(strings)),
    )


def _sheet(element: Element, place: int, names: Element | None, pointers: Mapping[str, Relationship]) -> BuiltSheet:
    name, pointer = element.attributes["name"], pointers[element.foreign("id") or ""]
    if pointer.kind != "worksheet":
        raise ValueError(f"the result sheet {name!r} must be a worksheet")
    state = element.attributes.get("state")
    return BuiltSheet(name, pointer.target, pointer.type, state, tuple(_names_of(names, place)))


def _names_of(names: Element | None, place: int) -> Iterator[SheetName]:
    for element in names.children if names else ():
        attributes = element.attributes
        if "localSheetId" not in attributes:
            raise ValueError(f"the name {attributes['name']!r} must belong to one result sheet")
        if attributes["localSheetId"] == str(place):
            yield SheetName(attributes["name"], element.text, hidden=attributes.get("hidden") == "1")
