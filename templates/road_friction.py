"""Friction of tyres on a dry road where none was measured on the scene: one range, and the table it comes from."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["FRICTION", "FRICTION_ROWS", "FRICTION_SHAPE", "FRICTION_SOURCE"]

FRICTION = 0.65
FRICTION_SHAPE: Mapping[str, float] = {"Low": 0.55, "Low likeliest": 0.60, "High likeliest": 0.70, "High": 0.80}
"""A trapezoid, columns of `xlmc_assumptions` -> value: flat where the two ranges of travelled asphalt overlap."""
FRICTION_SOURCE = (
    "Dry travelled asphalt, not measured: above [30 mph|48 km/h] .55 to .70, below it .60 to .80 (J. S. Baker's table "
    "of 1975; sheet Guide); likeliest where both agree. Enter: tests on this surface"
)
FRICTION_ROWS = (
    (
        "Travelled asphalt, dry, below [30 mph|48 km/h] (J. S. Baker, 1975, as quoted at mfes.com/friction.html)",
        ".60 to .80",
    ),
    ("Travelled asphalt, dry, above [30 mph|48 km/h] (the same)", ".55 to .70"),
    (
        "Dry asphalt, averages of recent studies (the same page, by which Baker could not say who had tested, and his "
        "values are low)",
        ".72 to .78",
    ),
    ("Case study of SAE 2001-01-3347, dry asphalt, breadth of the literature", ".60 to .95"),
)
"""Rows of the Guide: surface, friction in g."""
