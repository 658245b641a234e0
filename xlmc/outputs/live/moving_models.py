"""The models of the states that a window goes through, and what their runs have in common.

A state at rest has the model that the edited workbook would have. It is made from one in which the same assumptions are
held at the same values: in such a model a moved number needs no formula to be looked at again. A state that moves has
what a `ReusingRunner` can run: an assumption that was frozen a moment ago is still drawn there, as a distribution with
a single value, and so is the number that a decision takes, if nothing but formulas reads its cell. Other decisions, and
cells that are solved for, are typed into the workbook first; all else is then as in a workbook that was opened with
these numbers.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.util import find_spec
from types import MappingProxyType
from typing import Final

from xlmc.engine.graph.nodes import Constant
from xlmc.errors import XlmcError
from xlmc.excel.formula import Graph
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions
from xlmc.montecarlo.loop.blocks import ModelRunner
from xlmc.montecarlo.loop.reusing_runner import ReusingRunner
from xlmc.montecarlo.model.applied_changes import applied, changed_cells, reads_again
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.outputs.live.adjusted_scenarios import changes_of
from xlmc.outputs.live.adjustments import Adjustments

__all__ = ["MANY_FORMULAS", "KnownModels", "Moving"]

MANY_FORMULAS: Final = 5_000
"""Needed formulas with which a run takes long."""

_MOST_SHAPES: Final = 1_000
"""Different formulas that are compiled in some seconds."""

_IN_SHAPES: Final = re.compile(r"\$?\b[A-Za-z]{1,3}\$?\d+\b|\d+(\.\d+)?")

_KEPT: Final = 3
"""Sets of held assumptions whose models are kept."""

_DECIDED: Final = "decided: "
"""Before the name of a decision, where it is an assumption with a single value."""

_MOST_MORE: Final = 2
"""Nodes that a trial computes where decisions are assumptions, as a multiple of those of the workbook's model."""

_State = tuple[tuple[str, bool, float | None], ...]
"""Each assumption that is held or drawn differently from the workbook: its name, whether it is held, and where. Each
filter or row of evidence that is used or not, likewise: its name, and whether it is used, with no place.
"""


@dataclass(frozen=True, slots=True)
class Moving:
    """What a state that moves is run with.

    Attributes:
        model: of the state.
        reusing: what it has in common with the states before.
    """

    model: CompiledModel
    reusing: ReusingRunner

    def runner(self, block: int) -> ModelRunner:
        """Return what runs its blocks, of so many trials each."""
        return self.reusing.runner(self.model, min(block, self.reusing.largest_block))

    @property
    def base(self) -> dict[str, float | None] | None:
        """Return the forecasts at the base case; otherwise None."""
        return self.reusing.base(self.model)


