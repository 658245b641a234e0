"""Central moments of a sample, and how the moments themselves vary from run to run.

Every smooth statistic is a function of the means of z, z², z³, z⁴ (z the standardised value), so its error is its
gradient through one 4 × 4 covariance matrix: the delta method. Independent trials, weighted trials and replicates
differ only in what an independent unit is, and so only in `_pulls` and `_totals`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.columns import PART, RUN, on_disk, pairwise_sum, passed, release
from xlmc.montecarlo.interruption import checkpoint

__all__ = ["Moments", "moments_of"]

Floats = NDArray[np.float64]

Slices = Callable[[slice], Floats]
"""Gives the values of a part of the trials, centred or standardised."""


_SUMMABLE = 1e290
"""Sums of larger values may pass the largest number."""

_SHRUNK = 100
"""After this many halvings, no sum of values can overflow."""


@dataclass(frozen=True, slots=True)
class Moments:
    """Moments in the population's definition (divided by n, or by the sum of the weights).

    Attributes:
        mean: in the unit of the values.
        scale: the root of the second central moment, same unit.
        skewness, kurtosis: the means of z³ and z⁴; nan where all values are equal.
        covariance: (4, 4) of the sample means of z, z², z³, z⁴.
        noise: relative standard error of the mean's own standard error.
        fifth, sixth: the means of z⁵ and z⁶; nan where all values are equal.
        totals: (4, replicates) how far each pulls the means of z, z², z³, z⁴; None for independent trials.
    """

    mean: float
    scale: float
    skewness: float
    kurtosis: float
    covariance: Floats
    noise: float
    fifth: float = math.nan
    sixth: float = math.nan
    totals: Floats | None = None


def moments_of(x: Floats, w: Floats | None, group: NDArray[np.intp] | None, groups: int, units: float) -> Moments:
    """Compute moments of (n,) ascending values with weights that sum to 1, and errors from `units` independent units.

    There are two passes, the first from a pivot inside the data, so that 1e9 ± 1 keeps its digits.
    """
    checkpoint()
    if x.size == 0:
        return Moments(np.nan, np.nan, np.nan, np.nan, np.zeros((4, 4)), np.nan)
    if max(abs(float(x[0])), abs(float(x[-1]))) > _SUMMABLE:
        moments = moments_of(np.ldexp(x, -_SHRUNK), w, group, groups, units)  # an exact scale: sums would overflow
        return replace(moments, mean=math.ldexp(moments.mean, _SHRUNK), scale=math.ldexp(moments.scale, _SHRUNK))
    pivot = float(x[x.size // 2])
    shift = _average(lambda here: x[here] - pivot, x.size, w)

    def about_the_mean(here: slice) -> Floats:
        passed(x)
        return np.asarray(x[here] - pivot - shift)

    centred = _keep_if_in_memory(about_the_mean, x)
    largest = max(float(np.abs(centred(here)).max()) for here in _slices(x.size))
    if largest == 0.0:
        return Moments(pivot + shift, 0.0, np.nan, np.nan, np.zeros((4, 4)), 0.0)
    # Scaled before squaring: tiny and huge units neither vanish nor overflow.
    root = _average(lambda here: np.square(centred(here) / largest), x.size, w) ** 0.5

    z = _keep_if_in_memory(lambda here: centred(here) / largest / root, x)
    release(x)
    means = np.sum([*_sums(z, x.size, w)], axis=0)
    totals = None if group is None else _totals(z, x.size, w, group, groups, means)
    pulls = _pulls(z, x.size, w, means) if totals is None else iter([totals])
    covariance, noise = _variation(pulls, units)
    shape = float(means[2]), float(means[3])
    return Moments(pivot + shift, largest * root, *shape, covariance, noise, float(means[4]), float(means[5]), totals)


def _sums(z: Slices, n: int, w: Floats | None) -> Iterator[Floats]:
    """Yield, block by block, the (6,) sums of z to z⁶, each trial with its share."""
    work = _Work(n)
    for powers, share, _ in _blocks(z, n, w, None):
        shared = np.multiply(powers, share, out=work.for_block(powers.shape[1]))
        first = shared.sum(axis=1)
        yield np.concatenate([first, np.multiply(shared[2], powers[1:3], out=shared[:2]).sum(axis=1)])


class _Work:
    """Memory for (4, b) numbers of one block after another: fresh memory costs more than what is computed in it."""

    def __init__(self, n: int) -> None:
        self._memory = np.empty(4 * min(n, PART))

    def for_block(self, b: int) -> Floats:
        """Return the memory for a block of b trials; what was written there for another is gone."""
        return self._memory[: 4 * b].reshape(4, b)


def _keep_if_in_memory(compute: Slices, x: Floats) -> Slices:
    """Compute all values once if `x` is in memory, or short; else each part whenever it is needed."""
    return compute if on_disk(x) and x.size > RUN else compute(slice(0, x.size)).__getitem__


def _slices(n: int) -> Iterator[slice]:
    return (slice(start, min(start + PART, n)) for start in range(0, n, PART))


def _average(values: Slices, n: int, w: Floats | None) -> float:
    if w is None:
        return pairwise_sum(values, n) / n
    return pairwise_sum(lambda here: w[here] * values(here), n)


def _blocks(
    z: Slices, n: int, w: Floats | None, group: NDArray[np.intp] | None
) -> Iterator[tuple[Floats, Floats | float, NDArray[np.intp] | None]]:
    """Yield, block by block, (4, b) powers of z, the share of each trial in the whole, and its replicate.

    The next block is written over the powers.
    """
    work = _Work(n)
    for here in _slices(n):
        powers = work.for_block(here.stop - here.start)
        powers[0] = z(here)
        np.multiply(powers[0], powers[0], out=powers[1])
        np.multiply(powers[1], powers[0], out=powers[2])
        np.multiply(powers[1], powers[1], out=powers[3])
        yield (
            powers,
            1.0 / n if w is None else w[here],
            None if group is None else group[here],
        )


def _pulls(z: Slices, n: int, w: Floats | None, means: Floats) -> Iterator[Floats]:
    """Yield, block by block, (4, b) how far each trial pulls the means of z, z², z³, z⁴; see `_blocks`."""
    for powers, share, _ in _blocks(z, n, w, None):
        np.subtract(powers, means[:4, None], out=powers)
        yield np.multiply(powers, share, out=powers)


def _totals(z: Slices, n: int, w: Floats | None, group: NDArray[np.intp], groups: int, means: Floats) -> Floats:
    """Return (4, groups) how far each replicate pulls them."""
    totals = np.zeros((4, groups))
    for powers, share, ids in _blocks(z, n, w, group):
        pulls = (powers - means[:4, None]) * share
        assert ids is not None, "the blocks are of trials with replicates"
        totals += [np.bincount(ids, weights=row, minlength=groups) for row in pulls]
    return totals


def _variation(influences: Iterator[Floats], units: float) -> tuple[Floats, float]:
    """Return the covariance of the four means, and the relative error of the first one's standard error."""
    covariance, fourth, count = np.zeros((4, 4)), 0.0, 0
    for pulls in influences:
        covariance += np.einsum("iu,ju->ij", pulls, pulls)  # not a matrix product: threads must not change the last bit
        square = pulls[0] * pulls[0]
        fourth += float(np.sum(square * square))
        count += pulls.shape[1]
    if units <= 1.0:
        return np.zeros((4, 4)), np.nan
    variance = float(covariance[0, 0])
    if variance == 0.0:
        return covariance, 0.0
    # The mean's squared error is a sum of one square per unit: the spread of the squares, and, for few units, that of
    # the mean they are taken about.
    spread = (fourth / (variance * variance) - 1.0 / count) * units / (units - 1.0) + 2.0 / (units * (units - 1.0))
    return covariance * (units / (units - 1.0)), 0.5 * max(spread, 0.0) ** 0.5
