"""How far the forms are off, through xlmc, beside the exact answer and beside what the evidence itself allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

from stressing.exact import DIGITS, conditioning, exact
from stressing.forms import FORMS, INPUTS
from stressing.sweeps import Point
from stressing.workbook import values_of
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["BOUND", "UNIT", "Measured", "measured"]

Floats = NDArray[np.float64]

UNIT: Final = 2.0**-53
"""The unit roundoff: the largest relative error of one operation."""

BOUND: Final = 8.0
"""What the rewritten forms stay below, as `Measured.excess` counts."""


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """What was found at the points of a sweep; errors are relative, of directions over 180°.

    Attributes:
        x: of the points, `(n,)`.
        errors: engine -> cell -> `(n,)`; infinite where the cell is an error or no number.
        conditions: rewritten cell -> `(n,)`; see `exact.conditioning`.
    """

    x: Floats
    errors: dict[str, dict[str, Floats]]
    conditions: dict[str, Floats]

    def excess(self, engine: str, cell: str, rewritten: str) -> Floats:
        """The error over that which one rounding of the answer and of each quantity of the evidence makes, `(n,)`."""
        return np.asarray(self.errors[engine][cell] / (UNIT * (1.0 + self.conditions[rewritten])))


def measured(model: CompiledModel, points: Sequence[Point], engines: Sequence[str]) -> Measured:
    """Compute every form at every point with every engine, and hold it against 80 digits."""
    columns = {name: np.array([point.evidence[name] for point in points]) for name in INPUTS}
    truths = [exact(point.evidence) for point in points]
    result = [conditioning(point.evidence) for point in points]
    errors = {}
    for engine in engines:
        values = values_of(model, columns, engine)
        errors[engine] = {
            cell: np.array(
                [_error(value, t[form.rewritten], form.angle) for value, t in zip(values[cell], truths, strict=True)]
            )
            for form in FORMS
            for cell in (form.printed, form.rewritten)
        }
    conditions = {form.rewritten: np.array([each[form.rewritten] for each in result]) for form in FORMS}
    return Measured(np.array([point.x for point in points]), errors, conditions)


def _error(value: float, truth: mpf, angle: bool) -> float:
    if not np.isfinite(value):
        return np.inf
    with mp.workdps(DIGITS):
        apart = mpf(float(value)) - truth
        if angle:
            return float(abs((apart + 180) % 360 - 180) / 180)
        return float(abs(apart / truth)) if truth else (0.0 if not apart else np.inf)
