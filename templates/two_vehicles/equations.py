"""Momentum and run-out, equation by equation: SAE 2001-01-3347, in forms that keep their digits.

Angles are subtracted in degrees, before RADIANS(), so that the difference is exact. As printed, (16) divides by cos α2
and (19) to (21) subtract nearly equal velocities; the primed forms here do neither.
"""

from __future__ import annotations

from templates.description import Equation

__all__ = ["CENTRES", "DELTA_V", "IMPACT_SPEEDS", "MASSES", "RUN_OUT"]

MASSES = (Equation("[m_{j}|]", "m{j}", "{who} mass", "lb·s²/ft", "w_{j}/g", "weight / g"),)

RUN_OUT = (
    Equation(
        "V{j}_f",
        "V{j}f",
        "{who} post-impact speed",
        "[ft|m]/s",
        "SQRT(2*g*f_{j}*s_{j})",
        "run-out to rest",
        "<Not stated in the paper: constant deceleration f·g to rest.|>",
    ),
)

CENTRES = (
    Equation(
        "a_{j}",
        "a{j}",
        "{who} CG, X coordinate",
        "[ft|m]",
        "-(x_{j}*COS(RADIANS(alpha_{j}))+y_{j}*SIN(RADIANS(alpha_{j})))[/in_per_ft|]",
        "Figure 5",
        "<The impact centre (x forward, y right of the CG), turned by the heading and seen from itself.|>",
    ),
    Equation(
        "b_{j}",
        "b{j}",
        "{who} CG, Y coordinate",
        "[ft|m]",
        "-(x_{j}*SIN(RADIANS(alpha_{j}))-y_{j}*COS(RADIANS(alpha_{j})))[/in_per_ft|]",
        "Figure 5",
    ),
)

IMPACT_SPEEDS = (
    Equation(
        "delta_alpha",
        "δ",
        "Angle between the approaches",
        "deg",
        "alpha_1-alpha_2",
        "definition",
        "Subtracted in degrees, where the difference is exact.",
        number_format="0.00",
    ),
    Equation("sin_delta", "sin δ", "Its sine", "", "SIN(RADIANS(delta_alpha))", "definition"),
    Equation(
        "p_{j}",
        "p{j}",
        "{who} momentum after, across its approach",
        "[lb·s|N·s]",
        "m_{j}*V{j}_f*SIN(RADIANS(beta_{j}-alpha_{j}))",
        "definition",
        "<All of it came from the impact: before, the vehicle had no momentum across its own approach direction.|>",
        number_format="#,##0.00",
    ),
    Equation(
        "V{j}_i",
        "V{j}i",
        "{who} impact speed",
        "[ft|m]/s",
        "<|->(V{j}_f*SIN(RADIANS(beta_{j}-alpha_{k}))+p_{k}/m_{j})/sin_delta",
        "eq (<15|16>′)",
        "<Eq (15) with p2 in place of its second term.|Eq (16) without V1i and without the division by cos α2, "
        "which gives a plausible wrong speed at α2 = 90° or 270°.>",
    ),
)

DELTA_V = (
    Equation(
        "P_along",
        "Pu",
        "Impulse along the bisector of the approaches",
        "[lb·s|N·s]",
        "-(p_1+p_2)/(2*SIN(RADIANS(delta_alpha/2)))",
        "eqs (1), (2), (5), (6)",
        "The impulse that gives both vehicles their p1 and p2, solved in the frame of the bisector.",
        number_format="#,##0.00",
    ),
    Equation(
        "P_across",
        "Pw",
        "Impulse across the bisector",
        "[lb·s|N·s]",
        "(p_1-p_2)/(2*COS(RADIANS(delta_alpha/2)))",
        "eqs (1), (2), (5), (6)",
        number_format="#,##0.00",
    ),
    Equation(
        "mean_alpha",
        "ᾱ",
        "Direction of the bisector",
        "deg",
        "(alpha_1+alpha_2)/2",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "P_x",
        "Px",
        "Impulse on «1», X",
        "[lb·s|N·s]",
        "P_along*COS(RADIANS(mean_alpha))-P_across*SIN(RADIANS(mean_alpha))",
        "eq (5)",
        "«2» receives the opposite impulse.",
        number_format="#,##0.00",
    ),
    Equation(
        "P_y",
        "Py",
        "Impulse on «1», Y",
        "[lb·s|N·s]",
        "P_along*SIN(RADIANS(mean_alpha))+P_across*COS(RADIANS(mean_alpha))",
        "eq (6)",
        number_format="#,##0.00",
    ),
    Equation(
        "P_total",
        "P",
        "Impulse, magnitude",
        "[lb·s|N·s]",
        "SQRT(P_along^2+P_across^2)",
        "eq (19′)",
        number_format="#,##0.00",
    ),
    Equation(
        "dV_{j}",
        "ΔV{j}",
        "{who} change in velocity",
        "[ft|m]/s",
        "P_total/m_{j}",
        "eq (19′)",
        "<From the impulse: no subtraction of nearly equal velocities.|>",
    ),
    Equation("dV{j}_x", "ΔV{j}x", "{who} change in velocity, X", "[ft|m]/s", "<|->P_x/m_{j}", "eq (20′)"),
    Equation("dV{j}_y", "ΔV{j}y", "{who} change in velocity, Y", "[ft|m]/s", "<|->P_y/m_{j}", "eq (21′)"),
)
