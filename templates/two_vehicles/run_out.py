"""Run-out over several surfaces, and what came before the impact: rows that wait until they are needed.

A vehicle seldom slides to rest in one way. The rows of sheet Run-out take up to three further segments, the grade and
the share of full sliding of each, a speed at the end, or the speed after the impact itself. Before the impact they take
a skid, on the same road unless another friction is typed in, and the driver's response time. Without an entry
everything is as it was.
"""

from __future__ import annotations

from templates.checks import check
from templates.description import Equation, ForecastRow, GuideSection, Input, Role, Section
from templates.two_vehicles.equations import RUN_OUT
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = [
    "RUN_OUT_CHECK",
    "RUN_OUT_GUIDE",
    "RUN_OUT_NOTE",
    "before_section",
    "run_out_forecasts",
    "run_out_inputs",
    "segmented_run_out",
]

_SEGMENTS = (1, 2, 3, 4)
_ROLLING = (
    "Engineering Toolbox, Rolling resistance: ordinary car tires on concrete or new asphalt 0.01 to 0.015; on tar "
)
_ROLLING += "or asphalt 0.02. Blank: 0"
_SHARE = {
    1: "Blank: 1, all wheels slide. Braked wheels of all, by weight; or of a spinning vehicle with free wheels its "
    "mean drag over that of full sliding: sheet Guide",
    2: "As for segment 1",
}
_GRADE = {1: "Blank: level. Uphill on its way positive", 2: "As for segment 1"}


def _row(symbol: str, notation: str, name: str, unit: str, source: str, shown: str = "General") -> Input:
    return Input(symbol, notation, name, unit, None, source, frozen=True, number_format=shown)


def _segment(j: int, k: int) -> tuple[Input, ...]:
    """What may be said of a segment; length and friction of the first are on sheet Inputs."""
    who, at = f"{vehicle(j)} run-out, segment {k}:", f"{j}_{k}"
    which = min(k, 2)
    own = (
        _row(f"s_{at}", f"s{j},{k}", f"{who} length", "[ft|m]", "Blank: no such segment. Surveyed", "0.0"),
        _row(f"f_{at}", f"f{j},{k}", f"{who} friction", "g", "Blank: as segment 1, in the same trial", "0.000"),
    )
    return (
        *(own if k > 1 else ()),
        _row(f"grade_{at}", f"G{j},{k}", f"{who} grade", "%", _GRADE[which], "0.0"),
        _row(f"share_{at}", f"q{j},{k}", f"{who} share of full sliding", "", _SHARE[which], "0.00"),
    )


def _of_vehicle(j: int) -> tuple[Input, ...]:
    who = vehicle(j)
    return (
        *(row for k in _SEGMENTS for row in _segment(j, k)),
        _row(
            f"v_end_{j}",
            f"vend,{j}",
            f"{who} speed at the end of its run-out",
            "[mph|km/h]",
            "Blank: at rest. The speed at which it struck something else, say",
            "0.0",
        ),
        _row(
            f"v_after_{j}",
            f"vaft,{j}",
            f"{who} speed after the impact, typed in",
            "[mph|km/h]",
            "Blank: from the run-out. An entry takes its place: from a recorder, a video, a simulation",
            "0.0",
        ),
        _row(
            f"d_pre_{j}",
            f"dpre,{j}",
            f"{who} skid before the impact",
            "[ft|m]",
            "Blank: none. Its length up to the impact, as surveyed",
            "0.0",
        ),
        _row(
            f"f_pre_{j}",
            f"fpre,{j}",
            f"{who} friction before the impact",
            "g",
            "Blank: the same road, as in segment 1 of the run-out, in the same trial",
            "0.000",
        ),
        _row(f"grade_pre_{j}", f"Gpre,{j}", f"{who} grade before the impact", "%", _GRADE[1], "0.0"),
        _row(
            f"t_pre_{j}",
            f"tpre,{j}",
            f"{who} response time of its driver",
            "s",
            "Blank: not asked. 1.25 s with a standard deviation of 0.46 s in a study of surprised drivers (Ergonomics "
            "1993)",
            "0.00",
        ),
    )


def run_out_inputs() -> tuple[Input, ...]:
    """The rows of sheet Run-out, blank."""
    rolling = _row("f_roll", "froll", "Rolling resistance of wheels that turn", "g", _ROLLING, "0.000")
    return (*_of_vehicle(1), *_of_vehicle(2), rolling)


def _or(symbol: str, otherwise: str) -> str:
    return f"IF(ISNUMBER({symbol}),{symbol},{otherwise})"


def _drag(j: str, k: int) -> Equation:
    at = f"{j}_{k}"
    friction = f"f_{j}" if k == 1 else _or(f"f_{at}", f"f_{j}")
    share, slope = _or(f"share_{at}", "1"), f"N(grade_{at})/100"
    return Equation(
        f"drag_{at}",
        f"z{j},{k}",
        f"{{who}} run-out, segment {k}: drag",
        "g",
        f"({share}*{friction}+(1-{share})*N(f_roll)+{slope})/SQRT(1+({slope})^2)",
        "(q·f + (1 − q)·froll)·cos θ + sin θ",
        "<The share q slides, the rest rolls; θ is the grade.|>" if k == 1 else "",
        number_format="0.000",
    )


_FURTHER = "+".join(f"N(s_{{j}}_{k})*drag_{{j}}_{k}" for k in _SEGMENTS[1:])
_ASKED = ",".join(
    f"{symbol}_{{j}}_{k}" for k in _SEGMENTS for symbol in ("s", "grade", "share") if (symbol, k) != ("s", 1)
)

