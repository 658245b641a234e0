"""Known forms in whatever order their parts stand; each form proposed means the same."""

from __future__ import annotations

import itertools

import pytest
from simulated import simulated

from xlmc.analysis.studies.stability.case import Case
from xlmc.analysis.studies.stability.extent import Extent
from xlmc.analysis.studies.stability.formula_trees import Trees, factors
from xlmc.analysis.studies.stability.momentum import spin
from xlmc.analysis.studies.stability.rewriting import (
    angles_in_degrees,
    same,
    with_quadrant,
    without_cosine,
    without_quotient,
)
from xlmc.engine.engine import Target
from xlmc.excel.address import parse_address

CELLS = {
    "A1": 5.0, "A2": 3.0, "A3": 20.0, "A4": 15.0, "A5": 186.0, "A6": 190.0, "A7": 282.0, "A8": 197.0, "A9": 7.0,
    "C1": "=(A1*A3*SIN(RADIANS(A6-A7))-A2*A4*SIN(RADIANS(A7-A8)))/(A1*SIN(RADIANS(A5-A7)))",
}  # fmt: skip
NAMES = {"m_1": "S!$A$1", "m_2": "S!$A$2", "v_1": "S!$A$3", "v_2": "S!$A$4", "V": "S!$C$1"}
ONE = {"a": {"cell": "A5", "low": 181, "high": 191}, "b": {"cell": "A7", "low": 272, "high": 292}}


@pytest.fixture(scope="session")
def case(book):
    def make(formula, filters=None, **cells):
        model = book(CELLS | {"Z1": formula} | cells, ONE, {"f": "Z1"}, filters or {}, names=NAMES)
        return Case(Extent(model), simulated(model, trials=200, seed=1)), parse_address("Z1", "S")

    return make


def shown(case, cell, tree):
    return None if tree is None else f"={case.trees.text(tree, cell)}"


BETTER = "=-(v_2*SIN(RADIANS(A8-A5))+m_1/m_2*v_1*SIN(RADIANS(A6-A5)))/SIN(RADIANS(A5-A7))"
TERMS = ["m_1*v_1*COS(RADIANS(A6))", "COS(RADIANS(A8))*v_2*m_2", "-m_1*V*COS(RADIANS(A5))"]


@pytest.mark.parametrize("order", list(itertools.permutations(TERMS)))
def test_the_speed_divided_by_a_cosine(case, order):
    total = "+".join(order).replace("+-", "-")
    for formula in (f"=({total})/(m_2*COS(RADIANS(A7)))", f"=1/(COS(RADIANS(A7))*m_2)*({total})"):
        made, cell = case(formula)
        cosine = next(part for part in factors(made.lowering.graph.formulas[cell])[1] if "COS" in str(part))
        better = without_cosine(made, cell, cosine)
        assert shown(made, cell, better) == BETTER
        assert same(made, cell, better)


def test_a_speed_that_is_not_from_momentum_is_not_taken_for_it(case):
    """The pattern fits, and V is another speed: 50 digits tell."""
    made, cell = case(f"=({'+'.join(TERMS)})/(m_2*COS(RADIANS(A7)))".replace("+-", "-"), C1="=A3+1")
    cosine = next(part for part in factors(made.lowering.graph.formulas[cell])[1] if "COS" in str(part))
    assert not same(made, cell, without_cosine(made, cell, cosine))


OWN, OTHER, BEFORE = TERMS[1], TERMS[0], TERMS[2]


@pytest.mark.parametrize(
    "formula",
    [
        "=({own}+{other}{before})/(m_2*COS(RADIANS(A7))*A9)",  # two masses below
        "=({own}+{other}{before})/COS(RADIANS(A7))",  # none
        "=A9*({own}+{other}{before})/(m_2*COS(RADIANS(A7)))",  # a factor before the sum
        "=({own}+{other})/(m_2*COS(RADIANS(A7)))",  # two terms
        "=({own}+{other}{before}+A9)/(m_2*COS(RADIANS(A7)))",  # four
        "=({own}+{other}/A9{before})/(m_2*COS(RADIANS(A7)))",  # a quotient among them
        "=({own}+{other}+m_1*V*COS(RADIANS(A5)))/(m_2*COS(RADIANS(A7)))",  # nothing is subtracted
        "=({own}-{other}{before})/(m_2*COS(RADIANS(A7)))",  # two are
        "=({other}+m_1*A9*COS(RADIANS(A8)){before})/(m_2*COS(RADIANS(A7)))",  # the mass below is in none
        "=({own}+m_2*A9*COS(RADIANS(A6)){before})/(m_2*COS(RADIANS(A7)))",  # and in two
        "=({own}+A9*v_1*COS(RADIANS(A6)){before})/(m_2*COS(RADIANS(A7)))",  # no mass of the other two
        "=({own}*A9+{other}{before})/(m_2*COS(RADIANS(A7)))",  # two speeds
    ],
)
def test_what_is_no_momentum_along_an_axis(case, formula):
    made, cell = case(formula.format(own=OWN, other=OTHER, before=BEFORE))
    cosine = next(part for part in factors(made.lowering.graph.formulas[cell])[1] if "COS" in str(part))
    assert without_cosine(made, cell, cosine) is None


