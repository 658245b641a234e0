"""The planar impact model, equation by equation: SAE 2001-01-3347, eqs (1) to (22), in forms that keep their digits.

Angles are subtracted in degrees, before RADIANS(), so that the difference is exact. As printed, (16) divides by cos α2
and (17) to (21) subtract nearly equal velocities; the primed forms here do neither.
"""

from __future__ import annotations

from templates.description import Equation, Section
from templates.vehicles import for_both

__all__ = ["model_sections"]

_RUN_OUT = (
    Equation("m_{j}", "m{j}", "{who} mass", "lb·s²/ft", "w_{j}/g", "weight / g"),
    Equation(
        "V{j}_f",
        "V{j}f",
        "{who} post-impact speed",
        "ft/s",
        "SQRT(2*g*f_{j}*s_{j})",
        "run-out to rest",
        "<Not stated in the paper: constant deceleration f·g to rest.|>",
    ),
    Equation(
        "a_{j}",
        "a{j}",
        "{who} CG, X coordinate",
        "ft",
        "-(x_{j}*COS(RADIANS(alpha_{j}))+y_{j}*SIN(RADIANS(alpha_{j})))/in_per_ft",
        "Figure 5",
        "<The impact centre (x forward, y right of the CG, inches), turned by the heading and seen from itself.|>",
    ),
    Equation(
        "b_{j}",
        "b{j}",
        "{who} CG, Y coordinate",
        "ft",
        "-(x_{j}*SIN(RADIANS(alpha_{j}))-y_{j}*COS(RADIANS(alpha_{j})))/in_per_ft",
        "Figure 5",
    ),
)

_IMPACT_SPEEDS = (
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
        "lb·s",
        "m_{j}*V{j}_f*SIN(RADIANS(beta_{j}-alpha_{j}))",
        "definition",
        "<All of it came from the impact: before, the vehicle had no momentum across its own approach direction.|>",
        number_format="#,##0.00",
    ),
    Equation(
        "V{j}_i",
        "V{j}i",
        "{who} impact speed",
        "ft/s",
        "<|->(V{j}_f*SIN(RADIANS(beta_{j}-alpha_{k}))+p_{k}/m_{j})/sin_delta",
        "eq (<15|16>′)",
        "<Eq (15) with p2 in place of its second term.|Eq (16) without V1i and without the division by cos α2, "
        "which gives a plausible wrong speed at α2 = 90° or 270°.>",
    ),
)

_DELTA_V = (
    Equation(
        "P_along",
        "Pu",
        "Impulse along the bisector of the approaches",
        "lb·s",
        "-(p_1+p_2)/(2*SIN(RADIANS(delta_alpha/2)))",
        "eqs (1), (2), (5), (6)",
        "The impulse that gives both vehicles their p1 and p2, solved in the frame of the bisector.",
        number_format="#,##0.00",
    ),
    Equation(
        "P_across",
        "Pw",
        "Impulse across the bisector",
        "lb·s",
        "(p_1-p_2)/(2*COS(RADIANS(delta_alpha/2)))",
        "eqs (1), (2), (5), (6)",
        number_format="#,##0.00",
    ),
    Equation(
        "mean_alpha",
        "μ",
        "Direction of the bisector",
        "deg",
        "(alpha_1+alpha_2)/2",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "P_x",
        "Px",
        "Impulse on vehicle 1, X",
        "lb·s",
        "P_along*COS(RADIANS(mean_alpha))-P_across*SIN(RADIANS(mean_alpha))",
        "eq (5)",
        "Vehicle 2 receives the opposite impulse.",
        number_format="#,##0.00",
    ),
    Equation(
        "P_y",
        "Py",
        "Impulse on vehicle 1, Y",
        "lb·s",
        "P_along*SIN(RADIANS(mean_alpha))+P_across*COS(RADIANS(mean_alpha))",
        "eq (6)",
        number_format="#,##0.00",
    ),
    Equation(
        "P_total",
        "P",
        "Impulse, magnitude",
        "lb·s",
        "SQRT(P_along^2+P_across^2)",
        "eq (19′)",
        number_format="#,##0.00",
    ),
    Equation(
        "dV_{j}",
        "ΔV{j}",
        "{who} change in velocity",
        "ft/s",
        "P_total/m_{j}",
        "eq (19′)",
        "<From the impulse: no subtraction of nearly equal velocities.|>",
    ),
    Equation("dV{j}_x", "ΔV{j}x", "{who} change in velocity, X", "ft/s", "<|->P_x/m_{j}", "eq (20′)"),
    Equation("dV{j}_y", "ΔV{j}y", "{who} change in velocity, Y", "ft/s", "<|->P_y/m_{j}", "eq (21′)"),
)

