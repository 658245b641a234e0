"""Models that a function of Python computes: the same answers as a workbook's, and refusals in words."""

from __future__ import annotations

import numpy as np
import pytest

import xlmc
from xlmc import Normal, Triangular, Uniform
from xlmc.errors import DefinitionError, FormulaError, SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.scenarios import Frozen, Limits, Numbers, Range, Scenario, Typed

G = 9.80665


def skid(friction, distance, grade):
    speed = np.sqrt(2 * G * (friction + grade) * distance)
    return {"Speed": 3.6 * speed, "Energy": speed**2 / 2, "Possible": distance > 24}


RANGES = {
    "friction": Uniform(0.6, 0.8, source="tests"),
    "distance": Normal(25, 0.5, units="m"),
    "grade": Triangular(-0.02, 0, 0.02),
}


@pytest.fixture(scope="module")
def model():
    limits = {"Possible": {"because": "gouges"}, "Speed": {"above": 62, "because": "recorder"}}
    forecasts = {"Speed": {"units": "km/h", "threshold": 65}, "Energy": "J/kg"}
    return xlmc.model(skid, RANGES, forecasts, limits)


@pytest.fixture(scope="module")
def run(model):
    return model.simulate(20_000, seed=3)


def test_every_trial_is_what_the_function_gives_for_its_draws(run):
    result = skid(**run.inputs)
    assert np.array_equal(run.forecasts["Speed"], result["Speed"])
    assert np.array_equal(run.forecasts["Energy"], result["Energy"])


def test_filters_keep_exactly_what_they_say(run):
    assert (run.inputs["distance"] > 24).all()
    assert (run.forecasts["Speed"] > 62).all()
    draws = run.prior
    result = skid(**draws)
    assert run.accepted == int((result["Possible"] & (result["Speed"] > 62)).sum())


def test_answers_agree_with_the_textbook():
    """The mean square of the speed is 2 g E(f) E(s), for independent friction and length."""
    run = xlmc.model(lambda f, s: 2 * G * f * s, {"f": Uniform(0.6, 0.8), "s": Normal(25, 0.5)}, ["v2"]).simulate(
        100_000
    )
    mean = run["v2"].mean
    assert abs(mean.value - 2 * G * 0.7 * 25) < 4 * mean.error


@pytest.mark.parametrize("options", [{"engine": "jit"}, {"jobs": 2}, {"scheduler": "threads", "jobs": 2}])
def test_however_it_is_run_the_trials_are_the_same(model, run, options):
    again = model.simulate(20_000, seed=3, **options)
    assert np.array_equal(again.trial_index, run.trial_index)
    assert np.array_equal(again.forecasts["Speed"], run.forecasts["Speed"])


@pytest.mark.parametrize(
    "options", [{"sampling": "lhs"}, {"sampling": "sobol"}, {"until_accepted": 500, "rare": "always"}]
)
def test_other_ways_of_sampling_agree(model, run, options):
    other = model.simulate(20_000, seed=4, **options) if "sampling" in options else model.simulate(seed=4, **options)
    apart = other["Speed"].mean.value - run["Speed"].mean.value
    assert abs(apart) < 5 * np.hypot(other["Speed"].mean.error, run["Speed"].mean.error)


def test_a_trial_without_a_number_is_counted():
    run = xlmc.model(lambda x: np.log(x), {"x": Uniform(-1, 1)}, ["y"]).simulate(10_000)
    assert run.faults["y"]["#NUM!"] == int((run.inputs["x"] <= 0).sum()) > 4_000
    assert run.warnings


def test_correlations_are_drawn():
    run = xlmc.model(
        lambda a, b: a + b, {"a": Uniform(0, 1), "b": Uniform(0, 1)}, ["y"], correlations={("a", "b"): 0.8}
    ).simulate(20_000)
    frame = run.frame()
    assert frame["a"].corr(frame["b"], method="spearman") == pytest.approx(0.8, abs=0.02)


