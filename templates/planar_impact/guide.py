"""The guide sheet of the planar impact template."""

from __future__ import annotations

from templates.description import GuideSection
from templates.guidance import CAVEATS, FIRST_STEPS, NAMES, READINGS
from templates.restitution import RESTITUTION
from templates.two_vehicles.run_out import RUN_OUT_GUIDE

__all__ = ["guide"]

_WHEN = GuideSection(
    "When to use this model",
    (
        "Two vehicles whose approach and departure directions and run-out can be estimated, and whose approaches "
        "differ by more than about 10°. It gives impact speeds, delta-V, change in yaw rate, direction of force, "
        "restitution.",
        "Not for near-parallel approaches (|sin δ| small): momentum leaves the speeds undetermined. Use crush-energy "
        "or momentum-energy.",
        "Not where tyre or other outside forces matter during the impact: at f = 0.8 they take about 1.8 mph (2.8 "
        "km/h) for each 0.1 s of contact. Enter a duration on sheet Inputs to see how much.",
        "Both vehicles are rigid and move in the plane; the impulse acts at one point, at one instant, at full crush.",
        "Rotation (inertia, impact centre, γ) enters the speeds and delta-V only through the restitution filters. The "
        "simpler model, momentum, gives the same speeds and delta-V in every trial, and needs none of them.",
        "The next model, planar-forward, is this one turned round: given speeds and restitution, where do they go? "
        "crush-energy takes over where the approaches are near-parallel.",
    ),
)

_TRUST = GuideSection(
    "Reading the results of this model",
    (
        "Most trials are rejected: each is a combination of inputs that cannot belong to one crash. A few percent "
        "accepted is normal. The middle of every range taken together may well be such a combination, and so red.",
        "Filtering also teaches about the inputs: compare each assumption before and after in the results.",
        "A limit on e_t can decide the speed of the slower vehicle. State how the answers move when it moves.",
        "e_t has no finite standard deviation, because its closing speed crosses zero: quote its percentiles.",
        "The speeds are correlated with the delta-Vs: do not combine the ends of separate ranges freely.",
        "A blow from behind: PDOF jumps between 180 and −180. Where the workbook has a sheet Evidence, enter its "
        "direction there, with Use FALSE if it is not to be evidence; PDOF is then counted to within 180° of that.",
        "Both decelerations may share one road surface. Then correlate them (sheet Results wanted).",
        "The filters use e_n and e_t as ratios, so that their limits stand in one place, the table. Should a closing "
        "speed be exactly zero, the ratio is #DIV/0! and the trial is rejected and counted.",
    ),
)

_CORRECTIONS = GuideSection(
    "Where this workbook departs from the printed paper",
    ("A prime, as in (15′), marks an equation rewritten to keep its digits: in exact arithmetic it is the same.",),
    (
        ("Equation", "As used here"),
        ("(4)", "Sign corrected: «2» receives −P, as in (18)"),
        ("(7), (8)", "Need opposite handedness of (t, n); (9) to (14) are right and used"),
        ("(16)", "No division by cos α2: as printed, α2 = 90° or 270° gives a plausible wrong speed without an error"),
        ("(17) to (21)", "From the impulse, not from differences of nearly equal velocities"),
        ("(23)", "Arctangent of two arguments: as printed it can point to the opposite side of the vehicle"),
        ("(25)", "Not used; its denominator should read V1n,i − V2n,i"),
        ("Vf", "Never stated in the paper: √(2·g·f·s). The impact centre is in inches, in the vehicle's own frame"),
        ("Table 3", "The text means Table 2"),
    ),
)


def guide(scene: GuideSection, *, more: bool) -> tuple[GuideSection, ...]:
    """The guide, beginning with what there is to say of the scene itself.

    Args:
        scene: that.
        more: the workbook has a sheet Evidence.
    """
    readings = (READINGS, RUN_OUT_GUIDE) if more else ()
    return (scene, FIRST_STEPS, *readings, NAMES, _WHEN, RESTITUTION, _TRUST, CAVEATS, _CORRECTIONS)
