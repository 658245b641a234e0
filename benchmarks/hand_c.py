"""hand.c and hand_march.c built and called: the books in C, one thread.

`build(folder)` compiles it with the compiler named in CC, else the first of gcc, clang, cc.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["FINITE", "FLAGS", "Hand", "March", "build", "compiler"]

Array = NDArray[np.float64]
HERE = Path(__file__).resolve().parent
FLAGS = (
    *("-O3", "-march=native", "-fopenmp-simd", "-ffp-contract=fast"),
    *("-fno-math-errno", "-fno-trapping-math"),  # or gcc takes no square root of several numbers at once
    *("-fno-builtin-sin", "-fno-builtin-cos"),  # or gcc makes pairs of them into calls that it cannot vectorise
)
"""No -ffast-math: its reordering and its dropping of NaNs are not used. Contraction to fused multiply-adds is."""
FINITE = ("-fno-signed-zeros", "-ffinite-math-only", "-fno-builtin-exp")
"""For hand_march.c, which has neither infinities nor NaNs: gcc makes no vectors of minima and maxima otherwise."""
SOURCES: dict[str, tuple[str, ...]] = {"hand.c": (), "hand_march.c": FINITE}
"""File -> its flags besides FLAGS."""
WIDE = "-mprefer-vector-width=512"
"""Compilers avoid 512-bit vectors unless told; one that does not know the flag is called without it."""


def compiler() -> str | None:
    """The C compiler, or None."""
    names = (os.environ["CC"],) if os.environ.get("CC") else ("gcc", "clang", "cc")
    return next((result for name in names if (result := shutil.which(name))), None)


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
            for done in _compiled(cc, extra, library, math):
                if done.returncode:
                    break
            else:
                return library
    raise RuntimeError(done.stderr)


def _compiled(
    cc: str, extra: Sequence[str], library: Path, math: Sequence[str]
) -> Iterator[subprocess.CompletedProcess[str]]:
    """Compile each source, then link them; the caller stops at the first that fails."""
    objects = {source: library.with_name(f"{source}.o") for source in SOURCES}
    commands = [
        [cc, *FLAGS, *SOURCES[source], *extra, "-fPIC", "-c", "-o", str(made), str(HERE / source)]
        for source, made in objects.items()
    ]
    for command in (*commands, [cc, "-shared", "-o", str(library), *map(str, objects.values()), *math]):
        yield subprocess.run(command, capture_output=True, text=True)


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
        result = self._evaluate(np.ascontiguousarray(inputs), n, out)
        return out[:, :result]

    def simulate(self, trials: int, seed: int, chunk: int) -> Array:
        """Forecasts of the accepted trials, (f, m). `chunk` is a multiple of 8.

        Raises:
            MemoryError: more trials were accepted than there is room for, or no room was to be had.
        """
        capacity = min(trials, int(self._share * trials) + 10_000)
        out = np.empty((self._forecasts, capacity))
        result = self._simulate(trials, seed, chunk, self._low, self._high, out, capacity)
        if result < 0 or (result == capacity and capacity < trials):
            raise MemoryError("no room for the accepted trials")
        return out[:, :result]


class March:
    """The functions of the library for the time-stepped books.

    Args:
        library: from `build`.
        cells: formula cells of the time steps.
        search: one of `hand_written_march.SEARCHES`; `searchsorted` searches by halves.
    """

    GROUP = 32
    """Trials that go through all steps together, GROUP in hand_march.c."""

    def __init__(self, library: Path, cells: int, search: str) -> None:
        import hand_written_march as march
        from books import ROAD_STEP

        steps, dt = march.steps_of(cells)
        columns = np.array(march.road_columns())
        functions = ctypes.CDLL(str(library))
        doubles = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")
        size, real = ctypes.c_long, ctypes.c_double
        book = [size, real, doubles, size, real, ctypes.c_int, doubles]
        self._book = (steps, dt, columns, columns.shape[1], ROAD_STEP, int(search == "guess"))
        self._evaluate, self._simulate = functions.march_evaluate, functions.march_simulate
        self._evaluate.argtypes, self._evaluate.restype = [doubles, size, *book], None
        self._simulate.argtypes = [size, ctypes.c_uint64, size, doubles, doubles, *book]
        self._simulate.restype = size
        self._low, self._high = march.LOW, march.HIGH

    def evaluate(self, inputs: Array) -> Array:
        """Inputs (12, n) -> the forecast, (1, n)."""
        n = inputs.shape[1]
        whole = np.pad(inputs, ((0, 0), (0, -n % self.GROUP)), mode="edge")
        out = np.empty((1, whole.shape[1]))
        self._evaluate(np.ascontiguousarray(whole), whole.shape[1], *self._book, out)
        return out[:, :n]

    def simulate(self, trials: int, seed: int, chunk: int) -> Array:
        """The forecast, (1, trials). `chunk` is a multiple of GROUP.

        Raises:
            MemoryError: no room was to be had.
        """
        out = np.empty((1, trials + chunk))
        if self._simulate(trials, seed, chunk, self._low, self._high, *self._book, out):
            raise MemoryError("no room for a chunk of inputs")
        return out[:, :trials]
