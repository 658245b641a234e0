"""Two vehicles meet in the plane: speeds and delta-V from directions and run-out alone (SAE 2001-01-3347)."""

from __future__ import annotations

from templates.checks import check, checks_section
from templates.description import CorrelationRow, Diagram, Equation, FilterRow, GuideSection, Section, Template
from templates.guidance import CAVEATS, FIRST_STEPS, NAMES, READINGS
from templates.plan_view import mark, turned
from templates.two_vehicles.answers import ANSWERS, FORCE
from templates.two_vehicles.checks import ANGLES, ENERGY, FORWARD, FRICTION
from templates.two_vehicles.drawing import rest_points, vehicle_curves
from templates.two_vehicles.equations import DELTA_V, IMPACT_SPEEDS, MASSES, RUN_OUT
from templates.two_vehicles.options import (
    drawing_inputs,
    duration_inputs,
    duration_section,
    turn_filters,
    turn_inputs,
    turn_section,
)
from templates.two_vehicles.readings import direction_section, readings
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
from templates.two_vehicles.scene import Scene, assumptions_of_momentum, constants_of_momentum
from templates.two_vehicles.together import SWITCH, drawn_together, leave_together
from templates.units import MPH
from templates.vehicles import SECOND, for_both

__all__ = ["describe"]

_ENERGY = (
    Equation(
        "E_before",
        "Ei",
        "Kinetic energy before, of translation",
        "[ft·lb|J]",
        "(m_1*V1_i^2+m_2*V2_i^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_after",
        "Ef",
        "Kinetic energy after, of translation",
        "[ft·lb|J]",
        "(m_1*V1_f^2+m_2*V2_f^2)/2",
        "definition",
        number_format="#,##0",
    ),
    Equation(
        "E_lost",
        "Elost",
        "Energy lost to crush and rotation",
        "[ft·lb|J]",
        "E_before-E_after",
        "definition",
        "Rotation after the impact is part of it; planar-impact tells how large a part.",
        number_format="#,##0",
    ),
    Equation(
        "approach_[mph|kmh]",
        "VP",
        "Closing speed along the impulse",
        "[mph|km/h]",
        "-(P_x*(V1_i*COS(RADIANS(alpha_1))-V2_i*COS(RADIANS(alpha_2)))"
        f"+P_y*(V1_i*SIN(RADIANS(alpha_1))-V2_i*SIN(RADIANS(alpha_2))))/P_total*{MPH}",
        "definition",
        "Positive when the impulse opposes the approach of the vehicles.",
        number_format="0.00",
    ),
)

_CLOSING = check(
    "check_closing",
    "The impulse opposes the approach",
    "approach_[mph|kmh]>0",
    "physics",
    "FALSE: the impulse would pull the vehicles together. Look at the approach and departure angles.",
)

_WHEN = GuideSection(
    "When to use this model",
    (
        "Two vehicles whose approach and departure directions and run-out can be estimated, and whose approaches "
        "differ by more than about 10°. Rotation need not be known: it changes no speed and no delta-V.",
        "The next model, planar-impact, gives the same speeds and delta-V in every trial. It adds yaw and restitution, "
        "with which impossible combinations can be rejected: often most of them. Use it once inertia, impact centre "
        "and contact direction can be given.",
        "Not for near-parallel approaches (|sin δ| small): an uncertainty σ of an angle, in radians, becomes one of "
        "about σ/|sin δ| of a speed. Where that is more than you can accept, use crush-energy or momentum-energy.",
        "Not where tyre or other outside forces matter during the impact: at f = 0.8 they take about 1.8 mph "
        "(2.8 km/h) for each 0.1 s of contact. Enter a duration on sheet Inputs to see how much.",
    ),
)

_TRUST = GuideSection(
    "Reading the results of this model",
    (
        "Without restitution to judge the trials, ranges are wider than those of planar-impact for the same scene.",
        "PDOF, the principal direction of force, is counted counter-clockwise from the front, −180 to 180, so that a "
        "blow from ahead does not jump between 0 and 360. Sheet Model gives it clockwise too.",
        "A blow from behind jumps between 180 and −180: enter its direction from the damage on sheet Evidence, with "
        "Use FALSE if it is not to be evidence. PDOF is then counted to within 180° of that.",
        "The speeds are correlated with the delta-Vs: do not combine the ends of separate ranges freely.",
    ),
)

