"""The mode: where the trials lie closest.

**Value.** Half-sample mode (Robertson & Cryer 1974, Bickel 2002): keep the half of the trials that lies in the shortest
interval, then the densest half of those, until two or three are left. There is no bandwidth to choose, and outliers do
not matter. It is meant for continuous forecasts: if there are at most half as many different values as trials, as for
counts, the mode is the most frequent value.

**Error.** In a window of width h about a rounded peak the noise of a count, √(nh), hides the curvature, nh³, until h
is about n^(−1/5): the mode converges no faster, and the bootstrap fails for such statistics. Subsampling does not
(Politis & Romano 1994). Therefore a fixed shuffle deals the trials into 32 equal groups (fewer if one would hold under
8 trials), and the standard deviation of the groups' modes is scaled from the group's size to n by the fifth-root law.
With replicates, the groups are the replicates. At a peak with a kink or an edge the mode converges as n^(−1/3), and
this error is up to about twice too large. It measures the spread only: the bias of a skewed peak, which shrinks with n
as well, is not in it. Counts have whole modes: the ends of the interval are the nearest whole numbers, and where both
are the mode itself its error is 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.columns import PART, passed, picked, release
from xlmc.montecarlo.statistics.estimate import Estimate, with_error
from xlmc.montecarlo.statistics.sample import Sample, Values

__all__ = ["mode"]

Floats = NDArray[np.float64]

GROUPS = 32
LEAST_IN_A_GROUP = 8
MOST_IN_A_GROUP = 10_000  # more would cost time and not improve the spread of 32 numbers
SHUFFLE_SEED = 1974
CONVERGENCE = 0.2
_SQUARABLE = 1e140  # squares and sums of larger numbers may overflow
ROUNDING = 1e-9  # widths that differ by less are equal: 0.3 − 0.2 and 0.2 − 0.1


def mode(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Half-sample mode of (n,) values, or the most frequent of counts; no error below 16 trials or two replicates.

    >>> mode([1.0, 4.0, 4.25, 4.5, 9.0]).value
    4.25
    """
    sample = Sample.of(values, weights, replicate)
    if sample.n == 0:
        return Estimate(np.nan)
    value = half_sample_mode(sample)
    sizes, modes = _modes_of_groups(sample)
    is_count = sample.whole and _are_counts(sample.x)
    release(sample.x)
    if modes.size < 2:
        return Estimate(value, n=sample.n)
    largest = float(np.abs(modes).max())
    unit = largest if largest > _SQUARABLE else 1.0
    error = float(unit * np.std(modes / unit, ddof=1) * (np.mean(sizes) / sample.n) ** CONVERGENCE)
    result = with_error(value, error, modes.size - 1.0, confidence, sample.n)
    return _of_whole_numbers(result) if is_count else result


def _of_whole_numbers(result: Estimate) -> Estimate:
    """Return the mode of counts with whole ends of its interval, and without an error where these are equal."""
    if result.interval is None:
        return result
    low, high = (float(round(end)) for end in result.interval)
    return Estimate(result.value, 0.0 if low == high else result.error, (low, high), result.n)


def half_sample_mode(sample: Sample) -> float:
    """Return the mode of at least one ascending value, weighted or not."""
    x, w = sample.x, sample.w
    if _are_counts(x):
        return _most_frequent(x, w)
    with np.errstate(over="ignore"):  # a half that is wider than all doubles is not the densest
        while x.size > 3:
            half = _densest_half(x) if w is None else _densest_weighted_half(x, w)
            x, w = x[half], None if w is None else w[half]
            if x[0] == x[-1]:
                return float(x[0])
    return _mode_of_three(x, np.ones(x.size) if w is None else w)


def _are_counts(x: Floats) -> bool:
    """Return whether there are at most half as many different values as trials."""
    different = 1
    for start in range(1, x.size, PART):
        stop = min(start + PART, x.size)
        different += int(np.count_nonzero(x[start:stop] != x[start - 1 : stop - 1]))
        passed(x)
        if 2 * different > x.size:
            return False
    return 2 * different <= x.size