def test_every_file_is_written_and_names_the_function(run, tmp_path):
    pages = [run.save(tmp_path / "a.xlsx"), run.save_page(tmp_path / "a.html"), run.save_json(tmp_path / "a.json")]
    assert all(path.stat().st_size > 10_000 for path in pages)
    with pytest.raises(DefinitionError, match=r"Python function .*skid computes 'Speed'.*Run it from Python"):
        xlmc.load(tmp_path / "a.xlsx")
    with pytest.raises(DefinitionError, match=r"Run it from Python.*open_run\(path, model\)"):
        xlmc.open_run(run.keep(tmp_path / "a.xlmcrun"))


def test_the_record_says_how_to_repeat_it(run):
    from xlmc.analysis.results.record import make_record

    assert make_record(run._run)["run.repeat"] == ("in Python, of the model of skid: simulate(trials=20000, seed=3)")


def test_studies_work_on_it(model, run):
    influences = xlmc.sensitivities(run)["Speed"].influences
    assert influences[0].assumption == "friction"
    held = xlmc.screen(model, "50 %", trials=4_000).joint.names
    assert "grade" in held
    assert "friction" not in held
    names = ("friction", "distance")
    simpler = xlmc.model(
        lambda friction, distance: skid(friction, distance, 0.0)["Speed"],
        {name: RANGES[name] for name in names},
        {"Speed": "km/h"},
    )
    assert xlmc.compare(model, simpler, trials=4_000).simpler == 1
    with pytest.raises(SimulationError, match="no formulas to look through"):
        xlmc.stability(model)


def test_it_can_be_changed_and_frozen(model):
    held = model.frozen("grade").simulate(2_000)
    assert "grade" not in held.inputs
    other = model.with_(friction=Uniform(0.7, 0.9), trials=2_000).simulate()
    assert other.trials == 2_000
    assert other.inputs["friction"].min() > 0.7


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda x: float(x), "failed: TypeError"),
        (lambda x: x[:1].repeat(2), r"with the shape \(2,\) for 1 trial"),
        (lambda x: {"z": x}, "does not give 'y'"),
        (lambda x: np.full(x.shape, "a"), "gives texts instead of real numbers, as 'y'"),
        (lambda x: np.full(x.shape, "1.5"), "gives texts instead of real numbers, as 'y'"),
        (lambda x: np.array([None] * x.size), "gives objects instead of real numbers, as 'y'"),
        (lambda x: x + 1j, "gives complex numbers instead of real numbers, as 'y'"),
        (lambda x: np.ma.masked_greater(x, 0.4), r"gives a masked array, and not result.filled\(numpy.nan\), as"),
        (lambda x: np.full(x.shape, "2026-01-01", "M8[D]"), "gives dates instead of real numbers, as 'y'"),
        (lambda z: z, "failed: TypeError"),
        (lambda x: x + np.random.default_rng().random(x.shape), "for the same values"),
    ],
)
def test_a_function_that_cannot_be_used_is_refused(function, message):
    with pytest.raises(FormulaError, match=message):
        xlmc.model(function, {"x": Uniform(0, 1)}, ["y"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (({}, ["y"]), "at least one assumption"),
        (({"x": Uniform(0, 1)}, []), "at least one forecast"),
        (({"x": 3}, ["y"]), "The assumption 'x' is 3. Give a distribution"),
        (({"x": Uniform(0, 1), "X": Uniform(0, 1)}, ["y"]), "only in the case of their names"),
        (({"x": Uniform(0, 1)}, {"y": {"unit": "m"}}), "cannot have"),
        (({"x": Uniform(0, 1)}, ["y"], {"y": {"at_least": 1, "below": 0}}), "contradict each other"),
    ],
)
def test_definitions_that_cannot_be_used_are_refused(arguments, message):
    with pytest.raises(DefinitionError, match=message):
        xlmc.model(lambda **given: next(iter(given.values())), *arguments)


def test_other_processes_are_refused_in_words(model):
    with pytest.raises(SimulationError, match="Use threads"):
        model.simulate(100_000, jobs=2, scheduler="processes")


