from __future__ import annotations

import math
import re
from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.stating import Kind, Role
from xlmc.montecarlo.loop.forecast_result import ForecastResult


class Run:
    """What sentences need of a run: forecasts with `(m,)` values."""

    def __init__(self, values, faults=(), category="rung 1", **definition):
        forecast = Forecast("speed", Cell("S", 1, 1), Cell("S", 1, 1), **definition)
        result = ForecastResult(forecast, lambda: np.asarray(values, float), Counter(faults), two_valued=True)
        self.results = {"speed": result}
        self.model = SimpleNamespace(workbook=SimpleNamespace(category=category))


def sentences(values, **definition):
    return [each.text for each in statements(Run(values, **definition))]


GRID = np.arange(100_000) / 1000.0  # 0 to 99.999, every percentile known


def test_a_range_that_is_surely_more_probable_than_not_is_called_so():
    [message] = sentences(GRID, units="mph", central=0.51)
    assert message.startswith("speed: more probable than not (5")


def test_another_range_is_called_by_its_share():
    assert sentences(GRID, units="mph", central=0.6) == [
        "speed: the 60 % range (60.0 % ± 0.2 %) lies between 20.0 and 80.0 mph"
    ]


@pytest.mark.parametrize("central", [0.4, 0.51, 0.8])
def test_books_that_are_not_about_crashes_call_every_range_by_its_share(central):
    (message,) = sentences(GRID, units="EUR", central=central, category="")
    assert message.startswith(f"speed: the {100 * central:.0f} % range (")
    assert " lies between " in message
    (bound,) = sentences(GRID, units="EUR", central=central, category="", role=Role.LOWER)
    assert ", with a probability of at least " in bound


@pytest.mark.parametrize("n", [5, 12, 40, 300, 1000, 20_000])
@pytest.mark.parametrize("report_to", [None, 0.01, 1.0, 5.0])
@pytest.mark.parametrize("factor", [1.0, 0.731])  # proportional in every trial, and so both are stated or neither
def test_a_range_is_rounded_outwards_until_it_is_more_probable_than_not(n, report_to, factor):
    values = factor * np.random.default_rng(n).normal(40.0, 6.0, n)
    result = {each.kind: each for each in certainties(Run(values, report_to=report_to).results["speed"])}["between"]
    assert result.share.interval[0] > 0.5
    assert result.share.value == np.mean((values >= result.low) & (values <= result.high))
    if report_to is not None and report_to >= 1.0:
        assert (result.low % report_to, result.high % report_to) == (0.0, 0.0)
    (text,) = sentences(values, units="mph", report_to=report_to)
    assert "more probable than not (" in text or f" in all {n} trials" in text


def test_three_trials_cannot_tell_and_a_range_below_even_odds_claims_nothing():
    (text,) = sentences([1.0, 2.0, 4.0], units="mph")
    assert "more probable" not in text.partition(";")[0]
    (text,) = sentences(GRID, units="mph", central=0.4)
    assert text == "speed: 40.0 % ± 0.2 % between 30.0 and 70.0 mph"


@pytest.mark.parametrize(
    ("report_to", "text"),
    [
        (1.0, "between 24 and 75 mph"),
        (0.25, "between 24.50 and 75.50 mph"),
        (5.0, "between 25 and 80 mph"),
        (10.0, "between 20 and 80 mph"),
        (100.0, "between 0 and 100 mph"),
        (1e-6, "between 24.5 and 75.5 mph"),  # finer than the trials support
    ],
)
def test_answers_are_stated_at_the_resolution_that_is_asked_for(report_to, text):
    (result,) = sentences(GRID, units="mph", report_to=report_to)
    assert result.removesuffix(" in all 100,000 trials; at least 99.9961 % with 95 % confidence").endswith(text)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (22.0, "speed: 22 mph in all 40 trials"),
        (22.4, "speed: between 22 and 23 mph in all 40 trials; at least 91.2 % with 95 % confidence"),
    ],
)
def test_a_constant_is_stated_within_the_resolution(value, text):
    (result,) = sentences([value] * 40, units="mph", report_to=1.0)
    assert result == text