class KnownModels:
    """See the module. For one thread.

    Args:
        own: the workbook's model.
        trials: of the longest run of a state that moves.
        most_bytes: of draws that are kept.
        seed: of all runs; None for the workbook's.
    """

    def __init__(self, own: CompiledModel, trials: int, most_bytes: int | None = None, seed: int | None = None) -> None:
        self.own, self._trials, self._most_bytes = own, trials, most_bytes
        self._seed = own.definitions.settings.seed if seed is None else seed
        self._holding: dict[_State, CompiledModel] = {(): own}
        self._runners: dict[_State, ReusingRunner] = {}
        self._last: tuple[CompiledModel, Adjustments, CompiledModel] | None = None
        self._typed: tuple[Adjustments, KnownModels] | None = None
        self._deciding: KnownModels | None = None
        self._decides = _may_decide(own)

    def _with_typed(self, typed: Adjustments) -> KnownModels:
        """Return the models of the workbook with what is typed into its cells; those of the last one are kept.

        Raises:
            DefinitionError, FormulaError: as for `applied`.
        """
        if self._typed is None or self._typed[0] != typed:
            own = applied(self.own, changes_of(self.own.definitions, typed))
            self._typed = typed, KnownModels(own, self._trials, self._most_bytes, self._seed)
        return self._typed[1]

    def _alone(self, known: KnownModels) -> KnownModels:
        """Return the models that are run next; draws that the others keep are given back."""
        for each in (self, self._deciding, None if self._typed is None else self._typed[1]):
            if each is not None and each is not known:
                for runner in each._runners.values():
                    runner.forget()
        return known

    def at_rest(self, adjustments: Adjustments) -> CompiledModel:
        """Return the model of a state.

        Raises:
            DefinitionError, FormulaError: as for `applied`.
        """
        if typed := adjustments.typed_part():
            return self._with_typed(typed).at_rest(adjustments.untyped_part())
        state = _state_of(self.own.definitions, adjustments)
        if not state:
            return self._moved(self.own, adjustments)
        numbers = adjustments.numbers(self.own.definitions)
        try:
            holding = self._of_state(state, adjustments)
            again = reads_again(holding, changes_of(holding.definitions, numbers))
        except XlmcError:  # what is drawn now may have no distribution before its numbers are changed, too
            again = True
        return self._moved(self.own, adjustments) if again else self._moved(holding, numbers)

    def moving(self, adjustments: Adjustments) -> Moving:
        """Return what a state is run with while it moves.

        Raises:
            DefinitionError, FormulaError: as for `applied`.
            SimulationError: a filter or a forecast cannot be computed.
        """
        if typed := adjustments.typed_part():
            result = self._decided(adjustments) if self._decides else None
            return result or self._alone(self._with_typed(typed)).moving(adjustments.untyped_part())
        self._typed = None
        self._alone(self)
        state = _state_of(self.own.definitions, adjustments)
        if (result := self._held(adjustments, state)) is not None:
            return result
        model = self.at_rest(adjustments)
        reusing = self._runner_of(state, self._holding.get(state, model))
        return Moving(model, reusing if reusing.holds_for(model) else self._new_runner(model))

    def _held(
        self, adjustments: Adjustments, state: _State, values: Mapping[str, float] = MappingProxyType({})
    ) -> Moving | None:
        """Return what runs a state in which some assumptions have a single value; None if more is to be changed.

        Args:
            adjustments: the state.
            state: the part of it that says what is held, and where.
            values: of further assumptions that have a single value.
        """
        still = _frozen_values(self.own, state)
        if still is None:
            return None
        still = {**still, **values}
        model = self._moved(self.own, adjustments.numbers(self.own.definitions))
        model = model.changed(model.workbook, _holding_still(model.definitions, still)) if still else model
        reusing = self._runner_of((), self.own)
        return Moving(model, reusing) if reusing.holds_for(model) else None

    def _decided(self, adjustments: Adjustments) -> Moving | None:
        """Return what runs a state with other decisions, none of which need formulas to be looked at again.

        None if a decision is no number that formulas alone read, or if this would take longer.
        """
        if self._deciding is None:
            typed = self._with_typed(adjustments.typed_part()).own
            model = _deciding(self.own) if _defines_the_same(self.own, typed) else None
            if model is None:
                self._decides = False
                return None
            self._deciding = KnownModels(model, self._trials, self._most_bytes, self._seed)
        changed = {name: float(each["value"]) for name, each in adjustments.decisions.items() if each}
        values = {
            _DECIDED + each.name: changed.get(each.name, each.base)
            for each in self.own.definitions.decisions
            if each.base is not None
        }
        untyped, known = adjustments.untyped_part(), self._alone(self._deciding)
        return known._held(untyped, _state_of(known.own.definitions, untyped), values)

    def _moved(self, model: CompiledModel, adjustments: Adjustments) -> CompiledModel:
        """Return the model with other numbers; a state is first run with few trials, then with more, then at rest."""
        if self._last is None or self._last[0] is not model or self._last[1] != adjustments:
            changes = changes_of(model.definitions, adjustments)
            self._last = model, adjustments, applied(model, changes) if changes else model
        return self._last[2]

    def _of_state(self, state: _State, adjustments: Adjustments) -> CompiledModel:
        """Return the workbook's own model but for what is held; the last ones are kept."""
        if state not in self._holding:
            changes = changes_of(self.own.definitions, adjustments.frozen_part(self.own.definitions))
            self._holding[state] = applied(self.own, changes)
            for old in [each for each in self._holding if each][:-_KEPT]:
                self._holding.pop(old)
                self._runners.pop(old, None)
        return self._holding[state]

    def _runner_of(self, state: _State, model: CompiledModel) -> ReusingRunner:
        if state not in self._runners or not self._runners[state].holds_for(model):
            self._runners[state] = self._new_runner(model)
        for other, runner in self._runners.items():
            if other != state:
                runner.forget()
        return self._runners[state]

    def _new_runner(self, model: CompiledModel) -> ReusingRunner:
        return ReusingRunner(model, _engine(model), self._seed, self._trials, self._most_bytes)


