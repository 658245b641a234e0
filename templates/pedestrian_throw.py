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
from templates.thrown_body import EFFICIENCY_CHECK, THROWN
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_ASSUMPTIONS = (
    Input(
        "s",
        "s",
        "Throw distance, from the impact to rest",
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
        "v_most",
        "vmax",
        "Projection speed, upper bound",
        "[ft|m]/s",
        "SQRT(2*mu*g*s)",
        "Searle: horizontal projection",
        "The body slides all the way, as a skid.",
    ),
    Equation(
        "v_least",
        "vmin",
        "Projection speed, lower bound",
        "[ft|m]/s",
        "SQRT(2*mu*g*s/(1+mu^2))",
        "Searle: the best angle, tan θ = μ",
        "No angle throws a body so far at a lower speed.",
    ),
    Equation(
        "v_throw",
        "v",
        "Projection speed at the angle given",
        "[ft|m]/s",
        "SQRT(2*mu*g*s)/(COS(RADIANS(angle))+mu*SIN(RADIANS(angle)))",
        "Searle: v = √(2 μ g s)/(cos θ + μ sin θ)",
        "Up to twice the best angle it lies between the bounds; steeper, above them.",
    ),
    Equation(
        "angle_best",
        "θbest",
        "Angle that throws farthest",
        "deg",
        "DEGREES(ATAN(mu))",
        "tan θ = μ",
        number_format="0.0",
    ),
    Equation("steepness", "", "Angle, in units of twice the best", "", "angle/(2*angle_best)", "definition"),
)

_ANSWERS = (
    speed_answer("vmin", "vmin", "Projection speed, at least", "v_least"),
    speed_answer("vmax", "vmax", "Projection speed, at most", "v_most"),
    speed_answer("v", "v", "Projection speed at the angle given", "v_throw"),
    Equation(
        "V_vehicle_[mph|kmh]",
        "V",
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
    check("check_distance", "The body was thrown", "s>0", "geometry", "FALSE: a throw needs a distance."),
    check(
        "check_friction",
        "Friction is that of a body on the ground, up to 1.2",
        "AND(mu>0,mu<=1.2)",
        "plausibility",
        "FALSE: more than a body on the ground can have. A percentage entered as a number?",
    ),
    check(
        "check_angle",
        "The angle of projection is that of a throw",
        "AND(angle>=0,angle<=2*angle_best)",
        "physics",
        "FALSE: outside 0 to 2 θbest the bounds do not hold; a vehicle does not project so steeply.",
    ),
    EFFICIENCY_CHECK,
)

_SHARES = (*(f"{step**2}/64" for step in range(9)), "1.3", "1.6")


def _against_distance(name: str, look: Look, divisor: str) -> Curve:
    return Curve(name, look, tuple((f"{share}*s", f"SQRT(2*mu*g*{share}*s){divisor}*{MPH}") for share in _SHARES))


_DIAGRAM = Diagram(
    "Projection speed against throw distance, base case",
    "Throw distance, [ft|m]",
    "Projection speed, [mph|km/h]",
    (
        _against_distance("Upper bound", Look.FIRST, ""),
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
            "The two bounds need no angle: quote them where the angle is not known. The forecast at an angle is only "
            "as good as the range of the angle.",
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
            "Tests of clothed dummies on the surface in question give the friction of a body; none is quoted here. "
            "The values below are of other things that slide on the same scene.",
        ),
        (
            ("What slides", "Friction"),
            ("Motorcycle on its side", ".45 to .58"),
            ("Motorcycle with a fairing", "about .26"),
            ("Vehicle tyres, dry asphalt, averages of tests", ".72 to .78"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from a pedestrian's throw distance",
    subtitle="Searle: v between √(2 μ g s/(1 + μ²)) and √(2 μ g s)",
    rung=8,
    question="How fast was the vehicle that threw a pedestrian so far?",
    needs="throw distance, friction of the body on the ground",
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
        ForecastRow("Projection speed, at most", "vmax_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Projection speed at the angle", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed", "V_vehicle_[mph|kmh]", "[mph|km/h]"),
    ),
    filters=(
        FilterRow(
            "Angle within the bounds",
            "steepness",
            "Steeper than twice the best angle, the throw would leave Searle's bounds",
            at_most=1,
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="A lifted body has a steeper angle and a lower efficiency: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