_CORRECTIONS = GuideSection(
    "Where this workbook departs from the printed paper",
    ("A prime, as in (15′), marks an equation rewritten to keep its digits: in exact arithmetic it is the same.",),
    (
        ("Equation", "As used here"),
        ("(16)", "No division by cos α2: as printed, α2 = 90° or 270° gives a plausible wrong speed without an error"),
        ("(19) to (21)", "From the impulse, not from differences of nearly equal velocities"),
        ("(23)", "Arctangent of two arguments: as printed it can point to the opposite side of the vehicle"),
        ("Vf", "Never stated in the paper: √(2·g·f·s)"),
    ),
)

_CENTRES = tuple(turned(("0", "0"), f"alpha_{j}", f"-0.5*length_{j}", "0") for j in (1, 2))


def describe(scene: Scene) -> Template:
    """The workbook of one scene."""
    more = not scene.paper_only
    return Template(
        title=scene.title,
        subtitle=scene.subtitle,
        vehicles=scene.vehicles,
        rung=4,
        question="How fast were two vehicles that met at an angle? Delta-V?",
        needs="weights, approach and departure angles, run-out, friction",
        assumptions=assumptions_of_momentum(scene),
        constants=(*((SWITCH,) if more else ()), *constants_of_momentum()),
        optional=(*duration_inputs(), *turn_inputs(), *drawing_inputs()),
        sections=leave_together(_sections(more=True)) if more else _sections(more=False),
        forecasts=paper_forecasts() + direction_forecasts(yaw=False, near=more) + (run_out_forecasts() if more else ()),
        filters=(*_filters(scene), *turn_filters()),
        settings=(("Trials", 200_000), ("Seed", 999)),
        correlations=(CorrelationRow("f_1", "f_2", 0),),
        correlation_note=shared_road_note(),
        guide=(
            scene.guide,
            FIRST_STEPS,
            *((READINGS, RUN_OUT_GUIDE) if more else ()),
            NAMES,
            _WHEN,
            _TRUST,
            CAVEATS,
            _CORRECTIONS,
        ),
        diagram=drawn_together(_diagram("travel")) if more else _diagram("s"),
        evidence=readings(yaw=False) if more else (),
        waiting=run_out_inputs() if more else (),
        waiting_note=RUN_OUT_NOTE,
    )


def _sections(*, more: bool) -> tuple[Section, ...]:
    patterns = {
        "1  Masses and run-out speeds": MASSES + (segmented_run_out() if more else RUN_OUT),
        "2  Impact speeds, by conservation of momentum": IMPACT_SPEEDS,
        "3  Impulse and change in velocity": DELTA_V,
        "4  Answers (the forecasts)": ANSWERS,
        "5  Direction of force, energy": FORCE + _ENERGY,
    }
    return (
        *(Section(title, for_both(rows)) for title, rows in patterns.items()),
        duration_section(6),
        turn_section(7),
        *((direction_section(8), before_section(9)) if more else ()),
        checks_section(
            10 if more else 8, ENERGY, _CLOSING, ANGLES, FORWARD, FRICTION, *((RUN_OUT_CHECK,) if more else ())
        ),
    )


def _filters(scene: Scene) -> tuple[FilterRow, ...]:
    return (
        FilterRow(f"{SECOND} impact speed", "V2_[mph|kmh]", scene.because["V2_mph"], above=0),
        FilterRow("Energy lost", "E_lost", "An impact takes energy away; it cannot add any", at_least=0),
        FilterRow("Closing speed along the impulse", "approach_[mph|kmh]", "The vehicles push, not pull", above=0),
    )


def _diagram(way: str) -> Diagram:
    first, second = _CENTRES
    return Diagram(
        "Plan view of the base case",
        "X, [ft|m]",
        "Y, [ft|m]",
        (
            *vehicle_curves((first, second), way),
            rest_points((first, second), way),
            mark("Point of impact", ("0", "0")),
        ),
        plan=True,
        remark="Drawn from the cells below. This model needs no contact point: the vehicles are drawn nose to nose.",
    )
