"""Read XML from an untrusted file, and the texts in it: no document types, no entities, no traceback.

The parts of a workbook need neither, so any declaration of them is refused before it can do harm. Parts are fed to
the parser piece by piece: a refusal in one piece means that the next is never looked at.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn
from xml.etree import ElementTree
from xml.parsers import expat

from xlmc.errors import WorkbookError, capitalised

__all__ = [
    "REPAIR",
    "attribute",
    "decode",
    "expat_parser",
    "feed",
    "is_true",
    "run_text",
    "shared_strings",
    "tree",
    "whole_number",
]

REPAIR = "Open it in Excel, let Excel repair it, and save it again"
"""The hint for a package that is damaged inside."""

_PIECE = 1 << 16
_DIGITS = re.compile("[0-9]{1,9}")
_ESCAPE = re.compile(r"_x([0-9A-Fa-f]{4})_")
_SPACE = "{http://www.w3.org/XML/1998/namespace}space"
_NOT_XML = (expat.ExpatError, ElementTree.ParseError, ValueError, LookupError)


def tree(xml: bytes, part: str) -> ElementTree.Element:
    """Parse the part; names are `{namespace}local`, and `{*}local` finds them in any namespace.

    Raises:
        WorkbookError: the part is not XML, or declares a document type.
    """
    parser = ElementTree.XMLParser(target=_Builder())
    with _naming_part(part):
        for start in range(0, len(xml), _PIECE):
            parser.feed(xml[start : start + _PIECE])
        root: ElementTree.Element = parser.close()
        return root


def expat_parser() -> expat.XMLParserType:
    """Make a parser for one pass over a large part; names arrive as `namespace local`."""
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_size = _PIECE
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = _refuse
    parser.EntityDeclHandler = _refuse
    return parser


def feed(parser: expat.XMLParserType, xml: bytes, part: str) -> None:
    """Run the parser over the whole part.

    Raises:
        WorkbookError: the part is not XML, or declares a document type.
    """
    with _naming_part(part):
        for start in range(0, len(xml), _PIECE):
            parser.Parse(xml[start : start + _PIECE])
        parser.Parse(b"", True)


def attribute(element: ElementTree.Element, local: str) -> str | None:
    """Return the element's attribute of that local name in any namespace but none, such as `id` for `r:id`."""
    return next((value for key, value in element.items() if key.endswith("}" + local)), None)


def is_true(text: str | None) -> bool:
    """Read an XML boolean; absent is false."""
    return text in ("1", "true", "on")


def whole_number(text: str | None) -> int | None:
    """Read a count or position as XML writes it; None if it is absent, no number, or longer than any in a workbook."""
    return int(text) if text is not None and _DIGITS.fullmatch(text) else None


class _Builder(ElementTree.TreeBuilder):
    def doctype(self, *_: object) -> None:
        _refuse()


def _refuse(*_: object) -> NoReturn:
    raise WorkbookError("A document type or entities are declared, which no workbook needs")


@contextmanager
def _naming_part(part: str) -> Iterator[None]:
    try:
        yield
    except WorkbookError as error:
        if error.where is not None:
            raise
        raise WorkbookError(f"{part}: {capitalised(error.message)}", hint=error.hint or REPAIR) from None
    except _NOT_XML as error:
        raise WorkbookError(f"{part} is not well-formed XML ({error})", hint=REPAIR) from error


def decode(text: str) -> str:
    r"""Undo `_xHHHH_`, which stands for characters that XML cannot hold.

    >>> decode("Initial_x000a_speed")
    'Initial\nspeed'
    """
    if "_x" not in text:
        return text
    decoded = _ESCAPE.sub(lambda match: chr(int(match[1], 16)), text)
    # A pair of escapes may make one character; half a pair makes none that could be printed.
    return decoded.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")


def run_text(text: str, keep_space: bool) -> str:
    """Return the text of one run. Excel drops white space at its ends unless `xml:space` says to keep it."""
    return decode(text if keep_space else text.strip(" \t\r\n"))


def shared_strings(xml: bytes, part: str) -> list[str]:
    """Return the shared string table, rich texts as plain ones, without phonetic guides.

    An element that no table has, around a text or a part of it, makes no difference: were it left out with what it
    holds, every later text would stand under another number.

    Raises:
        WorkbookError: the part is not XML.
    """
    return ["".join(_runs(item)) for item in tree(xml, part).iter() if item.tag.endswith("}si")]


def _runs(item: ElementTree.Element) -> Iterator[str]:
    waiting = [item]
    while waiting:  # and not a recursion, of which a file could ask for too much
        element = waiting.pop()
        if element.tag.endswith("}t"):
            yield run_text(element.text or "", element.get(_SPACE) == "preserve")
        elif not element.tag.endswith("}rPh"):
            waiting += reversed(element)
