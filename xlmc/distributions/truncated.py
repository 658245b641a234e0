"""Truncation: a family between two cutoffs, renormalised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from xlmc.distributions.base import SMALLEST_U, TRIED_U, Array, Family, Values
from xlmc.distributions.parameters import Fault, show

__all__ = ["Truncated"]

_LARGEST_U = 1 - 2.0**-53
_LEAST_MASS = 1e-300  # below this, probabilities lose digits to underflow


@dataclass(frozen=True, slots=True)
class Truncated:
    """A family held between a lower and an upper cutoff; an absent cutoff is minus or plus infinity.

    Probabilities are counted from above where the interval lies in the upper half, so that far tails keep their digits.
    Shapes as in `Family`: cutoffs, too, may vary by trial; trials with nothing between them give NaN.

    >>> from xlmc.distributions.normal import Normal
    >>> tail = Truncated(Normal())
    >>> print(tail.ppf(np.array([0.1, 0.5, 0.9]), 8.0, 9.0, mean=0, std_dev=1).round(6))
    [8.012961 8.084889 8.278609]
    >>> tail.check(9.0, 8.0, mean=0, std_dev=1)
    'Lower cutoff (9) is not below Upper cutoff (8)'
    """

    family: Family

    def fault(self, lower: float, upper: float, *params: float, **named: float) -> Fault | None:
        """The first rule that these numbers break, if any; the keys add `lower_cutoff` and `upper_cutoff`."""
        values = self.family.bind(params, named)
        if fault := self.family.broken_rule(*values):
            return fault
        for key, label, cutoff in (("lower_cutoff", "Lower", lower), ("upper_cutoff", "Upper", upper)):
            if np.isnan(cutoff):
                return Fault(key, f"{label} cutoff must be a number", "Correct the number, or leave the cell blank")
        if not lower < upper:
            message = f"Lower cutoff ({show(lower)}) is not below Upper cutoff ({show(upper)})"
            return Fault("lower_cutoff", message, "Exchange the two, or correct the wrong one")
        if not _Slice(self.family, lower, upper, values).mass >= _LEAST_MASS:
            return self._empty(lower, upper, *values)
        if self.family.always_finite or not values:
            return None
        if np.isfinite(self.ppf(np.array(TRIED_U), lower, upper, *values)).all():
            return None
        return self.family.overflow_fault(values, "Correct the number, or give cutoffs at both ends")

    def check(self, lower: float, upper: float, *params: float, **named: float) -> str | None:
        """What is wrong with these numbers, in words; None when nothing is."""
        fault = self.fault(lower, upper, *params, **named)
        return None if fault is None else fault.message

    def ppf(
        self, u: Values, lower: Values, upper: Values, *params: Values, out: Array | None = None, **named: Values
    ) -> Array:
        """Quantiles of probabilities in [0, 1), shapes as in `Family.ppf`; NaN where the draw would not be finite."""
        values = self.family.bind(params, named)
        part = _Slice(self.family, lower, upper, values)
        x = np.clip(part.quantile(np.where(np.equal(u, 0.0), SMALLEST_U, u)), part.lowest, part.highest)
        x = np.where(_sound(part, lower, upper) & np.isfinite(x), x, np.nan)
        if out is None:
            return np.asarray(x, dtype=float)
        out[...] = x
        return out

    def cdf(self, x: Values, lower: Values, upper: Values, *params: Values, **named: Values) -> Array:
        """P(X <= x), shapes as in `ppf`."""
        values = self.family.bind(params, named)
        part = _Slice(self.family, lower, upper, values)
        sound = _sound(part, lower, upper)
        return np.where(sound, part.probability(x), np.nan)

    def support(self, lower: Values, upper: Values, *params: Values, **named: Values) -> tuple[Array, Array]:
        """The lowest and the highest possible value."""
        low, high = self.family.support(*params, **named)
        return np.maximum(low, lower), np.minimum(high, upper)

    def _empty(self, lower: float, upper: float, *values: float) -> Fault:
        low, high = self.family.support(*values)
        key, label, cutoff = "lower_cutoff", "Lower", lower
        if np.isinf(lower) or upper < low:
            key, label, cutoff = "upper_cutoff", "Upper", upper
        message = f"{label} cutoff ({show(cutoff)}) leaves nothing of the distribution"
        reach = f"from {show(float(low))} to {show(float(high))}" if np.isfinite(high - low) else "around its mean"
        return Fault(key, message, f"Choose cutoffs that leave part of the distribution, which lies {reach}")


class _Slice:
    """The piece of a family between two cutoffs, measured from the nearer end."""

    def __init__(self, family: Family, lower: Values, upper: Values, params: tuple[Any, ...]) -> None:
        self.family = family
        self.params = params
        (self.lowest, self.before), (self.highest, after) = family.cutoffs(lower, upper)
        self.below = family.cdf(self.before, *params), family.cdf(self.highest, *params)
        self.above = family.sf(self.lowest, *params), family.sf(after, *params)
        self.in_upper_half = self.below[0] > 0.5
        from_below = self.below[1] - self.below[0]
        from_above = self.above[0] - self.above[1]
        self.mass = np.where(self.in_upper_half, from_above, from_below)

    def quantile(self, u: Array) -> Array:
        if np.all(self.in_upper_half):
            return self._from_above(u)
        if not np.any(self.in_upper_half):
            return self._from_below(u)
        return np.where(self.in_upper_half, self._from_above(u), self._from_below(u))

    def probability(self, x: Values) -> Array:
        """P(X <= x)."""
        x = np.clip(x, self.before, self.highest)
        _, (_, beyond) = self.family.cutoffs(x, x)
        mass = np.where(self.mass > 0, self.mass, 1.0)
        from_below = (self.family.cdf(x, *self.params) - self.below[0]) / mass
        from_above = (self.above[0] - self.family.sf(beyond, *self.params)) / mass
        return np.where(self.in_upper_half, from_above, from_below)

    def _from_below(self, u: Array) -> Array:
        low, high = self.below
        # Rounding may reach 1, whose quantile can be infinite.
        return self.family.ppf(np.minimum(low + u * (high - low), _LARGEST_U), *self.params)

    def _from_above(self, u: Array) -> Array:
        low, high = self.above
        # A weighted sum, not a difference: it stays above 0 as long as u < 1.
        return self.family.isf(low * (1 - u) + high * u, *self.params)


def _sound(part: _Slice, lower: Values, upper: Values) -> Any:
    """Where the cutoffs leave something; False where anything is NaN."""
    return (part.mass >= _LEAST_MASS) & np.less(lower, upper)
