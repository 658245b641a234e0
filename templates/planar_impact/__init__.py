"""Two vehicles meet in the plane: impact speeds and delta-V from directions and run-out (SAE 2001-01-3347)."""

from __future__ import annotations

from templates.description import FilterRow, ForecastRow, Template
from templates.planar_impact.answers import ALL_CHECKS, answer_sections
from templates.planar_impact.equations import model_sections
from templates.planar_impact.evaluate import evaluate
from templates.planar_impact.guide import guide
from templates.planar_impact.inputs import Scene, assumptions, constants

__all__ = ["Scene", "describe", "evaluate"]


def describe(scene: Scene) -> Template:
    """The workbook of one scene."""
    return Template(
        title=scene.title,
        subtitle=scene.subtitle,
        assumptions=assumptions(scene),
        constants=constants(scene),
        sections=model_sections(scene.vehicles) + answer_sections(scene.vehicles),
        forecasts=_forecasts(scene),
        filters=_filters(scene),
        settings=(("Trials", 200_000), ("Seed", 999)),
        correlation_note=_shared_road(scene),
        guide=guide(scene.guide),
        all_checks=ALL_CHECKS,
        evaluate=evaluate,
    )


def _forecasts(scene: Scene) -> tuple[ForecastRow, ...]:
    first, second = scene.vehicles
    return (
        ForecastRow(f"{first} delta-V", "dV1_mph", "mph"),
        ForecastRow(f"{second} delta-V", "dV2_mph", "mph"),
        ForecastRow(f"{first} impact speed", "V1_mph", "mph"),
        ForecastRow(f"{second} impact speed", "V2_mph", "mph"),
    )


def _filters(scene: Scene) -> tuple[FilterRow, ...]:
    because = scene.because
    return (
        FilterRow("Restitution, normal", "e_n", because["e_n"], at_least=0, below=1),
        FilterRow("Restitution, tangential", "e_t", because["e_t"], at_least=0, at_most=0.25),
        FilterRow(f"{scene.vehicles[1]} impact speed", "V2_mph", because["V2_mph"], above=0),
    )


def _shared_road(scene: Scene) -> str:
    rows = [f"{who} post-impact deceleration" for who in scene.vehicles]
    return (
        f"Both on one road? First = {rows[0]}, Second = {rows[1]}, Correlation = 0.8, say. "
        "Blank: none, as in the paper."
    )
