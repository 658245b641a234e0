"""Which influences are no more than noise: what trials alone would show where an assumption has none.

Variance explained and dependence have a floor of their own (see `results`). A rank correlation, and the contribution
made of it, is noise within as many errors of 0 as the largest of all assumptions' stays within by chance, with 95 %
probability (Šidák 1967); a Sobol index likewise, on one side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from xlmc.statistics import Estimate
from xlmc.studies.sensitivity.results import ForecastSensitivity, Influence

__all__ = ["Noise", "noise"]

_CHANCE: Final = 0.05
"""That noise alone passes for an influence, in any of a forecast's assumptions."""


@dataclass(frozen=True, slots=True)
class Noise:
    """Whether each measure of one assumption's influence is no more than noise.

    Attributes:
        correlation: the rank correlation, and the contribution to variance that is made of it.
    """

    explained: bool
    dependence: bool
    correlation: bool
    first_order: bool
    total: bool


def noise(found: ForecastSensitivity) -> tuple[Noise, ...]:
    """Of the influences on a forecast, in their order."""
    count = max(len(found.influences), 1)
    each = 1.0 - (1.0 - _CHANCE) ** (1.0 / count)
    return tuple(_noise(one, _errors(each / 2.0), _errors(each)) for one in found.influences)


def _errors(chance: float) -> float:
    """How many errors a normal number lies above 0 with some chance."""
    from scipy.special import ndtri

    return -float(ndtri(chance))


def _noise(found: Influence, either: float, above: float) -> Noise:
    return Noise(
        explained=found.explained.value <= found.explained_floor,
        dependence=found.dependence.value <= found.dependence_floor,
        correlation=_is_small(found.rank_correlation, either, abs(found.rank_correlation.value)),
        first_order=found.first_order is not None and _is_small(found.first_order, above, found.first_order.value),
        total=found.total is not None and _is_small(found.total, above, found.total.value),
    )


def _is_small(found: Estimate, errors: float, size: float) -> bool:
    """Whether a number is within so many of its errors of 0; where it has no error, nothing is known of that."""
    return found.error is not None and math.isfinite(size) and size <= errors * found.error
