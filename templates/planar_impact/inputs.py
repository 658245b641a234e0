"""What the planar impact model needs to know of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from templates.description import GuideSection, Input
from templates.units import FEET_PER_MILE, GRAVITY, INCHES_PER_FOOT, SECONDS_PER_HOUR

__all__ = ["Scene", "assumptions", "constants"]


@dataclass(frozen=True, slots=True)
class Scene:
    """One crash: what stands in the input cells, and on whose word.

    Attributes:
        vehicles: what to call vehicle 1 and vehicle 2.
        ranges: symbol -> (low, high).
        base: symbol -> base value; the middle of the range where a symbol is missing.
        sources: symbol -> where the range comes from.
        because: symbol of a filtered quantity (`e_n`, `e_t`, `V2_mph`) -> the evidence for its limits.
        guide: what the guide sheet says of the scene.
    """

    title: str
    subtitle: str
    vehicles: tuple[str, str]
    ranges: Mapping[str, tuple[float, float]]
    base: Mapping[str, float]
    sources: Mapping[str, str]
    because: Mapping[str, str]
    guide: GuideSection

    def input(self, symbol: str, notation: str, name: str, unit: str, number_format: str) -> Input:
        """The input cell of one uniformly distributed quantity."""
        low, high = self.ranges[symbol]
        return Input(
            symbol,
            notation,
            name,
            unit,
            base=self.base.get(symbol, (low + high) / 2),
            source=self.sources[symbol],
            parameters={"Low": low, "High": high},
            number_format=number_format,
        )


_OF_EACH_VEHICLE = (
    ("w", "w", "weight", "lb", "#,##0"),
    ("I", "I", "yaw moment of inertia", "lb·ft·s²", "#,##0"),
    ("alpha", "α", "approach angle", "deg", "0.0"),
    ("beta", "β", "departure angle", "deg", "0.0"),
    ("s", "s", "post-impact travel distance", "ft", "0.0"),
    ("f", "f", "post-impact deceleration", "g", "0.000"),
)
_IMPACT_CENTRE = (
    ("x", "x", "impact centre x", "in", "0.0"),
    ("y", "y", "impact centre y", "in", "0.0"),
)


def assumptions(scene: Scene) -> tuple[Input, ...]:
    """The seventeen uncertain inputs, in the order of the paper's Table 1."""
    order = [(j, row) for rows in (_OF_EACH_VEHICLE, _IMPACT_CENTRE) for j in (1, 2) for row in rows]
    of_vehicles = (
        scene.input(f"{symbol}_{j}", f"{notation}{j}", f"{scene.vehicles[j - 1]} {name}", unit, number_format)
        for j, (symbol, notation, name, unit, number_format) in order
    )
    return (*of_vehicles, scene.input("gamma_t", "γ", "Orientation of tangent", "deg", "0.0"))


def constants(scene: Scene) -> tuple[Input, ...]:
    """Inputs that are held fixed: yaw rates before the impact, gravity, unit conversions."""
    yaw = "Before the impact, counter-clockwise positive; 0 unless the vehicle was turning"
    yaw_rates = (
        Input(f"omega{j}_deg", f"ω{j}i", f"{scene.vehicles[j - 1]} pre-impact yaw rate", "deg/s", 0, yaw)
        for j in (1, 2)
    )
    return (*yaw_rates, GRAVITY, INCHES_PER_FOOT, SECONDS_PER_HOUR, FEET_PER_MILE)
