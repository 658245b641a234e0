"""A vehicle leaves the ground and lands further on and lower: the speed at which it took off."""

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
    Role,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, FIRST_STEPS, READINGS, SIGNS
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY

__all__ = ["TEMPLATE"]

_ASSUMPTIONS = (
    Input(
        "d",
        "d",
        "Horizontal distance from take-off to landing, of the CG",
        "[ft|m]",
        Both(44.6, 13.6),
        "Example. Enter: surveyed between take-off and landing, as wide as both points are uncertain",
        {"Low": Both(43.6, 13.3), "High": Both(45.6, 13.9)},
        number_format="0.0",
    ),
    Input(
        "h",
        "h",
        "Drop from take-off to landing, of the CG (down positive)",
        "[ft|m]",
        Both(8.3, 2.53),
        "Example. Enter: surveyed. The CG may stand higher or lower at landing than at take-off: add the change",
        {"Low": Both(7.8, 2.38), "High": Both(8.8, 2.68)},
        number_format="0.00",
    ),
    Input(
        "theta",
        "θ",
        "Slope at take-off (up positive)",
        "deg",
        0,
        "Example. Enter: the survey of the last wheelbase before the edge; at least 1 to 2° either way",
        {"Low": -2, "High": 2},
        number_format="0.0",
    ),
    Input(
        "f",
        "f",
        "Deceleration before the edge",
        "g",
        0.45,
        "Example (.45 in Design News, 19 August 2002). Enter: friction of that surface where marks show braking",
        {"Low": 0.40, "High": 0.50},
        number_format="0.000",
    ),
    Input(
        "s",
        "s",
        "Length of braking before the edge",
        "[ft|m]",
        Both(32.7, 10),
        "Example. Enter: the marks up to the edge; 0 where there are none",
        {"Low": Both(31.7, 9.7), "High": Both(33.7, 10.3)},
        number_format="0.0",
    ),
)

_CONSTANTS = (GRAVITY, *CONVERSIONS)

_STEPS = (
    Equation(
        "q",
        "q",
        "Fall below the line of take-off",
        "[ft|m]",
        "h+d*TAN(RADIANS(theta))",
        "h + d·tan θ",
        "0 or less: at no speed would it land there. One degree of θ changes the speed by d/q · 0.9 %.",
        number_format="0.000",
    ),
    Equation("t", "t", "Time in the air", "s", "SQRT(2*q/g)", "q = g·t²/2"),
    Equation("v_x", "vx", "Speed along the ground", "[ft|m]/s", "d/t", "d / t"),
    Equation("v", "v", "Speed at take-off", "[ft|m]/s", "v_x/COS(RADIANS(theta))", "vx / cos θ"),
    Equation("v_1", "v1", "Speed before braking", "[ft|m]/s", "SQRT(v^2+2*f*g*s)", "√(v² + 2·f·g·s)"),
    Equation(
        "v_min",
        "vmin",
        "Least speed that reaches the landing, at any slope",
        "[ft|m]/s",
        "d*SQRT(g/(SQRT(d^2+h^2)+h))",
        "d·√(g/(√(d² + h²) + h))",
        "Not √(g·(√(d² + h²) − h)), which loses digits for a deep fall.",
    ),
    Equation("v_land", "vl", "Speed at landing", "[ft|m]/s", "SQRT(v^2+2*g*h)", "energy"),
    Equation(
        "steepness",
        "d/q",
        "Distance, in units of the fall below the line",
        "",
        "d/q",
        "definition",
        number_format="0.0",
    ),
)

_ANSWERS = (
    speed_answer("v", "v", "Speed at take-off", "v"),
    speed_answer("v1", "v1", "Speed before braking", "v_1"),
    speed_answer(
        "vmin",
        "vmin",
        "Take-off speed, at least",
        "v_min",
        "Whatever the slope: quote it where the slope is not known.",
    ),
    Equation(
        "landing_slope",
        "φ",
        "Direction of flight at landing (down negative)",
        "deg",
        "DEGREES(ATAN(TAN(RADIANS(theta))-2*q/d))",
        "tan φ = tan θ − 2·q/d",
        "Compare it with the gouge.",
        Role.ANSWER,
        "0.0",
    ),
)

