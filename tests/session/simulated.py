"""Runs of compiled models, as `Model.simulate` makes them, for tests that look inside."""

from __future__ import annotations

from typing import Any

from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["simulated"]


def simulated(
    model: CompiledModel,
    trials: int | None = None,
    seed: int | None = None,
    *,
    progress: Any = None,
    tell: Any = None,
    **options: Any,
) -> RunResult:
    """Return a run; `options` are those of `Model.simulate`."""
    return run_model(model, RunOptions.of(trials=trials, seed=seed, **options), progress=progress, tell=tell)
