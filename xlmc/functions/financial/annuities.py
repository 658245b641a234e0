"""Loans and savings of equal payments. Rates are per period; money received is positive, money paid is negative.

All rest on one equation, pv·g + pmt·(1 + rate·due)·s + fv = 0, where g = (1 + rate)^nper is what one unit grows to and
s = (g - 1)/rate what one unit paid at the end of every period comes to; `due` is 1 when payments fall due at the start.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.functions.financial.roots import growth_root
from xlmc.functions.math.powers import powered
from xlmc.functions.registry import Number, excel
from xlmc.functions.toolpak_rows import toolpak
from xlmc.functions.values import NUM, Floats

__all__ = ["growth"]

_SMALL_RATE: Final = 1e-4


def growth(rate: Any, periods: Any) -> Floats:
    """What one unit grows to, (1 + rate)^periods; NaN for rates below -1 unless the periods are whole."""
    return powered(1.0 + np.asarray(rate), periods)


def _accumulation(rate: Any, periods: Any) -> Floats:
    """What one unit paid at the end of every period comes to, ((1 + rate)^periods - 1)/rate.

    At small rates the difference would lose its digits.
    """
    small, zero = np.abs(rate) < _SMALL_RATE, np.asarray(rate) == 0
    careful = np.expm1(periods * np.log1p(np.where(small, rate, 0.0)))
    gain = np.where(small, careful, growth(rate, periods) - 1)
    return np.where(zero, periods, gain / np.where(zero, 1.0, rate))


def _due(rate: Any, when: Any) -> Floats:
    """What a payment is worth at the end of its period; any `when` but 0 is the period's start."""
    return np.where(np.asarray(when) != 0, 1.0 + np.asarray(rate), 1.0)


def _nonzero(x: Any) -> Floats:
    """A divisor: NaN for zero, which makes the quotient `#NUM!` without a flag."""
    return np.where(np.asarray(x) == 0, np.nan, x)


