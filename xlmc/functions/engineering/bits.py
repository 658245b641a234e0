"""Numbers as bits: whole, 0 or more, and below 2^48."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.registry import Number, excel
from xlmc.functions.values import NUM, Bools, Floats

__all__: list[str] = []

_END: Final = 2.0**48
_FURTHEST: Final = 53


def _has_bits(x: Floats) -> Bools:
    return np.asarray((x >= 0) & (x < _END) & (x == np.trunc(x)))


def _register(name: str, meaning: str, operation: np.ufunc) -> None:
    def body(x: Floats, y: Floats) -> Floats:
        fit = _has_bits(x) & _has_bits(y)
        left, right = (np.where(fit, z, 0.0).astype(np.int64) for z in (x, y))
        return np.where(fit, operation(left, right), NUM)

    body.__doc__ = meaning
    excel(name, Number, Number)(body)


_register("BITAND", "Bits that both numbers have.", np.bitwise_and)
_register("BITOR", "Bits that either number has.", np.bitwise_or)
_register("BITXOR", "Bits that only one of the numbers has.", np.bitwise_xor)


@excel("BITLSHIFT", Number, Number)
def shifted_left(x: Floats, places: Floats) -> Floats:
    """Bits moved left by up to 53 places, or right by a negative number; what falls off on the right is lost.

    `#NUM!` where the result has more than 48 bits.
    """
    shift = np.trunc(places)
    fit = _has_bits(x) & (np.abs(shift) <= _FURTHEST)
    moved = np.floor(np.ldexp(np.where(fit, x, 0.0), np.where(fit, shift, 0.0).astype(np.intc)))
    return np.where(fit & (moved < _END), moved, NUM)


@excel("BITRSHIFT", Number, Number)
def shifted_right(x: Floats, places: Floats) -> Floats:
    """Bits moved right by up to 53 places, or left by a negative number."""
    result: Floats = shifted_left(x, -places)
    return result
