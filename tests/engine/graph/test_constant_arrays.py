"""Arrays of constants: equal ones are one, and those that only constants are computed from do not fill the memory."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from xlmc.engine.graph.nodes import Constant, Forgotten
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.tracking import TrackingEvaluator
from xlmc.errors import FormulaError

ROWS, COLUMNS, FORMULAS = 40, 41, 60
SMALL = 100_000
"""Bytes: seven arrays of the size of the matrix, which has 13,120, and no eighth."""

RANGE = f"Data!$A$1:$AO${ROWS}"
MATRIX = np.round(np.random.default_rng(5).random((ROWS, COLUMNS)), 4)
ROW_GROUP, COLUMN_GROUP = np.arange(ROWS) % 9, np.arange(COLUMNS) % 7
DRAWS = np.linspace(1.0, 2.0, 9)


def at(row, column):
    letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
    return ("" if column < 26 else letters[column // 26 - 1]) + letters[column % 26] + str(row + 1)


def matrix(sheet="Data", changed=()):
    cells = {f"{sheet}!{at(r, c)}": float(MATRIX[r, c]) for r in range(ROWS) for c in range(COLUMNS)}
    return cells | dict(changed)


GROUPS = {f"Data!{at(r, 50)}": float(ROW_GROUP[r]) for r in range(ROWS)} | {
    f"Data!{at(50, c)}": float(COLUMN_GROUP[c]) for c in range(COLUMNS)
}
MASKS = f"(Data!$AY$1:$AY${ROWS}={{r}})*(Data!$A$51:$AO$51={{c}})"


@pytest.fixture
def bounded(monkeypatch):
    """Have so little memory for constants that arrays must be forgotten."""
    monkeypatch.setattr("xlmc.engine.graph.graph.MOST_KEPT", SMALL)


def made_for(lower, cells, targets=("Z1",)):
    return lower({"A1": 1.5} | cells, ["A1"], targets, sheets=("Data", "Copy"))


def numbers(lower, load_program, engine, cells):
    lowering, targets = made_for(lower, cells)
    program = load_program(engine)(lowering, targets, [], frozenset())
    (column,) = program.evaluator(DRAWS.size).filters({"A1": DRAWS}, DRAWS.size)
    return np.array(column.values), lowering.dag


def forgotten(dag):
    return [node_id for node_id, node in enumerate(dag.nodes) if isinstance(node, Forgotten)]


def book_of(formula):
    return {f"B{k + 1}": formula(k) for k in range(FORMULAS)} | {"Z1": f"=SUM(B1:B{FORMULAS})"}


def masked(k):
    return f"=SUMPRODUCT({MASKS.format(r=k % 9, c=k % 7)}*({RANGE}+{k}))*A1"


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_sums_of_many_computed_arrays_equal_those_of_numpy(lower, load_program, engine, monkeypatch):
    cells = matrix() | GROUPS | book_of(masked)
    whole, dag = numbers(lower, load_program, engine, cells)
    assert not forgotten(dag)
    monkeypatch.setattr("xlmc.engine.graph.graph.MOST_KEPT", SMALL)
    bounded, dag = numbers(lower, load_program, engine, cells)
    assert len(forgotten(dag)) > FORMULAS
    assert dag.kept <= SMALL
    assert bounded.tobytes() == whole.tobytes()
    each = [
        (np.equal(ROW_GROUP, k % 9)[:, None] * np.equal(COLUMN_GROUP, k % 7) * (MATRIX + k)).sum()
        for k in range(FORMULAS)
    ]
    np.testing.assert_allclose(bounded, sum(each) * DRAWS, rtol=1e-13)


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_a_constant_matrix_and_vectors_that_vary(lower, load_program, engine, bounded):
    drawn = {f"Data!{at(r, 52)}": f"=S!A$1*{r}+1" for r in range(ROWS)}
    formulas = book_of(lambda k: f"=SUMPRODUCT({RANGE}*Data!$BA$1:$BA${ROWS})*{k}")
    result, dag = numbers(lower, load_program, engine, matrix() | drawn | formulas)
    expected = [(MATRIX * (x * np.arange(ROWS) + 1)[:, None]).sum() * sum(range(FORMULAS)) for x in DRAWS]
    np.testing.assert_allclose(result, expected, rtol=1e-13)
    assert dag.kept < 2 * MATRIX.nbytes


@pytest.mark.parametrize(
    ("content", "sign", "expected"),
    [
        ("=NA()", "*", "#N/A"),
        ("=NA()", ",", "#N/A"),
        ("=1/0", ",", "#DIV/0!"),
        ("n. a.", "*", "#VALUE!"),
        ("n. a.", ",", None),
        ("12", ",", None),
    ],
)
def test_an_error_or_a_text_in_the_matrix(lower, evaluate, monkeypatch, content, sign, expected):
    """A text between commas counts as 0."""
    monkeypatch.setattr("xlmc.engine.graph.graph.MOST_KEPT", 300_000)  # an array with texts takes 120,000
    cells = matrix(changed={"Data!C3": content}) | {
        f"B{k}": f"=SUMPRODUCT((Data!$AY$1:$CM${ROWS}+{k}){sign}{RANGE})*A1" for k in range(1, 40)
    }
    lowering, targets = made_for(lower, cells, [f"B{k}" for k in range(1, 40)])
    dag = lowering.dag
    assert forgotten(dag)
    result = evaluate(NumpyProgram.of(lowering, [], targets, frozenset()).evaluator(9), {"A1": DRAWS}, 9)
    slow = evaluate(TrackingEvaluator(dag, [], [lowering.target(each) for each in targets]), {"A1": DRAWS}, 9)
    assert result == slow
    values = result[1][-1][1]
    if expected is None:
        np.testing.assert_allclose(values, 39 * (MATRIX.sum() - MATRIX[2, 2]) * DRAWS, rtol=1e-13)
    else:
        assert values == [expected] * 9


def test_equal_ranges_are_one_array_and_count_once(lower):
    cells = matrix() | matrix("Copy")
    formulas = {f"B{k}": f"=SUMPRODUCT({RANGE},{RANGE.replace('Data', 'Copy')})*A1+{k}" for k in range(1, 9)}
    lowering, _ = made_for(lower, cells | formulas | {"Z1": "=SUM(B1:B8)"})
    arrays = [node for node in lowering.dag.nodes if isinstance(node, Constant) and node.value.numbers.size > 64]
    assert len(arrays) == 1
    assert lowering.dag.kept == arrays[0].value.nbytes


@pytest.mark.parametrize("tail", ["", "&{k}"])
def test_equal_arrays_of_texts_are_one_and_others_are_not(lower, tail):
    cells = {f"Data!{at(r, 0)}": f"ab{r}" for r in range(99)}
    formulas = {f"B{k}": f'=SUMPRODUCT(LEN(Data!$A$1:$A$99&"x"{tail.format(k=k)}))*A1' for k in range(1, 5)}
    lowering, _ = made_for(lower, cells | formulas | {"Z1": "=SUM(B1:B4)"})
    values = [node.value for node in lowering.dag.nodes if isinstance(node, Constant)]
    assert sum(value.numbers.size == 99 and value.texts is not None for value in values) == (5 if tail else 2)


def test_a_forgotten_array_is_there_again_for_what_varies(lower, evaluate, bounded):
    early = {f"B{k}": f"=SUMPRODUCT({RANGE}*3+{k})" for k in range(1, 30)}
    late = {"Z1": f"=SUM(B1:B29)*A1+SUMPRODUCT(({RANGE}*3+1)*A1)-SUMPRODUCT(({RANGE}*3+2)*A1)"}
    lowering, targets = made_for(lower, matrix() | early | late)
    dag = lowering.dag
    assert forgotten(dag)
    program = pickle.loads(pickle.dumps(NumpyProgram.of(lowering, [], targets, frozenset())))
    _, (column,) = evaluate(program.evaluator(9), {"A1": DRAWS}, 9)
    sums = sum((MATRIX * 3 + k).sum() for k in range(1, 30))
    np.testing.assert_allclose(column[1], (sums - MATRIX.size) * DRAWS, rtol=1e-12)


def test_a_long_chain_of_arrays_is_computed_again(lower, evaluate, bounded):
    """Each formula adds to the array of the one before; the last goes back to an early one."""
    sums = ["".join(f"+{k}" for k in range(1, n)) for n in range(2, 40)]
    chain = {f"B{n}": f"=SUMPRODUCT({RANGE}{text})*A1" for n, text in enumerate(sums, 1)}
    back = {"Z1": f"=SUM(B1:B{len(sums)})+SUMPRODUCT({RANGE}{sums[20]},{RANGE}{sums[30]})*A1"}
    lowering, targets = made_for(lower, matrix() | chain | back)
    assert forgotten(lowering.dag)
    _, (column,) = evaluate(NumpyProgram.of(lowering, [], targets, frozenset()).evaluator(9), {"A1": DRAWS}, 9)
    added = [sum(range(1, n)) for n in range(2, 40)]
    expected = sum((MATRIX + a).sum() for a in added) + ((MATRIX + added[20]) * (MATRIX + added[30])).sum()
    np.testing.assert_allclose(column[1], expected * DRAWS, rtol=1e-12)


def test_arrays_that_every_trial_reads_are_refused_where_they_are_too_many(lower, bounded):
    read = book_of(lambda k: f"=SUM(SORT({RANGE}+{k},A$1))")
    with pytest.raises(FormulaError, match=r"S!B[67]: The arrays of constants of the workbook take more than"):
        made_for(lower, matrix() | read)


def test_a_sum_does_not_hold_what_it_was_summed_from(lower):
    cells = {"Z1": "=SUMPRODUCT(SEQUENCE(200,90)+1)*A1+INDEX(SEQUENCE(300,70)+2,5,5)*A1"}
    lowering, _ = made_for(lower, cells)
    singles = [
        node.value.numbers for node in lowering.dag.nodes if isinstance(node, Constant) and node.value.numbers.size == 1
    ]
    assert len(singles) > 3
    assert all(number.base is None or number.base.nbytes <= 8 for number in singles)
