"""The `formulas` package by its own means: `ExcelModel().loads(…).finish().compile(…)`, called once a trial."""

from __future__ import annotations

from importlib.metadata import version
from itertools import cycle, islice
from pathlib import Path
from typing import Any

from contest import CellPlace, Task


class FormulasModel:
    """The compiled callable. It also takes no arrays of trials: a cell is a 2-d array to it."""

    fewest = 1
    note = "ExcelModel().loads().finish().compile(); the callable is called once a trial"

    def __init__(self, task: Task) -> None:
        import formulas

        book = Path(task.path).name

        def name(place: CellPlace) -> str:
            sheet, _, cell = str(place).rpartition("!")
            return f"'[{book}]{sheet.upper()}'!{cell}"

        model = formulas.ExcelModel().loads(task.path).finish()
        outputs = [name(place) for place in task.forecasts]
        self._call = model.compile(inputs=[name(place) for place in task.inputs], outputs=outputs)
        self._single = len(outputs) == 1
        self._rows = task.rows
        self.versions = {"formulas": version("formulas")}

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """See `Contestant`."""
        return [self._trial(row) for row in rows]

    def settle(self) -> None:
        """Nothing to settle."""

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return [self._trial(row) for row in islice(cycle(self._rows), trials)]

    def _trial(self, row: list[float]) -> list[Any]:
        result = self._call(*row)
        return [_value(ranges) for ranges in ([result] if self._single else result)]


def prepare(task: Task) -> FormulasModel:
    """See `Contestant`."""
    return FormulasModel(task)


def _value(ranges: Any) -> Any:
    value = ranges.value[0, 0]
    return value if isinstance(value, str) else float(value)
