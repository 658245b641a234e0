"""The sheet Results: the answer first, then how many trials it rests on and what the filters did."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from xlmc.analysis.results.record.errors_met import lost_sentences
from xlmc.analysis.results.statements.in_words import sampling_sentence
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.number_text import count_text
from xlmc.outputs.document.parts import Heading
from xlmc.outputs.document.xlsx_writer import write_blocks
from xlmc.outputs.sections.checks import check_blocks
from xlmc.outputs.sections.filters import count_blocks, filter_blocks
from xlmc.outputs.sections.notices import notice_blocks
from xlmc.outputs.sheets import cells
from xlmc.outputs.sheets.cells import Shown
from xlmc.outputs.summary import (
    SummaryRow,
    base_case,
    base_text,
    error_sentence,
    frequent_texts,
    percent,
    range_heading,
    summarise,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.sheets.page import Page

__all__ = ["LAST", "WIDTHS", "base_sentences", "opening_sentences", "range_sentences", "write_results"]

WIDTHS = (30, 9, *[9.5] * 10)
LAST = 11
_ROW = 15.75


def write_results(page: Page, simulation: RunResult) -> None:
    """Write the sheet."""
    book = simulation.model.workbook.name
    settings = simulation.settings
    page.height = _ROW
    page.title("Results of the simulation", f"{book}, seed {settings.seed}, {count_text(simulation.evaluated)} trials")
    for sentence in opening_sentences(simulation):
        page.wide(sentence, "warning", LAST)
    _write_answers(page, simulation)
    found = (*count_blocks(simulation), *check_blocks(simulation), *filter_blocks(simulation, full=True))
    write_blocks(page, found, last=LAST)
    if notices := [*notice_blocks(simulation)]:
        write_blocks(page, [Heading("Notices", 2), *notices], last=LAST)
    page.set_up_printing(book)


def opening_sentences(simulation: RunResult) -> list[str]:
    """Return the sentences before the answers.

    They say which changed workbook was run, if one was; why not to use the answers, failed checks first; and how many
    trials were lost to errors.
    """
    ended = simulation.stopped
    missing = simulation.refused
    return [
        *([] if simulation.changed_from is None else [simulation.changed_from.sentence]),
        *(f"An answer is missing: {warning}. The answers of other forecasts do not need it." for warning in missing),
        *(f"Do not use these results as they are: {each}" for each in simulation.warnings if each not in missing),
        *lost_sentences(simulation),
        *([f"Fewer trials than were asked for: {ended.sentence}"] if ended.interrupted else []),
    ]


def _write_answers(page: Page, simulation: RunResult) -> None:
    rows = summarise(simulation)
    page.heading("Answers, from the accepted trials")
    page.table(_headers(rows), [_answer(row, rows) for row in rows])
    page.row += 1
    for sentence in (
        sampling_sentence(simulation),
        error_sentence(simulation.model.workbook),
        *range_sentences(rows),
        *base_sentences(simulation),
    ):
        page.wide(sentence, "remark", LAST)
    write_texts(page, rows)
    _write_thresholds(page, rows)


def write_texts(page: Page, rows: Sequence[SummaryRow]) -> None:
    """Write how often each text is the answer; nothing where all answers are numbers."""
    for row in rows:
        if not row.categories:
            continue
        page.heading(f"{row.name}: how often each text is the answer")
        head = f"{row.name} ({row.units})" if row.units else row.name
        told, others, left = frequent_texts(row.categories)
        lines = [_text(*each) for each in told.items()]
        if others:
            last = [Shown(others, look="name"), cells.count(round(left * row.trials)), Shown(left, "0.0%")]
            lines.append([*last, *[cells.BLANK] * 3])
        page.table([head, "Trials", "Share", "±", "95 % from", "to"], lines)


def _text(text: str, share: Estimate) -> list[Shown]:
    return [Shown(text or "(empty)", look="name"), cells.count(round(share.value * share.n)), *_share(share)]


def _headers(rows: Sequence[SummaryRow]) -> list[str]:
    heads = ["Forecast", "Units", "Accepted trials", "Mean", "±", "Standard deviation", "±"]
    heads += [f"{range_heading(rows)} from", "±", "to", "±", "Base case"]
    return heads if len({row.share for row in rows}) < 2 else [*heads, "Range holds"]


def _answer(row: SummaryRow, rows: Sequence[SummaryRow]) -> list[Shown]:
    shown = [
        Shown(row.name, look="name"),
        Shown(row.unit),
        cells.count(row.trials),
        *(cells.share(row.answer, "answer") if row.is_share else cells.estimate(row.mean, "answer", form=row.form)),
        *(
            shown
            for each in row.spread
            for shown in cells.estimate(each, "answer", form=row.form, spread=each is row.spread[0])
        ),
        Shown(base_text(row)) if row.is_share else cells.exact(row.base, row.form, row.mean),
    ]
    return shown if len({other.share for other in rows}) < 2 else [*shown, Shown(percent(row.share))]


def _write_thresholds(page: Page, rows: Sequence[SummaryRow]) -> None:
    """Write how probable values above the thresholds are; nothing where there is no threshold."""
    found = [row for row in rows if row.threshold is not None]
    if not found:
        return
    page.heading("Values above a threshold")
    page.table(
        ["Forecast", "Units", "Threshold", "Above it", "±", "95 % from", "to"],
        [
            [
                Shown(row.name, look="name"),
                Shown(row.units),
                cells.exact(row.threshold, row.form),
                *([Shown(cells.NONE)] * 4 if row.above is None else _share(row.above)),
            ]
            for row in found
        ],
    )


def range_sentences(rows: Sequence[SummaryRow]) -> list[str]:
    """Return the sentence that says what a central range is."""
    shares = {row.share for row in rows}
    if len(shares) != 1:
        return ["Central ranges leave out as many accepted trials below as above."]
    share = shares.pop()
    outside = percent((1 - share) / 2)
    return [f"The {percent(share)} range is central: {outside} of the accepted trials lie below it, {outside} above."]


def base_sentences(simulation: RunResult) -> list[str]:
    """Return the sentences that say what the base case is, and which filters it would not pass."""
    found = base_case(simulation)
    if found is None:
        return ["There is no base case: the cell of an assumption is blank."]
    meaning = "The base case has every assumption at the value in its cell"
    if not found.rejected_by:
        return [f"{meaning}."]
    return [f"{meaning}. As a trial it would be rejected by: {', '.join(found.rejected_by)}."]


def _share(found: Estimate) -> list[Shown]:
    if found.error == 0.0 and found.value in (0.0, 1.0):
        return [Shown(found.value, "0%"), *[cells.BLANK] * 3]
    return [*cells.share(found), *cells.interval(found, percent=True)]