CHANGES = {
    "as it is": lambda model: model,
    "held at a value": lambda model: model.with_(friction=0.7),
    "other settings": lambda model: model.with_(trials=900),
    "frozen": lambda model: model.frozen("grade", "distance"),
    "another family": lambda model: model.with_(distance=xlmc.Weibull(20, 6, 3, units="yd", source="chain")),
    "cut off": lambda model: model.with_(distance=Normal(25, 0.5, lower_cutoff=24.5)),
    "twice": lambda model: model.with_(friction=Triangular(0.6, 0.7, 0.8)).frozen("distance"),
    "limits": lambda model: model.scenario(Scenario("other limits", (Limits("Speed", {"above": None, "below": 70}),))),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_changed_model_is_saved_and_read_back_equal(model, tmp_path, change):
    run = CHANGES[change](model).simulate(1_000, seed=2)
    run.save(tmp_path / "a.xlsx")
    run.save_report(tmp_path / "a.docx")
    opened = xlmc.open_run(run.keep(tmp_path / "a.xlmcrun"), model)
    assert opened.accepted == run.accepted > 0
    for name, values in run.forecasts.items():
        assert np.array_equal(opened.forecasts[name], values)
    assert {name: result.statistics.mean for name, result in opened.results.items()} == {
        name: result.statistics.mean for name, result in run.results.items()
    }
    assert [(a.name, a.units, a.source, a.frozen, a.given, a.base) for a in opened.model.assumptions] == [
        (a.name, a.units, a.source, a.frozen, a.given, a.base) for a in run.model.assumptions
    ]
    influences = [
        [(i.assumption, i.explained) for i in xlmc.sensitivities(r)["Speed"].influences] for r in (run, opened)
    ]
    assert influences[0] == influences[1]
    for file in ("a.xlsx", "a.xlmcrun"):
        assert xlmc.replay(tmp_path / file, model=model).to_the_last_bit


def test_a_saved_run_is_not_opened_beside_another_function(run, tmp_path):
    path = run.keep(tmp_path / "a.xlmcrun")
    same = {"Possible": {"because": "gouges"}, "Speed": {"above": 62, "because": "recorder"}}
    forecasts = {"Speed": {"units": "km/h", "threshold": 65}, "Energy": "J/kg"}
    other = xlmc.model(lambda **x: {**skid(**x), "Energy": x["grade"]}, RANGES, forecasts, same)
    with pytest.raises(SimulationError, match="gives other numbers as 'Energy'"):
        xlmc.open_run(path, other)
    fewer = xlmc.model(lambda friction: friction, {"friction": RANGES["friction"]}, {"Speed": "km/h"})
    with pytest.raises(DefinitionError, match="does not hold it"):
        xlmc.open_run(path, fewer)


def test_frozen_without_names_changes_nothing(model):
    assert repr(model.frozen()) == repr(model)
    assert model.frozen().simulate(100)._run.changed_from is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(
    "change",
    [
        lambda value: Frozen("friction", value),
        lambda value: Range("friction", 0.5, value),
        lambda value: Numbers("distance", {"lower_cutoff": value}),
        lambda value: Limits("Speed", {"above": value}),
        lambda value: Typed(Cell("Model", 3, 1), value),
    ],
)
def test_no_change_is_to_something_else_than_a_number(model, change, value):
    with pytest.raises(DefinitionError, match="no cell can hold"):
        model.scenario(Scenario("odd", (change(value),)))
    with pytest.raises(DefinitionError, match="no cell can hold"):
        model.with_(friction=value)


@pytest.mark.parametrize("name", ["ROW", "INDEX", "a/b: c?", "LAMBDA"])
def test_a_model_may_have_any_name(name, tmp_path):
    run = xlmc.model(lambda x: 2 * x, {"x": Uniform(1, 2)}, ["y"], name=name).simulate(1_000)
    assert np.array_equal(run.forecasts["y"], 2 * run.inputs["x"])
    assert run.save(tmp_path / "a.xlsx").is_file()
