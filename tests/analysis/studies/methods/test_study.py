from __future__ import annotations

import re
import signal
import time
from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from xlmc.analysis.studies.methods import STATISTICS, recommendation, study
from xlmc.analysis.studies.methods.converged_reference import reference_of
from xlmc.analysis.studies.methods.curve import rms_of, runs_of, slope_of
from xlmc.analysis.studies.methods.need import need, reach_of, worst_error
from xlmc.analysis.studies.methods.optimised import in_step
from xlmc.analysis.studies.methods.sampled import MONTE_CARLO
from xlmc.analysis.studies.methods.study import MANY, quick_settings
from xlmc.errors import SimulationError
from xlmc.outputs.methods import methods_report, methods_tables

module = import_module("xlmc.analysis.studies.methods.study")

REPLICATES, TRIALS = 100, 8_192


def straight_book(book):
    """y = 2x + z without filters: Taylor's first order has its mean and SD exactly."""
    return book(
        {"A1": 0.5, "B1": 1.0, "C1": "=10+2*A1+B1"},
        {
            "x": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
            "z": {"cell": "B1", "distribution": "Normal", "mean": 0, "std_dev": 1},
        },
        {"y": "C1"},
    )


@pytest.fixture
def straight(book):
    return straight_book(book)


@pytest.fixture(scope="module")
def reference(case_study):
    return reference_of(case_study, 1 << 21, "mc", "jit", 3)


def test_sampling_errors_are_what_theory_says(case_study, reference):
    """100 runs know a root mean square to 7 %, the reference the density at a quantile to 8; 30 % is far more."""
    results = [MONTE_CARLO.run(case_study, TRIALS, 1_000 + seed) for seed in range(REPLICATES)]
    runs = runs_of(TRIALS, results, reference)
    for forecast in case_study.forecasts:
        for statistic in STATISTICS:
            theory = reference.theory(forecast.name, statistic, TRIALS)
            own = getattr(reference.errors[forecast.name], statistic)
            assert runs.errors[forecast.name, statistic].value == pytest.approx(np.hypot(theory, own), rel=0.3)
    share = reference.acceptance.value
    assert runs.acceptance.value == pytest.approx((share * (1 - share) / TRIALS) ** 0.5, rel=0.3)


def test_theory_is_that_of_the_independent_reference(reference):
    """Theory of 131,072 trials for the filtered means, mph; SDs of two million trials are known to 0.7 %."""
    for name, error in zip(reference.answers, (0.0154, 0.0295, 0.0367, 0.0417), strict=True):
        assert reference.theory(name, "mean", 131_072) == pytest.approx(error, rel=0.03)


def test_every_method_is_there(small):
    keys = [curve.method.key for curve in small.every]
    assert keys[:5] == ["corners", "optimised", "worst-case", "taylor-1", "taylor-2"]
    assert keys[5:10] == ["mc", "lhs", "sobol", "grid", "surrogate"]
    assert keys[10:] == ["mc/jit", "mc/formulas"]
    assert small.absent == {}
    assert small.ladder == (512, 2_048, 8_192)
    assert [runs.converged for runs in small.curves[0].lengths] == [False, True, True]


def test_what_every_method_tells(small):
    for curve in small.every:
        assert curve.lengths[-1].seconds > 0.0
        assert curve.lengths[-1].evaluations >= 1
        if curve.method.errors != "once":
            assert all(np.isfinite(curve.lengths[-1].shares[each]) for each in STATISTICS)
            assert curve.lengths[-1].acceptance is not None
    grid = next(curve for curve in small.curves if curve.method.key == "grid")
    assert grid.lengths[-1].effective > 0


def test_an_engine_has_the_errors_of_its_trials(small):
    plain = next(curve for curve in small.curves if curve.method.key == "mc")
    for engine in small.engines:
        for statistic in STATISTICS:
            expected = plain.lengths[-1].shares[statistic]
            assert engine.lengths[-1].shares[statistic] == pytest.approx(expected, rel=1e-3)
    slow = small.engines[-1]
    assert not slow.lengths[-1].measured
    assert slow.lengths[-1].seconds == pytest.approx(4 * slow.lengths[-2].seconds)


