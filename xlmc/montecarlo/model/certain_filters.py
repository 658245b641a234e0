"""Which filters no trial can break, so that nothing is said of them where results are explained."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

from xlmc.engine.graph.nodes import Target
from xlmc.engine.passes.bounds import Bounds, NodeBounds
from xlmc.excel.functions.values import LOGICAL, NUMBER
from xlmc.montecarlo.model.needed import filter_condition, filter_limits

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Filter
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["breakable"]


def breakable(model: CompiledModel) -> tuple[Filter, ...]:
    """Return the filters that a trial may break, as far as the graph of the workbook tells.

    Left out are those whose condition holds and no assumption reaches, such as one that a switch turns off, and those
    whose limits hold for all numbers that the ranges of the assumptions lead to. A cell that is an error breaks its
    filter, and no range tells of that: whoever knows a trial that was rejected knows better.
    """
    supports = {name: draw.ends for name, draw in model.draws.items()}
    bounds = NodeBounds(model.lowering.dag, {name: ends for name, ends in supports.items() if ends is not None})
    return tuple(each for each in model.filters if not _is_certain(model, each, bounds))


def _is_certain(model: CompiledModel, filter_: Filter, bounds: NodeBounds) -> bool:
    known = model.lowering.known(Target(filter_condition(filter_), filter_.cell))
    if known is not None:
        return int(known.kinds.flat[0]) in (NUMBER, LOGICAL) and bool(known.numbers.flat[0] != 0.0)
    limits = filter_limits(filter_)
    if filter_.evidence is not None or not limits:
        return False
    ends = bounds.of(model.lowering.target(Target(filter_.cell, filter_.cell)))
    return ends is not None and all(isinstance(limit, float) and _HOLDS[how](ends, limit) for how, limit in limits)


_HOLDS: Final[Mapping[str, Callable[[Bounds, float], bool]]] = {
    ">=": lambda ends, limit: ends[0] >= limit,
    "<=": lambda ends, limit: ends[1] <= limit,
    ">": lambda ends, limit: ends[0] > limit,
    "<": lambda ends, limit: ends[1] < limit,
}
"""Relation -> whether it holds between all numbers from one to another, and a limit."""
