"""Values and texts as the parts of a workbook write them: cells by their type, escapes, rich text, shared strings."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING

from xlmc.errors import ErrorCode
from xlmc.workbook.safe_xml import tree, whole_number
from xlmc.workbook.workbook import CellValue

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

__all__ = ["CellContext", "convert", "decode", "run_text", "shared_strings"]

_LOGICAL = {"1": True, "0": False, "true": True, "false": False}


@dataclass(frozen=True, slots=True)
class CellContext:
    """What the cells of a sheet need from the rest of the workbook.

    Attributes:
        strings: the shared string table.
        dynamic_marks: the values of `cm` that mark a dynamic-array formula.
        date1904: dates count from 1904 instead of 1900.
    """

    strings: Sequence[str] = ()
    dynamic_marks: frozenset[str] = frozenset()
    date1904: bool = False


def convert(kind: str, raw: str, context: CellContext) -> CellValue:
    """The value that `raw` stands for in a cell of type `kind` (the attribute `t`).

    Raises:
        ValueError: `raw` is no value of that type, or there is no such type.
    """
    converter = _CONVERTERS.get(kind)
    if converter is None:
        raise ValueError(f"is of the unknown type {kind!r}")
    return converter(raw, context)


def _number(raw: str, _: CellContext) -> CellValue:
    if not raw:
        return None
    try:
        value = float(raw)
    except ValueError:
        value = float("nan")
    if not isfinite(value):
        raise ValueError(f"holds {raw!r} where a number should be")
    return value


def _logical(raw: str, _: CellContext) -> CellValue:
    if raw not in _LOGICAL:
        raise ValueError(f"holds {raw!r} where TRUE (1) or FALSE (0) should be")
    return _LOGICAL[raw]


def _error(raw: str, _: CellContext) -> CellValue:
    # Excel has error values without a number of their own (#FIELD!, #BUSY!, #PYTHON!): for a model all are #VALUE!.
    try:
        return ErrorCode.from_text(raw)
    except ValueError:
        return ErrorCode.VALUE


def _shared(raw: str, context: CellContext) -> CellValue:
    number = whole_number(raw)
    if number is None or number >= len(context.strings):
        raise ValueError(f"holds a text that the workbook does not (number {raw!r} of {len(context.strings)})")
    return context.strings[number]


def _date(raw: str, context: CellContext) -> CellValue:
    from openpyxl.utils.datetime import MAC_EPOCH, WINDOWS_EPOCH, from_ISO8601, to_excel  # slow to import

    try:
        return float(to_excel(from_ISO8601(raw), MAC_EPOCH if context.date1904 else WINDOWS_EPOCH))
    except (ValueError, TypeError, OverflowError):
        raise ValueError(f"holds {raw!r} where a date should be") from None


def _text(raw: str, _: CellContext) -> CellValue:
    return decode(raw)


def _inline(raw: str, _: CellContext) -> CellValue:
    return raw  # its runs were decoded one by one


_CONVERTERS: dict[str, Callable[[str, CellContext], CellValue]] = {
    "n": _number,
    "b": _logical,
    "e": _error,
    "s": _shared,
    "str": _text,
    "inlineStr": _inline,
    "d": _date,
}


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
