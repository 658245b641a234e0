"""Workbooks made by hand, part by part, so that a test shows the very XML it is about."""

from __future__ import annotations

import io
import zipfile

import pytest

from xlmc.excel.workbook.reader import read_workbook

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
XMLNS = f'xmlns="{MAIN}" xmlns:r="{OFFICE}"'
PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"


def zip_of(parts):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as package:
        for name, content in parts.items():
            package.writestr(name, content)
    return packed.getvalue()


def rels_of(*rels):
    """A rels part; each relationship is (id, kind or whole type, target) and perhaps "External"."""
    lines = [
        f'<Relationship Id="{key}" Type="{kind if ":" in kind else f"{OFFICE}/{kind}"}" Target="{target}"'
        + (f' TargetMode="{mode[0]}"/>' if mode else "/>")
        for key, kind, target, *mode in rels
    ]
    return f'<Relationships xmlns="{PACKAGE}">{"".join(lines)}</Relationships>'


def parts_of(sheets=None, strings=(), in_workbook="", rels=(), more=None):
    """The parts of a workbook.

    Args:
        sheets: name -> what its `worksheet` element holds.
        strings: what the `si` elements of the shared string table hold.
        in_workbook: what the `workbook` element holds beside its sheets.
        rels: further relationships of the workbook.
        more: further parts, which win over those made here.
    """
    sheets = {"Sheet1": ""} if sheets is None else sheets
    tabs = "".join(f'<sheet name="{name}" sheetId="{n}" r:id="s{n}"/>' for n, name in enumerate(sheets, 1))
    pointers = [(f"s{n}", "worksheet", f"worksheets/sheet{n}.xml") for n in range(1, len(sheets) + 1)]
    if strings:
        pointers.append(("strings", "sharedStrings", "sharedStrings.xml"))
    parts = {
        "[Content_Types].xml": '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>',
        "_rels/.rels": rels_of(("w", "officeDocument", "xl/workbook.xml")),
        "xl/workbook.xml": f"<workbook {XMLNS}><sheets>{tabs}</sheets>{in_workbook}</workbook>",
        "xl/_rels/workbook.xml.rels": rels_of(*pointers, *rels),
        "xl/sharedStrings.xml": f'<sst xmlns="{MAIN}">{"".join(f"<si>{item}</si>" for item in strings)}</sst>',
    }
    for number, content in enumerate(sheets.values(), 1):
        parts[f"xl/worksheets/sheet{number}.xml"] = f'<worksheet xmlns="{MAIN}">{content}</worksheet>'
    return {name: part.encode() if isinstance(part, str) else part for name, part in (parts | (more or {})).items()}


@pytest.fixture
def zipped():
    """Parts -> the bytes of their zip."""
    return zip_of


@pytest.fixture
def rels():
    """Relationships -> a rels part."""
    return rels_of


@pytest.fixture
def book_parts():
    """Pieces of XML -> the parts of a workbook."""
    return parts_of


@pytest.fixture
def book():
    """Pieces of XML -> the workbook read from them."""

    def read(sheets=None, **pieces):
        return read_workbook(zip_of(parts_of(sheets, **pieces)), name="book.xlsx")

    return read


@pytest.fixture
def cells(book):
    """What `sheetData` holds, and pieces of the workbook around it -> the cells read from it."""

    def read(rows, **pieces):
        return dict(book({"Sheet1": f"<sheetData>{rows}</sheetData>"}, **pieces).sheets["Sheet1"].cells)

    return read
