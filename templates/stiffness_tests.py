"""Sheet Stiffness: rows of crash tests, and the stiffness that they give with its scatter.

A test's energy per width is that of its own profile, straight between the stations: with V = b0 + b1·C at every point
of the width, its speed is the root of the mean square of V. One test with b0 typed gives b1 exactly, so that its own
speed comes back; several give a mean and a scatter, or a straight line.
"""

from __future__ import annotations

from itertools import pairwise

from templates.description import Equation, Input, TestTable
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["STIFFNESS_TESTS"]

_ROWS = 16
_FIRST = 6
"""The row of the sheet with the first test."""
_LENGTH = "[in_per_ft|cm_per_m]"
_HIDDEN_ZERO = "0.000;-0.000;;@"


def _column(letter: str) -> str:
    return f"${letter}${_FIRST}:${letter}${_FIRST + _ROWS - 1}"


_USED, _MEAN, _VARIANCE, _SPEED, _B1 = map(_column, "LMNOP")
_STATIONS = "EFGHIJ"


def _where_used(formula: str) -> str:
    return f"IF($L{{r}}>0,{formula},0)"


def _of(symbol: str) -> str:
    """The quantity of the vehicle that the row's test is of."""
    return f"CHOOSE($L{{r}},{symbol}_1,{symbol}_2)"


_SQUARES = "+".join(f"{a}{{r}}^2+{a}{{r}}*{b}{{r}}+{b}{{r}}^2" for a, b in pairwise(_STATIONS))
_SHARE = f"SQRT(C{{r}}/K{{r}}*{_of('L_tests')}/{_of('[w|m]_tests')})"
_STIFF = f"{_LENGTH}*{_of('m_used')}/({MPH})^2/{_of('L_used')}"

_COMPUTED = (
    (
        "Used for vehicle",
        "IF(AND(COUNT(C{r}:K{r})=9,OR(N(B{r})=1,N(B{r})=2),MIN(C{r}:D{r},K{r})>0,MAX(E{r}:J{r})>0),B{r},0)",
        "0;-0;;@",
    ),
    ("Mean crush", _where_used("(E{r}/2+F{r}+G{r}+H{r}+I{r}+J{r}/2)/5"), _HIDDEN_ZERO),
    ("Its variance over the width", _where_used(f"MAX(({_SQUARES})/15-M{{r}}^2,0)"), _HIDDEN_ZERO),
    ("Speed at mean weight and width", _where_used(f"D{{r}}*{_SHARE}"), _HIDDEN_ZERO),
    (
        "b1, with b0 of sheet Inputs",
        _where_used(
            f"(SQRT(MAX(({_of('b0')}*M{{r}})^2+(M{{r}}^2+N{{r}})*(O{{r}}^2-{_of('b0')}^2),0))-{_of('b0')}*M{{r}})"
            "/(M{r}^2+N{r})"
        ),
        _HIDDEN_ZERO,
    ),
    ("A, [lb/in|N/cm]", _where_used(f"{_STIFF}*{_of('b0')}*P{{r}}"), "0.0;-0.0;;@"),
    ("B, [lb/in²|N/cm²]", _where_used(f"{_STIFF}*P{{r}}^2"), "0.00;-0.00;;@"),
    ("G = A²/(2B), [lb|N]", _where_used(f"{_STIFF}*{_of('b0')}^2/2"), "#,##0;-#,##0;;@"),
    (
        "Speed that the stiffness in use returns",
        _where_used(
            f"SQRT(({_of('b0_used')}+{_of('b1_used')}*M{{r}})^2+{_of('b1_used')}^2*N{{r}})/({_SHARE})",
        ),
        "0.00;-0.00;;@",
    ),
    ("Less that entered", 'IF($L{r}>0,T{r}-D{r},"–")', "0.00"),
)


def _even(slope: str) -> str:
    """Speeds of tests whose crush was as deep everywhere as theirs in the mean."""
    return f"SQRT(ABS({_SPEED}^2-{slope}^2*{_VARIANCE}))"


def _slope(speeds: str) -> str:
    return f"IF(lined_{{j}}=1,SUMPRODUCT(({_USED}={{j}})*({_MEAN}-x_tests_{{j}})*{speeds})/Sxx_{{j}},0)"


def _passes() -> tuple[Equation, ...]:
    """The slope of the straight line, five times better: each pass takes the profile off by the slope before.

    The fourth is extrapolated from three (Aitken), so that deep narrow profiles settle, too.
    """
    formulas = [_slope(_SPEED), _slope(_even("pass_{j}_0")), _slope(_even("pass_{j}_1"))]
    second = "(pass_{j}_2-2*pass_{j}_1+pass_{j}_0)"
    formulas.append(
        f"IF(ABS{second}>1E-9*ABS(pass_{{j}}_2),pass_{{j}}_0-(pass_{{j}}_1-pass_{{j}}_0)^2/{second},pass_{{j}}_2)"
    )
    formulas += [_slope(_even("pass_{j}_3")), _slope(_even("pass_{j}_4"))]
    names = ("first slope of the line", *(f"its pass {k}" for k in range(1, 6)))
    return tuple(
        Equation(f"pass_{{j}}_{k}", "", f"{{who}} {name}", "[mph/in|(km/h)/cm]", formula, number_format="0.0000")
        for k, (name, formula) in enumerate(zip(names, formulas, strict=True))
    )


