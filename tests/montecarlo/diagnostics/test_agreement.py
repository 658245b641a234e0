"""Verdicts of evidence whose answers are known: quantities that are normal, and readings of them."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest
from scipy.special import ndtr
from simulated import simulated

from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.diagnostics.agreement import ItemAgreement, Verdict, agreement
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.statistics import Estimate

CELLS = {
    "A1": 0.0,
    "B1": 0.0,
    "C1": "=A1*1",
    "D1": "=A1+B1",
    "E1": "=A1-B1",
    "F1": "=IF(A1>-9,B1*1,0)",
    "G1": "=A1/1000",
}
NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}
INPUTS = {"a": {"cell": "A1", **NORMAL}, "b": {"cell": "B1", **NORMAL}}
SEED, TRIALS = 3, 60_000


@pytest.fixture(scope="module")
def judged(book):
    """The agreement of items of evidence, each a cell, a reading and an error."""

    def judge(trials=TRIALS, filters=None, **items):
        evidence = {name: {"cell": cell, "reading": reading, **error} for name, (cell, reading, error) in items.items()}
        model = book(CELLS, INPUTS, {"a": "C1", "sum": "D1"}, filters, evidence=evidence)
        return agreement(model, SEED, trials)

    return judge


def bell(sigma):
    return {"error": "normal", "std_dev": sigma}


def within(tolerance):
    return {"plus_minus": tolerance}


def close(result, truth):
    """Within four standard errors."""
    return abs(result.value - truth) < 4 * result.error


def test_one_item_keeps_what_is_known_and_its_weights_give_the_known_answers(judged):
    """X ~ N(0, 1), a reading of 1 with a standard deviation of 0.5: the share is √0.2·exp(-0.4)."""
    result = judged(EDR=("C1", 1, bell(0.5)))
    (item,) = result.items
    assert close(result.together, 0.299776)
    assert result.effective / result.past == pytest.approx(0.420470, rel=0.02)
    weighted = next(each for each in result.answers if each.used == "all evidence" and each.forecast == "a")
    assert close(weighted.mean, 0.8)
    assert close(weighted.standard_deviation, 0.447214)
    assert weighted.effective == pytest.approx(result.effective)
    assert item.chance == pytest.approx(2 * ndtr(-1 / math.hypot(1, 0.5)), rel=0.02)
    assert item.best_z < 0.01
    assert item.mean_z == pytest.approx(0.4, abs=0.02)
    assert result.verdict is Verdict.INDEPENDENT
    assert "there is no other item" in result.sentence


def test_a_sharp_reading_in_the_middle_is_not_strained_though_it_keeps_hardly_a_trial(judged):
    result = judged(sharp=("C1", 0, within(0.001)))
    assert result.items[0].alone.value < 0.002
    assert result.items[0].chance > 0.95
    assert re.fullmatch("9[5-9] %|100 %", result.items[0].chance_text)
    assert result.verdict is Verdict.INDEPENDENT


@pytest.mark.parametrize(
    ("cell", "reading", "error", "verdict"),
    [
        ("C1", 2.3, within(0.2), Verdict.INDEPENDENT),
        ("C1", 2.9, within(0.2), Verdict.STRAINED),
        ("C1", 2.9, bell(0.2), Verdict.STRAINED),
        ("C1", 3.6, within(0.2), Verdict.INCONSISTENT),
        ("C1", 3.6, bell(0.2), Verdict.INCONSISTENT),
        ("C1", 9.0, bell(2.0), Verdict.INCONSISTENT),
        ("C1", 9.0, within(1.0), Verdict.INCONSISTENT),
        ("C1", -9.0, within(1.0), Verdict.INCONSISTENT),
        ("G1", 2.9, bell(1.0), Verdict.STRAINED),
        ("G1", -2.9, bell(1.0), Verdict.STRAINED),
        ("G1", 3.1, bell(1.0), Verdict.INCONSISTENT),
        ("G1", -3.1, bell(1.0), Verdict.INCONSISTENT),
        ("C1", 1.0, {"error": "at least"}, Verdict.INDEPENDENT),
        ("C1", 2.8, {"error": "at least"}, Verdict.STRAINED),
        ("C1", 9.0, {"error": "at least"}, Verdict.INCONSISTENT),
        ("C1", 1.0, {"error": "at least", "std_dev": 0.1}, Verdict.INDEPENDENT),
        ("C1", 9.0, {"error": "at least", "std_dev": 0.1}, Verdict.INCONSISTENT),
        ("C1", -9.0, {"error": "at least", "std_dev": 0.1}, Verdict.INDEPENDENT),
        ("C1", -9.0, {"error": "at most", "std_dev": 0.1}, Verdict.INCONSISTENT),
        ("C1", 9.0, {"error": "at most"}, Verdict.INDEPENDENT),
    ],
)
def test_where_a_reading_lies_decides(judged, cell, reading, error, verdict):
    assert judged(item=(cell, reading, error)).verdict is verdict


def test_a_chance_that_no_trial_shows_is_told_as_a_bound(judged):
    """Of 800 trials, none lies near 5.5: below Wilson's upper end on both sides, 2 × 1.96²/(800 + 1.96²)."""
    result = judged(trials=100, item=("C1", 5.5, bell(0.1)))
    assert (result.trials, result.verdict) == (800, Verdict.STRAINED)
    assert result.items[0].chance < 1e-30
    assert result.items[0].chance_text == "below 0.96 %"
    assert result.sentence == "'item' is strained: given the model, a reading so far out has a chance below 0.96 %"


