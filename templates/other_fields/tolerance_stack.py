"""Parts in a housing: is there a gap left, and is it small enough, over the temperatures of use?"""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
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
from templates.editions import Both
from templates.other_fields.guidance import CAVEATS, EXAMPLE, EXAMPLE_NUMBERS, FIRST_STEPS

__all__ = ["TEMPLATE"]

_RECTANGULAR = "Example. Limits and nothing else known: rectangular (GUM, JCGM 100:2008, 4.3.7)"
_CAPABLE = "Example. Process with Cpk 1: the tolerance is 3 standard deviations"
_TRIANGULAR = "Example. Values near the limits less likely than at the middle: triangular (GUM 4.3.9)"
_NUMBER = "0.000[0|]"

_PARTS = ("bearing", "spacer", "gear", "ring")

_ASSUMPTIONS = (
    Input(
        "housing",
        "H",
        "Depth of the housing",
        "[in|mm]",
        Both(4, 100),
        _RECTANGULAR,
        {"Low": Both(3.996, 99.9), "High": Both(4.004, 100.1)},
        "Uniform",
        _NUMBER,
    ),
    Input(
        "bearing",
        "b",
        "Width of the bearing",
        "[in|mm]",
        Both(0.75, 19),
        _RECTANGULAR,
        {"Low": Both(0.7476, 18.94), "High": Both(0.7524, 19.06)},
        "Uniform",
        _NUMBER,
    ),
    Input(
        "spacer",
        "s",
        "Length of the spacer",
        "[in|mm]",
        Both(1.25, 31),
        _CAPABLE,
        {"Mean": Both(1.25, 31), "Std dev": Both(0.0007, 0.017)},
        "Normal",
        _NUMBER,
    ),
    Input(
        "gear",
        "z",
        "Width of the gear",
        "[in|mm]",
        Both(1.5, 37.6),
        _TRIANGULAR,
        {"Low": Both(1.498, 37.55), "Likeliest": Both(1.5, 37.6), "High": Both(1.502, 37.65)},
        "Triangular",
        _NUMBER,
    ),
    Input(
        "ring",
        "r",
        "Thickness of the ring",
        "[in|mm]",
        Both(0.492, 12.2),
        _RECTANGULAR,
        {"Low": Both(0.4908, 12.17), "High": Both(0.4932, 12.23)},
        "Uniform",
        _NUMBER,
    ),
    Input(
        "warming",
        "ΔT",
        "Temperature of use, above that of assembly",
        "[°F|K]",
        Both(36, 20),
        EXAMPLE,
        {"Low": Both(-36, -20), "High": Both(108, 60)},
        "Uniform",
        "0",
    ),
    Input(
        "a_housing",
        "αH",
        "Expansion of the housing (aluminium)",
        "10⁻⁶/[°F|K]",
        Both(12.8, 23),
        "Example: alloys differ by as much. Enter: the supplier's",
        {"Low": Both(12.2, 22), "High": Both(13.4, 24)},
        "Uniform",
        "0.0",
    ),
    Input(
        "a_parts",
        "αP",
        "Expansion of the parts (steel)",
        "10⁻⁶/[°F|K]",
        Both(6.5, 11.7),
        "Example: carbon and alloy steels differ by as much. Enter: the supplier's",
        {"Low": Both(6.1, 11), "High": Both(6.9, 12.4)},
        "Uniform",
        "0.0",
    ),
)

_CONSTANTS = (
    Input("gap_min", "gmin", "Least gap allowed", "[in|mm]", 0, EXAMPLE, number_format=_NUMBER),
    Input("gap_max", "gmax", "Greatest gap allowed", "[in|mm]", Both(0.018, 0.45), EXAMPLE, number_format=_NUMBER),
    Input("million", "10⁶", "One million", "", 1_000_000, "Definition", number_format="#,##0"),
)

_STEPS = (
    Equation(
        "stack", "S", "Length of the stack", "[in|mm]", "+".join(_PARTS), "sum of the parts", number_format=_NUMBER
    ),
    Equation(
        "gap",
        "g0",
        "Gap as assembled",
        "[in|mm]",
        "housing-stack",
        "H − S",
        "Linear: its variance is the sum of the variances.",
        Role.ANSWER,
        _NUMBER,
    ),
    Equation(
        "growth",
        "Δg",
        "Growth of the gap with temperature",
        "[in|mm]",
        "(a_housing*housing-a_parts*stack)*warming/million",
        "Δl = α·l·ΔT",
        "A product: what expansion does depends on the temperature.",
        number_format=_NUMBER,
    ),
    Equation("gap_hot", "g", "Gap in use", "[in|mm]", "gap+growth", "g0 + Δg", "", Role.ANSWER, _NUMBER),
    Equation("tight", "", "Too tight in use", "", "gap_hot<gap_min", "g < gmin", "", Role.ANSWER, "General"),
    Equation("loose", "", "Too loose in use", "", "gap_hot>gap_max", "g > gmax", "", Role.ANSWER, "General"),
    Equation(
        "used",
        "p",
        "Gap in use, share of the greatest allowed",
        "",
        "gap_hot/gap_max",
        "g/gmax",
        "",
        Role.ANSWER,
        "0%",
    ),
)

