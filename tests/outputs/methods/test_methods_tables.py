"""The tables of a study of methods: what is in them, and how their numbers are written."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.analysis.studies.methods import STATISTICS
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.methods_json import study_json
from xlmc.outputs.methods.methods_tables import _ends, _number, _of_kind, _share_text, percent_text, slope_text


def test_the_tables(small):
    bounds = {row[0]: row[2:] for row in methods_tables.bounds_table(small).rows}
    assert bounds["Chevrolet delta-V"][:2] == ("8.87 to 18.70", "8.85 to 15.88")
    errors = {row[0]: row[1:] for row in methods_tables.error_table(small).rows}
    assert [*errors] == [curve.method.name for curve in small.every if curve.answers]
    assert errors["Monte Carlo"][0] == "8,192"
    assert errors["Taylor, first order"][-1] == "never"
    assert errors["Monte Carlo, engine formulas"][1].startswith("≈ ")
    assert len(methods_tables.forecast_table(small).rows) == 4 * (1 + len(errors))
    assert {row[0] for row in methods_tables.reference_table(small).rows} == set(small.varying)
    sentence = dict(methods_tables.cannot_lines(small))
    assert "does not see filters" in sentence["Taylor, second order"]


def test_every_run_has_a_row_and_errors_are_those_of_the_study(small):
    table = methods_tables.length_table(small)
    expected = [(curve, runs) for curve in small.every if curve.answers for runs in curve.lengths]
    assert len(table.rows) == len(expected)
    for row, (curve, runs) in zip(table.rows, expected, strict=True):
        result = dict(zip(table.heads, row, strict=True))
        assert result["Method"] == curve.method.name
        assert result["Trials"] == ("–" if curve in small.once else f"{runs.budget:,}")
        assert result["Evaluations"] == f"{runs.evaluations:,.0f}"
        assert result["Time"].startswith("≈ ") is not runs.measured
        assert (result["Failed"] == "–") is (runs.failed == 0)
        assert (result["Effective"] == "–") is (runs.effective is None)
        for each, heading in STATISTICS.items():
            if not math.isfinite(runs.shares[each]):
                assert result[heading] == "–"
            elif not result[heading].startswith("≤"):
                assert float(result[heading].replace(",", "")) == pytest.approx(
                    100 * runs.shares[each], rel=0.06, abs=0.5
                )
    assert table.at_right == set(range(1, len(table.heads)))


def test_the_floor_is_the_root_mean_square_of_the_errors_of_the_reference(small):
    reference = small.reference
    for each in STATISTICS:
        parts = [getattr(reference.errors[name], each) / width for name, width in reference.widths.items()]
        assert methods_tables.floor_of(small, each) == pytest.approx(math.sqrt(np.mean(np.square(parts))))


def test_the_json_holds_the_numbers_of_the_study(small):
    result = study_json(small)
    assert result["reference"]["trials"] == small.reference.trials
    assert result["recommended"] in {curve.method.key for curve in small.curves + small.engines}
    for messages, curve in zip(result["methods"], small.every, strict=True):
        assert messages["method"] == curve.method.key
        for row, runs in zip(messages["runs"], curve.lengths, strict=True):
            assert row["trials"] == (None if curve in small.once else runs.budget)
            for name, errors in row["errors"].items():
                for each, values in errors.items():
                    value = runs.errors[name, each].value
                    assert values["rms"] == (value if math.isfinite(value) else None)
        drawn = curve not in small.once
        assert (messages["needs"] is not None) is drawn
        assert (messages["near_enough"] is not None) is (not drawn and bool(curve.answers))


PERCENT, DATE, YES, WHOLE = Form(Kind.PERCENT), Form(Kind.DATE), Form(Kind.YES_NO), Form(Kind.WHOLE)


@pytest.mark.parametrize(
    ("form", "least", "most", "text"),
    [
        (PLAIN, 1.0, 2.5, "1.00 to 2.50"),
        (PLAIN, -999.994, 12.0, "-999.99 to 12.00"),
        (PLAIN, 12.3456, 1000.0, "12 to 1,000"),
        (PLAIN, -1000.0, 12.3456, "-1,000 to 12"),
        (PLAIN, 0.0, 0.1, "0.00 to 0.10"),
        (PLAIN, 0.0123456, 0.09, "0.01235 to 0.09"),
        (PLAIN, 1.0, math.inf, "–"),
        (PLAIN, math.nan, 1.0, "–"),
        (WHOLE, 2.0, 7.0, "2 to 7"),
        (PERCENT, 0.25, 0.5, "25.00 % to 50.00 %"),
    ],
)
def test_the_ends_of_what_is_possible(form, least, most, text):
    assert _ends(form, least, most) == text


@pytest.mark.parametrize(
    ("form", "statistic", "value", "error", "spread", "text"),
    [
        (PLAIN, "mean", 11.8435, 0.019, False, "11.844 ± 0.019"),
        (PLAIN, "mean", 11.8435, math.nan, False, "12"),
        (PLAIN, "mean", math.nan, 0.1, False, "–"),
        (PLAIN, "mean", math.inf, 0.1, False, "–"),
        (YES, "sd", 0.5, 0.1, True, "–"),
        (YES, "mean", 0.5, 0.01, False, "50.0 ± 1.0 %"),
        (DATE, "sd", 2.0, math.nan, True, "2.0 days"),
        (DATE, "sd", 2.0, 0.1, True, "2.00 ± 0.10 days"),
    ],
)
def test_numbers_have_the_digits_that_their_errors_support(form, statistic, value, error, spread, text):
    assert _of_kind(form, statistic, value, error, spread=spread) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0249, "0.025"), (2.449, "2.4"), (9.96, "10"), (10.0, "10"), (12.4, "12"), (-12.4, "-12"), (math.nan, "–")],
)
def test_two_digits_and_whole_numbers_from_10_on(value, text):
    assert _number(value) == text
    assert percent_text(value / 100.0) == text


@pytest.mark.parametrize(
    ("share", "floor", "text"),
    [(0.02, 0.01, "2.0"), (0.01, 0.01, "1.0"), (0.0099, 0.01, "≤ 1.0"), (math.nan, 0.01, "–")],
)
def test_an_error_below_that_of_the_reference(share, floor, text):
    assert _share_text(share, floor) == text


@pytest.mark.parametrize(("slope", "text"), [(-0.494, "−0.49"), (-1.0, "−1.00"), (0.1, "0.10"), (math.nan, "–")])
def test_slopes(slope, text):
    assert slope_text(slope) == text
