"""Whole-number forecasts: ties in percentiles, in the mode and in shares."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from scipy import stats

from stressing.workbook import book_of
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.statistics import mode

__all__ = ["LAWS", "book", "measure"]

LAWS: Final = {
    "Yes-No": (("Probability", 0.4), stats.bernoulli(0.4)),
    "Poisson": (("Rate", 3.5), stats.poisson(3.5)),
    "Geometric": (("Probability", 0.3), stats.geom(0.3)),
    "Binomial": (("Probability", 0.3), ("Trials", 10), stats.binom(10, 0.3)),
}
"""Family -> its parameters, and SciPy's law of it."""

PERCENTS: Final = (10, 24.5, 50, 75.5, 90)


def book(name: str) -> CompiledModel:
    """The assumption as forecast."""
    *parameters, _ = LAWS[name]
    return book_of({"x": (1, name, *parameters)}, {"y": "=x"}, ["y"])


def measure(name: str, trials: int, runs: int, first: int = 0) -> dict[str, Any]:
    """How often percentiles' intervals hold the truth, and how often the mode is the most probable value."""
    model, law = book(name), LAWS[name][-1]
    truth = [float(law.ppf(percent / 100)) for percent in PERCENTS]
    likely = float(np.argmax(law.pmf(np.arange(100))))
    held, modes = np.zeros(len(PERCENTS), int), 0
    for seed in range(first, first + runs):
        result = run_model(model, RunOptions.of(trials=trials, seed=seed, keep_inputs=0))["y"]
        for place, (percent, true) in enumerate(zip(PERCENTS, truth, strict=True)):
            interval = result.percentile(percent).interval
            held[place] += interval is not None and interval[0] <= true <= interval[1]
        modes += mode(result.sample).value == likely
    return {"family": name, "trials": trials, "runs": runs, "percents": PERCENTS, "held": held.tolist(), "modes": modes}
