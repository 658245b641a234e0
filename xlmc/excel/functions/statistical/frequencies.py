"""How often numbers occur. Letters: n trials, k numbers of a trial, b bins, m points that a function is asked at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import error_where, first_error, require_same_in_all_trials
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.lookup.picked_cells import Indices, flatten_cells
from xlmc.excel.functions.registry import Arrays, Kind, Number, excel
from xlmc.excel.functions.samples import Sample, join_samples, pairs_of, points_of, restore_shape, row_sums, sample_of
from xlmc.excel.functions.values import ERROR, NA, NUM, NUMBER, Bools, Codes, Floats, Value

__all__: list[str] = []

_WHOLE: Final = 1e-9
"""The sum of probabilities may differ from 1 by this."""


@dataclass(frozen=True, slots=True, eq=False)
class _Modes:
    """The most frequent numbers of each trial.

    Attributes:
        x: all numbers, (n, k).
        indices: where each mode first stands in `x`, in rising order, filled up with k: (n, k).
        how_many: modes of each trial, (n,).
        errors: (n,).
    """

    x: Floats
    indices: Indices
    how_many: Indices
    errors: Codes


def _modes_of(values: tuple[Value, ...]) -> _Modes:
    sample = join_samples([_list_numbers(value) for value in values])
    indices = _first_indices(sample.x, sample.counts)
    return _Modes(sample.x, indices, (indices < sample.x.shape[1]).sum(axis=1), sample.errors)


def _list_numbers(value: Value) -> Sample:
    """Return the numbers of an argument; a value or cell by itself must be a number."""
    alone = value.shape[1:] in ((), (1, 1))
    kinds = flatten_cells(value.kinds, value)
    wrong = error_where(alone & (kinds != NUMBER) & (kinds < ERROR), ErrorCode.VALUE)
    return Sample(
        flatten_cells(value.numbers, value), kinds == NUMBER, first_error(flatten_cells(value.errors, value), wrong)
    )


def _first_indices(x: Floats, counts: Bools) -> Indices:
    """Return the `indices` of `_Modes`: sorted numbers form runs of equal ones; the longest, from two on, are the
    modes.
    """
    k = x.shape[1]
    order = np.argsort(np.where(counts, x, np.inf), axis=1, kind="stable")
    ordered, valid = np.take_along_axis(x, order, axis=1), np.take_along_axis(counts, order, axis=1)
    begins = np.concatenate([np.ones((x.shape[0], 1), bool), ordered[:, 1:] != ordered[:, :-1]], axis=1)
    start = np.maximum.accumulate(np.where(begins, np.arange(k), 0), axis=1)
    length = np.where(valid, np.arange(k) - start + 1, 0)
    longest = np.maximum(length.max(axis=1, keepdims=True), 2)
    return np.sort(np.where(length == longest, np.take_along_axis(order, start, axis=1), k), axis=1)


@excel("MODE.SNGL", Arrays(repeat=True), aliases=("MODE",), facts=Facts(empty_cells=EmptyCells.IGNORED))
def mode(*values: Value) -> Value:
    """Return the most frequent number, the first of several; `#N/A` where none occurs twice."""
    modes = _modes_of(values)
    first = np.minimum(modes.indices[:, :1], modes.x.shape[1] - 1)
    result = np.take_along_axis(modes.x, first, axis=1)[:, 0]
    return Value.of_numbers(np.where(modes.how_many > 0, result, NA), modes.errors)


@excel("MODE.MULT", Arrays(repeat=True), returns=Kind.ANY, facts=Facts(spills=True, empty_cells=EmptyCells.IGNORED))
def modes_in_a_column(*values: Value) -> Value:
    """All of the most frequent numbers, in the order they appear in: (n, modes, 1); `#N/A` where none occurs twice.

    Raises:
        ShapeVaries: not all trials have as many.
    """
    modes = _modes_of(values)
    rows = int(require_same_in_all_trials(np.where(modes.errors > 0, 1, np.maximum(modes.how_many, 1))))
    result = np.take_along_axis(modes.x, np.minimum(modes.indices[:, :rows], modes.x.shape[1] - 1), axis=1)
    result = np.where(modes.how_many[:, None] > 0, result, NA)
    return Value.of_numbers(result[:, :, None], modes.errors.reshape(-1, 1, 1))


@excel("FREQUENCY", Arrays, Arrays, returns=Kind.ANY, facts=Facts(spills=True, empty_cells=EmptyCells.IGNORED_IN_FIRST))
def frequency(values: Value, bins: Value) -> Value:
    """Count the numbers up to each bin and above the next lower one, and those above all bins: (n, b + 1, 1).

    Bins need no order; of equal bins the first counts, the others give 0. A cell that is no number is no bin.

    Raises:
        ShapeVaries: not all trials have the same cells for bins.
    """
    sample, given = sample_of(values), sample_of(bins)
    limits = given.x[:, require_same_in_all_trials(given.counts | (given.codes > 0))]
    order = np.argsort(limits, axis=1, kind="stable")
    rising = np.concatenate([np.take_along_axis(limits, order, axis=1), np.full((limits.shape[0], 1), np.inf)], axis=1)
    up_to = sample.count_where(np.less_equal, rising)
    each = np.diff(up_to, axis=1, prepend=0.0)
    back = np.argsort(order, axis=1, kind="stable")
    back = np.concatenate([back, np.full((back.shape[0], 1), back.shape[1])], axis=1)
    result = np.take_along_axis(each, np.broadcast_to(back, each.shape), axis=1)
    errors = first_error(sample.errors, given.errors)
    return Value.of_numbers(result[:, :, None], errors[:, None, None])


@excel("PROB", Arrays, Arrays, Number, Number(default=None))
def probability_between(values: Value, shares: Value, low: Value, high: Value | None = None) -> Value:
    """Sum of the probabilities of the values from `low` to `high`, or of those that equal `low`.

    `#NUM!` for probabilities that are not above 0 and at most 1, or do not add up to 1; `#N/A` for unequal sizes.
    """
    pairs = pairs_of(values, shares)
    points, codes, shape = points_of(low, low if high is None else high)
    if pairs is None:
        return restore_shape(np.full((1, 1), NA), first_error(*codes), shape)
    x, p, counts, errors = pairs
    p = np.where(counts, p, 0.0)
    proper = ((p > 0) & (p <= 1) | ~counts).all(axis=1) & (np.abs(row_sums(p) - 1) < _WHOLE)
    columns = zip(*(point.T for point in points), strict=True)
    sums = [row_sums(np.where((x >= a[:, None]) & (x <= b[:, None]), p, 0.0)) for a, b in columns]
    result = np.where(proper[:, None], np.stack(sums, axis=1), NUM)
    return restore_shape(result, first_error(errors[:, None], *codes), shape)
