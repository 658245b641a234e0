"""Speed change from the energy that crushed two vehicles, by crush profile and stiffness."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    CorrelationRow,
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
from templates.guidance import CAVEATS, FIRST_STEPS, READINGS, SIGNS
from templates.other_readings import cut_off_delta_v, recorded_delta_v, seen_speed
from templates.plan_view import mark
from templates.restitution import RESTITUTION, restitution_input
from templates.speed_answer import speed_answer
from templates.stiffness_tests import STIFFNESS_TESTS
from templates.units import CONVERSIONS, GRAVITY, MPH, RADIUS_OF_GYRATION
from templates.vehicles import FIRST, SECOND, for_both, vehicle

__all__ = ["TEMPLATE"]

_STATIONS = range(1, 7)
_TEST = "Example. Enter: published crash test of this model, this end of it"

# Symbol, notation, name, unit, (low, base, high) of vehicle 1 and of vehicle 2, source, number format.
_UNCERTAIN = (
    (
        "b0",
        "b0",
        "no-damage speed b0",
        "[mph|km/h]",
        (Both((4, 5, 6), (6.5, 8, 9.5)), Both((2, 3, 4), (3.2, 4.8, 6.4))),
        f"{_TEST}: the speed that leaves no residual crush",
        "0.00",
    ),
    (
        "b1",
        "b1",
        "slope of speed over crush b1",
        "[mph/in|(km/h)/cm]",
        (Both((1.35, 1.5, 1.65), (0.86, 0.95, 1.04)), Both((1.5, 1.7, 1.9), (0.95, 1.08, 1.21))),
        f"{_TEST}: (test speed − b0) / mean residual crush",
        "0.000",
    ),
    (
        "bias",
        "c",
        "reading error of all crush stations",
        "[in|cm]",
        (Both((-0.5, 0, 0.5), (-1.3, 0, 1.3)), Both((-0.5, 0, 0.5), (-1.3, 0, 1.3))),
        "Example. Where the undamaged contour was: shifts the whole profile",
        "0.00",
    ),
    (
        "L",
        "L",
        "width of the crush",
        "[in|cm]",
        (Both((58, 60, 62), (147, 152, 157)), Both((56, 60, 64), (142, 152, 162))),
        "Example. Enter: measured width of direct and induced damage; 0 for a fixed barrier",
        "0.0",
    ),
    (
        "theta",
        "θ",
        "force, off the perpendicular",
        "deg",
        ((0, 5, 10), (0, 5, 10)),
        "Example. From the principal direction of force; the correction grows as tan²θ",
        "0.0",
    ),
    (
        "h",
        "h",
        "lever arm of the force",
        "[ft|m]",
        (Both((0, 0.5, 1), (0, 0.15, 0.3)), Both((0, 1, 2), (0, 0.3, 0.6))),
        "Example. From the CG to the line of the force",
        "0.00",
    ),
    (
        "[w|m]",
        "[w|m]",
        "[weight|mass]",
        "[lb|kg]",
        (Both((3400, 3500, 3600), (1540, 1590, 1640)), Both((2900, 3000, 3100), (1315, 1360, 1405))),
        "Example. Enter: scale weight or published curb weight, plus occupants and load",
        "#,##0",
    ),
)


_REPLACED = {"b0": "=lined_{j}=1", "b1": "=tests_{j}>0"}
"""What sheet Stiffness gives in place of an assumption, and when."""


def _third(values: tuple[float, float, float] | Both, place: int) -> float | Both:
    if isinstance(values, Both):
        return Both(values.imperial[place], values.si[place])
    return values[place]


def _assumptions() -> tuple[Input, ...]:
    of_vehicles = (
        Input(
            f"{symbol}_{j}",
            f"{notation},{j}" if notation in ("b0", "b1") else f"{notation}{j}",
            f"{vehicle(j)} {name}",
            unit,
            _third(values[j - 1], 1),
            source,
            {"Low": _third(values[j - 1], 0), "High": _third(values[j - 1], 2)},
            number_format=number_format,
            frozen=_REPLACED[symbol].format(j=j) if symbol in _REPLACED else False,
        )
        for j in (1, 2)
        for symbol, notation, name, unit, values, source, number_format in _UNCERTAIN
    )
    return (*of_vehicles, *(_station(j, i) for j in (1, 2) for i in _STATIONS), restitution_input("e", "Restitution"))


_PROFILES = (
    (Both((18, 17, 16, 15, 14, 12), (46, 43, 41, 38, 36, 30)), "front, example"),
    (Both((8, 12, 16, 18, 17, 12), (20, 30, 41, 46, 43, 30)), "side, example"),
)


_READ = Both(0.5, 1.3)
"""How far a depth may be misread, either way, at one station alone."""


def _station(j: int, i: int) -> Input:
    profile, what = _PROFILES[j - 1]
    depth = Both(profile.imperial[i - 1], profile.si[i - 1])
    return Input(
        f"c_{j}_{i}",
        f"C{j},{i}",
        f"{vehicle(j)} crush at station {i}",
        "[in|cm]",
        depth,
        f"Residual crush, stations evenly spaced over the width ({what}). The range: how far this reading alone is off",
        {
            "Low": Both(depth.imperial - _READ.imperial, round(depth.si - _READ.si, 6)),
            "High": Both(depth.imperial + _READ.imperial, round(depth.si + _READ.si, 6)),
        },
        number_format="0.0",
    )


_BASIS = Input(
    "basis",
    "",
    "Stiffness is made of: 1 = speeds of the tests, 2 = energy that the tests lost",
    "",
    1,
    "1: b1 = (speed of the test − b0)/crush, as published b0, b1, A and B are; the energy is then that absorbed up to "
    "the greatest crush. 2: coefficients fitted to energy lost, rebound taken off",
    choices=(1, 2),
)


def _constants() -> tuple[Input, ...]:
    of_vehicles: list[Input] = []
    for j in (1, 2):
        of_vehicles += (
            Input(
                f"[w|m]_test_{j}",
                f"[w|m]test,{j}",
                f"{vehicle(j)} [weight|mass] in the crash test",
                "[lb|kg]",
                Both(3700, 1680) if j == 1 else Both(3200, 1450),
                _TEST,
                number_format="#,##0",
            ),
            Input(
                f"L_test_{j}",
                f"Ltest,{j}",
                f"{vehicle(j)} width of the crush in the crash test",
                "[in|cm]",
                Both(62, 157),
                _TEST,
                number_format="0.0",
            ),
            Input(
                f"k_{j}",
                f"k{j}",
                f"{vehicle(j)} radius of gyration in yaw",
                "[ft|m]",
                Both(4.6, 1.4),
                RADIUS_OF_GYRATION,
                number_format="0.00",
            ),
        )
    length = Input(
        "[in_per_ft|cm_per_m]",
        "[12|100]",
        "[Inches in a foot|Centimetres in a metre]",
        "[in/ft|cm/m]",
        Both(12, 100),
        "Definition",
    )
    return (_BASIS, *of_vehicles, GRAVITY, length, *CONVERSIONS)


_OPTIONAL = tuple(
    Input(
        f"{letter}_given_{j}",
        f"{letter}{j} given",
        f"{vehicle(j)} stiffness {letter}, where it is published",
        unit,
        None,
        "Optional. Both A and B replace b0 and b1; a pair taken from tables has no known scatter",
    )
    for j in (1, 2)
    for letter, unit in (("A", "[lb/in|N/cm]"), ("B", "[lb/in²|N/cm²]"))
)

_LEVER = tuple(
    Input(f"{symbol}_{j}", f"{notation}{j}", f"{vehicle(j)} {name}", "[in|cm]", None, source)
    for j in (1, 2)
    for symbol, notation, name, source in (
        (
            "face",
            "xf",
            "distance of the undamaged struck face from the CG",
            "Optional. With it the lever arm follows from C1 to C6 and the direction of the force, in each trial",
        ),
        (
            "aside",
            "yf",
            "middle of the crush width, beside the CG, toward station 6",
            "Optional, with the row above. Blank: opposite the CG",
        ),
    )
)

_LINES = tuple(
    Input(
        f"line_{j}",
        "",
        f"{vehicle(j)} b0 and b1 from a straight line through the tests of sheet Stiffness: 1 = yes",
        "",
        None,
        "Optional. For three tests or more at different speeds; blank: b0 is that of the assumptions, in each trial",
        choices=(1,),
    )
    for j in (1, 2)
)

_LENGTH = "[in_per_ft|cm_per_m]"

_STIFFNESS = (
    Equation("[m_{j}|]", "m{j}", "{who} mass", "lb·s²/ft", "w_{j}/g", "weight / g"),
    Equation(
        "[w|m]_used_{j}",
        "[w|m]used,{j}",
        "{who} [weight|mass] of the tests that is used",
        "[lb|kg]",
        "IF(tests_{j}>0,[w|m]_tests_{j},[w|m]_test_{j})",
        "sheet Stiffness, or Inputs",
        number_format="#,##0",
    ),
    Equation("[m_used_{j}|]", "mused,{j}", "{who} mass of the tests", "lb·s²/ft", "w_used_{j}/g", "weight / g"),
    Equation(
        "L_used_{j}",
        "Lused,{j}",
        "{who} width of their crush that is used",
        "[in|cm]",
        "IF(tests_{j}>0,L_tests_{j},L_test_{j})",
        "sheet Stiffness, or Inputs",
        number_format="0.0",
    ),
    Equation(
        "b1_used_{j}",
        "b1,used,{j}",
        "{who} slope b1 that is used",
        "[mph/in|(km/h)/cm]",
        "IF(tests_{j}=0,b1_{j},IF(lined_{j}=1,pass_{j}_5+line_sd_{j}/SQRT(Sxx_{j})*scatter_slope_{j},"
        "b1_tests_{j}+b1_sd_{j}*SQRT(1+1/MAX(tests_{j},1))*scatter_{j}))",
        "mean ± s·√(1 + 1/n)·t",
        "<The next vehicle of a kind differs from the mean of n tests by their scatter s and the error of that mean; "
        "from few tests in Student's t.|>",
        number_format="0.0000",
    ),
    Equation(
        "b0_used_{j}",
        "b0,used,{j}",
        "{who} no-damage speed b0 that is used",
        "[mph|km/h]",
        "IF(lined_{j}=1,level_{j}+line_sd_{j}*SQRT(1+1/MAX(tests_{j},1))*scatter_{j}-b1_used_{j}*x_tests_{j},b0_{j})",
        "input, or of the line",
        "<Of the line: its speed at the mean crush less b1 times that, so that a high b1 goes with a low b0.|>",
        number_format="0.000",
    ),
    Equation(
        "A_{j}",
        "A{j}",
        "{who} force at which crush begins, per width",
        "[lb/in|N/cm]",
        f"IF(B_given_{{j}}>0,A_given_{{j}},{_LENGTH}*m_used_{{j}}*(b0_used_{{j}}/({MPH}))*(b1_used_{{j}}/({MPH}))"
        "/L_used_{j})",
        "A = m b0 b1 / L",
        "<A and B come from one test and go together: b0 and b1 are drawn, not A and B.|>",
        number_format="0.00",
    ),
    Equation(
        "B_{j}",
        "B{j}",
        "{who} stiffness, per width",
        "[lb/in²|N/cm²]",
        f"IF(B_given_{{j}}>0,B_given_{{j}},{_LENGTH}*m_used_{{j}}*(b1_used_{{j}}/({MPH}))^2/L_used_{{j}})",
        "B = m b1² / L",
        number_format="0.00",
    ),
    Equation(
        "G_{j}",
        "G{j}",
        "{who} energy per width before crush begins",
        "[lb|N]",
        "A_{j}^2/(2*B_{j})",
        "G = A²/(2B)",
        number_format="#,##0.0",
    ),
    Equation(
        "least_stiff",
        "Bleast",
        "Stiffness of the softer vehicle, negative where a force is",
        "[lb/in²|N/cm²]",
        "IF(MIN(A_1,A_2,b1_used_1,b1_used_2)>=0,MIN(B_1,B_2),-1)",
        "above",
        "Few tests scatter so widely that some draws are no stiffness.",
        number_format="0.00",
    ),
)


def _force(i: int) -> Equation:
    return Equation(
        f"F_{{j}}_{i}",
        f"F{{j}},{i}",
        f"{{who}} force per width at station {i}",
        "[lb/in|N/cm]",
        f"A_{{j}}+B_{{j}}*MAX(c_{{j}}_{i}+bias_{{j}},0)",
        "A + B·C",
        number_format="#,##0.0",
    )


_PAIRS = tuple((i, i + 1) for i in _STATIONS if i + 1 in _STATIONS)
_ENERGY = (
    *(_force(i) for i in _STATIONS),
    Equation(
        "E_plain_{j}",
        "E{j}0",
        "{who} energy by its stiffness, force perpendicular",
        "[ft·lb|J]",
        "L_{j}/(6*5*B_{j})*("
        + "+".join(f"F_{{j}}_{a}^2+F_{{j}}_{a}*F_{{j}}_{b}+F_{{j}}_{b}^2" for a, b in _PAIRS)
        + f")/{_LENGTH}",
        "∫(A + B·C)²/(2B) dL, crush linear between the stations",
        "<Exact for a profile of straight pieces. The shortcut by mean crush is too low: 10 % for 0 to 24 inches.|>",
        number_format="#,##0",
    ),
    Equation(
        "E_{j}",
        "E{j}",
        "{who} energy absorbed up to its greatest crush",
        "[ft·lb|J]",
        "E_plain_{j}*(1+TAN(RADIANS(theta_{j}))^2)/IF(basis=1,1,1-e^2)",
        "oblique force",
        "<1 + tan²θ: an oblique force crushes along its own line. Energy lost is 1 − e² of the energy absorbed.|>",
        number_format="#,##0",
    ),
    Equation(
        "force_{j}",
        "F{j}",
        "{who} force at full crush",
        "[lb|N]",
        "L_{j}/(2*5)*(" + "+".join(f"F_{{j}}_{a}+F_{{j}}_{b}" for a, b in _PAIRS) + ")/COS(RADIANS(theta_{j}))",
        "∫(A + B·C) dL / cos θ",
        number_format="#,##0",
    ),
)


def _depth(i: int) -> str:
    return f"MAX(c_{{j}}_{i}+bias_{{j}},0)"


_PANELS = tuple((_depth(a), _depth(b), a) for a, b in _PAIRS)

_CENTROID = (
    Equation(
        "area_{j}",
        "Ac{j}",
        "{who} area of the crush",
        "[in²|cm²]",
        "L_{j}/5*(" + "+".join(f"({a}+{b})/2" for a, b, _ in _PANELS) + ")",
        "∫ C dL",
        number_format="#,##0.0",
    ),
    Equation(
        "along_{j}",
        "yc{j}",
        "{who} centroid of the crush, from the middle toward station 6",
        "[in|cm]",
        "IF(area_{j}>0,(L_{j}/5)^2*("
        + "+".join(f"({i - 3.5:g})*({a}+{b})/2+({a}+2*{b})/6" for a, b, i in _PANELS)
        + ")/area_{j},0)",
        "∫ y C dL / ∫ C dL",
        "<Straight between the stations.|>",
        number_format="0.00",
    ),
    Equation(
        "inward_{j}",
        "xc{j}",
        "{who} centroid of the crush, below the undamaged face",
        "[in|cm]",
        "IF(area_{j}>0,L_{j}/5*(" + "+".join(f"({a}^2+{a}*{b}+{b}^2)/6" for a, b, _ in _PANELS) + ")/area_{j},0)",
        "½ ∫ C² dL / ∫ C dL",
        number_format="0.00",
    ),
    Equation(
        "arm_{j}",
        "hc{j}",
        "{who} lever arm of a force through that centroid",
        "[ft|m]",
        f"IF(ISNUMBER(face_{{j}}),ABS((face_{{j}}-inward_{{j}})*SIN(RADIANS(theta_{{j}}))+(N(aside_{{j}})+along_{{j}})"
        f'*COS(RADIANS(theta_{{j}})))/{_LENGTH},"–")',
        "|x sin θ + y cos θ|",
        "<Takes the place of the lever arm among the assumptions once the distance of the face from the CG is entered. "
        "θ counts toward station 6.|>",
        number_format="0.000",
    ),
)

_IMPACT = (
    *_CENTROID,
    Equation(
        "h_used_{j}",
        "hu{j}",
        "{who} lever arm that is used",
        "[ft|m]",
        "IF(ISNUMBER(face_{j}),arm_{j},h_{j})",
        "input, or from the profile",
        number_format="0.000",
    ),
    Equation(
        "m_eff_{j}",
        "m{j}′",
        "{who} effective mass at the line of force",
        "[lb·s²/ft|kg]",
        "m_{j}*k_{j}^2/(k_{j}^2+h_used_{j}^2)",
        "m k²/(k² + h²)",
        "<Off centre, part of the closing speed turns the vehicle instead of stopping it.|>",
        number_format="#,##0.00",
    ),
    Equation(
        "m_both",
        "m̄",
        "Effective mass of both",
        "[lb·s²/ft|kg]",
        "m_eff_1*m_eff_2/(m_eff_1+m_eff_2)",
        "1/(1/m1′ + 1/m2′)",
        number_format="#,##0.00",
    ),
    Equation(
        "E_sum",
        "E",
        "Energy absorbed up to the greatest crush, both vehicles",
        "[ft·lb|J]",
        "E_1+E_2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "V_close",
        "Vc",
        "Closing speed along the line of force",
        "[ft|m]/s",
        "SQRT(2*E_sum/m_both)",
        "E = m̄ Vc²/2",
        "At the line of force, not of the centres of gravity. At the greatest crush the closing speed is used up; "
        "restitution comes after it.",
    ),
    Equation(
        "dV_{j}",
        "ΔV{j}",
        "{who} change in velocity",
        "[ft|m]/s",
        "(1+e)*SQRT(2*m_both*E_sum)/m_{j}",
        "(1 + e) m̄ Vc/m",
    ),
)

_ANSWERS = (
    speed_answer("dV{j}", "ΔV{j}", "{who} delta-V", "dV_{j}"),
    speed_answer("closing", "Vc", "Closing speed along the line of force", "V_close"),
    Equation(
        "EBS{j}_[mph|kmh]",
        "EBS{j}",
        "{who} equivalent barrier speed",
        "[mph|km/h]",
        f"SQRT(2*E_{{j}}/m_{{j}})*{MPH}",
        "E = m·EBS²/2",
        "<The speed whose energy, in the vehicle's own mass, crushes it so: energy absorbed. It is no delta-V.|>",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "EES{j}_[mph|kmh]",
        "EES{j}",
        "{who} energy equivalent speed",
        "[mph|km/h]",
        "EBS{j}_[mph|kmh]*SQRT(1-e^2)",
        "EBS·√(1 − e²)",
        "<The speed of the energy lost, which momentum-energy takes.|>",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "E_absorbed", "Eabs", "Energy absorbed by the crush", "[ft·lb|J]", "E_sum", "above", "", Role.ANSWER, "#,##0"
    ),
    Equation(
        "E_crush",
        "Elost",
        "Energy lost to the crush",
        "[ft·lb|J]",
        "E_sum*(1-e^2)",
        "E (1 − e²)",
        "The rest rebounds. Sliding and rotation take energy of their own beside it.",
        Role.ANSWER,
        "#,##0",
    ),
    Equation(
        "ratio",
        "F1/F2",
        "Force balance, F1/F2",
        "",
        "IF(MIN(L_1,L_2)>0,force_1/force_2,1)",
        "Newton's third law",
        "The same force crushed both vehicles: 1 within what stiffness data are worth.",
        Role.ANSWER,
        "0.00",
    ),
)

_MORE = (
    Equation(
        "balance_2",
        "C2 balance",
        "Uniform crush of «2» that balances the force on «1»",
        "[in|cm]",
        'IF(L_2>0,(force_1*COS(RADIANS(theta_2))/L_2-A_2)/B_2,"–")',
        "Newton's third law",
        "Compare it with the profile of «2».",
        number_format="0.000",
    ),
    Equation(
        "shortcut_{j}",
        "",
        "{who} energy by mean crush, for comparison",
        "[ft·lb|J]",
        "L_{j}/(2*B_{j})*((" + "+".join(f"F_{{j}}_{a}+F_{{j}}_{b}" for a, b in _PAIRS) + f")/10)^2/{_LENGTH}",
        "L (A + B·C̄)²/(2B)",
        "<Too low wherever the profile is not flat. Not used.|>",
        number_format="#,##0",
    ),
)

_CHECKS = checks_section(
    6,
    check(
        "check_crush",
        "No crush is negative",
        "MIN(" + ",".join(f"c_{j}_{i}" for j in (1, 2) for i in _STATIONS) + ")>=0",
        "geometry",
        "FALSE: crush is measured inward from the undamaged contour.",
    ),
    check(
        "check_stiffness",
        "Both vehicles resist crush",
        "AND(MIN(A_1,A_2)>=0,MIN(B_1,B_2)>0)",
        "physics",
        "FALSE: a stiffness that is not positive. Look at b0, b1 and the optional A and B.",
    ),
    check(
        "check_tests",
        "Tests of sheet Stiffness are complete and leave crush",
        "AND(tests_begun=10*(tests_1+tests_2),tests_low<>-1,OR(N(line_1)<>1,lined_1=1),OR(N(line_2)<>1,lined_2=1))",
        "published tests",
        "FALSE: a row lacks a number or names no vehicle by 1 or 2; a speed is not above b0; or a line needs three "
        "tests whose crush differs.",
    ),
    check(
        "check_restitution",
        "Restitution lies between 0 and 1",
        "AND(e>=0,e<1)",
        "physics",
        "FALSE: 1 loses no energy, more adds some; below 0 a common velocity was never reached, and crush tells less.",
    ),
    check(
        "check_balance",
        "The forces on both vehicles agree within a factor of 1.5",
        "AND(ratio>=1/1.5,ratio<=1.5)",
        "Newton's third law",
        "FALSE: one force cannot crush both vehicles so. Look at profiles, widths and stiffness.",
    ),
    check(
        "check_oblique",
        "No force is more than 45° off the perpendicular",
        "MAX(ABS(theta_1),ABS(theta_2))<=45",
        "validity",
        "FALSE: a sliding contact; the correction 1 + tan²θ is no longer one.",
    ),
)


def _profile(j: int, look: Look) -> Curve:
    points = tuple((f"L_{j}*{i - 1}/5-L_{j}/2", f"MAX(c_{j}_{i}+bias_{j},0)") for i in _STATIONS)
    return Curve(f"{vehicle(j)} crush", look, points)


_DIAGRAM = Diagram(
    "Crush profiles, base case",
    "Along the crush, [in|cm]",
    "Depth, [in|cm]",
    (
        _profile(1, Look.FIRST),
        _profile(2, Look.SECOND),
        mark("Centroids", *((f"along_{j}", f"inward_{j}") for j in (1, 2))),
    ),
    remark="Drawn from the cells below, each profile about the middle of its width.",
)

_GUIDE = (
    GuideSection(
        "This workbook",
        (
            "A template. The numbers in it are an example: the front of one car into the side of another. Replace "
            "every green cell, every range, every source.",
        ),
    ),
    FIRST_STEPS,
    READINGS,
    SIGNS,
    GuideSection(
        "When to use this model",
        (
            "Damage was measured and stiffness data fit the vehicles, but momentum says little: near-parallel "
            "approaches, one vehicle that did not leave the scene, unknown run-out. It answers delta-V, not the "
            "speeds of the vehicles.",
            "Enter residual crush at six stations evenly spaced over the width. For a fixed barrier as the second "
            "vehicle: width 0, a weight of 1,000,000,000.",
            "Stiffness from one test at one speed is a straight line through one point: stay near its crush. A and B "
            "of one test are bound to each other: b0 and b1 are drawn and both computed from them. Published A and B "
            "may be entered under Optional; they are then single values without a distribution, which is worth saying.",
            "Crash tests. Sheet Stiffness takes tests of the vehicle's model, a row each with [weight|mass], speed, C1 "
            "to C6 and width, as crash-test databases list them. One test with b0 of the assumptions gives b1 in each "
            "trial, so that the test's own speed comes back whatever b0 is. From two on b1 scatters as the sister "
            "tests do, in Student's t: two tests are hardly a scatter, and the ranges say so. Three or more at "
            "different speeds may give b0 and b1 by least squares; with three the scatter has one degree of freedom "
            "and no variance, so prefer more. The tests replace b1, [weight|mass] and width of the test on sheet "
            "Inputs. The last two columns beside the tests show what speed the stiffness in use returns for each.",
            "Absorbed and lost. b0 and b1 come from the speed with which the tests struck, so that the energy computed "
            "from them is absorbed up to the greatest crush: it gives the closing speed whatever the restitution, and "
            "the equivalent barrier speed (EBS). Rebound gives e² of it back; 1 − e² is lost and gives the energy "
            "equivalent speed (EES). The template returns the test that its stiffness comes from for every e. "
            "Coefficients that were fitted to energy lost are rare: enter 2 for what the stiffness is made of.",
            "What other templates take: momentum-energy the EES; the evidence of planar-impact the energy lost, to "
            "which work of sliding adds.",
            "The next models: momentum and planar-impact, if directions and run-out are known. If both kinds can be "
            "used, use both: two independent answers that agree are worth more than either.",
            "Not for sideswipes, override or underride, nor for crush far beyond the test's.",
        ),
    ),
    GuideSection(
        "Reading the results of this model",
        (
            "The force balance judges the data: the same force crushed both. Trials outside 0.67 to 1.5 are rejected.",
            "Energy rises with the square of the crush, so that the mean crush of an uneven profile underestimates it.",
            "Delta-V is that along the line of force, at the centre of gravity.",
        ),
    ),
    RESTITUTION,
    CAVEATS,
)

TEMPLATE = Template(
    title="Delta-V from crush energy",
    subtitle="Energy of the crush by profile and stiffness; effective masses; restitution",
    rung=7,
    question="What delta-V left this damage, where momentum says little?",
    needs="crush profiles, stiffness, weights, line of the force",
    assumptions=_assumptions(),
    constants=_constants(),
    optional=(*_OPTIONAL, *_LEVER, *_LINES),
    tests=STIFFNESS_TESTS,
    sections=(
        Section("1  Stiffness from a crash test", for_both(_STIFFNESS)),
        Section("2  Crush energy", for_both(_ENERGY)),
        Section("3  Energy to change in velocity", for_both(_IMPACT)),
        Section("4  Answers (the forecasts)", for_both(_ANSWERS)),
        Section("5  For comparison", for_both(_MORE)),
        _CHECKS,
    ),
    forecasts=(
        ForecastRow(f"{FIRST} delta-V", "dV1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{SECOND} delta-V", "dV2_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Closing speed along the force", "closing_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{FIRST} equivalent barrier speed", "EBS1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{SECOND} equivalent barrier speed", "EBS2_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{FIRST} energy equivalent speed", "EES1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{SECOND} energy equivalent speed", "EES2_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Energy absorbed by the crush", "E_absorbed", "[ft·lb|J]", stated="diagnostic"),
        ForecastRow("Energy lost to the crush", "E_crush", "[ft·lb|J]", stated="diagnostic"),
        ForecastRow("Force balance", "ratio", "", stated="diagnostic"),
    ),
    filters=(
        FilterRow(
            "Force balance",
            "ratio",
            "Example. The same force crushed both vehicles; limits as wide as stiffness data are uncertain",
            at_least=0.67,
            at_most=1.5,
        ),
        FilterRow(
            "Least stiffness", "least_stiff", "A vehicle that is crushed resists. Without tests: no effect", above=0
        ),
    ),
    evidence=(
        *(recorded_delta_v(f"{who} delta-V", f"dV{j}_[mph|kmh]") for j, who in ((1, FIRST), (2, SECOND))),
        *(cut_off_delta_v(f"{who} delta-V", f"dV{j}_[mph|kmh]") for j, who in ((1, FIRST), (2, SECOND))),
        seen_speed("Closing speed along the force", "closing_[mph|kmh]"),
    ),
    settings=(("Trials", 200_000), ("Seed", 999)),
    correlations=(CorrelationRow("b0_1", "b1_1", 0), CorrelationRow("b0_2", "b1_2", 0)),
    correlation_note="A higher b0 chosen for the same test means a lower b1: enter a negative correlation. 0 is none.",
    guide=_GUIDE,
    diagram=_DIAGRAM,
    vehicles=("Vehicle 1", "Vehicle 2"),
)
