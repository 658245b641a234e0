"""Thin layers: what they are solved for, and that the answers of whole runs are the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate
from scipy.special import ndtr
from simulated import simulated

from xlmc.analysis.results.record import make_record
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.rare import learning
from xlmc.montecarlo.rare.layered import Layered, search_space_of
from xlmc.montecarlo.rare.layers import _meets
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction

NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}
CELLS = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "A4": 1.0, "B2": "=A2^2/4", "B3": "=A1-B2"}
GIVEN = {
    "a": {"cell": "A1", **NORMAL},
    "b": {"cell": "A2", **NORMAL},
    "c": {"cell": "A3", "low": 0.5, "high": 2},
    "d": {"cell": "A4", "distribution": "Yes-No", "probability": 0.5},
}
THIN = {"at_least": -1e-5, "at_most": 1e-5}


@pytest.fixture
def ground(book):
    def make(filters, correlations=None, given=GIVEN, **more):
        cells = {**CELLS, **{f"B{row}": text for row, text in enumerate(more.pop("formulas", ()), 4)}}
        model = book(cells, given, {"x": "A1", "all": "D1"} if "D1" in cells else {"x": "A1"}, filters, correlations)
        return search_space_of(model, LimitStateFunction(model, np.random.default_rng(3)), np.random.default_rng(4))

    return make


def solved(result):
    return [layer.name for layer in result.layers] if isinstance(result, Layered) else []


SOLVED = [
    (["=A1-A2^2/4"], THIN, ["a"]),
    (["=A1*A3-A2"], THIN, ["a"]),
    (["=SQRT(A1^2+A3^2)-2.5"], THIN, ["a"]),
    (["=A1^2-A3"], THIN, ["a"]),
    (["=EXP(A1)+A2-3"], THIN, ["a"]),
    (["=2*A1*A2-A1*A3+A1/3"], THIN, ["c"]),
    (["=(A1+A3)/(A1-A3)"], THIN, ["a"]),
    (["=SUM(A1:A3)-1"], THIN, ["a"]),
    (["=IF(A4=1,A1-A2^2/4,A2-4.5)"], {"at_least": -1e-5, "at_most": 1e-5}, ["a"]),
    (["=AND(ABS(B3)<=0.00001,A3>1.9)"], {}, ["a"]),
    (["=OR(ABS(B3)<=0.00001,AND(A1>4.5,A2>0))"], {}, ["a"]),
    (["=AND(A1>=B2,A1<=B2+0.00001)"], {}, ["a"]),
    (["=AND(ABS(A1+A2*A3-1)<0.0001,ABS(A1-2*A3)<0.0001)"], {}, ["a", "b"]),
    (["=SIN(A3)-A1/5"], THIN, ["a"]),
    (["=A3*SIN(A3)-0.5"], THIN, []),
    (["=ROUND(A1-A2,5)"], {"at_least": 0, "at_most": 0}, []),
    (["=A1-A2^2/4"], {"at_least": -0.01, "at_most": 0.01}, []),
    (["=A1-A2^2/4"], {"at_least": 4}, []),
    (["=A1*A1+A1*A2+A2*A2*A1"], THIN, []),
    (["=A4-0.3"], THIN, []),
]


@pytest.mark.parametrize(("formulas", "limits", "names"), SOLVED, ids=[each[0][0] for each in SOLVED])
def test_what_is_solved(ground, formulas, limits, names):
    assert sorted(solved(ground({"f": {"cell": "B4", **limits}}, formulas=formulas))) == names


def test_a_cell_that_all_depends_through_is_solved_for_and_undone(ground):
    """A2 and A1 are correlated, and A3 stands in several places, but below the root alone."""
    formulas = ["=(B5+A1)/(B5*A2-3)+0.5", "=2*SQRT(A3)"]
    assert solved(ground({"f": {"cell": "B4", **THIN}}, {("a", "b"): 0.5}, formulas=formulas)) == ["c"]
    beside = ["=(B5+A1)/(B5*A2-A3)+0.5", "=2*SQRT(A3)"]
    assert solved(ground({"f": {"cell": "B4", **THIN}}, {("a", "b"): 0.5}, formulas=beside)) == []


def test_two_rows_make_a_layer(ground):
    rows = {"low": {"cell": "B3", "at_least": 0}, "high": {"cell": "B3", "at_most": 1e-5}}
    assert solved(ground(rows)) == ["a"]
    compared = {"low": "B4", "high": "B5"}
    assert solved(ground(compared, formulas=["=A1>=A2^2/4", "=A2^2/4+0.00001>=A1"])) == ["a"]


def test_correlated_assumptions_and_those_with_parameters_that_vary_are_not_solved_for(ground):
    asked = {"f": {"cell": "B4", **THIN}}
    assert solved(ground(asked, {("a", "b"): 0.5}, formulas=["=A1*A3-A2"])) == ["c"]
    varying = {**GIVEN, "b": {"cell": "A2", "distribution": "Normal", "mean": "A3", "std_dev": 1}}
    assert solved(ground(asked, given=varying, formulas=["=A1-A2*2"])) == ["a"]
    assert solved(ground(asked, given=varying, formulas=["=A3-A2*2"])) == []


def test_points_stand_for_the_trials_they_are_made_of(ground):
    varying = {**GIVEN, "b": {"cell": "A2", "distribution": "Normal", "mean": "A3", "std_dev": 1}}
    filters = {"f": {"cell": "B4", **THIN}, "g": {"cell": "A4", "at_least": 0}, "h": "B5"}
    result = ground(filters, {("d", "c"): 0.5}, formulas=["=A1-A2^2/4+A3", "=OR(A1<0,A2>1)"], given=varying)
    uniforms = np.random.default_rng(5).random((5_000, result.dimensions))
    points = result.points(uniforms)
    assert result.uniforms(points) == pytest.approx(uniforms, abs=1e-12)
    assert np.array_equal(result.accepts(points), result._function.accepts_at(uniforms))
    distances = result.distance(points)
    assert np.array_equal(distances == 0.0, result.accepts(points))
    assert np.isfinite(distances).all()


def density(x):
    return math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)


def mean_over(of, weight, low, high):
    def integral(function):
        return integrate.quad(function, low, high, epsabs=0, epsrel=1e-9)[0]

    mass = integral(weight)
    return integral(lambda y: of(y) * weight(y)) / mass, mass


def test_the_answer_of_two_sheets_beside_another_filter_is_the_truth(book):
    """A1² = 4 − A3 within ±10⁻⁶: two sheets, A1 = ±s; another filter, A2 ≤ 1 − A1, leaves little of one."""
    filters = {"f": {"cell": "B4", "at_least": -1e-6, "at_most": 1e-6}, "h": {"cell": "B5", "at_most": 1}}
    cells = {**CELLS, "B4": "=A1^2+A3-4", "B5": "=A1+A2"}
    given = {name: GIVEN[name] for name in "abc"}
    run = simulated(book(cells, given, {"x": "A1", "z": "A3"}, filters), seed=3, until_accepted=3_000, rare="always")

    def sheet(sign):
        return lambda z: density(s := math.sqrt(4 - z)) / s * ndtr(1 - sign * s)

    (mean, mass), (_, of_upper) = (
        mean_over(lambda z: z, weight, 0.5, 2) for weight in (lambda z: sheet(1)(z) + sheet(-1)(z), sheet(1))
    )
    true = 1e-6 * mass / 1.5
    assert abs(run.acceptance.value - true) < 4.5 * run.acceptance.error
    result = run["z"].statistics.mean
    assert abs(result.value - mean) < 4.5 * result.error
    upper = of_upper / mass
    assert abs(np.mean(run.forecasts["x"] > 0) - upper) < 4.5 * math.sqrt(upper * (1 - upper) / 3_000)
    assert run.acceptance.error < 0.01 * run.acceptance.value
    layer = run.inputs["a"] ** 2 + run.inputs["c"] - 4
    assert np.abs(layer).max() <= 1e-6
    places = np.sort((layer + 1e-6) / 2e-6)
    assert np.abs(places - np.linspace(0, 1, 3_000)).max() < 1.95 / math.sqrt(3_000)  # even across: Kolmogorov
    assert run.warnings == []
    entry = next(s for s in make_record(run).sections if s.key == "rare").entries
    assert next(each.value for each in entry if each.key == "solved") == "a"
    assert "solved for 'a'" in run.rare.sentence


def test_a_layer_that_cannot_be_solved_ends_with_a_warning(book, monkeypatch):
    """Correlated assumptions are left alone; the search gives up long before the limit of trials."""
    monkeypatch.setattr(learning, "_ROUNDS", 2)
    layer = {"at_least": -1e-4, "at_most": 1e-4}
    model = book({**CELLS, "B4": "=A1-A2^2/4"}, GIVEN, {"x": "A1"}, {"f": {"cell": "B4", **layer}}, {("a", "b"): 0.5})
    run = simulated(model, 1 << 25, seed=1, until_accepted=1_000_000, rare="always")
    assert "gave up" in run.warnings[0]
    assert run.rare is None


A1, A2, B1 = Cell("S", 1, 1), Cell("S", 2, 1), Cell("S", 1, 2)


@pytest.mark.parametrize(
    ("tree", "cells", "meets"),
    [
        (A1, {A1}, True),
        (A1, {A2, B1}, False),
        (ir.Binary("+", A1, B1), {B1}, True),
        (ir.Call("SUM", (Area("S", 1, 1, 3, 1),)), {A2}, True),
        (ir.Call("SUM", (Area("S", 1, 1, 3, 1), B1)), {B1}, True),
        (ir.Call("SUM", (Area("S", 1, 1, 3, 1),)), {B1}, False),
        (ir.Number(1.0), {A1}, False),
        (A1, set(), False),
    ],
)
def test_whether_a_formula_reads_one_of_some_cells(tree, cells, meets):
    assert _meets(tree, cells) == meets
