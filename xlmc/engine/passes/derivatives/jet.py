"""A value with its derivatives, and the chain rule, by which second derivatives follow from the rules of functions.

Letters: `s` is the shape of the value, `(n,)` or `(n, r, c)`; `a` is the number of assumptions that reach it. The shape
of derivatives begins with one or two `a`; then comes the shape of the value, or one that broadcasts to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.values import Bools, Floats, Value

__all__ = ["Jet", "align", "by_value", "chain", "concatenate", "flat"]

Seconds = Callable[[], Mapping[tuple[int, int], Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """A number over trials with its first and second derivatives.

    Attributes:
        x: the value, `s`; any number where the value is an error.
        active: the assumptions that reach it, counted from 0, rising.
        first: `(a, *s)`.
        second: `(a, a, *s)`, symmetric; None if only first derivatives are wanted.
        error: estimate of the error of `first`; None if it is rounding alone.
        second_error: likewise.
    """

    x: Floats
    active: tuple[int, ...]
    first: Floats
    second: Floats | None = None
    error: Floats | None = None
    second_error: Floats | None = None

    @classmethod
    def still(cls, x: Floats) -> Jet:
        """Make a jet that no assumption changes."""
        none = (1,) * np.ndim(x)
        return cls(x, (), np.zeros((0, *none)), np.zeros((0, 0, *none)))

    @classmethod
    def of_input(cls, x: Floats, number: int, order: int) -> Jet:
        """Make the jet of the draws of an assumption."""
        return cls(x, (number,), np.ones((1, 1)), np.zeros((1, 1, 1)) if order > 1 else None)

    @property
    def order(self) -> int:
        return 1 if self.second is None else 2

    def each(self, change: Callable[[NDArray[Any], int], NDArray[Any]], x: Floats | None = None) -> Jet:
        """Change every part alike, by `change(part, how many axes go before those of the value)`."""
        parts = (self.first, 1), (self.second, 2), (self.error, 1), (self.second_error, 2)
        changed = [None if part is None else change(part, axes) for part, axes in parts]
        value = change(self.x, 0) if x is None else x
        return Jet(value, self.active, changed[0], *changed[1:])  # type: ignore[arg-type]  # `first` is never None

    def spread(self) -> Jet:
        """Return the jet with all derivatives in the value's full shape."""
        return self.each(lambda part, axes: np.broadcast_to(part, (*part.shape[:axes], *self.x.shape)))

    def as_range(self) -> Jet:
        """`(n,)` as `(n, 1, 1)`; a range as it is."""
        if self.x.ndim == 3:
            return self
        return self.each(lambda part, axes: part.reshape(*part.shape, 1, 1))

    def times(self, factor: Any, x: Floats | None = None) -> Jet:
        """Every derivative times a number; errors times its size."""
        size = np.abs(factor)
        return Jet(
            self.x * factor if x is None else x,
            self.active,
            self.first * factor,
            None if self.second is None else self.second * factor,
            None if self.error is None else self.error * size,
            None if self.second_error is None else self.second_error * size,
        )

    def lost(self, where: NDArray[np.bool_]) -> Jet:
        """Return the jet without derivatives where `where` says so, `s`."""
        if not where.any():
            return self

        def change(part: NDArray[Any], axes: int) -> NDArray[Any]:
            return np.where(where, np.nan, part) if axes else part

        return self.each(change, self.x)

    def function(self, x: Floats, first: Any, second: Callable[[], Any]) -> Jet:
        """Apply a function of the number, given its value, its derivative and its second derivative there."""
        return chain(x, [self], [first], lambda: {(0, 0): second()})

    def __add__(self, other: Jet) -> Jet:
        """Sum."""
        return chain(self.x + other.x, [self, other], [1.0, 1.0])

    def __sub__(self, other: Jet) -> Jet:
        """Difference."""
        return chain(self.x - other.x, [self, other], [1.0, -1.0])

    def __mul__(self, other: Jet) -> Jet:
        """Product."""
        return chain(self.x * other.x, [self, other], [other.x, self.x], lambda: {(0, 1): 1.0})

    def __truediv__(self, other: Jet) -> Jet:
        """Quotient."""
        y = self.x / other.x
        inverse = 1 / other.x
        return chain(
            y, [self, other], [inverse, -y * inverse], lambda: {(0, 1): -(inverse**2), (1, 1): 2 * y * inverse**2}
        )

    def ln(self) -> Jet:
        """Natural logarithm."""
        return self.function(np.log(self.x), 1 / self.x, lambda: -1 / self.x**2)

    def sqrt(self) -> Jet:
        """Square root."""
        y = np.sqrt(self.x)
        return self.function(y, 0.5 / y, lambda: -0.25 / (self.x * y))

    def total(self) -> Jet:
        """Sum of each row: `(n, m)` to `(n,)`."""
        return self.spread().each(lambda part, _: part.sum(axis=-1))


def align(jets: Sequence[Jet]) -> list[Jet]:
    """Return the jets, all with the same active assumptions."""
    active = tuple(sorted({number for jet in jets for number in jet.active}))
    return [_widen(jet, active) for jet in jets]


