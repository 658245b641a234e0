"""The plain trials of a run, for the search: those that were accepted are evidence of where acceptance lies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from xlmc.run.model import Model
    from xlmc.sampling.streams import Stream

__all__ = ["MOST_PLAIN", "plain_uniforms"]

Floats = NDArray[np.float64]

MOST_PLAIN: Final = 4_096
"""Accepted plain trials that are looked at: the first of them."""


def plain_uniforms(model: Model, seed: int, accepted: NDArray[np.int64]) -> Floats:
    """(k, d) the uniforms of plain trials with these numbers, (k,)."""
    streams = _streams(model, seed)
    uniforms = np.empty((len(streams), accepted.size))
    for row, stream in zip(uniforms, streams, strict=True):
        for place, trial in enumerate(accepted.tolist()):
            stream.uniforms(trial, row[place : place + 1])
    return uniforms.T


def _streams(model: Model, seed: int) -> Sequence[Stream]:
    """In the order of the coordinates."""
    found: list[Stream] = []

    def filler(streams: Sequence[Stream], _maps: object, _rows: Floats) -> Callable[[int], None]:
        found.extend(streams)
        return lambda _: None

    model.sampler(seed, 1, filler=filler)
    return found
