from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.functions.dates.day_count import by_basis, days_between, days_in_year, european_360, us_360
from xlmc.functions.families import function_named
from xlmc.functions.values import Value

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
