"""The nodes that are computed on one set of trials: on all of them, or on the survivors of the filters."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Input, Range, Rescue, Select, evaluated
from xlmc.evaluation.llvm.addresses import Addresses
from xlmc.evaluation.llvm.loop import Load, compiled
from xlmc.evaluation.llvm.machine import Machine, NativeLoop
from xlmc.evaluation.llvm.recipes import Operand, Recipe, reads
from xlmc.evaluation.llvm.stages import Stage, stages
from xlmc.evaluation.llvm.trials import Trials
from xlmc.functions import Kind

__all__ = ["Loop", "Memory", "Phase"]


class Memory:
    """Arrays that loops write to, by node, `(block,)`; for one thread.

    Attributes:
        addresses: of the arrays that loops read and write.
    """

    def __init__(self, dag: Dag, places: Iterable[int], block: int) -> None:
        dtypes = {place: np.bool_ if dag.types[place] is Kind.LOGICAL else np.float64 for place in places}
        self._arrays: dict[int, NDArray[Any]] = {place: np.empty(block, dtype) for place, dtype in dtypes.items()}
        self.addresses = Addresses()

    def of(self, place: int, n: int) -> NDArray[Any]:
        """The first `n` elements of a node's array."""
        array = self._arrays[place]
        return array if n == array.size else array[:n]


@dataclass(frozen=True, slots=True)
class Loop:
    """A stage as native code, with the arrays it reads and the nodes it writes."""

    call: NativeLoop
    loads: tuple[Load, ...]
    stores: tuple[int, ...]


class Phase:
    """Computes the nodes of `places`.

    Args:
        keep: the nodes whose values are wanted afterwards.
        early: the nodes that were computed before, on a wider set of trials; None where this is the first phase.
        may_err: the inputs whose draws may be errors.

    Attributes:
        stores: the nodes that need memory.
    """

    def __init__(
        self,
        dag: Dag,
        machine: Machine,
        recipes: Mapping[int, Recipe],
        places: Sequence[int],
        keep: Iterable[int],
        early: frozenset[int] | None,
        may_err: frozenset[str],
    ) -> None:
        self._dag, self._machine, self._recipes, self._may_err = dag, machine, recipes, may_err
        self._early = early
        parts = stages(dag, [place for place in places if not isinstance(dag.nodes[place], Input)], recipes)
        read = [self._read_from_outside(stage) for stage in parts]
        self._steps: list[Loop | tuple[int, ...]] = []
        for position, stage in enumerate(parts):
            wanted = set(keep).union(*(found for other, found in enumerate(read) if other != position))
            self._steps.append(self._loop(stage, read[position], wanted) if stage.loop else stage.places)
        self.stores = tuple(place for step in self._steps if isinstance(step, Loop) for place in step.stores)

    def _read_from_outside(self, stage: Stage) -> set[int]:
        read = {used for place in stage.places for used in reads(self._dag, place, self._recipes.get(place))}
        return read - set(stage.places)

    def _loop(self, stage: Stage, read: set[int], wanted: set[int]) -> Loop:
        recipes = {place: self._recipes[place] for place in stage.places}
        loads: dict[Operand, Load] = {}
        for recipe in recipes.values():
            for part in recipe.operands:
                if isinstance(part, Operand) and part.place in read:
                    load = self._load(part)
                    if load is not None:
                        loads[load.operand] = load
        stores = tuple(place for place in stage.places if place in wanted)
        found = tuple(loads.values())
        return Loop(compiled(self._dag, self._machine, recipes, found, stores), found, stores)

    def _load(self, part: Operand) -> Load | None:
        """How a node from outside is read; None for a constant."""
        node = self._dag.nodes[part.place]
        if isinstance(node, Constant):
            return None
        is_input = isinstance(node, Input)
        picked = self._early is not None and (is_input or part.place in self._early)
        if isinstance(node, Input):
            return Load(Operand(part.place, Kind.NUMBER), Kind.NUMBER, picked, node.name in self._may_err)
        if part.place in self._recipes:
            own = self._dag.types[part.place]
            return Load(Operand(part.place, own), own, picked, False)  # it was checked when it was written
        return Load(part, Kind.NUMBER, picked, True)

    @property
    def loops(self) -> tuple[Loop, ...] | None:
        """The stages, where all are loops."""
        loops = tuple(step for step in self._steps if isinstance(step, Loop))
        return loops if len(loops) == len(self._steps) else None

    def run(self, trials: Trials, memory: Memory) -> bool:
        """Compute all nodes; whether any trial must be computed again."""
        wrong = 0
        for step in self._steps:
            if isinstance(step, Loop):
                wrong += self._run_loop(step, trials, memory)
            else:
                self._run_outside(step, trials)
        return wrong > 0

    def _run_loop(self, step: Loop, trials: Trials, memory: Memory) -> int:
        address, places = memory.addresses.of, []
        for load in step.loads:
            source = trials.wider if load.picked else trials
            assert source is not None
            places.append(address(load.operand.place, source.array(load.operand)))
        written = [memory.of(place, trials.n) for place in step.stores]
        places += [address(place, array) for place, array in zip(step.stores, written, strict=True)]
        places += [address("survivors", trials.survivors), address("wrong", trials.wrong)]
        wrong = step.call((ctypes.c_void_p * len(places))(*places), trials.n)
        trials.arrays.update(zip(step.stores, written, strict=True))
        return wrong

    def _run_outside(self, places: Sequence[int], trials: Trials) -> None:
        for place in places:
            node = self._dag.nodes[place]
            assert isinstance(node, Apply | Select | Rescue | Range)
            needed = {used: trials.value(used) for used in reads(self._dag, place, None)}
            with np.errstate(all="ignore"):
                trials.values[place] = evaluated(node, needed)
