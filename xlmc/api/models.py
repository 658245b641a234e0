"""The model of a workbook or of a function, and its runs.

A `Model` holds a `CompiledModel`, and a `Simulation` a `RunResult`, which do the work.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Final, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.api.changes import Changes
from xlmc.api.results import Results
from xlmc.errors import Notice, SimulationError
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.run_options import RunArguments, RunOptions
from xlmc.montecarlo.model import loading

if TYPE_CHECKING:
    from xlmc.analysis.studies.optimising import OptimiseArguments, Optimised
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Assumption, Check, Filter, Forecast
    from xlmc.montecarlo.definitions.evidence import Evidence
    from xlmc.montecarlo.definitions.scenarios import Scenario
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.model.python_function import FilterColumns, ForecastColumns, Vectorised
    from xlmc.montecarlo.simulation.simulate import OnProgress

__all__ = ["Model", "Simulation", "load", "model", "open_run"]

Floats = NDArray[np.float64]

_SETTINGS: Final = frozenset(
    {
        *("trials", "seed", "sampling", "engine", "evidence", "detailed", "number_style"),
        *("rare", "time_limit", "forecasts"),
        *("until_accepted", "precision", "precision_of", "confidence", "adaptive"),
    }
)
"""Keywords of `Model.with_` that are settings of a run."""


class Simulation(Results):
    """A finished run: accepted trials, counts, statistics, and the files that show them.

    Of a large run the columns lie in temporary files, as read-only arrays, for as long as it lives. `m` is the number
    of accepted trials.
    """

    @property
    def model(self) -> Model:
        """The model that was run."""
        return Model(self._run.model, self._changes)


class Model:
    """A workbook's assumptions, forecasts and filters, which can be simulated and used as a function."""

    def __init__(self, compiled: CompiledModel, changes: Changes | None = None) -> None:
        self._compiled, self._changes = compiled, changes

    def __repr__(self) -> str:
        changes = "" if self._changes is None else f", with {self._changes.words}"
        return f"<Model: {self.workbook.name}{changes}>"

    def _repr_html_(self) -> str:
        """Return what a notebook shows: assumptions, forecasts, filters."""
        from xlmc.outputs.notebook import model_html

        return model_html(self._compiled)

    @property
    def path(self) -> Path:
        """Where the workbook is."""
        return self._compiled.path

    @property
    def workbook(self) -> Workbook:
        """What was read of the file: `xlmc.excel.load` describes it."""
        return self._compiled.workbook

    @property
    def assumptions(self) -> tuple[Assumption, ...]:
        """The assumptions as defined, each with `name`, `cell`, `distribution`, `base`, …"""
        return self._compiled.assumptions

    @property
    def live(self) -> tuple[Assumption, ...]:
        """The assumptions that are drawn: some forecast or filter needs them, and they are not frozen."""
        return self._compiled.live

    @property
    def bases(self) -> Mapping[str, float | None]:
        """Name of each live assumption -> its base value; None if its cell is blank."""
        return self._compiled.bases

    @property
    def forecasts(self) -> tuple[Forecast, ...]:
        """The forecasts as defined, each with `name`, `cell`, `units`, …"""
        return self._compiled.forecasts

    @property
    def filters(self) -> tuple[Filter, ...]:
        """The filters as defined, each with `name`, `cell` and its limits; those of some forecasts only come last."""
        return (*self._compiled.filters, *self._compiled.forecast_filters)

    @property
    def checks(self) -> tuple[Check, ...]:
        """The checks as defined."""
        return self._compiled.checks

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        """The rows of `xlmc_evidence`, those that are not used among them."""
        return self._compiled.evidence

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What the person should know before a run."""
        return self._compiled.notices

    def function(self, inputs: Mapping[str, ArrayLike]) -> dict[str, Floats]:
        """Compute the workbook as a function: values of every live assumption in, every forecast out.

        Filters are not asked.

        Args:
            inputs: name of the assumption -> `(n,)` or a number.

        Returns:
            Name of the forecast -> `(n,)`; NaN where the cell is an error, a text or blank.

        Raises:
            SimulationError: an assumption is missing, unknown or frozen, or the values are of different lengths.
        """
        return self._compiled.function(inputs)

    def quantiles(self, probabilities: ArrayLike) -> dict[str, Floats]:
        """Return the quantiles of every live assumption, before filtering and whatever it is correlated with.

        Where parameters vary, they are those with all other assumptions at their base values, or at their medians where
        they have none.

        Args:
            probabilities: `(q,)`, between 0 and 1.

        Returns:
            Name of the assumption -> `(q,)`; NaN where the parameters are not a distribution.
        """
        return self._compiled.quantiles(probabilities)

    def scenario(self, scenario: str | Scenario) -> Model:
        """Return the model of a scenario: one of the table `xlmc_scenarios` by its name, or one made here.

        Raises:
            SimulationError: there is no scenario of this name.
            DefinitionError: the scenario is not possible.
            FormulaError: a cell cannot be computed in it.
        """
        from xlmc.analysis.studies.scenario_answers import scenario_named

        return self._with(scenario_named(self._compiled, scenario))

    def with_(
        self, changes: Mapping[str, Distribution | float] | None = None, /, **named: Distribution | float | str | None
    ) -> Model:
        """Return the model with other distributions, values or settings; this one and its workbook stay as they are.

        `model.with_(friction=Uniform(0.6, 0.8), trials=10_000)` draws an assumption from another distribution;
        `model.with_(friction=0.7)` holds it at a value.

        Args:
            changes: name of an assumption -> its distribution, or the value to hold it at.
            named: the same by keyword, where blanks and signs are underscores: `road_friction`; and settings of a run:
                `trials`, `seed`, `sampling`, `engine`, `evidence`, `until_accepted`, `precision`, …

        Raises:
            SimulationError: there is no such assumption, or a setting is out of its range.
            DefinitionError: the change is not possible.
        """
        from xlmc.montecarlo.definitions.scenarios import Change, Frozen, Redrawn, Scenario
        from xlmc.montecarlo.model.keywords import assumption_named

        settings = {name: value for name, value in named.items() if name in _SETTINGS}
        by_name = {**(changes or {}), **{name: value for name, value in named.items() if name not in _SETTINGS}}
        result: list[Change] = []
        for name, value in by_name.items():
            assumption = assumption_named(self._compiled, name)
            if isinstance(value, Distribution):
                result.append(Redrawn(assumption, value))
            elif isinstance(value, Real) and not isinstance(value, bool):
                result.append(Frozen(assumption, float(value)))
            else:
                hint = "Give a distribution, such as xlmc.Uniform(0.6, 0.8), or a number to hold it at"
                raise SimulationError(f"{name!r} cannot be {value!r}", hint=hint)
        changed = self._with(Scenario("changed in Python", tuple(result))) if result else self
        if not settings:
            return changed
        compiled = changed._compiled
        asked = RunOptions.of(**settings).settings(compiled.definitions.settings)
        definitions = replace(compiled.definitions, settings=asked)
        return Model(compiled.changed(compiled.workbook, definitions), changed._changes)

    def frozen(self, *names: str) -> Model:
        """Return the model with these assumptions held at their base values.

        Raises:
            SimulationError: there is no such assumption.
            DefinitionError: it has no base value.
        """
        from xlmc.montecarlo.definitions.scenarios import Frozen, Scenario
        from xlmc.montecarlo.model.keywords import assumption_named

        frozen = tuple(Frozen(assumption_named(self._compiled, name)) for name in names)
        return self._with(Scenario("changed in Python", frozen))

    def _with(self, scenario: Scenario) -> Model:
        from xlmc.analysis.studies.scenario_answers import model_of
        from xlmc.montecarlo.definitions.scenarios import Scenario

        if not scenario.changes:
            return self
        own = self._compiled if self._changes is None else self._changes.own
        before = () if self._changes is None else self._changes.scenario.changes
        every = Scenario(scenario.name, (*before, *scenario.changes))
        return Model(model_of(self._compiled, scenario), Changes(own, every))

    def save_scenario(self, scenario: str | Scenario, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write a copy of the workbook with a scenario typed into its cells, and give the path back.

        Formulas that depend on these cells get their new values; every other byte stays as it is.

        Args:
            scenario: a name in the table `xlmc_scenarios`, or one made here.
            path: where to.
            overwrite: replace any other file, and type into the workbook itself where the path is its own.

        Raises:
            SimulationError: there is no scenario of this name.
            DefinitionError: the scenario is not possible, or a table lacks a column for it.
            WorkbookError: a cell holds a formula, or the file cannot be written.
        """
        from xlmc.analysis.studies.scenario_workbook import edited_workbook, write_edited

        return write_edited(edited_workbook(self._compiled, scenario), Path(path), overwrite=overwrite)

    def simulate(
        self,
        trials: int | None = None,
        seed: int | None = None,
        *,
        progress: OnProgress | None = None,
        tell: Callable[[str], None] | None = None,
        **options: Unpack[RunArguments],
    ) -> Simulation:
        """Run the simulation; what is not given comes from the workbook's settings.

        However the work is divided, the result is the same to the last bit. `trials` or a goal (`until_accepted`,
        `precision`, `adaptive`) replaces all that the settings say of the length of the run.

        Args:
            trials: how many, 1 or more; with a goal the most, by default 10⁹.
            seed: 0 or more.
            until_accepted: accepted trials, of which the last ends the run; 2 or more.
            rare: `auto`, where accepted trials are so rare that the limit of trials would come before
                `until_accepted`, learn where they are and draw there; `never`; or `always`.
            precision: largest half width of intervals, of the number itself (`"1%"`) or in its units (`0.1`).
            precision_of: of which numbers: `mean`, `sd`, `range`, percentiles such as `p75.5`; by default `mean,range`.
            confidence: of these intervals, by default 95 %.
            adaptive: significant digits that must be stable, as in JCGM 101, 7.9.
            forecasts: names of those whose precision or stability counts; by default all.
            time_limit: seconds, or such as `5m`, after which the run ends with the block of trials it is in.
            engine: `numpy`, `jit`, compiled for long runs, or `formulas`, the slow reference.
            sampling: `mc`, Monte Carlo; `lhs`, Latin hypercube; `lhs500`, the same in blocks of 500; or `sobol`,
                scrambled Sobol. All but the first run whole replicates (independent parts of the run), and so
                sometimes a few more trials.
            number_style: the signs of thousands and decimals where people read numbers: `1,234.5`, `1.234,5`,
                `1 234,5`, `1 234.5`, `1'234.5`, `1234.5` or `1234,5`.
            evidence: how evidence with a normal or lognormal error is used: `rejection`, `weights`, or `auto`, which
                decides by the run's first trials.
            scenarios: run the scenarios of the table `xlmc_scenarios`, too, when `scenarios` of the run is asked for,
                or the first of its files is written.
            detailed: how many forecasts, from the first on, sensitivity, charts and page tell of; by default 20.
            jobs: threads or processes.
            scheduler: `threads`; `processes`; `local`, a Dask cluster of this machine; or the address of a Dask
                scheduler. By default processes for a long run with several jobs, else threads.
            workers: of the local cluster; by default one for each processor.
            keep_inputs: of how many accepted trials, from the first on, the draws are kept; None for all.
            keep_interrupted: end the run with what it has when Ctrl-C is pressed, rather than raise KeyboardInterrupt.
            progress: called with a `Progress` (trials, accepted, share done, means) after every block.
            tell: called before the run with a sentence on the disk that it needs, if it needs any.

        Raises:
            SimulationError: an argument is out of its range, there is no space on the disk for the accepted trials,
                or the workers cannot be used.
            TypeError: there is no such argument.
        """
        from xlmc.montecarlo.simulation.simulate import run_model

        asked = RunOptions.of(trials=trials, seed=seed, **options)
        if asked.scenarios:
            from xlmc.analysis.studies.scenario_answers import refuse_no_scenarios

            refuse_no_scenarios(self._compiled)
        run = run_model(self._compiled, asked, progress=progress, tell=tell)
        return Simulation(run if self._changes is None else self._changes.named_in(run), self._changes)

    def optimise(self, **options: Unpack[OptimiseArguments]) -> Optimised:
        """Find the decisions with which a statistic of a forecast is largest, or smallest: see `xlmc.optimise`."""
        from xlmc.analysis.studies.optimising import optimise

        return optimise(self._compiled, **options)


