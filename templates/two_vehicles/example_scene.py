"""The scene the empty template shows: plausible numbers that hold every check, each marked as an example."""

from __future__ import annotations

from dataclasses import replace

from templates.description import GuideSection
from templates.editions import Both
from templates.two_vehicles.scene import Scene

__all__ = ["EXAMPLE", "FORWARD_EXAMPLE", "MOMENTUM_EXAMPLE"]

_RANGES = {
    "w_1": Both((6660, 6860), (3020, 3110)),
    "I_1": Both((4710, 5210), (6390, 7060)),
    "alpha_1": (181, 191),
    "beta_1": (187, 197),
    "s_1": Both((20, 22), (6.1, 6.7)),
    "f_1": (0.60, 0.95),
    "w_2": Both((3410, 3510), (1545, 1595)),
    "I_2": Both((1850, 2040), (2510, 2770)),
    "alpha_2": (272, 292),
    "beta_2": (192, 202),
    "s_2": Both((20, 24), (6.1, 7.3)),
    "f_2": (0.60, 0.95),
    "x_1": Both((97.5, 103.5), (2.48, 2.63)),
    "y_1": Both((-16, -10), (-0.41, -0.25)),
    "x_2": Both((-3.2, 3.2), (-0.08, 0.08)),
    "y_2": Both((-28.6, -22.6), (-0.73, -0.57)),
    "gamma_t": (96, 106),
}
_BASE = {
    "alpha_1": 188,
    "beta_1": 188.5,
    "s_1": Both(21, 6.4),
    "f_1": 0.75,
    "beta_2": 199,
    "s_2": Both(22, 6.7),
    "f_2": 0.82,
}
_WHAT_TO_ENTER = {
    "w": "scale weight or published curb weight, plus occupants and load",
    "I": "published inertia, or an estimate from weight and dimensions",
    "alpha": "tyre marks, lane geometry, statements; wider for a turning vehicle",
    "beta": "line from the point of impact toward rest, as surveyed",
    "s": "surveyed distance from impact to rest along the path",
    "f": "published drag of this surface, share of locked wheels, grade. 0.60 to 0.95 is the breadth of the literature "
    "for dry asphalt in SAE 2001-01-3347",
    "x": "from the CG forward to the centre of the crush zone",
    "y": "from the CG to the right, to the centre of the crush zone",
    "gamma": "direction of the contact surface, from the damage",
}

EXAMPLE = Scene(
    title="Impact of two vehicles in the plane",
    subtitle="Impact speeds and delta-V from approach and departure directions and run-out (SAE 2001-01-3347)",
    vehicles=("Vehicle 1", "Vehicle 2"),
    ranges=_RANGES,
    base=_BASE,
    sources={symbol: f"Example. Enter: {_WHAT_TO_ENTER[symbol.partition('_')[0]]}" for symbol in _RANGES},
    because={
        "e_n": "Example. A common velocity was reached along the normal; 1 or more would add energy",
        "e_t": "Example. A common velocity was reached along the contact surface, with little rebound",
        "V2_mph": "It was moving forward",
    },
    guide=GuideSection(
        "This workbook",
        (
            "A template. The numbers in it are an example, close to the case study of SAE 2001-01-3347: replace every "
            "green cell, every range, every source, and the filter limits by those of your scene.",
        ),
    ),
)

MOMENTUM_EXAMPLE = replace(
    EXAMPLE,
    title="Momentum of two vehicles",
    subtitle="Impact speeds and delta-V from directions and run-out; no rotation, no restitution (SAE 2001-01-3347)",
)

FORWARD_EXAMPLE = replace(
    EXAMPLE,
    title="What an impact does to two vehicles",
    subtitle="Delta-V, rotation and departure from impact speeds and restitution (SAE 2001-01-3347, forward)",
)
