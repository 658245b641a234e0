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
    "spread": "a − b",
    "fast": "v (km/h)",
}


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("SIN(RADIANS(beta_1-alpha_1))", "sin(β1 − α1)"),
        ("SQRT(2*g*V1_f)", "√(2 · g · V1f)"),
        ("-P_x/m_1", "−Px/m1"),
        ("-(a+b)/2", "−(a + b)/2"),
        ("DEGREES(ATAN2(-a,-b))", "deg(atan2(−b, −a))"),
        ("ATAN2(MAX(a,b),MIN(b,ATAN2(a,g)))", "atan2(min(b, atan2(g, a)), max(a, b))"),
        ("TAN(RADIANS(a))^2", "tan(a)²"),
        ("SIN(RADIANS((a-b)/2))", "sin((a − b)/2)"),
        ("COS(RADIANS(a)/2)", "cos(rad(a)/2)"),
        ("IF(N(a)>0,N(b)/2,0)", "if(a > 0, b/2, 0)"),
        ("IF(a=1,b,-b)", "if(a = 1, b, −b)"),
        ("a*spread/b", "a · (a − b)/b"),
        ("spread", "a − b"),
        ("2*fast", "2 · v (km/h)"),
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
