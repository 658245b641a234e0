"""Complex numbers: how texts hold them, and functions of them.

The functions give `#NUM!` where they have no value: at poles, and for overflows.
"""

from __future__ import annotations

import cmath
import math
import re
from cmath import isfinite
from collections.abc import Callable, Sequence
from decimal import Decimal
from functools import reduce
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.excel.functions.per_element import per_object
from xlmc.excel.functions.registry import Anything, Cells, Kind, Parameter, excel
from xlmc.excel.functions.toolpak import OneCell, strict_number
from xlmc.excel.functions.values import Value, from_objects

__all__ = ["common_suffix", "read", "write"]

_Read = tuple[complex, str] | ErrorCode
"""A number and its suffix, `i` or `j` ("" if it has none), or the error of a value that is no number."""

_UNSIGNED: Final = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[Ee][+-]?[0-9]+)?"
_REAL: Final = rf"(?P<real>[+-]?{_UNSIGNED})"
_NUMBER: Final = re.compile(rf"{_REAL}?(?:(?P<imaginary>(?(real)[+-]|[+-]?)(?:{_UNSIGNED})?)(?P<suffix>[ij]))?")
_LONGEST: Final = 21
"""Characters of a coefficient, its sign apart, before it gets an exponent."""


def read(item: object) -> _Read:
    """Read a complex number from an Excel value: a text, or a number; 0 for a blank or an empty text.

    A logical is `#VALUE!`, any other text `#NUM!`.
    """
    match item:
        case None | "":
            return 0j, ""
        case bool():
            return ErrorCode.VALUE
        case str():
            return _parse(item)
        case float():
            return complex(item), ""
        case _:
            raise TypeError(f"{item!r} is no Excel value")


def _parse(text: str) -> _Read:
    match = _NUMBER.fullmatch(text)
    if match is None:
        return ErrorCode.NUM
    number = complex(_read_coefficient(match["real"]), _read_coefficient(match["imaginary"]))
    return (number, match["suffix"] or "") if isfinite(number) else ErrorCode.NUM


def _read_coefficient(text: str | None) -> float:
    """Read the text before a suffix: a number, a sign alone for 1, None for 0."""
    if text is None:
        return 0.0
    return float(text + "1") if text in ("", "+", "-") else float(text)


def common_suffix(*suffixes: str) -> str | ErrorCode:
    """Return the suffix of all numbers that have one; `#VALUE!` if some have `i` and some `j`."""
    result = set(suffixes) - {""}
    return ErrorCode.VALUE if len(result) > 1 else "".join(result)


def write(number: complex, suffix: str) -> str | ErrorCode:
    """Write a number as Excel does, each part to 15 digits; `#NUM!` if a part is not finite."""
    if not isfinite(number):
        return ErrorCode.NUM
    real, imaginary = _write_part(number.real), _write_part(number.imag)
    if number.imag == 0:
        return real
    imaginary = {"1": "", "-1": "-"}.get(imaginary, imaginary) + (suffix or "i")
    if number.real == 0:
        return imaginary
    return real + ("" if imaginary.startswith("-") else "+") + imaginary


def _write_part(x: float) -> str:
    """Write up to 15 significant digits; with an exponent, of two digits or more, if they are too long without."""
    rounded = Decimal(f"{x + 0.0:.15g}")
    plain = f"{rounded:f}"
    if len(plain.removeprefix("-")) <= _LONGEST:
        return plain
    mantissa, _, exponent = f"{rounded.normalize():E}".partition("E")
    return f"{mantissa}E{int(exponent):+03d}"


@excel("COMPLEX", OneCell, OneCell, OneCell(default=None), returns=Kind.TEXT)
@per_object
def complex_(real: object, imaginary: object, suffix: object = None) -> str | ErrorCode:
    """Write a complex number from its coefficients; `#VALUE!` for another suffix than i or j."""
    x, y = strict_number(real), strict_number(imaginary)
    if isinstance(x, ErrorCode) or isinstance(y, ErrorCode):
        return x if isinstance(x, ErrorCode) else ErrorCode(int(y))
    if suffix not in (None, "", "i", "j"):
        return ErrorCode.VALUE
    return write(complex(x, y), str(suffix or "i"))


def _register_measure(name: str, meaning: str, function: Callable[[complex], float | ErrorCode]) -> None:
    """Register a function that gives a real number for a complex one."""

    def measure(item: object) -> float | ErrorCode:
        result = read(item)
        return result if isinstance(result, ErrorCode) else function(result[0])

    measure.__doc__ = meaning
    excel(name, OneCell)(per_object(measure))


_register_measure("IMREAL", "The real coefficient.", lambda z: z.real)
_register_measure("IMAGINARY", "The imaginary coefficient.", lambda z: z.imag)
_register_measure("IMABS", "The distance from 0.", abs)
_register_measure(
    "IMARGUMENT", "The angle, above -π and up to π; `#DIV/0!` of 0.", lambda z: cmath.phase(z) if z else ErrorCode.DIV0
)


