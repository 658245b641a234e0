"""What difference still counts as none, and whether a difference is smaller."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.units import factor_between
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.number_text import number_text
from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "Judgement",
    "Tolerances",
    "Verdict",
    "chance_of",
    "chance_tolerance",
    "in_tolerances",
    "judge",
    "read_tolerances",
]

_CERTAINTY: Final = 3.0
"""Errors by which a difference must be below or above the tolerance: by chance it is on the wrong side once in 740."""

_SHARE_OF_SD: Final = 0.1
"""The tolerance where none is stated, as a share of a forecast's standard deviation."""

_SHARE_OF_CHANCE: Final = 0.1
_LEAST_OF_CHANCE: Final = 0.001
"""The tolerance of P(> threshold) where none is stated, as a share of it or of its complement, and the least one."""

_AT_THE_TOLERANCE: Final = 0.05
"""A share of the tolerance: a difference known to be this near to it is as large as the tolerance, and stays undecided.
"""


class Verdict(Enum):
    """What trials say of a difference."""

    WITHIN = "within"
    BEYOND = "beyond"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class Judgement:
    """A verdict.

    Attributes:
        largest: of the numbers that make the verdict, the one that is farthest off, measured in its tolerance.
        times: about how many times as many trials would decide, at most 9, because the difference itself is only known
            roughly; 1 where they have decided, infinite where the difference is as large as the tolerance.
        blind: whether too few trials are there to know the error of a number that makes the verdict.
    """

    verdict: Verdict
    largest: str
    times: float = 1.0
    blind: bool = False


def judge(differences: Mapping[str, tuple[Estimate, float]]) -> Judgement:
    """Whether all differences, each with its tolerance, are within, or one is beyond.

    Within: |d| + 3 errors ≤ tolerance for all. Beyond: |d| − 3 errors > tolerance for one. Else undecided. An error
    falls with the root of the trials.

    >>> judge({"mean": (Estimate(0.2, 0.01), 0.5)}).verdict
    <Verdict.WITHIN: 'within'>
    """
    single = {name: _judge(*each) for name, each in differences.items()}
    for verdict in (Verdict.BEYOND, Verdict.UNDECIDED, Verdict.WITHIN):
        names = [name for name, (result, _) in single.items() if result is verdict]
        if names:
            largest = max(names, key=lambda name: in_tolerances(*differences[name]))
            blind = any(_is_blind(differences[name][0]) for name in names)
            return Judgement(verdict, largest, max(single[name][1] for name in names), blind)
    raise ValueError("there is no difference to judge")


def _judge(difference: Estimate, tolerance: float) -> tuple[Verdict, float]:
    if _is_blind(difference):
        return Verdict.UNDECIDED, math.inf
    assert difference.error is not None
    size, margin = abs(difference.value), _CERTAINTY * difference.error
    if size + margin <= tolerance:
        return Verdict.WITHIN, 1.0
    if size - margin > tolerance:
        return Verdict.BEYOND, 1.0
    if margin < _AT_THE_TOLERANCE * tolerance:
        return Verdict.UNDECIDED, math.inf
    # How near it is to the tolerance is known to an error only: nearer than that may be chance.
    return Verdict.UNDECIDED, (margin / max(abs(tolerance - size), difference.error)) ** 2


def _is_blind(difference: Estimate) -> bool:
    return math.isnan(difference.value) or difference.error is None


def in_tolerances(difference: Estimate, tolerance: float) -> float:
    """Return the size of a difference, measured in its tolerance."""
    size = abs(difference.value)
    if math.isnan(size):
        return math.inf
    return size / tolerance if tolerance else math.inf if size else 0.0


def chance_tolerance(share: float) -> float:
    """Return the tolerance of a probability for which none is stated.

    >>> chance_tolerance(0.7), chance_tolerance(0.002)
    (0.03, 0.001)
    """
    return max(_LEAST_OF_CHANCE, round(_SHARE_OF_CHANCE * min(share, 1.0 - share), 12))


def chance_of(points: float | None) -> float | None:
    """Return a tolerance stated in percentage points as a share; None if none is.

    Raises:
        SimulationError: it is out of its range.
    """
    if points is None:
        return None
    if not 0.0 < points < 100.0:
        message = f"the tolerance of P(> threshold) is {number_text(points)} percentage points"
        raise SimulationError(message, hint="give a number above 0 and below 100, such as 1")
    return points / 100.0


@dataclass(frozen=True, slots=True)
class _Stated:
    """One tolerance as it was asked for: `value` in `unit`, `%` of the SD, or the forecast's own unit where blank."""

    text: str
    value: float
    unit: str

    def of(self, forecast: Forecast, deviation: float) -> float | None:
        """Return the tolerance in the forecast's unit; None if the units are of different kinds."""
        if self.unit == "%":
            return self.value / 100.0 * deviation
        factor = 1.0 if not self.unit else factor_between(self.unit, forecast.units)
        return None if factor is None else self.value * factor


