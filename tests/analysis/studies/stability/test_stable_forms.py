"""Forms proposed for formulas that lose digits: the family, not the example. All are computed again before they are."""

from __future__ import annotations

from itertools import zip_longest

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.analysis.studies.stability import Level, stability
from xlmc.montecarlo.model.loading import load

pytestmark = pytest.mark.usefixtures("few_points")

TINY, SMALL, DATA = (1e-9, 1e-8), (1e-6, 1e-5), (1e6, 1e6 + 2)

FORMS = [
    ("=1-SIN(A1)^2", [(1.5707, 1.5708)], "=COS(A1)^2"),
    ("=A2-A2*COS(RADIANS(A1))", [(1e-3, 1e-2), (1, 2)], "=2*A2*SIN(RADIANS(A1)/2)^2"),
    ("=1-SIN(RADIANS(A1))", [(89.99, 89.999)], "=2*SIN(RADIANS(90-A1)/2)^2"),
    ("=1+COS(RADIANS(A1))", [(179.99, 179.999)], "=2*SIN(RADIANS(180-A1)/2)^2"),
    ("=A2/(1-COS(A1))", [SMALL, (1, 2)], "=A2/(2*SIN(A1/2)^2)"),
    ("=COS(A2)-COS(A2+A1)", [TINY, (1, 1.1)], "=2*(SIN((2*A2+A1)/2)*SIN(A1/2))"),
    (
        "=SIN(RADIANS(A2+A1))-SIN(RADIANS(A2))",
        [TINY, (10, 11)],
        "=2*(COS(RADIANS(2*A2+A1)/2)*SIN(RADIANS(A1)/2))",
    ),
    ("=TAN(A2+A1)-TAN(A2)", [TINY, (1, 1.1)], "=SIN(A1)/(COS(A2+A1)*COS(A2))"),
    ("=LN(A2+A1)-LN(A2)", [TINY, (1, 2)], "=IF((A2+A1)/A2=1,A1/A2,A1/A2*LN((A2+A1)/A2)/((A2+A1)/A2-1))"),
    ("=LOG10(1-A1)", [TINY], "=IF(1-A1=1,-A1/LN(10),-A1*LOG10(1-A1)/(1-A1-1))"),
    (
        "=EXP(A2+A1)-EXP(A2)",
        [TINY, (1, 2)],
        "=EXP(A2)*IF(ABS(A1)<1,IF(EXP(A1)=1,A1,(EXP(A1)-1)*A1/LN(EXP(A1))),EXP(A1)-1)",
    ),
    ("=1-EXP(A1)", [TINY], "=IF(ABS(A1)<1,IF(EXP(A1)=1,-A1,(1-EXP(A1))*A1/LN(EXP(A1))),1-EXP(A1))"),
    ("=1-TANH(A1)", [(12, 14)], "=2/(EXP(2*A1)+1)"),
    ("=1-SQRT(1-A1^2)", [(1e-5, 1e-4)], "=A1^2/(1+SQRT(1-A1^2))"),
    ("=SQRT(A1^2+A2^2)-A1", [(1e5, 2e5), (1, 2)], "=A2^2/(A1+SQRT(A1^2+A2^2))"),
    ("=(A2+A1)^0.5-A2^0.5", [TINY, (1, 2)], "=A1/(SQRT(A2)+SQRT(A2+A1))"),
    ("=(-A2-SQRT(A2^2-4*A1*A3))/(2*A1)", [(1, 2), (-2e5, -1e5), (1, 2)], "=2*A3/(SQRT(A2^2-4*A1*A3)-A2)"),
    (
        "=-A2/(2*A1)+SQRT((A2/(2*A1))^2-A3/A1)",
        [(1, 2), (1e5, 2e5), (1, 2)],
        "=-A3/A1/(0.5*A2/A1+SQRT((A2/(2*A1))^2-A3/A1))",
    ),
    ("=(A1^2+A2^2+A3^2)/3-((A1+A2+A3)/3)^2", [DATA] * 3, "=DEVSQ(A1,A2,A3)/3"),
    ("=SUMPRODUCT(A1:A3,A1:A3)/3-AVERAGE(A1:A3)^2", [DATA] * 3, "=DEVSQ(A1:A3)/COUNT(A1:A3)"),
    (
        "=SUMPRODUCT(A1:A2,A3:A4)/2-AVERAGE(A1:A2)*AVERAGE(A3:A4)",
        [DATA] * 4,
        "=COVARIANCE.P(A1:A2,A3:A4)",
    ),
    ("=A1*A1+POWER(A2,2)-2*COS(A3)*A1*A2", [(100, 100.001)] * 2 + [SMALL], "=(A1-A2)^2+4*A1*A2*SIN(A3/2)^2"),
    ("=1/A2-1/(A2+A1)", [TINY, (1, 2)], "=A1/(A2*(A2+A1))"),
    ("=(A2+A1)^2-A2^2", [TINY, (1, 2)], "=2*A1*A2+A1^2"),
    ("=A2/(A2-A1)-1", [TINY, (2, 3)], "=A1/(A2-A1)"),
    ("=A2^-1-(A2+A1)^-1", [TINY, (1, 2)], "=A1/(A2*(A2+A1))"),
    ("=$A2-$A$2*COS(A1)", [SMALL, (1, 2)], "=2*$A2*SIN(A1/2)^2"),
    ("=LET(x,1-COS(A1),x/A1^2)", [SMALL], "=2*SIN(A1/2)^2/A1^2"),
    ("=LOG(1+A1)", [TINY], "=IF(1+A1=1,A1/LN(10),A1*LOG10(1+A1)/(1+A1-1))"),
    ("=LOG(1+A1,2)", [TINY], "=IF(1+A1=1,A1,A1*LN(1+A1)/(1+A1-1))/LN(2)"),
    ("=A2*(COSH(A1/A2)-1)", [(1, 2), (1e4, 1e5)], "=A2*(2*SINH(A1/A2/2)^2)"),
    (
        "=A2^2/2*(A1-SIN(A1))",
        [(1e-4, 1e-3), (1, 2)],
        "=A2^2/2*IF(ABS(A1)<0.5,A1^3/6*(1-A1^2/20*(1-A1^2/42*(1-A1^2/72*(1-A1^2/110*(1-A1^2/156*(1-A1^2/210"
        "*(1-A1^2/272))))))),A1-SIN(A1))",
    ),
    (
        "=SQRT(A1+A2)-SQRT(A2)",
        [(0, 1), (0, 1e8)],
        "=IF(-SQRT(A2)<0,A1/(SQRT(A2)+SQRT(A1+A2)),SQRT(A1+A2)-SQRT(A2))",
    ),
]