def load(path: str | Path, *, feeds: Mapping[str, str] | None = None, functions: str | Path | None = None) -> Model:
    """Read a workbook and compile what its forecasts and filters need.

    Args:
        path: of the workbook.
        feeds: assumption -> the answer of another workbook that it takes in each trial, such as
            `{"Vehicle speed at the impact": "momentum.xlsx!Vehicle 1 impact speed"}`. The filters of both hold, and
            assumptions of one name are drawn once. An assumption of such a workbook may be fed in turn, as
            `"momentum.xlsx!Name"`.
        functions: a file of Python, which is run: its functions compute what formulas call by their names.

    Raises:
        WorkbookError: a file cannot be read.
        SimulationError: there is no such assumption or answer, or the workbooks cannot be joined.
        DefinitionError: a definition is not what it must be; all faulty ones are listed.
        FormulaError: a needed cell cannot be computed.
    """
    from xlmc.montecarlo.definitions.feeds import read_feeds

    return Model(loading.load(path, read_feeds(feeds or {}), functions_of(functions)))


def model(
    function: Vectorised,
    assumptions: Mapping[str, Distribution],
    forecasts: Mapping[str, str | ForecastColumns] | Sequence[str],
    filters: Mapping[str, FilterColumns] | Sequence[str] = (),
    *,
    correlations: Mapping[tuple[str, str], float] | None = None,
    name: str | None = None,
) -> Model:
    """Make a model of a function of NumPy arrays, without a workbook.

    The same sampling, filters, statistics, studies and reports work on it. `stability`, which looks at formulas, does
    not, and the derivatives of `methods` are differences. Only this process calls the function, in threads where there
    are several jobs.

    Args:
        function: takes an array `(n,)` for each assumption, by name, and gives a dict: name of each forecast and filter
            -> `(n,)`; where one is asked for, the array alone. It must compute each trial from that trial's values,
            and draw nothing at random.
        assumptions: name -> distribution.
        forecasts: name -> units, or a dict with some of `units`, `range_percent`, `threshold`, `report_to`, `kind` and
            `role`; or the names alone.
        filters: name -> dict with some of `at_least`, `at_most`, `above`, `below` and `because`; or names of logicals.
        correlations: (name, name) -> rank correlation.
        name: of the model; by default that of the function.

    Raises:
        DefinitionError: a definition is not what it must be.
        FormulaError: the function fails, does not take arrays, or gives something else than it must.
    """
    from xlmc.montecarlo.model.python_function import function_model

    return Model(function_model(function, assumptions, forecasts, filters, correlations=correlations, name=name))


def functions_of(path: str | Path | None) -> OwnFunctions | None:
    """Return the functions of a file; None for no file.

    Raises:
        WorkbookError: the file cannot be read or run, or defines none.
    """
    from xlmc.excel.own_functions import load_functions

    return None if path is None else load_functions(path)


def open_run(path: str | Path, model: Model | None = None, *, functions: str | Path | None = None) -> Simulation:
    """Return the run that `Simulation.keep` saved in a file: every statistic is the same to the last bit.

    Args:
        path: of the file.
        model: of `xlmc.model`, where a function of Python computed the run, which no file holds; changes of the model
            stand in the file.
        functions: the file of Python whose functions the run's formulas called: it must be the same.

    Raises:
        SimulationError: the model is of another function than the run.
        WorkbookError: the file cannot be read, or is no saved run.
        XlmcError: its workbook cannot be understood any more.
    """
    from xlmc.analysis.results.saved import open_run, refuse_other_function

    run = open_run(path, None if model is None else model._compiled.definitions.python, functions_of(functions))
    if model is not None:
        refuse_other_function(run, path)
    return Simulation(run)
