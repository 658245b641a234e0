"""The methods of `xlmc simulate` as they stand: independent trials, Latin hypercube, scrambled Sobol, the engines."""

from __future__ import annotations

import time
from dataclasses import dataclass

from xlmc.analysis.studies.methods.answer import Errors, MethodResult, answer_of, extremes_of
from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.loop.sobol_order import PILOT_TRIALS
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.simulation.simulate import simulate

__all__ = ["ENGINE_VARIANTS", "MONTE_CARLO", "SAMPLERS", "Sampled"]


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
        return "independent" if METHODS[self.method].independent else "consistent"

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
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
        learned = PILOT_TRIALS if METHODS[self.method].ordered else 0
        seconds = time.perf_counter() - started
        ends = extremes_of(run.forecasts, run.trial_index, seed, run.plan)
        return MethodResult(seconds, run.trials + learned, answers, run.accepted / run.trials, extremes=ends)


SAMPLERS = tuple(
    Sampled(row.key, row.name[:1].upper() + row.name[1:], row.key, cannot=row.limit)
    for row in METHODS.values()
    if row.compared
)

MONTE_CARLO = SAMPLERS[0]

ENGINE_VARIANTS = tuple(
    Sampled(f"mc/{engine}", f"Monte Carlo, engine {engine}", engine=engine)
    for engine in ENGINES
    if engine != MONTE_CARLO.engine
)
"""The same trials as `MONTE_CARLO`, computed by something else: the errors are the same, the seconds are not."""
