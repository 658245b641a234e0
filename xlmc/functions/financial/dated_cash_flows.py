"""What payments on any dates are worth, and the rates at which they are worth nothing.

Letters: n trials, k payments of a trial. Blank cells do not count, texts and logicals are `#VALUE!`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import earliest, first_errors, where_wrong
from xlmc.functions.financial.cash_flows import guess_of, has_both_signs, rows
from xlmc.functions.financial.roots import growth_root
from xlmc.functions.registry import Cells, excel
from xlmc.functions.toolpak import OneCell, strict_numbers
from xlmc.functions.toolpak_rows import whole_days
from xlmc.functions.values import BLANK, Codes, Floats, Value

__all__: list[str] = []


def _dated(values: Value, dates: Value, date1904: bool) -> tuple[Floats, Floats, Codes]:
    """Payments and years after the first: (n, k) each; and errors (n,).

    `#NUM!` for a date before the first, for dates and payments of unequal number, and where there are none.
    """
    flows, how_many, errors = _filled(values)
    serials, how_many_dates, date_errors = _filled(dates)
    k = min(flows.shape[1], serials.shape[1])
    dated = np.arange(k) < how_many_dates[:, None]
    days, valid = whole_days(np.where(dated, serials[:, :k], serials[:, :1]), date1904)
    years = (days - days[:, :1]) / 365
    wrong = (how_many != how_many_dates) | (how_many == 0) | ~valid.all(axis=1) | (years < 0).any(axis=1)
    return flows[:, :k], np.maximum(years, 0.0), earliest(errors, date_errors, where_wrong(wrong, ErrorCode.NUM))


def _filled(value: Value) -> tuple[Floats, NDArray[np.intp], Codes]:
    """The numbers of all cells but blank ones, at the left, with zeros behind; how many; the first error."""
    x, errors = strict_numbers(value)
    filled = rows(value.kinds != BLANK, value)
    order = np.argsort(~filled, axis=1, kind="stable")
    packed = np.take_along_axis(np.where(filled, rows(x, value), 0.0), order, axis=1)
    return packed, filled.sum(axis=1), first_errors(rows(errors, value))


@excel("XNPV", OneCell, Cells, Cells, dated=True)
def dated_present_value(rate: Value, values: Value, dates: Value, *, date1904: bool = False) -> Value:
    """Worth, on the first date, of payments on dates, by years of 365 days; `#NUM!` unless the rate is above 0."""
    r, rate_errors = (rows(a, rate)[:, 0] for a in strict_numbers(rate))
    flows, years, errors = _dated(values, dates, date1904)
    lost = r <= 0
    log_growth = np.log1p(np.where(lost, 0.0, r))
    total = np.zeros(1)
    for column in range(flows.shape[1]):
        total = total + flows[:, column] * np.exp(-years[:, column] * log_growth)
    return Value.of_numbers(total, earliest(rate_errors, errors, where_wrong(lost, ErrorCode.NUM)))


@excel("XIRR", Cells, Cells, OneCell(default=None), dated=True)
def dated_rate(values: Value, dates: Value, guess: Value | None = None, *, date1904: bool = False) -> Value:
    """Rate at which payments on dates are worth nothing; of several, the one nearest to the guess (10 %).

    `#NUM!` where there is none or the payments are all of one sign.
    """
    flows, years, errors = _dated(values, dates, date1904)
    start, start_errors = guess_of(guess)
    n = max(flows.shape[0], years.shape[0], start.shape[0])
    alive = flows != 0
    first = np.where(alive, years, np.inf).min(axis=1, keepdims=True)
    last = np.where(alive, years, -np.inf).max(axis=1, keepdims=True)

    def worth(x: Floats) -> Floats:
        """On the first day for positive rates, on the last for negative ones, so that nothing grows."""
        total = np.zeros(1)
        for column in range(flows.shape[1]):
            since, until = years[:, column] - first[:, 0], last[:, 0] - years[:, column]
            factor = np.exp(-np.abs(x) * np.where(x >= 0, since, until))
            total = total + np.where(alive[:, column], flows[:, column] * factor, 0.0)
        return total

    usable = has_both_signs(flows, np.ones_like(alive)) & (errors == 0)
    rate = growth_root(worth, np.broadcast_to(start, (n,)))
    return Value.of_numbers(np.where(usable, rate, np.nan), earliest(np.broadcast_to(errors, (n,)), start_errors))
