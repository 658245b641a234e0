from __future__ import annotations

import math

import pytest

from xlmc.outputs.sheets.styles import axis_format, bounds, no_reference


@pytest.mark.parametrize(
    ("lowest", "highest", "low", "high", "step"),
    [
        (0.0, 1.0, 0.0, 1.0, 0.1),
        (0.0, 1.01, 0.0, 1.2, 0.2),
        (0.0, 2.0, 0.0, 2.0, 0.2),
        (0.0, 2.1, 0.0, 2.5, 0.5),
        (0.0, 5.0, 0.0, 5.0, 0.5),
        (0.0, 5.1, 0.0, 6.0, 1.0),
        (0.0, 9.9, 0.0, 10.0, 1.0),
        (18.9, 26.6, 18.0, 27.0, 1.0),
        (-3.0, 4.0, -3.0, 4.0, 1.0),
        (-1234.0, -1001.0, -1250.0, -1000.0, 50.0),
        (1e-7, 4e-7, 1e-7, 4e-7, 5e-8),
    ],
)
def test_an_axis_ends_at_round_numbers_about_its_values(lowest, highest, low, high, step):
    assert bounds(lowest, highest) == {"min": low, "max": high, "major_unit": step}


@pytest.mark.parametrize("exponent", [-200, -9, 0, 5, 200])
@pytest.mark.parametrize("span", [1.0, 1.7, 2.3, 4.9, 7.7, 9.99])
def test_an_axis_has_four_to_eleven_steps_and_holds_its_values(span, exponent):
    lowest, highest = 0.37 * 10.0**exponent, (0.37 + span) * 10.0**exponent
    result = bounds(lowest, highest)
    assert result["min"] <= lowest <= highest <= result["max"]
    assert 4 <= round((result["max"] - result["min"]) / result["major_unit"]) <= 12
    mantissa = result["major_unit"] / 10.0 ** math.floor(math.log10(result["major_unit"] * 1.0000001))
    assert min(abs(mantissa - each) for each in (1.0, 2.0, 5.0)) < 1e-6


@pytest.mark.parametrize(
    ("lowest", "highest"),
    [(1.0, 1.0), (2.0, 1.0), (1.0, 1.0 + 1e-10), (-1e308, 1e308), (0.0, 1e-301), (math.nan, 1.0), (0.0, math.inf)],
)
def test_numbers_without_a_spread_set_no_ends(lowest, highest):
    assert bounds(lowest, highest) == {}


def test_a_title_is_no_reference_and_a_minus_stays_with_its_number():
    assert no_reference("Change (Model!D50)!") == "Change (Model!\u2060D50)!\u2060"
    assert axis_format("#,##0.0") == '#,##0.0;"\u2212"#,##0.0'
