"""Evidence: what was read, whether it agrees with the model and with itself, and what each item moves."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import evidence_text
from xlmc.errors import capitalised
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.diagnostics.agreement import Verdict
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE, Shown
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.montecarlo.diagnostics.agreement import Agreement, Answer, ItemAgreement
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["evidence_blocks", "item_table", "means_tables", "section", "trials_sentence"]

_ITEM_HEADS: Final = (
    "Evidence",
    "Reading",
    "Keeps alone",
    "Given the others",
    "Ratio",
    "Chance of such a reading",
    "z of best trial",
    "Verdict",
)

_MEANING: Final = (
    "Shares are shares of the trials that pass all other filters. Chance: that of a reading as far from the model as "
    "this one, or farther, given its error and the other evidence. Below 1 % an item is strained; below 0.1 %, or if "
    "it lies beyond all trials, it is inconsistent. z of best trial: standard deviations from the reading to the "
    "trial that agrees best with all evidence. It does not count against an item that it keeps few trials."
)

_MOVES_MEANING: Final = (
    "Each trial counts with the chance that the evidence keeps it. Effective trials: the number of trials of equal "
    "weight that would say as much; the standard errors come from them."
)

_BAD: Final = (Verdict.INCONSISTENT, Verdict.STRAINED, Verdict.TOO_FEW)
_MOST: Final = 4
"""Forecasts whose means stand side by side."""


def evidence_blocks(simulation: RunResult, names: Collection[str], *, full: bool) -> Iterator[Block]:
    """Yield all that is said of evidence; nothing where none is used.

    Args:
        simulation: the finished run.
        names: of the forecasts to show.
        full: with standard deviations and ranges.
    """
    agreement = simulation.agreement
    if agreement is None:
        return
    yield Paragraph(f"{capitalised(agreement.sentence)}.", "warning" if agreement.verdict in _BAD else "text")
    for remark in agreement.remarks:
        if remark != agreement.sentence:
            yield Paragraph(f"{capitalised(remark)}.")
    yield item_table(agreement)
    yield Paragraph(trials_sentence(agreement), "small")
    yield Paragraph(_MEANING, "small")
    yield from [_moves(simulation, agreement, names)] if full else means_tables(simulation, agreement, names)
    yield Paragraph(_MOVES_MEANING, "small")
    yield _sources(simulation)


def trials_sentence(agreement: Agreement) -> str:
    """Say what the evidence is judged by."""
    return (
        f"Judged by {count_text(agreement.trials)} trials of the same seed, of which "
        f"{count_text(agreement.past)} pass all other filters."
    )


def item_table(agreement: Agreement) -> Table:
    """Return each item, alone and with the others."""
    several = len(agreement.items) > 1
    rows = [_item(each, several) for each in agreement.items]
    if several:
        best = "" if agreement.best_z is None else Shown(agreement.best_z, "0.00")
        whole = (Measured(agreement.together, "share"), Measured(None), Measured(agreement.ratio))
        rows.append(("All together", "", *whole, "", best, agreement.verdict.value))
    widths = (1.7, 2.2, 1.3, 1.3, 1.3, 1.1, 0.7, 1.3)
    return Table("", _ITEM_HEADS, tuple(rows), (5, 6), widths, "Each item, and with the others.")


def _item(item: ItemAgreement, several: bool) -> tuple[Content, ...]:
    return (
        item.name,
        evidence_text(item.evidence),
        Measured(item.alone, "share"),
        Measured(item.given_others if several else None, "share", nothing=NONE),
        Measured(item.ratio if several else None, nothing=NONE),
        Shown(item.chance_text or NONE),
        Shown(NONE) if item.best_z is None else Shown(item.best_z, "0.00"),
        Shown(item.verdict.value, look="warning" if item.verdict in _BAD else "text"),
    )


def _moves(simulation: RunResult, agreement: Agreement, names: Collection[str]) -> Table:
    """Return what each set of items makes of each forecast."""
    heads = ("Forecast", "With", "Effective trials", "Mean", "Standard deviation", "Range from", "to")
    rows = [_move(simulation, each) for each in agreement.answers if each.forecast in names]
    return Table("", heads, tuple(rows), caption="What each item moves.")


def _move(simulation: RunResult, answer: Answer) -> tuple[Content, ...]:
    form = simulation.results[answer.forecast].form
    units = f", {answer.units}" if answer.units else ""
    counted = form.kind is Kind.YES_NO
    others = [("spread", answer.standard_deviation), ("number", answer.low), ("number", answer.high)]
    return (
        f"{answer.forecast}{units}",
        answer.used,
        cells.count(round(answer.effective)),
        _mean(simulation, answer),
        *(Measured(None if counted else each, what, form, like=answer.mean) for what, each in others),
    )


def _mean(simulation: RunResult, answer: Answer) -> Measured:
    form = simulation.results[answer.forecast].form
    return Measured(answer.mean, "share" if form.kind is Kind.YES_NO else "number", form, nothing=NONE)


def means_tables(simulation: RunResult, agreement: Agreement, names: Collection[str]) -> Iterator[Table]:
    """Yield the means of forecasts side by side, with a row for each set of items."""
    chosen = [each for each in agreement.evidence_trials.forecasts if each in names]
    for first in range(0, len(chosen), _MOST):
        shown = chosen[first : first + _MOST]
        rows: dict[str, list[Answer]] = {}
        for each in agreement.answers:
            if each.forecast in shown:
                rows.setdefault(each.used, []).append(each)
        yield Table(
            "",
            ("With", "Effective trials", *shown),
            tuple(
                (
                    used,
                    cells.count(round(max(each.effective for each in answers))),
                    *(_mean(simulation, each) for each in answers),
                )
                for used, answers in rows.items()
            ),
            widths=(1.8, 1.0, *[1.5] * len(shown)),
            caption="What each item of evidence moves: the means of the forecasts.",
        )


def _sources(simulation: RunResult) -> Table:
    return Table(
        "",
        ("Evidence", "Cell", "Reading and error", "Source"),
        tuple(
            (each.name, str(each.cell), evidence_text(each), each.source or NONE) for each in simulation.model.evidence
        ),
        widths=(2.0, 1.4, 3.0, 3.6),
        caption="The rows of xlmc_evidence.",
        spans=(1, 1, 4, 6),
    )


def section(material: Material) -> Iterator[Block]:
    """Yield what is said of evidence, in brief."""
    return evidence_blocks(material.simulation, material.forecasts, full=False)
