from __future__ import annotations

from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA


def _serial(text: str) -> int:
    return (date.fromisoformat(text) - date(1899, 12, 30)).days


HOLIDAYS = [["2014-03-16"], ["2014-04-04"], ["2014-03-20"], ["2014-01-01"]]

VALUES = [
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01"), 110),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", "2012-11-22"), 109),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", [["2012-11-22"], ["2012-12-04"], ["2013-01-21"]]), 107),
    ("NETWORKDAYS", ("2012-10-01", "2013-03-01", [["2012-11-22", "2012-11-22", None, "2012-11-24"]]), 109),
    ("NETWORKDAYS", ("2013-03-01", "2012-10-01", "2012-11-22"), -109),
    ("NETWORKDAYS", (41001.9, 41001.1), 1),
    ("NETWORKDAYS", (-1, 41000), NUM),
    ("NETWORKDAYS", (1, 41000, [[-1]]), NUM),
    ("NETWORKDAYS", (1, 41000, [["x"]]), VALUE),
    ("NETWORKDAYS", (1, 41000, [[NA]]), NA),
    ("NETWORKDAYS", (True, 41000, [[NA]]), VALUE),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-01-31"), 22),
    ("NETWORKDAYS.INTL", ("2006-02-28", "2006-01-31"), -21),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-02-01", 7, [["2006-01-02", "2006-01-16"]]), 22),
    ("NETWORKDAYS.INTL", ("2006-01-01", "2006-02-01", "0010001", [["2006-01-02", "2006-01-16"]]), 20),
    ("NETWORKDAYS.INTL", ("2014-03-11", "2014-04-04", "1001000"), 18),
    ("NETWORKDAYS.INTL", ("2014-03-11", "2014-04-04", 2, HOLIDAYS), 17),
    ("NETWORKDAYS.INTL", (1, 100, "1111111"), 0),
    ("NETWORKDAYS.INTL", (1, 100, 8), NUM),
    ("WORKDAY", ("2008-10-01", 151), _serial("2009-04-30")),
    ("WORKDAY", ("2008-10-01", 151, [["2008-11-26", "2008-12-04", "2009-01-21"]]), _serial("2009-05-05")),
    ("WORKDAY", ("2016-02-29", 6, [["2016-02-22", "2016-02-23", "2016-03-08"]]), _serial("2016-03-09")),
    ("WORKDAY", ("2016-03-05", -1), _serial("2016-03-04")),
    ("WORKDAY", ("2016-03-05", -1, "2016-03-04"), _serial("2016-03-03")),
    ("WORKDAY", ("2016-03-05", 0.9), _serial("2016-03-05")),
    ("WORKDAY", (5, -10), NUM),
    ("WORKDAY", (5, 1e300), NUM),
    ("WORKDAY", (5, True), VALUE),
    ("WORKDAY.INTL", ("2012-01-01", 30, 0), NUM),
    ("WORKDAY.INTL", ("2012-01-01", 90, 11), 41013),
    ("WORKDAY.INTL", ("2012-01-01", 30, 17), _serial("2012-02-05")),
    ("WORKDAY.INTL", ("2014-03-11", 24), _serial("2014-04-14")),
    ("WORKDAY.INTL", ("2014-03-11", 24, None, HOLIDAYS), _serial("2014-04-16")),
    ("WORKDAY.INTL", ("2014-03-11", 24, 13, HOLIDAYS), _serial("2014-04-11")),
    ("WORKDAY.INTL", ("2014-03-11", 24, "0101010", HOLIDAYS), _serial("2014-04-25")),
    ("WORKDAY.INTL", (1, 1, "1111111"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


patterns = st.lists(st.booleans(), min_size=7, max_size=7).filter(any)


@given(patterns, st.integers(40000, 40100), st.integers(-40, 40), st.lists(st.integers(39990, 40200), max_size=8))
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
    found = function_named("WORKDAY")([start, Value.of_numbers(np.array([1.0])), holidays])
    assert found.objects().tolist() == [[[41002.0, 41002.0]], [[41001.0, 41003.0]]]


def test_dates_count_from_1904_too():
    """Day 0 was a Friday."""
    values = [Value.of_numbers(np.array([float(x)])) for x in (0, 1, 3)]
    assert function_named("WORKDAY").body(*values, date1904=True).numbers.tolist() == [4.0]
    assert function_named("NETWORKDAYS").body(values[0], values[2], date1904=True).numbers.tolist() == [2.0]
