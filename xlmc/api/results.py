"""The results of a run: accepted trials, counts, statistics, and the files that show them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.api.changes import Changes, run_of_a_file
from xlmc.errors import Notice

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.montecarlo.definitions.run_settings import Settings
    from xlmc.montecarlo.diagnostics.agreement import Agreement
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.loop.blocks import FilterTally
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.loop.stopping import Stopped
    from xlmc.montecarlo.rare.account import RareAccount
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["Results"]

Floats = NDArray[np.float64]


class Results:
    """What a finished run found, and the files that show it.

    `m` is the number of accepted trials.
    """

    def __init__(self, run: RunResult, changes: Changes | None = None) -> None:
        self._run, self._changes = run, changes

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
        from xlmc.analysis.results.statements.sentences import statements

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

        return save(run_of_a_file(self._run, self._changes), Path(path), overwrite=overwrite)

    def save_page(self, path: str | Path, *, beside: Results | None = None, overwrite: bool = False) -> Path:
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

        return keep(run_of_a_file(self._run, self._changes), Path(path), overwrite=overwrite)

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
            kind: `histogram`, `cumulative`, `tornado`, `scatter`, `trend`, `before-after`, or `drawing`, which shows
                trials over the workbook's drawing; None for a histogram and the cumulative share side by side.
            ax: axes to draw into; None for a figure of its own.

        Raises:
            SimulationError: matplotlib is not installed, there is no such kind or forecast, or nothing to draw.
        """
        from xlmc.outputs.plot import plot

        return plot(self._run, forecast, kind, ax)
