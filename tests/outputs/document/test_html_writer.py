"""How cells read as text and as HTML."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.statistics import Estimate, format_estimate
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown, shown_text
from xlmc.outputs.document.element import Html
from xlmc.outputs.document.html_writer import estimate_html, shown_html

CASES = [
    (cells.count(200_000), "200,000"),
    (cells.count(7), "7"),
    (Shown(None), ""),
    (Shown("=1+1"), "=1+1"),
    (Shown(1234.5678, "#,##0.00"), "1,234.57"),
    (Shown(-1234.5678, "#,##0"), "-1,235"),
    (Shown(0.01771, "0.000%"), "1.771 %"),
    (Shown(0.25, "0%"), "25 %"),
    (Shown(12345.678, "0.00"), "12345.68"),
    (Shown(1.2345e-9, "0.00E+00"), "1.23e-09"),
    (Shown(999), "999"),
    (Shown(0.1), "0.1"),
    (Shown(1 / 3), "0.333333333"),
    (Shown(math.nan), cells.NONE),
    (Shown(math.inf), "∞"),
    (Shown(-math.inf), "−∞"),
]


@pytest.mark.parametrize(("shown", "text"), CASES, ids=lambda case: str(case))
def test_a_cell_reads_as_on_the_sheet(shown, text):
    assert shown_text(shown) == text


def test_an_unknown_format_is_refused():
    with pytest.raises(ValueError, match="yyyy"):
        shown_text(Shown(1.0, "yyyy-0.0"))


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (46_082.0, "yyyy-mm-dd", "2026-03-01"),
        (0.25, "[h]:mm:ss", "6:00:00"),
        (-1234.5, '"$"#,##0.0', "-$1,234.5"),
        (12.25, '0.00" days"', "12.25 days"),
    ],
)
def test_forms_of_dates_and_money(value, digits, text):
    assert shown_text(Shown(value, digits)) == text


@given(st.floats(-999, 999), st.floats(1e-3, 9.4))
def test_an_estimate_shows_the_digits_that_are_printed(value, error):
    value_cell, error_cell = cells.estimate(Estimate(value, error))
    assert f"{shown_text(value_cell)} ± {shown_text(error_cell)}" == format_estimate(value, error)


@given(st.floats(allow_nan=False), st.floats(0.0, allow_nan=False))
def test_every_format_of_an_estimate_is_known(value, error):
    for cell in (*cells.estimate(Estimate(value, error)), *cells.share(Estimate(value, error))):
        assert shown_text(cell)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_carries_its_full_value(value):
    result = shown_html(Shown(value)).source
    assert float(result.partition('value="')[2].partition('"')[0]) == value


def test_estimates():
    assert estimate_html(Estimate(17.02134, 0.00231)).source == '<data value="17.02134">17.0213 ± 0.0023</data>'
    assert estimate_html(Estimate(math.nan)) == Html(f"<span>{cells.NONE}</span>")
