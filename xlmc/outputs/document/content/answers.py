"""The question and the answer: warnings first, what was asked, the answers in words and as a table, what ± means."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.analysis.results.record.errors_met import lost_sentences
from xlmc.analysis.results.statements.run_in_words import sampling_sentence
from xlmc.analysis.results.statements.sentences import meaning, statements
from xlmc.montecarlo.loop.stopping.stopped import ALL_TRIALS
from xlmc.montecarlo.number_text import percent
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE, Shown
from xlmc.outputs.document.material import also_named
from xlmc.outputs.document.measured import Measured, counted_share
from xlmc.outputs.document.parts import Block, Bullets, Content, Paragraph, Table
from xlmc.outputs.summary import (
    SummaryRow,
    base_case,
    base_text,
    end_texts,
    error_sentence,
    frequent_texts,
    mean_heading,
    question,
    range_heading,
    summarise,
    with_units,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["answer_blocks", "answer_tables", "opening_sentences", "section"]


def answer_blocks(
    simulation: RunResult, names: Collection[str], same: Mapping[str, tuple[str, ...]] | None = None
) -> Iterator[Block]:
    """Yield the question, and the answers of the forecasts of these names.

    Args:
        simulation: the finished run.
        names: of the forecasts.
        same: forecast -> others that are the same, which are named with it.
    """
    rows = [row for row in summarise(simulation) if row.name in names]
    for sentence in opening_sentences(simulation):
        yield Paragraph(sentence, "warning")
    asked = tuple(question(simulation))
    yield Paragraph("".join(each.text for each in asked), phrases=asked)
    stated = [each for each in statements(simulation) if each.forecast in names]
    if stated:
        leads = tuple(each.forecast if each.text.startswith(f"{each.forecast}: ") else "" for each in stated)
        texts = (
            f"{also_named(lead, same or {})}{each.text.removeprefix(lead)}."
            for lead, each in zip(leads, stated, strict=True)
        )
        yield Bullets(tuple(texts), leads=leads)
        yield Paragraph(meaning(simulation.model.workbook, stated), "small")
    rows = [replace(row, name=also_named(row.name, same or {})) for row in rows]
    yield _answers(rows)
    yield from _thresholds(rows)
    yield from _texts(rows)
    yield Paragraph(error_sentence(simulation.model.workbook), "meaning")
    ended = [] if simulation.stopped == ALL_TRIALS else [f"The run ended when {simulation.stopped.sentence}."]
    yield Paragraph(" ".join([*_remarks(simulation, rows), *ended]), "small")


def answer_tables(simulation: RunResult) -> Iterator[Block]:
    """Yield the answers in tables for a sheet, with how many trials each rests on."""
    rows = summarise(simulation)
    yield _counted_answers(rows)
    sampled, *others = _remarks(simulation, rows)
    for sentence in (sampled, error_sentence(simulation.model.workbook), *others):
        yield Paragraph(sentence, "small")
    yield from _texts(rows)
    yield from _thresholds(rows)


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


def _remarks(simulation: RunResult, rows: Sequence[SummaryRow]) -> list[str]:
    return [sampling_sentence(simulation), *_range_sentences(rows), *_base_sentences(simulation)]


def _answers(rows: Sequence[SummaryRow]) -> Table:
    """Return the paper's table."""
    mixed = _is_mixed(rows)
    heads = ("Forecast", "Units", *_heads(rows))
    lines = tuple((row.name, row.unit, *_numbers(row, mixed)) for row in rows)
    widths = (4.0, 0.9, *[1.0] * (5 + mixed))  # those of numbers become as wide as these
    caption = "The answers, from the accepted trials; each number with its standard error."
    return Table("", heads, lines, range(2, len(heads)), widths, caption)


def _counted_answers(rows: Sequence[SummaryRow]) -> Table:
    mixed = _is_mixed(rows)
    lines = [(row.name, row.unit, cells.count(row.trials), *_numbers(row, mixed)) for row in rows]
    heads = ("Forecast", "Units", "Accepted trials", *_heads(rows))
    return Table("", heads, tuple(lines), caption="Answers, from the accepted trials.")


