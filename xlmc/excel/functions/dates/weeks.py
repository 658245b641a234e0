"""Days of the week, weeks of the year, and work days: all days but weekends and holidays.

Where work days are counted, letters are n trials, m cells of an argument in an array formula (1 elsewhere), h holidays
of a trial; days of the week are numbered from 0 for Monday, and dates are serials of the 1900 system.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import align_ranges, error_where, first_error, first_error_in_row
from xlmc.excel.functions.dates.calendar import in_calendar, parts_of, serial_of, weekday_of
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.registry import Anything, Cells, Number, excel
from xlmc.excel.functions.toolpak import DAYS_TO_1904, Date, OneCell, strict_numbers, toolpak, whole_days
from xlmc.excel.functions.values import BLANK, NUM, Bools, Codes, Floats, Value, constant

__all__ = ["Weeks", "worked_days"]

_ISO: Final = 21
"""Excel's number for weeks as ISO 8601 counts them."""

_WEEK_STARTS: Final = {1: 0, 2: 1, 11: 1, 12: 2, 13: 3, 14: 4, 15: 5, 16: 6, 17: 0}
"""The day on which the week starts, 0 for Sunday, by Excel's `return_type`."""


def _week_start(kind: Any) -> Floats:
    """Return the day on which the week starts; NaN for an unknown kind."""
    whole = np.floor(kind)
    return np.select([whole == known for known in _WEEK_STARTS], list(_WEEK_STARTS.values()), np.nan)


@excel("WEEKDAY", Number, Number(default=1.0), dated=True)
def weekday(serial: Any, kind: Any, *, date1904: bool = False) -> Floats:
    """Return the number of the day in its week, from 1; with kind 3 from 0 for Monday."""
    from_monday = np.floor(kind) == 3
    start = np.where(from_monday, 1.0, _week_start(kind))
    inside = in_calendar(np.asarray(serial), date1904)
    number = (weekday_of(np.where(inside, serial, 1.0), date1904) - start) % 7
    return np.where(inside, number + np.where(from_monday, 0, 1), NUM)


@toolpak("WEEKNUM", Date, Number(default=1.0))
def week_number(serial: Any, kind: Any) -> Floats:
    """Return the number of the week in the year, 1 for that of 1 January; kind 21 counts as ISO 8601 does."""
    year = parts_of(serial)[0]
    new_year = serial_of(year, 1, 1)
    shift = (weekday_of(new_year) - _week_start(kind)) % 7
    return np.where(np.floor(kind) == _ISO, _iso_week(serial), np.floor((np.floor(serial) - new_year + shift) / 7) + 1)


def _iso_week(serial: Any) -> Floats:
    """Return the week by ISO 8601, 1 for that of the year's first Thursday; serials are of the 1900 system."""
    thursday = np.floor(serial) + 3 - (weekday_of(serial) - 1) % 7
    new_year = serial_of(parts_of(thursday)[0], 1, 1)
    return np.asarray(np.floor((thursday - new_year) / 7) + 1)


@excel("ISOWEEKNUM", Number, dated=True)
def iso_week_number(serial: Any, *, date1904: bool = False) -> Floats:
    """Return the number of the week in the year by ISO 8601."""
    inside = in_calendar(np.asarray(serial), date1904)
    return np.where(inside, _iso_week(np.where(inside, serial, 1.0) + (DAYS_TO_1904 if date1904 else 0)), NUM)


_WEEKENDS: Final = {
    **{code: {(code + 4) % 7, (code + 5) % 7} for code in range(1, 8)},
    **{code: {(code - 5) % 7} for code in range(11, 18)},
}
"""The days off for each of Excel's numbers of weekends: 1 is Saturday and Sunday, 11 is Sunday, and so on."""

_A_MONDAY: Final = 2
"""The serial of 2 January 1900, a Monday in Excel, from which work days are counted."""


def worked_days(weekend: Value) -> tuple[Bools, Codes]:
    """Return which days of the week are worked, in the shape of the argument followed by 7; and errors."""
    known: dict[object, tuple[bool, ...] | ErrorCode] = {}
    items = weekend.objects()
    worked, errors = np.ones((*items.shape, 7), bool), np.zeros(items.shape, np.uint8)
    for index in np.ndindex(*items.shape):
        item = items[index]
        key = (type(item), item)
        if key not in known:
            known[key] = _read_weekend(item)
        result = known[key]
        if isinstance(result, ErrorCode):
            errors[index] = result
        else:
            worked[index] = result
    return worked, errors


