"""The differential method, root sum of squares: first-order Taylor, σ² = Σ Σ ∂f/∂xᵢ ∂f/∂xⱼ cov(xᵢ, xⱼ)."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from xlmc.run.model import Model
from xlmc.studies.methods.answer import Answer, Errors, MethodResult
from xlmc.studies.methods.expansion import expansion_of

__all__ = ["FirstOrder"]


@dataclass(frozen=True, slots=True)
class FirstOrder:
    """The law of propagation of uncertainty (JCGM 100, 5.1 and 5.2); the range is that of a normal distribution."""

    key: str = "taylor-1"
    name: str = "Taylor, first order"
    errors: Errors = "once"
    cannot: str = "does not see filters; takes every curve for straight and every answer for normally distributed"

    def run(self, model: Model, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first derivatives."""
        from scipy.special import ndtri

        started = time.perf_counter()
        expansion = expansion_of(model, seed, 1)
        answers = {}
        for forecast in model.forecasts:
            found = expansion.forecasts[forecast.name]
            mean, slope = float(found.value[0]), found.gradient[0]
            sd = float(np.sqrt(slope @ expansion.moments.covariance @ slope))
            reach = sd * float(ndtri((1.0 + forecast.central) / 2.0))
            answers[forecast.name] = Answer(mean, sd, mean - reach, mean + reach)
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=expansion.remarks)
