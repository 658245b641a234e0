"""What every engine does: evaluate blocks of trials, filters first, forecasts on the survivors."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.node_values import corner
from xlmc.engine.graph.nodes import Target
from xlmc.excel.functions.values import BLANK, ERROR, TEXT, Bools, Codes, Floats, Objects, Value

__all__ = [
    "BLANK_RESULT",
    "DISCARDED_FIRST",
    "TEXT_RESULT",
    "UNDECIDED_RESULT",
    "AcceptedBlock",
    "BlockMemory",
    "BlockRunner",
    "Column",
    "Compilable",
    "Evaluator",
    "Linear",
    "Program",
    "RunsWholeBlocks",
    "Target",
    "UniformStream",
    "column_of",
]

TEXT_RESULT: Final = 200
BLANK_RESULT: Final = 201
"""Codes, beside those of `ErrorCode`, of a result that is no number."""

UNDECIDED_RESULT: Final = 202
"""Code of a forecast that a filter of its own cannot decide on, because the filter's cell is an error."""

DISCARDED_FIRST: Final = 203
"""Code of a forecast that its own first filter discards; the second's is the next, and so on."""


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """One target over a block: `(n,)` numbers (logicals as 1 and 0) and codes, 0 where the number counts.

    `codes` is None when every trial counts. `texts` are the texts of trials whose code is that of a text, `(n,)`; None
    where there is none.
    """

    values: Floats | Bools
    codes: Codes | None = None
    texts: Objects | None = None

    def as_floats(self, *, copy: bool = True) -> Floats:
        """Return the numbers, `(n,)`, with `copy` in memory of their own; NaN where the trial does not count."""
        floats = self.values.astype(np.float64, copy=copy)
        return floats if self.codes is None else np.where(self.codes > 0, np.nan, floats)

    def at(self, trials: NDArray[np.intp] | Bools) -> Column:
        """Return some of the trials, by number or by a mask."""
        codes = None if self.codes is None else self.codes[trials]
        codes = codes if codes is not None and codes.any() else None
        return Column(self.values[trials], codes, None if self.texts is None or codes is None else self.texts[trials])


class Evaluator(Protocol):
    """Evaluates one block after another; it may reuse its memory, so take what you keep before the next block."""

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """Evaluate the filters of `n` trials, `(n,)` each. An input's errors are NaNs."""

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """Evaluate the forecasts of the surviving trials of the block that `filters` saw, `(m,)` each."""


@dataclass(frozen=True, slots=True, eq=False)
class AcceptedBlock:
    """A block without errors, evaluated and filtered. The next block overwrites its columns.

    Attributes:
        accepted: `(m,)` the trials that no filter rejects, as the run counts them.
        draws: assumption -> `(m,)`; empty when not asked for.
        forecasts: one a forecast, `(m,)`.
        together: `(f, f)` trials that both of two filters reject.
        only: `(f,)` trials that one filter alone rejects.
        drawn: assumption -> its draws in the whole block; None if native code made them.
        discards: per forecast, number of one of its own filters -> accepted trials that this discards; empty where no
            forecast has filters of its own.
    """

    accepted: NDArray[np.int64]
    draws: dict[str, Floats]
    forecasts: list[Floats]
    together: NDArray[np.int64]
    only: NDArray[np.int64]
    drawn: Mapping[str, Floats] | None = None
    discards: Sequence[Counter[int]] = ()


@dataclass(frozen=True, slots=True, eq=False)
class BlockMemory:
    """Memory that a block's columns may be written to, `(block,)` each.

    Attributes:
        accepted: for the accepted trials, int64; None where they are not kept.
        draws: assumption -> doubles; empty where no draws are kept.
        forecasts: doubles, one for each of the first forecasts, or for all.
    """

    accepted: NDArray[np.int64] | None
    draws: Mapping[str, Floats]
    forecasts: Sequence[Floats]


class UniformStream(Protocol):
    """A random stream whose uniforms an engine can draw itself."""

    @property
    def beginning(self) -> tuple[int, int]:
        """The 128-bit state of a PCG64DXSM before the first trial, and its increment."""


@dataclass(frozen=True, slots=True)
class Linear:
    """Draws that are offset + factor·uniform, all of them, in the order of their stages."""

    streams: Sequence[UniformStream]
    maps: Sequence[tuple[float, float]]


class BlockRunner(Protocol):
    """Runs a block at once."""

    def __call__(
        self, start: int, trials: int, inputs: bool, block_memory: Callable[[], BlockMemory] | None
    ) -> AcceptedBlock | None:
        """Run the first trials of a block; None if one needs the careful path, or one of those behind them.

        Args:
            start: the block's first trial.
            trials: how many count.
            inputs: whether to keep draws.
            block_memory: gives memory for the block's columns; it is written to if all trials of a whole block stay.
        """


@runtime_checkable
class RunsWholeBlocks(Protocol):
    """An evaluator that can also run a block at once, with less memory, fewer calls and fewer locks."""

    def block_runner(
        self, names: Sequence[str], draw: Callable[[int], Mapping[str, Floats]], linear: Linear | None
    ) -> BlockRunner | None:
        """Return what runs a block at once and gives the same numbers; None if the model does not allow it.

        Args:
            names: the assumptions that are drawn.
            draw: makes the draws of a block from its first trial on, `(block,)` each.
            linear: another way to make them, if each is an offset plus a factor times a uniform; None if not.
        """


@runtime_checkable
class Compilable(Protocol):
    """A body of a function that native code may replace."""

    def compiled(self) -> Callable[..., Value] | None:
        """Return what gives the same values, to the last bit, by native code; None if there is no such code."""


class Program(Protocol):
    """A compiled workbook. Evaluators are for one thread each.

    `Engine.load` says what a program is made of: a `Lowering`, of which `dag` holds the nodes and `target` gives the
    node of a `Target`; the targets of the filters and the forecasts; the inputs whose draws may be errors.

    Attributes:
        largest_block: blocks of more trials are no faster.
    """

    largest_block: int

    def evaluator(self, block: int) -> Evaluator:
        """Make an evaluator for blocks of up to `block` trials."""


def column_of(value: Value, n: int) -> Column:
    """Turn a value into the numbers of `n` trials; an array gives its upper left value."""
    value = corner(value)
    codes = np.where(value.kinds >= ERROR, value.kinds - np.uint8(ERROR), np.uint8(0)).astype(np.uint8)
    codes = np.where(value.kinds == TEXT, np.uint8(TEXT_RESULT), codes)
    codes = np.where(value.kinds == BLANK, np.uint8(BLANK_RESULT), codes)
    values = np.broadcast_to(value.numbers, (n,))
    texts = None if value.texts is None else np.broadcast_to(value.texts, (n,))
    return Column(values, np.broadcast_to(codes, (n,)) if codes.any() else None, texts)
