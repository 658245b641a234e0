from __future__ import annotations

import math

import hand_c
import hand_numba
import hand_written
import hand_written_skid
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

ACCEPTANCE = 0.01756579
"""Of the case study, by 2·10⁹ trials."""


@pytest.fixture(scope="module")
def case_in_c(library):
    return hand_c.Hand(library, "case", hand_written.LOW, hand_written.HIGH, 4)


@pytest.fixture(scope="module")
def skid_in_c(library):
    return hand_c.Hand(library, "skid", hand_written_skid.LOW, hand_written_skid.HIGH, 1)


@pytest.fixture(scope="module")
def case_in_numba():
    return hand_numba.CASE_KERNELS["polynomial"]()


@pytest.fixture(scope="module")
def skid_in_numba():
    return hand_numba.skid_kernel()


def inputs(module, n, seed=5):
    low, high = module.LOW[:, None], module.HIGH[:, None]
    return low + (high - low) * np.random.default_rng(seed).random((len(low), n))


def numba_evaluate(kernel, forecasts, given):
    n = given.shape[1]
    out = np.empty((forecasts, n))
    return out[:, : kernel(given, n, np.empty((6, n)), out, 0)]


def test_c_computes_the_case_study(case_in_c):
    given = inputs(hand_written, 20_001)
    expected = hand_written.KERNELS["plain"](0)(given.copy())
    assert expected.shape[1] > 300
    np.testing.assert_allclose(case_in_c.evaluate(given), expected, rtol=1e-12)


def test_numba_computes_the_case_study(case_in_numba):
    given = inputs(hand_written, 20_001)
    expected = hand_written.KERNELS["plain"](0)(given.copy())
    np.testing.assert_allclose(numba_evaluate(case_in_numba, 4, given), expected, rtol=1e-12)


def test_the_loop_with_sine_and_cosine_of_the_c_library(monkeypatch):
    """As it is written: compiled, it is the other one, but for these two."""
    assert hand_numba._sincos_libm(0.5) == (math.sin(0.5), math.cos(0.5))
    monkeypatch.setattr(hand_numba, "_sincos_libm", hand_numba._sincos_libm.py_func)
    given = inputs(hand_written, 1_501)
    expected = hand_written.KERNELS["plain"](0)(given.copy())
    assert expected.shape[1] > 20
    result = numba_evaluate(hand_numba.CASE_KERNELS["libm"]().py_func, 4, given)
    np.testing.assert_allclose(result, expected, rtol=1e-12)


def test_numba_makes_the_runs_of_numpy(case_in_numba):
    """The same draws, so the same accepted trials, also of a part of a chunk."""
    _, expected = hand_written.simulate(50_001, 3, 4_096, "plain")
    result = hand_numba.simulate(case_in_numba, 4, hand_written.LOW, hand_written.HIGH, 50_001, 3, 4_096)
    np.testing.assert_allclose(result, expected, rtol=1e-12)


def test_c_accepts_as_many_as_the_reference(case_in_c):
    trials = 1_000_000
    accepted = case_in_c.simulate(trials, 11, 2_048).shape[1]
    assert abs(accepted / trials - ACCEPTANCE) < 4 * math.sqrt(ACCEPTANCE * (1 - ACCEPTANCE) / trials)


def test_c_runs_depend_on_seed_alone(case_in_c):
    whole, part = case_in_c.simulate(100_000, 7, 1_024), case_in_c.simulate(60_003, 7, 1_024)
    assert 0 < part.shape[1] < whole.shape[1]
    np.testing.assert_array_equal(whole[:, : part.shape[1]], part)
    assert not np.array_equal(case_in_c.simulate(60_003, 8, 1_024)[:, :100], part[:, :100])


def test_all_compute_the_skid(skid_in_c, skid_in_numba):
    given = inputs(hand_written_skid, 1_003)
    friction, distance, grade = given
    slope = np.arctan(grade / 100)
    drag = friction * np.cos(slope) + np.sin(slope)
    expected = np.sqrt(2 * 32.174 * distance * drag) * 3600 / 5280
    np.testing.assert_allclose(skid_in_c.evaluate(given)[0], expected, rtol=1e-13)
    np.testing.assert_allclose(numba_evaluate(skid_in_numba, 1, given)[0], expected, rtol=1e-13)
    np.testing.assert_allclose(hand_written_skid.evaluate(given.copy())[0], expected, rtol=1e-13)


def test_skid_runs_agree(skid_in_c, skid_in_numba):
    """Means of independent draws differ by less than 5 standard errors; numba draws what NumPy draws."""
    trials = 200_001
    module = hand_written_skid
    plain = module.simulate(trials, 2, 4_096).speeds
    loop = hand_numba.simulate(skid_in_numba, 1, module.LOW, module.HIGH, trials, 2, 4_096)
    np.testing.assert_allclose(loop, plain, rtol=1e-13)
    other = skid_in_c.simulate(trials, 2, 4_096)
    assert other.shape == plain.shape
    assert abs(other.mean() - plain.mean()) < 5 * plain.std() * math.sqrt(2 / trials)
    assert other.std() == pytest.approx(plain.std(), rel=5 * math.sqrt(1 / trials))


@given(st.floats(-1e5, 1e5))
def test_polynomial_sine_and_cosine(x):
    """2 ulp of the value, or of the cancellation that reducing a large angle leaves."""
    sine, cosine = hand_numba._sincos_polynomial(x)
    for result, expected in ((sine, math.sin(x)), (cosine, math.cos(x))):
        assert result == pytest.approx(expected, rel=5e-16, abs=1e-20 * (1 + abs(x)))
