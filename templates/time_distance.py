"""A vehicle and an intruder: speed before braking, response time, and whether another speed had avoided the crash."""

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
    SCENE_TELLS,
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
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_RESPONSE = "To brake lights, surprise: mean 1.25 s, SD 0.46 s (Ergonomics, 1993); cut off at 0.5 and 3 s"

_HIT = "Same driver: impact speed if not avoided (without braking: at least)"
_MARGIN = "Same driver: margin if it arrives (without braking: at most)"

_ASSUMPTIONS = (
    Input(
        "v_impact",
        "vi ([mph|km/h])",
        "«1» speed at the impact",
        "[mph|km/h]",
        Both(40, 64),
        "Example. Enter: from momentum, crush or throw; 0 cannot be",
        {"Low": Both(37, 60), "High": Both(43, 68)},
        number_format="0.0",
    ),
    Input(
        "d_brake",
        "db",
        "«1» braking distance before the impact (used where it braked)",
        "[ft|m]",
        Both(60, 18),
        "Example. Enter: skid or ABS marks up to the point of impact. Did it not brake? Answer 2 below",
        {"Low": Both(57, 17), "High": Both(63, 19)},
        number_format="0.0",
    ),
    BRAKING_INPUT,
    Input(
        "d_intruder",
        "dI",
        "Intruder: distance from becoming a hazard to the point of impact",
        "[ft|m]",
        Both(22, 6.7),
        "Example. Enter: from where a driver can tell that it moves, such as the stop line or the kerb",
        {"Low": Both(21, 6.4), "High": Both(23, 7.0)},
        number_format="0.0",
    ),
    Input(
        "u",
        "u ([mph|km/h])",
        "Intruder: speed when it became a hazard",
        "[mph|km/h]",
        0,
        "Example, held at 0: it started from rest. Enter for a pedestrian the walking speed (see sheet Guide)",
        {"Low": 0, "High": Both(3, 5)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "a_intruder",
        "aI",
        "Intruder: acceleration",
        "g",
        0.17,
        "Cars starting from rest: comfortable .15 to .20 g (Hawkins, review of papers 1938 to 2010), over some "
        "[30 ft|10 m]. 0 for a pedestrian",
        {"Mean": 0.17, "Std dev": 0.035, "Lower cutoff": 0.08, "Upper cutoff": 0.30},
        "Normal",
        "0.000",
    ),
    Input(
        "clearance",
        "c",
        "Intruder: further distance until it has cleared",
        "[ft|m]",
        Both(12, 3.7),
        "Example. Enter: how far it still had to go until the vehicle could pass behind it",
        {"Low": Both(11, 3.4), "High": Both(13, 4.0)},
        number_format="0.0",
    ),
    Input(
        "t_fresh",
        "tf",
        "Response time of an ordinary driver",
        "s",
        1.25,
        _RESPONSE,
        {"Mean": 1.25, "Std dev": 0.46, "Lower cutoff": 0.5, "Upper cutoff": 3},
        "Normal",
        "0.00",
    ),
)

_CONSTANTS = (
    BRAKED_INPUT,
    Input(
        "limit",
        "V ([mph|km/h])",
        "Speed that the question is about, such as the limit",
        "[mph|km/h]",
        Both(45, 70),
        "Enter: the posted limit, or the speed that was prudent there",
        number_format="0.0",
    ),
    *RESPONSE_LIMITS,
    GRAVITY,
    *CONVERSIONS,
)

_AS_IT_WAS = (
    Equation("v_i", "vi", "Speed at the impact", "[ft|m]/s", f"v_impact/({MPH})", "input"),
    BRAKING,
    *way_braked("d_brake", "db"),
    Equation("v_0", "v0", "Speed before braking", "[ft|m]/s", "SQRT(v_i^2+2*b*d_braked)", "v0² = vi² + 2·b·d"),
    BRAKING_TIME,
    Equation("u_s", "u", "Intruder's speed at the start", "[ft|m]/s", f"u/({MPH})", "input"),
    Equation(
        "t_intruder",
        "tI",
        "From becoming a hazard to the impact",
        "s",
        "2*d_intruder/(u_s+SQRT(u_s^2+2*a_intruder*g*d_intruder))",
        "d = u·t + aI·g·t²/2",
        "The root without a division by the acceleration, which may be 0.",
    ),
    Equation(
        "t_clear",
        "tc",
        "From becoming a hazard to having cleared",
        "s",
        "2*(d_intruder+clearance)/(u_s+SQRT(u_s^2+2*a_intruder*g*(d_intruder+clearance)))",
        "the same, further on",
    ),
    Equation(
        "t_response",
        "tr",
        "Response time that this crash implies",
        "s",
        "t_intruder-t_brake",
        "tI − tb",
        "Rise of the brakes included. Below 0: braking began before there was a hazard. Without braking: at least.",
    ),
    RESPONSE_BEYOND,
    Equation(
        "t_weighed",
        "",
        "Response time, as evidence weighs it",
        "s",
        "IF(AND(did_brake=0,ISNUMBER(t_usual)),t_usual,t_response)",
        "tr, or the reading",
        "Without braking the reading itself, which weighs nothing: a lower bound is no measured time.",
    ),
    Equation(
        "D_0",
        "D0",
        "Distance from the point of impact when the hazard began",
        "[ft|m]",
        "v_0*t_response+d_braked",
        "v0·tr + d",
        number_format="0.00",
    ),
    Equation("V_s", "V", "The speed in question", "[ft|m]/s", f"limit/({MPH})", "input"),
)


def _instead(driver: str, who: str, response: str) -> tuple[Equation, ...]:
    """Steps of the same approach at the speed in question; `driver` ends the symbols."""
    return (
        Equation(
            f"s_{driver}",
            f"s{driver}",
            f"{who}: distance left when braking begins",
            "[ft|m]",
            f"D_0-V_s*{response}",
            "D0 − V·t",
            "0 or less: it arrives before it brakes. Without braking: he brakes as soon as tI has passed."
            if driver == "same"
            else "",
            number_format="0.00",
        ),
        Equation(
            f"stops_{driver}",
            "",
            f"{who}: stops before the point of impact (1 = yes)",
            "",
            f"IF(AND(s_{driver}>0,V_s^2<=2*b*s_{driver}),1,0)",
            "V² ≤ 2·b·s",
            number_format="0",
        ),
        Equation(
            f"v_hit_{driver}",
            f"vhit,{driver}",
            f"{who}: speed at the point of impact",
            "[ft|m]/s",
            f"IF(s_{driver}<=0,V_s,SQRT(MAX(V_s^2-2*b*s_{driver},0)))",
            "√(V² − 2·b·s)",
            "It changes fast near a stop: give its percentiles, not its mean." if driver == "same" else "",
        ),
        Equation(
            f"t_arrive_{driver}",
            f"ta,{driver}",
            f"{who}: arrives after",
            "s",
            f"IF(s_{driver}<=0,D_0/V_s,{response}+2*MAX(s_{driver},0)/(V_s+v_hit_{driver}))",
            "t + 2·s/(V + vhit)",
            "Where the vehicle stops short, this is only a bound: it never arrives." if driver == "same" else "",
        ),
        Equation(
            f"avoided_{driver}",
            "",
            f"{who}: avoided (1 = yes)",
            "",
            f"IF(OR(stops_{driver}=1,t_arrive_{driver}>=t_clear),1,0)",
            "stops, or ta ≥ tc",
            number_format="0",
        ),
    )


_NEVER = (
    Equation(
        "t_arrive_never",
        "ta,never",
        "Never braking: arrives after",
        "s",
        "D_0/V_s",
        "D0 / V",
        "A driver who had not responded when he struck may never have braked. It strikes at the speed in question.",
    ),
    Equation(
        "avoided_least",
        "",
        "Same driver: avoided, at least (1 = yes)",
        "",
        "IF(did_brake=1,avoided_same,IF(t_arrive_never>=t_clear,1,0))",
        "without braking: D0 / V ≥ tc",
        "Without braking, at most is as above: he brakes as soon as the time to the impact has passed. Else equal.",
        number_format="0",
    ),
)

_ANSWERS = (
    speed_answer("v0", "v0", "Speed before braking", "v_0"),
    Equation(
        "over_[mph|kmh]",
        "v0 − V ([mph|km/h])",
        "Speed before braking, less the speed in question",
        "[mph|km/h]",
        f"v_0*{MPH}-limit",
        "definition",
        "",
        Role.ANSWER,
        "0.00",
    ),
    STOPPING_SPEED,
    speed_answer("v_hit", "vhit", "Same driver: speed at the point of impact", "v_hit_same"),
    Equation(
        "margin",
        "ta − tc",
        "Same driver: time by which the intruder has cleared, if the vehicle arrives",
        "s",
        "t_arrive_same-t_clear",
        "ta − tc",
        "Below 0: a collision.",
        Role.ANSWER,
        "0.00",
    ),
)

_SELF_TEST = (
    Equation(
        "v_again",
        "vi′",
        "Speed at the impact, from the speed before braking",
        "[ft|m]/s",
        "SQRT(MAX(v_0^2-2*b*(D_0-v_0*t_response),0))",
        "as above, with V = v0",
        "A test of the sheet itself: at V = v0 it must give the crash that happened.",
    ),
    Equation(
        "t_again",
        "tI′",
        "Time of the impact, from the speed before braking",
        "s",
        "t_response+2*(D_0-v_0*t_response)/(v_0+v_again)",
        "as above, with V = v0",
    ),
)

_CHECKS = checks_section(
    7,
    check(
        "check_inputs",
        "Speeds, distances and times are not negative",
        "AND(v_impact>0,d_brake>=0,d_intruder>0,u>=0,a_intruder>=0,clearance>=0,limit>0,t_fresh>0)",
        "geometry",
        "FALSE: a distance or a speed below 0, or an impact at 0.",
    ),
    check(
        "check_moves",
        "The intruder reaches the point of impact",
        "u+a_intruder>0",
        "physics",
        "FALSE: neither speed nor acceleration: it stands still.",
    ),
    BRAKING_CHECK,
    BRAKED_CHECK,
    check(
        "check_response",
        "The hazard began before the braking",
        "IF(check_moves,t_response>0,TRUE)",
        "physics",
        "FALSE: the driver braked before there was a hazard. Look at the intruder's distance and acceleration.",
    ),
    check(
        "check_identity",
        "At its own speed the vehicle has the crash that happened",
        "IF(check_moves,AND(ABS(v_again-v_i)<=0.000001*v_0,ABS(t_again-t_intruder)<=0.000001*t_intruder),TRUE)",
        "identity",
        "FALSE: a formula was typed over.",
    ),
)

_STEPS = tuple(range(13))


def _seen_at(share: str, speed: str, response: str, end: str) -> tuple[str, str]:
    """Time, and distance still to go: constant speed while responding, then braking, at `share` of the time `end`."""
    time = f"{share}*({end})"
    gone = f"{speed}*MIN({time},{response})"
    braking = f"MAX(MIN({time}-{response},{speed}/b),0)"
    return time, f"D_0-({gone}+{speed}*{braking}-b*{braking}^2/2)"


_DIAGRAM = Diagram(
    "Distance to the point of impact, base case",
    "Time since the hazard began, s",
    "Distance still to go, [ft|m]",
    (
        Curve(
            "As it was",
            Look.FIRST,
            (
                *(_seen_at(f"{step}/12", "v_0", "t_response", "t_intruder") for step in _STEPS[:-1]),
                ("t_intruder", "0"),
            ),
        ),
        Curve(
            "At the speed in question, same driver",
            Look.SECOND,
            tuple(_seen_at(f"{step}/12", "V_s", "t_response", "t_clear") for step in _STEPS),
        ),
        Curve(
            "Same driver, never braking",
            Look.LINE,
            (
                ("0", "D_0"),
                (
                    "IF(did_brake=1,0,MIN(t_clear,t_arrive_never))",
                    "IF(did_brake=1,D_0,D_0-V_s*MIN(t_clear,t_arrive_never))",
                ),
            ),
        ),
        Curve("Intruder at the point of impact", Look.FIRST_PATH, (("t_intruder", "0"), ("t_intruder", "D_0"))),
        Curve("Intruder has cleared", Look.SECOND_PATH, (("t_clear", "0"), ("t_clear", "D_0"))),
    ),
    remark="Drawn from the cells below. Never braking is drawn where it did not brake. A curve that reaches 0 after "
    "the intruder has cleared, or never, is no crash.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle on its way, and an intruder that crosses its path: a left turn, a pull-out, a pedestrian. It "
            "answers how fast the vehicle was before it braked, how long its driver took to respond, and whether the "
            "crash would have been avoided at another speed, by stopping or because the intruder had cleared.",
            "A pedestrian: set the acceleration to 0 and Frozen to TRUE, enter the walking speed as the intruder's "
            "speed, with its range, and set its Frozen to FALSE.",
            "The speed at the impact comes from another model (momentum, crush-energy, pedestrian-throw) or from an "
            "EDR (edr-speed): use its mean and standard deviation, Distribution Normal.",
            "Not where the vehicle braked in parts, steered, or was itself accelerating.",
        ),
    ),
    GuideSection(
        "Two drivers, two questions",
        (
            "Same driver: would this crash have been avoided, had this driver been at the speed in question and "
            "responded as here? The response time that the crash implies is kept. This shows what the speed alone "
            "changed.",
            "Ordinary driver: would a driver drawn from the published distribution have avoided it from there? Another "
            "question, with another answer, often a very different one. Say which one you answer.",
            "The implied response time is evidence: below 0.5 s nobody responds, and a filter rejects it. The row on "
            "sheet Evidence weighs it by the published distribution of response times, if you set Use to TRUE; it has "
            "no effect without braking. Do so only if nothing else in the workbook already uses that distribution for "
            "this driver.",
            "Where the vehicle was no faster than the speed in question, that speed would not have helped: the same "
            "driver has then not avoided it. See how often it was above the limit.",
            "Yes and no (1 and 0): the mean is the probability. So is Above threshold, with its interval.",
        ),
    ),
    NO_BRAKING,
    GuideSection(
        "Published values",
        ("A constant acceleration is for the first [30 ft|10 m] or so: it falls as speed grows.",),
        (
            ("Quantity", "Values"),
            ("Response to brake lights, surprise", "mean 1.25 s, SD 0.46 s"),
            (
                "Green's review of such times (Transportation Human Factors 2(3), 2000)",
                "brake lights ahead about 1.25 s; an object that suddenly moves into the path roughly 1.5 s",
            ),
            (
                "A barrel that rolls toward the path, drivers unaware (HFES Proceedings 37, 1993, page 206)",
                "mean 1.5 s, 85th percentile 1.9 s, at all ages alike",
            ),
            (
                "Of drivers who braked in 122 events of left turns across the path",
                "100, 99, 90, 58, 30 % reached .4, .5, .6, .7, .8 g (SAE 2019-01-0414, tallied by Peck)",
            ),
            ("Cars starting from rest, comfortable", ".15 to .20 g"),
            (
                "Walking, older than 65 years",
                "mean [3.81 ft/s = 2.60 mph|1.16 m/s = 4.18 km/h], 15th percentile [3.02 ft/s = 2.06 mph|0.92 m/s = "
                "3.31 km/h] (Gates and others, TRB 06-1826)",
            ),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Time and distance: would it have been avoided?",
    subtitle="v0 = √(vi² + 2 f g db); D0 = v0·tr + db; the same approach at another speed",
    rung=9,
    question="Would the crash have been avoided at the limit?",
    needs="impact speed, braking distance, the intruder's path",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(
        Section("1  As it was", _AS_IT_WAS),
        Section("2  The same driver at the speed in question", _instead("same", "Same driver", "t_response")),
        Section("3  An ordinary driver at the speed in question", _instead("fresh", "Ordinary driver", "t_fresh")),
        Section("4  The same driver, had he never braked", _NEVER),
        Section("5  Answers (the forecasts)", _ANSWERS),
        Section("6  Test of the sheet itself", _SELF_TEST),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» speed before braking", "v0_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed before braking, above the limit", "over_[mph|kmh]", "[mph|km/h]", threshold=0),
        SCENE_TELLS,
        ForecastRow("Implied response time (without braking: at least)", "t_response", "s"),
        ForecastRow("Distance when the hazard began", "D_0", "[ft|m]"),
        ForecastRow("Highest speed that still stops (without braking: at most)", "v_stop_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Same driver: stops, at most (1 = yes)", "stops_same", "", threshold=0.5),
        ForecastRow("Same driver: avoided, at most (1 = yes)", "avoided_same", "", threshold=0.5),
        ForecastRow("Same driver: avoided, at least (1 = yes)", "avoided_least", "", threshold=0.5),
        ForecastRow(_HIT, "v_hit_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(_MARGIN, "margin", "s", threshold=0),
        ForecastRow("Ordinary driver: avoided (1 = yes)", "avoided_fresh", "", threshold=0.5),
    ),
    filters=(
        RESPONSE_FILTER,
        FilterRow(
            "Not avoided",
            "avoided_same",
            "The impact speed is that of the trials in which there is an impact",
            below=0.5,
            only_for=_HIT,
        ),
        FilterRow(
            "Arrives",
            "stops_same",
            "The margin is that of the trials in which the vehicle arrives",
            below=0.5,
            only_for=_MARGIN,
        ),
    ),
    evidence=(
        EvidenceRow(
            "Response time of surprised drivers",
            "t_weighed",
            1.25,
            "Normal",
            {"Std dev": 0.46},
            "Ergonomics, 1993. Set Use to TRUE to weigh the implied response time by it. No effect without braking",
            use=False,
            named="t_usual",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="A driver who brakes harder may respond sooner: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
