"""A formula as Excel shows it: that of its own cell, without the prefixes that only the file has."""

from __future__ import annotations

import re
from typing import Final

from xlmc.address import Cell
from xlmc.formula.shape import text_at
from xlmc.workbook.model import Formula

__all__ = ["shown_formula"]

_REFERENCE: Final = r"(?:'(?:[^']|'')*'!)?[\w.$!:]+"
_TOKEN: Final = re.compile(
    r'"(?:[^"]|"")*"'  # a text
    r"|(?:_xlfn\.)?LAMBDA\((?P<parameters>(?:\s*_xl(?:pm|op)\.[\w.]+\s*,)+)"
    rf"|_xlfn\.ANCHORARRAY\((?P<spilled>{_REFERENCE})\)"
    rf"|_xlfn\.SINGLE\((?P<single>{_REFERENCE})\)"
    r"|'(?:[^']|'')*'"  # a sheet's name
    r"|(?<![\w.])(?P<prefix>(?:_xlfn\.|_xlws\.|_xlpm\.|_xlop\.|_xleta\.)+)",
    re.IGNORECASE,
)
_OPTIONAL: Final = re.compile(r"_xlop\.([\w.]+)", re.IGNORECASE)
_NEEDED: Final = re.compile(r"_xlpm\.", re.IGNORECASE)


def shown_formula(formula: Formula, cell: Cell) -> str:
    """A cell's formula with its `=`; in braces where it was entered with Ctrl-Shift-Enter.

    Args:
        formula: as the file holds it; a shared formula's text is that of another cell.
        cell: that it stands in.
    """
    if formula.array is not None and not formula.dynamic:
        return f"{{={_TOKEN.sub(_shown, formula.text)}}}"
    text = text_at(formula.text, cell.row - formula.row, cell.column - formula.column)
    return f"={_TOKEN.sub(_shown, text)}"


def _shown(found: re.Match[str]) -> str:
    if found["parameters"] is not None:
        return "LAMBDA(" + _NEEDED.sub("", _OPTIONAL.sub(r"[\1]", found["parameters"]))
    if found["spilled"] is not None:
        return f"{_NEEDED.sub('', found['spilled'])}#"
    if found["single"] is not None:
        return f"@{_NEEDED.sub('', found['single'])}"
    return "" if found["prefix"] is not None else found[0]
