"""The guide sheet of the forward model."""

from __future__ import annotations

from templates.description import GuideSection
from templates.guidance import CAVEATS, FIRST_STEPS, NAMES, READINGS
from templates.restitution import RESTITUTION

__all__ = ["GUIDE"]

_WHEN = GuideSection(
    "When to use this model",
    (
        "Both impact speeds are known, or in question, and the effect is wanted: delta-V, direction of force, spin, "
        "where the vehicles go. Speeds from a recorder or a video; a speed that somebody claims; approaches so "
        "parallel that momentum cannot find the speeds.",
        "Compare departure angles and travel to rest with the scene: a claimed speed that cannot reach them is "
        "refuted.",
        "Impact speeds are searched from rest positions, as an optimiser does: give speeds and headings the widest "
        "ranges that the scene allows, and enter on sheet Evidence the departure angles and the travel to rest as "
        "surveyed. The trials that are kept are all that lead there. The example rest-positions shows it; run it with "
        "--until-accepted, since few trials fit.",
        "It is planar-impact turned round: its answers, given that model's speeds and restitutions, are that model's "
        "inputs. Use planar-impact where directions and run-out are known better than speeds.",
        "Both vehicles are rigid and move in the plane; the impulse acts at one point, at one instant, at full crush. "
        "At f = 0.8 the tyres take about 1.8 mph (2.8 km/h) for each 0.1 s of contact that this neglects.",
    ),
)

_CLOSURES = GuideSection(
    "Two closures",
    (
        "Six unknowns need six equations: (1) to (4) are four. The paper adds restitution along the normal (9) and the "
        "tangent (10): closure 1. It lets e_t be anything from −1 to 1, so that contacts that slide on (sideswipes) or "
        "break through are described too.",
        "Closure 2 takes (26), the ratio of the tangential to the normal impulse, in the place of (10). It is the "
        "equivalent friction of the contact. Where friction suffices to end the sliding, it ends it, and no more: "
        "compare μ used with μ in sheet Model.",
        "The two agree when closure 2 is given the ratio that closure 1 prints, as long as sliding does not reverse.",
    ),
)

_CORRECTIONS = GuideSection(
    "Where this workbook departs from the printed paper",
    (),
    (
        ("Equation", "As used here"),
        ("(4)", "Sign corrected: «2» receives −P, as in (18)"),
        ("(7), (8)", "One handedness of (t, n) for both: closing speeds as in (9) to (14)"),
        ("(23)", "Arctangent of two arguments: as printed it can point to the opposite side of the vehicle"),
        ("Travel to rest", "Never stated in the paper: Vf²/(2·g·f)"),
    ),
)

GUIDE = (FIRST_STEPS, READINGS, NAMES, _WHEN, _CLOSURES, RESTITUTION, CAVEATS, _CORRECTIONS)
