"""Read a workbook: the one way in from a file to the `Workbook` model, with notices on what may mislead."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from xlmc.errors import Notice, WorkbookError
from xlmc.workbook.lazy_sheets import LazySheets, naming_file
from xlmc.workbook.links import Links, linked_files
from xlmc.workbook.model import Workbook
from xlmc.workbook.package import LIMITS, SMALLER, read_parts, relationships
from xlmc.workbook.printable import label
from xlmc.workbook.safe_xml import is_true
from xlmc.workbook.structure import Structure, read_structure, tables_of

__all__ = ["read_workbook"]


def read_workbook(source: str | Path | bytes, name: str | None = None) -> Workbook:
    """Read an `.xlsx` or `.xlsm` file. Nothing in it is run, followed or changed.

    Sheets are parsed when first looked up, so a damaged sheet complains then.

    Args:
        source: the file's path, or its bytes.
        name: what to call the workbook; by default the file's own name.

    Raises:
        WorkbookError: the file cannot be opened, is no workbook, is encrypted, damaged or unreasonably large.
    """
    if isinstance(source, bytes):
        return _read(source, name or "workbook", name or "workbook")
    return _read(_file_bytes(Path(source)), name or Path(source).name, str(source))


def _read(data: bytes, name: str, where: str) -> Workbook:
    with naming_file(where):
        parts = read_parts(data)
        structure = read_structure(parts)
        sheets = LazySheets(where, parts, structure)
        tables = [table for sheet in structure.worksheets for table in tables_of(parts, sheet.part, sheet.name)]
        return Workbook(
            name=label(name),
            sheets=sheets,
            names=structure.names,
            tables=tuple(tables),
            links=Links(parts, structure),
            data_tables=tuple(sheets.data_tables()),
            date1904=structure.date1904,
            macintosh=b"Macintosh" in parts.get("docProps/app.xml", b""),
            notices=tuple(_workbook_notices(parts, structure, name)),
            parts=parts,
            sha256=hashlib.sha256(data).hexdigest(),
            data=data,
        )


def _file_bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(LIMITS.total + 1)
    except (OSError, ValueError) as error:
        raise _cannot_open(path, error) from error
    if len(data) > LIMITS.total:
        raise WorkbookError(f"the file is larger than {LIMITS.total >> 20} MB", where=path, hint=SMALLER)
    return data


def _cannot_open(path: Path, error: Exception) -> WorkbookError:
    for kind, message, hint in _REASONS:
        if isinstance(error, kind):
            return WorkbookError(message, where=path, hint=hint)
    return WorkbookError(
        f"the file cannot be read ({error})", where=repr(str(path)), hint="Check its name and its disk"
    )


_REASONS = (
    (FileNotFoundError, "there is no such file", "Check its name and folder"),
    (IsADirectoryError, "this is a folder", "Name the workbook in it"),
    (PermissionError, "the file may not be read", "Close it in Excel, or ask for permission to read it"),
)


_SAVED_AT: Final = re.compile(rb"<dcterms:modified[^>]*>\s*(\d{4}-\d\d-\d\d)")


def _workbook_notices(parts: Mapping[str, bytes], structure: Structure, name: str) -> Iterator[Notice]:
    """Notices on the workbook called `name` as a whole."""
    for stray in structure.strays:
        yield Notice(stray.message, name)
    for message in (*_on_calculation(structure.calculation), *_on_links(parts, structure), *_on_signature(parts)):
        yield Notice(message, name)


def _on_calculation(settings: Mapping[str, str]) -> Iterator[str]:
    if not is_true(settings.get("fullPrecision", "1")):
        yield "Excel calculates this workbook with precision as displayed; xlmc calculates with full precision"
    if settings.get("calcMode") == "manual":
        yield "calculation is set to manual: the values Excel saved may be older than the formulas and inputs"
    if is_true(settings.get("iterate")):
        yield "iterative calculation is on: xlmc does not calculate circular references"


def _on_links(parts: Mapping[str, bytes], structure: Structure) -> Iterator[str]:
    if any(rel.kind == "externalLink" for rel in structure.relationships.values()):
        named = ", ".join(linked_files(parts, structure))
        yield (
            f"the workbook links to other files{f' ({named})' if named else ''}, which xlmc does not open: where a "
            f"formula reads them, it gets the value that Excel stored{_age(parts)}"
        )


def _age(parts: Mapping[str, bytes]) -> str:
    """The file does not say when its links were updated last: it was before it was saved."""
    found = _SAVED_AT.search(parts.get("docProps/core.xml", b""))
    return f", of {found[1].decode()} or older" if found else ", at a time that the file does not tell"


def _on_signature(parts: Mapping[str, bytes]) -> Iterator[str]:
    if any(rel.type.endswith("/digital-signature/origin") for rel in relationships(parts).values()):
        yield "the workbook is digitally signed: a copy with results in it will not carry a valid signature"
