"""A simply supported steel beam: does it fail in bending, and does it sag too much?"""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Curve,
    Diagram,
    Equation,
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
from templates.other_fields.guidance import CAVEATS, EXAMPLE, EXAMPLE_NUMBERS, FIRST_STEPS

__all__ = ["TEMPLATE"]

_JCSS = "JCSS Probabilistic Model Code"
_SECTION = "Example: a rolled section. Enter yours, from the maker's table"

_ASSUMPTIONS = (
    Input(
        "dead",
        "D",
        "Dead load",
        "[kip/ft|kN/m]",
        Both(0.525, 7.66),
        "Example: a little above the nominal [0.50 kip/ft|7.3 kN/m]. Enter yours",
        {"Mean": Both(0.525, 7.66), "CoV %": 10},
        "Normal",
        "0.000",
    ),
    Input(
        "live",
        "Q",
        "Live load, the greatest in 50 years",
        "[kip/ft|kN/m]",
        Both(1.2, 17.5),
        "Example. Gumbel, since it is the largest of many. Enter yours",
        {"Mean": Both(1.2, 17.5), "CoV %": 25},
        "Gumbel",
        "0.000",
    ),
    Input(
        "fy",
        "Fy",
        "Yield strength",
        "[ksi|MPa]",
        Both(52.5, 362),
        f"Example, above the specified [50 ksi|345 MPa]. Type and CoV: {_JCSS}, see sheet Guide",
        {"Mean": Both(52.5, 362), "CoV %": 10},
        "Lognormal",
        "0.0",
    ),
    Input(
        "fabrication",
        "kF",
        "Section modulus, real to nominal",
        "",
        1,
        "Example: what rolling and fabrication leave. Enter yours",
        {"Mean": 1, "CoV %": 5},
        "Normal",
        "0.00",
    ),
    Input(
        "professional",
        "kP",
        "Strength, tested to computed",
        "",
        1.02,
        f"Example. {_JCSS}: mean 1.0, CoV 5 %; see sheet Guide",
        {"Mean": 1.02, "CoV %": 6},
        "Normal",
        "0.00",
    ),
)

_CONSTANTS = (
    Input("span", "L", "Span", "[ft|m]", Both(24, 7.3), EXAMPLE, number_format="0.00"),
    Input("Z_x", "Z", "Plastic section modulus", "[in³|cm³]", Both(54, 884), _SECTION, number_format="0.0"),
    Input("I_x", "I", "Moment of inertia", "[in⁴|cm⁴]", Both(375, 15600), _SECTION, number_format="0"),
    Input(
        "E_s", "E", "Modulus of elasticity", "[ksi|MPa]", Both(29000, 200000), "Structural steel", number_format="#,##0"
    ),
    Input(
        "q_test",
        "qtest",
        "Total load that it has carried already",
        "[kip/ft|kN/m]",
        Both(2.3, 33.5),
        "Example: a load test. Enter 0 if the beam is not built yet",
        number_format="0.00",
    ),
    Input(
        "sag_share",
        "n",
        "Allowed deflection: span over",
        "",
        360,
        "Floors under live load: International Building Code, table 1604.3",
        number_format="0",
    ),
    Input(
        "[in_per_ft|unit]",
        "[12|1000]",
        "[Inches in a foot|MPa·cm³ in a kN·m; mm in a m]",
        "[in/ft|]",
        Both(12, 1000),
        "Definition",
        number_format="0",
    ),
)

_MOMENTS = (
    Equation("w", "w", "Total load", "[kip/ft|kN/m]", "dead+live", "definition", number_format="0.000"),
    Equation(
        "M_load",
        "M",
        "Greatest bending moment",
        "[kip·ft|kN·m]",
        "w*span^2/8",
        "w·L²/8",
        "At mid-span, under a uniform load.",
        Role.ANSWER,
        "0.0",
    ),
    Equation(
        "M_beam",
        "MR",
        "Moment that the beam resists",
        "[kip·ft|kN·m]",
        "fabrication*professional*fy*Z_x/[in_per_ft|unit]",
        "AISC 360, F2-1",
        "Plastic moment: compact section, compression flange held laterally.",
        Role.ANSWER,
        "0.0",
    ),
    Equation(
        "M_test",
        "Mtest",
        "Moment that it has resisted already",
        "[kip·ft|kN·m]",
        "q_test*span^2/8",
        "w·L²/8",
        number_format="0.0",
    ),
    Equation(
        "reserve",
        "MR − Mtest",
        "Resistance beyond the moment carried already",
        "[kip·ft|kN·m]",
        "M_beam-M_test",
        "definition",
        "Below 0 the beam would have failed then; the filter rejects such trials.",
        number_format="0.0",
    ),
)

