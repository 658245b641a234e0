"""What the search for lost digits finds, in the order of how much it matters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

from xlmc.analysis.studies.shown import Shown
from xlmc.excel.address import Cell
from xlmc.montecarlo.number_text import number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["CellDigits", "Finding", "Level", "Stability", "Where"]


class Level(IntEnum):
    """How much a finding matters; lower is worse."""

    WRONG = 0
    """The numbers must not be used as they are."""
    DOUBTFUL = 1
    """Right in what was looked at, but digits are lost that another form would keep, or a statistic is in doubt."""
    NOTE = 2
    """Good to know."""


@dataclass(frozen=True, slots=True)
class Where:
    """The assumption in whose range it happens.

    Attributes:
        name: of the assumption.
        low, high: from where to where.
        units: its units.
    """

    name: str
    low: float
    high: float
    units: str = ""

    def __str__(self) -> str:
        units = f" {self.units}" if self.units else ""
        if self.low == self.high:
            return f"{self.name} = {number_text(self.low)}{units}"
        return f"{self.name} from {number_text(self.low)} to {number_text(self.high)}{units}"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong, doubtful or worth knowing.

    Attributes:
        level: how much it matters.
        kind: a word for it: `quadrant`, `division`, `cancellation`, `rounding`, `edge`, `jump`, `tail`, `filter`, …
        cell: where.
        name: what the cell is called: a forecast, a filter, a defined name; else empty.
        formula: its formula, with `=`.
        what: what was found, in one sentence.
        effect: how wrong the number gets, in one sentence.
        where: the ranges that provoke it; empty where it happens everywhere, or it is of a whole run.
        instead: a formula without the defect, with `=`; None if none is known.
        size: findings of one level are ranked by it: the error as a share of what it concerns, or how many times it is
            larger than it need be.
    """

    level: Level
    kind: str
    cell: Cell
    name: str
    formula: str
    what: str
    effect: str
    where: tuple[Where, ...] = ()
    instead: str | None = None
    size: float = 0.0


@dataclass(frozen=True, slots=True)
class CellDigits:
    """What a needed cell amplifies and loses.

    Attributes:
        cell: which.
        name: what it is called.
        amplification: its relative change per relative change of the assumptions, all together: the median of the
            trials.
        most: the same in the worst of 100 trials.
        through: the assumption that brings most of it.
        rounding: the largest error by rounding met, relative to the width of the cell's central range.
        excess: by how much it is larger than the error that rounding the assumptions alone would bring.
        checked: whether some trials were computed again with 50 digits, all the way.
    """

    cell: Cell
    name: str
    amplification: float
    most: float
    through: str
    rounding: float
    excess: float
    checked: bool


@dataclass(frozen=True, eq=False, repr=False)
class Stability(Shown):
    """All that was found in a workbook.

    Attributes:
        run: the run that was looked at.
        findings: the worst first.
        cells: every needed formula cell that holds numbers.
        unchecked: cells with functions that were not computed again with 50 digits, and these functions.
        points: how many trials were looked at, the base case and the ends of the ranges among them.
        recomputed: how many of these were computed again with 50 digits.
        ended: why it ended before everything was looked for; empty if it did not.
        not_looked_for: what it then had not looked for.
    """

    run: RunResult
    findings: tuple[Finding, ...]
    cells: tuple[CellDigits, ...]
    unchecked: tuple[tuple[Cell, Sequence[str]], ...]
    points: int
    recomputed: int
    ended: str = ""
    not_looked_for: tuple[str, ...] = ()

    @property
    def wrong(self) -> bool:
        """Whether numbers must not be used as they are."""
        return any(finding.level is Level.WRONG for finding in self.findings)
