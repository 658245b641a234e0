"""A family that is given by other numbers than its own parameters, which are searched for: percentiles, moments."""

from __future__ import annotations

from abc import abstractmethod
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.base import Array, Family, Member, Values
from xlmc.montecarlo.distributions.parameters import ParameterSpec

__all__ = ["SolvedMember"]


class SolvedMember(Family):
    """The member of a family that has some parameters as given and some other numbers; before any truncation.

    Its parameters are those given, in the family's order, then the other numbers. They are numbers: unlike other
    families', they cannot vary by trial.

    Args:
        family: whose member it is.
        given: the keys of the parameters that are given.
        others: what is given in place of the rest.
    """

    def __init__(self, family: Family, given: tuple[str, ...], others: tuple[ParameterSpec, ...]) -> None:
        self.family = family
        self.name, self.aliases = family.name, family.aliases
        self._given = tuple(spec for spec in family.parameters if spec.key in given)
        self.parameters = (*self._given, *others)
        self._member = lru_cache(maxsize=64)(self._find)

    @abstractmethod
    def _find(self, *values: float) -> tuple[float, ...] | None:
        """Return the family's own parameters; None if there is no such member."""

    def valid(self, *params: Values, **named: Values) -> bool | NDArray[np.bool_]:
        return self.broken_rule(*self._numbers(self.bind(params, named))) is None

    def member(self, *params: float, **named: float) -> tuple[float, ...]:
        """Return the family's own parameters, in its order.

        Raises:
            ValueError: no member of the family has these numbers.
        """
        result = self._member(*self.bind(params, named))
        if result is None:
            raise ValueError(self.check(*params, **named))
        return result

    def _numbers(self, values: tuple[Any, ...]) -> tuple[float, ...]:
        """Return the parameters as numbers.

        Raises:
            TypeError: one of them varies by trial.
        """
        if any(np.ndim(value) for value in values):
            raise TypeError(f"{self.name} by {self.given_by} takes numbers, not one for each trial")
        return tuple(float(value) for value in values)

    def _own(self, values: tuple[Any, ...]) -> Member:
        """Return the family with its own parameters; NaN, where no member has these numbers."""
        result = self._member(*self._numbers(values)) or (np.nan,) * len(self.family.parameters)
        return Member(self.family, result)

    def _ppf(self, u: Array, *values: Any) -> Array:
        return self._own(values).ppf(u, out=u)

    def _isf(self, q: Array, *values: Any) -> Array:
        return self._own(values).isf(q)

    def _cdf(self, x: Values, *values: Any) -> Values:
        return self._own(values).cdf(x)

    def _sf(self, x: Values, *values: Any) -> Values:
        return self._own(values).sf(x)

    def _mean(self, *values: Any) -> Values:
        return self._own(values).mean()

    def _variance(self, *values: Any) -> Values:
        return self._own(values).variance()

    def _support(self, *values: Any) -> tuple[Values, Values]:
        return self._own(values).support()
