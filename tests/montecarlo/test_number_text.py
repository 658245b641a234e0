"""How numbers are written, by tables."""

from __future__ import annotations

import math
from decimal import Decimal

import pytest

from xlmc.montecarlo.number_text import (
    count_text,
    decimals_of,
    exact_text,
    fixed_text,
    format_estimate,
    in_signs,
    is_far,
    number_text,
    signs,
    styled_text,
    two_digit_exponent,
    whole_text,
)


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (2234567.89, 6, "2,234,568"),
        (0.1 + 0.2, 6, "0.3"),
        (1234.5678, 6, "1,234.57"),
        (1234.5, 6, "1,234.5"),
        (100.0, 6, "100"),
        (-0.00012345678, 6, "-0.000123457"),
        (9.4e-5, 6, "9.4e-05"),
        (9.94e-5, 6, "9.94e-05"),
        (9.96e-5, 6, "0.0000996"),  # 1.0e-04 in two digits
        (1e-4, 6, "0.0001"),
        (9.4e14, 6, "940,000,000,000,000"),
        (1e15, 6, "1e+15"),
        (9.96e14, 6, "9.96e+14"),
        (99.71, 3, "99.7"),
        (99.96, 3, "100"),
        (0.9996, 3, "1"),
        (9.996, 3, "10"),
        (0.0, 6, "0"),
        (-0.0, 6, "0"),
        (math.inf, 6, "inf"),
        (12345.678, 2, "12,346"),
    ],
)
def test_numbers_without_an_error(value, digits, text):
    assert number_text(value, digits) == text


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (48211.3, -1, "48,210"),
        (48251.3, -2, "48,300"),
        (-0.001, 2, "0.00"),
        (-0.006, 2, "-0.01"),
        (1234.5, 0, "1,234"),
        (1234.567, 1, "1,234.6"),
        (2.0, 3, "2.000"),
    ],
)
def test_fixed_decimals(value, decimals, text):
    assert fixed_text(value, decimals) == text


@pytest.mark.parametrize(
    ("value", "far"),
    [
        (0.0, False),
        (math.inf, False),
        (9.4e-5, True),
        (9.96e-5, False),
        (1e-4, False),
        (9.94e14, False),
        (9.96e14, True),
    ],
)
def test_what_is_written_with_a_power_of_ten(value, far):
    assert is_far(value) is is_far(-value) is far


@pytest.mark.parametrize(
    ("number", "power"), [(1.0, 0), (0.00996, -2), (0.00994, -3), (9.94, 0), (9.96, 1), (99.4, 1), (-250.0, 2)]
)
def test_the_power_of_ten_in_two_digits(number, power):
    assert two_digit_exponent(number) == power


@pytest.mark.parametrize(
    ("error", "decimals"),
    [(0.0023, 4), (0.00996, 3), (1.0, 1), (9.96, 0), (870.0, -1), (0.0, None), (None, None), (math.inf, None)],
)
def test_decimals_show_an_error_in_two_digits(error, decimals):
    assert decimals_of(error) == decimals


@pytest.mark.parametrize(
    ("value", "error", "decimals", "text"),
    [
        (17.02134, 0.00231, None, "17.0213 ± 0.0023"),
        (48211.3, 870.0, None, "48,210 ± 870"),
        (2.2345e6, 1.2e3, None, "2,234,500 ± 1,200"),
        (17.02134, None, None, "17.0213"),
        (17.02134, None, 2, "17.02"),
        (17.02134, 0.00231, 1, "17.0 ± 0.0"),
        (math.nan, 0.1, None, "nan"),
        (1234567.8, 0.0, None, "1,234,567.8"),
        (0.0, 0.0, None, "0"),
        (5.0, 0.0, 3, "5"),
        (1e16, 1e13, None, "(1.0000 ± 0.0010)e+16"),
        (2.5e-6, 3e-8, None, "(2.500 ± 0.030)e-06"),
        (0.0, 3e-8, None, "(0.0 ± 3.0)e-08"),
        (-9.997e-12, 3e-14, None, "(-9.997 ± 0.030)e-12"),
        (9.9996e-12, 3e-14, None, "(1.0000 ± 0.0030)e-11"),
        (1e-12, 9.96e-12, None, "(0.1 ± 1.0)e-11"),
        (9.97e20, 1.0, None, "9.97e+20"),
        (1e-9, 2.0, None, "0.0 ± 2.0"),
        (1.0, 1e-14, None, "1"),
        (1.0, 1.2e-12, None, "1.0000000000000 ± 0.0000000000012"),
        (-0.001, 0.5, None, "0.00 ± 0.50"),
    ],
)
def test_numbers_with_an_error(value, error, decimals, text):
    assert format_estimate(value, error, decimals) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1234567.8, "1,234,567.8"),
        (0.1 + 0.2, "0.3"),
        (1 / 3, "0.333333"),
        (123456789012.0, "123,456,789,012"),
        (2.5, "2.5"),
        (0.0, "0"),
        (math.pi, "3.14159"),
    ],
)
def test_exact_numbers(value, text):
    assert exact_text(value) == text


def test_counts_and_records():
    assert [count_text(n) for n in (0, 999, 1_000, 1_234_567)] == ["0", "999", "1,000", "1,234,567"]
    assert [whole_text(x) for x in (0.1 + 0.2, 200_000, 1e22, -2.0)] == ["0.30000000000000004", "200000", "1e+22", "-2"]
    assert styled_text(0.0213, ".1%") == "2.1 %"
    assert styled_text(Decimal("1234.50"), ",f") == "1,234.50"


def test_signs_of_thousands_and_decimals():
    assert signs() == (",", ".")
    with in_signs(".", ","):
        assert signs() == (".", ",")
        assert [number_text(1234567.25), count_text(1_000), fixed_text(-1234.5, 2)] == [
            "1.234.567",
            "1.000",
            "-1.234,50",
        ]
        assert [format_estimate(1234.5, 0.32), styled_text(0.5, ".1%")] == ["1.234,50 ± 0,32", "50,0 %"]
        assert [whole_text(0.5), exact_text(1234.5)] == ["0,5", "1.234,5"]
        with in_signs(" ", ","):
            assert number_text(1234.5) == "1 234,5"
        assert number_text(1234.5) == "1.234,5"
    assert number_text(1234.5) == "1,234.5"


@pytest.mark.parametrize(
    ("value", "typed", "computed"),
    [
        (0.12345678901234, "0.12345678901234", "0.123457"),
        (1234.56789012345, "1,234.56789012345", "1,234.57"),
        (49.9903986800412, "49.9903986800412", "49.9904"),
        (0.1 + 0.2, "0.3", "0.3"),
        (1 / 3, "0.333333", "0.333333"),
        (12345678901234.0, "12,345,678,901,234", "12,345,678,901,234"),
    ],
)
def test_numbers_that_a_person_typed_have_all_of_their_digits(value, typed, computed):
    assert exact_text(value, typed=True) == typed
    assert exact_text(value) == computed
