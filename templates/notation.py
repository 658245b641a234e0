"""Print an Excel formula the way the paper prints its equations.

The printed form is derived from the formula itself, so that the two cannot disagree.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from itertools import pairwise

__all__ = ["printed"]

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_CALL = re.compile(r"\b(SIN|COS|TAN|ATAN2|N)\(")
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
    "=": " = ",
    ",": ", ",
    "^2": "²",
}
_SIGN = re.compile(r">=|<=|<>|\^2|[*+\-><=,]")
_LEADING_MINUS = re.compile(r"(^|\(|[,≥≤<>≠=] ) ?− ")
_ENCLOSED = re.compile(r"\|[^|]*\|| \([^()]*\)$")
"""What stands between bars, and the unit at the end of a notation."""


def printed(formula: str, notation: Mapping[str, str]) -> str:
    """Write a formula as mathematics: `SIN(RADIANS(beta_1-alpha_1))` -> `sin(β1 − α1)`.

    The arctangent of two arguments takes y first, as in mathematics; Excel's takes x first.

    Args:
        formula: in terms of symbols, without `=`.
        notation: symbol -> how it is printed.
    """
    text = _SIGN.sub(lambda sign: _SIGNS[sign[0]], _calls(formula))
    text = _LEADING_MINUS.sub(r"\1−", text)
    alone = _WORD.fullmatch(text) is not None
    return _WORD.sub(lambda word: _word(word[0], notation, alone=alone), text)


def _calls(formula: str) -> str:
    """The formula with those functions that mathematics writes otherwise written so."""
    result = _CALL.search(formula)
    if result is None:
        return formula
    arguments, end = _arguments(formula, result.end())
    name, rest = result[1], _calls(formula[end:])
    return formula[: result.start()] + _AS_MATHEMATICS.get(name, _angle)(name, [*map(_calls, arguments)]) + rest


def _arguments(formula: str, start: int) -> tuple[list[str], int]:
    """The arguments of a function whose first begins at `start`, and where the formula goes on after them."""
    depth, cuts = 0, [start - 1]
    for place in range(start, len(formula)):
        depth += {"(": 1, ")": -1}.get(formula[place], 0)
        if depth < 0 or (depth == 0 and formula[place] == ","):
            cuts.append(place)
        if depth < 0:
            return [formula[first + 1 : last] for first, last in pairwise(cuts)], cuts[-1] + 1
    raise ValueError(f"A bracket stays open in {formula!r}. Close it.")


def _angle(name: str, arguments: list[str]) -> str:
    """`SIN(RADIANS(alpha_1))` -> `SIN(alpha_1)`: the unit of an angle stands beside it."""
    (angle,) = arguments
    if angle.startswith("RADIANS("):
        (inner,), end = _arguments(angle, len("RADIANS("))
        if end == len(angle):
            angle = f"{inner}°" if inner.isdigit() else inner
    return f"{name}({angle})"


_AS_MATHEMATICS: Mapping[str, Callable[[str, list[str]], str]] = {
    "ATAN2": lambda name, arguments: f"{name}({','.join(reversed(arguments))})",
    "N": lambda _, arguments: arguments[0],
}
"""Name of a function -> how its call is written, where it is no function of an angle."""


def _word(word: str, notation: Mapping[str, str], *, alone: bool) -> str:
    result = notation.get(word) or _FUNCTIONS.get(word) or (word if word in notation else word.lower())
    return result if alone or not _is_expression(result) else f"({result})"


def _is_expression(notation: str) -> bool:
    """Whether a quantity is printed as a difference, say, which needs brackets inside of an equation."""
    return any(sign in _ENCLOSED.sub("", notation) for sign in "−+·/")
