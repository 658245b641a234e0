"""What a momentum solution answers: speeds, delta-V, the direction of the force."""

from __future__ import annotations

from templates.description import Equation, Role

__all__ = ["ANSWERS", "APPROACH", "DELTA_V_ANSWER", "FORCE", "ROTATION"]

DELTA_V_ANSWER = Equation(
    "dV{j}_[mph|kmh]",
    "ΔV{j} ([mph|km/h])",
    "{who} delta-V",
    "[mph|km/h]",
    "dV_{j}*s_per_hour/[ft_per_mile|m_per_km]",
    "eq (19′)",
    role=Role.ANSWER,
    number_format="0.00",
)

ANSWERS = (
    DELTA_V_ANSWER,
    Equation(
        "V{j}_[mph|kmh]",
        "V{j}i ([mph|km/h])",
        "{who} impact speed",
        "[mph|km/h]",
        "V{j}_i*s_per_hour/[ft_per_mile|m_per_km]",
        "eq (<15|16>′)",
        role=Role.ANSWER,
        number_format="0.00",
    ),
)

FORCE = (
    Equation(
        "closing_[mph|kmh]",
        "Vc",
        "Closing speed of the centres of gravity",
        "[mph|km/h]",
        "SQRT((V1_i*COS(RADIANS(alpha_1))-V2_i*COS(RADIANS(alpha_2)))^2"
        "+(V1_i*SIN(RADIANS(alpha_1))-V2_i*SIN(RADIANS(alpha_2)))^2)*s_per_hour/[ft_per_mile|m_per_km]",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "dV{j}_long",
        "ΔV{j} long",
        "{who} delta-V along its heading",
        "[mph|km/h]",
        "(dV{j}_x*COS(RADIANS(alpha_{j}))+dV{j}_y*SIN(RADIANS(alpha_{j})))*s_per_hour/[ft_per_mile|m_per_km]",
        "definition",
        "<Negative: slowed. This is what an event data recorder calls longitudinal.|>",
        number_format="0.00",
    ),
    Equation(
        "dV{j}_right",
        "ΔV{j} right",
        "{who} delta-V to its right",
        "[mph|km/h]",
        "(dV{j}_x*SIN(RADIANS(alpha_{j}))-dV{j}_y*COS(RADIANS(alpha_{j})))*s_per_hour/[ft_per_mile|m_per_km]",
        "definition",
        "<Negative: pushed to its left. y to the right, as SAE J670, SAE J211 and 49 CFR 563.5 count.|>",
        number_format="0.00",
    ),
    Equation(
        "PDOF_{j}",
        "PDOF{j}",
        "{who} PDOF, counter-clockwise from the front",
        "deg",
        "DEGREES(ATAN2(-dV{j}_long,dV{j}_right))",
        "eq (23′)",
        "<Direction the blow came from, −180 to 180, left side positive. Eq (23)'s arctangent loses the quadrant. "
        "Excel's ATAN2 takes x first; printed, as in mathematics, y is first.|>",
        number_format="0.0",
    ),
    Equation(
        "PDOF{j}_cw",
        "PDOF{j} cw",
        "{who} PDOF, clockwise from the front",
        "deg",
        "MOD(-PDOF_{j},360)",
        "convention",
        "<As reports and CDC count, 0 to 360: right side 90, left side 270.|>",
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
)

ROTATION = (
    Equation(
        "d_omega{j}_deg",
        "Δω{j} (deg/s)",
        "{who} change in yaw rate",
        "deg/s",
        "DEGREES(d_omega_{j})",
        "eq (<17|18>′)",
        "<Counter-clockwise positive, seen from above; SAE J670 counts clockwise.|>",
        number_format="0.0",
    ),
    Equation(
        "E_before",
        "Ei",
        "Kinetic energy before",
        "[ft·lb|J]",
        "(m_1*V1_i^2+m_2*V2_i^2+I_1*omega1_i^2+I_2*omega2_i^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_after",
        "Ef",
        "Kinetic energy after",
        "[ft·lb|J]",
        "(m_1*V1_f^2+m_2*V2_f^2+I_1*omega1_f^2+I_2*omega2_f^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost in the impact",
        "[ft·lb|J]",
        "E_before-E_after",
        "definition",
        number_format="#,##0",
    ),
)

APPROACH = (
    Equation(
        "side",
        "side",
        "Side of the contact surface that «2» lies on",
        "",
        "IF(ABS(d_2-d_1)>0.000000001,SIGN(d_2-d_1),SIGN(V_close_n))",
        "convention",
        "1: that of the normal n; −1: the other. In a central impact, both centres of gravity at the impact centre, "
        "the vehicles are points and close in from whichever side they come.",
        number_format="0",
    ),
    Equation(
        "approach_[mph|kmh]",
        "Vn",
        "Normal closing speed",
        "[mph|km/h]",
        "V_close_n*side*s_per_hour/[ft_per_mile|m_per_km]",
        "eq (9)",
        "Positive when the contact points approach each other, whichever way γ is drawn.",
        number_format="0.00",
    ),
)
