"""The calibration of a weight by comparison in air: what acts only together with something else."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import Equation, ForecastRow, GuideSection, Input, Role, Section, Template
from templates.other_fields.guidance import CAVEATS, EXAMPLE, EXAMPLE_NUMBERS, FIRST_STEPS

__all__ = ["TEMPLATE"]

_LIMITS = "Example. Limits and nothing else known. Enter yours"

_ASSUMPTIONS = (
    Input(
        "m_Rc",
        "mR,c",
        "Conventional mass of the reference weight",
        "mg",
        100_000,
        "Example. Enter: its certificate",
        {"Mean": 100_000, "Std dev": 0.05},
        "Normal",
        "0.000",
    ),
    Input(
        "dm_Rc",
        "δmR,c",
        "Mass added to balance the weight",
        "mg",
        1.234,
        "Example. Enter: your comparison",
        {"Mean": 1.234, "Std dev": 0.02},
        "Normal",
        "0.000",
    ),
    Input("rho_a", "ρa", "Density of the air", "kg/m³", 1.2, _LIMITS, {"Low": 1.1, "High": 1.3}, "Uniform", "0.00"),
    Input(
        "rho_W",
        "ρW",
        "Density of the weight",
        "kg/m³",
        8000,
        _LIMITS,
        {"Low": 7000, "High": 9000},
        "Uniform",
        "0",
    ),
    Input(
        "rho_R",
        "ρR",
        "Density of the reference weight",
        "kg/m³",
        8000,
        _LIMITS,
        {"Low": 7950, "High": 8050},
        "Uniform",
        "0",
    ),
)

_CONSTANTS = (
    Input("m_nom", "mnom", "Nominal mass", "mg", 100_000, f"{EXAMPLE} (100 g)", number_format="#,##0"),
    Input("rho_a0", "ρa0", "Density of the air, conventional", "kg/m³", 1.2, "OIML D 28 (2004)", number_format="0.0"),
    Input(
        "permitted",
        "MPE",
        "Maximum permissible error",
        "mg",
        1.6,
        "Example. Enter: the limit of its class",
        number_format="0.00",
    ),
)

_STEPS = (
    Equation(
        "volumes",
        "v",
        "Difference of the specific volumes",
        "m³/kg",
        "1/rho_W-1/rho_R",
        "definition",
        "0 at the base case: to first order the air's density does not matter.",
        number_format="0.00E+00",
    ),
    Equation(
        "buoyancy",
        "B",
        "Correction for the buoyancy of the air",
        "mg",
        "(m_Rc+dm_Rc)*(rho_a-rho_a0)*volumes",
        "m·(ρa − ρa0)·v",
        number_format="0.0000",
    ),
    Equation(
        "delta_m",
        "δm",
        "Deviation from the nominal mass",
        "mg",
        "(m_Rc-m_nom)+dm_Rc+buoyancy",
        "mR,c − mnom + δmR,c + B",
        "100,000 mg are subtracted first, so that no digits are lost.",
        Role.ANSWER,
        "0.0000",
    ),
    Equation(
        "share",
        "p",
        "Deviation, share of what is permitted",
        "",
        "ABS(delta_m)/permitted",
        "|δm|/MPE",
        "",
        Role.ANSWER,
        "0.0%",
    ),
    Equation(
        "conforms", "", "Conforms to its class", "", "ABS(delta_m)<=permitted", "|δm| ≤ MPE", "", Role.ANSWER, "General"
    ),
)

_CHECKS = checks_section(
    2,
    check(
        "check_density",
        "Densities are those of metals, in kg/m³",
        "AND(MIN(rho_W,rho_R)>1000,MAX(rho_W,rho_R)<25000)",
        "handbooks",
        "FALSE: in g/cm³? Multiply by 1000.",
    ),
    check("check_air", "The air is as dense as air", "AND(rho_a>0.5,rho_a<1.6)", "physics", "FALSE: in other units?"),
    check(
        "check_mass",
        "The reference weight has about the nominal mass",
        "ABS(m_Rc-m_nom)<0.01*m_nom",
        "definition",
        "FALSE: in grams?",
    ),
    called="Checks",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    GuideSection(
        "When to use this model",
        (
            "A weight of 100 g is compared with a reference weight in air, which carries the two unequally where their "
            "densities differ. The conventional mass of a body is that of the weight of 8000 kg/m³ which balances it "
            "in air of 1.2 kg/m³ (OIML D 28, 2004). It answers how far the weight is from its nominal mass.",
        ),
    ),
    GuideSection(
        "What it shows",
        (
            "The law of propagation, to first order, gives 0.054 mg for these numbers, and Monte Carlo 0.075 mg: the "
            "density of the air and that of the weight each do nothing alone while the other is at its middle. "
            "Together they are the largest part. Sobol indices "
            "show that: their first order is 0, their total is not.",
            "xlmc methods mass-calibration.xlsx   runs the propagation beside Monte Carlo and says which to use.",
            "xlmc simulate mass-calibration.xlsx --adaptive 2   runs until two digits are stable (JCGM 101, 7.9).",
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Calibration of a weight",
    subtitle="A weight of 100 g is compared with a reference weight in air",
    rung=3,
    question="How far is a weight from its nominal mass, and does it conform?",
    needs="the comparison, densities of air and weights",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(),
    sections=(Section("1  The measurement", _STEPS), _CHECKS),
    forecasts=(
        ForecastRow("Deviation from the nominal mass", "delta_m", "mg", 95),
        ForecastRow("Deviation, share of what is permitted", "share", "", 95, kind="percent"),
        ForecastRow("Conforms to its class", "conforms", "", 95, kind="yes/no"),
    ),
    filters=(),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Two weights of one melt have one density: First, Second, and 0.9, say.",
    guide=_GUIDE,
    group="Engineering",
    columns=("Low", "High", "Mean", "Std dev"),
)
