"""A vehicle in a video passes two marks: its speed between them, and at the last one."""

from __future__ import annotations

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
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY, MPH

__all__ = ["TEMPLATE"]

_FRAME = "A crossing lies anywhere between two frames: uniform 0 to 1"

_ASSUMPTIONS = (
    Input(
        "d",
        "d",
        "Distance between the two marks",
        "[ft|m]",
        Both(100, 30),
        "Example. Enter: surveyed on the scene, or scaled; as wide as the marks can be placed in the image",
        {"Low": Both(99, 29.7), "High": Both(101, 30.3)},
        number_format="0.00",
    ),
    Input(
        "u_1",
        "u1",
        "First mark: share of a frame before the frame counted",
        "frames",
        0.5,
        _FRAME,
        {"Low": 0, "High": 1},
        number_format="0.00",
    ),
    Input(
        "u_2",
        "u2",
        "Last mark: share of a frame before the frame counted",
        "frames",
        0.5,
        _FRAME,
        {"Low": 0, "High": 1},
        number_format="0.00",
    ),
    Input(
        "rate",
        "r",
        "Frame rate",
        "1/s",
        30,
        "Example. Enter: from the metadata. Where the rate varies, enter the mean over the frames counted, from their "
        "time stamps",
        {"Low": 29.9, "High": 30.1},
        number_format="0.00",
    ),
    Input(
        "a",
        "a",
        "Deceleration between the marks (speeding up: negative)",
        "g",
        0,
        "Example, held at 0: a steady speed. Enter: what braking lamps, other marks or an EDR say",
        {"Low": 0, "High": 0.7},
        number_format="0.000",
        frozen=True,
    ),
)

_WITHOUT_TABLE = "=rec_used=0"

_OF_TABLE = (
    Input(
        "scale",
        "k",
        "Many frames: length of one unit of the positions on sheet Record",
        "[ft|m]",
        1,
        "Example. Enter: the length of a pixel along the path, and how far it may be off; 1 where positions are in "
        "[ft|m]. It is common to all frames",
        {"Low": 0.99, "High": 1.01},
        number_format="0.0000",
        frozen=_WITHOUT_TABLE,
    ),
    *(
        Input(
            f"z_{k}",
            f"z{k}",
            f"Many frames: error of the {name}, in its standard errors",
            "",
            0,
            "Least squares: marks are off by chance, each frame for itself",
            {"Mean": 0, "Std dev": 1},
            "Normal",
            "0.00",
            frozen=_WITHOUT_TABLE,
        )
        for k, name in ((1, "mean speed"), (2, "bend"))
    ),
    Input(
        "u_sd",
        "us",
        "Many frames: how far their scatter is from that of many more",
        "",
        0.5,
        "Least squares: a scatter seen in few frames is itself uncertain, so that errors follow Student's t",
        {"Low": 0, "High": 1},
        number_format="0.00",
        frozen="=OR(rec_used=0,ISNUMBER(mark_error),rec_free<1)",
    ),
)

_CONSTANTS = (
    Input(
        "bend",
        "",
        "Many frames: 1 = a steady deceleration is fitted, 0 = a steady speed",
        "",
        1,
        "Example. 0 only where nothing suggests that it braked or sped up: a bend that is left out shows as speed",
        choices=(0, 1),
    ),
    Input(
        "n",
        "n",
        "Frames counted between the marks",
        "",
        40,
        "Example. Count: the frame after the last mark less the frame after the first",
        number_format="0",
    ),
    GRAVITY,
    *CONVERSIONS,
)

_OPTIONAL = (
    Input(
        "mark_error",
        "σx",
        "Many frames: standard error of a mark",
        "",
        None,
        "Optional, in units of the positions on sheet Record. From marking the same frames again. Blank: from the "
        "scatter of the frames about the curve",
        number_format="0.00",
    ),
)

_ROWS = 100


def _column(letter: str) -> str:
    return f"${letter}$6:${letter}${5 + _ROWS}"


_USED, _TIME, _BEND, _PLACE, _REST = map(_column, "DEFGH")


def _read(symbol: str, name: str, formula: str, note: str = "", number_format: str = "0.0000") -> Equation:
    return Equation(symbol, "", name, "", formula, note=note, number_format=number_format)


