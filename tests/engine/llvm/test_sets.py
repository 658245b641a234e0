"""Functions of many cells in the loop: what counts, in values worked out with NumPy and in errors."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.engine.graph.nodes import Apply
from xlmc.engine.llvm import phase, sets
from xlmc.engine.llvm.loop import compile_loop
from xlmc.engine.llvm.loop_rules import Literal, Operand
from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.llvm.sets import over_cells
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Kind

A, B = np.array([1.5, -2.0, 0.0, 4.0, 3.0]), np.array([2.0, 5.0, -3.0, 0.0, 3.0])
CELLS = {
    "C1": 7.0, "C2": "text", "C3": True, "D1": "=A1>1", "D2": "=1/A1", "D3": "=A1&1", "E1": "=NA()",
    "F1": "=A1", "F2": "=B1", "F3": "=C1", "F4": "=C2", "F5": "=D1",
}  # fmt: skip
"""F1:F5 hold two numbers that vary, 7, a text and a logical that varies; C4 is empty."""

THREE = np.array([A, B, np.full(5, 7.0)])
VALUES = {
    "SUM(A1:B1)": A + B,
    "SUM(A1:B1,C1:C4)": A + B + 7,
    "SUM(A1,B1,TRUE)": A + B + 1,
    "SUM(F1:F5)": A + B + 7,
    "SUM(A1:B1,A1>1)": A + B + (A > 1),
    "PRODUCT(A1:B1,3)": A * B * 3,
    "PRODUCT(F1:F5)": A * B * 7,
    "MIN(A1:B1)": np.minimum(A, B),
    "MAX(A1:B1,1)": np.maximum(np.maximum(A, B), 1),
    "MIN(F1:F5)": THREE.min(axis=0),
    "MAX(F1:F5)": THREE.max(axis=0),
    "AVERAGE(A1:B1)": (A + B) / 2,
    "AVERAGE(F1:F5)": THREE.mean(axis=0),
    "SUMSQ(A1:B1)": A * A + B * B,
    "VAR.S(F1:F5)": THREE.var(axis=0, ddof=1),
    "VAR.P(F1:F5)": THREE.var(axis=0),
    "STDEV.S(F1:F5)": THREE.std(axis=0, ddof=1),
    "STDEV.P(F1:F5)": THREE.std(axis=0),
    "VAR.S(A1:B1)": np.array([A, B]).var(axis=0, ddof=1),
    "VAR.P(A1:A1)": 0 * A,
    "COUNT(F1:F5)": 0 * A + 3,
    "COUNT(A1:B1,C1:C4)": 0 * A + 3,
    "AND(A1:B1)*1": (A != 0) & (B != 0),
    "OR(A1:B1)*1": (A != 0) | (B != 0),
    "XOR(A1:B1)*1": (A != 0) ^ (B != 0),
    "AND(A1>1,B1>1,C1:C4)*1": (A > 1) & (B > 1),
    "OR(A1>2,B1>2)*1": (A > 2) | (B > 2),
    "XOR(A1>1,B1>1,TRUE)*1": ~((A > 1) ^ (B > 1)),
    "SUMPRODUCT(A1:B1,B1:C1)": A * B + B * 7,
    "SUMPRODUCT(F1:F5,F1:F5)": A * A + B * B + 49,
    "SUMPRODUCT(A1:B1,{2,3})": 2 * A + 3 * B,
    "SUMPRODUCT(A1:B1)": A + B,
    "SUMPRODUCT(A1:B1,B1:C1,{1,2})": A * B + 14 * B,
    "SUM({1,2},A1:A1)": A + 3,
}
LOST = {
    "VAR.S(A1:A1)": [ErrorCode.DIV0] * 5,
    "STDEV.S(A1:A1,C2:C3)": [ErrorCode.DIV0] * 5,
    "SUM(A1,D2:D2)": [0, 0, ErrorCode.DIV0, 0, 0],
    "MAX(A1:B1,D2:D2)": [0, 0, ErrorCode.DIV0, 0, 0],
    "MIN(D2:D2,A1)": [0, 0, ErrorCode.DIV0, 0, 0],
    "COUNT(D2:D2,A1:A1)": [0, 0, 0, 0, 0],
    "SUM(A1:B1,E1:E1)": [ErrorCode.NA] * 5,
    "AND(A1:A1,D2:D2)": [0, 0, ErrorCode.DIV0, 0, 0],
    "PRODUCT(A1:A1,D2:D2)": [0, 0, ErrorCode.DIV0, 0, 0],
    "SUMPRODUCT(A1:B1,C1:D1)": [0, 0, 0, 0, 0],
    "SUM(A1:A1,1E308,1E308)": [ErrorCode.NUM] * 5,
    "AVERAGE(C2:C4,C2:C4)+A1": [ErrorCode.DIV0] * 5,
}


@pytest.fixture(scope="module")
def computed(lower):
    """`computed`: formula -> what it gives for the numbers A and B, and the codes of its errors."""
    formulas = [*VALUES, *LOST]
    cells = {f"Z{row}": f"={formula}" for row, formula in enumerate(formulas, 1)}
    lowering, targets = lower({"A1": 0.0, "B1": 0.0, **CELLS, **cells}, ["A1", "B1"], [*cells])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(phase, "compile_loop", lambda *given: compile_loop(*given[:6], 0))
        evaluator = JitProgram(lowering, [], targets, frozenset()).evaluator(A.size)
    list(evaluator.filters({"A1": A, "B1": B}, A.size))
    return dict(zip(formulas, evaluator.forecasts(np.arange(A.size)), strict=True))


@pytest.mark.parametrize("formula", VALUES)
def test_values(computed, formula):
    np.testing.assert_allclose(computed[formula].values, np.asarray(VALUES[formula], float), rtol=1e-14, atol=1e-300)


@pytest.mark.parametrize("formula", LOST)
def test_errors(computed, formula):
    codes = computed[formula].codes
    assert (np.zeros(5) if codes is None else codes).tolist() == LOST[formula]


@pytest.fixture
def rule(lower):
    """`rule(formula)`: the rule of its function, beside the graph."""

    def make(formula, cells=()):
        book = {"A1": 0.0, "B1": 0.0, **CELLS, **dict(cells), "Z1": f"={formula}"}
        lowering, (target,) = lower(book, ["A1", "B1"], ["Z1"])
        dag = lowering.dag
        node = dag.nodes[lowering.target(target)]
        assert isinstance(node, Apply)
        return over_cells(dag, node), dag

    return make


@pytest.mark.parametrize(
    ("formula", "operands", "literals", "beside"),
    [
        ("SUM(A1:B1)", 2, [], 0), ("SUM(F1:F5)", 2, [7.0], 1), ("SUM(A1:A1,C1:C4)", 1, [7.0], 0),
        ("AND(A1:A1,C1:C4)", 1, [True, True], 0), ("SUM(A1,TRUE)", 1, [1.0], 0), ("OR(A1:B1,FALSE)", 2, [False], 0),
        ("SUMPRODUCT(A1:B1,B1:C1)", 3, [7.0], 0), ("SUMPRODUCT(A1:B1,C1:D1)", 2, [7.0, 0.0], 1),
        ("AND(F1:F5)", 3, [True], 0), ("MAX(F1:F3)", 2, [7.0], 0),
    ],
)  # fmt: skip
def test_what_counts(rule, formula, operands, literals, beside):
    made, _ = rule(formula)
    assert sum(isinstance(part, Operand) for part in made.operands) == operands
    assert [part.value for part in made.operands if isinstance(part, Literal)] == literals
    assert len(made.beside) == beside
    kind = Kind.LOGICAL if formula[:2] in ("AN", "OR") else Kind.NUMBER
    assert all(part.kind is kind for part in made.operands if isinstance(part, Operand))


def test_a_count_is_known_but_for_errors(rule):
    made, dag = rule("COUNT(F1:F5)")
    assert made.operands == (Literal(3.0),)
    assert [dag.types[part.node] for part in made.beside] == [Kind.NUMBER, Kind.NUMBER, Kind.LOGICAL]
    assert not made.makes


@pytest.mark.parametrize(
    "formula",
    ["SUM(A1:A1,D3:D3)", "SUM(A1:A1,E1:E1)", "MEDIAN(A1:B1)",
     "COUNT(A1:A1,D3:D3)", "VAR.S(A1:A1,C2:C3)", 'SUM(A1,"x")', "SUMPRODUCT(A1:A1,C2:C2)"],
)  # fmt: skip
def test_what_is_left_to_numpy(rule, formula):
    assert rule(formula)[0] is None


@pytest.mark.parametrize(("function", "most"), [("SUM({})", 200), ("COUNT({})", 200), ("SUMPRODUCT({},{})", 100)])
def test_wide_ranges_are_left_to_numpy(rule, function, most):
    for rows, has_one in ((most, True), (most + 1, False)):
        cells = {f"H{row}": f"=A1+{row}" for row in range(1, rows + 1)}
        made, _ = rule(function.replace("{}", f"H1:H{rows}"), cells)
        assert (made is not None) == has_one
    assert sets._MOST == 200
