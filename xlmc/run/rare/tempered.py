"""Proposals that nothing was learned for: the assumptions as they are, and the assumptions spread wider.

What is drawn from them says whether accepted trials lie where a search did not look: each trial has a weight, how much
likelier it is as a plain trial than as one of these, and the weighted share of accepted ones estimates their
probability whatever was found before (a defensive mixture: Hesterberg 1995; Owen & Zhou 2000).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.run.rare.mixture import log_sum

__all__ = ["Tempered", "as_they_are", "widened"]

Floats = NDArray[np.float64]

_ALL: Final = (1.5, 2.0, 3.0, 4.0)
"""Spreads of all assumptions together, as far as the largest weights stay moderate."""

_ONE: Final = 4.0
"""The spread of one assumption alone, the others being as they are."""

_LARGEST: Final = 64.0
"""Of the ratio of densities at the median, which the spread of all assumptions together may have."""


@dataclass(frozen=True, slots=True, eq=False)
class Tempered:
    """A mixture of independent normals about 0, in d dimensions.

    Attributes:
        shares: (K,) of the components; they sum to 1.
        spreads: (K, d) their standard deviations.
    """

    shares: Floats
    spreads: Floats

    def draw(self, count: int, random: np.random.Generator) -> Floats:
        """(count, d) independent points."""
        component = np.searchsorted(np.cumsum(self.shares)[:-1], random.random(count), side="right")
        return np.asarray(self.spreads[component] * random.standard_normal((count, self.spreads.shape[1])))

    def log_weights(self, points: Floats) -> Floats:
        """(n,) the logarithm of how much likelier each of (n, d) points is as a plain trial than as one of these."""
        narrower = 0.5 * (1.0 - self.spreads**-2.0)
        logs = np.log(self.shares) - np.log(self.spreads).sum(axis=1)
        return -log_sum(logs[:, None] + np.einsum("kd,nd->kn", narrower, np.square(points)))


def as_they_are(dimensions: int) -> Tempered:
    """Plain trials."""
    return Tempered(np.ones(1), np.ones((1, dimensions)))


def widened(dimensions: int) -> Tempered:
    """A third of the trials with one assumption spread wider, a half with all of them, the rest as they are."""
    together = [spread for spread in _ALL if spread**dimensions <= _LARGEST] or [_LARGEST ** (1.0 / dimensions)]
    alone = np.where(np.eye(dimensions, dtype=bool), _ONE, 1.0)
    spreads = [np.ones((1, dimensions)), np.outer(together, np.ones(dimensions)), alone]
    shares = [[0.15], [0.5 / len(together)] * len(together), [0.35 / dimensions] * dimensions]
    return Tempered(np.concatenate(shares), np.concatenate(spreads))
