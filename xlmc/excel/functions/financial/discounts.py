"""Securities that pay once, at maturity; among them US Treasury bills.

Dates are serials of the 1900 system, time is in years by the day count. Treasury bills are bought at a discount, which
counts 360 days a year, and paid back at 100 within a year.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from xlmc.excel.functions.dates.day_count import days_between, days_in_year, is_basis, months_later
from xlmc.excel.functions.registry import Number
from xlmc.excel.functions.toolpak import Date, toolpak
from xlmc.excel.functions.values import NUM, Bools, Floats

__all__: list[str] = []


def _years(start: Any, end: Any, basis: Any) -> tuple[Floats, Bools]:
    """Years between two dates, and where they are refused: `end` is not after `start`, or there is no such basis."""
    wrong = ~is_basis(basis) | np.less_equal(end, start)
    days = days_between(start, end, basis)
    return np.where(wrong | (days == 0), np.nan, days / days_in_year(start, end, basis)), wrong


def _all_positive(*amounts: Any) -> Bools:
    """Return the trials in which all numbers are above 0."""
    result = np.ones(1, bool)
    for amount in amounts:
        result = result & (np.asarray(amount) > 0)
    return result


@toolpak("DISC", Date, Date, Number, Number, Number(default=0.0))
def discount_rate(settlement: Any, maturity: Any, pr: Any, redemption: Any, basis: Any) -> Floats:
    """Yearly discount, as a share of the redemption value."""
    years, wrong = _years(settlement, maturity, basis)
    wrong = wrong | ~_all_positive(pr, redemption)
    return np.where(wrong, NUM, (redemption - pr) / np.where(wrong, 1.0, redemption) / years)


@toolpak("INTRATE", Date, Date, Number, Number, Number(default=0.0))
def interest_rate(settlement: Any, maturity: Any, investment: Any, redemption: Any, basis: Any) -> Floats:
    """Yearly simple interest, as a share of the investment."""
    years, wrong = _years(settlement, maturity, basis)
    wrong = wrong | ~_all_positive(investment, redemption)
    return np.where(wrong, NUM, (redemption - investment) / np.where(wrong, 1.0, investment) / years)


@toolpak("PRICEDISC", Date, Date, Number, Number, Number(default=0.0))
def discounted_price(settlement: Any, maturity: Any, discount: Any, redemption: Any, basis: Any) -> Floats:
    """Price at a yearly discount."""
    years, wrong = _years(settlement, maturity, basis)
    return np.where(wrong | ~_all_positive(discount, redemption), NUM, redemption * (1 - discount * years))


@toolpak("RECEIVED", Date, Date, Number, Number, Number(default=0.0))
def amount_received(settlement: Any, maturity: Any, investment: Any, discount: Any, basis: Any) -> Floats:
    """Return what is paid back at maturity; `#NUM!` where the discount takes all."""
    years, wrong = _years(settlement, maturity, basis)
    left = 1 - discount * years
    return np.where(
        wrong | ~_all_positive(investment, discount, left), NUM, investment / np.where(left == 0, np.nan, left)
    )


@toolpak("YIELDDISC", Date, Date, Number, Number, Number(default=0.0))
def discounted_yield(settlement: Any, maturity: Any, pr: Any, redemption: Any, basis: Any) -> Floats:
    """Yearly yield of a discounted security."""
    return interest_rate(settlement, maturity, pr, redemption, basis)


@toolpak("ACCRINTM", Date, Date, Number, Number(default=1000.0), Number(default=0.0))
def interest_at_maturity(issue: Any, settlement: Any, rate: Any, par: Any, basis: Any) -> Floats:
    """Interest from issue to maturity, all of it paid at maturity."""
    years, wrong = _years(issue, settlement, basis)
    return np.where(wrong | ~_all_positive(rate, par), NUM, par * rate * years)


def _years_from_issue(settlement: Any, maturity: Any, issue: Any, basis: Any) -> tuple[Floats, Floats, Bools]:
    """Years from issue to maturity and to settlement, and where the dates are wrong.

    Both count in the length of a year that the basis gives from issue to settlement.
    """
    wrong = ~is_basis(basis) | np.less_equal(maturity, settlement) | np.less(settlement, issue)
    year = days_in_year(issue, settlement, basis)
    return days_between(issue, maturity, basis) / year, days_between(issue, settlement, basis) / year, wrong


@toolpak("PRICEMAT", Date, Date, Date, Number, Number, Number(default=0.0))
def price_with_interest_at_maturity(
    settlement: Any, maturity: Any, issue: Any, rate: Any, yield_: Any, basis: Any
) -> Floats:
    """Price per 100 of a security that pays its interest at maturity; `#NUM!` for negative rates."""
    to_maturity, to_settlement, wrong = _years_from_issue(settlement, maturity, issue, basis)
    wrong = wrong | (np.asarray(rate) < 0) | (np.asarray(yield_) < 0)
    paid_back = 100 * (1 + to_maturity * rate)
    return np.where(wrong, NUM, paid_back / (1 + (to_maturity - to_settlement) * yield_) - 100 * to_settlement * rate)


@toolpak("YIELDMAT", Date, Date, Date, Number, Number, Number(default=0.0))
def yield_with_interest_at_maturity(
    settlement: Any, maturity: Any, issue: Any, rate: Any, pr: Any, basis: Any
) -> Floats:
    """Yearly yield of a security that pays its interest at maturity."""
    to_maturity, to_settlement, wrong = _years_from_issue(settlement, maturity, issue, basis)
    wrong = wrong | (np.asarray(rate) < 0) | ~_all_positive(pr)
    paid = np.where(wrong, 1.0, np.asarray(pr) / 100 + to_settlement * rate)
    ahead = to_maturity - to_settlement
    return np.where(wrong, NUM, ((1 + to_maturity * rate) / paid - 1) / np.where(ahead == 0, np.nan, ahead))


_HALF_A_YEAR = 182


def _is_bill_refused(settlement: Any, maturity: Any, amount: Any) -> Bools:
    too_long = maturity > months_later(settlement, 12)
    return np.asarray(too_long | np.less_equal(maturity, settlement) | (np.asarray(amount) <= 0))


@toolpak("TBILLPRICE", Date, Date, Number)
def bill_price(settlement: Any, maturity: Any, discount: Any) -> Floats:
    """Price at a yearly discount; `#NUM!` where it is below 0."""
    price = 100 * (1 - discount * (maturity - settlement) / 360)
    return np.where(_is_bill_refused(settlement, maturity, discount) | (price < 0), NUM, price)


@toolpak("TBILLYIELD", Date, Date, Number)
def bill_yield(settlement: Any, maturity: Any, pr: Any) -> Floats:
    """Yearly yield at a price."""
    wrong = _is_bill_refused(settlement, maturity, pr)
    days = np.where(wrong, 1.0, np.subtract(maturity, settlement))
    return np.where(wrong, NUM, (100 - pr) / np.where(wrong, 1.0, pr) * 360 / days)


@toolpak("TBILLEQ", Date, Date, Number)
def bond_equivalent_yield(settlement: Any, maturity: Any, discount: Any) -> Floats:
    """Yield of a bond with two coupons a year that is worth as much.

    Beyond half a year of t days of 365 (366 for t = 366), with x = t/365 and the price P of one unit, it solves
    (1 + y/2)·(1 + y·(x - 1/2)) = 1/P.
    """
    wrong = _is_bill_refused(settlement, maturity, discount)
    days = np.where(wrong, 1.0, np.subtract(maturity, settlement))
    price = 1 - discount * days / 360
    wrong = wrong | (price <= 0)
    simple = 365 * discount / (360 * np.where(wrong, 1.0, price))
    x = days / np.where(days == 366, 366, 365)
    term = np.where(days > _HALF_A_YEAR, 2 * x - 1, 1.0)
    root = np.sqrt(np.maximum(x * x - term * (1 - 1 / np.where(wrong, 1.0, price)), 0.0))
    return np.where(wrong, NUM, np.where(days > _HALF_A_YEAR, 2 * (root - x) / term, simple))
