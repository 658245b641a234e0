"""A family that is told by percentiles: "10 % of drivers react within 0.8 s, 90 % within 2 s"."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.distributions.base import Array, Family, Fault, ParameterSpec, Values, show
from xlmc.distributions.matching import match_percentiles

__all__ = ["ByPercentiles"]


class ByPercentiles(Family):
    """The member of a family that has some parameters as given and these percentiles; before any truncation.

    Its parameters are those given, in the family's order, then the percentiles by rising percentage. They are numbers:
    unlike other families', they cannot vary by trial.

    >>> from xlmc.distributions.normal import Normal
    >>> reaction = ByPercentiles(Normal(), (), (10.0, 90.0))
    >>> reaction.keys
    ('p10', 'p90')
    >>> print(reaction.ppf(np.array([0.1, 0.5, 0.9]), p10=0.8, p90=2.0).round(12))
    [0.8 1.4 2. ]
    >>> reaction.check(p10=2.0, p90=0.8)
    'P10 (2) is not below P90 (0.8)'
    """

    def __init__(self, family: Family, given: tuple[str, ...], percents: tuple[float, ...]) -> None:
        self.family, self.percents = family, percents
        self.name, self.aliases = family.name, family.aliases
        self._given = tuple(spec for spec in family.parameters if spec.key in given)
        headings = [f"P{show(percent)}" for percent in percents]
        self.parameters = (*self._given, *(ParameterSpec(each.lower(), (each,)) for each in headings))
        self._member = lru_cache(maxsize=64)(self._find)

    def __reduce__(self) -> tuple[Any, ...]:
        """The members that it has found are looked for again."""
        return ByPercentiles, (self.family, tuple(spec.key for spec in self._given), self.percents)

    def broken_rule(self, *values: float) -> Fault | None:
        """The first thing wrong with these numbers, if any."""
        if fault := super().broken_rule(*values):
            return fault
        places = list(zip(self.parameters, values, strict=True))[len(self._given) :]
        for (lower, below), (upper, above) in pairwise(places):
            if not below < above:
                message = f"{lower.heading} ({show(below)}) is not below {upper.heading} ({show(above)})"
                return Fault(lower.key, message, "Exchange the two, or correct the wrong one")
        if self._member(*values) is None:
            shown = ", ".join(
                f"{spec.heading} {show(value)}" for spec, value in zip(self.parameters, values, strict=True)
            )
            message = f"No single {self.name} has {shown}"
            return Fault(places[-1][0].key, message, "Correct the percentiles, or choose another distribution")
        return None

    def valid(self, *params: Values, **named: Values) -> bool | NDArray[np.bool_]:
        return self.broken_rule(*self._numbers(self.bind(params, named))) is None

    def member(self, *params: float, **named: float) -> tuple[float, ...]:
        """The family's own parameters, in its order.

        Raises:
            ValueError: no member of the family has these percentiles.
        """
        found = self._member(*self.bind(params, named))
        if found is None:
            raise ValueError(self.check(*params, **named))
        return found

    def _find(self, *values: float) -> tuple[float, ...] | None:
        given = {spec.key: float(value) for spec, value in zip(self._given, values, strict=False)}
        points = [
            (percent / 100, float(x)) for percent, x in zip(self.percents, values[len(self._given) :], strict=True)
        ]
        return match_percentiles(self.family, given, points)

    def _numbers(self, values: tuple[Any, ...]) -> tuple[float, ...]:
        """The parameters as numbers.

        Raises:
            TypeError: one of them varies by trial.
        """
        if any(np.ndim(value) for value in values):
            raise TypeError(f"{self.name} by percentiles takes numbers, not one for each trial")
        return tuple(float(value) for value in values)

    def _own(self, values: tuple[Any, ...]) -> tuple[float, ...]:
        """The family's own parameters; NaN, where no member has these percentiles."""
        return self._member(*self._numbers(values)) or (np.nan,) * len(self.family.parameters)

    def _ppf(self, u: Array, *values: Any) -> Array:
        return self.family.ppf(u, *self._own(values), out=u)

    def _isf(self, q: Array, *values: Any) -> Array:
        return self.family.isf(q, *self._own(values))

    def _cdf(self, x: Values, *values: Any) -> Values:
        return self.family.cdf(x, *self._own(values))

    def _sf(self, x: Values, *values: Any) -> Values:
        return self.family.sf(x, *self._own(values))

    def _mean(self, *values: Any) -> Values:
        return self.family.mean(*self._own(values))

    def _variance(self, *values: Any) -> Values:
        return self.family.variance(*self._own(values))

    def _support(self, *values: Any) -> tuple[Values, Values]:
        return self.family.support(*self._own(values))
