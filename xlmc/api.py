"""What people use in Python: the model of a workbook, its runs, and all that can be asked of either.

A `Model` holds a `CompiledModel`, and a `Simulation` a `RunResult`, which do the work. What stands here is what
docs/python.md lists, and stays as it is from version to version.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.errors import DefinitionError, Notice, SimulationError, XlmcError
from xlmc.montecarlo.definitions.distribution import Distribution
from xlmc.montecarlo.definitions.run_options import RunArguments, RunOptions
from xlmc.montecarlo.model import loading

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from xlmc.analysis.studies.comparison import CompareArguments, Comparison
    from xlmc.analysis.studies.fitting import Fitting
    from xlmc.analysis.studies.methods import Study
    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.analysis.studies.screening import ScreenArguments, Screening
    from xlmc.analysis.studies.sensitivity import Sensitivities
    from xlmc.analysis.studies.stability import Stability
    from xlmc.analysis.studies.verify import Verification
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Assumption, Check, Filter, Forecast
    from xlmc.montecarlo.definitions.evidence import Evidence
    from xlmc.montecarlo.definitions.run_settings import Settings
    from xlmc.montecarlo.definitions.scenarios import Scenario
    from xlmc.montecarlo.diagnostics.agreement import Agreement
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.loop.blocks import FilterTally
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.loop.stopping import Stopped
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.model.python_function import FilterColumns, ForecastColumns, Vectorised
    from xlmc.montecarlo.rare.account import RareAccount
    from xlmc.montecarlo.simulation.simulate import OnProgress
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.replay import Replayed

__all__ = [
    "Model",
    "Simulation",
    "check",
    "compare",
    "convert",
    "fit",
    "load",
    "methods",
    "model",
    "open_run",
    "replay",
    "screen",
    "sensitivities",
    "stability",
    "verify",
]

Floats = NDArray[np.float64]

_SETTINGS: Final = frozenset(
    {
        *("trials", "seed", "sampling", "engine", "evidence", "rare", "time_limit", "forecasts"),
        *("until_accepted", "precision", "precision_of", "confidence", "adaptive"),
    }
)
"""Keywords of `Model.with_` that are settings of a run."""


class Simulation:
    """A finished run: accepted trials, counts, statistics, and the files that show them.

    Of a large run the columns lie in temporary files, as read-only arrays, for as long as it lives. `m` is the number
    of accepted trials.
    """

    def __init__(self, run: RunResult, changed: _Changed | None = None) -> None:
        self._run, self._changed = run, changed

    def _repr_html_(self) -> str:
        """Return what a notebook shows: warnings, answers, filters, notices."""
        from xlmc.outputs.notebook import run_html

        return run_html(self._run)

    def __repr__(self) -> str:
        if self.rare is not None:
            return f"<Simulation: {self.accepted} accepted trials, found in {self.rare.evaluations} evaluations>"
        return f"<Simulation: {self.accepted} of {self.trials} trials accepted>"

    def __getitem__(self, name: str) -> ForecastResult:
        """Return the result of a forecast, by name whatever its case.

        Raises:
            KeyError: there is no such forecast.
        """
        return self._run[name]

    @property
    def model(self) -> Model:
        """The model that was run."""
        return Model(self._run.model, self._changed)

    @property
    def settings(self) -> Settings:
        """The settings of the run: `trials`, `seed`, `sampling`, `engine`, `evidence`, …"""
        return self._run.settings

    @property
    def trials(self) -> int:
        """How many trials were run; where accepted ones are rare, those before the search, which the counts are of."""
        return self._run.trials

    @property
    def accepted(self) -> int:
        """How many trials were accepted."""
        return self._run.accepted

    @property
    def acceptance(self) -> Estimate:
        """The share of accepted trials, with its error."""
        return self._run.acceptance

    @property
    def trial_index(self) -> NDArray[np.int64]:
        """`(m,)` the numbers of the accepted trials, from 0; where they are rare, in the order they were drawn in."""
        return self._run.trial_index

    @property
    def inputs(self) -> Mapping[str, Floats]:
        """Assumption -> its accepted draws, `(m,)`, or fewer where not all were to be kept."""
        return self._run.inputs

    @property
    def prior(self) -> Mapping[str, Floats]:
        """Assumption -> its draws before filtering, of the first trials."""
        return self._run.prior

    @property
    def forecasts(self) -> Mapping[str, Floats]:
        """Forecast -> `(m,)`, NaN where it has no number."""
        return self._run.forecasts

    @property
    def results(self) -> Mapping[str, ForecastResult]:
        """Forecast -> its result, in the order of the workbook."""
        return self._run.results

    @property
    def tally(self) -> FilterTally:
        """What each filter rejected, alone and together with others."""
        return self._run.tally

    @property
    def faults(self) -> Mapping[str, Counter[str]]:
        """Forecast -> fault, such as `#DIV/0!` -> accepted trials in which it has no number."""
        return self._run.faults

    @property
    def error_trials(self) -> int:
        """Trials that were lost to errors; each counts once."""
        return self._run.error_trials

    @property
    def stopped(self) -> Stopped:
        """What ended the run: `by`, `reached`, and a `sentence`."""
        return self._run.stopped

    @property
    def rare(self) -> RareAccount | None:
        """Where accepted trials come from where a search found them; None with plain trials."""
        return self._run.rare

    @property
    def agreement(self) -> Agreement | None:
        """Whether the evidence agrees with the model and with itself; None if no evidence is used."""
        return self._run.agreement

    @property
    def weights(self) -> Floats | None:
        """`(m,)` the weights of the accepted trials; None if they count alike."""
        return None if self._run.weighting is None else self._run.weighting.weights

    @property
    def checks(self) -> tuple[CheckResult, ...]:
        """The workbook's checks, at the base case and in the accepted trials."""
        return self._run.checks

    @property
    def warnings(self) -> list[str]:
        """Why the answer must not be used as it is; empty when it may be."""
        return self._run.warnings

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What else the reader of the answer should know."""
        return self._run.notices

    @property
    def scenarios(self) -> tuple[ScenarioAnswers, ...]:
        """The answers of the workbook as it is, then of each scenario; none unless `simulate(scenarios=True)` ran them.

        Each has a `name`, its `run`, the `acceptance`, and for each forecast `mean`, `low`, `high`, `above` and their
        `differences` to the workbook as it is. A scenario that is not possible is in `impossible_scenarios`.
        """
        from xlmc.analysis.studies.scenario_answers import scenario_answers

        return scenario_answers(self._run)

    @property
    def impossible_scenarios(self) -> Mapping[str, str]:
        """Why scenarios have no answers, by their names; see `scenarios`."""
        from xlmc.analysis.studies.scenario_answers import impossible_scenarios

        return impossible_scenarios(self._run)

    def frame(self, *, inputs: bool = True) -> pandas.DataFrame:
        """Return the accepted trials, one a row, indexed by trial: assumptions, then forecasts.

        An assumption with the name of a forecast is called `name (assumption)`; what is called `Trial`, as the index
        is, `Trial (assumption)` or `Trial (forecast)`. `frame.attrs["units"]` is a dict: column -> units.

        Args:
            inputs: with the assumptions.

        Raises:
            SimulationError: not all draws were kept.
        """
        return self._run.frame(inputs=inputs)

    @property
    def sentences(self) -> tuple[str, ...]:
        """The sentences that may be quoted, as on the sheet Certainty, without a full stop.

        Each forecast is stated at the resolution under `Report to`; of a bound one side alone, of a diagnostic nothing.
        """
        from xlmc.analysis.results.statements import statements

        return tuple(each.text for each in statements(self._run))

    def save(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the workbook with result sheets, and give the path back.

        As `save_page`, `keep` and `save_json` do, it replaces a file only where xlmc wrote it for the same workbook and
        nobody has changed it since; `extract`, whose tables bear no mark, replaces none.

        Args:
            path: where to.
            overwrite: replace any other file too, and write into the workbook itself where the path is its own.

        Raises:
            WorkbookError: the file is not ours to replace, or cannot be written.
        """
        from xlmc.outputs import save

        return save(_of_a_file(self._run, self._changed), Path(path), overwrite=overwrite)

    def save_page(self, path: str | Path, *, beside: Simulation | None = None, overwrite: bool = False) -> Path:
        """Write the results as one page for a browser, which needs no network.

        Args:
            path: where to; it ends in `.html` or `.htm`.
            beside: a second run, which is shown beside this one.
            overwrite: replace any other file, too.

        Raises:
            WorkbookError: the file does not end in `.html`, or cannot be written.
        """
        from xlmc.outputs.page import save_page

        second = None if beside is None else beside._run
        return save_page(self._run, Path(path), beside=second, overwrite=overwrite)

    def keep(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Save the run in a file that ends in `.xlmcrun`; `xlmc.open_run` gives it back.

        Raises:
            WorkbookError: the file cannot be written.
            SimulationError: the workbook was not read from a file.
        """
        from xlmc.analysis.results.saved import keep

        return keep(_of_a_file(self._run, self._changed), Path(path), overwrite=overwrite)

    def extract(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the accepted trials, with assumptions and forecasts, to a `.csv` or a `.parquet` file.

        Raises:
            WorkbookError: the file has another ending, or cannot be written.
            SimulationError: Parquet needs pyarrow, which is not installed.
        """
        from xlmc.outputs.extract import extract

        return extract(self._run, Path(path), overwrite=overwrite)

    def save_json(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write all results as JSON; docs/json.md describes it.

        Raises:
            WorkbookError: the file cannot be written, or does not end in `.json`.
        """
        from xlmc.outputs.json_document import save_json

        return save_json(self._run, Path(path), overwrite=overwrite)

    def save_report(
        self,
        path: str | Path,
        *,
        case: Mapping[str, str] | None = None,
        sections: Sequence[str] = (),
        forecasts: Sequence[str] = (),
        paper: str = "letter",
        overwrite: bool = False,
    ) -> Path:
        """Write the report to hand over: five to ten pages, as PDF or as a Word file; docs/report.md describes it.

        A report bears no mark of its own, so no file that is there is replaced unless `overwrite` says so.

        Args:
            path: where to; it ends in `.pdf` or `.docx`.
            case: what stands on the first page, such as `{"Case number": "2026-17"}`; wins over the table `xlmc_case`.
            sections: names of sections; by default all.
            forecasts: names of forecasts; by default all.
            paper: of the pages: `letter` or `a4`.
            overwrite: replace a file that is there.

        Raises:
            DefinitionError: the table `xlmc_case` is not what it must be.
            SimulationError: a library is missing, there is no such section, forecast or paper, or no font has a
                character.
            WorkbookError: the file has another ending, is there already, or cannot be written.
        """
        from xlmc.outputs.document import Wanted, save_report

        wanted = Wanted(case or {}, sections, forecasts, paper)
        return save_report(self._run, Path(path), wanted, overwrite=overwrite)

    def plot(self, forecast: str | None = None, kind: str | None = None, ax: Axes | None = None) -> Figure:
        """Return a matplotlib figure, which a notebook shows as it is.

        Args:
            forecast: its name; before and after filtering, that of an assumption. None for all forecasts, and where a
                kind is named for the first that can be drawn.
            kind: `histogram`, `cumulative`, `tornado`, `scatter`, `trend` or `before-after`; None for a histogram and
                the cumulative share side by side.
            ax: axes to draw into; None for a figure of its own.

        Raises:
            SimulationError: matplotlib is not installed, there is no such kind or forecast, or nothing to draw.
        """
        from xlmc.outputs.plot import plot

        return plot(self._run, forecast, kind, ax)


class Model:
    """A workbook's assumptions, forecasts and filters, which can be simulated and used as a function."""

    def __init__(self, compiled: CompiledModel, changed: _Changed | None = None) -> None:
        self._compiled, self._changed = compiled, changed

    def __repr__(self) -> str:
        changes = "" if self._changed is None else f", with {self._changed.words}"
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
        found: list[Change] = []
        for name, value in by_name.items():
            assumption = assumption_named(self._compiled, name)
            if isinstance(value, Distribution):
                found.append(Redrawn(assumption, value))
            elif isinstance(value, Real) and not isinstance(value, bool):
                found.append(Frozen(assumption, float(value)))
            else:
                hint = "Give a distribution, such as xlmc.Uniform(0.6, 0.8), or a number to hold it at"
                raise SimulationError(f"{name!r} cannot be {value!r}", hint=hint)
        changed = self._with(Scenario("changed in Python", tuple(found))) if found else self
        if not settings:
            return changed
        compiled = changed._compiled
        asked = RunOptions.of(**settings).settings(compiled.definitions.settings)
        definitions = replace(compiled.definitions, settings=asked)
        return Model(compiled.changed(compiled.workbook, definitions), changed._changed)

    def frozen(self, *names: str) -> Model:
        """Return the model with these assumptions held at their base values.

        Raises:
            SimulationError: there is no such assumption.
            DefinitionError: it has no base value.
        """
        from xlmc.montecarlo.definitions.scenarios import Frozen, Scenario
        from xlmc.montecarlo.model.keywords import assumption_named

        held = tuple(Frozen(assumption_named(self._compiled, name)) for name in names)
        return self._with(Scenario("changed in Python", held))

    def _with(self, scenario: Scenario) -> Model:
        from xlmc.analysis.studies.scenario_answers import model_of
        from xlmc.montecarlo.definitions.scenarios import Scenario

        own = self._compiled if self._changed is None else self._changed.own
        before = () if self._changed is None else self._changed.scenario.changes
        every = Scenario(scenario.name, (*before, *scenario.changes))
        return Model(model_of(self._compiled, scenario), _Changed(own, every))

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
            evidence: how evidence with a normal or lognormal error is used: `rejection`, `weights`, or `auto`, which
                decides by the run's first trials.
            scenarios: run the scenarios of the table `xlmc_scenarios`, too, when `scenarios` of the run is asked for,
                or the first of its files is written.
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
        return Simulation(run if self._changed is None else self._changed.named_in(run), self._changed)


@dataclass(frozen=True, slots=True)
class _Changed:
    """What a model differs in from that of its workbook.

    Attributes:
        own: the model of the workbook.
        scenario: all changes.
    """

    own: CompiledModel
    scenario: Scenario

    @property
    def words(self) -> str:
        """The changes, as results say them."""
        from xlmc.analysis.results.statements.in_words import changes_text

        return changes_text(self.scenario)

    def named_in(self, run: RunResult) -> RunResult:
        """Return the run with the sentence that it is none of the workbook as it is."""
        from xlmc.montecarlo.simulation.simulation import ChangedFrom

        book = self.own.workbook
        return replace(run, changed_from=ChangedFrom(book.name, book.sha256, tuple(self.words.split("; "))))


def _of_a_file(run: RunResult, changed: _Changed | None) -> RunResult:
    """Return the run of a workbook that says what was run: a copy with the changes typed in, where there are any.

    Raises:
        DefinitionError: a table lacks a column for a change.
        WorkbookError: a cell that changes holds a formula.
    """
    if changed is None:
        return run
    from xlmc.analysis.studies.scenario_workbook import edited_workbook
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.model.loading import build_model

    if changed.own.definitions.feeding is not None:
        hint = "Type the changes into the workbooks first, and run these"
        raise SimulationError("no file holds the workbooks of this run with their changes", hint=hint)
    book = read_workbook(edited_workbook(changed.own, changed.scenario).data, changed.own.workbook.name)
    model = build_model(book, changed.own.path, python=changed.own.definitions.python)
    return replace(run, model=model.changed(book, replace(model.definitions, settings=run.model.definitions.settings)))


def load(path: str | Path, *, feeds: Mapping[str, str] | None = None) -> Model:
    """Read a workbook and compile what its forecasts and filters need.

    Args:
        path: of the workbook.
        feeds: assumption -> the answer of another workbook that it takes in each trial, such as
            `{"Vehicle speed at the impact": "momentum.xlsx!Vehicle 1 impact speed"}`. The filters of both hold, and
            assumptions of one name are drawn once. An assumption of such a workbook may be fed in turn, as
            `"momentum.xlsx!Name"`.

    Raises:
        WorkbookError: a file cannot be read.
        SimulationError: there is no such assumption or answer, or the workbooks cannot be joined.
        DefinitionError: a definition is not what it must be; all faulty ones are listed.
        FormulaError: a needed cell cannot be computed.
    """
    from xlmc.montecarlo.definitions.feeds import read_feeds

    return Model(loading.load(path, read_feeds(feeds or {})))


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


def open_run(path: str | Path) -> Simulation:
    """Return the run that `Simulation.keep` saved in a file: every statistic is the same to the last bit.

    Raises:
        WorkbookError: the file cannot be read, or is no saved run.
        XlmcError: its workbook cannot be understood any more.
    """
    from xlmc.analysis.results.saved import open_run

    return Simulation(open_run(path))


def sensitivities(run: Simulation, *, assumptions: Collection[str] = ()) -> Sensitivities:
    """Compute what the answers of a finished run depend on. Nothing random is in it but the run's own draws.

    Args:
        run: with one forecast or more.
        assumptions: names of those that are measured for every forecast. Where there are more than 20, the others are
            measured for a forecast only if they are among the 20 that matter most for it.

    Raises:
        SimulationError: no assumption that is drawn has one of these names, or evidence weights the trials.
    """
    from xlmc.analysis.studies.sensitivity import sensitivities

    if run.weights is not None:
        raise SimulationError(
            "Evidence weights the trials of this run, and sensitivities count them alike",
            hint='Run it with evidence="rejection"',
        )
    return sensitivities(run._run, assumptions=assumptions)


def compare(
    first: Model,
    second: Model,
    tolerance: Iterable[str] | str = (),
    *,
    told: Callable[[str], None] | None = None,
    **options: Unpack[CompareArguments],
) -> Comparison:
    """Run two books of one scene over the same trials, and judge whether their answers agree.

    An assumption of the same name takes the same random numbers in both. Forecasts are paired by name. The trials are
    plain Monte Carlo, whatever the books' settings say.

    Args:
        first: a book; numbers are given in its units.
        second: the other; either may be the simpler.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD in the first book), `Name=0.5 mph`; a tenth of the SD
            where none is stated. It holds for mean, SD and both ends of the central range.
        told: the former name of `tell`.
        options: `pairs`, `feeds`, `trials`, `seed`, `engine`, `jobs`, `chance`, `causes` and `tell`, which
            `xlmc.analysis.studies.comparison.compare` describes.

    Raises:
        SimulationError: no forecast has a counterpart, a pair has units of two kinds, or an argument is out of its
            range.
    """
    from xlmc.analysis.studies.comparison import compare

    options.setdefault("tell", told)
    return compare(first._compiled, second._compiled, tolerance, **options)


def screen(
    model: Model,
    tolerance: Iterable[str] | str = (),
    *,
    told: Callable[[str], None] | None = None,
    **options: Unpack[ScreenArguments],
) -> Screening:
    """Find which assumptions may be frozen, and which filters left out, without moving an answer beyond the tolerance.

    The model and its workbook stay as they are. The trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: to screen.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD), `Name=0.5 mph`; a tenth of the SD where none is
            stated. It holds for mean, SD and both ends of the central range.
        told: the former name of `tell`.
        options: `chance`, `acceptance_tolerance`, `sets`, `judged_by`, `ends`, `trials`, `seed`, `engine`, `jobs` and
            `tell`, which `xlmc.analysis.studies.screening.screen` describes.

    Raises:
        SimulationError: an argument is out of its range, no name fits a set, or fewer than two trials are accepted, or
            give a number for any forecast.
    """
    from xlmc.analysis.studies.screening import screen

    options.setdefault("tell", told)
    return screen(model._compiled, tolerance, **options)


def check(path: str | Path) -> tuple[XlmcError, ...]:
    """Return every problem of a workbook, each with its cell: what keeps it from being run, and impossible scenarios.

    Raises:
        WorkbookError: the file cannot be read.
    """
    from xlmc.analysis.studies.scenario_answers import scenario_faults
    from xlmc.engine.engines import ENGINES
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels

    problems = read_definitions(calculate_labels(read_workbook(path)), ENGINES).problems
    if problems:
        return problems
    try:
        return tuple(scenario_faults(loading.load(path)).values())
    except XlmcError as error:
        return (error,)


def verify(path: str | Path, *, everything: bool = False) -> Verification:
    """Compute the formulas of a workbook again at the base case, and compare with the values that Excel saved.

    Args:
        path: of the workbook.
        everything: every formula cell, not only those that forecasts and filters need.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError: it defines neither a forecast nor a filter, and not everything is asked for.
    """
    from xlmc.analysis.studies.verify import verify
    from xlmc.engine.engines import ENGINES
    from xlmc.excel.workbook.reader import read_workbook
    from xlmc.montecarlo.definitions.definitions_reader import read_definitions
    from xlmc.montecarlo.model.labels import calculate_labels

    workbook = read_workbook(path)
    if everything:
        return verify(workbook)
    definitions = read_definitions(calculate_labels(workbook), ENGINES)
    if not definitions.forecasts and not definitions.filters:
        message, hint = "The workbook has no forecasts and no filters", "Give everything=True to check every formula"
        raise DefinitionError(message, where=workbook.name, hint=hint)
    return verify(workbook, definitions)


def fit(values: ArrayLike, *, kind: str | None = None, by: str = "aic") -> Fitting:
    """Rank the distributions that describe measurements.

    Args:
        values: `(n,)`, two or more, not all equal.
        kind: `continuous` or `counts`; None: counts where every value is a whole number from 0 up.
        by: `aic`, `bic`, `ad` or `ks`.

    Raises:
        SimulationError: the values cannot be fitted, or there is no such kind or criterion.
    """
    from xlmc.analysis.studies.fitting import CRITERIA, KINDS, fit

    for given, known in ((kind, KINDS), (by, CRITERIA)):
        if given is not None and given not in known:
            raise SimulationError(f"{given!r} is unknown here", hint=f"Choose one of {', '.join(known)}")
    return fit(values, kind=kind, by=by)


def methods(
    model: Model,
    *,
    accuracy: str = "1%",
    trials: int | None = None,
    replicates: int | None = None,
    reference_trials: int | None = None,
    seed: int | None = None,
    quick: bool = False,
) -> Study:
    """Measure what each method of uncertainty analysis costs on a model, and what it misses.

    Args:
        model: to measure them on.
        accuracy: wanted of mean, SD and both ends of the central range in 95 of 100 runs: `1%` of the range from 5 to
            95 %, or a number in the forecasts' units.
        trials: of the longest runs.
        replicates: runs of each length.
        reference_trials: of the long run that errors are measured against.
        seed: of the reference.
        quick: few and short runs, in about half a minute.

    Raises:
        SimulationError: an argument is out of its range, or the reference accepts too few trials.
    """
    from xlmc.analysis.studies.methods import quick_settings, study

    asked = {"trials": trials, "replicates": replicates, "reference_trials": reference_trials}
    given: dict[str, Any] = {name: value for name, value in asked.items() if value is not None}
    return study(model._compiled, accuracy=accuracy, seed=seed, **(quick_settings(given) if quick else given))


def stability(model: Model, *, trials: int | None = None, seed: int | None = None, jobs: int = 1) -> Stability:
    """Find where a model loses digits, or its numbers are not what they seem, within the ranges of its assumptions.

    Args:
        model: of a workbook.
        trials: of the run that is looked at; by default the book's own.
        seed: of it.
        jobs: threads or processes.

    Raises:
        SimulationError: an argument is out of its range, or a function of Python computes the model.
    """
    from xlmc.analysis.studies.stability import stability

    return stability(model._compiled, trials=trials, seed=seed, jobs=jobs)


def replay(path: str | Path, *, jobs: int = 1) -> Replayed:
    """Repeat the run that a result workbook or a saved run records, and say whether it is identical.

    Raises:
        WorkbookError: the file cannot be read, or holds no record.
        XlmcError: its workbook cannot be run.
    """
    from xlmc.outputs.replay import replay

    return replay(path, jobs=jobs)


def convert(path: str | Path, to: str | Path, *, overwrite: bool = False) -> Path:
    """Write a copy of a workbook of Crystal Ball or @RISK with its definitions as tables, and give the path back.

    Raises:
        WorkbookError: there is nothing to convert, or the file cannot be written.
        DefinitionError, FormulaError: the workbook cannot be understood.
    """
    from xlmc.outputs.conversion.convert import convert

    convert(loading.load(path), Path(to), overwrite=overwrite)
    return Path(to)