def test_what_cannot_be_seen_is_said(small):
    text = "\n".join(recommendation(small))
    assert "Taylor, first order misses the upper end of Nissan impact speed by 5.6 mph, 8" in text
    assert "because it does not see the filters, which reject 98.2 % of the trials" in text
    assert "Bounds answer another question" in text
    assert "Recommended: " in text
    assert "`xlmc simulate intersection.xlsx --trials " in text


def test_the_command_is_one_for_this_workbook(small):
    known = small.model
    settings = replace(known.definitions.settings, sampling="lhs500", engine="formulas")
    book = replace(known.workbook, name="my book.xlsx")
    model = type(known)(book, replace(known.definitions, settings=settings), known.path)
    text = "\n".join(recommendation(replace(small, model=model)))
    assert re.search(r'`xlmc simulate "my book.xlsx" --trials \d+ --sampling \w+ --engine (numpy|jit)`', text)


def test_need_follows_the_square_root(small):
    """Half the accuracy asked for is a fourth of the trials, where errors fall with their square root."""
    plain = next(curve for curve in small.curves if curve.method.key == "mc")
    result = need(small, plain)
    assert result.statistic in STATISTICS
    assert result.trials > small.ladder[-1]
    assert result.seconds > 0.0
    value, low, high = reach_of(small, plain, plain.lengths[-1], (result.forecast, result.statistic))
    assert 1.0 < low < value < high


def test_without_filters_the_differential_method_may_do(straight):
    result = study(straight, accuracy="2%", reference_trials=1 << 16, trials=1 << 12, replicates=3)
    assert result.reference.sampling == "sobol"
    text = "\n".join(recommendation(result))
    assert "Taylor, first order and Taylor, second order are near enough, and need no draws at all" in text
    first = next(curve for curve in result.once if curve.method.key == "taylor-1")
    assert worst_error(result, first).times < 1.0
    sobol, plain = (next(c for c in result.curves if c.method.key == key) for key in ("sobol", "mc"))
    assert sobol.lengths[-1].shares["mean"] < 0.2 * plain.lengths[-1].shares["mean"]


@pytest.fixture(scope="module")
def of_straight(book):
    return study(straight_book(book), accuracy="0.8%", reference_trials=1 << 14, trials=1 << 10, replicates=2)


def test_nothing_is_said_of_filters_where_there_are_none(of_straight):
    result = of_straight
    assert all("filters" not in sentence for _, sentence in methods_tables.cannot_lines(result))
    assert dict(methods_tables.cannot_lines(result))["Taylor, first order"].startswith("takes every curve for straight")
    assert not any(sentence.endswith(".") for _, sentence in methods_tables.cannot_lines(result))


def test_independent_trials_are_carried_on_by_theory(of_straight):
    """Eight times more exact is 64 times as many trials, however the slope of two runs of each length came out."""
    result = of_straight
    plain = next(curve for curve in result.curves if curve.method is MONTE_CARLO)
    finer = replace(result, accuracy=("0.1%", 0.001, True))
    assert need(finer, plain).trials == pytest.approx(64 * need(result, plain).trials, rel=0.02)  # whole counts


def test_ends_that_are_never_off_need_no_more_trials(book):
    """24.5 % and 75.5 % of a die are 2 and 5 in all but a few runs in millions: no error is not an unknown one."""
    die = {"cell": "A1", "distribution": "Discrete Uniform", "low": 1, "high": 6}
    result = study(
        book({"A1": 3, "B1": "=A1*2"}, {"die": die}, {"f": "B1"}),
        reference_trials=1 << 14,
        trials=1 << 13,
        replicates=2,
    )
    plain = next(curve for curve in result.curves if curve.method is MONTE_CARLO)
    assert plain.lengths[-1].errors["f", "low"].value == 0.0
    assert np.isfinite(need(result, plain).trials)
    assert not any("however many trials" in sentence for sentence in recommendation(result))