@pytest.mark.parametrize(
    ("role", "definition", "texts"),
    [
        (Role.LOWER, {}, ["speed: at least 48 mph, more probable than not (52.0 % ± 0.2 %)"]),
        (Role.UPPER, {}, ["speed: at most 52 mph, more probable than not (52.0 % ± 0.2 %)"]),
        (Role.LOWER, {"threshold": 85.8}, ["P(speed > 85.8 mph) ≥ 14.20 % ± 0.11 %"]),
        (Role.UPPER, {"threshold": 85.8}, ["P(speed > 85.8 mph) ≤ 14.20 % ± 0.11 %"]),
        (Role.LOWER, {"threshold": 200.0}, ["P(speed > 200 mph): the bound does not tell"]),
        (Role.UPPER, {"threshold": -5.0}, ["P(speed > -5 mph): the bound does not tell"]),
        (Role.UPPER, {"asked": (-math.inf, 10.0)}, ["P(speed at most 10 mph) ≥ 10.00 % ± 0.09 %"]),
        (Role.LOWER, {"asked": (-math.inf, 10.0)}, ["P(speed at most 10 mph) ≤ 10.00 % ± 0.09 %"]),
        (Role.LOWER, {"asked": (10.0, 20.0)}, ["P(speed from 10 to 20 mph): the bound does not tell"]),
        (Role.DIAGNOSTIC, {"threshold": 85.8, "asked": (10.0, 20.0)}, []),
    ],
    ids=str,
)
def test_bounds_are_stated_on_one_side_and_diagnostics_not_at_all(role, definition, texts):
    result = sentences(GRID, units="mph", report_to=2.0, role=role, **definition)
    assert result[-len(texts) :] == texts if texts else result == []


@pytest.mark.parametrize("role", [Role.LOWER, Role.UPPER])
@pytest.mark.parametrize("central", [0.4, 0.51, 0.95])
def test_the_two_sides_of_a_bound_are_all_trials(role, central):
    values = np.random.default_rng(5).gamma(2.0, 3.0, 4000)
    result = {each.kind: each for each in certainties(Run(values, role=role, central=central).results["speed"])}
    assert sum(each.share.value for each in result.values()) == pytest.approx(1.0, abs=1e-12)
    between = result["between"]
    assert between.share.value == np.mean((values >= between.low) & (values <= between.high)) >= central
    assert (between.high if role is Role.LOWER else -between.low) == math.inf


@pytest.mark.parametrize(
    ("ones", "text"),
    [
        (842, "speed: yes with probability 84.2 % ± 1.2 %, more probable than not"),
        (100, "speed: yes with probability 10.0 % ± 0.9 %, so no is more probable than yes"),
        (505, "speed: yes with probability 50 % ± 2 %"),
        (0, "speed: yes in 0 of 1,000 trials; at most 0.39 % with 95 % confidence"),
        (1000, "speed: yes in all 1,000 trials; at least 99.61 % with 95 % confidence"),
    ],
)
@pytest.mark.parametrize("kind", [None, Kind.YES_NO])
def test_a_yes_or_no_is_a_probability(ones, text, kind):
    values = [0.0] * (1000 - ones) + [1.0] * ones
    assert sentences(values, kind=kind) == [text]


@pytest.mark.parametrize(
    ("role", "ones", "text"),
    [
        (Role.LOWER, 842, "yes with a probability of at least 84.2 % ± 1.2 %, more probable than not"),
        (Role.LOWER, 100, "yes with a probability of at least 10.0 % ± 0.9 %"),
        (Role.LOWER, 0, "the bound does not tell"),
        (Role.UPPER, 842, "yes with a probability of at most 84.2 % ± 1.2 %"),
        (Role.UPPER, 100, "yes with a probability of at most 10.0 % ± 0.9 %, so no is more probable than yes"),
        (Role.UPPER, 1000, "the bound does not tell"),
        (Role.UPPER, 0, "yes in 0 of 1,000 trials; at most 0.39 % with 95 % confidence"),
    ],
)
@pytest.mark.parametrize("kind", [None, Kind.YES_NO])
def test_a_bound_of_a_yes_or_no_says_one_side_alone(role, ones, text, kind):
    assert sentences([0.0] * (1000 - ones) + [1.0] * ones, kind=kind, role=role) == [f"speed: {text}"]


