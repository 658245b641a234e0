"""An event data recorder kept speeds before the crash: the speed at the impact, and the way since the brake was on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from templates.braking import BRAKING_CHECK
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
    PastedTable,
    Role,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import cut_off_delta_v, recorded_delta_v
from templates.restitution import restitution_input
from templates.road_friction import FRICTION_SHAPE, FRICTION_SOURCE
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_SAMPLES = range(1, 11)
"""Samples before the last one: 5 s at two a second."""
_EXAMPLE = {1: Both(47, 76), 2: Both(55, 88), 3: Both(56, 90), 4: Both(56, 90)}

_ASSUMPTIONS = (
    Input(
        "q",
        "q",
        "Recorded speeds are rounded: true less recorded",
        "[mph|km/h]",
        0,
        "One sample's resolution, 1 [mph|km/h]; 49 CFR 563.8 asks for 1 km/h",
        {"Low": -0.5, "High": 0.5},
        number_format="0.00",
    ),
    Input(
        "kappa",
        "κ",
        "Share by which slipping wheels under-report, while braking",
        "",
        0.13,
        "8 to 18 % low at maximum or ABS braking, GM modules (Reust and Morgan, Collision 2(2):32, 2007)",
        {"Low": 0.08, "High": 0.18},
        number_format="0.000",
    ),
    Input(
        "bias",
        "b",
        "True less recorded speed, before braking",
        "[mph|km/h]",
        Both(0.75, 1.2),
        "Coasting, above [30 mph|50 km/h]: recorded speeds from [0.5 mph|0.8 km/h] above to [2.0 mph|3.2 km/h] below "
        "the true one (Reust and Morgan, 2007)",
        {"Low": Both(-0.5, -0.8), "High": Both(2.0, 3.2)},
        number_format="0.00",
    ),
    Input(
        "f",
        "f",
        "Deceleration while braking",
        "g",
        0.70,
        FRICTION_SOURCE,
        FRICTION_SHAPE,
        "Trapezoid",
        "0.000",
    ),
    Input(
        "tau",
        "τ",
        "From the last sample to the impact",
        "s",
        0.25,
        "The impact lies anywhere between the last sample and the next: Low 0, High the interval between samples, and "
        "the delay of the recorder where the report gives one",
        {"Low": 0, "High": 0.5},
        number_format="0.00",
    ),
    replace(restitution_input("e", "Restitution, along one line"), frozen="=COUNT(w_own,w_other)<2"),
    Input(
        "u_dv",
        "u",
        "Recorded delta-V over the true one",
        "",
        1,
        "49 CFR 563.8: within 10 %. Of a delta-V whose whole pulse was kept; held until a further event is entered",
        {"Low": 0.9, "High": 1.1},
        number_format="0.00",
        frozen="=COUNT(dv_1st,t_2nd)<2",
    ),
)


def _sample(number: int) -> Input:
    return Input(
        f"v_{number}",
        f"v{number}",
        f"Recorded speed, {number} before the last sample",
        "[mph|km/h]",
        _EXAMPLE.get(number),
        "Example. Enter: the report of the recorder" if number in _EXAMPLE else "Optional. The same",
        number_format="0",
    )


_CONSTANTS = (
    Input(
        "v_last",
        "v0",
        "Recorded speed, last sample before the impact",
        "[mph|km/h]",
        Both(40, 64),
        "Example. Enter: the report of the recorder",
        number_format="0",
    ),
    Input(
        "n_on",
        "non",
        "Samples that show the brake on, up to and with the last one",
        "",
        3,
        "Example. Enter: the report of the recorder. 0: off in all; 1: on in the last one only",
        number_format="0",
    ),
    Input(
        "T_s",
        "Ts",
        "Interval between samples",
        "s",
        0.5,
        "0.5 s in most recorders; 0.1 s under the rule of December 2024 (89 FR 102810)",
        number_format="0.00",
    ),
    GRAVITY,
    *CONVERSIONS,
)

_OPTIONAL = (
    *(_sample(number) for number in _SAMPLES),
    Input(
        "dv_long",
        "ΔV",
        "Recorded delta-V, along the vehicle",
        "[mph|km/h]",
        None,
        "Optional. Where what was struck stood or approached, without rebound, the impact speed was more",
    ),
    Input("w_own", "w1", "Weight of this vehicle", "[lb|kg]", None, "Optional. For the closing speed from the delta-V"),
    Input("w_other", "w2", "Weight of the other vehicle", "[lb|kg]", None, "Optional. The same"),
    Input(
        "v_other",
        "vother",
        "Speed of what was struck, along this vehicle's way",
        "[mph|km/h]",
        None,
        "Optional. For a delta-V as evidence. Blank: it stood; negative: it approached",
    ),
    *(
        Input(symbol, notation, name, unit, None, source)
        for symbol, notation, name, unit, source in (
            (
                "dv_1st",
                "ΔV1st",
                "First event: recorded delta-V along, with its sign",
                "[mph|km/h]",
                "Optional, of a recording with several events. As the report prints it: negative where it slowed",
            ),
            (
                "t_2nd",
                "t2nd",
                "Time from the first event to the second",
                "s",
                "Optional. The report's time between events",
            ),
            ("f_2nd", "f2nd", "Deceleration between them", "g", "Optional. Blank: none, it rolled"),
            ("dv_2nd", "ΔV2nd", "Second event: recorded delta-V along", "[mph|km/h]", "Optional. As the first"),
            ("t_3rd", "t3rd", "Time from the second event to the third", "s", "Optional. The same"),
            ("f_3rd", "f3rd", "Deceleration between those", "g", "Optional. The same"),
        )
    ),
)

_ROWS = 101
"""10 s at ten a second, or 5 s at twenty."""


_HEADINGS = "$A$5:$J$5"


def _column(letter: str) -> str:
    return f"${letter}$6:${letter}${5 + _ROWS}"


_TIME, _SPEED, _BRAKE, _PEDAL, _SLIPS, _APART = map(_column, "KLMNOP")
_FEW = 'IF(rec_slipped<3,"–",'


def _headed(symbol: str, name: str, *patterns: str, note: str = "") -> Equation:
    """The first column whose heading is like one of these, 0 if there is none."""
    formula = "0"
    for pattern in reversed(patterns):
        formula = f'IFERROR(MATCH("{pattern}",{_HEADINGS},0),{formula})'
    return Equation(symbol, "", name, "", formula, note=note, number_format="0")


def _cell(column: str) -> str:
    return f"INDEX($A{{r}}:$J{{r}},MAX({column},1))"


def _number(column: str) -> str:
    """The number in a cell, or the one its text begins with, as in "45 [72]"; no number gives a dash."""
    cell = _cell(column)
    plain = f'SUBSTITUTE(TRIM({cell}),"−","-")'
    first = f'IFERROR(VALUE(LEFT({plain},FIND(" ",{plain}&" ")-1)),"–")'
    return f'IF({column}=0,"–",IF(ISNUMBER({cell}),{cell},{first}))'


_BRACKET = _cell("rec_c_speed")
_SAID = f"LOWER(TRIM({_cell('rec_c_brake')}))"
_COMPUTED = (
    ("Time read, s", _number("rec_c_time"), "0.00;-0.00;0.00;"),
    (
        "Speed read, [mph|km/h]",
        f'IF(rec_bracket=1,IFERROR(VALUE(MID({_BRACKET},FIND("[",{_BRACKET})+1,'
        f'FIND("]",{_BRACKET})-FIND("[",{_BRACKET})-1)),"–"),{_number("rec_c_speed")})',
        "0.0;-0.0;0.0;",
    ),
    (
        "Brake read",
        f'IF(OR(rec_c_brake=0,{_SAID}=""),"–",IF(OR({_SAID}="off",{_SAID}="no",{_SAID}="0"),0,1))',
        "0;-0;0;",
    ),
    ("Pedal read", _number("rec_c_pedal"), "0;-0;0;"),
    ("Wheels slip", "IF(AND(ISNUMBER(rec_on),ISNUMBER(K{r}),ISNUMBER(L{r})),IF(K{r}>N(rec_on),1,0),0)", "0;-0;;@"),
    ("From mean time, s", "IF(AND(O{r}=1,ISNUMBER(rec_mid)),K{r}-rec_mid,0)", "0.00;-0.00;;@"),
)

_TABLE = PastedTable(
    columns=("Time, s", "Speed, [mph|km/h]", "Brake: On/Off or 1/0", "Accelerator, %"),
    width=10,
    rows=_ROWS,
    computed=_COMPUTED,
    subtitle="Paste the pre-crash table of the report at A5, with its headings, or type below these. They say which "
    "column is which. Blank: sheet Inputs says what was recorded.",
    read=(
        _headed("rec_c_time", "Column of the times", "*time*", note="The first whose heading has the word: 1 is A"),
        _headed("rec_c_speed", "Column of the speeds", "*vehicle*speed*", "*speed*vehicle*", "*speed*"),
        _headed("rec_c_brake", "Column of the brake", "*brake*"),
        _headed("rec_c_pedal", "Column of the accelerator", "*accelerator*", "*throttle*", note="0: none, none needed"),
        Equation(
            "rec_bracket",
            "",
            "Speeds are those in brackets, as in 45 [72] (1 = yes)",
            "",
            f'IF(ISNUMBER(SEARCH("[[mph|km/h]",INDEX({_HEADINGS},MAX(rec_c_speed,1)))),1,0)',
            note="Where the heading has [[mph|km/h]] in brackets",
            number_format="0",
        ),
        Equation(
            "rec_unit",
            "",
            "Its heading names no other unit alone (1 = yes)",
            "",
            f'IF(OR(ISNUMBER(SEARCH("[mph|km/h]",INDEX({_HEADINGS},MAX(rec_c_speed,1)))),'
            f'NOT(ISNUMBER(SEARCH("[km/h|mph]",INDEX({_HEADINGS},MAX(rec_c_speed,1)))))),1,0)',
            number_format="0",
        ),
        Equation(
            "rec_begun",
            "",
            "Cells of the table that are filled",
            "",
            f"COUNTA($A$6:$J${5 + _ROWS})",
            number_format="0",
        ),
        Equation(
            "rec_n",
            "",
            "Samples",
            "",
            f"COUNT({_SPEED})",
            note="Fewer than 2: the table is not used",
            number_format="0",
        ),
        Equation("rec_end", "", "Time of the last sample, s", "s", f"MAX({_TIME})", number_format="0.00"),
        Equation(
            "rec_step", "", "Interval between samples, s", "s", f"IF(rec_n>1,(MAX({_TIME})-MIN({_TIME}))/(rec_n-1),0)"
        ),
        Equation(
            "rec_oldest",
            "",
            "Recorded speed, first sample",
            "",
            f"SUMIFS({_SPEED},{_TIME},MIN({_TIME}))",
            number_format="0.0",
        ),
        Equation(
            "rec_newest",
            "",
            "Recorded speed, last sample",
            "",
            f"SUMIFS({_SPEED},{_TIME},rec_end)",
            number_format="0.0",
        ),
        Equation("rec_sum", "", "Sum of all recorded speeds", "", f"SUM({_SPEED})", number_format="0.0"),
        Equation(
            "rec_off",
            "",
            "Last time at which the brake was off, s",
            "s",
            f"IF(COUNTIFS({_BRAKE},0)>0,MAXIFS({_TIME},{_BRAKE},0),MIN({_TIME})-1)",
            note="One second before the first sample where it was on in all",
            number_format="0.00",
        ),
        Equation(
            "rec_on",
            "",
            "First time at which it was on until the end, s",
            "s",
            f'IF(OR(rec_n<2,rec_off>=rec_end),"–",MINIFS({_TIME},{_TIME},">"&rec_off))',
            note="A dash: it was off at the end",
            number_format="0.00",
        ),
        Equation(
            "rec_at_on",
            "",
            "Recorded speed then",
            "",
            f'IF(ISNUMBER(rec_on),SUMIFS({_SPEED},{_TIME},rec_on),"–")',
            number_format="0.0",
        ),
        Equation(
            "rec_slipped",
            "",
            "Samples after that, with wheels that slip",
            "",
            f"SUM({_SLIPS})",
            number_format="0",
        ),
        Equation(
            "rec_slip_sum",
            "",
            "Sum of their speeds",
            "",
            f"SUMPRODUCT({_SLIPS},{_SPEED})",
            number_format="0.0",
        ),
        Equation("rec_mid", "", "Their mean time, s", "s", f"{_FEW}SUMPRODUCT({_SLIPS},{_TIME})/rec_slipped)"),
        Equation(
            "rec_spread",
            "",
            "Sum of squares of their times about it",
            "s²",
            f"{_FEW}SUMSQ({_APART}))",
        ),
        Equation(
            "rec_slope",
            "",
            "Least squares: change of recorded speed in a second",
            "",
            f"{_FEW}SUMPRODUCT({_APART},{_SPEED})/rec_spread)",
            note="One line through all samples with slip. A dash: fewer than 3; sheet Inputs has the friction",
        ),
        Equation(
            "rec_fit",
            "",
            "Recorded speed at the last sample, by that line",
            "",
            "IF(rec_slipped<3,rec_newest,rec_slip_sum/rec_slipped+rec_slope*(rec_end-rec_mid))",
            note="With fewer than 3 the sample itself",
            number_format="0.00",
        ),
        Equation(
            "rec_share",
            "",
            "Error of rounding left in it, of one sample's",
            "",
            "IF(rec_slipped<3,1,SQRT(1/rec_slipped+(rec_end-rec_mid)^2/rec_spread))",
            note="Samples are rounded each by itself, so that a line through many is known better than one of them",
        ),
        Equation(
            "rec_released",
            "",
            "Last time at which the accelerator was pressed, s",
            "s",
            f'IF(COUNTIFS({_PEDAL},">0")>0,MAXIFS({_TIME},{_PEDAL},">0"),"–")',
            note="A dash: no such column, or never pressed",
            number_format="0.00",
        ),
    ),
)

_USED = "IF(rec_n>=2"

_SPEEDS = (
    Equation(
        "braked",
        "",
        "The brake was on at the last sample (1 = yes)",
        "",
        f"{_USED},IF(ISNUMBER(rec_on),1,0),IF(n_on>0,1,0))",
        "input",
        number_format="0",
    ),
    Equation(
        "t_0",
        "v0,true",
        "True speed at the last sample",
        "[mph|km/h]",
        f"{_USED},IF(rec_slipped>0,(rec_fit+q*rec_share)/(1-kappa),rec_newest+q+bias),"
        "IF(n_on>1,(v_last+q)/(1-kappa),v_last+q+bias))",
        "(v + q)/(1 − κ)",
        "Recorded is (1 − κ) of the true speed while wheels slip; otherwise, and at the sample at which the brake "
        "first shows on, the difference of coasting tests holds.",
    ),
    Equation(
        "a_brake",
        "a",
        "Deceleration until the impact, while braking",
        "[ft|m]/s²",
        f"IF(AND(rec_n>=2,ISNUMBER(rec_slope)),-rec_slope/({MPH})/(1-kappa),f*g)",
        "f·g, or of the record",
        "Of the line through the samples on sheet Record, where there are three or more with slip.",
        number_format="0.00",
    ),
    Equation(
        "v_impact_s",
        "vi",
        "Speed at the impact",
        "[ft|m]/s",
        f"t_0/({MPH})-braked*a_brake*tau",
        "vtrue − a·τ",
        "The deceleration goes on after the last sample where the brake was on.",
    ),
)


def _true(number: int) -> Equation:
    return Equation(
        f"t_{number}",
        f"v{number},true",
        f"True speed, {number} before the last sample",
        "[mph|km/h]",
        f'IF(ISNUMBER(v_{number}),IF({number}<n_on-1,(v_{number}+q)/(1-kappa),v_{number}+q+bias),"–")',
        "as above",
        "One sensor: the same q, κ and b in all samples." if number == 1 else "",
    )


def _way(number: int) -> Equation:
    return Equation(
        f"x_{number}",
        f"x{number}",
        f"Way between samples {number} and {number - 1} before the last, brake on",
        "[ft|m]",
        f"IF({number}<n_on,(t_{number}+t_{number - 1})/2*T_s/({MPH}),0)",
        "mean speed · Ts",
        "Off by at most a·Ts²/8 in an interval." if number == 1 else "",
        number_format="0.00",
    )


_RECORD = (
    Equation(
        "n_given",
        "",
        "Samples given before the last, without a gap",
        "",
        "COUNT(" + ",".join(f"v_{number}" for number in _SAMPLES) + ")",
        "input",
        number_format="0",
    ),
    *(_true(number) for number in _SAMPLES),
    *(_way(number) for number in _SAMPLES),
)

_WHOLE = (
    Equation(
        "slip_sum",
        "Σslip",
        "True speeds of samples with slip, added",
        "[mph|km/h]",
        "IF(rec_n>=2,(rec_slip_sum+rec_slipped*q)/(1-kappa),0)",
        "Σ (v + q)/(1 − κ)",
        number_format="0.0",
    ),
    Equation(
        "ends_half",
        "½vend",
        "Half the true speed at the last sample, from the table",
        "[mph|km/h]",
        "IF(rec_n>=2,IF(rec_slipped>0,(rec_newest+q)/(1-kappa),rec_newest+q+bias)/2,0)",
        "trapezoids",
        number_format="0.00",
    ),
    Equation(
        "x_table",
        "xtab",
        "Way from brake on to the last sample, from the table",
        "[ft|m]",
        f"IF(AND(rec_n>=2,ISNUMBER(rec_on)),IF(rec_slipped>0,((N(rec_at_on)+q+bias)/2+slip_sum-ends_half)*rec_step/({MPH}),0),0)",
        "Σ mean speed · step",
        number_format="0.0",
    ),
    Equation(
        "x_record",
        "xrec",
        "Way from the first sample to the impact",
        "[ft|m]",
        "IF(rec_n>=2,(rec_sum-rec_slip_sum+(rec_n-rec_slipped)*(q+bias)+slip_sum-(rec_oldest+q+bias)/2-ends_half)"
        f'*rec_step/({MPH})+(t_0/({MPH})+v_impact_s)/2*tau,"–")',
        "Σ mean speed · step",
        "A dash until sheet Record holds a table.",
        Role.ANSWER,
        "0.0",
    ),
    Equation(
        "t_braked",
        "tbr",
        "Time from brake on to the impact, at least",
        "s",
        'IF(ISNUMBER(rec_on),rec_end-rec_on+tau,"–")',
        "record",
        "The brake came on after the sample before: at most one interval more. A dash without a table.",
        Role.ANSWER,
        "0.00",
    ),
)

_RELEASED = (
    Equation(
        "t_released",
        "trel",
        "Time from the accelerator's release to the impact, at most",
        "s",
        'IF(AND(ISNUMBER(rec_released),rec_n>=2),rec_end-rec_released+tau,"–")',
        "record",
        "It was released after the sample that still shows it pressed. A dash without a column of it.",
        number_format="0.00",
    ),
)

_EVENTS = (
    Equation(
        "v_2nd_[mph|kmh]",
        "v2nd",
        "Speed along, at the second event",
        "[mph|km/h]",
        f'IF(AND(ISNUMBER(dv_1st),ISNUMBER(t_2nd)),v_impact_s*{MPH}+dv_1st/u_dv-N(f_2nd)*g*t_2nd*{MPH},"–")',
        "vi + ΔV1/u − a·t",
        "From the speed at the impact, which is that of the first event, its delta-V, and the time to the second.",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "v_3rd_[mph|kmh]",
        "v3rd",
        "Speed along, at the third event",
        "[mph|km/h]",
        "IF(AND(ISNUMBER(v_2nd_[mph|kmh]),ISNUMBER(dv_2nd),ISNUMBER(t_3rd)),"
        f'v_2nd_[mph|kmh]+dv_2nd/u_dv-N(f_3rd)*g*t_3rd*{MPH},"–")',
        "the same",
        "A dash: no such event.",
        Role.ANSWER,
        "0.00",
    ),
)

_ANSWERS = (
    speed_answer("vi", "vi", "Speed at the impact", "v_impact_s"),
    Equation(
        "v_on_[mph|kmh]",
        "von ([mph|km/h])",
        "Speed at the sample at which the brake was first on",
        "[mph|km/h]",
        f"{_USED},IF(ISNUMBER(rec_on),rec_at_on+q+bias,t_0),CHOOSE(MAX(n_on,1),t_0,"
        + ",".join(f"t_{number}" for number in _SAMPLES)
        + "))",
        "record",
        "The last sample, where the brake was off in all.",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "x_on",
        "xon",
        "Way from that sample to the impact",
        "[ft|m]",
        f"{_USED},x_table," + "+".join(f"x_{number}" for number in _SAMPLES) + f")+(t_0/({MPH})+v_impact_s)/2*tau",
        "Σ x",
        "At least: the brake came on up to one interval before that sample.",
        Role.ANSWER,
        "0.0",
    ),
)

_DELTA_V = (
    Equation(
        "above_dv",
        "vi − ΔV",
        "Speed at the impact, less the recorded delta-V",
        "[mph|km/h]",
        f"IF(ISNUMBER(dv_long),v_impact_s*{MPH}-ABS(dv_long),0)",
        "definition",
        number_format="0.00",
    ),
    Equation(
        "closing",
        "Vc",
        "Closing speed from the recorded delta-V, along one line",
        "[mph|km/h]",
        'IF(AND(ISNUMBER(dv_long),w_own>0,w_other>0,ISNUMBER(e),N(e)>-1),ABS(dv_long)*(1+w_own/w_other)/(1+e),"–")',
        "ΔV1·(1 + m1/m2)/(1 + e)",
        number_format="0.00",
    ),
)

_RECORD_TIMES = f"Record!{_TIME}"

_GIVEN_DELTA_V = (
    Equation(
        "dv_along_[mph|kmh]",
        "ΔValong",
        "Delta-V along that the speed at the impact gives",
        "[mph|km/h]",
        f'IF(AND(w_own>0,w_other>0,e>-1),(v_impact_s*{MPH}-N(v_other))*(1+e)/(1+w_own/w_other),"–")',
        "(vi − vother)·(1 + e)/(1 + m1/m2)",
        "Along one line. The delta-V that was recorded may be evidence of it: sheet Evidence.",
        number_format="0.00",
    ),
)

_CHECKS = checks_section(
    6,
    check(
        "check_samples",
        "The brake was first on at a sample that is given",
        "AND(ISNUMBER(v_on_[mph|kmh]),ISNUMBER(x_on),OR(rec_n>=2,AND(n_on>=0,n_on<=n_given+1,n_on=INT(n_on))))",
        "record",
        "FALSE: fill in the recorded speeds back to the sample at which the brake was first on.",
    ),
    check(
        "check_table",
        "The pasted table was read: its columns, its unit, every sample",
        f"OR(rec_begun=0,AND(rec_c_time>0,rec_c_speed>0,rec_c_brake>0,rec_unit=1,rec_n>=2,COUNT({_RECORD_TIMES})=rec_n))",
        "record",
        "FALSE: a heading of sheet Record names no time, speed or brake, or speeds in another unit; or a time or speed "
        "is no number.",
    ),
    check(
        "check_last",
        "The vehicle moved at the last sample",
        f"{_USED},rec_newest,v_last)>0",
        "record",
        "FALSE: it stood, and there is no speed at the impact to be found; or it stopped before the impact.",
    ),
    check(
        "check_share",
        "The share of slip is that of braking wheels",
        "AND(kappa>=0,kappa<0.5)",
        "published values",
        "FALSE: more than half. A percentage entered as a number?",
    ),
    BRAKING_CHECK,
    check(
        "check_restitution",
        "Restitution lies between 0 and 1",
        "AND(e>=0,e<1)",
        "definition",
        "FALSE: the vehicles would not separate, or gain energy. A percentage entered as a number?",
    ),
    check(
        "check_time",
        "The impact lies at the last sample or after it",
        "AND(tau>=0,T_s>0,OR(rec_n<2,tau<=2*rec_step))",
        "record",
        "FALSE: a time below 0, or no interval; or τ on sheet Inputs is that of a slower recorder than the table's.",
    ),
    check(
        "check_forward",
        "The vehicle still moves forward at the impact",
        "v_impact_s>0",
        "physics",
        "FALSE: it would have stopped before the impact.",
    ),
)


def _record_of(newest: str, others: str) -> tuple[tuple[str, str], ...]:
    """Points from the oldest sample given to the last one; samples that are blank repeat the oldest."""
    values = ",".join((newest, *(f"{others}_{k}" for k in _SAMPLES)))
    return tuple((f"-tau-MIN({k},n_given)*T_s", f"CHOOSE(MIN({k},n_given)+1,{values})") for k in reversed(range(11)))


_DIAGRAM = Diagram(
    "Speed before the impact, base case",
    "Time before the impact, s",
    "Speed, [mph|km/h]",
    (
        Curve("True", Look.FIRST, (*_record_of("t_0", "t"), ("0", f"v_impact_s*{MPH}"))),
        Curve("Recorded", Look.SECOND, _record_of("v_last", "v")),
    ),
    remark="Drawn from the cells below.",
)


def _as_evidence(made: Callable[[str, str], EvidenceRow]) -> EvidenceRow:
    """A row of the recorded delta-V, which needs both weights, and is no filter then."""
    row = made("«1» delta-V along", "dv_along_[mph|kmh]")
    what = "Without its sign; leave the recorded delta-V of sheet Inputs blank then, and enter both weights there"
    return replace(row, source=f"{what}. {row.source}")


_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "The recorder of a vehicle kept its speed for some seconds before the event. It answers the speed at the "
            "impact, which lies after the last sample, and the way since the brake went on, for time-distance.",
            "Count the samples that show the brake on, from the last one back: with the brake on in the last three, "
            "enter 3, and the recorded speeds of at least two before the last.",
            "Recorded speed is that of wheels. Braking wheels slip, and the recorded speed is low; in a yaw with "
            "steering only it was 2 to 7 % low, with braking too 3 to 18 % (Reust and Morgan, 2007): choose the range "
            "by what the brake and stability flags say.",
            "Deceleration and slip are both a matter of how hard the driver braked: a correlation between them (sheet "
            "Results wanted) keeps impossible pairs apart.",
            "Another tyre size or axle ratio than the factory's: multiply the recorded speeds (Nagel, Collision 3(2), "
            "2008). Older recorders of some makers sample asynchronously, up to a second off: widen τ.",
            "A whole pre-crash table: paste it on sheet Record as the report prints it, with its headings, which say "
            "which columns are time, speed and brake; speeds such as 45 [72] are read too; up to 101 samples. It takes "
            "the place of the samples on sheet Inputs. One line of least squares through all samples with slipping "
            "wheels gives the deceleration and the speed at the last one, with the error of rounding that so many "
            "samples leave. Enter the interval between samples as High of τ.",
            "Several events in one recording: the table belongs to the first trigger, and the speed at the impact is "
            "that of the first event. Enter among the optional inputs its delta-V along the vehicle, with its sign, "
            "and the time to the next event: the speeds at the second and the third follow. Make sure that the events "
            "are of one crash and in the order in which they happened.",
            "The recorded delta-V says something of the speed only with both weights and a restitution. As evidence "
            "(sheet Evidence) it is one row: with 10 % and a step of 1 km/h where the whole pulse was kept; as a lower "
            "limit where the record ended before the pulse did, or the sensor reached the end of its range. Use it "
            "there or among the optional inputs, not in both.",
        ),
    ),
    GuideSection(
        "Recorded and true speed: published values",
        ("Above [30 mph|50 km/h], recorders of GM (Reust and Morgan, Collision 2(2):32, 2007).",),
        (
            ("What the vehicle did", "Recorded speed"),
            ("Accelerated", "within [1.5 mph|2.4 km/h]"),
            ("Coasted", "[0.5 mph|0.8 km/h] high to [2.0 mph|3.2 km/h] low"),
            ("Yaw, steering only", "2 to 7 % low"),
            ("Yaw, braking too", "3 to 18 % low"),
            ("Maximum or ABS braking", "8 to 18 % low"),
            ("49 CFR 563.8, Table III", "speed within 1 km/h; delta-V within 10 %; both in steps of 1 km/h"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed at the impact from an event data recorder",
    subtitle="vtrue = (v + q)/(1 − κ); vi = vtrue − a·τ",
    rung=11,
    question="How fast was it at the impact, by its EDR?",
    needs="recorded speeds, brake flag, friction",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=_OPTIONAL,
    sections=(
        Section("1  Speed at the last sample and at the impact", _SPEEDS),
        Section("2  The record", (*_RECORD, *_WHOLE, *_RELEASED)),
        Section("3  Answers (the forecasts)", _ANSWERS),
        Section("4  Recorded delta-V", (*_DELTA_V, *_GIVEN_DELTA_V)),
        Section("5  Optional: further events of the recording", _EVENTS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» speed at the impact", "vi_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed when the brake was first on", "v_on_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» way from brake on to the impact, at least", "x_on", "[ft|m]", stated="lower bound"),
        ForecastRow("«1» way from the first sample to the impact", "x_record", "[ft|m]"),
        ForecastRow("«1» time from brake on to the impact, at least", "t_braked", "s", stated="lower bound"),
        ForecastRow("«1» speed at the second event", "v_2nd_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed at the third event", "v_3rd_[mph|kmh]", "[mph|km/h]"),
    ),
    filters=(
        FilterRow("Forward at the impact", "v_impact_s", "The vehicle had not stopped", above=0),
        FilterRow(
            "Not below the recorded delta-V",
            "above_dv",
            "What was struck stood or approached, and the vehicle did not rebound. Without a delta-V: no effect",
            at_least=0,
        ),
    ),
    evidence=(
        EvidenceRow(
            "Impact speed from another source",
            "vi_[mph|kmh]",
            None,
            "Normal",
            {},
            "Enter a speed from momentum, crush or a video, and its standard deviation",
        ),
        EvidenceRow(
            "Skid marks from brake on to the impact",
            "x_on",
            None,
            "Uniform",
            {},
            "Enter the length surveyed, and how far it may be off: marks begin after the brake does, and the brake "
            "came on up to one interval before the first sample that shows it",
        ),
        *(_as_evidence(made) for made in (recorded_delta_v, cut_off_delta_v)),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Slip and deceleration both tell how hard it braked: correlate them, if you know how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
    record=_TABLE,
)