def _read_weekend(item: object) -> tuple[bool, ...] | ErrorCode:
    """Return which days of the week are worked, for a number of `_WEEKENDS` or a text of seven 0s and 1s (off)."""
    match item:
        case None:
            return _read_weekend(1.0)
        case ErrorCode():
            return item
        case str():
            is_mask = len(item) == 7 and set(item) <= {"0", "1"}
            return tuple(mark == "0" for mark in item) if is_mask else ErrorCode.VALUE
        case bool():
            return ErrorCode.VALUE
        case float() if np.floor(item) in _WEEKENDS:
            return tuple(day not in _WEEKENDS[int(item)] for day in range(7))
        case _:
            return ErrorCode.NUM


class Weeks:
    """Counts work days by weekends, without holidays.

    Attributes:
        worked: (n, m, 7).
        a_week: how many work days a week has, at least 1 so that one can divide by it, (n, m).
        none: where a week has no work day, (n, m).
    """

    def __init__(self, worked: Bools) -> None:
        self.worked = worked
        self.none: Bools = np.asarray(~worked.any(axis=-1))
        self.a_week = np.maximum(worked.sum(axis=-1), 1)
        self._before: NDArray[np.intp] = np.cumsum(worked, axis=-1) - worked
        self._order = np.argsort(~worked, axis=-1, kind="stable")

    def count_before(self, day: Floats) -> Floats:
        """Count the work days from `_A_MONDAY` until before a day, negative for earlier days: (n, m) -> (n, m)."""
        weeks, weekday = np.divmod(day - _A_MONDAY, 7)
        return np.asarray(weeks * self.a_week + _look_up_day(self._before, weekday))

    def day_at_count(self, number: Floats) -> Floats:
        """Return the work day for which `count_before` gives this number."""
        weeks, rest = np.divmod(number, self.a_week)
        return np.asarray(_A_MONDAY + weeks * 7 + _look_up_day(self._order, rest))

    def is_worked(self, day: Floats) -> Bools:
        return _look_up_day(self.worked, np.mod(day - _A_MONDAY, 7)).astype(bool)


def _look_up_day(table: NDArray[Any], weekday: Floats) -> NDArray[Any]:
    """Return from tables (n, m, 7) the entry of a day of the week, (n, m)."""
    shape = np.broadcast_shapes(table.shape[:-1], weekday.shape)
    spread = np.broadcast_to(table, (*shape, 7))
    return np.take_along_axis(spread, np.broadcast_to(weekday, shape)[..., None].astype(np.intp), axis=-1)[..., 0]


def _read_holidays(value: Value | None, date1904: bool) -> tuple[Floats, Codes]:
    """Read the holidays of each trial, each once, in rising order, then infinities: (n, h); and errors, (n,)."""
    if value is None:
        return np.full((1, 0), np.inf), np.zeros(1, np.uint8)
    x, errors = strict_numbers(value)
    x, errors, blank = (
        np.broadcast_to(array, value.shape).reshape(value.shape[0], -1) for array in (x, errors, value.kinds == BLANK)
    )
    days, valid = whole_days(x, date1904)
    errors = np.where(errors > 0, errors, error_where(~valid & ~blank, ErrorCode.NUM))
    days = np.sort(np.where(blank, np.inf, days), axis=1)
    again = np.zeros(days.shape, bool)
    again[:, 1:] = days[:, 1:] == days[:, :-1]
    return np.where(again, np.inf, days), first_error_in_row(errors)


def _count_holidays(weeks: Weeks, holidays: Floats, first: Floats, last: Floats) -> Floats:
    """Count the holidays from one day to another that fall on work days: (n, m)."""
    total = np.zeros((1, 1))
    for column in range(holidays.shape[1]):
        day = holidays[:, column : column + 1]
        finite = np.isfinite(day)
        known = np.where(finite, day, 0.0)
        total = total + (finite & (day >= first) & (day <= last) & weeks.is_worked(known))
    return total


def _count_work_days(weeks: Weeks, holidays: Floats, start: Floats, end: Floats) -> Floats:
    """Count the work days from one day to another, including both; negative if the end comes first."""
    first, last = np.minimum(start, end), np.maximum(start, end)
    count = weeks.count_before(last + 1) - weeks.count_before(first) - _count_holidays(weeks, holidays, first, last)
    return np.where(weeks.none, 0.0, np.where(end < start, -count, count))


def _move(weeks: Weeks, holidays: Floats, start: Floats, days: Floats) -> Floats:
    """Return the work day so many work days after a day, or before it if negative; the day itself for 0.

    Each holiday that is passed moves the result on by a day, which may pass further holidays.
    """
    forward = days > 0
    passed = np.zeros((1, 1))
    for _ in range(holidays.shape[1] + 1):
        ahead = weeks.day_at_count(weeks.count_before(start + 1) + days + passed - 1)
        behind = weeks.day_at_count(weeks.count_before(start) + days - passed)
        result = np.where(forward, ahead, behind)
        first, last = np.where(forward, start + 1, result), np.where(forward, result, start - 1)
        values = _count_holidays(weeks, holidays, first, last)
        if (values == passed).all():
            break
        passed = values
    return np.where(days == 0, start, result)