_TABLE = PastedTable(
    columns=("Frame", "Time stamp, s", "Position along the path"),
    width=3,
    rows=_ROWS,
    computed=(
        ("Used", "IF(COUNT(B{r},C{r})=2,1,0)", "0;-0;;@"),
        ("Time from their mean", "IF(D{r}=1,B{r}-rec_mid,0)", "0.0000;-0.0000;;@"),
        ("Its square, less a line", "IF(D{r}=1,E{r}^2-rec_skew*E{r}-rec_S2/rec_n,0)", "0.0000;-0.0000;;@"),
        ("Position from their mean", "IF(D{r}=1,C{r}-rec_place,0)", "0.00;-0.00;;@"),
        ("Less the curve", "G{r}-rec_b1*E{r}-rec_b2*F{r}", "0.00;-0.00;;@"),
        (
            "Since the frame before",
            'IF(AND(D{r}=1,B{r}>rec_first),B{r}-MAXIFS($B$6:$B$105,$D$6:$D$105,1,$B$6:$B$105,"<"&B{r}),"–")',
            "0.0000;-0.0000;0.0000;",
        ),
    ),
    subtitle="Enter many frames of one vehicle: the time stamp of each, as measured in the file, and where a point of "
    "it lies along its path. Blank: two marks, as on sheet Inputs.",
    read=(
        _read("rec_begun", "Times and positions that are filled", "COUNTA($B$6:$C$105)", number_format="0"),
        _read("rec_n", "Frames", f"SUM({_USED})", "Fewer than 3: the table is not used", "0"),
        _read("rec_mid", "Their mean time, s", f"IF(rec_n>0,SUMPRODUCT({_USED},{_column('B')})/rec_n,0)"),
        _read("rec_place", "Their mean position", f"IF(rec_n>0,SUMPRODUCT({_USED},{_column('C')})/rec_n,0)"),
        _read("rec_S2", "Sum of squares of times", f"SUMSQ({_TIME})"),
        _read(
            "rec_skew",
            "Sum of cubes over sum of squares",
            f"IF(rec_S2>0,SUMPRODUCT({_TIME},{_TIME},{_TIME})/rec_S2,0)",
            "0 where frames are evenly spaced",
        ),
        _read("rec_Q2", "Sum of squares of the bend", f"SUMSQ({_BEND})", number_format="0.000000"),
        _read("rec_used", "The table is used (1 = yes)", "IF(AND(rec_n>=3,rec_S2>0),1,0)", number_format="0"),
        _read(
            "rec_bent",
            "A steady deceleration is fitted (1 = yes)",
            "IF(AND(rec_used=1,N(bend)=1,rec_n>=4,rec_Q2>0),1,0)",
            "Asked for on sheet Inputs, and there are four frames or more",
            "0",
        ),
        _read("rec_b1", "Least squares: mean speed", f"IF(rec_used=1,SUMPRODUCT({_TIME},{_PLACE})/rec_S2,0)"),
        _read("rec_b2", "Least squares: bend", f"IF(rec_bent=1,SUMPRODUCT({_BEND},{_PLACE})/rec_Q2,0)"),
        _read("rec_free", "Frames beyond what is fitted", "rec_n-2-rec_bent", number_format="0"),
        _read(
            "rec_sd",
            "Scatter of the frames about the curve",
            f"IF(rec_free>0,SQRT(SUMSQ({_REST})/rec_free),0)",
            "Standard deviation, in units of the positions",
        ),
        _read("rec_first", "First time, s", f"IF(rec_n>0,MINIFS({_column('B')},{_USED},1),0)"),
        _read("rec_last", "Last time, s", f"IF(rec_n>0,MAXIFS({_column('B')},{_USED},1),0)"),
        _read(
            "rec_longest",
            "Longest interval between neighbours over the shortest",
            "IF(rec_n>1,MAX(I6:I105)/MIN(I6:I105),1)",
            "Far from 1: the frame rate varies, and 1/rate would be wrong",
            "0.00",
        ),
    ),
)

