"""Every assumption before and after filtering, as the sheet Assumptions has it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.report.conditioning import PERCENTS, Conditioning, Marginal, conditioning
from xlmc.report.page.element import Html, element
from xlmc.report.page.flow import Flow
from xlmc.report.page.shown import estimate_html, number
from xlmc.report.sheets.assumptions import MEANING, MOVED, NARROWED, STRATIFIED, write_correlations
from xlmc.report.sheets.cells import NONE
from xlmc.results.record.wording import distribution_text, status
from xlmc.statistics import Estimate

if TYPE_CHECKING:
    from xlmc.definitions.model import Assumption
    from xlmc.run.simulation import Simulation

__all__ = ["inputs"]

_HEADS = ("Assumption", "Trials", "Mean", "Standard deviation", *(f"{each:g} %" for each in PERCENTS))
_CHANGES = ("Shift of mean in SDs", "SD accepted / before")
_COLUMNS = len(_HEADS) + len(_CHANGES)


def inputs(simulation: Simulation) -> Html:
    """The section."""
    correlations = Flow()
    write_correlations(correlations, simulation)
    names = enumerate((*_HEADS, *_CHANGES))
    heads = (element("th", head, scope="col", class_="number" if place else None) for place, head in names)
    bodies = (_assumption(simulation, assumption) for assumption in simulation.model.assumptions)
    table = element("table", element("thead", element("tr", *heads)), *bodies)
    return element(
        "section",
        element("h2", "Assumptions, before filtering and accepted"),
        element("p", MEANING),
        *(element("p", said, class_="remark") for said in _remarks(simulation)),
        element("div", table, class_="wide-table paired"),
        correlations.html,
        id="assumptions",
    )


def _remarks(simulation: Simulation) -> Iterator[str]:
    early = max((values.size for values in simulation.prior.values()), default=0)
    yield f"Before filtering: the first {early:,} trials. ± is the standard error."
    if simulation.plan.size:
        yield STRATIFIED
    if simulation.kept_inputs < simulation.accepted:
        yield f"Accepted: the first {simulation.kept_inputs:,} of {simulation.accepted:,} accepted trials."


def _assumption(simulation: Simulation, assumption: Assumption) -> Html:
    """Its name above two rows, in a body of their own so that they stay together."""
    named = element("tr", element("th", *_named(assumption), scope="rowgroup", colspan=str(_COLUMNS)))
    if assumption.name not in simulation.inputs:
        why = element("td", status(simulation.model, assumption.name, assumption.frozen), colspan=str(_COLUMNS))
        return element("tbody", named, element("tr", why))
    accepted, replicate = simulation.inputs[assumption.name], simulation.replicate
    kept = None if replicate is None else replicate[: accepted.size]
    found = conditioning(simulation.prior[assumption.name], accepted, kept)
    before = element("tr", *_marginal(found.prior, "before"), element("td"), element("td"))
    return element("tbody", named, before, element("tr", *_marginal(found.accepted, "accepted"), *_changes(found)))


def _named(assumption: Assumption) -> Iterator[Html | str]:
    base = NONE if assumption.base is None else f"{assumption.base:.9g}"
    yield element("b", assumption.name, f", {assumption.units}" if assumption.units else "")
    yield " "
    yield element("small", f"{assumption.cell}, base case {base}. {distribution_text(assumption)}. {assumption.source}")


def _marginal(found: Marginal, when: str) -> Iterator[Html]:
    yield element("td", when)
    yield element("td", number(found.trials, f"{found.trials:,}"), class_="number")
    for estimate in (found.mean, found.standard_deviation, *found.percentiles.values()):
        yield element("td", estimate_html(estimate), class_="number")


def _changes(found: Conditioning) -> Iterator[Html]:
    yield _change(found.shift, abs(found.shift.value) >= MOVED)
    yield _change(found.narrowing, found.narrowing.value <= NARROWED)


def _change(found: Estimate, marked: bool) -> Html:
    return element("td", estimate_html(found), class_="number moved" if marked else "number")
