"""A forecast whose mean does not exist, run through xlmc: a ratio whose denominator passes 0."""

from __future__ import annotations

import math
from typing import Any, Final

from stressing.workbook import book_of
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.statistics import farthest_part

__all__ = ["FORECASTS", "QUARTILE", "book", "measure"]

FORECASTS: Final = {
    "ratio": "=across/along",
    "normal": "=across",
    "lognormal": "=EXP(along)",
}
"""The first is Cauchy: median 0, quartiles ±1, no mean; the others are there to see the difference."""

QUARTILE: Final = 1.0


def book() -> CompiledModel:
    """Two standard normal assumptions and the forecasts of them."""
    normal = (0.5, "Normal", ("Mean", 0.0), ("Std dev", 1.0))
    return book_of({"across": normal, "along": normal}, dict(FORECASTS), list(FORECASTS))


def measure(model: CompiledModel, trials: int, seed: int) -> dict[str, Any]:
    """Of one run: mean and upper quartile with their errors, the farthest trial's part, and what xlmc said."""
    run = run_model(model, RunOptions.of(trials=trials, seed=seed, keep_inputs=0))
    messages = " ".join(notice.message for notice in run.notices_of_run if "depend on a single trial" in notice.message)
    result = {}
    for name in FORECASTS:
        mean, quartile = run[name].mean, run[name].percentile(75)
        assert mean.interval is not None
        assert quartile.interval is not None
        result[name] = {
            "mean": mean.value, "error": mean.error, "interval": mean.interval,
            "quartile": quartile.value, "quartile interval": quartile.interval,
            "farthest": farthest_part(run[name].sample), "told": repr(name) in messages,
        }  # fmt: skip
    assert math.isfinite(result["ratio"]["mean"])
    return {"trials": trials, "seed": seed, "found": result}