@pytest.mark.parametrize(
    ("chance", "effective", "text"),
    [
        (0.37, 1_000.0, "37 %"),
        (0.0999, 1_000.0, "10 %"),
        (0.0213, 1_000.0, "2.1 %"),
        (0.002, 1_000.0, "0.2 %"),
        (0.0019, 1_000.0, "below 1.1 %"),
        (0.0, 1_000.0, "below 0.77 %"),
        (math.nan, 1_000.0, ""),
    ],
)
def test_a_chance_is_a_number_where_a_trial_on_each_side_shows_it(chance, effective, text):
    """Half of the chance lies on each side; from one trial there on it is told, and else Wilson's upper end."""
    nothing = Estimate(math.nan)
    item = ItemAgreement(None, nothing, nothing, nothing, chance, effective, None, None, Verdict.INDEPENDENT)
    assert item.chance_text == text


def test_items_about_one_quantity_corroborate_and_others_are_independent(judged):
    result = judged(EDR=("C1", 0.5, bell(0.5)), video=("C1", 0.4, within(0.5)))
    assert {each.verdict for each in result.items} == {result.verdict} == {Verdict.CORROBORATES}
    assert result.ratio.value > 1.5
    for each in result.items:
        assert each.ratio.value == pytest.approx(result.ratio.value)
        assert each.given_others.value == pytest.approx(each.ratio.value * each.alone.value)
    assert "corroborate each other" in result.sentence
    apart = judged(EDR=("C1", 0.5, bell(0.5)), other=("F1", 1.0, within(0.5)))
    assert apart.verdict is Verdict.INDEPENDENT
    assert close(apart.ratio, 1.0)
    pulls = judged(EDR=("C1", 1.2, bell(0.7)), video=("C1", -0.5, bell(0.7)))
    assert pulls.verdict is Verdict.PULLS_APART


def test_readings_far_from_all_trials_that_agree_best_are_inconsistent_however_few_each_leaves(judged):
    """Two readings of one quantity, 30 standard deviations apart; either leaves some 900 trials of 20,000."""
    result = judged(trials=20_000, one=("C1", 1.5, bell(0.1)), two=("C1", -1.5, bell(0.1)))
    assert all(100 < each.effective < 2_000 for each in result.items)
    assert result.effective > 100
    assert {each.verdict for each in result.items} == {Verdict.INCONSISTENT}
    assert result.conflicts


def test_two_sound_items_may_be_inconsistent_with_each_other(judged):
    result = judged(EDR=("C1", 1.5, within(0.2)), video=("C1", -1.5, within(0.2)))
    assert result.verdict is Verdict.INCONSISTENT
    assert result.conflicts
    assert result.together.value == result.ratio.value == 0.0
    assert "no trial agrees with 'EDR' and 'video' together. Alone they keep" in result.sentence
    assert [each.used for each in result.answers[:4]] == [
        "no evidence",
        "all evidence",
        "EDR alone, without video",
        "video alone, without EDR",
    ]
    assert math.isnan(result.answers[1].mean.value)
    alone = next(each for each in result.answers if each.items == ("EDR",))
    assert abs(alone.mean.value - 1.487) < 0.02  # of N(0, 1) between 1.3 and 1.7


def test_three_items_are_each_left_out(judged):
    result = judged(x=("C1", 0.5, bell(0.5)), y=("F1", 0.5, bell(0.5)), z=("D1", 4.5, bell(0.2)))
    last = result.items[2]
    assert last.verdict is Verdict.INCONSISTENT  # given the other two the sum is N(0.8, 0.4)
    assert last.chance == pytest.approx(2 * ndtr(-(4.5 - 0.8) / math.sqrt(0.44)), rel=0.5)
    used = [each.used for each in result.answers if each.forecast == "a"]
    assert used[:2] == ["no evidence", "all evidence"]
    assert used[2:] == ["all but x", "all but y", "all but z", "x alone", "y alone", "z alone"]


