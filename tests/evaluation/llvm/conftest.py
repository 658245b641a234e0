from __future__ import annotations

from functools import cache

import mpmath
import numpy as np
import pytest


@cache
def plain_machine():
    """This processor without fused multiplication; one object, which keeps what it has compiled."""
    from xlmc.evaluation.llvm import machine as machines

    plain = machines.this_machine()
    plain.fused = False
    return plain


@pytest.fixture(scope="module", params=["as it is", "without fused multiplication"])
def compiled(request, lower):
    """`compiled(cells, inputs)`: what takes arrays of the inputs and gives the cells by the compiled loop."""
    from xlmc.evaluation.llvm import program as programs

    def make(cells, inputs=("A1",)):
        with pytest.MonkeyPatch.context() as patch:
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
    """`distance(computed, exact)`: how many units in the last place of the exact value lie between, at most.

    The unit of a subnormal is that of all subnormals.
    """

    def found(computed, exact):
        worst = 0.0
        for value, truth in zip(computed, exact, strict=True):
            unit = mpmath.mpf(float(np.spacing(abs(float(truth)))))
            worst = max(worst, float(abs(mpmath.mpf(float(value)) - truth) / unit))
        return worst

    return found
