"""The differential methods: worst case, and Taylor's expansion of first and second order about the means.

- Worst case: f ± Σ|∂f/∂x|·Δx, every assumption at its worst end at once.
- First order, root sum of squares: σ² = Σ Σ ∂f/∂xᵢ ∂f/∂xⱼ cov(xᵢ, xⱼ).
- Second order: the forecast as a quadratic polynomial of the assumptions. Its mean is
  f + ½ Σ Σ ∂²f/∂xᵢ∂xⱼ cov(xᵢ, xⱼ), exactly. Standard deviation and range are those of the polynomial at 65,536 Sobol
  draws of the assumptions, which costs no evaluation of the workbook and asks for no moment beyond it.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import Answer, Errors, MethodResult, answer_of
from xlmc.analysis.studies.methods.expansion import draw_assumptions, expansion_of
from xlmc.analysis.studies.methods.points import box_of
from xlmc.engine.passes.derivatives import Derivative
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["FirstOrder", "SecondOrder", "WorstCase"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class WorstCase:
    """Bounds of the forecasts made straight. Δx reaches from the mean to either end, which may differ."""

    key: str = "worst-case"
    name: str = "Differential, worst case"
    errors: Errors = "once"
    cannot: str = (
        "gives two ends and no likelihood in between, does not see filters, and takes every curve for straight"
    )

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first derivatives."""
        started = time.perf_counter()
        expansion, box = expansion_of(model, seed, 1), box_of(model, seed)
        answers = {}
        for name, derivative in expansion.forecasts.items():
            to_low, to_high = (derivative.gradient[0] * (end - expansion.moments.mean) for end in (box.low, box.high))
            value = float(derivative.value[0])
            down, up = np.minimum(to_low, to_high).sum(), np.maximum(to_low, to_high).sum()
            answers[name] = Answer(least=value + float(down), most=value + float(up))
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=(*expansion.remarks, *box.remarks))


@dataclass(frozen=True, slots=True)
class FirstOrder:
    """The law of propagation of uncertainty (JCGM 100, 5.1 and 5.2); the range is that of a normal distribution."""

    key: str = "taylor-1"
    name: str = "Taylor, first order"
    errors: Errors = "once"
    cannot: str = "does not see filters; takes every curve for straight and every answer for normally distributed"

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first derivatives."""
        from scipy.special import ndtri

        started = time.perf_counter()
        expansion = expansion_of(model, seed, 1)
        answers = {}
        for forecast in model.forecasts:
            derivative = expansion.forecasts[forecast.name]
            mean, slope = float(derivative.value[0]), derivative.gradient[0]
            sd = float(np.sqrt(slope @ expansion.moments.covariance @ slope))
            reach = sd * float(ndtri((1.0 + forecast.central) / 2.0))
            answers[forecast.name] = Answer(mean, sd, mean - reach, mean + reach)
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=expansion.remarks)


@dataclass(frozen=True, slots=True)
class SecondOrder:
    """The quadratic polynomial instead of the workbook."""

    key: str = "taylor-2"
    name: str = "Taylor, second order"
    errors: Errors = "once"
    cannot: str = "does not see filters; misses what the third and higher derivatives do over the ranges"

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first and second derivatives."""
        started = time.perf_counter()
        expansion = expansion_of(model, seed, 2)
        moments = expansion.moments
        result = {name: each for name, each in expansion.forecasts.items() if not np.isnan(_bend(each)).any()}
        values: dict[str, list[Floats]] = {name: [] for name in result}
        for block in draw_assumptions(model, seed):
            for name, each in result.items():
                values[name].append(_polynomial(each, block - moments.mean))
        answers = {forecast.name: Answer() for forecast in model.forecasts}
        for forecast in model.forecasts:
            if forecast.name in result:
                each = result[forecast.name]
                mean = float(each.value[0]) + 0.5 * float(np.sum(_bend(each) * moments.covariance))
                rest = answer_of(np.concatenate(values[forecast.name]), None, forecast.central)
                answers[forecast.name] = Answer(mean, rest.sd, rest.low, rest.high)
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=expansion.remarks)


def _polynomial(derivative: Derivative, away: Floats) -> Floats:
    """Return the quadratic polynomial at points `(n, k)` counted from the means, `(n,)`; most of many assumptions have
    no part in it.
    """
    slope, bend = derivative.gradient[0], _bend(derivative)
    reaching = np.flatnonzero((slope != 0.0) | (bend != 0.0).any(axis=0))
    near = np.ascontiguousarray(away[:, reaching])
    bent = 0.5 * np.einsum("nk,nk->n", near @ bend[np.ix_(reaching, reaching)], near)
    return np.asarray(float(derivative.value[0]) + near @ slope[reaching] + bent)


def _bend(derivative: Derivative) -> Floats:
    assert derivative.hessian is not None  # second derivatives were asked for
    return np.asarray(derivative.hessian[0])
