"""Distributions as people write them in Python: `Uniform(0.6, 0.8)`."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from numbers import Real
from typing import Final, TypedDict, Unpack

from xlmc.errors import DefinitionError
from xlmc.montecarlo.distributions import family_named
from xlmc.montecarlo.sampling.draws import Draw

__all__ = [
    "Beta",
    "BetaPERT",
    "DiscreteUniform",
    "Distribution",
    "DistributionArguments",
    "Exponential",
    "Gamma",
    "Lognormal",
    "Normal",
    "Poisson",
    "Trapezoid",
    "Triangular",
    "Uniform",
    "Weibull",
    "YesNo",
]

_CUTOFFS: Final = ("lower_cutoff", "upper_cutoff")


class DistributionArguments(TypedDict, total=False):
    """What every distribution takes besides its parameters.

    Attributes:
        lower_cutoff, upper_cutoff: nothing is drawn beyond them.
        base: the value of the base case; the median, where it is left out.
        units: of the assumption.
        source: where its range comes from.
    """

    lower_cutoff: float
    upper_cutoff: float
    base: float
    units: str
    source: str


class Distribution:
    """A distribution with its parameters, and what else is known of the assumption that is drawn from it.

    Attributes:
        family: its name, as the list of distributions spells it.
        given: key of a parameter or cutoff -> number.
        base: the value of the base case; None for the one there is, or the median.
        units, source: of the assumption; empty for those there are.

    Args:
        family: its name, whatever its case.
        parameters: in the usual order.
        also: see `DistributionArguments`.

    Raises:
        DefinitionError: there is no such distribution, it is made from data, or the numbers are not one.
        TypeError: there are too few parameters, or too many.

    >>> Distribution("weibull", 0.0, 2.0, 1.5)
    Weibull(0, 2, 1.5)
    """

    def __init__(self, family: str, *parameters: float, **also: Unpack[DistributionArguments]) -> None:
        known = family_named(family)
        if known.data is not None:
            hint = "Give Triangular, Trapezoid or another distribution with parameters, or use a workbook"
            raise DefinitionError(f"{known.name} is made from data in cells", hint=hint)
        unknown = also.keys() - DistributionArguments.__annotations__.keys()
        if unknown:
            raise TypeError(f"{known.name} takes no {', '.join(sorted(unknown))}")
        self.family = known.name
        values = known.bind(parameters, {})
        given: dict[str, object] = dict(zip(known.keys, values, strict=True))
        given |= {key: value for key, value in also.items() if key in _CUTOFFS}
        self.given: Mapping[str, float] = {key: _number(known.name, key, value) for key, value in given.items()}
        base = also.get("base")
        self.base = None if base is None else _number(known.name, "base", base)
        self.units, self.source = also.get("units", ""), also.get("source", "")
        if (fault := self.draw(known.name).fault()) is not None:
            raise DefinitionError(f"{known.name}: {fault.message}", hint=fault.hint)

    def __repr__(self) -> str:
        numbers = [f"{value:.12g}" for key, value in self.given.items() if key not in _CUTOFFS]
        named = [f"{key}={self.given[key]:.12g}" for key in _CUTOFFS if key in self.given]
        named += [] if self.base is None else [f"base={self.base:.12g}"]
        named += [f"{key}={value!r}" for key, value in (("units", self.units), ("source", self.source)) if value]
        return f"{self.family}({', '.join([*numbers, *named])})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Distribution) and vars(self) == vars(other)

    def draw(self, name: str) -> Draw:
        """Return how an assumption of this name is drawn from it."""
        return Draw.of(name, family_named(self.family), self.given)


def _number(family: str, key: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, Real) or math.isnan(float(value)):
        raise DefinitionError(f"{family}: {key} is {value!r}, which is not a number", hint="Give a number")
    return float(value)


class Uniform(Distribution):
    """Every value from `low` to `high` alike."""

    def __init__(self, low: float, high: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Uniform", low, high, **also)


class Triangular(Distribution):
    """From `low` to `high`, rising and falling in straight lines around `likeliest`."""

    def __init__(self, low: float, likeliest: float, high: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Triangular", low, likeliest, high, **also)


class Trapezoid(Distribution):
    """From `low` to `high`; every value from `low_likeliest` to `high_likeliest` alike."""

    def __init__(
        self,
        low: float,
        low_likeliest: float,
        high_likeliest: float,
        high: float,
        **also: Unpack[DistributionArguments],
    ) -> None:
        super().__init__("Trapezoid", low, low_likeliest, high_likeliest, high, **also)


class BetaPERT(Distribution):
    """From `low` to `high`, smooth, with its mode at `likeliest`."""

    def __init__(self, low: float, likeliest: float, high: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("BetaPERT", low, likeliest, high, **also)


class Normal(Distribution):
    """The normal distribution."""

    def __init__(self, mean: float, std_dev: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Normal", mean, std_dev, **also)


class Lognormal(Distribution):
    """The logarithm of `x - location` is normal; `mean` and `std_dev` are those of `x` itself."""

    def __init__(
        self, mean: float, std_dev: float, location: float = 0.0, **also: Unpack[DistributionArguments]
    ) -> None:
        super().__init__("Lognormal", *_ordered("Lognormal", mean=mean, std_dev=std_dev, location=location), **also)


class Exponential(Distribution):
    """Waiting times at a rate; the mean is 1/`rate`."""

    def __init__(self, rate: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Exponential", *_ordered("Exponential", rate=rate), **also)


class Gamma(Distribution):
    """The gamma distribution from `location` up; its mean is `location + scale·shape`."""

    def __init__(
        self, scale: float, shape: float, location: float = 0.0, **also: Unpack[DistributionArguments]
    ) -> None:
        super().__init__("Gamma", *_ordered("Gamma", scale=scale, shape=shape, location=location), **also)


class Weibull(Distribution):
    """The Weibull distribution from `location` up."""

    def __init__(
        self, scale: float, shape: float, location: float = 0.0, **also: Unpack[DistributionArguments]
    ) -> None:
        super().__init__("Weibull", *_ordered("Weibull", scale=scale, shape=shape, location=location), **also)


class Beta(Distribution):
    """The beta distribution, stretched from `low` to `high`."""

    def __init__(
        self, alpha: float, beta: float, low: float = 0.0, high: float = 1.0, **also: Unpack[DistributionArguments]
    ) -> None:
        super().__init__("Beta", *_ordered("Beta", alpha=alpha, beta=beta, low=low, high=high), **also)


class Poisson(Distribution):
    """How many events happen where `rate` are expected."""

    def __init__(self, rate: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Poisson", rate, **also)


class DiscreteUniform(Distribution):
    """Every whole number from `low` to `high` alike."""

    def __init__(self, low: float, high: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Discrete Uniform", low, high, **also)


class YesNo(Distribution):
    """1 with this probability, otherwise 0."""

    def __init__(self, probability: float, **also: Unpack[DistributionArguments]) -> None:
        super().__init__("Yes-No", probability, **also)


def _ordered(family: str, **named: float) -> Iterable[float]:
    """Return parameters by key in the order of the family."""
    return family_named(family).bind((), named)
