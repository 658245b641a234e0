from __future__ import annotations

import pytest

from xlmc.engine.graph.nodes import Constant, Input, Select
from xlmc.engine.graph.trial_sets import ALL_TRIALS
from xlmc.engine.numpy.branches import SURVIVORS, Placement


@pytest.fixture
def placed(lower):
    """`placed(cells, filters, forecasts)`: cell -> its context, the placement, and the dag."""

    def make(cells, filters, forecasts, inputs=("A1", "A2", "A3")):
        lowering, targets = lower(cells, inputs, [*filters, *forecasts])
        nodes = [lowering.target(target) for target in targets]
        placement = Placement(lowering.dag, nodes[: len(filters)], nodes[len(filters) :])
        contexts = {}
        open_ = [ALL_TRIALS, SURVIVORS]
        while open_:
            context = open_.pop()
            members = placement.members(context)
            contexts |= dict.fromkeys(members, context)
            open_ += [inner for node in members for inner in placement.branches(node)]
        names = {}
        for cell in lowering.graph.formulas:
            node = lowering.cell(cell)
            names[cell.a1] = contexts.get(node, None if isinstance(lowering.dag.nodes[node], Constant) else "nowhere")
        for cell, name in lowering.inputs.items():
            names[cell.a1] = contexts.get(lowering.dag.input(name), "nowhere")
        return names, placement, lowering

    return make


def test_what_only_forecasts_need_is_left_to_the_survivors(placed):
    cells = {"B1": "=A1+1", "B2": "=A2*2", "B3": "=B1+B2", "D1": "=B1>0", "C9": "=1+1"}
    where, _, _ = placed(cells, ["D1"], ["B3"])
    assert {name: where[name] for name in ("A1", "B1", "D1")} == dict.fromkeys(("A1", "B1", "D1"), ALL_TRIALS)
    assert {name: where[name] for name in ("A2", "B2", "B3")} == dict.fromkeys(("A2", "B2", "B3"), SURVIVORS)
    assert where["A3"] == "nowhere"


def test_without_filters_all_is_left_to_the_survivors(placed):
    where, placement, _ = placed({"B1": "=A1+1"}, [], ["B1"])
    assert where["B1"] == SURVIVORS
    assert placement.members(ALL_TRIALS) == []
    assert placement.externals(SURVIVORS, []) == []


def test_what_the_survivors_take_from_all_trials(placed):
    cells = {"B1": "=A1+1", "B2": "=SQRT(B1)+A1", "D1": "=B1>0"}
    where, placement, lowering = placed(cells, ["D1"], ["B2", "B1"])
    carried = placement.externals(SURVIVORS, [])
    assert [lowering.dag.nodes[node].__class__.__name__ for node in carried] == ["Input", "Apply"]
    assert where["B1"] == ALL_TRIALS


def test_a_branch_that_may_err_has_its_own_trials(placed):
    where, _, _ = placed({"B1": "=SQRT(A1)", "C1": "=IF(A2>0,B1,0)"}, ["C1"], [])
    context = where["B1"]
    assert (context.parent, context.branch, context.depth) == (ALL_TRIALS, 1, 1)
    assert where["C1"] == ALL_TRIALS


@pytest.mark.parametrize("formula", ["IF(A2>0,A1+A2,A1*3)", "IF(A2>0,-A1,ABS(A1))", "IF(A2>0,MAX(A1:A3),SUM(A1:A3))"])
def test_a_branch_that_cannot_err_has_not(placed, formula):
    _, placement, _ = placed({"C1": f"={formula}"}, ["C1"], [])
    assert all(placement.branches(node) == [] for node in placement.members(ALL_TRIALS))


def test_what_both_branches_need_is_needed_anyway(placed):
    where, _, _ = placed({"B1": "=SQRT(A1)", "C1": "=IF(A2>0,B1+LN(A2),B1-1/A2)"}, ["C1"], [])
    assert where["B1"] == ALL_TRIALS


def test_what_the_condition_needs_is_needed_anyway(placed):
    where, _, _ = placed({"B1": "=SQRT(A1)", "C1": "=IF(B1>0,1/B1,0)"}, ["C1"], [])
    assert where["B1"] == ALL_TRIALS


def test_draws_are_never_in_a_branch(placed):
    where, _, _ = placed({"C1": "=IF(A2>0,1/A1,0)"}, ["C1"], [])
    assert where["A1"] == ALL_TRIALS
    where, _, _ = placed({"C1": "=IF(A2>0,1/A1,0)", "D1": "=A2>0"}, ["D1"], ["C1"])
    assert where["A1"] == SURVIVORS


def test_a_rescue_is_nowhere(placed):
    where, _, _ = placed({"B1": "=SQRT(A1)", "B2": "=LN(A2)", "C1": "=IFERROR(B1,B2)"}, ["C1"], [])
    assert (where["B1"], where["B2"], where["A2"]) == (ALL_TRIALS, "nowhere", "nowhere")


def test_a_range_that_is_folded_is_nowhere(placed):
    _, placement, lowering = placed({"B1": "=SUM(A1:A3)"}, ["B1"], [])
    kinds = [type(lowering.dag.nodes[node]).__name__ for node in placement.members(ALL_TRIALS)]
    assert kinds == ["Input", "Input", "Input", "Apply"]


def test_branches_do_not_nest_without_end(placed):
    cells = {"B1": "=1/A1"} | {f"B{k}": f"=IF(A2>{k},SQRT(B{k - 1}),0)" for k in range(2, 60)}
    where, _, lowering = placed(cells, ["B59"], [])
    depths = [context.depth for context in where.values() if context != "nowhere"]
    assert 3 < max(depths) < 20
    assert sum(isinstance(node, Select) for node in lowering.dag.nodes) == 58
    assert isinstance(lowering.dag.nodes[0], Input)
