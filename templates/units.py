"""Fixed inputs that most templates share: gravity and conversions, as cells, so that no formula hides a number."""

from __future__ import annotations

from templates.description import Input

__all__ = ["FEET_PER_MILE", "GRAVITY", "INCHES_PER_FOOT", "SECONDS_PER_HOUR"]

GRAVITY = Input(
    "g",
    "g",
    "Acceleration of gravity",
    "ft/s²",
    32.174,
    "Standard gravity (9.80665 m/s²). Part of the record: the answers depend on it",
    number_format="0.000",
)
INCHES_PER_FOOT = Input("in_per_ft", "12", "Inches in a foot", "in/ft", 12, "Definition")
SECONDS_PER_HOUR = Input("s_per_hour", "3600", "Seconds in an hour", "s/h", 3600, "Definition")
FEET_PER_MILE = Input("ft_per_mile", "5280", "Feet in a mile", "ft/mi", 5280, "Definition")
