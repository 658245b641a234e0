"""When a rule may look: after a growing number of blocks.

A rule that looks after every block gets many chances to find its numbers known well by luck, and costs most. With
numbers of blocks that grow by a constant factor there are few looks, each at much more than the one before.
"""

from __future__ import annotations

import math

__all__ = ["FIRST", "GROWTH", "Checkpoints"]

FIRST = 4
"""Blocks before the first look."""

GROWTH = 1.25
"""Blocks of a look over those of the look before it: at most so many times the trials needed are run."""


class Checkpoints:
    """Counts blocks, and says after which to look: 4, 5, 7, 9, 12, 15, 19, 24, 30, …

    >>> checkpoints = Checkpoints()
    >>> [block for block in range(1, 31) if checkpoints.due()]
    [4, 5, 7, 9, 12, 15, 19, 24, 30]
    """

    def __init__(self) -> None:
        self._blocks, self._next = 0, FIRST

    def due(self) -> bool:
        """Count a block; whether to look after it."""
        self._blocks += 1
        if self._blocks < self._next:
            return False
        self._next = max(self._blocks + 1, math.ceil(self._blocks * GROWTH))
        return True
