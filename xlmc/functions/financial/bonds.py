"""Bonds that pay coupons: price, yield and duration, per 100 of face value. Dates are serials of the 1900 system.

Formulas as in Excel's documentation of PRICE, YIELD and DURATION: n coupons are left, the first after the share w of a
period, and p = 1 + yield/frequency is what one unit grows to in a period.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from xlmc.functions.financial.annuities import growth
from xlmc.functions.financial.coupons import Coupons, months_between
from xlmc.functions.financial.roots import growth_root
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Floats

__all__ = ["annuity"]

_FIRST_GUESS: Final = 0.05


def annuity(log_growth: Floats, n: Any) -> Floats:
    """What n payments of one, the first of them now, are worth, when a unit grows by exp(log_growth) a period."""
    zero = log_growth == 0
    per_period = np.expm1(-np.where(zero, 1.0, log_growth))
    return np.asarray(np.where(zero, n, np.expm1(-n * log_growth) / per_period))


class _Bond:
    """What price and yield share: coupon, accrued interest and the share of a period to the next coupon."""

    def __init__(self, settlement: Any, maturity: Any, rate: Any, redemption: Any, frequency: Any, basis: Any) -> None:
        coupons = Coupons(settlement, maturity, frequency, basis)
        self.refused = coupons.refused | (np.asarray(rate) < 0) | (np.asarray(redemption) <= 0)
        self.a_year = 12 / months_between(frequency)
        self.n, self.redemption, self.coupon = coupons.count, redemption, 100 * rate / self.a_year
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
    return np.where(wrong, NUM, bond.price(np.log1p(np.where(wrong, 0.0, yield_) / bond.a_year)))


@toolpak("YIELD", Date, Date, Number, Number, Number, Number, Number(default=0.0))
def yield_to_maturity(
    settlement: Any, maturity: Any, rate: Any, pr: Any, redemption: Any, frequency: Any, basis: Any
) -> Floats:
    """Yield at a price; `#NUM!` for a price of 0 or less."""
    bond = _Bond(settlement, maturity, rate, redemption, frequency, basis)
    wrong = bond.refused | (np.asarray(pr) <= 0)
    paid = np.where(wrong, 100.0, pr + bond.accrued)
    guess = np.broadcast_to(_FIRST_GUESS / bond.a_year, np.broadcast_shapes(paid.shape, bond.n.shape, bond.share.shape))
    per_period = growth_root(lambda x: bond.price(x) - pr, guess)
    last = ((bond.redemption + bond.coupon) / paid - 1) / bond.share
    return np.where(wrong, NUM, np.where(bond.n == 1, last, per_period) * bond.a_year)


def _duration(
    settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any
) -> tuple[Floats, Floats]:
    """Mean time of all payments in years, weighted by what they are worth; and what a unit grows to in a period."""
    coupons = Coupons(settlement, maturity, frequency, basis)
    wrong = coupons.refused | (np.asarray(coupon) < 0) | (np.asarray(yield_) < 0)
    a_year = 12 / months_between(frequency)
    grown = 1 + np.where(wrong, 0.0, yield_) / a_year
    share = 1 - coupons.days_before / coupons.days
    n = np.where(wrong, 0.0, coupons.count)
    last = share + n - 1
    worth, moment = 1 / growth(grown - 1, last), last / growth(grown - 1, last)
    payment, factor = np.asarray(coupon) / a_year, 1 / growth(grown - 1, share)
    for k in range(int(n.max())):
        due = np.where(k < n, payment * factor, 0.0)
        worth, moment = worth + due, moment + due * (share + k)
        factor = factor / grown
    return np.where(wrong, NUM, moment / worth / a_year), grown


@toolpak("DURATION", Date, Date, Number, Number, Number, Number(default=0.0))
def macaulay_duration(settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any) -> Floats:
    """Macaulay duration, in years; `#NUM!` for negative rates."""
    return _duration(settlement, maturity, coupon, yield_, frequency, basis)[0]


@toolpak("MDURATION", Date, Date, Number, Number, Number, Number(default=0.0))
def modified_duration(settlement: Any, maturity: Any, coupon: Any, yield_: Any, frequency: Any, basis: Any) -> Floats:
    """Macaulay duration by the growth of a period: how much of its price a bond loses as the yield rises."""
    duration, grown = _duration(settlement, maturity, coupon, yield_, frequency, basis)
    return duration / grown
