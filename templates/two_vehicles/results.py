"""What a run of a two-vehicle model collects, and the correlation of friction on a shared road."""

from __future__ import annotations

from templates.description import ForecastRow

__all__ = ["direction_forecasts", "paper_forecasts", "shared_road", "shared_road_note"]


def paper_forecasts(vehicles: tuple[str, str]) -> tuple[ForecastRow, ...]:
    """The four forecasts of SAE 2001-01-3347."""
    first, second = vehicles
    return (
        ForecastRow(f"{first} delta-V", "dV1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{second} delta-V", "dV2_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{first} impact speed", "V1_[mph|kmh]", "[mph|km/h]"),
        ForecastRow(f"{second} impact speed", "V2_[mph|kmh]", "[mph|km/h]"),
    )


def direction_forecasts(vehicles: tuple[str, str], *, yaw: bool) -> tuple[ForecastRow, ...]:
    """Beyond the paper's four: direction of force, closing speed, energy lost, and the change in yaw rate."""
    rows = [
        *(ForecastRow(f"{who} PDOF, counter-clockwise", f"PDOF_{j}", "deg") for j, who in enumerate(vehicles, 1)),
        ForecastRow("Closing speed", "closing_[mph|kmh]", "[mph|km/h]"),
        ForecastRow("Energy lost", "E_lost", "[ft·lb|J]"),
    ]
    if yaw:
        rows += (
            ForecastRow(f"{who} change in yaw rate", f"d_omega{j}_deg", "deg/s") for j, who in enumerate(vehicles, 1)
        )
    return tuple(rows)


def shared_road(vehicles: tuple[str, str]) -> str:
    """How to correlate both decelerations, where the row is still blank."""
    rows = [f"{who} post-impact deceleration" for who in vehicles]
    return (
        f"Both on one road? First = {rows[0]}, Second = {rows[1]}, Correlation = 0.8, say. "
        "Blank: none, as in the paper."
    )


def shared_road_note() -> str:
    """How to use the row that is ready."""
    return "Both on one road? Then their decelerations go together: raise 0 to 0.8, say. 0 is none, as in the paper."
