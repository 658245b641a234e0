"""The evidence of a run of a small book: its trials, sizes, errors and the ranges that tell trials apart."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats
from simulated import simulated

from xlmc.analysis.studies.stability.case import Case, _base, _by_chance
from xlmc.analysis.studies.stability.extent import Extent
from xlmc.excel.address import parse_address

CELLS = {
    "A1": 4.0,
    "A2": 0.5,
    "B1": "=A1*3",
    "B2": "=B1+A2",
    "B3": "=A2>0.25",
    "B4": "=IF(B3,B2,0)",
    "B5": "=5+A2*0",
    "B6": "=A2*0",
    "B7": "=(A1+1E8)-1E8",
    "B8": "=SQRT(A2-0.5)",
}
INPUTS = {"u": {"cell": "A1", "low": 2.0, "high": 6.0}, "v": {"cell": "A2", "low": 0.0, "high": 1.0}}
FORECASTS = {"answer": "B4", "five": "B5", "nothing": "B6", "cancels": "B7", "root": "B8"}


def at(address):
    return parse_address(address, "S")


@pytest.fixture(scope="module")
def case(book):
    model = book(CELLS, INPUTS, FORECASTS, {"most": {"cell": "B1", "at_most": 15.0}})
    return Case(Extent(model), simulated(model, trials=400, seed=1))


def test_the_base_case_and_the_ends_of_ranges_come_first(case):
    u, v = case.draws["u"][: case.special], case.draws["v"][: case.special]
    assert (u[0], v[0]) == (4, 0.5)
    held_u, held_v = v[1:][u[1:] != 4], u[1:][v[1:] != 0.5]
    assert {*held_u} == {0.5}  # one assumption at an end, the other at its base
    assert {*held_v} == {4}
    assert {2, 6} <= {*u}
    assert {0, 1} <= {*v}
    assert {case.run.prior["u"].min(), case.run.prior["u"].max()} <= {*u}
    assert case.special == 9


def test_accepted_trials_come_last(case):
    accepted = case.draws["u"][case.first_accepted :]
    assert accepted.size == case.run.accepted
    assert (accepted * 3 <= 15).all()
    assert (case.draws["u"][case.special : case.first_accepted] * 3 > 15).any()
    assert case.n == case.special + 400 + case.run.accepted


def test_numbers_and_sizes_of_cells(case):
    u, v = case.draws["u"], case.draws["v"]
    np.testing.assert_array_equal(case.number(case.node[at("B1")]), u * 3)
    low, high = np.quantile((u * 3)[case.special :], [0.245, 0.755])
    assert case.scale(at("B1")) == pytest.approx(high - low)
    assert case.scale(at("B5")) == 5  # it does not vary
    assert case.scale(at("B6")) == 1  # it is 0
    root = np.sqrt(np.maximum(v - 0.5, 0))[case.special :][v[case.special :] >= 0.5]
    assert case.scale(at("B8")) == pytest.approx(np.subtract(*np.quantile(root, [0.755, 0.245])))


def test_errors_by_rounding(case):
    """A sum with 1E8 is rounded in steps of 2^-26; what rounding the assumption would bring is 2^-52 of it."""
    errors = case.errors[case.node[at("B7")]]
    assert 0.1 * 2.0**-26 < np.median(errors) < 2.0**-25
    inherent = case.inherent(at("B7"))
    assert np.median(inherent) < 1e-7 * np.median(errors)
    assert case.inherent(at("B7")) is inherent
    moved, total = case.moved(at("B1"))
    np.testing.assert_allclose(moved, np.abs(3 * case.draws["u"]), rtol=1e-12)
    np.testing.assert_allclose(total, [np.abs(3 * case.draws["u"]).sum(), 0], rtol=1e-12)
    assert case.term_sizes[case.node[at("B7")]] == pytest.approx(1e8 + 6, rel=1e-6)


def test_values_with_fifty_digits(case):
    before = case.recomputed
    trial = case.special + 3
    assert case.exact_number(case.node[at("B7")], trial) == case.draws["u"][trial]
    assert case.exact_number(case.node[at("B1")], trial) == case.draws["u"][trial] * 3
    assert case.recomputed == before + 1
    lost = int(np.flatnonzero(case.draws["v"] < 0.5)[0])
    assert math.isnan(case.exact_number(case.node[at("B8")], lost))


def test_what_follows_from_what(case):
    after = case.after(case.node[at("B3")])
    assert case.node[at("B4")] in after
    assert case.node[at("B2")] not in after
    assert case.after(case.node[at("B4")]) == []
    order = case.after(case.node[at("B1")])
    assert order.index(case.node[at("B2")]) < order.index(case.node[at("B4")])
    assert case.node[at("B3")] in case.comparisons
    assert case.node[at("B1")] not in case.comparisons


def test_names_of_what_a_cell_needs_and_reaches(case):
    assert case.inputs_of(case.node[at("B1")]) == {"u"}
    assert case.inputs_of(case.node[at("B4")]) == {"u", "v"}
    assert case.upstream(at("B3")) == {at("B3"), at("A2")}
    assert case.forecasts_of([at("B1")]) == ["answer", "most"]
    assert case.forecasts_of([at("B7")]) == ["cancels"]
    assert case.forecasts_of([]) == []


@pytest.mark.parametrize(
    ("low", "high", "named"),
    [
        (0.0, 0.1, True),
        (0.0, 0.45, True),
        (0.0, 0.55, False),  # more than half of the range says nothing
        (0.4, 0.5, True),
        (0.0, 1.0, False),  # every trial
    ],
)
def test_the_range_that_tells_trials_from_others(case, low, high, named):
    v = case.draws["v"]
    trials = (v >= low) & (v <= high)
    found = case.where(trials, case.node[at("B2")])
    if not named:
        assert found == ()
        return
    (where,) = found
    assert where.name == "v"
    assert (where.low, where.high) == (v[trials].min(), v[trials].max())


def test_an_assumption_that_a_cell_does_not_need_is_not_named(case):
    assert case.where(case.draws["v"] < 0.1, case.node[at("B1")]) == ()


def test_few_trials_lie_together_by_chance(case):
    rows = np.argsort(np.where(np.arange(case.n) < case.special, np.inf, case.draws["v"]))
    for count in (4, 5):
        trials = np.zeros(case.n, bool)
        trials[rows[:count]] = True
        assert bool(case.where(trials, case.node[at("B2")])) is (count == 5)


def test_both_ranges_are_named_the_narrower_first(case):
    trials = (case.draws["v"] < 0.3) & (case.draws["u"] < 2.5)
    assert [each.name for each in case.where(trials, case.node[at("B2")])] == ["u", "v"]
    assert [each.name for each in case.where(trials, case.node[at("B2")], most=1)] == ["u"]


@pytest.mark.parametrize(("share", "count"), [(0.1, 2), (0.5, 5), (0.3, 10)])
def test_how_often_trials_lie_close_together_by_chance(share, count):
    """The range of n uniform numbers is a Beta(n - 1, 2) number."""
    assert _by_chance(share, count) == pytest.approx(stats.beta(count - 1, 2).cdf(share))


@pytest.mark.parametrize(("base", "value"), [(3.0, 3), (4, 4), (None, 2), (True, 2), ("x", 2)])
def test_a_base_that_is_no_number_is_the_median(base, value):
    assert _base(base, np.array([1.0, np.nan, 2.0, 9.0])) == value


def test_nothing_is_drawn(book):
    model = book({"A1": 4.0, "B1": "=A1*3"}, {"u": {"cell": "A1", "low": 2, "high": 6, "frozen": True}}, {"x": "B1"})
    case = Case(Extent(model), simulated(model, trials=100, seed=1))
    assert (case.draws, case.special, case.n, case.first_accepted) == ({}, 0, 1, 1)
