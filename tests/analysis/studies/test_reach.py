"""Which forecasts each assumption reaches, and what several that reach no common one cost in one run."""

from __future__ import annotations

import signal

import pytest

from xlmc.analysis.studies.comparison.tolerances import Verdict
from xlmc.analysis.studies.reach import apart, reach_of
from xlmc.analysis.studies.screening import ALONE, screen
from xlmc.montecarlo.simulation import simulate
from xlmc.outputs.studies.screen import screen_report

INPUTS = {name: {"cell": f"A{row}", "low": -1, "high": 1} for row, name in enumerate("abcd", start=1)}
CELLS = {f"A{row}": 0.0 for row in range(1, 5)} | {"B1": "=A1+A2", "B2": "=B1*A3", "B3": "=A3", "B4": "=A4*2"}
FORECASTS = {"sum": "B1", "product": "B2", "third": "B3", "fourth": "B4"}
ALL = "sum product third fourth"


@pytest.mark.parametrize(
    ("cells", "changed", "filters", "correlations", "expected"),
    [
        ({}, {}, None, None, {"a": "sum product", "b": "sum product", "c": "product third", "d": "fourth"}),
        ({"C1": "=A4>0"}, {}, {"f": "C1"}, None, {"a": "sum product", "d": ALL}),
        ({}, {}, None, {("c", "d"): 0.5}, {"c": "product third fourth", "d": "product third fourth"}),
        ({}, {"d": {"cell": "A4", "low": "B3", "high": 2}}, None, None, {"c": "product third fourth", "d": "fourth"}),
        ({"B4": "=OFFSET(A1,C1,0)+A4", "C1": 1}, {}, None, None, {"b": "sum product fourth", "d": "fourth"}),
    ],
    ids=["alone", "filter", "correlated", "parameter", "OFFSET"],
)
def test_what_each_assumption_reaches(book, cells, changed, filters, correlations, expected):
    model = book(CELLS | cells, INPUTS | changed, FORECASTS, filters, correlations)
    result = reach_of(model)
    assert {name: {*result[name]} for name in expected} == {name: {*text.split()} for name, text in expected.items()}


def test_those_that_reach_a_common_forecast_keep_their_order():
    reaches = [frozenset(each) for each in ("x", "y", "xz", "z", "", "x")]
    assert apart("abcdef", reaches) == [["a", "b", "e"], ["c"], ["d", "f"]]


SMALL = ALONE + 10
"""Assumptions of little weight beside those that matter."""


def many(book, formulas, low=-1.0, base=0.0):
    """Each formula of x and z is a forecast of its own two assumptions; others hardly move the first of them."""
    cells, given, forecasts = {}, {}, {}

    def add(name, row):
        cells[f"A{row}"] = base
        given[name] = {"cell": f"A{row}", "low": low, "high": 1}

    for number, formula in enumerate(formulas):
        row = 2 * number + 1
        add(f"x{number}", row)
        add(f"z{number}", row + 1)
        cells[f"B{number + 1}"] = "=" + formula.replace("X", f"A{row}").replace("Z", f"A{row + 1}")
        forecasts[f"y{number}"] = f"B{number + 1}"
    first = 2 * len(formulas) + 1
    for number in range(SMALL):
        add(f"s{number}", first + number)
    cells["B1"] += f"+SUM(A{first}:A{first + SMALL - 1})/10000"
    return book(cells, given, forecasts)


@pytest.mark.parametrize(
    ("formula", "needed"),
    [("X^2+Z/1000", "x"), ("SIN(2*PI()*X)+Z/1000", "x"), ("X*Z", "xz"), ("IF(X>0.98,100,0)+Z/1000", "x")],
    ids=["square", "sine", "interaction", "step"],
)
def test_no_group_hides_an_effect_that_cancels(book, formula, needed):
    """All have the mean 0 or a base value beside the step, at which a straight line would show nothing."""
    result = screen(many(book, [formula] * 3), trials=20_000, seed=3)
    held = {*(result.joint.names if result.joint else ()), *(result.at_once.names if result.at_once else ())}
    assert held.isdisjoint(f"{name}{number}" for name in needed for number in range(3))
    assert held >= {f"s{number}" for number in range(SMALL)}


def test_what_is_held_in_one_run_costs_what_it_costs_alone(book):
    """To the bit: the forecasts of either do not depend on the other."""
    formulas = ["X+Z/2", "X-Z", "X*2+Z*3", "X^2+Z^2"] * 6
    model = many(book, formulas)
    result = screen(model, trials=2_000, seed=1)
    whole = {cost.names: cost for cost in result.single}
    assert len(whole) > ALONE
    assert result.runs < len(whole)
    for name in ("x0", "z5", "x7"):
        (alone,) = screen(model, trials=2_000, seed=1, sets=[name]).sets
        assert whole[name,].size == alone.size
        assert whole[name,].forecasts == alone.forecasts
    assert [cost.names[0] for cost in result.single] == [e.name for e in result.expected if (e.name,) in whole]


def test_those_that_fit_together_are_tried_apart_and_then_run_together(book):
    """Of x + z in units of its SD, 1/√6 each has: either may be held at a tolerance of a third, both may not."""
    result = screen(many(book, ["X+Z"] * 14), "35 %", trials=20_000, seed=1)
    names = {*result.joint.names}
    for number in range(14):
        assert len({f"x{number}", f"z{number}"} & names) == 1
    assert result.joint.judgement.verdict is Verdict.WITHIN
    assert {f"s{number}" for number in range(SMALL)} <= names


def test_a_first_run_that_is_interrupted_is_the_answer(book, monkeypatch):
    blocks, add = [], simulate._Gathered.add

    def pressed(self, block):
        add(self, block)
        blocks.append(block.trials)
        if len(blocks) == 2:
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(simulate._Gathered, "add", pressed)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        result = screen(many(book, ["X+Z"]), trials=200_000, seed=1)
    finally:
        signal.signal(signal.SIGINT, before)
    assert result.ended
    assert screen_report(result).blocks
    assert result.run.trials < 200_000
    assert result.single == ()
