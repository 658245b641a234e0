"""A family that is given by its mean and its standard deviation, or its coefficient of variation.

Most families are moved, stretched and bent: x = location + scale · z(shape). Given the shape, two moments fix location
and scale; given the location, their ratio is one equation in the shape. The beta distribution on given ends, the
uniform one and the inverse Gaussian have formulas of their own.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any, Final

import numpy as np

from xlmc.montecarlo.distributions.base import Family, Member, Values
from xlmc.montecarlo.distributions.parameters import MEAN, STD_DEV, Fault, ParameterSpec, show
from xlmc.montecarlo.distributions.solved_member import SolvedMember

__all__ = ["COV", "COV_SHARE", "ByMoments", "by_moments"]

COV: Final = ParameterSpec("cov", ("CoV %", "Coefficient of variation %", "CV %"))
"""The standard deviation in percent of the mean."""

COV_SHARE: Final = ParameterSpec("cov_share", ("CoV", "Coefficient of variation", "CV"))
"""The standard deviation as a share of the mean."""

_OF_MEAN: Final = {COV.key: 0.01, COV_SHARE.key: 1.0}

_NUMBERS: Final = 2
"""How many parameters a mean and a spread stand for."""

_MET: Final = 1e-8
"""Relative difference from the moments that were asked for, up to which they are met."""

_LOG_SHAPES: Final = np.linspace(math.log(1e-2), math.log(1e5), 500)


def by_moments(family: Family, given: Collection[str], spread: ParameterSpec) -> ByMoments:
    """Return the family with Mean and a spread instead of the parameters that are not given.

    Args:
        family: of two or three parameters that its moments determine.
        given: the keys of its own parameters that are given, the mean among them where it is one.
        spread: `STD_DEV`, `COV` or `COV_SHARE`.

    Raises:
        ValueError: mean and spread do not determine what is left.
    """
    own = tuple(key for key in family.keys if key in given and key != MEAN.key)
    left = [spec for spec in family.parameters if spec.key not in own]
    defaults = [spec.key for spec in left if spec.default is not None]
    if len(left) == _NUMBERS + len(defaults):
        own = tuple(key for key in family.keys if key in (*own, *defaults))
        left = [spec for spec in left if spec.key not in defaults]
    if len(left) != _NUMBERS or not _is_determined(family, own):
        names = ", ".join(spec.heading for spec in left) or "no parameter"
        raise ValueError(f"Mean and {spread.heading} do not determine {names} of {family.name}")
    return ByMoments(family, own, spread)


def _is_determined(family: Family, own: Collection[str]) -> bool:
    """Return whether mean and standard deviation determine the parameters that are not its own."""
    if family.name in ("Uniform", "Beta"):
        return {*own} == ({"low", "high"} if family.name == "Beta" else set())
    if MEAN.key in family.keys:
        return len(family.roles) > 0
    return len(family.roles) > 0 and "ordered" not in family.roles


class ByMoments(SolvedMember):
    """The member of a family that has some parameters as given, and this mean and spread; before any truncation.

    >>> from xlmc.montecarlo.distributions.logistic import Logistic
    >>> load = by_moments(Logistic(), (), COV)
    >>> load.keys
    ('mean', 'cov')
    >>> print(load.mean(mean=50.0, cov=10.0), load.variance(mean=50.0, cov=10.0).round(9))
    50.0 25.0
    >>> load.check(mean=50.0, cov=-1.0)
    'CoV % (-1) must be above 0'
    """

    given_by = "moments"

    def __init__(self, family: Family, given: tuple[str, ...], spread: ParameterSpec) -> None:
        self.spread = spread
        super().__init__(family, given, (MEAN, spread))

    def __reduce__(self) -> tuple[Any, ...]:
        """Look again for the members that it has found."""
        return ByMoments, (self.family, tuple(spec.key for spec in self._given), self.spread)

    def broken_rule(self, *values: float) -> Fault | None:
        """Return the first thing wrong with these numbers, if any."""
        if fault := super().broken_rule(*values):
            return fault
        mean, spread = values[-2:]
        if not spread > 0:
            return Fault(
                self.spread.key, f"{self.spread.heading} ({show(spread)}) must be above 0", "Give a positive number"
            )
        if self.spread.key in _OF_MEAN and mean == 0:
            message = "Mean is 0, of which no percentage is a standard deviation"
            return Fault(self.spread.key, message, "Give Std dev instead")
        if self._member(*values) is None:
            shown = ", ".join(
                f"{spec.heading} {show(value)}" for spec, value in zip(self.parameters, values, strict=True)
            )
            message = f"No {self.name} has {shown}"
            return Fault(self.spread.key, message, "Correct the numbers, or choose another distribution")
        return None

    def _find(self, *values: float) -> tuple[float, ...] | None:
        given = {spec.key: float(value) for spec, value in zip(self._given, values, strict=False)}
        mean, spread = values[-2:]
        deviation = abs(mean) * spread * _OF_MEAN[self.spread.key] if self.spread.key in _OF_MEAN else spread
        with np.errstate(all="ignore"):
            result = _parameters(self.family, given, mean, deviation)
            if result is None or self.family.broken_rule(*result) is not None:
                return None
            member = Member(self.family, result)
            away = abs(float(member.mean()) - mean) / max(abs(mean), deviation)
            apart = abs(math.sqrt(max(float(member.variance()), 0.0)) - deviation) / deviation
        return result if away <= _MET and apart <= _MET else None


def _parameters(family: Family, given: dict[str, float], mean: float, deviation: float) -> tuple[float, ...] | None:
    """Return the parameters of the member, in the family's order; None if there is none."""
    if family.name == "Uniform":
        return mean - math.sqrt(3) * deviation, mean + math.sqrt(3) * deviation
    if family.name == "Beta":
        return _beta(given["low"], given["high"], mean, deviation)
    if {MEAN.key, STD_DEV.key} <= {*family.keys}:
        own = {**given, MEAN.key: mean, STD_DEV.key: deviation}
        return tuple(own[key] for key in family.keys)
    if family.name == "Inverse Gaussian":
        return given["location"], mean, (mean - given["location"]) ** 3 / deviation**2
    known = {role: given.get(key) for role, key in zip(family.roles, family.keys, strict=True)}
    location, shape = known.get("location", 0.0), known.get("shape", math.nan)
    if shape is None:
        shape = None if location is None else _shape(family, (mean - location) / deviation)
        if shape is None:
            return None
    one, width = (float(each) for each in _standard(family, shape))
    scale = (mean - location) / one if location is not None else deviation / width
    location = mean - scale * one if location is None else location
    return _placed(family, location, scale, shape) if scale > 0 else None


