"""A graph of nodes parted into stages: loops, and between them what the loops cannot compute."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.llvm.recipes import Recipe, reads

__all__ = ["Stage", "stages"]

_LONGEST: Final = 250
"""Nodes of one loop; the time to compile grows faster than the loop."""


@dataclass(frozen=True, slots=True)
class Stage:
    """Nodes that are computed together, in order; `loop` says how."""

    places: tuple[int, ...]
    loop: bool


def stages(dag: Dag, places: Sequence[int], recipes: Mapping[int, Recipe]) -> list[Stage]:
    """The nodes of `places`, in order, as stages in order; those without a recipe stand outside of loops."""
    levels: dict[int, int] = {}
    for place in places:
        in_loop = place in recipes
        levels[place] = 0 if in_loop else 1  # loops stand on even levels
        for used in reads(dag, place, recipes.get(place)):
            if used in levels:
                after = levels[used] + ((used in recipes) != in_loop)
                levels[place] = max(levels[place], after)
    grouped: defaultdict[int, list[int]] = defaultdict(list)
    for place in places:
        grouped[levels[place]].append(place)
    return [stage for level in sorted(grouped) for stage in _parts(grouped[level], loop=level % 2 == 0)]


def _parts(places: Sequence[int], loop: bool) -> Iterable[Stage]:
    size = _LONGEST if loop else len(places)
    for start in range(0, len(places), size):
        yield Stage(tuple(places[start : start + size]), loop)
