"""Two vehicles meet in the plane at given speeds: what the impact does to them (SAE 2001-01-3347, forward)."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import (
    CorrelationRow,
    Diagram,
    Equation,
    EvidenceRow,
    FilterRow,
    ForecastRow,
    Input,
    Look,
    Role,
    Section,
    Template,
)
from templates.editions import Both
from templates.other_readings import cut_off_delta_v, recorded_delta_v
from templates.plan_view import line, mark
from templates.planar_forward.equations import model_sections
from templates.planar_forward.guide import GUIDE
from templates.restitution import restitution_input
from templates.two_vehicles.answers import APPROACH, DELTA_V_ANSWER, FORCE, ROTATION
from templates.two_vehicles.checks import CLOSING, ENERGY, FRICTION
from templates.two_vehicles.drawing import rest_points, vehicle_curves
from templates.two_vehicles.options import drawing_inputs, duration_inputs, duration_section
from templates.two_vehicles.results import shared_road_note
from templates.two_vehicles.scene import Scene, assumptions_of_planar_forward, constants_of_momentum, yaw_rates
from templates.units import MPH
from templates.vehicles import for_both, vehicle

__all__ = ["describe"]

_SPEEDS = ((Both(31, 50), Both(33, 53), Both(35, 56)), (Both(3, 5), Both(5, 8), Both(7, 11)))
_CENTRES = (("a_1", "b_1"), ("a_2", "b_2"))


def _speeds() -> tuple[Input, ...]:
    return tuple(
        Input(
            f"V{j}_before",
            f"V{j} ([mph|km/h])",
            f"{vehicle(j)} impact speed",
            "[mph|km/h]",
            base,
            "Example. Enter: event data recorder, video, skid before the impact; or the speed in question",
            {"Low": low, "High": high},
            number_format="0.0",
        )
        for j, (low, base, high) in enumerate(_SPEEDS, 1)
    )


_CLOSURES = (
    restitution_input("e_n", "Restitution, normal"),
    Input(
        "e_t",
        "e_t",
        "Restitution, tangential (closure 1)",
        "",
        0.1,
        "Example: a common velocity, as in the case study of SAE 2001-01-3347; below 0 where the contact slid on",
        {"Low": 0, "High": 0.25},
        number_format="0.00",
    ),
    Input(
        "mu",
        "μ",
        "Impulse ratio, at most (closure 2)",
        "",
        0.55,
        "Example, held: set Frozen to FALSE with closure 2. Friction and engagement of the contact surfaces; SAE "
        "2019-01-0422 takes 0.82 for a corner into a barrier. Enter: what the damage shows",
        {"Low": 0.4, "High": 0.7},
        number_format="0.00",
        frozen=True,
    ),
)

_CLOSURE = Input(
    "closure",
    "",
    "Closure: 1 = e_n and e_t, 2 = e_n and impulse ratio",
    "",
    1,
    "1: equations (9) and (10) of the paper. 2: equation (26); sliding ends where friction suffices to end it",
    choices=(1, 2),
)

_FOUND = "COUNT(rest_beta_1,rest_s_1,rest_beta_2,rest_s_2)"
"""Readings of sheet Evidence that say how the vehicles went to rest."""

_SEARCHED = (
    Equation(
        "V{j}_fits_[mph|kmh]",
        "V{j}fit ([mph|km/h])",
        "{who} impact speed that fits",
        "[mph|km/h]",
        f'IF({_FOUND}>0,V{{j}}_before,"–")',
        "input",
        "<The trials that sheet Evidence keeps tell the speed that leads to rest where it was found. A dash without.|>",
        Role.ANSWER,
        "0.00",
    ),
    Equation(
        "alpha_fits_{j}",
        "α{j}fit",
        "{who} approach angle that fits",
        "deg",
        f'IF({_FOUND}>0,alpha_{{j}},"–")',
        "input",
        "",
        Role.ANSWER,
        "0.0",
    ),
)

_FURTHER = (
    Equation(
        "V{j}f_[mph|kmh]",
        "V{j}f ([mph|km/h])",
        "{who} speed after",
        "[mph|km/h]",
        f"V{{j}}_f*{MPH}",
        "conversion",
        "",
        Role.ANSWER,
        "0.00",
    ),
)

_CHECKS = (
    ENERGY,
    CLOSING,
    check(
        "check_restitution",
        "e_n lies between −1 and 1 and e_t does not exceed 1",
        "AND(e_n>=-1,e_n<1,ABS(e_t)<=1)",
        "eqs (9), (10)",
        "FALSE: no impact behaves so; 1 or more along the normal adds energy.",
    ),
    check(
        "check_ratio",
        "The impulse ratio lies between 0 and 2",
        "AND(mu>=0,mu<=2)",
        "eq (26)",
        "FALSE: the model finds the direction of sliding, so enter the size only. A percentage entered as a number?",
    ),
    check(
        "check_push",
        "The vehicles push, not pull",
        "P_n*side<0",
        "physics",
        "FALSE: the normal impulse would pull the vehicles together. Look at γ and the impact centre.",
    ),
    check(
        "check_forward",
        "No impact speed is negative",
        "AND(V1_before>=0,V2_before>=0)",
        "convention",
        "FALSE: turn the approach angle by 180° for a vehicle that moved backward.",
    ),
    FRICTION,
)


def describe(scene: Scene) -> Template:
    """The workbook of one scene."""
    given = assumptions_of_planar_forward(scene, _speeds())
    return Template(
        title=scene.title,
        subtitle=scene.subtitle,
        vehicles=scene.vehicles,
        rung=6,
        question="What do given impact speeds do: delta-V, spin, where to?",
        needs="impact speeds, headings, restitution, inertias, impact centre",
        assumptions=(*given, *_CLOSURES),
        constants=(_CLOSURE, *yaw_rates(), *constants_of_momentum(inches=True)),
        optional=(*duration_inputs(), *drawing_inputs()),
        sections=(
            *model_sections(),
            Section("5  Answers (the forecasts)", for_both((DELTA_V_ANSWER, *_FURTHER, *_SEARCHED))),
            Section("6  Direction of force, yaw, energy", for_both(FORCE + ROTATION + APPROACH)),
            duration_section(7),
            checks_section(8, *_CHECKS),
        ),
        forecasts=_forecasts(),
        filters=(
            FilterRow("Energy lost", "E_lost", "An impact takes energy away; it cannot add any", at_least=0),
            FilterRow("Normal closing speed", "approach_[mph|kmh]", "The contact points must meet", above=0),
        ),
        evidence=_evidence(),
        settings=(("Trials", 200_000), ("Seed", 999)),
        correlations=(CorrelationRow("f_1", "f_2", 0),),
        correlation_note=shared_road_note(),
        guide=(scene.guide, *GUIDE),
        diagram=_diagram(),
    )


def _evidence() -> tuple[EvidenceRow, ...]:
    """Where the vehicles came to rest, and what recorders kept: speeds and angles are then searched for."""
    rows: list[EvidenceRow] = []
    for j in (1, 2):
        who = vehicle(j)
        rows += [
            EvidenceRow(
                f"{who} departure angle as surveyed",
                f"beta_{j}",
                None,
                "Uniform",
                {},
                "The line from the impact toward rest, and how far it may be off; within the turn that the model gives",
                named=f"rest_beta_{j}",
            ),
            EvidenceRow(
                f"{who} travel to rest as surveyed",
                f"s_{j}",
                None,
                "Uniform",
                {},
                "The distance surveyed, and how far it may be off",
                named=f"rest_s_{j}",
            ),
            recorded_delta_v(f"{who} delta-V", f"dV{j}_[mph|kmh]"),
            cut_off_delta_v(f"{who} delta-V", f"dV{j}_[mph|kmh]"),
        ]
    return tuple(rows)


def _forecasts() -> tuple[ForecastRow, ...]:
    patterns = (
        ("impact speed that fits", "V{j}_fits_[mph|kmh]", "[mph|km/h]"),
        ("delta-V", "dV{j}_[mph|kmh]", "[mph|km/h]"),
        ("speed after", "V{j}f_[mph|kmh]", "[mph|km/h]"),
        ("departure angle", "beta_{j}", "deg"),
        ("travel to rest", "s_{j}", "[ft|m]"),
        ("change in yaw rate", "d_omega{j}_deg", "deg/s"),
        ("PDOF, counter-clockwise", "PDOF_{j}", "deg"),
    )
    of_vehicles = (
        ForecastRow(f"{vehicle(j)} {name}", symbol.format(j=j), unit) for name, symbol, unit in patterns for j in (1, 2)
    )
    return (*of_vehicles, ForecastRow("Energy lost", "E_lost", "[ft·lb|J]", stated="diagnostic"))


def _diagram() -> Diagram:
    return Diagram(
        "Plan view of the base case",
        "X, [ft|m]",
        "Y, [ft|m]",
        (
            *vehicle_curves(_CENTRES),
            line("Contact direction γ", Look.LINE, "gamma_t", "0.4*length_1"),
            rest_points(_CENTRES),
            mark("Impact centre", ("0", "0")),
        ),
        plan=True,
        remark="Drawn from the cells below, about the impact centre. Departure and rest are the model's answers.",
    )
