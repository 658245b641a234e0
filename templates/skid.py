"""A vehicle skids over up to three surfaces, yaws, trips and rolls: its speed at the beginning, or at the end."""

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
from templates.units import CONVERSIONS, GRAVITY, MPH
from templates.vehicles import phase

__all__ = ["TEMPLATE"]

_SURFACES = (1, 2, 3)
_LATER = (
    ("yaw", "Yaw", FRICTION, (0.55, 0.80), "Tyres that slide sideways: as for braking. Held at length 0 until used"),
    (
        "trip",
        "Trip",
        FRICTION,
        (0.55, 0.80),
        "No published value is known here: as tyres that slide, until you enter one. Held at length 0 until used",
    ),
    (
        "roll",
        "Roll",
        0.50,
        (0.40, 0.60),
        "Dolly tests on soil: .52 and .53 over the whole roll (Rose, Rollover Accident Reconstruction); within one "
        "roll from .6 to .2, whose middle is .4 (SAE 2009-01-0093). Held at length 0 until used",
    ),
)
"""Phases after the skid: symbol, name until another is typed, deceleration, its range, source."""
_PHASES = (*map(str, _SURFACES), *(symbol for symbol, *_ in _LATER))
_FURTHER_FRICTION = "As the first surface, held: set Frozen to FALSE, and enter its own where the skid goes on over it"
_FURTHER = "Example, held: set Frozen to FALSE, and a length, where the skid goes on over another surface"


def _surface(number: int) -> tuple[Input, Input]:
    first = number == 1
    return (
        Input(
            f"f_{number}",
            f"f{number}",
            f"{phase(number)} friction",
            "g",
            FRICTION,
            FRICTION_SOURCE if first else _FURTHER_FRICTION,
            FRICTION_SHAPE,
            "Trapezoid",
            "0.000",
            frozen=not first,
        ),
        Input(
            f"d_{number}",
            f"d{number}",
            f"{phase(number)} length of skid",
            "[ft|m]",
            Both(100, 30) if first else 0,
            "Example. Enter: the length surveyed, as wide as its ends are uncertain" if first else _FURTHER,
            {"Low": Both(97, 29.1), "High": Both(103, 30.9)} if first else {"Low": 0, "High": Both(10, 3)},
            number_format="0.0",
            frozen=not first,
        ),
    )


def _named(symbol: str) -> str:
    """What stands in labels for the name of a phase."""
    return phase(1 + _PHASES.index(symbol))


def _later(symbol: str, base: float, ends: tuple[float, float], source: str) -> tuple[Input, Input]:
    return (
        Input(
            f"f_{symbol}",
            f"f{symbol}",
            f"{_named(symbol)}: deceleration",
            "g",
            base,
            source,
            {"Low": ends[0], "High": ends[1]},
            number_format="0.000",
            frozen=True,
        ),
        Input(
            f"d_{symbol}",
            f"d{symbol}",
            f"{_named(symbol)}: length",
            "[ft|m]",
            0,
            "Held at 0. Enter the length surveyed, and set both Frozen to FALSE",
            {"Low": 0, "High": Both(10, 3)},
            number_format="0.0",
            frozen=True,
        ),
    )


