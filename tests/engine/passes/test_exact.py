"""Formulas with 50 digits: the values Excel would show if it did not round, its errors, and what is passed on."""

from __future__ import annotations

import math

import mpmath
import pytest
from mpmath import mpf

from xlmc.engine.passes.exact import Exact, as_double
from xlmc.engine.passes.random_rounding import closure
from xlmc.errors import ErrorCode

CELLS = {
    "E1": "=A1*A1",
    "E2": "=A1*2",
    "A1": 1.0,
    "B1": 0.1,
    "B2": 270.0,
    "B3": "text",
    "B4": True,
    "C1": 3.0,
    "C2": 4.5,
    "D1": "=NA()",
}


def _variance(numbers, lost):
    mean = mpmath.fsum(numbers) / len(numbers)
    return mpmath.fsum((each - mean) ** 2 for each in numbers) / (len(numbers) - lost)


@pytest.fixture(scope="session")
def exact(book):
    """`exact(formula, x)`: its value, and whether all of it was computed with 50 digits."""

    def make(formula, x=0.75):
        model = book(CELLS | {"Z1": formula}, {"x": {"cell": "A1", "low": 0, "high": 9}}, {"f": "Z1", "x": "A1"})
        node = model.lowering.cell(model.forecasts[0].cell)
        result = Exact(model.lowering.dag, closure(model.lowering.dag, [node]))
        return result.trial({"x": x})[node], not result.unchecked

    return make


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("=0.1+0.2-0.3", lambda x: 0),
        ("=B1*3-0.3+A1", lambda x: x),
        ("=COS(RADIANS(B2))", lambda x: 0),
        ("=COS(RADIANS(270))+A1", lambda x: x),
        ("=SIN(PI())*A1", lambda x: 0),
        ("=TAN(RADIANS(60))^2+A1", lambda x: 3 + x),
        ("=(A1+1E20)-1E20", lambda x: x),
        ("=DEGREES(ATAN2(-A1,A1))", lambda x: 135),
        ("=LN(EXP(A1))-A1", lambda x: 0),
        ("=SQRT(A1)^2-A1", lambda x: 0),
        ("=A1^3-A1*A1*A1", lambda x: 0),
        ("=LOG(A1,2)+LOG10(100)+LOG(1000)", lambda x: mpmath.log(x, 2) + 5),
        ("=SUM(C1:C2,A1,B3)+MAX(C1:C2)-MIN(A1,C1)", lambda x: 7.5 + x + 4.5 - x),
        ("=SUMPRODUCT(C1:C2,C1:C2)+SUMSQ(C1,A1)", lambda x: 9 + 20.25 + 9 + x * x),
        ("=AVERAGE(C1:C2,A1)*3+PRODUCT(C1:C2)", lambda x: 7.5 + x + 13.5),
        ("=STDEV.S(A1,A1+2)^2+VAR.P(A1,A1+2)", lambda x: 3),
        ("=MOD(-A1,0.5)", lambda x: 0.25),
        ("=IF(A1*3-2.25=0,1,2)", lambda x: 1),
        ("=IF(AND(A1>0,NOT(A1>1),OR(A1>5,B4)),A1,0)", lambda x: x),
        ("=IFERROR(1/(A1-0.75),7)", lambda x: 7),
        ("=INT(A1*4)+ROUND(A1,1)+ABS(-A1)+SIGN(-A1)", lambda x: 3 + mpf("0.8") + x - 1),
        ("=50%*A1", lambda x: x / 2),
        ("=ASIN(SIN(A1))+ACOS(COS(A1))+ATAN(TAN(A1))", lambda x: 3 * x),
        ("=A1-C1/C2+(A1-C1)*2", lambda x: x - mpf(2) / 3 + 2 * (x - 3)),
        ("=0^A1+(-2)^3+A1^-2", lambda x: -8 + x**-2),
        ("=SQRT(0)+SQRTPI(A1)", lambda x: mpmath.sqrt(x * mpmath.pi)),
        ("=ASIN(1)+ASIN(-1)+ACOS(-1)-ACOS(1)+A1", lambda x: mpmath.pi + x),
        ("=ACOSH(1)+ACOSH(A1+1)", lambda x: mpmath.acosh(x + 1)),
        ("=ASINH(A1)+ATANH(A1)", lambda x: mpmath.asinh(x) + mpmath.atanh(x)),
        ("=SINH(A1)+COSH(A1)+TANH(A1)", lambda x: mpmath.exp(x) + mpmath.tanh(x)),
        ("=SEC(A1)*COS(A1)+CSC(A1)*SIN(A1)+COT(A1)", lambda x: 2 + mpmath.cot(x)),
        ("=COT(RADIANS(90))+TAN(PI())+A1", lambda x: x),
        ("=ACOT(A1)+ACOT(-A1)", lambda x: mpmath.pi),
        ("=LOG(A1,0.5)+LN(A1)", lambda x: -mpmath.log(x, 2) + mpmath.log(x)),
        ("=ATAN2(0,A1)+ATAN2(A1,0)", lambda x: mpmath.pi / 2),
        ("=SIGN(A1)+2*SIGN(0)+INT(-A1)+A1%", lambda x: x / 100),
        ("=PRODUCT(B3:B3)+SUM(B3:B4)+MIN(B3:B4)+MAX(B3:B4)+A1", lambda x: x),
        ("=SUM(B4,TRUE,A1)", lambda x: 1 + x),
        ("=VAR.S(A1,C1,C2)+STDEV.P(A1,C1)", lambda x: _variance([x, 3, 4.5], 1) + mpmath.sqrt(_variance([x, 3], 0))),
        ("=DEVSQ(A1,C1,C2)", lambda x: 3 * _variance([x, 3, 4.5], 0)),
        ("=COVARIANCE.P(C1:C2,E1:E2)", lambda x: mpf("0.75") * (2 * x - x * x) / 2),
        ("=COVARIANCE.S(C1:C2,E1:E2)", lambda x: mpf("0.75") * (2 * x - x * x)),
        ("=SUMPRODUCT(C1:C2)+SUMPRODUCT(B3:B4,C1:C2)+A1", lambda x: mpf("7.5") + x),
        ("=SUMPRODUCT(C1:C2-A1,C1:C2)", lambda x: (3 - x) * 3 + (mpf("4.5") - x) * mpf("4.5")),
        ("=IF(A1>=0.75,1,0)+IF(A1>0.75,10,0)+IF(A1<=0.75,100,0)+IF(A1<0.75,1000,0)", lambda x: 101),
        ("=IF(A1<>0.75,1,2)+IF(A1*1=0.75,10,20)", lambda x: 12),
        ("=IF(AND(E1:E2>0),1,2)+IF(OR(A1>1,A1<0),10,20)", lambda x: 21),
        ("=IF(NOT(A1>1),A1,0)", lambda x: x),
        ("=IF(F9,1,F9)+A1", lambda x: x),
        ("=IFERROR(D1,A1)+IFNA(D1,A1)+IFERROR(A1,7)+IFNA(A1,7)", lambda x: 4 * x),
    ],
)
def test_values(exact, formula, value):
    result, checked = exact(formula)
    assert checked
    with mpmath.workdps(50):
        assert abs(mpf(result) - value(mpf("0.75"))) < mpf(10) ** -38