_CHECKS = checks_section(
    2,
    check(
        "check_parts", "No dimension is negative", f"MIN(housing,{','.join(_PARTS)})>=0", "geometry", "FALSE: a sign?"
    ),
    check("check_limits", "The limits leave room", "gap_max>gap_min", "definition", "FALSE: exchanged?"),
    check(
        "check_metal",
        "Expansions are those of metals",
        "AND(MIN(a_housing,a_parts)>=0,MAX(a_housing,a_parts)<=[23|41])",
        "handbooks",
        "FALSE: in other units? They are in millionths for a degree.",
    ),
    called="Checks",
)


def _bar(name: str, look: Look, before: str, length: str, height: str) -> Curve:
    return Curve(name, look, ((before, height), (f"{before}+{length}", height)))


_DIAGRAM = Diagram(
    "The stack in its housing, base case, as assembled",
    "Length, [in|mm]",
    "Row",
    (
        _bar("Housing", Look.LINE, "0", "housing", "2"),
        *(
            _bar(part.capitalize(), Look.FIRST if k % 2 else Look.SECOND, "+".join(_PARTS[:k]) or "0", part, "1")
            for k, part in enumerate(_PARTS)
        ),
        Curve("Gap", Look.POINT, (("stack", "1"), ("housing", "1"))),
    ),
    remark="Drawn from the cells below. The gap lies between the two points.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    GuideSection(
        "When to use this model",
        (
            "A chain of dimensions with tolerances that closes in a gap, and expands with temperature. Worst cases add "
            "tolerances up; here the gap is what the parts that are made will really leave, with the share of "
            "assemblies that are too tight or too loose.",
            "Fewer parts: type 0 and freeze the row. More: add a row to the table, name its cell (Formulas, Define "
            "Name) and add the name to the stack of sheet Model.",
            "The sheet Sensitivity of the results shows Sobol indices: which tolerance is worth tightening, alone and "
            "together with others. No filter is set here, so they are given.",
            "Parts of one batch are alike: then Correlations has a row for them, and Sobol indices are left out.",
        ),
    ),
    GuideSection(
        "Type B: which distribution for what is known",
        (
            "After the Guide to the expression of uncertainty in measurement (GUM, JCGM 100:2008) and its supplement 1 "
            "(JCGM 101:2008).",
        ),
        (
            ("What is known", "Distribution"),
            ("Limits ± a, nothing else (GUM 4.3.7)", "Uniform: Low, High. Standard uncertainty a/√3"),
            ("Limits ± a, the middle likelier (GUM 4.3.9)", "Triangular; a/√6"),
            ("The sum of two errors with limits ± a and ± b", "Trapezoid; Triangular where they are alike"),
            ("A value with standard uncertainty u, or U = k·u (GUM 4.3.3)", "Normal: Mean, Std dev U/k"),
            ("A mean of n readings (JCGM 101, 6.4.9.2)", "Student's t: Midpoint, Scale s/√n, Degrees of freedom n − 1"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Tolerance stack",
    subtitle="Four parts in a housing: the gap as assembled and in use",
    rung=2,
    question="Do parts with tolerances fit, and which tolerance decides?",
    needs="dimensions with tolerances, temperatures, expansion",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(Section("1  The gap", _STEPS), _CHECKS),
    forecasts=(
        ForecastRow("Gap as assembled", "gap", "[in|mm]", 95),
        ForecastRow("Gap in use", "gap_hot", "[in|mm]", 95),
        ForecastRow("Gap in use, share of the greatest allowed", "used", "", 95, kind="percent"),
        ForecastRow("Too tight in use", "tight", "", 95, kind="yes/no"),
        ForecastRow("Too loose in use", "loose", "", 95, kind="yes/no"),
    ),
    filters=(),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Parts of one batch that are alike? First, Second, and 0.5, say.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    group="Engineering",
    columns=("Low", "High", "Likeliest", "Mean", "Std dev"),
)
