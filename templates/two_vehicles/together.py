"""One switch for two vehicles that stuck together: the second leaves the impact as the first does."""

from __future__ import annotations

import re
from dataclasses import replace

from templates.description import Curve, Diagram, Equation, Input, Section

__all__ = ["SWITCH", "drawn_together", "leave_together"]

SWITCH = Input(
    "together",
    "",
    "Stuck together after the impact: 0 = no, 1 = yes",
    "",
    0,
    "1: «2» leaves with the speed and direction of «1»; its own departure angle, travel and friction have no effect",
    number_format="0",
    choices=(0, 1),
)

_DIRECTION = Equation(
    "beta_out_2",
    "β2,out",
    "«2» departure angle, or that of both",
    "deg",
    "IF(together=1,beta_1,beta_2)",
    "input",
    number_format="0.00",
)
_ANGLE, _TRAVEL = re.compile(r"\bbeta_2\b"), re.compile(r"\b(s|travel)_2\b")


def leave_together(sections: tuple[Section, ...]) -> tuple[Section, ...]:
    """The sections with the switch in them: in the first, speed and direction of vehicle 2 follow it."""
    first, *others = (replace(each, equations=tuple(map(_switched, each.equations))) for each in sections)
    return replace(first, equations=(*first.equations, _DIRECTION)), *others


def _switched(equation: Equation) -> Equation:
    formula = _ANGLE.sub("beta_out_2", equation.formula)
    if equation.symbol == "V2_f":
        formula = f"IF(together=1,V1_f,{formula})"
    return replace(equation, formula=formula)


def drawn_together(diagram: Diagram) -> Diagram:
    """The diagram with the switch in it."""
    return replace(diagram, curves=tuple(map(_switched_curve, diagram.curves)))


def _switched_curve(curve: Curve) -> Curve:
    def switched(formula: str) -> str:
        return _TRAVEL.sub(r"IF(together=1,\1_1,\1_2)", _ANGLE.sub("beta_out_2", formula))

    return replace(curve, points=tuple((switched(x), switched(y)) for x, y in curve.points))
