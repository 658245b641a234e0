"""The watch in every run: lost digits become warnings, and nothing else does."""

from __future__ import annotations

import pytest
from simulated import simulated

X = {"x": {"cell": "A1", "low": 1, "high": 2}}


@pytest.fixture(scope="session")
def warned(book):
    def make(formula, assumptions=X, **cells):
        model = book({"A1": 1.5, "Z1": formula} | cells, assumptions, {"f": "Z1"})
        return simulated(model, trials=2_000, seed=1).warnings

    return make


@pytest.mark.parametrize(
    "formula",
    [
        "=(A1+1E15)-1E15",
        "=A1*COS(RADIANS(270))*1E16",
        "=(1-COS(A1/100000000))*1E17",
        "=(1-COS(A1*1E-9))/(A1*1E-9)^2",
        "=LN(1+A1*1E-18)/A1*1E18",
        "=(SQRT(1+A1*1E-18)-1)*1E18",
    ],
)
def test_lost_digits_are_warned_of(warned, formula):
    (warning,) = warned(formula)
    assert "the digits of 'f' cannot be trusted" in warning
    assert "xlmc stability says where" in warning


@pytest.mark.parametrize(
    "formula",
    [
        "=A1^2",
        "=(A1+1000)-1000",
        "=IF(A1>1.5,1,0)",
        "=ROUND(A1*100,0)/100",
        "=INT(A1*10)",
        "=0.1*3-0.3",
        "=A1-A1",
        "=A1*3-A1-A1-A1",
        "=VLOOKUP(A1,{1,10;1.5,20},2)",
        "=1/(A1-1.5)",
        "=IF(0.1*3>=0.3,A1,0)",
        "=20.3*A1/A1-20.3",
        "=IFERROR(SQRT(A1-1.5),0)",
        "=MOD(A1*360,360)",
        "=MAX(A1,5)",
        "=5+(1-COS(A1*1E-9))",
        "=IF(A1>0,0.1+0.2-0.3,0)",
    ],
)
def test_sound_formulas_are_not(warned, formula):
    assert warned(formula) == []


def test_whole_numbers_stay_exact(warned):
    """Sums and products of whole numbers decide and look up, and none of them is moved."""
    wide = {"x": {"cell": "A1", "low": 1, "high": 3}}
    assert warned("=IF(INT(A1)*3=3,1,0)+INDEX({10,20,30},INT(A1)*2-1)", wide) == []
