"""How the numbers of cells are written, as their number formats say."""

from __future__ import annotations

from collections.abc import Iterable

from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.number_formats import cell_formats
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.forms import Form, kind_of_format
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.tables.table_rows import as_text
from xlmc.montecarlo.number_text import number_text

__all__ = ["content_in", "formats_of", "forms_of"]


def formats_of(workbook: Workbook, cells: Iterable[Cell]) -> list[str]:
    """Return the number format of each cell; `General` where it has none, the file does not say, or a workbook that
    feeds this one has the cell.
    """
    wanted = [*cells]
    places = {cell: (workbook.sheets[cell.sheet].part, cell.a1) for cell in wanted if cell.sheet in workbook.sheets}
    parts = workbook.parts or workbook.origin
    result = cell_formats(parts, roles(parts).workbook, places.values()) if parts else {}
    return [result[places[cell]] if parts and cell in places else "General" for cell in wanted]


def forms_of(workbook: Workbook, cells: Iterable[Cell]) -> list[Form]:
    """Return the form of each cell's numbers: a date, a percentage or money where its format shows one."""
    codes = formats_of(workbook, cells)
    return [Form(kind_of_format(code) or Kind.NUMBER, code, date1904=workbook.date1904) for code in codes]


def content_in(form: Form, value: CellValue) -> str:
    """Write what a cell holds as the cell shows it; a number of which its format says nothing with twelve digits."""
    if isinstance(value, bool | ErrorCode) or not isinstance(value, int | float):
        return as_text(value)
    return number_text(float(value), 12) if form.kind is Kind.NUMBER else form.number(float(value))
