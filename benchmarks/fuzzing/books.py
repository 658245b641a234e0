"""Workbooks made part by part: a few kilobytes, quickly read, with whatever XML an input is about."""

from __future__ import annotations

import io
import re
import sys
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final
from xml.sax.saxutils import escape, quoteattr

from xlmc.excel.address import column_letters

__all__ = ["ROOT", "Sheet", "Table", "book", "cell", "packed", "parts_of", "shipped"]

ROOT: Final = Path(__file__).resolve().parents[2]
MAIN: Final = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE: Final = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE: Final = "http://schemas.openxmlformats.org/package/2006/relationships"
TYPES: Final = "http://schemas.openxmlformats.org/package/2006/content-types"
_SPREADSHEET: Final = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_CONTROL: Final = re.compile("[\x00-\x08\x0b-\x1f\ufffe\uffff]")

Value = float | bool | str | None


@dataclass(frozen=True, slots=True)
class Table:
    """An Excel table whose headings stand in the first row of `area`."""

    name: str
    area: str
    headings: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sheet:
    """The `c` elements of a sheet by row, and its tables."""

    rows: Mapping[int, Sequence[str]]
    tables: tuple[Table, ...] = ()
    after: str = ""


def cell(row: int, column: int, value: object = None, formula: str | None = None, attributes: str = "") -> str:
    """A `c` element. A text value that starts with `#` is an error; `attributes` are those of the `f` element."""
    place = f'r="{column_letters(column)}{row}"'
    written = "" if formula is None else f"<f{attributes}>{_text(formula)}</f>"
    if value is None:
        return f"<c {place}>{written}</c>"
    if isinstance(value, bool):
        return f'<c {place} t="b">{written}<v>{value:d}</v></c>'
    if isinstance(value, str):
        kind = "e" if value.startswith("#") and formula is None and value[-1:] in "!?A0" else "str"
        return f'<c {place} t="{kind}">{written}<v>{_text(value)}</v></c>'
    return f"<c {place}>{written}<v>{value}</v></c>"


def _text(text: str) -> str:
    """Text as Excel writes it into a file: what XML cannot hold as `_x0007_`."""
    return escape(_CONTROL.sub(lambda result: f"_x{ord(result[0]):04X}_", text))


def parts_of(sheets: Mapping[str, Sheet], names: Mapping[str, str] | None = None) -> dict[str, bytes]:
    """The parts of a workbook."""
    parts: dict[str, str] = {}
    tabs, rels, types = [], [], []
    tables = 0
    for number, (name, sheet) in enumerate(sheets.items(), 1):
        part = f"xl/worksheets/sheet{number}.xml"
        types.append(f'<Override PartName="/{part}" ContentType="{_SPREADSHEET}.worksheet+xml"/>')
        tabs.append(f'<sheet name={quoteattr(name)} sheetId="{number}" r:id="s{number}"/>')
        rels.append(f'<Relationship Id="s{number}" Type="{OFFICE}/worksheet" Target="worksheets/sheet{number}.xml"/>')
        rows = "".join(f'<row r="{row}">{"".join(cells)}</row>' for row, cells in sorted(sheet.rows.items()))
        pointers, own = "", []
        for table in sheet.tables:
            tables += 1
            where = f"tables/table{tables}.xml"
            own.append(f'<Relationship Id="t{tables}" Type="{OFFICE}/table" Target="../{where}"/>')
            pointers += f'<tablePart r:id="t{tables}"/>'
            types.append(f'<Override PartName="/xl/{where}" ContentType="{_SPREADSHEET}.table+xml"/>')
            parts[f"xl/{where}"] = _table(table, tables)
        if own:
            parts[f"xl/worksheets/_rels/sheet{number}.xml.rels"] = _rels(own)
        pointers = f'<tableParts count="{len(sheet.tables)}">{pointers}</tableParts>' if pointers else ""
        parts[part] = (
            f'<worksheet xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheetData>{rows}</sheetData>'
            f"{sheet.after}{pointers}</worksheet>"
        )
    given = "".join(
        f"<definedName name={quoteattr(name)}>{_text(text)}</definedName>" for name, text in (names or {}).items()
    )
    given = f"<definedNames>{given}</definedNames>" if given else ""
    types.append(f'<Override PartName="/xl/workbook.xml" ContentType="{_SPREADSHEET}.sheet.main+xml"/>')
    parts["xl/workbook.xml"] = (
        f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{"".join(tabs)}</sheets>{given}</workbook>'
    )
    parts["xl/_rels/workbook.xml.rels"] = _rels(rels)
    parts["_rels/.rels"] = _rels([f'<Relationship Id="w" Type="{OFFICE}/officeDocument" Target="xl/workbook.xml"/>'])
    defaults = (
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="xml" ContentType="application/xml"/>'
    )
    first = {"[Content_Types].xml": f'<Types xmlns="{TYPES}">{defaults}{"".join(types)}</Types>'}
    return {name: xml.encode("utf-8", "surrogatepass") for name, xml in (first | parts).items()}


def _rels(lines: Sequence[str]) -> str:
    return f'<Relationships xmlns="{PACKAGE}">{"".join(lines)}</Relationships>'


def _table(table: Table, number: int) -> str:
    columns = "".join(
        f'<tableColumn id="{n}" name={quoteattr(_text(heading))}/>' for n, heading in enumerate(table.headings, 1)
    )
    return (
        f'<table xmlns="{MAIN}" id="{number}" name={quoteattr(table.name)} displayName={quoteattr(table.name)} '
        f'ref="{table.area}"><tableColumns count="{len(table.headings)}">{columns}</tableColumns></table>'
    )


def packed(parts: Mapping[str, bytes] | Sequence[tuple[str, bytes]]) -> bytes:
    """A zip of these parts, not compressed: that would take longer than reading them."""
    file = io.BytesIO()
    pairs = parts.items() if isinstance(parts, Mapping) else parts
    with zipfile.ZipFile(file, "w") as package:
        for name, content in pairs:
            package.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content)
    return file.getvalue()


def book(sheets: Mapping[str, Sheet], names: Mapping[str, str] | None = None) -> bytes:
    """The bytes of a workbook."""
    return packed(parts_of(sheets, names))


@cache
def shipped() -> tuple[tuple[str, bytes], ...]:
    """The books of the repository by the tests' list, name and bytes."""
    sys.path.append(str(ROOT / "tests" / "session"))
    from committed_books import BOOKS

    return tuple((path.name, path.read_bytes()) for path in sorted(BOOKS.values()))
