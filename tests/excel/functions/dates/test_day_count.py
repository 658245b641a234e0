from __future__ import annotations

import calendar
from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.excel.functions.dates.day_count import (
    by_basis,
    days_between,
    days_in_year,
    european_360,
    is_basis,
    is_leap_year,
    is_month_end,
    month_length,
    months_later,
    us_360,
)
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.values import Value, from_objects

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

YEARS = [
    (("2012-01-01", "2012-07-30"), 0.5805555555555556),
    (("2012-01-01", "2012-07-30", 1), 0.5765027322404371),
    (("2012-01-01", "2012-07-30", 3), 0.5780821917808219),
    (("2012-07-30", "2012-01-01", 3.9), 0.5780821917808219),
    (("2012-01-01", "2012-07-30", 2), 211 / 360),
    (("2007-12-31", "2008-01-01", 1), 1 / 365),
    (("2007-12-31", "2008-02-28", 1), 59 / 365),
    (("2007-12-31", "2008-02-29", 1), 60 / 366),
    (("2008-02-29", "2009-02-28", 1), 365 / 366),
    (("2008-03-01", "2009-03-01", 1), 1),
    (("2008-01-01", "2008-01-02", 1), 1 / 366),
    (("2004-06-30", "2009-06-30", 1), 1826 / (2192 / 6)),
    (("2011-02-28", "2012-02-29", 0), 1),
    (("2011-02-28", "2011-03-31", 0), 31 / 360),
    (("2011-01-30", "2011-03-31", 0), 60 / 360),
    (("2011-01-31", "2011-03-31", 0), 60 / 360),
    (("2011-01-29", "2011-03-31", 0), 62 / 360),
    (("2011-01-29", "2011-03-31", 4), 61 / 360),
    (("2011-02-28", "2011-03-31", 4), 32 / 360),
    (("2011-02-28", "2011-02-28"), 0),
    ((1, 2, 5), NUM),
    ((1, 2, -1), NUM),
    ((-1, 2), NUM),
    ((1, 2958466), NUM),
    ((True, 2), VALUE),
    ((None, 360, None), 355 / 360),
]


@pytest.mark.parametrize(("arguments", "expected"), YEARS)
def test_parts_of_years(check, arguments, expected):
    check("YEARFRAC", arguments, expected, rel=1e-15)


def test_the_end_of_february_counts_as_a_30th_at_the_end_where_asked():
    start, end = 40909, 40968  # 1 January and 29 February 2012
    assert us_360(start, end) == 58
    assert us_360(start, end, end_too=True) == 59
    assert us_360(start - 1, start + 30, end_too=True) == 30
    assert european_360(start - 1, start + 30) == 30


def test_each_trial_has_its_basis():
    """1 January 2012 to 1 July 2012: 180 or 182 days."""
    basis = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    assert days_between(40909, 41091, basis).tolist() == [180, 182, 182, 182, 180]
    assert days_in_year(40909, 41091, basis).tolist() == [360, 366, 360, 365, 360]


def test_only_what_is_asked_for_is_computed():
    assert by_basis(np.array([1.0, 1.9]), lambda: 1 / 0, lambda: 7.0).tolist() == [7.0, 7.0]
    assert np.isnan(by_basis(np.array([5.0]), lambda: 1.0))


def test_dates_count_from_1904_too():
    arguments = [Value.of_numbers(np.array([float(x)])) for x in (0, 366, 1)]
    assert function_named("YEARFRAC").body(*arguments, date1904=True).numbers.tolist() == [1.0]


ZERO = date(1899, 12, 30)
days_of_march_1900_on = st.integers(61, 2_900_000)


@given(days_of_march_1900_on, st.integers(-1000, 1000), st.booleans())
def test_months_later(serial, months, to_end):
    start = ZERO + timedelta(serial)
    year, month = divmod(start.year * 12 + start.month - 1 + months, 12)
    if not 1901 <= year <= 9999:
        return
    length = calendar.monthrange(year, month + 1)[1]
    expected = date(year, month + 1, length if to_end else min(start.day, length))
    assert months_later(serial, months, to_end) == (expected - ZERO).days


@given(days_of_march_1900_on)
def test_month_ends(serial):
    assert is_month_end(serial) == ((ZERO + timedelta(serial + 1)).day == 1)


@pytest.mark.parametrize(("serial", "months", "expected"), [(0, 5, 152), (0, 1, 31), (31, 1, 60), (90, -1, 60)])
def test_the_year_1900_as_excel_has_it(serial, months, expected):
    assert months_later(serial, months) == expected


def test_leap_years():
    years = np.arange(1904, 2500)
    assert is_leap_year(years).tolist() == [calendar.isleap(year) for year in years.tolist()]
    assert month_length(years, 2).tolist() == [calendar.monthrange(year, 2)[1] for year in years.tolist()]
    assert month_length(1900, 2) == 29


NUM_OF_DATE_DIFFERENCES, VALUE_OF_DATE_DIFFERENCES = ErrorCode.NUM, ErrorCode.VALUE

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
    (2, 1, "D", NUM_OF_DATE_DIFFERENCES),
    (1, 2, "W", NUM_OF_DATE_DIFFERENCES),
    (1, 2, None, NUM_OF_DATE_DIFFERENCES),
    (-1, 2, "D", NUM_OF_DATE_DIFFERENCES),
    ("x", 2, "W", VALUE_OF_DATE_DIFFERENCES),
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
    assert result.objects().tolist() == [100.0, 3.0, NUM_OF_DATE_DIFFERENCES]


def test_a_basis_is_a_number_from_0_to_4_without_its_fraction():
    numbers = [-1.0, -0.5, 0.0, 0.5, 4.0, 4.9, 5.0, np.nan]
    assert is_basis(np.array(numbers)).tolist() == [False, False, True, True, True, True, False, False]
    assert [bool(is_basis(number)) for number in numbers] == is_basis(np.array(numbers)).tolist()
