from __future__ import annotations

import pytest

from templates.notation import printed

NOTATION = {
    "alpha_1": "α1",
    "beta_1": "β1",
    "V1_f": "V1f",
    "m_1": "m1",
    "g": "g",
    "P_x": "Px",
    "a": "a",
    "b": "b",
    "Check_a": "",
}


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("SIN(RADIANS(beta_1-alpha_1))", "sin(β1 − α1)"),
        ("SQRT(2*g*V1_f)", "√(2 · g · V1f)"),
        ("-P_x/m_1", "−Px/m1"),
        ("-(a+b)/2", "−(a + b)/2"),
        ("DEGREES(ATAN2(-a,-b))", "deg(atan2(−a, −b))"),
        ("a^2+b^2", "a² + b²"),
        ("RADIANS(a)", "rad(a)"),
        ("AND(a>0,b<=1)", "and(a > 0, b ≤ 1)"),
        ("a>=COS(RADIANS(10))", "a ≥ cos(10°)"),
        ("IF(a<>0,b<1,TRUE)", "if(a ≠ 0, b < 1, true)"),
        ("AND(a>=-1,b<-a)", "and(a ≥ −1, b < −a)"),
        ("AND(Check_a,a<b)", "and(Check_a, a < b)"),
    ],
)
def test_formula_is_printed_as_the_paper_prints(formula, expected):
    assert printed(formula, NOTATION) == expected
