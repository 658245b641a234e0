"""Two vehicles meet in the plane: impact speeds and delta-V from directions and run-out (SAE 2001-01-3347)."""

from __future__ import annotations

from templates.description import CorrelationRow, Diagram, FilterRow, ForecastRow, Look, Template
from templates.plan_view import line, mark
from templates.planar_impact.answers import answer_sections
from templates.planar_impact.equations import model_sections
from templates.planar_impact.evaluate import evaluate
from templates.planar_impact.guide import guide
from templates.restitution_curve import curve_diagram, curve_evidence, curve_inputs
from templates.two_vehicles.drawing import rest_points, vehicle_curves
from templates.two_vehicles.options import drawing_inputs, duration_inputs, turn_filters, turn_inputs
from templates.two_vehicles.readings import lever_inputs, readings, rotation_inputs
from templates.two_vehicles.results import direction_forecasts, paper_forecasts, shared_road, shared_road_note
from templates.two_vehicles.run_out import RUN_OUT_NOTE, run_out_forecasts, run_out_inputs
from templates.two_vehicles.scene import (
    Scene,
    assumptions_of_planar_impact,
    constants_of_momentum,
    yaw_rates,
)
from templates.two_vehicles.together import SWITCH, drawn_together, leave_together
from templates.vehicles import SECOND

__all__ = ["Scene", "describe", "evaluate"]

_CENTRES = (("a_1", "b_1"), ("a_2", "b_2"))
_CURVE = (
    ForecastRow("Closing speed along the normal", "approach_[mph|kmh]", "[mph|km/h]", stated="diagnostic"),
    ForecastRow("Restitution along the normal", "e_n", "", stated="diagnostic"),
)
"""What is drawn over the published curve."""


def describe(scene: Scene) -> Template:
    """The workbook of one scene."""
    more = not scene.paper_only
    sections = model_sections(more=more) + answer_sections(more=more)
    return Template(
        title=scene.title,
        subtitle=scene.subtitle,
        vehicles=scene.vehicles,
        rung=5,
        question="The same, with yaw: which solutions does restitution allow?",
        needs="those of momentum; yaw inertias, impact centre, contact direction",
        assumptions=assumptions_of_planar_impact(scene),
        constants=(*((SWITCH,) if more else ()), *yaw_rates(), *constants_of_momentum(inches=True)),
        optional=(
            *duration_inputs(),
            *((*turn_inputs(), *lever_inputs(), *rotation_inputs(), *curve_inputs()) if more else ()),
            *drawing_inputs(),
        ),
        sections=leave_together(sections) if more else sections,
        forecasts=paper_forecasts()
        + ((*direction_forecasts(yaw=True, near=True), *run_out_forecasts(), *_CURVE) if more else ()),
        filters=_filters(scene) + (turn_filters() if more else ()),
        settings=(("Trials", 200_000), ("Seed", 999)),
        correlations=(CorrelationRow("f_1", "f_2", 0),) if more else (),
        correlation_note=shared_road_note() if more else shared_road(),
        guide=guide(scene.guide, more=more),
        diagram=drawn_together(_diagram("travel")) if more else _diagram("s"),
        evidence=(*readings(yaw=True), *curve_evidence()) if more else (),
        waiting=run_out_inputs() if more else (),
        waiting_note=RUN_OUT_NOTE,
        curve=curve_diagram("e_n", "approach_[mph|kmh]") if more else None,
    )


def _filters(scene: Scene) -> tuple[FilterRow, ...]:
    because = scene.because
    return (
        FilterRow("Restitution, normal", "e_n", because["e_n"], at_least=0, below=1),
        FilterRow("Restitution, tangential", "e_t", because["e_t"], at_least=0, at_most=0.25),
        FilterRow(f"{SECOND} impact speed", "V2_[mph|kmh]", because["V2_mph"], above=0),
    )


def _diagram(way: str) -> Diagram:
    return Diagram(
        "Plan view of the base case",
        "X, [ft|m]",
        "Y, [ft|m]",
        (
            *vehicle_curves(_CENTRES, way),
            line("Contact direction γ", Look.LINE, "gamma_t", "0.4*length_1"),
            rest_points(_CENTRES, way),
            mark("Impact centre", ("0", "0")),
        ),
        plan=True,
        remark="Drawn from the cells below, about the impact centre. Outlines are centred on the CG; their size "
        "is for the eye only.",
    )
