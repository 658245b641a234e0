"""Arrays whose size differs from trial to trial: `FILTER` of what varies. They are computed trial by trial."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.budget import ask_for_live
from xlmc.functions.lookup.picking import joined
from xlmc.functions.values import Value

__all__ = ["Ragged", "by_trial"]


class Ragged(Value):
    """One value a trial, each of a size of its own. It passes for a `Value` only where trials are taken from it."""

    __slots__ = ("trials",)

    trials: Sequence[Value]

    def __init__(self, trials: Sequence[Value]) -> None:
        super().__init__(np.zeros((len(trials), 0, 0)), np.zeros((1, 1, 1), np.uint8))
        object.__setattr__(self, "trials", trials)

    @property
    def has_errors(self) -> bool:
        return any(trial.has_errors for trial in self.trials)

    @property
    def plain(self) -> bool:
        return all(trial.plain for trial in self.trials)

    def take(self, index: NDArray[np.intp]) -> Value:
        """The trials of `index`."""
        return Ragged([self.trials[i] for i in index])


def by_trial(evaluate: Callable[[Mapping[int, Value]], Value], values: Mapping[int, Value]) -> Value:
    """Evaluate each trial alone; one value where all are of one size, a `Ragged` otherwise."""
    n = max(value.shape[0] for value in values.values())
    found: list[Value] = []
    size = 0
    for i in range(n):
        found.append(evaluate({place: _trial(value, i) for place, value in values.items()}))
        size += found[-1].nbytes
        ask_for_live(size)
    if len({value.shape for value in found}) > 1:
        return Ragged(found)
    return joined(found, axis=0)


def _trial(value: Value, i: int) -> Value:
    if isinstance(value, Ragged):
        return value.trials[i]
    return value.take(np.array([i], np.intp))