_READ = for_both(
    (
        Equation(
            "tests_begun",
            "",
            "Numbers entered with the tests",
            "",
            f"COUNT($B${_FIRST}:$K${_FIRST + _ROWS - 1})",
            note="Ten a test",
            number_format="0",
        ),
        Equation(
            "tests_low",
            "",
            "Negative crush, or a test without b1 above 0 (-1 = yes)",
            "",
            f'IF(OR(COUNTIF($E${_FIRST}:$J${_FIRST + _ROWS - 1},"<0")>0,'
            + ",".join(f'AND(lined_{j}=0,COUNTIFS({_USED},{j},{_B1},"<=0")>0)' for j in (1, 2))
            + "),-1,0)",
            number_format="0",
        ),
        Equation("tests_{j}", "", "{who} tests", "", f"COUNTIF({_USED},{{j}})", number_format="0"),
        Equation(
            "[w|m]_tests_{j}",
            "",
            "{who} mean [weight|mass] of the tests",
            "[lb|kg]",
            f"IF(tests_{{j}}>0,SUMIF({_USED},{{j}},{_column('C')})/tests_{{j}},0)",
            note="Takes the place of the [weight|mass] in the crash test on sheet Inputs",
            number_format="#,##0.0",
        ),
        Equation(
            "L_tests_{j}",
            "",
            "{who} mean width of their crush",
            "[in|cm]",
            f"IF(tests_{{j}}>0,SUMIF({_USED},{{j}},{_column('K')})/tests_{{j}},0)",
            note="The same, of the width",
            number_format="0.00",
        ),
        Equation(
            "x_tests_{j}",
            "",
            "{who} mean crush of the tests, averaged",
            "[in|cm]",
            f"IF(tests_{{j}}>0,SUMIF({_USED},{{j}},{_MEAN})/tests_{{j}},0)",
            number_format="0.00",
        ),
        Equation(
            "Sxx_{j}",
            "",
            "{who} sum of squares of mean crush about it",
            "[in²|cm²]",
            f"SUMPRODUCT(({_USED}={{j}})*({_MEAN}-x_tests_{{j}})^2)",
            number_format="0.00",
        ),
        Equation(
            "b1_tests_{j}",
            "",
            "{who} mean b1 of the tests",
            "[mph/in|(km/h)/cm]",
            f"IF(tests_{{j}}>0,SUMIF({_USED},{{j}},{_B1})/tests_{{j}},0)",
            note="With b0 of sheet Inputs, as it is drawn: a higher b0 means a lower b1",
        ),
        Equation(
            "b1_sd_{j}",
            "",
            "{who} scatter of b1 over the tests",
            "[mph/in|(km/h)/cm]",
            f"IF(tests_{{j}}>1,SQRT(SUMPRODUCT(({_USED}={{j}})*({_B1}-b1_tests_{{j}})^2)/(tests_{{j}}-1)),0)",
            note="Standard deviation with n − 1. One test has none: its scatter is that of b0 alone",
        ),
        Equation(
            "lined_{j}",
            "",
            "{who} a straight line is used (1 = yes)",
            "",
            "IF(AND(N(line_{j})=1,tests_{j}>=3,Sxx_{j}>0),1,0)",
            note="Asked for on sheet Inputs, and there are three tests or more whose crush differs",
            number_format="0",
        ),
        *_passes(),
        Equation(
            "level_{j}",
            "",
            "{who} speed of the line at the mean crush",
            "[mph|km/h]",
            f"IF(lined_{{j}}=1,SUMPRODUCT(({_USED}={{j}})*{_even('pass_{j}_5')})/tests_{{j}},0)",
            number_format="0.000",
        ),
        Equation(
            "line_sd_{j}",
            "",
            "{who} scatter of the tests about the line",
            "[mph|km/h]",
            f"IF(lined_{{j}}=1,SQRT(SUMPRODUCT(({_USED}={{j}})*({_even('pass_{j}_5')}-level_{{j}}-pass_{{j}}_5*({_MEAN}-x_tests_{{j}}))^2)"
            "/(tests_{j}-2)),0)",
            note="Standard deviation with n − 2",
            number_format="0.000",
        ),
        Equation(
            "line_b0_{j}",
            "",
            "{who} b0 of the line",
            "[mph|km/h]",
            "IF(lined_{j}=1,level_{j}-pass_{j}_5*x_tests_{j},0)",
            number_format="0.000",
        ),
    )
)

_SCATTER = tuple(
    Input(
        f"{symbol}_{j}",
        notation.format(j=j),
        f"{vehicle(j)} {name}",
        "",
        0,
        source,
        {"Midpoint": 0, "Scale": 1, "Degrees of freedom": f"=MAX(tests_{j}-1-lined_{j},1)"},
        "Student's t",
        "0.00",
        frozen=frozen.format(j=j),
    )
    for j in (1, 2)
    for symbol, notation, name, frozen, source in (
        (
            "scatter",
            "t{j}",
            "against its sister tests",
            "=tests_{j}<2",
            "Student's t: this vehicle is one more of the kind that was tested few times. In standard deviations of "
            "the tests, times √(1 + 1/n)",
        ),
        (
            "scatter_slope",
            "tb,{j}",
            "slope of the line through the tests",
            "=lined_{j}=0",
            "Student's t: in standard errors of the slope",
        ),
    )
)

STIFFNESS_TESTS = TestTable(
    columns=(
        ("Test: its number, its source", "General"),
        ("Vehicle: 1 or 2", "0"),
        ("[Weight, lb|Mass, kg]", "#,##0"),
        ("Speed, [mph|km/h]", "0.0"),
        *((f"C{i}, [in|cm]", "0.0") for i in range(1, 7)),
        ("Width, [in|cm]", "0.0"),
    ),
    rows=_ROWS,
    computed=_COMPUTED,
    read=_READ,
    scatter=_SCATTER,
    subtitle=(
        "Enter crash tests of the vehicle's model into a rigid barrier, one a row. Blank: b0, b1, [weight|mass] and "
        "width of sheet Inputs hold."
    ),
)
