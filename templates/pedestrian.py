"""A braking vehicle strikes a pedestrian: skid, throw and walking on one sheet."""

from __future__ import annotations

from templates.braking import (
    BRAKED_CHECK,
    BRAKED_INPUT,
    BRAKING,
    BRAKING_CHECK,
    BRAKING_INPUT,
    BRAKING_TIME,
    NO_BRAKING,
    RESPONSE_BEYOND,
    RESPONSE_FILTER,
    RESPONSE_LIMITS,
    SCENE_SHOWS,
    STOPPING_SPEED,
    way_braked,
)
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
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.speed_answer import speed_answer
from templates.thrown_body import (
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
    MORE_OF_THROW,
    ON_THE_WAY,
    SHARED_MOMENTUM,
    THROWN,
    projection,
)
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_ASSUMPTIONS = (
    BRAKING_INPUT,
    Input(
        "d_before",
        "db",
        "«1» marks before the impact (used where it braked)",
        "[ft|m]",
        Both(30, 9),
        "Example. Enter: surveyed up to the point of impact. Did it not brake? Answer 2 below",
        {"Low": Both(27, 8), "High": Both(33, 10)},
        number_format="0.0",
    ),
    Input(
        "d_after",
        "da",
        "«1» braking after the impact, to rest",
        "[ft|m]",
        Both(50, 15),
        "Example. Enter: from the point of impact to rest, where it braked all the way; 0 where that is not known",
        {"Low": Both(47, 14), "High": Both(53, 16)},
        number_format="0.0",
    ),
    Input(
        "s",
        "s",
        "Throw distance along the ground, from the impact to rest",
        "[ft|m]",
        Both(54, 16.5),
        "Example. Enter: surveyed; as wide as the point of impact is uncertain; 0 where it is not known",
        {"Low": Both(50, 15.5), "High": Both(58, 17.5)},
        number_format="0.0",
    ),
    *THROWN,
    Input(
        "walked",
        "dw",
        "Pedestrian: way from becoming a hazard to the impact",
        "[ft|m]",
        Both(10, 3.0),
        "Example. Enter: from the kerb, or from where a driver could see that they would cross",
        {"Low": Both(9, 2.7), "High": Both(11, 3.3)},
        number_format="0.0",
    ),
    Input(
        "walking",
        "u",
        "Pedestrian: walking speed",
        "[ft|m]/s",
        Both(4.5, 1.4),
        "Experts' reports take [4 to 5 ft/s|1.2 to 1.5 m/s]; see sheet Guide for age",
        {"Low": Both(4, 1.2), "High": Both(5, 1.5)},
        number_format="0.00",
    ),
)

_CONSTANTS = (
    Input(
        "known",
        "",
        "Impact speed taken from: 1 = marks after the impact, 2 = throw",
        "",
        1,
        "Choose the better one. The other stands beside it as evidence (sheet Evidence)",
        number_format="0",
        choices=(1, 2),
    ),
    BRAKED_INPUT,
    Input(
        "limit",
        "V ([mph|km/h])",
        "Speed that the question is about, such as the limit",
        "[mph|km/h]",
        Both(30, 50),
        "Enter: the posted limit",
        number_format="0.0",
    ),
    *RESPONSE_LIMITS,
    GRAVITY,
    *CONVERSIONS,
)

_SPEED = (
    BRAKING,
    *way_braked("d_before", "db"),
    Equation(
        "marks_known",
        "",
        "Marks after the impact were measured (1 = yes)",
        "",
        "IF(d_after>0,1,0)",
        "input",
        "A blank length is no measurement: it gives no speed.",
        number_format="0",
    ),
    SHARED_MOMENTUM,
    Equation(
        "v_marks",
        "vs",
        "Impact speed, from the marks after it",
        "[ft|m]/s",
        "IF(marks_known=1,SQRT(2*b*d_after)*(1+slowed),NA())",
        "√(2·b·da)·(1 + η·mb/mv)",
        "The marks give the speed after the impact, in which the vehicle had given its share to the body.",
    ),
    Equation(
        "throw_known",
        "",
        "A throw was measured (1 = yes)",
        "",
        "IF(s>0,1,0)",
        "input",
        number_format="0",
    ),
    *ON_THE_WAY,
    *projection("v_projected", "vp", "Projection speed of the body", where="throw_known=1"),
    Equation(
        "v_thrown",
        "vt",
        "Impact speed, from the throw",
        "[ft|m]/s",
        "v_projected/efficiency*(1+slowed)",
        "vp / η · (1 + η·mb/mv)",
        "A vehicle is never slower than the body that it throws.",
    ),
    Equation("v_i", "vi", "Impact speed", "[ft|m]/s", "IF(known=2,v_thrown,v_marks)", "input"),
    Equation("v_0", "v0", "Speed before braking", "[ft|m]/s", "SQRT(v_i^2+2*b*d_braked)", "√(vi² + 2·b·d)"),
)