@pytest.fixture(scope="module")
def looked_at(book):
    """All formulas, each in a row of its own sheet, in one book: one look is enough."""

    def make(formula, given, **cells):
        ranges = {
            f"x{row}": {"cell": f"A{row}", "low": low, "high": high} for row, (low, high) in enumerate(given, start=1)
        }
        base = {one["cell"]: (one["low"] + one["high"]) / 2 for one in ranges.values()}
        return stability(book({**base, **cells, "Z1": formula}, ranges, {"f": "Z1"}), trials=600, seed=5)

    return make


@pytest.mark.parametrize(("formula", "given", "better"), FORMS)
def test_another_form(looked_at, formula, given, better):
    (one,) = [each for each in looked_at(formula, given).findings if each.kind == "cancellation"]
    assert one.instead == better


def test_formulas_of_other_cells_are_looked_into(looked_at):
    result = looked_at("=(1-C1)/A1^2", [(1e-6, 1e-4)], C1="=COS(A1)")
    assert [one.instead for one in result.findings if one.kind == "cancellation"] == ["=2*SIN(A1/2)^2/A1^2"]
    result = looked_at("=SQRT(C1-C2^2)", [DATA] * 3, C1="=SUMSQ(A1:A3)/3", C2="=AVERAGE(A1:A3)")
    assert [one.instead for one in result.findings if one.kind == "cancellation"] == [
        "=SQRT(DEVSQ(A1:A3)/COUNT(A1:A3))"
    ]


