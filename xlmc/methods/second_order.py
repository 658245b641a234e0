"""Second-order Taylor: the forecast as a quadratic polynomial of the assumptions about their means.

Its mean is f + ½ Σ Σ ∂²f/∂xᵢ∂xⱼ cov(xᵢ, xⱼ), exactly. Standard deviation and range are those of the polynomial at
65,536 Sobol draws of the assumptions, which costs no evaluation of the workbook and asks for no moment beyond it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from xlmc.methods.answer import Answer, MethodResult, answer_of
from xlmc.methods.expansion import expansion_of
from xlmc.methods.moments import drawn
from xlmc.model import Model

__all__ = ["SecondOrder"]


@dataclass(frozen=True, slots=True)
class SecondOrder:
    """The quadratic polynomial in place of the workbook."""

    key: str = "taylor-2"
    name: str = "Taylor, second order"
    sampling: bool = False
    cannot: str = "does not see filters; misses what the third and higher derivatives do over the ranges"

    def run(self, model: Model, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first and second derivatives."""
        started = time.perf_counter()
        expansion = expansion_of(model, seed, 2)
        moments = expansion.moments
        away = drawn(model, seed) - moments.mean
        answers = {}
        for forecast in model.forecasts:
            found = expansion.forecasts[forecast.name]
            assert found.hessian is not None  # second derivatives were asked for
            value, slope, bend = float(found.value[0]), found.gradient[0], found.hessian[0]
            if np.isnan(bend).any() or np.isnan(slope).any():
                answers[forecast.name] = Answer()
                continue
            mean = value + 0.5 * float(np.sum(bend * moments.covariance))
            polynomial = value + away @ slope + 0.5 * np.einsum("nk,nk->n", away @ bend, away)
            rest = answer_of(polynomial, None, forecast.central)
            answers[forecast.name] = Answer(mean, rest.sd, rest.low, rest.high)
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=expansion.remarks)
