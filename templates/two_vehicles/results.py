"""What a run of a two-vehicle model collects, and the correlation of friction on a shared road."""

from __future__ import annotations

from templates.description import ForecastRow
from templates.vehicles import FIRST, SECOND, vehicle

__all__ = ["direction_forecasts", "paper_forecasts", "shared_road", "shared_road_note"]


def paper_forecasts() -> tuple[ForecastRow, ...]:
    """The four forecasts of SAE 2001-01-3347."""
    return (
        ForecastRow(f"{FIRST} delta-V", "dV1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{SECOND} delta-V", "dV2_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{FIRST} impact speed", "V1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{SECOND} impact speed", "V2_[mph|kmh]", "[mph|km/h]"),
    )


def direction_forecasts(*, yaw: bool, near: bool) -> tuple[ForecastRow, ...]:
    """Beyond the paper's four: direction of force, closing speed, energy lost, and the change in yaw rate.

    Args:
        yaw: the model has yaw rates.
        near: it has rows for the direction of force as a reading.
    """
    pdof = "PDOF_near" if near else "PDOF"
    rows = [
        *(ForecastRow(f"{vehicle(j)} PDOF, counter-clockwise", f"{pdof}_{j}", "deg") for j in (1, 2)),
        ForecastRow("Closing speed", "closing_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Energy lost", "E_lost", "[ft·lb|J]", stated="diagnostic"),
    ]
    if yaw:
        rows += (ForecastRow(f"{vehicle(j)} change in yaw rate", f"d_omega{j}_deg", "deg/s") for j in (1, 2))
    return tuple(rows)


def shared_road() -> str:
    """How to correlate both decelerations, where the row is still blank."""
    return (
        f"Both on one road? First = {FIRST} post-impact deceleration, Second = {SECOND} post-impact deceleration, "
        "Correlation = 0.8, say. Blank: none, as in the paper."
    )


def shared_road_note() -> str:
    """How to use the row that is ready."""
    return "Both on one road? Then their decelerations go together: raise 0 to 0.8, say. 0 is none, as in the paper."
