"""What people use in Python: the model of a workbook, its runs, and all that can be asked of either.

What a model and a run *are* is in `xlmc.montecarlo.loop`; the methods here call the rooms that do the work.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

from xlmc.montecarlo.definitions.run_options import RunArguments, RunOptions
from xlmc.montecarlo.model import loading, model
from xlmc.montecarlo.simulation import simulation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.montecarlo.definitions.scenarios import Scenario
    from xlmc.montecarlo.simulation.simulate import OnProgress

__all__ = ["Model", "Simulation", "load", "open_run"]


class Simulation(simulation.Simulation):
    """A finished run that can write files and draw figures.

    `xlmc.montecarlo.simulation.simulation.Simulation` says what it holds.
    """

    model: Model

    @property
    def scenarios(self) -> tuple[ScenarioAnswers, ...]:
        """The answers of the workbook as it is, then of each scenario; none unless `simulate(scenarios=True)` ran them.

        Each has a `name`, its `run`, the `acceptance`, and for each forecast `mean`, `low`, `high`, `above` and their
        `differences` to the workbook as it is.
        """
        from xlmc.analysis.studies.scenario_answers import scenario_answers

        return scenario_answers(self)

    @classmethod
    def of(cls, run: simulation.Simulation) -> Simulation:
        """The same run, and its model, with the methods of this module."""
        found = cls.__new__(cls)
        found.__dict__.update(run.__dict__, model=Model.of(run.model))
        return found

    @property
    def sentences(self) -> tuple[str, ...]:
        """The sentences that may be quoted, as on the sheet Certainty, without a full stop.

        Each forecast is stated at the resolution under `Report to`; of a bound one side alone, of a diagnostic nothing.
        """
        from xlmc.analysis.results.statements import statements

        return tuple(each.text for each in statements(self))

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

        return save(self, Path(path), overwrite=overwrite)

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

        return save_page(self, Path(path), beside=beside, overwrite=overwrite)

    def keep(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Save the run in a file that ends in `.xlmcrun`; `xlmc.open_run` gives it back.

        Raises:
            WorkbookError: the file cannot be written.
            SimulationError: the workbook was not read from a file.
        """
        from xlmc.analysis.results.saved import keep

        return keep(self, Path(path), overwrite=overwrite)

    def extract(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write the accepted trials, with assumptions and forecasts, to a `.csv` or a `.parquet` file.

        Raises:
            WorkbookError: the file has another ending, or cannot be written.
            SimulationError: Parquet needs pyarrow, which is not installed.
        """
        from xlmc.outputs.extract import extract

        return extract(self, Path(path), overwrite=overwrite)

    def save_json(self, path: str | Path, *, overwrite: bool = False) -> Path:
        """Write all results as JSON; docs/json.md describes it.

        Raises:
            WorkbookError: the file cannot be written, or does not end in `.json`.
        """
        from xlmc.outputs.json_document import save_json

        return save_json(self, Path(path), overwrite=overwrite)

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
        return save_report(self, Path(path), wanted, overwrite=overwrite)

    def plot(self) -> Figure:
        """A matplotlib figure: every forecast's histogram and cumulative share, with the central range shaded.

        Raises:
            SimulationError: matplotlib is not installed, or there is nothing to draw.
        """
        from xlmc.outputs.plot import plot

        return plot(self)


class Model(model.Model):
    """A workbook's assumptions, forecasts and filters, which can be simulated.

    See `xlmc.montecarlo.model.model.Model`.
    """

    @classmethod
    def of(cls, known: model.Model) -> Model:
        """The same model, with the methods of this module."""
        if isinstance(known, cls):
            return known
        found = cls.__new__(cls)
        found.__dict__.update(known.__dict__)
        return found

    def scenario(self, scenario: str | Scenario) -> Model:
        """The model of the workbook in a scenario: one of the table `xlmc_scenarios` by its name, or one made here.

        Raises:
            SimulationError: there is no scenario of this name.
            DefinitionError: the scenario is not possible.
            FormulaError: a cell cannot be computed in it.
        """
        from xlmc.analysis.studies.scenario_answers import model_of

        return Model.of(model_of(self, scenario))

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

        return write_edited(edited_workbook(self, scenario), Path(path), overwrite=overwrite)

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
            from xlmc.analysis.studies.scenario_answers import models_of

            models_of(self)  # a scenario that is not possible is refused before the run
        return Simulation.of(run_model(self, asked, progress=progress, tell=tell))


def load(path: str | Path) -> Model:
    """Read a workbook and compile what its forecasts and filters need.

    Raises:
        WorkbookError: the file cannot be read.
        DefinitionError: a definition is not what it must be; all faulty ones are listed.
        FormulaError: a needed cell cannot be computed.
    """
    return Model.of(loading.load(path))


def open_run(path: str | Path) -> Simulation:
    """The run that `Simulation.keep` saved in a file: every statistic is the same to the last bit.

    Raises:
        WorkbookError: the file cannot be read, or is no saved run.
        XlmcError: its workbook cannot be understood any more.
    """
    from xlmc.analysis.results.saved import open_run

    return Simulation.of(open_run(path))