def test_the_command_runs_what_is_recommended(book):
    """A tenth of a thousandth of the range is far for independent trials, and near for Sobol points."""
    uniform = {"low": -1, "high": 1}
    model = book(
        {"A1": 0.0, "A2": 0.0, "B1": "=IF(A1>0,10,0)+A2"},
        {"x": {"cell": "A1", **uniform}, "z": {"cell": "A2", **uniform}},
        {"y": "B1"},
    )
    result = study(model, accuracy="0.003%", reference_trials=1 << 18, trials=1 << 14, replicates=4)
    (sentence,) = [paragraph for paragraph in recommendation(result) if paragraph.startswith("Recommended")]
    assert sentence.startswith("Recommended: Scrambled Sobol")
    assert "--sampling sobol`" in sentence


def test_errors_in_cells_are_warned_of(book):
    model = book({"A1": 1.0, "B1": "=LN(A1)"}, {"a": {"cell": "A1", "low": -1, "high": 2}}, {"f": "B1"})
    assert any(
        "lost to errors in cells" in sentence for sentence in reference_of(model, 1 << 14, "mc", "numpy", 3).warnings
    )
    assert (
        "lost to errors in cells"
        in recommendation(study(model, reference_trials=1 << 14, trials=1 << 10, replicates=2))[0]
    )


def test_accuracy_in_units(straight):
    result = study(straight, accuracy="0.5", reference_trials=1 << 14, trials=1 << 10, replicates=2)
    assert result.tolerance("y") == 0.5
    sentence = recommendation(result)
    assert sentence[0].startswith("Recommended: ")
    assert "each known to within 0.5 in its units, in 95 of 100 runs" in sentence[1]
    assert any("--precision 0.5 --precision-of mean,sd,range`" in each for each in sentence)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"accuracy": "good"}, "is not a precision"),
        ({"replicates": 1}, "1 replicates were asked for"),
        ({"trials": 100}, "100 trials were asked for"),
        ({"reference_trials": 10}, "10 reference trials were asked for"),
        ({"seed": -1}, "The seed -1 is negative"),
    ],
)
def test_what_cannot_be_meant(straight, asked, message):
    with pytest.raises(SimulationError, match=message):
        study(straight, **asked)


def test_too_few_accepted(book):
    model = book(
        {"A1": 0.5, "B1": "=A1"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"f": "B1"},
        {"rare": {"cell": "A1", "above": 0.999}},
    )
    with pytest.raises(SimulationError, match="too few to measure methods with"):
        study(model, reference_trials=2_048, trials=1_024, replicates=2)


def test_a_forecast_whose_errors_cannot_be_squared(book):
    model = book({"A1": 1e-200, "B1": "=1/A1"}, {"x": {"cell": "A1", "low": 1e-200, "high": 1e-190}}, {"y": "B1"})
    with pytest.raises(SimulationError, match=r"'y' is beyond 1E150 in some trials"):
        study(model, reference_trials=1 << 14, trials=1 << 10, replicates=2)


def test_exact_numbers_of_the_reference_are_shown_exactly(book):
    model = book({"A1": 1.5, "B1": "=A1*0+2.25"}, {"x": {"cell": "A1", "low": 1, "high": 2}}, {"y": "B1"})
    result = study(model, reference_trials=1 << 14, trials=1 << 10, replicates=2)
    assert methods_tables.reference_table(result).rows == (("y", "", "2.25", "0", "2.25", "2.25"),)


def test_a_method_that_cannot_be_used_is_named(book):
    model = book(
        {"A1": 1.0, "B1": "=SIN(50*A1)"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"f": "B1"},
    )
    result = study(model, reference_trials=1 << 14, trials=1 << 10, replicates=2)
    assert "is a quadratic polynomial" in result.absent["Surrogate, exact filter"]


def test_nothing_is_drawn(book):
    with pytest.raises(SimulationError, match="so that every method gives the same"):
        study(book({"A1": 1.0, "B1": "=A1"}, {}, {"f": "B1"}))


