"""What the engineer gives: the impact, the braking, the intruder's path, a driver, the speed in question."""

from __future__ import annotations

from templates.braking import BRAKED_INPUT, BRAKING_INPUT, RESPONSE_LIMITS
from templates.description import Input
from templates.editions import Both
from templates.units import CONVERSIONS, GRAVITY

__all__ = ["ASSUMPTIONS", "CONSTANTS"]

_RESPONSE = "To brake lights, surprise: mean 1.25 s, SD 0.46 s (Ergonomics, 1993); cut off at 0.5 and 3 s"

ASSUMPTIONS = (
    Input(
        "v_impact",
        "vi ([mph|km/h])",
        "«1» speed at the impact",
        "[mph|km/h]",
        Both(40, 64),
        "Example. Enter: from momentum, crush or throw; 0 cannot be",
        {"Low": Both(37, 60), "High": Both(43, 68)},
        number_format="0.0",
    ),
    Input(
        "d_brake",
        "db",
        "«1» braking distance before the impact (used where it braked)",
        "[ft|m]",
        Both(60, 18),
        "Example. Enter: skid or ABS marks up to the point of impact. Did it not brake? Answer 2 below",
        {"Low": Both(57, 17), "High": Both(63, 19)},
        number_format="0.0",
    ),
    BRAKING_INPUT,
    Input(
        "d_intruder",
        "dI",
        "Intruder: distance from becoming a hazard to the point of impact",
        "[ft|m]",
        Both(22, 6.7),
        "Example. Enter: from where a driver can tell that it moves, such as the stop line or the kerb",
        {"Low": Both(21, 6.4), "High": Both(23, 7.0)},
        number_format="0.0",
    ),
    Input(
        "u",
        "u ([mph|km/h])",
        "Intruder: speed when it became a hazard",
        "[mph|km/h]",
        0,
        "Example, held at 0: it started from rest. Enter for a pedestrian the walking speed (see sheet Guide)",
        {"Low": 0, "High": Both(3, 5)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "a_intruder",
        "aI",
        "Intruder: acceleration",
        "g",
        0.17,
        "Cars starting from rest: comfortable .15 to .20 g (Hawkins, review of papers 1938 to 2010), over some "
        "[30 ft|10 m]. 0 for a pedestrian",
        {"Mean": 0.17, "Std dev": 0.035, "Lower cutoff": 0.08, "Upper cutoff": 0.30},
        "Normal",
        "0.000",
    ),
    Input(
        "clearance",
        "c",
        "Intruder: further distance until it has cleared",
        "[ft|m]",
        Both(12, 3.7),
        "Example. Enter: how far it still had to go until the vehicle could pass behind it",
        {"Low": Both(11, 3.4), "High": Both(13, 4.0)},
        number_format="0.0",
    ),
    Input(
        "t_fresh",
        "tf",
        "Response time of an ordinary driver",
        "s",
        1.25,
        _RESPONSE,
        {"Mean": 1.25, "Std dev": 0.46, "Lower cutoff": 0.5, "Upper cutoff": 3},
        "Normal",
        "0.00",
    ),
)

CONSTANTS = (
    BRAKED_INPUT,
    Input(
        "limit",
        "V ([mph|km/h])",
        "Speed that the question is about, such as the limit",
        "[mph|km/h]",
        Both(45, 70),
        "Enter: the posted limit, or the speed that was prudent there",
        number_format="0.0",
    ),
    *RESPONSE_LIMITS,
    GRAVITY,
    *CONVERSIONS,
)
