"""Rounding in the loop, to the bits of `functions.math.rounding`, whose grid of multiples of 10^-digits this is.

Half a unit of a number's 15th digit depends on the number's decade: the numbers from one power of two to the next lie
in one decade or in two. A trial in which doubles do not tell on which side of that half a unit a number lies is
computed again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, Final

import numpy as np
from llvmlite import ir

from xlmc.engine.llvm.constant_column import ConstantColumn
from xlmc.engine.llvm.loop_rules import Emit, Emitter
from xlmc.excel.functions.math.rounding import DECADES, FIFTEEN_DIGITS, HALF_OF_15TH_DIGIT, LAST_BIT, NO_FRACTION, TENS
from xlmc.excel.functions.values import Floats

__all__ = ["MOST_DIGITS", "ROUNDED", "down_to_whole", "is_even", "nearest_multiple", "round_to", "whole_quotient"]

MOST_DIGITS: Final = 22
"""Up to here doubles hold powers of ten exactly."""

_INTEGER: Final = ir.IntType(64)
_MANTISSA_BITS: Final = 52
_BINADES: Final = 0x7FF
"""Powers of two, as the bits of a double's size count them: the last stands for infinity."""


@cache
def _decades() -> tuple[Floats, Floats, Floats]:
    """For sizes from each power of two on: the power of ten before the next power of two, infinity where there is none,
    and half a unit of the 15th digit of sizes below it, and of those from it on.
    """
    begins = np.arange(_BINADES, dtype=np.int64) << _MANTISSA_BITS
    least, most = begins.view(np.float64), (begins + ((1 << _MANTISSA_BITS) - 1)).view(np.float64)
    below, above = (np.searchsorted(DECADES, sizes, side="right") for sizes in (np.nextafter(least, 0.0), most))
    limits = np.where(above > below, DECADES[np.maximum(above - 1, 0)], np.inf)
    return limits, HALF_OF_15TH_DIGIT[below], HALF_OF_15TH_DIGIT[above]


class _Grid:
    """See `functions.math.rounding`: the same steps, for digits that are known."""

    def __init__(self, body: Emitter, size: Any, digits: int) -> None:
        self._body, self._size = body, size
        self._up, self._down = float(TENS[max(digits, 0)]), float(TENS[max(-digits, 0)])
        builder, compare = body.builder, body.builder.fcmp_ordered
        seen, half = self._half_of_15th_digit(), body.number(0.5 / self._up * self._down)
        below_half = compare("<", seen, half)
        self._tolerance = builder.select(below_half, seen, half)
        steps = self._steps()
        self.coarse = compare("<", steps, body.number(FIFTEEN_DIGITS))
        self.fine = compare(">=", steps, body.number(NO_FRACTION))
        self._may_be_near = builder.and_(below_half, builder.not_(self.fine))
        whole = body.intrinsic("llvm.floor", steps)
        following = builder.fadd(whole, body.number(1.0))
        self.n = builder.select(self.reaches(following), following, whole)

    def _steps(self) -> Any:
        if self._down > 1.0:
            return self._body.builder.fdiv(self._size, self._body.number(self._down))
        return self._body.builder.fmul(self._size, self._body.number(self._up))

    def _half_of_15th_digit(self) -> Any:
        body, builder = self._body, self._body.builder
        index = builder.lshr(builder.bitcast(self._size, _INTEGER), _INTEGER(_MANTISSA_BITS))
        # An infinity or NaN has no decade: the trial is computed again, whatever stands here.
        index = builder.select(builder.icmp_unsigned("<", index, _INTEGER(_BINADES)), index, _INTEGER(0))
        limit, below, above = (ConstantColumn(body, part).at(index) for part in _decades())
        return builder.select(builder.fcmp_ordered("<", self._size, limit), below, above)

    def multiple(self, n: Any) -> Any:
        """Return the n-th multiple."""
        builder, number = self._body.builder, self._body.number
        n = builder.fdiv(n, number(self._up)) if self._up > 1.0 else n
        return builder.fmul(n, number(self._down)) if self._down > 1.0 else n

    def reaches(self, n: Any) -> Any:
        """Whether the size is seen at the n-th multiple or above it."""
        gap = self._body.builder.fsub(self.multiple(n), self._size)
        self._flag_near(gap)
        return self._body.builder.fcmp_ordered("<=", gap, self._tolerance)

    def passes(self) -> Any:
        """Whether the size is seen above its n-th multiple."""
        builder, compare = self._body.builder, self._body.builder.fcmp_ordered
        gap = builder.fsub(self._size, self.multiple(self.n))
        self._flag_near(gap)
        return builder.and_(compare(">=", gap, self._tolerance), compare(">", self._size, self._body.number(0.0)))

    def _flag_near(self, gap: Any) -> None:
        body, builder = self._body, self._body.builder
        apart = body.intrinsic("llvm.fabs", builder.fsub(gap, self._tolerance))
        near = builder.fcmp_ordered("<", apart, builder.fmul(body.number(LAST_BIT), self._size))
        body.flag(builder.and_(near, self._may_be_near))


