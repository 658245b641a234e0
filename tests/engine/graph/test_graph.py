from __future__ import annotations

import pytest

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Range, Select, uses
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Kind
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import constant

ADD, SQRT, SUM, EQUAL, JOIN = (REGISTRY[name] for name in ("+", "SQRT", "SUM", "=", "&"))


@pytest.fixture
def dag():
    return Dag()


def number(dag, item):
    return dag.constant(constant(item))


def objects(dag, node):
    return dag.nodes[node].value.objects().tolist()


def test_equal_nodes_are_one(dag):
    a, b = dag.input("a"), dag.input("b")
    assert dag.input("a") == a != b
    assert dag.add(Apply(ADD, (a, b))) == dag.add(Apply(ADD, (a, b))) != dag.add(Apply(ADD, (b, a)))
    assert number(dag, 1.5) == number(dag, 1.5) != number(dag, 2.5)


@pytest.mark.parametrize(("one", "other"), [(1.0, True), (0.0, None), ("1", 1.0), ("", None), (ErrorCode.NA, "#N/A")])
def test_constants_of_different_kinds_are_two(dag, one, other):
    assert number(dag, one) != number(dag, other)


def test_what_is_known_is_computed_at_once(dag):
    four = dag.add(Apply(ADD, (number(dag, 1.0), number(dag, 3.0))))
    assert objects(dag, dag.add(Apply(SQRT, (four,)))) == [2.0]
    assert objects(dag, dag.add(Apply(SQRT, (number(dag, -1.0),)))) == [ErrorCode.NUM]
    total = dag.add(Range(((four, number(dag, "x")), (number(dag, None), four))))
    assert dag.sizes[total] == (2, 2)
    assert objects(dag, dag.add(Apply(SUM, (total,)))) == [8.0]


def test_nodes_come_after_those_they_use(dag):
    a = dag.input("a")
    root = dag.add(Apply(SQRT, (dag.add(Apply(ADD, (a, number(dag, 1.0)))),)))
    assert all(used < node for node in range(root + 1) for used in uses(dag.nodes[node]))


def test_types(dag):
    a = dag.input("a")
    equal, text = dag.add(Apply(EQUAL, (a, a))), dag.add(Apply(JOIN, (a, a)))
    assert [dag.types[node] for node in (a, equal, text)] == [Kind.NUMBER, Kind.LOGICAL, Kind.TEXT]
    assert dag.types[dag.add(Select(equal, a, a))] is Kind.NUMBER
    assert dag.types[dag.add(Select(equal, a, text))] is Kind.ANY
    assert dag.types[dag.add(IfErrorNode(a, number(dag, 0.0), False))] is Kind.NUMBER
    assert dag.types[dag.add(IfErrorNode(a, text, False))] is Kind.ANY
    assert dag.types[dag.add(Range(((a,),)))] is Kind.ANY


@pytest.mark.parametrize(
    ("condition", "taken"),
    [(True, "yes"), (2.0, "yes"), (0.0, "no"), (None, "no"), (ErrorCode.NA, None), ("x", None)],
)
def test_an_if_whose_condition_is_known(dag, condition, taken):
    inputs = {"yes": dag.input("yes"), "no": dag.input("no")}
    made = dag.add(Select(number(dag, condition), inputs["yes"], inputs["no"]))
    assert made == inputs.get(taken, len(dag.nodes) - 1)
    assert isinstance(dag.nodes[made], Input if taken else Select)


@pytest.mark.parametrize(
    ("value", "only_na", "given"),
    [(1.0, False, 1.0), (None, False, 0.0), (ErrorCode.NUM, False, "instead"), (ErrorCode.NUM, True, ErrorCode.NUM)],
)
def test_a_rescue_of_what_is_known(dag, value, only_na, given):
    instead = dag.input("instead")
    made = dag.add(IfErrorNode(number(dag, value), instead, only_na))
    assert made == instead if given == "instead" else objects(dag, made) == [given]


def test_sizes_follow_through(dag):
    a = dag.input("a")
    column = dag.add(Range(((a,), (a,), (number(dag, 1.0),))))
    row = dag.add(Range(((number(dag, 1.0), number(dag, 2.0)),)))
    assert isinstance(dag.nodes[row], Constant)
    assert [dag.sizes[node] for node in (a, column, row)] == [None, (3, 1), (1, 2)]
    sum_of_both = dag.add(Apply(ADD, (column, row)))
    assert (dag.sizes[sum_of_both], dag.types[sum_of_both]) == ((3, 2), Kind.ANY)
    assert dag.sizes[dag.add(Apply(SUM, (sum_of_both,)))] is None


def test_upstream_is_what_varies_in_order(dag):
    a, b = dag.input("a"), dag.input("b")
    one = dag.add(Apply(ADD, (a, number(dag, 1.0))))
    dag.add(Apply(SQRT, (b,)))
    two = dag.add(Apply(SQRT, (one,)))
    assert dag.upstream([two]) == [a, one, two]
    assert dag.upstream([number(dag, 9.0)]) == []
    assert dag.upstream([two, a]) == [a, one, two]
