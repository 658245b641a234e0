"""The numbers that ranges hold, and bodies made of functions of such numbers.

Letters: n trials, k cells of a range, m points that a function is asked at (1, but for array formulas).
In a range only numbers count; what is given directly is taken as arithmetic takes it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps

import numpy as np

from xlmc.functions.arguments import direct_errors, earliest, first_errors, leveled
from xlmc.functions.lookup.picked_cells import flattened
from xlmc.functions.values import NA, NUMBER, Bools, Codes, Floats, Value

__all__ = [
    "Sample",
    "at_each",
    "laid_out",
    "mean_of",
    "of_pairs",
    "pairs_of",
    "points_of",
    "row_sums",
    "sample_of",
    "spread_of",
]


def row_sums(x: Floats) -> Floats:
    """Sums of the rows from left to right, the same bits for any number of rows: (n, k) -> (n,)."""
    return np.asarray(np.add.accumulate(x, axis=1)[:, -1])


def mean_of(x: Floats, counts: Bools) -> tuple[Floats, Floats, Floats]:
    """The mean of what counts, every distance from it (0 of what does not), and how much counts: (n,), (n, k), (n,).

    The distances sum up to 0 as well as doubles can, however far from 0 the numbers lie; those of equal numbers are 0.
    """
    k = counts.sum(axis=1).astype(np.float64)
    divisor = np.maximum(k, 1.0)
    most = np.where(counts, x, -np.inf).max(axis=1)
    varies = most > np.where(counts, x, np.inf).min(axis=1)
    first = row_sums(np.where(counts, x, 0.0)) / divisor
    distance = np.where(counts, x - first[:, None], 0.0)
    over = row_sums(distance) / divisor
    mean = np.where(varies | (k == 0), first + over, most)
    return mean, np.where(counts & varies[:, None], distance - over[:, None], 0.0), k


def spread_of(x: Floats, counts: Bools) -> tuple[Floats, Floats]:
    """The sum of the squared distances from the mean, and how much counts: (n, k) -> (n,), (n,)."""
    _, distance, k = mean_of(x, counts)
    return row_sums(distance * distance), k


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """The numbers of one range.

    Attributes:
        x: the cells, (n, k); any number where it does not count.
        counts: whether the cell is a number.
        codes: the cell's error, 0 for none.
    """

    x: Floats
    counts: Bools
    codes: Codes

    @property
    def errors(self) -> Codes:
        """The first error of each trial: (n,)."""
        return first_errors(self.codes)

    @property
    def size(self) -> Floats:
        """How many numbers each trial has: (n, 1)."""
        return np.asarray(self.counts.sum(axis=1, keepdims=True), np.float64)

    def ordered(self) -> Floats:
        """The numbers of each trial in rising order, infinities behind them: (n, k)."""
        return np.sort(np.where(self.counts, self.x, np.inf), axis=1)

    def how_many(self, relation: Callable[[Floats, Floats], Bools], points: Floats) -> Floats:
        """How many numbers of each trial stand in a relation to each point: (n, m) -> (n, m)."""
        found = [(relation(self.x, column[:, None]) & self.counts).sum(axis=1) for column in points.T]
        return np.stack(found, axis=1).astype(np.float64)


def sample_of(value: Value) -> Sample:
    """The numbers of a range, or the one number given directly."""
    in_range = value.numbers.ndim == 3
    x, errors = (value.numbers, value.errors) if in_range else value.to_numbers()
    counts = value.kinds == NUMBER if in_range else errors == 0
    return Sample(flattened(x, value), flattened(counts, value), flattened(errors, value))


def pairs_of(first: Value, second: Value) -> tuple[Floats, Floats, Bools, Codes] | None:
    """Two ranges cell by cell: the numbers, where both are some, and the first error; None for unequal sizes.

    Shapes: (n, k) three times, (n,).
    """
    one, other = sample_of(first), sample_of(second)
    if one.x.shape[1] != other.x.shape[1]:
        return None
    counts = one.counts & other.counts
    return one.x, other.x, counts, earliest(one.errors, other.errors)


def of_pairs(body: Callable[[Floats, Floats, Bools], Floats]) -> Callable[[Value, Value], Value]:
    """A body for two ranges from a function of their pairs, (n, k) each -> (n,); `#N/A` for unequal sizes."""

    @wraps(body)
    def apply(first: Value, second: Value) -> Value:
        pairs = pairs_of(first, second)
        if pairs is None:
            return Value.of_numbers(np.full(1, NA), earliest(direct_errors(first), direct_errors(second)))
        x, y, counts, errors = pairs
        return Value.of_numbers(body(x, y, counts), errors)

    return apply


def points_of(*values: Value) -> tuple[list[Floats], list[Codes], tuple[int, ...]]:
    """Single arguments as numbers (n, m) and errors (n, m), and the shape, (n,) or (n, r, c), that they have in all."""
    level = leveled(*values)
    shape = np.broadcast_shapes(*(value.shape for value in level))
    found = [value.to_numbers() for value in level]
    whole = Value(np.zeros(shape), np.zeros(shape, np.uint8))
    return [flattened(x, whole) for x, _ in found], [flattened(codes, whole) for _, codes in found], shape


def laid_out(result: Floats, errors: Codes, shape: tuple[int, ...]) -> Value:
    """A result (n, m) or (1, m) in the shape of the points it is for."""
    full = np.broadcast_shapes(result.shape, errors.shape)
    back = (full[0], *shape[1:])
    return Value.of_numbers(*(np.broadcast_to(array, full).reshape(back) for array in (result, errors)))


def at_each(position: int = 0) -> Callable[[Callable[..., Floats]], Callable[..., Value]]:
    """A body from a function of the `Sample` of the argument at `position` and of points (n, m), which gives (n, m)."""

    def decorate(body: Callable[..., Floats]) -> Callable[..., Value]:
        @wraps(body)
        def apply(*arguments: Value) -> Value:
            sample = sample_of(arguments[position])
            points, codes, shape = points_of(*arguments[:position], *arguments[position + 1 :])
            codes.insert(position, sample.errors[:, None])
            return laid_out(body(sample, *points), earliest(*codes), shape)

        return apply

    return decorate
