"""Sets of trials: all of them, and those that take one branch of an `IF`, which may stand in a branch itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

__all__ = ["ALL_TRIALS", "DEEPEST_BRANCHES", "TrialSet", "common_set"]

DEEPEST_BRANCHES: Final = 8
"""Sets within sets; an `IF` that is deeper is evaluated on one set with both of its branches."""


class TrialSet(NamedTuple):
    """The trials of `parent` in which its `IF`, the node `select`, takes one branch. A tuple, as it is a key of dicts.

    Attributes:
        parent: None for all trials.
        select: -1 for a set that no `IF` makes.
        branch: 1 yes, 0 no.
        depth: how many sets it lies in.
    """

    parent: TrialSet | None
    select: int = -1
    branch: int = 1
    depth: int = 0

    def taking(self, select: int, branch: int) -> TrialSet:
        """Return the trials of this set that take a branch of an `IF`."""
        return TrialSet(self, select, branch, self.depth + 1)

    def outwards(self) -> Iterator[TrialSet]:
        """Return the set and those it lies in, from the innermost out."""
        trials: TrialSet | None = self
        while trials is not None:
            yield trials
            trials = trials.parent


ALL_TRIALS: Final = TrialSet(None)


def common_set(a: TrialSet | None, b: TrialSet) -> TrialSet:
    """Return the narrowest set that holds the trials of both; `b` where there is no `a` yet."""
    if a is None:
        return b
    while a is not b and a != b:
        if a.depth >= b.depth and a.parent is not None:
            a = a.parent
        elif b.parent is not None:
            b = b.parent
    return a
