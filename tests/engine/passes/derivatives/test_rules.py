"""Every rule against mpmath's derivatives at 50 digits, first and second, at points that hypothesis chooses."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.analysis.studies.derivatives import derivatives
from xlmc.engine.passes.derivatives.rules import RULES

DIGITS = 50

ANY, ABOVE, UNIT, BEYOND = (-3.0, 3.0), (0.1, 5.0), (-0.95, 0.95), (1.1, 5.0)

ONE = {  # formula of A1 -> (mpmath's own, range)
    "=-A1": (lambda x: -x, ANY),
    "=A1%": (lambda x: x / 100, ANY),
    "=RADIANS(A1)": (lambda x: x * mpmath.pi / 180, (-400.0, 400.0)),
    "=DEGREES(A1)": (lambda x: x * 180 / mpmath.pi, ANY),
    "=A1^2": (lambda x: x**2, ANY),
    "=A1^3": (lambda x: x**3, ANY),
    "=A1^-2": (lambda x: x**-2, (-3.0, -0.2)),
    "=A1^0.5": (mpmath.sqrt, ABOVE),
    "=A1^0": (lambda x: mpmath.mpf(1), ABOVE),
    "=2^A1": (lambda x: mpmath.mpf(2) ** x, ANY),
    "=A1^A1": (lambda x: x**x, ABOVE),
    "=SQRT(A1)": (mpmath.sqrt, ABOVE),
    "=SQRTPI(A1)": (lambda x: mpmath.sqrt(x * mpmath.pi), ABOVE),
    "=EXP(A1)": (mpmath.exp, ANY),
    "=LN(A1)": (mpmath.log, ABOVE),
    "=LOG10(A1)": (mpmath.log10, ABOVE),
    "=LOG(A1)": (mpmath.log10, ABOVE),
    "=LOG(A1,3)": (lambda x: mpmath.log(x, 3), ABOVE),
    "=LOG(7,A1)": (lambda x: mpmath.log(7, x), BEYOND),
    "=SIN(A1)": (mpmath.sin, ANY),
    "=COS(A1)": (mpmath.cos, ANY),
    "=TAN(A1)": (mpmath.tan, (-1.4, 1.4)),
    "=SEC(A1)": (mpmath.sec, (-1.4, 1.4)),
    "=CSC(A1)": (mpmath.csc, (0.2, 2.9)),
    "=COT(A1)": (mpmath.cot, (0.2, 2.9)),
    "=ASIN(A1)": (mpmath.asin, UNIT),
    "=ACOS(A1)": (mpmath.acos, UNIT),
    "=ATAN(A1)": (mpmath.atan, ANY),
    "=ACOT(A1)": (lambda x: mpmath.pi / 2 - mpmath.atan(x), ANY),
    "=SINH(A1)": (mpmath.sinh, ANY),
    "=COSH(A1)": (mpmath.cosh, ANY),
    "=TANH(A1)": (mpmath.tanh, ANY),
    "=SECH(A1)": (mpmath.sech, ANY),
    "=CSCH(A1)": (mpmath.csch, ABOVE),
    "=COTH(A1)": (mpmath.coth, ABOVE),
    "=ASINH(A1)": (mpmath.asinh, ANY),
    "=ACOSH(A1)": (mpmath.acosh, BEYOND),
    "=ATANH(A1)": (mpmath.atanh, UNIT),
    "=ACOTH(A1)": (mpmath.acoth, BEYOND),
    "=FISHER(A1)": (mpmath.atanh, UNIT),
    "=FISHERINV(A1)": (mpmath.tanh, ANY),
    "=ABS(A1)": (abs, (-3.0, -0.1)),
    "=SIGN(A1)*A1": (lambda x: -x, (-3.0, -0.1)),
    "=MOD(A1,0.7)": (lambda x: x - mpmath.mpf("2.1"), (2.15, 2.75)),
    "=ROUND(A1,0)*A1": (lambda x: 2 * x, (1.6, 2.4)),
    "=INT(A1)*A1+TRUNC(A1)": (lambda x: -2 * x - 1, (-1.9, -1.1)),
    "=ROUNDUP(A1,1)+ROUNDDOWN(A1,1)+A1": (lambda x: x + mpmath.mpf("4.1"), (2.01, 2.09)),
    "=EVEN(A1)*A1+ODD(A1)": (lambda x: 4 * x + 3, (2.1, 2.9)),
    "=QUOTIENT(A1,2)*A1": (lambda x: x, (2.1, 2.9)),
    "=IF(A1>0,A1^2,SIN(A1))": (lambda x: x**2 if x > 0 else mpmath.sin(x), (0.2, 3.0)),
    "=IF(A1>0,A1^2,SIN(A1))+A1": (lambda x: x + mpmath.sin(x), (-3.0, -0.2)),
    "=IF(A1,A1^3,7)": (lambda x: x**3, ABOVE),
    "=IFERROR(SQRT(-A1),A1^3)": (lambda x: x**3, ABOVE),
    "=IFERROR(SQRT(A1),A1^3)": (mpmath.sqrt, ABOVE),
    "=IFNA(VLOOKUP(99,F1:G3,2,FALSE),A1^3)": (lambda x: x**3, ABOVE),
    "=IFS(A1<0,1,A1<9,EXP(A1),TRUE,2)": (mpmath.exp, ABOVE),
    "=SWITCH(2,1,A1,2,A1*A1,0)": (lambda x: x * x, ANY),
    "=CHOOSE(INT(A1),SIN(A1),COS(A1),A1)": (mpmath.cos, (2.05, 2.95)),
    "=IF(AND(A1>0,OR(A1>9,NOT(A1>8))),A1^3,1)": (lambda x: x**3, ABOVE),
    "=(A1>1)*A1^2": (lambda x: x**2, BEYOND),
    "=LET(v,A1*A1,v*EXP(v))": (lambda x: x * x * mpmath.exp(x * x), (-1.5, 1.5)),
    "=LAMBDA(v,v^3)(A1+1)": (lambda x: (x + 1) ** 3, ANY),
}
TWO = {  # formula of A1 and B1 -> (mpmath's own, ranges)
    "=A1+B1": (lambda x, y: x + y, ANY, ANY),
    "=A1-B1": (lambda x, y: x - y, ANY, ANY),
    "=A1*B1": (lambda x, y: x * y, ANY, ANY),
    "=A1/B1": (lambda x, y: x / y, ANY, (0.2, 4.0)),
    "=A1^B1": (lambda x, y: x**y, ABOVE, ANY),
    "=POWER(A1,B1)": (lambda x, y: x**y, ABOVE, ANY),
    "=LOG(A1,B1)": (lambda x, y: mpmath.log(x) / mpmath.log(y), ABOVE, (1.3, 5.0)),
    "=ATAN2(A1,B1)": (lambda x, y: mpmath.atan2(y, x), (-3.0, -0.1), (0.1, 3.0)),
    "=ATAN2(A1,B1)+0": (lambda x, y: mpmath.atan2(y, x), (0.1, 3.0), (-3.0, 3.0)),
    "=MOD(A1,B1)": (lambda x, y: x - 2 * y, (2.2, 2.8), (0.95, 1.05)),
    "=CEILING(A1,B1)": (lambda x, y: 3 * y, (2.2, 2.8), (0.95, 1.05)),
    "=FLOOR(A1,B1)+MROUND(A1,B1)": (lambda x, y: 2 * y + 3 * y, (2.7, 2.8), (0.98, 1.02)),
    "=CEILING.MATH(A1,B1)*A1": (lambda x, y: 3 * y * x, (2.2, 2.8), (0.95, 1.05)),
    "=SUM(A1:B1,A1,3,D1:D3)": (lambda x, y: 2 * x + y + 3, ANY, ANY),
    "=SUMSQ(A1:B1,4)": (lambda x, y: x * x + y * y + 16, ANY, ANY),
    "=AVERAGE(A1:B1,A1*B1)": (lambda x, y: (x + y + x * y) / 3, ANY, ANY),
    "=PRODUCT(A1:B1,A1,2)": (lambda x, y: 2 * x * x * y, ANY, ANY),
    "=MIN(A1:B1,A1+7)": (lambda x, y: x, (-3.0, 0.9), (1.0, 3.0)),
    "=MAX(A1:B1,0)*A1": (lambda x, y: y * x, (-3.0, 0.9), (1.0, 3.0)),
    "=MEDIAN(A1,B1,9)*B1": (lambda x, y: y * y, (-3.0, 0.9), (1.0, 3.0)),
    "=MEDIAN(A1,B1)^2": (lambda x, y: ((x + y) / 2) ** 2, (-3.0, 0.9), (1.0, 3.0)),
    "=LARGE(A1:B1,2)+SMALL(A1:B1,2)*A1": (lambda x, y: x + y * x, (-3.0, 0.9), (1.0, 3.0)),
    "=VAR.S(A1:B1,5)": (lambda x, y: _variance([x, y, mpmath.mpf(5)], 1), ANY, ANY),
    "=VAR.P(A1:B1,5)+DEVSQ(A1:B1)": (
        lambda x, y: _variance([x, y, mpmath.mpf(5)], 0) + 2 * _variance([x, y], 0),
        ANY,
        ANY,
    ),
    "=STDEV.S(A1:B1,9)": (lambda x, y: mpmath.sqrt(_variance([x, y, mpmath.mpf(9)], 1)), ANY, ANY),
    "=STDEV.P(A1:B1,9)": (lambda x, y: mpmath.sqrt(_variance([x, y, mpmath.mpf(9)], 0)), ANY, ANY),
    "=SUMPRODUCT(A1:B1,A1:B1,{2,3})": (lambda x, y: 2 * x * x + 3 * y * y, ANY, ANY),
    "=SUMPRODUCT(A1:B1*EXP(A1:B1))": (lambda x, y: x * mpmath.exp(x) + y * mpmath.exp(y), ANY, ANY),
    '=SUMIF(D1:D3,"b",E1:E3)': (lambda x, y: x * y + x**3, ANY, ANY),
    '=SUMIF(A1:B1,">0")': (lambda x, y: y, (-3.0, -0.1), (0.1, 3.0)),
    '=SUMIFS(E1:E3,D1:D3,"b")': (lambda x, y: x * y + x**3, ANY, ANY),
    '=AVERAGEIF(D1:D3,"b",E1:E3)': (lambda x, y: (x * y + x**3) / 2, ANY, ANY),
    "=VLOOKUP(2,F1:G3,2,FALSE)": (lambda x, y: y * y, ANY, ANY),
    "=VLOOKUP(A1,F1:G3,2)": (lambda x, y: y * y, (2.1, 2.9), ANY),
    "=HLOOKUP(2,TRANSPOSE(TAKE(F1:G3,3)),2,FALSE)*A1": (lambda x, y: y * y * x, ANY, ANY),
    "=INDEX(G1:G3,2)+INDEX(E1:E3,MATCH(A1,F1:F3))": (lambda x, y: y * y + x * y, (2.1, 2.9), ANY),
    "=INDEX(F1:G3,MATCH(A1,F1:F3),2)": (lambda x, y: y * y, (2.1, 2.9), ANY),
    "=LOOKUP(A1,F1:F3,E1:E3)": (lambda x, y: x * y, (2.1, 2.9), ANY),
    "=LOOKUP(A1,F1:G3)": (lambda x, y: y * y, (2.1, 2.9), ANY),
    "=XLOOKUP(2,F1:F3,E1:E3)": (lambda x, y: x * y, ANY, ANY),
    "=XLOOKUP(77,F1:F3,E1:E3,A1*B1^2)": (lambda x, y: x * y**2, ANY, ANY),
    "=XLOOKUP(A1,F1:F3,E1:E3,0,-1)": (lambda x, y: x * y, (2.1, 2.9), ANY),
    "=SUM(TRANSPOSE(TAKE(E1:E3,3)))": (lambda x, y: x + x * y + x**3, ANY, ANY),
    "=SUM(TAKE(E1:E3,2))+SUM(DROP(E1:E3,2))*2": (lambda x, y: x + x * y + 2 * x**3, ANY, ANY),
    "=SUMPRODUCT(VSTACK(E1:E3,B1)*VSTACK(1,2,3,4))": (lambda x, y: x + 2 * x * y + 3 * x**3 + 4 * y, ANY, ANY),
    "=SUM(FILTER(E1:E3,{0;1;1}))": (lambda x, y: x * y + x**3, ANY, ANY),
    "=INDEX(SORTBY(E1:E3,F1:F3,-1),1)": (lambda x, y: x**3, ANY, ANY),
    "=MMULT(A1:B1,E1:E2)": (lambda x, y: x * x + y * x * y, ANY, ANY),
}
CELLS = {
    "A1": 1.0, "B1": 1.0,
    "D1": "a", "D2": "b", "D3": "b",
    "E1": "=A1", "E2": "=A1*B1", "E3": "=A1^3",
    "F1": 1.0, "F2": 2.0, "F3": 3.0,
    "G1": "=A1", "G2": "=B1^2", "G3": "=A1+B1",
}  # fmt: skip
WIDE = {"x": {"cell": "A1", "low": -9, "high": 9}, "y": {"cell": "B1", "low": -9, "high": 9}}


def _variance(numbers, lost):
    mean = mpmath.fsum(numbers) / len(numbers)
    return mpmath.fsum((number - mean) ** 2 for number in numbers) / (len(numbers) - lost)


def _close(result, exact):
    """Within 1e-10, and within rounding where the exact derivative is 0."""
    assert abs(result - exact) <= 1e-10 * abs(exact) + 1e-13, (result, float(exact))


@pytest.mark.parametrize("formula", ONE)
@settings(max_examples=3)
@given(data=st.data())
def test_one_argument(book, formula, data):
    f, (low, high) = ONE[formula]
    points = data.draw(st.lists(st.floats(low, high), min_size=2, max_size=2, unique=True))
    model = book(CELLS | {"Z1": formula}, {"x": WIDE["x"]}, {"f": "Z1"})
    results = derivatives(model, {"x": points}, order=2)
    result = results.forecasts["f"]
    assert not results.numerical
    assert not result.gradient_error.any()
    with mpmath.workdps(DIGITS):
        for i, x in enumerate(points):
            _close(result.value[i], f(mpmath.mpf(x)))
            _close(result.gradient[i, 0], mpmath.diff(f, x))
            _close(result.hessian[i, 0, 0], mpmath.diff(f, x, 2))


@pytest.mark.parametrize("formula", TWO)
@settings(max_examples=3)
@given(data=st.data())
def test_two_arguments(book, formula, data):
    f, *ranges = TWO[formula]
    points = [data.draw(st.lists(st.floats(*r), min_size=1, max_size=1)) for r in ranges]
    model = book(CELLS | {"Z1": formula}, WIDE, {"f": "Z1", "y": "B1", "x": "A1"})
    results = derivatives(model, dict(zip("xy", points, strict=True)), order=2)
    result = results.forecasts["f"]
    assert not results.numerical
    with mpmath.workdps(DIGITS):
        for i, point in enumerate(zip(*points, strict=True)):
            _close(result.value[i], f(*map(mpmath.mpf, point)))
            for j in range(2):
                _close(result.gradient[i, j], mpmath.diff(f, point, tuple(np.eye(2, dtype=int)[j])))
                for k in range(2):
                    orders = np.eye(2, dtype=int)[j] + np.eye(2, dtype=int)[k]
                    _close(result.hessian[i, j, k], mpmath.diff(f, point, tuple(int(o) for o in orders)))


def test_every_rule_is_for_a_function_of_the_registry():
    from xlmc.excel.functions.families import REGISTRY
    from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION
    from xlmc.excel.functions.math.aggregate import SO_FAR

    names = {row.name for row in [*REGISTRY.values(), *SO_FAR.values(), POSITION, CELL_AT]} | {"shown", "snap to zero"}
    assert set(RULES) - names == set()
