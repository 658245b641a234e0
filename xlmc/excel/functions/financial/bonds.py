"""Bonds that pay coupons: price, yield and duration, per 100 of face value. Dates are serials of the 1900 system.

Formulas as in Excel's documentation of PRICE, YIELD and DURATION: n coupons are left, the first after the share w of a
period, and p = 1 + yield/frequency is what one unit grows to in a period.

The first or the last coupon period may be odd (`ODDFPRICE`, `ODDLPRICE` and kin). A long period is cut into
*quasi-coupon* periods, the periods there would be if the coupons went on; in sums each counts by its own length. Where
Excel's documentation leaves a rule open, the rule was found from values that Excel computed.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.excel.functions.dates.day_count import by_basis, days_between, is_basis, months_later, us_360
from xlmc.excel.functions.financial.annuities import growth
from xlmc.excel.functions.financial.coupons import Coupons, is_frequency, months_between
from xlmc.excel.functions.financial.roots import growth_root
from xlmc.excel.functions.registry import Number
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__ = ["annuity"]

_FIRST_GUESS: Final = 0.05


def annuity(log_growth: Floats, n: Any) -> Floats:
    """Return what n payments of one, the first of them now, are worth, when a unit grows by exp(log_growth) a
    period.
    """
    zero = log_growth == 0
    per_period = np.expm1(-np.where(zero, 1.0, log_growth))
    return np.asarray(np.where(zero, n, np.expm1(-n * log_growth) / per_period))


class _Bond:
    """What price and yield need both: coupon, accrued interest and the share of a period to the next coupon."""

    def __init__(self, settlement: Any, maturity: Any, rate: Any, redemption: Any, frequency: Any, basis: Any) -> None:
        coupons = Coupons(settlement, maturity, frequency, basis)
        self.refused = coupons.refused | (np.asarray(rate) < 0) | (np.asarray(redemption) <= 0)
        self.per_year = 12 / months_between(frequency)
        self.n, self.redemption, self.coupon = coupons.count, redemption, 100 * rate / self.per_year
        gone = coupons.days_before / coupons.days
        self.accrued, self.share = self.coupon * gone, 1 - gone

    def price(self, log_growth: Floats) -> Floats:
        """Price without accrued interest; the yield of a last coupon is simple interest."""
        payments = self.coupon * annuity(log_growth, self.n) * np.exp(-self.share * log_growth)
        redeemed = self.redemption * np.exp(-(self.n - 1 + self.share) * log_growth)
        last = (self.redemption + self.coupon) / (1 + self.share * np.expm1(log_growth))
        return np.asarray(np.where(self.n == 1, last, payments + redeemed) - self.accrued)


@toolpak("PRICE", Date, Date, Number, Number, Number, Number, Number(default=0.0))
def price(
    settlement: Any, maturity: Any, rate: Any, yield_: Any, redemption: Any, frequency: Any, basis: Any
) -> Floats:
    """Price at a yield; `#NUM!` for negative rates."""
    bond = _Bond(settlement, maturity, rate, redemption, frequency, basis)
    wrong = bond.refused | (np.asarray(yield_) < 0)
    return np.where(wrong, NUM, bond.price(np.log1p(np.where(wrong, 0.0, yield_) / bond.per_year)))


@toolpak("YIELD", Date, Date, Number, Number, Number, Number, Number(default=0.0))
def yield_to_maturity(
    settlement: Any, maturity: Any, rate: Any, pr: Any, redemption: Any, frequency: Any, basis: Any
) -> Floats:
    """Yield at a price; `#NUM!` for a price of 0 or less."""
    bond = _Bond(settlement, maturity, rate, redemption, frequency, basis)
    wrong = bond.refused | (np.asarray(pr) <= 0)
    paid = np.where(wrong, 100.0, pr + bond.accrued)
    guess = np.broadcast_to(
        _FIRST_GUESS / bond.per_year, np.broadcast_shapes(paid.shape, bond.n.shape, bond.share.shape)
    )
    per_period = growth_root(lambda x: bond.price(x) - pr, guess)
    last = ((bond.redemption + bond.coupon) / paid - 1) / bond.share
    return np.where(wrong, NUM, np.where(bond.n == 1, last, per_period) * bond.per_year)


def _duration(
    settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any
) -> tuple[Floats, Floats]:
    """Mean time of all payments in years, weighted by what they are worth; and what a unit grows to in a period."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    wrong = coupons.refused | (np.asarray(coupon) < 0) | (np.asarray(yield_) < 0)
    per_year = 12 / months_between(frequency)
    grown = 1 + np.where(wrong, 0.0, yield_) / per_year
    share = 1 - coupons.days_before / coupons.days
    n = np.where(wrong, 0.0, coupons.count)
    last = share + n - 1
    worth, moment = 1 / growth(grown - 1, last), last / growth(grown - 1, last)
    payment, factor = np.asarray(coupon) / per_year, 1 / growth(grown - 1, share)
    for k in range(int(n.max())):
        due = np.where(k < n, payment * factor, 0.0)
        worth, moment = worth + due, moment + due * (share + k)
        factor = factor / grown
    return np.where(wrong, NUM, moment / worth / per_year), grown


