"""Excel's iterative calculation, as a workbook sets it."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Iteration"]


@dataclass(frozen=True, slots=True)
class Iteration:
    """How Excel computes cells that need each other in a circle, where its iterative calculation is on.

    Attributes:
        count: the most times that they are computed.
        change: once none of them changes by so much, they are not computed again.
    """

    count: int = 100
    change: float = 0.001
