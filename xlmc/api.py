"""What people use in Python: the model of a workbook, its runs, and all that can be asked of either.

A `Model` holds a `CompiledModel`, and a `Simulation` a `RunResult`, which do the work. What stands here is what
docs/python.md lists, and stays as it is from version to version.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.errors import Notice
from xlmc.montecarlo.definitions.run_options import RunArguments, RunOptions
from xlmc.montecarlo.model import loading

if TYPE_CHECKING:
    import pandas
    from matplotlib.figure import Figure

    from xlmc.analysis.studies.comparison import CompareArguments, Comparison
    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.analysis.studies.screening import ScreenArguments, Screening
    from xlmc.analysis.studies.sensitivity import Sensitivities
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
    from xlmc.montecarlo.rare.account import RareAccount
    from xlmc.montecarlo.simulation.simulate import OnProgress
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["Model", "Simulation", "compare", "load", "open_run", "screen", "sensitivities"]

Floats = NDArray[np.float64]


class Simulation:
    """A finished run: accepted trials, counts, statistics, and the files that show them.

    Of a large run the columns lie in temporary files, as read-only arrays, for as long as it lives. `m` is the number
    of accepted trials.
    """

    def __init__(self, run: RunResult) -> None:
        self._run = run

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
        return Model(self._run.model)

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
        """Whether the evidence agrees with the model and with itself; None where no evidence is used."""
        return self._run.agreement

    @property
    def weights(self) -> Floats | None:
        """`(m,)` the weights of the accepted trials; None where they count alike."""
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
        is, `Trial (assumption)` or `Trial (forecast)`.

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

        return save(self._run, Path(path), overwrite=overwrite)

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

        return keep(self._run, Path(path), overwrite=overwrite)

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

    def plot(self) -> Figure:
        """Return a matplotlib figure: every forecast's histogram and cumulative share, with the central range shaded.

        Raises:
            SimulationError: matplotlib is not installed, or there is nothing to draw.
        """
        from xlmc.outputs.plot import plot

        return plot(self._run)


class Model:
    """A workbook's assumptions, forecasts and filters, which can be simulated and used as a function."""

    def __init__(self, compiled: CompiledModel) -> None:
        self._compiled = compiled

    def __repr__(self) -> str:
        return f"<Model: {self.workbook.name}>"

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
        """Name of each live assumption -> its base value; None where its cell is blank."""
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
        from xlmc.analysis.studies.scenario_answers import model_of

        return Model(model_of(self._compiled, scenario))

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
            SimulationError: an argument is out of its range, there is no room on the disk for the accepted trials,
                or the workers cannot be used.
            TypeError: there is no such argument.
        """
        from xlmc.montecarlo.simulation.simulate import run_model

        asked = RunOptions.of(trials=trials, seed=seed, **options)
        if asked.scenarios:
            from xlmc.analysis.studies.scenario_answers import refuse_no_scenarios

            refuse_no_scenarios(self._compiled)
        return Simulation(run_model(self._compiled, asked, progress=progress, tell=tell))


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
        SimulationError: no assumption that is drawn has one of these names.
    """
    from xlmc.analysis.studies.sensitivity import sensitivities

    return sensitivities(run._run, assumptions=assumptions)


def compare(
    first: Model, second: Model, tolerance: Iterable[str] | str = (), **options: Unpack[CompareArguments]
) -> Comparison:
    """Run two books of one scene over the same trials, and judge whether their answers agree.

    An assumption of the same name takes the same random numbers in both. Forecasts are paired by name. The trials are
    plain Monte Carlo, whatever the books' settings say.

    Args:
        first: a book; numbers are given in its units.
        second: the other; either may be the simpler.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD in the first book), `Name=0.5 mph`; a tenth of the SD
            where none is stated. It holds for mean, SD and both ends of the central range.
        options: `pairs`, `feeds`, `trials`, `seed`, `engine`, `jobs`, `chance`, `causes` and `told`, which
            `xlmc.analysis.studies.comparison.compare` describes.

    Raises:
        SimulationError: no forecast has a counterpart, a pair has units of two kinds, or an argument is out of its
            range.
    """
    from xlmc.analysis.studies.comparison import compare

    return compare(first._compiled, second._compiled, tolerance, **options)


def screen(model: Model, tolerance: Iterable[str] | str = (), **options: Unpack[ScreenArguments]) -> Screening:
    """Find which assumptions may be held, and which filters left out, without moving an answer beyond the tolerance.

    The model and its workbook stay as they are. The trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: to screen.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD), `Name=0.5 mph`; a tenth of the SD where none is
            stated. It holds for mean, SD and both ends of the central range.
        options: `chance`, `acceptance_tolerance`, `sets`, `judged_by`, `ends`, `trials`, `seed`, `engine`, `jobs` and
            `told`, which `xlmc.analysis.studies.screening.screen` describes.

    Raises:
        SimulationError: an argument is out of its range, no name fits a set, or fewer than two trials are accepted, or
            give a number for any forecast.
    """
    from xlmc.analysis.studies.screening import screen

    return screen(model._compiled, tolerance, **options)
