"""Rounding to digits and to multiples.

Excel rounds the number that it shows, which has 15 significant digits, not the double behind it: `ROUND(1.005, 2)` is
1.01 and `INT(880000000*0.00849/3)` is 2490400, although both doubles lie just below. So a number that lies less than
half a unit of its 15th digit below a boundary counts as on it. Where doubles cannot tell on which side of that half a
unit a number lies, as for `TRUNC(0.09999999999999995, 1)`, it is computed in decimals.
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import ROUND_HALF_UP, Context, Decimal
from typing import Final

import numpy as np

from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Number, Ranges, excel
from xlmc.excel.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["DECADES", "FIFTEEN_DIGITS", "HALF_OF_15TH_DIGIT", "LAST_BIT", "NO_FRACTION", "TENS"]

_ONE_CELL: Final = Number(ranges=Ranges.ONE_CELL)
TENS: Final = np.array([float(f"1e{n}") for n in range(309)])
"""The powers of ten that a double holds, from 1 on."""

DECADES: Final = np.array([float(f"1e{n}") for n in range(-290, 309)])
"""Where numbers get one digit more; below the first, half a unit of the 15th digit counts as 0."""
HALF_OF_15TH_DIGIT: Final = np.array([0.0, *(float(f"5e{n - 15}") for n in range(-290, 309))])
"""Half a unit of the 15th digit of numbers below the first decade, and from each decade on."""

_SHOWN: Final = Context(prec=15, rounding=ROUND_HALF_UP)
LAST_BIT: Final = 2.3e-16
"""A share of a double: more than its last bit, less than half a unit of its 15th digit."""

FIFTEEN_DIGITS: Final = 1e14
"""Fewer steps than these are more than the 15th digit."""
_HALF: Final = np.asarray(0.5)
NO_FRACTION: Final = 2.0**52
"""From here on all doubles are whole numbers: there is nothing to round."""


class _Grid:
    """A size, 0 or more, among the multiples of 10^-digits.

    A multiple is one division or multiplication of a whole number by a power of ten: the nearest double to it, for up
    to 22 digits.

    Attributes:
        n: how many whole steps Excel sees in the size.
        coarse: whether a step is more than the 15th digit.
        fine: whether a step is less than the double can hold.
    """

    def __init__(self, size: Floats, digits: Floats) -> None:
        whole = np.clip(np.trunc(digits), -308, 308).astype(np.intp)
        self._up, self._down = TENS[np.maximum(whole, 0)], TENS[np.maximum(-whole, 0)]
        self._size, self._digits = size, whole
        seen = HALF_OF_15TH_DIGIT[np.searchsorted(DECADES, size, side="right")]
        self._tolerance = np.minimum(seen, self.multiple(_HALF))
        steps = size * self._up / self._down
        self.coarse, self.fine = steps < FIFTEEN_DIGITS, steps >= NO_FRACTION
        self.n = np.floor(steps)
        self.n = np.where(self.reaches(self.n + 1), self.n + 1, self.n)

    def multiple(self, n: Floats) -> Floats:
        """Return the n-th multiple."""
        return np.asarray(n / self._up * self._down)

    def reaches(self, n: Floats) -> Bools:
        """Whether the size is seen at the n-th multiple or above it."""
        gap = self.multiple(n) - self._size
        return self._correct(gap <= self._tolerance, gap, n, above=False)

    def passes(self) -> Bools:
        """Whether the size is seen above its n-th multiple."""
        gap = self._size - self.multiple(self.n)
        return self._correct(gap >= self._tolerance, gap, self.n, above=True) & (self._size > 0)

    def _correct(self, answer: Bools, gap: Floats, n: Floats, *, above: bool) -> Bools:
        """Correct the answer of doubles by decimals where the gap to the n-th multiple nearly equals the tolerance."""
        near = np.abs(gap - self._tolerance) < LAST_BIT * self._size
        if not near.any():
            return np.asarray(answer)
        near = near & (self._tolerance < self.multiple(_HALF))
        answer, n, size, digits = (part.copy() for part in np.broadcast_arrays(answer, n, self._size, self._digits))
        for index in zip(*np.nonzero(near), strict=True):
            steps = _SHOWN.scaleb(_SHOWN.plus(Decimal(float(size[index]))), int(digits[index]))
            answer[index] = steps > float(n[index]) if above else steps >= float(n[index])
        return np.asarray(answer)


def _round_on_grid(x: Floats, digits: Floats, further: Callable[[_Grid], Bools]) -> Floats:
    """Round `x` to `digits` digits towards zero, or one step further from zero where `further(grid)` says so."""
    grid = _Grid(np.abs(x), digits)
    result = np.copysign(grid.multiple(grid.n + further(grid)), x) + 0.0
    return np.where(grid.fine, x, result)


@excel("ROUND", Number, Number, facts=Facts(exact_steps=True))
def round_(x: Floats, digits: Floats) -> Floats:
    """Round to `digits` digits after the point (before it, if negative), halves away from zero."""
    return _round_on_grid(x, digits, lambda grid: grid.coarse & grid.reaches(grid.n + 0.5))


@excel("ROUNDUP", Number, Number, facts=Facts(exact_steps=True))
def round_up(x: Floats, digits: Floats) -> Floats:
    """Round to `digits` digits, away from zero."""
    return _round_on_grid(x, digits, _Grid.passes)


def _round_down(x: Floats, digits: Floats) -> Floats:
    """Round to `digits` digits, towards zero."""
    return _round_on_grid(x, digits, lambda _: np.asarray(False))


excel("ROUNDDOWN", Number, Number, facts=Facts(exact_steps=True))(_round_down)
excel("TRUNC", Number, Number(default=0.0), facts=Facts(exact_steps=True, unrounded=True))(_round_down)


@excel("INT", Number, facts=Facts(unrounded=True))
def int_(x: Floats) -> Floats:
    """Down to a whole number."""
    return _round_on_grid(x, np.asarray(0.0), lambda grid: (x < 0) & grid.passes())


def _down_to_multiple(x: Floats, multiple: Floats) -> Floats:
    """Down to a multiple, or up to one if that is negative; 0 for multiples of 0."""
    return np.asarray(int_(x / np.where(multiple == 0, 1.0, multiple)) * multiple + 0.0)


def _up_to_multiple(x: Floats, multiple: Floats) -> Floats:
    """Up to a multiple, or down to one if that is negative; 0 for multiples of 0."""
    return -_down_to_multiple(-x, multiple) + 0.0


@excel("CEILING", Number, Number, facts=Facts(exact_steps=True))
def ceiling(x: Floats, multiple: Floats) -> Floats:
    """Up to a multiple; away from zero when both are negative; `#NUM!` for a negative multiple of a positive number."""
    return np.where((x > 0) & (multiple < 0), NUM, _up_to_multiple(x, multiple))


@excel("FLOOR", Number, Number, facts=Facts(exact_steps=True))
def floor(x: Floats, multiple: Floats) -> Floats:
    """Down to a multiple; towards zero when both are negative; `#NUM!` as for CEILING, `#DIV/0!` for multiples of 0."""
    result = np.where((multiple == 0) & (x != 0), DIV0, _down_to_multiple(x, multiple))
    return np.where((x > 0) & (multiple < 0), NUM, result)


@excel("CEILING.MATH", Number, Number(default=1.0), Number(default=0.0), facts=Facts(exact_steps=True))
def ceiling_math(x: Floats, multiple: Floats, mode: Floats) -> Floats:
    """Up to a multiple, whatever its sign; a negative number away from zero when `mode` is not 0."""
    size = np.abs(multiple)
    return np.where((x < 0) & (mode != 0), _down_to_multiple(x, size), _up_to_multiple(x, size))


@excel("FLOOR.MATH", Number, Number(default=1.0), Number(default=0.0), facts=Facts(exact_steps=True))
def floor_math(x: Floats, multiple: Floats, mode: Floats) -> Floats:
    """Down to a multiple, whatever its sign; a negative number towards zero when `mode` is not 0."""
    size = np.abs(multiple)
    return np.where((x < 0) & (mode != 0), _up_to_multiple(x, size), _down_to_multiple(x, size))


@excel("MROUND", _ONE_CELL, _ONE_CELL, facts=Facts(exact_steps=True))
def mround(x: Floats, multiple: Floats) -> Floats:
    """To the nearest multiple, halves away from zero; `#NUM!` when the signs differ.

    This one takes the doubles as they are, as Excel does: `MROUND(6.05, 0.1)` is 6, `MROUND(7.05, 0.1)` is 7.1.
    """
    quotient = x / np.where(multiple == 0, 1.0, multiple)
    return np.where(np.sign(x) * np.sign(multiple) < 0, NUM, np.floor(quotient + 0.5) * multiple)


@excel("EVEN", Number, facts=Facts(exact_steps=True))
def even(x: Floats) -> Floats:
    """To the next even whole number, away from zero."""
    return np.asarray(np.copysign(np.ceil(np.abs(x) / 2) * 2, x) + 0.0)


@excel("ODD", Number, facts=Facts(exact_steps=True))
def odd(x: Floats) -> Floats:
    """To the next odd whole number, away from zero; 0 to 1."""
    return np.asarray(np.copysign(np.ceil((np.abs(x) + 1) / 2) * 2 - 1, x + 0.0))


@excel("CEILING.PRECISE", Number, Number(default=1.0), aliases=("ISO.CEILING", "ECMA.CEILING"))
def ceiling_precise(x: Floats, multiple: Floats) -> Floats:
    """Up to a multiple whose sign does not matter."""
    result: Floats = ceiling_math(x, multiple, np.zeros(1))
    return result


@excel("FLOOR.PRECISE", Number, Number(default=1.0))
def floor_precise(x: Floats, multiple: Floats) -> Floats:
    """Down to a multiple whose sign does not matter."""
    result: Floats = floor_math(x, multiple, np.zeros(1))
    return result
