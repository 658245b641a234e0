"""Read a workbook: the one way in from a file to the `Workbook` model, with notices on what may mislead."""

from __future__ import annotations

import hashlib
import posixpath
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Final

from xlmc.errors import Notice, WorkbookError
from xlmc.excel.address import column_number
from xlmc.excel.workbook.formats import other_format
from xlmc.excel.workbook.lazy_sheets import LazySheets, naming_file
from xlmc.excel.workbook.other_formats.mark import converted_from, other_format_notices
from xlmc.excel.workbook.package import (
    LIMITS,
    SMALLER,
    WORKBOOKS,
    content_type,
    read_parts,
    relationships,
)
from xlmc.excel.workbook.pivot_tables import pivot_tables
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.safe_xml import REPAIR, decode, is_true, tree, whole_number
from xlmc.excel.workbook.sheet import CellContext, convert
from xlmc.excel.workbook.structure import Structure, iteration_of, read_structure, tables_of
from xlmc.excel.workbook.workbook import CellContent, CellValue, DefinedName, LinkedBook, Sheet, Workbook

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from xlmc.excel.own_functions import OwnFunctions

__all__ = ["Links", "linked_files", "read_workbook"]


def read_workbook(
    source: str | Path | bytes, name: str | None = None, functions: OwnFunctions | None = None
) -> Workbook:
    """Read an `.xlsx` or `.xlsm` file; or an `.xls`, `.xlsb` or `.ods`, whose cells LibreOffice converts, where it is
    installed.

    Nothing in it is run, followed or changed. Sheets are parsed when first looked up, so a damaged sheet complains
    then.

    Args:
        source: the file's path, or its bytes.
        name: what to call the workbook; by default the file's own name.
        functions: a person's own, which its formulas may call.

    Raises:
        WorkbookError: the file cannot be opened, is no workbook, is encrypted, damaged or unreasonably large.
    """
    if isinstance(source, bytes):
        workbook = _read(source, name or "workbook", name or "workbook")
    else:
        workbook = _read(_file_bytes(Path(source)), name or Path(source).name, str(source))
    return workbook if functions is None else replace(workbook, functions=functions)


def _read(data: bytes, name: str, where: str) -> Workbook:
    with naming_file(where):
        parts = _parts(data)
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
            pivots=pivot_tables(parts, structure.worksheets, structure.date1904),
            date1904=structure.date1904,
            saved_by=_saved_by(parts),
            libreoffice=b"<Application>LibreOffice" in parts.get("docProps/app.xml", b""),
            macintosh=b"Macintosh" in parts.get("docProps/app.xml", b""),
            iteration=iteration_of(structure.calculation),
            may_be_stale=_may_be_stale(structure.calculation),
            category=_category(parts),
            notices=tuple(_workbook_notices(parts, structure, name)),
            parts=parts,
            sha256=hashlib.sha256(data).hexdigest(),
            data=data,
        )


_APPLICATION: Final = re.compile(rb"<Application>([^<]{1,80})")


def _saved_by(parts: Mapping[str, bytes]) -> str:
    """Return the program that saved a workbook last; of one that LibreOffice converted, the program of its format."""
    if (form := converted_from(parts)) is not None:
        return form.program
    match = _APPLICATION.search(parts.get("docProps/app.xml", b""))
    name = "" if match is None else label(match[1].decode("utf-8", "replace"))
    return next((each for each in ("LibreOffice", "Excel") if each in name), name.partition("/")[0])


def _parts(data: bytes) -> dict[str, bytes]:
    form = other_format(data)
    if form is None:
        return read_parts(data)
    from xlmc.excel.workbook.other_formats.joined_package import parts_of_other_format  # few workbooks need it

    return parts_of_other_format(data, form)


def _file_bytes(path: Path) -> bytes:
    try:
        if path.is_fifo():  # nothing may ever be written to it
            raise WorkbookError("this is a pipe, not a file", where=path, hint="Copy the workbook to a file")
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


_BROKEN: Final = re.compile(rb"""\srefreshError\s*=\s*["'](?:1|true)["']""")

_CATEGORY: Final = re.compile(rb"<(?:\w+:)?category[^>]*>([^<]*)<")
_SAVED_AT: Final = re.compile(rb"<dcterms:modified[^>]*>\s*(\d{4}-\d\d-\d\d)")


def _workbook_notices(parts: Mapping[str, bytes], structure: Structure, name: str) -> Iterator[Notice]:
    """Notices on the workbook called `name` as a whole."""
    for notice in structure.left_out:
        yield Notice(notice.message, name)
    yield from (Notice(message, name) for message in other_format_notices(parts))
    for message in (
        *_on_ending(parts, structure, name),
        *_on_calculation(structure.calculation),
        *_on_links(parts, structure),
        *_on_signature(parts),
    ):
        yield Notice(message, name)


