"""The sections of the page that say what the result sheets say, from certainty to the record."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING

from xlmc.analysis.results.record import Entry, Record, RecordTable, Section, Value
from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.excel.workbook.printable import printable
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.number_text import styled_text, whole_text
from xlmc.outputs.document.cells import NONE
from xlmc.outputs.document.charts import shape_chart
from xlmc.outputs.document.content.answers import answer_blocks
from xlmc.outputs.document.content.assumptions import (
    assumption_change,
    assumption_remarks,
    assumption_rows,
    correlation_blocks,
    meaning_of_marks,
)
from xlmc.outputs.document.content.certainty import certainty_blocks
from xlmc.outputs.document.content.checks import check_blocks
from xlmc.outputs.document.content.evidence import evidence_blocks
from xlmc.outputs.document.content.filters import count_blocks, filter_blocks
from xlmc.outputs.document.content.notices import notice_blocks
from xlmc.outputs.document.content.statistics import statistics_sentence, statistics_tables
from xlmc.outputs.document.element import EMPTY, Html, element
from xlmc.outputs.document.html_writer import blocks_html, cell_html, picture_html
from xlmc.outputs.document.parts import Block, Heading, Paragraph
from xlmc.outputs.filter_effect import PERCENTS, filter_effect_of

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "answer",
    "assumptions",
    "certainty",
    "checks",
    "evidence",
    "filters",
    "notices",
    "record",
    "statistics",
]

_HEADS = ("Assumption", "Trials", "Mean", "Standard deviation", *(f"{styled_text(each, 'g')} %" for each in PERCENTS))

_CHANGES = ("Shift of mean in SDs", "SD accepted / before")

_COLUMNS = len(_HEADS) + len(_CHANGES)

_OPEN = frozenset({"run", "file", "trials", "sampling", "software"})

_CODE = frozenset({"repeat", "command", "fingerprint", "sha256", "original_sha256"})


def answer(simulation: RunResult) -> Html:
    """Return what was asked and answered, which can be read alone."""
    return _section("answer", "The answer", answer_blocks(simulation, simulation.results))


def certainty(simulation: RunResult, names: Collection[str] | None = None) -> Html:
    """How certain the central ranges are, of the forecasts of these names; None: of all."""
    message = "The share of the accepted trials below, in and above each central range, as it is rounded here."
    blocks = certainty_blocks(simulation, _named(simulation, names))
    return _section("certainty", "Certainty of ranges", (Paragraph(message, "small"), *blocks))


def statistics(simulation: RunResult, names: Collection[str] | None = None) -> Html:
    """Everything about the accepted trials of each forecast of these names; None: of all."""
    forecasts = (
        element(
            "div",
            blocks_html([Heading(name, 2), *statistics_tables([simulation.results[name]])]),
            class_="forecast-statistics",
        )
        for name in _named(simulation, names)
    )
    message = f"Of the accepted trials. From … to: the 95 % interval of each number. {statistics_sentence(simulation)}"
    head = element("h2", "Statistics"), element("p", message, class_="remark")
    return element("section", *head, *forecasts, id="statistics")


def _named(simulation: RunResult, names: Collection[str] | None) -> list[str]:
    """Return those of the forecasts that have these names; None: all."""
    return [name for name in simulation.results if names is None or name in names]


def checks(simulation: RunResult) -> Html:
    """Return the checks; nothing if the workbook has none."""
    return _section("checks", "Checks", check_blocks(simulation))


def evidence(simulation: RunResult) -> Html:
    """Return whether the evidence agrees, and what each item moves; nothing where none is used."""
    return _section("evidence", "Evidence", evidence_blocks(simulation, simulation.results, full=True))


def filters(simulation: RunResult) -> Html:
    """Return how many trials were run and accepted, and what each filter rejected."""
    result = (*count_blocks(simulation), *filter_blocks(simulation, full=True))
    return _section("filters", "Trials and filters", result)


def assumptions(simulation: RunResult) -> Html:
    """Every assumption before and after filtering, as the sheet Assumptions has it."""
    names = enumerate((*_HEADS, *_CHANGES))
    heads = (element("th", head, scope="col", class_="number" if index else None) for index, head in names)
    bodies = (_assumption(simulation, assumption) for assumption in simulation.model.assumptions)
    table = element("table", element("thead", element("tr", *heads)), *bodies)
    return element(
        "section",
        element("h2", "Assumptions, before filtering and accepted" if simulation.filters_act else "Assumptions"),
        *([element("p", meaning_of_marks())] if simulation.filters_act else []),
        *(element("p", message, class_="remark") for message in assumption_remarks(simulation)),
        element("div", table, class_="wide-table paired"),
        blocks_html(correlation_blocks(simulation)),
        id="assumptions",
    )


def _assumption(simulation: RunResult, assumption: Assumption) -> Html:
    """Return an assumption's name above its rows, in a table body of their own so that they stay together."""
    effect = filter_effect_of(simulation, assumption.name)
    form = simulation.model.input_forms.get(assumption.name, PLAIN)
    shape = EMPTY if effect is None else _shape(simulation, assumption.name)
    named = element("tr", element("th", shape, *_name_line(assumption, form), scope="rowgroup", colspan=str(_COLUMNS)))
    if effect is None:
        why = element("td", status(simulation.model, assumption.name, assumption.frozen), colspan=str(_COLUMNS))
        return element("tbody", named, element("tr", why))
    rows = assumption_rows(simulation, assumption.name)
    changes = assumption_change(effect) if len(rows) > 1 else ("", "")
    ends = [("", "")] * (len(rows) - 1) + [changes]
    lines = ((*row, *end) for row, end in zip(rows, ends, strict=True))
    return element("tbody", named, *(element("tr", *map(cell_html, line)) for line in lines))


