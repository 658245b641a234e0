"""Roots of one function of one unknown in many trials at once: a scan for changes of sign, then secants.

Every trial is scanned at the same shares of its own range. Each change of sign is a bracket of its own, and all of them
are solved together by a few steps of Anderson and Björck's method. Where these do not converge, the bracket is narrowed
by Chandrupatla's method, inverse quadratic interpolation or else halving, until its ends are neighbours. Where a
function jumps past 0, or has a pole, it changes its sign and is 0 nowhere: that is no root.

Sources: Anderson and Björck 1973, "A new high order method of regula falsi type for computing a root of an equation",
BIT 13; Chandrupatla 1997, "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function
without using derivatives", Advances in Engineering Software 28.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["CONVERGED", "EPSILON", "INTERPOLATIONS", "OWN_STEPS", "SCANNED", "Roots", "find_roots"]

SCANNED: Final = 16
"""Parts of the range that are looked at; two roots within one part cancel, and are not seen."""

_MOST_ROUNDS: Final = 200
_JUMP: Final = 1e-3
"""A function that is still this large at a root, as a share of its values at both ends of the bracket, jumps there."""

INTERPOLATIONS: Final = 8
OWN_STEPS: Final = 2
"""Steps before one whose three points are steps, and none an end of the bracket."""

CONVERGED: Final = 1e-9
EPSILON: Final = float(np.finfo(np.float64).eps)

_TINY: Final = 2.0**-1000

Floats = NDArray[np.float64]
Trials = NDArray[np.intp]
Function = Callable[[Floats, Trials | None], Floats]
"""Takes the unknown `(m,)` and the trials `(m,)` that it is for, None for all; gives `(m,)`, NaN for no number."""


@dataclass(frozen=True, slots=True)
class Roots:
    """All roots that were found, by trial, those of a trial in ascending order.

    Attributes:
        trials: `(r,)`.
        values: `(r,)`.
    """

    trials: Trials
    values: Floats

    def counts(self, n: int) -> NDArray[np.intp]:
        """`(n,)` how many each trial has."""
        return np.bincount(self.trials, minlength=n)

    def chosen(self, n: int, *, last: bool = False) -> Floats:
        """`(n,)` the first root of each trial, or the last; NaN where it has none."""
        values = np.full(n, np.nan)
        order = slice(None) if last else slice(None, None, -1)
        values[self.trials[order]] = self.values[order]  # of a trial that stands several times, the last one stays
        return values


def find_roots(function: Function, low: Floats, high: Floats) -> Roots:
    """Find where a function is 0.

    Args:
        function: of the unknown and the trials, which are None where all are meant.
        low: `(n,)` the lower end of each trial's range; NaN for a trial without one.
        high: `(n,)` the upper end; a trial whose ends are in the other order has no root.

    >>> roots = find_roots(lambda x, trial: x * x - 2.0, np.zeros(3), np.array([1.0, 2.0, 9.0]))
    >>> roots.trials.tolist(), roots.values.round(12).tolist()
    ([1, 2], [1.414213562373, 1.414213562373])
    """
    with np.errstate(all="ignore"):
        known = np.isfinite(low) & np.isfinite(high) & (low <= high)
        trials = None if known.all() else np.flatnonzero(known)
        brackets, exact = _scan(function, trials, low[known], high[known])
        x, remainder = _solve(function, brackets)
        ends = np.maximum(np.abs(brackets.at_low), np.abs(brackets.at_high))
        sound = np.abs(remainder) <= _JUMP * ends
    where = np.concatenate([brackets.trials[sound], exact[0]])
    values = np.concatenate([x[sound], exact[1]])
    if not exact[0].size:  # the scan goes upwards, so that brackets of a trial are in order
        order = np.argsort(where, kind="stable")
        return Roots(where[order], values[order])
    order = np.lexsort((values, where))
    where, values = where[order], values[order]
    new = np.ones(where.size, bool)
    new[1:] = (where[1:] != where[:-1]) | (values[1:] != values[:-1])
    return Roots(where[new], values[new])


@dataclass(frozen=True, slots=True)
class _Brackets:
    """Intervals at whose ends a function has different signs, `(m,)` each, and its values there."""

    trials: Trials
    low: Floats
    high: Floats
    at_low: Floats
    at_high: Floats


def _scan(
    function: Function, trials: Trials | None, low: Floats, high: Floats
) -> tuple[_Brackets, tuple[Trials, Floats]]:
    """Look at the range of some trials, None for all: the brackets, and the points where the function is exactly 0."""
    result: list[tuple[Any, ...]] = []
    numbers = np.arange(low.size) if trials is None else trials
    width = high - low
    left, at, before = low, np.empty(low.size), function(low, trials)
    zeros = [(numbers[before == 0.0], low[before == 0.0])]
    positive = before > 0.0
    for part in range(1, SCANNED + 1):
        if part == SCANNED:
            at[:] = high
        else:
            np.add(low, np.multiply(width, part / SCANNED, out=at), out=at)
        values = function(at, trials)
        above, negative = values > 0.0, values < 0.0
        exact = above == negative
        if exact.any():
            exact &= values == 0.0  # and not where it has no number
            zeros.append((numbers[exact], at[exact]))
        here = np.flatnonzero(above != positive)
        if here.size:
            here = here[np.sign(before[here]) * np.sign(values[here]) < 0.0]  # none of a zero, and of no number
            result.append((numbers[here], left[here], at[here], before[here], values[here]))
        left, at = at, np.empty(low.size) if left is low else left
        before, positive = values, above
    result = result or [(numbers[:0], *[low[:0]] * 4)]
    where, *columns = map(np.concatenate, zip(*result, strict=True))
    trials_of_zeros, points = map(np.concatenate, zip(*zeros, strict=True))
    return _Brackets(where, *columns), (trials_of_zeros, points)


def _solve(function: Function, brackets: _Brackets) -> tuple[Floats, Floats]:
    """Return the root in each bracket, `(m,)`, and the function there: by interpolation, and else by narrowing.

    Each step is the value at 0 of the quadratic through the inverse of the last three points, and no smaller than some
    last digits. A root is taken where the function has become far smaller than at both ends, and changed its sign over
    such a smallest step; or where all three points are steps, the last one is c and the one before it C, and so the
    next one about c²/C, or less, if this and some more is less than the last digit.
    """
    trials, low, high, f0, f1 = (getattr(brackets, key) for key in _Brackets.__slots__)
    if not trials.size:
        return low, low
    roots, remainder = np.empty(trials.size), np.empty(trials.size)
    left, small = np.arange(trials.size), CONVERGED * np.minimum(np.abs(f0), np.abs(f1))
    x1, before = high, high - low
    slope = before / (f1 - f0)
    x = x1 - f1 * slope
    for step in range(INTERPOLATIONS):
        np.fmin(np.fmax(x, low, out=x), high, out=x)
        fx = function(x, trials)
        moved = x - x1
        slope_before, slope = slope, moved / (fx - f1)
        bend = np.subtract(slope, slope_before, out=slope_before)
        bend /= fx - f0
        change = np.subtract(slope, np.multiply(bend, f1, out=bend), out=bend)
        change *= fx
        size, last, close = np.abs(change), EPSILON * np.abs(x), np.abs(fx) <= small
        if close.any():
            done = (np.abs(moved) <= 4.0 * last) & ((fx > 0.0) != (f1 > 0.0))
            if step >= OWN_STEPS:
                done |= 16.0 * size * size <= last * before
            done |= fx == 0.0
            done &= close
            here = np.flatnonzero(done)
            if here.size:
                at = left[here]
                most = np.where(fx[here] == 0.0, 0.0, np.abs(moved[here]))
                remainder[at] = fx[here]
                roots[at] = x[here] - np.fmin(np.fmax(change[here], -most), most)
                if here.size == left.size:
                    return roots, remainder
                on = np.flatnonzero(~done)
                left, trials, small, low, high = (e[on] for e in (left, trials, small, low, high))
                x, fx, x1, f1, slope, change, size, last = (e[on] for e in (x, fx, x1, f1, slope, change, size, last))
        np.copysign(np.maximum(size, 2.0 * last, out=size), change, out=change)
        x1, f0, f1, before = x, f1, fx, size
        x = x1 - change
    if left.size:
        columns = (getattr(brackets, key)[left] for key in _Brackets.__slots__)
        roots[left], remainder[left] = _narrow(function, _Brackets(*columns))
    return roots, remainder


def _narrow(function: Function, brackets: _Brackets) -> tuple[Floats, Floats]:
    """Narrow brackets until their ends are neighbours, and give the better end of each, and the value at the worse one.

    A bracket in which the function has no number somewhere gives NaN.
    """
    trials, count = brackets.trials, brackets.trials.size
    values, remainder = np.full(count, np.nan), np.full(count, np.inf)
    left, share = np.arange(count), np.full(count, 0.5)
    x1, f1, x2, f2 = brackets.high, brackets.at_high, brackets.low, brackets.at_low
    for _ in range(_MOST_ROUNDS):
        if not left.size:
            break
        x = x1 + share * (x2 - x1)
        f = function(x, trials[left])
        same = np.sign(f) == np.sign(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        nearer = np.abs(f1) < np.abs(f2)
        best, value = np.where(nearer, x1, x2), np.where(nearer, f1, f2)
        width = np.abs(x2 - x1)
        least = (2.0 * EPSILON * np.abs(best) + _TINY) / width
        done = (least > 0.5) | (value == 0.0) | ~(width > 0.0)
        lost = np.isnan(f)
        if (done | lost).any():
            ended = done & ~lost
            worse = np.where(value == 0.0, 0.0, np.where(nearer, f2, f1))  # of a jump, one end may be near 0 by chance
            values[left[ended]], remainder[left[ended]] = best[ended], worse[ended]
            on = ~(done | lost)
            left, x1, f1, x2, f2, x3, f3, least = (e[on] for e in (left, x1, f1, x2, f2, x3, f3, least))
        xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        smooth = (phi * phi < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
        step = f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        share = np.clip(np.where(smooth, step, 0.5), least, 1.0 - least)
    return values, remainder
