from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode
from xlmc.functions.dates.weeks import Weeks, worked_days
from xlmc.functions.values import from_objects

patterns = st.lists(st.booleans(), min_size=7, max_size=7).filter(any)


@given(patterns, st.integers(-200, 200))
def test_days_of_work_are_counted_and_found_again(pattern, day):
    """Day 2 is a Monday."""
    weeks = Weeks(np.array([[pattern]]))
    worked = [pattern[(d - 2) % 7] for d in range(-200, 201)]
    counted = weeks.before(np.array([[float(day)]]))[0, 0]
    assert counted == sum(worked[: day + 200]) - sum(worked[:202])
    assert weeks.is_worked(np.array([[float(day)]]))[0, 0] == worked[day + 200]
    if worked[day + 200]:
        assert weeks.numbered(np.array([[counted]]))[0, 0] == day


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
