"""A bumper runs into another at low speed: both delta-V, with brakes on, duration and mean acceleration.

With the shares q1 = m2/(m1 + m2), q2 = m1/(m1 + m2) and the drag of braked wheels during the contact, the contact
impulse and the tyres' impulses give ΔV2 = q2·(1 + e)·Vc − (q2·f1 + q1·f2)·g·Δt, and ΔV1 the rest of (1 + e)·Vc. A force
in proportion to the deflection takes the time (π/2)·X/Vc to the greatest deflection X and e times that back; a constant
force 2·X/Vc and e times that: Δt = κ·(1 + e)·X/Vc, with κ from π/2 to 2.
"""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    Equation,
    EvidenceRow,
    FilterRow,
    ForecastRow,
    GuideSection,
    Input,
    Role,
    Section,
    Template,
)
from templates.editions import Both
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import cut_off_delta_v, recorded_delta_v, seen_speed
from templates.restitution import RESTITUTION
from templates.restitution_curve import curve_diagram, curve_evidence, curve_inputs, curve_section
from templates.speed_answer import speed_answer
from templates.units import CONVERSIONS, GRAVITY, INCHES_PER_FOOT, MPH
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
    _mass(1, Both(3400, 1540), Both(3500, 1590), Both(3600, 1640)),
    _mass(2, Both(2930, 1330), Both(3000, 1360), Both(3070, 1390)),
    Input(
        "e",
        "e",
        "Restitution",
        "",
        0.3,
        "0.2 to 0.4 at a delta-V of [2 to 5 mph|3 to 8 km/h] (SAE 931842); the tail ends at the 0.75 of bumper tests "
        "by King, Siegmund and Bailey (as cited in SAE 2001-01-3347). Enter: tests of these bumpers",
        {"Low": 0.2, "Low likeliest": 0.2, "High likeliest": 0.4, "High": 0.75},
        "Trapezoid",
        "0.00",
    ),
    Input(
        "V1_before",
        "V1i,given",
        "«1» speed before (used where known = 1)",
        _SPEED,
        Both(8, 13),
        "Example. Enter: event data recorder, video",
        {"Low": Both(7, 11), "High": Both(9, 15)},
        number_format="0.0",
    ),
    Input(
        "V2_before",
        "V2i,given",
        "«2» speed before, in the direction of «1»",
        _SPEED,
        0,
        "Example, held at 0: it stood. Forward positive",
        {"Low": 0, "High": Both(3, 5)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "dV2_given",
        "ΔV2,given",
        "«2» delta-V (used where known = 2)",
        _SPEED,
        Both(5, 8),
        "Example, held. Enter: its event data recorder, if the pulse was whole; set Frozen to FALSE",
        {"Low": Both(4.5, 7.2), "High": Both(5.5, 8.8)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "d_after",
        "d2",
        "«2» way to rest after the impact (used where known = 3)",
        "[ft|m]",
        Both(4, 1.2),
        "Example, held. Enter: surveyed; set Frozen to FALSE",
        {"Low": Both(3, 0.9), "High": Both(5, 1.5)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "f_after",
        "f2,after",
        "«2» drag on that way",
        "g",
        0.35,
        "Example, held. Enter: friction of the road times the share of braked wheels; set Frozen to FALSE",
        {"Low": 0.1, "High": 0.6},
        number_format="0.00",
        frozen=True,
    ),
    Input(
        "f_1",
        "f1",
        "«1» drag of its braked wheels during the impact",
        "g",
        0,
        "Example, held at 0: it did not brake. Enter: friction times the share of braked wheels",
        {"Low": 0, "High": 0.7},
        number_format="0.00",
        frozen=True,
    ),
    Input(
        "f_2",
        "f2",
        "«2» drag of its braked wheels during the impact",
        "g",
        0.3,
        "Example: not known whether a foot was on the brake. 0: free to roll. All wheels locked: friction of the road",
        {"Low": 0, "High": 0.6},
        number_format="0.00",
    ),
    Input(
        "X",
        "X",
        "Greatest deflection of both bumpers together",
        "[in|m]",
        Both(4, 0.10),
        "Example. Enter: strokes of the isolators, or crush of both with what sprang back; from tests of these bumpers",
        {"Low": Both(2.5, 0.06), "High": Both(5.5, 0.14)},
        number_format="[0.0|0.000]",
    ),
    Input(
        "kappa",
        "κ",
        "Shape of the force: time to the greatest deflection, in units of X/Vc",
        "",
        1.8,
        "Mechanics: π/2 = 1.571 where the force grows in proportion to the deflection, 2 where it is constant",
        {"Low": 1.571, "High": 2},
        number_format="0.000",
    ),
)

_CONSTANTS = (
    Input(
        "known",
        "",
        "Known: 1 = «1» speed before, 2 = «2» delta-V, 3 = «2» way to rest",
        "",
        1,
        "Which of the rows above is the known one",
        number_format="0",
        choices=(1, 2, 3),
    ),
    GRAVITY,
    INCHES_PER_FOOT,
    *CONVERSIONS,
)

_OPTIONAL = (
    Input(
        "t_impact",
        "Δtgiven",
        "Impact duration, typed in",
        "s",
        None,
        "Optional. Takes the place of that from the deflection. From a recorder, or from tests of these bumpers",
        number_format="0.000",
    ),
    *(
        Input(
            f"v_bumper_{j}",
            f"vb{j}",
            f"{vehicle(j)} bumper: barrier speed that it takes without damage",
            _SPEED,
            None,
            "Optional. From tests of this bumper. 49 CFR 581.5 asks for [2.5 mph|4.0 km/h] of cars sold in the USA "
            "(it is a least one)"
            if j == 1
            else "Optional. The same",
            number_format="0.0",
        )
        for j in (1, 2)
    ),
)

_STEPS = (
    Equation("[m_1|]", "m1", "«1» mass", "lb·s²/ft", "w_1/g", "weight / g"),
    Equation("[m_2|]", "m2", "«2» mass", "lb·s²/ft", "w_2/g", "weight / g"),
    Equation("part_1", "q1", "«1» share of (1 + e)·Vc", "", "m_2/(m_1+m_2)", "momentum"),
    Equation("part_2", "q2", "«2» share of (1 + e)·Vc", "", "m_1/(m_1+m_2)", "momentum"),
    Equation("V2_i", "V2i", "«2» speed before", "[ft|m]/s", f"V2_before/({MPH})", "input"),
    Equation(
        "a_tyres",
        "aT",
        "Tyres: what they take from «2»'s change and add to «1»'s, by unit of time",
        "[ft|m]/s²",
        "(part_2*f_1+part_1*f_2)*g",
        "(q2·f1 + q1·f2)·g",
        "A braked «2» is held back, a braked «1» pushes less; both change «1» more.",
    ),
    Equation(
        "travel",
        "κ·X",
        "Deflection times shape",
        "[ft|m]",
        "kappa*X[/in_per_ft|]",
        "definition",
    ),
    Equation(
        "dV2_known",
        "ΔV2,k",
        "«2» change in velocity, where known",
        "[ft|m]/s",
        f"IF(known=2,dV2_given/({MPH}),IF(known=3,SQRT(2*g*f_after*d_after)-V2_i,0))",
        "input; run-out to rest",
    ),
    Equation(
        "V_close",
        "Vc",
        "Closing speed",
        "[ft|m]/s",
        f"IF(known=1,V1_before/({MPH})-V2_i,IF(N(t_impact)>0,(dV2_known+a_tyres*t_impact)/(part_2*(1+e)),"
        "(dV2_known+SQRT(dV2_known^2+4*part_2*(1+e)^2*a_tyres*travel))/(2*part_2*(1+e))))",
        "momentum, restitution, tyres",
        "From «2»'s change: the duration depends on the closing speed in turn, which leaves a quadratic equation.",
    ),
    Equation(
        "t_contact",
        "Δt",
        "Duration of the impact",
        "s",
        "IF(N(t_impact)>0,t_impact,travel*(1+e)/V_close)",
        "κ·(1 + e)·X/Vc, or as typed",
        "To the greatest deflection κ·X/Vc; the rebound takes e times that.",
        number_format="0.0000",
    ),
    Equation(
        "dV_2",
        "ΔV2",
        "«2» change in velocity",
        "[ft|m]/s",
        "MAX(part_2*(1+e)*V_close-a_tyres*t_contact,MIN(-V2_i,0))",
        "q2·(1 + e)·Vc − aT·Δt",
        "Forward. Its brakes hold a standing vehicle, and never push it back.",
    ),
    Equation(
        "dV_1",
        "ΔV1",
        "«1» change in velocity",
        "[ft|m]/s",
        "V_close*(1+e)-dV_2",
        "restitution",
        "Backward. Both together are (1 + e)·Vc, whatever the brakes do.",
    ),
    Equation("V1_i", "V1i", "«1» speed before", "[ft|m]/s", "V2_i+V_close", "definition"),
    Equation("V1_f", "V1f", "«1» speed after", "[ft|m]/s", "V1_i-dV_1", "definition"),
    Equation("V2_f", "V2f", "«2» speed after", "[ft|m]/s", "V2_i+dV_2", "definition"),
)

_ANSWERS = (
    speed_answer("V1", "V1i", "«1» impact speed", "V1_i"),
    speed_answer("closing", "Vc", "Closing speed", "V_close"),
    speed_answer("dV1", "ΔV1", "«1» delta-V", "dV_1"),
    speed_answer("dV2", "ΔV2", "«2» delta-V", "dV_2"),
    speed_answer("V1f", "V1f", "«1» speed after", "V1_f"),
    speed_answer("V2f", "V2f", "«2» speed after", "V2_f"),
    *(
        Equation(
            f"a_mean_{j}",
            f"a{j}",
            f"{vehicle(j)} mean acceleration",
            "g",
            f"dV_{j}/t_contact/g",
            "ΔV/(g·Δt)",
            "Of the vehicle, not of its occupants; the peak is higher. It says nothing of injury." if j == 1 else "",
            Role.ANSWER,
            "0.00",
        )
        for j in (1, 2)
    ),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost in the bumpers",
        "[ft·lb|J]",
        "m_1*m_2/(m_1+m_2)*V_close^2*(1-e^2)/2",
        "m̄·Vc²·(1 − e²)/2",
        "",
        Role.ANSWER,
        "#,##0",
    ),
)

_LIMITS = (
    Equation(
        "V_limit_[mph|kmh]",
        "Vlim",
        "Closing speed that takes both bumpers to their limits",
        _SPEED,
        'IF(COUNT(v_bumper_1,v_bumper_2)=2,SQRT((m_1*v_bumper_1^2+m_2*v_bumper_2^2)*(m_1+m_2)/(m_1*m_2)),"–")',
        "½·m̄·V² = ½·m1·vb1² + ½·m2·vb2²",
        "Above it at least one must show damage. Below it one may: the softer one takes more than its part.",
        number_format="0.00",
    ),
    Equation(
        "beyond",
        "Vc − Vlim",
        "Closing speed, less that limit",
        _SPEED,
        f'IF(COUNT(v_bumper_1,v_bumper_2)=2,V_close*{MPH}-V_limit_[mph|kmh],"–")',
        "definition",
        "Sheet Evidence has a row for it: at most 0 where neither bumper was damaged.",
        number_format="0.00",
    ),
)

_CHECKS = checks_section(
    5,
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
        "check_friction",
        "Drags are those of road tyres, up to 1.2",
        "AND(MIN(f_1,f_2)>=0,f_after>0,MAX(f_1,f_2,f_after)<=1.2)",
        "published values",
        "FALSE: below 0, or more than road tyres give. A percentage entered as a number?",
    ),
    check(
        "check_bumpers",
        "The bumpers gave in; the shape of the force lies between π/2 and 2",
        "AND(X>0,kappa>=1.57,kappa<=2,d_after>=0)",
        "geometry; mechanics",
        "FALSE: no deflection, or a shape that neither a spring nor a constant force has.",
    ),
    check(
        "check_low",
        "It is an impact at low speed: closing speed up to [20 mph|32 km/h]",
        "closing_[mph|kmh]<=[20|32]",
        "validity",
        "FALSE: restitution and deflection of bumpers do not hold there. Use collinear, or crush-energy.",
    ),
    check(
        "check_way",
        "A braked «2» stood or moved in the direction of «1»",
        "OR(f_2=0,V2_before>=0)",
        "validity",
        "FALSE: of a vehicle that came the other way the tyres pull in both directions in turn. Set its drag to 0.",
    ),
    check(
        "check_forward",
        "A braked «1» is not thrown back",
        "OR(f_1=0,V1_f>=0)",
        "physics",
        "FALSE: its tyres would then push forward. Set its drag to 0, or halve it.",
    ),
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "A vehicle ran into the rear, or the front, of another in line, at a speed at which bumpers still work. It "
            "answers the speed of «1», both delta-V, the duration and the mean accelerations of the vehicles. Positive "
            "is the direction of «1».",
            "It needs the masses, the restitution and one of three: the speed of «1», the delta-V of «2», or how far "
            "«2» went after the impact.",
            "Restitution decides: both delta-V together are (1 + e) times the closing speed, and delta-V from a "
            "closing speed is in proportion to 1 + e. It is higher than at speed, and tests scatter widely. If both "
            "delta-V were recorded, enter them as evidence: then the restitution follows.",
            "Brakes: a struck vehicle on its brake is held back by its tyres while the impact lasts, one that rolls "
            "free is not. Where nobody knows, let the drag range from 0 to the friction of the road. The longer "
            "the impact, the more it matters: of like cars, 0.7 g on «2» take [0.8 mph|1.2 km/h] from its delta-V in "
            "0.1 s, and add as much to that of «1».",
            "Duration: from the deflection of both bumpers and the shape of their force, between that of a spring and "
            "a constant one. For like cars, a spring and no brakes, the mean acceleration is Vc²/(π·X), whatever the "
            "restitution. A duration typed in takes its place.",
            "No claim about injury is made or implied: delta-V and mean acceleration are those of the vehicle. What "
            "an occupant felt depends on seat, posture and person, which no quantity here describes.",
            "Not for impacts off centre or at an angle, overrides and underrides, nor for speeds at which the "
            "structure behind the bumpers folds. Next: collinear, crush-energy.",
        ),
    ),
    GuideSection(
        "Limits of bumpers",
        (
            "Two undamaged bumpers bound the closing speed from above, if it is known what they take: the energy of "
            "compression, half the reduced mass times Vc², cannot exceed what both together take, each half its mass "
            "times the square of its barrier speed. Enter these among the optional inputs and 0 on sheet Evidence.",
            "49 CFR 581.5 asks of passenger cars that they pass a pendulum and a fixed barrier at [2.5 mph|4.0 km/h] "
            "(corners [1.5 mph|2.4 km/h]) within its damage criteria. Many bumpers take more: as a limit from above it "
            "needs a test of this bumper.",
        ),
    ),
    RESTITUTION,
    GuideSection(
        "Published tests at low speed",
        (
            "Restitution against closing speed is drawn on sheet Scene, with the base case in it; its points stand on "
            "sheet Inputs. Type over them where you have tests of like vehicles.",
            "The restitution drawn in a run is wider than that range: its tail goes up to the 0.75 of King, Siegmund "
            "and Bailey, for which no closing speeds could be read. So trials lie above it, unless a row of sheet "
            "Evidence is used. Decide before the run which tests are like this impact.",
        ),
        (
            ("Test", "Values"),
            (
                "SAE 931842: vehicle into the rear of a standing one, delta-V [2 to 5 mph|3 to 8 km/h]",
                "e clustered at 0.2 to 0.4; about 0.1 is given there for medium and high speeds",
            ),
            (
                "King, Siegmund and Bailey, bumpers (as cited in SAE 2001-01-3347)",
                "e 0.25 to 0.75, with noticeable differences between types of bumper",
            ),
            (
                "A Polo into a Fiesta at [5.5 mph|8.9 km/h]",
                "delta-V [3.5 and 3.1 mph|5.6 and 5.0 km/h]: e = 0.2, as both together are (1 + e)·Vc",
            ),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="Bumper impact at low speed",
    subtitle="ΔV2 = q2·(1 + e)·Vc − aT·Δt; Δt = κ·(1 + e)·X/Vc",
    rung=15,
    question="What did a bumper impact do to both vehicles?",
    needs="weights, restitution, one known speed, brakes, deflection",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=(*_OPTIONAL, *curve_inputs()),
    sections=(
        Section("1  Impact with brakes on", _STEPS),
        Section("2  Answers (the forecasts)", _ANSWERS),
        Section("3  Optional: limits of the bumpers", _LIMITS),
        curve_section(4, "e", "closing_[mph|kmh]"),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» impact speed", "V1_[mph|kmh]", _SPEED),
        ForecastRow("Closing speed", "closing_[mph|kmh]", _SPEED),
        ForecastRow("«1» delta-V", "dV1_[mph|kmh]", _SPEED),
        ForecastRow("«2» delta-V", "dV2_[mph|kmh]", _SPEED),
        ForecastRow("«2» speed after", "V2f_[mph|kmh]", _SPEED),
        ForecastRow("Duration of the impact", "t_contact", "s"),
        *(ForecastRow(f"{vehicle(j)} mean acceleration", f"a_mean_{j}", "g") for j in (1, 2)),
        ForecastRow("Energy lost in the bumpers", "E_lost", "[ft·lb|J]"),
    ),
    filters=(FilterRow("Closing speed", "V_close", "One must catch the other to strike it", above=0),),
    evidence=(
        *(recorded_delta_v(f"{vehicle(j)} delta-V", f"dV{j}_[mph|kmh]") for j in (1, 2)),
        *(cut_off_delta_v(f"{vehicle(j)} delta-V", f"dV{j}_[mph|kmh]") for j in (1, 2)),
        seen_speed("«1» impact speed", "V1_[mph|kmh]"),
        EvidenceRow(
            "Neither bumper was damaged",
            "beyond",
            None,
            "At most",
            {},
            "Enter 0, and among the optional inputs what both bumpers take. Std dev: how well that is known",
        ),
        *curve_evidence(),
    ),
    diagram=curve_diagram("e", "closing_[mph|kmh]", low_speeds=True),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(),
    correlation_note="Do the weights share an error? Then correlate them here.",
    guide=_GUIDE,
    vehicles=("Vehicle 1", "Vehicle 2"),
)
