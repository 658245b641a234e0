"""Johnson SB: a normal bent between two limits; from a hump to a bathtub."""

from __future__ import annotations

from math import comb

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.located import SHAPE_1, SHAPE_2
from xlmc.montecarlo.distributions.parameters import HIGH, LOW, Constraint, above_zero

__all__ = ["JohnsonSB", "share_moments"]

_STEP = 1 / 32
_NORMALS = np.arange(-10.0, 10.0, _STEP)
_WEIGHTS = np.exp(-(_NORMALS**2) / 2) / np.sqrt(2 * np.pi) * _STEP
_ODDS = np.arange(-40.0, 40.0, _STEP)
_ROWS = 256  # parameters at a time, so that memory stays small


class JohnsonSB(Family):
    """Johnson SB between low and high, with two shapes: the first skews, the second narrows.

    >>> johnson = JohnsonSB()
    >>> print(johnson.ppf(np.array([0.1, 0.5, 0.9]), low=10, high=20, shape_1=1, shape_2=2).round(6))
    [12.42178  13.775407 15.351359]
    >>> johnson.check(low=10, high=10, shape_1=1, shape_2=2)
    'Low (10) must be below High (10)'
    """

    name = "Johnson SB"
    parameters = (LOW, HIGH, SHAPE_1, SHAPE_2)
    rules = (
        Constraint(
            "low", lambda low, high, *_: low < high, "Low ({low}) must be below High ({high})", "Correct the wrong one"
        ),
        above_zero(parameters, "shape_2"),
    )
    open_below = True
    always_finite = True
    formula = "Shape 1 + Shape 2·ln((X − Low)/(High − X)) is standard normal"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 12, section 4.3"
    elsewhere = ("@RISK JohnsonSB(alpha1, alpha2, a, b): both shapes, low, high",)

    def _ppf(self, u: Array, low: Values, high: Values, first: Values, second: Values) -> Array:
        from scipy.special import expit, ndtri

        score = (ndtri(u) - first) / second
        # From the nearer end.
        near = np.subtract(high, low) * expit(-np.abs(score))
        return np.asarray(np.where(score < 0, low + near, high - near))

    def _cdf(self, x: Values, low: Values, high: Values, first: Values, second: Values) -> Values:
        from scipy.special import ndtr

        inside = np.clip(x, low, high)
        odds = np.log(inside - low) - np.log(high - inside)
        return np.asarray(ndtr(first + second * odds))

    def _mean(self, low: Values, high: Values, first: Values, second: Values) -> Values:
        return low + np.subtract(high, low) * share_moments(first, second)[0]

    def _variance(self, low: Values, high: Values, first: Values, second: Values) -> Values:
        return np.square(np.subtract(high, low)) * share_moments(first, second)[1]

    def _support(self, low: Values, high: Values, first: Values, second: Values) -> tuple[Values, Values]:
        nothing = 0 * np.add(first, second)
        return low + nothing + 0 * high, high + nothing + 0 * low

    def _mirrored(self, low: Values, high: Values, first: Values, second: Values) -> tuple[Values, ...]:
        return np.negative(high), np.negative(low), np.negative(first), second


def share_moments(first: Values, second: Values, orders: int = 2) -> list[Values]:
    """Mean and central moments, up to an order, of the share of the way from low to high.

    By the trapezoidal rule, which for smooth functions that die away at both ends is exact to rounding: over the normal
    where the share changes slowly with it, over the log odds where the share jumps.
    """
    first, second = np.broadcast_arrays(np.asarray(first, dtype=float), np.asarray(second, dtype=float))
    rows = np.stack([first.ravel(), second.ravel()], axis=1)
    parts = [_moments_of(rows[i : i + _ROWS, 0], rows[i : i + _ROWS, 1], orders) for i in range(0, len(rows), _ROWS)]
    return [np.concatenate([part[k] for part in parts]).reshape(first.shape) for k in range(orders)]


def _moments_of(first: Array, second: Array, orders: int) -> list[Array]:
    """Do the same for parameters `(n,)`."""
    from scipy.special import expit, ndtr

    first, second = first[:, None], second[:, None]
    shares = expit((_NORMALS - first) / np.maximum(second, 1.0))
    mean = shares @ _WEIGHTS
    gentle = [mean, *(((shares - mean[:, None]) ** k) @ _WEIGHTS for k in range(2, orders + 1))]

    # E[L^k] = k · ∫ p^(k - 1) · p' · P(log odds > y) dy, where p = expit(y) and p' = p(1 - p).
    p, beyond = expit(_ODDS), ndtr(-(first + second * _ODDS))
    raw = [beyond @ (k * p**k * (1 - p) * _STEP) for k in range(1, orders + 1)]
    jumping = [raw[0], *(_central(raw, k) for k in range(2, orders + 1))]
    steep = second[:, 0] < 1.0
    return [np.where(steep, a, b) for a, b in zip(jumping, gentle, strict=True)]


def _central(raw: list[Array], order: int) -> Array:
    """Return a central moment from those about 0, the first of which is the mean."""
    about = [np.ones_like(raw[0]), *raw]
    terms = [comb(order, k) * about[k] * (-raw[0]) ** (order - k) for k in range(order + 1)]
    return np.asarray(np.sum(terms, axis=0))