def _apply(function: Callable[..., complex], numbers: Sequence[_Read], *more: float) -> str | ErrorCode:
    """Write what a function gives for complex numbers; an error if one is no number, or if their suffixes differ."""
    error = next((number for number in numbers if isinstance(number, ErrorCode)), None)
    if error is not None:
        return error
    suffix = common_suffix(*(number[1] for number in numbers if not isinstance(number, ErrorCode)))
    if isinstance(suffix, ErrorCode):
        return suffix
    try:
        result = function(*(number[0] for number in numbers if not isinstance(number, ErrorCode)), *more)
    except (ArithmeticError, ValueError):  # what cmath raises at poles and for overflows
        return ErrorCode.NUM
    return write(result, suffix)


def _register(name: str, meaning: str, function: Callable[..., complex], *parameters: Parameter) -> None:
    """Register a function that gives a complex number for one or two complex ones."""

    def apply(*items: object) -> str | ErrorCode:
        return _apply(function, [read(item) for item in items])

    apply.__doc__ = meaning
    excel(name, *(parameters or (OneCell,)), returns=Kind.TEXT)(per_object(apply))


def _square_root(z: complex) -> complex:
    """Compute the root from length and angle, as Excel documents it: that of -1 has a real part of 6E-17."""
    return cmath.rect(math.sqrt(abs(z)), cmath.phase(z) / 2)


def _binary_logarithm(z: complex) -> complex:
    return complex(math.log2(abs(z)), cmath.phase(z) / math.log(2))


_register("IMCONJUGATE", "The number with the imaginary part reversed.", lambda z: z.conjugate())
_register("IMSQRT", "The square root.", _square_root)
_register("IMEXP", "e to the power of the number.", cmath.exp)
_register("IMLN", "The natural logarithm.", cmath.log)
_register("IMLOG10", "The logarithm to base 10.", cmath.log10)
_register("IMLOG2", "The logarithm to base 2.", _binary_logarithm)
_register("IMSIN", "The sine.", cmath.sin)
_register("IMCOS", "The cosine.", cmath.cos)
_register("IMTAN", "The tangent.", cmath.tan, Anything)
_register("IMSEC", "1 / cosine.", lambda z: 1 / cmath.cos(z), Anything)
_register("IMCSC", "1 / sine.", lambda z: 1 / cmath.sin(z), Anything)
_register("IMCOT", "1 / tangent.", lambda z: 1 / cmath.tan(z), Anything)
_register("IMSINH", "The hyperbolic sine.", cmath.sinh, Anything)
_register("IMCOSH", "The hyperbolic cosine.", cmath.cosh, Anything)
_register("IMSECH", "1 / hyperbolic cosine.", lambda z: 1 / cmath.cosh(z), Anything)
_register("IMCSCH", "1 / hyperbolic sine.", lambda z: 1 / cmath.sinh(z), Anything)
_register("IMSUB", "The difference.", lambda z, w: z - w, OneCell, OneCell)
_register("IMDIV", "The quotient.", lambda z, w: z / w, OneCell, OneCell)


def _raise_to(z: complex, power: float) -> complex:
    """Compute a power from length and angle, as Excel documents it."""
    if z == 0 and power == 0:
        raise ValueError("0^0")
    return cmath.rect(abs(z) ** power, cmath.phase(z) * power)


@excel("IMPOWER", OneCell, OneCell, returns=Kind.TEXT)
@per_object
def power(item: object, exponent: object) -> str | ErrorCode:
    """Raise the number to a real power."""
    number, value = read(item), strict_number(exponent)
    if isinstance(value, ErrorCode) and not isinstance(number, ErrorCode):
        return value
    return _apply(_raise_to, [number], float(value))


def _register_fold(name: str, meaning: str, operation: Callable[[complex, complex], complex]) -> None:
    """Register an operation on any number of complex numbers, which ignores blank cells."""

    def fold(*values: Value) -> Value:
        rows = [value.objects().reshape(value.shape[0], -1) for value in values]
        out = np.empty(max(len(row) for row in rows), object)
        for trial in range(out.size):
            out[trial] = _fold(operation, [row[trial if len(row) > 1 else 0] for row in rows])
        return from_objects(out)

    fold.__doc__ = meaning
    excel(name, Cells(repeat=True), returns=Kind.TEXT)(fold)


def _fold(operation: Callable[[complex, complex], complex], rows: Sequence[NDArray[Any]]) -> str | ErrorCode:
    items = [item for row in rows for item in row if item is not None]
    numbers = [item if isinstance(item, ErrorCode) else read(item) for item in items]
    return _apply(lambda *z: reduce(operation, z or (0j,)), numbers)


_register_fold("IMSUM", "The sum.", lambda z, w: z + w)
_register_fold("IMPRODUCT", "The product.", lambda z, w: z * w)
