"""Evidence by weights: the known posterior of a normal quantity, and when a run takes weights by itself."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from xlmc.analysis.results.statements.sentences import certainties, statements
from xlmc.api import Simulation, sensitivities
from xlmc.errors import SimulationError
from xlmc.montecarlo.diagnostics.weighing import Weighting
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.statistics import Sample
from xlmc.outputs.filter_effect import filter_effect_of
from xlmc.outputs.histogram import figures_of, histogram

CELLS = {"A1": 0.0, "B1": "=A1*1", "C1": "=EXP(A1/2)"}
X = {"x": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1}}


@pytest.fixture(scope="module")
def model(book):
    def make(reading=1.0, sigma=0.5, filters=None, **more):
        evidence = {"EDR": {"cell": "B1", "reading": reading, "error": "normal", "std_dev": sigma}, **more}
        return book(CELLS, X, {"y": "B1"}, filters, evidence=evidence)

    return make


def close(result, truth):
    """Within four standard errors."""
    return abs(result.value - truth) < 4 * result.error


def test_weights_give_the_known_posterior_and_effective_sample_size(model):
    """X ~ N(0, 1), a reading of 1 with a standard deviation of 0.5: mean 0.8, SD √0.2, mean weight √0.2·exp(-0.4)."""
    run = simulate(model(), trials=200_000, evidence="weights")
    weighting, result = run.weighting, run["y"]
    assert run.settings.evidence == "weights"
    assert run.accepted == 200_000
    spread = math.sqrt(0.299776**2 * (1 / 0.420470 - 1) / 200_000)  # of the mean weight
    assert abs(weighting.mean - 0.299776) < 4 * spread
    assert weighting.effective / run.accepted == pytest.approx(0.420470, rel=0.01)
    assert weighting.largest == pytest.approx(1.0, abs=1e-6)
    assert close(result.mean, 0.8)
    assert close(result.standard_deviation, 0.447214)
    assert close(result.percentile(95), 0.8 + 1.644854 * 0.447214)
    known = math.sqrt((1 / 9 + (8 / 9 - 0.8) ** 2) / 0.420470 / 200_000)  # of w²(x - 0.8)², as w² is a bell, too
    assert result.mean.error == pytest.approx(known, rel=0.02)
    assert all(close(each.share, truth) for each, truth in zip(certainties(result), (0.245, 0.51, 0.245), strict=False))
    (figure,) = figures_of(run)
    assert figure.bins.counted == round(weighting.effective)
    middle = float(
        np.average(figure.bins.edges + figure.bins.width / 2, weights=figure.bins.inside + figure.bins.outside)
    )
    assert middle == pytest.approx(0.8, abs=0.01)


def test_with_every_assumption_frozen_all_trials_weigh_the_same(book):
    frozen = {"x": X["x"] | {"frozen": True}}
    evidence = {"EDR": {"cell": "B1", "reading": 1.0, "error": "normal", "std_dev": 0.5}}
    run = simulate(book({**CELLS, "A1": 0.5}, frozen, {"y": "B1"}, evidence=evidence), trials=100, evidence="weights")
    assert run.weighting.weights.tolist() == [1.0] * 100
    chance = pytest.approx(math.exp(-0.5))  # a standard deviation from the reading
    assert (run.weighting.largest, run.weighting.mean) == (chance, chance)
    assert run["y"].mean.value == 0.5


def test_trials_with_hardly_any_weight_are_counted_wherever_trials_are(book):
    """exp(-z²/2) of z = (A1 - 3)/0.2 is far below any weight that a sample keeps in most trials."""
    evidence = {"EDR": {"cell": "B1", "reading": 3.0, "error": "normal", "std_dev": 0.2}}
    weighed = book({**CELLS, "D1": "=7+0*A1"}, X, {"y": "B1", "still": "D1"}, evidence=evidence)
    run = simulate(weighed, trials=20_000, evidence="weights")
    assert run["y"].sample.n < 19_000
    assert {result.statistics.trials for result in run.results.values()} == {20_000}
    assert [each.text for each in statements(run) if each.forecast == "still"] == ["still: 7 in all 20,000 trials"]
    assert filter_effect_of(run, "x").accepted.trials == 20_000


def test_filters_and_limits_still_reject_and_a_lognormal_error_weights_too(book):
    evidence = {
        "damage": {"cell": "C1", "reading": math.exp(0.5), "error": "lognormal", "std_dev": 0.5},
        "video": {"cell": "B1", "reading": 0.0, "error": "at least"},
    }
    weighed = book(CELLS, X, {"y": "B1"}, evidence=evidence)
    run = simulate(weighed, trials=100_000, evidence="weights")
    rejected = simulate(weighed, trials=100_000)
    assert run.accepted == pytest.approx(50_000, rel=0.02)
    assert rejected.settings.evidence == "rejection"
    assert run["y"].mean.value == pytest.approx(rejected["y"].mean.value, abs=5 * rejected["y"].mean.error)
    assert run.agreement.together.value == pytest.approx(rejected.accepted / rejected.trials, rel=0.05)


def test_a_run_takes_weights_by_itself_where_rejection_would_keep_too_few(model):
    def way(trials, reading=1.0, setting="auto", **more):
        return simulate(model(reading), trials=trials, evidence=setting, **more).settings.evidence

    assert way(20_000) == "rejection"  # keeps 6,000
    assert way(2_000) == "rejection"  # it would keep 600, but weights leave no more than 840
    assert way(2_000, setting="weights") == "weights"
    assert way(20_000, reading=3.5) == "weights"


def test_a_goal_rejects_and_weights_with_a_goal_are_refused(model):
    from xlmc.montecarlo.definitions.stopping import stopping

    goal = stopping(until_accepted=50)
    assert simulate(model(3.0), stopping=goal, evidence="auto").settings.evidence == "rejection"
    with pytest.raises(SimulationError, match="cannot weight its trials"):
        simulate(model(), stopping=goal, evidence="weights")
    with pytest.raises(SimulationError, match="A run with scenarios cannot weight"):
        simulate(model(), trials=10, evidence="weights", scenarios=True)
    with pytest.raises(SimulationError, match="'sometimes' is not a method to use evidence"):
        simulate(model(), trials=10, evidence="sometimes")


def test_without_a_normal_error_there_is_nothing_to_weight(book):
    evidence = {"EDR": {"cell": "B1", "reading": 1.0, "plus_minus": 0.5}}
    run = simulate(book(CELLS, X, {"y": "B1"}, evidence=evidence), trials=1_000, evidence="weights")
    assert run.weighting is None
    assert run.settings.evidence == ""


def test_percentiles_beyond_which_few_effective_trials_lie_are_not_given(model):
    run = simulate(model(2.5, 0.5), trials=600, evidence="weights")
    effective, result = run.weighting.effective, run["y"]
    assert 5 < effective < 200
    share = 100 * 10 / effective
    assert math.isnan(result.percentile(max(0.0, share - 1)).value)
    if share < 49:
        assert not math.isnan(result.percentile(share + 1).value)
    assert math.isnan(result.statistics.percentiles[0.0].value)
    assert any("say as much as" in str(notice) for notice in run.notices_of_run)
    fewer = simulate(model(4.0, 0.1), trials=500, evidence="weights")
    assert math.isnan(fewer["y"].central()[0].value)
    assert "too few effective trials" in statements(fewer)[0].text
    assert figures_of(fewer) == []


def test_any_engine_and_any_number_of_processes_give_the_same_weights(model):
    one = simulate(model(), trials=70_000, evidence="weights")
    for more in ({"engine": "jit"}, {"jobs": 2, "scheduler": "threads"}):
        other = simulate(model(), trials=70_000, evidence="weights", **more)
        assert np.array_equal(one.weighting.weights, other.weighting.weights)
    lhs = simulate(model(), trials=70_000, evidence="weights", sampling="lhs")
    assert close(replace(lhs["y"].mean), 0.8)


def test_a_weighted_sample_is_as_even_as_its_effective_size():
    sample = Sample.of([1.0, 2.0, 3.0, 4.0], [1.0, 1.0, 1.0, 0.0])
    assert sample.even.tolist() == sample.quantile(np.array([1, 3, 5]) / 6).tolist()
    assert Sample.of([1.0, 2.0], [0.0, 0.0]).even.size == 0
    assert Sample.of([3.0, 1.0]).even.tolist() == [1.0, 3.0]
    result = histogram(sample, 1.0, 3.0)
    assert result.counted == 3


def test_sensitivities_of_weighted_trials_are_refused_in_python(model):
    """They would count all trials alike, which is another answer."""
    run = simulate(model(), trials=2_000, evidence="weights")
    with pytest.raises(SimulationError, match=r'Evidence weights the trials of this run.*evidence="rejection"'):
        sensitivities(Simulation(run))


@pytest.mark.parametrize(
    ("weights", "most", "effective", "rows"),
    [
        ([1.0, 1.0, 1.0, 1.0], 4, 4.0, [0, 1, 2, 3]),
        ([1.0, 0.0, 1.0, 0.0], 4, 2.0, [0, 2]),
        ([1.0, 0.5, 0.5, 0.0], 4, 8 / 3, [0, 1]),  # at a quarter and three quarters of 2
        ([0.1, 0.1, 1.0], 3, 1.44 / 1.02, [2]),  # one of equal weight, in the middle of 1.2
        ([1.0, 1.0, 1.0, 1.0], 2, 4.0, [0, 1]),
        ([0.5] * 6, 6, 6.0, [0, 1, 2, 3, 4, 5]),
        ([0.0, 0.0, 1.0], 2, 1.0, []),
        ([], 5, 0.0, []),
    ],
)
def test_rows_of_equal_weight(weights, most, effective, rows):
    """As many as (Σw)²/Σw², at equal steps of the weights added up."""
    result = Weighting(np.array(weights), 0.5, 1.0)
    assert result.effective == pytest.approx(effective)
    assert result.even_rows(most).tolist() == rows
