"""Worksheets that are parsed when first asked for: a book of twenty costs only those a model needs."""

from __future__ import annotations

import re
from collections import ChainMap
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from xlmc.errors import WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.safe_xml import is_true, shared_strings, tree
from xlmc.excel.workbook.sheet import CellContext, parse_sheet
from xlmc.excel.workbook.structure import Structure
from xlmc.excel.workbook.workbook import CellContent, CellValue, DataTable, Sheet, Workbook

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["LazySheets", "dynamic_array_marks", "naming_file", "with_cells", "with_values"]

_T = TypeVar("_T")


class LazySheets(Mapping[str, Sheet]):
    """Worksheets by name, in tab order.

    Args:
        file: the name of the file, for messages.
        parts: of its package.
        structure: of its workbook part.

    Looking a sheet up raises `WorkbookError` where its part is damaged.
    """

    def __init__(self, file: str, parts: Mapping[str, bytes], structure: Structure) -> None:
        self._file = file
        self._parts = parts
        self._structure = structure
        self._entries = {entry.name: entry for entry in structure.worksheets}
        self._parsed: dict[str, Sheet] = {}
        self._changed: frozenset[str] = frozenset()

    def __getitem__(self, name: str) -> Sheet:
        if name not in self._parsed:
            entry = self._entries[name]
            with naming_file(self._file):
                xml = self._parts[entry.part]
                context = replace(self._context, placeholders=self._never_calculated(xml))
                self._parsed[name] = parse_sheet(xml, entry, context)
        return self._parsed[name]

    def __contains__(self, name: object) -> bool:
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        return f"<sheets {', '.join(self._entries)}>"

    def with_sheets(self, changed: Mapping[str, Sheet]) -> LazySheets:
        """Return the same worksheets, but for those of these names."""
        lazy_sheets = copy(self)
        lazy_sheets._parsed = {**self._parsed, **changed}
        lazy_sheets._changed = self._changed | changed.keys()
        return lazy_sheets

    def with_parts(self, parts: Mapping[str, bytes]) -> LazySheets:
        """Return the worksheets as other parts of the same structure hold them, none of them parsed yet."""
        return LazySheets(self._file, parts, self._structure)

    def part(self, name: str) -> str:
        """Return the name of the part that holds a worksheet, which is not parsed for that."""
        return self._entries[name].part

    def data_tables(self) -> Iterable[DataTable]:
        """All what-if data tables; parses no sheet that cannot hold one.

        Raises:
            WorkbookError: a sheet that may hold one is damaged.
        """
        suspects = [entry.name for entry in self._entries.values() if _may_hold_data_table(self._parts[entry.part])]
        return [table for name in suspects for table in self[name].data_tables]

    def mentioning(self, words: Iterable[bytes]) -> Iterator[str]:
        """Return the names of the sheets whose part holds one of these words, in small letters, whatever its case
        there, and of those that `with_sheets` has changed.
        """
        for entry in self._entries.values():
            xml = self._parts[entry.part].lower()
            encoded = b"\0" in xml[:4]  # in an encoding of its own
            if encoded or entry.name in self._changed or any(word in xml for word in words):
                yield entry.name

    def holding(self, texts: Collection[str]) -> list[str]:
        """Return the names of the sheets that hold all of these texts, each in a cell or a part of one; parse none.

        A sheet that was written in an unusual way may be left out.
        """
        with naming_file(self._file):
            strings = self._context.strings
        numbers = {text: {at for at, each in enumerate(strings) if each == text} for text in texts}
        result = []
        for entry in self._entries.values():
            xml = self._parts.get(entry.part, b"")
            shown = set(map(int, _SHARED.findall(xml)))
            if all(at & shown or text.encode() in xml for text, at in numbers.items()):
                result.append(entry.name)
        return result

    @cached_property
    def _context(self) -> CellContext:
        return CellContext(
            strings=self._read("sharedStrings", shared_strings) or (),
            dynamic_marks=self._read("sheetMetadata", dynamic_array_marks) or frozenset(),
            date1904=self._structure.date1904,
        )

    def _never_calculated(self, xml: bytes) -> bool:
        """Whether a program that does not calculate wrote the sheet: 0 beside every formula, and Excel is asked to.

        XlsxWriter writes so, and pandas by it. Other sheets of the workbook may be xlmc's, which have values.
        """
        asked = is_true(self._structure.calculation.get("fullCalcOnLoad"))
        return asked and b"\0" not in xml[:4] and not _CALCULATED.search(xml)

    def _read(self, kind: str, reader: Callable[[bytes, str], _T]) -> _T | None:
        part = self._structure.target(kind)
        return None if part is None or part not in self._parts else reader(self._parts[part], part)


