from __future__ import annotations

from contextlib import contextmanager
from functools import cache

import pytest


@pytest.fixture
def compile_nothing(monkeypatch):
    """Loops are not compiled: there is no code to run. `compile_nothing`: what each would be compiled of."""
    from xlmc.engine.llvm import phase
    from xlmc.engine.llvm.machine import NativeLoop

    made = []
    monkeypatch.setattr(phase, "compile_loop", lambda *given: made.append(given) or NativeLoop(0, None))
    return made


@pytest.fixture(scope="session")
def side_by_side():
    """`with side_by_side(k):` loops take so many vectors of trials at once; with 0 one trial after another.

    They give the same bits, which `test_shapes` shows; one vector takes half as long to compile as two, one trial a
    third.
    """
    from xlmc.engine.llvm import phase
    from xlmc.engine.llvm.loop import compile_loop

    @contextmanager
    def patched(count):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(phase, "compile_loop", lambda *given: compile_loop(*given[:6], count))
            yield

    return patched


@cache
def plain_machine():
    """This processor without fused multiplication; one object, which keeps what it has compiled."""
    from xlmc.engine.llvm import machine as machines

    plain = machines.this_machine()
    plain.fused = False
    return plain


@pytest.fixture(scope="module", params=["as it is", "without fused multiplication"])
def compiled(request, lower, side_by_side):
    """`compiled(cells, inputs)`: what takes arrays of the inputs and gives the cells by the compiled loop."""
    from xlmc.engine.llvm import program as programs

    def make(cells, inputs=("A1",)):
        with pytest.MonkeyPatch.context() as patch, side_by_side(1):
            if request.param != "as it is":
                patch.setattr(programs, "machine", plain_machine)
            lowering, targets = lower(cells, [*inputs], [*cells])
            program = programs.JitProgram(lowering, targets, [], frozenset())

        def evaluate(*arrays):
            draws, n = dict(zip(inputs, arrays, strict=True)), arrays[0].size
            columns = program.evaluator(n).filters(draws, n)
            assert all(column.codes is None for column in columns)
            return [column.values for column in columns]

        return evaluate

    return make


@pytest.fixture(scope="session")
def distance():
    """`distance(computed, exact)`: how many units in the last place of the exact value lie between, at most."""
    return lambda computed, exact: exact.distance(computed)
