"""A vehicle in a video passes two marks: its speed between them, and at the last one."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Curve,
    Diagram,
    Equation,
    EvidenceRow,
    FilterRow,
    ForecastRow,
    GuideSection,
    Input,
    Look,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_FRAME = "A crossing lies anywhere between two frames: uniform 0 to 1"

_ASSUMPTIONS = (
    Input(
        "d",
        "d",
        "Distance between the two marks",
        "[ft|m]",
        Both(100, 30),
        "Example. Enter: surveyed on the scene, or scaled; as wide as the marks can be placed in the image",
        {"Low": Both(99, 29.7), "High": Both(101, 30.3)},
        number_format="0.00",
    ),
    Input(
        "u_1",
        "u1",
        "First mark: share of a frame before the frame counted",
        "frames",
        0.5,
        _FRAME,
        {"Low": 0, "High": 1},
        number_format="0.00",
    ),
    Input(
        "u_2",
        "u2",
        "Last mark: share of a frame before the frame counted",
        "frames",
        0.5,
        _FRAME,
        {"Low": 0, "High": 1},
        number_format="0.00",
    ),
    Input(
        "rate",
        "r",
        "Frame rate",
        "1/s",
        30,
        "Example. Enter: from the metadata. Where the rate varies, enter the mean over the frames counted, from their "
        "time stamps",
        {"Low": 29.9, "High": 30.1},
        number_format="0.00",
    ),
    Input(
        "a",
        "a",
        "Deceleration between the marks (speeding up: negative)",
        "g",
        0,
        "Example, held at 0: a steady speed. Enter: what braking lamps, other marks or an EDR say",
        {"Low": 0, "High": 0.7},
        number_format="0.000",
        frozen=True,
    ),
)

_CONSTANTS = (
    Input(
        "n",
        "n",
        "Frames counted between the marks",
        "",
        40,
        "Example. Count: the frame after the last mark less the frame after the first",
        number_format="0",
    ),
    GRAVITY,
    *CONVERSIONS,
)

_STEPS = (
    Equation(
        "frames",
        "N",
        "Frames between the crossings",
        "",
        "n+u_1-u_2",
        "n + u1 − u2",
        "Each crossing lies within one frame: their difference is one frame either way, and most likely none.",
        number_format="0.000",
    ),
    Equation("T", "T", "Time between the crossings", "s", "frames/rate", "N / r"),
    Equation("v_mean", "v̄", "Mean speed between the marks", "[ft|m]/s", "d/T", "d / T"),
    Equation(
        "v_end",
        "ve",
        "Speed at the last mark",
        "[ft|m]/s",
        "v_mean-a*g*T/2",
        "v̄ − a·T/2",
        "With a steady deceleration the mean speed is that of half the time.",
    ),
    Equation("v_first", "va", "Speed at the first mark", "[ft|m]/s", "v_mean+a*g*T/2", "v̄ + a·T/2"),
)

_ANSWERS = (
    speed_answer("v", "v̄", "Mean speed between the marks", "v_mean"),
    speed_answer("vend", "ve", "Speed at the last mark", "v_end"),
)

_CHECKS = checks_section(
    3,
    check(
        "check_order",
        "The last mark is passed after the first",
        "AND(d>0,n>=1,frames>0,rate>0)",
        "geometry",
        "FALSE: count the frames from the first mark to the last.",
    ),
    check(
        "check_shares",
        "Shares of a frame lie between 0 and 1",
        "AND(MIN(u_1,u_2)>=0,MAX(u_1,u_2)<=1)",
        "definition",
        "FALSE: more than a frame.",
    ),
    check(
        "check_tyres",
        "The deceleration is one that tyres give, up to 1.2",
        "ABS(a)<=1.2",
        "published values",
        "FALSE: more than road tyres hold. A percentage entered as a number?",
    ),
    check(
        "check_forward",
        "The vehicle moves forward at the last mark",
        "v_end>0",
        "physics",
        "FALSE: so hard a braking would have stopped it before the last mark.",
    ),
    check(
        "check_frames",
        "At least 5 frames are counted",
        "n>=5",
        "conditioning",
        "FALSE: a frame more or less then decides the speed. Take marks that lie further apart; with 1 frame the "
        "mean has no finite value.",
    ),
)

_COUNTS = tuple(range(17))

_DIAGRAM = Diagram(
    "Speed as read, against the frames between the marks, base case",
    "Frames between the crossings",
    "Mean speed, [mph|km/h]",
    (
        Curve(
            "Speed",
            Look.FIRST,
            tuple((f"n-2+{count}/4", f"d*rate/MAX(n-2+{count}/4,0.1)*{MPH}") for count in _COUNTS),
        ),
        Curve("As counted", Look.POINT, (("frames", f"v_mean*{MPH}"),)),
    ),
    remark="Drawn from the cells below: how much two frames more or less change the speed.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A camera that stands still saw a vehicle pass two places whose distance is known. Count the frames from "
            "the first frame after the vehicle passed the first place to the first frame after it passed the last.",
            "One place is enough if both axles pass it: the distance is then the wheelbase.",
            "If you can, read when the vehicle passes a mark, not where it is in a frame: the frames just before and "
            "just after it passes are known. "
            "Take the longest stretch that the video shows: the error of a frame shrinks with the frames counted.",
            "Where the vehicle brakes, the mean speed is not the speed at the last mark. Enter the deceleration, as "
            "wide as it is uncertain.",
            "Frame rates of recorders vary. Where the file has a time stamp for each frame, use those: the mean rate "
            "over the frames counted is n divided by the difference of the stamps (SAE 2021-01-0887).",
            "Several distances scaled by one calibration share its error: correlate them.",
        ),
    ),
    GuideSection(
        "Published experience",
        ("How far such speeds were from the recorded ones.",),
        (
            ("Study", "Result"),
            (
                "Reverse projection against EDRs (Epstein and Westlake, Journal of Forensic Sciences, 2019)",
                "on average within [1.44 mph|2.3 km/h]",
            ),
            ("Frame rates (SAE 2021-01-0887)", "need the stamp of every frame where the rate varies"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from a video",
    subtitle="v̄ = d·r/(n + u1 − u2); ve = v̄ − a·T/2",
    rung=12,
    question="How fast was a vehicle that a camera saw?",
    needs="distance between two marks, frames counted, frame rate",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(
        Section("1  Speed", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» mean speed between the marks", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed at the last mark", "vend_[mph|kmh]", "[mph|km/h]"),
    ),
    filters=(
        FilterRow("Order of the marks", "frames", "The last mark is passed after the first", above=0),
        FilterRow("Forward at the last mark", "v_end", "The vehicle had not stopped", above=0),
    ),
    evidence=(
        EvidenceRow(
            "Speed in an EDR, at the last mark",
            "vend_[mph|kmh]",
            None,
            "Instrument",
            {"Resolution": Both(1.24, 2)},
            "Enter the recorded speed. 49 CFR 563.8: within 1 km/h, in steps of 1 km/h. Braking wheels "
            "under-report it: see the template edr-speed",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Distances that share one calibration are correlated: enter how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