@excel("FV", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def future_value(rate: Any, nper: Any, pmt: Any, pv: Any, when: Any) -> Floats:
    """Balance after the last payment."""
    return np.asarray(-(pv * growth(rate, nper) + pmt * _due(rate, when) * _accumulation(rate, nper)) + 0.0)


@excel("PV", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def present_value(rate: Any, nper: Any, pmt: Any, fv: Any, when: Any) -> Floats:
    """What all payments are worth now; `#NUM!` at a rate of -100 %."""
    later = fv + pmt * _due(rate, when) * _accumulation(rate, nper)
    return np.asarray(-later / _nonzero(growth(rate, nper)) + 0.0)


@excel("PMT", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def payment(rate: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Payment per period; `#NUM!` without periods."""
    worth = _due(rate, when) * _accumulation(rate, nper)
    return np.asarray(-(fv + pv * growth(rate, nper)) / _nonzero(worth) + 0.0)


@excel("NPER", Number, Number, Number, Number(default=0.0), Number(default=0.0))
def periods_needed(rate: Any, pmt: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """How many periods it takes; `#NUM!` when the payments never do."""
    zero = np.asarray(rate) == 0
    paid = pmt * _due(rate, when)
    ratio = (paid - np.multiply(fv, rate)) / _nonzero(paid + np.multiply(pv, rate))
    possible = (ratio > 0) & (np.asarray(rate) > -1)
    log_growth = np.log1p(np.where(zero | ~possible, 1.0, rate))
    result = np.where(possible, np.log(np.where(possible, ratio, 1.0)) / log_growth, np.nan)
    return np.where(zero, -np.add(pv, fv) / _nonzero(pmt), result) + 0.0


@excel("RATE", Number, Number, Number, Number(default=0.0), Number(default=0.0), Number(default=0.1))
def rate_of_annuity(nper: Any, pmt: Any, pv: Any, fv: Any, when: Any, guess: Any) -> Floats:
    """Rate per period; of several, the one nearest to the guess; `#NUM!` where there is none.

    There is none unless something is paid and something received.
    """
    nper, pmt, pv, fv, when, guess = np.broadcast_arrays(*map(np.atleast_1d, (nper, pmt, pv, fv, when, guess)))
    largest, smallest = np.maximum(np.maximum(pmt, pv), fv), np.minimum(np.minimum(pmt, pv), fv)
    possible = (nper > 0) & (largest > 0) & (smallest < 0)
    periods = np.where(possible, nper, 1.0)

    def balance(x: Floats) -> Floats:
        """At present for positive rates, at the end for negative ones, so that nothing grows beyond bounds."""
        rate, shrunk = np.expm1(x), np.exp(-periods * np.abs(x))
        zero = rate == 0
        paid = np.where(zero, periods, np.expm1(-periods * np.abs(x)) * -np.sign(x) / np.where(zero, 1.0, rate))
        ends = np.where(x >= 0, pv + fv * shrunk, pv * shrunk + fv)
        return np.asarray(ends + pmt * _due(rate, when) * paid)

    return np.where(possible, growth_root(balance, np.asarray(guess, np.float64)), np.nan)


def _interest(rate: Any, per: Any, nper: Any, pv: Any, fv: Any, when: Any) -> Floats:
    """Interest in the payment of a period: the rate on the balance before it, which earns for one period less when
    payments fall due at the start; the first of those bears none.
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
    """What a payment pays back; `#NUM!` for a period outside 1 to `nper`."""
    paid = payment(rate, nper, pv, fv, when)
    return np.asarray(paid - interest_payment(rate, per, nper, pv, fv, when))


@excel("ISPMT", Number, Number, Number, Number)
def straight_interest(rate: Any, per: Any, nper: Any, pv: Any) -> Floats:
    """Interest after `per` periods of a loan paid back in equal parts; `#NUM!` without periods."""
    return np.asarray(np.multiply(pv, rate) * (per / _nonzero(nper) - 1) + 0.0)


def _totals(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> tuple[Floats, Floats]:
    """Interest and principal paid from the first to the last period, both with the sign of the payments."""
    first, last, when = np.ceil(first), np.floor(last), np.trunc(when)
    pmt = payment(rate, nper, pv, 0.0, when)
    owed_at_last = _owed_after(rate, last, pmt, pv, when)
    principal = owed_at_last - _owed_after(rate, first - 1, pmt, pv, when)
    bearing = np.where((np.asarray(when) != 0) & (first == 1), 2.0, first)  # the first that bears interest
    interest = pmt * (last - bearing + 1) - owed_at_last + _owed_after(rate, bearing - 1, pmt, pv, when)
    wrong = (rate <= 0) | (nper <= 0) | (pv <= 0) | (first < 1) | (last < first) | (last > nper)
    wrong = wrong | ((when != 0) & (when != 1))
    return np.where(wrong, NUM, interest), np.where(wrong, NUM, principal)


def _owed_after(rate: Any, paid: Any, pmt: Any, pv: Any, when: Any) -> Floats:
    """What is owed just after so many payments; the first of those due at the start falls on the day of the loan."""
    interest_periods = np.where((np.asarray(when) != 0) & (paid > 0), paid - 1, paid)
    return np.asarray(pv * growth(rate, interest_periods) + pmt * _accumulation(rate, paid))


@toolpak("CUMIPMT", Number, Number, Number, Number, Number, Number)
def interest_between(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> Floats:
    """Interest paid from one period to another; `#NUM!` unless rate, periods and loan are above 0."""
    return _totals(rate, nper, pv, first, last, when)[0]


@toolpak("CUMPRINC", Number, Number, Number, Number, Number, Number)
def principal_between(rate: Any, nper: Any, pv: Any, first: Any, last: Any, when: Any) -> Floats:
    """What is paid back from one period to another; `#NUM!` unless rate, periods and loan are above 0."""
    return _totals(rate, nper, pv, first, last, when)[1]