def _on_grid(digits: int, further: Callable[[Emitter, _Grid, Any], Any] | None) -> Emit:
    """Round to `digits` digits towards zero, or one step further from zero where `further(body, grid, x)` says so."""

    def emit(body: Emitter, parts: Sequence[Any]) -> Any:
        (x,) = parts
        builder, n = body.builder, (grid := _Grid(body, body.intrinsic("llvm.fabs", x), digits)).n
        if further is not None:
            n = builder.select(further(body, grid, x), builder.fadd(n, body.number(1.0)), n)
        rounded = builder.fadd(body.intrinsic("llvm.copysign", grid.multiple(n), x), body.number(0.0))
        return builder.select(grid.fine, x, rounded)

    return emit


def _from_half_on(body: Emitter, grid: _Grid, _: Any) -> Any:
    middle = body.builder.fadd(grid.n, body.number(0.5))
    return body.builder.and_(grid.coarse, grid.reaches(middle))


def _above(_: Emitter, grid: _Grid, __: Any) -> Any:
    return grid.passes()


def _above_if_negative(body: Emitter, grid: _Grid, x: Any) -> Any:
    return body.builder.and_(body.builder.fcmp_ordered("<", x, body.number(0.0)), grid.passes())


_FURTHER: Final[dict[str, Callable[[Emitter, _Grid, Any], Any] | None]] = {
    "ROUND": _from_half_on,
    "ROUNDUP": _above,
    "ROUNDDOWN": None,
    "TRUNC": None,
}
ROUNDED: Final = frozenset(_FURTHER)
"""The functions that round to digits."""


@cache
def round_to(name: str, digits: int) -> Emit:
    """How the loop computes ROUND, ROUNDUP, ROUNDDOWN or TRUNC, to at most `MOST_DIGITS` digits before or after the
    point.
    """
    return _on_grid(digits, _FURTHER[name])


down_to_whole: Final[Emit] = _on_grid(0, _above_if_negative)
"""INT."""


def nearest_multiple(body: Emitter, parts: Sequence[Any]) -> Any:
    """MROUND, where the signs of the two numbers do not differ."""
    x, multiple = parts
    builder, zero, compare = body.builder, body.number(0.0), body.builder.fcmp_ordered
    positive, negative = (
        builder.and_(compare(">", x, zero), compare("<", multiple, zero)),
        builder.and_(compare("<", x, zero), compare(">", multiple, zero)),
    )
    body.flag(builder.or_(positive, negative))
    divisor = builder.select(compare("==", multiple, zero), body.number(1.0), multiple)
    steps = builder.fadd(builder.fdiv(x, divisor), body.number(0.5))
    return builder.fmul(body.intrinsic("llvm.floor", steps), multiple)


def whole_quotient(body: Emitter, parts: Sequence[Any]) -> Any:
    """QUOTIENT; infinity or NaN by zero."""
    return body.intrinsic("llvm.trunc", body.builder.fdiv(*parts))


def is_even(body: Emitter, parts: Sequence[Any]) -> Any:
    """ISEVEN."""
    half = body.builder.fmul(body.intrinsic("llvm.trunc", parts[0]), body.number(0.5))
    return body.builder.fcmp_ordered("==", body.intrinsic("llvm.floor", half), half)
