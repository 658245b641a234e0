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
    from xlmc.analysis.studies.comparison import compare
    from xlmc.analysis.studies.screening import screen
    from xlmc.analysis.studies.sensitivity import sensitivities
    from xlmc.api import Model, Simulation, load, open_run
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.loop.version import __version__

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
    "ForecastResult": "montecarlo.simulation.simulation",
    "Model": "api",
    "Simulation": "api",
    "__version__": "montecarlo.loop.version",
    "compare": "analysis.studies.comparison",
    "load": "api",
    "open_run": "api",
    "screen": "analysis.studies.screening",
    "sensitivities": "analysis.studies.sensitivity",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `xlmc --help` answers at once."""
    if name not in _HOMES:
        raise AttributeError(f"module 'xlmc' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"xlmc.{_HOMES[name]}"), name)
