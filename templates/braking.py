"""A vehicle that brakes for a hazard, or does not: what the templates of its driver's response share.

A driver who had not braked when he struck had not yet responded: the time since the hazard began is then no more than
a lower bound of his response time. Had he been slower, he might have braked at once after it, or never.
"""

from __future__ import annotations

from templates.checks import check
from templates.description import Equation, FilterRow, ForecastRow, GuideSection, Input, Role
from templates.road_friction import FRICTION, FRICTION_SHAPE, FRICTION_SOURCE
from templates.units import MPH

__all__ = [
    "BRAKED_CHECK",
    "BRAKED_INPUT",
    "BRAKING",
    "BRAKING_CHECK",
    "BRAKING_INPUT",
    "BRAKING_TIME",
    "NO_BRAKING",
    "RESPONSE_BEYOND",
    "RESPONSE_FILTER",
    "RESPONSE_LIMITS",
    "SCENE_SHOWS",
    "STOPPING_SPEED",
    "way_braked",
]

BRAKED_INPUT = Input(
    "braked",
    "",
    "Did the driver of «1» brake before the impact? 1 = yes, 2 = no",
    "",
    1,
    "Enter: marks, an EDR, a video. ABS may leave no marks. 2: both ends are given (sheet Guide, No braking)",
    number_format="0",
    choices=(1, 2),
)

RESPONSE_LIMITS = (
    Input("t_soonest", "tmin", "Response time, at least", "s", 0.5, "Nobody responds sooner", number_format="0.00"),
    Input(
        "t_latest",
        "tmax",
        "Response time, at most",
        "s",
        3,
        "A later response would be a different account of what happened. Not used without braking",
        number_format="0.00",
    ),
)

BRAKING_INPUT = Input(
    "f",
    "f",
    "«1» deceleration while braking",
    "g",
    FRICTION,
    f"{FRICTION_SOURCE}, less the grade where it runs downhill",
    FRICTION_SHAPE,
    "Trapezoid",
    "0.000",
)

BRAKING = Equation("b", "b", "Deceleration while braking", "[ft|m]/s²", "f*g", "f·g")


def way_braked(distance: str, notation: str) -> tuple[Equation, Equation]:
    """Whether it braked, and over which length: 0 where it did not, whatever `distance`, the input cell, says."""
    return (
        Equation(
            "did_brake",
            "",
            "It braked before the impact (1 = yes, 0 = no)",
            "",
            f"IF(AND(braked=1,{distance}>0),1,0)",
            "input",
            "0: the scene cannot tell when the driver would have responded. It shows only that he had not by then.",
            number_format="0",
        ),
        Equation(
            "d_braked",
            "d",
            "Braking before the impact",
            "[ft|m]",
            f"IF(did_brake=1,{distance},0)",
            f"{notation}, or 0",
            number_format="0.0",
        ),
    )


BRAKING_TIME = Equation(
    "t_brake",
    "tb",
    "Time of braking before the impact",
    "s",
    "2*d_braked/(v_0+v_i)",
    "distance / mean speed",
    "Not (v0 − vi)/b, which loses digits for short marks.",
)
"""The time from the speed before braking to the speed at the impact."""

RESPONSE_BEYOND = Equation(
    "t_beyond",
    "Δtr",
    "Response time, beyond its limits",
    "s",
    "IF(AND(did_brake=1,ISNUMBER(t_response)),MAX(t_soonest-t_response,t_response-t_latest),0)",
    "tmin − tr, tr − tmax",
    "Below 0: between them. Without braking 0: what is only a lower bound rejects nothing.",
)

STOPPING_SPEED = Equation(
    "v_stop_[mph|kmh]",
    "vstop ([mph|km/h])",
    "Highest speed from which the same driver still stops",
    "[mph|km/h]",
    f"2*D_0/(t_response+SQRT(t_response^2+2*D_0/b))*{MPH}",
    "D0 = v·tr + v²/(2·b)",
    "The root that does not subtract nearly equal numbers. Without braking: at most.",
    Role.ANSWER,
    "0.00",
)

RESPONSE_FILTER = FilterRow(
    "Response time, beyond its limits",
    "t_beyond",
    "Nobody responds sooner; a later response would be a different account (limits: sheet Inputs). Without braking "
    "it rejects nothing",
    at_most=0,
)

SCENE_SHOWS = ForecastRow(
    "Scene shows when the driver responded (1 = yes, 0 = it cannot tell)",
    "did_brake",
    "",
    kind="yes/no",
    stated="diagnostic",
)

BRAKING_CHECK = check(
    "check_friction",
    "The deceleration is that of road tyres, up to 1.2",
    "AND(f>0,f<=1.2)",
    "published values",
    "FALSE: more than road tyres hold. A percentage entered as a number?",
)

BRAKED_CHECK = check(
    "check_braked",
    "It braked over a distance, or not at all",
    "OR(braked=2,AND(braked=1,d_braked>0))",
    "input",
    "FALSE: no braking distance. If the driver did not brake before the impact, answer 2 on sheet Inputs.",
)

NO_BRAKING = GuideSection(
    "No braking",
    (
        "A driver who had not braked when he struck had not responded yet. The time since the hazard began is then a "
        "lower bound of his response time, and not that time: at a lower speed he might have braked just after it, or "
        "never. The scene cannot tell. Answer 2 to the question whether he braked.",
        "Both ends are then given. At most: he brakes as soon as that time has passed. At least: he never brakes. "
        "Whatever he would have done lies between them. Quote both, or neither.",
        "The forecast whether the scene shows it says 0 then, and others are one-sided: the response time is a least "
        "one; speeds that still stop, and shares that stop, are greatest ones. Where he braked, both ends are equal.",
        "No limit on the response time rejects such a scene: that he had not braked after 4 s is no contradiction.",
    ),
)
