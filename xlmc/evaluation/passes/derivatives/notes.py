"""What is noted on the way: where functions take different ways, where derivatives are lost, what has no rule."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell
from xlmc.evaluation.passes.derivatives.found import Kink, Numerical, Undefined
from xlmc.functions.values import Bools, Floats

__all__ = ["Notes"]


@dataclass
class Notes:
    """Collected over the portions of a run.

    Attributes:
        ways: node -> way -> in how many trials.
        lost: node -> why -> the trials, counted from 0.
        errors: node -> the largest relative error of a difference.
    """

    ways: dict[int, Counter[float]] = field(default_factory=lambda: defaultdict(Counter))
    lost: dict[int, dict[str, list[NDArray[np.intp]]]] = field(default_factory=lambda: defaultdict(dict))
    errors: dict[int, float] = field(default_factory=dict)
    names: dict[int, str] = field(default_factory=dict)
    jumping: set[int] = field(default_factory=set)

    def took(self, place: int, name: str, ways: NDArray[np.generic], jumps: bool) -> None:
        """A function took these ways, one a trial."""
        self.names[place] = name
        if jumps:
            self.jumping.add(place)
        found, counts = np.unique(np.asarray(ways, np.float64), return_counts=True)
        self.ways[place].update(dict(zip(found.tolist(), counts.tolist(), strict=True)))

    def lose(self, place: int, name: str, why: str, trials: Bools, start: int) -> None:
        """A function lost the derivatives in these trials of a portion that starts at `start`."""
        self.names[place] = name
        self.lost[place].setdefault(why, []).append(np.flatnonzero(trials) + start)

    def differed(self, place: int, name: str, first: Floats, error: Floats | None) -> None:
        """A function was differentiated by differences."""
        self.names[place] = name
        with np.errstate(all="ignore"):
            share = np.abs((0.0 if error is None else error) / first)
        share = share[np.isfinite(share)]
        worst = float(share.max()) if share.size else float("nan")
        known = self.errors.get(place, float("nan"))
        self.errors[place] = worst if np.isnan(known) else max(known, worst) if worst == worst else known

    def kinks(self, owners: Mapping[int, Cell]) -> tuple[Kink, ...]:
        """What took more than one way, the most evenly divided first."""
        found = []
        for place, ways in self.ways.items():
            if len(ways) > 1:
                share = 1 - max(ways.values()) / ways.total()
                found.append(Kink(owners[place], self.names[place], len(ways), share, place in self.jumping))
        return tuple(sorted(found, key=lambda kink: -kink.share))

    def undefined(self, owners: Mapping[int, Cell], concerned: Iterable[int]) -> tuple[Undefined, ...]:
        """Where derivatives were lost, of trials that concern a cell that was asked for; the most first."""
        those = np.fromiter(concerned, np.intp)
        found = []
        for place, reasons in self.lost.items():
            for why, parts in reasons.items():
                trials = np.intersect1d(np.concatenate(parts), those)
                if trials.size:
                    found.append(Undefined(owners[place], self.names[place], why, int(trials.size), int(trials[0])))
        return tuple(sorted(found, key=lambda each: -each.trials))

    def numerical(self, owners: Mapping[int, Cell]) -> tuple[Numerical, ...]:
        """The functions without a rule, the least certain first."""
        found = [Numerical(owners[place], self.names[place], error) for place, error in self.errors.items()]
        return tuple(sorted(found, key=lambda each: -np.nan_to_num(each.error)))
