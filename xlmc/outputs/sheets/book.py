"""All result sheets as a workbook of their own, built in memory: the same run gives the same bytes.

To add a sheet, write a module beside this one with a function that writes a `Page` of a run, and its row in `SHEETS`;
describe it in docs/guide.md. docs/adding.md has an example. The sheet stands where the row of a section names it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record import make_record
from xlmc.analysis.studies.sensitivity import Sensitivities, sensitivities
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.outputs.case_fields import case_of
from xlmc.outputs.document.sections import in_order
from xlmc.outputs.histogram import Figure, figures_of
from xlmc.outputs.sheets import (
    assumptions_sheet,
    bins_sheet,
    certainty_sheet,
    charts_sheet,
    evidence_sheet,
    limits_sheet,
    pairs_sheet,
    record_sheet,
    results_sheet,
    scenarios_sheet,
    sensitivity_sheet,
    statistics_sheet,
    trials_sheet,
)
from xlmc.outputs.sheets.bins_sheet import BinsAt
from xlmc.outputs.sheets.curves_sheet import Curves
from xlmc.outputs.sheets.page import Page
from xlmc.outputs.sheets.styles import CREATED, Styles
from xlmc.outputs.sheets.trials_sheet import TrialsAt

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.exact_book import ExactBook

__all__ = ["SHEETS", "ResultSheet", "Writing", "build_sheets"]


class Writing:
    """A result workbook that is being written, and what its sheets share.

    Attributes:
        book: as XlsxWriter builds it.
        simulation: the finished run.
        command: what the person typed, for the record.
        rows: the most accepted trials to write out.
        trials: where they stand, from the sheet Trials on.
        bins: where the bins of the histograms stand, from the sheet Bins on.
        pages: the sheets by their names.
    """

    trials: TrialsAt
    bins: Sequence[BinsAt]

    def __init__(
        self,
        book: ExactBook,
        simulation: RunResult,
        command: str | None,
        rows: int,
        sheets: Sequence[ResultSheet],
    ) -> None:
        self.book, self.simulation, self.command, self.rows = book, simulation, command, rows
        self.name = simulation.model.workbook.name
        styles, header = Styles(book), case_of(simulation.model.workbook, {}).in_a_line
        self.pages = {
            sheet.name: Page(book.add_worksheet(sheet.name), styles, sheet.widths, header)
            for sheet in sheets
            if sheet.wanted(self)
        }

    @cached_property
    def figures(self) -> list[Figure]:
        """The histograms of the detailed forecasts."""
        return figures_of(self.simulation, self.simulation.detailed)

    @cached_property
    def curves(self) -> Curves:
        """The sheet Curves, which takes the numbers of the charts as they are drawn."""
        return Curves(self.pages["Curves"], self.name)

    @cached_property
    def dependence(self) -> Sensitivities:
        """What the answers depend on."""
        return sensitivities(self.simulation)


@dataclass(frozen=True, slots=True)
class ResultSheet:
    """A sheet of the result workbook.

    Attributes:
        name: on its tab.
        write: fills its page.
        widths: of its columns, from the first on; empty where `write` sets them.
        after: the sheets whose cells it shows; they are written first.
        wanted: whether a run has one.
    """

    name: str
    write: Callable[[Page, Writing], object]
    widths: tuple[float, ...] = ()
    after: tuple[str, ...] = ()
    wanted: Callable[[Writing], bool] = lambda _: True


def _charts(page: Page, run: Writing) -> None:
    charts_sheet.write_charts(page, run.book, run.simulation, run.figures, run.bins, run.curves)


def _pairs(page: Page, run: Writing) -> None:
    pairs_sheet.write_pairs(page, run.book, run.simulation, run.curves, run.trials)


def _sensitivity(page: Page, run: Writing) -> None:
    sensitivity_sheet.write_sensitivity(page, run.book, run.dependence, run.simulation.model.workbook)


def _limits(page: Page, run: Writing) -> None:
    limits_sheet.write_limits(page, run.book, run.dependence, run.name)


def _has_limits(run: Writing) -> bool:
    """Whether a limit could be moved."""
    if not _is_even(run):
        return False
    result = run.dependence
    return bool(result.filter_limits or result.varying_limits or result.omitted_limits)


def _is_even(run: Writing) -> bool:
    """Whether all trials count alike, which some sheets take for granted."""
    return run.simulation.weighting is None


def _trials(page: Page, run: Writing) -> None:
    run.trials = trials_sheet.write_trials(page, run.simulation, run.rows)


def _bins(page: Page, run: Writing) -> None:
    run.bins = bins_sheet.write_bins(page, run.figures, run.name)


def _record(page: Page, run: Writing) -> None:
    record_sheet.write_record(page, make_record(run.simulation, run.command), run.name)


SHEETS: Final[tuple[ResultSheet, ...]] = (
    ResultSheet("Results", lambda page, run: results_sheet.write_results(page, run.simulation), results_sheet.WIDTHS),
    ResultSheet(
        "Evidence results",
        lambda page, run: evidence_sheet.write_evidence(page, run.simulation),
        evidence_sheet.WIDTHS,
        wanted=lambda run: run.simulation.agreement is not None,
    ),
    ResultSheet(
        "Scenarios",
        lambda page, run: scenarios_sheet.write_scenarios(page, run.simulation),
        scenarios_sheet.WIDTHS,
        wanted=lambda run: run.simulation.settings.scenarios,
    ),
    ResultSheet("Charts", _charts, charts_sheet.WIDTHS, after=("Bins",)),
    ResultSheet(
        "Statistics", lambda page, run: statistics_sheet.write_statistics(page, run.simulation), statistics_sheet.WIDTHS
    ),
    ResultSheet(
        "Certainty",
        lambda page, run: certainty_sheet.write_certainty(page, run.simulation, run.trials),
        certainty_sheet.WIDTHS,
        after=("Trials",),
        wanted=_is_even,
    ),
    ResultSheet("Pairs", _pairs, pairs_sheet.WIDTHS, after=("Charts", "Trials"), wanted=_is_even),
    ResultSheet(
        "Assumptions",
        lambda page, run: assumptions_sheet.write_assumptions(page, run.book, run.simulation, run.curves),
        assumptions_sheet.WIDTHS,
        after=("Pairs",),
    ),
    ResultSheet("Sensitivity", _sensitivity, sensitivity_sheet.WIDTHS, wanted=_is_even),
    ResultSheet("Filter limits", _limits, limits_sheet.WIDTHS, wanted=_has_limits),
    ResultSheet("Trials", _trials, trials_sheet.WIDTHS),
    ResultSheet("Bins", _bins),
    ResultSheet("Curves", lambda _, run: run.curves.finish(), after=("Charts", "Pairs", "Assumptions")),
    ResultSheet("Record", _record, record_sheet.WIDTHS),
)
"""The sheets that are more than blocks; the sections say in which order their tabs stand."""


@in_style_of("settings.number_style")
def build_sheets(
    simulation: RunResult,
    *,
    command: str | None = None,
    rows: int = trials_sheet.TRIAL_ROWS,
    further: Mapping[str, ResultSheet] | None = None,
) -> dict[str, bytes]:
    """Return the result sheets of a run, as the parts of a workbook that holds them alone.

    Args:
        simulation: the finished run.
        command: what the person typed, for the record.
        rows: the most accepted trials to write out.
        further: the sheets of the sections that have none in `SHEETS`, by the names of the sections.

    Raises:
        DefinitionError: the table `xlmc_case` is not what it must be.
    """
    from xlmc.outputs.sheets.exact_book import ExactBook

    with ExactBook() as book:
        book.set_properties({"created": CREATED})
        sheets = [*in_order("sheets", {sheet.name: sheet for sheet in SHEETS}, further or {}).values()]
        run = Writing(book, simulation, command, rows, sheets)
        waiting = [sheet for sheet in sheets if sheet.name in run.pages]
        while waiting:
            names = {sheet.name for sheet in waiting}
            sheet = next(each for each in waiting if names.isdisjoint(each.after))
            sheet.write(run.pages[sheet.name], run)
            waiting.remove(sheet)
    parts: dict[str, bytes] = book.parts
    return parts
