"""One random stream for each assumption, identified by (seed, name) and positioned by trial index.

A draw depends on nothing else: not on the other assumptions, not on the block size, not on the thread.
"""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.spelling import name_key

__all__ = ["Stream"]


class Stream:
    """The uniforms of one assumption, in any order of blocks. For one thread.

    Args:
        seed: of the run.
        name: of the assumption; its case and outer blanks do not count.
        purpose: what the numbers are for, unless they are the draws themselves; each purpose has its own stream.

    The generator is PCG64DXSM with `SeedSequence(seed, spawn_key=SHA-256(name_key(name)))`; trial i takes its i-th
    number. A purpose adds the words of its own SHA-256 to the key.
    """

    def __init__(self, seed: int, name: str, purpose: str = "") -> None:
        key = _words(name_key(name)) + (_words(purpose) if purpose else ())
        self._bits = np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=key))
        self._start = self._bits.state
        self._generator = np.random.Generator(self._bits)
        self._at = 0

    @property
    def beginning(self) -> tuple[int, int]:
        """The generator's 128-bit state before the first trial, and its increment."""
        inner = self._start["state"]
        return int(inner["state"]), int(inner["inc"])

    def uniforms(self, start: int, out: NDArray[np.float64]) -> None:
        """Fill `out` (n,) with the uniforms of trials `start` to `start + n - 1`, in [0, 1) on the grid k·2⁻⁵³."""
        self._go_to(start, out.size)
        self._generator.random(out=out)

    def raw(self, start: int, count: int) -> NDArray[np.uint64]:
        """Return the 64 random bits at each position from `start` on, `(count,)`."""
        self._go_to(start, count)
        return np.asarray(self._bits.random_raw(count), dtype=np.uint64)

    def _go_to(self, start: int, count: int) -> None:
        """Go to the position `start`, from which `count` numbers will be taken."""
        if start != self._at:
            self._bits.state = self._start
            self._bits.advance(start)
        self._at = start + count


def _words(text: str) -> tuple[int, ...]:
    return tuple(np.frombuffer(hashlib.sha256(text.encode()).digest(), dtype="<u4").tolist())
