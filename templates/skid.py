"""A vehicle skids over up to three surfaces: its speed at the beginning of the marks."""

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
from templates.guidance import CAVEATS, FIRST_STEPS, SIGNS
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_SURFACES = (1, 2, 3)
_FRICTION = "Example, dry asphalt: uniform .70 to .85, tails to .60 and .95 (SAE 2001-01-3347, Figure 4 and Table 1)"
_FURTHER = "Example, held: set Frozen to FALSE, and a length, where the skid goes on over another surface"


def _surface(number: int) -> tuple[Input, Input]:
    first = number == 1
    return (
        Input(
            f"f_{number}",
            f"f{number}",
            f"Surface {number} friction",
            "g",
            0.75,
            _FRICTION if first else _FURTHER,
            {"Low": 0.60, "Low likeliest": 0.70, "High likeliest": 0.85, "High": 0.95}
            if first
            else {"Low": 0.60, "High": 0.95},
            "Trapezoid" if first else "Uniform",
            "0.000",
            frozen=not first,
        ),
        Input(
            f"d_{number}",
            f"d{number}",
            f"Surface {number} length of skid",
            "[ft|m]",
            Both(100, 30) if first else 0,
            "Example. Enter: the length surveyed, as wide as its ends are uncertain" if first else _FURTHER,
            {"Low": Both(97, 29.1), "High": Both(103, 30.9)} if first else {"Low": 0, "High": Both(10, 3)},
            number_format="0.0",
            frozen=not first,
        ),
    )