def test_a_mean_that_does_not_converge_is_asked_of_no_method(book):
    model = book({"A1": 0.5, "B1": "=1/A1"}, {"a": {"cell": "A1", "low": -1, "high": 1}}, {"f": "B1"})
    result = study(model, reference_trials=1 << 17, trials=1 << 13, replicates=2)
    assert result.reference.heavy == {"f": ("mean", "sd")}
    sentence = recommendation(result)
    assert (
        "The mean and SD of f do not converge, as far as these trials show" in sentence[2]
    )  # a lognormal may look so too
    assert "more trials help no method" in sentence[2]
    plain = next(curve for curve in result.curves if curve.method is MONTE_CARLO)
    assert need(result, plain).statistic in ("low", "high")
    assert np.isnan(plain.lengths[-1].shares["mean"])  # its error is no share of anything, and no slope is drawn of it
    assert plain.lengths[-1].shares["low"] < 1.0


def test_no_forecast(book):
    with pytest.raises(SimulationError, match="has no forecast"):
        study(book({"A1": 1.0}))


def test_root_mean_squares():
    errors = np.random.default_rng(1).normal(0.5, 2.0, 20_000)
    result = rms_of([*errors, np.nan])
    assert result.n == 20_000
    assert result.value == pytest.approx((4 + 0.25) ** 0.5, rel=0.02)
    assert result.bias == pytest.approx(0.5, abs=0.06)
    assert rms_of(np.random.default_rng(1).normal(3.0, 1.0, 50)).value == pytest.approx(10**0.5, rel=0.1)
    assert np.isnan(rms_of([np.nan]).value)


def test_an_error_that_the_reference_explains_is_none_of_the_method():
    """All runs are off by what the reference may be off by; a reference that is surer says that they are."""
    errors = np.random.default_rng(1).normal(0.5, 0.1, 24)
    assert rms_of(errors, 0.3).value == pytest.approx(0.1, rel=0.5)
    assert rms_of(errors, 0.01).value == pytest.approx(0.51, rel=0.05)
    assert rms_of([0.5], 0.3).interval == (0.0, pytest.approx(0.5 + 1.96 * 0.3, abs=1e-3))


def test_the_interval_of_an_error_holds_it():
    """95 % of 400 times, with 8 replicates of a normal error; the standard error of that share is 1.1 %."""
    draws = np.random.default_rng(2).normal(0.0, 2.0, (400, 8))
    held = [low <= 2.0 <= high for low, high in (rms_of(each).interval for each in draws)]
    assert np.mean(held) == pytest.approx(0.95, abs=0.045)


@pytest.mark.parametrize("at", ["Taylor, first order", "runs of 128 to 131,072 trials, 1 of"])
def test_an_interrupted_study_answers_by_the_shortest_runs(straight, at):
    def tell(what):
        if what.startswith(at):
            signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        result = study(straight, reference_trials=1 << 16, trials=1 << 17, replicates=8, tell=tell)
    finally:
        signal.signal(signal.SIGINT, before)
    assert result.ended.startswith("it was interrupted after ")
    assert len(result.ladder) == 3
    assert all(len(curve.lengths) == 3 for curve in result.curves)
    assert "Recommended: " in "\n".join(recommendation(result))
    assert methods_report(result, figures=False)
    left_out = "the study was interrupted before it"
    assert result.absent.get("Taylor, second order") == (left_out if at.startswith("Taylor") else None)


@pytest.fixture
def usual_interrupts():
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("usual_interrupts")
def test_before_the_reference_is_run_the_short_run_answers(straight):
    """y = 10 + 2x + z has the mean 10 and the SD √5; 65,536 trials know it to 0.009, five times which is 0.045."""

    def tell(what):
        if what.startswith("the reference"):
            signal.raise_signal(signal.SIGINT)

    result = study(straight, tell=tell)
    assert result.ended
    assert result.reference.trials == 65_536
    assert result.reference.answers["y"].mean == pytest.approx(10.0, abs=0.045)
    assert [curve.method for curve in result.curves] == [MONTE_CARLO]
    assert set(result.absent.values()) == {"the study was interrupted before it"}
    assert "Recommended: Monte Carlo" in "\n".join(recommendation(result))
    assert methods_report(result, figures=False)