_Rule = Callable[[Weeks, Floats, Floats, Floats], tuple[Floats, Codes]]
"""Takes weeks, holidays and two numbers, (n, m); gives a number and an error."""


def _apply(rule: _Rule, start: Value, other: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    """Apply a rule to a date, a number, a weekend and holidays; the first three broadcast to the result's shape."""
    values = align_ranges(start, other, weekend)
    shape = np.broadcast_shapes(*(value.shape for value in values))
    (x, x_errors), (y, y_errors) = strict_numbers(values[0]), strict_numbers(values[1])
    worked, weekend_errors = worked_days(values[2])
    days_off, holiday_errors = _read_holidays(holidays, date1904)
    result, wrong = rule(Weeks(_flatten(worked, (*shape, 7))), days_off, _flatten(x, shape), _flatten(y, shape))
    of_arguments = [_flatten(errors, shape) for errors in (x_errors, y_errors, weekend_errors)]
    result, errors = np.broadcast_arrays(result, first_error(*of_arguments, holiday_errors[:, None], wrong))
    return Value.of_numbers(result.reshape(-1, *shape[1:]), errors.reshape(-1, *shape[1:]))


def _flatten(array: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """Turn (n,) or (n, r, c) into (n, m); a further axis of 7 stays."""
    behind = shape[-1:] if len(shape) in (2, 4) else ()
    return np.broadcast_to(array, shape).reshape(shape[0], -1, *behind)


def _network_days(start: Value, end: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    def rule(weeks: Weeks, days_off: Floats, x: Floats, y: Floats) -> tuple[Floats, Codes]:
        (first, first_valid), (last, last_valid) = whole_days(x, date1904), whole_days(y, date1904)
        wrong = error_where(~(first_valid & last_valid), ErrorCode.NUM)
        return _count_work_days(weeks, days_off, first, last), wrong

    return _apply(rule, start, end, weekend, holidays, date1904)


def _work_day(start: Value, days: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    def rule(weeks: Weeks, days_off: Floats, x: Floats, y: Floats) -> tuple[Floats, Codes]:
        first, valid = whole_days(x, date1904)
        result = _move(weeks, days_off, first, np.trunc(y)) - (DAYS_TO_1904 if date1904 else 0)
        outside = error_where(np.asarray(~(valid & in_calendar(result, date1904))), ErrorCode.NUM)
        return result, first_error(error_where(weeks.none, ErrorCode.VALUE), outside)

    return _apply(rule, start, days, weekend, holidays, date1904)


_SATURDAY_AND_SUNDAY: Final = constant(1.0)


@excel("NETWORKDAYS", OneCell, OneCell, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def network_days(start: Value, end: Value, holidays: Value | None = None, *, date1904: bool = False) -> Value:
    """Work days from one date to another, including both; negative if the end comes first."""
    return _network_days(start, end, _SATURDAY_AND_SUNDAY, holidays, date1904)


@excel(
    "NETWORKDAYS.INTL",
    OneCell,
    OneCell,
    Anything(default=None),
    Cells(default=None),
    dated=True,
    facts=Facts(empty_cells=EmptyCells.IGNORED),
)
def network_days_international(
    start: Value,
    end: Value,
    weekend: Value = _SATURDAY_AND_SUNDAY,
    holidays: Value | None = None,
    *,
    date1904: bool = False,
) -> Value:
    """As `NETWORKDAYS`; the weekend is a number, or a text of seven marks from Monday on, 1 for a day off."""
    return _network_days(start, end, weekend, holidays, date1904)


@excel("WORKDAY", OneCell, OneCell, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def work_day(start: Value, days: Value, holidays: Value | None = None, *, date1904: bool = False) -> Value:
    """Return the work day so many work days after a date, or before it if negative; the date itself for 0."""
    return _work_day(start, days, _SATURDAY_AND_SUNDAY, holidays, date1904)


@excel(
    "WORKDAY.INTL",
    OneCell,
    OneCell,
    Anything(default=None),
    Cells(default=None),
    dated=True,
    facts=Facts(empty_cells=EmptyCells.IGNORED),
)
def work_day_international(
    start: Value,
    days: Value,
    weekend: Value = _SATURDAY_AND_SUNDAY,
    holidays: Value | None = None,
    *,
    date1904: bool = False,
) -> Value:
    """As `WORKDAY`; the weekend is a number, or a text of seven marks from Monday on; `#VALUE!` if all days are off."""
    return _work_day(start, days, weekend, holidays, date1904)
