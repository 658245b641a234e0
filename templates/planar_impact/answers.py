"""What the planar impact model answers, and the checks that tell a possible impact from an impossible one."""

from __future__ import annotations

from dataclasses import replace

from templates.description import Equation, Role, Section
from templates.vehicles import for_both

__all__ = ["ALL_CHECKS", "answer_sections"]

ALL_CHECKS = "checks_hold"

_ANSWERS = (
    Equation(
        "dV{j}_mph",
        "ΔV{j}",
        "{who} delta-V",
        "mph",
        "dV_{j}*s_per_hour/ft_per_mile",
        "eq (19′)",
        role=Role.ANSWER,
        number_format="0.00",
    ),
    Equation(
        "V{j}_mph",
        "V{j}i",
        "{who} impact speed",
        "mph",
        "V{j}_i*s_per_hour/ft_per_mile",
        "eq (<15|16>′)",
        role=Role.ANSWER,
        number_format="0.00",
    ),
)

_MORE = (
    Equation(
        "closing_mph",
        "Vc",
        "Closing speed of the centres of gravity",
        "mph",
        "SQRT((V1_i*COS(RADIANS(alpha_1))-V2_i*COS(RADIANS(alpha_2)))^2"
        "+(V1_i*SIN(RADIANS(alpha_1))-V2_i*SIN(RADIANS(alpha_2)))^2)*s_per_hour/ft_per_mile",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "dV{j}_long",
        "ΔV{j} long",
        "{who} delta-V along its heading",
        "mph",
        "(dV{j}_x*COS(RADIANS(alpha_{j}))+dV{j}_y*SIN(RADIANS(alpha_{j})))*s_per_hour/ft_per_mile",
        "definition",
        "<Negative: slowed. This is what an event data recorder calls longitudinal.|>",
        number_format="0.00",
    ),
    Equation(
        "dV{j}_left",
        "ΔV{j} left",
        "{who} delta-V to its left",
        "mph",
        "(dV{j}_y*COS(RADIANS(alpha_{j}))-dV{j}_x*SIN(RADIANS(alpha_{j})))*s_per_hour/ft_per_mile",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "PDOF_{j}",
        "PDOF{j}",
        "{who} PDOF, counter-clockwise from the front",
        "deg",
        "DEGREES(ATAN2(-dV{j}_long,-dV{j}_left))",
        "eq (23′)",
        "<Direction the blow came from, −180 to 180, left side positive. Eq (23)'s arctangent loses the quadrant. "
        "Excel's ATAN2 takes x first.|>",
        number_format="0.0",
    ),
    Equation(
        "PDOF{j}_cw",
        "PDOF{j} cw",
        "{who} PDOF, clockwise from the front",
        "deg",
        "MOD(-PDOF_{j},360)",
        "convention",
        "<0 to 360: right side 90, left side 270.|>",
        number_format="0.0",
    ),
    Equation(
        "PDOF{j}_clock",
        "PDOF{j} clock",
        "{who} PDOF, clock direction",
        "o'clock",
        "MOD(ROUND(PDOF{j}_cw/30,0)+11,12)+1",
        "convention",
        "<Front 12, right side 3, left side 9.|>",
        number_format="0",
    ),
    Equation(
        "d_omega{j}_deg",
        "Δω{j}",
        "{who} change in yaw rate",
        "deg/s",
        "DEGREES(d_omega_{j})",
        "eq (<17|18>′)",
        "<Counter-clockwise positive.|>",
        number_format="0.0",
    ),
    Equation(
        "E_before",
        "Ei",
        "Kinetic energy before",
        "ft·lb",
        "(m_1*V1_i^2+m_2*V2_i^2+I_1*omega1_i^2+I_2*omega2_i^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_after",
        "Ef",
        "Kinetic energy after",
        "ft·lb",
        "(m_1*V1_f^2+m_2*V2_f^2+I_1*omega1_f^2+I_2*omega2_f^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost in the impact",
        "ft·lb",
        "E_before-E_after",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "d_{j}",
        "d{j}",
        "{who} CG, normal coordinate",
        "ft",
        "b_{j}*COS(RADIANS(gamma_t))-a_{j}*SIN(RADIANS(gamma_t))",
        "notation",
    ),
    Equation(
        "approach_mph",
        "Vn",
        "Normal closing speed",
        "mph",
        "V_close_n*SIGN(d_2-d_1)*s_per_hour/ft_per_mile",
        "eq (9)",
        "Positive when the contact points approach each other, whichever way γ is drawn.",
        number_format="0.00",
    ),
)

_CHECKS = (
    Equation(
        "check_energy",
        "",
        "The impact takes energy away",
        "",
        "E_lost>=0",
        "physics",
        "FALSE: the vehicles leave with more energy than they brought. Look for a wrong angle or travel distance.",
    ),
    Equation(
        "check_closing",
        "",
        "The contact points approach each other",
        "",
        "approach_mph>0",
        "physics",
        "FALSE: the vehicles move apart before they touch. Look at γ, the impact centre and the approach angles.",
    ),
    Equation(
        "check_angles",
        "",
        "The approaches are at least 10° from parallel",
        "",
        "ABS(sin_delta)>=SIN(RADIANS(10))",
        "conditioning",
        "FALSE: momentum alone is blind here. 1° of β1 moves V1i by 9 % at δ = 10° and 94 % at 1°; use crush energy.",
    ),
    Equation(
        "check_forward",
        "",
        "Both vehicles move forward",
        "",
        "AND(V1_i>0,V2_i>0)",
        "physics",
        "FALSE: a negative impact speed. The approach and departure angles contradict each other.",
    ),
    Equation(
        "check_restitution",
        "",
        "Both restitutions lie between −1 and 1",
        "",
        "AND(ABS(e_n)<=1,ABS(e_t)<=1)",
        "eqs (9), (10)",
        "FALSE: no impact behaves so. The filters reject such trials; a base case should not be one.",
    ),
    Equation(
        ALL_CHECKS,
        "",
        "All checks hold",
        "",
        "AND(check_energy,check_closing,check_angles,check_forward,check_restitution)",
    ),
)


def answer_sections(vehicles: tuple[str, str]) -> tuple[Section, ...]:
    """The answers, what else a report states, and the checks."""
    checks = tuple(replace(row, role=Role.CHECK, number_format="General") for row in _CHECKS)
    return (
        Section("6  Answers (the forecasts)", for_both(vehicles, _ANSWERS)),
        Section("7  Direction of force, yaw, energy", for_both(vehicles, _MORE)),
        Section("8  Physics checks, at the base case", checks),
    )
