"""US Treasury bills: bought at a discount, on years of 360 days, and paid back at 100 within a year."""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.functions.dates.months import months_later
from xlmc.functions.registry import Number
from xlmc.functions.toolpak_rows import Date, toolpak
from xlmc.functions.values import NUM, Bools, Floats

__all__: list[str] = []

_HALF_A_YEAR = 182


def _refused(settlement: Any, maturity: Any, amount: Any) -> Bools:
    too_long = maturity > months_later(settlement, 12)
    return np.asarray(too_long | np.less_equal(maturity, settlement) | (np.asarray(amount) <= 0))


@toolpak("TBILLPRICE", Date, Date, Number)
def bill_price(settlement: Any, maturity: Any, discount: Any) -> Floats:
    """Price at a discount a year; `#NUM!` where it comes to less than 0."""
    price = 100 * (1 - discount * (maturity - settlement) / 360)
    return np.where(_refused(settlement, maturity, discount) | (price < 0), NUM, price)


@toolpak("TBILLYIELD", Date, Date, Number)
def bill_yield(settlement: Any, maturity: Any, pr: Any) -> Floats:
    """Yield a year at a price."""
    wrong = _refused(settlement, maturity, pr)
    days = np.where(wrong, 1.0, np.subtract(maturity, settlement))
    return np.where(wrong, NUM, (100 - pr) / np.where(wrong, 1.0, pr) * 360 / days)


@toolpak("TBILLEQ", Date, Date, Number)
def bond_equivalent_yield(settlement: Any, maturity: Any, discount: Any) -> Floats:
    """Yield of a bond with two coupons a year that is worth as much.

    Beyond half a year of t days of 365 (366 for t = 366), with x = t/365 and the price P of one unit, it solves
    (1 + y/2)·(1 + y·(x - 1/2)) = 1/P.
    """
    wrong = _refused(settlement, maturity, discount)
    days = np.where(wrong, 1.0, np.subtract(maturity, settlement))
    price = 1 - discount * days / 360
    wrong = wrong | (price <= 0)
    simple = 365 * discount / (360 * np.where(wrong, 1.0, price))
    x = days / np.where(days == 366, 366, 365)
    term = np.where(days > _HALF_A_YEAR, 2 * x - 1, 1.0)
    root = np.sqrt(np.maximum(x * x - term * (1 - 1 / np.where(wrong, 1.0, price)), 0.0))
    return np.where(wrong, NUM, np.where(days > _HALF_A_YEAR, 2 * (root - x) / term, simple))
