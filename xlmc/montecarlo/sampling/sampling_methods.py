"""The sampling methods, a row each: the command line, settings, records and `xlmc methods` know them from here.

To add one, write a module beside this one with a `Margin`, which draws the uniforms of one assumption, and its row
below; describe it in docs/sampling.md. docs/adding.md has an example. A method imports its module only when it draws,
so that `--help` is quick.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from xlmc.errors import SimulationError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["GENERATOR", "METHODS", "REPLICATES", "STRATA", "Margin", "SamplingMethod"]

GENERATOR: Final = "PCG64DXSM"

REPLICATES: Final = 16
"""The fewest replicates of a run: their spread, and so every error, is known to 1/√30 = 18 %."""

STRATA: Final = 16_384
"""The most trials in a replicate. More intervals gain nothing: with 16,384, some 4·10⁻⁹ remains of the variance that
one input alone explains, if the forecast is smooth."""

_STREAMS: Final = f"{GENERATOR}: a stream for each assumption, seeded by (seed, name), positioned by trial number"
_SORTED: Final = f"{_STREAMS}; a second stream for each puts the intervals of a replicate in order"


class Margin(Protocol):
    """The uniforms of one assumption, in any order of blocks; for one thread."""

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, multiples of 2⁻⁵³ in [0, 1)."""


class SamplingMethod(NamedTuple):
    """One way to draw the trials of a run.

    Attributes:
        key: its name in options, settings, records and saved runs.
        name: its name in sentences.
        generator: where its numbers come from, for the record.
        margins: takes the seed, the dimension of each name and the trials in a replicate; gives a margin for each name.
        replicate: takes the trials asked for and gives those in each replicate; None if trials are independent of each
            other, so that a run may end after any of them.
        also: other names that a workbook may give it, as `distributions.spelling.plain` writes them.
        ordered: it spreads the first dimensions best, so a short run finds which assumptions matter most.
        compared: `xlmc methods` tries it.
        limit: why more trials may not bring the accuracy asked for, in a clause; empty where they always do.
    """

    key: str
    name: str
    generator: str
    margins: Callable[[int, Mapping[str, int], int], Sequence[Margin]]
    replicate: Callable[[int], int] | None = None
    also: tuple[str, ...] = ()
    ordered: bool = False
    compared: bool = True
    limit: str = ""

    @property
    def independent(self) -> bool:
        """Whether its trials are independent of each other."""
        return self.replicate is None


def _monte_carlo(seed: int, dimensions: Mapping[str, int], _size: int) -> list[Margin]:
    from xlmc.montecarlo.sampling.streams import Stream

    return [Stream(seed, name) for name in dimensions]


def _latin_hypercube(seed: int, dimensions: Mapping[str, int], size: int) -> list[Margin]:
    from xlmc.montecarlo.sampling.latin import LatinHypercube

    return [LatinHypercube(seed, name, size) for name in dimensions]


def _scrambled_sobol(seed: int, dimensions: Mapping[str, int], size: int) -> list[Margin]:
    """Return the margins.

    Raises:
        SimulationError: there are more assumptions than Sobol points have dimensions, or these are not to be had.
    """
    from xlmc.montecarlo.sampling.sobol_points import DIMENSIONS, ScrambledSobol

    if len(dimensions) > DIMENSIONS:
        message = f"Sobol points have {DIMENSIONS:,} dimensions, and {len(dimensions):,} assumptions are drawn"
        raise SimulationError(message, hint="Use --sampling lhs or mc")
    return [ScrambledSobol(seed, name, dimension, size) for name, dimension in dimensions.items()]


def _at_most(most: int) -> Callable[[int], int]:
    """Return a rule for replicates of at most so many trials."""
    return lambda trials: min(most, -(-trials // REPLICATES))


def _power_of_two(trials: int) -> int:
    """Return the trials of a Sobol replicate: 16 to 31 replicates are at most a sixteenth more than were asked for."""
    size = 1 << max(0, (trials // REPLICATES).bit_length() - 1)
    return size if trials <= (2 * REPLICATES - 1) * size else 2 * size


_ROWS: Final = (
    SamplingMethod("mc", "Monte Carlo", _STREAMS, _monte_carlo, also=("montecarlo",)),
    SamplingMethod(
        "lhs",
        "Latin hypercube",
        _SORTED,
        _latin_hypercube,
        _at_most(STRATA),
        also=("latinhypercube",),
        limit="filters take its gain away: what they accept is no marginal",
    ),
    SamplingMethod(
        "lhs500",
        "Latin hypercube in blocks of 500",
        _SORTED,
        _latin_hypercube,
        _at_most(500),
        compared=False,
    ),
    SamplingMethod(
        "sobol",
        "scrambled Sobol",
        "Sobol points with the direction numbers of Joe and Kuo, an assumption a dimension; linear scramble and "
        f"digital shift from {GENERATOR}, seeded by (seed, name), positioned by replicate",
        _scrambled_sobol,
        _power_of_two,
        also=("scrambledsobol",),
        ordered=True,
        limit="filters take most of its gain away",
    ),
)

METHODS: Final[dict[str, SamplingMethod]] = {row.key: row for row in _ROWS}
"""The methods by their keys; the first is used if no other is asked for."""