_LINE = (
    Equation(
        "sd_mark",
        "sx",
        "Many frames: standard error of a mark",
        "",
        'IF(rec_used=1,IF(ISNUMBER(mark_error),mark_error,IF(rec_free>0,rec_sd*SQRT(rec_free/CHIINV(u_sd,rec_free)),0)),"–")',
        "Student's t",
        "As typed, or the scatter of the frames with its own uncertainty.",
    ),
    Equation(
        "fit_1",
        "b1",
        "Many frames: mean speed, with its error",
        "1/s",
        'IF(rec_used=1,(rec_b1+z_1*sd_mark/SQRT(rec_S2))*SIGN(rec_b1)*scale,"–")',
        "least squares",
        "Positions may grow or shrink along the way.",
    ),
    Equation(
        "fit_2",
        "b2",
        "Many frames: half the acceleration, with its error",
        "[ft|m]/s²",
        'IF(rec_used=1,IF(rec_bent=1,(rec_b2+z_2*sd_mark/SQRT(rec_Q2))*SIGN(rec_b1)*scale,0),"–")',
        "least squares",
    ),
)


def _speed_at(time: str) -> str:
    return f"fit_1+fit_2*(2*({time}-rec_mid)-rec_skew)"


_STEPS = (
    *_LINE,
    Equation(
        "frames",
        "N",
        "Frames between the crossings",
        "",
        "n+u_1-u_2",
        "n + u1 − u2",
        "Each crossing lies within one frame: their difference is one frame either way, and most likely none.",
        number_format="0.000",
    ),
    Equation("T", "T", "Time between the crossings", "s", "frames/rate", "N / r"),
    Equation(
        "v_mean",
        "v̄",
        "Mean speed between the marks",
        "[ft|m]/s",
        f"IF(rec_used=1,{_speed_at('(rec_first+rec_last)/2')},d/T)",
        "d / T",
        "Of many frames: by the curve, from the first to the last.",
    ),
    Equation(
        "v_end",
        "ve",
        "Speed at the last mark",
        "[ft|m]/s",
        f"IF(rec_used=1,{_speed_at('rec_last')},v_mean-a*g*T/2)",
        "v̄ − a·T/2",
        "With a steady deceleration the mean speed is that of half the time.",
    ),
    Equation(
        "v_first",
        "va",
        "Speed at the first mark",
        "[ft|m]/s",
        f"IF(rec_used=1,{_speed_at('rec_first')},v_mean+a*g*T/2)",
        "v̄ + a·T/2",
    ),
    Equation(
        "a_fit",
        "afit",
        "Many frames: deceleration (speeding up: negative)",
        "g",
        'IF(rec_bent=1,-2*fit_2/g,"–")',
        "−2·b2/g",
        "A dash: two marks, or a steady speed.",
        Role.ANSWER,
        "0.000",
    ),
)

_ANSWERS = (
    speed_answer("v", "v̄", "Mean speed between the marks", "v_mean"),
    speed_answer("vend", "ve", "Speed at the last mark", "v_end"),
)

_CHECKS = checks_section(
    3,
    check(
        "check_order",
        "The last mark is passed after the first",
        "AND(d>0,n>=1,frames>0,rate>0)",
        "geometry",
        "FALSE: count the frames from the first mark to the last.",
    ),
    check(
        "check_shares",
        "Shares of a frame lie between 0 and 1",
        "AND(MIN(u_1,u_2)>=0,MAX(u_1,u_2)<=1)",
        "definition",
        "FALSE: more than a frame.",
    ),
    check(
        "check_tyres",
        "The deceleration is one that tyres give, up to 1.2",
        "AND(ABS(a)<=1.2,OR(rec_bent=0,ABS(N(a_fit))<=1.2))",
        "published values",
        "FALSE: more than road tyres hold. A percentage entered as a number?",
    ),
    check(
        "check_forward",
        "The vehicle moves forward at the last mark",
        "v_end>0",
        "physics",
        "FALSE: so hard a braking would have stopped it before the last mark.",
    ),
    check(
        "check_table",
        "The table of frames was read, and its marks scatter as they should",
        "OR(rec_begun=0,AND(rec_used=1,rec_n*2=rec_begun,OR(NOT(ISNUMBER(mark_error)),rec_free<1,rec_sd<=2*N(mark_error))))",
        "least squares",
        "FALSE: a frame without time or position, fewer than three; or marks lie farther from the curve than their "
        "error allows: then the deceleration was not steady, or a mark is wrong.",
    ),
    check(
        "check_frames",
        "At least 5 frames are counted",
        "OR(rec_used=1,n>=5)",
        "conditioning",
        "FALSE: a frame more or less then decides the speed. Take marks that lie further apart; with 1 frame the "
        "mean has no finite value.",
    ),
)

