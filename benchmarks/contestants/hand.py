"""The books written by hand in NumPy, numba or C: drawing, model, filters, keeping what passes.

`options` name the language, the kernel where there are several, the trials in a chunk and, for C, the built library.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from books import march_cells
from contest import Task
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Hand:
    """See `Contestant`. A chunk is what is drawn and evaluated at once.

    Args:
        fewest: chunks below which a measurement makes no sense.

    Attributes:
        sample: (trials, seed) -> forecasts of the accepted trials, (f, m).
    """

    def __init__(
        self,
        evaluate: Callable[[Array], Array],
        simulate: Callable[[int, int], Any],
        chunk: int,
        versions: dict[str, str],
        note: str,
        fewest: int = 8,
    ) -> None:
        self._evaluate, self.sample = evaluate, simulate
        self.fewest, self.note = fewest * chunk, f"{note}, chunks of {chunk:,}"
        self.versions = {"numpy": np.__version__} | versions

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """The check trials are accepted ones, so that every row has its forecasts."""
        result = self._evaluate(np.array(rows).T.copy())
        if result.shape[1] != len(rows):
            return [[None] * result.shape[0] for _ in rows]
        return [list(row) for row in result.T.tolist()]

    def settle(self) -> None:
        """Compile what compiles when it is first called."""
        self.run(self.fewest)

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return self.sample(trials, 1)


def prepare(task: Task) -> Hand:
    """See `Contestant`."""
    make = {"numpy": _numpy, "numba": _numba, "c": _c}[task.options["language"]]
    return make(task.book, task.options)


def _ranges(book: str) -> tuple[Array, Array]:
    import hand_written
    import hand_written_skid

    module = hand_written if book == "case-study" else hand_written_skid
    return module.LOW, module.HIGH


def _chunks(cells: int) -> int:
    """Chunks that take long enough to be measured."""
    return max(1, 8_000 // cells)


def _numpy(book: str, options: dict[str, Any]) -> Hand:
    import hand_written
    import hand_written_march
    import hand_written_plain
    import hand_written_skid

    chunk = options["chunk"]
    if cells := march_cells(book):
        search = options["kernel"]
        return Hand(
            lambda inputs: hand_written_march.buffered(inputs.shape[1], cells, search)(inputs),
            lambda trials, seed: hand_written_march.simulate(trials, seed, chunk, cells, search),
            chunk,
            {},
            f"NumPy, {search}",
            _chunks(cells),
        )
    if book in hand_written_plain.BOOKS:
        plain = hand_written_plain.BOOKS[book]
        return Hand(
            lambda inputs: plain.kernel(inputs.shape[1])(inputs),
            lambda trials, seed: plain.simulate(trials, seed, chunk),
            chunk,
            {},
            "NumPy",
        )
    if book == "skid":
        skid, draws_kept = options["kernel"], options.get("draws_kept", False)
        return Hand(
            hand_written_skid.KERNELS[skid][0],
            lambda trials, seed: hand_written_skid.simulate(trials, seed, chunk, skid, draws_kept).speeds,
            chunk,
            {},
            f"NumPy, {skid}",
        )
    kernel = options["kernel"]
    return Hand(
        lambda inputs: hand_written.KERNELS[kernel](inputs.shape[1])(inputs),
        lambda trials, seed: hand_written.simulate(trials, seed, chunk, kernel)[1],
        chunk,
        {},
        f"NumPy, {kernel}",
    )


def _numba(book: str, options: dict[str, Any]) -> Hand:
    import hand_numba
    import numba

    case = book == "case-study"
    kernel = hand_numba.CASE_KERNELS[options["kernel"]]() if case else hand_numba.skid_kernel()
    low, high = _ranges(book)
    forecasts = 4 if case else 1

    def evaluate(inputs: Array) -> Array:
        n = inputs.shape[1]
        out = np.empty((forecasts, n))
        return out[:, : kernel(inputs, n, np.empty((6, n)), out, 0)]

    def simulate(trials: int, seed: int) -> Array:
        return hand_numba.simulate(kernel, forecasts, low, high, trials, seed, options["chunk"])

    note = f"numba, {options['kernel']} sine and cosine" if case else "numba"
    return Hand(evaluate, simulate, options["chunk"], {"numba": numba.__version__}, note)


def _c(book: str, options: dict[str, Any]) -> Hand:
    import hand_c

    chunk = options["chunk"]
    if cells := march_cells(book):
        march = hand_c.March(Path(options["library"]), cells, options["kernel"])
        flags = {"flags": " ".join((*hand_c.FLAGS, *hand_c.FINITE))}
        note = f"C, {options['kernel']}"
        return Hand(
            march.evaluate,
            lambda trials, seed: march.simulate(trials, seed, chunk),
            chunk,
            flags,
            note,
            _chunks(cells),
        )
    low, high = _ranges(book)
    case = book == "case-study"
    hand = hand_c.Hand(Path(options["library"]), "case" if case else "skid", low, high, 4 if case else 1)
    flags = {"flags": " ".join(hand_c.FLAGS)}
    return Hand(hand.evaluate, lambda trials, seed: hand.simulate(trials, seed, chunk), chunk, flags, "C")
