"""Worksheets that are parsed when first asked for: a book of twenty costs only those a model needs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from typing import TypeVar

from xlmc.workbook.blame import told_of
from xlmc.workbook.metadata import dynamic_array_marks
from xlmc.workbook.model import DataTable, Sheet
from xlmc.workbook.sheet import parse_sheet
from xlmc.workbook.strings import shared_strings
from xlmc.workbook.structure import Structure
from xlmc.workbook.values import CellContext

__all__ = ["LazySheets"]

_T = TypeVar("_T")


class LazySheets(Mapping[str, Sheet]):
    """Worksheets by name, in tab order.

    Args:
        file: the name of the file, for complaints.
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

    def __getitem__(self, name: str) -> Sheet:
        if name not in self._parsed:
            entry = self._entries[name]
            with told_of(self._file):
                self._parsed[name] = parse_sheet(self._parts[entry.part], entry, self._context)
        return self._parsed[name]

    def __contains__(self, name: object) -> bool:
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        return f"<sheets {', '.join(self._entries)}>"

    def data_tables(self) -> Iterable[DataTable]:
        """All what-if data tables; parses no sheet that cannot hold one.

        Raises:
            WorkbookError: a sheet that may hold one is damaged.
        """
        suspects = [entry.name for entry in self._entries.values() if _may_hold_data_table(self._parts[entry.part])]
        return [table for name in suspects for table in self[name].data_tables]

    def mentioning(self, words: Iterable[bytes]) -> Iterator[str]:
        """The names of the sheets whose part holds one of these words, in small letters, whatever its case there."""
        for entry in self._entries.values():
            xml = self._parts[entry.part].lower()
            if b"\0" in xml[:4] or any(word in xml for word in words):  # zero bytes: an encoding of its own
                yield entry.name

    @cached_property
    def _context(self) -> CellContext:
        return CellContext(
            strings=self._read("sharedStrings", shared_strings) or (),
            dynamic_marks=self._read("sheetMetadata", dynamic_array_marks) or frozenset(),
            date1904=self._structure.date1904,
        )

    def _read(self, kind: str, reader: Callable[[bytes, str], _T]) -> _T | None:
        part = self._structure.target(kind)
        return None if part is None or part not in self._parts else reader(self._parts[part], part)


def _may_hold_data_table(xml: bytes) -> bool:
    # XML without zero bytes at its start is in an encoding that writes ASCII as it is.
    return b"dataTable" in xml or b"\0" in xml[:4]