def test_few_trials_are_said_to_be_few(judged):
    rare = {"rare": {"cell": "E1", "at_least": 4.4}}
    result = judged(2_000, rare, EDR=("C1", 1.0, within(0.5)))
    assert result.trials == 8 * 2_000  # so many are drawn where few pass the filters
    assert 0 < result.past < 100
    assert result.verdict is Verdict.TOO_FEW
    assert "too few trials to tell" in result.sentence
    assert result.remarks[0] == result.sentence


def test_inputs_that_press_against_their_ends_are_named(judged, book):
    cells = {"A1": 0.5, "B1": 0.5, "C1": "=A1+B1"}
    both = {name: {"cell": cell, "low": 0, "high": 1} for name, cell in (("a", "A1"), ("b", "B1"))}
    evidence = {"EDR": {"cell": "C1", "reading": 1.95, "error": "at least"}}
    result = agreement(book(cells, both, {"a": "C1"}, evidence=evidence), SEED, 2 * TRIALS)
    assert [(each.assumption, each.end) for each in result.pressed] == [("a", "upper"), ("b", "upper")]
    assert all(each.share > 0.99 for each in result.pressed)
    assert "the range, not the evidence, decides" in result.remarks[-1]
    assert not judged(EDR=("C1", 1, bell(0.5))).pressed


UNIFORM = {"low": 0, "high": 1}
TRIANGULAR = {"distribution": "Triangular", "low": 0, "likeliest": 0.5, "high": 1}
NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}
CUT = {**NORMAL, "upper_cutoff": 1}
EXPONENTIAL = {"distribution": "Exponential", "rate": 1}


@pytest.mark.parametrize(
    ("prior", "reading", "error", "ends"),
    [
        (UNIFORM, 0.97, bell(0.002), []),
        (UNIFORM, 0.03, bell(0.002), []),
        (UNIFORM, 0.97, bell(0.01), []),
        (UNIFORM, 0.999, bell(0.0002), []),
        (UNIFORM, 0.97, {"error": "at least"}, ["upper"]),
        (UNIFORM, 0.03, {"error": "at most"}, ["lower"]),
        (UNIFORM, 0.999, bell(0.01), ["upper"]),
        (UNIFORM, 1.02, bell(0.02), ["upper"]),
        (TRIANGULAR, 0.98, bell(0.01), []),
        (TRIANGULAR, 1.03, bell(0.04), ["upper"]),
        (NORMAL, 2.5, bell(0.05), []),  # it has no limit
        (CUT, 0.97, bell(0.002), []),
        (CUT, 1.05, bell(0.05), ["upper"]),
        (EXPONENTIAL, 4.0, bell(0.05), []),
        (EXPONENTIAL, 0.001, bell(0.02), ["lower"]),
    ],
    ids=str,
)
def test_the_range_decides_only_where_draws_pile_up_at_its_limit(book, prior, reading, error, ends):
    model = book(
        {"A1": 0.5, "C1": "=A1+0"},
        {"x": {"cell": "A1", **prior}},
        {"x": "C1"},
        evidence={"EDR": {"cell": "C1", "reading": reading, **error}},
    )
    for seed in (SEED, SEED + 1, SEED + 2):
        result = agreement(model, seed, 100_000)
        assert [each.end for each in result.pressed] == ends
        assert bool(ends) == any("the range, not the evidence" in each for each in result.remarks)


def test_filters_of_some_forecasts_hold_for_what_evidence_moves(book):
    model = book(CELLS, INPUTS, {"a": "C1", "sum": "D1"}, evidence={"EDR": {"cell": "D1", "reading": 0, **bell(9.0)}})
    cell = model.forecasts[0].cell
    own = Filter("positive", cell, cell, at_least=0.0, only_for=("a",))
    definitions = replace(model.definitions, forecast_filters=(own,))
    result = agreement(CompiledModel(model.workbook, definitions, model.path), SEED, TRIALS)
    means = {each.forecast: each.mean for each in result.answers if each.used == "no evidence"}
    assert close(means["a"], math.sqrt(2 / math.pi))  # of the half of N(0, 1) above 0
    assert close(means["sum"], 0.0)
    assert result.past == TRIALS


def test_what_is_an_error_agrees_with_nothing(book):
    cells = {"A1": 0.0, "C1": "=SQRT(A1)"}
    model = book(cells, {"a": INPUTS["a"]}, {"a": "A1"}, evidence={"EDR": {"cell": "C1", "reading": 1, **bell(0.5)}})
    result = agreement(model, SEED, TRIALS)
    alone = next(each for each in result.answers if each.used == "all evidence")
    assert alone.mean.value > 0.3
    run = simulated(model, trials=TRIALS, seed=SEED)
    assert run.accepted / run.trials == pytest.approx(result.together.value, rel=0.03)
