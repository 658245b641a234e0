"""Functions of complex numbers. Where there is no value, a pole or an overflow, they are `#NUM!`."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.engineering.complex_numbers import Read, common_suffix, read, written
from xlmc.functions.registry import Anything, Cells, Kind, Parameter, excel
from xlmc.functions.toolpak import OneCell, number_of, per_object
from xlmc.functions.values import Value, from_objects

__all__: list[str] = []


@excel("COMPLEX", OneCell, OneCell, OneCell(default=None), returns=Kind.TEXT)
@per_object
def complex_(real: object, imaginary: object, suffix: object = None) -> str | ErrorCode:
    """The text of a complex number from its coefficients; `#VALUE!` for another suffix than i or j."""
    x, y = number_of(real), number_of(imaginary)
    if isinstance(x, ErrorCode) or isinstance(y, ErrorCode):
        return x if isinstance(x, ErrorCode) else ErrorCode(int(y))
    if suffix not in (None, "", "i", "j"):
        return ErrorCode.VALUE
    return written(complex(x, y), str(suffix or "i"))


def _measure(name: str, meaning: str, function: Callable[[complex], float | ErrorCode]) -> None:
    """Register a real number of a complex one."""

    def measure(item: object) -> float | ErrorCode:
        found = read(item)
        return found if isinstance(found, ErrorCode) else function(found[0])

    measure.__doc__ = meaning
    excel(name, OneCell)(per_object(measure))


_measure("IMREAL", "The real coefficient.", lambda z: z.real)
_measure("IMAGINARY", "The imaginary coefficient.", lambda z: z.imag)
_measure("IMABS", "The distance from 0.", abs)
_measure(
    "IMARGUMENT", "The angle, above -π and up to π; `#DIV/0!` of 0.", lambda z: cmath.phase(z) if z else ErrorCode.DIV0
)


def _applied(function: Callable[..., complex], numbers: Sequence[Read], *more: float) -> str | ErrorCode:
    """The text of a function of complex numbers; the first that is none, or unlike suffixes, make an error."""
    error = next((number for number in numbers if isinstance(number, ErrorCode)), None)
    if error is not None:
        return error
    suffix = common_suffix(*(number[1] for number in numbers if not isinstance(number, ErrorCode)))
    if isinstance(suffix, ErrorCode):
        return suffix
    try:
        result = function(*(number[0] for number in numbers if not isinstance(number, ErrorCode)), *more)
    except (ArithmeticError, ValueError):  # how cmath tells of poles and overflows
        return ErrorCode.NUM
    return written(result, suffix)


def _register(name: str, meaning: str, function: Callable[..., complex], *parameters: Parameter) -> None:
    """Register a complex number of one or two complex ones."""

    def apply(*items: object) -> str | ErrorCode:
        return _applied(function, [read(item) for item in items])

    apply.__doc__ = meaning
    excel(name, *(parameters or (OneCell,)), returns=Kind.TEXT)(per_object(apply))


def _square_root(z: complex) -> complex:
    """By length and angle, as Excel documents it, so that the root of -1 keeps a real part of 6E-17."""
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


def _to_the_power(z: complex, power: float) -> complex:
    """By length and angle, as Excel documents it."""
    if z == 0 and power == 0:
        raise ValueError("0^0")
    return cmath.rect(abs(z) ** power, cmath.phase(z) * power)


@excel("IMPOWER", OneCell, OneCell, returns=Kind.TEXT)
@per_object
def power(item: object, exponent: object) -> str | ErrorCode:
    """The number to a real power."""
    number, found = read(item), number_of(exponent)
    if isinstance(found, ErrorCode) and not isinstance(number, ErrorCode):
        return found
    return _applied(_to_the_power, [number], float(found))


def _folded(name: str, meaning: str, operation: Callable[[complex, complex], complex]) -> None:
    """Register an operation on any number of complex numbers; blank cells do not count."""

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
    return _applied(lambda *z: reduce(operation, z or (0j,)), numbers)


_folded("IMSUM", "The sum.", lambda z, w: z + w)
_folded("IMPRODUCT", "The product.", lambda z, w: z * w)
