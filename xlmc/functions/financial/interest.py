"""Growth at compound interest, and prices quoted in fractions of a dollar."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import earliest, where_wrong
from xlmc.functions.facts import EmptyCells, Facts
from xlmc.functions.registry import Cells, Number, excel
from xlmc.functions.toolpak import OneCell, strict_numbers
from xlmc.functions.toolpak_rows import toolpak
from xlmc.functions.values import BLANK, DIV0, LOGICAL, NUM, TEXT, Floats, Value

__all__: list[str] = []

_TENS: Final = np.array([float(f"1e{n}") for n in range(309)])


@toolpak("EFFECT", Number, Number)
def effective_rate(nominal: Any, npery: Any) -> Floats:
    """Effective yearly rate of a nominal one that is compounded so many times a year."""
    wrong = (nominal <= 0) | (npery < 1)
    times = np.where(wrong, 1.0, np.floor(npery))
    return np.where(wrong, NUM, np.expm1(times * np.log1p(np.where(wrong, 0.0, nominal) / times)))


@toolpak("NOMINAL", Number, Number)
def nominal_rate(effective: Any, npery: Any) -> Floats:
    """Nominal yearly rate that, compounded so many times a year, comes to the effective one."""
    wrong = (effective <= 0) | (npery < 1)
    times = np.where(wrong, 1.0, np.floor(npery))
    return np.where(wrong, NUM, np.expm1(np.log1p(np.where(wrong, 0.0, effective)) / times) * times)


@excel("RRI", Number, Number, Number)
def equivalent_rate(nper: Any, pv: Any, fv: Any) -> Floats:
    """Rate per period at which `pv` grows to `fv`; `#NUM!` without periods, from nothing or to another sign."""
    wrong = (np.asarray(nper) <= 0) | (np.asarray(pv) == 0) | (np.sign(pv) * np.sign(fv) < 0)
    ratio = fv / np.where(wrong, 1.0, pv)
    lost = ratio == 0
    rate = np.expm1(np.log(np.where(wrong | lost, 1.0, ratio)) / np.where(wrong, 1.0, nper))
    return np.where(wrong, NUM, np.where(lost, -1.0, rate))


@excel("PDURATION", Number, Number, Number)
def growth_periods(rate: Any, pv: Any, fv: Any) -> Floats:
    """Periods in which `pv` grows to `fv`; `#NUM!` unless all three are above 0."""
    wrong = (np.asarray(rate) <= 0) | (np.asarray(pv) <= 0) | (np.asarray(fv) <= 0)
    rate, pv, fv = (np.where(wrong, 1.0, x) for x in (rate, pv, fv))
    return np.where(wrong, NUM, (np.log(fv) - np.log(pv)) / np.log1p(rate))


@excel("FVSCHEDULE", OneCell, Cells, facts=Facts(empty_cells=EmptyCells.IGNORED))
def scheduled_growth(principal: Value, schedule: Value) -> Value:
    """What a principal grows to at one rate after the other; blank rates are 0, texts and logicals `#VALUE!`."""
    result, errors = strict_numbers(principal)
    rates = schedule.as_range()
    wrong = where_wrong((rates.kinds == TEXT) | (rates.kinds == LOGICAL), ErrorCode.VALUE)
    codes = np.broadcast_to(np.where(wrong > 0, wrong, rates.errors), rates.shape)
    numbers = np.where(rates.kinds == BLANK, 0.0, rates.numbers)
    per_trial = (-1,) + (1,) * (result.ndim - 1)
    for row, column in np.ndindex(*rates.shape[1:]):
        result = result * (1 + numbers[:, row, column].reshape(per_trial))
        errors = earliest(errors, codes[:, row, column].reshape(per_trial))
    return Value.of_numbers(result, np.broadcast_to(errors, np.broadcast_shapes(result.shape, errors.shape)))


def _hundredths(fraction: Any) -> tuple[Floats, Floats]:
    """The denominator, whole, and the power of ten that holds its digits."""
    whole = np.where(np.asarray(fraction) < 1, 1.0, np.floor(fraction))
    return whole, _TENS[np.minimum(np.searchsorted(_TENS, whole), _TENS.size - 1)]


def _refused(fraction: Any, result: Floats) -> Floats:
    return np.where(np.asarray(fraction) < 0, NUM, np.where(np.asarray(fraction) < 1, DIV0, result))


@toolpak("DOLLARDE", Number, Number)
def decimal_dollars(price: Any, fraction: Any) -> Floats:
    """A price whose digits behind the point are a numerator, such as 1.02 for 1 + 2/16, as a decimal number."""
    whole, digits = _hundredths(fraction)
    dollars = np.trunc(price)
    return _refused(fraction, dollars + (price - dollars) * digits / whole)


@toolpak("DOLLARFR", Number, Number)
def fractional_dollars(price: Any, fraction: Any) -> Floats:
    """A decimal price with a numerator for the digits behind its point: 1.125 in 16ths is 1.02."""
    whole, digits = _hundredths(fraction)
    dollars = np.trunc(price)
    return _refused(fraction, dollars + (price - dollars) * whole / digits)
