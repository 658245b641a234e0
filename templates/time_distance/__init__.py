"""A vehicle and an intruder: speed before braking, response time, and whether another speed had avoided the crash."""

from __future__ import annotations

from templates.braking import RESPONSE_FILTER, SCENE_SHOWS
from templates.description import Curve, Diagram, EvidenceRow, FilterRow, ForecastRow, Look, Template
from templates.time_distance.equations import SECTIONS
from templates.time_distance.guide import GUIDE
from templates.time_distance.inputs import ASSUMPTIONS, CONSTANTS

__all__ = ["TEMPLATE"]

_HIT = "Same driver: impact speed if not avoided (without braking: at least)"
_MARGIN = "Same driver: margin if it arrives (without braking: at most)"

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

TEMPLATE = Template(
    title="Time and distance: would it have been avoided?",
    subtitle="v0 = √(vi² + 2 f g db); D0 = v0·tr + db; the same approach at another speed",
    rung=9,
    question="Would the crash have been avoided at the limit?",
    needs="impact speed, braking distance, the intruder's path",
    assumptions=ASSUMPTIONS,
    constants=CONSTANTS,
    optional=(),
    sections=SECTIONS,
    forecasts=(
        ForecastRow("«1» speed before braking", "v0_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed before braking, above the limit", "over_[mph|kmh]", "[mph|km/h]", threshold=0),
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
            "Same driver: stops, at most (1 = yes)",
            "stops_same",
            "",
            threshold=0.5,
            kind="yes/no",
            stated="upper bound",
        ),
        ForecastRow(
            "Same driver: avoided, at most (1 = yes)",
            "avoided_same",
            "",
            threshold=0.5,
            kind="yes/no",
            stated="upper bound",
        ),
        ForecastRow(
            "Same driver: avoided, at least (1 = yes)",
            "avoided_least",
            "",
            threshold=0.5,
            kind="yes/no",
            stated="lower bound",
        ),
        ForecastRow(_HIT, "v_hit_[mph|kmh]", "[mph|km/h]", stated="lower bound"),
        ForecastRow(_MARGIN, "margin", "s", threshold=0, stated="upper bound"),
        ForecastRow("Ordinary driver: avoided (1 = yes)", "avoided_fresh", "", threshold=0.5, kind="yes/no"),
    ),
    filters=(
        RESPONSE_FILTER,
        FilterRow(
            "Same driver: avoided (1 = yes)",
            "avoided_same",
            "The impact speed is that of the trials in which there is an impact",
            below=0.5,
            only_for=_HIT,
        ),
        FilterRow(
            "Same driver: stops (1 = yes)",
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
    guide=GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
)