def _beta(low: float, high: float, mean: float, deviation: float) -> tuple[float, ...] | None:
    if not low < mean < high:
        return None
    middle, variance = (mean - low) / (high - low), (deviation / (high - low)) ** 2
    both = middle * (1 - middle) / variance - 1
    return (low, high, middle * both, (1 - middle) * both) if both > 0 else None


def _shape(family: Family, ratio: float) -> float | None:
    """Return the shape nearest to 1 whose mean, from the location, is this multiple of the standard deviation."""
    from scipy.optimize import brentq

    def misfit(log: Any) -> Any:
        one, width = _standard(family, np.exp(log))
        return one / width - ratio

    values = misfit(_LOG_SHAPES)
    ends = np.flatnonzero(np.isfinite(values[:-1]) & np.isfinite(values[1:]) & (values[:-1] * values[1:] <= 0))
    roots = [
        brentq(lambda log: float(misfit(np.array(log))), _LOG_SHAPES[at], _LOG_SHAPES[at + 1], xtol=1e-15, rtol=1e-14)
        for at in ends
    ]
    return math.exp(min(roots, key=abs)) if roots else None


def _standard(family: Family, shape: Values) -> tuple[Any, Any]:
    """Return mean and standard deviation at location 0 and scale 1."""
    parameters = _placed(family, 0.0, 1.0, shape)
    return family.mean(*parameters), np.sqrt(family.variance(*parameters))


def _placed(family: Family, location: Any, scale: Any, shape: Any) -> tuple[Any, ...]:
    values = {"location": location, "scale": scale, "log scale": np.log(scale), "shape": shape, "rate": 1 / scale}
    return tuple(float(values[role]) if np.ndim(values[role]) == 0 else values[role] for role in family.roles)
