"""The workbook part, with its sheets, defined names and calculation settings; and the tables of its worksheets."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING, Final

from xlmc.errors import Notice, WorkbookError
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.iteration import Iteration
from xlmc.excel.workbook.package import SAVE_AS, Relationship, relationships
from xlmc.excel.workbook.printable import printable
from xlmc.excel.workbook.safe_xml import REPAIR, attribute, decode, is_true, tree, whole_number
from xlmc.excel.workbook.workbook import DefinedName, Table

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = [
    "SheetEntry",
    "Structure",
    "area_of",
    "free_sheet_name",
    "iteration_of",
    "read_structure",
    "read_table",
    "table_part",
    "tables_of",
]


@dataclass(frozen=True, slots=True)
class SheetEntry:
    """One tab. `kind` is `worksheet`, or that of a sheet without cells (`chartsheet`, …).

    A module sheet of the 1990s, whose code lies in the macro project, keeps its place among the tabs and has no part.
    """

    name: str
    part: str
    kind: str
    visible: bool


@dataclass(frozen=True, slots=True)
class Structure:
    """What the workbook part says.

    Attributes:
        part: its name.
        relationships: its pointers to sheets, shared strings and the rest, by id.
        sheets: all tabs in order, also those without cells.
        left_out: notices of names that belong to no sheet and are left out of `names`.
        calculation: the attributes of `calcPr`.
        links: the parts of linked workbooks, in the order in which formulas number them.
    """

    part: str
    relationships: Mapping[str, Relationship]
    sheets: tuple[SheetEntry, ...]
    names: tuple[DefinedName, ...]
    left_out: tuple[Notice, ...]
    date1904: bool
    calculation: Mapping[str, str]
    links: tuple[str, ...] = ()

    @property
    def worksheets(self) -> tuple[SheetEntry, ...]:
        return tuple(sheet for sheet in self.sheets if sheet.kind == "worksheet")

    def target(self, kind: str) -> str | None:
        """Return the part that the workbook's first relationship of that kind points to."""
        return next(
            (relationship.target for relationship in self.relationships.values() if relationship.kind == kind), None
        )


def free_sheet_name(parts: Mapping[str, bytes], wanted: str) -> str:
    """Choose a name that no sheet has, so that formulas on a new sheet mean the workbook's own: `xlmc`, `xlmc 2`, ….

    Raises:
        WorkbookError: there is no workbook part, or it is damaged.
    """
    taken = {entry.name.casefold() for entry in read_structure(parts).sheets}
    return next(name for name in chain([wanted], (f"{wanted} {n}" for n in count(2))) if name.casefold() not in taken)


def read_structure(parts: Mapping[str, bytes]) -> Structure:
    """Find and read the workbook part.

    Raises:
        WorkbookError: there is none, or it is damaged.
    """
    part = _workbook_part(parts)
    root = tree(parts[part], part)
    rels = relationships(parts, part)
    sheets = tuple(_sheet_entry(element, rels, parts) for element in root.findall("{*}sheets/{*}sheet"))
    _check_distinct(sheets)
    names = [_defined_name(element, sheets) for element in root.findall("{*}definedNames/{*}definedName")]
    properties, calculation = root.find("{*}workbookPr"), root.find("{*}calcPr")
    return Structure(
        part=part,
        relationships=rels,
        sheets=sheets,
        names=tuple(name for name in names if isinstance(name, DefinedName)),
        left_out=tuple(name for name in names if isinstance(name, Notice)),
        date1904=properties is not None and is_true(properties.get("date1904")),
        calculation={} if calculation is None else calculation.attrib,
        links=tuple(_links(root, rels)),
    )


def iteration_of(calculation: Mapping[str, str]) -> Iteration | None:
    """How a workbook computes circles, by the attributes of `calcPr` (ECMA-376, part 1, 18.2.2); None if it does not.

    A number that is none, or out of Excel's range, counts as the one that Excel begins with.
    """
    if not is_true(calculation.get("iterate")):
        return None
    usual = Iteration()
    count = whole_number(calculation.get("iterateCount")) or usual.count
    try:
        change = float(calculation.get("iterateDelta", usual.change))
    except ValueError:
        change = usual.change
    known = count <= _MOST_ITERATIONS, 0.0 <= change < math.inf
    return Iteration(count if known[0] else usual.count, change if known[1] else usual.change)


_MOST_ITERATIONS: Final = 32_767


def _links(root: Element, rels: Mapping[str, Relationship]) -> Iterator[str]:
    for element in root.findall("{*}externalReferences/{*}externalReference"):
        rel = rels.get(attribute(element, "id") or "")
        yield "" if rel is None or rel.kind != "externalLink" else rel.target


