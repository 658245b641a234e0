"""The plan view of two vehicles at the impact: outlines, approach and departure directions, points of rest."""

from __future__ import annotations

from templates.description import Curve, Look
from templates.plan_view import arrow, mark, outline, turned
from templates.vehicles import vehicle

__all__ = ["rest_points", "vehicle_curves"]

Point = tuple[str, str]

_LOOKS = ((Look.FIRST, Look.FIRST_PATH), (Look.SECOND, Look.SECOND_PATH))


def vehicle_curves(centres: tuple[Point, Point], way: str = "s") -> tuple[Curve, ...]:
    """Either vehicle at the impact, where it came from and where it went.

    Args:
        centres: formulas of the centres of gravity at the impact.
        way: symbol of the travel to rest, without the vehicle's number.
    """
    curves: list[Curve] = []
    for j, (centre, (solid, dashed)) in enumerate(zip(centres, _LOOKS, strict=True), 1):
        who = vehicle(j)
        came = turned(centre, f"alpha_{j}", f"-0.5*length_{j}", "0")
        curves += [
            outline(who, solid, centre, f"alpha_{j}", f"length_{j}", f"width_{j}"),
            arrow(f"{who} approach", solid, came, f"alpha_{j}", f"-0.9*length_{j}*(V{j}_i>0)"),
            arrow(f"{who} departure, to rest", dashed, centre, f"beta_{j}", f"{way}_{j}"),
        ]
    return tuple(curves)


def rest_points(centres: tuple[Point, Point], way: str = "s") -> Curve:
    """Where the centres of gravity come to rest."""
    points = (turned(centre, f"beta_{j}", f"{way}_{j}", "0") for j, centre in enumerate(centres, 1))
    return mark("Rest", *points, look=Look.REST)
