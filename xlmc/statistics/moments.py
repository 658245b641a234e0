"""Central moments of a sample, and how the moments themselves vary from run to run.

Every smooth statistic is a function of the means of z, z², z³, z⁴ (z the standardised value), so its error is its
gradient through one 4 × 4 covariance matrix: the delta method. Independent trials, weighted trials and replicates
differ only in what an independent unit is, and so only in `_influences`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Moments", "moments_of"]

Floats = NDArray[np.float64]

BLOCK = 65_536
"""Trials per pass: the powers of one block fit in the processor's cache."""


@dataclass(frozen=True, slots=True)
class Moments:
    """Moments in the population's definition (divided by n, or by the sum of the weights).

    Attributes:
        mean: in the unit of the values.
        scale: the root of the second central moment, same unit.
        skewness, kurtosis: the means of z³ and z⁴; nan where all values are equal.
        covariance: (4, 4) of the sample means of z, z², z³, z⁴.
        noise: relative standard error of the mean's own standard error.
    """

    mean: float
    scale: float
    skewness: float
    kurtosis: float
    covariance: Floats
    noise: float


def moments_of(x: Floats, w: Floats | None, group: NDArray[np.intp] | None, groups: int, units: float) -> Moments:
    """Moments of (n,) values with weights that sum to 1, counting errors in `units` independent units.

    Two passes, the first from a pivot inside the data, so that 1e9 ± 1 keeps its digits.
    """
    if x.size == 0:
        return Moments(np.nan, np.nan, np.nan, np.nan, np.zeros((4, 4)), np.nan)
    pivot = float(x[x.size // 2])
    z = x - pivot
    shift = _average(z, w)
    z -= shift
    largest = max(float(z.max()), -float(z.min()))
    if largest == 0.0:
        return Moments(pivot + shift, 0.0, np.nan, np.nan, np.zeros((4, 4)), 0.0)
    z /= largest  # before squaring: tiny and huge units neither vanish nor overflow
    root = _average(z * z, w) ** 0.5
    z /= root
    means = np.sum([(powers * share).sum(axis=1) for powers, share, _ in _blocks(z, w, None)], axis=0)
    covariance, noise = _variation(_influences(z, w, group, groups, means), units)
    return Moments(pivot + shift, largest * root, float(means[2]), float(means[3]), covariance, noise)


def _average(z: Floats, w: Floats | None) -> float:
    return float(z.mean()) if w is None else float(np.sum(w * z))


def _blocks(
    z: Floats, w: Floats | None, group: NDArray[np.intp] | None
) -> Iterator[tuple[Floats, Floats | float, NDArray[np.intp] | None]]:
    """Block by block: (4, b) powers of z, the share of each trial in the whole, its replicate."""
    for start in range(0, z.size, BLOCK):
        here = slice(start, start + BLOCK)
        block, square = z[here], z[here] * z[here]
        yield (
            np.stack([block, square, square * block, square * square]),
            1.0 / z.size if w is None else w[here],
            None if group is None else group[here],
        )


def _influences(
    z: Floats, w: Floats | None, group: NDArray[np.intp] | None, groups: int, means: Floats
) -> Iterator[Floats]:
    """(4, units) how far each independent unit pulls the means of z, z², z³, z⁴; trials in several blocks."""
    totals = np.zeros((4, groups))
    for powers, share, ids in _blocks(z, w, group):
        pulls = (powers - means[:, None]) * share
        if ids is None:
            yield pulls
        else:
            totals += [np.bincount(ids, weights=row, minlength=groups) for row in pulls]
    if group is not None:
        yield totals


def _variation(influences: Iterator[Floats], units: float) -> tuple[Floats, float]:
    """The covariance of the four means, and the relative error of the first one's standard error."""
    covariance, fourth, count = np.zeros((4, 4)), 0.0, 0
    for pulls in influences:
        covariance += np.einsum("iu,ju->ij", pulls, pulls)  # not a matrix product: threads must not change the last bit
        fourth += float(np.sum(pulls[0] ** 4))
        count += pulls.shape[1]
    if units <= 1.0:
        return np.zeros((4, 4)), np.nan
    square = float(covariance[0, 0])
    if square == 0.0:
        return covariance, 0.0
    # The mean's squared error is a sum of one square per unit: the spread of the squares, and, for few units, that of
    # the mean they are taken about.
    spread = (fourth / (square * square) - 1.0 / count) * units / (units - 1.0) + 2.0 / (units * (units - 1.0))
    return covariance * (units / (units - 1.0)), 0.5 * max(spread, 0.0) ** 0.5
