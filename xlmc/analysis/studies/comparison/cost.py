"""What a change of a workbook does to its answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from xlmc.analysis.studies.comparison.differences import Acceptance, Difference
from xlmc.analysis.studies.comparison.tolerances import Judgement

__all__ = ["Cost"]


@dataclass(frozen=True, slots=True)
class Cost:
    """What a change of the book does to its answers.

    Attributes:
        names: of the assumptions held, or of the filters left out.
        acceptance: of the book as it is (first), and changed (second).
        forecasts: name -> the same.
        judgement: of all numbers together.
        size: the largest difference, measured in its tolerance.
    """

    names: tuple[str, ...]
    acceptance: Acceptance
    forecasts: Mapping[str, Difference]
    judgement: Judgement
    size: float

    @property
    def lost(self) -> tuple[str, ...]:
        """The forecasts that are then a number in too few accepted trials."""
        return tuple(
            name
            for name, each in self.forecasts.items()
            if any(np.isnan(change.difference.value) for _, change in each.changes)
        )