def _is_mixed(rows: Sequence[SummaryRow]) -> bool:
    """Whether forecasts have ranges that hold different shares of the trials."""
    return len({row.share for row in rows if not row.is_share}) > 1


def _heads(rows: Sequence[SummaryRow]) -> list[str]:
    heads = [mean_heading(rows), "Standard deviation", f"{range_heading(rows)} from", "to", "Base case"]
    return [*heads, "Range holds"] if _is_mixed(rows) else heads


def _numbers(row: SummaryRow, mixed: bool) -> Iterator[Content]:
    """Yield the mean or the share of an answer, its spread, its range and its base case."""
    if row.is_share:
        yield Measured(row.answer, "share", look="answer", nothing=NONE)
    else:
        yield Measured(row.mean, form=row.form, look="answer", nothing=NONE)
    deviation, *ends = row.spread
    yield Measured(deviation, "spread", row.form, look="answer", nothing=NONE)
    for end, text in zip(ends, end_texts(row), strict=True):
        yield Measured(end, form=row.form, look="range", written=text, nothing=NONE)
    base = base_text(row)
    yield Shown(base) if row.is_share else replace(cells.exact(row.base, row.form, row.mean), written=base)
    if mixed:
        yield Shown(NONE if row.is_share else percent(row.share))


def _texts(rows: Sequence[SummaryRow]) -> Iterator[Table]:
    """Yield how often each text is the answer, for each forecast whose answers are texts."""
    for row in rows:
        if row.categories:
            head = with_units(row.name, row.units)
            frequent, others, left = frequent_texts(row.categories)
            lines: list[tuple[Content, ...]] = [
                (text or "(empty)", cells.count(round(share.value * share.n)), counted_share(share))
                for text, share in frequent.items()
            ]
            if others:
                lines.append((others, cells.count(round(left * row.trials)), Shown(left, "0.0%")))
            caption = f"{row.name}: how often each text is the answer."
            yield Table("", (head, "Trials", "Share"), tuple(lines), widths=(3.0, 1.0, 1.5), caption=caption)


def _thresholds(rows: Sequence[SummaryRow]) -> Iterator[Table]:
    """Yield how probable values above the thresholds are, but of a yes/no answer, whose yes they are; nothing where
    there is no threshold.
    """
    lines = [
        (
            row.name,
            row.units,
            cells.exact(row.threshold, row.form),
            Measured(row.above, "share", interval=True, nothing=NONE),
        )
        for row in rows
        if row.threshold is not None and not _is_yes(row)
    ]
    if lines:
        heads = ("Forecast", "Units", "Threshold", "Above it")
        yield Table("", heads, tuple(lines), caption="Values above a threshold.")


def _is_yes(row: SummaryRow) -> bool:
    """Whether what is above the threshold are the yes answers."""
    return row.yes is not None and row.above is not None and math.isclose(row.above.value, row.yes.value)


def _range_sentences(rows: Sequence[SummaryRow]) -> list[str]:
    """Return the sentence that says what a central range is."""
    shares = {row.share for row in rows}
    if len(shares) != 1:
        return ["Central ranges leave out as many accepted trials below as above."]
    share = shares.pop()
    outside = percent((1 - share) / 2)
    return [f"The {percent(share)} range is central: {outside} of the accepted trials lie below it, {outside} above."]


def _base_sentences(simulation: RunResult) -> list[str]:
    """Return the sentences that say what the base case is, and which filters it would not pass."""
    result = base_case(simulation)
    if result is None:
        return ["There is no base case: the cell of an assumption is blank."]
    message = "The base case has every assumption at the value in its cell"
    if not result.rejected_by:
        return [f"{message}."]
    return [f"{message}. As a trial it would be rejected by: {', '.join(result.rejected_by)}."]


def section(material: Material) -> Iterator[Block]:
    """Yield the question, and the answers of the chosen forecasts."""
    return answer_blocks(material.simulation, material.once, material.same)
