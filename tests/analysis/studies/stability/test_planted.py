"""Seven formulas that lose their digits beside fifteen sound ones, in one book."""

from __future__ import annotations

import re

import pytest

from xlmc.analysis.studies.stability import Level, stability

pytestmark = pytest.mark.usefixtures("few_points")

DATA = (1e6, 1e6 + 2)
PLANTED = {
    "variance": (
        "=(SUMSQ(A1:A4)-SUM(A1:A4)^2/COUNT(A1:A4))/(COUNT(A1:A4)-1)",
        [DATA] * 4,
        "SUMSQ(A1:A4)-SUM(A1:A4)^2/COUNT(A1:A4) is a difference of nearly equal numbers",
        "=DEVSQ(A1:A4)/(COUNT(A1:A4)-1)",
    ),
    "root": (
        "=(-A2+SQRT(A2^2-4*A1*A3))/(2*A1)",
        [(1, 2), (1e5, 2e5), (1, 2)],
        "-A2+SQRT(A2^2-4*A1*A3) is a difference of nearly equal numbers",
        "=-2*A3/(A2+SQRT(A2^2-4*A1*A3))",
    ),
    "cosine": (
        "=(1-COS(A1))/A1^2",
        [(1e-6, 1e-4)],
        "1-COS(A1) is a difference of nearly equal numbers",
        "=2*SIN(A1/2)^2/A1^2",
    ),
    "side": (
        "=SQRT(A1^2+A2^2-2*A1*A2*COS(RADIANS(A3)))",
        [(100, 100.001), (100, 100.001), (1e-4, 1e-3)],
        "A1^2+A2^2-2*A1*A2*COS(RADIANS(A3)) is a difference of nearly equal numbers",
        "=SQRT((A1-A2)^2+4*A1*A2*SIN(RADIANS(A3)/2)^2)",
    ),
    "logarithm": (
        "=LN(1+A1)/A1",
        [(1e-9, 1e-7)],
        "1+A1 is rounded to 16 digits, and LN uses only its difference from 1",
        "=IF(1+A1=1,A1,A1*LN(1+A1)/(1+A1-1))/A1",
    ),
    "growth": (
        "=(EXP(A1)-1)/A1",
        [(1e-9, 1e-7)],
        "EXP(A1)-1 is a difference of nearly equal numbers",
        "=IF(ABS(A1)<1,IF(EXP(A1)=1,A1,(EXP(A1)-1)*A1/LN(EXP(A1))),EXP(A1)-1)/A1",
    ),
    "roots": (
        "=SQRT(A1+A2)-SQRT(A1)",
        [(1e6, 2e6), (1e-4, 2e-4)],
        "SQRT(A1+A2)-SQRT(A1) is a difference of nearly equal numbers",
        "=A2/(SQRT(A1)+SQRT(A1+A2))",
    ),
}
"""Name -> the formula in terms of column A, the ranges of the column, what is said of it, and the form proposed."""

SOUND = {
    "1-COS(A1)": [(0.5, 1.5)],
    "LN(1+A1)": [(1, 2)],
    "EXP(A1)-1": [(1, 2)],
    "SQRT(A1)-SQRT(A2)": [(9, 16), (1, 4)],
    "(SUMSQ(A1:A4)-SUM(A1:A4)^2/4)/3": [(1, 2), (3, 4), (5, 6), (7, 8)],
    "(-A2-SQRT(A2^2-4*A1*A3))/(2*A1)": [(1, 2), (1e5, 2e5), (1, 2)],
    "SQRT(A1^2+A2^2-2*A1*A2*COS(RADIANS(A3)))": [(3, 4), (5, 6), (60, 90)],
    "A1-A2": [(100, 100.001), (100, 100.001)],
    "1/(A1-A2)": [(2, 2.001), (1.999, 1.9999)],
    "ATAN2(A1,A2)": [(-1, 1), (-1, 1)],
    "IF(A1<0,ATAN(A2/A1)+PI(),ATAN(A2/A1))": [(-1, 3), (1, 2)],
    "0.5*A1*A2^2/9.81": [(1000, 2000), (10, 20)],
    "SIN(A1)^2+COS(A1)^2+A2": [(0, 1), (1, 2)],
    "2*SIN(A1/2)^2/A1^2*A2": [(1e-6, 1e-4), (1, 2)],
    "DEVSQ(A1:A4)/3": [DATA] * 4,
}

UNRELATED = ["IF(A1<0,1,2)+(A1>=1)", "MAX(A1,0)"]


def _moved(formula, column):
    """A formula of column A in another column."""
    return re.sub(r"\bA(\d)", rf"{column}\1", formula)


@pytest.fixture(scope="module")
def result(book):
    """Beside comparisons that have nothing to do with them."""
    cells, ranges, forecasts, filters = {}, {}, {}, {}
    formulas = {name: (formula, given) for name, (formula, given, *_) in PLANTED.items()}
    formulas |= {formula: (f"={formula}", given) for formula, given in SOUND.items()}
    for number, (name, (formula, given)) in enumerate(formulas.items()):
        column = chr(ord("A") + number)
        cells[f"{column}9"], forecasts[name] = _moved(formula, column), f"{column}9"
        for row, (low, high) in enumerate(given, start=1):
            cells[f"{column}{row}"] = (low + high) / 2
            ranges[f"{column}{row} "] = {"cell": f"{column}{row}", "low": low, "high": high}
        for row, other in enumerate(UNRELATED, start=10):
            cells[f"{column}{row}"], forecasts[f"{column}{row} "] = f"={_moved(other, column)}", f"{column}{row}"
        filters[f"{column} "] = {"cell": f"{column}1", "at_least": given[0][0] - 1}
    return stability(book(cells, ranges, forecasts, filters), trials=1000, seed=5)


@pytest.mark.parametrize("name", PLANTED)
def test_each_is_found_with_its_culprit_and_another_form(result, name):
    column = chr(ord("A") + list(PLANTED).index(name))
    (one,) = [each for each in result.findings if each.name == name and each.level < Level.NOTE]
    assert one.kind == "cancellation"
    assert one.what.startswith(_moved(PLANTED[name][2], column))
    assert one.instead == _moved(PLANTED[name][3], column)
    assert all(where.name.startswith(column) for where in one.where)


def test_there_is_no_false_alarm(result):
    message = {(each.name, each.kind) for each in result.findings if each.name not in PLANTED}
    message -= {(name, kind) for name, kind in message if name.endswith(" ") and kind == "jump"}
    assert {kind for _, kind in message} <= {"amplification"}
    assert {name for name, _ in message} <= {"A1-A2", "1/(A1-A2)", "DEVSQ(A1:A4)/3"}


def test_only_the_assumptions_of_the_cell_are_named(result):
    assert all(where.name[0] == str(each.cell)[2] for each in result.findings for where in each.where)