def _shape(simulation: RunResult, name: str) -> Html:
    """Draw the draws before filtering and the accepted ones in a small picture; nothing if all draws are one value."""
    chart = shape_chart(simulation, name)
    return EMPTY if chart is None else picture_html(chart, "shape")


def _name_line(assumption: Assumption, form: Form) -> Iterator[Html | str]:
    base = NONE if assumption.base is None else form.number(assumption.base)
    yield element("b", assumption.name, f", {assumption.units}" if assumption.units else "")
    yield " "
    yield element("small", f"{assumption.cell}, base case {base}. {distribution_text(assumption)}. {assumption.source}")


def notices(simulation: RunResult) -> Html:
    """Return the notices; nothing if there are none."""
    return _section("notices", "Notices", notice_blocks(simulation))


def _section(key: str, heading: str, result: Iterable[Block]) -> Html:
    """Return a section of the page; nothing where it has no blocks."""
    blocks = [*result]
    return element("section", element("h2", heading), blocks_html(blocks), id=key) if blocks else EMPTY


def record(result: Record) -> Html:
    """Return the record of the run: every part of it can be opened, and open parts are printed."""
    message = (
        "What the numbers depend on, and how to repeat them. Every number is in full. Only open parts are printed."
    )
    return element(
        "section",
        element("h2", "Record"),
        element("p", message),
        *(_record_section(section) for section in result.sections),
        id="record",
    )


def _record_section(section: Section) -> Html:
    results = [element("summary", section.title)]
    entries = [entry for entry in section.entries if not entry.key.startswith("packed_")]  # for programs alone
    if entries:
        results.append(element("dl", *(each for entry in entries for each in _record_entry(section.key, entry))))
    if section.table is not None:
        results.append(_record_table(section.table) if section.table.rows else element("p", "None"))
    return element("details", *results, open="" if section.key in _OPEN else None, data_section=section.key)


def _record_entry(section: str, entry: Entry) -> tuple[Html, Html]:
    message = _value_text(entry.value)
    shown = element("code", message) if entry.key in _CODE else element("span", message)
    return element("dt", entry.label), element("dd", shown, data_key=f"{section}.{entry.key}")


def _record_table(table: RecordTable) -> Html:
    heads = element("tr", *(element("th", label, scope="col") for _, label in table.columns))
    rows = (element("tr", *(element("td", _value_text(value)) for value in row)) for row in table.rows)
    inner = element("table", element("thead", heads), element("tbody", *rows))
    return element("div", inner, class_="wide-table record")


def _value_text(value: Value) -> str:
    if value is None or value == "":
        return NONE
    if isinstance(value, bool):
        return str(value).upper()
    return printable(value) if isinstance(value, str) else whole_text(value)