_CHECKS = checks_section(
    3,
    check(
        "check_fall",
        "The landing lies below the line of take-off",
        "q>0",
        "geometry",
        "FALSE: at no speed would it land there.",
    ),
    check(
        "check_distance",
        "It flew forward, and braked over no negative length",
        "AND(d>0,s>=0)",
        "geometry",
        "FALSE: a length below 0.",
    ),
    check(
        "check_angle",
        "The slope is that of a road or a bank, within 45°",
        "ABS(theta)<=45",
        "geometry",
        "FALSE: steeper than 45°. A compass direction entered as a slope?",
    ),
    check(
        "check_friction",
        "The deceleration before the edge is that of tyres, up to 1.2",
        "AND(f>=0,f<=1.2,OR(f>0,s=0))",
        "published values",
        "FALSE: none, or more than tyres hold. A percentage entered as a number?",
    ),
    check(
        "check_least",
        "The speed is not below the least that reaches the landing",
        "IF(q>0,v>=v_min*(1-0.000001),TRUE)",
        "physics",
        "FALSE: a formula was typed over.",
    ),
    check(
        "check_time",
        "It was in the air for less than 3 s",
        "IF(q>0,t<3,TRUE)",
        "physics",
        "FALSE: over such a time air drag and rotation matter.",
    ),
    check(
        "check_steepness",
        "The fall below the line of take-off is not small against the distance",
        "IF(q>0,steepness<=10,TRUE)",
        "conditioning",
        "FALSE: d/q is above 10. A degree of slope changes the speed by 9 % or more: give percentiles, not the mean.",
    ),
)

_SHARES = tuple(f"{step}/16" for step in range(17))

_DIAGRAM = Diagram(
    "Flight of the CG, base case",
    "Distance from take-off, [ft|m]",
    "Height above landing, [ft|m]",
    (
        Curve(
            "Flight",
            Look.FIRST,
            tuple((f"{share}*d", f"h+{share}*d*TAN(RADIANS(theta))-q*({share})^2") for share in _SHARES),
        ),
        Curve("Line of take-off", Look.LINE, (("0", "h"), ("d", "h+d*TAN(RADIANS(theta))"))),
        Curve("Landing", Look.POINT, (("d", "0"),)),
    ),
    remark="Drawn from the cells below. The scale of heights is not that of distances.",
)

_GUIDE = (
    GuideSection(
        "This workbook",
        (
            "A template. The numbers in it are an example (The case of airborne Amy, Design News, 19 August 2002): "
            "replace every green cell, every range, every source.",
        ),
    ),
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle that left the ground over an edge or a bank, and struck the ground further on. It answers the "
            "speed at take-off, and before braking where there are marks up to the edge.",
            "Measure distance and drop of the centre of gravity. Signs decide: the drop is positive downward, the "
            "slope positive upward. A landing that is lower, entered as higher, gives another speed without a warning.",
            "Field formulas such as 2.73·D/√(D·G + H) are this one without the division by cos θ.",
            "Not for a vehicle that rotated much in the air, landed on an obstacle, or flew for seconds.",
            "A rider thrown from a motorcycle leaves at 10 to 20° (Hutchison, vceinc.com).",
        ),
    ),
    GuideSection(
        "How far the slope decides",
        (
            "A degree of slope changes the speed by about 0.87·d/q per cent. Where d/q is large, survey the slope "
            "better, or quote the least speed, which does not depend on it.",
        ),
        (
            ("Distance and drop", "Change of the speed per degree of slope"),
            ("[44.6 ft, 8.3 ft|13.6 m, 2.5 m]", "4.7 %"),
            ("[30 ft, 2 ft|9 m, 0.6 m]", "13 %"),
            ("[100 ft, 3 ft|30 m, 0.9 m]", "29 %"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed of a vehicle that left the ground",
    subtitle="q = h + d·tan θ; t = √(2 q/g); v = d/(t·cos θ)",
    rung=10,
    question="How fast was a vehicle that flew so far?",
    needs="distance and drop of the flight, slope at take-off",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(
        Section("1  Flight", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» speed at take-off", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed before braking", "v1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» take-off speed, at least", "vmin_[mph|kmh]", "[mph|km/h]", stated="lower bound"),
        ForecastRow("Time in the air", "t", "s"),
        ForecastRow("Direction of flight at landing", "landing_slope", "deg", stated="diagnostic"),
    ),
    filters=(FilterRow("Fall below the line of take-off", "q", "The vehicle landed, at some speed", above=0),),
    evidence=(
        EvidenceRow(
            "Direction of the gouge at landing",
            "landing_slope",
            None,
            "Uniform",
            {},
            "Enter the slope of the gouge, down negative, and how well it was measured",
        ),
        EvidenceRow(
            "Speed from another source",
            "v1_[mph|kmh]",
            None,
            "Normal",
            {},
            "Enter a speed from a yaw mark, an EDR or a video, and its standard deviation",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Distance and drop are measured apart: none.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
