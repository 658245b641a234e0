"""Build the example workbooks: `python examples/build.py [folder]`, without a folder where they are committed.

`intersection.xlsx` is the case study of SAE 2001-01-3347: a Nissan sedan turns left in front of a Chevrolet pickup.
`intersection-momentum.xlsx` is the same crash one rung down. The others are the worked examples of
`templates/published.py`.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

HERE = Path(__file__).resolve().parent
if __name__ == "__main__":
    sys.path.append(str(HERE.parent))

# The path above lets this run as a plain script.
from templates.description import GuideSection, Template  # noqa: E402
from templates.editions import Edition, edition  # noqa: E402
from templates.momentum import describe as momentum  # noqa: E402
from templates.planar_impact import describe as planar_impact  # noqa: E402
from templates.published import PUBLISHED  # noqa: E402
from templates.two_vehicles.scene import Scene  # noqa: E402
from templates.writer import write_book  # noqa: E402

__all__ = ["EXAMPLES", "build"]

_INERTIA = "Table 1; the paper does not name its source"
_DEPARTURE = "Table 1. Straight run-out between documented positions; within 10 degrees"
_TRAVEL = "Table 1. Positions documented by the police; both travelled about 22 ft"
_SURFACE = "Table 1. Breadth of published values for dry asphalt"
_CRUSH = "Table 1. From crush energy analysis (EDCRASH); from the CG"

# Symbol: (low, high, source), in the order of the paper's Table 1.
_TABLE_1: dict[str, tuple[float, float, str]] = {
    "w_1": (6661, 6861, "Table 1. Published weight; load not known, hence wider than the Nissan"),
    "I_1": (4712, 5208, _INERTIA),
    "alpha_1": (181, 191, "Table 1. No skid marks, little time to react; an evasive steer possible"),
    "beta_1": (187, 197, _DEPARTURE),
    "s_1": (20, 22, _TRAVEL),
    "f_1": (0.60, 0.95, _SURFACE),
    "w_2": (3410, 3510, "Table 1. Published weight; occupant weights reasonably well known"),
    "I_2": (1849, 2043, _INERTIA),
    "alpha_2": (272, 292, "Table 1. The Nissan was turning left; widest of the angles"),
    "beta_2": (192, 202, _DEPARTURE),
    "s_2": (20, 24, _TRAVEL),
    "f_2": (0.60, 0.95, _SURFACE),
    "x_1": (97.5, 103.5, f"{_CRUSH} forward"),
    "y_1": (-16, -10, f"{_CRUSH} to the right"),
    "x_2": (-3.2, 3.2, f"{_CRUSH} forward"),
    "y_2": (-28.6, -22.6, f"{_CRUSH} to the right"),
    "gamma_t": (96, 106, "Table 1. Orientation of the tangential direction"),
}

_ABOUT = GuideSection(
    "This workbook",
    (
        "The case study of SAE 2001-01-3347. A Nissan sedan turned left in front of an oncoming Chevrolet pickup. The "
        "ranges are those of Table 1, all uniform; the base case is the middle of every range.",
        "At the base case e_t is about 0.95 and the filter rejects it: all middles together are not a possible crash.",
        "The paper kept 3,481 of 200,000 trials. Its Table 2, in mph (mean, standard deviation, 51 % range): Chevrolet "
        "delta-V 11.8, 0.7, 11.3 to 12.4; Nissan delta-V 23.1, 1.4, 22.0 to 24.1; Chevrolet impact speed 33.1, 1.8, "
        "31.8 to 34.5; Nissan impact speed 4.8, 2.0, 3.3 to 6.2.",
    ),
)

INTERSECTION = Scene(
    title="Intersection collision of a Chevrolet pickup and a Nissan sedan",
    subtitle="Case study of SAE 2001-01-3347; vehicle 1 is the Chevrolet, vehicle 2 the Nissan",
    vehicles=("Chevrolet", "Nissan"),
    ranges={symbol: (low, high) for symbol, (low, high, _) in _TABLE_1.items()},
    base={},
    sources={symbol: source for symbol, (_, _, source) in _TABLE_1.items()},
    because={
        "e_n": "Significant engagement: a common velocity was reached along the normal; 1 or more would add energy",
        "e_t": "A common velocity was reached tangentially, and physical evidence shows little departure from it",
        "V2_mph": "The Nissan was moving forward",
    },
    guide=_ABOUT,
    paper_only=True,
)

_ABOUT_MOMENTUM = GuideSection(
    "This workbook",
    (
        "The case study of SAE 2001-01-3347 one rung down: the same ranges, without restitution to reject trials. "
        "Before any filter the converged means and standard deviations are, in mph: Chevrolet delta-V 12.17, 1.13; "
        "Nissan delta-V 23.77, 2.20; Chevrolet impact speed 33.69, 1.79; Nissan impact speed 8.90, 4.19.",
        "Compare with intersection.xlsx: restitution is what tells the Nissan's speed.",
    ),
)

_WITHOUT_RESTITUTION = replace(
    INTERSECTION,
    title="Intersection collision, by momentum alone",
    guide=_ABOUT_MOMENTUM,
)

EXAMPLES: dict[str, Template] = {
    "intersection": edition(planar_impact(INTERSECTION), Edition.IMPERIAL),
    "intersection-momentum": edition(momentum(_WITHOUT_RESTITUTION), Edition.IMPERIAL),
    **PUBLISHED,
}
"""File name without its ending -> what the workbook says."""


def build(folder: Path) -> list[Path]:
    """Write every example into `folder`; the paths written are returned."""
    written = []
    for name, template in EXAMPLES.items():
        path = folder / f"{name}.xlsx"
        write_book(template, path)
        written.append(path)
    return written


if __name__ == "__main__":
    build(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE)
