"""Find where functions of one unknown are zero, for all trials at once. Letters: n trials."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.excel.functions.values import Bools, Floats

__all__ = ["growth_root"]

_FIRST_STEP: Final = 0.01
_WIDENING: Final = 1.5
_FARTHEST: Final = 34.0
"""The search ends so far from the guess: rates from 10^-14 above -100 % to 10^14 are tried."""
_MOST_STEPS: Final = 100

Function = Callable[[Floats], Floats]


def growth_root(function: Function, guess: Floats) -> Floats:
    """Find the rate r > -1 nearest to the guess where a function of ln(1 + r) changes its sign; NaN if there is none.

    `function` maps (n,) to (n,), each trial by itself; n is the size of `guess`. The search widens to both sides of
    the guess until the sign changes, and then closes in by Chandrupatla's method (1997, Adv. Eng. Software 28, 145),
    which needs no derivative and never leaves the bracket.
    """
    start = np.log1p(np.where(guess > -1, guess, 0.0))
    low, high, mask = _bracket(function, start)
    return np.where(mask & (guess > -1), np.expm1(_close_in(function, low, high)), np.nan)


def _bracket(function: Function, start: Floats) -> tuple[Floats, Floats, Bools]:
    """Find the interval nearest to the start in which the sign changes: its ends, and which trials have one."""
    low = high = left = right = start
    value_left = value_right = function(start)
    value = value_left == 0
    step = _FIRST_STEP
    while step < _FARTHEST and not value.all():
        new_left, new_right = start - step, start + step
        new_value_left, new_value_right = function(new_left), function(new_right)
        at_right = ~value & _sign_changes(value_right, new_value_right)
        at_left = ~value & ~at_right & _sign_changes(value_left, new_value_left)
        low = np.where(at_right, right, np.where(at_left, new_left, low))
        high = np.where(at_right, new_right, np.where(at_left, left, high))
        value = value | at_left | at_right
        left, right, value_left, value_right = new_left, new_right, new_value_left, new_value_right
        step *= _WIDENING
    return low, high, value


def _sign_changes(one: Floats, other: Floats) -> Bools:
    return np.asarray(np.sign(one) * np.sign(other) <= 0)


def _close_in(function: Function, low: Floats, high: Floats) -> Floats:
    """Find the root in each interval, to the last bits.

    In the loop `a` is the newest point, `b` the other end, and `c` the point before.
    """
    a, b = low, high
    fa, fb = function(a), function(b)
    best = np.where(np.abs(fa) < np.abs(fb), a, b)
    share = np.full(a.shape, 0.5)
    open_ = (a != b) & (fa != 0) & (fb != 0)
    for _ in range(_MOST_STEPS):
        if not open_.any():
            break
        x = a + share * (b - a)
        fx = function(x)
        same_side = np.sign(fx) == np.sign(fa)
        c, fc = np.where(same_side, a, b), np.where(same_side, fa, fb)
        b, fb = np.where(same_side, b, a), np.where(same_side, fb, fa)
        a, fa = x, fx
        best = np.where(open_, np.where(np.abs(fa) < np.abs(fb), a, b), best)
        smallest = (2 * np.finfo(float).eps * np.abs(best) + 1e-18) / np.where(a == b, 1.0, np.abs(b - a))
        open_ = open_ & (fa != 0) & (smallest < 0.5)
        share = np.clip(_next_share(a, b, c, fa, fb, fc), smallest, 1 - smallest)
    return best


def _next_share(a: Floats, b: Floats, c: Floats, fa: Floats, fb: Floats, fc: Floats) -> Floats:
    """Where to look next, as a share of the way from `a` to `b`.

    It comes from inverse quadratic interpolation where that is safe; else it is the middle.
    """
    with np.errstate(all="ignore"):
        xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
        safe = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
        by_curve = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        return np.where(safe & np.isfinite(by_curve), by_curve, 0.5)
