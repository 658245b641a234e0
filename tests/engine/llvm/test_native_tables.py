"""What loops pick from tables has the bits of what they compute, and errs where that does."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from simulated import simulated
from table_books import CELLS, GIVEN, TABLE, TRIALS, outcome_of, some_book

from xlmc.engine.llvm import machine as machines
from xlmc.engine.llvm import program as programs
from xlmc.engine.llvm.loop_rules import Operand
from xlmc.engine.llvm.program import JitProgram

PROCESSORS = ["as it is", "without fused multiplication"]


@pytest.fixture
def processor(request, monkeypatch):
    if request.param != "as it is":
        plain = machines.this_machine()
        plain.fused = False
        monkeypatch.setattr(programs, "machine", lambda: plain)


def computing(patch):
    patch.setattr(programs, "rules_of_looked_up", lambda *_: {})


@pytest.mark.parametrize(("number", "processor"), [*zip((7, 13), PROCESSORS, strict=True)], indirect=["processor"])
def test_the_bits_of_random_books_are_the_same(book, monkeypatch, side_by_side, processor, number):
    """These two books have every lookup of `table_books` and all but one of its functions, a power."""
    with side_by_side(1):
        result = outcome_of(simulated(some_book(book, number), TRIALS, 5, engine="jit"))
    with monkeypatch.context() as patch, side_by_side(0):
        computing(patch)
        assert result == outcome_of(simulated(some_book(book, number), TRIALS, 5, engine="jit"))


ROWS = range(1, 13)


def sheet(formula):
    """A row for each time step; the formula takes the number that the row finds in the table."""
    cells = CELLS | {"D1": "=A2", "E1": "=A1/20"}
    for row in ROWS:
        cells |= {f"D{row + 1}": f"=D{row}*0.9+{formula.format(x=f'VLOOKUP(E{row},$K$1:$P$9,4)', row=row)}"}
        cells |= {f"E{row + 1}": f"=MIN(8,ABS(E{row}+D{row + 1}/20))"}
    return cells


def functions(model, phase):
    """The functions that the loops of a phase compute; "picked" stands for one that is picked from a table."""
    nodes, result = model.lowering.dag.nodes, []
    for plan in phase._stages.loop_plans():
        for node, rule in plan.rules.items():
            read = {part.node for part in rule.operands if isinstance(part, Operand)}
            result.append(nodes[node].function.name if read <= {*nodes[node].arguments} else "picked")
    return result


def built(book, formula):
    """The model of such a sheet, the functions that loops compute in every trial, and the codes of these loops."""
    model = book(sheet(formula), GIVEN, {"x": f"D{ROWS[-1] + 1}", "y": f"E{ROWS[-1] + 1}"})
    program = model.program("jit")
    assert isinstance(program, JitProgram)
    return model, functions(model, program.first), {loop.call for loop in program.first.loops}


@pytest.mark.parametrize(
    ("formula", "processor"),
    [
        ("SIN(ATAN({x}/100))*A2+COS(ATAN({x}/100))", "as it is"),
        ("EXP(-{x}/2)*A2", "without fused multiplication"),
    ],
    indirect=["processor"],
)
def test_rows_of_a_sheet_share_tables_and_code(book, monkeypatch, side_by_side, processor, formula):
    with side_by_side(1):
        model, names, codes = built(book, formula)
        result = outcome_of(simulated(model, TRIALS, 5, engine="jit"))
    assert "picked" in names
    assert not {"ATAN", "SIN", "EXP", "^", "LN", "The cell found"} & {*names}
    with monkeypatch.context() as patch, side_by_side(0):
        computing(patch)
        computed, _, codes_of_computed = built(book, formula)
        assert result == outcome_of(simulated(computed, TRIALS, 5, engine="jit"))
    assert len(codes) <= len(codes_of_computed) + 1


def test_rows_with_a_constant_of_their_own_are_computed(book, side_by_side):
    """A table is part of the code of a loop: so many tables would be as many codes."""
    with side_by_side(0):
        _, names, codes = built(book, "EXP(-{x}*({row}+0.1))*A2")
    assert "picked" not in names
    assert names.count("EXP") == len(ROWS)
    assert len(codes) < 6


@pytest.mark.parametrize(
    ("formula", "is_error"),
    [
        ("LN(VLOOKUP(A1,$K$1:$P$9,5))", lambda number: number <= 0),
        ("ASIN(VLOOKUP(A1,$K$1:$P$9,5))", lambda number: abs(number) > 1),
        ("SIN(VLOOKUP(A1,$K$1:$P$9,5)*2^27)", lambda number: abs(number) >= 1),
        ("ATAN(1/VLOOKUP(A1,$K$1:$P$9,5))", lambda number: number == 0),
    ],
)
def test_a_row_that_errs_errs_in_its_trials_alone(book, formula, is_error):
    model = book(CELLS | {"B1": f"={formula}"}, GIVEN, {"x": "B1"})
    run = simulated(model, TRIALS, 5, engine="jit")
    row = np.minimum(run.inputs["a"].astype(int), 8)
    wrong = np.array([is_error(TABLE[f"O{each + 1}"]) for each in range(9)])[row]
    np.testing.assert_array_equal(np.isnan(run.forecasts["x"]), wrong)
