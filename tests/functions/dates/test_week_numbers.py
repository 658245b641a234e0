from __future__ import annotations

from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value

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
        found = body(Value.of_numbers(zero), Value.of_numbers(kind), date1904=True).numbers
    else:
        found = body(*([zero, kind] if name == "WEEKDAY" else [zero]), date1904=True)
    assert np.asarray(found).tolist() == [expected]
