"""Loops are chosen by a table, never by a clock."""

from __future__ import annotations

import pytest

pytest.importorskip("llvmlite")

from simulated import simulated

from xlmc.engine.engines import ENGINES
from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.numpy.numpy_engine import NumpyProgram

PLAIN = [f"A1*A2+SQRT(A1+{k})" for k in range(1, 21)]
CHOSEN = [
    (PLAIN, JitProgram),
    (["SINH(A1)"], NumpyProgram),
    (["SINH(A1)", *PLAIN], JitProgram),
    (["MEDIAN(A1:A2,3)", "LARGE(A1:A2,1)"], NumpyProgram),
    (["A1"], JitProgram),
    (["2"], JitProgram),
    (["A1^A2"], JitProgram),  # nothing stands between loops
    (["A1^A2", "ROUND(A1,A2)", "A1+A2"], NumpyProgram),
    ([f"ROUND(A1,A2+{k})" for k in range(20)] + PLAIN, NumpyProgram),
    ([f"ROUND(A1,{k})" for k in range(20)], JitProgram),
]


@pytest.mark.parametrize(("formulas", "expected"), CHOSEN)
def test_a_book_has_the_program_that_the_table_says(lower, compile_nothing, formulas, expected):
    cells = {f"C{row}": f"={formula}" for row, formula in enumerate(formulas, 1)}
    lowering, targets = lower(cells, ["A1", "A2"], [*cells])
    assert type(ENGINES["jit"].load()(lowering, targets[:1], targets[1:], frozenset())) is expected


def test_a_run_that_loops_would_slow_down_has_the_bits_of_numpy(book):
    given = {name: {"cell": name, "low": 1, "high": 2} for name in ("A1", "A2")}
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=SINH(A1)+SIN(A2)"}, given, {"x": "B1"})
    by_numpy, by_jit = (simulated(model, 3_000, 2, engine=engine) for engine in ("numpy", "jit"))
    assert by_jit.settings.engine == "jit"
    assert by_jit.forecasts["x"].tobytes() == by_numpy.forecasts["x"].tobytes()
    again = simulated(model, 3_000, 2, engine="jit", jobs=2)
    assert again.forecasts["x"].tobytes() == by_numpy.forecasts["x"].tobytes()
