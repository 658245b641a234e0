"""Evidence in tables of text: for the terminal and the document to hand over."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import evidence_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics.number_text import count_text, fixed_text, number_text
from xlmc.outputs.summary import estimate_text, share_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.diagnostics.agreement import Agreement, Answer, ItemAgreement

__all__ = [
    "ITEM_HEADS",
    "MEANING",
    "MOVES_MEANING",
    "item_rows",
    "move_rows",
    "trials_sentence",
]

ITEM_HEADS: Final = (
    "Evidence",
    "Reading",
    "Keeps alone",
    "Given the others",
    "Ratio",
    "Chance of such a reading",
    "z of best trial",
    "Verdict",
)

MEANING: Final = (
    "Shares are shares of the trials that pass all other filters. Chance: that of a reading as far from the model as "
    "this one, or farther, given its error and the other evidence. Below 1 % an item is strained; below 0.1 %, or if "
    "it lies beyond all trials, it is inconsistent. z of best trial: standard deviations from the reading to the "
    "trial that agrees best with all evidence. It does not count against an item that it keeps few trials."
)

MOVES_MEANING: Final = (
    "Each trial counts with the chance that the evidence keeps it. Effective trials: the number of trials of equal "
    "weight that would say as much; the standard errors come from them."
)

_NONE: Final = "–"


def trials_sentence(found: Agreement) -> str:
    """Say what the evidence is judged by."""
    return (
        f"Judged by {count_text(found.trials)} trials of the same seed, of which "
        f"{count_text(found.past)} pass all other filters."
    )


def _share(item: ItemAgreement, given: bool) -> str:
    return share_text(item.given_others if given else item.alone) or _NONE


def item_rows(found: Agreement) -> list[tuple[str, ...]]:
    """Yield a row for each item, under `ITEM_HEADS`."""
    several = len(found.items) > 1
    return [
        (
            each.name,
            evidence_text(each.evidence),
            _share(each, given=False),
            _share(each, given=True) if several else _NONE,
            (estimate_text(each.ratio) or _NONE) if several else _NONE,
            each.chance_text or _NONE,
            _NONE if each.best_z is None else number_text(each.best_z, 2),
            each.verdict.value,
        )
        for each in found.items
    ]


def move_rows(found: Agreement, forms: Mapping[str, Form]) -> list[tuple[str, ...]]:
    """Yield a row for each set of items: which, how many effective trials, and the mean of each of these forecasts.

    Args:
        found: the agreement.
        forms: forecast -> how its numbers are written.
    """
    rows: dict[str, list[Answer]] = {}
    for each in found.answers:
        if each.forecast in forms:
            rows.setdefault(each.used, []).append(each)
    return [
        (
            used,
            fixed_text(max(each.effective for each in answers), 0),
            *(_mean(each, forms[each.forecast]) or _NONE for each in answers),
        )
        for used, answers in rows.items()
    ]


def _mean(answer: Answer, form: Form) -> str:
    return share_text(answer.mean) if form.kind is Kind.YES_NO else form.estimate(answer.mean)
