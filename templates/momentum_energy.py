"""Two vehicles meet: the closing speed from the energy that crush took, its direction from momentum."""

from __future__ import annotations

from dataclasses import replace

from templates.checks import check, checks_section
from templates.description import (
    CorrelationRow,
    Diagram,
    Equation,
    EvidenceRow,
    FilterRow,
    ForecastRow,
    GuideSection,
    Input,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, FIRST_STEPS, NAMES, READINGS
from templates.plan_view import mark, turned
from templates.two_vehicles.answers import ANSWERS, FORCE
from templates.two_vehicles.checks import FRICTION
from templates.two_vehicles.drawing import rest_points, vehicle_curves
from templates.two_vehicles.equations import MASSES
from templates.two_vehicles.example_scene import MOMENTUM_EXAMPLE
from templates.two_vehicles.options import drawing_inputs
from templates.two_vehicles.readings import direction_reading, direction_section
from templates.two_vehicles.results import direction_forecasts, paper_forecasts, shared_road_note
from templates.two_vehicles.run_out import (
    RUN_OUT_CHECK,
    RUN_OUT_GUIDE,
    RUN_OUT_NOTE,
    before_section,
    run_out_forecasts,
    run_out_inputs,
    segmented_run_out,
)
from templates.two_vehicles.scene import assumptions_of_momentum, constants_of_momentum, yaw_rates
from templates.two_vehicles.together import SWITCH, drawn_together, leave_together
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["TEMPLATE"]

_SCENE = replace(
    MOMENTUM_EXAMPLE,
    ranges={
        "w_1": Both((1920, 1960), (870, 890)),
        "alpha_1": (-3, 3),
        "beta_1": (346, 356),
        "s_1": Both((21, 24), (6.4, 7.4)),
        "f_1": (0.65, 0.75),
        "w_2": Both((3480, 3570), (1580, 1620)),
        "alpha_2": (180, 188),
        "beta_2": (177, 187),
        "s_2": Both((45, 51), (13.8, 15.4)),
        "f_2": (0.65, 0.75),
    },
    base={},
    sources=MOMENTUM_EXAMPLE.sources
    | {
        f"f_{j}": "Example: about 0.7, with which the travel gives the speeds after the impact of that case. Enter: "
        "published drag of this surface, share of locked wheels, grade"
        for j in (1, 2)
    },
)
"""Close to a head-on case of Schreier and Nelson (SAE Transactions 96, 1987), where momentum alone is blind."""

_EES = {1: Both((37, 45), (59, 73)), 2: Both((23.5, 28.5), (38, 46))}
_INERTIA = {1: Both((700, 770), (950, 1050)), 2: Both((1880, 2080), (2550, 2810))}
_WHEELBASE = {1: Both(7.87, 2.4), 2: Both(9.17, 2.795)}
_ROTATION = {1: 200, 2: 64}


def _ranged(
    symbol: str, notation: str, name: str, unit: str, ends: Both | tuple[float, float], source: str, shown: str
) -> Input:
    """An input that is uniform between two ends, its base value in the middle."""
    (low, high), (low_si, high_si) = (ends.imperial, ends.si) if isinstance(ends, Both) else (ends, ends)
    return Input(
        symbol,
        notation,
        name,
        unit,
        Both((low + high) / 2, (low_si + high_si) / 2),
        source,
        {"Low": Both(low, low_si), "High": Both(high, high_si)},
        number_format=shown,
    )


def _of_vehicle(j: int) -> tuple[Input, ...]:
    return (
        _ranged(
            f"EES_{j}",
            f"EES{j}",
            f"{vehicle(j)} energy equivalent speed of its crush",
            "[mph|km/h]",
            _EES[j],
            "Example. Enter: the energy equivalent speed of crush-energy (of energy lost; not EBS, that of energy "
            "absorbed), or of tests of like vehicles. Delta-V by CRASH3 was within 9 to 25 % (Smith and Noga, DOT HS "
            "806 152)",
            "0.0",
        ),
        _ranged(
            f"phi_{j}",
            f"φ{j}",
            f"{vehicle(j)} rotation from the impact to rest, counter-clockwise",
            "deg",
            (_ROTATION[j] - 10, _ROTATION[j] + 10),
            "Example. Enter: rest heading less approach heading; whole turns only where marks show them",
            "0",
        ),
        _ranged(
            f"mu_{j}",
            f"μR{j}",
            f"{vehicle(j)} friction against rotating",
            "",
            (0.3, 0.4),
            "0.3 to 0.4 in the case of Schreier and Nelson (SAE Transactions 96, 1987); more with locked wheels",
            "0.00",
        ),
        _ranged(
            f"I_{j}",
            f"I{j}",
            f"{vehicle(j)} yaw moment of inertia",
            "[lb·ft·s²|kg·m²]",
            _INERTIA[j],
            "Example. Enter: published inertia, or about 0.127 times mass, wheelbase and length (Schreier and Nelson)",
            "#,##0",
        ),
    )


_ASSUMPTIONS = (
    *(given for given in assumptions_of_momentum(_SCENE) if given.symbol != "alpha_2"),
    *(given for j in (1, 2) for given in _of_vehicle(j)),
)

_CONSTANTS = (
    *(
        Input(
            f"R_{j}",
            f"R{j}",
            f"{vehicle(j)} wheelbase",
            "[ft|m]",
            _WHEELBASE[j],
            "Example. Enter: published dimensions",
            number_format="0.00",
        )
        for j in (1, 2)
    ),
    Input(
        "lane_2",
        "",
        f"{vehicle(2)} direction of its lane, roughly",
        "deg",
        184,
        "Only says how its approach angle, an answer, is counted: within 180° of this",
        number_format="0",
    ),
    SWITCH,
    *yaw_rates(),
    *constants_of_momentum(),
)

_ROTATIONS = (
    Equation("omega{j}_i", "ω{j}i", "{who} yaw rate before", "rad/s", "RADIANS(omega{j}_deg)", "input"),
    Equation(
        "omega{j}_f",
        "ω{j}f",
        "{who} yaw rate after",
        "rad/s",
        "SIGN(phi_{j})*SQRT(mu_{j}*m_{j}*g*R_{j}*RADIANS(ABS(phi_{j}))/I_{j})",
        "sgn φ·√(μR·m·g·R·|φ|/I)",
        "<Friction under the tyres, at half the wheelbase, brings the rotation to rest: a crude law.|>",
    ),
)

_ENERGY = (
    Equation(
        "E_crush",
        "Ed",
        "Energy lost to crush",
        "[ft·lb|J]",
        f"(m_1*(EES_1/({MPH}))^2+m_2*(EES_2/({MPH}))^2)/2",
        "½·m·EES²",
        number_format="#,##0",
    ),
    Equation(
        "E_spin",
        "Erot",
        "Energy that went into rotation",
        "[ft·lb|J]",
        "(I_1*(omega1_f^2-omega1_i^2)+I_2*(omega2_f^2-omega2_i^2))/2",
        "½·I·(ωf² − ωi²)",
        number_format="#,##0",
    ),
    Equation("m_red", "m̄", "Reduced mass", "[lb·s²/ft|kg]", "m_1*m_2/(m_1+m_2)", "m1·m2/(m1 + m2)"),
    Equation(
        "apart_2",
        "|V1f − V2f|²",
        "Square of the speed at which they part",
        "[ft|m]²/s²",
        "(V1_f-V2_f)^2+4*V1_f*V2_f*SIN(RADIANS((beta_1-beta_2)/2))^2",
        "law of cosines",
        "Not V1f² + V2f² − 2·V1f·V2f·cos(β1 − β2), which loses digits where both leave alike.",
    ),
    Equation(
        "V_close",
        "c",
        "Closing speed",
        "[ft|m]/s",
        "SQRT(apart_2+2/m_red*(E_crush+E_spin))",
        "½·m̄·c² = ½·m̄·|V1f − V2f|² + Ed + Erot",
        "A sum of positive numbers: no digits are lost, whatever the angle (Zeidler and others, SAE 850256).",
    ),
)

_SPEEDS = (
    Equation(
        "p_along",
        "p∥",
        "Momentum after, along the approach of «1»",
        "[lb·s|N·s]",
        "m_1*V1_f*COS(RADIANS(beta_1-alpha_1))+m_2*V2_f*COS(RADIANS(beta_2-alpha_1))",
        "definition",
        number_format="#,##0.00",
    ),
    Equation(
        "p_across",
        "p⊥",
        "Momentum after, across it, 90° counter-clockwise",
        "[lb·s|N·s]",
        "m_1*V1_f*SIN(RADIANS(beta_1-alpha_1))+m_2*V2_f*SIN(RADIANS(beta_2-alpha_1))",
        "definition",
        "All of it was that of «2» before the impact.",
        number_format="#,##0.00",
    ),
    Equation(
        "reach",
        "prest",
        "Closing momentum beyond what went across",
        "[lb·s|N·s]",
        "m_2*V_close-ABS(p_across)",
        "m2·c − |p⊥|",
        "Below 0 no speed fits. Near 0 energy says little, and momentum answers better.",
        number_format="#,##0.00",
    ),
    Equation(
        "root",
        "pc",
        "Closing momentum along the approach of «1»",
        "[lb·s|N·s]",
        "SQRT(MAX(reach,0)*(m_2*V_close+ABS(p_across)))",
        "√((m2·c)² − p⊥²)",
        "As a product, which keeps its digits. The other root would drive the vehicles apart.",
        number_format="#,##0.00",
    ),
    Equation("V1_i", "V1i", "«1» impact speed", "[ft|m]/s", "(p_along+root)/(m_1+m_2)", "(p∥ + pc)/(m1 + m2)"),
    Equation(
        "V2_along",
        "V2∥",
        "«2» impact velocity, along the approach of «1»",
        "[ft|m]/s",
        "(p_along-m_1*V1_i)/m_2",
        "momentum",
    ),
    Equation(
        "V2_across",
        "V2⊥",
        "«2» impact velocity, across it, 90° counter-clockwise",
        "[ft|m]/s",
        "p_across/m_2",
        "momentum",
    ),
    Equation("V2_i", "V2i", "«2» impact speed", "[ft|m]/s", "SQRT(V2_along^2+V2_across^2)", "momentum"),
    Equation(
        "aside_2",
        "Δα",
        "«2» approach angle, from that of «1»",
        "deg",
        "DEGREES(ATAN2(V2_along,V2_across))",
        "momentum",
        number_format="0.00",
    ),
    Equation(
        "alpha_2",
        "α2",
        "«2» approach angle",
        "deg",
        "alpha_1+aside_2-360*ROUND((alpha_1+aside_2-lane_2)/360,0)",
        "momentum",
        "An answer, not an input: compare it with the lane. Counted to within 180° of that: 359° and 1° are near.",
        number_format="0.00",
    ),
)

_CHANGES = (
    Equation(
        "dV1_along",
        "ΔV1∥",
        "«1» change in velocity, along its approach",
        "[ft|m]/s",
        "V1_f*COS(RADIANS(beta_1-alpha_1))-V1_i",
        "definition",
    ),
    Equation(
        "dV1_across",
        "ΔV1⊥",
        "«1» change in velocity, across its approach, 90° counter-clockwise",
        "[ft|m]/s",
        "V1_f*SIN(RADIANS(beta_1-alpha_1))",
        "definition",
    ),
    Equation("dV_1", "ΔV1", "«1» change in velocity", "[ft|m]/s", "SQRT(dV1_along^2+dV1_across^2)", "definition"),
    Equation("dV_2", "ΔV2", "«2» change in velocity", "[ft|m]/s", "dV_1*m_1/m_2", "the opposite impulse"),
    Equation(
        "dV1_x",
        "ΔV1x",
        "«1» change in velocity, X",
        "[ft|m]/s",
        "dV1_along*COS(RADIANS(alpha_1))-dV1_across*SIN(RADIANS(alpha_1))",
        "definition",
    ),
    Equation(
        "dV1_y",
        "ΔV1y",
        "«1» change in velocity, Y",
        "[ft|m]/s",
        "dV1_along*SIN(RADIANS(alpha_1))+dV1_across*COS(RADIANS(alpha_1))",
        "definition",
    ),
    Equation("dV2_x", "ΔV2x", "«2» change in velocity, X", "[ft|m]/s", "-dV1_x*m_1/m_2", "the opposite impulse"),
    Equation("dV2_y", "ΔV2y", "«2» change in velocity, Y", "[ft|m]/s", "-dV1_y*m_1/m_2", "the opposite impulse"),
)

_FORCE = (
    replace(
        FORCE[0],
        name="Closing speed",
        formula=f"V_close*{MPH}",
        reference="from energy, above",
    ),
    *FORCE[1:],
)

_BALANCE = (
    Equation(
        "E_before",
        "Ei",
        "Kinetic energy before",
        "[ft·lb|J]",
        "(m_1*V1_i^2+m_2*V2_i^2+I_1*omega1_i^2+I_2*omega2_i^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_after",
        "Ef",
        "Kinetic energy after",
        "[ft·lb|J]",
        "(m_1*V1_f^2+m_2*V2_f^2+I_1*omega1_f^2+I_2*omega2_f^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost",
        "[ft·lb|J]",
        "E_crush",
        "balance",
        "The closing speed was found from it. Ei − Ef is the same, but loses digits where little is lost; a check "
        "compares them.",
        number_format="#,##0",
    ),
)

_CHECKS = (
    check(
        "check_reach",
        "The closing speed can carry the momentum across",
        "reach>=0",
        "physics",
        "FALSE: too little energy for so much momentum across the approach. Look at EES and the departure angles.",
    ),
    check(
        "check_balance",
        "Energy lost is the energy that crush took",
        "ABS(E_before-E_after-E_crush)<=0.000000001*E_before",
        "energy",
        "FALSE: a formula was typed over, or the check above fails.",
    ),
    check(
        "check_forward",
        "«1» moves forward along its approach",
        "V1_i>0",
        "physics",
        "FALSE: a negative impact speed. The approach and departure angles contradict each other.",
    ),
    check(
        "check_crush",
        "Crush took energy, and inertia is positive",
        "AND(EES_1>=0,EES_2>=0,E_crush>0,I_1>0,I_2>0,R_1>0,R_2>0)",
        "physics",
        "FALSE: an energy equivalent speed below 0, or none at all.",
    ),
    check(
        "check_spin",
        "Frictions against rotating are those of tyres",
        "AND(MIN(mu_1,mu_2)>=0,MAX(mu_1,mu_2)<=1.2)",
        "published values",
        "FALSE: more than road tyres give. A percentage entered as a number?",
    ),
    FRICTION,
    RUN_OUT_CHECK,
)

_WHEN = GuideSection(
    "When to use this model",
    (
        "Two vehicles whose approaches are near-parallel, head-on or from behind, where momentum alone says little: "
        "an angle uncertain by 3° can make a speed uncertain by hundreds of [mph|km/h]. The energy that crush took "
        "gives the closing speed at any angle; momentum gives only its direction.",
        "Where a speed after the impact is known rather than the travel to rest, enter it on sheet Run-out.",
        "The approach angle of the other vehicle is an answer. Compare it with its lane: sheet Evidence has a row.",
        "The reverse: where the closing momentum m2·c is hardly more than the momentum across (the quantity prest = "
        "m2·c − |p⊥| on sheet Model, near 0), energy says little, and momentum is better. Fill in both templates: "
        "xlmc compare runs them and says which tells more, by their standard deviations, and whether they agree.",
        "Where both approach angles are known, the scene is overdetermined: enter the second as evidence, and the "
        "trials that agree with both remain.",
        "A blow from behind: PDOF jumps between 180 and −180. Enter its direction on sheet Evidence, with Use FALSE if "
        "it is not to be evidence; PDOF is then counted to within 180° of that.",
        "Crush energy has a scatter of its own; ranges of EES must hold it. Use each fact once: a crush profile used "
        "here may not come back as a filter.",
    ),
)

_CENTRES = tuple(turned(("0", "0"), f"alpha_{j}", f"-0.5*length_{j}", "0") for j in (1, 2))

TEMPLATE = Template(
    title="Momentum and crush energy of two vehicles",
    subtitle="Closing speed c from energy; direction from momentum (Zeidler and others, SAE 850256)",
    rung=13,
    question="How fast, where approaches are near-parallel?",
    needs="weights, departures, run-out, crush energy, rotation",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=drawing_inputs(),
    sections=leave_together(
        (
            Section("1  Masses, run-out and rotation", for_both(MASSES + segmented_run_out() + _ROTATIONS)),
            Section("2  Closing speed, from energy", _ENERGY),
            Section("3  Impact speeds, from momentum", _SPEEDS),
            Section("4  Change in velocity", _CHANGES),
            Section(
                "5  Answers (the forecasts)", for_both(tuple(replace(each, reference="above") for each in ANSWERS))
            ),
            Section("6  Direction of force, energy", for_both(_FORCE + _BALANCE)),
            direction_section(7),
            before_section(8),
            checks_section(9, *_CHECKS),
        )
    ),
    forecasts=(
        *paper_forecasts(),
        ForecastRow(f"{vehicle(2)} approach angle", "alpha_2", "deg"),
        *direction_forecasts(yaw=False, near=True),
        *run_out_forecasts(),
    ),
    filters=(
        FilterRow("Closing momentum", "reach", "The closing speed can carry the momentum across", at_least=0),
        FilterRow(f"{vehicle(1)} impact speed", "V1_[mph|kmh]", "It was moving forward", above=0),
    ),
    evidence=(
        EvidenceRow(
            "Direction of the lane of «2»",
            "alpha_2",
            None,
            "Uniform",
            {},
            "Enter the direction of approach, counted as the lane on sheet Inputs, and how far it may turn within it",
        ),
        EvidenceRow(
            "«1» delta-V in its EDR, along",
            "dV1_long",
            None,
            "Instrument",
            {"Percent": 10, "Resolution": Both(0.62, 1)},
            "49 CFR 563.8: within 10 %, in steps of 1 km/h. Slowed: negative",
        ),
        *(direction_reading(j) for j in (1, 2)),
        EvidenceRow(
            "Speed of «1» from an EDR or a video",
            "V1_[mph|kmh]",
            None,
            "Normal",
            {},
            "A reading of its own: middle and standard deviation of edr-speed or video-speed, if they share "
            "no input with this workbook",
        ),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(CorrelationRow("f_1", "f_2", 0),),
    correlation_note=shared_road_note(),
    guide=(
        GuideSection(
            "This workbook",
            (
                "A template. The numbers in it are an example, close to a head-on case of Schreier and Nelson: replace "
                "every green cell, every range, every source.",
            ),
        ),
        FIRST_STEPS,
        READINGS,
        RUN_OUT_GUIDE,
        NAMES,
        _WHEN,
        CAVEATS,
    ),
    diagram=drawn_together(
        Diagram(
            "Plan view of the base case",
            "X, [ft|m]",
            "Y, [ft|m]",
            (
                *vehicle_curves(_CENTRES, "travel"),
                rest_points(_CENTRES, "travel"),
                mark("Point of impact", ("0", "0")),
            ),
            plan=True,
            remark="Drawn from the cells below, the vehicles nose to nose: this model needs no contact point.",
        )
    ),
    vehicles=_SCENE.vehicles,
    waiting=run_out_inputs(),
    waiting_note=RUN_OUT_NOTE,
)
