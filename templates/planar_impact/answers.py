"""What the planar impact model answers beside momentum, and its checks: a possible impact, or an impossible one."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import Equation, Section
from templates.two_vehicles.answers import ANSWERS, FORCE
from templates.two_vehicles.checks import ANGLES, ENERGY, FORWARD
from templates.two_vehicles.options import duration_section, turn_section
from templates.vehicles import for_both

__all__ = ["answer_sections"]

_YAW_AND_ENERGY = (
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
    Equation(
        "d_{j}",
        "d{j}",
        "{who} CG, normal coordinate",
        "[ft|m]",
        "b_{j}*COS(RADIANS(gamma_t))-a_{j}*SIN(RADIANS(gamma_t))",
        "notation",
    ),
    Equation(
        "approach_[mph|kmh]",
        "Vn",
        "Normal closing speed",
        "[mph|km/h]",
        "V_close_n*SIGN(d_2-d_1)*s_per_hour/[ft_per_mile|m_per_km]",
        "eq (9)",
        "Positive when the contact points approach each other, whichever way γ is drawn.",
        number_format="0.00",
    ),
)

_CLOSING = check(
    "check_closing",
    "The contact points approach each other",
    "approach_[mph|kmh]>0",
    "physics",
    "FALSE: the vehicles move apart before they touch. Look at γ, the impact centre and the approach angles.",
)
_BOUNDS = check(
    "check_restitution",
    "Both restitutions lie between −1 and 1",
    "AND(ABS(e_n)<=1,ABS(e_t)<=1)",
    "eqs (9), (10)",
    "FALSE: no impact behaves so. The filters reject such trials; a base case should not be one.",
)


def answer_sections(vehicles: tuple[str, str], *, turning: bool) -> tuple[Section, ...]:
    """The answers, what else a report states, the optional rows, and the checks.

    Args:
        vehicles: what to call them.
        turning: give the rows of a turning vehicle too.
    """
    optional = (duration_section(8, vehicles), *((turn_section(9, vehicles),) if turning else ()))
    return (
        Section("6  Answers (the forecasts)", for_both(vehicles, ANSWERS)),
        Section("7  Direction of force, yaw, energy", for_both(vehicles, FORCE + _YAW_AND_ENERGY)),
        *optional,
        checks_section(8 + len(optional), ENERGY, _CLOSING, ANGLES, FORWARD, _BOUNDS),
    )
