"""What float32 would change: the same random rounding, at its size."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.evaluation.passes.replicas import SINGLE, Jitter, evaluation, numbers
from xlmc.run.digits import DUST
from xlmc.run.rounding import MOST_DECISIONS, MOST_DIFFERENCE
from xlmc.studies.stability.case import Case
from xlmc.studies.stability.findings import Finding, Level, Where

__all__ = ["single_precision"]

_REPLICAS: Final = 2


def single_precision(case: Case) -> Iterator[Finding]:
    """A note on each forecast and filter for which float32 is too coarse, by the bounds of `--arithmetic float32`."""
    found = [evaluation(case.dag, case.places, case.draws, Jitter((9, i), SINGLE)) for i in range(_REPLICAS)]
    for row, node in zip(case.model.filters, case.conditions, strict=True):
        plain = case.number(node)
        flips = np.mean([numbers(one[node], case.n) != plain for one in found], axis=0)
        share = float(flips[case.special : case.first_accepted].mean()) if case.first_accepted > case.special else 0.0
        if share > MOST_DECISIONS:
            where = case.where(np.asarray(flips > 0), node)
            effect = f"{share:.2%} of its decisions would turn with `--arithmetic float32`; float64 decides them alike"
            what = "this filter decides trials by digits that float32 has not"
            yield _finding(case, row.cell, row.name, what, effect, share, where)
    for forecast in case.model.forecasts:
        node = case.node[forecast.cell]
        plain, scale = case.number(node), case.scale(forecast.cell)
        if scale < DUST * case.term_sizes[node] or np.isnan(plain).all():
            continue
        off = np.max([np.abs(numbers(one[node], case.n) - plain) for one in found], axis=0)
        share = float(np.nanquantile(off / np.fmax(scale, np.abs(plain)), 0.999))
        if share > MOST_DIFFERENCE:
            effect = f"float32 would put it off by up to {share:.1g} of its central range or value"
            what = "it needs more digits than float32 has"
            yield _finding(case, forecast.cell, forecast.name, what, effect, share, ())


def _finding(
    case: Case, cell: Cell, name: str, what: str, effect: str, size: float, where: tuple[Where, ...]
) -> Finding:
    formula = case.trees.written(cell)
    return Finding(Level.NOTE, "float32", cell, name, formula, what, effect, where, None, size)
