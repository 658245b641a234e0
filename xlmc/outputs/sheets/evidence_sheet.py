"""The sheet Evidence results: what was read, whether it agrees with model and itself, and what each item moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import evidence_text
from xlmc.errors import capitalised
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.diagnostics.agreement import Verdict
from xlmc.outputs.evidence_tables import ITEM_HEADS, MEANING, MOVES_MEANING, trials_sentence
from xlmc.outputs.sheets import cells
from xlmc.outputs.sheets.cells import Shown

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.diagnostics.agreement import Agreement, Answer, ItemAgreement
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_agreement", "write_evidence"]

WIDTHS: Final = (30, 26, *[11] * 8, 14, 11)
_LAST: Final = len(WIDTHS) - 1
_BAD: Final = (Verdict.INCONSISTENT, Verdict.STRAINED, Verdict.TOO_FEW)
_SOURCE_STARTS: Final = (0, 1, 2, 6)


def write_evidence(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    name = simulation.model.workbook.name
    page.title("Evidence: what was measured, and whether it agrees", name)
    write_agreement(page, simulation)
    page.set_up_printing(name)


def write_agreement(page: Page, simulation: RunResult) -> None:
    """Write all but the title: onto the sheet, or onto the page for a browser."""
    found = simulation.agreement
    if found is not None:
        said = f"{capitalised(found.sentence)}."
        page.wide(said, "warning" if found.verdict in _BAD else "paragraph", _LAST)
        for remark in found.remarks:
            if remark != found.sentence:
                page.wide(f"{capitalised(remark)}.", "paragraph", _LAST)
        _write_items(page, found)
        _write_moves(page, simulation, found)
    _write_sources(page, simulation)


def _write_items(page: Page, found: Agreement) -> None:
    page.heading("Each item, and with the others")
    heads = [*ITEM_HEADS[:3], "±", ITEM_HEADS[3], "±", ITEM_HEADS[4], "±", *ITEM_HEADS[5:]]
    page.table(heads, [_item(each, len(found.items) > 1) for each in found.items])
    if len(found.items) > 1:
        whole = [Shown("All together", look="name"), cells.BLANK, *cells.share(found.together), *[cells.BLANK] * 2]
        best = cells.BLANK if found.best_z is None else Shown(found.best_z, "0.00")
        page.line([*whole, *cells.estimate(found.ratio), cells.BLANK, best, Shown(found.verdict.value)])
    page.row += 1
    for sentence in (trials_sentence(found), MEANING):
        page.wide(sentence, "remark", _LAST)


def _item(item: ItemAgreement, several: bool) -> list[Shown]:
    nothing = [Shown(cells.NONE), Shown(cells.NONE)]
    return [
        Shown(item.name, look="name"),
        Shown(evidence_text(item.evidence)),
        *cells.share(item.alone),
        *(cells.share(item.given_others) if several else nothing),
        *(cells.estimate(item.ratio) if several else nothing),
        Shown(item.chance_text or cells.NONE),
        Shown(cells.NONE) if item.best_z is None else Shown(item.best_z, "0.00"),
        Shown(item.verdict.value, look="warning" if item.verdict in _BAD else "text"),
    ]


def _write_moves(page: Page, simulation: RunResult, found: Agreement) -> None:
    page.heading("What each item moves")
    heads = [
        "Forecast",
        "With",
        "Effective trials",
        "Mean",
        "±",
        "Standard deviation",
        "±",
        "Range from",
        "±",
        "to",
        "±",
    ]
    page.table(heads, [_move(each, simulation.results[each.forecast].form) for each in found.answers])
    page.row += 1
    page.wide(MOVES_MEANING, "remark", _LAST)


def _move(answer: Answer, form: Form) -> list[Shown]:
    estimates = answer.standard_deviation, answer.low, answer.high
    counted = form.kind is Kind.YES_NO
    units = f", {answer.units}" if answer.units else ""
    return [
        Shown(f"{answer.forecast}{units}", look="name"),
        Shown(answer.used),
        cells.count(round(answer.effective)),
        *(cells.share(answer.mean) if counted else cells.estimate(answer.mean, form=form)),
        *(
            shown
            for each in estimates
            for shown in (
                [cells.BLANK] * 2
                if counted
                else cells.estimate(each, like=answer.mean, form=form, spread=each is estimates[0])
            )
        ),
    ]


def _write_sources(page: Page, simulation: RunResult) -> None:
    page.heading("The rows of xlmc_evidence")
    heads = ("Evidence", "Cell", "Reading and error", "Source")
    page.line([Shown(head, look="header left") for head in heads], _SOURCE_STARTS, _LAST)
    for each in simulation.model.evidence:
        texts = (str(each.cell), evidence_text(each), each.source or cells.NONE)
        page.line([Shown(each.name, look="name"), *map(Shown, texts)], _SOURCE_STARTS, _LAST)
