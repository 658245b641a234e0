"""Complex numbers, which Excel keeps as texts: `3+4i`, `-2.5j`, `i`, `7`."""

from __future__ import annotations

import re
from cmath import isfinite
from decimal import Decimal
from typing import Final

from xlmc.errors import ErrorCode

__all__ = ["Read", "common_suffix", "read", "written"]

Read = tuple[complex, str] | ErrorCode
"""A number and its suffix, `i` or `j` ("" when it has none), or why it is none."""

_UNSIGNED: Final = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[Ee][+-]?[0-9]+)?"
_REAL: Final = rf"(?P<real>[+-]?{_UNSIGNED})"
_NUMBER: Final = re.compile(rf"{_REAL}?(?:(?P<imaginary>(?(real)[+-]|[+-]?)(?:{_UNSIGNED})?)(?P<suffix>[ij]))?")
_LONGEST: Final = 21
"""Characters of a coefficient, its sign apart, before it gets an exponent."""


def read(item: object) -> Read:
    """The complex number of an Excel value: a text, a number, or 0 for a blank or an empty text.

    A logical is `#VALUE!`, a text in no such form `#NUM!`.
    """
    match item:
        case None | "":
            return 0j, ""
        case bool():
            return ErrorCode.VALUE
        case str():
            return _parsed(item)
        case float():
            return complex(item), ""
        case _:
            raise TypeError(f"{item!r} is no Excel value")


def _parsed(text: str) -> Read:
    found = _NUMBER.fullmatch(text)
    if found is None:
        return ErrorCode.NUM
    number = complex(_coefficient(found["real"]), _coefficient(found["imaginary"]))
    return (number, found["suffix"] or "") if isfinite(number) else ErrorCode.NUM


def _coefficient(text: str | None) -> float:
    """What stands before a suffix: a number, a sign alone for 1, None for 0."""
    if text is None:
        return 0.0
    return float(text + "1") if text in ("", "+", "-") else float(text)


def common_suffix(*suffixes: str) -> str | ErrorCode:
    """The suffix that all share, numbers without one aside; `#VALUE!` when `i` meets `j`."""
    found = set(suffixes) - {""}
    return ErrorCode.VALUE if len(found) > 1 else "".join(found)


def written(number: complex, suffix: str) -> str | ErrorCode:
    """As Excel writes it, each part to 15 digits; `#NUM!` when a part is not finite."""
    if not isfinite(number):
        return ErrorCode.NUM
    real, imaginary = _digits(number.real), _digits(number.imag)
    if number.imag == 0:
        return real
    imaginary = {"1": "", "-1": "-"}.get(imaginary, imaginary) + (suffix or "i")
    if number.real == 0:
        return imaginary
    return real + ("" if imaginary.startswith("-") else "+") + imaginary


def _digits(x: float) -> str:
    """Up to 15 significant digits, plain as long as they fit, else with an exponent of two digits or more."""
    rounded = Decimal(f"{x + 0.0:.15g}")
    plain = f"{rounded:f}"
    if len(plain.removeprefix("-")) <= _LONGEST:
        return plain
    mantissa, _, exponent = f"{rounded.normalize():E}".partition("E")
    return f"{mantissa}E{int(exponent):+03d}"
