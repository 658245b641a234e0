"""Vehicles and arrows of a plan view, as formulas of their points."""

from __future__ import annotations

from templates.description import Curve, Look

__all__ = ["arrow", "line", "mark", "outline", "turned"]

Point = tuple[str, str]

_NOSE = (("-0.5", "-0.5"), ("-0.5", "0.5"), ("0.4", "0.5"), ("0.5", "0"), ("0.4", "-0.5"), ("-0.5", "-0.5"))
"""A rectangle with a pointed front: shares of the length forward, of the width to the left."""
_BARB = "0.1"
"""Length of an arrow's barbs, in units of the arrow."""


def turned(origin: Point, heading: str, forward: str, left: str) -> Point:
    """The point so far forward and to the left of the origin, seen along a heading in degrees."""
    sine, cosine = f"SIN(RADIANS({heading}))", f"COS(RADIANS({heading}))"
    x, y = origin
    return f"{x}+{forward}*{cosine}-{left}*{sine}", f"{y}+{forward}*{sine}+{left}*{cosine}"


def outline(name: str, look: Look, centre: Point, heading: str, length: str, width: str) -> Curve:
    """A vehicle about its centre, pointed at the front."""
    corners = (turned(centre, heading, f"({u}*{length})", f"({v}*{width})") for u, v in _NOSE)
    return Curve(name, look, tuple(corners))


def arrow(name: str, look: Look, tail: Point, heading: str, length: str) -> Curve:
    """An arrow from its tail along a heading; a length that begins with a minus sign draws it to the tail instead."""
    start, tip = tail, turned(tail, heading, length, "0")
    if length.startswith("-"):
        start, tip = tip, tail
    size = f"({_BARB}*ABS({length}))"
    barbs = (turned(tip, heading, f"-{size}", f"{sign}0.5*{size}") for sign in ("", "-"))
    left, right = barbs
    return Curve(name, look, (start, tip, left, tip, right))


def line(name: str, look: Look, heading: str, length: str) -> Curve:
    """A line through the origin, so long to either side."""
    return Curve(name, look, (turned(("0", "0"), heading, f"-{length}", "0"), turned(("0", "0"), heading, length, "0")))


def mark(name: str, *points: Point, look: Look = Look.POINT) -> Curve:
    """Marked points."""
    return Curve(name, look, points)
