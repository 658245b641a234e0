"""The first section of the page, which can be read alone: what was asked, the answers, and what they mean."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from xlmc.analysis.results.statements import meaning, statements
from xlmc.analysis.results.statements.in_words import sampling_sentence
from xlmc.montecarlo.loop.stopping.stopped import ALL_TRIALS
from xlmc.outputs.document.element import EMPTY, Html, element
from xlmc.outputs.document.html_writer import estimate_html, number, share_html
from xlmc.outputs.sheets.results_sheet import base_sentences, opening_sentences, range_sentences
from xlmc.outputs.summary import (
    SummaryRow,
    base_text,
    end_texts,
    error_sentence,
    percent,
    question,
    range_heading,
    summarise,
)

if TYPE_CHECKING:
    from xlmc.analysis.results.statements import Statement
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["answers"]


def answers(simulation: RunResult) -> Html:
    """Warnings, the question, the answers in words and as the paper's table, and the meaning of ±."""
    rows = summarise(simulation)
    return element(
        "section",
        element("h2", "The answer"),
        *map(_warning, opening_sentences(simulation)),
        element("p", *_question(simulation)),
        *_statements(simulation),
        _table(rows),
        element("p", error_sentence(simulation.model.workbook), class_="meaning"),
        *(element("p", sentence, class_="remark") for sentence in _remarks(simulation, rows)),
        id="answer",
    )


def _warning(sentence: str) -> Html:
    return element("p", sentence, class_="warning", role="alert")


def _question(simulation: RunResult) -> Iterator[Html | str]:
    for said in question(simulation):
        yield element("bdi", said.text) if said.is_name else said.text


def _statements(simulation: RunResult) -> Iterator[Html]:
    """Yield the sentences and what they mean; nothing if all forecasts are diagnostics."""
    if said := statements(simulation):
        yield element("ul", *(element("li", *_statement(each)) for each in said), class_="statements")
        yield element("p", meaning(simulation.model.workbook, said), class_="remark")


def _statement(statement: Statement) -> Iterator[Html | str]:
    """Yield the sentence, with the name before its colon in bold."""
    name = f"{statement.forecast}: "
    if statement.text.startswith(name):
        yield element("b", element("bdi", statement.forecast))
        yield f": {statement.text.removeprefix(name)}."
    else:
        yield element("bdi", f"{statement.text}.")


def _table(rows: Sequence[SummaryRow]) -> Html:
    thresholds = any(row.threshold is not None for row in rows)
    mixed = len({row.share for row in rows}) > 1
    heads = ["Forecast", "Units", "Mean", "Standard deviation", f"{range_heading(rows)} from", "to", "Base case"]
    heads += ["Range holds"] * mixed + ["Threshold", "Above threshold"] * thresholds
    return element(
        "div",
        element(
            "table",
            element("thead", element("tr", *(_head(head, index > 1) for index, head in enumerate(heads)))),
            element("tbody", *(_line(row, mixed, thresholds) for row in rows)),
        ),
        class_="wide-table answers",
    )


def _head(text: str, numbers: bool) -> Html:
    return element("th", text, scope="col", class_="number" if numbers else None)


def _line(row: SummaryRow, mixed: bool, thresholds: bool) -> Html:
    cells = [share_html(row.answer) if row.is_share else estimate_html(row.mean, row.form.estimate)]
    cells.append(estimate_html(row.spread[0], row.form.spread))
    texts = zip(row.spread[1:], end_texts(row), strict=True)
    cells += [number(end.value, text) if text else estimate_html(end) for end, text in texts]
    cells.append(element("span", base_text(row)) if row.base is None else number(row.base, base_text(row)))
    if mixed:
        cells.append(element("span", percent(row.share)))
    if thresholds:
        cells.append(EMPTY if row.threshold is None else number(row.threshold, row.form.number(row.threshold)))
        cells.append(EMPTY if row.above is None else share_html(row.above))
    found = (element("td", cell, class_="number") for cell in cells)
    return element("tr", element("th", row.name, scope="row"), element("td", row.unit), *found)


def _remarks(simulation: RunResult, rows: Sequence[SummaryRow]) -> Iterator[str]:
    yield sampling_sentence(simulation)
    yield from range_sentences(rows)
    yield from base_sentences(simulation)
    if simulation.stopped != ALL_TRIALS:
        yield f"The run ended when {simulation.stopped.sentence}."
