from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.statistics import Estimate, format_estimate, supported_digits

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
        (48211.3, 870.0, "48210 ± 870"),
        (48251.3, 8700.0, "48300 ± 8700"),
        (-17.02134, 0.00231, "-17.0213 ± 0.0023"),
        (-0.0001, 0.23, "0.00 ± 0.23"),
        (0.0, 0.00098, "0.00000 ± 0.00098"),
        (1.2e-12, 3e-14, "(1.200 ± 0.030)e-12"),
        (0.0, 3.1e-14, "(0.0 ± 3.1)e-14"),
        (6.02214e23, 1.5e20, "(6.0221 ± 0.0015)e+23"),
        (17.02134, 1e-17, "17.02134 ± 1.0e-17"),
        (3.0, 0.0, "3 ± 0"),
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
    assert float(shown_error) == pytest.approx(error, rel=0.051)
    unit = 10.0 ** (math.floor(math.log10(float(shown_error))) - 1)
    assert abs(float(shown_value) - value) <= 0.51 * unit
