"""A body that a vehicle throws: how it slides and how it leaves, the same in every template (Searle, SAE 831622)."""

from __future__ import annotations

from templates.checks import check
from templates.description import Input

__all__ = ["EFFICIENCY_CHECK", "THROWN"]

THROWN = (
    Input(
        "mu",
        "μ",
        "Friction of the body on the ground",
        "",
        0.66,
        "Placeholder, not a published value. Enter: tests of clothed dummies on this surface, as wide as they scatter",
        {"Low": 0.5, "Low likeliest": 0.6, "High likeliest": 0.7, "High": 0.8},
        "Trapezoid",
        "0.00",
    ),
    Input(
        "angle",
        "θ",
        "Angle of projection above the ground",
        "deg",
        15,
        "Example. Seldom known: 0 where the body was pushed forward; wide where it was lifted",
        {"Low": 0, "High": 30},
        number_format="0.0",
    ),
    Input(
        "efficiency",
        "η",
        "Projection speed over «1» speed",
        "",
        0.9,
        "Example. 1: the body reached the vehicle's speed. Less where it was lifted, or hit at the edge",
        {"Low": 0.8, "High": 1},
        number_format="0.00",
    ),
)
"""Friction on the ground, angle of projection, and projection speed over that of the vehicle."""

EFFICIENCY_CHECK = check(
    "check_efficiency",
    "The body is not faster than the vehicle",
    "AND(efficiency>0,efficiency<=1)",
    "physics",
    "FALSE: an inelastic body cannot leave faster than what pushes it.",
)
