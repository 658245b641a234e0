from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from llvmlite import ir

from xlmc.engine.llvm import loop as loops
from xlmc.engine.llvm import phase as phases
from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.numpy.numpy_engine import NumpyProgram

ROAD = {f"H{row}": 5.0 * row for row in range(1, 30)} | {f"I{row}": (row % 7) / 10 for row in range(1, 30)}


def march(rows, odd=()):
    """A vehicle that slows down on a road, row by row; rows in `odd` have another formula."""
    cells = {"A1": 0.7, "A2": 60.0, "B1": "=A2", "C1": 5.0, "D1": 0.0, **ROAD}
    for row in range(2, rows + 1):
        before = row - 1
        cells |= {
            f"B{row}": f"=MAX(0.1,B{before}-32.2*A1*E{row}*0.01)",
            f"C{row}": f"=C{before}+(B{row}+B{before})/2*0.01",
            f"D{row}": f"=D{before}+IF(B{row}>{row},B{row}*EXP(-A1*{row}/100),C{row}-{row * 0.5})",
            f"E{row}": f"=1+VLOOKUP(C{before},$H$1:$I$29,2)" if row not in odd else f"=SQRT(A1)+{row}/100",
            f"F{row}": f"=AND(B{row}>30,C{row}<{row * 1.5})",
        }
    cells["G1"] = f"=D{rows}+SUM(B2:B{rows})+IF(F{rows},1,0)"
    return cells


def made(lower, rows, odd=()):
    lowering, result = lower(march(rows, odd), ["A1", "A2"], ("G1", "D9"))
    return JitProgram(lowering, [], result, frozenset())


@pytest.mark.parametrize("odd", [(), (20, 21, 50)])
def test_loops_of_one_shape_have_one_code(lower, compile_nothing, odd):
    program = made(lower, 60, odd)
    dag, machine = compile_nothing[0][:2]
    codes = {}
    for plan in program.late._stages.loop_plans() if program.late.slots else program.first._stages.loop_plans():
        module = ir.Module()
        loops._inner(dag, module, machine, plan.rules, plan.loads, plan.stores, plan.slots, 2)
        codes.setdefault(plan.shape, []).append(str(module))
    assert max(map(len, codes.values())) > 3
    assert all(len({*alike}) == 1 for alike in codes.values())


def test_a_trial_that_errs_in_one_row_errs_alone(lower, side_by_side):
    cells = march(60) | {"G1": "=D60/(B30-B30*A3)", "A3": 0.5}
    lowering, result = lower(cells, ["A1", "A2", "A3"], ["G1"])
    draws = {"A1": np.full(5, 0.7), "A2": np.full(5, 60.0), "A3": np.array([0.5, 1.0, 0.5, 1.0, 0.25])}
    with side_by_side(0):  # so few trials are in no vector
        evaluator = JitProgram(lowering, [], result, frozenset()).evaluator(5)
    evaluator.filters(draws, 5)
    (column,) = evaluator.forecasts(np.arange(5))
    assert column.codes is not None
    assert (column.codes > 0).tolist() == [False, True, False, True, False]


def test_more_rows_are_compiled_no_longer(lower, compile_nothing):
    def loops(rows):
        compile_nothing.clear()
        program = made(lower, rows)
        return len(compile_nothing), len(set(program.slots.values()))

    few, many = loops(70), loops(140)
    assert few[0] == many[0] < 12
    assert many[1] < 1.1 * few[1]


@pytest.mark.parametrize(
    ("loops", "alone"), [([(250, 1)] * 3, 2), ([(90, 1), *[(90, 50)] * 50], 1), ([(90, 1), *[(90, 200)] * 200], 0)]
)
def test_code_that_serves_one_loop_among_many_alike_is_soon_made(loops, alone):
    assert phases._side_by_side_alone(loops) == alone


def test_loops_give_what_numpy_gives_and_one_trial_after_another_the_same_bits(lower, monkeypatch):
    """Most of them are of one shape; the rows with another formula are in loops of their own, of either kind."""
    ways, compile_loop = set(), phases.compile_loop
    monkeypatch.setattr(phases, "compile_loop", lambda *given: ways.add(given[-1]) or compile_loop(*given))
    lowering, targets = lower(march(60, (20, 21, 50)), ["A1", "A2"], ("G1", "D9"))
    made_of = {"numpy": NumpyProgram.of(lowering, [], targets, frozenset())}
    for rare in (1, 10**9):
        monkeypatch.setattr(phases, "_RARE", rare)
        made_of[rare] = JitProgram(lowering, [], targets, frozenset())
    assert ways == {0, 1, 2}
    for n in (1, 777):
        draws = {"A1": np.random.default_rng(1).uniform(0.5, 0.9, n), "A2": np.random.default_rng(2).uniform(50, 70, n)}
        result = {}
        for way, program in made_of.items():
            evaluator = program.evaluator(n)
            evaluator.filters(draws, n)
            result[way] = np.array([column.as_floats() for column in evaluator.forecasts(np.arange(n))])
        assert result[1].tobytes() == result[10**9].tobytes()
        np.testing.assert_allclose(result[1], result["numpy"], rtol=1e-13, err_msg=f"{n} trials")


def test_a_small_model_has_its_constants_in_its_code(lower, compile_nothing):
    made(lower, 9)
    program = made(lower, 9)
    assert all(not slots for *_, slots, _ in compile_nothing)
    assert program.largest_block >= 1 << 15
