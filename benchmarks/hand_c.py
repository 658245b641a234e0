"""hand.c built and called: the case study and the skid sheet in C, one thread.

`build(folder)` compiles it with the compiler named in CC, else the first of gcc, clang, cc.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["FLAGS", "Hand", "build", "compiler"]

Array = NDArray[np.float64]
SOURCE = Path(__file__).resolve().parent / "hand.c"
FLAGS = (
    *("-O3", "-march=native", "-fopenmp-simd", "-ffp-contract=fast"),
    *("-fno-math-errno", "-fno-trapping-math"),  # or gcc takes no square root of several numbers at once
    *("-fno-builtin-sin", "-fno-builtin-cos"),  # or gcc makes pairs of them into calls that it cannot vectorise
)
"""No -ffast-math: its reordering and its dropping of NaNs are not used. Contraction to fused multiply-adds is."""
WIDE = "-mprefer-vector-width=512"
"""Compilers avoid 512-bit vectors unless told; one that does not know the flag is called without it."""


def compiler() -> str | None:
    """The C compiler, or None."""
    names = (os.environ["CC"],) if os.environ.get("CC") else ("gcc", "clang", "cc")
    return next((found for name in names if (found := shutil.which(name))), None)


def build(folder: Path) -> Path:
    """Compile the library into `folder`.

    Raises:
        RuntimeError: no compiler, or it fails; its message.
    """
    cc = compiler()
    if cc is None:
        raise RuntimeError("no C compiler: set CC, or install gcc")
    library = folder / "hand.so"
    for extra in ((WIDE,), ()):
        for math in (("-lmvec", "-lm"), ("-lm",)):
            command = [cc, *FLAGS, *extra, "-shared", "-fPIC", "-o", str(library), str(SOURCE), *math]
            done = subprocess.run(command, capture_output=True, text=True)
            if done.returncode == 0:
                return library
    raise RuntimeError(done.stderr)


class Hand:
    """The functions of the library for one book.

    Args:
        library: from `build`.
        book: `case` or `skid`.
        low, high: of the uniform inputs, (k,).
        forecasts: how many.
    """

    def __init__(self, library: Path, book: str, low: Array, high: Array, forecasts: int) -> None:
        functions = ctypes.CDLL(str(library))
        doubles = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
        self._evaluate = getattr(functions, f"{book}_evaluate")
        self._evaluate.argtypes = [doubles, ctypes.c_long, doubles]
        self._evaluate.restype = ctypes.c_long
        self._simulate = getattr(functions, f"{book}_simulate")
        size = ctypes.c_long
        self._simulate.argtypes = [size, ctypes.c_uint64, size, doubles, doubles, doubles, size]
        self._simulate.restype = ctypes.c_long
        self._low, self._high = np.ascontiguousarray(low), np.ascontiguousarray(high)
        self._forecasts = forecasts
        self._share = 0.03 if book == "case" else 1.0

    def evaluate(self, inputs: Array) -> Array:
        """Inputs (k, n) -> forecasts of the accepted trials, (f, m)."""
        n = inputs.shape[1]
        out = np.empty((self._forecasts, n))
        found = self._evaluate(np.ascontiguousarray(inputs), n, out)
        return out[:, :found]

    def simulate(self, trials: int, seed: int, chunk: int) -> Array:
        """Forecasts of the accepted trials, (f, m). `chunk` is a multiple of 8.

        Raises:
            MemoryError: more trials were accepted than there is room for, or no room was to be had.
        """
        capacity = min(trials, int(self._share * trials) + 10_000)
        out = np.empty((self._forecasts, capacity))
        found = self._simulate(trials, seed, chunk, self._low, self._high, out, capacity)
        if found < 0 or (found == capacity and capacity < trials):
            raise MemoryError("no room for the accepted trials")
        return out[:, :found]