_ASSUMPTIONS = (
    *(given for number in _SURFACES for given in _surface(number)),
    *(given for symbol, _, *rest in _LATER for given in _later(symbol, *rest)),
    Input(
        "v_end",
        "vend,given",
        "Speed at the end of the skid",
        "[mph|km/h]",
        0,
        "Example, held at 0: the vehicle slid to rest. Enter the impact speed where the skid ended in an impact",
        {"Low": 0, "High": Both(5, 8)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "v_begin",
        "vbegin,given",
        "Speed at the beginning of the skid (used where known = 2)",
        "[mph|km/h]",
        Both(55, 90),
        "Example, held. Enter: event data recorder, video; set Frozen to FALSE",
        {"Low": Both(53, 86), "High": Both(57, 94)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "t_reaction",
        "tr",
        "Perception and response time",
        "s",
        1.25,
        "To brake lights, surprise: mean 1.25 s, SD 0.46 s (Ergonomics, 1993); cut off where no one can respond",
        {"Mean": 1.25, "Std dev": 0.46, "Lower cutoff": 0.3},
        "Normal",
        "0.00",
    ),
)

_CONSTANTS = (
    Input(
        "known",
        "",
        "Known speed: 1 = at the end of the skid, 2 = at its beginning",
        "",
        1,
        "1: how fast was it at the first mark? 2: how fast was it still at the end, where it struck something?",
        number_format="0",
        choices=(1, 2),
    ),
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

_OPTIONAL = (
    Input(
        "t_rise",
        "trise",
        "Air brakes: time until they are fully on",
        "s",
        None,
        "Optional. 0.45 s fits 49 CFR 571.121 (2011): "
        "[60 mph in 250 ft, 20 mph in 32 ft|97 km/h in 76 m, 32 km/h in 10 m]. "
        "With it, the length is counted from the application of the brakes",
        number_format="0.00",
    ),
)


def _steps() -> tuple[Equation, ...]:
    slope = Equation("theta", "θ", "Slope", "rad", "ATAN(grade/100)", "definition")
    drags = (
        Equation(
            f"drag_{i}",
            f"a{i}",
            f"{phase(i)} deceleration along the road",
            "g",
            f"braking*f_{i}*COS(theta)+SIN(theta)",
            "f·cos θ ± sin θ",
            "Friction works on the weight across the slope; the slope itself helps uphill." if i == 1 else "",
        )
        for i in _SURFACES
    )
    later = (
        Equation(
            f"drag_{symbol}",
            f"a{symbol}",
            f"{_named(symbol)}: deceleration along the road",
            "g",
            f"f_{symbol}*COS(theta)+SIN(theta)",
            "f·cos θ ± sin θ",
        )
        for symbol, *_ in _LATER
    )
    begin = Equation(
        "v_begin_s", "vbegin", "Speed at the beginning, where known", "[ft|m]/s", f"v_begin/({MPH})", "input"
    )
    left = Equation(
        "left_2",
        "vbegin² − 2·W",
        "Square of the speed left at the end, where the beginning is known",
        "[ft|m]²/s²",
        "IF(known=2,v_begin_s^2-2*work,0)",
        "energy",
        "Below 0 it would have stopped before the end.",
        number_format="0.00",
    )
    end = Equation(
        "v_end_s",
        "vend",
        "Speed at the end",
        "[ft|m]/s",
        f"IF(known=2,SQRT(MAX(left_2,0)),v_end/({MPH}))",
        "input, or √(vbegin² − 2·W)",
    )
    work = Equation(
        "work",
        "W",
        "Work of friction and slope, per unit mass",
        "[ft|m]²/s²",
        f"g*({'+'.join(f'drag_{i}*d_{i}' for i in _PHASES)})",
        "Σ g·a·d",
        number_format="0.00",
    )
    speed = Equation(
        "v_start",
        "v",
        "Speed at the beginning",
        "[ft|m]/s",
        "IF(known=2,v_begin_s,SQRT(2*work+v_end_s^2))",
        "√(2·W + vend²)",
    )
    return (slope, *drags, *later, work, begin, left, end, speed)


_ANSWERS = (
    speed_answer(
        "vend",
        "vend",
        "Speed at the end of the skid",
        "v_end_s",
        "The impact speed, where the skid ended in an impact.",
    ),
    Equation(
        "v_[mph|kmh]",
        "v ([mph|km/h])",
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
        "d_reaction+d_skid",
        "definition",
        "",
        Role.ANSWER,
        "0.0",
    ),
)

_TIMES = (
    Equation(
        "d_skid",
        "Σd",
        "Length of the whole skid",
        "[ft|m]",
        "+".join(f"d_{i}" for i in _PHASES),
        "definition",
        number_format="0.0",
    ),
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
_AIR_BRAKES = (
    Equation(
        "way_air",
        "Q",
        "Stopping distance, with what the rise of the brakes hides",
        "[ft|m]",
        'IF(N(t_rise)>0,d_skid+drag_mean*g*t_rise^2/24,"–")',
        "S + a·trise²/24",
        number_format="0.00",
    ),
    Equation(
        "v_air_[mph|kmh]",
        "vair ([mph|km/h])",
        "Speed when the brakes were applied, stopped by air brakes",
        "[mph|km/h]",
        f'IF(N(t_rise)>0,2*way_air/(t_rise/2+SQRT(t_rise^2/4+2*way_air/(drag_mean*g)))*{MPH},"–")',
        "S = V·trise/2 + V²/(2·a) − a·trise²/24",
        "To rest; the brakes rise evenly until fully on. A dash until the time is entered on sheet Inputs.",
        number_format="0.00",
    ),
)

_CHECKS = checks_section(
    5,
    check(
        "check_slowing",
        "The vehicle slows on every surface",
        "MIN(" + ",".join(f"drag_{i}" for i in _PHASES) + ")>0",
        "physics",
        "FALSE: the slope pulls more than friction holds. Look at the grade's sign and at the friction.",
    ),
    check(
        "check_lengths",
        "No length is negative, and one is not zero",
        "AND(MIN(" + ",".join(f"d_{i}" for i in _PHASES) + ")>=0,d_skid>0)",
        "geometry",
        "FALSE: a skid needs a length.",
    ),
    check(
        "check_friction",
        "Frictions are those of road tyres, up to 1.2",
        "AND(MIN({0})>0,MAX({0})<=1.2,braking>0,braking<=1)".format(",".join(f"f_{i}" for i in _PHASES)),
        "published values",
        "FALSE: more than road tyres give; the published ranges end at 0.95. A percentage entered as a number?",
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


def _point(phase: str, left: str) -> tuple[str, str]:
    """Distance slid, and speed: v² is what remains to be taken away, counted back from the end."""
    at = _PHASES.index(phase)
    before = "+".join(f"d_{k}" for k in _PHASES[:at]) or "0"
    after = "".join(f"+drag_{k}*d_{k}" for k in _PHASES[at + 1 :])
    work = f"{left}*drag_{phase}*d_{phase}{after}"
    return f"{before}+(1-{left})*d_{phase}", f"SQRT(MAX(v_end_s^2+2*g*({work}),0))*{MPH}"


_DIAGRAM = Diagram(
    "Speed along the skid, base case",
    "Distance from the beginning of the marks, [ft|m]",
    "Speed, [mph|km/h]",
    (
        Curve("Speed", Look.FIRST, tuple(_point(phase, left) for phase in _PHASES for left in _LEFT)),
        Curve("End of a phase", Look.POINT, tuple(_point(phase, "0") for phase in _PHASES)),
    ),
    remark="Drawn from the cells below. v² falls in proportion to the distance in each phase.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle that slid, all wheels locked or at the limit of anti-lock braking, over surfaces of known "
            "friction, to rest or to a known speed. It answers the speed at the first mark.",
            "Where the skid ended in an impact, take the speed at its end from an impact model, such as momentum, and "
            "enter it: speeds combine as √(v² + vend²), they do not add.",
            "Where the speed at the first mark is known instead (an EDR, a video), set Known speed to 2: the answer is "
            "then the speed at the end, such as the impact speed.",
            "Phases after the skid: yaw (tyres slide sideways), trip, roll. Enter their lengths; each takes its own "
            "deceleration. Type over the yellow names above the table of Inputs to call surfaces and phases as you "
            "like, in the order in which they followed each other. A motorcycle: Braking as the first, Sliding on its "
            "side as the second.",
            "Air brakes need time to rise. With that time entered, sheet Model also gives the speed of a vehicle that "
            "stopped in the whole length, counted from the application of the brakes, not from the first mark.",
            "Not for a rolling vehicle, for one that spins (use critical-speed-yaw where it left curved yaw marks), "
            "nor where only some wheels brake unless their share is entered.",
            "Next models: collinear, momentum and planar-impact take run-out to rest, computed as here, as the speed "
            "after an impact.",
        ),
    ),
    GuideSection(
        "Friction: published values",
        ("Measure on the scene with a similar car where you can. The ranges below are no substitute for that.",),
        (
            ("Surface", "Friction (g)"),
            *FRICTION_ROWS,
            ("Shape of the paper's Figure 4", "uniform .70 to .85, straight tails to the extremes of the literature"),
            ("Motorcycle on its side, [25 mph|40 km/h] (Day and Smith, 1984)", ".45 to .58"),
            ("Motorcycle on its side, fairing (Raftery, 1995)", ".26; without fairing .33"),
            ("Riders braking in an emergency", "half used at most 56 % of the possible deceleration (Ecker, 2001)"),
            ("Tyres locked, dry (TRL PPR496)", ".7 to .9"),
            ("Rolling over, soil, whole roll (Rose)", ".52 and .53"),
            (
                "Heavy tractor, 49 CFR 571.121 (2011)",
                "[from 60 mph: loaded 250 ft, light 235 ft; from 20 mph: 32 and 30 ft|"
                "from 97 km/h: loaded 76 m, light 72 m; from 32 km/h: 9.8 and 9.1 m]",
            ),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from skid marks",
    subtitle="Friction and slope over surfaces and phases: v = √(2 g Σ a d + vend²)",
    rung=1,
    question="How fast was a skidding vehicle, and where was danger perceived?",
    needs="length and friction of each surface, grade",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=_OPTIONAL,
    sections=(
        Section("1  Speed from the work of friction", _steps()),
        Section("2  Answers (the forecasts)", _ANSWERS),
        Section("3  The whole skid", _TIMES),
        Section("4  Optional: air brakes", _AIR_BRAKES),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("Speed at the beginning of the skid", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Speed at the end of the skid", "vend_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Distance while responding", "d_reaction", "[ft|m]"),
        ForecastRow("Distance from perception", "d_total", "[ft|m]"),
    ),
    filters=(
        FilterRow(
            "Reaches the end", "left_2", "Where the beginning is known: it did not stop before the end", at_least=0
        ),
        FilterRow("Mean deceleration", "drag_mean", "The skid slowed the vehicle; it did not speed it up", above=0),
    ),
    evidence=(
        seen_speed("Speed at the beginning of the skid", "v_[mph|kmh]"),
        seen_speed("Speed at the end of the skid", "vend_[mph|kmh]"),
        told_speed("Speed at the beginning of the skid", "v_[mph|kmh]"),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note=f"Several surfaces alike? First = {phase(1)} friction, Second = {phase(2)} friction, 0.8, say.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=(*(f"Surface {number}" for number in _SURFACES), *(name for _, name, *_ in _LATER)),
    named="phase",
)
