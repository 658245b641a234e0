"""What a project costs and when it ends: a network of activities, costs that go together, a register of risks."""

from __future__ import annotations

from datetime import date

from templates.checks import check, checks_section
from templates.description import (
    CorrelationRow,
    Curve,
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

_MONEY, _DATE = '"$"#,##0', "yyyy-mm-dd"
_ESTIMATE = "Example: least, likeliest, most. Enter: your estimate, and whose it is"

_ACTIVITIES: tuple[tuple[str, str, tuple[int, int, int], tuple[int, int, int]], ...] = (
    ("design", "Design", (25, 30, 45), (60_000, 70_000, 95_000)),
    ("supply", "Procurement", (40, 50, 80), (180_000, 200_000, 260_000)),
    ("site", "Site works", (35, 45, 75), (120_000, 140_000, 210_000)),
    ("build", "Installation", (30, 35, 50), (90_000, 105_000, 140_000)),
    ("tests", "Commissioning", (8, 10, 20), (20_000, 25_000, 45_000)),
)
"""Symbol, name, working days and cost: least, likeliest, most."""

_RISKS: tuple[tuple[str, str, float, tuple[int, int, int], tuple[int, int, int]], ...] = (
    ("ground", "Ground worse than surveyed", 0.3, (20_000, 35_000, 80_000), (5, 10, 20)),
    ("permit", "Permit late", 0.25, (5_000, 8_000, 15_000), (10, 15, 30)),
    ("price", "Supplier raises the price", 0.2, (15_000, 25_000, 50_000), (0, 0, 1)),
    ("rework", "Rework after the tests", 0.15, (10_000, 20_000, 60_000), (3, 6, 15)),
)
"""Symbol, name, probability, cost and working days where it happens: least, likeliest, most."""


def _serial(day: date) -> int:
    """The number that a spreadsheet shows as this day."""
    return (day - date(1899, 12, 30)).days


def _three(values: tuple[int, int, int]) -> dict[str, float]:
    return dict(zip(("Low", "Likeliest", "High"), values, strict=True))


def _activity(symbol: str, name: str, days: tuple[int, int, int], cost: tuple[int, int, int]) -> tuple[Input, Input]:
    return (
        Input(
            f"t_{symbol}",
            f"t,{symbol}",
            f"{name}: duration",
            "days",
            days[1],
            _ESTIMATE,
            _three(days),
            "Triangular",
            "0",
        ),
        Input(
            f"c_{symbol}", f"c,{symbol}", f"{name}: cost", "", cost[1], _ESTIMATE, _three(cost), "Triangular", _MONEY
        ),
    )


def _risk(
    symbol: str, name: str, probability: float, cost: tuple[int, int, int], days: tuple[int, int, int]
) -> tuple[Input, Input, Input]:
    return (
        Input(
            f"r_{symbol}",
            f"r,{symbol}",
            f"Risk: {name[0].lower()}{name[1:]}",
            "",
            0,
            "Example: probability from the risk register. The base case is without it",
            {"Probability": probability},
            "Yes-No",
            "0",
        ),
        Input(
            f"i_{symbol}", f"i,{symbol}", f"{name}: cost", "", cost[1], _ESTIMATE, _three(cost), "Triangular", _MONEY
        ),
        Input(
            f"l_{symbol}", f"l,{symbol}", f"{name}: delay", "days", days[1], _ESTIMATE, _three(days), "Triangular", "0"
        ),
    )


_ASSUMPTIONS = (
    *(row for each in _ACTIVITIES for row in _activity(*each)),
    *(row for each in _RISKS for row in _risk(*each)),
)

_CONSTANTS = (
    Input("start", "start", "Start", "", _serial(date(2027, 3, 1)), EXAMPLE, number_format=_DATE),
    Input("deadline", "due", "Deadline", "", _serial(date(2027, 10, 29)), EXAMPLE, number_format=_DATE),
    Input("daily", "o", "Overhead for each working day", "$/day", 1_500, EXAMPLE, number_format=_MONEY),
    Input("budget", "budget", "Budget", "", 870_000, EXAMPLE, number_format=_MONEY),
)

_TIME = (
    Equation(
        "parallel",
        "t,par",
        "Procurement and site works, side by side",
        "days",
        "MAX(t_supply,t_site)",
        "the later one counts",
        "Its mean is later than either mean: where ways meet, a plan of single values is too early.",
        number_format="0.0",
    ),
    Equation(
        "delays",
        "l",
        "Delays by risks that happen",
        "days",
        "+".join(f"r_{symbol}*l_{symbol}" for symbol, *_ in _RISKS),
        "Σ r·l",
        number_format="0.0",
    ),
    Equation(
        "days",
        "t",
        "Duration",
        "days",
        "t_design+parallel+t_build+t_tests+delays",
        "critical path",
        "Working days.",
        Role.ANSWER,
        "0.0",
    ),
    Equation(
        "finish",
        "finish",
        "Finish",
        "",
        "WORKDAY(start,ROUNDUP(days,0))",
        "Monday to Friday",
        "Holidays: name them as WORKDAY's third argument.",
        Role.ANSWER,
        _DATE,
    ),
    Equation("late", "", "Later than the deadline", "", "finish>deadline", "finish > due", "", Role.ANSWER, "General"),
    Equation(
        "critical",
        "",
        "Procurement decides the finish",
        "",
        "t_supply>t_site",
        "criticality",
        "Else the site works do.",
        Role.ANSWER,
        "General",
    ),
)
_COST = (
    Equation(
        "direct",
        "c",
        "Cost of the activities",
        "",
        "+".join(f"c_{symbol}" for symbol, *_ in _ACTIVITIES),
        "Σ c",
        number_format=_MONEY,
    ),
    Equation(
        "events",
        "i",
        "Cost of risks that happen",
        "",
        "+".join(f"r_{symbol}*i_{symbol}" for symbol, *_ in _RISKS),
        "Σ r·i",
        number_format=_MONEY,
    ),
    Equation("overhead", "c,o", "Overhead", "", "daily*days", "o·t", number_format=_MONEY),
    Equation("cost", "C", "Cost of the project", "", "direct+events+overhead", "definition", "", Role.ANSWER, _MONEY),
    Equation("share", "p", "Cost, share of the budget", "", "cost/budget", "C/budget", "", Role.ANSWER, "0.0%"),
    Equation("over", "", "Over budget", "", "cost>budget", "C > budget", "", Role.ANSWER, "General"),
)

_CHECKS = checks_section(
    3,
    check(
        "check_days",
        "No activity is shorter than nothing",
        "MIN(" + ",".join(f"t_{symbol}" for symbol, *_ in _ACTIVITIES) + ")>=0",
        "definition",
        "FALSE: a duration is negative.",
    ),
    check("check_dates", "The deadline lies after the start", "deadline>start", "definition", "FALSE: exchanged?"),
    check("check_budget", "There is a budget", "budget>0", "definition", "FALSE: enter the budget."),
    check(
        "check_risks",
        "A risk happens or does not",
        "AND(" + ",".join(f"r_{symbol}*(1-r_{symbol})=0" for symbol, *_ in _RISKS) + ")",
        "definition",
        "FALSE: in the green cell of a risk stand 0 or 1; its probability stands under Probability.",
    ),
    called="Checks",
)


def _bar(name: str, begin: str, length: str, row: int) -> Curve:
    look = Look.FIRST if row % 2 else Look.SECOND
    return Curve(name, look, ((begin, str(row)), (f"{begin}+{length}", str(row))))


_DIAGRAM = Diagram(
    "The plan, base case",
    "Working days from the start",
    "Row",
    (
        _bar("Design", "0", "t_design", 5),
        _bar("Procurement", "t_design", "t_supply", 4),
        _bar("Site works", "t_design", "t_site", 3),
        _bar("Installation", "t_design+parallel", "t_build", 2),
        _bar("Commissioning", "t_design+parallel+t_build", "t_tests", 1),
        Curve("Finish, with delays", Look.POINT, (("days", "1"),)),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    GuideSection(
        "When to use this model",
        (
            "A project of activities in sequence, two of them side by side, whose costs and durations are estimated "
            "with three numbers each, and a register of risks that happen or do not. It answers what the project "
            "costs, when it ends, and how probable it is to stay within budget and deadline.",
            "P80. The reported range of cost and finish is the central one of 60 % (Range % of sheet Results wanted): "
            "it ends at P20 and at P80. The budget that suffices in 80 % of cases is its upper end; the contingency is "
            "that minus the estimate. All percentiles stand on the sheet Statistics of the results.",
            "Costs that rise together are correlated: the same market, the same crew. Left out, the spread of the sum "
            "comes out too small, since high and low costs cancel. So are duration and cost of one activity.",
            "A risk is a row with its probability (Yes-No), one with its cost and one with its delay; it counts in the "
            "trials in which it happens. Risks that have happened: type 1 in the green cell and freeze the row.",
            "Further activities: add rows to the table, name their cells (Formulas, Define Name), and add the names to "
            "the sums of sheet Model (Review, Unprotect Sheet).",
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Cost and schedule of a project",
    subtitle="Activities with costs that go together, a register of risks, a finish date",
    rung=1,
    question="What does a project cost, and when does it end?",
    needs="durations and costs as three numbers, risks with probabilities",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(Section("1  Time", _TIME), Section("2  Cost", _COST), _CHECKS),
    forecasts=(
        ForecastRow("Cost of the project", "cost", "", 60, kind="currency"),
        ForecastRow("Over budget", "over", "", 60, kind="yes/no"),
        ForecastRow("Cost, share of the budget", "share", "", 60, kind="percent"),
        ForecastRow("Finish", "finish", "", 60, kind="date or time"),
        ForecastRow("Later than the deadline", "late", "", 60, kind="yes/no"),
        ForecastRow("Duration", "days", "working days", 60),
        ForecastRow("Procurement decides the finish", "critical", "", 60, kind="yes/no", stated="diagnostic"),
    ),
    filters=(),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(
        CorrelationRow("t_site", "c_site", 0.6),
        CorrelationRow("c_site", "c_build", 0.4),
        CorrelationRow("t_build", "c_build", 0.6),
        CorrelationRow("t_design", "c_design", 0.6),
    ),
    correlation_note="Rank correlations, as estimated. Rows may be added.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    group="Projects and products",
    columns=("Low", "Likeliest", "High", "Probability"),
)
