"""Sine and cosine of many angles at once, by tangents where these are what the processor is fast at.

NumPy computes the tangent of eight numbers at a time on processors with AVX-512, the sine and the cosine one by one.
There both are made of tangents here, within 4 units in the last place of the exact values; elsewhere NumPy's own are
used, within 1. Which it is depends on the processor alone, never on how many angles there are.

    T = tan(x/2), sin x = 2T / (1 + T²), cos x = sin x / tan x

The cosine as (1 - T²) / (1 + T²) would be quicker and loses digits where it is small.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.functions.values import Floats
from xlmc.functions.work_memory import work_arrays

__all__ = ["COSINE", "SINE", "Tangents", "sine_and_cosine"]


def _tangent_is_fast() -> bool:
    found = np.lib.introspect.opt_func_info(func_name="^tan$", signature="^float64$").get("tan", {})
    return any("X86_V4" in target["current"] or "AVX512" in target["current"] for target in found.values())


BY_TANGENTS: Final = _tangent_is_fast()


def sine_and_cosine(x: Floats, sine: Floats, cosine: Floats, work: Floats) -> None:
    """Both of the same angles.

    Args:
        x: radians, `(n,)`.
        sine: `(n,)`, for the result.
        cosine: `(n,)`, for the result.
        work: `(n,)`, overwritten. All four lie apart from each other.
    """
    if not BY_TANGENTS:
        np.sin(x, out=sine)
        np.cos(x, out=cosine)
        return
    _sine(x, sine, work)
    _cosine(x, sine, cosine, work)


def _sine(x: Floats, out: Floats, work: Floats) -> None:
    np.multiply(x, 0.5, out=out)
    np.tan(out, out=out)
    np.multiply(out, out, out=work)
    np.add(work, 1.0, out=work)
    np.add(out, out, out=out)
    np.divide(out, work, out=out)


def _cosine(x: Floats, sine: Floats, out: Floats, work: Floats) -> None:
    np.tan(x, out=out)
    np.add(out, _TINY, out=out)
    np.add(sine, _TINY, out=work)
    np.divide(work, out, out=out)


_TINY: Final = 1.1e-301
"""Makes 1 of 0 / 0 at an angle of 0, and changes no other quotient."""


class Tangents:
    """The sine or the cosine, called as a ufunc is: `out` may be `x` itself."""

    nin: Final = 1

    def __init__(self, plain: np.ufunc, by_tangents: Callable[[Floats, Floats], None]) -> None:
        self._plain, self._by_tangents = plain, by_tangents

    def __call__(self, *x: Floats, out: Floats | None = None) -> Floats:
        """Of radians, one array of any shape."""
        if not BY_TANGENTS:
            return np.asarray(self._plain(*x, out=out))
        angles = np.ascontiguousarray(x[0], dtype=np.float64)
        own = np.empty_like(angles) if out is None else out
        self._by_tangents(angles.reshape(-1), own.reshape(-1))
        return own


def _sine_alone(x: Floats, out: Floats) -> None:
    _sine(x, out, *work_arrays(x.size, 1))


def _cosine_alone(x: Floats, out: Floats) -> None:
    sine, work = work_arrays(x.size, 2)
    _sine(x, sine, work)
    _cosine(x, sine, out, work)


SINE: Final = Tangents(np.sin, _sine_alone)
COSINE: Final = Tangents(np.cos, _cosine_alone)
