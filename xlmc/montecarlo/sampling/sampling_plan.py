"""The plan of a run: its sampling method, and how its trials are divided into independent replicates."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.sampling.latin import LatinHypercube
from xlmc.montecarlo.sampling.sampling_methods import METHODS, REPLICATES, STRATA, Margin
from xlmc.montecarlo.sampling.streams import Stream

__all__ = ["MOST_OUTER", "Repeated", "SamplingPlan"]

_OWN: Final[Mapping[str, str]] = MappingProxyType({})

MOST_OUTER: Final = STRATA
"""The most draws of an outer loop: intervals of its Latin hypercube."""


class Repeated:
    """The uniforms of an assumption that keeps each draw for several trials.

    Args:
        margin: gives the draws, by their numbers.
        times: trials that keep a draw.
    """

    def __init__(self, margin: Margin, times: int) -> None:
        self._margin, self._times = margin, times

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """See `Margin`."""
        first, last = start // self._times, -(-(start + out.size) // self._times)
        drawn = np.empty(last - first)
        self._margin.uniforms(first, drawn)
        out[:] = np.repeat(drawn, self._times)[start - first * self._times :][: out.size]


@dataclass(frozen=True, slots=True)
class SamplingPlan:
    """A method and its replicates, each a range of trials, one after the other.

    Attributes:
        method: a key of `METHODS`.
        trials: how many are run: whole replicates, and so sometimes more than were asked for.
        size: trials in a replicate; 0 where the trials themselves are independent.
        order: the assumptions in the order of their Sobol dimensions; empty to take them as they are listed.
        outer: assumptions that are drawn once for each replicate, all others once for each trial in it.
    """

    method: str
    trials: int
    size: int = 0
    order: tuple[str, ...] = ()
    outer: frozenset[str] = frozenset()

    @classmethod
    def nested(cls, outer: Collection[str], draws: int, trials: int) -> SamplingPlan:
        """Make the plan of two loops: a Latin hypercube of outer draws, and for each so many independent trials.

        Args:
            outer: the assumptions that the outer loop draws.
            draws: of the outer loop, 1 to `MOST_OUTER`.
            trials: for each of them.
        """
        return cls("mc", draws * trials, trials, outer=frozenset(outer))

    @classmethod
    def of(cls, method: str, trials: int) -> SamplingPlan:
        """Make the plan for at least `trials` trials; the plan for its own number of trials is the same.

        Raises:
            ValueError: there is no such method.

        >>> SamplingPlan.of("sobol", 200_000)
        SamplingPlan(method='sobol', trials=204800, size=8192, order=(), outer=frozenset())
        >>> SamplingPlan.of("lhs", 200_000).replicates
        16
        """
        if method not in METHODS:
            raise ValueError(f"there is no sampling method {method!r}")
        replicate = METHODS[method].replicate
        if replicate is None:
            return cls(method, trials)
        size = replicate(trials)
        return cls(method, size * max(REPLICATES, -(-trials // size)), size)

    @property
    def replicates(self) -> int:
        """How many replicates there are; 0 if the trials themselves are independent."""
        return self.trials // self.size if self.size else 0

    def margins(self, seed: int, names: Sequence[str], streams: Mapping[str, str] = _OWN) -> Sequence[Margin]:
        """Return, for each assumption, the object that draws its uniforms.

        Args:
            seed: of the run.
            names: of the assumptions.
            streams: name of an assumption -> the name that its uniforms are drawn by, where that is another.

        Raises:
            SimulationError: the method cannot draw so many assumptions.
        """
        dimensions = {name: dimension for dimension, name in enumerate(self.order or names)}
        if self.outer:
            return [self._nested_margin(seed, name, streams.get(name, name)) for name in names]
        of_streams = {streams.get(name, name): dimensions[name] for name in names}
        return METHODS[self.method].margins(seed, of_streams, self.size)

    def _nested_margin(self, seed: int, name: str, stream: str) -> Margin:
        if name not in self.outer:
            return Stream(seed, stream)
        return Repeated(LatinHypercube(seed, stream, self.replicates), self.size)

    def replicate_of(self, trials: NDArray[np.int64]) -> NDArray[np.int64] | None:
        """Return the replicate of each trial, (n,); None if the trials themselves are independent."""
        return trials // self.size if self.size else None
