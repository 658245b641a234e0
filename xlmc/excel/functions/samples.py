"""The numbers that ranges hold, and how functions of such numbers become bodies.

Letters: n trials, k cells of a range, m points at which a function is computed (1, except in array formulas).
In a range only numbers count; a value given directly is converted as in arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps

import numpy as np

from xlmc.excel.functions.arguments import align_ranges, errors_unless_range, first_error, first_error_in_row
from xlmc.excel.functions.lookup.picked_cells import flatten_cells, join_cells
from xlmc.excel.functions.values import NA, NUMBER, Bools, Codes, Floats, Value

__all__ = [
    "Sample",
    "at_each",
    "join_samples",
    "mean_of",
    "of_pairs",
    "pairs_of",
    "points_of",
    "restore_shape",
    "row_sums",
    "sample_of",
    "spread_of",
]


def row_sums(x: Floats) -> Floats:
    """Sum each row from left to right, with the same bits for any number of rows: (n, k) -> (n,)."""
    return np.add.accumulate(x, axis=1)[:, -1].copy()  # a part would hold all sums up to it in memory


def mean_of(x: Floats, counts: Bools) -> tuple[Floats, Floats, Floats]:
    """Return the mean of the numbers that count, their distances from it, and how many they are: (n,), (n, k), (n,).

    The distance is 0 where a number does not count. The distances sum to 0 as well as doubles can, however far from 0
    the numbers lie; those of equal numbers are 0.
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
    """Return the sum of the squared distances from the mean, and how many numbers count: (n, k) -> (n,), (n,)."""
    _, distance, k = mean_of(x, counts)
    return row_sums(distance * distance), k


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """The numbers of one range.

    Attributes:
        x: the cells, (n, k); arbitrary numbers where they do not count.
        counts: whether each cell is a number.
        codes: the error of each cell, 0 for none.
    """

    x: Floats
    counts: Bools
    codes: Codes

    @property
    def errors(self) -> Codes:
        """The first error of each trial: (n,)."""
        return first_error_in_row(self.codes)

    @property
    def size(self) -> Floats:
        """How many numbers each trial has: (n, 1)."""
        return np.asarray(self.counts.sum(axis=1, keepdims=True), np.float64)

    def ordered(self) -> Floats:
        """Return the numbers of each trial in rising order, followed by infinities: (n, k)."""
        return np.sort(np.where(self.counts, self.x, np.inf), axis=1)

    def count_where(self, relation: Callable[[Floats, Floats], Bools], points: Floats) -> Floats:
        """Count the numbers of each trial that are, say, less than each point: (n, m) -> (n, m)."""
        result = [(relation(self.x, column[:, None]) & self.counts).sum(axis=1) for column in points.T]
        return np.stack(result, axis=1).astype(np.float64)


def sample_of(value: Value) -> Sample:
    """Read the numbers of a range, or the one number given directly."""
    in_range = value.numbers.ndim == 3
    x, errors = (value.numbers, value.errors) if in_range else value.to_numbers()
    counts = value.kinds == NUMBER if in_range else errors == 0
    return Sample(flatten_cells(x, value), flatten_cells(counts, value), flatten_cells(errors, value))


def join_samples(samples: Sequence[Sample]) -> Sample:
    """Put samples side by side, as one: (n, k) or (1, k) each -> (n, the sum of all k)."""
    x, counts, codes = (join_cells([getattr(sample, part) for sample in samples]) for part in ("x", "counts", "codes"))
    return Sample(x, counts, codes)


def pairs_of(first: Value, second: Value) -> tuple[Floats, Floats, Bools, Codes] | None:
    """Pair two ranges cell by cell; None if their sizes differ.

    Returns:
        The cells of both ranges, and where both are numbers, (n, k) each; the first error, (n,).
    """
    one, other = sample_of(first), sample_of(second)
    if one.x.shape[1] != other.x.shape[1]:
        return None
    counts = one.counts & other.counts
    return one.x, other.x, counts, first_error(one.errors, other.errors)


def of_pairs(body: Callable[[Floats, Floats, Bools], Floats]) -> Callable[[Value, Value], Value]:
    """Make a body for two ranges from a function of their pairs, (n, k) each -> (n,); `#N/A` if sizes differ."""

    @wraps(body)
    def apply(first: Value, second: Value) -> Value:
        pairs = pairs_of(first, second)
        if pairs is None:
            return Value.of_numbers(
                np.full(1, NA), first_error(errors_unless_range(first), errors_unless_range(second))
            )
        x, y, counts, errors = pairs
        return Value.of_numbers(body(x, y, counts), errors)

    return apply


def points_of(*values: Value) -> tuple[list[Floats], list[Codes], tuple[int, ...]]:
    """Return arguments as numbers (n, m) and errors (n, m), and the shape (n,) or (n, r, c) that they broadcast to."""
    level = align_ranges(*values)
    shape = np.broadcast_shapes(*(value.shape for value in level))
    result = [value.to_numbers() for value in level]
    whole = Value(np.zeros(shape), np.zeros(shape, np.uint8))
    return [flatten_cells(x, whole) for x, _ in result], [flatten_cells(codes, whole) for _, codes in result], shape


def restore_shape(result: Floats, errors: Codes, shape: tuple[int, ...]) -> Value:
    """Give a result (n, m) or (1, m) the shape of the points that it belongs to."""
    full = np.broadcast_shapes(result.shape, errors.shape)
    back = (full[0], *shape[1:])
    return Value.of_numbers(*(np.broadcast_to(array, full).reshape(back) for array in (result, errors)))


def at_each(position: int = 0) -> Callable[[Callable[..., Floats]], Callable[..., Value]]:
    """Make a body from a function of the `Sample` of the argument at `position` and of points, (n, m) -> (n, m)."""

    def decorate(body: Callable[..., Floats]) -> Callable[..., Value]:
        @wraps(body)
        def apply(*arguments: Value) -> Value:
            sample = sample_of(arguments[position])
            points, codes, shape = points_of(*arguments[:position], *arguments[position + 1 :])
            codes.insert(position, sample.errors[:, None])
            return restore_shape(body(sample, *points), first_error(*codes), shape)

        return apply

    return decorate
