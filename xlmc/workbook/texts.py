"""Texts as the parts of a workbook write them: escapes, rich text, shared strings."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.workbook.safe_xml import tree

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["decode", "run_text", "shared_strings"]

_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{4})_")
_SPACE = "{http://www.w3.org/XML/1998/namespace}space"


def decode(text: str) -> str:
    r"""Undo `_xHHHH_`, which stands for characters that XML cannot hold.

    >>> decode("Initial_x000a_speed")
    'Initial\nspeed'
    """
    if "_x" not in text:
        return text
    decoded = _ESCAPE.sub(lambda found: chr(int(found[1], 16)), text)
    # A pair of escapes may make one character; half a pair makes none that could be printed.
    return decoded.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")


def run_text(text: str, keep_space: bool) -> str:
    """The text of one run. Excel drops white space at its ends unless `xml:space` says to keep it."""
    return decode(text if keep_space else text.strip(" \t\r\n"))


def shared_strings(xml: bytes, part: str) -> list[str]:
    """The shared string table, rich texts as plain ones, without phonetic guides.

    Raises:
        WorkbookError: the part is not XML.
    """
    return ["".join(_runs(item)) for item in tree(xml, part) if item.tag.endswith("}si")]


def _runs(item: Element) -> Iterator[str]:
    for child in item:
        if child.tag.endswith("}t"):
            yield run_text(child.text or "", child.get(_SPACE) == "preserve")
        elif child.tag.endswith("}r"):
            yield from _runs(child)