def test_a_form_that_is_another_formula_is_not_proposed(looked_at):
    """It looks like a variance, and divides the sum's square by 5 where there are 3."""
    result = looked_at("=(SUMSQ(A1:A3)-SUM(A1:A3)^2/3.0000000001)/3", [DATA] * 3)
    assert all("DEVSQ" not in (one.instead or "") for one in result.findings)


ARCCOSINES = [
    ("=ACOS(1-A1)", [TINY], "=2*ASIN(MIN(1,SQRT(A1/2)))"),
    ("=ACOS(COS(A1))", [SMALL], "=2*ASIN(MIN(1,SQRT(2*SIN(A1/2)^2/2)))"),
    (
        "=ACOS(SIN(A1)*SIN(A2)+COS(A1)*COS(A2)*COS(A3-A4))*6371000",
        [(0.7, 0.70001)] * 4,
        "=2*ASIN(MIN(1,SQRT(SIN((A1-A2)/2)^2+COS(A1)*COS(A2)*SIN((A3-A4)/2)^2)))*6371000",
    ),
    (
        "=ACOS(MIN(1,COS(A1)*COS(A2)+SIN(A1)*SIN(A2)*COS(A3)))",
        [(0.7, 0.70001), (0.7, 0.70001), SMALL],
        "=2*ASIN(MIN(1,SQRT(SIN((A1-A2)/2)^2+SIN(A1)*SIN(A2)*SIN(A3/2)^2)))",
    ),
]


@pytest.mark.parametrize(("formula", "given", "better"), ARCCOSINES)
def test_another_form_of_an_angle_between_directions(looked_at, formula, given, better):
    """The exact difference of two longitudes in it is not to blame."""
    (one,) = [each for each in looked_at(formula, given).findings if each.kind == "rounding"]
    assert "is rounded to 16 digits, and near 1 and -1 ACOS is so steep that this shows" in one.what
    assert one.instead == better


def test_growth_of_little_a_time(looked_at):
    (one,) = [each for each in looked_at("=(1+A1)^12-1", [TINY]).findings if each.kind == "cancellation"]
    grown = "12*IF(1+A1=1,A1,A1*LN(1+A1)/(1+A1-1))"
    assert one.instead == (
        f"=IF(ABS({grown})<1,IF(EXP({grown})=1,{grown},(EXP({grown})-1)*({grown})/LN(EXP({grown}))),EXP({grown})-1)"
    )


def test_what_is_proposed_can_be_typed_into_the_cell(book):
    """A name of another sheet is not known there; one of the book may be hidden by the sheet's own."""
    cells = {"A1": 5e-6, "Z1": "=1-COS(A1)", "Data!A1": 2.0}
    for names, better in [
        ({"Data!x": "S!$A$1"}, "=2*SIN(A1/2)^2"),
        ({"S!x": "S!$A$1"}, "=2*SIN(x/2)^2"),
        ({"x": "S!$A$1"}, "=2*SIN(x/2)^2"),
        ({"x": "S!$A$1", "S!X": "Data!$A$1"}, "=2*SIN(A1/2)^2"),
        ({"_xlnm.Print_Area": "S!$A$1"}, "=2*SIN(A1/2)^2"),
    ]:
        ranges = {"angle": {"cell": "A1", "low": 1e-6, "high": 1e-5}}
        result = stability(book(cells, ranges, {"f": "Z1"}, names=names), trials=500, seed=5)
        assert [each.instead for each in result.findings if each.kind == "cancellation"] == [better]


