"""Print an Excel formula the way the paper prints its equations.

The printed form is derived from the formula itself, so that the two cannot disagree.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

__all__ = ["printed"]

_ANGLE_FUNCTION = re.compile(r"\b(SIN|COS)\(RADIANS\(([^()]*)\)\)")
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_FUNCTIONS = {"SQRT": "√", "RADIANS": "rad", "DEGREES": "deg", "ABS": "abs"}
_SIGNS = {
    "*": " · ",
    "+": " + ",
    "-": " − ",
    ">=": " ≥ ",
    "<=": " ≤ ",
    "<>": " ≠ ",
    ">": " > ",
    "<": " < ",
    ",": ", ",
    "^2": "²",
}
_SIGN = re.compile(r">=|<=|<>|\^2|[*+\-><,]")
_LEADING_MINUS = re.compile(r"(^|\(|[,≥≤<>≠] ) ?− ")


def printed(formula: str, notation: Mapping[str, str]) -> str:
    """`SIN(RADIANS(beta_1-alpha_1))` -> `sin(β1 − α1)`.

    Args:
        formula: in terms of symbols, without `=`.
        notation: symbol -> how it is printed.
    """
    text = _ANGLE_FUNCTION.sub(_angle, formula)
    text = _SIGN.sub(lambda sign: _SIGNS[sign[0]], text)
    text = _LEADING_MINUS.sub(r"\1−", text)
    return _WORD.sub(lambda word: _word(word[0], notation), text)


def _angle(function: re.Match[str]) -> str:
    name, angle = function.groups()
    return f"{name}({angle}{'°' if angle.isdigit() else ''})"


def _word(word: str, notation: Mapping[str, str]) -> str:
    return notation.get(word) or _FUNCTIONS.get(word) or (word if word in notation else word.lower())
