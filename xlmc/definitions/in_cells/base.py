"""The base case of a draw that does not name one: its mean, as @RISK shows it between simulations."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.definitions.in_cells.draws import Drawn
from xlmc.definitions.model import DataRange, Parameter
from xlmc.definitions.tables.data import data_family
from xlmc.distributions import Family, Truncated
from xlmc.errors import DefinitionError, FormulaError

__all__ = ["base_of", "percentile_cutoffs"]

_NODES: Final = 256
"""Points of the Gauss-Legendre rule over the probabilities of a distribution that is cut off."""

Cutoffs = tuple[Parameter | None, Parameter | None]


def base_of(
    family: Family,
    numbers: Mapping[str, float | None],
    data: DataRange | None,
    cutoffs: Cutoffs,
    limits: tuple[float | None, ...],
    saved: Callable[[Cell], float | None],
) -> float | None:
    """The mean; None where a number is not known before the workbook is calculated, or there is no finite mean.

    Args:
        family: of the draw; without its data.
        numbers: its parameters.
        data: what the family is built from.
        cutoffs: as the run needs them.
        limits: the same as numbers.
        saved: the number that a cell holds.
    """
    known = {key: number for key, number in numbers.items() if number is not None}
    unknown = len(known) < len(numbers) or any(
        cutoff is not None and limit is None for cutoff, limit in zip(cutoffs, limits, strict=True)
    )
    built = family if data is None else _built(family, data, saved)
    if unknown or built is None:
        return None
    if all(limit is None for limit in limits):
        mean = np.nan if built.fault(**known) else float(built.mean(**known))
    else:
        lower, upper = (end if limit is None else limit for limit, end in zip(limits, (-np.inf, np.inf), strict=True))
        mean = _mean_between(built, lower, upper, known)
    return mean if np.isfinite(mean) else None


def _built(family: Family, data: DataRange, saved: Callable[[Cell], float | None]) -> Family | None:
    """The family with its data; None where a cell is not calculated yet, or they are no distribution.

    Of the latter the model tells when it is made.
    """
    values = {cell: saved(cell) for cell in data.cells}
    numbers = {cell: value for cell, value in values.items() if value is not None}
    if len(numbers) < len(values):
        return None
    try:
        return data_family(family, data, numbers.__getitem__)
    except DefinitionError:
        return None


def _mean_between(family: Family, lower: float, upper: float, known: Mapping[str, float]) -> float:
    cut = Truncated(family)
    if cut.fault(lower, upper, **known):
        return np.nan
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return float(weights @ cut.ppf((nodes + 1) / 2, lower, upper, *family.bind((), known)) / 2)


def percentile_cutoffs(drawn: Drawn, numbers: Mapping[str, float | None], percents: tuple[float, float]) -> Cutoffs:
    """The cutoffs below which these probabilities lie; None for one at an end.

    Raises:
        FormulaError: a parameter is not a number that is known before the workbook is calculated.
    """
    known = {key: number for key, number in numbers.items() if number is not None}
    if len(known) < len(numbers) or drawn.data or drawn.family.fault(**known):
        hint = "cut off at values with RiskTruncate, or give the parameters as numbers"
        raise FormulaError(f"RiskTruncateP of {drawn.function} needs parameters that are fixed numbers", hint=hint)
    values = drawn.family.bind((), known)
    low, high = percents
    return (
        None if low == 0 else float(drawn.family.ppf(low, *values)),
        None if high == 1 else float(drawn.family.ppf(high, *values)),
    )
