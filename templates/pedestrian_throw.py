"""A pedestrian is thrown by a vehicle: projection speed from the throw distance, after Searle."""

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
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, SIGNS
from templates.speed_answer import speed_answer
from templates.thrown_body import (
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
    FRICTION_ROWS,
    PROJECTION_SPEED,
    THROWN,
    after_landing,
)
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_ASSUMPTIONS = (
    Input(
        "s",
        "s",
        "Throw distance along the ground, from the impact to rest",
        "[ft|m]",
        Both(60, 18),
        "Example. Enter: surveyed; as wide as the point of impact is uncertain",
        {"Low": Both(56, 17), "High": Both(64, 19)},
        number_format="0.0",
    ),
    *THROWN,
)

_CONSTANTS = (GRAVITY, *CONVERSIONS)

_STEPS = (
    Equation(
        "v_level",
        "vlevel",
        "Projection speed, level (θ = 0)",
        "[ft|m]/s",
        "SQRT(2*mu*g*(s-mu*H))",
        "Searle, with the fall H: √(2 μ g (s − μH))",
        "The greatest only for angles of 0 to twice the best. Downward, or steeper, it was more: no upper limit.",
    ),
    Equation(
        "v_least",
        "vmin",
        "Projection speed, lower bound",
        "[ft|m]/s",
        "SQRT(2*mu*g*(s-mu*H)/(1+mu^2))",
        "Searle, with the fall H: the best angle, tan θ = μ",
        "No angle throws a body so far at a lower speed.",
    ),
    Equation(
        "v_throw",
        "v",
        "Projection speed at the angle given",
        "[ft|m]/s",
        PROJECTION_SPEED,
        "Searle, with the fall H: v = √(2 μ g (s − μH))/(cos θ + μ sin θ)",
        "Flight, landing and slide with one μ; s is the whole distance.",
    ),
    after_landing("v_throw", "v"),
    Equation(
        "angle_best",
        "θbest",
        "Angle that throws farthest",
        "deg",
        "DEGREES(ATAN(mu))",
        "tan θ = μ",
        number_format="0.0",
    ),
)

_ANSWERS = (
    speed_answer("vmin", "vmin", "Projection speed, at least", "v_least"),
    speed_answer("vlevel", "vlevel", "Projection speed, if level", "v_level"),
    speed_answer("v", "v", "Projection speed at the angle given", "v_throw"),
    Equation(
        "V_vehicle_[mph|kmh]",
        "V ([mph|km/h])",
        "«1» speed at the impact",
        "[mph|km/h]",
        f"v_throw/efficiency*{MPH}",
        "v/η",
        "A vehicle is never slower than the body that it throws.",
        Role.ANSWER,
        "0.00",
    ),
)

_CHECKS = checks_section(
    3,
    check(
        "check_distance",
        "The body was thrown, further than its fall alone takes it",
        "AND(s>0,H>=0,s>mu*H)",
        "geometry",
        "FALSE: a throw needs a distance, more than μ·H. Look at the distance and at the fall.",
    ),
    check(
        "check_friction",
        "Friction is that of a body on the ground, up to 1.2",
        "AND(mu>0,mu<=1.2)",
        "plausibility",
        "FALSE: more than a body on the ground can have. A percentage entered as a number?",
    ),
    ANGLE_CHECK,
    check(
        "check_slide",
        "The body slides on after it lands",
        "IF(AND(ABS(angle)<90,mu<=1.2,s>mu*H),u_after>=0,TRUE)",
        "physics",
        "FALSE: so steep, or short, a throw stops where it lands: the formula gives too low a speed. The lower bound "
        "holds.",
    ),
    EFFICIENCY_CHECK,
)

_SHARES = (*(f"{step**2}/64" for step in range(9)), "1.3", "1.6")


def _against_distance(name: str, look: Look, divisor: str) -> Curve:
    return Curve(
        name, look, tuple((f"{share}*s", f"SQRT(2*mu*g*MAX({share}*s-mu*H,0)){divisor}*{MPH}") for share in _SHARES)
    )


_DIAGRAM = Diagram(
    "Projection speed against throw distance, base case",
    "Throw distance, [ft|m]",
    "Projection speed, [mph|km/h]",
    (
        _against_distance("Level (θ = 0)", Look.FIRST, ""),
        _against_distance("Lower bound", Look.SECOND, "/SQRT(1+mu^2)"),
        Curve("This throw", Look.POINT, (("s", f"v_throw*{MPH}"),)),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A pedestrian or cyclist was struck by the front of a vehicle, projected forward, and slid to rest on "
            "level ground of one surface (J. and A. Searle, The Trajectories of Pedestrians, Motorcycles, "
            "Motorcyclists, etc., SAE 831622).",
            "The lower bound needs no angle: no angle throws a body so far at a lower speed. Quote it where the angle "
            "is not known. There is no upper bound without a range of angles: the speed if level is the greatest only "
            "for angles from 0 to twice the best one, 2·arctan μ. The forecast at an angle is only as good as that "
            "range.",
            "H is how far the centre of gravity falls, from its height when the body leaves the vehicle to its height "
            "when it lies; more where the ground falls away. Without it speeds come out too high, most for short "
            "throws: at [20 ft and 2.3 ft|6 m and 0.7 m] of fall, by 4 %.",
            "The throw distance is the whole one along the ground, flight and slide together.",
            "The vehicle's speed is at least the projection speed. How much more depends on the kind of throw: about "
            "equal for a high front that pushes the body forward, more for a body that is lifted over the bonnet.",
            "Not for a body carried on the vehicle, thrown over the roof, struck by the corner of the vehicle, or "
            "stopped by an obstacle before it came to rest by sliding.",
            "Beside it: skid, for a vehicle that braked to rest from the impact.",
        ),
    ),
    GuideSection(
        "Friction: published values",
        (
            "Values that authors use with their equations, as J. Eubanks lists them (Current Trends in Pedestrian "
            "Crash Reconstruction, SATAI, 12 July 2008), and below them other things that slide on the same scene. "
            "Each belongs to its author's equation. Tests of clothed dummies on the surface in question are better.",
        ),
        (
            ("Author, or what slides", "Friction"),
            *FRICTION_ROWS,
            ("Motorcycle on its side", ".45 to .58"),
            ("Motorcycle with a fairing", "about .26"),
            ("Vehicle tyres, dry asphalt, averages of tests", ".72 to .78"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from a pedestrian's throw distance",
    subtitle="Searle: v = √(2 μ g (s − μH))/(cos θ + μ sin θ), at least √(2 μ g (s − μH)/(1 + μ²))",
    rung=8,
    question="How fast was the vehicle that threw a pedestrian so far?",
    needs="throw distance, fall and friction of the body",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(
        Section("1  Projection speed", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("Projection speed, at least", "vmin_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Projection speed, if level", "vlevel_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Projection speed at the angle", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed", "V_vehicle_[mph|kmh]", "[mph|km/h]"),
    ),
    filters=(
        FilterRow(
            "Slides on after landing",
            "u_after",
            "A body that stops where it lands is outside the formula. The lower bound holds for it too",
            at_least=0,
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="A lifted body has a steeper angle and a lower efficiency: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
