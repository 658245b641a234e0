"""What the sections of a run are made from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.results.record import Record
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Material"]


@dataclass(frozen=True, slots=True)
class Material:
    """What sections are made from.

    Attributes:
        simulation: the finished run.
        record: its record.
        forecasts: the names of those that the report is about, in the order of the workbook.
    """

    simulation: RunResult
    record: Record
    forecasts: tuple[str, ...]
