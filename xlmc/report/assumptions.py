"""The sheet Assumptions: what each one is, why, and how the filters changed it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from xlmc.record.wording import distribution_text, status
from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.conditioning import Marginal, conditioning
from xlmc.statistics import Estimate

if TYPE_CHECKING:
    from xlmc.definitions import Assumption
    from xlmc.report.page import Page
    from xlmc.simulation import Simulation

__all__ = ["WIDTHS", "write_assumptions"]

WIDTHS = (34, 11, 10, *[9.5] * 14)
_LAST = len(WIDTHS) - 1
_STARTS = (0, 1, 2, 3, 5, 6, 10)
_MOVED, _NARROWED = 0.5, 0.8

_MEANING = (
    "Filters keep only the combinations that agree with the evidence. That is conditioning: an assumption that the "
    "evidence speaks about is distributed differently among the accepted trials, although its range is the same. A "
    "mean that moves by half a standard deviation or more, or a standard deviation that shrinks to 0.8 or less, is "
    "marked. An assumption that does not change is one the filters say nothing about."
)


def write_assumptions(page: Page, simulation: Simulation) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Assumptions", f"{name}: {simulation.accepted:,} of {simulation.trials:,} trials accepted")
    _write_definitions(page, simulation)
    _write_marginals(page, simulation)
    page.printed(name)


def _write_definitions(page: Page, simulation: Simulation) -> None:
    page.heading("As defined")
    headers = ("Assumption", "Cell", "Units", "Base case", "Status", "Distribution", "Source")
    page.spread(headers, _STARTS, _LAST, "header left")
    for assumption in simulation.model.assumptions:
        page.spread(_definition(simulation, assumption), _STARTS, _LAST, "text")
    _write_correlations(page, simulation)


def _definition(simulation: Simulation, assumption: Assumption) -> list[str]:
    return [
        assumption.name,
        str(assumption.cell),
        assumption.units,
        cells.NONE if assumption.base is None else f"{assumption.base:.10g}",
        status(simulation.model, assumption),
        distribution_text(assumption),
        assumption.source,
    ]


def _write_correlations(page: Page, simulation: Simulation) -> None:
    pairs = simulation.model.definitions.correlations
    if not pairs:
        return
    page.heading("Rank correlations")
    page.spread(["First", "Second", "Correlation"], (0, 1, 5), 6, "header left")
    for pair in pairs:
        page.spread([pair.first, pair.second, f"{pair.value:.10g}"], (0, 1, 5), 6, "text")


def _write_marginals(page: Page, simulation: Simulation) -> None:
    page.heading("Before and after filtering")
    page.wide(_MEANING, "paragraph", _LAST)
    page.row += 1
    page.table(_headers(), [line for name in simulation.inputs for line in _pair(simulation, name)])
    early = max((values.size for values in simulation.prior.values()), default=0)
    page.row += 1
    page.wide(f"Before filtering: the first {early:,} trials. ± is the standard error.", "remark", _LAST)


def _headers() -> list[str]:
    heads = ["Assumption", "", "Trials", "Mean", "±", "Standard deviation", "±", "5 %", "±", "50 %", "±", "95 %", "±"]
    return [*heads, "Shift of mean in SDs", "±", "SD after / before", "±"]


def _pair(simulation: Simulation, name: str) -> list[list[Shown]]:
    """The line of the draws before filtering, and that of the accepted ones with what has changed."""
    units = next(a.units for a in simulation.model.live if a.name == name)
    found = conditioning(simulation.prior[name], simulation.inputs[name])
    before = [cells.text(name, "name"), cells.text("before"), cells.count(found.prior.trials), *_marginal(found.prior)]
    after = [
        cells.text(units, "accepted text"),
        cells.text("accepted", "accepted text"),
        Shown(found.accepted.trials, "#,##0", "accepted"),
        *_marginal(found.accepted, "accepted"),
        *_change(found.shift, abs(found.shift.value) >= _MOVED),
        *_change(found.narrowing, found.narrowing.value <= _NARROWED),
    ]
    return [[*before, *[cells.BLANK] * 4], after]


def _marginal(found: Marginal, look: str = "number") -> list[Shown]:
    error = "error" if look == "number" else f"{look} error"
    estimates = (found.mean, found.standard_deviation, *found.percentiles.values())
    return [shown for estimate in estimates for shown in cells.estimate(estimate, look, error)]


def _change(found: Estimate, marked: bool) -> list[Shown]:
    return cells.estimate(found, "moved" if marked else "accepted", "accepted error")
