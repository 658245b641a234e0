"""The value of uneven payments, in equal periods or on any dates, and the rates at which it is 0.

Letters: n trials, k payments of a trial. In equal periods only the numbers of a range count, read row by row. With
dates blank cells do not count, and texts and logicals are `#VALUE!`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import error_where, first_error, first_error_in_row
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.financial.annuities import growth
from xlmc.excel.functions.financial.roots import growth_root
from xlmc.excel.functions.lookup.picked_cells import Indices, flatten_cells
from xlmc.excel.functions.registry import Anything, Arrays, Cells, excel
from xlmc.excel.functions.samples import join_samples, sample_of
from xlmc.excel.functions.toolpak import OneCell, strict_numbers, whole_days
from xlmc.excel.functions.values import BLANK, Bools, Codes, Floats, Value

__all__: list[str] = []


def _single(value: Value) -> tuple[Floats, Codes]:
    """Return a number per trial, and its error: (n,) each."""
    x, errors = value.to_numbers()
    return flatten_cells(x, value)[:, 0], flatten_cells(errors, value)[:, 0]


def _read_payments(values: Sequence[Value]) -> tuple[Floats, Bools, Codes]:
    """Return the payments, which of them count, and the first error: (n, k), (n, k), (n,)."""
    sample = join_samples([sample_of(value) for value in values])
    return sample.x, sample.counts, sample.errors


def _present_value(rate: Floats, flows: Floats, counts: Bools) -> Floats:
    """Present value, the first payment one period from now: (n,), (n, k) -> (n,)."""
    total = np.zeros(1)
    factor = np.ones(1)
    for column in range(flows.shape[1]):
        factor = np.where(counts[:, column], factor / (1 + rate), factor)
        total = total + np.where(counts[:, column], flows[:, column] * factor, 0.0)
    return total


@excel("NPV", Anything, Cells(repeat=True), facts=Facts(empty_cells=EmptyCells.IGNORED))
def net_present_value(rate: Value, *values: Value) -> Value:
    """Present value of payments at the ends of the periods to come; `#DIV/0!` at a rate of -100 %."""
    r, r_errors = rate.to_numbers()
    flows, counts, errors = _read_payments(values)
    if r.ndim == 3:
        cells = [_present_value(r[:, i, j], flows, counts) for i, j in np.ndindex(*r.shape[1:])]
        result = np.stack(np.broadcast_arrays(*cells), axis=1).reshape(-1, *r.shape[1:])
        errors = errors.reshape(-1, 1, 1)
    else:
        result = _present_value(r, flows, counts)
    return Value.of_numbers(result, first_error(r_errors, errors, error_where(r == -1, ErrorCode.DIV0)))


def _pack_payments(flows: Floats, counts: Bools) -> tuple[Floats, Indices]:
    """Each trial's payments, from the first to the last that is not 0, moved to the left; and how many there are."""
    alive = counts & (flows != 0)
    begun = np.logical_or.accumulate(alive, axis=1)
    to_come = np.logical_or.accumulate(alive[:, ::-1], axis=1)[:, ::-1]
    used = counts & begun & to_come
    order = np.argsort(~used, axis=1, kind="stable")
    return np.take_along_axis(np.where(used, flows, 0.0), order, axis=1), used.sum(axis=1)


def _has_both_signs(flows: Floats, counts: Bools) -> Bools:
    """Whether money is both paid and received: (n, k), (n, k) -> (n,)."""
    return np.asarray((counts & (flows > 0)).any(axis=1) & (counts & (flows < 0)).any(axis=1))


@excel("IRR", Arrays, Anything(default=None), facts=Facts(empty_cells=EmptyCells.IGNORED))
def internal_rate(values: Value, guess: Value | None = None) -> Value:
    """Rate at which the present value of the payments is 0; of several, the one nearest to the guess (10 %).

    `#NUM!` where there is none or the payments are all of one sign.
    """
    flows, counts, errors = _read_payments([values.as_range()])
    start, start_errors = _read_guess(guess)
    n = max(flows.shape[0], start.shape[0])
    packed, how_many = _pack_payments(flows, counts)
    k = packed.shape[1]

    def worth(x: Floats) -> Floats:
        """Return the value at the first payment for positive rates, at the last for negative ones: no factor
        exceeds 1.
        """
        step = np.exp(-np.abs(x))
        at_first = at_last = np.zeros(1)
        for column in range(k):
            at_last = np.where(column < how_many, at_last * step + packed[:, column], at_last)
            at_first = at_first * step + packed[:, k - 1 - column]
        return np.where(x >= 0, at_first, at_last)

    rate = growth_root(worth, np.broadcast_to(start, (n,)))
    rate = np.where(_has_both_signs(flows, counts), rate, np.nan)
    return Value.of_numbers(rate, first_error(np.broadcast_to(errors, (n,)), start_errors))


def _read_guess(guess: Value | None) -> tuple[Floats, Codes]:
    """Return the guess of a rate, 10 % if it is left out, and its errors: (n,) each."""
    return (np.full(1, 0.1), np.zeros(1, np.uint8)) if guess is None else _single(guess)


