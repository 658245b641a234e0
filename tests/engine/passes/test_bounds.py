from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated import simulated

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Select
from xlmc.engine.passes.bounds import NodeBounds
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT
from xlmc.excel.functions.values import NUMBER, TEXT, Value, constant

OPERATIONS = {"+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide}
OF_ONE = {"u-": np.negative, "SIN": np.sin, "COS": np.cos, "SQRT": np.sqrt, "ABS": np.abs, "EXP": np.exp}
OF_TWO = {**OPERATIONS, "MAX": np.maximum, "MIN": np.minimum}
LIMITS = st.floats(-1e6, 1e6)


@st.composite
def models(draw):
    """A graph of operations on two bounded inputs and a constant, with values of its nodes in 50 trials."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    ends = [sorted(draw(st.tuples(LIMITS, LIMITS))) for _ in range(2)]
    dag, number = Dag(), draw(LIMITS)
    nodes = [dag.input("a"), dag.input("b"), dag.constant(constant(number))]
    values = [rng.uniform(low, high, 50).clip(low, high) for low, high in ends] + [np.full(50, number)]
    for _ in range(draw(st.integers(1, 6))):
        name = draw(st.sampled_from([*OF_TWO, *OF_ONE]))
        used = rng.integers(len(nodes), size=1 if name in OF_ONE else 2).tolist()
        node = dag.add(Apply(REGISTRY[name], tuple(nodes[part] for part in used)))
        if node not in nodes and node == len(dag.nodes) - 1:
            with np.errstate(all="ignore"):
                values.append((OF_TWO | OF_ONE)[name](*(values[part] for part in used)))
            nodes.append(node)
    return dag, dict(zip(("a", "b"), map(tuple, ends), strict=True)), dict(zip(nodes, values, strict=True))


@given(models())
def test_values_lie_between_the_bounds(model):
    """Rounding may lead past them by some 1e-16 of the largest numbers on the way, here at most six operations."""
    dag, ends, values = model
    known, reach = NodeBounds(dag, ends), 1.0
    for node in dag.upstream(list(values)):
        result = known.of(node)
        if node in values and result is not None:
            low, high = result
            reach = max(reach, 1e6, *(abs(end) for end in result if math.isfinite(end)))
            computed = values[node][np.isfinite(values[node])]  # no root of less than 0
            assert (low - 1e-13 * reach <= computed).all()
            assert (computed <= high + 1e-13 * reach).all()


@pytest.fixture
def dag():
    return Dag()


def test_what_is_known(dag):
    a, b, free = dag.input("a"), dag.input("b"), dag.input("free")
    two = dag.constant(constant(2.0))

    def of(name, *parts):
        return dag.add(Apply(REGISTRY[name], parts))

    wanted = {
        a: (-1.0, 3.0),
        of("u-", a): (-3.0, 1.0),
        of("*", a, two): (-2.0, 6.0),
        of("/", two, b): (0.5, 2.0),
        of("-", a, b): (-5.0, 2.0),
        of("ABS", a): (0.0, 3.0),
        of("SQRT", b): (0.0, 4.0),
        of("SIN", a): (-1.0, 1.0),
        of("COS", free): (-1.0, 1.0),
        of("ABS", free): (0.0, math.inf),
        of("EXP", free): (0.0, math.inf),
        of("EXP", a): (0.0, 2.0 * math.exp(3.0)),
        of("EXP", of("*", a, dag.constant(constant(300.0)))): (0.0, math.inf),
        of("SQRT", free): (0.0, math.inf),
        of("MAX", a, two): (2.0, 3.0),
        of("MAX", free, two): (2.0, math.inf),
        of("MIN", b, free): (-math.inf, 4.0),
        of("MIN", a, b): (-1.0, 3.0),
        of("+", b, of("EXP", free)): (1.0, math.inf),
        of("-", b, of("EXP", free)): (-math.inf, 4.0),
        of("*", b, of("EXP", free)): (0.0, math.inf),
        of("/", two, of("MAX", free, two)): (0.0, 1.0),
        of("*", dag.constant(constant(0.0)), free): (0.0, 0.0),
        dag.add(Select(of("<", a, b), a, two)): (-1.0, 3.0),
    }
    unknown = [free, of("/", two, a), of("+", a, free), of("*", of("ABS", free), of("SIN", a))]
    known = NodeBounds(dag, {"a": (-1.0, 3.0), "b": (1.0, 4.0)})
    assert {node: known.of(node) for node in reversed(wanted)} == dict(reversed(wanted.items()))
    assert [known.of(node) for node in unknown] == [None] * len(unknown)


def test_a_number_of_a_table_lies_between_the_smallest_and_the_largest(dag):
    numbers, free = np.array([[[3.0], [-2.0], [7.0]]]), dag.input("free")
    kinds = np.array([[[NUMBER], [TEXT], [NUMBER]]], np.uint8)
    columns = [dag.constant(Value(numbers, np.full_like(kinds, NUMBER))), dag.constant(Value(numbers, kinds))]
    cells = [dag.add(Apply(CELL_AT, (column, free))) for column in columns]
    known = NodeBounds(dag, {"other": (0.0, 1.0)})
    assert list(map(known.of, cells)) == [(-2.0, 7.0), None]


def test_a_graph_may_grow(dag):
    a, two = dag.input("a"), dag.constant(constant(2.0))
    known = NodeBounds(dag, {"a": (-1.0, 3.0)})
    assert (known.of(a), known.of(two)) == ((-1.0, 3.0), (2.0, 2.0))
    assert known.of(dag.add(Apply(REGISTRY["*"], (a, two)))) == (-2.0, 6.0)


def test_without_bounds_of_inputs_only_constants_are_known(dag):
    a, two = dag.input("a"), dag.constant(constant(2.0))
    known = NodeBounds(dag, {})
    assert [known.of(node) for node in (a, two, dag.add(Apply(REGISTRY["SIN"], (a,))))] == [None, (2.0, 2.0), None]


@pytest.mark.parametrize(
    ("assumption", "asked"),
    [
        ({"low": 0.0, "high": 90.0}, 0),
        ({"distribution": "Triangular", "low": 0.0, "likeliest": 1.0, "high": 90.0}, 0),
        ({"distribution": "Normal", "mean": 0.0, "std_dev": 1.0, "lower_cutoff": -3.0, "upper_cutoff": 3.0}, 0),
        ({"distribution": "Normal", "mean": 0.0, "std_dev": 1.0}, 1),
        ({"low": 0.0, "high": 1e9}, 1),
    ],
)
def test_a_guard_is_asked_only_where_the_assumptions_do_not_answer(book, monkeypatch, assumption, asked):
    from xlmc.excel.functions.math.trigonometry import Within

    calls = []
    call = Within.__call__
    monkeypatch.setattr(Within, "__call__", lambda self, x: (calls.append(x.size), call(self, x))[1])
    model = book({"A1": 1.0, "B1": "=SIN(A1)"}, {"a": {"cell": "A1", **assumption}}, {"x": "B1"})
    run = simulated(model, 1000, seed=1)
    assert bool(calls) == bool(asked)
    assert np.array_equal(np.isnan(run.forecasts["x"]), np.abs(run.inputs["a"]) >= 2.0**27)


@given(st.floats(allow_nan=False, allow_infinity=False), st.integers(-59, 59), st.sampled_from([1.0, -1.0]))
def test_to_divide_by_a_power_of_two_is_to_multiply(x, exponent, sign):
    divisor = sign * 2.0**exponent
    with np.errstate(all="ignore"):
        assert math.copysign(1.0, x / divisor) == math.copysign(1.0, x * (1.0 / divisor))
        assert np.float64(x) / divisor == np.float64(x) * (1.0 / divisor)