_ASSUMPTIONS = (
    *(given for number in _SURFACES for given in _surface(number)),
    Input(
        "v_end",
        "vend",
        "Speed at the end of the skid",
        "[mph|km/h]",
        0,
        "Example, held at 0: the vehicle slid to rest. Enter the impact speed where the skid ended in an impact",
        {"Low": 0, "High": Both(5, 8)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "t_reaction",
        "tr",
        "Perception and response time",
        "s",
        1.25,
        "Published distribution: mean 1.25 s, standard deviation 0.46 s; cut off where no one can respond",
        {"Mean": 1.25, "Std dev": 0.46, "Lower cutoff": 0.3},
        "Normal",
        "0.00",
    ),
)

_CONSTANTS = (
    Input(
        "grade",
        "G",
        "Grade along the skid, uphill positive",
        "%",
        0,
        "Enter: the survey; rise over run",
        number_format="0.0",
    ),
    Input(
        "braking",
        "n",
        "Share of full braking",
        "",
        1,
        "1: all wheels locked or at the limit. Less where wheels did not brake",
        number_format="0.00",
    ),
    GRAVITY,
    *CONVERSIONS,
)


def _steps() -> tuple[Equation, ...]:
    slope = Equation("theta", "θ", "Slope", "rad", "ATAN(grade/100)", "definition")
    drags = (
        Equation(
            f"drag_{i}",
            f"a{i}",
            f"Surface {i} deceleration along the road",
            "g",
            f"braking*f_{i}*COS(theta)+SIN(theta)",
            "f·cos θ ± sin θ",
            "Friction works on the weight across the slope; the slope itself helps uphill." if i == 1 else "",
        )
        for i in _SURFACES
    )
    end = Equation("v_end_s", "vend", "Speed at the end", "[ft|m]/s", f"v_end/({MPH})", "input")
    work = Equation(
        "work",
        "W",
        "Work of friction and slope, per unit mass",
        "[ft|m]²/s²",
        f"g*({'+'.join(f'drag_{i}*d_{i}' for i in _SURFACES)})",
        "Σ g·a·d",
        number_format="0.00",
    )
    speed = Equation("v_start", "v", "Speed at the beginning", "[ft|m]/s", "SQRT(2*work+v_end_s^2)", "√(2·W + vend²)")
    return (slope, *drags, end, work, speed)


_ANSWERS = (
    Equation(
        "v_[mph|kmh]",
        "v",
        "Speed at the beginning of the skid",
        "[mph|km/h]",
        f"v_start*{MPH}",
        "energy",
        "Braking before the marks begin is not in it: a lower bound of the speed on perceiving danger.",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "d_reaction",
        "dr",
        "Distance covered while perceiving and responding",
        "[ft|m]",
        "v_start*t_reaction",
        "v·tr",
        "",
        Role.ANSWER,
        "0.0",
    ),
    Equation(
        "d_total",
        "d",
        "Distance from perception to the end of the skid",
        "[ft|m]",
        "d_reaction+d_1+d_2+d_3",
        "definition",
        "",
        Role.ANSWER,
        "0.0",
    ),
)

_TIMES = (
    Equation("d_skid", "Σd", "Length of the whole skid", "[ft|m]", "d_1+d_2+d_3", "definition", number_format="0.0"),
    Equation(
        "drag_mean",
        "ā",
        "Mean deceleration",
        "g",
        "work/(g*d_skid)",
        "definition",
        number_format="0.000",
    ),
)

_CHECKS = checks_section(
    4,
    check(
        "check_slowing",
        "The vehicle slows on every surface",
        "MIN(drag_1,drag_2,drag_3)>0",
        "physics",
        "FALSE: the slope pulls more than friction holds. Look at the grade's sign and at the friction.",
    ),
    check(
        "check_lengths",
        "No length is negative, and one is not zero",
        "AND(MIN(d_1,d_2,d_3)>=0,d_skid>0)",
        "geometry",
        "FALSE: a skid needs a length.",
    ),
    check(
        "check_friction",
        "Frictions are those of road tyres, up to 1.2",
        "AND(MIN(f_1,f_2,f_3)>0,MAX(f_1,f_2,f_3)<=1.2,braking>0,braking<=1)",
        "published values",
        "FALSE: more than road tyres give; the published range ends at 0.95. A percentage entered as a number?",
    ),
    check(
        "check_end",
        "The speed at the end is not negative, and below the one at the beginning",
        "AND(v_end>=0,v_start>v_end_s)",
        "physics",
        "FALSE: skidding takes speed away.",
    ),
)


_LEFT = tuple(f"{(8 - step) ** 2}/64" for step in range(9))
"""Of a surface, still to be slid; points closer together toward its end, where the speed changes fastest."""


def _point(surface: int, left: str) -> tuple[str, str]:
    """Distance slid, and speed: v² is what remains to be taken away, counted back from the end."""
    before = "+".join(f"d_{k}" for k in _SURFACES if k < surface) or "0"
    after = "".join(f"+drag_{k}*d_{k}" for k in _SURFACES if k > surface)
    work = f"{left}*drag_{surface}*d_{surface}{after}"
    return f"{before}+(1-{left})*d_{surface}", f"SQRT(MAX(v_end_s^2+2*g*({work}),0))*{MPH}"


_DIAGRAM = Diagram(
    "Speed along the skid, base case",
    "Distance from the beginning of the marks, [ft|m]",
    "Speed, [mph|km/h]",
    (
        Curve("Speed", Look.FIRST, tuple(_point(i, left) for i in _SURFACES for left in _LEFT)),
        Curve("End of a surface", Look.POINT, tuple(_point(i, "0") for i in _SURFACES)),
    ),
    remark="Drawn from the cells below. v² falls in proportion to the distance on each surface.",
)

_GUIDE = (
    GuideSection(
        "This workbook",
        ("A template. The numbers in it are an example: replace every green cell, every range, every source.",),
    ),
    FIRST_STEPS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle that slid, all wheels locked or at the limit of anti-lock braking, over surfaces of known "
            "friction, to rest or to a known speed. It answers the speed at the first mark.",
            "Where the skid ended in an impact, take the speed at its end from an impact model, such as momentum, and "
            "enter it: speeds combine as √(v² + vend²), they do not add.",
            "Not for a rolling vehicle, for one that spins (use critical-speed-yaw where it left curved yaw marks), "
            "nor where only some wheels brake unless their share is entered.",
            "Next rungs: collinear, momentum and planar-impact take run-out to rest, computed as here, as the speed "
            "after an impact.",
        ),
    ),
    GuideSection(
        "Friction: published values",
        ("Measure on the scene with a similar car where you can. The ranges below are no substitute for that.",),
        (
            ("Surface", "Friction (g)"),
            ("Dry asphalt, averages of tests", ".72 to .78"),
            ("Travelled asphalt, below 30 mph", ".60 to .80"),
            ("Travelled asphalt, above 30 mph", ".55 to .70"),
            ("Case study of SAE 2001-01-3347, dry asphalt", ".60 to .95"),
            ("Shape of the paper's Figure 4", "uniform .70 to .85, straight tails to the extremes of the literature"),
            ("Motorcycle sliding on its side", ".45 to .58; with a fairing about .26"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from skid marks",
    subtitle="Friction and slope over up to three surfaces: v = √(2 g Σ a d + vend²)",
    rung=1,
    question="How fast was a skidding vehicle, and where was danger perceived?",
    needs="length and friction of each surface, grade",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(
        Section("1  Speed from the work of friction", _steps()),
        Section("2  Answers (the forecasts)", _ANSWERS),
        Section("3  The whole skid", _TIMES),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("Speed at the beginning of the skid", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Distance while responding", "d_reaction", "[ft|m]"),
        ForecastRow("Distance from perception", "d_total", "[ft|m]"),
    ),
    filters=(
        FilterRow("Mean deceleration", "drag_mean", "The skid slowed the vehicle; it did not speed it up", above=0),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Several surfaces alike? First = Surface 1 friction, Second = Surface 2 friction, 0.8, say.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
)
