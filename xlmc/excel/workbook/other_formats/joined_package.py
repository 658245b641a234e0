"""A workbook in another format as the parts of an `.xlsx`: cells by LibreOffice, with what it drops put back.

These are hidden texts of shapes, which go into legacy drawings as Excel itself writes them; and the last digits of
numbers. What both have read must agree, or the file is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from html import escape
from typing import Final, TypeGuard

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.formats import ODS, XLSB, OtherFormat
from xlmc.excel.workbook.injection.content_types import add_types
from xlmc.excel.workbook.injection.formula_values import with_values
from xlmc.excel.workbook.injection.splice import OFFICE_RELATIONSHIPS, SplicedXml, render
from xlmc.excel.workbook.lazy_sheets import LazySheets
from xlmc.excel.workbook.other_formats.binary_workbook import read_binary_workbook
from xlmc.excel.workbook.other_formats.libreoffice import converted_to_xlsx
from xlmc.excel.workbook.other_formats.mark import with_mark
from xlmc.excel.workbook.other_formats.old_workbook import OldBook, OldSheet, Position, read_old_workbook
from xlmc.excel.workbook.other_formats.open_document import read_open_document
from xlmc.excel.workbook.other_formats.shape_texts import ShapeText
from xlmc.excel.workbook.package import CONTENT_TYPES, read_parts, relationships, rels_part, unpacked
from xlmc.excel.workbook.structure import SheetEntry, read_structure
from xlmc.excel.workbook.workbook import CellContent, CellValue

__all__ = ["parts_of_other_format"]

_CLOSE: Final = 1e-13
"""Relative difference of numbers that are the same to 15 digits."""

_MOST_FILLED: Final = 1_000_000
"""Cells that the array formulas and what-if tables of a sheet may fill."""

_BEHIND_DRAWING: Final = (
    *("legacyDrawingHF", "drawingHF", "picture", "oleObjects", "controls", "AlternateContent", "webPublishItems"),
    *("tableParts", "extLst"),
)
"""What stands behind `legacyDrawing` in a worksheet (ECMA-376, part 1, 18.3.1.99)."""

_DRAWING_TYPE: Final = "application/vnd.openxmlformats-officedocument.vmlDrawing"
_RELATIONS: Final = b'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"/>'
_RELATION: Final = "xlmcLegacyDrawing"
_NOT_IN_NAMES: Final = re.compile(r"[^\w.]|_(?=x[0-9A-Fa-f]{4}_)")
_NO_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_SPACES: Final = (
    'xmlns:v="urn:schemas-microsoft-com:vml" xmlns:o="urn:schemas-microsoft-com:office:office" '
    'xmlns:x="urn:schemas-microsoft-com:office:excel"'
)
_PICTURE: Final = (
    '<v:shapetype id="_x0000_t75" coordsize="21600,21600" o:spt="75" o:preferrelative="t" '
    'path="m@4@5l@4@11@9@11@9@5xe" filled="f" stroked="f"><v:stroke joinstyle="miter"/></v:shapetype>'
)


def parts_of_other_format(data: bytes, form: OtherFormat) -> dict[str, bytes]:
    """Return the parts of the workbook, with a mark from which a reader says what they come from: see `mark`.

    Args:
        data: the file.
        form: its format.

    Raises:
        WorkbookError: the file cannot be read, LibreOffice cannot convert it, or both read different cells.
    """
    try:
        return _joined(_read(data, form), converted_to_xlsx(data, form), form)
    except _DifferenceError as error:
        raise WorkbookError(error.message, where=error.where, hint=form.hint) from None


class _DifferenceError(WorkbookError):
    """What LibreOffice gives is not what the file holds; the hint is that of the format."""


def _read(data: bytes, form: OtherFormat) -> OldBook:
    readers: dict[OtherFormat, Callable[[dict[str, bytes]], OldBook]] = {
        XLSB: read_binary_workbook,
        ODS: read_open_document,
    }
    return readers[form](unpacked(data)) if form in readers else read_old_workbook(data)


def _joined(old: OldBook, converted: bytes, form: OtherFormat) -> dict[str, bytes]:
    parts = read_parts(converted)
    structure = read_structure(parts)
    entries = {entry.name: entry for entry in structure.worksheets}
    sheets = LazySheets("the converted workbook", parts, structure)
    for number, sheet in enumerate(old.sheets, 1):
        entry = entries.get(sheet.name)
        if entry is None:
            raise _DifferenceError(f"LibreOffice has lost the sheet {sheet.name!r}")
        exact = _exact(sheet, sheets[sheet.name].cells, old.tells_logicals)
        if exact:
            parts[entry.part] = with_values(parts[entry.part], entry.part, exact)
        if sheet.texts:
            _put_texts(parts, entry, sheet.texts, number)
    settings = {"fullPrecision": "0"} if old.as_displayed else {}
    settings |= {"calcMode": "manual"} if old.manual else {}
    parts[structure.part] = _with_calculation(parts[structure.part], structure.part, settings)
    return with_mark(parts, form, old.macros)


def _with_calculation(xml: bytes, part: str, settings: Mapping[str, str]) -> bytes:
    """Return the workbook's part with these settings of Excel's calculation, of which LibreOffice drops some.

    Raises:
        WorkbookError: it has no place for them.
    """
    if not settings:
        return xml
    document = SplicedXml(xml, part)
    element = document.root.find("calcPr")
    if element is None:
        raise _DifferenceError("LibreOffice has lost how the workbook is calculated")
    for name, value in settings.items():
        document.set(element, name, value)
    return document.result()


def _exact(
    sheet: OldSheet, cells: Mapping[Position, CellContent], tells_logicals: bool
) -> dict[Position, float | bool]:
    """Return the numbers of cells that LibreOffice has shortened, and the results of formulas as Excel saved them.

    Raises:
        WorkbookError: a constant is another number, or a formula is none any more.
    """
    result: dict[Position, float | bool] = {}
    for position, number in sheet.numbers.items():
        content = cells.get(position)
        value = None if content is None else content.value
        if (
            content is None
            or content.formula is not None
            or not _is_number(value)
            or not math.isclose(value, number, rel_tol=_CLOSE, abs_tol=0.0)
        ):
            where = Cell(sheet.name, *position)
            raise _DifferenceError(f"LibreOffice has made {_words(content)} of the number {number!r}", where=where)
        if value != number:
            result[position] = number
    filled = _positions(sheet)
    for position, number in sheet.results.items():
        content = cells.get(position)
        if content is None or (content.formula is None and position not in filled):
            raise _DifferenceError("LibreOffice has lost the formula of the cell", where=Cell(sheet.name, *position))
        same_kind = (
            not tells_logicals or isinstance(content.value, bool)
            if isinstance(number, bool)
            else _is_number(content.value)
        )
        if not (same_kind and content.value == number) and math.isfinite(number):
            result[position] = number
    return result


def _words(content: CellContent | None) -> str:
    if content is None or (content.formula is None and content.value is None):
        return "a blank cell"
    if content.formula is not None:
        return "a formula"
    if isinstance(content.value, ErrorCode):
        return content.value.text
    return f"the {'number' if _is_number(content.value) else 'text'} {content.value!r}"


def _is_number(value: CellValue) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool | ErrorCode)  # an ErrorCode is a whole number


def _positions(sheet: OldSheet) -> set[Position]:
    """Return the cells that array formulas and what-if tables fill.

    Raises:
        WorkbookError: they are more than there could be.
    """
    areas = [area for area in sheet.areas if area[:2] != area[2:]]  # a cell alone keeps its formula
    sizes = (max(bottom - top + 1, 0) * max(right - left + 1, 0) for top, left, bottom, right in areas)
    if sum(sizes) > _MOST_FILLED:
        raise _DifferenceError(f"the array formulas of the sheet {sheet.name!r} fill too many cells")
    return {
        (row, column)
        for top, left, bottom, right in areas
        for row in range(top, bottom + 1)
        for column in range(left, right + 1)
    }


def _put_texts(parts: dict[str, bytes], entry: SheetEntry, texts: Iterable[ShapeText], number: int) -> None:
    """Put the shapes into the sheet's legacy drawing, which may hold comments, or into a new one."""
    drawings = [rel.target for rel in relationships(parts, entry.part).values() if rel.kind == "vmlDrawing"]
    shapes = [_shape(text, 1024 * number + 512 + at) for at, text in enumerate(texts)]
    if drawings and drawings[0] in parts:
        document = SplicedXml(parts[drawings[0]], drawings[0])
        for each in (_PICTURE, *shapes):
            document.append(document.root, each.replace(" ", f" {_SPACES} ", 1).encode())
        parts[drawings[0]] = document.result()
        return
    part = f"xl/drawings/xlmcDrawing{number}.vml"
    layout = f'<o:shapelayout v:ext="edit"><o:idmap v:ext="edit" data="{number}"/></o:shapelayout>'
    parts[part] = f"<xml {_SPACES}>{layout}{_PICTURE}{''.join(shapes)}</xml>".encode()
    parts[CONTENT_TYPES] = add_types(parts[CONTENT_TYPES], {part: _DRAWING_TYPE})
    rels = rels_part(entry.part)
    relations = SplicedXml(parts.get(rels, _RELATIONS), rels)
    relation = {"Id": _RELATION, "Type": f"{OFFICE_RELATIONSHIPS}/vmlDrawing", "Target": f"/{part}"}
    relations.append(relations.root, render("Relationship", relation))
    parts[rels] = relations.result()
    sheet = SplicedXml(parts[entry.part], entry.part)
    drawing = render(f"{sheet.prefix(sheet.root)}legacyDrawing", {"xmlns:r": OFFICE_RELATIONSHIPS, "r:id": _RELATION})
    behind = next((each for each in sheet.root.children if each.local in _BEHIND_DRAWING), None)
    if behind is None:
        sheet.append(sheet.root, drawing)
    else:
        sheet.before(behind, drawing)
    parts[entry.part] = sheet.result()


