"""Arguments that reach the edge of what a function takes: below it is an error, and at it the function is vertical."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.functions.facts import Domain
from xlmc.functions.families import function_named
from xlmc.studies.stability.case import Case, Floats
from xlmc.studies.stability.findings import Finding, Level
from xlmc.studies.stability.trees import terms

__all__ = ["domain_edges"]

_CLOSE: Final = 1e-3
"""Of the spread of the argument: nearer to the edge than that, and it is told of."""


def domain_edges(case: Case) -> Iterator[Finding]:
    """The functions whose argument leaves their domain in some trials, or comes close to its edge."""
    for cell in case.cells:
        for part in case.trees.parts(cell):
            row = function_named(part.name) if isinstance(part, ir.Call) else None
            domain = None if row is None else row.facts.domain
            if isinstance(part, ir.Call) and domain is not None and not _is_of_squares(part):
                finding = _finding(case, cell, part, domain)
                if finding is not None:
                    yield finding


def _is_of_squares(part: ir.Call) -> bool:
    """Whether it is the root of a sum of squares, which cannot leave the domain."""
    squares = [
        sign > 0 and isinstance(term, ir.Binary) and (term.operator == "^" and term.right == ir.Number(2.0))
        for sign, term in (found for argument in part.arguments[:1] for found in terms(argument))
    ]
    return all(squares)


def _finding(case: Case, cell: Cell, part: ir.Call, domain: Domain) -> Finding | None:
    low, high = domain.low, domain.high
    place = case.trees.place(part.arguments[0], cell)
    if place is None or place not in case.values:
        return None
    x = case.number(place)[case.special :]
    x = x[np.isfinite(x)]
    if not x.size or x.min() == x.max():
        return None
    every = case.number(place)
    outside = (every < low) | (every > high)
    argument, function = case.trees.text(part.arguments[0], cell), part.name
    takes = f"{low:g} or more" if high == np.inf else f"{low:g} to {high:g}"
    above = takes if domain.with_ends else f"above {low:g}"
    share = float(outside[case.special :].mean())
    if share:
        what = f"{function} takes {above}, and {argument} goes to {_extreme(x, low, high):.4g}"
        return Finding(
            Level.DOUBTFUL,
            "edge",
            cell,
            case.trees.title(cell),
            case.trees.written(cell),
            what,
            f"the cell is an error in {share:.2%} of the trials",
            case.where(outside, place),
            None,
            share,
        )
    room = np.minimum(x - low, high - x)
    spread = float(x.max() - x.min())
    if room.min() > _CLOSE * spread:
        return None
    near = np.asarray(np.minimum(every - low, high - every) <= 10 * _CLOSE * spread)
    return Finding(
        Level.NOTE,
        "edge",
        cell,
        case.trees.title(cell),
        case.trees.written(cell),
        f"{function} takes {above}, and {argument} comes down to {room.min():.2g} from that edge",
        "close to it the function is steep, and a trial beyond it is an error",
        case.where(near, place),
        None,
        float(room.min() / spread),
    )


def _extreme(x: Floats, low: float, high: float) -> float:
    return float(x.min() if low - x.min() > x.max() - high else x.max())
