"""The methods of `xlmc simulate` as they stand: independent trials, Latin hypercube, scrambled Sobol, the engines."""

from __future__ import annotations

import time
from dataclasses import dataclass

from xlmc.run.model import Model
from xlmc.run.pilot import PILOT_TRIALS
from xlmc.run.simulate import simulate
from xlmc.studies.methods.answer import Errors, MethodResult, answer_of, extremes_of

__all__ = ["ENGINE_VARIANTS", "LATIN", "MONTE_CARLO", "SAMPLERS", "SOBOL", "Sampled"]


@dataclass(frozen=True, slots=True)
class Sampled:
    """A run of `xlmc simulate`.

    Attributes:
        method: as the setting `Sampling` has it.
        engine: likewise.
    """

    key: str
    name: str
    method: str = "mc"
    engine: str = "numpy"
    cannot: str = ""

    @property
    def errors(self) -> Errors:
        """See `Method`."""
        return "independent" if self.method == "mc" else "consistent"

    def run(self, model: Model, budget: int, seed: int) -> MethodResult:
        """See `Method`.

        Raises:
            SimulationError: there is no such engine here.
        """
        started = time.perf_counter()
        run = simulate(
            model,
            trials=budget,
            seed=seed,
            sampling=self.method,
            engine=self.engine,
            keep_inputs=0,
        )
        answers = {f.name: answer_of(run.forecasts[f.name], None, f.central) for f in model.forecasts}
        learned = PILOT_TRIALS if self.method == "sobol" else 0
        seconds = time.perf_counter() - started
        ends = extremes_of(run.forecasts, run.trial_index, seed, run.plan)
        return MethodResult(seconds, run.trials + learned, answers, run.accepted / run.trials, extremes=ends)


MONTE_CARLO = Sampled("mc", "Monte Carlo")
LATIN = Sampled("lhs", "Latin hypercube", "lhs", cannot="filters take its gain away: what they accept is no marginal")
SOBOL = Sampled("sobol", "Scrambled Sobol", "sobol", cannot="filters take most of its gain away")
SAMPLERS = (MONTE_CARLO, LATIN, SOBOL)

ENGINE_VARIANTS = (
    Sampled("mc/jit", "Monte Carlo, engine jit", engine="jit"),
    Sampled("mc/formulas", "Monte Carlo, engine formulas", engine="formulas"),
)
"""The same trials as `MONTE_CARLO`, computed by something else: the errors are the same, the seconds are not."""
