"""Texts that a program keeps in hidden pictures of a sheet's legacy drawing (VML), beside the sheet's comments.

A picture is a shape whose client data hold a script text. Excel keeps such texts and shows them to nobody.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.package import relationships
from xlmc.excel.workbook.safe_xml import decode, tree
from xlmc.excel.workbook.structure import Structure

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["DamagedDrawing", "HiddenScript", "hidden_scripts", "scripts_of_sheet"]

_OPEN_BREAK: Final = re.compile(rb"<br\s*>", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class HiddenScript:
    """The script text of one shape.

    Attributes:
        sheet: on whose drawing it lies.
        shape: its name.
        text: the text, as the file holds it.
    """

    sheet: str
    shape: str
    text: str


@dataclass(frozen=True, slots=True)
class DamagedDrawing:
    """A drawing that cannot be read, and why."""

    sheet: str
    reason: str


def hidden_scripts(parts: Mapping[str, bytes], structure: Structure) -> Iterator[HiddenScript | DamagedDrawing]:
    """Return the script texts of all worksheets, in tab order; shapes in the order of the file.

    Args:
        parts: of the package.
        structure: of its workbook part.
    """
    for entry in structure.worksheets:
        yield from scripts_of_sheet(parts, entry.name, entry.part)


def scripts_of_sheet(parts: Mapping[str, bytes], name: str, part: str) -> Iterator[HiddenScript | DamagedDrawing]:
    """Return the script texts of the worksheet `name`, whose part is `part`, in the order of the file."""
    try:
        targets = [rel.target for rel in relationships(parts, part).values() if rel.kind == "vmlDrawing"]
        for target in targets:
            if target not in parts:
                yield DamagedDrawing(name, f"the drawing {target} is missing from the file")
            elif b"ScriptText" in parts[target] or b"\0" in parts[target][:4]:
                yield from _of_drawing(name, _root(parts[target], target))
    except WorkbookError as error:
        yield DamagedDrawing(name, error.message)


def _root(xml: bytes, part: str) -> Element:
    """Return the drawing's root. Excel itself may leave a line break in a comment open, as HTML does.

    Raises:
        WorkbookError: it is no XML even so.
    """
    try:
        return tree(xml, part)
    except WorkbookError:
        if not _OPEN_BREAK.search(xml):
            raise
        return tree(_OPEN_BREAK.sub(b"<br/>", xml), part)


def _of_drawing(sheet: str, root: Element) -> Iterator[HiddenScript]:
    for shape in root.iter():
        if not (isinstance(shape.tag, str) and shape.tag.endswith("}shape")):
            continue
        text = shape.find("{*}ClientData/{*}ScriptText")
        if text is not None:
            yield HiddenScript(sheet, decode(shape.get("id", "")), text.text or "")
