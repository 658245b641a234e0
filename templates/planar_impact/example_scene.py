"""The scene the empty template shows: plausible numbers that hold every check, each marked as an example."""

from __future__ import annotations

from templates.description import GuideSection
from templates.planar_impact.inputs import Scene

__all__ = ["EXAMPLE"]

_RANGES = {
    "w_1": (6660, 6860),
    "I_1": (4710, 5210),
    "alpha_1": (181, 191),
    "beta_1": (187, 197),
    "s_1": (20, 22),
    "f_1": (0.60, 0.95),
    "w_2": (3410, 3510),
    "I_2": (1850, 2040),
    "alpha_2": (272, 292),
    "beta_2": (192, 202),
    "s_2": (20, 24),
    "f_2": (0.60, 0.95),
    "x_1": (97.5, 103.5),
    "y_1": (-16, -10),
    "x_2": (-3.2, 3.2),
    "y_2": (-28.6, -22.6),
    "gamma_t": (96, 106),
}
_BASE = {
    "alpha_1": 188,
    "beta_1": 188.5,
    "s_1": 21,
    "f_1": 0.75,
    "beta_2": 199,
    "s_2": 22,
    "f_2": 0.82,
}
_WHAT_TO_ENTER = {
    "w": "scale weight or published curb weight, plus occupants and load",
    "I": "published inertia, or an estimate from weight and dimensions",
    "alpha": "tyre marks, lane geometry, statements; wider for a turning vehicle",
    "beta": "line from the point of impact toward rest, as surveyed",
    "s": "surveyed distance from impact to rest along the path",
    "f": "published drag of this surface, share of locked wheels, grade",
    "x": "from the CG forward to the centre of the crush zone, inches",
    "y": "from the CG to the right, to the centre of the crush zone, inches",
    "gamma": "direction of the contact surface, from the damage",
}

EXAMPLE = Scene(
    title="Planar impact of two vehicles",
    subtitle="Impact speeds and delta-V from approach and departure directions and run-out (SAE 2001-01-3347)",
    vehicles=("Vehicle 1", "Vehicle 2"),
    ranges=_RANGES,
    base=_BASE,
    sources={symbol: f"Example. Enter: {_WHAT_TO_ENTER[symbol.partition('_')[0]]}" for symbol in _RANGES},
    because={
        "e_n": "Example. A common velocity was reached along the normal; 1 or more would add energy",
        "e_t": "Example. A common velocity was reached along the contact surface, with little rebound",
        "V2_mph": "Vehicle 2 was moving forward",
    },
    guide=GuideSection(
        "This workbook",
        (
            "A template. The numbers in it are an example, close to the case study of SAE 2001-01-3347: replace every "
            "green cell, every range, every source, and the filter limits by those of your scene.",
        ),
    ),
)
