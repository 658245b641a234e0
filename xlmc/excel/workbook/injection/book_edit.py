"""The workbook part and its pointers: add sheets with their names at the end, find result sheets, take them out again.

Each result sheet has a hidden name of its own, `_xlmc_result`, whose text is the sheet's name. Excel and LibreOffice
keep such names. A sheet that a person copied or renamed no longer has the name in its mark: it counts as theirs.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import chain

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.injection.splice import OFFICE_RELATIONSHIPS, Element, SplicedXml, render
from xlmc.excel.workbook.injection.strict import STRICT_MAIN, strict_type
from xlmc.excel.workbook.safe_xml import REPAIR
from xlmc.excel.workbook.workbook import DefinedName

__all__ = [
    "NewSheet",
    "add_pointers",
    "add_sheets",
    "drop_pointers",
    "mark",
    "marked_names",
    "marked_sheets",
    "sheet_list",
    "without_sheets",
]

_LAST_SHEET_ID = 65534
_BEFORE_NAMES = ("sheets", "functionGroups", "externalReferences")


@dataclass(frozen=True, slots=True)
class SheetName:
    """A defined name of one sheet, such as its print titles; `text` is what it stands for."""

    name: str
    text: str
    hidden: bool = False


@dataclass(frozen=True, slots=True)
class NewSheet:
    """A sheet to add: `pointer` is the id of its relationship, `state` None if it is visible."""

    name: str
    pointer: str
    state: str | None
    names: tuple[SheetName, ...]


def add_sheets(xml: bytes, part: str, new: Sequence[NewSheet]) -> bytes:
    """Return the workbook part with the sheets behind all others.

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
    _keep_unlisted_apart(document, present, len(new))
    _add_names(document, [(present + i, name) for i, sheet in enumerate(new) for name in sheet.names])
    return document.result()


def add_pointers(xml: bytes, part: str, targets: Sequence[tuple[str, str]]) -> tuple[bytes, list[str]]:
    """Return a rels part with pointers to the targets, given as (type, target), and their new ids.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    present = [element.attributes.get("Id", "") for element in document.root.children]
    last = max((int(i[3:]) for i in present if i[:3].casefold() == "rid" and i[3:].isdecimal()), default=0)
    ids = [f"rId{last + 1 + index}" for index in range(len(targets))]
    tag = document.prefix(document.root) + "Relationship"
    for pointer, (kind, target) in zip(ids, targets, strict=True):
        document.append(document.root, render(tag, {"Id": pointer, "Type": kind, "Target": target}))
    return document.result(), ids


def drop_pointers(xml: bytes, part: str, ids: Collection[str]) -> bytes:
    """Return a rels part without the pointers of these ids.

    Raises:
        WorkbookError: the part is not XML.
    """
    document = SplicedXml(xml, part)
    for element in document.root.children:
        if element.attributes.get("Id") in ids:
            document.remove(element)
    return document.result()


def sheet_list(root: Element, part: str) -> Element:
    """Return the element that lists the sheets.

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
    namespace = strict_type(OFFICE_RELATIONSHIPS) if document.root.namespace == STRICT_MAIN else OFFICE_RELATIONSHIPS
    prefix = document.prefix_of(namespace)
    attributes: dict[str, object] = {"name": sheet.name, "sheetId": sheet_id}
    if sheet.state is not None:
        attributes["state"] = sheet.state
    if prefix is None:
        attributes["xmlns:r"] = namespace
    attributes[f"{prefix or 'r'}:id"] = sheet.pointer
    return render(document.prefix(document.root) + "sheet", attributes)


def _free_ids(sheets: Element, wanted: int) -> list[int]:
    """Yield the numbers behind the last one used, as Excel counts; lower ones where there are no more."""
    used = {int(i) for i in (sheet.attributes.get("sheetId", "") for sheet in sheets.children) if i.isdecimal()}
    last = max(used, default=0)
    free = (number for number in chain(range(last + 1, _LAST_SHEET_ID + 1), range(1, last)) if number not in used)
    return [number for _, number in zip(range(wanted), free, strict=False)]


