"""Empirical, smoothed: the data, each spread out as a normal curve.

A kernel density estimate: the mean of normal distributions around the values, all with one standard deviation, the
bandwidth. Without a bandwidth it is 0.9·min(s, IQR/1.34)·m^(-1/5).

Source: B. W. Silverman, *Density Estimation for Statistics and Data Analysis*, 1986, equation 3.31.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from xlmc.montecarlo.distributions.base import LARGEST, Array, Family, Values
from xlmc.montecarlo.distributions.custom_data import rows_of, value_pieces
from xlmc.montecarlo.distributions.parameters import DataError, DataSpec, show

__all__ = ["REACH", "EmpiricalSmoothed", "silverman"]

REACH: Final = 9.0
"""Bandwidths after which a curve is cut off: 1e-19 of it lies beyond, less than the step of the uniforms."""

_CELLS: Final = 8
_DEGREE: Final = 12
"""Cells per bandwidth, and the degree of the density's Taylor polynomial in one: the term left out is below 1e-13."""

_CHUNK: Final = 64

_MOST_CELLS: Final = 200_000

_LEAST_CELL: Final = 4.0
"""A cell is at least so many steps wide between the numbers that a computer can tell apart."""

_LEAST_BANDWIDTH: Final = 1e-300
"""Smaller ones have too few digits left."""


def silverman(values: ArrayLike) -> float:
    """Return the bandwidth by Silverman's rule; 0 where the values do not vary.

    >>> round(silverman([1, 2, 3, 4, 5]), 4)
    0.9736
    """
    data = np.asarray(values, dtype=float)
    quarter, three_quarters = np.percentile(data, [25, 75])
    spread = float(data.std(ddof=1)) if data.size > 1 else 0.0
    robust = float(three_quarters - quarter) / 1.34
    return float(0.9 * (min(spread, robust) if robust > 0 else spread) * data.size ** (-1 / 5))


