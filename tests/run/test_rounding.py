"""Runs in float32: how far they are from float64, what is said of it, and when they are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("llvmlite")

import xlmc
from xlmc.errors import RoundingError, SimulationError
from xlmc.results.record import make_record
from xlmc.run.blocks import Task
from xlmc.run.rounding import MOST_DECISIONS, _difference
from xlmc.run.scheduling.recipe import worker_of

CASE_STUDY = Path(__file__).resolve().parents[2] / "examples" / "intersection.xlsx"
UNIT = {"low": 0, "high": 1}
GIVEN = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3")}
CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0}
U = 2.0**-24
"""Half a unit in the last place of float32: a rounding's largest relative error."""

BLOCK = 8192


def columns(book, formula, **cells):
    """A formula of the three draws, in float32 and in float64."""
    model = book(CELLS | {"B1": f"={formula}"} | cells, GIVEN, {"x": "B1"})
    task = Task(0, BLOCK, False)
    workers = [worker_of(model, model.program("jit", name), "jit", 3, BLOCK) for name in ("float32", "float64")]
    return [worker.run(task).forecasts[0] for worker in workers]


@pytest.mark.parametrize(
    ("formula", "roundings"),
    [
        ("A1", 0),  # a draw is kept as it was drawn
        ("A1*A2", 3),  # both draws, the product
        ("A1*A2+SQRT(A3)", 4),  # of positive terms the worse one and the sum: 3 and 1
        ("(A1+A2)/(A2+A3)", 5),  # 2 above, 2 below, the quotient
        ("SQRT(A1)*0.1", 3.5),  # half that of the draw, the root, the constant, the product
        ("A1^3", 5),  # three times that of the draw, two products
        ("SUM(A1:A3)", 3),  # the draws, two sums
    ],
)
def test_the_error_is_that_of_the_roundings(book, formula, roundings):
    single, double = columns(book, formula)
    assert np.all(np.abs(single - double) <= 1.01 * roundings * U * np.abs(double))
    assert (single != double).any() == (roundings > 0)


@pytest.mark.parametrize(
    "formula",
    [
        "(A1+1)*1E30*1E30/1E30/1E30",  # beyond 3.4E38 on the way
        "1E30*(A1+1)*1E30",
        "IF((A1+1)*1E30*1E30>1E38,A1+1,A2)",
        "1/((A1+1)*1E-30*1E-30)",  # below 1.2E-38: its reciprocal is infinite
        "SIN(A1*1E6+1E4)+2",  # float32 holds no digits of such angles
        "SQRT((A1+1)*1E38*10)",
    ],
)
def test_what_float32_cannot_hold_is_computed_in_float64(book, formula):
    single, double = columns(book, formula)
    np.testing.assert_array_equal(single, columns(book, formula)[0])
    np.testing.assert_allclose(single, double, rtol=8 * U)


def test_errors_are_those_of_float64(book):
    single, double = columns(book, "1/MAX(0,A1-0.5)+SQRT(A2-0.25)")
    assert np.isnan(double).any()
    assert np.isnan(single).tolist() == np.isnan(double).tolist()


@pytest.mark.parametrize("number", ["1E39", "1E-39"])
def test_numbers_out_of_range_are_refused(book, number):
    model = book(CELLS | {"B1": f"=A1+{number}"}, GIVEN, {"x": "B1"})
    with pytest.raises(SimulationError, match=r"out of the range of float32.*float64"):
        model.simulate(100, engine="jit", arithmetic="float32")


@pytest.fixture(scope="module")
def run():
    return xlmc.load(CASE_STUDY).simulate(150_000, 4, engine="jit", arithmetic="float32")


def test_the_case_study(run):
    """Decisions as in float64 but for a few; forecasts within 1e-4: some hundred roundings, some digits cancelled."""
    double = xlmc.load(CASE_STUDY).simulate(150_000, 4, engine="jit")
    both, ours, theirs = np.intersect1d(run.trial_index, double.trial_index, return_indices=True)
    assert run.accepted + double.accepted - 2 * both.size <= MOST_DECISIONS * run.trials
    for name, values in double.forecasts.items():
        assert run.forecasts[name].dtype == np.float64
        assert 0 < np.abs(run.forecasts[name][ours] - values[theirs]).max() <= 1e-4 * np.abs(values).max()
    assert run.rounding.trials == 131_072
    assert run.rounding.decisions <= MOST_DECISIONS * run.rounding.trials
    assert 0 < max(run.rounding.differences.values()) < 1e-4


