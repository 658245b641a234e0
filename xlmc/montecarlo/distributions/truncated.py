"""Truncation: a family between two cutoffs, renormalised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from xlmc.montecarlo.distributions.base import SMALLEST_U, TRIED_U, Array, Family, Member, Values
from xlmc.montecarlo.distributions.parameters import Fault, show

__all__ = ["Slice", "Truncated"]

_LARGEST_U = 1 - 2.0**-53
_LEAST_MASS = 1e-300  # below this, probabilities lose digits to underflow


@dataclass(frozen=True, slots=True)
class Truncated:
    """A family held between a lower and an upper cutoff; an absent cutoff is minus or plus infinity.

    Probabilities are counted from above where the interval lies in the upper half, so that far tails keep their digits.
    Shapes as in `Family`: cutoffs, too, may vary by trial; trials with nothing between them give NaN.

    >>> from xlmc.montecarlo.distributions.normal import Normal
    >>> tail = Truncated(Normal())
    >>> print(tail.ppf(np.array([0.1, 0.5, 0.9]), 8.0, 9.0, mean=0, std_dev=1).round(6))
    [8.012961 8.084889 8.278609]
    >>> tail.check(9.0, 8.0, mean=0, std_dev=1)
    'Lower cutoff (9) is not below Upper cutoff (8)'
    """

    family: Family

    def fault(self, lower: float, upper: float, *params: float, **named: float) -> Fault | None:
        """Return the first rule that these numbers break, if any; the keys add `lower_cutoff` and `upper_cutoff`."""
        values = self.family.bind(params, named)
        if fault := self.family.broken_rule(*values):
            return fault
        if not self.family.truncates:
            key = "upper_cutoff" if np.isinf(lower) else "lower_cutoff"
            return Fault(key, f"{self.family.name} cannot be cut off", "Let a formula limit the draws: MIN, MAX or IF")
        for key, label, cutoff in (("lower_cutoff", "Lower", lower), ("upper_cutoff", "Upper", upper)):
            if np.isnan(cutoff):
                return Fault(key, f"{label} cutoff must be a number", "Correct the number, or leave the cell blank")
        if not lower < upper:
            message = f"Lower cutoff ({show(lower)}) is not below Upper cutoff ({show(upper)})"
            return Fault("lower_cutoff", message, "Exchange the two, or correct the wrong one")
        part = Slice(Member(self.family, values), lower, upper)
        if not part.mass >= _LEAST_MASS:
            return self._empty(lower, upper, *values)
        if self.family.always_finite or not values:
            return None
        if np.isfinite(part.ppf(np.array(TRIED_U))).all():
            return None
        return self.family.overflow_fault(values, "Correct the number, or give cutoffs at both ends")

    def check(self, lower: float, upper: float, *params: float, **named: float) -> str | None:
        """Say what is wrong with these numbers, in words; None when nothing is."""
        fault = self.fault(lower, upper, *params, **named)
        return None if fault is None else fault.message

    def checked(self, lower: Values, upper: Values, *params: Values, **named: Values) -> Slice:
        """Make the distribution between the cutoffs; parameters are checked here, and by none of its functions."""
        return Slice(self.family.checked(*params, **named), lower, upper)

    def ppf(
        self, u: Values, lower: Values, upper: Values, *params: Values, out: Array | None = None, **named: Values
    ) -> Array:
        """Quantiles of probabilities in [0, 1), shapes as in `Family.ppf`; NaN where the draw would not be finite."""
        return self.checked(lower, upper, *params, **named).ppf(u, out)

    def cdf(self, x: Values, lower: Values, upper: Values, *params: Values, **named: Values) -> Array:
        """P(X <= x), shapes as in `ppf`."""
        return self.checked(lower, upper, *params, **named).cdf(x)

    def support(self, lower: Values, upper: Values, *params: Values, **named: Values) -> tuple[Array, Array]:
        """Return the lowest and the highest possible value."""
        return self.checked(lower, upper, *params, **named).support()

    def _empty(self, lower: float, upper: float, *values: float) -> Fault:
        low, high = Member(self.family, values).support()
        key, label, cutoff = "lower_cutoff", "Lower", lower
        if np.isinf(lower) or upper < low:
            key, label, cutoff = "upper_cutoff", "Upper", upper
        message = f"{label} cutoff ({show(cutoff)}) leaves nothing of the distribution"
        reach = f"from {show(float(low))} to {show(float(high))}" if np.isfinite(high - low) else "around its mean"
        return Fault(key, message, f"Choose cutoffs that leave part of the distribution, which lies {reach}")


class Slice:
    """The piece of a distribution between two cutoffs, measured from the nearer end.

    Args:
        whole: the distribution.
        lower, upper: cutoffs, each a number or `(n,)`.
    """

    def __init__(self, whole: Member, lower: Values, upper: Values) -> None:
        self._whole, self._lower, self._upper = whole, lower, upper
        (self._lowest, self._before), (self._highest, after) = whole.family.cutoffs(lower, upper)
        self._below = whole.cdf(self._before), whole.cdf(self._highest)
        self._above = whole.sf(self._lowest), whole.sf(after)
        self._in_upper_half = self._below[0] > 0.5
        from_below = self._below[1] - self._below[0]
        from_above = self._above[0] - self._above[1]
        self.mass = np.where(self._in_upper_half, from_above, from_below)
        self._sound = (self.mass >= _LEAST_MASS) & np.less(lower, upper)  # False where anything is NaN

    @property
    def whole(self) -> Member:
        """The distribution that it is a piece of."""
        return self._whole

    def ppf(self, u: Values, out: Array | None = None) -> Array:
        """See `Truncated.ppf`."""
        x = np.clip(self._quantile(np.where(np.equal(u, 0.0), SMALLEST_U, u)), self._lowest, self._highest)
        x = np.where(self._sound & np.isfinite(x), x, np.nan)
        if out is None:
            return np.asarray(x, dtype=float)
        out[...] = x
        return out

    def order(self, u: Values) -> Array:
        """See `Family.order`."""
        return self.ppf(u)

    def percentile(self, p: Values) -> Array:
        """See `Family.percentile`."""
        return self.ppf(p)

    def cdf(self, x: Values) -> Array:
        """P(X <= x), shapes as in `ppf`."""
        return np.where(self._sound, self._probability(x), np.nan)

    def support(self) -> tuple[Array, Array]:
        """See `Truncated.support`."""
        low, high = self._whole.support()
        return np.maximum(low, self._lower), np.minimum(high, self._upper)

    def _quantile(self, u: Array) -> Array:
        if np.all(self._in_upper_half):
            return self._from_above(u)
        if not np.any(self._in_upper_half):
            return self._from_below(u)
        return np.where(self._in_upper_half, self._from_above(u), self._from_below(u))

    def _probability(self, x: Values) -> Array:
        x = np.clip(x, self._before, self._highest)
        _, (_, beyond) = self._whole.family.cutoffs(x, x)
        mass = np.where(self.mass > 0, self.mass, 1.0)
        from_below = (self._whole.cdf(x) - self._below[0]) / mass
        from_above = (self._above[0] - self._whole.sf(beyond)) / mass
        return np.where(self._in_upper_half, from_above, from_below)

    def _from_below(self, u: Array) -> Array:
        low, high = self._below
        # Rounding may reach 1, whose quantile can be infinite.
        return self._whole.ppf(np.minimum(low + u * (high - low), _LARGEST_U))

    def _from_above(self, u: Array) -> Array:
        low, high = self._above
        # A weighted sum, not a difference: it stays above 0 as long as u < 1.
        return self._whole.isf(low * (1 - u) + high * u)
