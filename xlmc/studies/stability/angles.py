"""Angles subtracted after RADIANS: each is rounded before, where the difference of degrees would have been exact."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.studies.stability.case import Case
from xlmc.studies.stability.findings import Finding, Level
from xlmc.studies.stability.rewriting import angles_in_degrees

__all__ = ["rounded_angles"]

_LEFT: Final = 0.1
"""Of the larger angle: a difference above it loses less than a digit."""


def rounded_angles(case: Case) -> Iterator[Finding]:
    """The cells that subtract angles so, and in which little is left of them in some trials."""
    for cell in case.cells:
        left = min((_left(case, cell, part) for part in case.trees.parts(cell)), default=1.0)
        better = angles_in_degrees(case.trees.formula(cell)) if left < _LEFT else None
        if better is not None:
            yield Finding(
                Level.NOTE,
                "angles",
                cell,
                case.trees.title(cell),
                case.trees.written(cell),
                "it subtracts angles after RADIANS, which rounds them; in degrees the difference is exact",
                f"down to {left:.1g} of the angles is left: so many of their digits are lost in the difference",
                (),
                case.trees.offered(better, cell),
                1 / max(left, 1e-16),
            )


def _left(case: Case, cell: Cell, part: ir.Expression) -> float:
    """The smallest difference as a share of the larger angle; 1 where the part is none."""
    if angles_in_degrees(part) is None or not isinstance(part, ir.Binary) or part.operator != "-":
        return 1.0
    places = [case.trees.place(tree, cell) for tree in (part, part.left, part.right)]
    if any(place is None or place not in case.values for place in places):
        return 1.0
    difference, first, second = (np.abs(case.number(place)) for place in places if place is not None)
    with np.errstate(all="ignore"):
        return float(np.nanmin(difference / np.fmax(first, second)))
