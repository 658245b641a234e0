"""LAMBDAs that call themselves, as bodies written out by hand: sums, factorials and Fibonacci numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from xlmc.engine.graph import recursive_calls
from xlmc.engine.graph.nodes import Apply, IfErrorNode, Range, Select
from xlmc.engine.graph.recursive_calls import Body, SelfCall, call_lambda, join_trials, spread_trials
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import Value, constant, from_objects


def apply(name, *slots):
    return Apply(REGISTRY[name], slots)


def items(value):
    return value.objects().ravel().tolist()


def numbers(*x):
    return Value.of_numbers(np.array(x, float))


def factorial(deepest=200):
    """f(n) = IF(n<=1, 1, n·f(n-1)); slot 1 is the constant 1."""
    steps = {2: apply("<=", 0, 1), 3: apply("-", 0, 1), 4: SelfCall((3,)), 5: apply("*", 0, 4), 6: Select(2, 1, 5)}
    return Body(1, 0, {1: constant(1.0)}, steps, 6, frozenset({6}), deepest)


def total(deepest=2000):
    """g(n, sum) = IF(n<=0, sum, g(n-1, sum+n)), with the step 1 taken from outside in slot 2 and 0 in slot 3."""
    steps = {4: apply("<=", 0, 3), 5: apply("-", 0, 2), 6: apply("+", 1, 0), 7: SelfCall((5, 6)), 8: Select(4, 1, 7)}
    return Body(2, 1, {3: constant(0.0)}, steps, 8, frozenset({7, 8}), deepest)


def fibonacci():
    """h(n) = IF(n<2, n, h(n-1) + h(n-2)), where 2 is taken from outside."""
    steps = {
        3: apply("<", 0, 1), 4: apply("-", 0, 2), 5: SelfCall((4,)), 6: apply("-", 0, 1), 7: SelfCall((6,)),
        8: apply("+", 5, 7), 9: Select(3, 0, 8),
    }  # fmt: skip
    return Body(1, 1, {2: constant(1.0)}, steps, 9, frozenset({9}), 100)


def test_each_trial_ends_by_its_own_numbers():
    assert items(call_lambda(factorial(), numbers(1, 5, 0, 10, 3))) == [1.0, 120.0, 1.0, math.factorial(10), 6.0]
    assert items(call_lambda(factorial(), numbers(4))) == [24.0]
    assert items(call_lambda(fibonacci(), numbers(0, 1, 7, 10), numbers(2))) == [0.0, 1.0, 13.0, 55.0]


def test_rounds_of_one_call():
    """The trials end in different rounds, and in another order than they have; what is taken may vary, too."""
    result = call_lambda(total(), numbers(3, 100, 0, 10), numbers(0, 0, 7, 1), numbers(1))
    assert items(result) == [6.0, 5050.0, 7.0, 56.0]
    assert items(call_lambda(total(), numbers(9), numbers(0), numbers(1, 2, 3))) == [45.0, 9 + 7 + 5 + 3 + 1, 18.0]


def test_deep_rounds_need_no_stack():
    assert items(call_lambda(total(), numbers(1500), numbers(0), numbers(1))) == [1500 * 1501 / 2]


@pytest.mark.parametrize(("deepest", "lost"), [(5, False), (4, True)])
def test_calls_too_deep_are_an_error_of_their_trial(deepest, lost):
    """5! takes five calls, and the others end before."""
    result = items(call_lambda(factorial(deepest), numbers(5, 2, 1, 4)))
    assert result == [ErrorCode.NUM if lost else 120.0, 2.0, 1.0, 24.0]
    rounds = items(call_lambda(total(deepest), numbers(4, 1, 3), numbers(0), numbers(1)))
    assert rounds == [ErrorCode.NUM if lost else 10.0, 1.0, 6.0]


def test_too_many_steps(monkeypatch):
    """1! takes the comparison and the choice; 3! those of three calls, two differences, products and calls."""
    monkeypatch.setattr(recursive_calls, "MOST_STEPS", 10)
    with pytest.raises(FormulaError, match="more than 10 steps"):
        call_lambda(factorial(), numbers(50))
    assert items(call_lambda(factorial(), numbers(1))) == [1.0]


def test_trials_that_call_too_deep_are_taken_out_so_many_times(monkeypatch):
    """Those that come to the depth together are taken out at once."""
    calls = numbers(*range(4, 10))
    assert set(items(call_lambda(factorial(3), calls))) == {ErrorCode.NUM}
    monkeypatch.setattr(recursive_calls, "_MOST_RESTARTS", 0)
    with pytest.raises(FormulaError, match="steps"):
        call_lambda(factorial(3), calls)


def test_errors_decide_nothing():
    wrong = from_objects(np.array([3.0, ErrorCode.DIV0, "x", 2.0], object))
    assert items(call_lambda(factorial(), wrong))[:2] == [6.0, ErrorCode.DIV0]
    assert items(call_lambda(total(), wrong, numbers(0), numbers(1)))[:2] == [6.0, ErrorCode.DIV0]
    assert items(call_lambda(total(), wrong, numbers(0), numbers(1)))[3] == 3.0


def with_if_error(only_na):
    """f(x) = IFERROR(1/x, f(x+1)); IFNA(1/x, …)."""
    steps = {2: apply("/", 1, 0), 3: apply("+", 0, 1), 4: SelfCall((3,)), 5: IfErrorNode(2, 4, only_na)}
    return Body(1, 0, {1: constant(1.0)}, steps, 5, frozenset(), 10)


def test_what_stands_for_an_error_is_called_for_those_trials_alone():
    assert items(call_lambda(with_if_error(False), numbers(0, 2, 4))) == [1.0, 0.5, 0.25]
    assert items(call_lambda(with_if_error(True), numbers(0, 2))) == [ErrorCode.DIV0, 0.5]
    lost = from_objects(np.array([ErrorCode.NA, 2.0], object))
    assert items(call_lambda(with_if_error(True), lost))[1] == 0.5


def test_texts_and_blanks():
    """f(n) = IF(n<=0, "end", f(n-1)), and an empty result that an IF makes 0."""
    steps = {3: apply("<=", 0, 2), 4: apply("-", 0, 1), 5: SelfCall((4,)), 6: Select(3, 7, 5)}
    for end, result in (("end", "end"), (None, 0.0), (ErrorCode.NA, ErrorCode.NA)):
        constants = {1: constant(1.0), 2: constant(0.0), 7: constant(end)}
        body = Body(1, 0, constants, steps, 6, frozenset({5, 6}), 10)
        assert items(call_lambda(body, numbers(0, 3, 1))) == [result] * 3
    plain = Body(1, 0, {1: constant(None)}, {}, 1, frozenset(), 10)
    assert items(call_lambda(plain, numbers(1))) == [None]


def test_arrays_are_refused():
    array = from_objects(np.array([[[1.0, 2.0]]], object))
    body = Body(1, 0, {1: array}, {}, 1, frozenset(), 10)
    with pytest.raises(FormulaError, match="calls itself gives an array"):
        call_lambda(body, numbers(1))
    one = Body(1, 0, {}, {1: Range(((0,),))}, 1, frozenset(), 10)
    assert items(call_lambda(one, numbers(1, 2))) == [1.0, 2.0]
    deciding = Body(1, 0, {1: array, 2: constant(1.0)}, {3: Select(1, 0, 2)}, 3, frozenset({3}), 10)
    with pytest.raises(FormulaError, match="An array decides"):
        call_lambda(deciding, numbers(1))


def test_values_of_some_trials_are_joined():
    first, second = np.array([3, 0]), np.array([2])
    joined = join_trials(4, [(first, from_objects(np.array(["a", 1.0], object))), (second, constant(ErrorCode.NA))])
    assert items(joined) == [1.0, None, ErrorCode.NA, "a"]
    whole = numbers(1, 2)
    assert join_trials(2, [(np.arange(2), whole)]) is whole
    assert items(join_trials(2, [(np.array([1, 0]), whole)])) == [2.0, 1.0]
    assert items(join_trials(2, [(np.array([0]), constant(5.0))])) == [5.0, None]
    assert items(join_trials(3, [])) == [None] * 3
    ranges = from_objects(np.array([[[1.0, 2.0]]], object))
    assert join_trials(2, [(np.array([1, 0]), ranges)]).shape == (2, 1, 2)
    with pytest.raises(FormulaError, match="arrays of several sizes"):
        join_trials(2, [(np.array([0]), ranges), (np.array([1]), constant(1.0))])


def test_a_constant_is_spread_over_trials():
    assert items(spread_trials(constant("x"), 3)) == ["x"] * 3


def counted():
    """c(n) = 1 + IF(n<=0, 0, c(n-1)): the IF is no last step; slots 1 and 2 are the constants 1 and 0."""
    steps = {3: apply("<=", 0, 2), 4: apply("-", 0, 1), 5: SelfCall((4,)), 6: Select(3, 2, 5), 7: apply("+", 1, 6)}
    return Body(1, 0, {1: constant(1.0), 2: constant(0.0)}, steps, 7, frozenset(), 10)


def test_a_choice_within_a_larger_formula():
    wrong = from_objects(np.array([2.0, ErrorCode.DIV0, 0.0, -1.0, 5.0], object))
    assert items(call_lambda(counted(), wrong)) == [3.0, ErrorCode.DIV0, 1.0, 1.0, 6.0]
    assert items(call_lambda(counted(), numbers(9, 10))) == [10.0, ErrorCode.NUM]


def test_two_ways_into_the_next_round():
    """w(n, sum) = IF(n<=0, sum, IF(ISEVEN(n), w(n-1, sum+10), w(n-1, sum+1))), in any order of trials."""
    steps = {
        5: apply("<=", 0, 2), 6: apply("-", 0, 3), 7: apply("+", 1, 4), 8: apply("+", 1, 3), 9: SelfCall((6, 7)),
        10: SelfCall((6, 8)), 11: apply("ISEVEN", 0), 12: Select(11, 9, 10), 13: Select(5, 1, 12),
    }  # fmt: skip
    constants = {2: constant(0.0), 3: constant(1.0), 4: constant(10.0)}
    body = Body(2, 0, constants, steps, 13, frozenset({9, 10, 12, 13}), 100)
    result = call_lambda(body, numbers(4, 3, 0, 1, 6, 5), numbers(0, 100, 7, 0, 0, 0))
    assert items(result) == [22.0, 112.0, 7.0, 1.0, 33.0, 23.0]


def test_a_lambda_without_parameters():
    result = call_lambda(Body(0, 0, {0: constant(5.0)}, {}, 0, frozenset(), 10))
    assert (items(result), result.shape) == ([5.0], (1,))
