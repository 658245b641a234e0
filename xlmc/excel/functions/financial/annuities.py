"""Loans and savings of equal payments, and growth at compound interest.

Rates are per period; money received is positive, money paid is negative. All functions of payments solve one equation,
pv·g + pmt·(1 + rate·due)·s + fv = 0, where g = (1 + rate)^nper is what one unit grows to and s = (g - 1)/rate what one
unit paid at the end of every period comes to; `due` is 1 when payments fall due at the start. The last functions
convert prices that are quoted in fractions of a dollar.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import error_where, first_error
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.financial.roots import growth_root
from xlmc.excel.functions.math.arithmetic import raise_to_power
from xlmc.excel.functions.math.rounding import TENS
from xlmc.excel.functions.registry import Cells, Number, excel
from xlmc.excel.functions.toolpak import OneCell, strict_numbers, toolpak
from xlmc.excel.functions.values import BLANK, DIV0, LOGICAL, NUM, TEXT, Floats, Value

__all__ = ["growth"]

_SMALL_RATE: Final = 1e-4


def growth(rate: Any, periods: Any) -> Floats:
    """Return what one unit grows to, (1 + rate)^periods; NaN for rates below -1 unless the periods are whole."""
    return raise_to_power(1.0 + np.asarray(rate), periods)


def _accumulation(rate: Any, periods: Any) -> Floats:
    """Return what one unit paid at the end of every period comes to, ((1 + rate)^periods - 1)/rate.

    At small rates the difference would lose its digits.
    """
    small, zero = np.abs(rate) < _SMALL_RATE, np.asarray(rate) == 0
    careful = np.expm1(periods * np.log1p(np.where(small, rate, 0.0)))
    gain = np.where(small, careful, growth(rate, periods) - 1)
    return np.where(zero, periods, gain / np.where(zero, 1.0, rate))


def _timing_factor(rate: Any, when: Any) -> Floats:
    """Return what one unit paid is worth at the end of its period; any `when` but 0 means that it is paid at
    the start.
    """
    return np.where(np.asarray(when) != 0, 1.0 + np.asarray(rate), 1.0)


def _nan_if_zero(x: Any) -> Floats:
    """Return the divisor, NaN where it is 0: the quotient is then `#NUM!`, and no floating-point flag is raised."""
    return np.where(np.asarray(x) == 0, np.nan, x)


def _nan_unless_valid(rate: Any) -> Floats:
    """Return the rate, NaN where it leaves nothing of a unit: at -1 and below."""
    return np.where(np.asarray(rate) > -1, rate, np.nan)


@excel("FV", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def future_value(rate: Any, nper: Any, pmt: Any, pv: Any, when: Any) -> Floats:
    """Balance after the last payment; `#DIV/0!` before the first one at a rate of -100 %."""
    lost = (np.asarray(rate) == -1) & (np.asarray(nper) < 0)
    return np.where(lost, DIV0, _future_value(np.where(lost, 0.0, rate), nper, pmt, pv, when))


def _future_value(rate: Any, nper: Any, pmt: Any, pv: Any, when: Any) -> Floats:
    return np.asarray(-(pv * growth(rate, nper) + pmt * _timing_factor(rate, when) * _accumulation(rate, nper)) + 0.0)


@excel("PV", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def present_value(rate: Any, nper: Any, pmt: Any, fv: Any, when: Any) -> Floats:
    """Return what all payments are worth now; `#NUM!` at rates of -100 % and below."""
    rate = _nan_unless_valid(rate)
    later = fv + pmt * _timing_factor(rate, when) * _accumulation(rate, nper)
    return np.asarray(-later / _nan_if_zero(growth(rate, nper)) + 0.0)


@excel("PMT", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def payment(rate: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Payment per period; `#NUM!` without periods, and at rates of -100 % and below."""
    rate = _nan_unless_valid(rate)
    worth = _timing_factor(rate, when) * _accumulation(rate, nper)
    return np.asarray(-(fv + pv * growth(rate, nper)) / _nan_if_zero(worth) + 0.0)


