"""xlmc itself: `model.simulate` whole, with drawing, filters and keeping what was accepted."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version
from typing import Any

from contest import Task


class Xlmc:
    """A loaded book. Every run makes its program anew, which is in the time; compiling to machine code is not."""

    def __init__(self, task: Task) -> None:
        import numpy

        import xlmc
        from xlmc.montecarlo.model.loading import load
        from xlmc.montecarlo.simulation.simulate import BLOCK

        self.engine = task.options["engine"]
        self._keeps = {"keep_inputs": None} if task.options.get("draws_kept") else {}
        compiled = load(task.path)
        self._model = xlmc.Model(compiled)
        self._names = {(a.cell.sheet, a.cell.row, a.cell.column): a.name for a in self._model.assumptions}
        self._task = task
        self.note = "model.simulate, one thread"
        self._program = compiled.program(self.engine)
        self.fewest = min(BLOCK, self._program.largest_block)
        self.versions = {"xlmc": xlmc.__version__, "numpy": numpy.__version__} | _versions("numba", "formulas")

    def answers(self, rows: list[list[float]]) -> list[list[Any]]:
        """The filters are asked too: given trials are put in the place of drawn ones."""
        import numpy as np

        names = [self._names[place] for place in self._task.inputs]
        inputs = {name: np.array(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}
        evaluator = self._program.evaluator(len(rows))
        evaluator.filters(inputs, len(rows))
        columns = evaluator.forecasts(np.arange(len(rows)))
        return [list(row) for row in zip(*(column.as_floats().tolist() for column in columns), strict=True)]

    def settle(self) -> None:
        """Compile to machine code, if the engine does that."""
        if self.engine == "jit":
            self.run(self.fewest)

    def run(self, trials: int) -> object:
        """See `Contestant`."""
        return self._model.simulate(trials, 1, engine=self.engine, **self._keeps)

    def sample(self, trials: int, seed: int) -> Any:
        """Forecasts of the accepted trials, one array (m,) a forecast."""
        run = self._model.simulate(trials, seed, engine=self.engine)
        return [run[forecast.name].values for forecast in self._model.forecasts]


def prepare(task: Task) -> Xlmc:
    """See `Contestant`."""
    return Xlmc(task)


def _versions(*packages: str) -> dict[str, str]:
    result = {}
    for package in packages:
        try:
            result[package] = version(package)
        except PackageNotFoundError:
            continue
    return result
