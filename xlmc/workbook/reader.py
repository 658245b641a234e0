"""Read a workbook: the one way in from a file to the `Workbook` model."""

from __future__ import annotations

import hashlib
from pathlib import Path

from xlmc.errors import WorkbookError
from xlmc.workbook.blame import told_of
from xlmc.workbook.lazy_sheets import LazySheets
from xlmc.workbook.links import Links
from xlmc.workbook.model import Workbook
from xlmc.workbook.notices import workbook_notices
from xlmc.workbook.package import LIMITS, SMALLER, read_parts
from xlmc.workbook.printable import label
from xlmc.workbook.structure import read_structure
from xlmc.workbook.tables import tables_of

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


def _read(data: bytes, name: str, place: str) -> Workbook:
    with told_of(place):
        parts = read_parts(data)
        structure = read_structure(parts)
        sheets = LazySheets(place, parts, structure)
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
            notices=tuple(workbook_notices(parts, structure, name)),
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
