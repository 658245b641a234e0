from __future__ import annotations

import math
import re
from collections import Counter

import numpy as np
import pytest

from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.loop.forecast_result import ForecastResult


class Run:
    """What sentences need of a run: forecasts with `(m,)` values."""

    def __init__(self, values, faults=(), **definition):
        forecast = Forecast("speed", Cell("S", 1, 1), Cell("S", 1, 1), **definition)
        self.results = {"speed": ForecastResult(forecast, lambda: np.asarray(values, float), Counter(faults))}


def sentences(values, **definition):
    return [each.text for each in statements(Run(values, **definition))]


GRID = np.arange(100_000) / 1000.0  # 0 to 99.999, every percentile known


def test_a_range_that_is_surely_more_probable_than_not_is_called_so():
    assert sentences(GRID, units="mph", central=0.6) == [
        "speed: more probable than not (60.0 % ± 0.2 %) between 20.0 and 80.0 mph"
    ]


def test_one_that_may_be_even_odds_is_not():
    (text,) = sentences(GRID[::100], units="mph")
    assert text.endswith("; there are too few trials to call it more probable than not")
    (text,) = sentences(GRID, units="mph", central=0.4)
    assert text == "speed: 40.0 % ± 0.2 % between 30.0 and 70.0 mph"


@pytest.mark.parametrize(
    ("threshold", "text"),
    [
        (85.8, "P(speed > 85.8 mph) = 14.20 % ± 0.11 %"),
        (100.0, "P(speed > 100 mph): 0 of 100,000 trials; at most 0.0039 % with 95 % confidence"),
        (-1.0, "P(speed > -1 mph): all 100,000 trials; at least 99.9961 % with 95 % confidence"),
    ],
)
def test_the_threshold_has_a_sentence_of_its_own(threshold, text):
    assert sentences(GRID, units="mph", threshold=threshold)[1] == text


@pytest.mark.parametrize(
    ("asked", "text", "words"),
    [
        ((20.0, 80.5), "P(speed from 20 to 80.5 mph) = 60.5 % ± 0.2 %", "from 20 to 80.5 mph"),
        ((85.8, math.inf), "P(speed at least 85.8 mph) = 14.20 % ± 0.11 %", "at least 85.8 mph"),
        ((-math.inf, 10.0), "P(speed at most 10 mph) = 10.00 % ± 0.09 %", "at most 10 mph"),
    ],
)
def test_the_range_that_was_asked_for_has_a_sentence_and_a_certainty(asked, text, words):
    assert sentences(GRID, units="mph", asked=asked)[1] == text
    found = certainties(Run(GRID, units="mph", asked=asked).results["speed"])[-1]
    assert (found.kind, found.low, found.high, found.words) == ("asked", *asked, words)
    assert round(found.share.value * 100_000) == np.count_nonzero((asked[0] <= GRID) & (asked[1] >= GRID))
    assert sentences([], asked=asked) == ["speed: no accepted trial has a number"]


def test_trials_without_a_number_are_told_of():
    run = Run([*GRID, math.nan], ["#NUM!"], units="mph", central=0.6, threshold=85.8)
    among = "; counted in the 100,000 of 100,001 accepted trials in which it is a number"
    assert [each.text for each in statements(run)] == [
        f"speed: more probable than not (60.0 % ± 0.2 %) between 20.0 and 80.0 mph{among}",
        f"P(speed > 85.8 mph) = 14.20 % ± 0.11 %{among}",
    ]


def test_without_units_numbers_or_variation():
    assert sentences([], threshold=1.0) == ["speed: no accepted trial has a number"]
    assert sentences([math.nan, math.nan]) == ["speed: no accepted trial has a number"]
    assert sentences([2.0] * 40, units="mph") == ["speed: 2 mph in all 40 trials"]
    assert sentences([2.0], units="mph") == ["speed: 2 mph in the only trial"]
    assert sentences([0.0] * 900 + [1.0] * 100) == ["speed: more probable than not (90.0 % ± 0.9 %) equal to 0"]
    (text,) = sentences([1.0] * 20 + [2.0] * 20)
    assert re.fullmatch(r"speed: all 40 trials; at least [\d.]+ % with 95 % confidence, between 1 and 2", text)


@pytest.mark.parametrize("values", [GRID, GRID[:7], [1.0, 1.0, 2.0], [5.0]])
def test_below_between_and_above_are_all_trials(values):
    run = Run(values, units="mph", threshold=2.0)
    found = {each.kind: each for each in certainties(run.results["speed"])}
    whole = sum(found[kind].share.value for kind in ("below", "between", "above"))
    assert whole == pytest.approx(1.0, abs=1e-12)
    assert found["at most"].share.value + found["over"].share.value == pytest.approx(1.0, abs=1e-12)
    values = np.asarray(values)
    between = found["between"]
    inside = np.mean((values >= between.low) & (values <= between.high))
    assert between.share.value == pytest.approx(inside, abs=1e-12)
    assert found["over"].share.value == np.mean(values > 2.0)
    assert found["over"].words == "above 2 mph"