def _workbook_part(parts: Mapping[str, bytes]) -> str:
    text = next((rel.target for rel in relationships(parts).values() if rel.kind == "officeDocument"), None)
    if text is None:
        raise WorkbookError("the file is a zip, but not an Excel workbook", hint=SAVE_AS)
    if text not in parts:
        raise WorkbookError(f"the file lacks its workbook part ({text})", hint=REPAIR)
    if text.lower().endswith(".bin"):
        raise WorkbookError("the file is a binary workbook (.xlsb)", hint=SAVE_AS)
    if not tree(parts[text], text).tag.endswith("}workbook"):
        raise WorkbookError("the file is an Office document, but not a workbook", hint=SAVE_AS)
    return text


def _sheet_entry(element: Element, rels: Mapping[str, Relationship], parts: Mapping[str, bytes]) -> SheetEntry:
    name = decode(element.get("name", ""))
    if "\n" in name or "\t" in name or printable(name) != name:
        hint = "Rename it in Excel, with letters and digits alone"
        raise WorkbookError(f"the name of the sheet {printable(name)!r} holds a control character", hint=hint)
    pointer = attribute(element, "id")
    if pointer == "":
        return SheetEntry(name, "", "module", visible=False)
    rel = rels.get(pointer or "")
    if rel is None or rel.target not in parts:
        raise WorkbookError(f"the sheet {name!r} is missing from the file", hint=REPAIR)
    return SheetEntry(name, rel.target, rel.kind, element.get("state", "visible") == "visible")


def _check_distinct(sheets: tuple[SheetEntry, ...]) -> None:
    names = Counter(sheet.name.casefold() for sheet in sheets)
    parts = Counter(sheet.part for sheet in sheets)
    for sheet in sheets:
        if names[sheet.name.casefold()] > 1 or (sheet.part and parts[sheet.part] > 1):
            raise WorkbookError(f"the sheet {sheet.name!r} is in the file twice", hint=REPAIR)


def _defined_name(element: Element, sheets: tuple[SheetEntry, ...]) -> DefinedName | Notice:
    """Read a name, or report a name of a tab that does not exist. `localSheetId` counts all tabs from 0."""
    name, text = decode(element.get("name", "")), decode(element.text or "")
    if "localSheetId" not in element.attrib:
        return DefinedName(name, text)
    position = whole_number(element.get("localSheetId"))
    if position is None or position >= len(sheets):
        return Notice(f"the defined name {name!r} belongs to a sheet that does not exist and is left out")
    return DefinedName(name, text, sheets[position].name)


def area_of(reference: str | None, sheet: str, what: str) -> Area:
    """Return the area `reference` names on `sheet`; a single cell is an area of one.

    Raises:
        WorkbookError: there is no reference, or it is none; `what` says whose it is.
    """
    try:
        cell = parse_address(reference or "", sheet)
    except ValueError as error:
        raise WorkbookError(f"{what} of sheet {sheet!r} has no valid range: {error}", hint=REPAIR) from None
    if isinstance(cell, Cell):
        return Area(sheet, cell.row, cell.column, cell.row, cell.column)
    return cell


def tables_of(parts: Mapping[str, bytes], sheet_part: str, sheet: str) -> Iterator[Table]:
    """Return the tables on one worksheet.

    Raises:
        WorkbookError: a table part is missing or damaged.
    """
    for rel in relationships(parts, sheet_part).values():
        if rel.kind == "table":
            if rel.target not in parts:
                raise WorkbookError(f"a table of sheet {sheet!r} is missing from the file", hint=REPAIR)
            yield read_table(parts[rel.target], rel.target, sheet)


def table_part(parts: Mapping[str, bytes], table: str) -> str:
    """Return the name of the part that holds a table.

    Raises:
        WorkbookError: none does.
    """
    for name, xml in parts.items():
        if name.casefold().endswith(".xml") and b"tableColumns" in xml:
            root = tree(xml, name)
            if decode(root.get("displayName", root.get("name", ""))) == table:
                return name
    raise WorkbookError(f"no part of the file holds the table {table}", hint=REPAIR)


def read_table(xml: bytes, part: str, sheet: str) -> Table:
    """One table part.

    Raises:
        WorkbookError: the part is damaged, or its columns or rows do not fit its range.
    """
    root = tree(xml, part)
    name = decode(root.get("displayName", root.get("name", "")))
    columns = tuple(decode(column.get("name", "")) for column in root.findall("{*}tableColumns/{*}tableColumn"))
    area = area_of(root.get("ref"), sheet, f"the table {name!r}")
    header, totals = (whole_number(root.get(key, default)) for key, default in _ROWS)
    if header is None or totals is None or header + totals > area.rows or len(columns) != area.columns:
        raise WorkbookError(f"the table {name!r} of sheet {sheet!r} does not fit its range {area.a1}", hint=REPAIR)
    return Table(name, area, columns, header, totals, _filtered(root, sheet, name))


def _filtered(root: Element, sheet: str, name: str) -> Area | None:
    """Return the range of its filter; None if no column of it has a condition."""
    element = root.find("{*}autoFilter")
    if element is None or not any(len(column) for column in element.findall("{*}filterColumn")):
        return None
    return area_of(element.get("ref"), sheet, f"the filter of the table {name!r}")


_ROWS = (("headerRowCount", "1"), ("totalsRowCount", "0"))
