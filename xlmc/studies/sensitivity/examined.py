"""Which accepted trials the influences rest on: all, or as many of the first as make every error small enough.

Of independent trials the first ones; of a Latin hypercube or Sobol run the first ones of each of its first replicates,
for later ones of a Sobol replicate fill the gaps that earlier ones left and are no sample by themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["COARSE_TRIALS", "LEAST_TRIALS", "MOST_TRIALS", "examined_places", "trials_for"]

MOST_TRIALS: Final = 1 << 13
"""They know a rank correlation to 0.011."""

LEAST_TRIALS: Final = 20
"""Fewer say nothing of an influence."""

COARSE_TRIALS: Final = 1 << 10
"""For a first look at very many assumptions: a rank correlation to 0.03."""

_FEWEST = 1 << 11
_VALUES = 1 << 20
"""Trials times pairs of an assumption and a forecast: some 0.05 s of work."""

_REPLICATES = 32


def trials_for(pairs: int) -> int:
    """How many trials to examine, at most, for so many pairs of an assumption and a forecast."""
    return min(MOST_TRIALS, max(_FEWEST, _VALUES // max(pairs, 1)))


def examined_places(simulation: Simulation, most: int) -> tuple[NDArray[np.intp], NDArray[np.int64] | None]:
    """The places of at most `most` accepted trials with known draws, ascending, and their replicates, if any."""
    kept = simulation.kept_inputs if simulation.model.live else 0
    if not simulation.plan.size:
        return np.arange(min(kept, most)), None
    replicate = simulation.plan.replicate_of(np.asarray(simulation.trial_index[:kept]))
    assert replicate is not None
    starts = np.flatnonzero(np.diff(replicate, prepend=-1))
    ends = np.append(starts[1:], replicate.size)
    chosen = min(_REPLICATES, starts.size)
    each = max(most // max(chosen, 1), 1)
    parts = [np.arange(start, min(end, start + each)) for start, end in zip(starts[:chosen], ends, strict=False)]
    places = np.concatenate(parts) if parts else np.empty(0, np.intp)
    return places, replicate[places]
