"""Result sheets in the workbook part: marked when they are added, found by their mark, taken out again.

Each result sheet has a hidden name of its own, `_xlmc_result`, whose text is the sheet's name. Excel and LibreOffice
keep such names. A sheet that a person copied or renamed no longer has the name in its mark: it counts as theirs.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence

from xlmc.workbook.injection.book_edit import sheet_list
from xlmc.workbook.injection.built_book import SheetName
from xlmc.workbook.injection.spans import Element
from xlmc.workbook.injection.splice import SplicedXml
from xlmc.workbook.model import DefinedName

__all__ = ["mark", "marked_names", "marked_sheets", "without_sheets"]

_MARK = "_xlmc_result"


def mark(sheet: str) -> SheetName:
    """The name that says the sheet of this name is a result sheet."""
    return SheetName(_MARK, _text(sheet), hidden=True)


def marked_sheets(root: Element, part: str) -> list[int]:
    """The positions of the result sheets among all sheets, in order.

    Raises:
        WorkbookError: the workbook part holds no list of sheets.
    """
    marks = {
        (element.attributes.get("localSheetId"), element.text)
        for element in _children(root, "definedNames")
        if element.attributes.get("name") == _MARK
    }
    sheets = enumerate(sheet_list(root, part).children)
    return [place for place, sheet in sheets if (str(place), _text(sheet.attributes.get("name", ""))) in marks]


def marked_names(names: Iterable[DefinedName]) -> list[str]:
    """The names of the result sheets, by the defined names of a workbook."""
    marks = (name for name in names if name.name == _MARK)
    return [mark.sheet for mark in marks if mark.sheet is not None and mark.text == _text(mark.sheet)]


def without_sheets(document: SplicedXml, gone: Sequence[int]) -> bytes:
    """The workbook part without the sheets at these positions and without their names; other positions close up."""
    sheets = _children(document.root, "sheets")
    left = [place for place in range(len(sheets)) if place not in gone]
    visible = next((place for place in left if sheets[place].attributes.get("state", "visible") == "visible"), None)
    for place in gone:
        document.remove(sheets[place])
    _close_up_names(document, gone)
    _close_up_views(document, gone, shown=left.index(visible) if visible is not None else 0)
    return document.result()


def _close_up_names(document: SplicedXml, gone: Sequence[int]) -> None:
    holder, names = document.root.find("definedNames"), _children(document.root, "definedNames")
    lost = [name for name in names if _place(name) in gone]
    if holder is not None and len(lost) == len(names):
        document.remove(holder)
        return
    for name in names:
        place = _place(name)
        if name in lost:
            document.remove(name)
        elif place is not None:
            _change(document, name, "localSheetId", place - bisect_left(gone, place))


def _close_up_views(document: SplicedXml, gone: Sequence[int], shown: int) -> None:
    """A window that showed a sheet that is gone shows the first visible one."""
    for view in _children(document.root, "bookViews"):
        for attribute in ("activeTab", "firstSheet"):
            text = view.attributes.get(attribute, "0")
            place = int(text) if text.isdecimal() else 0
            _change(document, view, attribute, shown if place in gone else place - bisect_left(gone, place))


def _change(document: SplicedXml, element: Element, attribute: str, place: int) -> None:
    if element.attributes.get(attribute, "0") != str(place):
        document.set(element, attribute, place)


def _place(name: Element) -> int | None:
    text = name.attributes.get("localSheetId", "")
    return int(text) if text.isdecimal() else None


def _children(root: Element, local: str) -> list[Element]:
    holder = root.find(local)
    return [] if holder is None else holder.children


def _text(sheet: str) -> str:
    doubled = sheet.replace('"', '""')
    return f'"{doubled}"'
