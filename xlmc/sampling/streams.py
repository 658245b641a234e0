"""One random stream per assumption, known by (seed, name) and positioned by trial index.

A draw depends on nothing else: not on the other assumptions, not on the block size, not on the thread.
"""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

__all__ = ["GENERATOR", "Stream"]

GENERATOR = "PCG64DXSM"


class Stream:
    """The uniforms of one assumption, in any order of blocks. For one thread.

    Args:
        seed: of the run.
        name: of the assumption, as `name_key` folds it.

    The generator is PCG64DXSM with `SeedSequence(seed, spawn_key=SHA-256(name))`; trial i takes its i-th number.
    """

    def __init__(self, seed: int, name: str) -> None:
        words = np.frombuffer(hashlib.sha256(name.encode()).digest(), dtype="<u4")
        self._bits = np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=tuple(int(w) for w in words)))
        self._start = self._bits.state
        self._generator = np.random.Generator(self._bits)

    @property
    def beginning(self) -> tuple[int, int]:
        """The generator's state before the first trial, 128 bits, and its increment."""
        inner = self._start["state"]
        return int(inner["state"]), int(inner["inc"])

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, in [0, 1) on the grid k·2⁻⁵³."""
        self._bits.state = self._start
        self._bits.advance(start)
        self._generator.random(out=out)