@dataclass(frozen=True)
class Tolerances:
    """The tolerances as stated: for all forecasts, and for single ones by key."""

    general: Sequence[_Stated]
    single: Mapping[str, _Stated]

    def of(self, forecast: Forecast, deviation: float) -> tuple[float, bool]:
        """Return a forecast's tolerance in its unit, and whether it was stated; else it is a tenth of its SD.

        Raises:
            SimulationError: the tolerance stated for it is in a unit of another kind.
        """
        if (stated := self.single.get(name_key(forecast.name))) is not None:
            result = stated.of(forecast, deviation)
            if result is None:
                message = (
                    f"the tolerance {stated.text!r} is in {stated.unit}, the forecast in {forecast.units or 'no unit'}"
                )
                raise SimulationError(message, where=forecast.cell, hint="state it in the forecast's own unit")
            return result, True
        result = next((value for each in self.general if (value := each.of(forecast, deviation)) is not None), None)
        return (_SHARE_OF_SD * deviation, False) if result is None else (result, True)

    def of_share(self, forecast: Forecast, deviation: float, chance: float | None) -> tuple[float, bool]:
        """Return the tolerance of the shares of a forecast whose answers are counted, and whether it was stated.

        It is that of its name; else `chance`, if one is stated, or that share of its standard deviation which all
        forecasts have. Otherwise nan: see `chance_tolerance`.

        Raises:
            SimulationError: the tolerance stated for it is in a unit.
        """
        if name_key(forecast.name) in self.single:
            return self.of(forecast, deviation)
        shares = [each.value / 100.0 * deviation for each in self.general if each.unit == "%"]
        return (shares[0], True) if shares and chance is None else (math.nan, False)

    def refuse_for_shares(self, forecasts: Sequence[Forecast]) -> None:
        """Refuse a number that is stated for all forecasts where the answers of all are counted.

        Raises:
            SimulationError: one is stated.
        """
        for each in self.general:
            if each.unit != "%":
                message = f"the tolerance {each.text!r} holds for no forecast: all answers are yes or no, or texts"
                hint = f"state percentage points (--chance 2, chance=2), or '{forecasts[0].name}=0.02'"
                raise SimulationError(message, hint=hint)


_NUMBER_AND_UNIT = re.compile(r"\s*(?P<number>[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(?P<unit>[^\d\s].*?)?\s*")


def read_tolerances(texts: Iterable[str], forecasts: Sequence[Forecast]) -> Tolerances:
    """Read `0.5`, `0.5 mph`, `10 %` (of the SD) and `Name=0.5 mph`.

    Raises:
        SimulationError: a text is none of these, no forecast has its name or unit, or one is stated twice.
    """
    general: list[_Stated] = []
    single: dict[str, _Stated] = {}
    for text in texts:
        name, equals, amount = text.rpartition("=")
        stated = _read_stated(text, amount)
        if not equals:
            _refuse_idle(stated, general, forecasts)
            general.append(stated)
            continue
        named = by_names(forecasts).get(name_key(name))
        if named is None:
            known = ", ".join(repr(f.name) for f in forecasts)
            raise SimulationError(f"there is no forecast {name.strip()!r} for the tolerance", hint=f"there are {known}")
        if name_key(named.name) in single:
            raise SimulationError(f"two tolerances are stated for {name.strip()!r}", hint="keep one of them")
        single[name_key(named.name)] = stated
    return Tolerances(general, single)


def _read_stated(text: str, amount: str) -> _Stated:
    match = _NUMBER_AND_UNIT.fullmatch(amount)
    try:
        value = float(match["number"]) if match else math.nan
    except ValueError:
        value = math.nan
    if match is None or not 0.0 < value < math.inf:
        hint = "write a positive number, its unit if need be, and before it the forecast: 'Name=0.5 mph'"
        raise SimulationError(f"the tolerance {text!r} cannot be read", hint=hint)
    return _Stated(text, value, match["unit"] or "")


def _refuse_idle(stated: _Stated, general: Sequence[_Stated], forecasts: Sequence[Forecast]) -> None:
    """Refuse a tolerance that holds for no forecast, for it must be a slip.

    Raises:
        SimulationError: it does not, or another one holds for the same forecasts.
    """
    mine = {f.name for f in forecasts if stated.of(f, 1.0) is not None}
    if not mine:
        units = ", ".join(sorted({f.units or "no unit" for f in forecasts}))
        raise SimulationError(f"no forecast has the unit of the tolerance {stated.text!r}", hint=f"there are {units}")
    for other in general:
        if mine & {f.name for f in forecasts if other.of(f, 1.0) is not None}:
            message = f"the tolerances {other.text!r} and {stated.text!r} hold for the same forecasts"
            raise SimulationError(message, hint="name the forecast before the tolerance")