def _shape(text: ShapeText, number: int) -> str:
    """Make a hidden picture of one pixel, as Excel writes it for Crystal Ball."""
    name = _NOT_IN_NAMES.sub(lambda match: f"_x{ord(match[0]):04x}_", text.shape)
    more = f"<x:ScriptExtended>{_text_of(text.more)}</x:ScriptExtended>" if text.more else ""
    return (
        f'<v:shape id="{escape(name)}" o:spid="_x0000_s{number}" type="#_x0000_t75" '
        f"style='position:absolute;margin-left:0;margin-top:0;width:.75pt;height:.75pt;z-index:{number};"
        'visibility:hidden\' o:userhidden="t" print="f" o:insetmode="auto"><o:lock v:ext="edit" grouping="t"/>'
        '<x:ClientData ObjectType="Pict"><x:SizeWithCells/><x:Anchor>0, 0, 0, 0, 0, 1, 0, 1</x:Anchor>'
        f"<x:CF>Bitmap</x:CF><x:ScriptText>{_text_of(text.text)}</x:ScriptText>{more}"
        "<x:ScriptLanguage>4</x:ScriptLanguage><x:ScriptLocation>2</x:ScriptLocation></x:ClientData></v:shape>"
    )


def _text_of(text: str) -> str:
    return escape(_NO_XML.sub("\ufffd", text), quote=False)
