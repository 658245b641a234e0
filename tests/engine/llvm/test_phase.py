"""Values of nodes in a set of trials, and how loops are made of stages."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply
from xlmc.engine.llvm import phase as module
from xlmc.engine.llvm.loop_rules import Operand
from xlmc.engine.llvm.phase import Phase, Trials, _side_by_side_alone
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Kind
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import constant, from_objects

NUMBER, LOGICAL = Kind.NUMBER, Kind.LOGICAL


@pytest.fixture
def dag():
    return Dag()


def trials(dag, n=3, wider=None, survivors=()):
    return Trials(dag, n, np.zeros(n, np.uint8), wider, np.array(survivors, np.intp))


def test_what_loops_read(dag):
    """An array as it is; a value as doubles, NaN where it is an error, spread over the trials, and made once."""
    a, b, c = (dag.input(name) for name in "abc")
    made = trials(dag)
    made.arrays[a] = np.array([1.0, 2.0, 3.0])
    made.values[b] = from_objects(np.array(["7", ErrorCode.NA, True], object))
    made.values[c] = constant(5.0)
    assert made.array(Operand(a, NUMBER)) is made.arrays[a]
    doubles = made.array(Operand(b, NUMBER))
    assert np.array_equal(doubles, [7.0, np.nan, 1.0], equal_nan=True)
    assert made.array(Operand(b, NUMBER)) is doubles
    assert np.array_equal(made.array(Operand(b, LOGICAL)), [np.nan, np.nan, 1.0], equal_nan=True)
    spread = made.array(Operand(c, NUMBER))
    assert spread.tolist() == [5.0, 5.0, 5.0]
    assert spread.flags.c_contiguous


def test_values_of_nodes(dag):
    a, b, c = (dag.input(name) for name in "abc")
    known = dag.constant(constant("x"))
    wide, made = trials(dag, 4), None
    wide.arrays[c] = np.array([1.0, 2.0, 3.0, 4.0])
    made = trials(dag, 2, wide, [3, 1])
    made.arrays[a] = np.array([True, False])
    made.arrays[b] = np.array([0.5, -1.0])
    assert made.value(known).objects().tolist() == ["x"]
    assert made.value(a).objects().tolist() == [True, False]
    assert made.value(b).objects().tolist() == [0.5, -1.0]
    assert made.value(c).objects().tolist() == [4.0, 2.0]
    assert made.value(c) is made.value(c)


def test_plain_numbers(dag):
    a, b, c = (dag.input(name) for name in "abc")
    wide = trials(dag, 4)
    wide.arrays[c] = np.array([1.0, 2.0, 3.0, 4.0])
    made = trials(dag, 2, wide, [0, 2])
    made.arrays[a] = np.array([0.5, -1.0])
    made.values[b] = constant("x")
    plain = [made.plain(dag.constant(constant(item))) for item in (5.0, True, "x", ErrorCode.NA)]
    assert plain == [5.0, True, None, None]
    assert plain[1] is True
    assert made.plain(a) is made.arrays[a]
    assert made.plain(b) is None
    assert made.plain(c).tolist() == [1.0, 3.0]
    assert made.arrays[c].tolist() == [1.0, 3.0]
    assert trials(dag).plain(c) is None


def test_what_is_forgotten(dag):
    a, b = (dag.input(name) for name in "ab")
    made = trials(dag)
    made.arrays[a] = np.zeros(3)
    made.values[b] = constant(5.0)
    made.array(Operand(b, NUMBER))
    made.array(Operand(b, LOGICAL))
    made.forget([a, b, 99])
    assert (made.arrays, made.values, made._converted) == ({}, {}, {})


@pytest.mark.parametrize("fallible", [True, False])
def test_columns(dag, fallible):
    a, c = dag.input("a"), dag.input("c")
    number, text = dag.constant(constant(5.0)), dag.constant(constant(ErrorCode.NUM))
    wide = trials(dag, 4)
    wide.arrays[c] = np.array([1.0, 2.0, 3.0, 4.0])
    made = trials(dag, 2, wide, [3, 0])
    made.arrays[a] = np.array([0.5, -1.0])
    assert made.column(a, fallible).values.tolist() == [0.5, -1.0]
    assert made.column(c, fallible).values.tolist() == [4.0, 1.0]
    assert made.column(number, fallible).values.tolist() == [5.0, 5.0]
    assert made.column(text, fallible).codes.tolist() == [ErrorCode.NUM] * 2


def test_a_fallible_draw_may_be_an_error(dag):
    a, made = dag.input("a"), trials(dag, 2)
    made.arrays[a] = np.array([np.nan, 1.0])
    assert made.column(a, True).codes.tolist() == [ErrorCode.NUM, 0]


@pytest.mark.parametrize(
    ("loops", "at_once"),
    [
        ([(10, 1), (20, 1)], "usual"), ([(10, 3), (20, 1)], "usual"), ([(10, 4), (20, 1)], 1),
        ([(127, 4), (1, 1)], 0), ([(126, 4), (1, 1)], 1), ([(128, 4), (1, 1)], 0), ([(127, 4), (1, 1), (1, 1)], 1),
        ([(254, 4), (1, 1), (1, 1)], 0),
    ],
)  # fmt: skip
def test_how_many_vectors_code_that_serves_one_loop_takes(loops, at_once):
    """One in 128 nodes may be computed one trial after another, where at least four loops are alike."""
    assert _side_by_side_alone(loops) == (module.SIDE_BY_SIDE if at_once == "usual" else at_once)


def test_nodes_outside_of_loops(dag):
    """Numbers of numbers and truth values are computed as NumPy does, those of fallible draws are not."""
    made = Phase.__new__(Phase)
    made._dag, made._may_err = dag, frozenset({"b"})
    a, b = dag.input("a"), dag.input("b")

    def node(name, *arguments):
        return dag.add(Apply(REGISTRY[name], arguments))

    text = node("&", a, a)
    assert made._is_plain(node("GAMMALN", a))
    assert made._is_plain(node("+", a, node(">", a, dag.constant(constant(1.0)))))
    assert not made._is_plain(node("GAMMALN", b))
    assert not made._is_plain(node("LEN", text))
    assert not made._is_plain(text)
    assert not made._is_plain(a)
    assert not made._is_plain(node("SEQUENCE", a))