_COUNTS = tuple(range(17))

_DIAGRAM = Diagram(
    "Speed as read, against the frames between the marks, base case",
    "Frames between the crossings",
    "Mean speed, [mph|km/h]",
    (
        Curve(
            "Speed",
            Look.FIRST,
            tuple((f"n-2+{count}/4", f"d*rate/MAX(n-2+{count}/4,0.1)*{MPH}") for count in _COUNTS),
        ),
        Curve("As counted", Look.POINT, (("frames", f"v_mean*{MPH}"),)),
    ),
    remark="Drawn from the cells below: how much two frames more or less change the speed.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A camera that stands still saw a vehicle pass two places whose distance is known. Count the frames from "
            "the first frame after the vehicle passed the first place to the first frame after it passed the last.",
            "One place is enough if both axles pass it: the distance is then the wheelbase.",
            "If you can, read when the vehicle passes a mark, not where it is in a frame: the frames just before and "
            "just after it passes are known. "
            "Take the longest stretch that the video shows: the error of a frame shrinks with the frames counted.",
            "Where the vehicle brakes, the mean speed is not the speed at the last mark. Enter the deceleration, as "
            "wide as it is uncertain.",
            "Frame rates of recorders vary. Where the file has a time stamp for each frame, use those: the mean rate "
            "over the frames counted is n divided by the difference of the stamps (SAE 2021-01-0887).",
            "Several distances scaled by one calibration share its error: correlate them.",
            "Many frames: enter on sheet Record the time stamp of each frame, as the file has it, and the position of "
            "one point of the vehicle along its path, in [ft|m] or in pixels, whose length is typed on sheet Inputs. "
            "Least squares gives speed and deceleration with the errors that marks and frames leave, from up to 100 "
            "frames whose intervals need not be even. A mark's error may be typed; else the scatter about the curve "
            "says it. A rolling shutter, which exposes the lines of a frame one after the other, is not modelled.",
        ),
    ),
    GuideSection(
        "Published experience",
        ("How far such speeds were from the recorded ones.",),
        (
            ("Study", "Result"),
            (
                "Reverse projection against EDRs (Epstein and Westlake, Journal of Forensic Sciences, 2019)",
                "on average within [1.44 mph|2.3 km/h]",
            ),
            ("Frame rates (SAE 2021-01-0887)", "need the stamp of every frame where the rate varies"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Speed from a video",
    subtitle="v̄ = d·r/(n + u1 − u2); ve = v̄ − a·T/2",
    rung=12,
    question="How fast was a vehicle that a camera saw?",
    needs="distance between two marks, frames counted, frame rate",
    assumptions=(*_ASSUMPTIONS, *_OF_TABLE),
    constants=_CONSTANTS,
    optional=_OPTIONAL,
    sections=(
        Section("1  Speed", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» mean speed between the marks", "v_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» speed at the last mark", "vend_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("«1» deceleration, of many frames", "a_fit", "g"),
    ),
    filters=(
        FilterRow("Order of the marks", "frames", "The last mark is passed after the first", above=0),
        FilterRow("Forward at the last mark", "v_end", "The vehicle had not stopped", above=0),
    ),
    evidence=(
        EvidenceRow(
            "Speed in an EDR, at the last mark",
            "vend_[mph|kmh]",
            None,
            "Instrument",
            {"Resolution": Both(1.24, 2)},
            "Enter the recorded speed. 49 CFR 563.8: within 1 km/h, in steps of 1 km/h. Braking wheels "
            "under-report it: see the template edr-speed",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Distances that share one calibration are correlated: enter how much.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle",),
    record=_TABLE,
)
