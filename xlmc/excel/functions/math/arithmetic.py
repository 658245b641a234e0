"""Signs, roots, powers, logarithms and remainders; `raise_to_power` gives one trial what it gives many."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from xlmc.excel.functions.facts import Domain, EmptyCells, Facts, Repeats
from xlmc.excel.functions.registry import Number, Numbers, Ranges, excel
from xlmc.excel.functions.samples import row_sums
from xlmc.excel.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["raise_to_power"]

_ONE_CELL: Final = Number(ranges=Ranges.ONE_CELL)
_FACTORIALS: Final = np.array([float(math.factorial(n)) for n in range(171)])

excel("ABS", Number, ufunc=np.absolute, facts=Facts(never_errs=True, unrounded=True))(np.absolute)
excel("SIGN", Number, ufunc=np.sign, facts=Facts(never_errs=True, unrounded=True))(np.sign)
excel("SQRT", Number, ufunc=np.sqrt, facts=Facts(measures=True, domain=Domain(0.0)))(np.sqrt)
excel("EXP", Number, ufunc=np.exp, facts=Facts(measures=True))(np.exp)
excel("LN", Number, ufunc=np.log, facts=Facts(measures=True, domain=Domain(0.0, with_ends=False)))(np.log)
excel("LOG10", Number, ufunc=np.log10, facts=Facts(domain=Domain(0.0, with_ends=False)))(np.log10)


@excel("SQRTPI", _ONE_CELL, facts=Facts(domain=Domain(0.0)))
def sqrt_pi(x: Floats) -> Floats:
    """Square root of `x` times π."""
    return np.asarray(np.sqrt(x * np.pi))


@excel("LOG", Number, Number(default=10.0), facts=Facts(domain=Domain(0.0, with_ends=False)))
def log(x: Floats, base: Floats) -> Floats:
    """Logarithm to a base; `#NUM!` unless both are above 0, `#DIV/0!` to base 1.

    Bases 10 and 2 have logarithms of their own, so that `LOG(1000)` is 3 and not one bit less.
    """
    result = np.where(base == 10, np.log10(x), np.where(base == 2, np.log2(x), np.log(x) / np.log(base)))
    return np.where((x <= 0) | (base <= 0), NUM, np.where(base == 1, DIV0, result))


@excel("MOD", Number, Number, ufunc=np.remainder)
def mod(x: Floats, divisor: Floats) -> Floats:
    """Remainder, with the sign of the divisor; `#DIV/0!` by zero.

    It is exact for the doubles, as in Excel since 2010: `MOD(10, 0.1)` is nearly 0.1, for the double 0.1 is a little
    more than a tenth.
    """
    return np.where(divisor == 0, DIV0, np.remainder(x, divisor))


@excel("QUOTIENT", _ONE_CELL, _ONE_CELL, facts=Facts(exact_steps=True))
def quotient(x: Floats, divisor: Floats) -> Floats:
    """Whole part of the quotient, towards zero; `#DIV/0!` by zero."""
    return np.where(divisor == 0, DIV0, np.trunc(x / divisor))


@excel("FACT", Number)
def fact(x: Floats) -> Floats:
    """Factorial of the whole part; `#NUM!` below 0 and above 170."""
    outside = (x < 0) | (x >= _FACTORIALS.size)
    return np.where(outside, NUM, _FACTORIALS[np.where(outside, 0, x).astype(np.intp)])


@excel("SUMSQ", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.ADD_UP, measures=True))
def sum_of_squares(x: Floats, counts: Bools) -> Floats:
    """Sum of the squares, from left to right."""
    return row_sums(np.where(counts, x * x, 0.0))


def raise_to_power(base: Any, exponent: Any) -> Floats:
    """Raise `base` to the power of `exponent`, both of at least one axis; NaN for a negative base and a fraction.

    Where the exponent is one number for all trials, NumPy squares, inverts and takes square roots by other means than
    `pow`, which may differ in the last bit. So each trial gets an exponent of its own.
    """
    base, exponents = np.broadcast_arrays(np.atleast_1d(np.asarray(base, np.float64)), np.asarray(exponent, np.float64))
    powers: Floats = np.where(exponents == 2, base * base, np.power(base, exponents.copy()))
    return powers