def test_which_of_yes_and_no_is_more_probable_is_told_of_crashes_alone():
    assert sentences([0.0] * 900 + [1.0] * 100, category="") == ["speed: yes with probability 10.0 % ± 0.9 %"]


def test_other_numbers_are_a_yes_and_numbers_stay_numbers_where_the_row_says_so():
    (text,) = sentences([0.0, 2.0, 3.0, 4.0] * 100, kind=Kind.YES_NO)
    assert text.startswith("speed: yes with probability 75 % ± 2 %, more probable than not; numbers other than 0 and 1")
    (text,) = sentences([0.0] * 900 + [1.0] * 100, kind=Kind.NUMBER)
    assert text == "speed: more probable than not (90.0 % ± 0.9 %) equal to 0"


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
    result = certainties(Run(GRID, units="mph", asked=asked).results["speed"])[-1]
    assert (result.kind, result.low, result.high, result.words) == ("asked", *asked, words)
    assert round(result.share.value * 100_000) == np.count_nonzero((asked[0] <= GRID) & (asked[1] >= GRID))
    assert sentences([], asked=asked) == ["speed: no trial is accepted"]


def test_trials_without_a_number_are_told_of():
    run = Run([*GRID, math.nan], ["#NUM!"], units="mph", central=0.6, threshold=85.8)
    among = "; counted in the 100,000 of 100,001 accepted trials in which it is a number"
    assert [each.text for each in statements(run)] == [
        f"speed: the 60 % range (60.0 % ± 0.2 %) lies between 20.0 and 80.0 mph{among}",
        f"P(speed > 85.8 mph) = 14.20 % ± 0.11 %{among}",
    ]


def test_without_units_numbers_or_variation():
    assert sentences([], threshold=1.0) == ["speed: no trial is accepted"]
    assert sentences([math.nan, math.nan], kind=Kind.NUMBER) == ["speed: no accepted trial has a number"]
    assert sentences([2.0] * 40, units="mph") == ["speed: 2 mph in all 40 trials"]
    assert sentences([42.35203596] * 40, units="mph") == ["speed: 42.352 mph in all 40 trials"]
    assert sentences([1234567.25] * 40, units="mph") == ["speed: 1,234,567.25 mph in all 40 trials"]
    assert sentences([2.0], units="mph") == ["speed: 2 mph in the only trial"]
    assert sentences([0.0] * 900 + [2.0] * 100) == ["speed: more probable than not (90.0 % ± 0.9 %) equal to 0"]
    (text,) = sentences([1.0] * 20 + [2.0] * 20)
    assert re.fullmatch(r"speed: between 1 and 2 in all 40 trials; at least [\d.]+ % with 95 % confidence", text)


@pytest.mark.parametrize("values", [GRID, GRID[:7], [1.0, 1.0, 2.0], [5.0]])
def test_below_between_and_above_are_all_trials(values):
    run = Run(values, units="mph", threshold=2.0)
    result = {each.kind: each for each in certainties(run.results["speed"])}
    whole = sum(result[kind].share.value for kind in ("below", "between", "above"))
    assert whole == pytest.approx(1.0, abs=1e-12)
    assert result["at most"].share.value + result["over"].share.value == pytest.approx(1.0, abs=1e-12)
    values = np.asarray(values)
    between = result["between"]
    inside = np.mean((values >= between.low) & (values <= between.high))
    assert between.share.value == pytest.approx(inside, abs=1e-12)
    assert result["over"].share.value == np.mean(values > 2.0)
    assert result["over"].words == "above 2 mph"


@pytest.mark.parametrize(("threshold", "messages"), [(0.5, 1), (0.0, 1), (1.0, 2), (-1.0, 2)])
def test_that_a_yes_is_above_one_half_is_not_told_again(threshold, messages):
    values = np.repeat([0.0, 1.0], [30, 70])
    assert len(sentences(values, threshold=threshold)) == messages
