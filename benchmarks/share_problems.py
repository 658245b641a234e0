"""Forecasts that jump, bend or oscillate with one input, whose variance that input explains: for share_coverage.py.

A forecast is g(a, b) of two uniforms, and kept trials may be those of a filter. The truths are computed by the midpoint
rule, 200,000 points by 200, within steps that no jump crosses.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

__all__ = ["PROBLEMS", "Problem"]

Floats = NDArray[np.float64]


def _all(a: Floats, _b: Floats) -> NDArray[np.bool_]:
    return np.full(a.shape, True)


def _under_the_diagonal(a: Floats, b: Floats) -> NDArray[np.bool_]:
    return a + b <= 1.2


@dataclass(frozen=True)
class Problem:
    """A forecast of two uniforms, and which trials a filter keeps.

    Attributes:
        forecast: `(n,)` a and b -> `(n,)`.
        smooth: whether words should stay away, and intervals be short.
        keeps: `(n,)` a and b -> `(n,)` which are accepted.
        exact: the share of the variance that a explains, if there is a closed form.
    """

    forecast: Callable[[Floats, Floats], Floats]
    smooth: bool = False
    keeps: Callable[[Floats, Floats], NDArray[np.bool_]] = _all
    exact: float | None = None

    @cached_property
    def truth(self) -> float:
        """Var(E[y | a]) / Var(y) among the accepted."""
        return self.exact if self.exact is not None else self._integrated()

    def _integrated(self) -> float:
        a = (np.arange(200_000) + 0.5) / 200_000
        weight, first, second = np.zeros(a.size), np.zeros(a.size), np.zeros(a.size)
        for b in (np.arange(200) + 0.5) / 200:
            kept = self.keeps(a, np.full(a.size, b))
            y = np.where(kept, self.forecast(a, np.full(a.size, b)), 0.0)
            weight, first, second = weight + kept, first + y, second + y * y
        whole = weight.sum()
        known = np.divide(first, weight, out=np.zeros(a.size), where=weight > 0)
        mean = first.sum() / whole
        between = float((weight * known**2).sum() / whole - mean**2)
        return between / float(second.sum() / whole - mean**2)


def _step(q: float) -> Callable[[Floats, Floats], Floats]:
    """A jump of variance 1 and uniform noise of variance 0.25."""
    height, width = 1.0 / math.sqrt(q * (1.0 - q)), math.sqrt(3.0)
    return lambda a, b: height * (a > q) + width * b


def _linear(share: float) -> Problem:
    slope, rest = math.sqrt(share), math.sqrt(1.0 - share)
    return Problem(lambda a, b: slope * ndtri(a) + rest * ndtri(b), smooth=True, exact=share)


def _exponential(sigma: float) -> Problem:
    size = math.exp(sigma * sigma)
    return Problem(
        lambda a, b: np.exp(sigma * ndtri(a)) * (1.0 + 0.3 * ndtri(b)), exact=(size - 1.0) / (size * 1.09 - 1.0)
    )


PROBLEMS: dict[str, Problem] = {
    **{f"step at {100 * q:g} %": Problem(_step(q), exact=0.8) for q in (0.5, 0.9, 0.97, 0.99)},
    "step at 97 %, hardly any noise": Problem(
        lambda a, b: np.where(a > 0.97, 10.0, 0.0) + 0.1 * b, exact=2.91 / (2.91 + 0.01 / 12.0)
    ),
    "yes or no at 99 %": Problem(lambda a, _: (a > 0.99).astype(float), exact=1.0),
    "bend at 95 %": Problem(lambda a, b: 100.0 * np.maximum(a - 0.95, 0.0) + b),
    "ten periods of a sine": Problem(lambda a, b: np.sin(20.0 * np.pi * a) + 0.7 * ndtri(b), exact=0.5 / 0.99),
    "1/x, 0.01 to 1.01": Problem(lambda a, b: (1.0 + 0.9 * b) / (a + 0.01)),
    "exponential, σ 1": _exponential(1.0),
    "exponential, σ 1.5": _exponential(1.5),
    "step at 90 %, filtered": Problem(_step(0.9), keeps=_under_the_diagonal),
    "bend at 80 %, filtered": Problem(lambda a, b: 10.0 * np.maximum(a - 0.8, 0.0) + b, keeps=_under_the_diagonal),
    "sine, filtered": Problem(lambda a, b: np.sin(20.0 * np.pi * a) + b, keeps=_under_the_diagonal),
    **{f"straight, {share:g}": _linear(share) for share in (0.0, 0.02, 0.3, 0.9)},
    "curved": Problem(lambda a, b: np.exp(a) * (1.0 + b), smooth=True),
    "product": Problem(lambda a, b: (1.0 + a) * (1.0 + b) ** 2, smooth=True),
    "product, filtered": Problem(lambda a, b: (1.0 + a) * (1.0 + b) ** 2, smooth=True, keeps=_under_the_diagonal),
}
