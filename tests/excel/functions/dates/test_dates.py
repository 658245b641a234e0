from __future__ import annotations

from datetime import date, datetime, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

ZERO = date(1899, 12, 30)


def _serial(text: str) -> int:
    return (date.fromisoformat(text) - ZERO).days


VALUES = [
    ("DATE", (1900, 1, 1), 1),
    ("DATE", (1900, 2, 29), 60),
    ("DATE", (1900, 3, 1), 61),
    ("DATE", (1900, 222, 1), 6727),
    ("DATE", (1900, 1, 22222), 22222),
    ("DATE", (1e-5, 1.1, 1.00001), 1),
    ("DATE", (1, 2, 1.00001), 398),
    ("DATE", (2008, 2, 29), _serial("2008-02-29")),
    ("DATE", (2009, 1, 400), _serial("2010-02-04")),
    ("DATE", (2009, 14, 1), _serial("2010-02-01")),
    ("DATE", (2009, 1, -1), _serial("2008-12-30")),
    ("DATE", (2009, 1, -1.9), _serial("2008-12-30")),
    ("DATE", (2009, -1, 1), _serial("2008-11-01")),
    ("DATE", ("2016", True, None), _serial("2015-12-31")),
    ("DATE", (9999, 12, 31), 2958465),
    ("DATE", (9999, 12, 32), NUM),
    ("DATE", (10000, 1, 1), NUM),
    ("DATE", (1900, 1, -1), NUM),
    ("DATE", (-1, 1, 1), NUM),
    ("DATE", ("x", NA, 1), VALUE),
    ("DATEVALUE", ("8/22/2011",), 40777),
    ("DATEVALUE", ("22-MAY-2011",), 40685),
    ("DATEVALUE", ("22-MAY-2011 18:00",), 40685),
    ("DATEVALUE", ("18:00",), 0),
    ("DATEVALUE", ("soon",), VALUE),
    ("DATEVALUE", (40777,), VALUE),
    ("YEAR", (0,), 1900),
    ("YEAR", ("2008-05-07",), 2008),
    ("YEAR", (2958465.9,), 9999),
    ("YEAR", (2958466,), NUM),
    ("YEAR", (-0.1,), NUM),
    ("YEAR", ("7/5/1800",), VALUE),
    ("MONTH", (0,), 1),
    ("MONTH", (60.5,), 2),
    ("MONTH", (-1,), NUM),
    ("DAY", (0,), 0),
    ("DAY", (None,), 0),
    ("DAY", (60,), 29),
    ("DAY", (-1,), NUM),
    ("DAYS", ("2021-03-15", "2021-02-01"), 42),
    ("DAYS", (1.2, 2.9), -1),
    ("DAYS", (1, -1), NUM),
    ("DAYS360", ("2011-01-01", "2011-12-31"), 360),
    ("DAYS360", (534, 1.00001), -526),
    ("DAYS360", ("2011-01-30", "2011-02-01"), 1),
    ("DAYS360", ("2011-02-28", "2011-03-31"), 30),
    ("DAYS360", ("2011-02-28", "2011-03-31", True), 32),
    ("DAYS360", ("2011-01-29", "2011-03-31"), 62),
    ("DAYS360", ("2011-01-29", "2011-03-31", True), 61),
    ("DAYS360", ("2012-02-28", "2012-02-29"), 1),
    ("DAYS360", (-1, 1), NUM),
    ("EDATE", ("2011-01-15", 1), 40589),
    ("EDATE", ("2011-01-15", -1.9), 40527),
    ("EDATE", ("2011-01-31", 1), _serial("2011-02-28")),
    ("EDATE", (None, 5), 152),
    ("EDATE", (10, -1), NUM),
    ("EDATE", ("2011-01-15", 1e9), NUM),
    ("EDATE", (-1, 1), NUM),
    ("EDATE", (True, 1), VALUE),
    ("EOMONTH", ("2011-01-01", 1), 40602),
    ("EOMONTH", ("2011-01-01", -3), 40482),
    ("EOMONTH", ("2012-01-31", 1), _serial("2012-02-29")),
    ("EOMONTH", (10, "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected)


@given(st.dates(date(1900, 3, 1)))
def test_parts_make_the_date_again(evaluate, day):
    serial = float((day - ZERO).days)
    parts = [evaluate(name, serial) for name in ("YEAR", "MONTH", "DAY")]
    assert parts == [day.year, day.month, day.day]
    assert evaluate("DATE", *parts) == serial


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        ("DATE", (1904, 1, 1), 0),
        ("DATE", (4, 1, 2), 1),
        ("DATE", (1903, 12, 31), None),
        ("YEAR", (0,), 1904),
        ("DAYS360", (0, 366, 0), 360),
        ("EDATE", (0, 12), 366),
        ("EDATE", (0, -1), None),
    ],
)
def test_dates_count_from_1904_too(name, arguments, expected):
    values = [Value.of_numbers(np.array([float(x)])) for x in arguments]
    body = function_named(name).body
    results = body(*values, date1904=True) if name == "EDATE" else body(*(v.numbers for v in values), date1904=True)
    result = results if isinstance(results, Value) else Value.of_numbers(np.atleast_1d(results))
    assert result.objects().tolist() == [NUM if expected is None else expected]


def test_now_is_now(evaluate):
    def serial(moment):
        return (moment - datetime(1899, 12, 30)) / timedelta(days=1)

    before = serial(datetime.now())
    result = evaluate("NOW")
    after = serial(datetime.now())
    assert before - 1e-9 <= result <= after + 1e-9
    assert evaluate("TODAY") in (np.floor(before), np.floor(after))
    assert function_named("NOW").volatile
    assert function_named("TODAY").volatile


NUM_OF_TIMES, VALUE_OF_TIMES = ErrorCode.NUM, ErrorCode.VALUE

VALUES_OF_TIMES = [
    ("TIME", (12, 0, 0), 0.5),
    ("TIME", (16, 48, 10), 60490 / 86400),
    ("TIME", (27, 0, 0), 0.125),
    ("TIME", (0, 750, 0), 45000 / 86400),
    ("TIME", (0, 0, 2000), 2000 / 86400),
    ("TIME", (1, -30, 0), 1800 / 86400),
    ("TIME", (1.9, 0.9, 0.9), 1 / 24),
    ("TIME", (-1, 0, 0), NUM_OF_TIMES),
    ("TIME", (0, 32767, 0), 32767 % 1440 / 1440),
    ("TIME", (0, 32768, 0), NUM_OF_TIMES),
    ("TIME", ("x", 0, 0), VALUE_OF_TIMES),
    ("HOUR", (0.75,), 18),
    ("HOUR", (0.33,), 7),
    ("HOUR", (None,), 0),
    ("HOUR", ("2011-07-18 7:45",), 7),
    ("HOUR", (0.9999999,), 0),
    ("HOUR", (-0.5,), NUM_OF_TIMES),
    ("HOUR", (2958466,), NUM_OF_TIMES),
    ("HOUR", ("x",), VALUE_OF_TIMES),
    ("MINUTE", ("12:45:00 PM",), 45),
    ("SECOND", ("4:48:18 PM",), 18),
    ("SECOND", (0.5 + 0.6 / 86400,), 1),
    ("TIMEVALUE", ("2:24 AM",), 0.1),
    ("TIMEVALUE", ("22-Aug-2011 6:35 AM",), 395 / 1440),
    ("TIMEVALUE", ("25:30",), 1.5 / 24),
    ("TIMEVALUE", ("22-Aug-2011",), 0),
    ("TIMEVALUE", ("soon",), VALUE_OF_TIMES),
    ("TIMEVALUE", (0.5,), VALUE_OF_TIMES),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_TIMES)
def test_values_times(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


@given(st.integers(0, 23), st.integers(0, 59), st.integers(0, 59), st.integers(0, 100000))
def test_parts_make_the_time_again(evaluate, hour, minute, second, day):
    time = evaluate("TIME", float(hour), float(minute), float(second))
    assert [evaluate(name, day + time) for name in ("HOUR", "MINUTE", "SECOND")] == [hour, minute, second]
