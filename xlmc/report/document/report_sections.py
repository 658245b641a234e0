"""What the report says, section by section, of a finished run: the same sentences and numbers as sheets and page."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.address import Cell
from xlmc.definitions.definitions import CaseDetails
from xlmc.report.document.parts import Block, Bullets, Document, Heading, Paragraph, Picture, Table
from xlmc.report.document.pictures import bar_picture, before_and_after, forecast_picture
from xlmc.report.document.sheet_blocks import blocks_of
from xlmc.report.filter_effect import Marginal, filter_effect_of
from xlmc.report.histogram import figures_of
from xlmc.report.page.svg import Bar
from xlmc.report.question import question
from xlmc.report.sheets.accounting import write_accounting, write_checks
from xlmc.report.sheets.results_sheet import (
    LAST,
    base_sentences,
    opening_sentences,
    range_sentences,
    write_counts,
)
from xlmc.report.sheets.sensitivity_sheet import influence_captions, sensitivity_sentences
from xlmc.report.summary import ERROR_SENTENCE, estimate_text, percent, range_heading, share_text, summarise
from xlmc.results.record import Record, make_record
from xlmc.results.record.in_words import distribution_text, sampling_sentence, status
from xlmc.results.statements import MEANING, statements
from xlmc.studies.sensitivity import sensitivities
from xlmc.studies.sensitivity.measures import noise
from xlmc.workbook.printable import label

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["SECTIONS", "describe"]

_FEW: Final = 4
"""Forecasts that have large figures: three of the smaller ones fit on a page."""

_NARROW: Final = 0.72
_BARS, _BARS_OF_MANY = 8, 4
_LONGEST_EQUATION: Final = 400

_WORDS: Final = (
    ("Assumption", "an uncertain input: a cell with a range and a distribution, from which each trial draws a value."),
    ("Trial", "one possible crash: one value is drawn for each assumption, and the workbook is calculated with them."),
    ("Forecast", "a cell whose values are wanted: an answer."),
    ("Filter", "a cell with limits that a possible crash must meet; a trial outside them is rejected."),
    ("Accepted", "a trial that meets all filters. All answers are those of the accepted trials."),
    ("Certainty", "the share of the accepted trials in which a forecast lies within a range."),
    (
        "Standard error, ±",
        "how far a printed number may lie from the one that infinitely many trials would give. It does not say whether "
        "the model is right.",
    ),
    ("Central range", "as many accepted trials lie below it as above it."),
    ("Base case", "the workbook as it is, each assumption at the value in its own cell."),
    ("Seed", "the number that the random draws start from; the same workbook and seed give the same numbers."),
    (
        "Variance explained",
        "the share of a forecast's variance that would go if the assumption's true value were known.",
    ),
)


@dataclass(frozen=True, slots=True)
class _Run:
    """A run, the record of it, and the names of the forecasts that the report is about."""

    simulation: Simulation
    record: Record
    forecasts: Sequence[str]

    def reports(self, forecast: str) -> bool:
        """Whether the report is about a forecast."""
        return forecast in self.forecasts


def describe(
    simulation: Simulation,
    case: CaseDetails,
    *,
    date: tuple[int, int, int],
    paper: str,
    sections: Sequence[str],
    forecasts: Sequence[str],
    command: str | None = None,
) -> Document:
    """The document of a run.

    Args:
        simulation: the finished run.
        case: what the cover says of the case.
        date: of the report.
        paper: `letter` or `a4`.
        sections: of SECTIONS, in that order.
        forecasts: the names of those that it is about.
        command: what the person typed, for the record.
    """
    record = make_record(simulation, command)
    run = _Run(simulation, record, forecasts)
    name = label(simulation.model.workbook.name)
    title = case.title or f"Simulation of {name}"
    year, month, day = date
    cover = (
        ("Case number", case.number),
        ("Analyst", case.analyst),
        ("Organisation", case.organisation),
        ("Date", f"{year:04}-{month:02}-{day:02}"),
        ("Workbook", name),
        ("SHA-256 of the workbook", str(record["file.sha256"] or "")),
        ("Fingerprint of the run", str(record["run.fingerprint"] or "")),
        ("Made with", f"xlmc {record['software.xlmc']}"),
    )
    blocks: list[Block] = []
    for key in SECTIONS:
        found = list(SECTIONS[key](run)) if key in sections else []
        blocks += found
    return Document(
        title=title,
        cover=tuple((head, text) for head, text in cover if text),
        running=" · ".join(text for text in (case.number, title) if text),
        author=", ".join(text for text in (case.analyst, case.organisation) if text),
        date=date,
        paper=paper,
        blocks=tuple(blocks),
    )


def _answer(run: _Run) -> Iterator[Block]:
    simulation = run.simulation
    yield Heading("Question and answer")
    for sentence in opening_sentences(simulation):
        yield Paragraph(sentence, look="warning")
    yield Paragraph("".join(question(simulation)))
    yield Bullets(
        tuple(_statement(each.forecast, each.text) for each in statements(simulation) if run.reports(each.forecast))
    )
    rows = [row for row in summarise(simulation) if run.reports(row.name)]
    thresholds, mixed = any(row.threshold is not None for row in rows), len({row.share for row in rows}) > 1
    heads = ["Forecast", "Units", "Mean", "Standard deviation", f"{range_heading(rows)} from", "to", "Base case"]
    heads += ["Range holds"] * mixed + ["Threshold", "Above threshold"] * thresholds
    lines = []
    for row in rows:
        line = [row.name, row.units, *map(estimate_text, (row.mean, row.standard_deviation, row.low, row.high))]
        line.append("" if row.base is None else f"{row.base:.6g}")
        line += [percent(row.share)] * mixed
        if thresholds:
            line.append("" if row.threshold is None else f"{row.threshold:g}")
            line.append("" if row.above is None else share_text(row.above))
        lines.append(tuple(line))
    yield Table(tuple(heads), tuple(lines), frozenset(range(2, len(heads))))
    for sentence in (
        MEANING,
        ERROR_SENTENCE,
        sampling_sentence(simulation),
        *range_sentences(rows),
        *base_sentences(simulation),
    ):
        yield Paragraph(sentence, look="small")


def _statement(forecast: str, text: str) -> Paragraph:
    rest = text.removeprefix(f"{forecast}: ")
    return Paragraph(f"{text}.") if rest == text else Paragraph(f"{rest}.", f"{forecast}: ")


def _figures(run: _Run) -> Iterator[Block]:
    figures = [figure for figure in figures_of(run.simulation) if run.reports(figure.answer.name)]
    if figures:
        yield Heading("Forecasts")
    width = 1.0 if len(figures) <= _FEW else _NARROW
    for figure in figures:
        words = f"Histogram of {figure.answer.name} with the cumulative share of the accepted trials."
        yield Picture(forecast_picture(figure), words, figure.caption, width)


def _filters(run: _Run) -> Iterator[Block]:
    yield Heading("Trials and filters")
    yield from blocks_of(lambda page: write_counts(page, run.simulation))
    yield from blocks_of(lambda page: write_accounting(page, run.simulation, LAST))


def _assumptions(run: _Run) -> Iterator[Block]:
    simulation = run.simulation
    filtered = bool(simulation.model.filters)
    yield Heading("Assumptions, before filtering and accepted" if filtered else "Assumptions")
    if filtered:
        yield Paragraph(
            "Filters keep only the combinations that agree with the evidence, so an assumption that the evidence bears "
            "on is distributed differently afterwards. In the pictures the line is the distribution before filtering, "
            "the filled area that of the accepted trials. Numbers are mean ± standard error; SD is the standard "
            "deviation.",
            look="small",
        )
    rows: list[tuple[str | Picture, ...]] = []
    for assumption in simulation.model.assumptions:
        units = f", {assumption.units}" if assumption.units else ""
        about = f"{distribution_text(assumption)}. {assumption.source}".strip()
        found = filter_effect_of(simulation, assumption.name)
        if found is None:
            why = status(simulation.model, assumption.name, assumption.frozen)
            rows.append((f"{assumption.name}{units}", about, why, "", ""))
            continue
        picture = Picture(
            before_and_after(simulation.prior[assumption.name], simulation.inputs[assumption.name]),
            f"Distribution of {assumption.name} before filtering and in the accepted trials.",
        )
        rows.append((f"{assumption.name}{units}", about, _marginal(found.prior), _marginal(found.accepted), picture))
    heads = ("Assumption", "Distribution and source", "Before filtering", "Accepted", "Before and accepted")
    yield Table(heads, tuple(rows), frozenset((2, 3)), (20, 33, 18, 18, 17))


def _marginal(found: Marginal) -> str:
    return f"{estimate_text(found.mean)}\nSD {estimate_text(found.standard_deviation)}"


def _sensitivity(run: _Run) -> Iterator[Block]:
    found = sensitivities(run.simulation)
    drawn = [each for each in found.forecasts if run.reports(each.forecast) and each.influences]
    if not drawn:
        return
    yield Heading("What the answers depend on")
    few = len(drawn) <= _FEW
    most = _BARS if few else _BARS_OF_MANY
    for each in drawn:
        weak = noise(each)
        shares = [
            _share(influence.assumption, influence.explained.value, influence.explained.error, is_weak.explained)
            for influence, is_weak in zip(each.influences[:most], weak[:most], strict=True)
        ]
        title = f"{each.forecast}: variance explained"
        picture = bar_picture(shares, "", "Share of the variance, %")
        first = "; ".join(f"{bar.name} {bar.pieces[0][1]:.0f} %" for bar in shares[:3])
        yield Picture(
            picture, f"{title}: {first}.", f"{title} by the assumptions that explain most of it.", 0.72 if few else 0.6
        )
    yield Paragraph(influence_captions(drawn[0], found.sobol_trials)[0], look="small")
    for sentence in sensitivity_sentences(found):
        yield Paragraph(sentence, look="small")


def _share(name: str, value: float, error: float | None, pale: bool) -> Bar:
    shown = 100.0 * value if math.isfinite(value) else 0.0
    whisker = None if error is None else (shown - 100.0 * error, shown + 100.0 * error)
    return Bar(name, ((0.0, shown, "light" if pale else "dark"),), whisker)


def _checks(run: _Run) -> Iterator[Block]:
    if run.simulation.checks:
        yield Heading("Physics checks")
        yield from blocks_of(lambda page: write_checks(page, run.simulation, LAST))


def _equations(run: _Run) -> Iterator[Block]:
    """The rows of every sheet with the columns Equation and Source."""
    rows = list(_named_equations(run.simulation))
    if rows:
        yield Heading("Equations and their sources")
        yield Table(("Quantity", "Symbol", "Equation", "Source", "Cell"), tuple(rows), weights=(24, 9, 40, 17, 12))


def _named_equations(simulation: Simulation) -> Iterator[tuple[str, ...]]:
    for name, sheet in simulation.model.workbook.sheets.items():
        texts: dict[int, dict[int, str]] = {}
        for (row, column), content in sheet.cells.items():
            if isinstance(content.value, str) and content.value.strip():
                texts.setdefault(row, {})[column] = label(content.value.strip())
        columns: dict[str, int] = {}
        for row in sorted(texts):
            heads = {text.casefold(): column for column, text in reversed(texts[row].items())}
            if {"equation", "source"} <= heads.keys():
                columns = {"quantity": min(texts[row]), **heads}
            elif columns and columns["equation"] in texts[row]:
                said = [texts[row].get(columns.get(key, 0), "") for key in ("quantity", "symbol", "equation", "source")]
                at = Cell(name, row, columns.get("value", columns["equation"]))
                yield *(text[:_LONGEST_EQUATION] for text in said), str(at)


def _repeat(run: _Run) -> Iterator[Block]:
    record = run.record
    yield Heading("How to repeat it")
    yield Paragraph(
        "The same version of xlmc gives the same numbers, to the last digit, from the same workbook, command and seed."
    )
    yield Paragraph(str(record["run.repeat"]), look="code")
    versions = (
        ("xlmc", "xlmc"),
        ("Python", "python"),
        ("NumPy", "numpy"),
        ("SciPy", "scipy"),
        ("formulas", "formulas"),
    )
    rows = [
        ("Workbook", label(str(record["file.name"]))),
        ("SHA-256 of the workbook", str(record["file.sha256"] or "")),
        ("Fingerprint of the run", str(record["run.fingerprint"] or "")),
        ("Trials, accepted", f"{run.simulation.trials:,}, {run.simulation.accepted:,}"),
        ("Seed", str(record["settings.seed"])),
        ("Sampling", str(record["sampling.method_in_words"])),
        ("Engine", str(record["sampling.engine"])),
        ("Software", ", ".join(f"{said} {record[f'software.{key}']}" for said, key in versions)),
        ("Processor", f"{record['processor.machine']}, {record['processor.system']}"),
    ]
    yield Table(("What", "Which"), tuple(rows), weights=(22, 78))
    yield Paragraph(
        "pip install xlmc==" + str(record["software.xlmc"]) + "; then xlmc replay on the result workbook says whether "
        "the numbers come out the same.",
        look="small",
    )


def _glossary(run: _Run) -> Iterator[Block]:
    yield Heading("Words")
    yield Bullets(tuple(Paragraph(text, f"{word}: ") for word, text in _WORDS))


SECTIONS: Final[dict[str, Callable[[_Run], Iterator[Block]]]] = {
    "answer": _answer,
    "forecasts": _figures,
    "filters": _filters,
    "assumptions": _assumptions,
    "sensitivity": _sensitivity,
    "checks": _checks,
    "equations": _equations,
    "repeat": _repeat,
    "words": _glossary,
}
"""What the report holds, in its order."""
