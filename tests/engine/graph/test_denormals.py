"""Numbers too small for Excel are 0 wherever a formula makes them: in both engines, and on the careful path."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engines import ENGINES
from xlmc.excel.functions.denormals import TINIEST

CELLS = {
    "B1": "=A1*A2",
    "B2": "=B1*1E+200",
    "B3": "=IF(A1>A2,A1*A2*1E+250,A1/1E+200*1E+250)",
    "B4": "=EXP(A3)",
    "B5": "=1+B4*1E+300",
    "B6": "=PRODUCT(A1,A2,1E+250)",
    "B7": "=A1^2*1E+300",
    "B8": "=ATAN2(1E+150,A1)*1E+300",
    "B9": "=A1-A2",
    "B10": "=SUM(A1:A2)*A2",
    "B11": "=A1^3*1E+300",
}
TARGETS = [*CELLS]


@pytest.fixture(scope="module")
def draws():
    generator = np.random.default_rng(4)
    sizes = 10.0 ** generator.uniform(-170, -140, (2, 500)) * generator.choice([-1, 1], (2, 500))
    return {"A1": sizes[0], "A2": sizes[1], "A3": generator.uniform(-760, -690, 500)}


@pytest.fixture(scope="module")
def expected(draws):
    """By hand, each product and quotient looked at."""

    def kept(x):
        return np.where(np.abs(x) < TINIEST, 0.0, x)

    a, b, c = draws.values()
    product, square, tiny = kept(a * b), kept(a * a), kept(np.exp(c))
    angle = kept(np.where(a == 0, 0.0, np.arctan2(a, 1e150)))
    return [
        product,
        product * 1e200,
        np.where(a > b, product * 1e250, kept(a / 1e200) * 1e250),
        tiny,
        1 + tiny * 1e300,
        product * 1e250,
        square * 1e300,
        angle * 1e300,
        a - b,
        kept((a + b) * b),
        kept(square * a) * 1e300,
    ]


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_each_engine_gives_what_excel_gives(lower, draws, expected, engine):
    if engine == "jit":
        pytest.importorskip("llvmlite")
    lowering, targets = lower(CELLS, draws, TARGETS)
    columns = ENGINES[engine].load()(lowering, targets, [], frozenset()).evaluator(500).filters(draws, 500)
    for column, wanted, cell in zip(columns, expected, TARGETS, strict=True):
        assert column.codes is None
        np.testing.assert_allclose(column.values, wanted, rtol=1e-13, atol=0, err_msg=cell)


def test_the_careful_path_gives_the_same_and_the_fast_path_is_not_left(run, draws):
    assert not run(CELLS, draws, TARGETS).careful


def test_a_divisor_that_vanished_is_0(run):
    outcome = run({"B1": "=1/(A1*A2)"}, {"A1": [1e-160, 1.0], "A2": [1e-150, 2.0]}, ["B1"])
    assert outcome.forecasts == [["#DIV/0!", 0.5]]


def test_the_loop_gives_up_no_small_numbers_of_others():
    pytest.importorskip("llvmlite")
    from llvmlite import ir

    from xlmc.engine.llvm.machine import this_machine, while_flushing

    assert _product_in_native_code(ir, this_machine(), while_flushing) == 0.0
    assert np.array([1e-160]) * 1e-150 > 0.0


def _product_in_native_code(ir, machine, while_flushing):
    double = ir.DoubleType()
    module = ir.Module()
    inner = ir.Function(module, ir.FunctionType(ir.IntType(64), [double.as_pointer()]), "inner")
    inner.attributes.add("noinline")
    builder = ir.IRBuilder(inner.append_basic_block("entry"))
    builder.store(builder.fmul(builder.load(inner.args[0]), double(1e-150)), inner.args[0])
    builder.ret(ir.IntType(64)(0))
    outer = ir.Function(module, ir.FunctionType(ir.IntType(64), [double.as_pointer(), ir.IntType(64)]), "outer")
    builder = ir.IRBuilder(outer.append_basic_block("entry"))
    builder.ret(while_flushing(builder, machine.triple, lambda: builder.call(inner, [outer.args[0]])))
    held = np.array([1e-160])
    machine.native(module, "outer")(held.ctypes.data, 1)
    return float(held[0])


def test_a_processor_that_does_not_flush_gives_the_same(lower, draws, expected, monkeypatch):
    pytest.importorskip("llvmlite")
    from xlmc.engine.llvm import machine as machines
    from xlmc.engine.llvm import program as programs

    plain = machines.this_machine()
    plain.flushes, plain.triple = False, "another"
    monkeypatch.setattr(programs, "machine", lambda: plain)
    lowering, targets = lower(CELLS, draws, TARGETS)
    columns = programs.JitProgram(lowering, targets, [], frozenset()).evaluator(500).filters(draws, 500)
    for column, wanted, cell in zip(columns, expected, TARGETS, strict=True):
        np.testing.assert_allclose(column.values, wanted, rtol=1e-13, atol=0, err_msg=cell)


@pytest.mark.parametrize("triple", ["x86_64-pc-windows-msvc", "aarch64-apple-darwin", "powerpc64le-unknown-linux-gnu"])
def test_the_instructions_are_those_of_the_processor(triple):
    pytest.importorskip("llvmlite")
    from llvmlite import binding, ir

    from xlmc.engine.llvm.machine import flushes, while_flushing

    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), []), "function")
    builder = ir.IRBuilder(function.append_basic_block("entry"))
    while_flushing(builder, triple, lambda: None)
    builder.ret_void()
    binding.parse_assembly(str(module)).verify()
    assert flushes(triple) == ("llvm." in str(module))
