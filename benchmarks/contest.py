"""What passes between `compare.py` and the process of one contestant. Standard library only: peers run it too."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any, NamedTuple, Protocol

__all__ = ["Answer", "CellPlace", "Contestant", "Task", "measured"]

REPEATS = 3
"""Measurements in one process; the fastest counts."""


class CellPlace(NamedTuple):
    """A cell as every contestant can be told it: row and column count from 1."""

    sheet: str
    row: int
    column: int

    def __str__(self) -> str:
        letters, column = "", self.column
        while column:
            column, digit = divmod(column - 1, 26)
            letters = chr(ord("A") + digit) + letters
        return f"{self.sheet}!{letters}{self.row}"


@dataclass(frozen=True)
class Task:
    """A book and what to do with it.

    Attributes:
        book: its name in `books.BOOKS`.
        path: of the file.
        inputs, forecasts: their cells.
        check: inputs of the trials whose forecasts are compared, one row a trial.
        rows: inputs of the trials that are timed where the contestant does not draw its own.
        seconds: how long to measure, about; 0 for answers alone.
        options: of the contestant.
        ladder: trial counts at which to sample for the measure of accuracy, instead of measuring the rate.
        seeds: how many runs at each of them.
    """

    book: str
    path: str
    inputs: list[CellPlace]
    forecasts: list[CellPlace]
    check: list[list[float]]
    rows: list[list[float]]
    seconds: float
    options: dict[str, Any] = field(default_factory=dict)
    ladder: list[int] = field(default_factory=list)
    seeds: int = 0

    @classmethod
    def of(cls, plain: dict[str, Any]) -> Task:
        """From JSON."""
        places = {key: [CellPlace(*place) for place in plain[key]] for key in ("inputs", "forecasts")}
        return cls(**{**plain, **places})


@dataclass
class Answer:
    """What a contestant's process prints.

    Attributes:
        values: forecasts of the check trials, one row a trial; None where the answer is no real number.
        ready: seconds from importing the contestant to the forecasts of the first trial.
        rate: trials per second, None where not measured.
        trials: timed in the fastest measurement.
        versions: of what it runs on.
        note: how it was used.
        samples: trials -> one [seconds, statistics] a seed; see `one_contestant.statistics`.
    """

    values: list[list[float | None]]
    ready: float
    rate: float | None = None
    trials: int = 0
    versions: dict[str, str] = field(default_factory=dict)
    note: str = ""
    samples: dict[str, list[list[Any]]] = field(default_factory=dict)


class Contestant(Protocol):
    """A book made ready.

    Attributes:
        fewest: trials below which a measurement makes no sense, such as a block.
        versions, note: for the record.
    """

    fewest: int
    versions: dict[str, str]
    note: str

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """Forecasts at given inputs."""

    def settle(self) -> None:
        """What may be done once before the measurement, such as finding the best way to be used."""

    def run(self, trials: int) -> object:
        """Run so many trials, as fast as it goes."""


def measured(run: Callable[[int], object], fewest: int, seconds: float) -> tuple[float, int]:
    """Trials per second and how many were timed: the fastest of REPEATS runs that take `seconds` together, about."""
    trials, spent = fewest, _seconds(run, fewest)
    while spent < seconds / REPEATS / 3:
        trials = fewest * max(1, round(trials / fewest * min(10.0, seconds / REPEATS / spent)))
        spent = _seconds(run, trials)
    if spent < 2 * seconds:
        spent = min(spent, *(_seconds(run, trials) for _ in range(REPEATS - 1)))
    return trials / spent, trials


def _seconds(run: Callable[[int], object], trials: int) -> float:
    start = perf_counter()
    run(trials)
    return max(perf_counter() - start, 1e-9)