@pytest.mark.usefixtures("usual_interrupts")
def test_ctrl_c_does_not_wait_for_a_run_to_end(straight, monkeypatch):
    monkeypatch.setattr(module, "reference_of", lambda *given: signal.raise_signal(signal.SIGINT) or time.sleep(600))
    result = study(straight)
    assert result.ended
    assert result.reference.trials == 65_536


def test_many_assumptions_are_measured_within_a_limit_of_time(book):
    """Of a second a quarter goes by before the methods that draw take turns: what there is no time for is named."""
    count = MANY + 1
    cells = {f"A{row}": 0.5 for row in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    model = book(
        cells, {f"x{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, count + 1)}, {"y": "B1"}
    )
    result = study(model, time_limit="0.5s")
    assert not result.ended
    assert MONTE_CARLO.name not in result.absent
    assert next(len(curve.lengths) for curve in result.curves if curve.method is MONTE_CARLO) >= 3
    assert any("give a longer time with --time-limit" in why for why in result.absent.values())
    assert len({len(curve.lengths) for curve in result.curves}) == 1
    assert "Recommended: " in "\n".join(recommendation(result))


@pytest.mark.parametrize(
    ("count", "given", "limit"),
    [
        (MANY, {}, None),
        (MANY + 1, {}, "about 60 s"),
        (MANY + 1, {"time_limit": "2m"}, "about 2 min"),
        (1, {"time_limit": 40}, "about 40 s"),
        (MANY + 1, {"replicates": 2}, None),
    ],
)
def test_what_will_be_measured_is_said_before(book, monkeypatch, count, given, limit):
    class Said(Exception):  # noqa: N818 - it is no fault
        pass

    def plan(what):
        raise Said(what)

    cells = {f"A{row}": 0.5 for row in range(1, count + 1)} | {"B1": f"=SUM(A1:A{count})"}
    model = book(
        cells, {f"x{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, count + 1)}, {"y": "B1"}
    )
    with pytest.raises(Said) as said:
        study(model, plan=plan, **given)
    text = str(said.value)
    assert text.startswith(f"Measures 12 methods on {count} assumptions and 1 forecasts: a reference of ")
    assert ("--time-limit" in text) == (limit is not None)
    assert limit is None or limit in text


def test_quick_settings_limit_the_time_of_many_assumptions(straight, book):
    assert quick_settings(straight, {})["replicates"] == 8
    cells = {f"A{row}": 0.5 for row in range(1, MANY + 2)} | {"B1": f"=SUM(A1:A{MANY + 1})"}
    many = book(cells, {f"x{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, MANY + 2)}, {"y": "B1"})
    assert quick_settings(many, {}) == {"time_limit": 30.0}
    assert quick_settings(many, {"trials": 4_096})["trials"] == 4_096


def test_slopes():
    assert slope_of([1, 10, 100], [5, np.nan, 0.5]) == pytest.approx(-0.5)
    assert np.isnan(slope_of([4, 4], [1, 2]))
    assert np.isnan(slope_of([0.0030409, 0.003048, 0.003048], [0.0124, 0.0174, 0.0159])), "short runs all take as long"


def test_searches_in_step_and_a_failure_among_them():
    asked = []

    def answer(questions):
        asked.append(len(questions))
        return [each + 1 for each in questions]

    def climb(times):
        def search(ask):
            value = 0
            for _ in range(times):
                value = ask(value)
            return value

        return search

    assert in_step([climb(3), climb(1), climb(0)], answer) == [3, 1, 0]
    assert sum(asked) == 4

    def broken(ask):
        raise ValueError("broken")

    with pytest.raises(ValueError, match="broken"):
        in_step([climb(2), broken], answer)
