"""What the loops hold, and that a run with them is the run without."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from simulated import simulated

from xlmc.engine.llvm import program as programs
from xlmc.engine.llvm.machine import Machine
from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.tracking import TrackingEvaluator
from xlmc.montecarlo.model.loading import load

CASE_STUDY = Path(__file__).resolve().parents[3] / "examples" / "intersection.xlsx"


@pytest.fixture(scope="module")
def runs():
    model = load(CASE_STUDY)
    return [
        simulated(model, 100_000, 5, engine=engine, jobs=jobs)
        for engine, jobs in (("numpy", 1), ("jit", 1), ("jit", 2))
    ]


def test_the_case_study_is_the_same_run(runs):
    numpy, jit, _ = runs
    assert numpy.trial_index.tolist() == jit.trial_index.tolist()
    assert numpy.tally.together.tolist() == jit.tally.together.tolist()
    for name, values in numpy.forecasts.items():
        np.testing.assert_allclose(jit.forecasts[name], values, rtol=1e-12, atol=0)


def test_threads_change_nothing(runs):
    _, one, two = runs
    assert one.trial_index.tolist() == two.trial_index.tolist()
    assert all(one.forecasts[name].tolist() == values.tolist() for name, values in two.forecasts.items())


@pytest.fixture
def program(lower):
    def make(formula, **cells):
        lowering, targets = lower({**cells, "B1": f"={formula}"}, ["A1", "A2"], ["B1"])
        return JitProgram(lowering, [], targets, frozenset())

    return make


def stages(program):
    """How many loops, and how many nodes outside of loops."""
    steps = [*program.first._steps, *program.late._steps]
    loops = [step for step in steps if not isinstance(step, tuple)]
    return len(loops), sum(len(step) for step in steps if isinstance(step, tuple))


@pytest.mark.parametrize(
    ("formula", "loops", "outside"),
    [
        ("A1+A2*SIN(A1)/COS(A1)-SQRT(A2^3)", 1, 0),
        ("IF(AND(A1>1,A2>1),SUM(A1:A2),IF(A1>0,MAX(A1:A2),-A1))", 1, 0),
        ("IFERROR(1/A1,A2)", 1, 0),
        ("SINH(A1)", 0, 1),
        ("SINH(A1+A2)+1", 2, 1),
        ("SINH(A1)*SINH(A2)+SINH(A1*A2)", 2, 3),
        ("EXP(A1)+LN(A2)*LOG10(A1)^A2", 1, 0),
        ("MEDIAN(A1:A2)*2", 1, 2),
        ("A1", 0, 0),
        ("2", 0, 0),
    ],
)
def test_what_stands_in_loops(program, compile_nothing, formula, loops, outside):
    assert stages(program(formula)) == (loops, outside)


def counted(monkeypatch):
    """How many trials the careful path computes again."""
    seen = []
    careful = TrackingEvaluator.forecasts

    def forecasts(self, survivors):
        seen.append(survivors.size)
        return careful(self, survivors)

    monkeypatch.setattr(TrackingEvaluator, "forecasts", forecasts)
    return seen


@pytest.mark.parametrize(
    ("formula", "again"),
    [
        # A1 is 0, 1, …, 9; A2 is 1: what could err stands in a branch that is not taken, or does
        ("A1/A2", 0),
        ("1/A1", 1),
        ("IF(A1>0,1/A1,A2)", 0),
        ("IF(A1>0,LN(A1),A2)", 0),
        ("IF(A1>2,IF(A1>5,1/(A1-5),1/(A1-2)),0)", 0),
        ("IF(A1>2,IF(A1>5,1/(A1-6),1/(A1-4)),1/(A1-2))", 3),
        ("IF(1/A1>0.4,A1,A2)", 1),
        ("IFERROR(SQRT(A1-3),A2)", 3),
        ("SIN(A1*2^26)", 8),
        ("A1*1E300*A1*1E300", 9),
    ],
)
def test_only_trials_in_which_something_may_be_an_error_are_computed_again(program, monkeypatch, formula, again):
    evaluator, seen = program(formula).evaluator(10), counted(monkeypatch)
    evaluator.filters({"A1": np.arange(10.0), "A2": np.ones(10)}, 10)
    evaluator.forecasts(np.arange(10))
    assert sum(seen) == again


def test_a_function_outside_of_loops_is_right_after_many_blocks_with_errors(program):
    """After some the evaluator no longer tries plain numbers."""
    evaluator, good = program("SINH(1/A1)*2").evaluator(4), np.array([1.0, 2.0, 4.0, 8.0])
    for block in range(20):
        a1 = good * (np.arange(4) != block % 5)  # every fifth block has no error
        evaluator.filters({"A1": a1, "A2": a1}, 4)
        (column,) = evaluator.forecasts(np.arange(4))
        wrong = a1 == 0
        assert (column.codes is None) == (not wrong.any())
        assert column.values[~wrong].tolist() == (np.sinh(1 / good[~wrong]) * 2).tolist()
        assert column.codes is None or column.codes.tolist() == [2 * int(each) for each in wrong]


def test_an_evaluator_takes_blocks_of_any_size_up_to_its_own(program):
    evaluator = program("IF(A1>0,1/A1,-1)+SQRT(A1)").evaluator(10)
    for values in ([1.0, 4.0], [0.0], [4.0] * 10, [-1.0, 16.0, 0.25]):
        draws = np.array(values)
        evaluator.filters({"A1": draws, "A2": draws}, draws.size)
        (result,) = evaluator.forecasts(np.arange(draws.size))
        expected = [-1.0 if v == 0 else np.nan if v < 0 else 1 / v + v**0.5 for v in values]
        assert result.as_floats() == pytest.approx(expected, rel=1e-15, nan_ok=True)


def test_blocks_are_small_where_many_values_are_kept(monkeypatch, program):
    assert program("A1+A2").largest_block == 1 << 20
    monkeypatch.setattr(programs, "_MOST_MEMORY", 1 << 16)
    assert program("A1+A2").largest_block == 1 << 13


def test_nothing_of_the_workbooks_text_reaches_the_compiler(lower, monkeypatch):
    """Names, texts and comments of a workbook are not ours to run: modules hold our own identifiers and numbers."""
    modules = []
    native = Machine.native

    def seen(self, module, name):
        modules.append(str(module))
        return native(self, module, name)

    monkeypatch.setattr(Machine, "native", seen)
    cells = {
        "Evil!A7": 3.0,
        "B1": '=A1*2+Evil!A7+IF(A1>0,Injected,LEN("payload"&A1))',
        "B2": '=IFERROR(SQRT(B1),"payload")&"payload"',
        "B3": "=SIN(SINH(LN(A1)^A1))+B1+(B2=A1)",
    }
    names = {"Injected": "S!$C$1"}
    lowering, targets = lower(cells | {"C1": 1.5}, ["A1"], ["B1", "B2", "B3"], names=names)
    JitProgram(lowering, targets[:1], targets[1:], frozenset())
    assert len(modules) > 1
    for text in modules:
        assert set(re.findall(r"[A-Za-z_][\w.]*", re.sub(r"0x[0-9a-fA-F]+", "", text))) <= OWN_WORDS


OWN_WORDS = {
    *(
        "ModuleID",
        "target",
        "triple",
        "datalayout",
        "unknown",
        "define",
        "declare",
        "internal",
        "noinline",
        "alignstack",
        "noalias",
        "ret",
    ),
    *("loop", "over_trials", "entry", "body", "after", "br", "label", "phi", "icmp", "slt", "ne", "fcmp", "uno"),
    *("double", "i1", "i8", "i64", "ptr", "load", "store", "getelementptr", "bitcast", "call", "select", "zext"),
    *("trunc", "to", "uitofp", "add", "nuw", "nsw", "or", "and", "xor", "shl", "fadd", "fsub", "fmul", "fdiv", "fneg"),
    *("olt", "ogt", "oeq", "one", "ole", "oge", "uge", "une", "x", "source_filename"),
    *("llvm.fma", "llvm.fma.f64", "llvm.fabs.f64", "llvm.sqrt.f64"),
    *("llvm.x86.sse.stmxcsr", "llvm.x86.sse.ldmxcsr", "llvm.aarch64.get.fpcr", "llvm.aarch64.set.fpcr"),
    *("alloca", "i32", "void", "sub", "lshr", "llvm.loop", "llvm.loop.interleave.count"),
}
