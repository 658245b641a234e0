from __future__ import annotations

from datetime import date

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.families import function_named
from xlmc.functions.values import Value, from_objects

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

VALUES = [
    ("2001-01-01", "2003-01-01", "Y", 2),
    ("2001-06-01", "2002-08-15", "D", 440),
    ("2001-06-01", "2002-08-15", "YD", 75),
    ("2001-06-01", "2002-08-15", "MD", 14),
    ("2011-01-01", "2011-12-31", "y", 0),
    ("2011-01-01", "2011-12-31", "M", 11),
    ("2011-01-01", "2011-12-31", "md", 30),
    ("2011-01-01", "2011-12-31", "YM", 11),
    ("2000-02-02", "2001-02-01", "Y", 0),
    ("2001-05-04", "2020-05-03", "Y", 18),
    ("2001-05-04", "2020-05-03", "YM", 11),
    ("2017-07-31", "2018-07-13", "MD", 12),
    ("2014-01-31", "2014-03-01", "MD", -2),
    ("1988-06-22", "2012-05-11", "YD", 323),
    ("1999-02-15", "2003-03-15", "YD", 28),
    ("2000-02-15", "2003-03-15", "YD", 29),
    ("2000-02-29", "2000-03-08", "YD", 8),
    ("2000-02-29", "2002-03-08", "YD", 7),
    (1.9, 2.1, "D", 1),
    (None, 1, "D", 1),
    (2, 1, "D", NUM),
    (1, 2, "W", NUM),
    (1, 2, None, NUM),
    (-1, 2, "D", NUM),
    ("x", 2, "W", VALUE),
]


@pytest.mark.parametrize(("start", "end", "unit", "expected"), VALUES)
def test_values(check, start, end, unit, expected):
    check("DATEDIF", (start, end, unit), expected)


days = st.dates(date(1900, 3, 1), date(2500, 1, 1))


@given(days, days)
def test_whole_months_and_years_are_as_many_as_have_passed(evaluate, one, other):
    start, end = sorted((one, other))
    serials = [float((day - date(1899, 12, 30)).days) for day in (start, end)]
    months = (end.year - start.year) * 12 + end.month - start.month - (end.day < start.day)
    assert evaluate("DATEDIF", *serials, "M") == months
    assert evaluate("DATEDIF", *serials, "Y") == months // 12
    assert evaluate("DATEDIF", *serials, "YM") == months % 12
    assert 0 <= evaluate("DATEDIF", *serials, "YD") <= 365


def test_each_trial_may_have_its_unit():
    units = from_objects(np.array(["D", "M", "X"], object))
    result = function_named("DATEDIF")([Value.of_numbers(np.array([x])) for x in (0.0, 100.0)] + [units])
    assert result.objects().tolist() == [100.0, 3.0, NUM]