@excel("NPER", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def periods_needed(rate: Any, pmt: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Return the number of periods; `#NUM!` where the payments never suffice."""
    zero = np.asarray(rate) == 0
    paid = pmt * _timing_factor(rate, when)
    ratio = (paid - np.multiply(fv, rate)) / _nan_if_zero(paid + np.multiply(pv, rate))
    possible = (ratio > 0) & (np.asarray(rate) > -1)
    log_growth = np.log1p(np.where(zero | ~possible, 1.0, rate))
    result = np.where(possible, np.log(np.where(possible, ratio, 1.0)) / log_growth, np.nan)
    return np.where(zero, -np.add(pv, fv) / _nan_if_zero(pmt), result) + 0.0


@excel("RATE", Number, Number, Number, Number(default=0.0), Number(default=0.0), Number(default=0.1))
def rate_of_annuity(nper: Any, pmt: Any, pv: Any, fv: Any, when: Any, guess: Any) -> Floats:
    """Rate per period; of several, the one nearest to the guess; `#NUM!` without one.

    There is none unless something is paid and something received.
    """
    nper, pmt, pv, fv, when, guess = np.broadcast_arrays(*map(np.atleast_1d, (nper, pmt, pv, fv, when, guess)))
    largest, smallest = np.maximum(np.maximum(pmt, pv), fv), np.minimum(np.minimum(pmt, pv), fv)
    possible = (nper > 0) & (largest > 0) & (smallest < 0)
    periods = np.where(possible, nper, 1.0)

    def balance(x: Floats) -> Floats:
        """Return the balance, at present for positive rates and at the end for negative ones, so that nothing
        overflows.
        """
        rate, shrunk = np.expm1(x), np.exp(-periods * np.abs(x))
        zero = rate == 0
        paid = np.where(zero, periods, np.expm1(-periods * np.abs(x)) * -np.sign(x) / np.where(zero, 1.0, rate))
        ends = np.where(x >= 0, pv + fv * shrunk, pv * shrunk + fv)
        return np.asarray(ends + pmt * _timing_factor(rate, when) * paid)

    return np.where(possible, growth_root(balance, np.asarray(guess, np.float64)), np.nan)


def _interest(rate: Any, per: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Interest in the payment of a period: the rate times the balance before it.

    Payments at the start bear interest for one period less, and the first of them bears none.
    """
    at_start = np.asarray(when) != 0
    pmt = payment(rate, nper, pv, fv, when)
    before = future_value(rate, per - 1, pmt, pv, when) / np.where(at_start, 1.0 + np.asarray(rate), 1.0)
    return np.where(at_start & (np.asarray(per) == 1), 0.0, before * rate) + 0.0


@excel("IPMT", Number, Number, Number, Number, Number(default=0.0), Number(default=0.0))
def interest_payment(rate: Any, per: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Interest in the payment of one period; `#NUM!` for a period outside 1 to `nper`."""
    outside = (np.asarray(per) < 1) | (np.asarray(per) >= np.asarray(nper) + 1)
    return np.where(outside, NUM, _interest(rate, per, nper, pv, fv, when))


@excel("PPMT", Number, Number, Number, Number, Number(default=0.0), Number(default=0.0))
def principal_payment(rate: Any, per: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Principal in the payment of one period; `#NUM!` for a period outside 1 to `nper`."""
    paid = payment(rate, nper, pv, fv, when)
    return np.asarray(paid - interest_payment(rate, per, nper, pv, fv, when))


@excel("ISPMT", Number, Number, Number, Number)
def straight_interest(rate: Any, per: Any, nper: Any, pv: Any) -> Floats:
    """Interest after `per` periods of a loan paid back in equal parts; `#NUM!` without periods."""
    return np.asarray(np.multiply(pv, rate) * (per / _nan_if_zero(nper) - 1) + 0.0)


def _totals(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> tuple[Floats, Floats]:
    """Interest and principal paid from the first to the last period, both with the sign of the payments."""
    first, last, when = np.ceil(first), np.floor(last), np.trunc(when)
    pmt = payment(rate, nper, pv, 0.0, when)
    owed_at_last = _find_owed(rate, last, pmt, pv, when)
    principal = owed_at_last - _find_owed(rate, first - 1, pmt, pv, when)
    bearing = np.where((np.asarray(when) != 0) & (first == 1), 2.0, first)  # the first that bears interest
    interest = pmt * (last - bearing + 1) - owed_at_last + _find_owed(rate, bearing - 1, pmt, pv, when)
    wrong = (rate <= 0) | (nper <= 0) | (pv <= 0) | (first < 1) | (last < first) | (last > nper)
    wrong = wrong | ((when != 0) & (when != 1))
    return np.where(wrong, NUM, interest), np.where(wrong, NUM, principal)


def _find_owed(rate: Any, paid: Any, pmt: Any, pv: Any, when: Any) -> Floats:
    """Return what is owed just after `paid` payments; of those due at the start, the first falls on the day of the
    loan.
    """
    interest_periods = np.where((np.asarray(when) != 0) & (paid > 0), paid - 1, paid)
    return np.asarray(pv * growth(rate, interest_periods) + pmt * _accumulation(rate, paid))


@toolpak("CUMIPMT", Number, Number, Number, Number, Number, Number)
def interest_between(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> Floats:
    """Interest paid from one period to another; `#NUM!` unless rate, periods and loan are above 0."""
    return _totals(rate, nper, pv, first, last, when)[0]


@toolpak("CUMPRINC", Number, Number, Number, Number, Number, Number)
def principal_between(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> Floats:
    """Principal paid from one period to another; `#NUM!` unless rate, periods and loan are above 0."""
    return _totals(rate, nper, pv, first, last, when)[1]


@toolpak("EFFECT", Number, Number)
def effective_rate(nominal: Any, npery: Any) -> Floats:
    """Effective yearly rate of a nominal one that is compounded `npery` times a year."""
    wrong = (nominal <= 0) | (npery < 1)
    times = np.where(wrong, 1.0, np.floor(npery))
    return np.where(wrong, NUM, np.expm1(times * np.log1p(np.where(wrong, 0.0, nominal) / times)))


@toolpak("NOMINAL", Number, Number)
def nominal_rate(effective: Any, npery: Any) -> Floats:
    """Nominal yearly rate that, compounded `npery` times a year, comes to the effective one."""
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
    """Return what a principal grows to at one rate after the other; blank rates are 0, texts and logicals `#VALUE!`."""
    result, errors = strict_numbers(principal)
    rates = schedule.as_range()
    wrong = error_where((rates.kinds == TEXT) | (rates.kinds == LOGICAL), ErrorCode.VALUE)
    codes = np.broadcast_to(np.where(wrong > 0, wrong, rates.errors), rates.shape)
    numbers = np.where(rates.kinds == BLANK, 0.0, rates.numbers)
    per_trial = (-1,) + (1,) * (result.ndim - 1)
    for row, column in np.ndindex(*rates.shape[1:]):
        result = result * (1 + numbers[:, row, column].reshape(per_trial))
        errors = first_error(errors, codes[:, row, column].reshape(per_trial))
    return Value.of_numbers(result, np.broadcast_to(errors, np.broadcast_shapes(result.shape, errors.shape)))


def _denominator_and_scale(fraction: Any) -> tuple[Floats, Floats]:
    """Return the denominator, whole, and the power of ten that holds its digits."""
    whole = np.where(np.asarray(fraction) < 1, 1.0, np.floor(fraction))
    return whole, TENS[np.minimum(np.searchsorted(TENS, whole), TENS.size - 1)]


def _with_errors_of_fraction(fraction: Any, result: Floats) -> Floats:
    """Return the result; `#NUM!` for a fraction below 0, `#DIV/0!` below 1."""
    return np.where(np.asarray(fraction) < 0, NUM, np.where(np.asarray(fraction) < 1, DIV0, result))


@toolpak("DOLLARDE", Number, Number)
def decimal_dollars(price: Any, fraction: Any) -> Floats:
    """Turn a price whose digits behind the point are a numerator, such as 1.02 for 1 + 2/16, into a decimal number."""
    whole, digits = _denominator_and_scale(fraction)
    dollars = np.trunc(price)
    return _with_errors_of_fraction(fraction, dollars + (price - dollars) * digits / whole)


@toolpak("DOLLARFR", Number, Number)
def fractional_dollars(price: Any, fraction: Any) -> Floats:
    """Write a decimal price with a numerator for the digits behind its point: 1.125 in 16ths is 1.02."""
    whole, digits = _denominator_and_scale(fraction)
    dollars = np.trunc(price)
    return _with_errors_of_fraction(fraction, dollars + (price - dollars) * whole / digits)