_YAW = (
    Equation(
        "d_omega_{j}",
        "Δω{j}",
        "{who} change in yaw rate",
        "rad/s",
        "<(P_x*b_1-P_y*a_1)|(P_y*a_2-P_x*b_2)>/I_{j}",
        "eq (<17|18>′)",
        "<Eq (3): one moment of the impulse instead of the difference of two large terms.|"
        "Eq (4) with its sign corrected: vehicle 2 receives the opposite impulse (as in (18)).>",
    ),
    Equation("omega{j}_i", "ω{j}i", "{who} yaw rate before", "rad/s", "RADIANS(omega{j}_deg)", "input"),
    Equation("omega{j}_f", "ω{j}f", "{who} yaw rate after", "rad/s", "omega{j}_i+d_omega_{j}", "eqs (17), (18)"),
)

_RESTITUTION = (
    Equation(
        "V_sep_x",
        "Vsep,x",
        "Separation speed, X",
        "ft/s",
        "V1_f*COS(RADIANS(beta_1))+b_1*omega1_f-V2_f*COS(RADIANS(beta_2))-b_2*omega2_f",
        "eq (11)",
    ),
    Equation(
        "V_sep_y",
        "Vsep,y",
        "Separation speed, Y",
        "ft/s",
        "V2_f*SIN(RADIANS(beta_2))-a_2*omega2_f-V1_f*SIN(RADIANS(beta_1))+a_1*omega1_f",
        "eq (12)",
    ),
    Equation(
        "V_close_x",
        "Vclose,x",
        "Closing speed, X",
        "ft/s",
        "V2_i*COS(RADIANS(alpha_2))+b_2*omega2_i-V1_i*COS(RADIANS(alpha_1))-b_1*omega1_i",
        "eq (13)",
    ),
    Equation(
        "V_close_y",
        "Vclose,y",
        "Closing speed, Y",
        "ft/s",
        "V1_i*SIN(RADIANS(alpha_1))-a_1*omega1_i-V2_i*SIN(RADIANS(alpha_2))+a_2*omega2_i",
        "eq (14)",
    ),
    Equation(
        "V_sep_n",
        "Vsep,n",
        "Separation speed, normal",
        "ft/s",
        "V_sep_x*SIN(RADIANS(gamma_t))+V_sep_y*COS(RADIANS(gamma_t))",
        "eq (9), above the line",
    ),
    Equation(
        "V_close_n",
        "Vclose,n",
        "Closing speed, normal",
        "ft/s",
        "V_close_x*SIN(RADIANS(gamma_t))+V_close_y*COS(RADIANS(gamma_t))",
        "eq (9), below the line",
    ),
    Equation(
        "V_sep_t",
        "Vsep,t",
        "Separation speed, tangential",
        "ft/s",
        "V_sep_y*SIN(RADIANS(gamma_t))-V_sep_x*COS(RADIANS(gamma_t))",
        "eq (10), above the line",
    ),
    Equation(
        "V_close_t",
        "Vclose,t",
        "Closing speed, tangential",
        "ft/s",
        "V_close_y*SIN(RADIANS(gamma_t))-V_close_x*COS(RADIANS(gamma_t))",
        "eq (10), below the line",
    ),
    Equation(
        "e_n",
        "e_n",
        "Restitution, normal",
        "",
        "V_sep_n/V_close_n",
        "eq (9)",
        "Eqs (7) and (8) as printed need opposite handedness of tangent and normal; (9) to (14) are right.",
    ),
    Equation(
        "e_t",
        "e_t",
        "Restitution, tangential",
        "",
        "V_sep_t/V_close_t",
        "eq (10)",
        "The closing speed below the line can cross zero: extreme values are expected, and the filter removes them.",
    ),
)


def model_sections(vehicles: tuple[str, str]) -> tuple[Section, ...]:
    """The model of two vehicles called so, in the order of the paper."""
    patterns = {
        "1  Masses, run-out speeds, centres of gravity": _RUN_OUT,
        "2  Impact speeds, by conservation of momentum": _IMPACT_SPEEDS,
        "3  Impulse and change in velocity": _DELTA_V,
        "4  Change in yaw rate": _YAW,
        "5  Restitution at the impact centre (judges a solution; not needed to find it)": _RESTITUTION,
    }
    return tuple(Section(title, for_both(vehicles, rows)) for title, rows in patterns.items())
