"""The plan of a run: its sampling method, and how its trials are divided into independent replicates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.sampling.sampling_methods import METHODS, REPLICATES, Margin

__all__ = ["SamplingPlan"]


@dataclass(frozen=True, slots=True)
class SamplingPlan:
    """A method and its replicates, each a range of trials, one after the other.

    Attributes:
        method: a key of `METHODS`.
        trials: how many are run: whole replicates, and so sometimes more than were asked for.
        size: trials in a replicate; 0 where the trials themselves are independent.
        order: the assumptions in the order of their Sobol dimensions; empty to take them as they are listed.
    """

    method: str
    trials: int
    size: int = 0
    order: tuple[str, ...] = ()

    @classmethod
    def of(cls, method: str, trials: int) -> SamplingPlan:
        """Make the plan for at least `trials` trials; the plan for its own number of trials is the same.

        Raises:
            ValueError: there is no such method.

        >>> SamplingPlan.of("sobol", 200_000)
        SamplingPlan(method='sobol', trials=204800, size=8192, order=())
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

    def margins(self, seed: int, names: Sequence[str]) -> Sequence[Margin]:
        """Return, for each assumption, the object that draws its uniforms.

        Raises:
            SimulationError: the method cannot draw so many assumptions.
        """
        dimensions = {name: dimension for dimension, name in enumerate(self.order or names)}
        return METHODS[self.method].margins(seed, {name: dimensions[name] for name in names}, self.size)

    def replicate_of(self, trials: NDArray[np.int64]) -> NDArray[np.int64] | None:
        """Return the replicate of each trial, (n,); None if the trials themselves are independent."""
        return trials // self.size if self.size else None
