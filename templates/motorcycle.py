"""A motorcycle brakes, slides on its side and strikes a car: momentum, the rider's flight, and the way before.

Momentum with so light a partner multiplies what is not known of the car by the ratio of the masses: the book computes
by how much. Where both directions of approach decide, the equations are (15′) and (16′) of SAE 2001-01-3347; where the
car's speed before is known, momentum along the motorcycle's way is enough, and no angle of crossing is divided by.
"""

from __future__ import annotations

from dataclasses import replace

from templates.checks import check, checks_section
from templates.description import (
    CorrelationRow,
    Curve,
    Diagram,
    Equation,
    EvidenceRow,
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
from templates.guidance import CAVEATS, EXAMPLE_NUMBERS, FIRST_STEPS, NAMES, READINGS
from templates.other_readings import cut_off_delta_v, recorded_delta_v, seen_speed, told_speed
from templates.road_friction import FRICTION, FRICTION_SHAPE, FRICTION_SOURCE
from templates.speed_answer import speed_answer
from templates.thrown_body import ANGLE_CHECK, EFFICIENCY_CHECK, MORE_OF_THROW, ON_THE_WAY, THROWN, projection
from templates.two_vehicles.equations import IMPACT_SPEEDS, MASSES, RUN_OUT
from templates.units import CONVERSIONS, GRAVITY, MPH
from templates.vehicles import for_both, vehicle

__all__ = ["TEMPLATE"]

_SPEED = "[mph|km/h]"
_SLIDING = (
    "Motorcycles on their side at [25 mph|40 km/h]: .45 to .58 (Day and Smith, 1984); with a fairing about .26, "
    "without .33 (Raftery, 1995). Enter: what slid, on what"
)


def _angle(symbol: str, notation: str, name: str, base: float, off: float, source: str) -> Input:
    return Input(
        symbol,
        notation,
        name,
        "deg",
        base,
        source,
        {"Low": base - off, "High": base + off},
        number_format="0.0",
    )


def _after(j: int, way: Both, ends: tuple[Both, Both]) -> Input:
    return Input(
        f"s_{j}",
        f"s{j}",
        f"{vehicle(j)} way to rest after the impact",
        "[ft|m]",
        way,
        "Example. Enter: surveyed",
        {"Low": ends[0], "High": ends[1]},
        number_format="0.0",
    )


_RIDER = {
    "H": replace(
        THROWN[1],
        name="Rider: fall of the centre of gravity, from the seat to where he lay",
        base=Both(2.5, 0.75),
        source="Example, judged. Enter: from the height of the seat and of this rider, and the slope",
        parameters={"Low": Both(2.0, 0.6), "High": Both(3.0, 0.9)},
    ),
    "angle": replace(
        THROWN[2],
        name="Rider: angle of projection above the ground",
        source="Riders leave at 10 to 20° (T. Hutchison, Speed Calculation in a Motorcycle Accident, vceinc.com, "
        "2009); passengers at 18 to 20 and up to 45°",
        parameters={"Low": 10, "High": 20},
    ),
    "efficiency": replace(
        THROWN[3],
        name="Rider: projection speed over «1» speed at the impact",
        source="Example, judged; no published value is quoted here. 1: nothing held him back. Less where tank, bars or "
        "the car did",
    ),
    "mu": replace(THROWN[0], name="Rider: friction on the ground"),
}

_ASSUMPTIONS = (
    Input(
        "f_upright",
        "fu",
        "«1» deceleration upright, before the impact",
        "g",
        0.6,
        "Riders in emergencies: .45 to .75 g (B. Wilson, Forensic Crash Consultancy, on britishsuperbikeschool.com, "
        "2024). One brake alone gives less (sheet Guide)",
        {"Low": 0.45, "High": 0.75},
        number_format="0.000",
    ),
    Input(
        "d_upright",
        "du",
        "«1» skid upright, before it fell",
        "[ft|m]",
        Both(40, 12),
        "Example. Enter: surveyed; 0 where there is none",
        {"Low": Both(37, 11.1), "High": Both(43, 12.9)},
        number_format="0.0",
    ),
    Input(
        "f_slide",
        "fs",
        "«1» friction on its side, before the impact",
        "g",
        0.515,
        _SLIDING,
        {"Low": 0.45, "High": 0.58},
        number_format="0.000",
    ),
    Input(
        "d_slide",
        "ds",
        "«1» slide on its side, before the impact",
        "[ft|m]",
        0,
        "Example, held at 0: it was struck upright. Enter: scrapes surveyed; set Frozen to FALSE",
        {"Low": 0, "High": Both(20, 6)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "v_given",
        "vi,given",
        "«1» speed at the end of its way (used where known = 1)",
        _SPEED,
        0,
        "Example, held at 0: it slid to rest and struck nothing. Enter: from a video, a recorder",
        {"Low": 0, "High": Both(5, 8)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "[w|m]_1",
        "[w|m]1",
        "«1» [weight|mass], of what took part in the impact",
        "[lb|kg]",
        Both(600, 272),
        "Example. Enter: the motorcycle, with load, and with as much of the rider as pushed on it",
        {"Low": Both(520, 236), "High": Both(680, 308)},
        number_format="#,##0",
    ),
    Input(
        "[w|m]_2",
        "[w|m]2",
        "«2» [weight|mass]",
        "[lb|kg]",
        Both(3400, 1542),
        "Example. Enter: scale weight or published curb weight, plus occupants and load",
        {"Low": Both(3300, 1497), "High": Both(3500, 1588)},
        number_format="#,##0",
    ),
    _angle("alpha_1", "α1", "«1» approach angle", 0, 3, "Example. Enter: its marks, its lane"),
    _angle("alpha_2", "α2", "«2» approach angle", 90, 3, "Example. Enter: its lane, gouges"),
    _angle("beta_1", "β1", "«1» departure angle", 57, 5, "Example. Enter: from the impact to rest"),
    _angle("beta_2", "β2", "«2» departure angle", 69, 2, "Example. Enter: from the impact to rest, of its CG. Decides"),
    _after(1, Both(6, 1.8), (Both(5, 1.5), Both(7, 2.1))),
    Input(
        "f_1",
        "f1",
        "«1» friction on its side, after the impact",
        "g",
        0.515,
        _SLIDING,
        {"Low": 0.45, "High": 0.58},
        number_format="0.000",
    ),
    _after(2, Both(11, 3.3), (Both(10, 3.0), Both(12, 3.6))),
    Input(
        "f_2",
        "f2",
        "«2» deceleration after the impact",
        "g",
        FRICTION,
        f"{FRICTION_SOURCE}. Less where it did not brake with all wheels",
        FRICTION_SHAPE,
        "Trapezoid",
        "0.000",
    ),
    Input(
        "V2_before",
        "V2i,given",
        "«2» speed before (used where it is known)",
        _SPEED,
        Both(15, 24),
        "Example, held. Enter: its event data recorder, a video; 0 where it stood. Set Frozen to FALSE",
        {"Low": Both(13, 21), "High": Both(17, 27)},
        number_format="0.0",
        frozen=True,
    ),
    Input(
        "s",
        "s",
        "Rider: throw distance along the ground, from the impact to rest",
        "[ft|m]",
        Both(64, 19.5),
        "Example. Enter: surveyed; 0 where the car stopped him, or it is not known",
        {"Low": Both(60, 18.3), "High": Both(68, 20.7)},
        number_format="0.0",
    ),
    *(_RIDER[symbol] for symbol in ("mu", "H", "angle", "efficiency")),
    Input(
        "z_fit",
        "zfit",
        "Regression: how far this case is off it, in residual standard deviations",
        "",
        0,
        "Held until a regression is entered below. Residuals of a fit are taken as normal",
        {"Mean": 0, "Std dev": 1},
        "Normal",
        "0.00",
        frozen="=COUNT(fit_0,fit_w,fit_sd,dL)<4",
    ),
)

_CONSTANTS = (
    Input(
        "known",
        "",
        "Impact speed taken from: 1 = typed in, 2 = momentum, 3 = rider's flight, 4 = regression",
        "",
        2,
        "Choose the best one. The others stand beside it as evidence (sheet Evidence)",
        number_format="0",
        choices=(1, 2, 3, 4),
    ),
    Input(
        "car_known",
        "",
        "Momentum: is the speed of «2» before the impact known? 1 = no, 2 = yes",
        "",
        1,
        "1: both directions of approach decide; they must cross. 2: momentum along the way of «1» decides",
        number_format="0",
        choices=(1, 2),
    ),
    GRAVITY,
    *CONVERSIONS,
)

_ASKED = (
    (
        "fit_0",
        "k0",
        "constant",
        _SPEED,
        "Optional, of a paper whose tests are like this case. No regression is filled in: none could be read. Name the "
        "paper, its tests and its table",
    ),
    ("fit_w", "kL", "by wheelbase lost", "[mph/in|(km/h)/cm]", "Optional. The same paper"),
    ("fit_c", "kC", "by crush of «2»", "[mph/in|(km/h)/cm]", "Optional. The same paper. Blank: 0"),
    (
        "fit_sd",
        "σfit",
        "residual standard deviation",
        _SPEED,
        "Optional, and needed: without its scatter a regression says nothing of one case",
    ),
)

_OPTIONAL = (
    replace(
        MORE_OF_THROW[0],
        name="Grade of the road along the way of «1»",
        source="Optional. Uphill positive, before the impact and along the throw; run-outs are taken as level",
    ),
    replace(
        MORE_OF_THROW[1],
        name="Rider: way on the motorcycle or the car, from the impact to the projection",
    ),
    Input("dL", "ΔL", "«1» wheelbase lost", "[in|cm]", None, "Optional. Measured, of a wheelbase published"),
    Input("crush", "C", "«2» greatest crush where it was struck", "[in|cm]", None, "Optional. Measured"),
    *(
        Input(symbol, notation, f"Regression v = k0 + kL·ΔL + kC·C: {name}", unit, None, source)
        for symbol, notation, name, unit, source in _ASKED
    ),
)

_MOMENTUM = (
    *for_both(MASSES),
    *for_both(RUN_OUT),
    Equation("ratio", "m2/m1", "Ratio of the masses", "", "m_2/m_1", "definition", number_format="0.00"),
    *for_both(
        replace(each, name=f"{each.name}, by both directions") if each.symbol == "V{j}_i" else each
        for each in IMPACT_SPEEDS
    ),
    Equation(
        "V2_b", "V2b", "«2» speed before", "[ft|m]/s", f"IF(car_known=2,V2_before/({MPH}),V2_i)", "input, or eq (16′)"
    ),
    Equation(
        "V1_along",
        "V1,al",
        "«1» impact speed, by momentum along its way",
        "[ft|m]/s",
        f"V1_f*COS(RADIANS(beta_1-alpha_1))+ratio*(V2_f*COS(RADIANS(beta_2-alpha_1))-V2_before/({MPH})"
        "*COS(RADIANS(alpha_2-alpha_1)))",
        "eqs (1), (2) along α1",
        "With the speed of «2» as typed in. No division by the sine of a crossing: approaches may be parallel.",
    ),
    Equation(
        "v_momentum",
        "vm",
        "Impact speed, from momentum",
        "[ft|m]/s",
        "IF(car_known=2,V1_along,V1_i)",
        "eq (15′), or along α1",
    ),
    Equation(
        "across",
        "vac",
        "Momentum left over across its way, as a speed of «1»",
        _SPEED,
        f"IF(car_known=2,(V1_f*SIN(RADIANS(beta_1-alpha_1))+ratio*(V2_f*SIN(RADIANS(beta_2-alpha_1))-V2_before/({MPH})"
        f'*SIN(RADIANS(alpha_2-alpha_1))))*{MPH},"–")',
        "eqs (1), (2) across α1",
        "0 where all that was entered agrees; a row of sheet Evidence. A dash where the speed of «2» is not known.",
        number_format="0.00",
    ),
    Equation(
        "per_degree",
        "c1",
        "A degree of «2» departure angle moves that speed by",
        "%",
        "100*ABS(RADIANS(1)*ratio*V2_f*IF(car_known=2,SIN(RADIANS(beta_2-alpha_1)),COS(RADIANS(beta_2-alpha_2))"
        "/sin_delta)/v_momentum)",
        "derivative by β2",
        "The conditioning of momentum with a light partner: what is not known of the car counts m2/m1 times.",
        number_format="0.0",
    ),
    Equation(
        "per_approach",
        "c2",
        "A degree of «2» approach angle moves that speed by",
        "%",
        "100*ABS(RADIANS(1)*IF(car_known=2,ratio*V2_b*SIN(RADIANS(alpha_2-alpha_1)),(V1_i*COS(RADIANS(delta_alpha))"
        "-V1_f*COS(RADIANS(beta_1-alpha_2))-ratio*V2_f*COS(RADIANS(beta_2-alpha_2)))/sin_delta)/v_momentum)",
        "derivative by α2",
        number_format="0.0",
    ),
    Equation(
        "per_tenth",
        "c3",
        "A tenth of «2» speed after moves that speed by",
        "%",
        "100*ABS(0.1*ratio*V2_f*IF(car_known=2,COS(RADIANS(beta_2-alpha_1)),SIN(RADIANS(beta_2-alpha_2))"
        "/sin_delta)/v_momentum)",
        "derivative by V2f",
        "A fifth of its deceleration is a tenth of its speed.",
        number_format="0.0",
    ),
    Equation(
        "dV_2",
        "ΔV2",
        "«2» change in velocity",
        "[ft|m]/s",
        "SQRT((V2_f*COS(RADIANS(beta_2))-V2_b*COS(RADIANS(alpha_2)))^2"
        "+(V2_f*SIN(RADIANS(beta_2))-V2_b*SIN(RADIANS(alpha_2)))^2)",
        "eqs (19) to (21)",
        "Small: a recorder may not have been woken by it.",
    ),
    Equation(
        "E_gained",
        "Egain",
        "Energy after the impact, less that before",
        "[ft·lb|J]",
        "(m_1*(V1_f^2-v_momentum^2)+m_2*(V2_f^2-V2_b^2))/2",
        "definition",
        "Negative in any impact.",
        number_format="#,##0",
    ),
)

_FLIGHT = (
    *ON_THE_WAY,
    Equation(
        "rider_known",
        "",
        "A throw was measured (1 = yes)",
        "",
        "IF(s>0,1,0)",
        "input",
        "A blank length gives no speed.",
        number_format="0",
    ),
    *projection("v_projected", "vp", "Projection speed of the rider", where="rider_known=1"),
    Equation("v_rider", "vr", "Impact speed, from the rider's flight", "[ft|m]/s", "v_projected/efficiency", "vp / η"),
)

_BEFORE = (
    Equation(
        "v_i",
        "vi",
        "Impact speed",
        "[ft|m]/s",
        f"IF(known=1,v_given/({MPH}),IF(known=2,v_momentum,IF(known=3,v_rider,N(v_fit_[mph|kmh])/({MPH}))))",
        "input",
    ),
    *(
        Equation(
            f"drag_{symbol}",
            f"a{letter}",
            f"«1» deceleration {where}, along the road",
            "g",
            f"(f_{symbol}+slope)/SQRT(1+slope^2)",
            "f·cos θ ± sin θ, with G = tan θ",
        )
        for symbol, letter, where in (("upright", "u", "upright"), ("slide", "s", "on its side"))
    ),
    Equation(
        "v_fall", "vf", "Speed when it fell", "[ft|m]/s", "SQRT(v_i^2+2*g*drag_slide*d_slide)", "√(vi² + 2·g·as·ds)"
    ),
    Equation(
        "v_0",
        "v0",
        "Speed before braking",
        "[ft|m]/s",
        "SQRT(v_fall^2+2*g*drag_upright*d_upright)",
        "√(vf² + 2·g·au·du)",
    ),
    Equation(
        "t_before",
        "tb",
        "Time from the first mark to the impact",
        "s",
        "IF(d_upright>0,2*d_upright/(v_0+v_fall),0)+IF(d_slide>0,2*d_slide/(v_fall+v_i),0)",
        "2·d over the sum of both speeds",
        "Time-distance takes it from there: a driver saw the motorcycle for that time and longer.",
        number_format="0.00",
    ),
)

_REGRESSION = Equation(
    "v_fit_[mph|kmh]",
    f"vfit ({_SPEED})",
    "Impact speed, by the regression entered",
    _SPEED,
    'IF(COUNT(fit_0,fit_w,fit_sd,dL)=4,fit_0+fit_w*dL+N(fit_c)*N(crush)+z_fit*fit_sd,"–")',
    "k0 + kL·ΔL + kC·C + z·σ",
    "A dash: none is entered.",
    Role.ANSWER,
    "0.00",
)

_ANSWERS = (
    speed_answer("vi", "vi", "Impact speed", "v_i"),
    speed_answer("vm", "vm", "Impact speed, from momentum", "v_momentum"),
    speed_answer("vr", "vr", "Impact speed, from the rider's flight", "v_rider"),
    speed_answer("vfall", "vf", "Speed when it fell", "v_fall"),
    speed_answer("v0", "v0", "Speed before braking", "v_0"),
    speed_answer("V2", "V2b", "«2» speed before", "V2_b"),
    speed_answer("dV2", "ΔV2", "«2» delta-V", "dV_2"),
    Equation(
        "apart",
        f"vr − vm ({_SPEED})",
        "Impact speed from the flight, less that from momentum",
        _SPEED,
        f"(v_rider-v_momentum)*{MPH}",
        "definition",
        "Two answers to one question: near 0 where both are right.",
        Role.ANSWER,
        "0.00",
    ),
)

_CHECKS = checks_section(
    6,
    check(
        "check_lengths",
        "No length is negative",
        "AND(MIN(d_upright,d_slide,s_1,s_2,s,H)>=0,N(carried)>=0,v_given>=0)",
        "geometry",
        "FALSE: a length below 0.",
    ),
    check(
        "check_friction",
        "Decelerations are those of tyres and of metal on a road, up to 1.2",
        "AND(MIN(f_upright,f_slide,f_1,f_2)>0,MAX(f_upright,f_slide,f_1,f_2)<=1.2)",
        "published values",
        "FALSE: more than a road gives. A percentage entered as a number?",
    ),
    check(
        "check_body",
        "Friction of the rider is up to 1.2",
        "AND(mu>0,mu<=1.2)",
        "plausibility",
        "FALSE: more than a body on the ground can have. A percentage entered as a number?",
    ),
    ANGLE_CHECK,
    EFFICIENCY_CHECK,
    check(
        "check_known",
        "What the impact speed is taken from was entered",
        "IF(known=3,rider_known=1,IF(known=4,ISNUMBER(v_fit_[mph|kmh]),TRUE))",
        "input",
        "FALSE: what is chosen was not entered, so that there is no impact speed. Choose another, or enter it.",
    ),
    check(
        "check_crossing",
        "Momentum: approaches cross by 10° or more, where both directions decide",
        "OR(known<>2,car_known=2,ABS(sin_delta)>=0.1736)",
        "conditioning",
        "FALSE: nearly parallel, momentum by directions says nothing. Enter the speed of «2», or take the flight.",
    ),
    check(
        "check_conditioning",
        "Momentum: a degree of «2» angles moves the speed by 10 % or less, a tenth of its speed after by 25 % or less",
        "IF(known=2,AND(MAX(per_degree,per_approach)<=10,per_tenth<=25),TRUE)",
        "conditioning",
        "FALSE: so light a partner hardly turned the car. Do not quote momentum; take the flight, or a regression.",
    ),
    check(
        "check_forward",
        "Momentum: «1» moved forward",
        "IF(known=2,v_momentum>0,TRUE)",
        "physics",
        "FALSE: its speed comes out negative. Angles are where a vehicle moves to, from +X.",
    ),
    check(
        "check_energy",
        "Momentum: the impact took energy away",
        "IF(known=2,E_gained<=0,TRUE)",
        "physics",
        "FALSE: more energy after than before. Look at directions and run-outs.",
    ),
)

_SHARES = tuple(f"{step}/8" for step in range(9))


def _upright(share: str) -> tuple[str, str]:
    """Distance to the impact, and the speed there, after a share of the skid upright."""
    return (
        f"-d_slide-(1-{share})*d_upright",
        f"SQRT(v_fall^2+2*g*drag_upright*(1-{share})*d_upright)*{MPH}",
    )


def _sliding(share: str) -> tuple[str, str]:
    return f"-(1-{share})*d_slide", f"SQRT(v_i^2+2*g*drag_slide*(1-{share})*d_slide)*{MPH}"


_DIAGRAM = Diagram(
    "Speed of the motorcycle on its way to the impact, base case",
    "Distance before the impact, [ft|m]",
    f"Speed, {_SPEED}",
    (
        Curve("Upright", Look.FIRST, tuple(map(_upright, _SHARES))),
        Curve("On its side", Look.SECOND, tuple(map(_sliding, _SHARES))),
        Curve("Impact", Look.POINT, (("0", f"v_i*{MPH}"),)),
    ),
    remark="Drawn from the cells below.",
)

_GUIDE = (
    EXAMPLE_NUMBERS,
    FIRST_STEPS,
    READINGS,
    NAMES,
    GuideSection(
        "When to use this model",
        (
            "A motorcycle skidded upright, perhaps fell and slid on its side, and struck a car. The impact speed comes "
            "from momentum, from the rider's flight, or from a regression; the skid and the slide before it add to "
            "that: v² + 2·g·Σ a·d. Without an impact, choose 1 and leave its speed 0.",
            "The way of a motorcycle that slid on to rest after the impact is its run-out; it does not count twice.",
            "Not for a motorcycle that was itself run over, that struck with its side, or whose impact spun the car: "
            "momentum of points, as here, has no rotation in it. For those: planar-impact, with its inertias.",
        ),
    ),
    GuideSection(
        "Momentum with a light partner",
        (
            "The motorcycle's momentum is what is missing in that of the car, and the car has five or six times the "
            "mass: any error of the car's speed or direction is multiplied by m2/m1. Section 1 of sheet Model says by "
            "how many per cent a degree of the car's angles moves the answer, and a tenth of its speed after. A check "
            "is red above 10 % for a degree or 25 % for that tenth: then momentum is no basis for an opinion.",
            "McNally and Bartlett (Motorcycle Speed Estimates Using Conservation of Linear and Rotational Momentum, "
            "IPTM, 2002) ask for such an analysis wherever the weights differ greatly, as it decides whether the "
            "method is to be used at all.",
            "Where both directions decide, approaches must cross; near 90° is best. Head-on and rear-end, the sine of "
            "their angle is 0: the speed of the car must be known (its recorder, or that it stood). Momentum along the "
            "motorcycle's way then needs no crossing, and what is left over across it is a check on everything "
            "entered: sheet Evidence.",
            "Which mass took part? A rider who flew off over the car left his momentum with himself: enter the "
            "motorcycle alone, or let the range hold both.",
        ),
    ),
    GuideSection(
        "The rider's flight",
        (
            "A rider who leaves over the bars is a projectile, lands and slides: v = √(2 μ g (s − μ H))/(cos θ + "
            "μ sin θ), with one μ for landing and slide, as a pedestrian's. Where he stopped against the car, or was "
            "caught by it, his flight says nothing: leave the distance 0.",
            "Flight and momentum answer one question twice. Sheet Evidence has a row in which their difference must be "
            "0, within an error that you decide on before you look.",
        ),
    ),
    GuideSection(
        "Regressions",
        (
            "Wheelbase lost and crush of the car against impact speed: several are published, and none could be read "
            "for this template, so that its rows are blank. Enter one, in the units of the rows, with its residual "
            "standard deviation, from a paper whose motorcycles (forks, wheels) and struck parts are like these. O. "
            "Masory, W. Bartlett and B. Wright compared such formulas with crash tests (Motorcycle Accident "
            "Reconstruction, Part I: Physical Models) and found that they cannot give the speed with high accuracy.",
            "How wide their scatter is can be read: four equations fitted to 99 tests, by what was struck, left a "
            "standard deviation of [5.8 mph|9.3 km/h] (L. Peck and others, SAE Int. J. Transportation Safety 7(1), "
            "2019, abstract). Its constants are not in the abstract.",
        ),
    ),
    GuideSection(
        "Decelerations: published values",
        ("Test a like motorcycle on the scene where you can.",),
        (
            ("What", "Deceleration or friction (g)"),
            ("Riders in emergencies (B. Wilson, 2024)", ".45 to .75"),
            (
                "Riders of all kinds, dry, from [37 mph|60 km/h] (Ecker and others, 2001)",
                "half used at most 56 % of the possible deceleration",
            ),
            ("On its side, [25 mph|40 km/h] (Day and Smith, 1984)", ".45 to .58"),
            ("On its side, with a fairing (Raftery, 1995)", "about .26; without .33"),
            ("Share of the front brake", "about 70 % of the braking power (motorcycleinvestigation.com)"),
        ),
    ),
    CAVEATS,
)

TEMPLATE = Template(
    title="A motorcycle strikes a car",
    subtitle="Skid and slide: v0 = √(vi² + 2 g Σ a d); vi from momentum, the rider's flight, or a regression",
    rung=16,
    question="How fast was a motorcycle that struck a car?",
    needs="skid and slide, directions and run-out, or the rider's throw",
    assumptions=_ASSUMPTIONS,
    constants=_CONSTANTS,
    optional=_OPTIONAL,
    sections=(
        Section("1  Momentum", _MOMENTUM),
        Section("2  The rider's flight", _FLIGHT),
        Section("3  Optional: a regression", (_REGRESSION,)),
        Section("4  The way before the impact", _BEFORE),
        Section("5  Answers (the forecasts)", _ANSWERS),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow("«1» impact speed", "vi_[mph|kmh]", _SPEED),
        ForecastRow("«1» impact speed, from momentum", "vm_[mph|kmh]", _SPEED),
        ForecastRow("«1» impact speed, from the rider's flight", "vr_[mph|kmh]", _SPEED),
        ForecastRow("«1» impact speed, by the regression entered", "v_fit_[mph|kmh]", _SPEED),
        ForecastRow("«1» speed when it fell", "vfall_[mph|kmh]", _SPEED),
        ForecastRow("«1» speed before braking", "v0_[mph|kmh]", _SPEED),
        ForecastRow("«2» speed before", "V2_[mph|kmh]", _SPEED),
        ForecastRow("«2» delta-V", "dV2_[mph|kmh]", _SPEED),
        ForecastRow("Time from the first mark to the impact", "t_before", "s"),
        ForecastRow("A degree of «2» departure angle moves momentum by", "per_degree", "%", stated="diagnostic"),
    ),
    filters=(
        FilterRow("Impact speed", "v_i", "It moved forward, or had come to rest", at_least=0),
        FilterRow(
            "Throw measured (1 = yes)",
            "rider_known",
            "A blank length gives no answer",
            above=0.5,
            only_for="«1» impact speed, from the rider's flight",
        ),
    ),
    evidence=(
        EvidenceRow(
            "Flight and momentum agree",
            "apart",
            None,
            "Normal",
            {},
            "Enter 0, and a standard deviation for what neither model has in it",
        ),
        EvidenceRow(
            "Momentum across the way of «1» is nil",
            "across",
            None,
            "Normal",
            {},
            "Enter 0, and a standard deviation for what points without tyres leave out. Needs the speed of «2»",
        ),
        seen_speed("«1» impact speed", "vi_[mph|kmh]"),
        seen_speed("«1» speed before braking", "v0_[mph|kmh]"),
        told_speed("«1» speed before braking", "v0_[mph|kmh]"),
        seen_speed("«2» speed before", "V2_[mph|kmh]"),
        recorded_delta_v("«2» delta-V", "dV2_[mph|kmh]"),
        cut_off_delta_v("«2» delta-V", "dV2_[mph|kmh]"),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(CorrelationRow("f_slide", "f_1", 0.9),),
    correlation_note="One motorcycle slid on one road before and after the impact: its frictions go together.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Motorcycle 1", "Car 2"),
)
