"""Exponentials, logarithms and powers of the compiled loop against mpmath, in units in the last place."""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np
import pytest
from exact_numbers import Exact

pytest.importorskip("llvmlite")

GENERATOR = np.random.default_rng(11)
N = 500
LEAST, MOST = -708.3964185322640, 709.782712893384
"""Between these an exponential is a number of Excel's."""

EXPONENTS = np.concatenate(
    [
        GENERATOR.uniform(LEAST, MOST, N),
        GENERATOR.uniform(-2, 2, N),
        GENERATOR.normal(size=N) * 1e-4,
        (np.arange(-1021, 1023) + 0.5) * np.log(2),  # where the power of two changes
        [0.0, -0.0, 1e-300, LEAST, MOST, np.nextafter(MOST, 0)],
    ]
)
POSITIVE = np.concatenate(
    [
        np.exp(GENERATOR.uniform(-708, 709, N)),
        GENERATOR.uniform(0.5, 2, N),
        1 + GENERATOR.normal(size=N) * 1e-5,
        np.sqrt(0.5) * np.exp2(np.arange(-20, 20)),  # likewise
        [1.0, np.nextafter(1, 0), np.nextafter(1, 2), 2.2250738585072014e-308, np.finfo(float).max],
        10.0 ** np.arange(-22, 23),
    ]
)


@cache
def exactly(function, precision, *of):
    """Of arrays that are given as bytes; kept for the other way of compiling."""
    with mpmath.workprec(precision):
        columns = [np.frombuffer(each).tolist() for each in of]
        return Exact.of(function(*map(mpmath.mpf, row)) for row in zip(*columns, strict=True))


def test_exponentials(compiled, distance):
    result = compiled({"B1": "=EXP(A1)"})(EXPONENTS)[0]
    assert distance(result, exactly(mpmath.exp, 200, EXPONENTS.tobytes())) < 0.75


def test_logarithms(compiled, distance):
    natural, common, again = compiled({"B1": "=LN(A1)", "B2": "=LOG10(A1)", "B3": "=LOG(A1)"})(POSITIVE)
    assert distance(natural, exactly(mpmath.log, 200, POSITIVE.tobytes())) < 0.9
    assert distance(common, exactly(mpmath.log10, 200, POSITIVE.tobytes())) < 0.51
    assert again.tolist() == common.tolist()


def test_powers_of_ten_have_whole_logarithms(compiled):
    exponents = np.arange(-22.0, 23)
    assert compiled({"B1": "=LOG10(A1)"})(10.0**exponents)[0].tolist() == exponents.tolist()


@cache
def bases_and_exponents():
    """Of which the power is a number of Excel's: small and large bases, near 1 with large exponents."""
    bases = (np.exp(GENERATOR.uniform(-30, 30, N)), GENERATOR.uniform(0.7, 1.42, N), np.exp2(GENERATOR.normal(size=N)))
    exponents = (GENERATOR.uniform(-20, 20, N), GENERATOR.uniform(-1900, 1900, N), GENERATOR.integers(-40, 40, N))
    near = 1 + GENERATOR.normal(size=N) * 1e-6
    x, y = np.concatenate([*bases, near]), np.concatenate([*exponents, GENERATOR.uniform(-1, 1, N) * 6e8])
    size = y * np.log(x)
    inside = (size > LEAST + 1) & (size < MOST - 1)
    return x[inside], y[inside]


def test_powers(compiled, distance):
    x, y = bases_and_exponents()
    result = compiled({"B1": "=A1^A2"}, ("A1", "A2"))(x, y)[0]
    assert distance(result, exactly(mpmath.power, 300, x.tobytes(), y.tobytes())) < 0.9


OF_POSITIVE = np.concatenate([np.exp(GENERATOR.uniform(-7, 7, N)), GENERATOR.uniform(0.9, 1.1, N), np.arange(1.0, 100)])
BASES = {"whole": np.concatenate([OF_POSITIVE, -OF_POSITIVE]), "others": OF_POSITIVE}
CONSTANT = {"whole": (4.0, 5.0, 7.0, -2.0, -3.0, 40.0), "others": (1.5, -0.5, 0.1)}


@pytest.mark.parametrize("which", CONSTANT)
def test_powers_with_a_constant_exponent(compiled, distance, which):
    exponents = CONSTANT[which]
    result = compiled({f"B{row}": f"=A1^{exponent!r}" for row, exponent in enumerate(exponents, 1)})(BASES[which])
    bases = BASES[which]
    for exponent, powers in zip(exponents, result, strict=True):
        exact = exactly(mpmath.power, 300, bases.tobytes(), np.full(bases.size, exponent).tobytes())
        assert distance(powers, exact) < 0.9, exponent


def test_powers_that_a_double_holds_are_exact(compiled):
    x, y = (each.ravel() for each in np.meshgrid(np.arange(1.0, 40), np.arange(0.0, 10)))
    exact = np.array([float(int(a) ** int(b)) for a, b in zip(x, y, strict=True)])
    held = exact < 2.0**53
    assert compiled({"B1": "=A1^A2"}, ("A1", "A2"))(x, y)[0][held].tolist() == exact[held].tolist()


EDGES = np.array(
    [
        *(0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0, 5.0, -5.0, 0.5, -0.5, 1 / 3, -1.5, 1e-300, -1e-300, 1e300),
        *(-1e300, 709.0, 710.0, -708.0, -709.0, -746.0, 1e5, -1e5, 2.0**53, 2.0**53 + 2, 1.7e308, 2.3e-308),
    ]
)
POWERS = ("0", "4", "5", "1.5", "(-2)", "(-3)", "(-0.5)", "1E300", "(1/3)", "9007199254740993")
FORMULAS = (
    *(
        "EXP(A1)",
        "LN(A1)",
        "LOG10(A1)",
        "A1^A2",
        "POWER(A2,A1)",
        "IF(A1>0,LN(A1),A2)",
        "LOG(A1)",
        "LOG(A1,10)",
        "LOG(A1,2)",
        "EXP(A1)*EXP(A2)",
    ),
    *(f"A1^{exponent}" for exponent in POWERS),
)


@pytest.mark.parametrize("formula", FORMULAS)
def test_at_the_edges_errors_and_zeros_are_those_of_the_numpy_engine(lower, load_program, formula):
    """Trial by trial: the tests above see vectors."""
    a, b = (each.ravel() for each in np.meshgrid(EDGES, EDGES))
    lowering, targets = lower({"B1": f"={formula}"}, ["A1", "A2"], ["B1"])
    result = []
    for engine in ("numpy", "jit"):
        evaluator = load_program(engine)(lowering, targets, [], frozenset()).evaluator(a.size)
        result.append(evaluator.filters({"A1": a, "A2": b}, a.size)[0])
    one, two = (np.zeros(a.size) if column.codes is None else column.codes for column in result)
    assert one.tolist() == two.tolist()
    fine = one == 0
    np.testing.assert_allclose(result[1].values[fine], result[0].values[fine], rtol=4e-16, atol=0)
    assert (result[1].values[fine] == 0).tolist() == (result[0].values[fine] == 0).tolist()