def _keep_unlisted_apart(document: SplicedXml, present: int, added: int) -> None:
    """Keep names of sheets that do not exist, as damaged books have, from becoming names of a new sheet."""
    holder = document.root.find("definedNames")
    for name in holder.children if holder else ():
        index = name.attributes.get("localSheetId", "")
        if index.isdecimal() and int(index) >= present:
            document.set(name, "localSheetId", int(index) + added)


def _add_names(document: SplicedXml, new: Iterable[tuple[int, SheetName]]) -> None:
    """Add each name at its place in Excel's order: alphabetical, then by sheet."""
    holder = document.root.find("definedNames")
    present = [(_order(element.attributes), element) for element in (holder.children if holder else ())]
    names = sorted((_attributes(index, name) for index, name in new), key=lambda result: _order(result[0]))
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


def _attributes(index: int, name: SheetName) -> tuple[dict[str, str], str]:
    attributes = {"name": name.name, "localSheetId": str(index)}
    return (attributes | {"hidden": "1"} if name.hidden else attributes), name.text


def _order(attributes: Mapping[str, str]) -> tuple[str, int]:
    index = attributes.get("localSheetId", "")
    return attributes.get("name", "").removeprefix("_xlnm.").casefold(), int(index) if index.isdecimal() else -1


_MARK = "_xlmc_result"


def mark(sheet: str) -> SheetName:
    """Return the name that says the sheet of this name is a result sheet."""
    return SheetName(_MARK, _text(sheet), hidden=True)


def marked_sheets(root: Element, part: str) -> list[int]:
    """Return the positions of the result sheets among all sheets, in order.

    Raises:
        WorkbookError: the workbook part holds no list of sheets.
    """
    marks = {
        (element.attributes.get("localSheetId"), element.text)
        for element in _children(root, "definedNames")
        if element.attributes.get("name") == _MARK
    }
    sheets = enumerate(sheet_list(root, part).children)
    return [index for index, sheet in sheets if (str(index), _text(sheet.attributes.get("name", ""))) in marks]


def marked_names(names: Iterable[DefinedName]) -> list[str]:
    """Return the names of the result sheets, by the defined names of a workbook."""
    marks = (name for name in names if name.name == _MARK)
    return [mark.sheet for mark in marks if mark.sheet is not None and mark.text == _text(mark.sheet)]


def without_sheets(document: SplicedXml, gone: Sequence[int]) -> bytes:
    """Return the workbook part without the sheets at these positions and without their names; other positions
    close up.
    """
    sheets = _children(document.root, "sheets")
    left = [index for index in range(len(sheets)) if index not in gone]
    visible = next((index for index in left if sheets[index].attributes.get("state", "visible") == "visible"), None)
    for index in gone:
        document.remove(sheets[index])
    _close_up_names(document, gone)
    _close_up_views(document, gone, shown=left.index(visible) if visible is not None else 0)
    return document.result()


def _close_up_names(document: SplicedXml, gone: Sequence[int]) -> None:
    holder, names = document.root.find("definedNames"), _children(document.root, "definedNames")
    lost = [name for name in names if _index_of(name) in gone]
    if holder is not None and len(lost) == len(names):
        document.remove(holder)
        return
    for name in names:
        index = _index_of(name)
        if name in lost:
            document.remove(name)
        elif index is not None:
            _change(document, name, "localSheetId", index - bisect_left(gone, index))


def _close_up_views(document: SplicedXml, gone: Sequence[int], shown: int) -> None:
    """Have a window that showed a sheet that is gone show the first visible one."""
    for view in _children(document.root, "bookViews"):
        for attribute in ("activeTab", "firstSheet"):
            text = view.attributes.get(attribute, "0")
            index = int(text) if text.isdecimal() else 0
            _change(document, view, attribute, shown if index in gone else index - bisect_left(gone, index))


def _change(document: SplicedXml, element: Element, attribute: str, index: int) -> None:
    if element.attributes.get(attribute, "0") != str(index):
        document.set(element, attribute, index)


def _index_of(name: Element) -> int | None:
    text = name.attributes.get("localSheetId", "")
    return int(text) if text.isdecimal() else None


def _children(root: Element, local: str) -> list[Element]:
    holder = root.find(local)
    return [] if holder is None else holder.children


def _text(sheet: str) -> str:
    doubled = sheet.replace('"', '""')
    return f'"{doubled}"'
