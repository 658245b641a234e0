"""Which method draws, and how the trials of a run are divided into independent replicates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import SimulationError
from xlmc.sampling.directions import DIMENSIONS
from xlmc.sampling.latin import LatinHypercube
from xlmc.sampling.sobol import ScrambledSobol
from xlmc.sampling.streams import Stream

__all__ = ["METHODS", "REPLICATES", "Margin", "Plan"]

METHODS: Final[Mapping[str, str]] = {
    "mc": "Monte Carlo",
    "lhs": "Latin hypercube",
    "lhs500": "Latin hypercube in blocks of 500",
    "sobol": "scrambled Sobol",
}
"""By their names in the settings."""

REPLICATES: Final = 16
"""The fewest of a run: their spread, and so every error, is known to 1/√30 = 18 %."""

_STRATA: Final = {"lhs": 16_384, "lhs500": 500}
"""The most trials in a replicate. More intervals gain nothing: of the variance that one input alone explains, 16,384
leave some 4·10⁻⁹ where the forecast is smooth."""


class Margin(Protocol):
    """The uniforms of one assumption, in any order of blocks; for one thread."""

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, in [0, 1)."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The method and its replicates, a range of trials each, one after the other.

    Attributes:
        method: `mc`, `lhs`, `lhs500` or `sobol`.
        trials: that are run: whole replicates, and so sometimes more than were asked for.
        size: trials in a replicate; 0 where the trials themselves are independent.
        order: the assumptions in the order of their Sobol dimensions; empty to take them as they are listed.
    """

    method: str
    trials: int
    size: int = 0
    order: tuple[str, ...] = ()

    @classmethod
    def of(cls, method: str, trials: int) -> Plan:
        """The plan for at least `trials` trials; that for its own number of trials is the same plan.

        Raises:
            ValueError: there is no such method.

        >>> Plan.of("sobol", 200_000)
        Plan(method='sobol', trials=204800, size=8192, order=())
        >>> Plan.of("lhs", 200_000).replicates
        16
        """
        if method not in METHODS:
            raise ValueError(f"there is no sampling method {method!r}")
        if method == "mc":
            return cls(method, trials)
        size = _power_of_two(trials) if method == "sobol" else min(_STRATA[method], -(-trials // REPLICATES))
        return cls(method, size * max(REPLICATES, -(-trials // size)), size)

    @property
    def replicates(self) -> int:
        """How many; 0 where the trials themselves are independent."""
        return self.trials // self.size if self.size else 0

    def margins(self, seed: int, names: Sequence[str]) -> list[Margin]:
        """What draws each assumption.

        Raises:
            SimulationError: there are more assumptions than Sobol points have dimensions, or these are not to be had.
        """
        if self.method == "mc":
            return [Stream(seed, name) for name in names]
        if self.method != "sobol":
            return [LatinHypercube(seed, name, self.size) for name in names]
        if len(names) > DIMENSIONS:
            message = f"Sobol points have {DIMENSIONS:,} dimensions, and {len(names):,} assumptions are drawn"
            raise SimulationError(message, hint="Use --sampling lhs or mc")
        places = {name: place for place, name in enumerate(self.order or names)}
        return [ScrambledSobol(seed, name, places[name], self.size) for name in names]

    def replicate_of(self, trials: NDArray[np.int64]) -> NDArray[np.int64] | None:
        """The replicate of each trial, (n,); None where the trials themselves are independent."""
        return trials // self.size if self.size else None


def _power_of_two(trials: int) -> int:
    """The trials of a Sobol replicate: 16 to 31 of them are at most a sixteenth more than were asked for."""
    size = 1 << max(0, (trials // REPLICATES).bit_length() - 1)
    return size if trials <= (2 * REPLICATES - 1) * size else 2 * size
