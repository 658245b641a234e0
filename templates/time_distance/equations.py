"""The crash as it was, the same approach at the speed in question, and the checks."""

from __future__ import annotations

from templates.braking import (
    BRAKED_CHECK,
    BRAKING,
    BRAKING_CHECK,
    BRAKING_TIME,
    RESPONSE_BEYOND,
    STOPPING_SPEED,
    way_braked,
)
from templates.checks import check, checks_section
from templates.description import Equation, Role, Section
from templates.speed_answer import speed_answer
from templates.units import MPH

__all__ = ["SECTIONS"]

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

SECTIONS = (
    Section("1  As it was", _AS_IT_WAS),
    Section(
        "2  The same driver at the speed in question; without braking, if he brakes at once after tI",
        _instead("same", "Same driver", "t_response"),
    ),
    Section("3  An ordinary driver at the speed in question", _instead("fresh", "Ordinary driver", "t_fresh")),
    Section("4  The same driver, had he never braked", _NEVER),
    Section("5  Answers (the forecasts)", _ANSWERS),
    Section("6  Test of the sheet itself", _SELF_TEST),
    _CHECKS,
)
