"""Assumptions: what each one is, and how the filters changed what was drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record.definition_tables import correlations_met
from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.number_text import count_text, counted_text, number_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE, Shown
from xlmc.outputs.document.charts import shape_chart
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table, cell_text
from xlmc.outputs.filter_effect import draws_of_prior, filter_effect_of

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material
    from xlmc.outputs.filter_effect import FilterEffect, Marginal

__all__ = [
    "MEANING_OF_FILTERS",
    "assumption_change",
    "assumption_remarks",
    "assumption_rows",
    "correlation_blocks",
    "meaning_of_marks",
    "section",
]

_MOVED, _NARROWED = 0.5, 0.8

MEANING_OF_FILTERS: Final = (
    "Filters keep only the combinations in which they hold. So an assumption that they bear on is distributed "
    "differently among the accepted trials, although its range is the same."
)

_STRATIFIED: Final = (
    "Before filtering, ± is that of independent trials; the draws of this run are more even, so it is rather too "
    "large. Of the accepted draws, ± comes from the differences between the independent parts of the run (replicates)."
)

_CORRELATIONS: Final = (
    "“Asked for” and “drawn with” are before filtering. They differ if the correlations asked for are not all possible "
    "at once, or if an assumption takes so few different values that only a weaker one is possible. Filters change "
    "correlations as they change assumptions; those of the accepted trials are beside them."
)


def meaning_of_marks() -> str:
    """Say what filters do to assumptions, and what is marked."""
    return (
        f"{MEANING_OF_FILTERS} Marked: a mean that moved by {number_text(_MOVED)} standard deviations or more; a "
        f"standard deviation that shrank to {number_text(_NARROWED)} of what it was or less."
    )


def assumption_remarks(simulation: RunResult) -> Iterator[str]:
    """Yield the sentences that say which trials the numbers are from."""
    early = draws_of_prior(simulation)
    which = "Before filtering: t" if simulation.filters_act else "T"
    first = "trial" if early == 1 else f"{count_text(early)} trials"
    yield f"{which}he first {first}. ± is the standard error."
    if simulation.plan.size:
        yield _STRATIFIED
    if simulation.kept_inputs < simulation.accepted:
        yield (
            f"Accepted: the first {count_text(simulation.kept_inputs)} of "
            f"{counted_text(simulation.accepted, 'accepted trial')}."
        )


def assumption_rows(simulation: RunResult, name: str) -> list[tuple[Content, ...]]:
    """Return a row of the draws before filtering and one of the accepted ones, or one of all where no filter acts:
    which they are, trials, mean, standard deviation and percentiles; none where nothing was drawn.
    """
    effect, form = filter_effect_of(simulation, name), simulation.model.input_forms.get(name, PLAIN)
    if effect is None:
        return []
    if not simulation.filters_act:
        return [_row("all", effect.prior, form)]
    return [_row("before", effect.prior, form), _row("accepted", effect.accepted, form, "second ")]


def _row(which: str, marginal: Marginal, form: Form, second: str = "") -> tuple[Content, ...]:
    look = f"{second}number"
    return (
        Shown(which, look="second" if second else "text"),
        Shown(marginal.trials, cells.count(0).format, look),
        Measured(marginal.mean, form=form, look=look, nothing=NONE),
        Measured(marginal.standard_deviation, "spread", form, look, nothing=NONE),
        *(Measured(each, form=form, look=look, nothing=NONE) for each in marginal.percentiles.values()),
    )


def assumption_change(effect: FilterEffect) -> tuple[Measured, Measured]:
    """Return how far the mean moved, in standard deviations before filtering, and what part of these is left."""
    moved, narrowed = abs(effect.shift.value) >= _MOVED, effect.narrowing.value <= _NARROWED
    return (
        Measured(effect.shift, look="moved" if moved else "number", nothing=NONE),
        Measured(effect.narrowing, look="moved" if narrowed else "number", nothing=NONE),
    )


def correlation_blocks(simulation: RunResult) -> Iterator[Block]:
    """Yield the rank correlations, without those of 0 between draws that are apart anyway; or nothing."""
    met = [pair for pair in correlations_met(simulation) if pair.asked != 0.0 or pair.used is not None]
    if not met:
        return
    rows = tuple(
        (
            pair.first,
            pair.second,
            Shown(NONE, look="number") if pair.asked is None else cells.exact(pair.asked),
            Shown(NONE, look="number") if pair.used is None else cells.exact(round(pair.used, 6)),
            Measured(pair.accepted, nothing=NONE),
        )
        for pair in met
    )
    heads = ("First", "Second", "Asked for", "Drawn with", "Accepted")
    yield Table("", heads, rows, (), (3, 3, 1, 1, 1.5), "Rank correlations of assumptions.", (1, 4, 2, 2, 1))
    yield Paragraph(_CORRELATIONS, "small")


def section(material: Material) -> Iterator[Block]:
    """Yield every assumption before and after filtering, and their rank correlations."""
    simulation = material.simulation
    acts = simulation.filters_act
    if acts:
        yield Paragraph(
            f"{MEANING_OF_FILTERS} In the pictures, "
            "the draws before filtering are pale, and the line is the accepted ones."
        )
    rows = [_assumption_row(simulation, each) for each in simulation.model.assumptions]
    heads = (
        "Assumption",
        "Distribution and source",
        "Mean, before and accepted" if acts else "Mean",
        "SD, before and accepted" if acts else "SD",
        "Picture",
    )
    caption = "The assumptions before and after filtering." if acts else "The assumptions."
    yield Table("", heads, tuple(rows), (2, 3), (1.9, 3.4, 1.5, 1.5, 1.9), caption)
    yield Paragraph(" ".join(assumption_remarks(simulation)), "small")
    yield from correlation_blocks(simulation)


def _assumption_row(simulation: RunResult, each: Assumption) -> tuple[Content, ...]:
    name = f"{each.name}, {each.units}" if each.units else each.name
    words = f"{distribution_text(each)}. {each.source}".strip()
    rows = assumption_rows(simulation, each.name)
    if not rows:
        form = simulation.model.input_forms.get(each.name, PLAIN)
        base = "" if each.base is None else form.number(each.base)
        return name, words, f"{status(simulation.model, each.name, each.frozen)}: {base}", NONE, NONE
    return (
        name,
        words,
        *("\n".join(cell_text(row[column]) for row in rows) for column in (2, 3)),
        shape_chart(simulation, each.name) or NONE,
    )
