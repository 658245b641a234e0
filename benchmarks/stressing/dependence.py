"""Correlations near ±1, and matrices that are hardly possible: what is asked for, and what the draws have."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from stressing.workbook import book_of
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import rank_correlation

__all__ = ["MATRICES", "book", "compared", "measure"]

Pairs = Mapping[tuple[str, str], float]

MATRICES: Final[Mapping[str, Pairs]] = {
    "0.999 throughout": {("first", "second"): 0.999, ("first", "third"): 0.999, ("second", "third"): 0.999},
    "hardly possible": {("first", "second"): 0.9, ("first", "third"): 0.9, ("second", "third"): 0.64},
    "just singular": {("first", "second"): 1.0, ("first", "third"): 0.5, ("second", "third"): 0.5},
    "all of them one": {("first", "second"): 1.0, ("first", "third"): -1.0, ("second", "third"): -1.0},
    "just impossible": {("first", "second"): 0.9, ("first", "third"): 0.9, ("second", "third"): 0.6},
    "contradictory": {("first", "second"): 1.0, ("first", "third"): 1.0, ("second", "third"): -1.0},
}
"""Of three assumptions. The fourth and fifth lie on either side of what a Gaussian copula can have."""


SWAPS: Final = 1e-11
"""How far a rank correlation of 1 may be off because rounding lets neighbours change places."""


def book(pairs: Pairs) -> CompiledModel:
    """Assumptions of three families with these correlations, and their sum."""
    assumptions: dict[str, Sequence[object]] = {
        "first": (0.5, "Uniform", ("Low", 0.0), ("High", 1.0)),
        "second": (0.5, "Normal", ("Mean", 5.0), ("Std dev", 2.0)),
        "third": (1.5, "Triangular", ("Low", 0.0), ("High", 3.0), ("Likeliest", 1.5)),
    }
    named = {name for pair in pairs for name in pair}
    held = {name: given for name, given in assumptions.items() if name in named}
    rows = [(*pair, value) for pair, value in pairs.items()]
    return book_of(held, {"total": f"={'+'.join(held)}"}, ["total"], correlations=rows)


def measure(model: CompiledModel, pairs: Pairs, trials: int, seed: int, sampling: str = "mc") -> list[dict[str, Any]]:
    """Pair by pair: asked, aimed at (after repair), expected of so many draws, found in them, and its error."""
    return compared(model, pairs, run_model(model, RunOptions.of(trials=trials, seed=seed, sampling=sampling)))


def compared(model: CompiledModel, pairs: Pairs, run: RunResult) -> list[dict[str, Any]]:
    """The same of a run that was made."""
    trials = run.accepted
    (group,) = model.groups
    result = []
    for (first, second), asked in pairs.items():
        i, j = group.names.index(first), group.names.index(second)
        aimed = float(group.copula.spearman[i, j])
        got = rank_correlation(run.inputs[first], run.inputs[second])
        result.append(
            {"pair": f"{first}, {second}", "asked": asked, "aimed": aimed, "expected": _expected(aimed, trials),
             "found": got.value, "error": _error(aimed, trials)}
        )  # fmt: skip
    return result


def _expected(rank: float, trials: int) -> float:
    """Of Spearman's correlation of a finite sample of normals (Moran 1948)."""
    rho = min(1.0, max(-1.0, 2.0 * math.sin(math.pi * rank / 6.0)))
    return (6.0 * math.asin(rho) / math.pi + (trials - 2) * rank) / (trials + 1)


def _error(rank: float, trials: int) -> float:
    """Of Spearman's correlation of normals (Bonett & Wright 2000); at ±1 that of neighbours that rounding lets swap."""
    return (1.0 - rank**2) * math.sqrt((1.0 + rank**2 / 2.0) / (trials - 3)) + SWAPS