def _may_decide(own: CompiledModel) -> bool:
    """Return whether all decisions are numbers in cells that nothing but formulas may read."""
    definitions = own.definitions
    cells = {each.cell for each in definitions.decisions}
    taken = {each.cell for each in definitions.assumptions}
    numbers = all(each.base is not None and not each.contents for each in definitions.decisions)
    return bool(cells) and numbers and cells.isdisjoint(taken) and not definitions.solves and own.folds_nothing


def _defines_the_same(own: CompiledModel, typed: CompiledModel) -> bool:
    """Return whether two models differ in what decisions hold alone, and not in what was read from other cells."""
    definitions, others = (replace(each.definitions, decisions=()) for each in (own, typed))
    return definitions == others


def _deciding(own: CompiledModel) -> CompiledModel | None:
    """Return the workbook's model with its decisions as assumptions that have a single value.

    None if a formula cannot be computed then, if the draws of others would depend on them, or if much would be computed
    in each trial that is else computed once.
    """
    definitions = own.definitions
    decided = tuple(
        Assumption(
            _DECIDED + each.name, each.cell, "Uniform", {"low": each.base, "high": each.base}, each.row, base=each.base
        )
        for each in definitions.decisions
        if each.base is not None
    )
    with_decisions = replace(definitions, assumptions=(*definitions.assumptions, *decided), decisions=())
    try:
        model = type(own)(own.workbook, with_decisions, own.path)
    except XlmcError:  # a formula that computes which cell it reads, say
        return None
    same = len(model.needed.stages) == len(own.needed.stages)
    return model if same and _in_each_trial(model) <= _MOST_MORE * _in_each_trial(own) else None


def _in_each_trial(model: CompiledModel) -> int:
    """Count the nodes that a trial computes."""
    return sum(not isinstance(node, Constant) for node in model.lowering.dag.nodes)


def _engine(model: CompiledModel) -> str:
    """Choose what computes states that move: the compiled engine if the workbook asks for it, or if it soon pays."""
    compiled = find_spec("llvmlite") is not None
    if model.definitions.settings.engine == "jit" and compiled:
        return "jit"
    many = len(model.needed.graph.formulas) > MANY_FORMULAS
    return "jit" if many and compiled and _shapes(model.needed.graph) <= _MOST_SHAPES else "numpy"


def _shapes(graph: Graph) -> int:
    """Count the formulas that differ by more than numbers and references; those filled down do not."""
    return len({_IN_SHAPES.sub("#", graph.text(cell)) for cell in graph.formulas})


def _state_of(definitions: Definitions, adjustments: Adjustments) -> _State:
    state = adjustments.frozen_part(definitions)
    result: list[tuple[str, bool, float | None]] = [
        (name, bool(each["used"]), None) for name, each in state.filters.items()
    ]
    changed = state.assumptions
    for assumption in definitions.assumptions if changed else ():
        given = changed.get(assumption.name)
        if given is not None:
            base = given.get("base")
            frozen = bool(given.get("frozen", assumption.frozen))
            result.append((assumption.name, frozen, None if base is None else float(base)))
    return tuple(result)


def _frozen_values(own: CompiledModel, state: _State) -> dict[str, float] | None:
    """Return the value of each held assumption; None if holding it changes more than the values of draws."""
    named = {each.name: each for each in own.live}
    grouped = {name for group in own.groups for name in group.names}
    result: dict[str, float] = {}
    for name, frozen, base in state:
        assumption = named.get(name)
        value = base if base is not None or assumption is None else assumption.base
        if not frozen or value is None or assumption is None or assumption.cells or assumption.data is not None:
            return None
        if own.draws[name].name in grouped:
            return None
        result[name] = value
    frozen_then = replace(
        own.definitions,
        assumptions=tuple(
            replace(each, frozen=True, base=result[each.name]) if each.name in result else each
            for each in own.definitions.assumptions
        ),
    )
    return None if result and own.reads_elsewhere(changed_cells(own, frozen_then)[0]) else result


def _holding_still(definitions: Definitions, values: Mapping[str, float]) -> Definitions:
    """Return the definitions with assumptions that have a single value each."""

    def still(assumption: Assumption) -> Assumption:
        if assumption.name not in values:
            return assumption
        value = values[assumption.name]
        return replace(
            assumption,
            distribution="Uniform",
            own_family=None,
            given={"low": value, "high": value},
            base=value,
            checked=None,
        )

    return replace(definitions, assumptions=tuple(map(still, definitions.assumptions)))
