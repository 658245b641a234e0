"""What is said of directions whose numbers jump by a full turn among the accepted trials."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.diagnostics.directions import direction_notices, torn_direction
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.statistics import Sample

TURN = 360.0


def cut(directions, lowest):
    """Directions in degrees as a formula with MOD shows them, from `lowest` on for a turn."""
    return lowest + np.mod(np.asarray(directions) - lowest, TURN)


@given(
    middle=st.floats(-720, 720),
    spread=st.floats(0.5, 50),
    lowest=st.sampled_from([-180.0, 0.0, 90.0]),
    seed=st.integers(0, 999),
)
def test_directions_are_found_as_they_were_before_the_cut(middle, spread, lowest, seed):
    """Within half a turn of their mean, which uniform numbers of less than 100° on either side always are."""
    directions = middle + spread * np.random.default_rng(seed).uniform(-1, 1, 500)
    shown = cut(directions, lowest)
    torn = torn_direction(Sample.of(shown), TURN)
    across = np.floor((directions - lowest) / TURN)
    if across.min() == across.max():
        assert torn is None
    elif torn is None:  # so few beyond the jump that the standard deviation hardly shows them
        assert directions.std() > 0.95 * shown.std()
    else:
        assert torn.deviation == pytest.approx(directions.std(), rel=1e-9)
        apart = (torn.mean - directions.mean()) / TURN
        assert apart == pytest.approx(round(apart), abs=1e-9)
        assert -90 <= torn.mean < 270
        beyond = np.mean(across == across.max())
        assert torn.share == pytest.approx(min(beyond, 1 - beyond))


@pytest.mark.parametrize(
    "numbers",
    [
        pytest.param(np.linspace(-170, 5, 50), id="less than half a turn"),
        pytest.param(np.linspace(-180, 180, 500), id="all directions"),
        pytest.param(np.linspace(0, 700, 500), id="a rotation of nearly two turns"),
        pytest.param(np.r_[np.linspace(0, 100, 5000), 200], id="one far number"),
        pytest.param([12.0], id="one trial"),
        pytest.param([], id="no trial"),
    ],
)
def test_other_angles_are_no_torn_directions(numbers):
    assert torn_direction(Sample.of(numbers), TURN) is None


def test_weights_count():
    """Without weights 2 of 4 lie beyond the jump; with these a tenth."""
    torn = torn_direction(Sample.of([-178.0, -176.0, 176.0, 178.0], weights=[0.05, 0.05, 0.45, 0.45]), TURN)
    assert torn.share == pytest.approx(0.1)
    assert torn.mean == pytest.approx(0.1 * 183 + 0.9 * 177)


def test_many_trials_are_looked_at_in_part():
    """The tolerance is four standard errors of a mean of the 100,000 or so that are looked at."""
    shown = cut(np.random.default_rng(5).normal(178, 10, 350_000), -180)
    torn = torn_direction(Sample.of(shown), TURN)
    assert torn.mean == pytest.approx(178, abs=4 * 10 / math.sqrt(350_000 / 4))


@pytest.fixture
def result(book):
    """`result(units, numbers)`: a forecast's accepted trials."""
    forecast = book({"A1": 1, "A2": "=A1"}, {"a": {"cell": "A1", "low": 0, "high": 2}}, {"PDOF": "A2"}).forecasts[0]
    return lambda units, numbers: ForecastResult(
        replace(forecast, units=units), lambda: np.asarray(numbers, np.float64), Counter()
    )


def test_the_sentence_gives_a_formula_that_keeps_the_numbers_together(result):
    shown = cut([170, 176, 184, 190], -180)
    (notice,) = direction_notices([result("°", shown)])
    assert "'PDOF' is a direction" in notice.message
    assert "50.00 % of the accepted trials lie beyond the jump" in notice.message
    assert "180 ° on average, with a standard deviation of 7.62 °" in notice.message
    assert "=x-360*ROUND((x-180)/360,0)" in notice.message
    assert direction_notices([result("°", [x - 360 * round((x - 180) / 360) for x in shown])]) == []


@pytest.mark.parametrize(
    ("units", "factor", "middle", "formula"),
    [
        ("deg", 1.0, 0.0, "=x-360*ROUND(x/360,0)"),
        ("Degrees", 1.0, -60.0, "=x-360*ROUND((x+60)/360,0)"),
        ("rad", math.pi / 180, 180.0, "=x-(2*PI())*ROUND((x-3.1)/(2*PI()),0)"),
    ],
)
def test_units_and_middles(result, units, factor, middle, formula):
    shown = cut([middle - 4, middle - 1, middle + 1, middle + 4], middle) * factor
    (notice,) = direction_notices([result(units, shown)])
    assert formula in notice.message


@pytest.mark.parametrize("units", ["", "mph", "%", "°/s"])
def test_other_units_are_no_directions(result, units):
    assert direction_notices([result(units, [-179, -178, 178, 179])]) == []
