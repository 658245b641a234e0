"""Sines, cosines, tangents and arctangents of the compiled loop against mpmath, in units in the last place."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import mpmath
import numpy as np
import pytest
from exact_numbers import Exact
from simulated import simulated

from xlmc.engine.llvm.loop_arithmetic import HALF_PI
from xlmc.excel.functions.denormals import tiny_to_zero

pytest.importorskip("llvmlite")

from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.numpy.numpy_engine import NumpyProgram

LIMIT = 2.0**27


def near_multiples():
    """Doubles around the multiples of π/2, odd and even, small and large."""
    with mpmath.workprec(200):
        counts = [*range(1, 400), *(2**k + j for k in range(9, 26) for j in (-1, 0, 1))]
        centres = np.array([float(mpmath.pi / 2 * k) for k in counts])
    steps = (centres, np.nextafter(centres, 0), np.nextafter(centres, np.inf))
    return np.concatenate([part[part < LIMIT] for part in steps])


def closest():
    """The doubles that come closest to a multiple of π/2, where most digits cancel.

    q·2^e lies by p·π/2 where p/q is a convergent of the continued fraction of 2^e / (π/2).
    """
    result = []
    with mpmath.workprec(400):
        for exponent in range(-52, -25):
            rest = mpmath.ldexp(1, exponent) / (mpmath.pi / 2)
            before, q = 1, 0
            while True:
                whole = int(mpmath.floor(rest))
                before, q = q, whole * q + before
                if q >= 2**53:
                    break
                result.append(q * 2.0**exponent)
                rest = 1 / (rest - whole)
    return np.array([x for x in result if 0.1 < x < LIMIT])


GENERATOR = np.random.default_rng(3)
ANGLES = {
    "dense": np.linspace(-7, 7, 1001),
    "degrees": np.radians(np.arange(-720, 721)),
    "quarters": np.arange(-40, 41) * (np.pi / 4),
    "near multiples": near_multiples(),
    "closest": closest(),
    "any size": np.exp(GENERATOR.uniform(np.log(1e-12), np.log(LIMIT), 700)) * GENERATOR.choice([-1, 1], 700),
    "large": GENERATOR.uniform(LIMIT / 2, LIMIT, 300),
    "tiny": np.array(
        [0.0, 5e-324, 1e-310, 2.2e-308, 1e-300, 1e-200, 1e-20, 1e-8, -1e-8, -5e-324, np.nextafter(LIMIT, 0)]
    ),
}


KNOWN = {}


def exactly(function, *arrays):
    """Of numbers that are 0 where Excel knows none so small; kept for the other way of compiling."""
    key = (function, mpmath.mp.prec, *(array.tobytes() for array in arrays))
    if key not in KNOWN:
        rows = zip(*map(tiny_to_zero, arrays), strict=True)
        KNOWN[key] = Exact.of(function(*map(mpmath.mpf, map(float, row))) for row in rows)
    return KNOWN[key]


@cache
def exact_of_angles(angles):
    """Sines, cosines and tangents."""
    with mpmath.workprec(300):
        pairs = [mpmath.cos_sin(mpmath.mpf(x)) for x in tiny_to_zero(ANGLES[angles]).tolist()]
        sines, cosines = ([pair[at] for pair in pairs] for at in (1, 0))
        return Exact.of(sines), Exact.of(cosines), Exact.of(sine / cosine for cosine, sine in pairs)


@pytest.fixture(scope="module")
def of_angles(compiled):
    return compiled({"B1": "=SIN(A1)", "B2": "=COS(A1)", "B3": "=TAN(A1)"})


@pytest.mark.parametrize("angles", ANGLES)
def test_within_a_unit_in_the_last_place(of_angles, distance, angles):
    sine, cosine, tangent = of_angles(ANGLES[angles])
    exact_sine, exact_cosine, exact_tangent = exact_of_angles(angles)
    assert distance(sine, exact_sine) < 1
    assert distance(cosine, exact_cosine) < 1
    assert distance(tangent, exact_tangent) < 2


def test_hard_angles_are_among_them():
    """Below 2^27 some double comes within 2^-58 of a multiple of π/2."""
    with mpmath.workprec(300):
        halves = [mpmath.mpf(float(x)) / (mpmath.pi / 2) for x in ANGLES["closest"]]
        assert min(abs(half - mpmath.nint(half)) for half in halves) < mpmath.ldexp(1, -58)


def test_half_pi_to_159_bits():
    with mpmath.workprec(300):
        assert abs(mpmath.fsum(map(mpmath.mpf, HALF_PI)) - mpmath.pi / 2) < mpmath.mpf(2) ** -159


ARC_GENERATOR = np.random.default_rng(5)
STEPS = np.array([7, 11, 19, 39]) / 16
"""Where the reduction changes."""

SIZES = np.concatenate(
    [
        np.linspace(0, 5, 251),
        np.exp(ARC_GENERATOR.uniform(-45, 45, 250)),
        STEPS,
        np.nextafter(STEPS, 0),
        np.nextafter(STEPS, 9),
        [0.0, 5e-324, 1e-310, 2.2250738585072014e-308, 1e-20, 1e20, 1e300, np.finfo(float).max],
    ]
)
TO_ONE = np.concatenate(
    [
        np.linspace(0, 1, 351),
        1 - np.exp(ARC_GENERATOR.uniform(-36, 0, 200)),
        np.exp(ARC_GENERATOR.uniform(-700, 0, 200)),
    ]
)

HARD = np.array(
    [
        *(0.12441101180747778, 0.06238907818326885, 0.24650079, 0.5, np.nextafter(0.5, 0), np.nextafter(0.5, 1)),
        *map(float.fromhex, ("0x1.f0400edae762fp-1", "0x1.fc01a33f8f07fp-1", "0x1.f8d76753701d4p-3")),
    ]
)
"""Where the angle of a point (√(1 - x²), x) is off by 2.3 to 2.6 such units, and where the reduction changes."""


def test_arctangents(compiled, distance):
    x = np.concatenate([SIZES, -SIZES])
    with mpmath.workprec(200):
        assert distance(compiled({"B1": "=ATAN(A1)"})(x)[0], exactly(mpmath.atan, x)) < 1


@cache
def points():
    """In every direction, near the axes and the diagonals too."""
    x, y = (ARC_GENERATOR.permutation(np.concatenate([SIZES, -SIZES, np.ones(100), -np.ones(100)])) for _ in range(2))
    near = np.exp(ARC_GENERATOR.uniform(-3, 3, 500)) * ARC_GENERATOR.choice([-1, 1], 500)
    x, y = np.concatenate([x, near, near, near]), np.concatenate([y, near, -near[::-1], np.nextafter(near, 0)])
    apart = (tiny_to_zero(x) != 0) | (tiny_to_zero(y) != 0)
    return x[apart], y[apart]


def test_angles_of_points(compiled, distance):
    x, y = points()
    with mpmath.workprec(1200):
        exact = exactly(mpmath.atan2, y, x)
    sizes = np.abs(exact.nearest)
    fine = (sizes > 2.3e-308) | ((sizes == 0) & (exact.left == 0))  # Excel knows no smaller ones
    result = compiled({"B1": "=ATAN2(A1,A2)"}, ("A1", "A2"))(x, y)[0]
    assert distance(result[fine], exact.take(fine)) < 2


def test_on_the_axes(compiled):
    angle = compiled({"B1": "=ATAN2(A1,A2)"}, ("A1", "A2"))
    x, y = np.array([1.0, 0.0, -1.0, 0.0, -1.0, 1.0]), np.array([0.0, 1.0, 0.0, -1.0, -0.0, -0.0])
    assert angle(x, y)[0].tolist() == [0.0, np.pi / 2, np.pi, -np.pi / 2, np.pi, 0.0]


@pytest.mark.parametrize(("name", "function"), [("ASIN", mpmath.asin), ("ACOS", mpmath.acos)])
def test_arcsines_and_arccosines(compiled, distance, name, function):
    x = np.concatenate([TO_ONE, -TO_ONE, HARD, -HARD])
    with mpmath.workprec(1200):
        assert distance(compiled({"B1": f"={name}(A1)"})(x)[0], exactly(function, x)) < 2


def test_remainders_are_exact(compiled):
    """As NumPy has them, whose remainder is that of the doubles, rounded once."""
    x = np.concatenate([SIZES, -SIZES])
    x = x[np.abs(x) < 1e15]
    divisor = ARC_GENERATOR.choice([360.0, -360.0, 0.1, -0.1, 1.0, np.pi, 1e-3, -7.25], x.size)
    result = compiled({"B1": "=MOD(A1,A2)"}, ("A1", "A2"))(x, divisor)[0]
    expected = tiny_to_zero(np.remainder(tiny_to_zero(x), divisor))
    np.testing.assert_array_equal(result.view(np.int64), expected.view(np.int64))


def dividends(divisor):
    """Of any size, zeros, and those whose quotients come closest to halfway between two doubles.

    Let y be the odd part of the divisor, of b bits, and m of 54 bits, odd: m is halfway between two doubles. If m·y is
    -k modulo 2^(b + 1), x = (m·y + k) / 2^(b + 1) is whole, and x/y·2^(b + 1) lies k/y from m.
    """
    whole = abs(Fraction(divisor).numerator)
    y = whole // (whole & -whole)
    bits = y.bit_length() + 1
    near = []
    for k in range(-1501, 1502, 2):
        m = -k * pow(y, -1, 2**bits) % 2**bits
        m += 2**bits * int(ARC_GENERATOR.integers(0, 2 ** (54 - bits), endpoint=False))
        near.append(float((m * y + k) >> bits))
    result = np.concatenate([SIZES[SIZES > 1e-240], near, np.nextafter(near, 0), np.nextafter(near, np.inf), [0.0]])
    return np.concatenate([result, -result])


@pytest.mark.parametrize("divisor", [100, 12, -12, 3, 5280, 32.174, 1e-9, 7e15, 1 + 2**-52, 2 - 2**-52, 0.1, 64])
def test_quotients_by_constants_are_exact(compiled, divisor):
    """To the last bit, and with the sign of a zero."""
    x = dividends(divisor)
    x = x[np.abs(x) < 1e290]
    result = compiled({"B1": f"=A1/{divisor!r}"})(x)[0]
    np.testing.assert_array_equal(result.view(np.int64), (x / divisor).view(np.int64))


@pytest.mark.parametrize("divisor", [100, -1e15, 1e-9, 1e-200])
@pytest.mark.parametrize("number", [1e-242, 1e-307, 2.3e-308, 1e308])
def test_quotients_at_the_edges_are_those_of_the_numpy_engine(lower, divisor, number):
    """Also where the steps between are too small or too large for a double."""
    lowering, targets = lower({"B1": f"=A1/{divisor!r}"}, ["A1"], ["B1"])
    draws = {"A1": number * np.array([1.0, -1.0, 1.2345678, 1.3])}
    programs = [JitProgram(lowering, targets, [], frozenset()), NumpyProgram.of(lowering, targets, [], frozenset())]
    jit, numpy = (each.evaluator(4).filters(draws, 4)[0] for each in programs)
    assert [jit.codes is None, *jit.values] == [numpy.codes is None, *numpy.values]


CELLS = {
    "A1": 0.5,
    "A2": 0.5,
    "B1": "=ATAN2(INT(2*A1),INT(2*A2))",
    "B2": "=ASIN(2*A1)",
    "B3": "=ACOS(2*A1)",
    "B4": "=MOD(A1,INT(2*A2))",
    "B5": "=ATAN(1/INT(2*A1))",
}


ERRORS = {"B1": "#DIV/0!", "B2": "#NUM!", "B3": "#NUM!", "B4": "#DIV/0!", "B5": "#DIV/0!"}


@pytest.mark.parametrize("cell", ERRORS)
def test_errors_are_those_of_the_careful_path(book, side_by_side, cell):
    given = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": 1}}
    model = book(CELLS, given, {"x": cell})
    with side_by_side(0):
        runs = [simulated(model, 2000, engine="numpy"), simulated(model, 2000, engine="jit")]
    numpy, jit = (run.forecasts["x"] for run in runs)
    assert runs[0].faults == runs[1].faults
    assert set(runs[0].faults["x"]) == {ERRORS[cell]}
    np.testing.assert_array_equal(np.isnan(numpy), np.isnan(jit))
    np.testing.assert_allclose(jit, numpy, rtol=1e-12, atol=1e-12)
