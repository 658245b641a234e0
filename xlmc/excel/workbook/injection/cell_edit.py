"""Put contents into cells of a sheet and rows into a table, and leave every other byte as it is."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Area, Cell, column_letters, parse_address
from xlmc.excel.workbook.injection.splice import Element, SplicedXml, cell_text, render
from xlmc.excel.workbook.safe_xml import REPAIR
from xlmc.excel.workbook.workbook import CellValue

__all__ = ["Content", "Typed", "saved_value", "with_calculation_on_load", "with_contents", "with_last_row"]

_BEHIND_CALCULATION: Final = (
    "oleSize",
    "customWorkbookViews",
    "pivotCaches",
    "smartTagPr",
    "smartTagTypes",
    "webPublishing",
    "fileRecoveryPr",
    "webPublishObjects",
    "extLst",
)
"""What stands behind `calcPr` in a workbook part (ECMA-376, part 1, 18.2.27)."""


@dataclass(frozen=True, slots=True)
class Typed:
    """A formula that is typed into a cell, without its `=`, and the value that it has."""

    formula: str
    value: CellValue = None


Content = str | float | bool | ErrorCode | Typed | None
"""The content of a cell: a text, a number, a logical, an error, a formula, or nothing."""


def with_contents(xml: bytes, part: str, sheet: str, contents: Mapping[tuple[int, int], Content]) -> bytes:
    """Return a sheet's part with these contents; a cell keeps its look, and a new one takes that of the cell above it.

    Args:
        xml: the part.
        part: its name, for messages.
        sheet: the sheet's name, for messages.
        contents: by row and column, from 1.

    Raises:
        WorkbookError: the part is no sheet, or one of the cells holds a formula.
    """
    document = SplicedXml(xml, part)
    data = document.root.find("sheetData")
    if data is None:
        raise WorkbookError(f"{part} holds no cells", hint=REPAIR)
    rows = _numbered(data.find_all("row"), lambda name: int(name))
    wanted: defaultdict[int, dict[int, Content]] = defaultdict(dict)
    for (row, column), content in sorted(contents.items()):
        wanted[row][column] = content
    for number, cells in wanted.items():
        above = _cells_of(rows.get(number - 1))
        own = _cells_of(rows.get(number))
        fragments = {}
        for column, content in cells.items():
            old = own.get(column)
            if old is not None and old.find("f") is not None:
                hint = "Put a number or nothing into it, and try again"
                raise WorkbookError("the cell holds a formula", where=Cell(sheet, number, column), hint=hint)
            like = old or above.get(column)
            style = None if like is None else like.attributes.get("s")
            fragments[column] = _fragment(document.prefix(data), number, column, content, style)
        if number in rows:
            _put(document, rows[number], own, fragments)
        else:
            row_of_cells = b"".join(fragments.values()).decode()
            _insert(document, data, rows, number, render(f"{document.prefix(data)}row", {"r": number}, row_of_cells))
    _extend_dimension(document, max(wanted, default=0))
    return document.result()


def with_last_row(xml: bytes, part: str, last: int) -> bytes:
    """Return a table's part whose table, and its filter, reach to another last row.

    Raises:
        WorkbookError: the part is no table.
    """
    document = SplicedXml(xml, part)
    for element in (document.root, *document.root.find_all("autoFilter")):
        area = parse_address(element.attributes.get("ref", ""), "-")
        if not isinstance(area, Area):
            raise WorkbookError(f"{part} is not a table", hint=REPAIR)
        document.set(element, "ref", Area("-", area.top, area.left, last, area.right).a1)
    return document.result()


def with_calculation_on_load(xml: bytes, part: str) -> bytes:
    """Return a workbook's part that has Excel calculate all formulas when it opens the file."""
    document = SplicedXml(xml, part)
    element = document.root.find("calcPr")
    if element is not None:
        document.set(element, "fullCalcOnLoad", "1")
        return document.result()
    new = render(f"{document.prefix(document.root)}calcPr", {"fullCalcOnLoad": "1"})
    behind = next((each for each in document.root.children if each.local in _BEHIND_CALCULATION), None)
    if behind is None:
        document.append(document.root, new)
    else:
        document.before(behind, new)
    return document.result()


def _put(document: SplicedXml, row: Element, own: Mapping[int, Element], fragments: Mapping[int, bytes]) -> None:
    for column, fragment in fragments.items():
        if column in own:
            document.before(own[column], fragment)
            document.remove(own[column])
        else:
            _insert(document, row, own, column, fragment)


def _insert(
    document: SplicedXml, parent: Element, children: Mapping[int, Element], number: int, fragment: bytes
) -> None:
    """Insert a new child at the place of its number."""
    behind = min((each for each in children if each > number), default=None)
    if behind is None:
        document.append(parent, fragment)
    else:
        document.before(children[behind], fragment)


def _cells_of(row: Element | None) -> dict[int, Element]:
    if row is None:
        return {}
    return _numbered(row.find_all("c"), lambda name: parse_address(name, "-").column)  # type: ignore[union-attr]


def _numbered(elements: list[Element], number_of: Callable[[str], int]) -> dict[int, Element]:
    """Rows or cells by their numbers; those that name none follow the one before."""
    result: dict[int, Element] = {}
    number = 0
    for each in elements:
        name = each.attributes.get("r")
        number = number + 1 if name is None else number_of(name)
        result[number] = each
    return result


def _fragment(prefix: str, row: int, column: int, content: Content, style: str | None) -> bytes:
    attributes = {"r": f"{column_letters(column)}{row}"} | ({} if style is None else {"s": style})
    if content is None:
        return render(f"{prefix}c", attributes)
    if isinstance(content, Typed):
        kind, text = saved_value(content.value)
        formula = f"<{prefix}f>{cell_text(content.formula)}</{prefix}f>"
        value = "" if content.value is None else f"<{prefix}v>{text}</{prefix}v>"
        return render(f"{prefix}c", attributes | ({} if kind == "n" else {"t": kind}), formula + value)
    if isinstance(content, str):
        text = f'<{prefix}is><{prefix}t xml:space="preserve">{cell_text(content)}</{prefix}t></{prefix}is>'
        return render(f"{prefix}c", attributes | {"t": "inlineStr"}, text)
    if isinstance(content, ErrorCode):
        return render(f"{prefix}c", attributes | {"t": "e"}, f"<{prefix}v>{content.text}</{prefix}v>")
    if isinstance(content, bool):
        return render(f"{prefix}c", attributes | {"t": "b"}, f"<{prefix}v>{int(content)}</{prefix}v>")
    return render(f"{prefix}c", attributes, f"<{prefix}v>{content!r}</{prefix}v>")


def saved_value(value: CellValue) -> tuple[str, str]:
    """Return the type of a cell that holds the value, and its text as XML."""
    match value:
        case bool():
            return "b", str(int(value))
        case ErrorCode():
            return "e", value.text
        case str():
            return "str", cell_text(value)
        case None:
            return "str", ""
        case _:
            return "n", repr(float(value)).removesuffix(".0")


def _extend_dimension(document: SplicedXml, last: int) -> None:
    """Have the sheet say that it reaches so far down, where it says less."""
    element = document.root.find("dimension")
    area = None if element is None else parse_address(element.attributes.get("ref", "A1"), "-")
    if element is not None and isinstance(area, Area) and area.bottom < last:
        document.set(element, "ref", Area("-", area.top, area.left, last, area.right).a1)
