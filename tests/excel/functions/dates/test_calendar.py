from __future__ import annotations

from datetime import date, timedelta

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.dates.calendar import in_calendar, last_serial, parts_of, serial_of, time_of, weekday_of

DATES = [
    (0, (1900, 1, 0)),
    (1, (1900, 1, 1)),
    (59, (1900, 2, 28)),
    (60, (1900, 2, 29)),
    (61, (1900, 3, 1)),
    (36526, (2000, 1, 1)),
    (43831, (2020, 1, 1)),
    (2958465, (9999, 12, 31)),
]


@pytest.mark.parametrize(("serial", "parts"), DATES)
def test_serials_and_dates(serial, parts):
    assert [int(part) for part in parts_of(serial)] == list(parts)
    assert serial_of(*parts) == serial


@pytest.mark.parametrize("date1904", [False, True])
def test_days_come_back(date1904):
    """Every day of 400 years and more, after which the calendar repeats itself, and then every 29th."""
    serials = np.r_[:200_000, 200_000 : last_serial(date1904) + 1 : 29, last_serial(date1904)]
    assert np.array_equal(serial_of(*parts_of(serials, date1904), date1904), serials)


@given(st.dates(date(1904, 1, 1)))
def test_the_calendar_is_the_true_one(day):
    assert serial_of(day.year, day.month, day.day, True) == (day - date(1904, 1, 1)).days
    if day > date(1900, 2, 28):
        assert serial_of(day.year, day.month, day.day) == (day - date(1899, 12, 30)).days
    assert (weekday_of(serial_of(day.year, day.month, day.day)) - 1) % 7 == day.weekday()


@given(st.integers(1905, 9990), st.integers(-20, 20), st.integers(-400, 400))
def test_months_and_days_run_over(year, month, day):
    first = date(year + (month - 1) // 12, (month - 1) % 12 + 1, 1)
    assert serial_of(year, month, day) == (first + timedelta(days=day - 1) - date(1899, 12, 30)).days


@pytest.mark.parametrize(
    ("date_", "serial"), [((1900, 1, -5), -5), ((1900, 2, 30), 61), ((1900, 3, 0), 60), ((2020, 1.9, 1.9), 43831)]
)
def test_dates_run_over_in_1900_too(date_, serial):
    assert serial_of(*date_) == serial


@pytest.mark.parametrize("date_", [(10000, 1, 1), (1e300, 1, 1), (2020, -1e300, 1), (1899, 12, 30), (2020, 1, 1e12)])
def test_what_is_outside_comes_out_outside(date_):
    assert not in_calendar(serial_of(*date_))


def test_weekdays_before_march_1900_are_one_off():
    assert weekday_of(np.array([0, 1, 60, 61])).tolist() == [6, 0, 3, 4]
    assert date(1900, 1, 1).weekday() == 0  # in truth a Monday
    assert weekday_of(0, True) == (date(1904, 1, 1).weekday() + 1) % 7


@pytest.mark.parametrize(
    ("serial", "time"),
    [(0, (0, 0, 0)), (0.5, (12, 0, 0)), (43831.75, (18, 0, 0)), (0.1, (2, 24, 0)), (0.9999999, (0, 0, 0))],
)
def test_times(serial, time):
    assert [int(part) for part in time_of(serial)] == list(time)


@given(st.integers(0, 86399), st.floats(-0.49, 0.49))
def test_times_to_the_nearest_second(second, off):
    hour, minute, rest = time_of(1.0 + (second + off) / 86400)
    assert hour * 3600 + minute * 60 + rest == second


def test_shapes_broadcast():
    serials = serial_of(np.array([[2020], [2021]]), np.array([1, 2, 3]), 1)
    assert serials.shape == (2, 3)
    assert all(part.shape == (2, 3) for part in parts_of(serials))