@toolpak("DURATION", Date, Date, Number, Number, Number, Number(default=0.0))
def macaulay_duration(settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any) -> Floats:
    """Macaulay duration, in years; `#NUM!` for negative rates."""
    return _duration(settlement, maturity, coupon, yield_, frequency, basis)[0]


@toolpak("MDURATION", Date, Date, Number, Number, Number, Number(default=0.0))
def modified_duration(settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any) -> Floats:
    """Macaulay duration by the growth of a period: how much of its price a bond loses as the yield rises."""
    duration, grown = _duration(settlement, maturity, coupon, yield_, frequency, basis)
    return duration / grown


def _days(start: Any, end: Any, basis: Any) -> Floats:
    """Days between two dates; 0 if the end comes before the start."""
    return np.maximum(days_between(start, end, basis), 0.0)


def _counts_true_days(basis: Any) -> Bools:
    """Whether the basis counts true days in years of 360 or 365 days."""
    return np.asarray((np.floor(basis) == 2) | (np.floor(basis) == 3))


_Dates = tuple[Any, Any, Any, Any]
"""Settlement, maturity, issue, first coupon."""


class _OddFirst:
    """A bond with an odd first period, bought in it.

    Attributes:
        coupons: whole coupons after the first.
        first: the first coupon, in whole coupons.
        gone: the accrued part of it.
        ahead: periods to the first coupon.
    """

    def __init__(self, dates: _Dates, rate: Any, redemption: Any, frequency: Any, basis: Any) -> None:
        settlement, maturity, issue, first = dates
        in_order = np.less(issue, settlement) & np.less(settlement, first) & np.less(first, maturity)
        wrong = ~in_order | ~is_frequency(frequency) | ~is_basis(basis)
        self.refused = wrong | (np.asarray(rate) < 0) | (np.asarray(redemption) < 0)
        issue = np.where(self.refused, first, issue)  # refused trials get no periods: they take no time
        self.per_year, self.redemption = 12 / months_between(frequency), redemption
        self.coupon = 100 * rate / self.per_year
        self.coupons = Coupons(first, maturity, frequency, basis).count
        to_first = Coupons(settlement, first, frequency, basis)
        length, days = to_first.days, _days(issue, first, basis)
        short = days < length
        quasi_first, quasi_gone = _quasi_periods(to_first, issue)
        left = np.where(
            _counts_true_days(basis), _days(settlement, to_first.next, basis), length - to_first.days_before
        )
        self.first = np.where(short, days / length, quasi_first)
        self.gone = np.where(short, _days(issue, settlement, basis) / length, quasi_gone)
        self.ahead = np.where(short, _days(settlement, first, basis) / length, to_first.count - 1 + left / length)

    def price(self, log_growth: Floats) -> Floats:
        """Price without accrued interest, when a unit grows by exp(log_growth) a period."""
        at_first = self.first + annuity(log_growth, self.coupons + 1) - 1
        later = self.redemption * np.exp(-self.coupons * log_growth) + self.coupon * at_first
        return np.asarray(later * np.exp(-self.ahead * log_growth) - self.coupon * self.gone)


def _quasi_periods(to_first: Coupons, issue: Any) -> tuple[Floats, Floats]:
    """Return the length of a long first period in normal periods, and how much of it has gone at settlement."""
    basis, length = to_first.basis, to_first.days
    count = Coupons(issue, to_first.maturity, to_first.frequency, basis).count
    whole = gone = np.zeros(1)
    late = np.asarray(to_first.maturity)
    for index in range(int(count.max()), 0, -1):
        here = index <= count
        early = months_later(late, -months_between(to_first.frequency))
        normal = np.where(np.floor(basis) == 1, _days(early, late, basis), length)
        covered = np.where(index > 1, normal, _days(issue, late, basis))
        used = _days(np.maximum(issue, early), np.minimum(to_first.settlement, late), basis)
        whole, gone = whole + np.where(here, covered / normal, 0.0), gone + np.where(here, used / normal, 0.0)
        late = np.where(here, early, late)
    return whole, gone


