"""A vehicle leaves curved yaw marks: the speed at which its tyres could hold no more."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Curve,
    Diagram,
    Equation,
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
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import seen_speed, told_speed
from templates.road_friction import FRICTION, FRICTION_ROWS, FRICTION_SHAPE, FRICTION_SOURCE
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY

__all__ = ["TEMPLATE"]

_ASSUMPTIONS = (
    Input(
        "chord",
        "C",
        "Chord of the yaw mark",
        "[ft|m]",
        Both(100, 30),
        "Example. Enter: measured near the beginning of the mark, along its outer front tyre",
        {"Low": Both(99.5, 29.85), "High": Both(100.5, 30.15)},
        number_format="0.00",
    ),
    Input(
        "ordinate",
        "M",
        "Middle ordinate of the yaw mark",
        "[ft|m]",
        Both(4, 1.2),
        "Example. Enter: from the middle of the chord to the mark; its error decides the radius",
        {"Low": Both(3.8, 1.14), "High": Both(4.2, 1.26)},
        number_format="0.00",
    ),
    Input(
        "f",
        "f",
        "Friction",
        "g",
        FRICTION,
        FRICTION_SOURCE,
        FRICTION_SHAPE,
        "Trapezoid",
        "0.000",
    ),
)

_CONSTANTS = (
    Input("bank", "i", "Superelevation, inner side lower: positive", "%", 0, "Enter: the survey", number_format="0.0"),
    Input(
        "offset",
        "t",
        "From the mark inward to the path of the CG",
        "[ft|m]",
        0,
        "0 leaves it out; half the track width where the outer front tyre left the mark",
        number_format="0.00",
    ),
    GRAVITY,
    *CONVERSIONS,
)

_OPTIONAL = (
    Input(
        "chord_later", "C2", "Chord further along the mark", "[ft|m]", None, "Optional. A later radius must be smaller"
    ),
    Input(
        "ordinate_later",
        "M2",
        "Middle ordinate further along",
        "[ft|m]",
        None,
        "Optional. A later radius must be smaller",
    ),
)

_STEPS = (
    Equation(
        "R_mark",
        "Rmark",
        "Radius of the mark",
        "[ft|m]",
        "chord^2/(8*ordinate)+ordinate/2",
        "circle",
        "1 % of M is about 1 % of the radius and 0.5 % of the speed.",
        number_format="0.00",
    ),
    Equation(
        "R_cg", "R", "Radius of the path of the CG", "[ft|m]", "R_mark-offset", "definition", number_format="0.00"
    ),
    Equation(
        "f_side",
        "fs",
        "Sideways acceleration that friction and bank allow",
        "g",
        "(f+bank/100)/(1-f*bank/100)",
        "equilibrium on a bank",
    ),
    Equation("v", "v", "Critical speed", "[ft|m]/s", "SQRT(f_side*g*R_cg)", "v = √(f g R)"),
    Equation(
        "arc", "2M/C", "Twice the middle ordinate, in chords", "", "2*ordinate/chord", "circle", "1 is a half circle."
    ),
    Equation(
        "R_later",
        "R2",
        "Radius further along",
        "[ft|m]",
        'IF(AND(chord_later>0,ordinate_later>0),chord_later^2/(8*ordinate_later)+ordinate_later/2,"–")',
        "circle",
        number_format="0.00",
    ),
)

_ANSWERS = (
    speed_answer("v", "v", "Critical speed", "v"),
    Equation("R_path", "Rpath", "Radius of the path", "[ft|m]", "R_cg", "above", "", Role.ANSWER, "0.0"),
)

_CHECKS = checks_section(
    3,
    check(
        "check_arc",
        "Chord and middle ordinate are positive, and the arc is below a half circle",
        "AND(chord>0,ordinate>0,arc<1)",
        "geometry",
        "FALSE: chord and middle ordinate exchanged, or in different units?",
    ),
    check(
        "check_radius",
        "The path has a radius",
        "R_cg>0",
        "geometry",
        "FALSE: the offset is larger than the radius of the mark.",
    ),
    check(
        "check_friction",
        "Friction is that of road tyres, up to 1.2",
        "AND(f>0,f<=1.2)",
        "published values",
        "FALSE: more than road tyres hold; the published ranges end at 0.95.",
    ),
    check(
        "check_slowing",
        "The path tightens along the mark",
        "IF(AND(chord_later>0,ordinate_later>0),R_later<R_mark,TRUE)",
        "physics",
        "FALSE: a vehicle in yaw slows and its path tightens; this mark opens. It may not be a critical-speed mark.",
    ),
)

_ARC = tuple(f"{step - 8}/16*chord" for step in range(17))

_DIAGRAM = Diagram(
    "The yaw mark, base case",
    "Along the chord, [ft|m]",
    "Across, [ft|m]",
    (
        Curve("Yaw mark", Look.FIRST, tuple((x, f"SQRT(R_mark^2-({x})^2)-(R_mark-ordinate)") for x in _ARC)),
        Curve("Chord", Look.LINE, (("-chord/2", "0"), ("chord/2", "0"))),
        Curve("Middle ordinate", Look.SECOND_PATH, (("0", "0"), ("0", "ordinate"))),
    ),
    remark="Drawn from the cells below. The scale across is larger than that along.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle that left curved, striated yaw marks while it neither braked nor accelerated hard: all friction "
            "of its tyres acted sideways, so the radius gives the speed.",
            "Measure chord and middle ordinate near the beginning of the mark, where the rear tyre has just left the "
            "front tyre's track. Later radii are smaller, because the vehicle slows: enter one to check.",
            "A short chord makes a small middle ordinate whose reading error decides the answer: the radius varies as "
            "1/M. Choose the chord so that M is read to a few percent.",
            "Not for braking or accelerating tyres, not for marks of a vehicle already spinning, not for a rolling "
            "tyre's scuff. Other answers: skid for what follows in a straight line; the momentum templates for an "
            "impact.",
        ),
    ),
    GuideSection(
        "Friction: published values",
        ("Use a value measured on the scene, and remember that sliding sideways is not braking.",),
        (
            ("Surface", "Friction (g)"),
            *FRICTION_ROWS,
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Critical speed from yaw marks",
    subtitle="Radius from chord and middle ordinate, R = C²/(8M) + M/2; v = √(f g R)",
    rung=2,
    question="How fast was a vehicle that left curved yaw marks?",
    needs="chord and middle ordinate of the mark, friction",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=_OPTIONAL,
    sections=(
        Section("1  Radius and speed", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("Critical speed", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Radius of the path", "R_path", "[ft|m]"),
    ),
    filters=(FilterRow("Arc of the mark", "arc", "The chord spans less than a half circle", above=0, below=1),),
    evidence=(
        seen_speed("Critical speed", "v_[mph|kmh]"),
        told_speed("Critical speed", "v_[mph|kmh]"),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Chord and middle ordinate are measured apart: none.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
)
