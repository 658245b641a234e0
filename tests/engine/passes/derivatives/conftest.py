"""Rules of derivatives, applied to arguments of which every number is an assumption of its own."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from xlmc.engine.passes.derivatives import sweep  # noqa: F401 - it registers all rules
from xlmc.engine.passes.derivatives.jet import Jet, align
from xlmc.engine.passes.derivatives.rules import RULES, Operand
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import NUMBER, from_objects


def _value(argument):
    """An array `(n,)` or `(n, r, c)` as it is; rows of cells as `(1, r, c)`; a single value as `(1,)`."""
    if isinstance(argument, np.ndarray):
        return from_objects(argument.astype(object))
    box = np.empty((len(argument), len(argument[0])) if isinstance(argument, list) else (), object)
    box[...] = argument
    return from_objects(box[None])


def _operands(arguments, still, order):
    values = [_value(argument) for argument in arguments]
    operands, start = [], 0
    for index, value in enumerate(values):
        numbers = (value.kinds == NUMBER).any(axis=0)
        count = 0 if index in still else int(numbers.sum())
        first = np.zeros((count, *value.shape))
        for number, at in enumerate(zip(*np.nonzero(np.atleast_1d(numbers)), strict=True) if count else ()):
            first[(number, slice(None), *(at if value.numbers.ndim == 3 else ()))] = 1.0
        second = np.zeros((count, *first.shape)) if order > 1 else None
        active = tuple(range(start, start + count))
        operands.append(
            Operand(value, Jet(value.numbers, active, first, second) if count else Jet.still(value.numbers))
        )
        start += count
    return operands


@pytest.fixture(scope="session")
def operands_of():
    """`operands_of(arguments, still=(), order=2)`: those at the indices in `still` do not vary."""

    def make(arguments, still=(), order=2):
        return _operands(arguments, still, order)

    return make


@pytest.fixture(scope="session")
def outcome_of():
    """`outcome_of(name or function, *arguments, still=(), order=2)`: what its rule gives."""

    def apply(function, *arguments, still=(), order=2):
        function = REGISTRY[function] if isinstance(function, str) else function
        operands = _operands(arguments, still, order)
        with np.errstate(all="ignore"):
            return RULES[function.name].apply(function, function([operand.value for operand in operands]), operands)

    return apply


@pytest.fixture(scope="session")
def same_derivatives():
    """`same_derivatives(jet, f, point)`: asserts that they are mpmath's at 50 digits, of `f(*point)`, trial 0."""

    def compare(jet, f, point, rel=1e-12):
        k = len(point)
        assert jet.x.size == 1
        wide = align([jet, Jet(np.zeros(1), tuple(range(k)), np.zeros((k, 1)), np.zeros((k, k, 1)))])[0].spread()
        unit = np.eye(k, dtype=int)

        def exact(orders):
            return float(mpmath.diff(f, tuple(map(mpmath.mpf, point)), tuple(map(int, orders))))

        with mpmath.workdps(50):
            gradient = [exact(one) for one in unit]
            hessian = [[exact(one + other) for other in unit] for one in unit]
        assert wide.first.reshape(k, -1)[:, 0] == pytest.approx(np.array(gradient), rel=rel, abs=1e-14)
        assert wide.second.reshape(k, k, -1)[:, :, 0] == pytest.approx(np.array(hessian), rel=rel, abs=1e-14)

    return compare