_ANSWERS = (
    Equation(
        "utilization",
        "u",
        "Moment, share of the resistance",
        "",
        "M_load/M_beam",
        "M/MR",
        "Above 100 % it fails.",
        Role.ANSWER,
        "0.0%",
    ),
    Equation("fails", "", "Fails in 50 years", "", "M_load>M_beam", "M > MR", "", Role.ANSWER, "General"),
    Equation(
        "sag",
        "δ",
        "Deflection under live load",
        "[in|mm]",
        "5*live*[in_per_ft^2*in_per_ft|100*unit^2]*span^2*span^2/(384*E_s*I_x)",
        "5·q·L⁴/(384·E·I)",
        "At mid-span, elastic.",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "sags",
        "",
        "Sags more than allowed",
        "",
        "sag>[in_per_ft|unit]*span/sag_share",
        "δ > L/n",
        "",
        Role.ANSWER,
        "General",
    ),
)

_CHECKS = checks_section(
    3,
    check(
        "check_beam",
        "Span and section are positive",
        "MIN(span,Z_x,I_x,E_s)>0",
        "geometry",
        "FALSE: a beam needs a span and a section.",
    ),
    check("check_loads", "No load is negative", "MIN(dead,live,q_test)>=0", "statics", "FALSE: look at the loads."),
    check(
        "check_steel",
        "The strength is that of a structural steel",
        "AND(fy>=[25|170],fy<=[150|1030])",
        "usual range",
        "FALSE: in other units?",
    ),
    check(
        "check_factors",
        "Real to nominal is near 1",
        "AND(MIN(fabrication,professional)>0.5,MAX(fabrication,professional)<1.5)",
        "definition",
        "FALSE: a percentage entered as a number?",
    ),
    called="Checks",
)

_STEPS = tuple(f"{step}/10" for step in range(11))
_DIAGRAM = Diagram(
    "Bending moment along the beam, base case",
    "Distance from the support, [ft|m]",
    "Bending moment, [kip·ft|kN·m]",
    (
        Curve("Moment of the loads", Look.FIRST, tuple((f"{x}*span", f"w*{x}*(1-{x})*span^2/2") for x in _STEPS)),
        Curve("Moment that the beam resists", Look.SECOND, (("0", "M_beam"), ("span", "M_beam"))),
        Curve("Moment carried already", Look.SECOND_PATH, (("0", "M_test"), ("span", "M_test"))),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    GuideSection(
        "When to use this model",
        (
            "A steel beam on two supports under a uniform load, with a compact section that is held against buckling "
            "to the side. It answers how probable it is that bending exceeds what the beam resists while it stands.",
            "The live load is the greatest of 50 years, so the probability of failure is that of 50 years. Largest "
            "values follow a Gumbel distribution; its mean and CoV are typed, xlmc finds its parameters.",
            "The filter keeps the beams that have carried the test load. What has stood a test is stronger than what "
            "comes from the mill: set the load to 0 to see how much the test is worth.",
            "Other spans, supports, materials: change the formulas of sheet Model (Review, Unprotect Sheet). Strength "
            "and load need not be independent: a row of Correlations says so.",
            "Small probabilities: 200,000 trials give a probability of 0.1 % to about 7 % of itself. For 10⁻⁵ and "
            "less, add a filter Fails and run   xlmc simulate this-file.xlsx --until-accepted 10000 --rare auto   "
            "The share of trials accepted is the probability of failure.",
        ),
    ),
    GuideSection(
        "Published statistics (JCSS Probabilistic Model Code, part 3)",
        ("Of rolled sections. Loads, means and the section modulus of this workbook are examples.",),
        (
            ("Quantity", "Type, mean, CoV"),
            ("Yield strength, European production", "lognormal, 7 %; in the US and Canada about half as much again"),
            ("Modulus of elasticity", "lognormal, specified value, 3 %"),
            ("Area of a rolled profile (part 2, Self Weight)", "1 % above nominal; SD 4 % of nominal"),
            ("Bending capacity, real to computed", "lognormal, 1.0, 5 %"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Beam with uncertain load and strength",
    subtitle="A simply supported steel beam under a uniform load: M = w L²/8 against MR = Fy Z",
    rung=1,
    question="Does a steel beam fail under its loads, and does it sag too much?",
    needs="loads with their scatter, span, section, strength",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(Section("1  Load and resistance", _MOMENTS), Section("2  Answers (the forecasts)", _ANSWERS), _CHECKS),
    forecasts=(
        ForecastRow("Fails in 50 years", "fails", "", kind="yes/no"),
        ForecastRow("Moment, share of the resistance", "utilization", "", kind="percent"),
        ForecastRow("Greatest bending moment", "M_load", "[kip·ft|kN·m]"),
        ForecastRow("Moment that the beam resists", "M_beam", "[kip·ft|kN·m]"),
        ForecastRow("Deflection under live load", "sag", "[in|mm]"),
        ForecastRow("Sags more than allowed", "sags", "", kind="yes/no"),
    ),
    filters=(
        FilterRow(
            "Carried the test load", "reserve", "The beam stood under the load that it has carried already", at_least=0
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Two loads that come together, such as snow and wind? First, Second, and 0.3, say.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    group="Engineering",
    columns=("Low", "High", "Mean", "Std dev", "CoV %"),
)
