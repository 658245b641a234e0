"""Two vehicles meet in one line: speeds and delta-V from masses, restitution and one known speed."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Equation,
    FilterRow,
    ForecastRow,
    GuideSection,
    Input,
    Role,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import cut_off_delta_v, recorded_delta_v, seen_speed
from templates.restitution import RESTITUTION, restitution_input
from templates.restitution_curve import curve_diagram, curve_evidence, curve_inputs, curve_section
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY, MPH, RADIUS_OF_GYRATION
from templates.vehicles import vehicle

__all__ = ["TEMPLATE"]

_SPEED = "[mph|km/h]"


def _mass(j: int, low: Both, base: Both, high: Both) -> Input:
    return Input(
        f"[w|m]_{j}",
        f"[w|m]{j}",
        f"{vehicle(j)} [weight|mass]",
        "[lb|kg]",
        base,
        "Example. Enter: scale weight or published curb weight, plus occupants and load",
        {"Low": low, "High": high},
        number_format="#,##0",
    )


_ASSUMPTIONS = (
    _mass(1, Both(3900, 1770), Both(4000, 1815), Both(4100, 1860)),
    _mass(2, Both(2930, 1330), Both(3000, 1360), Both(3070, 1390)),
    restitution_input("e", "Restitution"),
    Input(
        "V2_before",
        "V2i,given",
        "«2» speed before, in the direction of «1»",
        _SPEED,
        0,
        "Example, held at 0: it stood. Negative where it came the other way",
        {"Low": 0, "High": Both(5, 8)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "V2_after",
        "V2f,given",
        "«2» speed after (used where known = 2 or 3)",
        _SPEED,
        Both(20, 32),
        "Example. Enter: from its run-out, by skid",
        {"Low": Both(18, 29), "High": Both(22, 35)},
        number_format="0.0",
    ),
    Input(
        "V1_after",
        "V1f,given",
        "«1» speed after (used where known = 3)",
        _SPEED,
        Both(17, 27),
        "Example, held. Enter: from its run-out, by skid; set Frozen to FALSE",
        {"Low": Both(16, 26), "High": Both(18, 29)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "V1_before",
        "V1i,given",
        "«1» speed before (used where known = 1)",
        _SPEED,
        Both(30, 48),
        "Example, held. Enter: event data recorder, video; set Frozen to FALSE",
        {"Low": Both(28, 45), "High": Both(32, 51)},
        number_format="0.0",
        frozen=True,
    ),
)

_CONSTANTS = (
    Input(
        "known",
        "",
        "Known speed: 1 = «1» before, 2 = «2» after, 3 = both after",
        "",
        2,
        "Which of the rows above are the known ones. 3 needs a restitution well above 0: speeds vary as 1/e",
        choices=(1, 2, 3),
    ),
    GRAVITY,
    *CONVERSIONS,
)

_OPTIONAL = (
    Input(
        "V1_claimed",
        "V1claimed",
        "«1» speed claimed by someone else",
        _SPEED,
        None,
        "Optional. A statement, or another report: is it possible with the speeds of «2» as given?",
    ),
    Input("h_1", "h1", "«1» lever arm of the impulse", "[ft|m]", None, "Optional. From its CG to the line of force"),
    Input("h_2", "h2", "«2» lever arm of the impulse", "[ft|m]", None, "Optional. From its CG to the line of force"),
    Input(
        "k_yaw",
        "k",
        "Radius of gyration in yaw",
        "[ft|m]",
        Both(4.6, 1.4),
        f"{RADIUS_OF_GYRATION}. Used with the lever arms only",
    ),
    Input(
        "t_impact",
        "Δt",
        "Impact duration",
        "s",
        None,
        "Optional, of low speeds above all. Gives mean accelerations. From a recorder, or from tests of these bumpers",
        number_format="0.000",
    ),
    Input(
        "f_braked",
        "fb",
        "«2» drag of its braked wheels during the impact",
        "g",
        None,
        "Optional. Friction times the share of braked wheels, where «2» stood on its brake or slid. Needs Δt",
        number_format="0.00",
    ),
)

_SPEEDS = (
    Equation("[m_1|]", "m1", "«1» mass", "lb·s²/ft", "w_1/g", "weight / g"),
    Equation("[m_2|]", "m2", "«2» mass", "lb·s²/ft", "w_2/g", "weight / g"),
    Equation(
        "V_part",
        "Vpart",
        "Speed at which they part, where both speeds after are known",
        "[ft|m]/s",
        f"IF(known=3,(V2_after-V1_after)/({MPH}),0)",
        "definition",
    ),
    Equation(
        "V2_i",
        "V2i",
        "«2» speed before",
        "[ft|m]/s",
        f"IF(known=3,(m_1*V1_after+m_2*V2_after)/(m_1+m_2)/({MPH})-m_1/(m_1+m_2)*V_part/e,V2_before/({MPH}))",
        "input; momentum, restitution",
        "Where both speeds after are known, they closed in at V_part/e about the common speed.",
    ),
    Equation(
        "V1_i",
        "V1i",
        "«1» speed before",
        "[ft|m]/s",
        f"IF(known=3,V2_i+V_part/e,IF(known=1,V1_before/({MPH}),V2_i+(V2_after/({MPH})-V2_i)*(1+m_2/m_1)/(1+e)))",
        "momentum, restitution",
        "Where «2»'s speed after is known, the impulse is m2·(V2f − V2i), and it is (1 + e) times the plastic one.",
    ),
    Equation("V_close", "Vc", "Closing speed", "[ft|m]/s", "V1_i-V2_i", "definition"),
    Equation(
        "dV_1",
        "ΔV1",
        "«1» change in velocity",
        "[ft|m]/s",
        "V_close*(1+e)/(1+m_1/m_2)",
        "momentum, restitution",
        "Backward; «2»'s is forward.",
    ),
    Equation("dV_2", "ΔV2", "«2» change in velocity", "[ft|m]/s", "V_close*(1+e)/(1+m_2/m_1)", "momentum, restitution"),
    Equation("V_sep", "Vsep", "Separation speed", "[ft|m]/s", "e*V_close", "restitution"),
    Equation("V1_f", "V1f", "«1» speed after", "[ft|m]/s", "V1_i-dV_1", "definition"),
    Equation("V2_f", "V2f", "«2» speed after", "[ft|m]/s", "V2_i+dV_2", "definition"),
)


_ANSWERS = (
    speed_answer("V1", "V1i", "«1» impact speed", "V1_i"),
    speed_answer("dV1", "ΔV1", "«1» delta-V", "dV_1"),
    speed_answer("dV2", "ΔV2", "«2» delta-V", "dV_2"),
    speed_answer("V1f", "V1f", "«1» speed after", "V1_f"),
    speed_answer("V2f", "V2f", "«2» speed after", "V2_f"),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost in the impact",
        "[ft·lb|J]",
        "m_1*m_2/(m_1+m_2)*V_close^2*(1-e^2)/2",
        "definition",
        "",
        Role.ANSWER,
        "#,##0",
    ),
)

_MORE = (
    Equation(
        "closing_[mph|kmh]",
        "Vc ([mph|km/h])",
        "Closing speed",
        _SPEED,
        f"V_close*{MPH}",
        "conversion",
        number_format="0.00",
    ),
    Equation(
        "common_[mph|kmh]",
        "Vcommon ([mph|km/h])",
        "Common speed at the end of compression",
        _SPEED,
        f"(m_1*V1_i+m_2*V2_i)/(m_1+m_2)*{MPH}",
        "momentum",
        number_format="0.00",
    ),
    Equation(
        "eccentricity",
        "x",
        "Share of rotation, Σ w·h²/k²",
        "",
        "(m_2*h_1^2+m_1*h_2^2)/(m_1+m_2)/k_yaw^2",
        "lever arms",
        "0 while the lever arms are blank.",
    ),
    Equation(
        "overstated",
        "",
        "Delta-V from a closing speed is overstated by",
        "%",
        "100*eccentricity/(1+eccentricity)",
        "x/(1 + x)",
        "Equal cars, one struck off centre: about 2 % at 1 ft (0.3 m), 9 % at 2 ft (0.6 m). If that matters, use "
        "planar-impact or planar-forward.",
        number_format="0.0",
    ),
    Equation(
        "e_claimed",
        "eclaimed",
        "Restitution that the claimed speed implies",
        "",
        f'IF(V1_claimed<>0,(V2_f-(V1_claimed/({MPH})-m_2/m_1*(V2_f-V2_i)))/(V1_claimed/({MPH})-V2_i),"–")',
        "momentum",
        "With the speeds of «2» before and after as above. Below 0, «1» would leave through «2».",
        number_format="0.00",
    ),
)

_BRAKED = "COUNT(t_impact,f_braked)=2"


def _where_braked(formula: str) -> str:
    return f'IF({_BRAKED},{formula},"–")'


_LOW_SPEED = (
    Equation(
        "taken",
        "j",
        "Speed that its tyres take from «2» during the impact",
        "[ft|m]/s",
        "N(f_braked)*g*N(t_impact)",
        "fb·g·Δt",
        "0 while sheet Inputs has no duration, or no drag.",
    ),
    Equation(
        "closed_b",
        "Vc,b",
        "Closing speed, «2» braked",
        "[ft|m]/s",
        _where_braked("IF(known=2,V_close+taken*m_2/m_1/(1+e),V_close)"),
        "momentum with the impulse of the tyres",
        "From the speed of «2» after, it was more: its tyres took a part.",
    ),
    Equation(
        "dV_2b",
        "ΔV2,b",
        "«2» change in velocity, braked",
        "[ft|m]/s",
        _where_braked("IF(known=2,V2_f-V2_i,MAX((closed_b*(1+e)+taken)/(1+m_2/m_1)-taken,MIN(-V2_i,0)))"),
        "m̄/m2·((1 + e)·Vc + j) − j",
        "Its brakes hold a standing vehicle, and never push it back.",
    ),
    Equation(
        "dV_1b",
        "ΔV1,b",
        "«1» change in velocity, «2» braked",
        "[ft|m]/s",
        _where_braked("closed_b*(1+e)-dV_2b"),
        "(1 + e)·Vc − ΔV2",
    ),
    *(
        Equation(
            f"{symbol}_[mph|kmh]",
            f"{notation} ([mph|km/h])",
            name,
            _SPEED,
            _where_braked(f"({quantity})*{MPH}"),
            "conversion",
            "",
            Role.ANSWER,
            "0.00",
        )
        for symbol, notation, name, quantity in (
            ("V1b", "V1i,b", "«1» impact speed, «2» braked", "V2_i+closed_b"),
            ("dV1b", "ΔV1,b", "«1» delta-V, «2» braked", "dV_1b"),
            ("dV2b", "ΔV2,b", "«2» delta-V, braked", "dV_2b"),
        )
    ),
    *(
        Equation(
            f"a_mean_{j}",
            f"a{j}",
            f"{vehicle(j)} mean acceleration",
            "g",
            f'IF(N(t_impact)>0,IF({_BRAKED},dV_{j}b,dV_{j})/t_impact/g,"–")',
            "ΔV/(g·Δt)",
            "Of the vehicle, not of its occupants; the peak is higher. It says nothing of injury." if j == 1 else "",
            Role.ANSWER,
            "0.00",
        )
        for j in (1, 2)
    ),
)

_CHECKS = checks_section(
    6,
    check(
        "check_closing",
        "«1» catches «2»",
        "V_close>0",
        "physics",
        "FALSE: they move apart before they touch. Look at the sign of «2»'s speed.",
    ),
    check(
        "check_restitution",
        "Restitution lies between 0 and 1",
        "AND(e>=0,e<1)",
        "physics",
        "FALSE: 1 loses no energy, more adds some; below 0 one vehicle passes through the other.",
    ),
    check(
        "check_order",
        "«1» does not leave through «2»",
        "V_sep>=0",
        "physics",
        "FALSE: after the impact the rear vehicle is the faster one. A sign in the separation speed?",
    ),
    check(
        "check_forward",
        "«1» moves forward",
        "V1_i>0",
        "physics",
        "FALSE: forward is the direction of «1». Exchange the vehicles, or the signs.",
    ),
    check(
        "check_way",
        "A braked «2» stood or moved in the direction of «1»",
        "OR(COUNT(t_impact,f_braked)<2,V2_i>=0)",
        "validity",
        "FALSE: of a vehicle that came the other way the tyres pull in both directions in turn. Clear its drag.",
    ),
    check(
        "check_claim",
        "The claimed speed is possible",
        "IF(V1_claimed<>0,AND(e_claimed>=0,e_claimed<1),TRUE)",
        "physics",
        "FALSE: it would need a restitution that no impact has: energy grows, or the vehicles pass through each other.",
    ),
)

_GUIDE = (
    GuideSection(
        "This workbook",
        (
            "A template. The numbers in it are an example: a car runs into the rear of a standing one. Replace every "
            "green cell, every range, every source.",
        ),
    ),
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "Head-on and front-to-rear impacts whose line of force passes near both centres of gravity, at low angles. "
            "It needs the masses, the restitution and one speed: that of «1» before, or that of «2» after.",
            "Positive is the direction of «1». «2» has a negative speed if it came the other way.",
            "Restitution matters: delta-V is proportional to 1 + e. The range on sheet Inputs is that of impacts at "
            "speed; where delta-V is [2 to 5 mph|3 to 8 km/h], tests had 0.2 to 0.4 (SAE 931842): enter that.",
            "Not for impacts off centre: enter the lever arms on sheet Inputs to see by how much delta-V is "
            "overstated. The next models are momentum and planar-impact (directions and run-out known) and "
            "planar-forward.",
            "Tyre forces: at f = 0.8 they take about 1.8 mph (2.8 km/h) for each 0.1 s of contact, much of a low-speed "
            "delta-V. Where «2» was struck while braked, enter the duration and the drag of its wheels among the "
            "optional inputs: impact speed, both delta-V and mean accelerations follow. Use evidence on the "
            "restitution against closing speed, too: at low speeds it decides. None of this says anything of injury.",
        ),
    ),
    RESTITUTION,
    GuideSection(
        "A published example can be wrong",
        (
            "A problem of Georgia Tech's (Impact, problem 2, aeresources.gatech.edu) lets 1,500 kg run into 2,500 kg "
            "at rest, which leaves at 15 m/s; e = 0.5. It prints 80 m/s for the impact speed. The answer is 26.67 m/s "
            "(96 km/h): the printed one has the separation speed negative. "
            "Entered as the claimed speed, 80 m/s turns its check red: restitution would be −0.5.",
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Collinear impact of two vehicles",
    subtitle="One dimension: momentum, restitution and one known speed",
    rung=3,
    question="How fast was a vehicle that struck another in line? Delta-V?",
    needs="weights, restitution, one known speed",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(*_OPTIONAL, *curve_inputs()),
    sections=(
        Section("1  Speeds and changes in velocity", _SPEEDS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        Section("3  Limits of one dimension, claims", _MORE),
        curve_section(4, "e", "closing_[mph|kmh]"),
        Section("5  Optional: duration, and «2» on its brake", _LOW_SPEED),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» impact speed", "V1_[mph|kmh]", _SPEED),
        ForecastRow("«1» delta-V", "dV1_[mph|kmh]", _SPEED),
        ForecastRow("«2» delta-V", "dV2_[mph|kmh]", _SPEED),
        ForecastRow("«1» speed after", "V1f_[mph|kmh]", _SPEED),
        ForecastRow("«2» speed after", "V2f_[mph|kmh]", _SPEED),
        ForecastRow("Energy lost", "E_lost", "[ft·lb|J]"),
        ForecastRow("«1» impact speed, «2» braked", "V1b_[mph|kmh]", _SPEED),
        ForecastRow("«1» delta-V, «2» braked", "dV1b_[mph|kmh]", _SPEED),
        ForecastRow("«2» delta-V, braked", "dV2b_[mph|kmh]", _SPEED),
        *(ForecastRow(f"{vehicle(j)} mean acceleration", f"a_mean_{j}", "g") for j in (1, 2)),
        ForecastRow("Closing speed", "closing_[mph|kmh]", _SPEED, stated="diagnostic"),
    ),
    filters=(
        FilterRow("Closing speed", "closing_[mph|kmh]", "One must catch the other to strike it", above=0),
        FilterRow("Energy lost", "E_lost", "An impact takes energy away; it cannot add any", at_least=0),
    ),
    evidence=(
        *(recorded_delta_v(f"{vehicle(j)} delta-V", f"dV{j}_[mph|kmh]") for j in (1, 2)),
        *(cut_off_delta_v(f"{vehicle(j)} delta-V", f"dV{j}_[mph|kmh]") for j in (1, 2)),
        seen_speed("«1» impact speed", "V1_[mph|kmh]"),
        *curve_evidence(),
    ),
    diagram=curve_diagram("e", "closing_[mph|kmh]"),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Do the weights share an error? Then correlate them here.",
    guide=_GUIDE,
    vehicles=("Vehicle 1", "Vehicle 2"),
)