@excel("MIRR", Arrays, Anything, Anything, facts=Facts(empty_cells=EmptyCells.IGNORED))
def modified_rate(values: Value, finance: Value, reinvest: Value) -> Value:
    """Rate when what is paid is borrowed at one rate and what is received is invested at another.

    `#DIV/0!` unless something is paid, and at a rate of -100 %; where nothing is received, Excel gives -100 %.
    """
    flows, counts, errors = _read_payments([values.as_range()])
    (borrowed, borrowed_errors), (invested, invested_errors) = _single(finance), _single(reinvest)
    paid = _present_value(borrowed, np.minimum(flows, 0.0), counts) * (1 + borrowed)
    k = counts.sum(axis=1)
    received = _present_value(invested, np.maximum(flows, 0.0), counts) * growth(invested, k)
    pays = (counts & (flows < 0)).any(axis=1)
    receives = (counts & (flows > 0)).any(axis=1)
    ratio = np.where(pays, -received / np.where(paid == 0, np.nan, paid), 1.0)
    rate = np.where(receives, np.expm1(np.log(np.where(receives, ratio, 1.0)) / np.where(k > 1, k - 1, 1)), -1.0)
    divided = error_where(~pays | (k < 2) | (borrowed == -1) | (invested == -1), ErrorCode.DIV0)
    return Value.of_numbers(rate, first_error(errors, borrowed_errors, invested_errors, divided))


def _date_payments(values: Value, dates: Value, date1904: bool) -> tuple[Floats, Floats, Codes]:
    """Return the payments, the years from the first date to each, (n, k) each, and the errors, (n,).

    `#NUM!` for a date before the first, for dates and payments of unequal number, and where there are none.
    """
    flows, how_many, errors = _pack_numbers(values)
    serials, how_many_dates, date_errors = _pack_numbers(dates)
    k = min(flows.shape[1], serials.shape[1])
    dated = np.arange(k) < how_many_dates[:, None]
    days, valid = whole_days(np.where(dated, serials[:, :k], serials[:, :1]), date1904)
    years = (days - days[:, :1]) / 365
    wrong = (how_many != how_many_dates) | (how_many == 0) | ~valid.all(axis=1) | (years < 0).any(axis=1)
    return flows[:, :k], np.maximum(years, 0.0), first_error(errors, date_errors, error_where(wrong, ErrorCode.NUM))


def _pack_numbers(value: Value) -> tuple[Floats, Indices, Codes]:
    """Return the numbers of the cells that are not blank, moved to the left; how many there are; and the
    first error.
    """
    x, errors = strict_numbers(value)
    filled = flatten_cells(value.kinds != BLANK, value)
    order = np.argsort(~filled, axis=1, kind="stable")
    packed = np.take_along_axis(np.where(filled, flatten_cells(x, value), 0.0), order, axis=1)
    return packed, filled.sum(axis=1), first_error_in_row(flatten_cells(errors, value))


@excel("XNPV", OneCell, Cells, Cells, dated=True)
def dated_present_value(rate: Value, values: Value, dates: Value, *, date1904: bool = False) -> Value:
    """Value on the first date of payments on dates, in years of 365 days; `#NUM!` unless the rate is above 0."""
    r, rate_errors = (flatten_cells(part, rate)[:, 0] for part in strict_numbers(rate))
    flows, years, errors = _date_payments(values, dates, date1904)
    lost = r <= 0
    log_growth = np.log1p(np.where(lost, 0.0, r))
    total = np.zeros(1)
    for column in range(flows.shape[1]):
        total = total + flows[:, column] * np.exp(-years[:, column] * log_growth)
    return Value.of_numbers(total, first_error(rate_errors, errors, error_where(lost, ErrorCode.NUM)))


@excel("XIRR", Cells, Cells, OneCell(default=None), dated=True)
def dated_rate(values: Value, dates: Value, guess: Value | None = None, *, date1904: bool = False) -> Value:
    """Rate at which the value of payments on dates is 0; of several, the one nearest to the guess (10 %).

    `#NUM!` where there is none or the payments are all of one sign.
    """
    flows, years, errors = _date_payments(values, dates, date1904)
    start, start_errors = _read_guess(guess)
    n = max(flows.shape[0], years.shape[0], start.shape[0])
    alive = flows != 0
    first = np.where(alive, years, np.inf).min(axis=1, keepdims=True)
    last = np.where(alive, years, -np.inf).max(axis=1, keepdims=True)

    def worth(x: Floats) -> Floats:
        """Return the value on the first day for positive rates, on the last for negative ones: no factor exceeds 1."""
        total = np.zeros(1)
        for column in range(flows.shape[1]):
            since, until = years[:, column] - first[:, 0], last[:, 0] - years[:, column]
            factor = np.exp(-np.abs(x) * np.where(x >= 0, since, until))
            total = total + np.where(alive[:, column], flows[:, column] * factor, 0.0)
        return total

    usable = _has_both_signs(flows, np.ones_like(alive)) & (errors == 0)
    rate = growth_root(worth, np.broadcast_to(start, (n,)))
    return Value.of_numbers(np.where(usable, rate, np.nan), first_error(np.broadcast_to(errors, (n,)), start_errors))
