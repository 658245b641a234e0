"""Days of work: all but weekends and holidays.

Letters: n trials, m cells of an argument in an array formula (1 elsewhere), h holidays of a trial. Dates are serials of
the 1900 system.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import earliest, first_errors, leveled, where_wrong
from xlmc.functions.dates.calendar import in_calendar
from xlmc.functions.dates.weeks import Weeks, worked_days
from xlmc.functions.facts import EmptyCells, Facts
from xlmc.functions.registry import Anything, Cells, excel
from xlmc.functions.toolpak import OneCell, strict_numbers
from xlmc.functions.toolpak_rows import DAYS_TO_1904, whole_days
from xlmc.functions.values import BLANK, Codes, Floats, Value, constant

__all__: list[str] = []


def _holidays(value: Value | None, date1904: bool) -> tuple[Floats, Codes]:
    """The holidays of each trial in rising order, each once, infinity for the rest: (n, h); and errors, (n,)."""
    if value is None:
        return np.full((1, 0), np.inf), np.zeros(1, np.uint8)
    x, errors = strict_numbers(value)
    x, errors, blank = (
        np.broadcast_to(array, value.shape).reshape(value.shape[0], -1) for array in (x, errors, value.kinds == BLANK)
    )
    days, valid = whole_days(x, date1904)
    errors = np.where(errors > 0, errors, where_wrong(~valid & ~blank, ErrorCode.NUM))
    days = np.sort(np.where(blank, np.inf, days), axis=1)
    again = np.zeros(days.shape, bool)
    again[:, 1:] = days[:, 1:] == days[:, :-1]
    return np.where(again, np.inf, days), first_errors(errors)


def _passed(weeks: Weeks, holidays: Floats, first: Floats, last: Floats) -> Floats:
    """How many holidays that would be worked lie from one day to another: (n, m)."""
    total = np.zeros((1, 1))
    for column in range(holidays.shape[1]):
        day = holidays[:, column : column + 1]
        finite = np.isfinite(day)
        known = np.where(finite, day, 0.0)
        total = total + (finite & (day >= first) & (day <= last) & weeks.is_worked(known))
    return total


def _counted(weeks: Weeks, holidays: Floats, start: Floats, end: Floats) -> Floats:
    """Days of work from one day to another, both counted, negative if the end comes first."""
    first, last = np.minimum(start, end), np.maximum(start, end)
    count = weeks.before(last + 1) - weeks.before(first) - _passed(weeks, holidays, first, last)
    return np.where(weeks.none, 0.0, np.where(end < start, -count, count))


def _moved(weeks: Weeks, holidays: Floats, start: Floats, days: Floats) -> Floats:
    """The day of work so many days of work after a day, or before it; the day itself for none.

    The holidays passed push the day on, which may pass more of them: once each at most.
    """
    forward = days > 0
    passed = np.zeros((1, 1))
    for _ in range(holidays.shape[1] + 1):
        ahead = weeks.numbered(weeks.before(start + 1) + days + passed - 1)
        behind = weeks.numbered(weeks.before(start) + days - passed)
        result = np.where(forward, ahead, behind)
        first, last = np.where(forward, start + 1, result), np.where(forward, result, start - 1)
        found = _passed(weeks, holidays, first, last)
        if (found == passed).all():
            break
        passed = found
    return np.where(days == 0, start, result)


Rule = Callable[[Weeks, Floats, Floats, Floats], tuple[Floats, Codes]]
"""From weeks, holidays and two numbers, (n, m), to a number and an error."""


def _by_weeks(rule: Rule, start: Value, other: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    """What a rule makes of a date, a number, a weekend and holidays, in the shape of the first three together."""
    values = leveled(start, other, weekend)
    shape = np.broadcast_shapes(*(value.shape for value in values))
    (x, x_errors), (y, y_errors) = strict_numbers(values[0]), strict_numbers(values[1])
    worked, weekend_errors = worked_days(values[2])
    days_off, holiday_errors = _holidays(holidays, date1904)
    result, wrong = rule(Weeks(_cells(worked, (*shape, 7))), days_off, _cells(x, shape), _cells(y, shape))
    of_arguments = [_cells(errors, shape) for errors in (x_errors, y_errors, weekend_errors)]
    result, errors = np.broadcast_arrays(result, earliest(*of_arguments, holiday_errors[:, None], wrong))
    return Value.of_numbers(result.reshape(-1, *shape[1:]), errors.reshape(-1, *shape[1:]))


def _cells(array: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """(n,), (n, r, c) or either with 7 behind as (n, m), with 7 behind."""
    behind = shape[-1:] if len(shape) in (2, 4) else ()
    return np.broadcast_to(array, shape).reshape(shape[0], -1, *behind)


def _network_days(start: Value, end: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    def rule(weeks: Weeks, days_off: Floats, x: Floats, y: Floats) -> tuple[Floats, Codes]:
        (first, first_valid), (last, last_valid) = whole_days(x, date1904), whole_days(y, date1904)
        wrong = where_wrong(~(first_valid & last_valid), ErrorCode.NUM)
        return _counted(weeks, days_off, first, last), wrong

    return _by_weeks(rule, start, end, weekend, holidays, date1904)


def _work_day(start: Value, days: Value, weekend: Value, holidays: Value | None, date1904: bool) -> Value:
    def rule(weeks: Weeks, days_off: Floats, x: Floats, y: Floats) -> tuple[Floats, Codes]:
        first, valid = whole_days(x, date1904)
        result = _moved(weeks, days_off, first, np.trunc(y)) - (DAYS_TO_1904 if date1904 else 0)
        outside = where_wrong(np.asarray(~(valid & in_calendar(result, date1904))), ErrorCode.NUM)
        return result, earliest(where_wrong(weeks.none, ErrorCode.VALUE), outside)

    return _by_weeks(rule, start, days, weekend, holidays, date1904)


_SATURDAY_AND_SUNDAY: Final = constant(1.0)


@excel("NETWORKDAYS", OneCell, OneCell, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def network_days(start: Value, end: Value, holidays: Value | None = None, *, date1904: bool = False) -> Value:
    """Days of work from one date to another, both counted; negative if the end comes first."""
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
    """As `NETWORKDAYS`, with the days off by number or as seven marks from Monday on, 1 for a day off."""
    return _network_days(start, end, weekend, holidays, date1904)


@excel("WORKDAY", OneCell, OneCell, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def work_day(start: Value, days: Value, holidays: Value | None = None, *, date1904: bool = False) -> Value:
    """The day of work so many days of work after a date, before it if negative; the date itself for 0."""
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
    """As `WORKDAY`, with the days off by number or as seven marks from Monday on; `#VALUE!` if all are off."""
    return _work_day(start, days, weekend, holidays, date1904)
