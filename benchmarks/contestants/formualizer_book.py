"""Formualizer: the inputs set a block of cells at once, the forecasts evaluated with what they need and is stale."""

from __future__ import annotations

from importlib.metadata import version
from itertools import cycle, groupby, islice
from time import perf_counter
from typing import Any

from contest import CellPlace, Task

TRIED_FOR = 0.2
"""Seconds for which each way of using it is tried."""


class Formualizer:
    """The fastest way that was found for the book: with or without a dependency history, on one thread or several."""

    fewest = 1

    def __init__(self, task: Task) -> None:
        import formualizer as fz

        self._task = task
        self._runs = _runs(task.inputs)
        self._targets = [tuple(place) for place in task.forecasts]
        modes = fz.WorkbookMode.Ephemeral, fz.WorkbookMode.Interactive
        self._fz, self._ways = fz, [(mode, parallel) for mode in modes for parallel in (False, True)]
        self._book = self._loaded(*self._ways[0])
        self.versions = {"formualizer": version("formualizer")}
        self.note = _note(*self._ways[0])

    def settle(self) -> None:
        """Try every way and stay with the fastest."""
        speeds = {}
        for way in self._ways:
            self._book = self._loaded(*way)
            self._trial(self._task.rows[0])
            speeds[way] = self._speed()
        best = max(speeds, key=lambda way: speeds[way])
        self._book, self.note = self._loaded(*best), _note(*best)

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """See `Contestant`."""
        return [self._trial(row) for row in rows]

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return [self._trial(row) for row in islice(cycle(self._task.rows), trials)]

    def _loaded(self, mode: Any, parallel: bool) -> Any:
        settings = self._fz.EvaluationConfig()
        settings.enable_parallel = parallel
        config = self._fz.WorkbookConfig(mode=mode, eval_config=settings)
        book = self._fz.Workbook.from_path(self._task.path, config=config)
        book.set_changelog_enabled(False)
        return book

    def _speed(self) -> float:
        start, trials = perf_counter(), 0
        while perf_counter() - start < TRIED_FOR:
            self._trial(self._task.rows[trials % len(self._task.rows)])
            trials += 1
        return trials / (perf_counter() - start)

    def _trial(self, row: list[float]) -> list[Any]:
        for sheet, top, column, places in self._runs:
            self._book.set_values_batch(sheet, top, column, [[row[i]] for i in places])
        return list(self._book.evaluate_cells(self._targets))


def prepare(task: Task) -> Formualizer:
    """See `Contestant`."""
    return Formualizer(task)


def _runs(inputs: list[CellPlace]) -> list[tuple[str, int, int, list[int]]]:
    """Inputs that stand under each other, as (sheet, first row, column, which inputs)."""
    numbered = sorted(range(len(inputs)), key=lambda i: (inputs[i].sheet, inputs[i].column, inputs[i].row))
    keyed = [(inputs[i].sheet, inputs[i].column, inputs[i].row - position, i) for position, i in enumerate(numbered)]
    runs = []
    for (sheet, column, _), group in groupby(keyed, key=lambda key: key[:3]):
        places = [i for *_, i in group]
        runs.append((sheet, inputs[places[0]].row, column, places))
    return runs


def _note(mode: Any, parallel: bool) -> str:
    name = str(mode).rpartition(".")[2].lower()
    return f"set_values_batch, evaluate_cells; {name} workbook, {'several threads' if parallel else 'one thread'}"