@pytest.mark.parametrize(
    ("formula", "code"),
    [
        ("=1/COS(RADIANS(B2))", ErrorCode.DIV0),
        ("=1/(A1-0.75)", ErrorCode.DIV0),
        ("=SQRT(-A1)", ErrorCode.NUM),
        ("=LN(A1-1)", ErrorCode.NUM),
        ("=ASIN(A1+1)", ErrorCode.NUM),
        ("=(-A1)^0.5", ErrorCode.NUM),
        ("=ATAN2(A1-0.75,0)", ErrorCode.DIV0),
        ("=A1+B3", ErrorCode.VALUE),
        ("=0^(A1-0.75)", ErrorCode.NUM),
        ("=0^-A1", ErrorCode.DIV0),
        ("=ACOS(-A1-1)", ErrorCode.NUM),
        ("=ACOSH(A1)", ErrorCode.NUM),
        ("=ATANH(A1+0.25)", ErrorCode.NUM),
        ("=ATANH(A1+1)", ErrorCode.NUM),
        ("=SQRTPI(-A1)", ErrorCode.NUM),
        ("=LOG(A1-0.75)", ErrorCode.NUM),
        ("=LOG10(-A1)", ErrorCode.NUM),
        ("=LOG(A1,A1-0.75)", ErrorCode.NUM),
        ("=LOG(A1,A1+0.25)", ErrorCode.DIV0),
        ("=TAN(RADIANS(B2))+A1", ErrorCode.DIV0),
        ("=CSC(A1-0.75)", ErrorCode.DIV0),
        ("=COT(A1-0.75)", ErrorCode.DIV0),
        ("=MOD(A1,A1-0.75)", ErrorCode.DIV0),
        ("=AVERAGE(B3:B4)+A1", ErrorCode.DIV0),
        ("=VAR.S(A1)", ErrorCode.DIV0),
        ("=A1+D1", ErrorCode.NA),
        ("=SUM(A1,D1:D1)", ErrorCode.NA),
        ("=SUMPRODUCT(D1:D1,A1:A1)", ErrorCode.NA),
        ("=SUMPRODUCT(C1:C2,A1:A1)", ErrorCode.VALUE),
        ("=AND(A1>0,D1)", ErrorCode.NA),
        ("=AND(F1:F9)", ErrorCode.VALUE),
        ("=NOT(D1)", ErrorCode.NA),
        ("=IF(D1,A1,2)", ErrorCode.NA),
        ("=IF(B3,A1,2)", ErrorCode.VALUE),
        ("=IFNA(1/(A1-0.75),7)", ErrorCode.DIV0),
    ],
)
def test_errors(exact, formula, code):
    assert exact(formula)[0] == code


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("=NORM.S.DIST(A1,TRUE)", float(mpmath.ncdf(0.75))),
        ("=INDEX(SORT(C1:C2,1,-1),2)+INDEX(SORT(E1:E2),1)", 3.5625),
        ("=SUM(SORT(VSTACK(C1:C2,A1)))", 8.25),
        ("=LARGE(E1:E2,2)", 0.5625),
        ('=SUM(B3:B3&"",A1,LEN(B3&A1))', ErrorCode.VALUE),
    ],
)
def test_what_is_not_known_here_is_computed_as_in_the_run_and_told_of(exact, formula, value):
    result, checked = exact(formula)
    assert not checked
    assert (result if isinstance(value, ErrorCode) else float(result)) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("formula", "value"),
    [("=A1=A1", 1.0), ("=NOT(A1)", 0.0), ("=A1/4", 0.1875), ("=C1:C2*A1", 2.25), ("=1/(A1-0.75)", math.nan)],
)
def test_as_a_double(exact, formula, value):
    assert as_double(exact(formula)[0]) == pytest.approx(value, nan_ok=True)


def test_a_difference_in_the_last_ten_of_fifty_digits_is_none(exact):
    """Of the size of what was subtracted: 1e-39 of it is a difference, 1e-41 is not."""
    assert exact("=(A1+1E-39)-A1")[0] == pytest.approx(mpf("1e-39"), rel=1e-9)
    assert exact("=(A1+1E-41)-A1")[0] == 0
    assert exact("=SUM(A1,1E-39,-A1)")[0] == pytest.approx(mpf("1e-39"), rel=1e-9)
    assert exact("=SUM(A1,1E-41,-A1)")[0] == 0
