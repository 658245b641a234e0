"""A runner that is kept while ranges and limits move, against one that is made anew: the same to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from xlmc.engine.llvm.machine import machine
from xlmc.montecarlo.definitions.scenarios import Limits, Numbers, Range
from xlmc.montecarlo.loop import reusing_runner
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.reusing_runner import ReusingRunner
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.simulation.simulate import simulate

CASE = Path("examples/intersection.xlsx")
FRICTION, TANGENT = "Nissan post-impact deceleration", "Restitution, tangential"
TRIALS, BLOCK = 3_000, 1_024

UNIT = {"cell": "A1", "low": 0.0, "high": 1.0}
ERRS = {"A1": 0.5, "A2": 1.0, "A3": 0.3, "B1": "=A1*10", "B2": "=A2/MAX(A1-0.2,0)", "B3": '=IF(A1>0.9,"far",A1)'}
ODD = (
    ERRS,
    {"u": UNIT, "n": {"cell": "A2", "distribution": "Normal", "mean": 1.0, "std_dev": 0.1}},
    {"ten": "B1", "both": "B2"},
    {
        "by a cell": {"cell": "B1", "at_least": "A3"},
        "errs": {"cell": "B2", "below": 30.0},
        "is text": {"cell": "B3", "above": 0.1},
    },
)
"""Errors in quantities and in what they are compared with, texts, and a limit in a cell."""
KEEPS_ALL = (*ODD[:2], {"ten": "B1", "both": "B2", "drawn": "A1"}, {})
"""No filter: every trial is accepted, with errors in an answer, and a draw as an answer."""


@pytest.fixture(scope="module")
def case():
    return load(CASE)


def moves(model):
    """Changes one after another, each to the model as it was: ranges, a limit that moves alone, and all back."""
    if any(each.name == FRICTION for each in model.assumptions):
        yield [Range(FRICTION, 0.7, 0.8)]
        for limit in (0.5, 0.4):
            yield [Range(FRICTION, 0.7, 0.8), Limits(TANGENT, {"at_most": limit})]
        yield [Range(FRICTION, 0.1, 2.5)]
    elif not model.filters:
        yield [Numbers("n", {"mean": 1.1})]
        yield [Range("u", 0.1, 0.95)]
    else:
        yield [Numbers("n", {"mean": 1.1})]
        for limit in (20.0, 9.0):
            yield [Limits("errs", {"below": limit}), Range("u", 0.1, 0.95)]
        yield [Limits("is text", {"above": 0.4})]
    yield []


def assert_same(result, expected):
    assert np.array_equal(result.trial_index, expected.trial_index)
    for name in ("rejected", "only", "together"):
        assert getattr(result.tally, name).tolist() == getattr(expected.tally, name).tolist()
    assert (result.tally.by_error, result.tally.errors) == (expected.tally.by_error, expected.tally.errors)
    assert (result.faults, result.error_trials) == (expected.faults, expected.error_trials)
    for mine, theirs in ((result.forecasts, expected.forecasts), (result.inputs, expected.inputs)):
        assert list(mine) == list(theirs)
        assert all(mine[name].tobytes() == theirs[name].tobytes() for name in mine)


def run(model, kept, block=BLOCK):
    return simulate(model, trials=TRIALS, seed=5, engine=kept.engine, own_runner=kept.runner(model, block))


@pytest.mark.parametrize(
    ("which", "engine"),
    [
        ("case study", "numpy"),
        ("errors", "numpy"),
        ("errors", "jit"),
        ("too large to keep", "jit"),
        ("nothing rejected", "numpy"),
        ("nothing rejected", "jit"),
    ],
)
def test_a_reusing_runner_gives_what_a_new_one_gives(book, case, engine, which, monkeypatch):
    model = case if which == "case study" else book(*(KEEPS_ALL if which == "nothing rejected" else ODD))
    if which == "too large to keep":
        monkeypatch.setattr(reusing_runner, "_MOST_BYTES", 100)
    kept = ReusingRunner(model, engine, 5, TRIALS)
    for number, changes in enumerate(moves(model)):
        moved = applied(model, changes)
        assert kept.holds_for(moved)
        expected = simulate(moved, trials=TRIALS, seed=5, engine=engine)
        assert expected.accepted
        assert_same(run(moved, kept), expected)
        assert_same(run(moved, kept, 700 + number), expected)  # blocks of any size
        assert kept.base(moved).keys() == expected.forecasts.keys()


def test_what_did_not_change_is_not_computed_again(book, monkeypatch):
    model = book(*ODD)
    kept = ReusingRunner(model, "numpy", 5, TRIALS)
    run(model, kept)
    draws, evaluator = kept._runners[BLOCK]
    before = {name: each.values for (name, start), each in draws._columns.items() if start == 0}
    run(applied(model, [Numbers("n", {"mean": 1.1})]), kept)
    after = {name: each.values for (name, start), each in draws._columns.items() if start == 0}
    assert after["u"] is before["u"]
    assert after["n"] is not before["n"]
    limits = [applied(model, [Limits("errs", {"below": limit})]) for limit in (20.0, 15.0, 10.0)]
    asked = []
    inner = evaluator._evaluator.filters
    monkeypatch.setattr(type(evaluator._evaluator), "filters", lambda self, *given: asked.append(1) or inner(*given))
    for moved in limits:
        run(moved, kept)
    blocks = -(-TRIALS // BLOCK)
    assert len(asked) == 2 * blocks  # back to the first range, kept when it comes again, and then only compared


def test_draws_that_depend_on_each_other_are_drawn_as_ever(book):
    cells = {"A1": 0.5, "A2": 1.0, "A3": "=A1+1", "B1": "=A1+A2"}
    inputs = {"u": UNIT, "v": {"cell": "A2", "low": 0.0, "high": "A3"}}
    model = book(cells, inputs, {"x": "B1"}, {"f": {"cell": "B1", "at_most": 2.0}})
    kept = ReusingRunner(model, "numpy", 5, TRIALS)
    for changes in ([], [Range("u", 0.2, 0.9)], [Limits("f", {"at_most": 1.5})], [Limits("f", {"at_most": 1.0})]):
        moved = applied(model, changes)
        assert_same(run(moved, kept), simulate(moved, trials=TRIALS, seed=5))


def test_a_reusing_runner_does_not_hold_for_other_nodes_or_other_kinds_of_limits(book):
    model = book(*ODD)
    kept = ReusingRunner(model, "numpy", 5, TRIALS)
    assert not kept.holds_for(book(*ODD))
    assert not kept.holds_for(applied(model, [Limits("by a cell", {"at_least": 0.3})]))


def test_a_run_in_pieces_gives_what_a_run_gives(case):
    for sampling, engine in (("lhs", "numpy"), ("sobol", "numpy"), ("mc", "jit")):
        whole = simulate(case, trials=40_000, sampling=sampling, engine=engine)
        pieces = simulate(case, trials=40_000, sampling=sampling, engine=engine, pieces=2_048)
        assert pieces.block == whole.block
        assert_same(pieces, whole)
        assert {name: values.tobytes() for name, values in pieces.prior.items()} == {
            name: values.tobytes() for name, values in whole.prior.items()
        }


def test_another_limit_makes_no_other_native_code(case):
    before = applied(case, [Limits(TANGENT, {"at_most": 0.5678})])
    simulate(before, trials=TRIALS, seed=5, engine="jit")
    misses = machine()._compiled.cache_info().misses
    moved = applied(case, [Limits(TANGENT, {"at_most": 0.4321})])
    result = simulate(moved, trials=TRIALS, seed=5, engine="jit")
    assert machine()._compiled.cache_info().misses == misses
    assert result.accepted == simulate(moved, trials=TRIALS, seed=5).accepted


def test_a_block_says_its_draws_start_where_it_does(book):
    model = book(*ODD)
    kept = ReusingRunner(model, "numpy", 5, TRIALS)
    runner = kept.runner(model, 100)
    whole = model.sampler(5, 300).draw(0)["u"]
    for start in (0, 200, 100, 0):
        assert runner.borrow(Task(start, 100, True, True)).prior["u"].tobytes() == whole[start : start + 100].tobytes()
