"""A workbook that was read and compiled: ready to be sampled and evaluated."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.engine.engine import Evaluator, Program, Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.passes.bounds import Bounds, NodeBounds
from xlmc.errors import Notice, SimulationError
from xlmc.excel.address import Cell, host_of
from xlmc.excel.formula import ir
from xlmc.excel.functions import Kind
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions import stating
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind as StatedAs
from xlmc.montecarlo.model.cell_forms import formats_of, forms_of
from xlmc.montecarlo.model.correlating import (
    copula_groups,
    copula_notices,
    correlated_groups,
    repair_notices,
    tie_notices,
)
from xlmc.montecarlo.model.data_tables import cells_read, computed_tables, with_data_tables
from xlmc.montecarlo.model.draw_binding import base_point, draw_of, dynamic_parameters, parameter_target, with_numbers
from xlmc.montecarlo.model.forecast_filters import (
    FilteringEvaluator,
    FilteringProgram,
    conditions_of,
    filters_by_forecast,
)
from xlmc.montecarlo.model.forecast_values import are_texts, is_two_valued
from xlmc.montecarlo.model.impossible_draws import possible_draws, with_errors
from xlmc.montecarlo.model.input_points import input_points
from xlmc.montecarlo.model.lowered_cells import lower_checks, lower_needed
from xlmc.montecarlo.model.model_notices import example_notices, heavy_notices, still_cells, still_notices
from xlmc.montecarlo.model.needed import chances_of, filter_condition
from xlmc.montecarlo.model.shared_parts import asks_for_the_same, hull
from xlmc.montecarlo.model.solving import with_solved_cells
from xlmc.montecarlo.model.stated_formulas import with_stated_formulas
from xlmc.montecarlo.sampling.draws import CorrelatedGroup, Draw, DrawStage, Filler, Sampler
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["CompiledModel"]

_MOST_GROWN: Final = 4
"""Nodes that changed limits of filters may have added, as a multiple of the first ones, before all are made anew."""


@dataclass(frozen=True, slots=True)
class _Compiled:
    """A program, and the least and largest draws, by name of the assumption, that it was compiled for."""

    program: Program
    ends: Mapping[str, Bounds]


_TRIED: Final = 64
"""Trials that tell whether an answer is a text."""


class CompiledModel:
    """A workbook's assumptions, forecasts and filters, and the function that computes them.

    Attributes:
        workbook, definitions, path: what it was made from.
        assumptions, forecasts, filters, checks: as defined.
        forecast_filters: filters of some forecasts only, as defined.
        live: the assumptions that are drawn: needed and not frozen.
        bases: name of each live assumption -> its base value; None if its cell is blank.
        chances: what decides which trials are kept by evidence whose error is no limit; drawn as assumptions are.
        draws: name of a live assumption or a chance -> how it is drawn.
        lowering: the nodes of the needed cells.
        groups: of correlated ones among them.
        notices: what the person should know.
        still: cells of forecasts that no assumption with a range reaches: they are the same in every trial.
    """

    def __init__(self, workbook: Workbook, definitions: Definitions, path: Path) -> None:
        definitions = with_data_tables(workbook, with_solved_cells(workbook, definitions))
        given, definitions = definitions, with_numbers(workbook, definitions)
        self._folded = definitions is not given
        self._compile(workbook, definitions, path)
        stated = with_stated_formulas(workbook, given, self.definitions, self._at_base)
        if stated is not self.definitions:
            self._define(stated, self.draws)

    def _at_base(self, cells: Sequence[Cell]) -> dict[Cell, float]:
        """Return the values of some cells at the base case, of those that the model has and that are numbers then."""
        base = base_point(self.bases)
        known = [cell for cell in cells if cell in self._parameter_cells]
        if base is None or not known:
            return {}
        columns = self.evaluator([parameter_target(cell) for cell in known], 1).filters(base | self.certain(1), 1)
        numbers = {cell: float(column.as_floats()[0]) for cell, column in zip(known, columns, strict=True)}
        return {cell: number for cell, number in numbers.items() if np.isfinite(number)}

    @property
    def _parameter_cells(self) -> set[Cell]:
        """The cells that compute numbers of what is drawn and limits of filters, which the model has."""
        cells = {cell for each in self.live for cell in each.formulas.values()}
        return cells | {cell for each in (*self.filters, *self.forecast_filters) for cell in each.formulas.values()}

    def _compile(self, workbook: Workbook, definitions: Definitions, path: Path) -> None:
        """Make the nodes of what the definitions ask for, and all that depends on them."""
        self.workbook, self.path = workbook, path
        self.needed, self.lowering = lower_needed(workbook, definitions)
        draws, faults = possible_draws(self.needed, self.lowering, definitions)
        while faults:
            definitions = with_errors(definitions, faults, self.lowering)
            self.needed, self.lowering = lower_needed(workbook, definitions)
            draws, faults = possible_draws(self.needed, self.lowering, definitions)
        self._programs: dict[str, _Compiled] = {}
        self._define(definitions, draws)
        self._check_targets()
        self._nodes = len(self.lowering.dag.nodes)
        self._checks = lower_checks(workbook, definitions, frozenset(self.needed.live)) if self.checks else None
        self._take_notices()

    def _define(self, definitions: Definitions, known: Mapping[str, Draw]) -> None:
        """Take the definitions; `known` are the draws of assumptions that are as they were, by name."""
        self.definitions = definitions
        self.assumptions, self.forecasts = definitions.assumptions, definitions.forecasts
        self.filters, self.checks = definitions.filters, definitions.checks
        self.forecast_filters = definitions.forecast_filters
        self.chances = chances_of(self.filters)
        named, chances = {a.name: a for a in (*self.assumptions, *self.chances)}, {a.name for a in self.chances}
        live: list[Assumption] = []
        draws: dict[str, Draw] = {}
        result: dict[str, Bounds] = {}
        for name in self.needed.live:
            draws[name] = draw = known.get(name) or draw_of(named[name], self.lowering)
            if draw.ends is not None:
                result[name] = draw.ends
            if name not in chances:
                live.append(named[name])
        self.live: tuple[Assumption, ...] = tuple(live)
        self.bases: Mapping[str, float | None] = {a.name: a.base for a in live}
        self.draws: Mapping[str, Draw] = draws
        self._ends = result
        rows = definitions.correlations
        tied = {name for row in rows for name in (row.first, row.second)}
        self._correlated = {name: draw for name, draw in self.draws.items() if name in tied}
        self.groups: tuple[CorrelatedGroup, ...] = (
            *correlated_groups(rows, self._correlated),
            *copula_groups(definitions.copulas, self.draws.keys()),
        )

    def _take_notices(self) -> None:
        rows, moving = self.definitions.correlations, self._moving()
        self.still = still_cells(self.needed, moving, self.forecasts)
        self.notices: tuple[Notice, ...] = (
            *self.workbook.notices,
            *self.definitions.notices,
            *self.needed.notices(frozenset() if self._checks is None else self._checks.graph.reached),
            *self.lowering.notices,
            *tie_notices(self.groups, rows, self._correlated),
            *repair_notices(self.groups, rows),
            *copula_notices(self.groups, self.definitions.copulas),
            *still_notices(self.needed, moving, self.forecasts, self.still),
            *heavy_notices(a for a in self.live if not self.draws[a.name].has_mean),
            *example_notices(self._sources()),
        )

    def changed(self, workbook: Workbook, definitions: Definitions) -> Self:
        """Return the model with other definitions. What they leave as it was is not computed again.

        Where only numbers are others (parameters and cutoffs of drawn assumptions, correlations, limits of filters), no
        formula is looked at: the new model shares the nodes with this one, and the programs that hold for both. As
        both may add to the nodes, ask models that share them from one thread at a time.

        Args:
            workbook: the same in all cells that the forecasts, filters and checks read.
            definitions: those of this model, changed.

        Raises:
            DefinitionError: numbers are not a distribution, or assumptions need each other in a circle.
            FormulaError: a cell that is needed now cannot be computed.
        """
        own = self.definitions
        if len(self.lowering.dag.nodes) > (1 + _MOST_GROWN) * self._nodes:
            self._make_anew()
        if not asks_for_the_same(own, definitions, frozenset(self.needed.live)):
            result = type(self)(workbook, definitions, self.path)
            result._folded = self._folded
            return result
        result = copy(self)
        result.workbook = workbook
        same = {old.name for old, new in zip(own.assumptions, definitions.assumptions, strict=True) if old is new}
        result._define(definitions, {name: draw for name, draw in self.draws.items() if name in same})
        if result.filter_targets != self.filter_targets:
            result._programs = {}
            result._check_targets()
        result._take_notices()
        return result

    def _make_anew(self) -> None:
        """Leave the nodes that changed limits added to the models that have them, and go on with nodes of one's own."""
        self._compile(self.workbook, self.definitions, self.path)

    def _sources(self) -> list[tuple[str, Cell, str]]:
        """Return what is needed of assumptions and filters, the row of each, and its source or reason."""
        idle = {a.name for a in self.needed.idle}
        result = [(f"{a.name!r}", a.row, a.source) for a in self.assumptions if a.name not in idle]
        filters = (*self.filters, *self.forecast_filters)
        return result + [(f"{each.name!r} (a filter)", each.row, each.because) for each in filters]

    def _moving(self) -> set[Cell]:
        """Return the cells of the live assumptions whose range has more than one value, as far as it is known."""
        still = {name for name, (low, high) in self._ends.items() if low >= high}
        return {a.cell for a in self.live if a.name not in still}

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it was read from, its workbook first: no output may replace one of them."""
        feeding, functions = self.definitions.feeding, self.workbook.functions
        fed_by = dict.fromkeys(Path(each.source) for each in (() if feeding is None else feeding.feeds))
        return (self.path, *fed_by, *(() if functions is None else (functions.path,)))

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        """The rows of `xlmc_evidence`, with numbers where they are used; those that are not used among them."""
        used = {each.name: each.evidence for each in self.filters if each.evidence is not None}
        result = (each if not each.used else used.get(each.name) for each in self.definitions.evidence)
        return tuple(each for each in result if each is not None)

    def certain(self, n: int) -> dict[str, NDArray[np.float64]]:
        """Name of each chance -> `(n,)` the number that keeps every trial, for whoever draws the assumptions alone."""
        return {a.name: np.zeros(n) for a in self.chances}

    @property
    def read(self) -> frozenset[Cell]:
        """Every cell that the forecasts, filters and checks read, blank cells of ranges among them."""
        cells = self.lowering.read | (frozenset() if self._checks is None else self._checks.read)
        return cells | cells_read(self.definitions, cells)

    @property
    def tabulated(self) -> frozenset[Cell]:
        """The cells of what-if data tables that are computed in every trial."""
        return frozenset(computed_tables(self.definitions))

    @property
    def trees(self) -> dict[Cell, ir.Expression]:
        """Every formula cell that the forecasts, filters and checks need, with its resolved tree."""
        of_checks = {} if self._checks is None else dict(self._checks.graph.formulas)
        return of_checks | dict(self.needed.graph.formulas)

    @property
    def folds_nothing(self) -> bool:
        """Whether no definition holds a number that was computed from cells when the workbook was read."""
        return not self._folded and not self.definitions.rewritten

    def reads_elsewhere(self, cells: Collection[Cell]) -> bool:
        """Whether anything but the rows of tables may read one of these cells, which are of such rows."""
        if not cells:
            return False
        own, read = {a.cell for a in self.assumptions}, self.read
        return not self.folds_nothing or any(cell in read and cell not in own for cell in cells)

    @property
    def saved(self) -> frozenset[Cell]:
        """The cells among them that xlmc cannot compute, and that hold what Excel saved."""
        return frozenset(self.lowering.saved)

    @property
    def fallible(self) -> frozenset[str]:
        """Names of the assumptions whose draws may be errors: their parameters vary."""
        return frozenset(name for stage in self.needed.stages[1:] for name in stage)

    def function(self, inputs: Mapping[str, ArrayLike]) -> dict[str, NDArray[np.float64]]:
        """Return the workbook as a function: values of every live assumption in, every forecast out. Filters are not
        asked.

        Args:
            inputs: name of the assumption -> `(n,)` or a number.

        Returns:
            Name of the forecast -> `(n,)`; NaN where the cell is an error, a text or blank.

        Raises:
            SimulationError: an assumption is missing, unknown or frozen, or the values are of different lengths.
        """
        full, n = self.points(inputs)
        if n == 0:
            return {forecast.name: np.empty(0) for forecast in self.forecasts}
        needed = frozenset(a.name for a in self.live)
        evaluator = NumpyProgram.of(self.lowering, self._forecast_targets, [], needed).evaluator(n)
        columns = evaluator.filters(full, n)
        return {f.name: column.as_floats() for f, column in zip(self.forecasts, columns, strict=True)}

    def points(self, inputs: Mapping[str, ArrayLike]) -> tuple[dict[str, NDArray[np.float64]], int]:
        """Return the values of every live assumption as engines take them, and how many, see `input_points`."""
        return input_points(self.assumptions, self.live, inputs)

    def program(self, engine: str) -> Program:
        """Compile the filters and forecasts for an engine once.

        Raises:
            SimulationError: there is no such engine, or a library that it needs is missing.
            FormulaError: it has no such formulas.
        """
        if engine not in ENGINES:
            raise SimulationError(f"there is no engine {engine!r}", hint=f"choose one of {', '.join(ENGINES)}")
        row, known, ends = ENGINES[engine], self._programs.get(engine), self._ends
        if known is not None and known.ends != ends:
            ends = hull(known.ends, ends)
        if known is None or (row.bounded and known.ends != ends):
            parts = self.lowering, self.filter_targets, self.answer_targets, self.fallible
            more = {"bounds": NodeBounds(self.lowering.dag, ends)} if row.bounded else {}
            known = self._programs[engine] = _Compiled(self._filtering(row.load()(*parts, **more)), ends)
        return known.program

    def evaluator(self, targets: Sequence[Target], block: int) -> Evaluator:
        """Make what computes such targets too, all of them in every trial, for blocks of up to `block` trials."""
        return NumpyProgram.of(self.lowering, targets, [], self.fallible).evaluator(block)

    def sampler(
        self,
        seed: int,
        block: int,
        engine: str = "numpy",
        plan: SamplingPlan | None = None,
        filler: Filler | None = None,
        draws: Mapping[str, Draw] | None = None,
    ) -> Sampler:
        """Make the draws, block by block; for one thread. They are the same for every engine; by default independent.

        With a filler, its uniforms are taken instead of the seed's; `draws` are taken instead of the model's.
        """
        draw_named = (self.draws if draws is None else draws).__getitem__
        stages = [DrawStage(tuple(map(draw_named, names)), dynamic=i > 0) for i, names in enumerate(self.needed.stages)]
        parameters = [dynamic_parameters(stage.draws, self.lowering, block) for stage in stages[1:]]
        return Sampler(seed, stages, self.groups, parameters, block, plan, filler or ENGINES[engine].filler)

    def quantiles(
        self, probabilities: ArrayLike, names: Collection[str] | None = None
    ) -> dict[str, NDArray[np.float64]]:
        """Return the quantiles of every live assumption, before filtering and whatever it is correlated with.

        Where parameters vary, they are those with all other assumptions at their base values, or at their medians where
        they have none.

        Args:
            probabilities: `(q,)`, between 0 and 1.
            names: of the assumptions that are wanted; None for all.

        Returns:
            Name of the assumption -> `(q,)`; NaN where the parameters are not a distribution.
        """
        wanted = np.atleast_1d(np.asarray(probabilities, np.float64))
        frozen: dict[str, NDArray[np.float64]] = {}
        result: dict[str, NDArray[np.float64]] = {}
        needs_medians = len(self.needed.stages) > 1
        for number, stage in enumerate(self.needed.stages):
            varying: Mapping[Cell, NDArray[np.float64]] = {}
            if number:  # no chance: its parameters are numbers
                varying = dynamic_parameters([self.draws[name] for name in stage], self.lowering, 1)(frozen, 1)
            for name in (name for name in stage if name in self.bases):
                base = self.bases[name]
                if names is None or name in names or (base is None and needs_medians):
                    values = self.draws[name].percentiles(np.append(wanted, 0.5), varying)
                    result[name], frozen[name] = values[:-1], values[-1:]
                if base is not None:
                    frozen[name] = np.full(1, base)
        return result

    def program_of(self, filters: Sequence[Target]) -> Program:
        """Other targets instead of the filters, and the forecasts, compiled for the engine `numpy`."""
        return self._filtering(NumpyProgram.of(self.lowering, filters, self.answer_targets, self.fallible))

    def _filtering(self, program: Program) -> Program:
        """Return the program that discards trials of forecasts with filters of their own, where there are any."""
        if not self.forecast_filters:
            return program
        return FilteringProgram(program, filters_by_forecast(self.forecasts, self.forecast_filters))

    def filtered(self, evaluator: Evaluator) -> Evaluator:
        """Make an evaluator of the targets of answers that discards trials of forecasts with filters of their own."""
        if not self.forecast_filters:
            return evaluator
        return FilteringEvaluator(evaluator, filters_by_forecast(self.forecasts, self.forecast_filters))

    @cached_property
    def categories(self) -> tuple[int, ...]:
        """The numbers of the forecasts whose answers are texts: the row says so, or each of some trials gives one."""
        kinds = [self.lowering.dag.types[self.lowering.target(target)] for target in self._forecast_targets]
        asked = [(number, each.kind) for number, each in enumerate(self.forecasts)]
        result = {number for number, kind in asked if kind is StatedAs.CATEGORY}
        unsure = [n for n, kind in asked if kind is None and kinds[n] not in (Kind.NUMBER, Kind.LOGICAL)]
        if unsure:
            targets = [self._forecast_targets[number] for number in unsure]
            columns = self.evaluator(targets, _TRIED).filters(self.sampler(0, _TRIED).draw(0), _TRIED)
            result |= {number for number, column in zip(unsure, columns, strict=True) if are_texts(column)}
        return tuple(sorted(result))

    @cached_property
    def two_valued(self) -> frozenset[str]:
        """The names of the forecasts whose formulas give TRUE and FALSE, or 1 and 0 by `IF`, and nothing else."""
        targets = zip(self.forecasts, self._forecast_targets, strict=True)
        return frozenset(
            each.name for each, target in targets if is_two_valued(self.lowering.dag, self.lowering.target(target))
        )

    @cached_property
    def formats(self) -> dict[str, str]:
        """The number format of each forecast's cell, by name; `General` where it has none or the file does not say."""
        hosts = [host_of(each.cell) for each in self.forecasts]
        return {f.name: code for f, code in zip(self.forecasts, formats_of(self.workbook, hosts), strict=True)}

    @cached_property
    def input_forms(self) -> dict[str, Form]:
        """The form of each assumption whose cell shows dates or times, percentages or amounts of money, by name."""
        hosts = [host_of(each.cell) for each in self.assumptions]
        forms = zip(self.assumptions, forms_of(self.workbook, hosts), strict=True)
        return {each.name: form for each, form in forms if form.kind is not stating.Kind.NUMBER}

    def check_program(self) -> Program:
        """Make the cells of the checks filters, a function of the live assumptions; others stand at their
        base values.
        """
        assert self._checks is not None, "the workbook has no checks"
        targets = [Target(check.cell, check.cell) for check in self.checks]
        return NumpyProgram.of(self._checks, targets, [], self.fallible)

    @property
    def checked(self) -> tuple[Assumption, ...]:
        """The live assumptions that the checks need."""
        reached = frozenset() if self._checks is None else self._checks.graph.reached
        return tuple(a for a in self.live if a.cell in reached)

    @property
    def filter_targets(self) -> list[Target]:
        """What the filters ask, 1 where it holds."""
        return [Target(filter_condition(filter_), filter_.cell) for filter_ in self.filters]

    @property
    def _forecast_targets(self) -> list[Target]:
        return [Target(forecast.cell, forecast.cell) for forecast in self.forecasts]

    @property
    def answer_targets(self) -> list[Target]:
        """The forecasts, and what their own filters ask."""
        return [*self._forecast_targets, *conditions_of(self.forecast_filters)]

    def _check_targets(self) -> None:
        """Lower every target once, so that a fault is reported when the workbook is loaded."""
        for target in (*self.filter_targets, *self.answer_targets):
            self.lowering.target(target)
