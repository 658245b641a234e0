"""What a two-vehicle model needs to know of a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from templates.description import GuideSection, Input
from templates.editions import Both
from templates.units import CONVERSIONS, GRAVITY, INCHES_PER_FOOT
from templates.vehicles import vehicle

__all__ = [
    "Scene",
    "assumptions_of_momentum",
    "assumptions_of_planar_forward",
    "assumptions_of_planar_impact",
    "constants_of_momentum",
    "yaw_rates",
]

Range = tuple[float, float] | Both


@dataclass(frozen=True, slots=True)
class Scene:
    """One crash: what stands in the input cells, and on whose word.

    Attributes:
        vehicles: what to call vehicle 1 and vehicle 2.
        ranges: imperial symbol -> (low, high), a `Both` of two such where there are both editions.
        base: imperial symbol -> base value; the middle of the range where a symbol is missing.
        sources: imperial symbol -> where the range comes from.
        because: imperial symbol of a filtered quantity (`e_n`, `e_t`, `V2_mph`) -> the evidence for its limits.
        guide: what the guide sheet says of the scene.
        paper_only: ask for the paper's forecasts and filters and no more.
    """

    title: str
    subtitle: str
    vehicles: tuple[str, str]
    ranges: Mapping[str, Range]
    base: Mapping[str, float | Both]
    sources: Mapping[str, str]
    because: Mapping[str, str]
    guide: GuideSection
    paper_only: bool = False

    def input(self, key: str, texts: tuple[str, str, str, str], number_format: str) -> Input:
        """The input cell of one uniformly distributed quantity.

        Args:
            key: its imperial symbol.
            texts: symbol, notation, name, unit.
            number_format: of the cell.
        """
        low, high = _ends(self.ranges[key])
        symbol, notation, name, unit = texts
        return Input(
            symbol,
            notation,
            name,
            unit,
            base=self.base.get(key, _middle(low, high)),
            source=self.sources[key],
            parameters={"Low": low, "High": high},
            number_format=number_format,
        )


def _ends(given: Range) -> tuple[float | Both, float | Both]:
    if isinstance(given, Both):
        return Both(given.imperial[0], given.si[0]), Both(given.imperial[1], given.si[1])
    return given


def _middle(low: float | Both, high: float | Both) -> float | Both:
    if isinstance(low, Both) and isinstance(high, Both):
        return Both((low.imperial + high.imperial) / 2, round((low.si + high.si) / 2, 6))
    return (low + high) / 2  # type: ignore[operator]


# Imperial symbol, then symbol, notation, name, unit, number format.
_WEIGHT = ("w", "[w|m]", "[w|m]", "[weight|mass]", "[lb|kg]", "#,##0")
_INERTIA = ("I", "I", "I", "yaw moment of inertia", "[lb·ft·s²|kg·m²]", "#,##0")
_DIRECTIONS = (
    ("alpha", "alpha", "α", "approach angle", "deg", "0.0"),
    ("beta", "beta", "β", "departure angle", "deg", "0.0"),
)
_RUN_OUT = (
    ("s", "s", "s", "post-impact travel distance", "[ft|m]", "0.0[|0]"),
    ("f", "f", "f", "post-impact deceleration", "g", "0.000"),
)
_IMPACT_CENTRE = (
    ("x", "x", "x", "impact centre x", "[in|m]", "0.0[|00]"),
    ("y", "y", "y", "impact centre y", "[in|m]", "0.0[|00]"),
)

Row = tuple[str, str, str, str, str, str]


def _of_both(scene: Scene, *groups: tuple[Row, ...]) -> tuple[Input, ...]:
    order = [(j, row) for rows in groups for j in (1, 2) for row in rows]
    return tuple(
        scene.input(
            f"{key}_{j}",
            (f"{symbol}_{j}", f"{notation}{j}", f"{vehicle(j)} {name}", unit),
            number_format,
        )
        for j, (key, symbol, notation, name, unit, number_format) in order
    )


def assumptions_of_momentum(scene: Scene) -> tuple[Input, ...]:
    """The ten uncertain inputs that speeds and delta-V need."""
    return _of_both(scene, (_WEIGHT, *_DIRECTIONS, *_RUN_OUT))


def assumptions_of_planar_impact(scene: Scene) -> tuple[Input, ...]:
    """The seventeen uncertain inputs, in the order of the paper's Table 1."""
    of_vehicles = _of_both(scene, (_WEIGHT, _INERTIA, *_DIRECTIONS, *_RUN_OUT), _IMPACT_CENTRE)
    return (*of_vehicles, _tangent(scene))


def assumptions_of_planar_forward(scene: Scene, speeds: tuple[Input, ...]) -> tuple[Input, ...]:
    """What the forward model needs of a scene, with the impact speeds of both vehicles in their place."""
    heading, friction = _DIRECTIONS[:1], _RUN_OUT[1:]
    before = _of_both(scene, (_WEIGHT, _INERTIA, *heading))
    after = _of_both(scene, friction, _IMPACT_CENTRE)
    return (*before, *speeds, *after, _tangent(scene))


def _tangent(scene: Scene) -> Input:
    return scene.input("gamma_t", ("gamma_t", "γ", "Orientation of tangent", "deg"), "0.0")


def constants_of_momentum(*, inches: bool = False) -> tuple[Input, ...]:
    """Gravity and unit conversions, held fixed."""
    return (GRAVITY, *((INCHES_PER_FOOT,) if inches else ()), *CONVERSIONS)


def yaw_rates() -> tuple[Input, ...]:
    """Yaw rates before the impact, held fixed at 0 unless the engineer knows better."""
    yaw = "Before the impact, counter-clockwise positive seen from above; 0 unless the vehicle was turning"
    return tuple(
        Input(f"omega{j}_deg", f"ω{j}i (deg/s)", f"{vehicle(j)} pre-impact yaw rate", "deg/s", 0, yaw) for j in (1, 2)
    )
