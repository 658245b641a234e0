"""The workbook part and its pointers: add sheets with their names at the end, or take some out again."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import chain

from xlmc.errors import WorkbookError
from xlmc.workbook.injection.built_book import SheetName
from xlmc.workbook.injection.namespaces import OFFICE_RELATIONSHIPS
from xlmc.workbook.injection.spans import Element
from xlmc.workbook.injection.splice import SplicedXml, render
from xlmc.workbook.safe_xml import REPAIR

__all__ = ["NewSheet", "add_pointers", "add_sheets", "drop_pointers", "sheet_list"]

_LAST_SHEET_ID = 65534
_BEFORE_NAMES = ("sheets", "functionGroups", "externalReferences")


@dataclass(frozen=True, slots=True)
class NewSheet:
    """A sheet to add: `pointer` is the id of its relationship, `state` None where it is visible."""

    name: str
    pointer: str
    state: str | None
    names: tuple[SheetName, ...]


def add_sheets(xml: bytes, part: str, new: Sequence[NewSheet]) -> bytes:
    """The workbook part with the sheets behind all others.

    Raises:
        WorkbookError: the part is not XML, or holds no list of sheets.
    """
    document = SplicedXml(xml, part)
    sheets = sheet_list(document.root, part)
    _add_view(document, sheets)
    present = len(sheets.children)
    ids = _free_ids(sheets, len(new))
    for sheet, sheet_id in zip(new, ids, strict=True):
        document.append(sheets, _sheet_element(document, sheet, sheet_id))
    _keep_strays_astray(document, present, len(new))
    _add_names(document, [(present + i, name) for i, sheet in enumerate(new) for name in sheet.names])
    return document.result()


def add_pointers(xml: bytes, part: str, targets: Sequence[tuple[str, str]]) -> tuple[bytes, list[str]]:
    """A rels part with pointers to the targets, given as (type, target), and their new ids.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    present = [element.attributes.get("Id", "") for element in document.root.children]
    last = max((int(i[3:]) for i in present if i[:3].casefold() == "rid" and i[3:].isdecimal()), default=0)
    ids = [f"rId{last + 1 + place}" for place in range(len(targets))]
    tag = document.prefix(document.root) + "Relationship"
    for pointer, (kind, target) in zip(ids, targets, strict=True):
        document.append(document.root, render(tag, {"Id": pointer, "Type": kind, "Target": target}))
    return document.result(), ids


def drop_pointers(xml: bytes, part: str, ids: Collection[str]) -> bytes:
    """A rels part without the pointers of these ids.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    for element in document.root.children:
        if element.attributes.get("Id") in ids:
            document.remove(element)
    return document.result()


def sheet_list(root: Element, part: str) -> Element:
    """The element that lists the sheets.

    Raises:
        WorkbookError: there is none.
    """
    sheets = root.find("sheets")
    if sheets is None:
        raise WorkbookError(f"{part} holds no list of sheets", hint=REPAIR)
    return sheets


def _add_view(document: SplicedXml, sheets: Element) -> None:
    # A sheet's view (frozen panes) belongs to a window of the workbook: Excel calls a book without one damaged.
    if document.root.find("bookViews") is None:
        p = document.prefix(document.root)
        document.before(sheets, f"<{p}bookViews><{p}workbookView/></{p}bookViews>".encode())


def _sheet_element(document: SplicedXml, sheet: NewSheet, sheet_id: int) -> bytes:
    prefix = document.prefix_of(OFFICE_RELATIONSHIPS)
    attributes: dict[str, object] = {"name": sheet.name, "sheetId": sheet_id}
    if sheet.state is not None:
        attributes["state"] = sheet.state
    if prefix is None:
        attributes["xmlns:r"] = OFFICE_RELATIONSHIPS
    attributes[f"{prefix or 'r'}:id"] = sheet.pointer
    return render(document.prefix(document.root) + "sheet", attributes)


def _free_ids(sheets: Element, wanted: int) -> list[int]:
    """The numbers behind the last one used, as Excel counts; lower ones where there are no more."""
    used = {int(i) for i in (sheet.attributes.get("sheetId", "") for sheet in sheets.children) if i.isdecimal()}
    last = max(used, default=0)
    free = (number for number in chain(range(last + 1, _LAST_SHEET_ID + 1), range(1, last)) if number not in used)
    return [number for _, number in zip(range(wanted), free, strict=False)]


def _keep_strays_astray(document: SplicedXml, present: int, added: int) -> None:
    """A damaged book may have names of a sheet that does not exist: they must not become names of a new one."""
    holder = document.root.find("definedNames")
    for name in holder.children if holder else ():
        place = name.attributes.get("localSheetId", "")
        if place.isdecimal() and int(place) >= present:
            document.set(name, "localSheetId", int(place) + added)


def _add_names(document: SplicedXml, new: Iterable[tuple[int, SheetName]]) -> None:
    """Put each name where Excel's order wants it: alphabetical, then by sheet."""
    holder = document.root.find("definedNames")
    present = [(_order(element.attributes), element) for element in (holder.children if holder else ())]
    names = sorted((_attributes(place, name) for place, name in new), key=lambda found: _order(found[0]))
    tag = document.prefix(document.root) + "definedName"
    loose = []
    for attributes, text in names:
        fragment = render(tag, attributes, escape(text, quote=False))
        behind = next((element for order, element in present if order > _order(attributes)), None)
        if behind is not None:
            document.before(behind, fragment)
        elif holder is not None:
            document.append(holder, fragment)
        else:
            loose.append(fragment.decode())
    if loose:
        _add_holder(document, "".join(loose))


def _add_holder(document: SplicedXml, content: str) -> None:
    before = [element for local in _BEFORE_NAMES for element in document.root.find_all(local)]
    document.after(before[-1], render(document.prefix(document.root) + "definedNames", {}, content))


def _attributes(place: int, name: SheetName) -> tuple[dict[str, str], str]:
    attributes = {"name": name.name, "localSheetId": str(place)}
    return (attributes | {"hidden": "1"} if name.hidden else attributes), name.text


def _order(attributes: Mapping[str, str]) -> tuple[str, int]:
    place = attributes.get("localSheetId", "")
    return attributes.get("name", "").removeprefix("_xlnm.").casefold(), int(place) if place.isdecimal() else -1