class EmpiricalSmoothed(Family):
    """A kernel density estimate with Gaussian curves. It has no parameters: an instance holds its data.

    Without data it can only be `built`.

    Args:
        values: `(m,)`, two or more.
        bandwidth: the standard deviation of each curve, above 0.

    >>> smoothed = EmpiricalSmoothed([1.0, 2.0, 4.0], bandwidth=0.5)
    >>> print(smoothed.ppf(np.array([0.1, 0.5, 0.9])).round(6))
    [0.729804 2.025228 4.262205]
    >>> print(smoothed.cdf(smoothed.ppf(0.1)).round(15))
    0.1
    """

    name = "Empirical smoothed"
    aliases = ("Kernel density", "KDE")
    parameters = ()
    open_below = True
    data = DataSpec((), "measurements", options=("Bandwidth",))
    formula = "F(x) = mean of Φ((x - measurement) / Bandwidth)"
    source = "B. W. Silverman, Density Estimation for Statistics and Data Analysis, 1986, equation 3.31"

    def __init__(self, values: ArrayLike = (), bandwidth: float = 1.0) -> None:
        self.values = np.sort(np.asarray(values, dtype=float))
        self.bandwidth = float(bandwidth)

    def built(self, data: Array, **options: Any) -> EmpiricalSmoothed:
        value_pieces(rows_of(data))  # refuses what is no data
        values = data[~np.isnan(data)]
        bandwidth = float(options.get("bandwidth", silverman(values)))
        if not bandwidth > 0:
            message = "The values are all equal, so nothing says how far to smooth them"
            raise DataError(message, "Give a Bandwidth, or more measurements", 0, 0)
        if bandwidth > LARGEST:
            raise DataError(f"Bandwidth ({show(bandwidth)}) must be at most 1E150", "Correct the number", 0, 0)
        if bandwidth / _CELLS < _LEAST_CELL * float(np.spacing(np.abs(values).max())) or bandwidth < _LEAST_BANDWIDTH:
            message = f"Bandwidth ({show(bandwidth)}) is below the last digits of the values and smooths nothing"
            raise DataError(message, "Give a larger Bandwidth, or use Empirical without smoothing", 0, 0)
        if self.cells_needed(values, bandwidth) > _MOST_CELLS:
            message = "The bandwidth is very small beside the spread of so many values"
            raise DataError(message, "Give a larger Bandwidth, or use Empirical without smoothing", 0, 0)
        return EmpiricalSmoothed(values, bandwidth)

    @staticmethod
    def cells_needed(values: ArrayLike, bandwidth: float) -> float:
        """How long the table of the quantile function would be."""
        gaps = np.diff(np.sort(np.asarray(values, dtype=float))) / bandwidth
        return float(np.minimum(gaps, 2 * REACH).sum() + 2 * REACH) * _CELLS

    @cached_property
    def _edges(self) -> Array:
        """The left edges of the cells, which cover all that lies within reach of a value."""
        ends = np.flatnonzero(np.diff(self.values) > 2 * REACH * self.bandwidth)
        firsts, lasts = self.values[np.concatenate([[0], ends + 1])], self.values[np.concatenate([ends, [-1]])]
        width, reach = self.bandwidth / _CELLS, REACH * self.bandwidth
        parts = [
            first - reach + width * np.arange(np.ceil((last - first + 2 * reach) / width))
            for first, last in zip(firsts, lasts, strict=True)
        ]
        return np.concatenate(parts)

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """F at the left edge of each cell `(c,)`, and the coefficients `(degree + 2, c)` of F - F(edge) in each.

        The polynomials are in (x - middle)/bandwidth.
        """
        from scipy.special import ndtr

        edges, half = self._edges, 0.5 / _CELLS
        at_edge, series = np.empty(edges.size), np.zeros((_DEGREE + 2, edges.size))
        for start in range(0, edges.size, _CHUNK):
            here = slice(start, start + _CHUNK)
            near, before = self._near(edges[here])
            z = (edges[here, None] - near) / self.bandwidth
            at_edge[here] = (before + ndtr(z).sum(axis=1)) / self.values.size
            for power, derivative in enumerate(_normal_derivatives(z + half)):
                series[power + 1, here] = derivative / (power + 1)
        series /= self.values.size
        series[0] = -_polynomial(series, np.full(edges.size, -half))
        return at_edge, series

    def _near(self, points: Array) -> tuple[Array, int]:
        """Return the values within reach of rising points, and how many lie before these."""
        margin = (REACH + 1) * self.bandwidth
        low, high = np.searchsorted(self.values, [points[0] - margin, points[-1] + margin])
        return self.values[low:high], int(low)

    def _ppf(self, u: Array) -> Array:
        at_edge, series = self._table
        shape, asked = u.shape, u.ravel()
        cell = np.clip(np.searchsorted(at_edge, asked, side="right") - 1, 0, at_edge.size - 1)
        mine, target, half = series[:, cell], asked - at_edge[cell], 0.5 / _CELLS
        slope = mine[1:] * np.arange(1, _DEGREE + 2)[:, None]
        t = np.zeros(asked.shape)
        for _ in range(6):  # Newton: the density changes little within a cell
            steep = _polynomial(slope, t)
            step = (target - _polynomial(mine, t)) / np.where(steep > 0, steep, np.inf)
            t = np.clip(t + step, -half, half)
        x = self._edges[cell] + (t + half) * self.bandwidth
        return np.asarray(np.clip(x, *self._support()).reshape(shape))

    def _cdf(self, x: Values) -> Values:
        from scipy.special import ndtr

        asked = np.atleast_1d(np.asarray(x, dtype=float))
        values = np.empty(asked.shape)
        for index, point in np.ndenumerate(asked):
            near, before = self._near(np.array([point]))
            values[index] = (before + ndtr((point - near) / self.bandwidth).sum()) / self.values.size
        low, high = self._support()
        values = np.where(asked < low, 0.0, np.where(asked > high, 1.0, values))
        return values.reshape(np.shape(x))

    @cached_property
    def _mirror(self) -> EmpiricalSmoothed:
        return EmpiricalSmoothed(-self.values, self.bandwidth)

    def _sf(self, x: Values, *_: Values) -> Values:
        return self._mirror._cdf(-np.asarray(x))

    def _isf(self, q: Array, *_: Values) -> Array:
        return -self._mirror._ppf(q)

    def _mean(self) -> Values:
        return float(self.values.mean())

    def _variance(self) -> Values:
        return float(self.values.var() + self.bandwidth**2)

    def _support(self) -> tuple[float, float]:
        reach = REACH * self.bandwidth
        return float(self.values[0] - reach), float(self.values[-1] + reach)

    def _mirrored(self) -> tuple[Values, ...]:
        raise TypeError("its mirror image is another instance")  # _sf and _isf do without


def _normal_derivatives(z: Array) -> list[Array]:
    """Return the sums over the last axis of φ⁽ⁿ⁾(z)/n!, n from 0 to the degree: φ⁽ⁿ⁺¹⁾ = -z·φ⁽ⁿ⁾ - n·φ⁽ⁿ⁻¹⁾."""
    before, now = np.zeros_like(z), np.exp(-z * z / 2) / np.sqrt(2 * np.pi)
    sums = [now.sum(axis=-1)]
    for n in range(_DEGREE):
        before, now = now, -(z * now + before) / (n + 1)  # each divided by its own factorial
        sums.append(now.sum(axis=-1))
    return sums


def _polynomial(coefficients: Array, t: Array) -> Array:
    """Return the values of polynomials, given as rows of coefficients from the lowest power up; each column has its own
    t.
    """
    value = np.zeros(t.shape)
    for row in coefficients[::-1]:
        value = value * t + row
    return value
