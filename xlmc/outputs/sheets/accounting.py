"""What Results and the page say of filters, errors and checks: what each asks, why, and which trials it concerns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.analysis.results.record.errors_met import ErrorMet, errors_met
from xlmc.analysis.results.statements.in_words import REJECTED_SENTENCE, discards_of, limits_text
from xlmc.montecarlo.diagnostics.checking import checks_sentence
from xlmc.montecarlo.statistics import proportion
from xlmc.montecarlo.statistics.number_text import count_text
from xlmc.outputs.sheets import cells
from xlmc.outputs.sheets.cells import Shown

if TYPE_CHECKING:
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["write_accounting", "write_checks"]


_FILTER_STARTS = (0, 1, 3, 5)
"""The columns that a filter, its cell, its limits and its reason begin in."""

_DISCARD_HEADERS = ("Filter", "Only for", "Cell", "Must be", "Discarded", "Share", "±", "Because")

_DISCARD_STARTS = (0, 1, 4, 5, 7, 8, 9, 10)

_CHECK_HEADERS = ("Check", "Cell", "Base case", "Trials failing", "Share", "±", "Because")

_CHECK_STARTS = (0, 1, 3, 5, 6, 7, 8)


def write_accounting(page: Page, simulation: RunResult, last: int) -> None:
    """Write the filters, what they rejected, and the errors.

    Args:
        page: the sheet.
        simulation: the run.
        last: the column that wide texts reach to.
    """
    page.heading("Filters: a trial is accepted when all hold")
    if not simulation.model.filters:
        page.wide("The workbook has no filters: every trial is accepted.", "paragraph", last)
    else:
        _write_filters(page, simulation, last)
        page.heading("Trials rejected by the filters")
        _write_rejections(page, simulation)
        if simulation.rare is not None:
            of = f"the first {count_text(simulation.trials)} trials"
            said = f"Counted among {of}, drawn before the search for accepted ones began."
            page.wide(said, "remark", last)
        if simulation.plan.size:
            page.wide(REJECTED_SENTENCE, "remark", last)
    if simulation.model.forecast_filters:
        _write_discards(page, simulation, last)
    _write_errors(page, simulation)


def _write_filters(page: Page, simulation: RunResult, last: int) -> None:
    headers = ("Filter", "Cell", "Must be", "Because")
    page.line([Shown(header, look="header left") for header in headers], _FILTER_STARTS, last)
    for number, filter_ in enumerate(simulation.model.filters, 1):
        texts = (str(filter_.cell), limits_text(filter_), filter_.because or cells.NONE)
        name = Shown(f"{number}. {filter_.name}", look="name")
        page.line([name, *(Shown(text) for text in texts)], _FILTER_STARTS, last)


def _write_rejections(page: Page, simulation: RunResult) -> None:
    tally, filters = simulation.tally, simulation.model.filters
    pairs = len(filters) if len(filters) > 1 else 0
    headers = ["Filter", "Error in it", "Rejected", "Share", "±", "Only by it", "Share", "±"]
    page.table(
        [*headers, *(f"Also by {other}" for other in range(1, pairs + 1))],
        [
            [
                Shown(f"{index + 1}. {filter_.name}", look="name"),
                cells.count(sum(tally.errors[index].values())),
                *_count_and_share(int(tally.rejected[index]), simulation.trials),
                *_count_and_share(int(tally.only[index]), simulation.trials),
                *(_pair(simulation, index, other) for other in range(pairs)),
            ]
            for index, filter_ in enumerate(filters)
        ],
    )


def _pair(simulation: RunResult, index: int, other: int) -> Shown:
    return Shown("") if index == other else cells.count(int(simulation.tally.together[index, other]))


def _write_discards(page: Page, simulation: RunResult, last: int) -> None:
    page.heading("Filters for some forecasts only")
    said = (
        f"These filters reject no trial. Of the {count_text(simulation.accepted)} accepted trials, a "
        "forecast named here counts "
        "those that its filters keep; all other forecasts count them all. A trial that two of its filters discard is "
        "counted for the first."
    )
    page.wide(said, "paragraph", last)
    page.line([Shown(header, look="header left") for header in _DISCARD_HEADERS], _DISCARD_STARTS, last)
    for found in discards_of(simulation):
        filter_ = found.filter
        texts = (found.forecast, str(filter_.cell), limits_text(filter_))
        line = [
            Shown(filter_.name, look="name"),
            *map(Shown, texts),
            *_count_and_share(found.trials, simulation.accepted),
        ]
        page.line([*line, Shown(filter_.because or cells.NONE)], _DISCARD_STARTS, last)
    page.row += 1


def _count_and_share(trials: int, of: int) -> list[Shown]:
    return [cells.count(trials), *cells.share(proportion(trials, of))]


def _write_errors(page: Page, simulation: RunResult) -> None:
    found = errors_met(simulation)
    if not found:
        return
    page.heading("Errors in cells")
    page.table(
        ["Name", "In a", "Cell", "Error", "Trials", "Share", "±"],
        [
            [
                Shown(met.name, look="name"),
                Shown(met.kind),
                Shown(str(met.cell)),
                Shown(met.error),
                *_count_and_share(met.trials, _among(simulation, met)),
            ]
            for met in found
        ],
    )


def _among(simulation: RunResult, met: ErrorMet) -> int:
    """How many trials an error was counted in; after a search, forecasts were computed in accepted trials alone."""
    return simulation.accepted if simulation.rare is not None and met.kind == "forecast" else simulation.trials


def write_checks(page: Page, simulation: RunResult, last: int) -> None:
    """Write the checks, and how many accepted trials fail each; nothing where the workbook has none.

    Args:
        page: the sheet.
        simulation: the run.
        last: the column that wide texts reach to.
    """
    checks = simulation.checks
    if not checks:
        return
    page.heading("Checks: each cell must be TRUE")
    page.line([Shown(header, look="header left") for header in _CHECK_HEADERS], _CHECK_STARTS, last)
    for check in checks:
        page.line(_check_line(check), _CHECK_STARTS, last)
    page.row += 1
    page.wide(f"{checks_sentence(checks)}. A check rejects no trial.", "remark", last)


def _check_line(check: CheckResult) -> list[Shown]:
    found = check.base.found
    return [
        Shown(check.name, look="name"),
        Shown(str(check.cell)),
        Shown(cells.NONE if found is None else found, look="warning" if check.holds is False else "text"),
        cells.count(check.failed),
        *cells.share(check.share),
        Shown(check.because or cells.NONE),
    ]
