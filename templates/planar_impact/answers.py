"""What the planar impact model answers beside momentum, and its checks: a possible impact, or an impossible one."""

from __future__ import annotations

from templates.checks import checks_section
from templates.description import Equation, Section
from templates.restitution_curve import curve_section
from templates.two_vehicles.answers import ANSWERS, APPROACH, FORCE, ROTATION
from templates.two_vehicles.checks import ANGLES, BOUNDS, CLOSING, ENERGY, FORWARD, FRICTION
from templates.two_vehicles.options import duration_section, turn_section
from templates.two_vehicles.readings import recorder_section
from templates.two_vehicles.run_out import RUN_OUT_CHECK, before_section
from templates.vehicles import for_both

__all__ = ["answer_sections"]

_NORMAL = (
    Equation(
        "d_{j}",
        "d{j}",
        "{who} CG, normal coordinate",
        "[ft|m]",
        "b_{j}*COS(RADIANS(gamma_t))-a_{j}*SIN(RADIANS(gamma_t))",
        "notation",
    ),
)


def answer_sections(*, more: bool) -> tuple[Section, ...]:
    """The answers, what else a report states, the optional rows, and the checks.

    Args:
        more: give the rows of a turning vehicle, and those that readings are held against, too.
    """
    further = (
        turn_section(9),
        recorder_section(10),
        before_section(11),
        curve_section(12, "e_n", "approach_[mph|kmh]"),
    )
    optional = (duration_section(8), *(further if more else ()))
    checks = (ENERGY, CLOSING, ANGLES, FORWARD, BOUNDS, FRICTION, *((RUN_OUT_CHECK,) if more else ()))
    return (
        Section("6  Answers (the forecasts)", for_both(ANSWERS)),
        Section("7  Direction of force, yaw, energy", for_both(FORCE + ROTATION + _NORMAL + APPROACH)),
        *optional,
        checks_section(8 + len(optional), *checks),
    )
