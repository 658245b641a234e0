"""Fixed inputs that most templates share: gravity and conversions, as cells, so that no formula hides a number."""

from __future__ import annotations

from templates.description import Input
from templates.editions import Both

__all__ = ["CONVERSIONS", "GRAVITY", "INCHES_PER_FOOT", "MPH", "RADIUS_OF_GYRATION"]

GRAVITY = Input(
    "g",
    "g",
    "Acceleration of gravity",
    "[ft|m]/s²",
    Both(32.174, 9.80665),
    "Standard gravity[ (9.80665 m/s²)|]. Part of the record: the answers depend on it",
    number_format="0.000[|00]",
)
INCHES_PER_FOOT = Input("[in_per_ft|]", "12", "Inches in a foot", "in/ft", 12, "Definition")
SECONDS_PER_HOUR = Input("s_per_hour", "3600", "Seconds in an hour", "s/h", 3600, "Definition")
LONG_DISTANCE = Input(
    "[ft_per_mile|m_per_km]",
    "[5280|1000]",
    "[Feet in a mile|Metres in a kilometre]",
    "[ft/mi|m/km]",
    Both(5280, 1000),
    "Definition",
)
CONVERSIONS = (SECONDS_PER_HOUR, LONG_DISTANCE)
"""What a speed in mph or km/h needs."""

RADIUS_OF_GYRATION = (
    "√(I/m) of [4.2 to 4.9 ft|1.3 to 1.5 m] for the vehicles of SAE 2001-01-3347, [4.59 ft|1.40 m] for the car of SAE "
    "2019-01-0422. Enter: that of this vehicle, where its inertia is published"
)
"""Where the radius of gyration in yaw of a passenger car comes from, as a source."""

MPH = "s_per_hour/[ft_per_mile|m_per_km]"
"""A speed in ft/s or m/s times this is in mph or km/h."""
