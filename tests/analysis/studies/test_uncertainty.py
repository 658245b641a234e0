"""Two loops against closed forms: where one input is uncertain and another varies, every band is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from workbook_files import workbook_of

import xlmc
from xlmc.analysis.studies.uncertainty import uncertainty
from xlmc.errors import DefinitionError, SimulationError
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

Z95 = 1.6448536269514722


def sum_of_two(**more):
    """Mean + z, with a mean from 0 to 10 that is not known and a standard normal z."""
    return xlmc.model(
        lambda mean, z: {"y": mean + z},
        {"mean": xlmc.Uniform(0, 10), "z": xlmc.Normal(0, 1)},
        {"y": {"threshold": 5.0}},
        **more,
    )


@pytest.fixture(scope="module")
def result():
    return xlmc.uncertainty(sum_of_two(), uncertain=["mean"], outer=400, inner=2_000, seed=3)


def bands_of(result, name="y"):
    return {band.number: band for band in result[name].bands}


@pytest.mark.parametrize(
    ("number", "low", "high"),
    [
        ("mean", 0.5, 9.5),
        ("5th percentile", 0.5 - Z95, 9.5 - Z95),
        ("median", 0.5, 9.5),
        ("95th percentile", 0.5 + Z95, 9.5 + Z95),
        ("SD", 1.0, 1.0),
    ],
)
def test_the_ends_of_each_band_are_those_of_the_closed_form(result, number, low, high):
    band = bands_of(result)[number]
    noise = 2.0 / math.sqrt(2_000) * 2  # of a percentile of 2,000 trials, and twice that
    assert abs(band.low.value - low) < 4 * band.low.error + noise
    assert abs(band.high.value - high) < 4 * band.high.error + noise


def test_probabilities_have_bands(result):
    band = bands_of(result)["P(> 5)"]
    assert (band.low.value, band.high.value) == pytest.approx((0.0, 1.0), abs=1e-3)
    assert abs(band.pooled.value - 0.5) < 4 * band.pooled.error


def test_the_curve_of_all_trials_lies_within_its_band(result):
    each = result["y"]
    assert np.all(each.low <= each.curve)
    assert np.all(each.curve <= each.high)
    assert each.curve[len(each.curve) // 2] == pytest.approx(5.0, abs=0.1)


def test_the_friction_of_the_paper(unknown_mean):
    """Figures 3 and 4: bands from the uniform mean, and all trials as a uniform plus a normal."""
    path, _ = unknown_mean
    result = xlmc.uncertainty(xlmc.load(path), outer=400, inner=1_000, uncertain=["Mean friction", "Skid"])
    assert result.variable == ("Scatter of friction", "Friction")
    bands = bands_of(result, "Friction of the skid")
    for band, low, high in ((bands["mean"], 0.7075, 0.8425), (bands["median"], 0.7075, 0.8425)):
        assert abs(band.low.value - low) < 4 * band.low.error
        assert abs(band.high.value - high) < 4 * band.high.error
    pooled = bands["SD"].pooled
    variance = 0.15**2 / 12 + (0.03**2 + 0.03 * 0.07 + 0.07**2) / 3  # of the mean, and the mean of the scatter squared
    assert abs(pooled.value - math.sqrt(variance)) < 4 * pooled.error
    causes = result["Speed"].causes
    assert causes["Mean friction"].value > 0.95 > abs(causes["Skid"].value)


def test_a_row_says_what_is_uncertain(unknown_mean):
    path, _ = unknown_mean
    model = load(path)
    assert [a.name for a in model.assumptions if a.uncertain] == ["Mean friction", "Scatter of friction", "Skid"]
    result = uncertainty(model, outer=40, inner=50)
    assert (result.uncertain, result.variable) == (("Mean friction", "Scatter of friction", "Skid"), ("Friction",))


@pytest.mark.parametrize("engine", ["numpy", "jit", "formulas"])
@pytest.mark.parametrize("jobs", [1, 2])
def test_every_engine_gives_the_same_bands(unknown_mean, engine, jobs):
    path, expected = unknown_mean
    result = xlmc.uncertainty(xlmc.load(path), outer=40, inner=50, seed=5, engine=engine, jobs=jobs)
    assert [band.low.value for band in result["Speed"].bands] == pytest.approx(expected, rel=1e-12)


def test_an_outer_draw_counts_by_the_trials_that_filters_keep():
    """Of two equally likely means, a filter keeps a share a and b of the trials: they count as a to b."""
    model = xlmc.model(
        lambda side, z: {"y": side + 0 * z, "kept": z < np.where(side > 0.5, 0.9, 0.1)},
        {"side": xlmc.YesNo(0.5), "z": xlmc.Uniform(0, 1)},
        ["y"],
        ["kept"],
    )
    for confidence, low in ((85, 0.0), (75, 1.0)):  # a tenth of the trials has 0: more than 7.5 %, less than 12.5 %
        result = xlmc.uncertainty(model, uncertain=["side"], outer=400, inner=500, confidence=confidence)
        (band,) = result["y"].bands
        assert band.number == "probability of yes"
        assert band.pooled.value == pytest.approx(0.9, abs=0.02)
        assert (band.low.value, band.high.value) == (low, 1.0)


def test_outer_draws_without_accepted_trials_are_counted():
    model = xlmc.model(
        lambda mean, z: {"y": mean + z, "kept": mean + z > 9.0},
        {"mean": xlmc.Uniform(0, 10), "z": xlmc.Uniform(0, 1)},
        ["y"],
        ["kept"],
    )
    result = xlmc.uncertainty(model, uncertain=["mean"], outer=100, inner=50)
    assert result.empty == 80
    assert result["y"].draws == 20
    with pytest.raises(SimulationError, match="None of 2,000 trials was accepted"):
        xlmc.uncertainty(model.with_(mean=xlmc.Uniform(0, 1)), uncertain=["mean"], outer=20, inner=100)


def test_few_inner_trials_are_said_to_widen_the_band():
    """Of a standard normal z, ten trials scatter by 0.32 about a mean that is known to 0.29: a band 48 % too wide."""
    model = xlmc.model(lambda m, z: {"y": m + z}, {"m": xlmc.Uniform(0, 1), "z": xlmc.Normal(0, 1)}, ["y"])
    few = xlmc.uncertainty(model, uncertain=["m"], outer=2_000, inner=10)
    excess = bands_of(few)["mean"].excess
    truth = 1 / 12
    assert excess == pytest.approx(1 - math.sqrt(truth / (truth + 0.1)), abs=0.04)
    assert few.wide
    assert not xlmc.uncertainty(model, uncertain=["m"], outer=400, inner=4_000).wide


def test_correlated_uncertain_assumptions_stay_for_the_inner_trials():
    model = xlmc.model(
        lambda a, b, z: {"y": a + b + 0 * z, "d": a - b + 0 * z},
        {"a": xlmc.Normal(0, 1), "b": xlmc.Normal(0, 1), "z": xlmc.Uniform(0, 1)},
        ["y", "d"],
        correlations={("a", "b"): 0.8},
    )
    result = xlmc.uncertainty(model, uncertain=["a,b"], outer=500, inner=20)
    assert bands_of(result)["SD"].high.value == pytest.approx(0.0, abs=1e-12)
    ratio = bands_of(result)["mean"].high.value / bands_of(result, "d")["mean"].high.value
    r = 2 * math.sin(math.pi * 0.8 / 6)  # Pearson's, of a normal copula
    assert ratio == pytest.approx(math.sqrt((1 + r) / (1 - r)), rel=0.15)


def test_what_cannot_be_asked_is_refused():
    model = sum_of_two()
    with pytest.raises(DefinitionError, match="No assumption that a forecast or filter needs is Uncertain"):
        xlmc.uncertainty(model)
    for options, message in (
        ({"outer": 19}, "19 outer draws"),
        ({"outer": 20_000}, "20,000 outer draws"),
        ({"inner": 1}, "1 inner trials"),
        ({"confidence": 100}, "confidence of 100 %"),
        ({"percents": [0]}, "0 is no percentile"),
        ({"judged": ["nothing"]}, "No forecast has the name 'nothing'"),
        ({"uncertain": ["nothing"]}, "No assumption that is drawn has the name 'nothing'"),
    ):
        with pytest.raises(SimulationError, match=message):
            xlmc.uncertainty(model, **{"uncertain": ["mean"], **options})
    tied = xlmc.model(
        lambda a, b: {"y": a + b},
        {"a": xlmc.Normal(0, 1), "b": xlmc.Normal(0, 1)},
        ["y"],
        correlations={("a", "b"): 0.5},
    )
    with pytest.raises(DefinitionError, match="'a' is Uncertain and correlated with 'b', which is Variable"):
        xlmc.uncertainty(tied, uncertain=["a"])


def test_an_uncertain_assumption_must_not_depend_on_a_variable_one(tmp_path):
    heads = ["Name", "Value", "Low", "High", "Kind of uncertainty"]
    rows = [heads, ["a", 1, 0, 2, "variable"], ["b", 1, "=B2-1", "=B2+1", "UNCERTAIN"]]
    path = tmp_path / "book.xlsx"
    tables = {"xlmc_assumptions": "Inputs!A1:E3", "xlmc_forecasts": "Model!A1:B2"}
    workbook_of({"Inputs": rows, "Model": [["Name", "Value"], ["y", "=Inputs!B2+Inputs!B3"]]}, tables).save(path)
    with pytest.raises(DefinitionError, match="'b' is Uncertain, and its distribution depends on 'a'"):
        xlmc.uncertainty(xlmc.load(path))


def test_an_unknown_word_is_refused_with_its_cell(tmp_path):
    rows = [["Name", "Value", "Low", "High", "Kind of uncertainty"], ["a", 1, 0, 2, "uncertian"]]
    path = tmp_path / "book.xlsx"
    tables = {"xlmc_assumptions": "Inputs!A1:E2", "xlmc_forecasts": "Model!A1:B2"}
    workbook_of({"Inputs": rows, "Model": [["Name", "Value"], ["y", "=Inputs!B2"]]}, tables).save(path)
    with pytest.raises(DefinitionError, match=r"'uncertian' is unknown") as caught:
        load(path)
    assert "Inputs!E2" in str(caught.value)
    assert "Did you mean uncertain?" in caught.value.hint


@pytest.mark.parametrize("inner", [1, 7, 1_000])
def test_a_nested_plan_draws_the_same_whatever_the_blocks(inner):
    plan = SamplingPlan.nested(["a"], 30, inner)
    whole = np.empty(30 * inner)
    uncertain, variable = plan.margins(1, ["a", "b"])
    uncertain.uniforms(0, whole)
    assert np.unique(whole).size == 30
    assert np.array_equal(np.sort(np.floor(whole[::inner] * 30)), np.arange(30))  # a Latin hypercube
    parts = [np.empty(size) for size in (1, 5, 30 * inner - 6)]
    start = 0
    for part in parts:
        uncertain.uniforms(start, part)
        start += part.size
    assert np.array_equal(np.concatenate(parts), whole)
    drawn = np.empty(30 * inner)
    variable.uniforms(0, drawn)
    assert np.unique(drawn).size == drawn.size


def test_values_that_are_all_the_same_have_no_deviation():
    model = xlmc.model(lambda m, z: {"y": m / 3 + 0 * z}, {"m": xlmc.Uniform(0, 1), "z": xlmc.Uniform(0, 1)}, ["y"])
    deviation = bands_of(xlmc.uncertainty(model, uncertain=["m"], outer=100, inner=37))["SD"]
    assert (deviation.low.value, deviation.high.value) == (0.0, 0.0)


def test_draws_that_filters_keep_differently_say_as_much_as_fewer():
    """Of draws that keep a share m of their trials, uniform, as many say as much as (Σm)²/Σm² = ¾ of all."""
    model = xlmc.model(
        lambda m, z: {"y": m + z, "kept": z < m}, {"m": xlmc.Uniform(0, 1), "z": xlmc.Uniform(0, 1)}, ["y"], ["kept"]
    )
    result = xlmc.uncertainty(model, uncertain=["m"], outer=400, inner=200)
    assert result["y"].effective == pytest.approx(300, rel=0.02)


def test_trials_that_errors_take_are_told():
    """The root is no number in half of the trials of a mean around 0."""
    model = xlmc.model(
        lambda mean, z: {"y": np.sqrt(mean + z)}, {"mean": xlmc.Uniform(-1, 1), "z": xlmc.Uniform(-2, 2)}, ["y"]
    )
    assert "Errors in cells take up to 50 % of the trials: what is said of y concerns those" in str(
        xlmc.uncertainty(model, uncertain=["mean"], outer=100, inner=2_000)
    )
