"""The workbook part: its sheets, defined names and calculation settings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.errors import Notice, WorkbookError
from xlmc.workbook.model import DefinedName
from xlmc.workbook.package import SAVE_AS, Relationship, relationships
from xlmc.workbook.printable import printable
from xlmc.workbook.safe_xml import REPAIR, attribute, is_true, tree, whole_number
from xlmc.workbook.strings import decode

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["SheetEntry", "Structure", "read_structure"]


@dataclass(frozen=True, slots=True)
class SheetEntry:
    """One tab. `kind` is `worksheet`, or that of a sheet without cells (`chartsheet`, …)."""

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
        strays: notices of names that belong to no sheet and are left out of `names`.
        calculation: the attributes of `calcPr`.
        links: the parts of linked workbooks, in the order in which formulas number them.
    """

    part: str
    relationships: Mapping[str, Relationship]
    sheets: tuple[SheetEntry, ...]
    names: tuple[DefinedName, ...]
    strays: tuple[Notice, ...]
    date1904: bool
    calculation: Mapping[str, str]
    links: tuple[str, ...] = ()

    @property
    def worksheets(self) -> tuple[SheetEntry, ...]:
        return tuple(sheet for sheet in self.sheets if sheet.kind == "worksheet")

    def target(self, kind: str) -> str | None:
        """The part that the workbook's first relationship of that kind points to."""
        return next((found.target for found in self.relationships.values() if found.kind == kind), None)


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
        strays=tuple(name for name in names if isinstance(name, Notice)),
        date1904=properties is not None and is_true(properties.get("date1904")),
        calculation={} if calculation is None else calculation.attrib,
        links=tuple(_links(root, rels)),
    )


def _links(root: Element, rels: Mapping[str, Relationship]) -> Iterator[str]:
    for element in root.findall("{*}externalReferences/{*}externalReference"):
        rel = rels.get(attribute(element, "id") or "")
        yield "" if rel is None or rel.kind != "externalLink" else rel.target


def _workbook_part(parts: Mapping[str, bytes]) -> str:
    found = next((rel.target for rel in relationships(parts).values() if rel.kind == "officeDocument"), None)
    if found is None:
        raise WorkbookError("the file is a zip, but no Excel workbook", hint=SAVE_AS)
    if found not in parts:
        raise WorkbookError(f"the file lacks its workbook part ({found})", hint=REPAIR)
    if found.lower().endswith(".bin"):
        raise WorkbookError("the file is a binary workbook (.xlsb)", hint=SAVE_AS)
    if not tree(parts[found], found).tag.endswith("}workbook"):
        raise WorkbookError("the file is an Office document, but no workbook", hint=SAVE_AS)
    return found


def _sheet_entry(element: Element, rels: Mapping[str, Relationship], parts: Mapping[str, bytes]) -> SheetEntry:
    name = decode(element.get("name", ""))
    if "\n" in name or "\t" in name or printable(name) != name:
        hint = "Rename it in Excel, with letters and digits alone"
        raise WorkbookError(
            f"the name of the sheet {printable(name)!r} holds a character that steers a screen", hint=hint
        )
    rel = rels.get(attribute(element, "id") or "")
    if rel is None or rel.target not in parts:
        raise WorkbookError(f"the sheet {name!r} is missing from the file", hint=REPAIR)
    return SheetEntry(name, rel.target, rel.kind, element.get("state", "visible") == "visible")


def _check_distinct(sheets: tuple[SheetEntry, ...]) -> None:
    names = Counter(sheet.name.casefold() for sheet in sheets)
    parts = Counter(sheet.part for sheet in sheets)
    for sheet in sheets:
        if names[sheet.name.casefold()] > 1 or parts[sheet.part] > 1:
            raise WorkbookError(f"the sheet {sheet.name!r} is in the file twice", hint=REPAIR)


def _defined_name(element: Element, sheets: tuple[SheetEntry, ...]) -> DefinedName | Notice:
    """A name, or a notice where it belongs to a tab that does not exist. `localSheetId` counts all tabs from 0."""
    name, text = decode(element.get("name", "")), decode(element.text or "")
    if "localSheetId" not in element.attrib:
        return DefinedName(name, text)
    position = whole_number(element.get("localSheetId"))
    if position is None or position >= len(sheets):
        return Notice(f"the defined name {name!r} belongs to a sheet that does not exist and is left out")
    return DefinedName(name, text, sheets[position].name)
