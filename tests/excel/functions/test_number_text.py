from __future__ import annotations

import math
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.functions.number_text import general_text, parse_number, round_to_15_digits

NUMBERS = [
    ("$1,234.50", 1234.5),
    ("-$5", -5.0),
    ("$-5", -5.0),
    ("$ (5)", -5.0),
    ("(5)", -5.0),
    ("( 5 )", -5.0),
    ("(5)%", -0.05),
    ("- 5", -5.0),
    ("+5", 5.0),
    ("-0", 0.0),
    ("%5", 0.05),
    ("1.999%", 0.01999),
    ("12.123%", 0.12123),
    ("35€", 35.0),
    ("€ 35", 35.0),
    ("1234,123", 1234123.0),
    ("1,2345", 12345.0),
    ("1,234,567.", 1234567.0),
    ("1,123E-1", 112.3),
    ("1e5", 100000.0),
    ("1 1/2", 1.5),
    ("-1 1/4", -1.25),
    ("0 3/4", 0.75),
    ("1 1/2%", 0.015),
    ("\t 5 \n", 5.0),
    ("1234567890123456", 1234567890123450.0),
    ("123456789012345.999", 123456789012345.0),
    ("0.00012345678901234567", 0.000123456789012345),
    ("1/15/2020", 43845.0),
    ("1:30 PM", 0.5625),
    ("1/15/2020 6:00", 43845.25),
]
NO_NUMBERS = [
    "1,23",
    "0,123",
    ",123",
    "1.2,345",
    "1,234,5",
    "$5%",
    "$$5",
    "$€5",
    "5$",
    "(-5)",
    "-(5)",
    "((5))",
    "(5",
    "5)",
    "+-5",
    "5%%",
    "5-",
    "1e",
    "e5",
    "1e5.5",
    "1 2",
    "1 1/0",
    "1.5 1/2",
    "1/2",
    "5\u00a0",
    "\u00a05",
    "−5",
    "١٢",
    "0x10",
    "TRUE",
    "1e99999999999",
    "£5",
]


@pytest.mark.parametrize(("text", "number"), NUMBERS)
def test_texts_that_are_numbers(text, number):
    assert parse_number(text) == number


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_texts_that_are_none(text):
    assert parse_number(text) is None


def test_dates_in_texts_of_the_1904_system():
    assert parse_number("1/15/2020", True) == 42383.0


@given(st.text(alphabet="0123456789.,-+()$%eE/: APMJan€", max_size=12))
def test_any_text_is_a_finite_number_or_none(text):
    number = parse_number(text)
    assert number is None or math.isfinite(number)


@pytest.mark.parametrize(
    ("number", "text"),
    [
        (1e19, "10000000000000000000"),
        (1e20, "1E+20"),
        (1e-7, "0.0000001"),
        (1e-18, "0.000000000000000001"),
        (1e-19, "1E-19"),
        (1.5e-10, "0.00000000015"),
        (0.123456789012345678, "0.123456789012346"),
        (0.0123456789012345678, "0.0123456789012346"),
        (0.000123456789012345678, "0.000123456789012346"),
        (0.0000123456789012345678, "1.23456789012346E-05"),
        (1.23456789012346e98, "1.23456789012346E+98"),
        (1.23456789012346e99, "1.2345678901235E+99"),
        (-1.25e-100, "-1.25E-100"),
    ],
)
def test_numbers_take_twenty_characters_at_most(number, text):
    assert general_text(number) == text


@pytest.mark.parametrize(
    ("number", "decimal"), [(0.1 + 0.2, "0.3"), (1.005, "1.005"), (123456789012345.67, "123456789012346"), (0.5, "0.5")]
)
def test_fifteen_digits_are_shown(number, decimal):
    assert round_to_15_digits(number) == Decimal(decimal)
