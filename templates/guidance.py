"""What every crash template has to tell its reader: how to use the sheets, and what a result does and does not mean."""

from __future__ import annotations

from templates.description import GuideSection

__all__ = ["CAVEATS", "EXAMPLE_NUMBERS", "FIRST_STEPS", "NAMES", "READINGS", "SIGNS"]

EXAMPLE_NUMBERS = GuideSection(
    "This workbook",
    ("A template. The numbers in it are an example: replace every green cell, every range, every source.",),
)

FIRST_STEPS = GuideSection(
    "How to use this workbook",
    (
        "1.  Sheet Inputs: give every green cell its best single value, its range (Low, High) and your source. The "
        "table is read by its column headings: columns may be moved, rows and columns of your own may be added.",
        "2.  Distribution: Uniform is the conservative choice; data that justify another are rare. "
        "Normal needs Mean and Std dev; Triangular needs Low, Likeliest, High; Trapezoid needs Low, Low likeliest, "
        "High likeliest, High (the shape of the paper's Figure 4 for friction). The columns for these, and for "
        "cutoffs, open with the + above the column headings.",
        "3.  Frozen = TRUE holds an input at its green value.",
        "4.  Sheet Model: look at the checks at the bottom. Red means that the single values contradict physics.",
        "5.  Sheet Results wanted: the forecasts, the filters with the evidence for their limits, trials and seed.",
        "6.  Save, close, and type   xlmc simulate this-file.xlsx   A copy with the results is written beside it.",
        "Sheets Model, Scene and Guide are locked against accidental changes, without a password (Review, Unprotect "
        "Sheet). Inputs and Results wanted stay open, so that rows can be added; Excel asks before a formula there is "
        "typed over.",
        "The limits of a filter belong to the scene. Write down the evidence before looking at the answers.",
    ),
)

READINGS = GuideSection(
    "Sheet Evidence",
    (
        "What was measured of the crash itself beside the inputs: by a recorder, in a video, from a gouge. A row does "
        "nothing until it has a Reading; then trials are kept by how well the quantity under Cell agrees with it.",
        "Error says how far a reading may be off. Uniform takes Plus or minus; Normal takes Std dev; Lognormal takes "
        "the Std dev of the natural logarithm (0.2 is some 20 %); Instrument takes Percent and Resolution; At least "
        "and At most take the reading as a limit.",
        "Use = FALSE leaves a row out. What is an input may not come back as a reading: use each fact once.",
    ),
)

_CONVENTION = (
    "One convention in every template. In the plane, seen from above: X and Y as on a map; angles, rotations and yaw "
    "rates counter-clockwise positive. On a vehicle: x forward, y to the right of its centre of gravity. Along a path: "
    "forward positive; a slope or an angle of take-off upward positive; a drop, or a fall, downward positive.",
    "Where others differ. SAE J670 and SAE J211 have the same x and y and z downward, so that rotation and yaw are "
    "clockwise positive: change the sign. ISO 8855 has y to the left. Recorders count forward and to the right (49 CFR "
    "563.5). CDC and clock directions of a force run clockwise from the front.",
)
_NAMED = "Every quantity is a named cell, so that formulas read like the printed equation beside them."

SIGNS = GuideSection("Signs and names", (*_CONVENTION, _NAMED))

NAMES = GuideSection(
    "Signs, units, names",
    (
        *_CONVENTION,
        "Angles are in degrees from +X, and say where a vehicle moves to. The direction of X is yours to choose, one "
        "for all angles. The direction of force (PDOF) says where the blow came from: counter-clockwise from the "
        "front, −180 to 180, the left side positive. Sheet Model gives it clockwise (0 to 360) and by the clock "
        "too.",
        f"{_NAMED} alpha is α, beta β, gamma_t γ, omega ω; _1 and _2 are the vehicles, _i before and _f after the "
        "impact, _n normal and _t tangential to the contact.",
    ),
)

CAVEATS = GuideSection(
    "What the results mean",
    (
        "Monte Carlo does not validate the model. It shows what the ranges imply if the model fits the crash.",
        "Ranges chosen too narrow make the answer look better than it is: each must hold every possible value.",
        "The filters must not be too tight either: limits, as those on restitution, should admit the real scatter.",
        "The 51 % range is the central range that is more probable than not. If a result straddles a speed limit, "
        "enter the limit as Threshold and report the probability of exceeding it.",
        "Monte Carlo error shrinks with more trials; reconstruction error does not.",
    ),
)
