from __future__ import annotations

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.statistics import Estimate, format_estimate, supported_digits
from xlmc.montecarlo.statistics.estimate import t_quantile, with_error, with_relative_error


def test_is_frozen_and_slotted():
    estimate = Estimate(1.0, 0.1, (0.8, 1.2), 50)
    with pytest.raises(dataclasses.FrozenInstanceError):
        estimate.value = 2.0
    assert not hasattr(estimate, "__dict__")


@pytest.mark.parametrize("dof", [1, 2.5, 9, 199, 1e7])
@pytest.mark.parametrize("confidence", [0.5, 0.95, 0.999])
def test_t_quantile_is_students(dof, confidence):
    assert t_quantile(dof, confidence) == pytest.approx(stats.t.ppf(0.5 + confidence / 2, dof), rel=1e-9)


def test_t_quantile_without_limit_of_freedom_is_normal():
    assert t_quantile(math.inf, 0.95) == pytest.approx(1.959963984540054, rel=1e-12)


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95])
def test_a_confidence_outside_0_and_1_is_refused(confidence):
    with pytest.raises(ValueError, match="between 0 and 1"):
        t_quantile(5, confidence)


def test_interval_is_value_and_t_errors_either_side():
    estimate = with_error(10.0, 2.0, 4.0, 0.95, 5)
    assert estimate.interval == pytest.approx((10 - 2 * 2.7764451, 10 + 2 * 2.7764451))


@pytest.mark.parametrize(
    ("value", "error", "dof"), [(1.0, 0.1, 0.5), (math.nan, 0.1, 9), (1.0, math.nan, 9), (math.inf, 1.0, 9)]
)
def test_an_error_that_cannot_be_known_is_none(value, error, dof):
    estimate = with_error(value, error, dof, 0.95, 3)
    assert (estimate.error, estimate.interval, estimate.n) == (None, None, 3)


def test_the_interval_of_a_scale_stays_positive_and_agrees_with_the_plain_one_when_narrow():
    low, high = with_relative_error(1.0, 0.9, 3.0, 0.95, 4).interval
    assert 0.0 < low < 1.0 < high
    assert low * high == pytest.approx(1.0)
    narrow = with_relative_error(5.0, 0.001, 99.0, 0.95, 100).interval
    assert narrow == pytest.approx(with_error(5.0, 0.001, 99.0, 0.95, 100).interval, rel=1e-6)


def test_the_interval_of_a_scale_of_two_trials_may_be_unbounded():
    assert with_relative_error(1.0, 1.0, 1.0, 0.9999, 2).interval == (0.0, math.inf)


EXAMPLES = settings(max_examples=50, deadline=None)


@pytest.mark.parametrize(
    ("error", "decimals"),
    [(0.0023, 2), (0.005, 2), (0.0051, 1), (0.05, 1), (0.4, 0), (0.6, -1), (3.0, -1), (870.0, -4), (1e-9, 8)],
)
def test_supported_decimals(error, decimals):
    assert supported_digits(Estimate(17.0, error)) == decimals


@EXAMPLES
@given(st.floats(1e-12, 1e12))
def test_two_errors_are_at_most_one_unit_of_the_last_supported_digit(error):
    unit = 10.0 ** -supported_digits(Estimate(1.0, error))
    assert 2 * error <= unit * (1 + 1e-9)
    assert 20 * error > unit * (1 - 1e-9)


@pytest.mark.parametrize("error", [None, 0.0])
def test_without_an_error_nothing_limits_the_digits(error):
    assert supported_digits(Estimate(17.0, error)) is None


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (17.02134, 0.00231, "17.0213 ± 0.0023"),
        (17.02134, 0.00996, "17.021 ± 0.010"),
        (17.02134, 0.0995, "17.02 ± 0.10"),
        (17.02134, 2.31, "17.0 ± 2.3"),
        (17.02134, 23.1, "17 ± 23"),
        (48211.3, 870.0, "48,210 ± 870"),
        (48251.3, 8700.0, "48,300 ± 8,700"),
        (-17.02134, 0.00231, "-17.0213 ± 0.0023"),
        (-0.0001, 0.23, "0.00 ± 0.23"),
        (0.0, 0.00098, "0.00000 ± 0.00098"),
        (1.2e-12, 3e-14, "(1.200 ± 0.030)e-12"),
        (0.0, 3.1e-14, "(0.0 ± 3.1)e-14"),
        (6.02214e23, 1.5e20, "(6.0221 ± 0.0015)e+23"),
        (17.02134, 1e-17, "17.02134"),
        (3.0, 0.0, "3"),
        (17.02134, None, "17.0213"),
        (math.nan, None, "nan"),
        (math.nan, 0.1, "nan"),
    ],
)
def test_format(value, error, text):
    assert format_estimate(value, error) == text


@EXAMPLES
@given(st.floats(-1e9, 1e9), st.floats(1e-4, 1e9))
def test_what_is_printed_is_within_half_of_the_last_digit(value, error):
    shown_value, shown_error = format_estimate(value, error).split(" ± ")
    shown_value, shown_error = (float(text.replace(",", "")) for text in (shown_value, shown_error))
    assert shown_error == pytest.approx(error, rel=0.051)
    unit = 10.0 ** (math.floor(math.log10(shown_error)) - 1)
    assert abs(shown_value - value) <= 0.51 * unit