@pytest.mark.parametrize("scheduler", ["threads", "processes"])
def test_two_jobs_change_nothing(run, scheduler):
    two = xlmc.load(CASE_STUDY).simulate(150_000, 4, engine="jit", arithmetic="float32", jobs=2, scheduler=scheduler)
    assert two.trial_index.tolist() == run.trial_index.tolist()
    assert all(two.forecasts[name].tobytes() == values.tobytes() for name, values in run.forecasts.items())


def test_it_is_said(run):
    assert "float32" in str(run.notices[-1])
    record = make_record(run)
    assert "--arithmetic float32" in str(record)
    assert "float64" in str(record)


def test_a_run_in_float64_says_nothing(book):
    run = book(CELLS, GIVEN, {"x": "A1"}).simulate(100)
    assert run.rounding is None
    assert run.notices == run.model.notices


@pytest.mark.parametrize("engine", ["numpy", "formulas"])
def test_other_engines_refuse(book, engine):
    with pytest.raises(SimulationError, match=f"`{engine}` computes in float64 only.*--engine jit"):
        book(CELLS, GIVEN, {"x": "A1"}).simulate(100, engine=engine, arithmetic="float32")


def test_there_is_no_other_arithmetic(book):
    with pytest.raises(SimulationError, match=r"there is no arithmetic 'float16'.*float64 or float32"):
        book(CELLS, GIVEN, {"x": "A1"}).simulate(100, engine="jit", arithmetic="float16")


def test_decisions_by_the_last_digits_are_refused(book):
    model = book(CELLS | {"C1": "=(A1+1E6)-1E6>A1"}, GIVEN, {"x": "A1"}, {"f": "C1"})
    with pytest.raises(RoundingError, match=r"accepted or rejected otherwise than in float64.*--arithmetic float64"):
        model.simulate(10_000, engine="jit", arithmetic="float32")


def test_lost_digits_are_refused(book):
    model = book(CELLS | {"B1": "=(A1+1E6)-1E6"}, GIVEN, {"x": "B1"})
    with pytest.raises(RoundingError, match=r"S!B1: .*x differs from float64 by .*--arithmetic float64"):
        model.simulate(10_000, engine="jit", arithmetic="float32")


def test_the_bounds_are_what_they_say(book, monkeypatch):
    """The same model passes where as many differing decisions may be."""
    model = book(CELLS | {"C1": "=(A1+1E3)-1E3>A2"}, GIVEN, {"x": "A1"}, {"f": "C1"})
    rounding = model.simulate(100_000, engine="jit", arithmetic="float32").rounding
    assert 0 < rounding.decisions <= MOST_DECISIONS * rounding.trials
    monkeypatch.setattr("xlmc.run.rounding.MOST_DECISIONS", rounding.decisions / rounding.trials / 1.5)
    with pytest.raises(RoundingError):
        model.simulate(100_000, engine="jit", arithmetic="float32")


@pytest.mark.parametrize(
    ("rounded", "exact", "difference"),
    [
        ([], [], 0.0),
        ([1.0, 2.0], [1.0, 2.0], 0.0),
        ([100.1, 100.0], [100.0, 100.0], 0.001),
        ([0.1, 10.0, -10.0], [0.0, 10.0, -10.0], 0.1 / np.std([0.0, 10.0, -10.0])),
        ([0.0, 0.0], [0.0, 0.0], 0.0),
        ([1e-9, 0.0], [0.0, 0.0], np.inf),
        ([np.nan, 1.0], [np.nan, 1.0], 0.0),
        ([np.nan, 1.0], [2.0, 1.0], np.inf),
    ],
)
def test_differences(rounded, exact, difference):
    assert _difference(np.array(rounded), np.array(exact)) == pytest.approx(difference)
