from __future__ import annotations

import calendar
from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.dates.day_count import is_leap_year, is_month_end, month_length, months_later

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
