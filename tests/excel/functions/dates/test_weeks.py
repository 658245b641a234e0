from __future__ import annotations

from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.dates.weeks import Weeks, worked_days
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, from_objects

patterns = st.lists(st.booleans(), min_size=7, max_size=7).filter(any)


@given(patterns, st.integers(-200, 200))
def test_days_of_work_are_counted_and_found_again(pattern, day):
    """Day 2 is a Monday."""
    weeks = Weeks(np.array([[pattern]]))
    worked = [pattern[(d - 2) % 7] for d in range(-200, 201)]
    counted = weeks.count_before(np.array([[float(day)]]))[0, 0]
    assert counted == sum(worked[: day + 200]) - sum(worked[:202])
    assert weeks.is_worked(np.array([[float(day)]]))[0, 0] == worked[day + 200]
    if worked[day + 200]:
        assert weeks.day_at_count(np.array([[counted]]))[0, 0] == day


OFF = [
    (1.0, "0000011"),
    (2.0, "1000001"),
    (3.9, "1100000"),
    (7.0, "0000110"),
    (11.0, "0000001"),
    (12.0, "1000000"),
    (17.0, "0000010"),
    ("1010000", "1010000"),
    (None, "0000011"),
]


@pytest.mark.parametrize(("weekend", "off"), OFF)
def test_days_off(weekend, off):
    worked, errors = worked_days(from_objects(np.array([weekend], object)))
    assert [not day for day in worked[0]] == [mark == "1" for mark in off]
    assert errors.tolist() == [0]


@pytest.mark.parametrize(
    ("weekend", "code"),
    [
        (0.0, ErrorCode.NUM),
        (8.0, ErrorCode.NUM),
        (1000001.0, ErrorCode.NUM),
        ("11", ErrorCode.VALUE),
        ("000001x", ErrorCode.VALUE),
        (True, ErrorCode.VALUE),
        (ErrorCode.NA, ErrorCode.NA),
    ],
)
def test_no_weekend(weekend, code):
    assert worked_days(from_objects(np.array([weekend], object)))[1].tolist() == [code]


NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

