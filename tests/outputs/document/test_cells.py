from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate, format_estimate, proportion
from xlmc.outputs.document.cells import (
    _span_format,
    estimate,
    interval,
    paired_format,
    share_format,
    shown_text,
    spread_format,
)

PAIRED = [
    (11.79946, 0.01256, "#,##0.000"),
    (48211.3, 870.0, "#,##0"),
    (70178.2, 12.3, "#,##0"),
    (0.05403, 0.00051, "#,##0.00000"),
    (-0.021, 0.013, "#,##0.000"),
    (0.0, 0.3, "#,##0.00"),
    (5.469e11, 2.177e9, "#,##0"),
    (2.5e-7, 1.2e-9, "0.000E+00"),
    (7.0, 0.0, "#,##0"),
    (math.nan, None, "General"),
    (math.inf, None, "General"),
    (17.02134, None, "#,##0.0000"),
    (0.0, None, "General"),
    (6760.846, 0.0023, "#,##0.000"),  # as many decimals as there is room for
]


@pytest.mark.parametrize(("value", "error", "expected"), PAIRED)
def test_formats_of_a_value_beside_its_error(value, error, expected):
    assert paired_format(Estimate(value, error)) == expected


@given(st.floats(1e-2, 9e3), st.floats(1e-3, 1e2))
def test_the_sheet_shows_the_digits_that_the_command_line_prints(value, error):
    decimals = paired_format(Estimate(value, error)).partition(".")[2].count("0")
    printed = format_estimate(value, error).split(" ")[0].partition(".")[2]
    room = 9 - len(f"{value:,.0f}") - 1
    assert decimals == min(len(printed), max(room, 0))


@pytest.mark.parametrize(
    ("estimate", "expected"),
    [
        (proportion(3542, 200_000), "0.000%"),
        (proportion(0, 200_000), "0.00000%"),
        (proportion(1, 2), "0%"),
        (Estimate(math.nan), "0.00%"),
        (Estimate(1.0, 2.1e-32), "0.00%"),  # rounding; Excel knows 30 decimals at most
    ],
)
def test_formats_of_shares(estimate, expected):
    assert share_format(estimate) == expected


@pytest.mark.parametrize(
    ("spread", "expected"), [(200.0, "#,##0.0"), (0.35, "#,##0.0000"), (4e8, "#,##0"), (0.0, "General")]
)
def test_formats_of_single_trials_follow_their_spread(spread, expected):
    assert spread_format(spread) == expected


@pytest.mark.parametrize(
    ("value", "error", "expected"),
    [
        (1234567.7995, 0.00035, ("#,##0", "#,##0.00000")),
        (45321.755034, 0.00002, ("#,##0.00", "0.0E+00")),
        (6760.846, 0.0023, ("#,##0.000", "#,##0.000")),
        (48211.3, 870.0, ("#,##0", "#,##0")),
    ],
)
def test_an_error_is_never_shown_as_0(value, error, expected):
    """A large value leaves no room for the decimals of a small error beside it."""
    assert tuple(cell.format for cell in estimate(Estimate(value, error))) == expected


@pytest.mark.parametrize(
    ("days", "error", "text"),
    [(-0.003968, 0.00012, "-0.00397 days"), (0.0156, 0.00012, "0:22:28"), (-2.561, 0.29, "-2.56 days")],
)
def test_differences_of_times_are_spans_that_excel_can_show(days, error, text):
    shown, _ = estimate(Estimate(days, error), form=Form(Kind.DATE, "[h]:mm"), spread=True)
    assert shown_text(shown) == text


@pytest.mark.parametrize(
    ("days", "error", "code"),
    [
        (0.0, 0.01, "[h]:mm:ss"),
        (0.999, 0.1, "[h]:mm:ss"),
        (1.0, 0.1, '#,##0.00" days"'),
        (1.2, 0.1, '#,##0.00" days"'),
        (-0.5, 0.012, '#,##0.000" days"'),
        (40.0, 250.0, '#,##0" days"'),
        (math.nan, 0.1, "[h]:mm:ss"),
        (0.0, None, "[h]:mm:ss"),
    ],
)
def test_a_span_below_a_day_is_in_hours(days, error, code):
    assert _span_format(days, error) == code


def test_a_time_before_the_first_one_is_a_number():
    shown, _ = estimate(Estimate(-0.25, 0.01), form=Form(Kind.DATE, "[h]:mm"))
    assert shown_text(shown) == "-0.25"


def test_ends_of_an_interval_have_no_more_digits_than_the_error_where_no_sheet_shows_them():
    result = Estimate(6.272e11, 1.4e9, (624_394_266_931.4, 629_696_104_000.2))
    assert [each.written for each in interval(result)] == ["624,400,000,000", "629,700,000,000"]
    assert [each.written for each in interval(result, form=Form(Kind.CURRENCY, "$0"))] == [
        "$624,400,000,000",
        "$629,700,000,000",
    ]
    assert [each.written for each in interval(Estimate(1.0, 0.02, (0.96, 1.04)))] == ["", ""]
    assert [each.value for each in interval(Estimate(1.0, 25.0))] == ["–", "–"]
