"""Pairs of numbers and the line through them. Letters: n trials, k pairs of a trial.

Of two ranges, only those pairs count in which both hold numbers.
"""

from __future__ import annotations

import numpy as np

from xlmc.excel.functions.arguments import first_error
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.registry import Arrays, Number, excel
from xlmc.excel.functions.samples import mean_of, of_pairs, pairs_of, points_of, restore_shape, row_sums
from xlmc.excel.functions.values import DIV0, NA, Bools, Floats, Value

__all__: list[str] = []


def _joint(x: Floats, y: Floats, counts: Bools) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the sums of the squared distances of x and of y and of their products, and the number of pairs:
    (n,) each.
    """
    (_, dx, k), (_, dy, _) = mean_of(x, counts), mean_of(y, counts)
    return row_sums(dx * dx), row_sums(dy * dy), row_sums(dx * dy), k


def _ratio(above: Floats, below: Floats) -> Floats:
    return np.where(below > 0, above / np.where(below > 0, below, 1.0), DIV0)


@excel("CORREL", Arrays, Arrays, aliases=("PEARSON",), facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def correlation(x: Floats, y: Floats, counts: Bools) -> Floats:
    """Pearson's correlation; `#DIV/0!` where one side does not vary."""
    xx, yy, xy, _ = _joint(x, y, counts)
    return _ratio(xy, np.sqrt(xx) * np.sqrt(yy))


@excel("RSQ", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def determination(y: Floats, x: Floats, counts: Bools) -> Floats:
    """Square of Pearson's correlation; `#DIV/0!` where one side does not vary."""
    xx, yy, xy, _ = _joint(x, y, counts)
    root = np.sqrt(xx) * np.sqrt(yy)
    r = xy / np.where(root > 0, root, 1.0)
    return np.where(root > 0, r * r, DIV0)


@excel("COVARIANCE.P", Arrays, Arrays, aliases=("COVAR",), facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def population_covariance(x: Floats, y: Floats, counts: Bools) -> Floats:
    """Covariance of a whole population; `#DIV/0!` of nothing."""
    _, _, xy, k = _joint(x, y, counts)
    return _ratio(xy, k)


@excel("COVARIANCE.S", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def sample_covariance(x: Floats, y: Floats, counts: Bools) -> Floats:
    """Covariance, estimated from a sample; `#DIV/0!` of fewer than two pairs."""
    _, _, xy, k = _joint(x, y, counts)
    return _ratio(xy, k - 1)


@excel("SLOPE", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def slope(y: Floats, x: Floats, counts: Bools) -> Floats:
    """Slope of the line of least squares; `#DIV/0!` where x does not vary."""
    xx, _, xy, _ = _joint(x, y, counts)
    return _ratio(xy, xx)


def _line(y: Floats, x: Floats, counts: Bools) -> tuple[Floats, Floats, Floats, Bools]:
    """Return the means of x and y, the slope, and whether x varies: (n,) each."""
    (mean_x, dx, _), (mean_y, dy, _) = mean_of(x, counts), mean_of(y, counts)
    xx = row_sums(dx * dx)
    return mean_x, mean_y, row_sums(dx * dy) / np.where(xx > 0, xx, 1.0), xx > 0


@excel("INTERCEPT", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def intercept(y: Floats, x: Floats, counts: Bools) -> Floats:
    """Return the value of the line of least squares at x = 0; `#DIV/0!` where x does not vary."""
    mean_x, mean_y, steepness, varies = _line(y, x, counts)
    return np.where(varies, mean_y - steepness * mean_x, DIV0)


@excel("STEYX", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
@of_pairs
def standard_error(y: Floats, x: Floats, counts: Bools) -> Floats:
    """Return the standard error of y about the line; `#DIV/0!` of fewer than three pairs, or where x does not vary."""
    (_, dx, k), (_, dy, _) = mean_of(x, counts), mean_of(y, counts)
    _, _, steepness, varies = _line(y, x, counts)
    off = dy - steepness[:, None] * dx
    return np.where(varies & (k > 2), np.sqrt(row_sums(off * off) / np.maximum(k - 2, 1.0)), DIV0)


@excel("FORECAST.LINEAR", Number, Arrays, Arrays, aliases=("FORECAST",), facts=Facts(empty_cells=EmptyCells.PAIRED))
def forecast(at: Value, ys: Value, xs: Value) -> Value:
    """Return the line of least squares at a point; `#DIV/0!` where x does not vary, `#N/A` for ranges of
    unequal size.
    """
    (points,), codes, shape = points_of(at)
    pairs = pairs_of(ys, xs)
    if pairs is None:
        return restore_shape(np.full((1, 1), NA), codes[0], shape)
    y, x, counts, errors = pairs
    mean_x, mean_y, steepness, varies = (part[:, None] for part in _line(y, x, counts))
    result = np.where(varies, mean_y + steepness * (points - mean_x), DIV0)
    return restore_shape(result, first_error(codes[0], errors[:, None]), shape)
