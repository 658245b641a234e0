"""A vehicle that brakes for a hazard: what the templates of its driver's response share."""

from __future__ import annotations

from templates.checks import check
from templates.description import Equation, FilterRow, Input, Role
from templates.units import MPH

__all__ = [
    "BRAKING",
    "BRAKING_CHECK",
    "BRAKING_INPUT",
    "RESPONSE_FILTER",
    "STOPPING_SPEED",
    "time_of_braking",
]

BRAKING_INPUT = Input(
    "f",
    "f",
    "«1» deceleration while braking",
    "g",
    0.70,
    "Example. Enter: friction of this surface, less the grade where it runs downhill",
    {"Low": 0.65, "High": 0.75},
    number_format="0.000",
)

BRAKING = Equation("b", "b", "Deceleration while braking", "[ft|m]/s²", "f*g", "f·g")

STOPPING_SPEED = Equation(
    "v_stop_[mph|kmh]",
    "vstop",
    "Highest speed from which the same driver still stops",
    "[mph|km/h]",
    f"2*D_0/(t_response+SQRT(t_response^2+2*D_0/b))*{MPH}",
    "D0 = v·tr + v²/(2·b)",
    "The root that does not subtract nearly equal numbers.",
    Role.ANSWER,
    "0.00",
)

RESPONSE_FILTER = FilterRow(
    "Response time",
    "t_response",
    "Nobody responds sooner; a later response would be a different account of what happened",
    at_least=0.5,
    at_most=3,
)

BRAKING_CHECK = check(
    "check_friction",
    "The deceleration is that of road tyres, up to 1.2",
    "AND(f>0,f<=1.2)",
    "published values",
    "FALSE: more than road tyres hold. A percentage entered as a number?",
)


def time_of_braking(distance: str) -> Equation:
    """The time from the speed before braking to the speed at the impact, over a distance of that symbol."""
    return Equation(
        "t_brake",
        "tb",
        "Time of braking before the impact",
        "s",
        f"2*{distance}/(v_0+v_i)",
        "distance / mean speed",
        "Not (v0 − vi)/b, which loses digits for short marks.",
    )
