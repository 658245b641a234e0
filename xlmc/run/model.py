"""A workbook understood and compiled: ready to be sampled and evaluated."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.address import Cell
from xlmc.definitions.model import Assumption, Check, Definitions, Filter, Forecast, name_key
from xlmc.definitions.reader import read_definitions
from xlmc.errors import DefinitionError, Notice, SimulationError
from xlmc.evaluation.engine import Evaluator, Program, Target
from xlmc.evaluation.engines import ENGINES
from xlmc.evaluation.graph.lower import Lowering
from xlmc.evaluation.graph.widening import widened
from xlmc.evaluation.numpy.numpy_engine import NumpyProgram
from xlmc.run.base_parameters import with_base_parameters
from xlmc.run.correlating import correlated_groups, repair_notices, tie_notices
from xlmc.run.drawing import draw_of, dynamic_parameters
from xlmc.run.filter_values import filter_faults
from xlmc.run.remarks import example_notices, still_notices
from xlmc.run.scene import Scene, condition, definitions_of_checks, in_order, refuse_without_base, survey
from xlmc.sampling.draws import CorrelatedGroup, Draw, Filler, Sampler, Stage
from xlmc.sampling.plan import Plan
from xlmc.workbook import Workbook, read_workbook
from xlmc.workbook.collecting import paused_collection

__all__ = ["Model", "load", "lowered", "understood"]


def load(path: str | Path) -> Model:
    """Read a workbook and compile what its forecasts and filters need.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError, FormulaError: as for `understood`.
    """
    with paused_collection():
        return understood(read_workbook(path), Path(path))


def understood(workbook: Workbook, path: Path) -> Model:
    """The model of a workbook that was read.

    Raises:
        DefinitionError: a definition is not what it must be; all faulty ones are listed.
        FormulaError: a needed cell cannot be computed.
    """
    with paused_collection():
        definitions = read_definitions(workbook, ENGINES)
        if definitions.problems:
            raise _joined(definitions.problems)
        model = Model(workbook, definitions, path)
        if faults := filter_faults(model):
            raise _joined(faults)
        return model


def _joined(problems: Sequence[DefinitionError]) -> DefinitionError:
    return problems[0] if len(problems) == 1 else DefinitionError("\n".join(str(p) for p in problems).rstrip("."))


def lowered(workbook: Workbook, definitions: Definitions) -> tuple[Scene, Lowering]:
    """What the forecasts and filters need, and its nodes.

    Raises:
        FormulaError, DefinitionError: as for `load`.
    """
    inputs = {a.cell: name_key(a.name) for a in definitions.assumptions if not a.frozen}
    held = {a.cell: a.base for a in definitions.assumptions if a.frozen and a.base is not None}
    scenes: list[Scene] = []

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        scenes.append(survey(workbook, definitions, more))
        return Lowering(scenes[-1].graph, inputs, held)

    lowering = widened(lower)
    return in_order(scenes[-1], lowering.led_to), lowering


def _lowered_checks(workbook: Workbook, definitions: Definitions, live: Sequence[Assumption]) -> Lowering | None:
    """The nodes of the checks, apart from those of the run, which they must not change; None without checks.

    Raises:
        FormulaError, DefinitionError: a check cannot be computed.
    """
    if not definitions.checks:
        return None
    asked = definitions_of_checks(definitions, live)
    scene, lowering = lowered(workbook, asked)
    refuse_without_base(definitions.checks, scene, asked)
    for check in definitions.checks:
        lowering.target(Target(check.cell, check.cell))
    return lowering


class Model:
    """A workbook's assumptions, forecasts and filters, and the function that computes them.

    Attributes:
        workbook, definitions, path: what it was made from.
        assumptions, forecasts, filters, checks: as defined.
        live: the assumptions that are drawn: needed and not frozen.
        groups: of correlated ones among them.
        notices: what the person should know.
    """

    def __init__(self, workbook: Workbook, definitions: Definitions, path: Path) -> None:
        definitions = with_base_parameters(workbook, definitions)
        self.workbook, self.definitions, self.path = workbook, definitions, path
        self.scene, self._lowering = lowered(workbook, definitions)
        self.live: tuple[Assumption, ...] = self.scene.live
        self._draws = {a.name: draw_of(a, self._lowering) for a in self.live}
        names = [a.name for a in self.live]
        self.groups: tuple[CorrelatedGroup, ...] = tuple(
            correlated_groups(definitions.correlations, names, self._draws)
        )
        self._programs: dict[str, Program] = {}
        self._check_targets()
        self._checks = _lowered_checks(workbook, definitions, self.live)
        repairs = repair_notices(self.groups, definitions.correlations, names)
        remarks = *still_notices(self.scene, self._draws, self.forecasts), *example_notices(definitions, self.scene)
        idle = self.scene.notices(frozenset() if self._checks is None else self._checks.graph.reached)
        ties = tie_notices(self.groups, definitions.correlations, self._draws)
        notices = workbook.notices, definitions.notices, idle, self._lowering.notices, ties, repairs, remarks
        self.notices: tuple[Notice, ...] = tuple(notice for part in notices for notice in part)

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        return self.definitions.assumptions

    @property
    def forecasts(self) -> tuple[Forecast, ...]:
        return self.definitions.forecasts

    @property
    def filters(self) -> tuple[Filter, ...]:
        return self.definitions.filters

    @property
    def checks(self) -> tuple[Check, ...]:
        return self.definitions.checks

    @property
    def read(self) -> frozenset[Cell]:
        """Every cell that the forecasts, filters and checks read, blank cells of ranges among them."""
        return self._lowering.read | (frozenset() if self._checks is None else self._checks.read)

    @property
    def saved(self) -> frozenset[Cell]:
        """The cells among them that xlmc cannot compute, and that hold what Excel saved."""
        return frozenset(self._lowering.saved)

    @property
    def draws(self) -> Mapping[str, Draw]:
        """Name of a live assumption -> how it is drawn."""
        return self._draws

    @property
    def lowering(self) -> Lowering:
        """The nodes of the needed cells."""
        return self._lowering

    @property
    def fallible(self) -> frozenset[str]:
        """Keys of the assumptions whose draws may be errors: their parameters vary."""
        return frozenset(name_key(a.name) for stage in self.scene.stages[1:] for a in stage)

    def function(self, inputs: Mapping[str, ArrayLike]) -> dict[str, NDArray[np.float64]]:
        """The workbook as a function: values of every live assumption in, every forecast out. Filters are not asked.

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
        needed = frozenset(name_key(a.name) for a in self.live)
        evaluator = NumpyProgram.of(self._lowering, self._forecast_targets, [], needed).evaluator(n)
        columns = evaluator.filters(full, n)
        return {f.name: column.as_floats() for f, column in zip(self.forecasts, columns, strict=True)}

    def points(self, inputs: Mapping[str, ArrayLike]) -> tuple[dict[str, NDArray[np.float64]], int]:
        """Values of every live assumption as engines take them: key -> `(n,)`, in the order of `live`, and `n`.

        Args:
            inputs: name of the assumption -> `(n,)` or a number.

        Raises:
            SimulationError: an assumption is missing, unknown or frozen, or the values are of different lengths.
        """
        given = {name_key(name): np.asarray(values, np.float64) for name, values in inputs.items()}
        self._check_names(inputs)
        sizes = {values.size for values in given.values() if values.ndim} - {1} or {1}
        if len(sizes) > 1 or any(values.ndim > 1 for values in given.values()):
            hint = "give lists of the same length"
            raise SimulationError("an assumption takes one number or one list of numbers", hint=hint)
        (n,) = sizes
        keys = [name_key(a.name) for a in self.live]
        return {key: np.ascontiguousarray(np.broadcast_to(given[key], (n,))) for key in keys}, n

    def _check_names(self, names: Collection[str]) -> None:
        known = {name_key(a.name): a for a in self.assumptions}
        for name in names:
            if name_key(name) not in known:
                hint = f"choose from {', '.join(repr(a.name) for a in self.live)}"
                raise SimulationError(f"there is no assumption {name!r}", hint=hint)
            if known[name_key(name)].frozen:
                raise SimulationError(f"the assumption {name!r} is frozen", hint="it is held at its cell's own value")
        given = {name_key(name) for name in names}
        missing = [a.name for a in self.live if name_key(a.name) not in given]
        if missing:
            raise SimulationError(f"no values for the assumption {missing[0]!r}", hint="give every live assumption")

    def program(self, engine: str) -> Program:
        """The filters and forecasts, compiled for an engine once.

        Raises:
            SimulationError: there is no such engine.
        """
        if engine not in ENGINES:
            raise SimulationError(f"there is no engine {engine!r}", hint=f"choose one of {', '.join(ENGINES)}")
        if engine not in self._programs:
            parts = self._lowering, self.filter_targets, self._forecast_targets, self.fallible
            with paused_collection():
                self._programs[engine] = ENGINES[engine].program(*parts, self._supports)
        return self._programs[engine]

    @property
    def _supports(self) -> dict[str, tuple[float, float]]:
        """Key of an assumption -> its least and largest draw, where both are known and finite."""
        found = {draw.name: draw.support() for draw in self._draws.values()}
        return {name: ends for name, ends in found.items() if ends is not None}

    def evaluator(self, targets: Sequence[Target], block: int) -> Evaluator:
        """What computes such targets too, all of them in every trial, for blocks of up to `block` trials."""
        return NumpyProgram.of(self._lowering, targets, [], self.fallible).evaluator(block)

    def sampler(
        self,
        seed: int,
        block: int,
        engine: str = "numpy",
        plan: Plan | None = None,
        filler: Filler | None = None,
    ) -> Sampler:
        """The draws, block by block; for one thread. They are the same for every engine; by default independent.

        With a filler, its uniforms take the place of the seed's.
        """
        draws = [tuple(self._draws[a.name] for a in stage) for stage in self.scene.stages]
        stages = [Stage(stage, dynamic=i > 0) for i, stage in enumerate(draws)]
        parameters = [dynamic_parameters(stage, self._lowering, block) for stage in draws[1:]]
        return Sampler(seed, stages, self.groups, parameters, block, plan, filler or ENGINES[engine].filler)

    def quantiles(self, probabilities: ArrayLike) -> dict[str, NDArray[np.float64]]:
        """The quantiles of every live assumption, before filtering and whatever it is correlated with.

        Where parameters vary, they are those with all other assumptions at their base values, or at their medians where
        they have none.

        Args:
            probabilities: `(q,)`, between 0 and 1.

        Returns:
            Name of the assumption -> `(q,)`; NaN where the parameters are no distribution.
        """
        wanted = np.atleast_1d(np.asarray(probabilities, np.float64))
        held: dict[str, NDArray[np.float64]] = {}
        found: dict[str, NDArray[np.float64]] = {}
        for place, stage in enumerate(self.scene.stages):
            draws = [self._draws[a.name] for a in stage]
            varying = dynamic_parameters(draws, self._lowering, 1)(held, 1) if place else {}
            for assumption, draw in zip(stage, draws, strict=True):
                values = np.append(wanted, 0.5)
                draw.fill(values, varying)
                found[assumption.name] = values[:-1]
                held[draw.name] = values[-1:] if assumption.base is None else np.full(1, assumption.base)
        return found

    def program_of(self, filters: Sequence[Target]) -> Program:
        """Other targets in place of the filters, and the forecasts, compiled for the engine `numpy`."""
        return NumpyProgram.of(self._lowering, filters, self._forecast_targets, self.fallible)

    def check_program(self) -> Program:
        """The cells of the checks as filters, a function of the live assumptions; others stand at their base values."""
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
        return [Target(condition(filter_), filter_.cell) for filter_ in self.filters]

    @property
    def _forecast_targets(self) -> list[Target]:
        return [Target(forecast.cell, forecast.cell) for forecast in self.forecasts]

    def _check_targets(self) -> None:
        """Lower every target once, so that a fault is told when the workbook is loaded."""
        for target in (*self.filter_targets, *self._forecast_targets):
            self._lowering.target(target)
