"""Sobol's indices of a model by pick and freeze: where they are right to give, and each with its standard error.

Two independent sets of trials, A and B; ABᵢ is A with assumption i taken from B. With answers a, b and c of these, each
`(n,)`, and v the variance of a and b,

    first order   Sᵢ = 1 − mean((b − c)²) / 2v        (Jansen 1999)
    total         Tᵢ = mean((a − c)²) / 2v            (Jansen 1999, Saltelli et al. 2010)

Sᵢ is the share of the variance that assumption i explains alone, Tᵢ what would be left on average if all others were
known. They hold for independent assumptions and trials that no filter rejects.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.montecarlo.loop.blocks import portions
from xlmc.montecarlo.statistics import Estimate

if TYPE_CHECKING:
    from xlmc.engine.engine import Evaluator
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["SobolRun", "pick_and_freeze", "sobol_indices", "why_not"]

_MOST_PAIRS: Final = 1 << 13
_LEAST_PAIRS: Final = 1 << 8
_MOST_NUMBERS: Final = 1 << 23
"""Draws of the trials that are evaluated together: of few pairs, those of several assumptions are."""
_LEAST_EVALUATED, _MOST_EVALUATED = 1 << 15, 1 << 17
_INSTEAD: Final = "What each assumption explains is given instead"
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SobolRun:
    """Sobol indices of a model.

    Attributes:
        pairs: of independent trials.
        indices: assumption -> number of a forecast, in the order of the workbook -> (first order, total).
    """

    pairs: int
    indices: Mapping[str, Mapping[int, tuple[Estimate, Estimate]]]


def why_not(simulation: RunResult) -> str:
    """Why Sobol indices would mislead; empty where they would not."""
    model = simulation.model
    if simulation.accepted < simulation.trials:
        return (
            "Sobol indices are not given: the filters reject trials, and among the accepted ones the assumptions are "
            f"no longer independent, so that the variance cannot be divided among them. {_INSTEAD}"
        )
    if model.groups:
        return (
            "Sobol indices are not given: assumptions are correlated, so that the variance cannot be divided among "
            f"them. {_INSTEAD}"
        )
    if len(model.needed.stages) > 1:
        return (
            "Sobol indices are not given: parameters of assumptions depend on other assumptions, so that these are not "
            f"independent. {_INSTEAD}"
        )
    return ""


def pick_and_freeze(
    model: CompiledModel,
    assumptions: Mapping[str, Sequence[int]],
    trials: int,
    seed: int,
    progress: Callable[[float], None] = lambda share: None,
) -> SobolRun:
    """Return the indices of a model without correlations, whatever its filters; of very many assumptions, of the first
    ones.

    Args:
        model: to evaluate.
        assumptions: name of a live one -> numbers of the forecasts for which its indices are wanted.
        trials: of the run; no more than half as many are evaluated, but some at least.
        seed: of the run. The trials are its first ones by Monte Carlo, and those that follow them.
        progress: takes the share that is done.
    """
    evaluations = max(_LEAST_EVALUATED, min(_MOST_EVALUATED, trials // 2))
    chosen = list(assumptions)[: max(evaluations // _LEAST_PAIRS - 2, 1)]
    pairs = min(_MOST_PAIRS, evaluations // (len(chosen) + 2))
    program = model.program("numpy")
    fitting = min(program.largest_block, _MOST_NUMBERS // max(len(model.draws), 1))
    together = max(min(fitting // pairs, len(chosen)), 1)
    block = min(together * pairs, program.largest_block)
    first, second = (_draws(model, seed, start, pairs, min(pairs, block)) for start in (0, pairs))
    evaluator = program.evaluator(block)
    numbers = sorted({number for name in chosen for number in assumptions[name]})
    a, b = (_answers(evaluator, draws, numbers, pairs, block) for draws in (first, second))
    mixed = {name: np.tile(values, together) for name, values in first.items()}
    result: dict[str, dict[int, tuple[Estimate, Estimate]]] = {}
    for start in range(0, len(chosen), together):
        rows = {name: slice(k * pairs, (k + 1) * pairs) for k, name in enumerate(chosen[start : start + together])}
        for name, here in rows.items():
            mixed[name][here] = second[name]
        c = _answers(evaluator, mixed, numbers, len(rows) * pairs, block)
        for name, here in rows.items():
            mixed[name][here] = first[name]
            result[name] = {
                number: sobol_indices(a[number], b[number], c[number][here]) for number in assumptions[name]
            }
        progress(len(result) / len(chosen))
    return SobolRun(pairs, result)


def _draws(model: CompiledModel, seed: int, start: int, count: int, block: int) -> dict[str, Floats]:
    """`(count,)` draws of independent trials from `start` on."""
    sampler = model.sampler(seed, block)
    drawn = {name: np.empty(count) for name in model.draws}
    for first in range(0, count, block):
        part = sampler.draw(start + first)
        for name, values in drawn.items():
            values[first : first + block] = part[name][: count - first]
    return drawn


def _answers(
    evaluator: Evaluator, draws: Mapping[str, Floats], numbers: Sequence[int], count: int, block: int
) -> dict[int, Floats]:
    """Return number of a forecast -> its `(count,)` answers, NaN where it is no number."""
    result: dict[int, list[Floats]] = {number: [] for number in numbers}
    for trials, part in portions(draws, count, block):
        n = trials.stop - trials.start
        evaluator.filters(part, n)
        columns = evaluator.forecasts(np.arange(n))
        for number, values in result.items():
            values.append(columns[number].as_floats())
    return {number: np.concatenate(values) for number, values in result.items()}


def sobol_indices(a: Floats, b: Floats, c: Floats) -> tuple[Estimate, Estimate]:
    """First-order and total index from the answers `(n,)` of A, B and ABᵢ; nan where they do not vary.

    Pairs in which one of the answers is no number (NaN) are left out.
    """
    known = ~(np.isnan(a) | np.isnan(b) | np.isnan(c))
    a, b, c = a[known], b[known], c[known]
    units = Units(int(a.size))
    if units.n < 2:
        return Estimate(math.nan, n=units.n), Estimate(math.nan, n=units.n)
    largest = max(float(np.max(np.abs(a))), float(np.max(np.abs(b)))) or 1.0
    a, b, c = a / largest, b / largest, c / largest  # first, so that sums and squares cannot overflow
    middle = 0.5 * (a.mean() + b.mean())
    scale = max(float(np.max(np.abs(a - middle))), float(np.max(np.abs(b - middle))))
    if not scale > 1e-12:
        return Estimate(math.nan, n=units.n), Estimate(math.nan, n=units.n)
    a, b, c = (a - middle) / scale, (b - middle) / scale, (c - middle) / scale
    squares = a * a + b * b  # of mean 2v
    first, total = (_share((each - c) ** 2, squares, units) for each in (b, a))
    alone = units.estimate(1.0 - first.value, first.error if first.error is not None else math.nan)
    return alone, total


def _share(part: Floats, whole: Floats, units: Units) -> Estimate:
    """mean(part)/mean(whole), with the error of a ratio."""
    size = float(whole.mean())
    value = float(part.mean()) / size
    return units.estimate(value, units.error((part - value * whole) / size))
