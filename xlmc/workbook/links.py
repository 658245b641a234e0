"""Links to other workbooks: the values that Excel stored in the link parts. No other file is opened."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

from xlmc.address import column_number
from xlmc.errors import WorkbookError
from xlmc.workbook.cell_values import CellContext, convert, decode
from xlmc.workbook.model import CellContent, CellValue, DefinedName, LinkedBook, Sheet
from xlmc.workbook.package import relationships
from xlmc.workbook.safe_xml import REPAIR, tree, whole_number
from xlmc.workbook.structure import Structure

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["Links", "linked_files"]

_CONTEXT: Final = CellContext()
_A1: Final = re.compile("([A-Z]{1,3})([1-9][0-9]{0,6})")


class Links(Mapping[str, LinkedBook]):
    """The linked workbooks as formulas write them, `[1]`, `[2]`, …; a part is read when first asked for.

    Looking one up raises `WorkbookError` where its part is damaged.
    """

    def __init__(self, parts: Mapping[str, bytes], structure: Structure) -> None:
        self._parts = {f"[{number}]": (part, parts.get(part, b"")) for number, part in enumerate(structure.links, 1)}
        self._files = {f"[{number}]": _file(parts, part) for number, part in enumerate(structure.links, 1)}
        self._read: dict[str, LinkedBook] = {}

    def __getitem__(self, book: str) -> LinkedBook:
        part, xml = self._parts[book]
        if book not in self._read:
            self._read[book] = _linked_book(book, self._files[book], tree(xml, part), part)
        return self._read[book]

    def __contains__(self, book: object) -> bool:
        return book in self._parts

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)


def linked_files(parts: Mapping[str, bytes], structure: Structure) -> list[str]:
    """The names of the files that a workbook links to, each once."""
    files = (_file(parts, part) for part in structure.links)
    return list(dict.fromkeys(file for file in files if file))


def _file(parts: Mapping[str, bytes], part: str) -> str:
    """The name of the file, without its folder; empty where the part names none."""
    found = (link.target for link in relationships(parts, part).values() if link.external)
    return posixpath.basename(next(found, "").replace("\\", "/"))


def _linked_book(book: str, file: str, root: Element, part: str) -> LinkedBook:
    titles = [decode(name.get("val", "")) for name in root.findall("{*}externalBook/{*}sheetNames/{*}sheetName")]
    sheets = {}
    for data in root.findall("{*}externalBook/{*}sheetDataSet/{*}sheetData"):
        title = _of_id(titles, data.get("sheetId"))
        if title is not None:
            sheets[book + title] = Sheet(book + title, part, dict(_cells(data, part)))
    return LinkedBook(file, sheets, tuple(_names(book, root, titles)))


def _names(book: str, root: Element, titles: list[str]) -> Iterator[DefinedName]:
    """The names that Excel stored with what they stand for; those of a sheet see that first."""
    for name in root.findall("{*}externalBook/{*}definedNames/{*}definedName"):
        text = decode(name.get("refersTo", "")).removeprefix("=")
        title = _of_id(titles, name.get("sheetId"))
        if text:
            yield DefinedName(decode(name.get("name", "")), text, None if title is None else book + title)


def _of_id(titles: list[str], sheet_id: str | None) -> str | None:
    number = whole_number(sheet_id)
    return titles[number] if number is not None and number < len(titles) else None


def _cells(data: Element, part: str) -> Iterator[tuple[tuple[int, int], CellContent]]:
    for cell in data.findall("{*}row/{*}cell"):
        corner = _A1.fullmatch(cell.get("r", ""))
        if corner is None:
            raise WorkbookError(f"{part} holds a value of the cell {cell.get('r')!r}, which is none", hint=REPAIR)
        yield (int(corner[2]), column_number(corner[1])), CellContent(_value(cell, part))


def _value(cell: Element, part: str) -> CellValue:
    raw = cell.find("{*}v")
    if raw is None:
        return None
    kind = cell.get("t", "n")
    try:
        return convert(kind, raw.text or "", _CONTEXT)
    except ValueError as error:
        raise WorkbookError(f"{part}: the value of {cell.get('r')} {error}", hint=REPAIR) from error
