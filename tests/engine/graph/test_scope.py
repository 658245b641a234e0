"""How ranges are taken in parts of a formula, and what a LAMBDA, a name or a choice gives as a function."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.engine.graph import scope as module
from xlmc.engine.graph.scope import Closure, LambdaCalls, Scope, Thunk, TooDeepError, bind, check_depth, is_omitted
from xlmc.errors import XlmcError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.registry import Ranges

HERE = Cell("S", 9, 9)
PLAIN = Scope(HERE)
FLAGS = [
    Scope(HERE, of_array=bool(bits & 1), around=bool(bits & 2), whole=bool(bits & 4), pointing=bool(bits & 8))
    for bits in range(16)
]


def flags(scope):
    return scope.of_array, scope.around, scope.whole, scope.pointing


@pytest.mark.parametrize("scope", FLAGS, ids=lambda scope: "".join("01"[each] for each in flags(scope)))
def test_how_parts_take_ranges(scope):
    """Array formula, around, whole, pointing: what each kind of part makes of them."""
    of_array, around, whole, pointing = flags(scope)
    assert scope.array == (of_array or around)
    assert scope.taking == (of_array, around, whole)
    assert flags(scope.plainly()) == (of_array, False, False, False)
    assert flags(scope.inside()) == (of_array, around, False, False)
    assert flags(scope.pointed_at()) == (of_array, around, whole, True)
    assert flags(scope.wanted_whole()) == (of_array, around, True, pointing)
    assert flags(scope.branch()) == (of_array, False, whole or around, pointing)
    assert flags(scope.over_arrays()) == (scope.taking if scope.array else (False, True, False)) + (pointing,)
    assert flags(scope.of(Ranges.CELLS)) == flags(scope.over_arrays())
    assert flags(scope.of(Ranges.AROUND)) == flags(scope.of(Ranges.ONE_CELL)) == flags(scope)
    others = [each for each in Ranges if each not in (Ranges.CELLS, Ranges.AROUND, Ranges.ONE_CELL)]
    assert all(flags(scope.of(each)) == flags(scope.plainly()) for each in others)
    seen = Scope(HERE, depth=3).seen_from(replace(scope, depth=5))
    assert (seen.taking, seen.depth, seen.pointing) == (scope.taking, 5, False)


def test_scopes_that_need_no_change_stay():
    for change in ("plainly", "inside", "branch"):
        assert getattr(PLAIN, change)() is PLAIN
    whole, pointing, array = Scope(HERE, whole=True), Scope(HERE, pointing=True), Scope(HERE, of_array=True)
    assert whole.wanted_whole() is whole
    assert pointing.pointed_at() is pointing
    assert array.over_arrays() is array


def test_variables_are_added():
    scope = PLAIN.bound({"a": 1}).bound({"b": 2, "a": 3})
    assert scope.variables == {"a": 3, "b": 2}
    inner = PLAIN.bound({"a": 1}).defining("f", ir.Number(2.0))
    assert inner.variables["a"] == 1
    assert inner.variables["f"].tree == ir.Number(2.0)
    assert inner.variables["f"].scope is inner


LAMBDA = ir.Lambda(("x", "y"), ir.Variable("x"), 1)


def test_calls_of_a_lambda():
    """Two parameters, of which the last may be left out; a call is one deeper, and takes ranges as its caller."""
    closure = Closure(LAMBDA, PLAIN.bound({"z": 9}))
    assert [closure.takes(count) for count in range(4)] == [False, True, True, False]
    caller = Scope(HERE, of_array=True, depth=4)
    inside = closure.inside([7], caller)
    assert (inside.variables["x"], inside.variables["z"], inside.depth, inside.of_array) == (7, 9, 5, True)
    assert inside.variables["y"].tree == ir.Missing()
    assert is_omitted(ir.Variable("y"), inside)
    assert not is_omitted(ir.Variable("x"), inside)
    assert not is_omitted(ir.Number(1.0), inside)
    assert not is_omitted(ir.Variable("none"), inside)
    further = PLAIN.bound({"outer": Thunk(ir.Variable("y"), inside)})
    assert is_omitted(ir.Variable("outer"), further)
    assert isinstance(bind(LAMBDA, PLAIN), Closure)
    assert isinstance(bind(ir.Number(1.0), PLAIN), Thunk)


def test_calls_too_deep():
    check_depth(Scope(HERE, depth=59))
    with pytest.raises(TooDeepError, match="more than 60 deep"):
        check_depth(Scope(HERE, depth=60))


def test_calls_that_are_written_out(monkeypatch):
    """Three within one call, and as many again in the next; one that calls itself is among the repeated ones."""
    monkeypatch.setattr(module, "_MOST_WRITTEN_OUT", 3)
    calls, one, other = LambdaCalls(), Closure(LAMBDA, PLAIN), Closure(LAMBDA, PLAIN)
    for _ in range(2):
        with calls.calling(one):
            assert calls.is_called(one)
            assert not calls.is_called(other)
            for _ in range(2):
                with calls.calling(one):
                    pass
        assert not calls.is_called(one)

    def four_times():
        with calls.calling(other), calls.calling(one):
            for _ in range(3):
                with calls.calling(one):
                    pass

    with pytest.raises(TooDeepError) as raised:
        four_times()
    assert raised.value.repeated == {one}
    assert not calls.is_called(other)
    with calls.calling(one):
        pass


def test_lambdas_that_are_lowered_on_their_own():
    calls, one = LambdaCalls(), Closure(LAMBDA, PLAIN)
    assert not calls.any_open
    with calls.opening(one):
        with calls.opening(one):
            assert calls.is_open(one)
        assert calls.any_open
    assert not calls.is_open(one)
    assert not calls.any_open


CELLS = {"A1": 3.0, "A2": 5.0}
CALLED = [
    ("LAMBDA(x,x+1)(A1)", 4.0),
    ("LET(f,LAMBDA(x,x*2),f(A1))", 6.0),
    ("LET(f,LAMBDA(x,x*2),g,f,g(A1))", 6.0),
    ("IF(A1>1,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", 4.0),
    ("IF(A1>9,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", 5.0),
    ("CHOOSE(2,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", 5.0),
    ("CHOOSE(1.9,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", 4.0),
    ("LAMBDA(x,LAMBDA(y,x*10+y))(A1)(A2)", 35.0),
    ("LET(f,LAMBDA(x,LAMBDA(y,x*10+y)),g,f(A2),g(A1))", 53.0),
    ("LET(y,7,LAMBDA(x,LET(y,2,x*y)))(A1)", 6.0),
    ("REDUCE(0,A1:A2,LAMBDA(a,b,a+b))", 8.0),
]


@pytest.mark.parametrize(("formula", "expected"), CALLED, ids=[formula for formula, _ in CALLED])
def test_what_is_called(value_of, formula, expected):
    assert value_of(CELLS, formula) == expected


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("LET(f,5,f(1))", "what is called here is not a LAMBDA"),
        ("CHOOSE(3,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", "what is called here is not a LAMBDA"),
        ("CHOOSE(0,LAMBDA(x,x+1),LAMBDA(x,x+2))(A1)", "what is called here is not a LAMBDA"),
        ("LAMBDA(x,LAMBDA(y,x+y))(1,2)(3)", "another number of arguments"),
    ],
)
def test_what_cannot_be_called(value_of, formula, message):
    with pytest.raises(XlmcError, match=f"(?i){message}"):
        value_of(CELLS, formula)


def test_functions_by_a_condition_that_varies(run):
    cells = {**CELLS, "H9": "=IF(A1>1,LAMBDA(x,x+1),LAMBDA(x,x*10))(A1)"}
    assert run(cells, {"A1": [0.5, 2.0]}, ["H9"]).forecasts == [[5.0, 3.0]]
