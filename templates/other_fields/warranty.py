"""What a warranty costs: a Weibull life, repairs of a few prices, claims of a year's production."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Curve,
    DataTable,
    Diagram,
    Equation,
    ForecastRow,
    GuideSection,
    Input,
    Look,
    Role,
    Section,
    Template,
)
from templates.other_fields.guidance import CAVEATS, EXAMPLE, EXAMPLE_NUMBERS, FIRST_STEPS

__all__ = ["TEMPLATE"]

_MONEY = '"$"#,##0'

_ASSUMPTIONS = (
    Input(
        "eta",
        "η",
        "Characteristic life (63 % have failed)",
        "years",
        12,
        "Example: estimated from a life test, with the error of the estimate. xlmc fit finds Scale and Shape",
        {"Mean": 12, "CoV %": 10},
        "Lognormal",
        "0.0",
    ),
    Input(
        "shape",
        "β",
        "Shape of the life (above 1: wear)",
        "",
        1.8,
        "Example: estimated from a life test, with the error of the estimate",
        {"Mean": 1.8, "Std dev": 0.1},
        "Normal",
        "0.00",
    ),
    Input(
        "life",
        "T",
        "Life of a unit",
        "years",
        10,
        "Weibull with this scale and shape: formulas, which follow the rows above",
        {"Scale": "=eta", "Shape": "=shape"},
        "Weibull",
        "0.0",
    ),
    Input(
        "refused",
        "r",
        "Claim refused (misuse)",
        "",
        0,
        "With the probability below",
        {"Probability": "=share_refused"},
        "Yes-No",
        "0",
    ),
    Input(
        "repair",
        "c",
        "Cost of a repair",
        "",
        150,
        "Discrete: the table of repairs below",
        {"Data": "repairs"},
        "Discrete",
        _MONEY,
    ),
    Input(
        "claims",
        "n",
        "Claims of all units sold",
        "",
        750,
        "Binomial: so many units, each with the probability of a claim on sheet Model",
        {"Probability": "=p_claim", "Trials": "=sold"},
        "Binomial",
        "#,##0",
    ),
)

_CONSTANTS = (
    Input("term", "w", "Term of the warranty", "years", 3, EXAMPLE, number_format="0.0"),
    Input("share_refused", "ρ", "Share of claims refused", "", 0.05, EXAMPLE, number_format="0%"),
    Input("sold", "N", "Units sold in a year", "", 10_000, EXAMPLE, number_format="#,##0"),
    Input("price", "price", "Price of a unit", "", 900, EXAMPLE, number_format=_MONEY),
    Input("reserve", "reserve", "Reserve for claims", "", 300_000, EXAMPLE, number_format=_MONEY),
)

_UNIT = (
    Equation(
        "p_fail",
        "F(w)",
        "Probability of a failure within the term",
        "",
        "1-1/EXP((term/eta)^shape)",
        "Weibull",
        "Of these scale and shape.",
        number_format="0.0%",
    ),
    Equation(
        "covered",
        "",
        "A unit leads to a paid claim",
        "",
        "AND(life<=term,refused=0)",
        "T ≤ w",
        "",
        Role.ANSWER,
        "General",
    ),
    Equation(
        "unit_cost",
        "c,unit",
        "Warranty cost of a unit sold",
        "",
        "IF(covered,repair,0)",
        "definition",
        "Mostly 0; its mean is what a unit must earn for its warranty.",
        Role.ANSWER,
        '"$"#,##0.00',
    ),
)
_FLEET = (
    Equation(
        "p_claim",
        "p",
        "Probability of a paid claim",
        "",
        "p_fail*(1-share_refused)",
        "F(w)·(1 − ρ)",
        number_format="0.0%",
    ),
    Equation(
        "repair_mean",
        "c̄",
        "Mean cost of a repair",
        "",
        "SUMPRODUCT(INDEX(repairs,0,1),INDEX(repairs,0,2))/SUM(INDEX(repairs,0,2))",
        "definition",
        "Of so many claims: hundreds of repairs cost close to the mean each.",
        number_format='"$"#,##0.00',
    ),
    Equation("paid", "n,paid", "Paid claims of all units sold", "", "claims", "drawn", "", Role.ANSWER, "#,##0"),
    Equation("all_cost", "C", "Cost of all claims", "", "paid*repair_mean", "n·c̄", "", Role.ANSWER, _MONEY),
    Equation(
        "share",
        "q",
        "Cost of all claims, share of the sales",
        "",
        "all_cost/(sold*price)",
        "C/(N·price)",
        "",
        Role.ANSWER,
        "0.00%",
    ),
    Equation(
        "short", "", "The reserve is too small", "", "all_cost>reserve", "C > reserve", "", Role.ANSWER, "General"
    ),
)

_CHECKS = checks_section(
    3,
    check("check_life", "Life and shape are positive", "MIN(eta,shape,term)>0", "definition", "FALSE: look at them."),
    check(
        "check_share",
        "The share refused lies between 0 and 1",
        "AND(share_refused>=0,share_refused<=1)",
        "definition",
        "FALSE: a percentage entered as a number?",
    ),
    check(
        "check_repairs",
        "The probabilities of the repairs add up to 1",
        "ABS(SUM(INDEX(repairs,0,2))-1)<0.000001",
        "definition",
        "FALSE: look at the table of repairs on sheet Inputs.",
    ),
    check("check_claims", "There are no more claims than units", "claims<=sold", "definition", "FALSE: look at both."),
    called="Checks",
)

_STEPS = tuple(f"{step}/10" for step in range(21))
_DIAGRAM = Diagram(
    "Units that have failed, base case",
    "Age, years",
    "Share",
    (
        Curve("Failed", Look.FIRST, tuple((f"{x}*term", f"1-1/EXP(({x}*term/eta)^shape)") for x in _STEPS)),
        Curve("End of the term", Look.SECOND_PATH, (("term", "0"), ("term", "p_fail"))),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    GuideSection(
        "When to use this model",
        (
            "Units that fail once at an age that follows a Weibull distribution, are repaired under warranty at one of "
            "a few prices, and of which some claims are refused. It answers what the warranty of one unit costs on "
            "average, what all claims of a year's production cost, and whether the reserve suffices.",
            "Two kinds of uncertainty are kept apart. A unit's own life scatters, and averages out over 10,000 units. "
            "Scale and shape of the life are known from few tests; that error does not average out, and is nearly all "
            "of the spread of the total.",
            "xlmc fit LIFE.csv --help   says how to find scale and shape from ages at failure.",
            "Failures that follow one another, and units that are replaced and fail again, need another model.",
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Cost of a warranty",
    subtitle="Weibull life, repairs of a few prices, claims of a year's production",
    rung=2,
    question="What does a warranty cost, and is the reserve enough?",
    needs="scale and shape of the life, prices of repairs, term, units sold",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(Section("1  One unit", _UNIT), Section("2  All units sold", _FLEET), _CHECKS),
    forecasts=(
        ForecastRow("A unit leads to a paid claim", "covered", "", 80, kind="yes/no"),
        ForecastRow("Warranty cost of a unit sold", "unit_cost", "", 80, kind="currency"),
        ForecastRow("Paid claims of all units sold", "paid", "", 80),
        ForecastRow("Cost of all claims", "all_cost", "", 80, kind="currency"),
        ForecastRow("Cost of all claims, share of the sales", "share", "", 80, kind="percent"),
        ForecastRow("The reserve is too small", "short", "", 80, kind="yes/no"),
    ),
    filters=(),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Scale and shape that were fitted to the same ages: First, Second, and −0.3, say.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    group="Projects and products",
    columns=("Mean", "Std dev", "CoV %", "Scale", "Shape", "Probability", "Trials", "Data"),
    data=(
        DataTable(
            "repairs",
            "Repairs",
            ("Cost", "Probability"),
            (_MONEY, "0%"),
            ((150, 0.55), (400, 0.30), (900, 0.15)),
            EXAMPLE,
        ),
    ),
)
