"""What a study may say of how far a method comes: nothing that its runs and theory do not know."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.studies.methods import recommendation, study
from xlmc.analysis.studies.methods.curve import Rms, in_order, rms_of
from xlmc.analysis.studies.methods.law import law
from xlmc.analysis.studies.methods.need import (
    Need,
    _verdict,
    choice,
    chosen_of,
    need,
    seconds_of,
    tied,
    worst_error,
)
from xlmc.analysis.studies.methods.recommendation import parts_of
from xlmc.analysis.studies.methods.study import LENGTHS, STEP, ladder_of
from xlmc.analysis.studies.steps import Steps

CONSISTENT = ("mc", "lhs", "sobol", "grid")


@pytest.mark.parametrize(
    ("seconds", "reaches", "usable"),
    [(1.0, "yes", True), (np.inf, "yes", False), (np.nan, "yes", False), (1.0, "no", False), (1.0, "unknown", False)],
)
def test_which_method_can_be_recommended(seconds, reaches, usable):
    assert Need(1000.0, seconds, "x", "mean", 1.0, reaches).usable is usable


@pytest.mark.parametrize(
    ("trials", "seconds"),
    [
        (100.0, 1.0),
        (200.0, 2.0),
        (250.0, 3.5),
        (300.0, 5.0),
        (600.0, 10.0),  # beyond the longest run, at its rate
        (50.0, 1.0),
        (np.inf, np.inf),
        (np.nan, np.inf),
    ],
)
def test_seconds_of_a_run(trials, seconds):
    """In proportion between the runs that were clocked; the one of 400 was not."""
    clocked = [(100, 1.0), (200, 2.0), (300, 5.0), (400, np.nan)]
    curve = SimpleNamespace(lengths=[SimpleNamespace(budget=b, seconds=s) for b, s in clocked])
    assert seconds_of(curve, trials) == pytest.approx(seconds)
    assert seconds_of(SimpleNamespace(lengths=curve.lengths[3:]), trials) == np.inf


@pytest.mark.parametrize(
    ("seconds", "result"),
    [
        ({"a": 10.0, "b": 12.0, "c": 12.01, "d": 9.9999}, "da"),
        ({"a": 10.0, "b": 12.0, "c": 12.01}, "ab"),
        ({"a": 0.25, "b": 0.125, "c": 0.225, "d": 0.2251}, "bc"),  # within a tenth of a second
        ({"a": 0.5, "b": 0.6, "c": 0.61}, "ab"),
    ],
)
def test_methods_within_a_fifth_or_a_tenth_of_a_second_tie(seconds, result):
    assert "".join(tied(seconds)) == result


@pytest.mark.parametrize(
    ("costs", "chosen"),
    [
        ({"mc": 3.0, "lhs": 2.0}, "mc"),
        ({"mc": 3.01, "lhs": 2.0}, "lhs"),
        ({"mc": 0.2, "lhs": 0.1}, "mc"),
        ({"mc": 0.2001, "lhs": 0.1}, "lhs"),
        ({"mc": 1.0, "lhs": 2.0}, "mc"),
        ({"mc": 9.0, "lhs": 2.0, "sobol": 1.0}, "sobol"),
    ],
)
def test_monte_carlo_is_chosen_unless_it_costs_much_more(costs, chosen):
    assert chosen_of(costs, "mc") == chosen


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(0.1, 0.5, "yes"), (0.1, 0.51, "unknown"), (0.5, 0.6, "unknown"), (0.51, 0.6, "no"), (0.0, 0.0, "yes")],
)
def test_an_error_between_two_bounds_beside_a_tolerance(low, high, verdict):
    assert _verdict(low, high, 0.5) == verdict


def with_errors(curve, change):
    """The curve with other errors: `change` takes the place of a runs and its error."""
    lengths = tuple(
        replace(runs, errors={kind: change(place, each) for kind, each in runs.errors.items()})
        for place, runs in enumerate(curve.lengths)
    )
    return replace(curve, lengths=lengths)


def curve_of(result, key):
    return next(curve for curve in (*result.once, *result.curves, *result.engines) if curve.method.key == key)


@pytest.mark.parametrize("key", CONSISTENT)
def test_no_noise_makes_a_method_that_converges_seem_not_to(small, key):
    """Errors that grow with the trials, and a mean error as large as they: chance, whatever the runs look like."""

    def grown(place, each):
        value = abs(each.value) * 4.0**place
        return Rms(value, value / 2, value, value / 4, each.n)

    result = need(small, with_errors(curve_of(small, key), grown))
    assert result.reaches == "yes"
    assert np.isfinite(result.trials)
    assert np.isfinite(result.seconds)


def test_of_independent_trials_theory_counts_and_not_the_noise_of_few_runs(small):
    """A fourth more or less error in every run would be half again as many trials; three runs cannot know that."""
    plain = curve_of(small, "mc")
    noisy = with_errors(plain, lambda _, each: replace(each, value=1.25 * each.value, spread=1.25 * each.spread))
    assert need(small, noisy).trials == need(small, plain).trials


def test_where_runs_contradict_theory_they_are_believed(small):
    plain = curve_of(small, "mc")
    far = with_errors(plain, lambda _, each: replace(each, spread=20.0 * each.spread, n=24))
    assert need(small, far).trials > 50.0 * need(small, plain).trials


def test_a_floor_is_found_where_there_is_one_and_left_open_where_runs_are_few(small):
    curve = curve_of(small, "surrogate")
    kind = ("Nissan impact speed", "mean")
    tolerance, theory = small.tolerance(kind[0]), small.reference.theory(*kind, 1)

    def law_with(mean_error, runs):
        generator = np.random.default_rng(3)

        def changed(place, _):
            spread = theory / curve.lengths[place].budget ** 0.5
            return rms_of(mean_error + spread * generator.standard_normal(runs))

        return law(small, with_errors(curve, changed), kind)

    # The longest runs have 144 accepted trials, and so an error of 8 tolerances by chance.
    assert law_with(100.0 * tolerance, 24).floor_low > tolerance
    open_ = law_with(0.0, 3)
    assert open_.floor_low < tolerance < open_.floor_high
    assert need(small, curve).reaches == "unknown"
    assert any(message.startswith("These runs cannot tell whether Surrogate") for message in recommendation(small))


def test_the_parts_of_a_miss_are_measured(small):
    """Without filters the mean is 8.897 mph, with them 4.742 (2·10⁹ trials made independently of this project)."""
    first = curve_of(small, "taylor-1")
    result = replace(
        worst_error(small, first), statistic="mean", error=first.lengths[0].errors["Nissan impact speed", "mean"].bias
    )
    parts = parts_of(small, result)
    assert parts.filters == pytest.approx(8.897 - 4.742, abs=0.06)
    assert parts.formulas == pytest.approx(-0.03, abs=0.03)
    assert parts.filters + parts.formulas == pytest.approx(result.error)


def test_filters_that_hardly_reject_are_not_blamed_for_curvature(book):
    """y = x⁴, kept below all but a thousandth of its trials: the straight line is off because y is no straight line."""
    model = book(
        {"A1": 0.5, "B1": "=A1^4", "C1": "=A1"},
        {"x": {"cell": "A1", "low": 0, "high": 1}},
        {"y": "B1"},
        {"not the last": {"cell": "C1", "below": 0.999}},
    )
    result = study(model, reference_trials=1 << 16, trials=1 << 10, replicates=2)
    first = curve_of(result, "taylor-1")
    parts = parts_of(result, worst_error(result, first))
    assert abs(parts.formulas) > 20.0 * abs(parts.filters)
    (message,) = [each for each in recommendation(result) if each.startswith("Taylor, first order misses")]
    assert "because it takes every curve for straight" in message.split("; ")[-1]


def test_a_forecast_that_crosses_zero_is_asked_for_no_more_than_another(book):
    """The same forecast about 0 and about 1,000."""
    needs = []
    for middle in (0, 1_000):
        model = book({"A1": 0.0, "B1": f"=A1+{middle}"}, {"x": {"cell": "A1", "low": -1, "high": 1}}, {"y": "B1"})
        result = study(model, reference_trials=1 << 16, trials=1 << 10, replicates=2)
        assert result.tolerance("y") == pytest.approx(0.01 * 1.8, rel=1e-3)
        needs.append(need(result, curve_of(result, "mc")).trials)
    assert needs[0] == pytest.approx(needs[1], rel=1e-3)
    assert needs[0] < 20_000


def test_an_answer_that_the_reference_cannot_judge_is_left_open(small):
    first = curve_of(small, "taylor-1")
    own = small.tolerance("Nissan impact speed")
    near = with_errors(first, lambda _, each: Rms(0.9 * own, own, 0.9 * own, np.nan, 1))
    judged = replace(small, once=tuple(near if curve is first else curve for curve in small.once))
    assert worst_error(judged, near).reaches == "unknown"
    assert any(
        "cannot tell whether Taylor, first order is near enough" in message for message in recommendation(judged)
    )


def test_times_never_fall_as_runs_grow(small):
    lengths = [
        replace(runs, seconds=seconds) for runs, seconds in zip(small.curves[0].lengths, (3.0, 1.0, 2.0), strict=True)
    ]
    assert [runs.seconds for runs in in_order(lengths)] == [1.0, 1.0, 2.0]
    curve = replace(small.curves[0], lengths=in_order(lengths))
    times = [seconds_of(curve, trials) for trials in (100, 512, 1_000, 2_048, 5_000, 8_192, 20_000)]
    assert times == sorted(times)


def test_beyond_the_longest_run_a_trial_costs_what_it_cost_there(small):
    """Half a second for 10,000 trials: 5·10⁹ take 250,000 s, however little the longest run took more than another."""
    first = small.curves[0].lengths[0]
    lengths = tuple(replace(first, budget=n, seconds=s) for n, s in ((1_000, 0.45), (2_000, 0.49), (10_000, 0.5)))
    assert seconds_of(replace(small.curves[0], lengths=lengths), 5e9) == pytest.approx(250_000.0)


def priced(result, seconds):
    """The study with runs that take so many seconds for the accuracy asked for, by method; the others take an hour."""

    def clocked(curve):
        each = seconds.get(curve.method.key, 3_600.0) / need(result, curve).trials
        return replace(curve, lengths=tuple(replace(runs, seconds=each * runs.budget) for runs in curve.lengths))

    return replace(result, curves=tuple(map(clocked, result.curves)), engines=tuple(map(clocked, result.engines)))


RULE = [
    ({"mc": 0.2, "lhs": 0.15}, "mc"),
    ({"mc": 0.2, "lhs": 0.11}, "mc"),  # a tenth of a second does not matter
    ({"mc": 2.0, "lhs": 1.4}, "mc"),
    ({"mc": 2.0, "lhs": 1.3}, "lhs"),
    ({"mc": 4.9, "mc/jit": 1.0}, "mc/jit"),
    ({"mc": 0.9, "mc/jit": 0.2}, "mc"),  # to compile takes half a second
    ({"mc": 1.2, "mc/jit": 0.2}, "mc/jit"),
    ({"mc": 2.0, "lhs": 0.6, "mc/jit": 0.2}, "lhs"),
    ({"mc": 2.0, "lhs": 1.0, "mc/jit": 0.2}, "mc/jit"),
]


@pytest.mark.parametrize(("seconds", "chosen"), RULE, ids=lambda each: str(each).strip("{}").replace("'", ""))
def test_what_is_recommended_costs_at_most_one_and_a_half_times_the_cheapest(small, seconds, chosen):
    result = choice(priced(small, seconds))
    assert result.chosen.method.key == chosen
    costs = {key: each + 0.5 * ("/" in key) for key, each in seconds.items()}
    assert costs[chosen] <= max(1.5 * min(costs.values()), min(costs.values()) + 0.1)


@pytest.mark.parametrize(
    ("seconds", "price"),
    [
        ({"mc": 0.9, "mc/jit": 0.2}, "it saves 0.7 s of the run, and takes about 0.5 s to compile."),
        ({"mc": 1.4, "lhs": 1.0}, "it saves 0.4 s, and gives up independent trials."),
        ({"mc": 9.0, "lhs": 0.6, "mc/jit": 0.2}, "it saves 0.4 s of the run, and takes about 0.5 s to compile."),
    ],
    ids=["an engine", "another sampling", "an engine beside another sampling"],
)
def test_what_is_cheaper_by_the_clock_only_has_its_price_said(small, seconds, price):
    (verdict, *_) = recommendation(priced(small, seconds))
    assert price in verdict


@pytest.mark.parametrize(
    ("beyond", "error", "message"), [(3.0, 0.3, True), (3.0, 0.01, False), (0.5, 0.3, False), (1e4, 0.6, True)]
)
def test_a_number_of_trials_that_no_run_had_is_given_with_its_error(small, monkeypatch, beyond, error, message):
    usual = choice(small)
    wanted = replace(usual.needs[usual.chosen], beyond=beyond, error=error)
    other = replace(usual, needs={**usual.needs, usual.chosen: wanted})
    monkeypatch.setattr(import_module("xlmc.analysis.studies.methods.recommendation"), "choice", lambda _: other)
    (verdict, *_) = recommendation(small)
    factor = f"The number of trials is computed, and known to a factor of {np.exp(2 * error):.2g}."
    assert (factor in verdict) == message
    assert ("as many trials as the longest measured runs had" in verdict) == (beyond == 1e4)


def with_reach(result, reach):
    """A Latin hypercube whose runs of 128, 512 … trials keep within so many tolerances, and what it then needs."""
    curve = curve_of(result, "lhs")
    kind = ("Nissan impact speed", "mean")

    def runs_of(place, times):
        value = times * result.tolerance(kind[0]) / 1.959964
        return replace(
            curve.lengths[-1],
            budget=128 * 4**place,
            converged=True,
            errors={kind: Rms(value, value / 4, 0.0, value, 8)},
        )

    lengths = tuple(runs_of(place, times) for place, times in enumerate(reach))
    return law(result, replace(curve, lengths=lengths), kind).trials(result.tolerance(kind[0]))


def test_runs_beside_a_jump_give_the_need_between_those_that_miss_and_those_that_keep(small):
    """As a percentile beside a gap: off by tens of tolerances up to 8,192 trials, by less than one from 32,768 on."""
    assert 8_192 < with_reach(small, (55.0, 69.0, 52.0, 48.0, 0.96, 0.69)) < 32_768
    assert with_reach(small, (60.0, 60.0, 60.0, 60.0, 60.0, 4.0)) == pytest.approx(16 * 131_072)
    assert with_reach(small, (0.9, 0.01, 0.9, 0.01, 0.9, 0.01)) == pytest.approx(128)
    line = [16.0 * 2.0**-place for place in range(6)]
    assert with_reach(small, line) == pytest.approx(128 * 16**2, rel=1e-6)
    bent = [times * (1.2, 0.85)[place % 2] for place, times in enumerate(line)]
    assert with_reach(small, bent) == pytest.approx(128 * 16**2, rel=0.15)


def test_methods_of_a_study_tie(timed):
    result = choice(timed)
    least = min(each.seconds for each in result.needs.values() if each.usable)
    for curve, each in result.needs.items():
        if each.usable:
            assert (curve in result.cheapest) == (each.seconds <= max(1.2 * least, least + 0.1))
    assert result.chosen.method.key == "mc"
    other = choice(replace(timed, accuracy=("0.001%", 1e-5, True)))
    seconds = {curve.method.key: each.seconds for curve, each in other.needs.items() if each.usable}
    assert 2.0 * min(seconds.values()) < seconds["mc"]
    assert seconds[other.chosen.method.key] == min(seconds.values())


def test_the_run_lengths_span_four_decades(book, monkeypatch):
    """However slow the machine is just now."""
    monkeypatch.setattr(import_module("xlmc.analysis.studies.methods.study"), "_LONGEST_RUN", np.inf)
    model = book({"A1": 0.0, "B1": "=A1"}, {"x": {"cell": "A1", "low": -1, "high": 1}}, {"y": "B1"})
    ladder = ladder_of(model, None, 1, 1.0, np.inf, Steps())
    assert ladder[0] == 128
    assert len(ladder) == LENGTHS
    assert ladder[-1] / ladder[0] == STEP ** (LENGTHS - 1) >= 10_000
    assert ladder_of(model, 1 << 13, 1, 0.01, np.inf, Steps()) == (512, 2_048, 8_192)