def test_a_form_is_found_for_every_cell_of_a_filled_down_column(tmp_path):
    """And none where it would have to name the draw of RAND(), which has no address."""
    book = openpyxl.Workbook()
    book.active.title = "S"
    rows = [["Name", "Value", "Low", "High"], *([f"x{row}", 5e-6, 1e-6, 1e-5] for row in (2, 3, 4))]
    cells = [["Name", "Value"], *([f"f{row}", f"=1-COS(B{row})"] for row in (2, 3, 4)), ["r", "=1-COS(RAND()*0.00001)"]]
    for row, (left, right) in enumerate(zip_longest(rows, cells, fillvalue=[None] * 4), start=1):
        for column, value in enumerate([*left, None, *right], start=1):
            book.active.cell(row, column, value)
    book.active.add_table(Table(displayName="xlmc_assumptions", ref="A1:D4"))
    book.active.add_table(Table(displayName="xlmc_forecasts", ref="F1:G5"))
    book.save(tmp_path / "filled.xlsx")
    result = stability(load(tmp_path / "filled.xlsx"), trials=500, seed=5)
    offered = {each.name: each.instead for each in result.findings if each.kind == "cancellation"}
    assert offered == {**{f"f{row}": f"=2*SIN(B{row}/2)^2" for row in (2, 3, 4)}, "r": None}


def test_a_form_that_is_worse_in_other_trials_stands_only_where_it_is_better(looked_at):
    """Above 0 it would be the other form that loses the digits; where A2 may be 0 it would have no number."""
    (one,) = [
        each
        for each in looked_at("=A2*A1+A2*SQRT(A1^2+A3)", [(-1e6, 1e3), (1, 2), (1, 2)]).findings
        if each.kind == "cancellation"
    ]
    old = "A2*A1+A2*SQRT(A1^2+A3)"
    assert one.instead == f"=IF(A1<0,-(A2^2)*A3/(A1*A2-A2*SQRT(A1^2+A3)),{old})"
    result = looked_at("=A2*A1+A2*SQRT(A1^2+A3)", [(-1e6, 1e3), (-1, 2), (1, 2)])
    assert [each.instead for each in result.findings if each.kind == "cancellation"] == [None]


def test_where_none_is_known_the_culprit_is_named_alone(looked_at):
    (one,) = [each for each in looked_at("=(A1-TAN(A1))/A1^3", [(1e-5, 1e-4)]).findings if each.kind == "cancellation"]
    assert one.what.startswith("A1-TAN(A1) is a difference of nearly equal numbers")
    assert one.instead is None


def test_a_spread_that_is_all_rounding_is_wrong_though_the_number_is_nearly_right(looked_at):
    """The variance is 100 to seven digits in every trial; how it varies is below what rounding leaves."""
    formula = "=(SUMSQ(A1:A3,D1:D2)-SUM(A1:A3,D1:D2)^2/5)/4"
    near = [(1e8 + 10, 1e8 + 10 + 1e-6), (1e8, 1e8 + 1e-6), (1e8 - 10, 1e8 - 10 + 1e-6)]
    result = looked_at(formula, near, D1=1e8 + 3000.0, D2=1e8 - 3000.0)
    (one,) = [each for each in result.findings if each.kind == "cancellation"]
    assert one.level is Level.WRONG
    assert "its spread comes from rounding" in one.effect
    assert any(
        "the digits of 'f' cannot be trusted: its spread comes from rounding" in warning
        for warning in result.run.warnings
    )


@pytest.mark.parametrize("formula", ["=SIN(A1)^2+COS(A1)^2", "=A1/A1*3", "=A1*1.1/A1"])
def test_a_constant_in_all_but_its_last_digit_is_no_spread(looked_at, formula):
    result = looked_at(formula, [(1, 2)])
    assert result.findings == ()
    assert not result.run.warnings