VALUES = [
    ("WEEKDAY", ("2008-02-14",), 5),
    ("WEEKDAY", ("2008-02-14", 2), 4),
    ("WEEKDAY", ("2008-02-14", 3), 3),
    ("WEEKDAY", ("2008-02-14", 11), 4),
    ("WEEKDAY", ("2008-02-14", 14), 1),
    ("WEEKDAY", ("2008-02-14", 17.9), 5),
    ("WEEKDAY", (0,), 7),
    ("WEEKDAY", (1,), 1),
    ("WEEKDAY", (True,), 1),
    ("WEEKDAY", (1, 4), NUM),
    ("WEEKDAY", (1, 0), NUM),
    ("WEEKDAY", (-1,), NUM),
    ("WEEKNUM", ("2012-03-09",), 10),
    ("WEEKNUM", ("2012-03-09", 2), 11),
    ("WEEKNUM", ("2012-03-09", 21), 10),
    ("WEEKNUM", ("2010-01-01",), 1),
    ("WEEKNUM", ("2010-01-01", 21), 53),
    ("WEEKNUM", ("2010-12-31", 1), 53),
    ("WEEKNUM", ("2012-12-31", 2), 54),
    ("WEEKNUM", (1, 3), NUM),
    ("WEEKNUM", (-1,), NUM),
    ("WEEKNUM", (True,), VALUE),
    ("ISOWEEKNUM", ("2012-03-09",), 10),
    ("ISOWEEKNUM", (1,), 52),
    ("ISOWEEKNUM", (-1,), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


days = st.dates(date(1900, 3, 1))


@given(days)
def test_iso_weeks_and_days(evaluate, day):
    serial = float((day - date(1899, 12, 30)).days)
    _, week, weekday = day.isocalendar()
    assert evaluate("ISOWEEKNUM", serial) == evaluate("WEEKNUM", serial, 21.0) == week
    assert evaluate("WEEKDAY", serial, 2.0) == weekday


@given(days, st.sampled_from([1, 2, *range(11, 18)]))
def test_a_week_starts_where_its_kind_says(evaluate, day, kind):
    """Counted day by day from 1 January of the year on."""
    start = {1: 6, 2: 0, 17: 6}.get(kind, kind - 11)  # as `date.weekday` has it
    passed = range(1, (day - date(day.year, 1, 1)).days + 1)
    new_weeks = sum((date(day.year, 1, 1) + timedelta(i)).weekday() == start for i in passed)
    serial = float((day - date(1899, 12, 30)).days)
    assert evaluate("WEEKNUM", serial, float(kind)) == 1 + new_weeks


@pytest.mark.parametrize(("name", "expected"), [("WEEKDAY", 6), ("WEEKNUM", 1), ("ISOWEEKNUM", 53)])
def test_dates_count_from_1904_too(name, expected):
    """1 January 1904 was a Friday."""
    zero = np.array([0.0])
    kind = np.array([1.0])
    body = function_named(name).body
    if name == "WEEKNUM":
        result = body(Value.of_numbers(zero), Value.of_numbers(kind), date1904=True).numbers
    else:
        result = body(*([zero, kind] if name == "WEEKDAY" else [zero]), date1904=True)
    assert np.asarray(result).tolist() == [expected]


NUM_OF_WORKDAYS, VALUE_OF_WORKDAYS, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA


def _serial(text: str) -> int:
    return (date.fromisoformat(text) - date(1899, 12, 30)).days


HOLIDAYS = [["2014-03-16"], ["2014-04-04"], ["2014-03-20"], ["2014-01-01"]]

VALUES_OF_WORKDAYS = [
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01"), 110),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", "2012-11-22"), 109),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", [["2012-11-22"], ["2012-12-04"], ["2013-01-21"]]), 107),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", [["2012-11-22", "2012-11-22", None, "2012-11-24"]]), 109),
    ("NETWORKDAYS", ("2013-03-01", "2012-10-01", "2012-11-22"), -109),
    ("NETWORKDAYS", (41001.9, 41001.1), 1),
    ("NETWORKDAYS", (-1, 41000), NUM_OF_WORKDAYS),
    ("NETWORKDAYS", (1, 41000, [[-1]]), NUM_OF_WORKDAYS),
    ("NETWORKDAYS", (1, 41000, [["x"]]), VALUE_OF_WORKDAYS),
    ("NETWORKDAYS", (1, 41000, [[NA]]), NA),
    ("NETWORKDAYS", (True, 41000, [[NA]]), VALUE_OF_WORKDAYS),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-01-31"), 22),
    ("NETWORKDAYS.INTL", ("2006-02-28", "2006-01-31"), -21),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-02-01", 7, [["2006-01-02", "2006-01-16"]]), 22),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-02-01", "0010001", [["2006-01-02", "2006-01-16"]]), 20),
    ("NETWORKDAYS.INTL", ("2014-03-11", "2014-04-04", "1001000"), 18),
    ("NETWORKDAYS.INTL", ("2014-03-11", "2014-04-04", 2, HOLIDAYS), 17),
    ("NETWORKDAYS.INTL", (1, 100, "1111111"), 0),
    ("NETWORKDAYS.INTL", (1, 100, 8), NUM_OF_WORKDAYS),
    ("WORKDAY", ("2008-10-01", 151), _serial("2009-04-30")),
    ("WORKDAY", ("2008-10-01", 151, [["2008-11-26", "2008-12-04", "2009-01-21"]]), _serial("2009-05-05")),
    ("WORKDAY", ("2016-02-29", 6, [["2016-02-22", "2016-02-23", "2016-03-08"]]), _serial("2016-03-09")),
    ("WORKDAY", ("2016-03-05", -1), _serial("2016-03-04")),
    ("WORKDAY", ("2016-03-05", -1, "2016-03-04"), _serial("2016-03-03")),
    ("WORKDAY", ("2016-03-05", 0.9), _serial("2016-03-05")),
    ("WORKDAY", (5, -10), NUM_OF_WORKDAYS),
    ("WORKDAY", (5, 1e300), NUM_OF_WORKDAYS),
    ("WORKDAY", (5, True), VALUE_OF_WORKDAYS),
    ("WORKDAY.INTL", ("2012-01-01", 30, 0), NUM_OF_WORKDAYS),
    ("WORKDAY.INTL", ("2012-01-01", 90, 11), 41013),
    ("WORKDAY.INTL", ("2012-01-01", 30, 17), _serial("2012-02-05")),
    ("WORKDAY.INTL", ("2014-03-11", 24), _serial("2014-04-14")),
    ("WORKDAY.INTL", ("2014-03-11", 24, None, HOLIDAYS), _serial("2014-04-16")),
    ("WORKDAY.INTL", ("2014-03-11", 24, 13, HOLIDAYS), _serial("2014-04-11")),
    ("WORKDAY.INTL", ("2014-03-11", 24, "0101010", HOLIDAYS), _serial("2014-04-25")),
    ("WORKDAY.INTL", (1, 1, "1111111"), VALUE_OF_WORKDAYS),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_WORKDAYS)
def test_values_workdays(check, name, arguments, expected):
    check(name, arguments, expected)


patterns_workdays = st.lists(st.booleans(), min_size=7, max_size=7).filter(any)


@given(
    patterns_workdays, st.integers(40000, 40100), st.integers(-40, 40), st.lists(st.integers(39990, 40200), max_size=8)
)
def test_days_are_counted_one_by_one(evaluate, pattern, start, days, holidays):
    """Serial 2 is a Monday."""

    def is_worked(day):
        return pattern[(day - 2) % 7] and day not in holidays

    off = "".join("0" if worked else "1" for worked in pattern)
    rows = [[float(day) for day in holidays] or [None]]
    day, left = start, abs(days)
    while left:
        day += 1 if days > 0 else -1
        left -= is_worked(day)
    assert evaluate("WORKDAY.INTL", float(start), float(days), off, rows) == day
    count = sum(is_worked(d) for d in range(min(start, day), max(start, day) + 1))
    assert evaluate("NETWORKDAYS.INTL", float(start), float(day), off, rows) == (-count if day < start else count)


def test_trials_have_holidays_of_their_own_and_ranges_of_dates_are_taken():
    start = Value.of_numbers(np.array([[[41000.0, 41001.0]]]))
    holidays = Value.of_numbers(np.array([[[41001.0]], [[41002.0]]]))
    result = function_named("WORKDAY")([start, Value.of_numbers(np.array([1.0])), holidays])
    assert result.objects().tolist() == [[[41002.0, 41002.0]], [[41001.0, 41003.0]]]


def test_dates_count_from_1904_too_workdays():
    """Day 0 was a Friday."""
    values = [Value.of_numbers(np.array([float(x)])) for x in (0, 1, 3)]
    assert function_named("WORKDAY").body(*values, date1904=True).numbers.tolist() == [4.0]
    assert function_named("NETWORKDAYS").body(values[0], values[2], date1904=True).numbers.tolist() == [2.0]
