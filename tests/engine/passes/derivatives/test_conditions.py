"""Conditions, choices and steps: their branches, and where they have no derivative."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.passes.derivatives.conditions import constant_jet, if_, if_error
from xlmc.engine.passes.derivatives.jet import Jet
from xlmc.engine.passes.derivatives.rules import RULES, Operand
from xlmc.errors import ErrorCode
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import Value, constant, from_objects

NAN = float("nan")
X = np.array([1.0, 2.0, 3.0])


def derivatives(jet, a=0):
    """By the assumption `a`, in each of three trials; none at all where no assumption reaches it."""
    if not jet.active:
        return [0.0, 0.0, 0.0]
    return np.broadcast_to(jet.first[a], (3,)).tolist()


@pytest.mark.parametrize(
    ("name", "branches", "lost"),
    [
        ("<", [1, 0, 0], True), ("<=", [1, 1, 0], True), (">", [0, 0, 1], True), (">=", [0, 1, 1], True),
        ("=", [0, 1, 0], False), ("<>", [1, 0, 1], False),
    ],
)  # fmt: skip
def test_comparisons(outcome_of, name, branches, lost):
    """By size, none has a derivative where both sides are equal; labels stand still."""
    outcome = outcome_of(name, X, 2.0, still=(1,))
    assert outcome.branches.tolist() == branches
    assert outcome.jet.x.tolist() == branches
    assert np.array_equal(derivatives(outcome.jet), [0.0, NAN if lost else 0.0, 0.0], equal_nan=True)
    if lost:
        assert np.array_equal(outcome.jet.second[0, 0], [0.0, NAN, 0.0], equal_nan=True)


@pytest.mark.parametrize("name", ["<", ">="])
def test_sides_that_change_alike_stay_equal(operands_of, name):
    """A number compared with itself, the same assumption on both sides."""
    (operand,) = operands_of([X])
    function = REGISTRY[name]
    outcome = RULES[name].apply(function, function([operand.value, operand.value]), [operand, operand])
    assert derivatives(outcome.jet) == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("name", ["<", "=", "<>"])
def test_texts_are_compared_without_derivatives(outcome_of, name):
    outcome = outcome_of(name, X, "text", still=(1,))
    assert outcome.jet.active == ()
    assert outcome.branches.tolist() == [1 if name == "<" else 0 if name == "=" else 1] * 3


def _broken(trial):
    """An operand without a derivative in one trial."""
    first = np.ones((1, 3))
    first[0, trial] = np.nan
    return Operand(Value.of_numbers(X), Jet(X, (0,), first, np.zeros((1, 1, 3))))


@pytest.mark.parametrize("name", ["<", "=", "<>"])
def test_a_condition_of_what_has_no_derivative_has_none(name):
    function, operands = REGISTRY[name], [_broken(0), Operand(constant(9.0), Jet.still(np.array([9.0])))]
    outcome = RULES[name].apply(function, function([each.value for each in operands]), operands)
    assert np.array_equal(derivatives(outcome.jet), [NAN, 0.0, 0.0], equal_nan=True)
    assert np.array_equal(outcome.jet.second[0, 0], [NAN, 0.0, 0.0], equal_nan=True)


@pytest.mark.parametrize(("name", "x"), [("AND", [1, 1, 1]), ("OR", [1, 1, 1]), ("XOR", [0, 0, 0]), ("NOT", [0, 0, 0])])
def test_joined_conditions(name, x):
    """They have no derivative where one of theirs has none."""
    function, one = REGISTRY[name], _broken(2)
    operands = [one] if name == "NOT" else [one, Operand(constant(True), Jet.still(np.ones(1)))]
    if name == "XOR":
        operands.append(Operand(constant(False), Jet.still(np.zeros(1))))
    outcome = RULES[name].apply(function, function([each.value for each in operands]), operands)
    assert outcome.branches.tolist() == outcome.jet.x.tolist() == x
    assert np.array_equal(derivatives(outcome.jet), [0.0, 0.0, NAN], equal_nan=True)


def test_conditions_of_a_range_are_summed(operands_of):
    """A range whose second cell has no derivative in trial 0."""
    x = np.ones((2, 1, 2))
    first = np.zeros((1, 2, 1, 2))
    first[0, 0, 0, 1] = np.nan
    operand = Operand(Value.of_numbers(x), Jet(x, (0,), first, np.zeros((1, 1, 1, 1, 1))))
    function = REGISTRY["AND"]
    outcome = RULES["AND"].apply(function, function([operand.value]), [operand])
    assert np.array_equal(outcome.jet.first[0], [NAN, 0.0], equal_nan=True)


@pytest.mark.parametrize("condition", [[1.0, 0.0, -2.0], [True, False, True]])
def test_the_branch_taken(operands_of, condition):
    """The condition stands still; the branches are two assumptions, the derivatives those of the one taken."""
    yes, no = np.full(3, 20.0), np.full(3, 30.0)
    test, *branches = operands_of([np.array(condition, object), yes, no], still=(0,))
    outcome = if_(Value.of_numbers(np.array([20.0, 30.0, 20.0])), [test, *branches])
    assert outcome.branches.tolist() == [True, False, True]
    assert outcome.jet.x.tolist() == [20.0, 30.0, 20.0]
    assert (derivatives(outcome.jet), derivatives(outcome.jet, 1)) == ([1.0, 0.0, 1.0], [0.0, 1.0, 0.0])
    assert outcome.jet.second.shape[:2] == (2, 2)
    assert not outcome.jet.second.any()


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("live", ["yes", "no"])
def test_one_branch_alone_varies(operands_of, live, order):
    arguments = [np.array([1.0, 0.0, 1.0]), np.full(3, 20.0), np.full(3, 30.0)]
    operands = operands_of(arguments, still=(0, 2 if live == "yes" else 1), order=order)
    jet = if_(Value.of_numbers(np.array([20.0, 30.0, 20.0])), operands).jet
    assert jet.order == order
    assert derivatives(jet) == ([1.0, 0.0, 1.0] if live == "yes" else [0.0, 1.0, 0.0])


def test_branches_that_stand_still(operands_of):
    operands = operands_of([np.array([1.0, 0.0, 1.0]), 20.0, 30.0], still=(0, 1, 2))
    jet = if_(Value.of_numbers(np.array([20.0, 30.0, 20.0])), operands).jet
    assert (jet.active, jet.x.tolist()) == ((), [20.0, 30.0, 20.0])


def test_a_condition_without_a_derivative_takes_that_of_the_choice(operands_of):
    yes, no = operands_of([np.full(3, 20.0), 30.0], still=(1,))
    jet = if_(Value.of_numbers(np.full(3, 20.0)), [_broken(1), yes, no]).jet
    assert np.array_equal(derivatives(jet), [1.0, NAN, 1.0], equal_nan=True)


def test_a_single_condition_of_ranges(operands_of):
    """One condition a trial chooses between two ranges of two cells, `(2, 1, 2)`."""
    low, high = np.array([[[1.0, 2.0]], [[3.0, 4.0]]]), np.array([[[5.0, 6.0]], [[7.0, 8.0]]])
    operands = operands_of([np.array([1.0, 0.0]), low, high], still=(0,))
    jet = if_(Value.of_numbers(np.array([[[1.0, 2.0]], [[7.0, 8.0]]])), operands).jet
    assert jet.x.tolist() == [[[1.0, 2.0]], [[7.0, 8.0]]]
    assert jet.first[:, 0, 0, 0].tolist() == [1.0, 0.0, 0.0, 0.0]
    assert jet.first[:, 1, 0, 1].tolist() == [0.0, 0.0, 0.0, 1.0]


@pytest.mark.parametrize(("only_na", "taken"), [(False, [False, True, True]), (True, [False, False, True])])
def test_instead_of_an_error(operands_of, only_na, taken):
    wrong = np.array([5.0, ErrorCode.DIV0, ErrorCode.NA], object)
    value, instead = from_objects(wrong), np.full(3, 9.0)
    (other,) = operands_of([instead])
    jet = Jet(value.numbers, (1,), np.full((1, 3), 2.0), np.zeros((1, 1, 3)))
    outcome = if_error(Value.of_numbers(np.where(taken, 9.0, 5.0)), [Operand(value, jet), other], only_na)
    assert outcome.branches.tolist() == taken
    assert derivatives(outcome.jet) == [float(one) for one in taken]
    assert derivatives(outcome.jet, 1) == [0.0 if one else 2.0 for one in taken]


def test_a_single_value_instead_of_cells(operands_of):
    cells = np.empty((2, 1, 2), object)
    cells[:, 0] = [[1.0, ErrorCode.NA], [3.0, 4.0]]
    value = from_objects(cells)
    (other,) = operands_of([np.full(2, 9.0)])
    jet = Jet(value.numbers, (1,), np.full((1, 1, 1, 1), 2.0), np.zeros((1, 1, 1, 1, 1)))
    outcome = if_error(Value.of_numbers(np.array([[[1.0, 9.0]], [[3.0, 4.0]]])), [Operand(value, jet), other], True)
    assert outcome.jet.first[0].tolist() == [[[0.0, 1.0]], [[0.0, 0.0]]]
    assert outcome.jet.first[1].tolist() == [[[2.0, 0.0]], [[2.0, 2.0]]]


@pytest.mark.parametrize(
    ("name", "x", "digits", "branches", "lost"),
    [
        ("ROUND", [1.25, 1.2, 1.31], 1.0, [1.3, 1.2, 1.3], [True, False, False]),
        ("ROUNDUP", [1.25, 1.2, 1.31], 1.0, [1.3, 1.2, 1.4], [False, True, False]),
        ("ROUNDDOWN", [1.25, 1.2, 1.31], 1.0, [1.2, 1.2, 1.3], [False, True, False]),
        ("TRUNC", [1.25, 2.0, -1.31], None, [1.0, 2.0, -1.0], [False, True, False]),
        ("INT", [1.25, 2.0, -1.31], None, [1.0, 2.0, -2.0], [False, True, False]),
        ("EVEN", [1.25, 2.0, -1.31], None, [2.0, 2.0, -2.0], [False, True, False]),
        ("ODD", [1.25, 3.0, -1.31], None, [3.0, 3.0, -3.0], [False, True, False]),
        ("SIGN", [1.25, 0.0, -1.31], None, [1.0, 0.0, -1.0], [False, True, False]),
        ("FACT", [2.25, 3.0, 4.5], None, [2.0, 6.0, 24.0], [False, True, False]),
        ("QUOTIENT", [4.5, 6.0, -7.0], 2.0, [2.0, 3.0, -3.0], [False, True, False]),
    ],
)
def test_steps(outcome_of, name, x, digits, branches, lost):
    arguments = [np.array(x)] + ([] if digits is None else [digits])
    outcome = outcome_of(name, *arguments, still=(1,))
    assert outcome.branches.tolist() == branches
    assert np.array_equal(derivatives(outcome.jet), np.where(lost, NAN, 0.0), equal_nan=True)


@pytest.mark.parametrize(
    ("name", "x", "multiple", "times", "lost"),
    [
        ("CEILING", [2.2, 3.0, 3.1], 1.5, [2, 2, 3], [False, True, False]),
        ("FLOOR", [2.2, 3.0, 3.1], 1.5, [1, 2, 2], [False, True, False]),
        ("MROUND", [2.2, 3.75, 3.1], 1.5, [1, 3, 2], [False, True, False]),
        ("CEILING.MATH", [2.2, 3.0, 3.1], 1.5, [2, 2, 3], [False, True, False]),
        ("FLOOR.MATH", [2.2, 3.0, 3.1], 1.5, [1, 2, 2], [False, True, False]),
        ("CEILING", [2.2, 3.0, 3.1], 0.0, [0, 0, 0], [False, False, False]),
    ],
)
def test_multiples(outcome_of, name, x, multiple, times, lost):
    """The derivative by the multiple is how often it is taken; by the number it is 0, none at a step."""
    outcome = outcome_of(name, np.array(x), multiple)
    assert outcome.branches.tolist() == times
    by_number = outcome.jet.first[outcome.jet.active.index(0)].tolist() if 0 in outcome.jet.active else [0.0] * 3
    by_multiple = np.broadcast_to(outcome.jet.first[-1], (3,))
    assert np.array_equal(by_number, np.where(lost, NAN, 0.0), equal_nan=True)
    assert by_multiple[~np.array(lost)].tolist() == [one for one, gone in zip(times, lost, strict=True) if not gone]


def test_a_multiple_that_is_left_out_is_1(outcome_of):
    outcome = outcome_of("CEILING.MATH", X - 0.5)
    assert outcome.branches.tolist() == [1.0, 2.0, 3.0]
    assert derivatives(outcome.jet) == [0.0, 0.0, 0.0]


def test_steps_of_several_numbers():
    """No step, but an operand without a derivative; a step of one without a derivative is not its own."""
    still, broken, result = Jet(X, (1,), np.ones((1, 3))), _broken(0).jet, Value.of_numbers(X)
    lone = constant_jet(result, [Jet(X, (0,), broken.first), still], np.zeros(1, bool))
    assert np.array_equal(derivatives(lone), [NAN, 0.0, 0.0], equal_nan=True)
    assert derivatives(lone, 1) == [0.0, 0.0, 0.0]
    both = constant_jet(result, [Jet(X, (0,), broken.first), still], np.array([True, True, False]))
    assert np.array_equal(derivatives(both), [NAN, NAN, 0.0], equal_nan=True)
    assert np.array_equal(derivatives(both, 1), [0.0, NAN, 0.0], equal_nan=True)
    assert constant_jet(result, [still], np.zeros(3, bool)).active == ()
