"""How much disk a long run takes, said before it starts: accepted trials that do not fit in memory go to files.

How many trials a run will accept is known from its first blocks: they are run, counted and thrown away. That happens
only where the trials would not fit in memory if all were accepted, so that it costs a short run nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.columns import column_store, free_disk
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.number_text import fixed_text, number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.stopping import Stopping
    from xlmc.montecarlo.loop.blocks import ModelRunner
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["DiskNeeded", "disk_needed"]

SAMPLED: Final = 65_536
"""Trials of which the accepted are counted."""

NUMBER: Final = 8
"""Bytes of a number in a column."""


@dataclass(frozen=True)
class DiskNeeded:
    """About how much a run writes.

    Attributes:
        stored: numbers that the run keeps: of each accepted trial its number, the forecasts, and the draws kept.
        sorted: numbers that the statistics write besides: the forecasts in ascending order, and one while it is merged.
        folder: where.
        free: bytes on that disk.
    """

    stored: int
    sorted: int
    folder: Path
    free: int

    @property
    def bytes(self) -> int:
        """The bytes that all these numbers take."""
        return NUMBER * (self.stored + self.sorted)

    def sentence(self) -> str:
        """Say what a person should know before the run starts."""
        return (
            f"This run keeps about {fixed_text(self.stored / 1e6, 0)} million numbers "
            f"and sorts {fixed_text(self.sorted / 1e6, 0)} million: "
            f"about {_gigabytes(self.bytes)} on disk in {self.folder} (free: {_gigabytes(self.free)})."
        )

    def check(self) -> None:
        """Refuse a run that the disk cannot hold.

        Raises:
            SimulationError: it needs more than is free.
        """
        if self.bytes > self.free:
            raise SimulationError(
                f"the run needs about {_gigabytes(self.bytes)} on disk, and {_gigabytes(self.free)} are free",
                where=self.folder,
                hint="Set TMPDIR to a folder on a disk with more space, or ask for fewer trials",
            )


def disk_needed(
    model: CompiledModel,
    stopping: Stopping,
    trials: int,
    block: int,
    most_inputs: int,
    runner: Callable[[], ModelRunner],
    in_memory: int | None = None,
) -> DiskNeeded | None:
    """Predict what a run will write from its first trials' acceptance; None if it stays in memory, or nobody can say.

    Args:
        model: of which it is a run.
        stopping: its goal; only one that counts accepted trials says how many there will be.
        trials: how many it has at most.
        block: trials in a block.
        most_inputs: accepted trials whose draws are kept.
        runner: makes what runs blocks.
        in_memory: see `ColumnStore`.

    Raises:
        SimulationError: there is no folder to write to.
    """
    if stopping.asked and stopping.accepted is None:
        return None
    most = column_store.IN_MEMORY if in_memory is None else in_memory
    rows = min(trials, trials if stopping.accepted is None else stopping.accepted)
    forecasts, inputs = len(model.forecasts), len(model.live)

    def stored(accepted: int) -> int:
        return accepted * (1 + forecasts) + min(accepted, most_inputs) * inputs

    if NUMBER * stored(rows) <= most:
        return None
    if model.filters:
        sampled, run = min(SAMPLED, trials), runner().run
        tasks = (Task(start, min(block, sampled - start), False, False) for start in range(0, sampled, block))
        rows = min(rows, round(sum(run(task).accepted.size for task in tasks) / sampled * trials))
    if NUMBER * stored(rows) <= most:
        return None
    return DiskNeeded(stored(rows), rows * (forecasts + 1), *free_disk())


def _gigabytes(count: int) -> str:
    return f"{number_text(count / 1e9, 2)} GB" if count < 1e10 else f"{fixed_text(count / 1e9, 0)} GB"
