"""xlmc itself: `model.simulate` whole, with drawing, filters and keeping what was accepted."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from typing import Any

from contest import Task


class Xlmc:
    """A loaded book. A run compiles its program anew; `xlmc/jit` then finds its machine code in this process."""

    note = "model.simulate, one thread"

    def __init__(self, task: Task) -> None:
        import numpy
        import xlmc

        self.engine = task.options["engine"]
        self.jobs = task.options.get("jobs", 1)
        self._model = xlmc.load(task.path)
        self._names = {(a.cell.sheet, a.cell.row, a.cell.column): a.name for a in self._model.assumptions}
        self._task = task
        slow = self.engine == "formulas"
        self.fewest = 16 if slow else self._model.simulate(1, 1, engine=self.engine).block
        self.versions = {"xlmc": xlmc.__version__, "numpy": numpy.__version__} | _versions("numba", "formulas")

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """The filters are asked too: given trials are put in the place of drawn ones."""
        import numpy as np

        names = [self._names[place] for place in self._task.inputs]
        inputs = {_key(name): np.array(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}
        evaluator = self._model.program(self.engine).evaluator(len(rows))
        evaluator.filters(inputs, len(rows))
        columns = evaluator.forecasts(np.arange(len(rows)))
        return [list(row) for row in zip(*(column.as_floats().tolist() for column in columns), strict=True)]

    def settle(self) -> None:
        """Nothing to settle."""

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return self._model.simulate(trials, 1, engine=self.engine, jobs=self.jobs)


def prepare(task: Task) -> Xlmc:
    """See `Contestant`."""
    return Xlmc(task)


def _key(name: str) -> str:
    from xlmc.definitions.model import name_key

    return name_key(name)


def _versions(*packages: str) -> dict[str, str]:
    found = {}
    for package in packages:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found