_ENDING_OF: Final = {
    "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml": ".xlsx",
    "application/vnd.ms-excel.sheet.macroEnabled.main+xml": ".xlsm",
    "application/vnd.openxmlformats-officedocument.spreadsheetml.template.main+xml": ".xltx",
    "application/vnd.ms-excel.template.macroEnabled.main+xml": ".xltm",
}
"""Content type of the workbook part -> the one ending with which Excel opens the file."""


def _on_ending(parts: Mapping[str, bytes], structure: Structure, name: str) -> Iterator[str]:
    ending = PurePath(name).suffix.casefold()
    meant = _ENDING_OF.get(content_type(parts, structure.part))
    if ending in WORKBOOKS and meant not in (None, ending):
        yield (
            f"the name ends in {ending}, but the file is a {meant} by its content: Excel opens neither it nor a copy "
            f"with results in it; rename it to end in {meant}"
        )


def _on_calculation(settings: Mapping[str, str]) -> Iterator[str]:
    if not is_true(settings.get("fullPrecision", "1")):
        yield "Excel calculates this workbook with precision as displayed; xlmc calculates with full precision"
    if settings.get("calcMode") == "manual":
        yield "calculation is set to manual: the values Excel saved may be older than the formulas and inputs"


def _may_be_stale(settings: Mapping[str, str]) -> bool:
    return settings.get("calcMode") == "manual" or is_true(settings.get("fullCalcOnLoad"))


def _on_links(parts: Mapping[str, bytes], structure: Structure) -> Iterator[str]:
    if any(rel.kind == "externalLink" for rel in structure.relationships.values()):
        named = ", ".join(linked_files(parts, structure))
        yield (
            f"the workbook links to other files{f' ({named})' if named else ''}, which xlmc does not open: where a "
            f"formula reads them, it gets the value that Excel stored{_age(parts)}"
        )
        broken = [_file(parts, part) or part for part in structure.links if _BROKEN.search(parts.get(part, b""))]
        if broken:
            yield (
                f"links to {', '.join(dict.fromkeys(broken))} are broken: what reads them is #REF!, as in Excel. "
                "Update or break the links in Excel (Data, Edit Links)"
            )


def _category(parts: Mapping[str, bytes]) -> str:
    """Return the category in the workbook's properties."""
    match = _CATEGORY.search(parts.get("docProps/core.xml", b""))
    return match[1].decode(errors="replace").strip() if match else ""


def _age(parts: Mapping[str, bytes]) -> str:
    """Say how old the links are: no newer than the file, which does not say when they were updated."""
    match = _SAVED_AT.search(parts.get("docProps/core.xml", b""))
    return f", of {match[1].decode()} or older" if match else ", at a time that the file does not tell"


def _on_signature(parts: Mapping[str, bytes]) -> Iterator[str]:
    if any(rel.type.endswith("/digital-signature/origin") for rel in relationships(parts).values()):
        yield "the workbook is digitally signed: a copy with results in it will not carry a valid signature"


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
            file = self._files[book]  # without its part, nothing of it is stored
            self._read[book] = _linked_book(book, file, tree(xml, part), part) if xml else LinkedBook(file, {})
        return self._read[book]

    def __contains__(self, book: object) -> bool:
        return book in self._parts

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)


def linked_files(parts: Mapping[str, bytes], structure: Structure) -> list[str]:
    """Return the names of the files that a workbook links to, each once."""
    files = (_file(parts, part) for part in structure.links)
    return list(dict.fromkeys(file for file in files if file))


def _file(parts: Mapping[str, bytes], part: str) -> str:
    """Return the name of the file, without its folder; empty where the part names none."""
    result = (link.target for link in relationships(parts, part).values() if link.external)
    return posixpath.basename(next(result, "").replace("\\", "/"))


def _linked_book(book: str, file: str, root: Element, part: str) -> LinkedBook:
    titles = [decode(name.get("val", "")) for name in root.findall("{*}externalBook/{*}sheetNames/{*}sheetName")]
    sheets, broken = {}, set()
    for data in root.findall("{*}externalBook/{*}sheetDataSet/{*}sheetData"):
        title = _of_id(titles, data.get("sheetId"))
        is_broken = is_true(data.get("refreshError"))
        if title is not None and (is_broken or len(data)):
            sheets[book + title] = Sheet(book + title, part, dict(_cells(data, part)))
            broken |= {book + title} if is_broken else set()
    return LinkedBook(file, sheets, tuple(_names(book, root, titles)), frozenset(broken))


def _names(book: str, root: Element, titles: list[str]) -> Iterator[DefinedName]:
    """Return the names that Excel stored with what they stand for; those of a sheet see that first."""
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
            at = cell.get("r")
            what = "a value without a cell" if at is None else f"a value of the cell {at!r}, which is none"
            raise WorkbookError(f"{part} holds {what}", hint=REPAIR)
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
