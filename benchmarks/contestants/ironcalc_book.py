"""IronCalc: the inputs set one by one, the workbook evaluated, the forecasts read."""

from __future__ import annotations

from importlib.metadata import version
from itertools import cycle, islice
from typing import Any

from contest import CellPlace, Task


class IronCalc:
    """The raw `Model` API, which keeps no history. `evaluate` computes the whole workbook."""

    fewest = 1
    note = "Model.update_cell_with_number, Model.evaluate, Model.get_cell_value"

    def __init__(self, task: Task) -> None:
        import ironcalc

        self._model = ironcalc.load_from_xlsx(task.path)
        sheets = [sheet["name"] for sheet in self._model.get_worksheets_properties()]

        def place(cell: CellPlace) -> tuple[int, int, int]:
            return sheets.index(cell.sheet), cell.row, cell.column

        self._inputs = [place(cell) for cell in task.inputs]
        self._forecasts = [place(cell) for cell in task.forecasts]
        self._rows = task.rows
        self.versions = {"ironcalc": version("ironcalc")}

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """See `Contestant`."""
        return [self._trial(row) for row in rows]

    def settle(self) -> None:
        """Nothing to settle."""

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return [self._trial(row) for row in islice(cycle(self._rows), trials)]

    def _trial(self, row: list[float]) -> list[Any]:
        for place, value in zip(self._inputs, row, strict=True):
            self._model.update_cell_with_number(*place, value)
        self._model.evaluate()
        return [self._model.get_cell_value(*place) for place in self._forecasts]


def prepare(task: Task) -> IronCalc:
    """See `Contestant`."""
    return IronCalc(task)
