"""The reference of a uniform answer, whose numbers are known; times and needs by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from xlmc.analysis.studies.methods.converged_reference import (
    Probe,
    _lost,
    _thinned,
    _width,
    probe_of,
    reference_of,
    unfiltered_of,
)
from xlmc.errors import SimulationError
from xlmc.montecarlo.statistics import Sample

N = 20_000
CELLS = {"A1": 0.5, "A2": 0.5, "B1": "=A1*10", "B2": "=A1>0.3", "B3": "=7+A1*0"}
INPUTS = {"u": {"cell": "A1", "low": 0.0, "high": 1.0}, "v": {"cell": "A2", "low": 0.0, "high": 1.0}}
FORECASTS = {"x": "B1", "wet": "B2", "fixed": "B3"}


@pytest.fixture(scope="module")
def model(model_of):
    return model_of(CELLS, INPUTS, FORECASTS, {"half": {"cell": "A2", "at_most": 0.5}})


@pytest.fixture(scope="module")
def reference(model):
    return reference_of(model, N, "mc", "numpy", 1)


def test_numbers_of_a_uniform_answer_and_their_errors(model, reference):
    n = reference.accepted
    assert (reference.trials, reference.sampling, reference.engine, reference.seed) == (N, "mc", "numpy", 1)
    assert n == pytest.approx(N / 2, abs=4 * math.sqrt(N / 4))
    assert reference.acceptance.value == n / N
    sd = 10 / math.sqrt(12)
    central = next(each.central for each in model.forecasts if each.name == "x")
    tail = (1 - central) / 2
    single = {
        "mean": sd,
        "sd": math.sqrt((10**4 / 80 - sd**4) / (4 * sd**2)),  # the fourth moment is w⁴/80
        "low": 10 * math.sqrt(tail * (1 - tail)),
        "high": 10 * math.sqrt(tail * (1 - tail)),
    }
    values = {"mean": 5.0, "sd": sd, "low": 10 * tail, "high": 10 * (1 - tail)}
    for statistic, value in values.items():
        error = single[statistic] / math.sqrt(n)
        assert getattr(reference.answers["x"], statistic) == pytest.approx(value, abs=4 * error)
        assert getattr(reference.errors["x"], statistic) == pytest.approx(error, rel=0.3)
        assert getattr(reference.single["x"], statistic) == pytest.approx(single[statistic], rel=0.3)
        theory = single[statistic] / math.sqrt(1000 * reference.acceptance.value)
        assert reference.theory("x", statistic, 1000) == pytest.approx(theory, rel=0.3)
    assert reference.widths["x"] == pytest.approx(9, abs=0.15)
    assert reference.widths["fixed"] == 0


def test_what_is_asked_of_an_answer(reference):
    assert all(reference.asks("x", statistic) for statistic in ("mean", "sd", "low", "high"))
    assert [reference.asks("wet", statistic) for statistic in ("mean", "sd", "low")] == [True, False, False]
    heavy = replace(reference, heavy={"x": ("sd",)})
    assert [heavy.asks("x", statistic) for statistic in ("mean", "sd")] == [True, False]


def test_the_width_of_an_answer_with_one_value_at_both_quantiles():
    x = np.array([*[0.0] * 96, 1.0, 1.0, 2.0, 3.0])
    answer = type("Answer", (), {"sd": 0.5, "mean": 0.07})
    assert _width(Sample(x), answer) == pytest.approx(3.289707 * 0.5)
    assert _width(Sample(np.arange(101.0)), answer) == pytest.approx(90)
    assert _width(Sample(x[:1]), answer) == 0
    tiny = type("Answer", (), {"sd": 1e-13, "mean": -0.2})
    assert _width(Sample(np.arange(101.0)), tiny) == 0
    assert _width(Sample(np.arange(101.0)), type("Answer", (), {"sd": math.nan, "mean": 0.0})) == 0


@pytest.mark.parametrize("extra", [0, 1])
def test_at_most_a_million_values_are_kept(extra):
    n = (1 << 20) + extra
    thinned = _thinned(np.arange(float(n)))
    assert thinned.size == 1 << 20
    assert (thinned[0], thinned[-1]) == (0, n - 1)
    np.testing.assert_array_equal(_thinned(np.arange(5.0)), np.arange(5))
    double = _thinned(np.arange(float(1 << 21)))
    np.testing.assert_array_equal(double[:3], [1, 3, 5])  # the upper of the two in each part


def test_statistics_without_an_end():
    """Of 1/u the tail has the index 1: no mean; of u^(-0.6) the index 1.67: a mean and no deviation."""
    u = (np.arange(50_000) + 0.5) / 50_000
    assert _lost(np.sort(1 / u)) == ("mean", "sd")
    assert _lost(np.sort(u**-0.6)) == ("sd",)
    assert _lost(np.sort(u)) == ()


@pytest.mark.parametrize(
    ("seconds", "accepted", "asked", "trials"),
    [
        (1.0, 65_536, 1.0, 65_536),
        (1.0, 65_536, 1.99, 65_536),
        (1.0, 65_536, 2.0, 131_072),
        (1.0, 65_536, 0.001, 16_384),
        (1.0, 65_536, 1e6, 1 << 22),  # no more are accepted
        (1.0, 32_768, 1e6, 1 << 23),
        (1.0, 0, 1e6, 1 << 25),
        (0.5, 0, 1.0, 131_072),
    ],
)
def test_how_many_trials_take_some_seconds(seconds, accepted, asked, trials):
    assert Probe(65_536, accepted, seconds, None).trials_in(asked) == trials


@pytest.mark.parametrize(("accepted", "sampling"), [(100, "sobol"), (99, "mc")])
def test_sobol_points_where_nothing_is_rejected(accepted, sampling):
    assert Probe(100, accepted, 1.0, None).sampling == sampling


def test_a_probe_has_a_reference_of_its_own(model):
    probe = probe_of(model, "numpy", 1, 1_000)
    assert (probe.trials, probe.accepted) == (1_000, probe.reference.accepted)
    assert probe.seconds >= probe.reference.seconds > 0
    assert probe_of(model, "numpy", 1, 150).reference is None


def test_a_reference_needs_a_hundred_accepted_trials(model):
    accepted = probe_of(model, "numpy", 1, 150).accepted
    assert accepted < 100
    with pytest.raises(SimulationError, match=f"accept {accepted} of 150 reference trials"):
        reference_of(model, 150, "mc", "numpy", 1)


@pytest.mark.parametrize(("factor", "refused"), [("1E150", True), ("1E149", False), ("-1E150", True)])
def test_answers_that_cannot_be_squared(model_of, factor, refused):
    cells = {"A1": 1.5, "B1": f"=A1*{factor}"}
    model = model_of(cells, {"u": {"cell": "A1", "low": 1.5, "high": 2.0}}, {"x": "B1"})
    if refused:
        with pytest.raises(SimulationError, match="beyond 1E150"):
            probe_of(model, "numpy", 1, 200)
    else:
        assert probe_of(model, "numpy", 1, 200).reference is not None


def test_without_the_filters(model, model_of, reference):
    free = unfiltered_of(model, reference)
    assert (free.accepted, free.sampling) == (N, "mc")
    plain = model_of(CELLS, INPUTS, FORECASTS)
    assert unfiltered_of(plain, reference_of(plain, 1_000, "mc", "numpy", 1)) is None
    lost = model_of({**CELLS, "B1": "=SQRT(0.5-A2)"}, INPUTS, FORECASTS, {"half": {"cell": "A2", "at_most": 0.5}})
    assert unfiltered_of(lost, reference_of(lost, 1_000, "mc", "numpy", 1)) is None


def test_what_an_end_needs(model, reference):
    forecast = next(each for each in model.forecasts if each.name == "x")
    need = reference.quantile_need(forecast, "low", 0.1)
    assert need is not None
    assert reference.quantile_need(forecast, "low", 0.0) is None
    assert replace(reference, ordered={}).quantile_need(forecast, "low", 0.1) is None
    assert replace(reference, ordered={"x": np.ones(1)}).quantile_need(forecast, "low", 0.1) is None
    fixed = next(each for each in model.forecasts if each.name == "fixed")
    assert reference.quantile_need(fixed, "low", 0.1) is None
