"""Targets as a function of one input: what does not depend on it is held, and changes no number."""

from __future__ import annotations

import numpy as np
import pytest
from workbook_files import workbook_of

from xlmc.engine.engine import Target
from xlmc.engine.graph.lowering import lower_cells
from xlmc.engine.numpy.repeated import RepeatedProgram
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.reader import read_workbook

X, A, B = (Cell("S", 1, column) for column in (1, 2, 3))
ANSWER = Cell("S", 2, 1)


def program(tmp_path, *formulas):
    path = tmp_path / "book.xlsx"
    workbook_of({"S": [[1, 2, 3], [formulas[0]], list(formulas[1:])]}, {}).save(path)
    workbook = read_workbook(path)
    named = {X: "x", A: "a", B: "b"}
    lowering = lower_cells(Resolver(workbook, named), [ANSWER], named, {})
    return RepeatedProgram.of(lowering, [Target(ANSWER, ANSWER)], "x")


@pytest.mark.parametrize(
    ("formula", "more", "held"),
    [
        ("=A1*B1/C1", (), 0),
        ("=A1*(B1/C1)", (), 1),
        ("=A1*A3+B3", ("=EXP(B1)", "=LN(C1)"), 2),
        ("=A1+SUM(A3:C3)", ("=B1*2", "=C1*2", "=B1*C1"), 1),
        ("=IF(A1>B1,A3,B3)", ("=SQRT(B1)", "=SQRT(C1)"), 2),
        ("=IFERROR(A1*A3,-A1)", ("=SQRT(B1-2)", "=1"), 1),
        ("=IFNA(A1*A3,-A1)", ("=IF(B1<1,NA(),1/(C1-1))", "=1"), 1),
        ("=LEN(A3&A1)+B3", ('=B1&"m"', "=C1^3"), 1),
        ("=A1*B1", (), 0),
        ("=MATCH(A1,A3:C3,1)", ("=B1*0.1", "=B1+1", "=B1+C1+2"), 3),
    ],
)
def test_held_numbers_change_nothing(tmp_path, formula, more, held):
    made = program(tmp_path, formula, *more)
    assert len(made.names) == held
    n, rng = 500, np.random.default_rng(1)
    given = {"a": rng.uniform(0, 4, n), "b": rng.uniform(0, 4, n)}
    for part in ({name: np.maximum(values, 2.5) for name, values in given.items()}, given):  # without errors, and with
        function = made.evaluated(part, n)
        for _ in range(3):
            x, trials = rng.uniform(-1, 3, n), rng.permutation(n)[: n // 3]
            expected = made.whole.evaluator(n).filters({"x": x, **part}, n)[0].as_floats()
            (result,) = (columns[0] for columns in function(x, None))
            assert np.array_equal(result, expected, equal_nan=True)
            (some,) = (columns[0].copy() for columns in function(x[trials], trials))
            assert np.array_equal(some, expected[trials], equal_nan=True)