def _widen(jet: Jet, active: tuple[int, ...]) -> Jet:
    if jet.active == active:
        return jet
    rows = [active.index(number) for number in jet.active]

    def change(part: NDArray[Any], axes: int) -> NDArray[Any]:
        if not axes:
            return part
        wide = np.zeros((*(len(active),) * axes, *part.shape[axes:]))
        wide[np.ix_(*[rows] * axes)] = part
        return wide

    return replace(jet.each(change), active=active)


def chain(x: Floats, jets: Sequence[Jet], firsts: Sequence[Any], seconds: Seconds | None = None) -> Jet:
    """Apply a function of several numbers.

    Args:
        x: its value.
        jets: what it is a function of; their values have the same number of axes.
        firsts: its derivative with respect to each.
        seconds: makes its second derivatives, by pairs of indices `i <= j`; those that are 0 may be left out.
    """
    live = [index for index, jet in enumerate(jets) if jet.active]
    if not live:
        return Jet.still(x)
    wide = dict(zip(live, align([jets[index] for index in live]), strict=True))
    parts = [wide[index].times(firsts[index], x) for index in live]
    order = wide[live[0]].order
    curves = _curves(wide, seconds()) if order > 1 and seconds is not None else []
    first, error = _sum([part.first for part in parts]), _sum_of_errors([part.error for part in parts])
    if order == 1:
        return Jet(x, parts[0].active, first, None, error)
    second = _sum([part.second for part in parts if part.second is not None] + [curve for curve, _ in curves])
    second_error = _sum_of_errors([part.second_error for part in parts] + [error for _, error in curves])
    return Jet(x, parts[0].active, first, second, error, second_error)


def _curves(wide: Mapping[int, Jet], seconds: Mapping[tuple[int, int], Any]) -> list[tuple[Floats, Floats | None]]:
    """Return the terms of the function's own second derivatives, and the errors of these terms."""
    result = []
    for (i, j), second in seconds.items():
        nothing = isinstance(second, float) and second == 0.0
        if i in wide and j in wide and not nothing:
            left, right = wide[i], wide[j]
            curve = _outer(left.first, right.first) * second
            error = _sum_of_errors([_outer_error(left, right, second), _outer_error(right, left, second)])
            if i != j:
                curve = curve + curve.swapaxes(0, 1)
                error = None if error is None else error + error.swapaxes(0, 1)
            result.append((curve, error))
    return result


def _outer(left: Floats, right: Floats) -> Floats:
    return left[:, None] * right[None, :]


def _outer_error(left: Jet, right: Jet, second: Any) -> Floats | None:
    return None if left.error is None else np.abs(second) * _outer(left.error, np.abs(right.first))


def _sum(parts: Sequence[Floats]) -> Floats:
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _sum_of_errors(parts: Sequence[Floats | None]) -> Floats | None:
    known = [part for part in parts if part is not None]
    return _sum(known) if known else None


def flat(jet: Jet, value: Value) -> Jet:
    """Return the cells of a value side by side, `(n, m)`."""
    n, size = value.shape[0], int(np.prod(value.shape[1:]))

    def change(part: NDArray[Any], axes: int) -> NDArray[Any]:
        return np.broadcast_to(part, (*part.shape[:axes], *value.shape)).reshape(*part.shape[:axes], n, size)

    return jet.each(change)


def concatenate(jets: Sequence[Jet], n: int) -> Jet:
    """Jets of cells side by side, as one."""

    def side(name: str, axes: int) -> Any:
        parts = [getattr(jet, name) for jet in jets]
        if all(part is None for part in parts):
            return None
        lead = next(part.shape[:axes] for part in parts if part is not None)
        full = [
            np.broadcast_to(0.0 if part is None else part, (*lead, n, jet.x.shape[-1]))
            for part, jet in zip(parts, jets, strict=True)
        ]
        return np.concatenate(full, axis=-1)

    second = side("second", 2) if all(jet.second is not None for jet in jets if jet.active) else None
    rest = side("first", 1), second, side("error", 1), side("second_error", 2)
    return Jet(side("x", 0), jets[0].active, *rest)


def by_value(cells: Jet, counts: Bools, wanted: NDArray[np.float64]) -> tuple[Jet, NDArray[np.intp]]:
    """Return the first cell of each trial that has the wanted value, and its index.

    Args:
        cells: `(n, m)`.
        counts: `(n, m)` which of them count.
        wanted: `(n,)`. Where several cells have it and do not change alike, there is no derivative.
    """
    same = counts & (cells.x == wanted[:, None])
    chosen = same.argmax(axis=1)
    trials = np.arange(same.shape[0])
    whole = cells.spread()
    there = same.any(axis=1)
    picked = whole.each(lambda part, _: np.where(there, part[..., trials, chosen], 0.0))
    apart = (whole.first != picked.first[..., None]).any(axis=0) & same
    alone = replace(picked, x=wanted).lost(apart.any(axis=1))
    return alone, chosen
