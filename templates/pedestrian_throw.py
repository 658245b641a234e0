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
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import seen_speed, told_speed
from templates.speed_answer import speed_answer
from templates.thrown_body import (
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
    FRICTION_ROWS,
    MORE_OF_THROW,
    ON_THE_WAY,
    SHARED_MOMENTUM,
    THROWN,
    projection,
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
    Input(
        "z_fit",
        "zfit",
        "Regression: how far this case is off it, in residual standard deviations",
        "",
        0,
        "Held until a regression is entered below. Residuals of a fit are taken as normal",
        {"Mean": 0, "Std dev": 1},
        "Normal",
        "0.00",
        frozen="=COUNT(fit_k,fit_p,fit_sd)<3",
    ),
)

_REGRESSION = tuple(
    Input(symbol, notation, f"Regression v = k·s^p + c: {name}", unit, None, source)
    for symbol, notation, name, unit, source in (
        (
            "fit_k",
            "k",
            "k",
            "",
            "Optional, of a paper whose cases are like this one; speeds in [mph|km/h], s in [ft|m]. Name the paper, "
            "its cases and its table",
        ),
        ("fit_p", "p", "p", "", "Optional. 0.5 where the speed goes with the root of the distance, 1 for a line"),
        ("fit_c", "c", "c", "[mph|km/h]", "Optional. Blank: 0"),
        (
            "fit_sd",
            "σfit",
            "residual standard deviation",
            "[mph|km/h]",
            "Optional, and needed: without its scatter a regression says nothing of one case",
        ),
    )
)

_CONSTANTS = (GRAVITY, *CONVERSIONS)

_STEPS = (
    *ON_THE_WAY,
    Equation(
        "v_level",
        "vlevel",
        "Projection speed, level (θ = 0)",
        "[ft|m]/s",
        "IF(s_thrown>=(2*mu+slope)*H,SQRT(2*mu_road*g*(s_thrown-mu*H)),"
        "(s_thrown+slope*H)*SQRT(g/(2*H)/SQRT(1+slope^2)))",
        "Searle, with the fall H: √(2 μ g (s − μH)); stopped where it landed: s·√(g/(2·H))",
        "The greatest only of bodies that slide on, thrown at 0 to twice the best angle. Downward, or steeper, it was "
        "more: no upper limit.",
    ),
    Equation(
        "v_least",
        "vmin",
        "Projection speed, lower bound",
        "[ft|m]/s",
        "SQRT(2*mu_road*g*MAX(s_thrown-mu*H,0)/(1+mu^2))",
        "Searle, with the fall H: the best angle, tan θ = μ",
        "No angle throws a body so far at a lower speed.",
    ),
    *projection("v_throw", "v", "Projection speed at the angle given"),
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
    SHARED_MOMENTUM,
    speed_answer("vmin", "vmin", "Projection speed, at least", "v_least"),
    speed_answer("vlevel", "vlevel", "Projection speed, if level", "v_level"),
    speed_answer("v", "v", "Projection speed at the angle given", "v_throw"),
    Equation(
        "V_vehicle_[mph|kmh]",
        "V ([mph|km/h])",
        "«1» speed at the impact",
        "[mph|km/h]",
        f"v_throw/efficiency*(1+slowed)*{MPH}",
        "v/η·(1 + η·mb/mv)",
        "A vehicle is never slower than the body that it throws.",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "v_fit_[mph|kmh]",
        "vfit ([mph|km/h])",
        "«1» speed by the regression entered",
        "[mph|km/h]",
        'IF(COUNT(fit_k,fit_p,fit_sd)=3,fit_k*s^fit_p+N(fit_c)+z_fit*fit_sd,"–")',
        "k·s^p + c + z·σ",
        "A dash: none is entered.",
        Role.ANSWER,
        "0.00",
    ),
)

_CHECKS = checks_section(
    3,
    check(
        "check_distance",
        "The body was thrown, and fell",
        "AND(s_thrown>0,H>=0,N(carried)>=0)",
        "geometry",
        "FALSE: a throw needs a distance; the fall is not negative.",
    ),
    check(
        "check_friction",
        "Friction is that of a body on the ground, up to 1.2",
        "AND(mu>0,mu<=1.2)",
        "plausibility",
        "FALSE: more than a body on the ground can have. A percentage entered as a number?",
    ),
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
)

