from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.dates.calendar import parts_of
from xlmc.excel.functions.dates.date_text import MONTHS, parse_date, parse_moment, parse_time

DATES = [
    ("6-4-82", 30106),
    ("6 - 4 - 82", 30106),
    ("6/4-1984", 30837),
    ("1/15/2020", 43845),
    ("15-Jan-2020", 43845),
    ("15 january 20", 43845),
    ("15Jan2020", 43845),
    ("January 15, 2020", 43845),
    ("Jan 15, 2020", 43845),
    ("2020-01-15", 43845),
    ("2020/1/15", 43845),
    ("Jan 2020", 43831),
    ("Oct-82", 30225),
    ("Oct1984", 30956),
    ("6/82", 30103),
    ("1/2020", 43831),
    ("2020-01", 43831),
    ("Feb 31", 11355),
    ("10 oct 00", 36809),
    ("10 oct 29", 47401),
    ("10 oct 30", 11241),
    ("1 jan 1900", 1),
    ("29 Feb 1900", 60),
    ("31 dec 9999", 2958465),
    ("29 feb 2004", 38046),
    ("Sept 1, 2020", 44075),
]
NO_DATES = [
    "29 feb 1975",
    "31 apr 2000",
    "13/1/2020",
    "2000-13-01",
    "1/0/2020",
    "6.4.82",
    "6 4 82",
    "6,4,82",
    "82/6/4",
    "6-82-4",
    "1984-Oct-6",
    "Jan 1 2023",
    "1 Jan, 2023",
    "Sunday 12 April 1984",
    "10 oct 0000",
    "31 dec 1899",
    "10000-01-01",
    "1/2",
    "6-Oct",
    "Oct 7",
    "Ja 2020",
    "Foo 2020",
    "",
    "٦/٤/1984",
]


@pytest.mark.parametrize(("text", "serial"), DATES)
def test_dates(text, serial):
    assert parse_date(text) == serial


@pytest.mark.parametrize("text", NO_DATES)
def test_no_dates(text):
    assert parse_date(text) is None


@pytest.mark.parametrize(("text", "serial"), [("1/1/1904", 0.0), ("1/15/2020", 42383.0), ("12/31/1903", None)])
def test_dates_of_the_1904_system(text, serial):
    assert parse_date(text, True) == serial


@given(st.integers(1, 2958465))
def test_written_dates_read_back(serial):
    year, month, day = (int(part) for part in parts_of(serial))
    assert parse_date(f"{year}-{month:02}-{day:02}") == serial
    assert parse_date(f"{month}/{day}/{year}") == serial
    assert parse_date(f"{MONTHS[month - 1]} {day}, {year}") == serial


SECOND = 1 / 86400
TIMES = [
    ("13:45:10", 49510 * SECOND),
    ("1:30 PM", 0.5625),
    ("1:30 p", 0.5625),
    ("12:00 AM", 0.0),
    ("00:00 PM", 0.5),
    ("1 AM", 1 / 24),
    ("01:", 1 / 24),
    ("01:02:", 3720 * SECOND),
    ("24:11", 1.007638888888889),
    ("100:30", 361800 * SECOND),
    ("13:60", 14 / 24),
    ("0:00:60", 60 * SECOND),
    ("10:12.456", 612.456 * SECOND),
    ("10:12:13.0123456789", 36733.012 * SECOND),
]


@pytest.mark.parametrize(("text", "days"), TIMES)
def test_times(text, days):
    assert parse_time(text) == pytest.approx(days, rel=1e-15)


@pytest.mark.parametrize(
    "text", ["1:2AM", "13:00 AM", "12:60 PM", "13:60:60", "24:60", "1:2:3:4", "AM 1", "10.5 AM", ":30"]
)
def test_no_times(text):
    assert parse_time(text) is None


@pytest.mark.parametrize(
    ("text", "day", "time"),
    [
        ("07/05/1984 07:00 AM", 30868.0, 7 / 24),
        ("January 15, 2020 1:30 PM", 43845.0, 0.5625),
        ("2020-01-15  12:00", 43845.0, 0.5),
        ("2020-01-15", 43845.0, None),
        ("12:00", None, 0.5),
    ],
)
def test_moments(text, day, time):
    moment = parse_moment(text)
    assert (moment.day, moment.time) == (day, time)
    assert moment.serial == (day or 0) + (time or 0)


@pytest.mark.parametrize("text", ["12:00 2020-01-15x", "2020-01-15 25", "2020-01-15T12:00", "x 12:00"])
def test_no_moments(text):
    assert parse_moment(text) is None
