from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.functions.fifteen_digits import SETTLED, Settled, keep, never_cancels

NUMBERS = st.floats(-1e300, 1e300, allow_subnormal=False)
LIMITS = st.floats(-1e6, 1e6)


def settled(total, first):
    return SETTLED.ufunc(np.atleast_1d(total), np.atleast_1d(first))


@given(NUMBERS, st.integers(-20, 20))
def test_fewer_than_eight_units_of_the_first_number_are_0(first, units):
    total = units * math.ulp(first)
    assert settled(total, first)[0] == (0.0 if abs(units) < 8 and first != 0 else total)


@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1))
def test_it_is_the_same_for_each_trial_alone_and_in_any_memory(pairs):
    total, first = np.array(pairs).T.copy()
    alone = [settled(*pair)[0] for pair in pairs]
    assert settled(total, first).tolist() == alone
    assert Settled(float(np.abs(first).max()))(total, first).tolist() == alone
    for out in (total.copy(), first.copy()):
        a, b = total.copy(), first.copy()
        assert SETTLED.ufunc(a, b, out=out).tolist() == alone
    assert SETTLED.ufunc(total.copy(), first, out=first).tolist() == alone


def test_numbers_that_cancel_beside_numbers_that_do_not():
    total, first = np.array([1e-17, 1e-17, -3.0, 0.0]), np.array([0.1, 1e-17, 1e10, 0.0])
    assert settled(total, first).tolist() == [0.0, 1e-17, -3.0, 0.0]


@given(LIMITS, LIMITS, LIMITS, LIMITS, st.booleans(), st.integers(0, 2**32))
def test_what_never_cancels_is_kept(a, b, c, d, adds, seed):
    first, second = sorted((a, b)), sorted((c, d))
    other = second if adds else [-second[1], -second[0]]
    result = first[0] + other[0], first[1] + other[1]
    if not never_cancels(result, tuple(first), tuple(second) if adds else None):
        return
    rng = np.random.default_rng(seed)
    x, y = (rng.uniform(*ends, 20) for ends in (first, second))
    total = x + y if adds else x - y
    assert settled(total, x).tolist() == total.tolist() == keep(total, x, out=x).tolist()


@pytest.mark.parametrize(
    ("result", "first", "second", "never"),
    [
        ((1.0, 3.0), (0.0, 1.0), (1.0, 2.0), True),
        ((0.0, 3.0), (0.0, 1.0), (0.0, 2.0), True),
        ((-3.0, 0.0), (-1.0, 0.0), (-2.0, 0.0), True),
        ((-1.0, 3.0), (-2.0, 1.0), (1.0, 2.0), False),
        ((1.0, 3.0), (4.0, 5.0), None, True),
        ((-3.0, -1.0), (1.0, 2.0), None, True),
        ((0.0, 3.0), (4.0, 5.0), None, False),
        ((1e-12, 3.0), (4.0, 5.0), None, False),
    ],
)
def test_bounds_tell_what_never_cancels(result, first, second, never):
    assert never_cancels(result, first, second) is never
