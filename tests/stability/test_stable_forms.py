"""Forms proposed for formulas that lose digits: the family, not the example. All are computed again before they are."""

from __future__ import annotations

import pytest

from xlmc.stability import Level, stability

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
]


@pytest.fixture(scope="module")
def looked_at(book):
    """All formulas, each in a row of its own sheet, in one book: one look is enough."""

    def make(formula, given, **cells):
        ranges = {
            f"x{row}": {"cell": f"A{row}", "low": low, "high": high} for row, (low, high) in enumerate(given, start=1)
        }
        base = {one["cell"]: (one["low"] + one["high"]) / 2 for one in ranges.values()}
        return stability(book({**base, **cells, "Z1": formula}, ranges, {"f": "Z1"}), trials=2000, seed=5)

    return make


@pytest.mark.parametrize(("formula", "given", "better"), FORMS)
def test_another_form(looked_at, formula, given, better):
    (one,) = [each for each in looked_at(formula, given).findings if each.kind == "cancellation"]
    assert one.instead == better


def test_formulas_of_other_cells_are_looked_into(looked_at):
    found = looked_at("=(1-C1)/A1^2", [(1e-6, 1e-4)], C1="=COS(A1)")
    assert [one.instead for one in found.findings if one.kind == "cancellation"] == ["=2*SIN(A1/2)^2/A1^2"]
    found = looked_at("=SQRT(C1-C2^2)", [DATA] * 3, C1="=SUMSQ(A1:A3)/3", C2="=AVERAGE(A1:A3)")
    assert [one.instead for one in found.findings if one.kind == "cancellation"] == ["=SQRT(DEVSQ(A1:A3)/COUNT(A1:A3))"]


def test_a_form_that_is_another_formula_is_not_proposed(looked_at):
    """It looks like a variance, and divides the sum's square by 5 where there are 3."""
    found = looked_at("=(SUMSQ(A1:A3)-SUM(A1:A3)^2/3.0000000001)/3", [DATA] * 3)
    assert all("DEVSQ" not in (one.instead or "") for one in found.findings)


def test_where_none_is_known_the_culprit_is_named_alone(looked_at):
    (one,) = [each for each in looked_at("=(A1-SIN(A1))/A1^3", [(1e-5, 1e-4)]).findings if each.kind == "cancellation"]
    assert one.what.startswith("A1-SIN(A1) is a difference of near equals")
    assert one.instead is None


def test_a_spread_that_is_all_rounding_is_wrong_though_the_number_is_nearly_right(looked_at):
    """The variance is 100 to seven digits in every trial; how it varies is below what rounding leaves."""
    formula = "=(SUMSQ(A1:A3,D1:D2)-SUM(A1:A3,D1:D2)^2/5)/4"
    near = [(1e8 + 10, 1e8 + 10 + 1e-6), (1e8, 1e8 + 1e-6), (1e8 - 10, 1e8 - 10 + 1e-6)]
    found = looked_at(formula, near, D1=1e8 + 3000.0, D2=1e8 - 3000.0)
    (one,) = [each for each in found.findings if each.kind == "cancellation"]
    assert one.level is Level.WRONG
    assert "its spread is rounding" in one.effect
    assert any("the digits of 'f' are not there: its spread is rounding" in warning for warning in found.run.warnings)


@pytest.mark.parametrize("formula", ["=SIN(A1)^2+COS(A1)^2", "=A1/A1*3", "=A1*1.1/A1"])
def test_a_constant_in_all_but_its_last_digit_is_no_spread(looked_at, formula):
    found = looked_at(formula, [(1, 2)])
    assert found.findings == ()
    assert not found.run.warnings
