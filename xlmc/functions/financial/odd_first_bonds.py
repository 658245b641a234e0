"""Bonds whose first coupon period is odd. Dates are serials of the 1900 system, amounts are per 100 of face value.

A long period is cut into *quasi-coupon* periods, as the coupons would fall if they went on. In sums over them each
counts by its own length. What Excel's documentation leaves open follows values that Excel computed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.day_count import days_between, is_basis
from xlmc.functions.dates.months import months_later
from xlmc.functions.financial.bonds import annuity
from xlmc.functions.financial.coupons import Coupons, is_frequency, months_between
from xlmc.functions.financial.roots import growth_root
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Bools, Floats

__all__: list[str] = []


def _days(start: Any, end: Any, basis: Any) -> Floats:
    """Days between two dates, none if they come in the wrong order."""
    return np.maximum(days_between(start, end, basis), 0.0)


def _is_of_true_days(basis: Any) -> Bools:
    """Whether true days go with years of 360 or 365 days."""
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
        issue = np.where(self.refused, first, issue)  # where no time need be spent on its periods
        self.a_year, self.redemption = 12 / months_between(frequency), redemption
        self.coupon = 100 * rate / self.a_year
        self.coupons = Coupons(first, maturity, frequency, basis).count
        to_first = Coupons(settlement, first, frequency, basis)
        length, days = to_first.days, _days(issue, first, basis)
        short = days < length
        quasi_first, quasi_gone = _quasi_periods(to_first, issue)
        left = np.where(_is_of_true_days(basis), _days(settlement, to_first.next, basis), length - to_first.days_before)
        self.first = np.where(short, days / length, quasi_first)
        self.gone = np.where(short, _days(issue, settlement, basis) / length, quasi_gone)
        self.ahead = np.where(short, _days(settlement, first, basis) / length, to_first.count - 1 + left / length)

    def price(self, log_growth: Floats) -> Floats:
        """Price without accrued interest, when a unit grows by exp(log_growth) a period."""
        at_first = self.first + annuity(log_growth, self.coupons + 1) - 1
        later = self.redemption * np.exp(-self.coupons * log_growth) + self.coupon * at_first
        return np.asarray(later * np.exp(-self.ahead * log_growth) - self.coupon * self.gone)


def _quasi_periods(to_first: Coupons, issue: Any) -> tuple[Floats, Floats]:
    """A long first period in normal ones: the whole of it, and what has gone of it at settlement."""
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
    return np.where(wrong, NUM, bond.price(np.log1p(np.where(wrong, 0.0, yield_) / bond.a_year)))


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
    return np.where(bond.refused | (np.asarray(pr) < 0), NUM, per_period * bond.a_year)