@toolpak("ODDFPRICE", Date, Date, Date, Date, Number, Number, Number, Number, Number(default=0.0))
def odd_first_price(
    settlement: Any,
    maturity: Any,
    issue: Any,
    first: Any,
    rate: Any,
    yield_: Any,
    redemption: Any,
    frequency: Any,
    basis: Any,
) -> Floats:
    """Price of a bond with an odd first period; `#NUM!` unless its first coupon is in step with maturity."""
    bond = _OddFirst((settlement, maturity, issue, first), rate, redemption, frequency, basis)
    in_step = Coupons(first, maturity, frequency, basis).previous == first
    wrong = bond.refused | ~in_step | (np.asarray(yield_) < 0)
    return np.where(wrong, NUM, bond.price(np.log1p(np.where(wrong, 0.0, yield_) / bond.per_year)))


@toolpak("ODDFYIELD", Date, Date, Date, Date, Number, Number, Number, Number, Number(default=0.0))
def odd_first_yield(
    settlement: Any,
    maturity: Any,
    issue: Any,
    first: Any,
    rate: Any,
    pr: Any,
    redemption: Any,
    frequency: Any,
    basis: Any,
) -> Floats:
    """Yield of a bond with an odd first period."""
    bond = _OddFirst((settlement, maturity, issue, first), rate, redemption, frequency, basis)
    shape = np.broadcast_shapes(bond.refused.shape, bond.gone.shape, bond.coupons.shape, np.shape(pr))
    per_period = growth_root(lambda x: bond.price(x) - pr, np.full(shape, 0.025))
    return np.where(bond.refused | (np.asarray(pr) < 0), NUM, per_period * bond.per_year)


def _odd_last(
    settlement: Any, maturity: Any, last: Any, rate: Any, redemption: Any, frequency: Any, basis: Any
) -> tuple[Floats, Floats, Floats, Bools]:
    """Return what is paid at maturity, accrued interest, years from settlement to it, and where Excel refuses
    the bond.
    """
    in_order = np.less(last, settlement) & np.less(settlement, maturity)
    wrong = ~in_order | ~is_frequency(frequency) | ~is_basis(basis)
    wrong = wrong | (np.asarray(rate) < 0) | (np.asarray(redemption) < 0)
    step = months_between(frequency)
    count = np.where(wrong, 1.0, Coupons(last, maturity, frequency, basis).count)
    whole = gone = ahead = np.zeros(1)
    early = np.asarray(last)
    for index in range(1, int(count.max()) + 1):
        here = index <= count
        late = months_later(early, step)
        normal = _long_days(early, late, basis)
        covered = np.where(index < count, normal, _long_days(early, maturity, basis))
        partly = np.where(early < settlement, _days(early, settlement, basis), 0.0)
        used = np.where(late < settlement, covered, partly)
        left = _days(np.maximum(settlement, early), np.minimum(maturity, late), basis)
        whole, gone, ahead = (
            total + np.where(here, days / normal, 0.0)
            for total, days in ((whole, covered), (gone, used), (ahead, left))
        )
        early = np.where(here, late, early)
    coupon = 100 * rate / (12 / step)
    return redemption + whole * coupon, gone * coupon, ahead * step / 12, np.asarray(wrong)


def _long_days(start: Any, end: Any, basis: Any) -> Floats:
    """Days as `_days` counts them, but with US months of 30 days the end of February is a 30th at both ends."""

    def plain() -> Floats:
        return days_between(start, end, basis)

    return np.maximum(by_basis(basis, lambda: us_360(start, end, end_too=True), plain, plain, plain, plain), 0.0)


@toolpak("ODDLPRICE", Date, Date, Date, Number, Number, Number, Number, Number(default=0.0))
def odd_last_price(
    settlement: Any, maturity: Any, last: Any, rate: Any, yield_: Any, redemption: Any, frequency: Any, basis: Any
) -> Floats:
    """Price of a bond in its odd last period, at simple interest."""
    paid, accrued, years, wrong = _odd_last(settlement, maturity, last, rate, redemption, frequency, basis)
    return np.where(wrong | (np.asarray(yield_) < 0), NUM, paid / (1 + years * yield_) - accrued)


@toolpak("ODDLYIELD", Date, Date, Date, Number, Number, Number, Number, Number(default=0.0))
def odd_last_yield(
    settlement: Any, maturity: Any, last: Any, rate: Any, pr: Any, redemption: Any, frequency: Any, basis: Any
) -> Floats:
    """Yield of a bond in its odd last period, at simple interest; `#NUM!` unless the price is above 0."""
    paid, accrued, years, wrong = _odd_last(settlement, maturity, last, rate, redemption, frequency, basis)
    wrong = wrong | (np.asarray(pr) <= 0)
    return np.where(wrong, NUM, (paid / np.where(wrong, 1.0, accrued + pr) - 1) / np.where(wrong, 1.0, years))
