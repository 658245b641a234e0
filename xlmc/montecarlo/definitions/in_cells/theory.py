"""@RISK's functions of a distribution itself, not of its draws: `RiskTheoMean(B2)`, `RiskTheoXtoP(B2, 5)`.

Moments come from the family's formulas where it has them, and else from its quantiles: by the trapezoidal rule over the
normal scores of probabilities, which is exact to rounding for smooth ones, or from the probability of each value.

Source: @RISK's manual, "Statistics Functions: Theoretical".
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from xlmc.errors import FormulaError
from xlmc.montecarlo.distributions.base import Array, Family, Member
from xlmc.montecarlo.distributions.compound import Compound
from xlmc.montecarlo.distributions.pieces import Pieces
from xlmc.montecarlo.distributions.quadrature import gauss_legendre
from xlmc.montecarlo.distributions.truncated import Slice
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers

__all__ = ["THEORETICAL", "Distribution", "theoretical"]

_STEP: Final = 1 / 64
_REACH: Final = 12.0
_NODES: Final = 500
_GRID: Final = 1 << 20
_LARGEST_U: Final = 1 - 2.0**-53
_MOST_VALUES: Final = 2_000_000


@dataclass(frozen=True)
class Distribution:
    """A distribution whose numbers are known: its member of a family, or a piece of one, and what is added to it."""

    whole: Member | Slice
    shift: float = 0.0

    def mean(self) -> float:
        if isinstance(self.whole, Member):
            return float(self.whole.mean()) + self.shift
        return self._expected(lambda x: x) + self.shift

    def variance(self) -> float:
        return float(self.whole.variance()) if isinstance(self.whole, Member) else self.central(2)

    def central(self, order: int) -> float:
        """Return a central moment."""
        mean = self.mean() - self.shift
        return self._expected(lambda x: (x - mean) ** order)

    def absolute(self) -> float:
        """Return the mean distance from the mean."""
        from scipy.special import ndtr, ndtri

        mean = self.mean() - self.shift
        if not self._is_smooth:
            return self._expected(lambda x: np.abs(x - mean))
        # Twice what lies below the mean, by Gauss and Legendre's rule over the normal scores up to it.
        nodes, weights = gauss_legendre(_NODES)
        last = float(ndtri(self.below(mean + self.shift)))
        z = -_REACH + (last + _REACH) * (nodes + 1) / 2
        density = np.exp(-(z**2) / 2) / math.sqrt(2 * math.pi)
        return float(weights @ ((mean - self.whole.ppf(ndtr(z))) * density)) * (last + _REACH)

    def quantile(self, p: float) -> float:
        return float(self.whole.percentile(np.array([p]))[0]) + self.shift

    def below(self, x: float) -> float:
        """P(X <= x)."""
        return float(self.whole.cdf(np.array([x - self.shift]))[0])

    def ends(self) -> tuple[float, float]:
        low, high = map(float, self.whole.support())
        if isinstance(self._family, WholeNumbers):
            low, high = float(np.ceil(low)), float(np.floor(high))
        elif (single := self._single_values) is not None:
            low, high = float(single[0][0]), float(single[0][-1])
        return low + self.shift, high + self.shift

    def _expected(self, function: Callable[[Array], Array]) -> float:
        values, weights = self._values
        with np.errstate(all="ignore"):
            return float(weights @ function(values))

    @property
    def _family(self) -> Family:
        return self.whole.family if isinstance(self.whole, Member) else self.whole.whole.family

    @cached_property
    def _single_values(self) -> tuple[Array, Array] | None:
        """The values of data that are all single ones, within the cutoffs, and the probability of each."""
        family = self._family
        if not (isinstance(family, Pieces) and family.single.all()):
            return None
        low, high = self.whole.support()
        inside = (family.low >= low) & (family.low <= high)
        return family.low[inside], family.share[inside] / family.share[inside].sum()

    @property
    def is_discrete(self) -> bool:
        """Whether it takes single values alone, of which sums are exact."""
        return isinstance(self._family, WholeNumbers) or self._single_values is not None

    @property
    def _is_smooth(self) -> bool:
        return (
            isinstance(self.whole, Member)
            and self.whole.family.data is None
            and not isinstance(self.whole.family, WholeNumbers)
        )

    @cached_property
    def _values(self) -> tuple[Array, Array]:
        """Values that stand for the distribution before its shift, and the probability of each: up to 2²⁰ quantiles."""
        from scipy.special import ndtr

        if (single := self._single_values) is not None:
            return single
        if isinstance(self._family, WholeNumbers):
            low = self.whole.ppf(1e-18)
            high = self.whole.isf(1e-18) if isinstance(self.whole, Member) else self.whole.ppf(_LARGEST_U)
            if high - low < _MOST_VALUES:
                k = np.arange(float(low), float(high) + 1)
                below = np.append(self.whole.cdf(k[0] - 1), self.whole.cdf(k))
                return k, np.asarray(np.diff(below), dtype=float)
        if not self._is_smooth:
            u = (np.arange(_GRID) + 0.5) / _GRID
            return self.whole.ppf(u), np.full(_GRID, 1 / _GRID)
        assert isinstance(self.whole, Member)
        z = np.arange(-_REACH, _REACH, _STEP)
        tail = ndtr(-np.abs(z))
        x = np.where(z < 0, self.whole.ppf(tail), self.whole.isf(tail))
        return x, np.exp(-(z**2) / 2) * (_STEP / math.sqrt(2 * math.pi))


_Function = Callable[[Distribution, float], float]


def _moment(value: float) -> float:
    if not math.isfinite(value):
        raise FormulaError("this number of the distribution is infinite, or there is none", hint="use percentiles")
    return value


def _standardised(of: Distribution, order: int) -> float:
    return float(_moment(of.central(order)) / _moment(of.variance()) ** (order / 2))


def _share(of: Distribution, p: float) -> float:
    if not 0 <= p <= 1:
        raise FormulaError("a probability must be from 0 to 1", hint="write a share, such as 0.9 or 90%")
    return _moment(of.ends()[int(p)] if p in (0, 1) else of.quantile(p))


THEORETICAL: Final[dict[str, tuple[int, _Function]]] = {
    "RiskTheoMean": (0, lambda of, _: _moment(of.mean())),
    "RiskTheoStdDev": (0, lambda of, _: math.sqrt(_moment(of.variance()))),
    "RiskTheoVariance": (0, lambda of, _: _moment(of.variance())),
    "RiskTheoSkewness": (0, lambda of, _: _standardised(of, 3)),
    "RiskTheoKurtosis": (0, lambda of, _: _standardised(of, 4)),
    "RiskTheoMeanAbsDev": (0, lambda of, _: _moment(of.absolute())),
    "RiskTheoCoeffOfVariation": (0, lambda of, _: math.sqrt(_moment(of.variance())) / of.mean()),
    "RiskTheoMin": (0, lambda of, _: _moment(of.ends()[0])),
    "RiskTheoMax": (0, lambda of, _: _moment(of.ends()[1])),
    "RiskTheoRange": (0, lambda of, _: _moment(of.ends()[1] - of.ends()[0])),
    "RiskTheoPercentile": (1, _share),
    "RiskTheoPtoX": (1, _share),
    "RiskTheoPercentileD": (1, lambda of, p: _share(of, 1 - p)),
    "RiskTheoPtoXD": (1, lambda of, p: _share(of, 1 - p)),
    "RiskTheoQtoX": (1, lambda of, p: _share(of, 1 - p)),
    "RiskTheoTarget": (1, lambda of, x: of.below(x)),
    "RiskTheoXtoP": (1, lambda of, x: of.below(x)),
    "RiskTheoTargetD": (1, lambda of, x: 1 - of.below(x)),
    "RiskTheoXtoPD": (1, lambda of, x: 1 - of.below(x)),
    "RiskTheoXtoQ": (1, lambda of, x: 1 - of.below(x)),
}
"""Function -> how many numbers it takes behind the distribution, and what it is."""


def theoretical(function: str, of: Distribution, number: float) -> float:
    """Return what a function of `THEORETICAL` is.

    Raises:
        FormulaError: there is no such number.
    """
    known = ("RiskTheoMean", "RiskTheoStdDev", "RiskTheoVariance", "RiskTheoCoeffOfVariation")
    if isinstance(of.whole, Member) and isinstance(of.whole.family, Compound) and function not in known:
        raise FormulaError(f"{function} of RiskCompound has no formula", hint="show a result of the run instead")
    try:
        return THEORETICAL[function][1](of, number)
    except FormulaError as error:
        raise FormulaError(f"{function}: {error.message}", hint=error.hint) from None
