"""A column of trials in ascending order, cut into classes of equal probability: what every given-data measure needs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["Classes", "Ladder", "Ranked"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_MOST_CLASSES = 16
"""With a straight line in each they follow two periods of a sine to 0.1 % of its variance."""

_STEPS = 32
"""Classes of a forecast where its distribution function is looked at: at each of the limits between them."""

_LEAST_IN_A_CLASS = 50
"""Trials, where there is more than one class: enough to lay a line through."""

_LEAST_FITTED = 8
"""Trials in the finest classes."""

_FLAT = 1e-24
"""A share of the column's variance: less within a class is rounding, and no line is fitted there."""

_LARGE = 1e100
"""From here on squares may overflow when many are added up."""


@dataclass(frozen=True)
class Classes:
    """A column's classes, with a straight line in each: the functions of it that a forecast is compared with.

    Attributes:
        starts, sizes: `(c,)` of each class, in ascending order of the column.
        label: `(n,)` the class of each trial, in that order.
        centred: `(n,)` the column less its mean in the class, in that order; all 0 in a class without a line.
        squares: `(c,)` sums of squares of `centred`; 1 in a class without a line.
        freedom: parameters of the fit: a mean a class, and a slope where there is a line.
    """

    starts: Indices
    sizes: Indices
    label: Indices
    centred: Floats
    squares: Floats
    freedom: int


@dataclass(frozen=True)
class Ranked:
    """`(n,)` values with their order.

    Attributes:
        values: as they came.
        order: the indices of the values, ascending.
    """

    values: Floats
    order: Indices

    @classmethod
    def of(cls, values: Floats) -> Ranked:
        return cls(values, np.argsort(values))

    @property
    def n(self) -> int:
        return int(self.values.size)

    @cached_property
    def ties(self) -> tuple[Indices, Indices]:
        """For every value in ascending order, `(n,)`: the index of the first equal one, and one past the last."""
        ascending = self.values[self.order]
        starts = np.flatnonzero(np.concatenate([[True], ascending[1:] != ascending[:-1]]))
        ends = np.append(starts[1:], self.n)
        return np.repeat(starts, ends - starts), np.repeat(ends, ends - starts)

    @cached_property
    def grades(self) -> Floats:
        """`(n,)` the share of values below each, −½ to ½ about the median; equal values share their mean."""
        first, end = self.ties
        grades = np.empty(self.n)
        grades[self.order] = (first + end) / (2.0 * self.n) - 0.5
        return grades

    @cached_property
    def spread(self) -> float:
        """The mean square of the grades: 1/12 without equal values, 0 where all are equal."""
        return float(np.mean(self.grades**2))

    def above(self, amounts: Floats) -> Floats:
        """`(n,)` for each trial the sum over n of amounts that sum to 0, at larger values, and half at equal ones."""
        first, end = self.ties
        reached = np.concatenate([[0.0], np.cumsum(amounts[self.order])])
        values = np.empty(self.n)
        values[self.order] = -(reached[first] + reached[end]) / (2.0 * self.n)
        return values

    @cached_property
    def pulls(self) -> Floats:
        """`(n,)` of the spread: see `given_data.rank_correlation`."""
        values = self.grades**2 + 2.0 * self.above(self.grades)
        return np.asarray(values - values.mean())

    @property
    def varies(self) -> bool:
        first, _ = self.ties
        return bool(first[-1] > 0)

    @cached_property
    def steps(self) -> Indices:
        """`(n,)` the class of every value, of `_STEPS` at most, numbered upwards from 0."""
        values = np.empty(self.n, np.intp)
        values[self.order] = self._labels(_STEPS)
        return values

    def _labels(self, classes: int) -> Indices:
        """`(n,)` classes of equal probability, in ascending order of the values; equal values stay together."""
        raw = np.floor((self.grades[self.order] + 0.5) * classes).astype(np.intp)
        return np.cumsum(np.concatenate([[0], raw[1:] != raw[:-1]]))

    @cached_property
    def classes(self) -> Classes:
        """At most 16, each of 50 trials or more."""
        return self.ladder[0]

    @cached_property
    def ladder(self) -> Ladder:
        """`classes`, then four times as many, and so on, as long as there are 8 trials in each."""
        return Ladder(self)

    def cut(self, count: int) -> Classes:
        """So many classes of equal probability, fewer where values are equal, with a line in each."""
        label = self._labels(count)
        starts = np.flatnonzero(np.concatenate([[True], label[1:] != label[:-1]]))
        sizes = np.diff(np.append(starts, self.n))
        x = _squarable(self.values[self.order])
        x = x - x.mean()
        centred = x - np.repeat(np.add.reduceat(x, starts) / sizes, sizes)
        squares = np.add.reduceat(centred**2, starts)
        flat = squares <= _FLAT * max(float(np.sum(x * x)), np.finfo(float).tiny)
        centred[np.repeat(flat, sizes)] = 0.0
        freedom = int(starts.size + np.count_nonzero(~flat))
        return Classes(starts, sizes, label, centred, np.where(flat, 1.0, squares), freedom)


class Ladder:
    """Ever finer classes of a column, each made when it is first asked for."""

    def __init__(self, ranked: Ranked) -> None:
        first = min(_MOST_CLASSES, max(1, ranked.n // _LEAST_IN_A_CLASS))
        doublings = max(ranked.n // (_LEAST_FITTED * first), 1).bit_length() - 1
        self._counts = [first * 4**step for step in range(doublings // 2 + 1)]
        self._ranked = ranked
        self._made: dict[int, Classes] = {}

    def __iter__(self) -> Iterator[Classes]:
        return (self[index] for index in range(len(self._counts)))

    def __getitem__(self, index: int) -> Classes:
        count = self._counts[index]
        if count not in self._made:
            self._made[count] = self._ranked.cut(count)
        return self._made[count]


def _squarable(x: Floats) -> Floats:
    """Return the values; very large ones in units of the largest: their squares are numbers, and lines fit them as
    well.
    """
    largest = float(np.abs(x).max(initial=0.0))
    return x / largest if largest > _LARGE else x
