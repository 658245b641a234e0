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
    from xlmc.api import Model, Simulation, compare, load, open_run, screen, sensitivities
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

_MODULES = {
    "ForecastResult": "montecarlo.loop.forecast_result",
    "Model": "api",
    "Simulation": "api",
    "__version__": "montecarlo.loop.version",
    "compare": "api",
    "load": "api",
    "open_run": "api",
    "screen": "api",
    "sensitivities": "api",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `xlmc --help` answers at once."""
    if name not in _MODULES:
        raise AttributeError(f"module 'xlmc' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"xlmc.{_MODULES[name]}"), name)