@pytest.mark.parametrize("extra", ["", "+A9"])
def test_a_change_of_spin(case, extra):
    turn = "m_1/A9*{}*(COS(RADIANS({}))*A3-SIN(RADIANS({}))*A4)"
    made, cell = case(f"={turn.format('v_1', 'A6', 'A6')}-{turn.format('V', 'A5', 'A5')}{extra}")
    better = spin(made.lowering.graph.formulas[cell])
    assert shown(made, cell, better) == (
        "=m_1/A9*((v_1*COS(RADIANS(A6))-V*COS(RADIANS(A5)))*v_1-(v_1*SIN(RADIANS(A6))-V*SIN(RADIANS(A5)))*v_2)" + extra
    )
    assert same(made, cell, better)


@pytest.mark.parametrize(
    ("formula", "better"),
    [
        ("=SIN(RADIANS(A5)-RADIANS(A7))*2", "=SIN(RADIANS(A5-A7))*2"),
        ("=COS(RADIANS(A5-A6)-RADIANS(A7))", "=COS(RADIANS(A5-A6-A7))"),
        ("=SIN(RADIANS(A5-A7))", None),
        ("=RADIANS(A5)+RADIANS(A7)", None),
    ],
)
def test_differences_of_angles(case, formula, better):
    made, cell = case(formula)
    tree = angles_in_degrees(made.lowering.graph.formulas[cell])
    assert shown(made, cell, tree) == better
    assert tree is None or same(made, cell, tree)


@pytest.mark.parametrize(
    ("formula", "better"),
    [
        ("=ATAN(A5/A7)", "=ATAN2(A7,A5)"),
        ("=DEGREES(ATAN(A5/A7))", "=DEGREES(ATAN2(A7,A5))"),
        ("=90-DEGREES(ATAN(A5/A7))", "=180-MOD(180-(90-DEGREES(ATAN2(A7,A5))),360)"),
        ("=DEGREES(ATAN(A5/A7))-A6", "=180-MOD(180-(DEGREES(ATAN2(A7,A5))-A6),360)"),
    ],
)
def test_the_quadrant(case, formula, better):
    made, cell = case(formula)
    part = next(part for part in made.trees.parts(cell) if getattr(part, "name", "") == "ATAN")
    (ratio,) = part.arguments
    tree = with_quadrant(made.lowering.graph.formulas[cell], part, ratio.left, ratio.right)
    assert shown(made, cell, tree) == better


def test_a_filter_without_a_quotient_decides_alike(case, book):
    given = {"cell": "Z1", "at_least": -0.5, "below": 0.25}
    made, cell = case("=(A5-186)/(A7-282)", {"e": given})
    (filter_,) = made.model.filters
    better = without_quotient(made, filter_, made.lowering.graph.formulas[cell])
    place = made.lowering.target(Target(better, cell))
    from xlmc.engine.passes.random_rounding import closure, evaluate, numbers_of

    result = numbers_of(evaluate(made.dag, closure(made.dag, [place]), made.draws)[place], made.n)
    e = made.number(made.node[cell])
    assert (result == ((e >= -0.5) & (e < 0.25))).all()
    assert 0 < result.sum() < made.n


def test_text_has_brackets_where_they_are_needed(case):
    products = ["A1-(A5-A7)", "A1/(A5*A7)", "-(A5+A7)^2", "(A5+A7)*A1%", "A5/A7/A9", "A1^(A5/A7)"]
    for formula in (*products, "2*(A5>A7)", 'A5&"x"'):
        made, cell = case(f"={formula}")
        text = Trees(made.model).text(made.lowering.graph.formulas[cell], cell)
        assert text.replace("m_1", "A1") == formula