_WAYS = (
    Equation(
        "way_{j}",
        "",
        "{who}: 0 = one distance to rest, 1 = segments, 2 = speed typed in",
        "",
        f"IF(ISNUMBER(v_after_{{j}}),2,IF(COUNT(v_end_{{j}},{_ASKED})>0,1,0))",
        "sheet Run-out",
        "<0 as long as sheet Run-out holds no entry: then the equation of the paper's case stands.|>",
        number_format="0",
    ),
    *(_drag("{j}", k) for k in _SEGMENTS),
    Equation(
        "work_{j}",
        "Σ{j}",
        "{who} run-out: distance times drag",
        "[ft|m]",
        f"s_{{j}}*drag_{{j}}_1+{_FURTHER}",
        "Σ s·z",
        number_format="0.00",
    ),
    Equation(
        "travel_{j}",
        "strav,{j}",
        "{who} travel, all segments",
        "[ft|m]",
        "s_{j}+" + "+".join(f"N(s_{{j}}_{k})" for k in _SEGMENTS[1:]),
        "Σ s",
        number_format="0.0",
    ),
)


def segmented_run_out() -> tuple[Equation, ...]:
    """How each vehicle came to rest, and its speed after the impact: from one distance, from segments, or typed in."""
    (plain,) = RUN_OUT
    segments = f"SQRT((N(v_end_{{j}})/({MPH}))^2+2*g*work_{{j}})"
    return (
        *_WAYS,
        Equation(
            plain.symbol,
            plain.notation,
            plain.name,
            plain.unit,
            f"IF(way_{{j}}=0,{plain.formula},IF(way_{{j}}=2,N(v_after_{{j}})/({MPH}),{segments}))",
            "√(2·g·f·s); √(vend² + 2·g·Σ s·z)",
            plain.note,
        ),
    )


_BEFORE = (
    Equation(
        "a_pre_{j}",
        "zpre,{j}",
        "{who} drag in its skid before the impact",
        "g",
        f"({_or('f_pre_{j}', 'f_{j}')}+N(grade_pre_{{j}})/100)/SQRT(1+(N(grade_pre_{{j}})/100)^2)",
        "f·cos θ + sin θ",
        number_format="0.000",
    ),
    Equation(
        "Vpre{j}_[mph|kmh]",
        "Vpre,{j} ([mph|km/h])",
        "{who} speed before its skid",
        "[mph|km/h]",
        f'IF(N(d_pre_{{j}})>0,SQRT(V{{j}}_i^2+2*g*d_pre_{{j}}*a_pre_{{j}})*{MPH},"–")',
        "√(Vi² + 2·g·d·z)",
        "<In each trial with the impact speed of that trial, and the friction of its run-out where it is the same "
        "road. A dash until sheet Run-out has the skid.|>",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "ahead_{j}",
        "D{j}",
        "{who} way to the impact, from where its driver perceived",
        "[ft|m]",
        f'IF(AND(N(t_pre_{{j}})>0,N(d_pre_{{j}})>0),Vpre{{j}}_[mph|kmh]/({MPH})*t_pre_{{j}}+d_pre_{{j}},"–")',
        "Vpre·t + d",
        "<A dash until sheet Run-out has the skid and the response time.|>",
        Role.ANSWER,
        "0.0",
    ),
)


def before_section(number: int) -> Section:
    """Speed before the skid, and the way from perception to the impact."""
    return Section(f"{number}  Optional: before the impact", for_both(_BEFORE))


def run_out_forecasts() -> tuple[ForecastRow, ...]:
    """The speeds before the skids, and the ways; they wait for entries."""
    return (
        *(ForecastRow(f"{vehicle(j)} speed before its skid", f"Vpre{j}_[mph|kmh]", "[mph|km/h]") for j in (1, 2)),
        *(ForecastRow(f"{vehicle(j)} way from perception to the impact", f"ahead_{j}", "[ft|m]") for j in (1, 2)),
    )


_SHARES = ",".join(f"share_{j}_{k}" for j in (1, 2) for k in _SEGMENTS)

RUN_OUT_CHECK = check(
    "check_run_out",
    "Shares of sliding are from 0 to 1; run-outs slow the vehicles",
    f"AND(MIN({_SHARES})>=0,MAX({_SHARES})<=1,MIN(work_1,work_2)>=0,N(v_end_1)>=0,N(v_end_2)>=0,N(v_after_1)>=0,"
    "N(v_after_2)>=0,N(d_pre_1)>=0,N(d_pre_2)>=0)",
    "sheet Run-out",
    "FALSE: look at sheet Run-out. A percentage entered as a share, or a grade that speeds a vehicle up?",
)

RUN_OUT_NOTE = (
    "Further segments of the run-out, and what came before the impact. A row without a value does nothing; to use one, "
    "fill it in and set Frozen to FALSE (sheet Guide)."
)

RUN_OUT_GUIDE = GuideSection(
    "Sheet Run-out",
    (
        "Its rows wait. Give one a value, a range and a source, and set Frozen to FALSE; with TRUE it is held at its "
        "value. Distance and deceleration on sheet Inputs are segment 1. The drag of each segment is (q·f + (1 − "
        "q)·froll)·cos θ + sin θ.",
        "No default is given for the share q of a spinning vehicle with free wheels. 50 to 80 %, and 70 to 75 %, are "
        "in use; McHenry cautions against both as arbitrary, and would simulate the spinout (mchenrysoftware.com, "
        "forum, “What is the appropriate rotating vehicle % drag factor?”, 25 June 2009, which quotes SAE 970949).",
        "A skid before the impact: leave its friction blank on the same road, and each trial has one friction before "
        "and after. For more, xlmc simulate --feed carries the trials through another workbook; a mean and a standard "
        "deviation would lose what goes together.",
    ),
)