_TIME = (
    Equation("t_walk", "tw", "From becoming a hazard to the impact", "s", "walked/walking", "dw / u"),
    BRAKING_TIME,
    Equation(
        "t_response",
        "tr",
        "Response time that this crash implies",
        "s",
        "t_walk-t_brake",
        "tw − tb",
        "Without braking: at least.",
    ),
    RESPONSE_BEYOND,
    Equation(
        "D_0",
        "D0",
        "«1» distance from the point of impact when the hazard began",
        "[ft|m]",
        "v_0*t_response+d_braked",
        "v0·tr + d",
        number_format="0.00",
    ),
    Equation("V_s", "V", "The speed in question", "[ft|m]/s", f"limit/({MPH})", "input"),
    Equation(
        "stops",
        "",
        "Same driver at that speed: stops before the point of impact, at most (1 = yes)",
        "",
        "IF(AND(D_0-V_s*t_response>0,V_s^2<=2*b*(D_0-V_s*t_response)),1,0)",
        "V² ≤ 2·b·(D0 − V·tr)",
        "The template time-distance also asks whether the pedestrian would have cleared.",
        number_format="0",
    ),
    Equation(
        "stops_least",
        "",
        "The same, at least (1 = yes)",
        "",
        "IF(did_brake=1,stops,0)",
        "without braking: 0",
        "A driver who had not responded when he struck may never have braked.",
        number_format="0",
    ),
)

_ANSWERS = (
    speed_answer("vi", "vi", "Impact speed", "v_i"),
    speed_answer("vs", "vs", "Impact speed, from the marks", "v_marks"),
    speed_answer("vt", "vt", "Impact speed, from the throw", "v_thrown"),
    speed_answer("v0", "v0", "Speed before braking", "v_0"),
    STOPPING_SPEED,
    Equation(
        "apart",
        "vt − vs ([mph|km/h])",
        "Impact speed from the throw, less that from the marks",
        "[mph|km/h]",
        f"(v_thrown-v_marks)*{MPH}",
        "definition",
        "Two answers to one question: near 0 where both are right. None where one was not measured.",
        Role.ANSWER,
        "0.00",
    ),
)

_CHECKS = checks_section(
    4,
    check(
        "check_lengths",
        "No length or time is negative",
        "AND(d_before>=0,d_after>=0,s>=0,H>=0,walked>0,walking>0,limit>0)",
        "geometry",
        "FALSE: a length below 0, or no way walked.",
    ),
    check(
        "check_known",
        "What the impact speed is taken from was measured",
        "IF(known=2,throw_known=1,marks_known=1)",
        "input",
        "FALSE: what is chosen was not measured, so that there is no impact speed. Choose the other, or enter it.",
    ),
    BRAKING_CHECK,
    BRAKED_CHECK,
    check(
        "check_body",
        "Friction of the body is up to 1.2",
        "AND(mu>0,mu<=1.2)",
        "plausibility",
        "FALSE: more than a body on the ground can have. A percentage entered as a number?",
    ),
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
    check(
        "check_walking",
        "The walking speed is that of a person, up to [15 ft/s|5 m/s]",
        "walking<=[15|5]",
        "plausibility",
        "FALSE: faster than people run. In other units?",
    ),
    check(
        "check_response",
        "The hazard began before the braking",
        "IF(check_known,t_response>0,TRUE)",
        "physics",
        "FALSE: the driver braked before there was a hazard. Look at the way walked and the walking speed.",
    ),
)

_STEPS = tuple(range(12))


def _still_to_go(share: str) -> tuple[str, str]:
    time = f"{share}*t_walk"
    braking = f"MAX({time}-t_response,0)"
    return time, f"D_0-v_0*({time})+b*{braking}^2/2"


