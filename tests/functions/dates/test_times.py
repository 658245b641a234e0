from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, VALUE = ErrorCode.NUM, ErrorCode.VALUE

VALUES = [
    ("TIME", (12, 0, 0), 0.5),
    ("TIME", (16, 48, 10), 60490 / 86400),
    ("TIME", (27, 0, 0), 0.125),
    ("TIME", (0, 750, 0), 45000 / 86400),
    ("TIME", (0, 0, 2000), 2000 / 86400),
    ("TIME", (1, -30, 0), 1800 / 86400),
    ("TIME", (1.9, 0.9, 0.9), 1 / 24),
    ("TIME", (-1, 0, 0), NUM),
    ("TIME", (0, 32767, 0), 32767 % 1440 / 1440),
    ("TIME", (0, 32768, 0), NUM),
    ("TIME", ("x", 0, 0), VALUE),
    ("HOUR", (0.75,), 18),
    ("HOUR", (0.33,), 7),
    ("HOUR", (None,), 0),
    ("HOUR", ("2011-07-18 7:45",), 7),
    ("HOUR", (0.9999999,), 0),
    ("HOUR", (-0.5,), NUM),
    ("HOUR", (2958466,), NUM),
    ("HOUR", ("x",), VALUE),
    ("MINUTE", ("12:45:00 PM",), 45),
    ("SECOND", ("4:48:18 PM",), 18),
    ("SECOND", (0.5 + 0.6 / 86400,), 1),
    ("TIMEVALUE", ("2:24 AM",), 0.1),
    ("TIMEVALUE", ("22-Aug-2011 6:35 AM",), 395 / 1440),
    ("TIMEVALUE", ("25:30",), 1.5 / 24),
    ("TIMEVALUE", ("22-Aug-2011",), 0),
    ("TIMEVALUE", ("soon",), VALUE),
    ("TIMEVALUE", (0.5,), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-14)


@given(st.integers(0, 23), st.integers(0, 59), st.integers(0, 59), st.integers(0, 100000))
def test_parts_make_the_time_again(evaluate, hour, minute, second, day):
    time = evaluate("TIME", float(hour), float(minute), float(second))
    assert [evaluate(name, day + time) for name in ("HOUR", "MINUTE", "SECOND")] == [hour, minute, second]
