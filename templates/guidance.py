"""What every crash template has to tell its reader: how to use the sheets, and what a result does and does not mean."""

from __future__ import annotations

from templates.description import GuideSection

__all__ = ["CAVEATS", "EXAMPLE_NUMBERS", "FIRST_STEPS", "NAMES", "READINGS", "RESTITUTION", "SIGNS"]

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

SIGNS = GuideSection(
    "Names",
    ("Every quantity is a named cell, so that formulas read like the printed equation beside them.",),
)

NAMES = GuideSection(
    "Signs, units, names",
    (
        "Angles are in degrees, counter-clockwise from +X, and say where a vehicle moves to. The direction of X is "
        "yours to choose, one for all angles.",
        "Every quantity is a named cell, so that formulas read like the paper: alpha is α, beta β, gamma_t γ, omega "
        "ω; _1 and _2 are the vehicles, _i before and _f after the impact, _n normal and _t tangential to the contact.",
    ),
)

RESTITUTION = GuideSection(
    "Restitution: published values, as cited in SAE 2001-01-3347",
    (
        "Restitution varies from test to test and no data will match a crash exactly: choose the tests that resemble "
        "it most, and limits wide enough for their scatter. Published values depend on how the normal was chosen.",
    ),
    (
        ("Source", "Values"),
        ("Monson and Germane [23], frontal barrier, 30 mph", "e_n 0.04 to 0.24, one test about 0.35"),
        (
            "Monson and Germane [23], frontal barrier, 35 mph",
            "e_n 0.08 to 0.23; on average higher than at 30 mph for transverse engines (the engine meets the cowl)",
        ),
        ("King, Siegmund and Bailey [18], low-speed barrier and vehicle to vehicle", "e_n 0.25 to 0.75"),
        (
            "Ishikawa [17], 45 vehicle-to-vehicle tests: 32 side, 13 frontal, cars of about 1000 kg",
            "e_n: no clear trend with severity across configurations. e_t falls with tangential closing speed in side "
            "impacts; engagement is superficial below about 15 mph of normal closing speed",
        ),
        (
            "Any impact",
            "−1 to 1. Below 0: a common velocity was never reached (sideswipe, break-through). "
            "1 or more adds energy: reject",
        ),
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
