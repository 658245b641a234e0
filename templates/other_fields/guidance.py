"""What the templates of other fields tell their reader: how to use the sheets, and what a result means."""

from __future__ import annotations

from templates.description import GuideSection

__all__ = ["CAVEATS", "EXAMPLE", "EXAMPLE_NUMBERS", "FIRST_STEPS"]

EXAMPLE = "Example value: enter yours"
"""The source of a number that is nobody's but this workbook's."""

EXAMPLE_NUMBERS = GuideSection(
    "This workbook",
    ("A template. The numbers in it are an example: replace every green cell, every range, every source.",),
)

FIRST_STEPS = GuideSection(
    "How to use this workbook",
    (
        "1.  Sheet Inputs: give every green cell its best single value, its distribution and your source. The table is "
        "read by its column headings: columns may be moved, rows and columns of your own may be added.",
        "2.  Distribution: each takes the columns of its parameters; the others stay blank. A standard deviation may "
        "be typed as Std dev, or in percent of the mean as CoV %. The columns Lower cutoff and Upper cutoff, "
        "where you add them, cut any of them off.",
        "3.  Frozen = TRUE holds an input at its green value.",
        "4.  Sheet Model: the formulas, each with its equation. Red: the single values contradict each other.",
        "5.  Sheet Results wanted: the forecasts, the filters and why they hold, correlations, trials and seed.",
        "6.  Save, close, and type   xlmc simulate this-file.xlsx   A copy with the results is written beside it.",
        "Sheets Model, Drawing and Guide are locked against accidental changes, without a password (Review, Unprotect "
        "Sheet).",
    ),
)

CAVEATS = GuideSection(
    "What the results mean",
    (
        "Monte Carlo does not validate the model. It shows what the distributions imply if the model is right.",
        "Distributions chosen too narrow make the answer look better than it is, and so does leaving out that two "
        "inputs rise and fall together.",
        "The ± beside a number is the error of having run so many trials and not more. It shrinks with more trials; "
        "what is wrong with the model or its inputs does not.",
    ),
)
