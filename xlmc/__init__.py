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
    from xlmc.api import (
        Model,
        Simulation,
        check,
        compare,
        convert,
        decide,
        fit,
        load,
        methods,
        model,
        open_run,
        optimise,
        replay,
        screen,
        seek,
        sensitivities,
        stability,
        uncertainty,
        verify,
    )
    from xlmc.excel.own_functions import scalar
    from xlmc.montecarlo.definitions.distribution import (
        Beta,
        BetaPERT,
        DiscreteUniform,
        Distribution,
        Exponential,
        Gamma,
        Lognormal,
        Normal,
        Poisson,
        Trapezoid,
        Triangular,
        Uniform,
        Weibull,
        YesNo,
    )
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.loop.version import __version__
    from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "Beta",
    "BetaPERT",
    "DiscreteUniform",
    "Distribution",
    "Estimate",
    "Exponential",
    "ForecastResult",
    "Gamma",
    "Lognormal",
    "Model",
    "Normal",
    "Poisson",
    "Simulation",
    "Trapezoid",
    "Triangular",
    "Uniform",
    "Weibull",
    "YesNo",
    "__version__",
    "check",
    "compare",
    "convert",
    "decide",
    "fit",
    "load",
    "methods",
    "model",
    "open_run",
    "optimise",
    "replay",
    "scalar",
    "screen",
    "seek",
    "sensitivities",
    "stability",
    "stress",
    "uncertainty",
    "verify",
]

_MODULES = {
    "Beta": "montecarlo.definitions.distribution",
    "BetaPERT": "montecarlo.definitions.distribution",
    "DiscreteUniform": "montecarlo.definitions.distribution",
    "Distribution": "montecarlo.definitions.distribution",
    "Estimate": "montecarlo.statistics",
    "Exponential": "montecarlo.definitions.distribution",
    "ForecastResult": "montecarlo.loop.forecast_result",
    "Gamma": "montecarlo.definitions.distribution",
    "Lognormal": "montecarlo.definitions.distribution",
    "Model": "api",
    "Normal": "montecarlo.definitions.distribution",
    "Poisson": "montecarlo.definitions.distribution",
    "Simulation": "api",
    "Trapezoid": "montecarlo.definitions.distribution",
    "Triangular": "montecarlo.definitions.distribution",
    "Uniform": "montecarlo.definitions.distribution",
    "Weibull": "montecarlo.definitions.distribution",
    "YesNo": "montecarlo.definitions.distribution",
    "__version__": "montecarlo.loop.version",
    "check": "api",
    "compare": "api",
    "convert": "api",
    "decide": "api",
    "fit": "api",
    "load": "api",
    "methods": "api",
    "model": "api",
    "open_run": "api",
    "optimise": "api",
    "replay": "api",
    "scalar": "excel.own_functions",
    "screen": "api",
    "seek": "api",
    "sensitivities": "api",
    "stability": "api",
    "stress": "api",
    "uncertainty": "api",
    "verify": "api",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `xlmc --help` answers at once."""
    if name not in _MODULES:
        raise AttributeError(f"module 'xlmc' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"xlmc.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names, which a notebook completes."""
    return list(__all__)
