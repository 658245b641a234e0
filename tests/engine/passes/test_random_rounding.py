"""Random rounding: small, blind to whole numbers, and as large as true errors are."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf

from xlmc.engine.graph.nodes import Apply, Constant, Input
from xlmc.engine.passes.random_rounding import (
    RandomRounding,
    _find_typed,
    closure,
    evaluate,
    evaluate_changes,
    numbers_of,
    open_constants,
    term_sizes,
)
from xlmc.excel.functions.values import Value, constant


@pytest.fixture(scope="session")
def needed(book):
    def make(formula, **cells):
        model = book(
            {"A1": 1.0, "Z1": formula} | cells, {"x": {"cell": "A1", "low": 0, "high": 9}}, {"f": "Z1", "x": "A1"}
        )
        node = model.lowering.cell(model.forecasts[0].cell)
        return model.lowering.dag, closure(model.lowering.dag, [node]), node

    return make


@given(st.floats(1e-300, 1e300), st.integers(0, 1000))
def test_a_number_moves_by_a_unit_of_its_last_place_or_not_at_all(x, seed):
    moved = RandomRounding(seed).move(Value.of_numbers(np.array([x])), 64).numbers
    near = {np.nextafter(x, 0), x, np.nextafter(x, np.inf)}
    assert set(moved.tolist()) <= near
    assert (x == np.rint(x) and x < 2**52) or len(set(moved.tolist())) == 3


def test_whole_numbers_and_texts_stay():
    rounding = RandomRounding(1)
    assert set(rounding.move(Value.of_numbers(np.array([2.0, 1e15])), 2).numbers.tolist()) == {2.0, 1e15}
    text = constant("a")
    assert rounding.move(text, 5) is text
    moved = rounding.move(Value.of_numbers(np.full(500, 2.0)), 500, whole_too=True).numbers
    assert len(set(moved.tolist())) == 3


def test_without_rounding_at_random_it_is_the_run(needed):
    dag, nodes, node = needed("=SIN(A1)*EXP(-A1)+LN(A1)/3")
    x = np.linspace(0.1, 5, 50)
    result = numbers_of(evaluate(dag, nodes, {"x": x})[node], 50)
    assert result == pytest.approx(np.sin(x) * np.exp(-x) + np.log(x) / 3, rel=1e-13)


@pytest.mark.parametrize(
    ("formula", "f"),
    [
        ("=(A1+1000000)-1000000", lambda x: x),
        ("=(1-COS(A1/1000))/A1", lambda x: (1 - mpmath.cos(x / 1000)) / x),
        ("=SQRT(A1*A1+0.1)-A1", lambda x: mpmath.sqrt(x * x + mpf("0.1")) - x),
    ],
)
def test_roundings_at_random_differ_as_much_as_the_true_error(needed, formula, f):
    """Within a small factor: every other result moves by a unit or two halves, and a rounding is 0.29 in the mean."""
    dag, nodes, node = needed(formula)
    x = np.random.default_rng(3).uniform(1, 2, 400)
    plain = numbers_of(evaluate(dag, nodes, {"x": x})[node], 400)
    off = [numbers_of(evaluate(dag, nodes, {"x": x}, RandomRounding(i))[node], 400) - plain for i in range(6)]
    with mpmath.workdps(50):
        true = np.array([float(mpf(p) - f(mpf(v))) for p, v in zip(plain, x, strict=True)])
    ratio = np.sqrt(np.mean(np.square(off))) / np.sqrt(np.mean(true**2))
    assert 0.4 <= ratio <= 8


def test_constants_that_were_computed_move_too(needed):
    """COS of 270° is folded to -1.8e-16 while the formula is compiled: no digit of it is there."""
    dag, nodes, node = needed("=A1*COS(RADIANS(270))")
    x = np.full(200, 3.0)
    moved = numbers_of(evaluate(dag, nodes, {"x": x}, RandomRounding(1))[node], 200)
    plain = numbers_of(evaluate(dag, nodes, {"x": x})[node], 200)
    assert np.abs(moved / plain - 1).max() > 0.5


def test_inputs_move_alike_wherever_they_are_used(needed):
    """A difference of an input with itself stays 0; one of its rounding with itself does not."""
    dag, nodes, node = needed("=A1*3.7-A1*3.7+B1*A1-A1*B1", B1=0.3)
    x = np.full(100, 1.1)
    result = numbers_of(evaluate(dag, nodes, {"x": x}, of_inputs=RandomRounding(1, 2.0**-20))[node], 100)
    assert np.abs(result).max() == 0.0


def test_the_size_of_terms(needed):
    dag, nodes, node = needed("=((A1+1000)-1001)*5")
    assert term_sizes(dag, nodes, evaluate(dag, nodes, {"x": np.array([1.0, 2.0])}))[node] == 1002.0


def test_values_that_nothing_reads_any_more_are_dropped(needed):
    dag, nodes, node = needed("=SIN(A1)*EXP(-A1)+LN(A1)/3")
    x = np.linspace(0.1, 5, 50)
    result = evaluate(dag, nodes, {"x": x}, RandomRounding(3), keep=[node])
    assert [*result] == [node]
    assert (
        numbers_of(result[node], 50).tobytes()
        == numbers_of(evaluate(dag, nodes, {"x": x}, RandomRounding(3))[node], 50).tobytes()
    )


@pytest.mark.parametrize(
    ("changed", "expected", "count"),
    [
        ({"sum": 10.0}, 30.0, 4),  # no logarithm
        ({"x": 4.0}, 18.0 + np.log(4.0), 6),
        ({"x": 4.0, "sum": 10.0}, 30.0 + np.log(4.0), 6),
    ],
)
def test_what_depends_on_another_value_changes_and_nothing_else(needed, changed, expected, count):
    """(A1 + 2)·3 + LN(A1), where A1 is 1 and the sum 3; the last addition rounds a difference to 0, by a node."""
    dag, nodes, node = needed("=(A1+2)*3+LN(A1)")
    values = evaluate(dag, nodes, {"x": np.array([1.0])})
    places = {
        "x": next(n for n in nodes if isinstance(dag.nodes[n], Input)),
        "sum": next(n for n in nodes if isinstance(dag.nodes[n], Apply) and values[n].numbers[0] == 3.0),
    }
    given_values = {places[name]: Value.of_numbers(np.array([value])) for name, value in changed.items()}
    result = evaluate_changes(dag, nodes, values, given_values)
    assert result[node].numbers[0] == pytest.approx(expected)
    assert len(result) == count
    assert all(result[n] is each for n, each in given_values.items())


def test_arrays_of_constants_are_moved_once_and_numbers_in_each_trial():
    moved = RandomRounding(1).move(Value.of_numbers(np.linspace(0.1, 0.9, 12).reshape(1, 4, 3)), 50)
    assert moved.shape == (1, 4, 3)
    assert RandomRounding(1).move(constant(0.1), 50).shape == (50,)


@pytest.mark.parametrize(("most", "closed"), [(10_000, False), (100, False), (80, True)])
def test_constants_computed_from_large_arrays_count_as_typed(needed, most, closed):
    """The sum of squares reads 40 cells twice, and the other sum 4."""
    cells = {f"B{k}": k / 7 for k in range(1, 41)} | {f"C{k}": k / 9 for k in range(1, 5)}
    dag, _, node = needed("=A1*SUMPRODUCT(B1:B40*B1:B40)+SUM(C1:C4*C1:C4)", **cells)
    graph = open_constants(dag, [node], most)
    names = {dag.origins[each].function.name for each in graph.closed}
    assert names == ({"SUMPRODUCT"} if closed else set())
    nodes = closure(graph, [node])
    x = np.linspace(0.1, 5, 50)
    plain = numbers_of(evaluate(dag, closure(dag, [node]), {"x": x})[node], 50)
    assert numbers_of(evaluate(graph, nodes, {"x": x})[node], 50).tobytes() == plain.tobytes()


@pytest.mark.parametrize(
    ("formula", "typed"),
    [
        ("=A1*99", []),
        ("=A1*-99", []),
        ("=A1*100", [100.0]),
        ("=A1*2.5", [2.5]),
        ("=A1*99.5+3", [99.5]),
        ("=A1*PI()", []),
        ("=A1*3.14", [3.14]),
        ("=A1/32.2-1000", [32.2, 1000.0]),
        ("=A1^2.5", []),
        ("=200.5^A1", [200.5]),
        ("=RADIANS(A1)", []),
        ("=IF(A1>200.5,1,2)", []),
    ],
)
def test_typed_numbers_are_measurements_unless_they_count_or_are_exponents(needed, formula, typed):
    dag, nodes, _ = needed(formula)
    result = [dag.nodes[each] for each in _find_typed(dag, nodes)]
    assert all(isinstance(node, Constant) for node in result)
    assert sorted(float(node.value.numbers.flat[0]) for node in result) == sorted(typed)
