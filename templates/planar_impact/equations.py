"""What the planar impact model adds to momentum: yaw, and restitution at the impact centre (SAE 2001-01-3347)."""

from __future__ import annotations

from templates.description import Equation, Section
from templates.two_vehicles.equations import CENTRES, DELTA_V, IMPACT_SPEEDS, MASSES, RUN_OUT
from templates.two_vehicles.run_out import segmented_run_out
from templates.vehicles import for_both

__all__ = ["model_sections"]

_YAW = (
    Equation(
        "d_omega_{j}",
        "Δω{j}",
        "{who} change in yaw rate",
        "rad/s",
        "<(P_x*b_1-P_y*a_1)|(P_y*a_2-P_x*b_2)>/I_{j}",
        "eq (<17|18>′)",
        "<Eq (3): one moment of the impulse instead of the difference of two large terms.|"
        "Eq (4) with its sign corrected: «2» receives the opposite impulse (as in (18)).>",
    ),
    Equation("omega{j}_i", "ω{j}i", "{who} yaw rate before", "rad/s", "RADIANS(omega{j}_deg)", "input"),
    Equation("omega{j}_f", "ω{j}f", "{who} yaw rate after", "rad/s", "omega{j}_i+d_omega_{j}", "eqs (17), (18)"),
)

_RESTITUTION = (
    Equation(
        "V_sep_x",
        "Vsep,x",
        "Separation speed, X",
        "[ft|m]/s",
        "V1_f*COS(RADIANS(beta_1))+b_1*omega1_f-V2_f*COS(RADIANS(beta_2))-b_2*omega2_f",
        "eq (11)",
    ),
    Equation(
        "V_sep_y",
        "Vsep,y",
        "Separation speed, Y",
        "[ft|m]/s",
        "V2_f*SIN(RADIANS(beta_2))-a_2*omega2_f-V1_f*SIN(RADIANS(beta_1))+a_1*omega1_f",
        "eq (12)",
    ),
    Equation(
        "V_close_x",
        "Vclose,x",
        "Closing speed, X",
        "[ft|m]/s",
        "V2_i*COS(RADIANS(alpha_2))+b_2*omega2_i-V1_i*COS(RADIANS(alpha_1))-b_1*omega1_i",
        "eq (13)",
    ),
    Equation(
        "V_close_y",
        "Vclose,y",
        "Closing speed, Y",
        "[ft|m]/s",
        "V1_i*SIN(RADIANS(alpha_1))-a_1*omega1_i-V2_i*SIN(RADIANS(alpha_2))+a_2*omega2_i",
        "eq (14)",
    ),
    Equation(
        "V_sep_n",
        "Vsep,n",
        "Separation speed, normal",
        "[ft|m]/s",
        "V_sep_x*SIN(RADIANS(gamma_t))+V_sep_y*COS(RADIANS(gamma_t))",
        "eq (9), above the line",
    ),
    Equation(
        "V_close_n",
        "Vclose,n",
        "Closing speed, normal",
        "[ft|m]/s",
        "V_close_x*SIN(RADIANS(gamma_t))+V_close_y*COS(RADIANS(gamma_t))",
        "eq (9), below the line",
    ),
    Equation(
        "V_sep_t",
        "Vsep,t",
        "Separation speed, tangential",
        "[ft|m]/s",
        "V_sep_y*SIN(RADIANS(gamma_t))-V_sep_x*COS(RADIANS(gamma_t))",
        "eq (10), above the line",
    ),
    Equation(
        "V_close_t",
        "Vclose,t",
        "Closing speed, tangential",
        "[ft|m]/s",
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


def model_sections(*, more: bool) -> tuple[Section, ...]:
    """The model of two vehicles, in the order of the paper.

    Args:
        more: with run-outs of several segments.
    """
    patterns = {
        "1  Masses, run-out speeds, centres of gravity": MASSES + (segmented_run_out() if more else RUN_OUT) + CENTRES,
        "2  Impact speeds, by conservation of momentum": IMPACT_SPEEDS,
        "3  Impulse and change in velocity": DELTA_V,
        "4  Change in yaw rate": _YAW,
        "5  Restitution at the impact centre (judges a solution; not needed to find it)": _RESTITUTION,
    }
    return tuple(Section(title, for_both(rows)) for title, rows in patterns.items())
