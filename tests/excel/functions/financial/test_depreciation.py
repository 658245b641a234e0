from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import ErrorCode

NUM, DIV0, VALUE = ErrorCode.NUM, ErrorCode.DIV0, ErrorCode.VALUE

VALUES = [
    ("SLN", (30000, 7500, 10), 2250),
    ("SLN", (30000, 7500, 0), DIV0),
    ("SYD", (30000, 7500, 10, 1), 4090.90909090909),
    ("SYD", (30000, 7500, 10, 10), 409.090909090909),
    ("SYD", (30000, 7500, 10, 11), NUM),
    ("SYD", (30000, 7500, 10, 0), NUM),
    ("DB", (1000000, 100000, 6, 1, 7), 186083.333333333),
    ("DB", (1000000, 100000, 6, 2, 7), 259639.416666667),
    ("DB", (1000000, 100000, 6, 7, 7), 15845.0984738486),
    ("DB", (1000000, 100000, 6, 7), NUM),
    ("DB", (1000000, 100000, 6, 0), NUM),
    ("DB", (1000000, 100000, 6, 1, 13), NUM),
    ("DB", (-1, 100000, 6, 1), NUM),
    ("DB", (0, 100000, 6, 1), 0),
    ("DB", (575000, 5000, 10, 7), 12586.412259574658),
    ("DDB", (2400, 300, 3650, 1), 1.31506849315068),
    ("DDB", (2400, 300, 10, 1, 2), 480),
    ("DDB", (2400, 300, 10, 2, 1.5), 306),
    ("DDB", (2400, 300, 10, 10), 22.1225472000002),
    ("DDB", (2400, 300, 10, 11), NUM),
    ("DDB", (2400, 300, 10, 1, 0), NUM),
    ("DDB", (-2400, 300, 10, 1), NUM),
    ("DDB", (100, 10, 13, 0.3, 3), 23.07692307692),
    ("DDB", (100, 50, 13, 2, 4.5), 15.38461538462),
    ("DDB", (100, 50, 12.7, 2, 4.5), 14.56692913386),
    ("DDB", (100, 10, 1, 1, 50.3), 90),
    ("VDB", (2400, 300, 3650, 0, 1), 1.31506849315068),
    ("VDB", (2400, 300, 120, 6, 18), 396.306053264752),
    ("VDB", (2400, 300, 120, 6, 18, 1.5), 311.808936658234),
    ("VDB", (2400, 300, 10, 0, 0.875, 1.5), 315),
    ("VDB", (575000, 5000, 10, 3, 5, 1.5, False), 102160.546875),
    ("VDB", (575000, 5000, 10, 9, 10, 1.5), 49192.265625),
    ("VDB", (100, 10, 13, 0, 4.2, 1), 29.83431952663),
    ("VDB", (100, 10, 13, 0, 4.2, 1, True), 28.51446162465),
    ("VDB", (100, 10, 13, 10, 13, 1), 20.5110274341),
    ("VDB", (100, 10, 40, 0, 20, 3), 78.97022361334),
    ("VDB", (100, 10, 12.7, 2, 3.3, 1), 9.096594454871),
    ("VDB", (1, 0, 14, 0.5, 1.5, 1.25), 0.08529974489795919),
    ("VDB", (1, 0, 14, 13.5, 14, 1.25), 0.03436314522734203),
    ("VDB", (1, 0, 14, 13, 14, 1.25), 0.06866789938377948),
    ("VDB", (100, 10, 13, 0.5, 1, 1, True), 3.84615384615385),
    ("VDB", (100, 10, 13, 5, 4), NUM),
    ("VDB", (100, 10, 13, 5, 13.5), NUM),
    ("VDB", (100, 10, 13, -1, 2), NUM),
    ("VDB", (100, "x", 13, -1, 2), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES)
def test_values(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


def test_a_life_without_end_is_no_endless_loop(evaluate):
    assert evaluate("VDB", 100.0, 10.0, 1e300, 0.0, 1e299) == pytest.approx(100 - 100 * math.exp(-0.2), abs=100)
    assert evaluate("VDB", 100.0, 10.0, 1e15, 0.0, 1.0) == pytest.approx(2e-13, abs=1e-13)


def _period_by_period(cost, salvage, life, start, end, factor, switch):
    """The loss from `start` to `end`: periods one after the other, the first of them shortened as Excel does."""
    time, value, equal, lost = 0.0, cost, None, 0.0
    step = start - math.floor(start) if switch else 0.0
    while time < end - 1e-9:
        declining = max(min(value * factor / life, value - salvage), 0.0)
        if switch and equal is None and (value - salvage) / (life - time) > declining:
            equal = (value - salvage) / (life - time)
        loss = declining if equal is None else equal
        until = time + (step or 1.0)
        step = 0.0
        lost += loss * max(min(until, end) - max(time, start), 0.0)
        value, time = value - loss * (until - time), until
    return lost


@given(
    st.floats(10, 1000),
    st.floats(0, 1.2),
    st.integers(1, 30),
    st.sampled_from([0.5, 1.0, 1.5, 2.0, 3.0, 40.0]),
    st.booleans(),
    st.data(),
)
def test_declining_losses_are_those_of_one_period_after_the_other(evaluate, cost, share, life, factor, switch, data):
    start = data.draw(st.integers(0, 4 * life - 1)) / 4
    end = data.draw(st.integers(int(4 * start), 4 * life)) / 4
    expected = _period_by_period(cost, share * cost, float(life), start, end, factor, switch)
    result = evaluate("VDB", cost, share * cost, float(life), start, end, factor, not switch)
    assert result == pytest.approx(expected, rel=1e-9, abs=1e-9 * cost)


@given(st.floats(10, 1000), st.floats(0.01, 0.99), st.integers(1, 30), st.integers(1, 12))
def test_fixed_declining_losses_are_those_of_one_period_after_the_other(evaluate, cost, share, life, months):
    salvage, value = share * cost, cost
    rate = math.floor((1 - (salvage / cost) ** (1 / life)) * 1000 + 0.5) / 1000
    for period in range(1, life + (months < 12) + 1):
        part = {1: months / 12, life + 1: 1 - months / 12}.get(period, 1.0)
        loss = value * rate * part
        result = evaluate("DB", cost, salvage, float(life), float(period), float(months))
        assert result == pytest.approx(loss, rel=1e-9, abs=1e-12)
        value -= loss


NUM_OF_FRENCH_DEPRECIATION, VALUE_OF_FRENCH_DEPRECIATION = ErrorCode.NUM, ErrorCode.VALUE

BOUGHT, LEAP_DAY, FIRST = "1998-02-28", "2000-02-29", "2002-05-14"

VALUES_OF_FRENCH_DEPRECIATION = [
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 1, 0.15, 1), 360),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0.15, 1), 2400 * 0.15 * 134 / 366),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 6, 0.15, 1), 2400 * (0.875 - 0.15 * 134 / 366 - 0.75)),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 7, 0.15, 1), 0),
    ("AMORLINC", (2400, "2008-08-19", "2008-08-19", 300, 0, 0.15, 1), 360),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 2400, 0, 0.15, 1), 0),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0.15, 2), NUM_OF_FRENCH_DEPRECIATION),
    ("AMORLINC", (2400, "2008-08-19", "2008-12-31", 300, 0, 0, 1), NUM_OF_FRENCH_DEPRECIATION),
    ("AMORLINC", (2400, "2008-12-31", "2008-08-19", 300, 0, 0.15, 1), NUM_OF_FRENCH_DEPRECIATION),
    ("AMORLINC", (True, "2008-08-19", "2008-12-31", 300, 0, 0.15, 1), VALUE_OF_FRENCH_DEPRECIATION),
    ("AMORDEGRC", (2400, "2008-08-19", "2008-12-31", 300, 1, 0.15, 1), 776),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0, 0.15, 3), 75),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0, 0.3, 0), 90),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 0.3, 0.3, 0), 0),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 1, 0.3, 1), 5),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 1.7, 0.1, 4), 13),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 2, 0.15, 1), 6),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 10, 10, 0.07, 1), 2),
    ("AMORDEGRC", (100, BOUGHT, LEAP_DAY, 50, 1, 0.3, 1), 23),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 0, 0.07, 1), 147),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 11.3, 0.07, 1), 1),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 13, 0.07, 1), 3),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 14, 0.07, 1), 3),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 15.5, 0.07, 1), 0),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 1, 0.5, 1), NUM_OF_FRENCH_DEPRECIATION),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 0, 1, 0.22, 1), NUM_OF_FRENCH_DEPRECIATION),
    ("AMORDEGRC", (200, BOUGHT, FIRST, 300, 1, 0.15, 1), NUM_OF_FRENCH_DEPRECIATION),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), VALUES_OF_FRENCH_DEPRECIATION)
def test_values_french_depreciation(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-12)


def test_linear_losses_add_up_to_what_there_is_to_lose(evaluate):
    lost = [evaluate("AMORLINC", 2400.0, "2008-08-19", "2008-12-31", 300.0, float(per), 0.15, 3.0) for per in range(9)]
    assert sum(lost) == pytest.approx(2100)
