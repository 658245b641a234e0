"""The `+` or `-` that a formula ends with: Excel makes 0 of a result that cancels but for the last bits.

    0 where |result| < 8 units in the last place of the first number

It was found by trying numbers in Excel: `n` units with n from 1 to 7 give 0, 8 do not, at sizes from 1E-7 to 1E308
(joeu2004 and J. W. Lewis, microsoft.public.excel.worksheet.functions, April 2009; S. Byrne, Stack Overflow 40293983,
2016, who names the first number). Microsoft says no more than "at or very close to zero" (article 78113). A result that
is too small a number for Excel is 0, too; see `denormals`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Final

import numpy as np

from xlmc.functions.denormals import TINIEST
from xlmc.functions.facts import Facts
from xlmc.functions.registry import Function, Kind, Number
from xlmc.functions.values import Bools, Floats

__all__ = ["EIGHT_UNITS", "SETTLED", "Settled", "keep", "never_cancels"]

EIGHT_UNITS: Final = 2.0**-49
"""Eight units in the last place, as a share of a power of two."""

_SURELY: Final = 2.0**-30
"""The share above which a result is no matter of the last bits, even where its bounds are rounded."""


@dataclass(frozen=True, slots=True)
class Settled:
    """Makes the last sum of a formula what Excel makes of it, called as a ufunc of two arrays is.

    The second may be the memory that the result goes to.

    Args:
        largest: the size that the first number never exceeds, but for rounding, where that is known beforehand.
    """

    largest: float | None = None
    nin: ClassVar[int] = 2

    def __call__(self, result: Any, first: Any, out: Floats | None = None) -> Floats:
        """0 where the sum is within the last bits of the first number, else the sum."""
        result, first = np.asarray(result), np.asarray(first)
        limit = 2.0 * EIGHT_UNITS * (_size(first) if self.largest is None else self.largest)
        dust = None if _is_far_from_0(result, max(limit, TINIEST)) else _dust(result, first)
        if out is None:
            found: Floats = np.array(result if dust is None else np.broadcast_to(result, dust.shape))
        else:
            found = out
            if found is not result:
                np.copyto(found, result)
        if dust is not None:
            found[dust] = 0.0
        return found


def _size(x: Floats) -> float:
    return max(-float(x.min(initial=0.0)), float(x.max(initial=0.0)))


def _is_far_from_0(result: Floats, limit: float) -> bool:
    """Whether each result is of this size or larger."""
    below = np.count_nonzero(result < limit)
    return below == 0 or bool(below == np.count_nonzero(result <= -limit))


def _dust(result: Floats, first: Floats) -> Bools:
    """Where the result is nothing but the last bits of the first number."""
    _, exponents = np.frexp(first)
    eight = np.where(first == 0, 0.0, np.ldexp(0.5 * EIGHT_UNITS, exponents))
    return np.asarray(np.abs(result) < np.maximum(eight, TINIEST))


def keep(result: Floats, first: Floats, out: Floats) -> Floats:
    """The sum as it is, where that is known to be no matter of the last bits."""
    if out is not result:
        np.copyto(out, result)
    return out


def never_cancels(result: tuple[float, float], first: tuple[float, float], second: tuple[float, float] | None) -> bool:
    """Whether bounds tell that no result is 0 but for the last bits.

    Args:
        result: of the sum.
        first: of the number in it that comes first.
        second: of the number that is added to it, if it is a sum and not a difference.
    """
    if second is not None and (min(*first, *second) >= 0 or max(*first, *second) <= 0):
        return True
    limit = max(_SURELY * max(abs(first[0]), abs(first[1])), TINIEST)
    return result[0] > limit or result[1] < -limit


_SETTLES: Final = Settled()

SETTLED: Final = Function(
    "settled", (Number, Number), _SETTLES, Kind.NUMBER, ufunc=_SETTLES, facts=Facts(never_errs=True)
)
"""The function of a sum, and of the number in it that comes first."""