_SHARED = re.compile(rb'<(?:\w+:)?c\b[^>]*\bt="s"[^>]*>\s*<(?:\w+:)?v>(\d{1,9})</')
"""A cell that shows a shared string, by its number."""

_CALCULATED = re.compile(rb"(?:</(?:\w+:)?f>|<(?:\w+:)?f\b[^>]*/>)\s*<(?:\w+:)?v\b[^>]*>(?!\s*(?:0(?:\.0*)?\s*)?</)")
"""A formula with a saved value that is neither 0 nor empty."""


def _may_hold_data_table(xml: bytes) -> bool:
    # XML without zero bytes at its start is in an encoding that writes ASCII as it is.
    return b"dataTable" in xml or b"\0" in xml[:4]


_DYNAMIC = "XLDAPR"


def dynamic_array_marks(xml: bytes, part: str) -> frozenset[str]:
    """Return the values of `cm` that mark a dynamic-array formula.

    `cm` counts cell metadata from 1; each names records (`rc`) of a type `t`, counted from 1, with a value `v`,
    counted from 0, among that type's own.

    Raises:
        WorkbookError: the part is not XML.
    """
    root = tree(xml, part)
    types = [element.get("name") for element in root.findall("{*}metadataTypes/{*}metadataType")]
    spilling = _spilling_records(root)
    wanted = {(str(types.index(_DYNAMIC) + 1), str(v)) for v in spilling} if _DYNAMIC in types else set()
    return frozenset(
        str(number)
        for number, block in enumerate(root.findall("{*}cellMetadata/{*}bk"), 1)
        if any((record.get("t"), record.get("v")) in wanted for record in block.findall("{*}rc"))
    )


def _spilling_records(root: Element) -> list[int]:
    future = next((result for result in root.findall("{*}futureMetadata") if result.get("name") == _DYNAMIC), ())
    return [number for number, block in enumerate(future) if _spills(block)]


def _spills(block: Element) -> bool:
    return any(is_true(result.get("fDynamic")) for result in block.iterfind(".//{*}dynamicArrayProperties"))


@contextmanager
def naming_file(file: str) -> Iterator[None]:
    """Let errors from within that do not say where they are name `file`."""
    try:
        yield
    except WorkbookError as error:
        if error.where is not None:
            raise
        raise WorkbookError(error.message, where=file, hint=error.hint) from error


def with_values(workbook: Workbook, values: Mapping[Cell, CellValue]) -> Workbook:
    """Return the workbook with these values typed into its cells; see `with_contents`."""
    contents = {cell: CellContent(value) for cell, value in values.items()}
    other = {cell for cell, content in contents.items() if content != workbook.content(cell)}
    return replace(with_contents(workbook, contents), typed=workbook.typed | other)


def with_contents(workbook: Workbook, contents: Mapping[Cell, CellContent]) -> Workbook:
    """Return the workbook with other contents in some cells. No file holds it: it has no parts and no fingerprint.

    Its `origin` are the parts of the file, in whose drawings Crystal Ball hides definitions.
    """
    typed: dict[str, dict[tuple[int, int], CellContent]] = {}
    for cell, content in contents.items():
        typed.setdefault(cell.sheet, {})[cell[1:]] = content
    more = with_cells(workbook.sheets, typed)
    return replace(workbook, sheets=more, parts={}, origin=workbook.parts or workbook.origin, sha256="", data=b"")


def with_cells(
    sheets: Mapping[str, Sheet], contents: Mapping[str, Mapping[tuple[int, int], CellContent]]
) -> Mapping[str, Sheet]:
    """Return the sheets with other contents in some cells; the others are still parsed when they are looked up."""
    changed = {name: replace(sheets[name], cells={**sheets[name].cells, **new}) for name, new in contents.items()}
    if isinstance(sheets, LazySheets):
        return sheets.with_sheets(changed)
    return ChainMap(changed, sheets)  # type: ignore[arg-type]  # which nobody writes to