def _most_frequent(x: Floats, w: Floats | None) -> float:
    """Return the value with the most weight; the middle one if there are several."""
    most, result = 0.0, [np.empty(0)]
    for values, carried in _runs(x, w):
        largest = float(carried.max(initial=0.0))
        if largest > most * (1.0 + ROUNDING):
            most, result = largest, []
        result.append(values[carried >= most * (1.0 - ROUNDING)])
    tied = np.concatenate(result)
    return float(tied[(tied.size - 1) // 2])


def _runs(x: Floats, w: Floats | None) -> Iterator[tuple[Floats, Floats]]:
    """Yield the different values in ascending order and the weight of each, a part at a time."""
    last, carried = np.empty(0), np.empty(0)
    for start in range(0, x.size, PART):
        here = np.concatenate([last, x[start : start + PART]])
        amounts = np.concatenate([carried, np.ones(here.size - last.size) if w is None else w[start : start + PART]])
        passed(x)
        starts = np.flatnonzero(np.concatenate([[True], here[1:] != here[:-1]]))
        values, sums = here[starts], np.add.reduceat(amounts, starts)
        yield values[:-1], sums[:-1]
        last, carried = values[-1:], sums[-1:]
    yield last, carried


def _densest_half(x: Floats) -> slice:
    size = (x.size + 1) // 2

    if x.size <= PART:
        start = _find_smallest(x[size - 1 :] - x[: x.size - size + 1])
        return slice(start, start + size)

    def widths() -> Iterator[Floats]:
        for start in range(0, x.size - size + 1, PART):
            stop = min(start + PART, x.size - size + 1)
            yield x[start + size - 1 : stop + size - 1] - x[start:stop]
            passed(x)

    start = _find_smallest_in_parts(widths)
    return slice(start, start + size)


def _densest_weighted_half(x: Floats, w: Floats) -> slice:
    """Return the run of trials with at least half the weight that is shortest for its weight."""
    reached = np.concatenate([[0.0], np.cumsum(w)])
    needed = reached[:-1] + reached[-1] / 2.0 * (1.0 - 1e-12)  # rounding must not ask for one trial more
    stops = np.searchsorted(reached, needed)
    stops = stops[stops <= x.size]
    starts = np.arange(stops.size)
    start = _find_smallest((x[stops - 1] - x[starts]) / (reached[stops] - reached[starts]))
    return slice(start, int(stops[start]))


def _find_smallest(widths: Floats) -> int:
    """Return the index of the smallest; of several the middle one, so that evenly spaced values do not give an end."""
    smallest = np.flatnonzero(widths <= widths.min() * (1.0 + ROUNDING))
    return int(smallest[(smallest.size - 1) // 2])


def _find_smallest_in_parts(widths: Callable[[], Iterator[Floats]]) -> int:
    """Do the same for widths that each call yields anew, a part at a time."""
    smallest = min(float(part.min()) for part in widths()) * (1.0 + ROUNDING)
    wanted = (sum(int(np.count_nonzero(part <= smallest)) for part in widths()) - 1) // 2
    passed = 0
    for part in widths():
        here = np.flatnonzero(part <= smallest)
        if wanted < here.size:
            return passed + int(here[wanted])
        wanted, passed = wanted - here.size, passed + part.size
    raise AssertionError("the smallest width is one of them")


def _mode_of_three(x: Floats, w: Floats) -> float:
    """Return one value; the mean of two; of three that of the closer pair, or the middle one if neither is closer."""
    if x.size == 3:
        left, right = (x[1] - x[0]) / (w[0] + w[1]), (x[2] - x[1]) / (w[1] + w[2])
        if abs(left - right) <= ROUNDING * (left + right):
            return float(x[1])
        pair = slice(0, 2) if left < right else slice(1, 3)
        x, w = x[pair], w[pair]
    return float(x[0] + np.sum(w * (x - x[0])) / np.sum(w))


def _modes_of_groups(sample: Sample) -> tuple[Floats, Floats]:
    """Return the sizes and the modes, `(groups,)`, of independent parts: the replicates, or groups dealt by rank, which
    do not depend on the order of trials.
    """
    if sample.group is not None:
        parts = [sample.replicate(each) for each in range(sample.groups)]
        return np.array([part.n for part in parts], float), np.array([half_sample_mode(part) for part in parts])
    groups = min(GROUPS, sample.n // LEAST_IN_A_GROUP)
    if groups < 2:
        return np.empty(0), np.empty(0)
    dealt = _dealt(sample.n, groups)
    if sample.w is None:
        modes = half_sample_modes(picked(sample.x, dealt.ravel()).reshape(dealt.shape))
    else:
        modes = np.array([half_sample_mode(sample.part(ranks)) for ranks in dealt])
    return np.full(groups, float(dealt.shape[1])), modes


def half_sample_modes(rows: Floats) -> Floats:
    """Return the modes, `(g,)`, of `(g, n)` values, ascending in each row: what `half_sample_mode` gives for each."""
    values, waiting = np.empty(len(rows)), np.arange(len(rows))
    different = 1 + np.count_nonzero(rows[:, 1:] != rows[:, :-1], axis=1)

    def finish(done: NDArray[np.bool_], mode_of: Callable[[Floats], float]) -> None:
        nonlocal rows, waiting
        if done.any():
            values[waiting[done]] = [mode_of(row) for row in rows[done]]
            rows, waiting = rows[~done], waiting[~done]

    finish(2 * different <= rows.shape[1], lambda row: _most_frequent(row, None))
    with np.errstate(over="ignore"):  # a half that is wider than all doubles is not the densest
        while waiting.size and rows.shape[1] > 3:
            size = (rows.shape[1] + 1) // 2
            starts = _find_smallest_of_rows(rows[:, size - 1 :] - rows[:, : rows.shape[1] - size + 1])
            rows = np.array([row[start : start + size] for row, start in zip(rows, starts, strict=True)])
            finish(rows[:, 0] == rows[:, -1], lambda row: float(row[0]))
    finish(np.ones(waiting.size, bool), lambda row: _mode_of_three(row, np.ones(row.size)))
    return values


def _find_smallest_of_rows(widths: Floats) -> NDArray[np.intp]:
    """Return `_find_smallest` of each row."""
    smallest = widths <= widths.min(axis=1, keepdims=True) * (1.0 + ROUNDING)
    values: NDArray[np.intp] = smallest.argmax(axis=1)
    for row in np.flatnonzero(np.count_nonzero(smallest, axis=1) > 2):
        values[row] = _find_smallest(widths[row])
    return values


@lru_cache(maxsize=2)
def _dealt(n: int, groups: int) -> NDArray[np.intp]:
    """Deal n ranks to groups, ascending in each, `(groups, size)`: the same for all forecasts of a run."""
    size = min(n // groups, MOST_IN_A_GROUP)
    shuffle = np.random.Generator(np.random.PCG64DXSM(SHUFFLE_SEED))
    dealt = np.sort(shuffle.choice(n, (groups, size), replace=False), axis=1)
    dealt.flags.writeable = False
    return dealt