_DIAGRAM = Diagram(
    "Both on their way to the point of impact, base case",
    "Time since the hazard began, s",
    "Distance still to go, [ft|m]",
    (
        Curve("«1»", Look.FIRST, (*(_still_to_go(f"{step}/12") for step in _STEPS), ("t_walk", "0"))),
        Curve("Pedestrian", Look.SECOND, (("0", "walked"), ("t_walk", "0"))),
        Curve("Braking begins, or the impact", Look.POINT, (("t_response", "d_braked"),)),
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
            "A vehicle braked, struck a pedestrian with its front, and braked on to rest. Marks and throw each give "
            "the impact speed; marks before the impact the speed before braking; the way walked, the response time. A "
            "length that was not measured is 0, and gives no answer of its own.",
            "Marks and throw answer one question twice. Choose the better one; sheet Evidence has a row in which "
            "their difference must be 0, within an error that you decide on before you look.",
            "Not for a body carried on the vehicle, thrown over the roof, or struck by its corner; not where the "
            "vehicle did not brake to rest (then choose the throw, 2).",
            "Where the vehicle was no faster than the speed in question, the answer is that it would not have stopped: "
            "the limit then changes nothing. Compare its speed before braking.",
            "Next: time-distance, which asks whether the pedestrian would have cleared, and what an ordinary driver "
            "would have done.",
        ),
    ),
    NO_BRAKING,
    GuideSection(
        "Walking: published values",
        ("Use the pedestrian's age and what witnesses saw.",),
        (
            ("Pedestrian", "Walking speed"),
            (
                "Older than 65 years (Gates and others, TRB 06-1826, 2006)",
                "mean [3.81 ft/s|1.16 m/s], 15th percentile [3.02 ft/s|0.92 m/s]",
            ),
            ("Experts' reports", "[4 to 5 ft/s|1.2 to 1.5 m/s]"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="A braking vehicle and a pedestrian",
    subtitle="Skid: v = √(2 f g d); throw, after Searle; walking: tr = dw/u − tb",
    rung=14,
    question="How fast, and when was the pedestrian seen?",
    needs="marks, throw distance, way walked, frictions",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=MORE_OF_THROW,
    sections=(
        Section("1  Speed", _SPEED),
        Section("2  Time", _TIME),
        Section("3  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» impact speed", "vi_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» impact speed, from the marks", "vs_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» impact speed, from the throw", "vt_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed before braking", "v0_[mph|kmh]", "[mph|km/h]"),
        SCENE_SHOWS,
        ForecastRow("Implied response time (without braking: at least)", "t_response", "s", stated="lower bound"),
        ForecastRow("Distance when the hazard began", "D_0", "[ft|m]"),
        ForecastRow(
            "Highest speed that still stops (without braking: at most)",
            "v_stop_[mph|kmh]",
            "[mph|km/h]",
            stated="upper bound",
        ),
        ForecastRow(
            "Same driver at the limit: stops, at most (1 = yes)",
            "stops",
            "",
            threshold=0.5,
            kind="yes/no",
            stated="upper bound",
        ),
        ForecastRow(
            "Same driver at the limit: stops, at least (1 = yes)",
            "stops_least",
            "",
            threshold=0.5,
            kind="yes/no",
            stated="lower bound",
        ),
    ),
    filters=(
        RESPONSE_FILTER,
        FilterRow(
            "Marks after the impact measured (1 = yes)",
            "marks_known",
            "A blank length gives no answer",
            above=0.5,
            only_for="«1» impact speed, from the marks",
        ),
        FilterRow(
            "Throw measured (1 = yes)",
            "throw_known",
            "A blank length gives no answer",
            above=0.5,
            only_for="«1» impact speed, from the throw",
        ),
    ),
    evidence=(
        EvidenceRow(
            "Throw and marks agree",
            "apart",
            None,
            "Normal",
            {},
            "Enter 0, and a standard deviation for what neither model has in it",
        ),
        EvidenceRow(
            "Impact speed in an EDR or a video",
            "vi_[mph|kmh]",
            None,
            "Normal",
            {},
            "A reading of its own: middle and standard deviation of edr-speed or video-speed, if they share "
            "no input with this workbook",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="A lifted body has a steeper angle and a lower efficiency: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
