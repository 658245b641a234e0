"""Formulas with 50 digits: the values Excel would show if it did not round, its errors, and what is passed on."""

from __future__ import annotations

import mpmath
import pytest
from mpmath import mpf

from xlmc.engine.passes.exact import Exact
from xlmc.engine.passes.random_rounding import closure
from xlmc.errors import ErrorCode

CELLS = {"A1": 1.0, "B1": 0.1, "B2": 270.0, "B3": "text", "B4": True, "C1": 3.0, "C2": 4.5}


@pytest.fixture(scope="session")
def exact(book):
    """`exact(formula, x)`: its value, and whether all of it was computed with 50 digits."""

    def make(formula, x=0.75):
        model = book(CELLS | {"Z1": formula}, {"x": {"cell": "A1", "low": 0, "high": 9}}, {"f": "Z1", "x": "A1"})
        node = model.lowering.cell(model.forecasts[0].cell)
        found = Exact(model.lowering.dag, closure(model.lowering.dag, [node]))
        return found.trial({"x": x})[node], not found.unchecked

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
    ],
)
def test_values(exact, formula, value):
    found, checked = exact(formula)
    assert checked
    with mpmath.workdps(50):
        assert abs(mpf(found) - value(mpf("0.75"))) < mpf(10) ** -38


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
    ],
)
def test_errors(exact, formula, code):
    assert exact(formula)[0] == code


def test_what_is_not_known_here_is_computed_as_in_the_run_and_told_of(exact):
    found, checked = exact("=NORM.S.DIST(A1,TRUE)")
    assert not checked
    assert float(found) == pytest.approx(float(mpmath.ncdf(0.75)), rel=1e-15)
