"""What people hold in Python: models and runs with the names that docs/python.md lists, and no others."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import numpy as np
import pytest
from simulated import simulated

import xlmc
from xlmc import api
from xlmc.analysis.studies.verify import Status
from xlmc.errors import DefinitionError, SimulationError, WorkbookError
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[2]
BOOK = ROOT / "examples" / "skid-100-ft.xlsx"
PAGE = ROOT / "docs" / "python.md"


@pytest.fixture(scope="module")
def book():
    return xlmc.load(BOOK)


@pytest.fixture(scope="module")
def run(book):
    return book.simulate(1_000)


def own_names(kind):
    return {name for name in dir(kind) if not name.startswith("_")}


def test_a_run_names_the_model_that_it_is_a_run_of(book, run):
    assert isinstance(run, xlmc.Simulation)
    assert isinstance(run.model, xlmc.Model)
    assert run.model.workbook is book.workbook


def test_an_opened_run_can_be_run_again(run, tmp_path):
    again = xlmc.open_run(run.keep(tmp_path / "a.xlmcrun")).model.simulate(1_000)
    assert {name: values.tolist() for name, values in again.forecasts.items()} == {
        name: values.tolist() for name, values in run.forecasts.items()
    }


def test_a_run_gives_what_the_result_in_it_gives(run):
    """Every property, and the result of a forecast by its name; a figure and files have tests of their own."""
    inner = simulated(load(BOOK), 1_000)
    public = xlmc.Simulation(inner)
    beside = {"impossible_scenarios", "model", "scenarios", "sentences", "weights"}
    properties = {
        name for name in own_names(xlmc.Simulation) if isinstance(getattr(xlmc.Simulation, name), property)
    } - beside
    assert all(getattr(public, name) == getattr(inner, name) for name in properties - {"trial_index"})
    assert public.trial_index is inner.trial_index
    assert public["distance while RESPONDING"] is inner["Distance while responding"]
    assert public.frame().equals(run.frame())


def test_a_model_gives_what_the_compiled_model_in_it_gives(book):
    inner = load(BOOK)
    public = xlmc.Model(inner)
    names = {name for name, each in vars(xlmc.Model).items() if isinstance(each, property)}
    assert all(getattr(public, name) == getattr(inner, name) for name in names)
    assert public.quantiles(0.5) == inner.quantiles(0.5) == book.quantiles(0.5)
    bases = {name: 1.0 if base is None else base for name, base in public.bases.items()}
    computed = public.function(bases)
    assert computed.keys() == {each.name for each in public.forecasts}
    assert all(np.isfinite(values).all() for values in computed.values())


@pytest.mark.parametrize(("kind", "title"), [(xlmc.Model, "Model"), (xlmc.Simulation, "Simulation")])
def test_the_public_names_are_those_that_the_page_lists(kind, title):
    section = PAGE.read_text("utf-8").partition(f"\n## `{title}`")[2].partition("\n## ")[0]
    listed = set(re.findall(r"^\| `(?:run|model)\.(\w+)", section, re.MULTILINE))
    assert listed == own_names(kind)


@pytest.mark.parametrize("name", [name for name in api.__all__ if name not in ("Model", "Simulation")])
def test_the_public_functions_are_on_the_page(name):
    assert f"`xlmc.{name}(" in PAGE.read_text("utf-8")
    assert inspect.getdoc(getattr(xlmc, name))


def test_what_the_package_offers_is_there():
    assert all(getattr(xlmc, name) is not None for name in xlmc.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = xlmc.nothing


@pytest.fixture(scope="module")
def crash():
    return xlmc.load(ROOT / "examples" / "intersection.xlsx")


@pytest.fixture(scope="module")
def crash_run(crash):
    return crash.simulate(20_000, seed=999)


def test_an_estimate_shows_itself_with_its_error():
    assert str(xlmc.Estimate(11.77412, 0.0418)) == repr(xlmc.Estimate(11.77412, 0.0418)) == "11.774 ± 0.042"


def test_a_quantile_is_the_percentile_of_its_share(crash_run):
    answer = crash_run["Nissan delta-V"]
    assert answer.quantile(0.95) == answer.percentile(95)
    with pytest.warns(UserWarning, match=r"quantile\(0\.95\)"):
        answer.percentile(0.95)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda run: run["Nissan delta-V"].probability_above("x"), "'x' is not a threshold"),
        (lambda run: run["Nissan delta-V"].quantile(95), "95 is not a share"),
        (lambda run: run["Nissan delta-V"].percentile(101), "101 is not a percentage"),
        (lambda run: run["Nissan delta-V"].central(float("nan")), "nan is not a share"),
        (lambda run: run.model.simulate(trials="many"), "`trials` is 'many'"),
        (lambda run: run.model.simulate(seed=1.5), "`seed` is 1.5"),
        (lambda run: run.model.simulate(jobs=True), "`jobs` is True"),
        (lambda run: run.model.simulate(until_accepted="all"), "'all' accepted trials were asked for"),
        (lambda run: run.plot(kind="pie"), "Choose one of histogram"),
        (lambda run: run.plot("speed of light"), "There is no forecast 'speed of light'"),
        (lambda run: run.model.with_(friction=1.0), "There is no assumption 'friction'"),
        (lambda run: run.model.with_(nissan_weight="heavy"), "'nissan_weight' cannot be 'heavy'"),
    ],
)
def test_what_cannot_be_meant_is_refused_in_words(crash_run, ask, words):
    with pytest.raises(SimulationError, match=re.escape(words)):
        ask(crash_run)


def test_whole_numbers_may_be_floats_and_numpy_integers(book):
    assert book.simulate(1e3).trials == book.simulate(np.int64(1_000)).trials == 1_000


def test_a_changed_model_draws_what_it_was_given(crash):
    changed = crash.with_({"Nissan weight": xlmc.Normal(3_500, 20)}, nissan_departure_angle=181, trials=8_192)
    run = changed.simulate(seed=1)
    weight = run.prior["Nissan weight"]
    assert abs(weight.mean() - 3_500) < 4 * 20 / np.sqrt(weight.size)
    assert "Nissan departure angle" not in run.inputs
    assert run.trials == 8_192
    assert crash.simulate(10, seed=1).inputs.keys() > run.inputs.keys()


def test_files_of_a_changed_model_say_and_hold_the_change(crash, tmp_path):
    run = crash.with_(nissan_weight=xlmc.Uniform(3_000, 3_100)).frozen("Chevrolet weight").simulate(20_000, seed=1)
    for path in (run.save(tmp_path / "a.xlsx"), run.keep(tmp_path / "a.xlmcrun")):
        result = xlmc.replay(path)
        assert result.identical
    words = xlmc.open_run(tmp_path / "a.xlmcrun")._run.changed_from.sentence
    assert "Nissan weight Uniform(3000, 3100); Chevrolet weight frozen" in words
    again = xlmc.load(tmp_path / "a.xlsx")
    assert next(a for a in again.assumptions if a.name == "Nissan weight").given == {"low": 3_000, "high": 3_100}


@pytest.mark.parametrize(
    ("family", "parameters"),
    [
        ("Uniform", (1.0, 2.0)),
        ("Triangular", (1.0, 1.2, 2.0)),
        ("Trapezoid", (1.0, 1.2, 1.5, 2.0)),
        ("BetaPERT", (1.0, 1.2, 2.0)),
        ("Normal", (1.0, 2.0)),
        ("Lognormal", (1.0, 2.0)),
        ("Exponential", (2.0,)),
        ("Gamma", (1.0, 2.0)),
        ("Weibull", (1.0, 2.0)),
        ("Beta", (1.0, 2.0)),
        ("Poisson", (3.0,)),
        ("DiscreteUniform", (1.0, 6.0)),
        ("YesNo", (0.3,)),
    ],
)
def test_distributions_have_the_mean_that_their_parameters_say(family, parameters):
    means = {
        "Uniform": 1.5,
        "Triangular": 1.4,
        "Trapezoid": (2.0**2 + 2.0 * 1.5 + 1.5**2 - 1.2**2 - 1.2 * 1.0 - 1.0**2) / (3 * (2.0 + 1.5 - 1.2 - 1.0)),
        "BetaPERT": (1.0 + 4 * 1.2 + 2.0) / 6,
        "Normal": 1.0,
        "Lognormal": 1.0,
        "Exponential": 0.5,
        "Gamma": 2.0,
        "Weibull": 0.886226925452758,
        "Beta": 1 / 3,
        "Poisson": 3.0,
        "DiscreteUniform": 3.5,
        "YesNo": 0.3,
    }
    given = getattr(xlmc, family)(*parameters)
    assert given.draw("x").distribution.mean() == pytest.approx(means[family])


def test_numbers_that_are_no_distribution_are_refused_at_once():
    with pytest.raises(DefinitionError, match=r"Low \(2\) is above High \(1\)"):
        xlmc.Uniform(2, 1)
    with pytest.raises(DefinitionError, match="made from data"):
        xlmc.Distribution("Custom", 1)
    with pytest.raises(TypeError, match="takes no unit"):
        xlmc.Uniform(0, 1, unit="m")


def test_a_frame_has_its_units(crash_run):
    units = crash_run.frame().attrs["units"]
    assert units["Nissan delta-V"] == "mph"
    assert units["Nissan weight"] == "lb"
    assert units.keys() == set(crash_run.frame().columns)


def test_a_notebook_shows_models_runs_and_figures(crash, crash_run):
    assert "Nissan weight" in crash._repr_html_()
    shown = crash_run._repr_html_()
    assert "Nissan delta-V" in shown
    assert "<svg" in shown
    assert crash_run.plot(kind="tornado")._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize("kind", ["histogram", "cumulative", "tornado", "scatter", "trend", "before-after"])
def test_a_picture_is_drawn_into_axes_that_are_given(crash_run, kind):
    from matplotlib.figure import Figure

    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert crash_run.plot(kind=kind, ax=right) is figure
    assert right.get_title(loc="left")
    assert not left.get_title(loc="left")


def test_the_names_of_the_package_are_offered():
    assert {"load", "model", "Uniform", "Estimate"} < set(dir(xlmc))


def test_studies_have_the_names_of_the_commands(tmp_path):
    book = ROOT / "examples" / "intersection.xlsx"
    assert xlmc.check(book) == ()
    assert not xlmc.verify(book).of(Status.DIFFERING)
    assert xlmc.fit([1.2, 1.3, 1.1, 1.5, 1.45, 1.33, 1.29]).fits
    assert xlmc.stability(xlmc.load(BOOK), trials=2_000).cells
    with pytest.raises(SimulationError, match="Choose one of"):
        xlmc.fit([1, 2, 3], by="r2")
    with pytest.raises(WorkbookError, match="already"):
        xlmc.convert(book, tmp_path / "b.xlsx")


def test_steps_are_told_by_either_name_of_the_argument(book):
    steps = {"tell": [], "told": []}
    for name, result in steps.items():
        xlmc.compare(book, book, trials=1_000, seed=1, causes=False, **{name: result.append})
    assert steps["tell"] == steps["told"] != []
