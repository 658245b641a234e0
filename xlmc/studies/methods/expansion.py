"""What the differential methods share: the point, the derivatives there, and what to say of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.passes.derivatives import Derivative, Derivatives
from xlmc.run.model import Model
from xlmc.studies.derivatives import derivatives
from xlmc.studies.methods.moments import Moments, moments_of

__all__ = ["Expansion", "expansion_of"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Expansion:
    """The forecasts about the means of the assumptions.

    Attributes:
        moments: of the assumptions.
        forecasts: name -> value and derivatives there, of one point.
        remarks: what to say of the point.
    """

    moments: Moments
    forecasts: Mapping[str, Derivative]
    remarks: tuple[str, ...]


def expansion_of(model: Model, seed: int, order: int) -> Expansion:
    """Expand a model's forecasts.

    Raises:
        SimulationError: a mean or a standard deviation of an assumption is infinite.
    """
    moments = moments_of(model, seed)
    names = [a.name for a in model.live]
    found = derivatives(model, dict(zip(names, moments.mean, strict=True)), order=order)
    remarks = ("about the means of the assumptions", *moments.remarks, *_remarks(found))
    return Expansion(moments, found.forecasts, remarks)


def _remarks(found: Derivatives) -> list[str]:
    said = [f"no derivative: {each.why} ({each.function} in {each.cell})" for each in found.undefined]
    if found.numerical:
        names = ", ".join(f"{each.function} in {each.cell}" for each in found.numerical)
        said.append(f"derivatives by differences, for want of a rule: {names}")
    lost = [name for name, each in found.forecasts.items() if np.isnan(each.gradient).any()]
    if lost:
        said.append(f"nothing to say of {', '.join(lost)}")
    return said
