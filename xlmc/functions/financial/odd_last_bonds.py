"""Bonds in an odd last coupon period. Dates are serials of the 1900 system, amounts are per 100 of face value.

The period is cut into *quasi-coupon* periods, as the coupons would fall if they went on. In sums over them each counts
by its own length. What Excel's documentation leaves open follows values that Excel computed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.day_count import by_basis, days_between, is_basis, us_360
from xlmc.functions.dates.months import months_later
from xlmc.functions.financial.coupons import Coupons, is_frequency, months_between
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Bools, Floats

__all__: list[str] = []


def _days(start: Any, end: Any, basis: Any) -> Floats:
    """Days between two dates, none if they come in the wrong order."""
    return np.maximum(days_between(start, end, basis), 0.0)


def _odd_last(
    settlement: Any, maturity: Any, last: Any, rate: Any, redemption: Any, frequency: Any, basis: Any
) -> tuple[Floats, Floats, Floats, Bools]:
    """What is paid at maturity, accrued interest, years from settlement to it, and where Excel refuses the bond."""
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
    """As `_days`; by the US way the end of February is a 30th at both ends."""

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