_SHARES = (*(f"{step**2}/64" for step in range(9)), "1.3", "1.6")


def _against_distance(name: str, look: Look, divisor: str) -> Curve:
    return Curve(
        name,
        look,
        tuple(
            (f"{share}*s_thrown", f"SQRT(2*mu_road*g*MAX({share}*s_thrown-mu*H,0)){divisor}*{MPH}") for share in _SHARES
        ),
    )


_DIAGRAM = Diagram(
    "Projection speed against throw distance, base case",
    "Throw distance, [ft|m]",
    "Projection speed, [mph|km/h]",
    (
        _against_distance("Level (θ = 0)", Look.FIRST, ""),
        _against_distance("Lower bound", Look.SECOND, "/SQRT(1+mu^2)"),
        Curve("This throw", Look.POINT, (("s_thrown", f"v_throw*{MPH}"),)),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A pedestrian or cyclist was struck by the front of a vehicle, projected forward, and slid to rest on "
            "ground of one surface and grade (J. and A. Searle, The Trajectories of Pedestrians, Motorcycles, "
            "Motorcyclists, etc., SAE 831622).",
            "The lower bound needs no angle: no angle throws a body so far at a lower speed. Quote it where the angle "
            "is not known. There is no upper bound without a range of angles: the speed if level is the greatest only "
            "for angles from 0 to twice the best one, 2·arctan μ, and of bodies that slide on. The forecast at an "
            "angle is only as good as that range.",
            "A body that was thrown steeply, or hardly anywhere, stops where it lands. It was faster than the equation "
            "of a sliding body says, and its flight alone gives its speed: sheet Model takes the one that holds.",
            "H is how far the centre of gravity falls, from its height when the body leaves the vehicle to its height "
            "when it lies; more where the ground falls away. Without it speeds come out too high, most for short "
            "throws: at [20 ft and 2.3 ft|6 m and 0.7 m] of fall, by 4 %.",
            "The throw distance is the whole one along the ground, flight and slide together.",
            "The vehicle's speed is at least the projection speed. How much more depends on the kind of throw: about "
            "equal for a high front that pushes the body forward, more for a body that is lifted over the bonnet.",
            "A rider who leaves a motorcycle that stops against a car is thrown as well: H is the fall from the seat "
            "to the road, η the share of the motorcycle's speed with which he left it, and the answer is the speed "
            "of the motorcycle.",
            "A regression of tests or cases (speed against throw distance) stands beside it once its constants and "
            "its residual scatter are entered among the optional inputs. None is filled in: take one from a paper "
            "whose cases had this kind of throw, front and body, and whose scatter it states.",
            "Not for a body carried on the vehicle to rest, thrown over the roof, struck by the corner of the "
            "vehicle, or stopped by an obstacle before it came to rest by sliding.",
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
            ("Vehicle tyres, dry asphalt, averages of recent studies (mfes.com)", ".72 to .78"),
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
    optional=(*MORE_OF_THROW, *_REGRESSION),
    sections=(
        Section("1  Projection speed", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("Projection speed, at least", "vmin_[mph|kmh]", "[mph|km/h]", stated="lower bound"),
        ForecastRow("Projection speed, if level", "vlevel_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Projection speed at the angle", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed", "V_vehicle_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed by the regression entered", "v_fit_[mph|kmh]", "[mph|km/h]"),
    ),
    filters=(
        FilterRow(
            "Angle, in units of twice the best",
            "steepness",
            "A vehicle pushes or lifts a body forward: not steeper than twice the angle that throws farthest",
            at_most=1,
        ),
    ),
    evidence=(
        seen_speed("«1» speed", "V_vehicle_[mph|kmh]"),
        told_speed("«1» speed", "V_vehicle_[mph|kmh]"),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="A lifted body has a steeper angle and a lower efficiency: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
