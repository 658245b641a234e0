"""xlmc: Monte Carlo simulation of Excel workbooks, without Excel.

>>> import xlmc
>>> model = xlmc.load("examples/intersection.xlsx")
>>> run = model.simulate(trials=20_000, seed=1)
>>> round(run["Chevrolet delta-V"].mean.value)
12
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from xlmc.api import Model, Simulation, load, open_run
    from xlmc.run.forecast_result import ForecastResult
    from xlmc.run.version import __version__
    from xlmc.studies.comparison import compare
    from xlmc.studies.screening import screen
    from xlmc.studies.sensitivity import sensitivities

__all__ = [
    "ForecastResult",
    "Model",
    "Simulation",
    "__version__",
    "compare",
    "load",
    "open_run",
    "screen",
    "sensitivities",
]

_HOMES = {
    "ForecastResult": "run.simulation",
    "Model": "api",
    "Simulation": "api",
    "__version__": "run.version",
    "compare": "studies.comparison",
    "load": "api",
    "open_run": "api",
    "screen": "studies.screening",
    "sensitivities": "studies.sensitivity",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `xlmc --help` answers at once."""
    if name not in _HOMES:
        raise AttributeError(f"module 'xlmc' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"xlmc.{_HOMES[name]}"), name)
