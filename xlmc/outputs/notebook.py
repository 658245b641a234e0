"""What a notebook shows of a model and of a run: tables, and a small histogram of each answer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import distribution_text, limits_text
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.outputs.document import further_sections
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.histogram import figures_of
from xlmc.outputs.summary import error_sentence, rejection_rows, summarise, summary_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.histogram import Histogram

__all__ = ["model_html", "run_html"]

_ROWS: Final = 40
"""Rows of a table; a notebook shows the first ones of more."""

_WIDTH, _HEIGHT = 150, 34
"""Size of a histogram, in pixels."""

_STYLE: Final = "border-collapse:collapse;margin:.3em 0 .8em"
_LINE: Final = "color-mix(in srgb,currentColor 20%,transparent)"
_CELL: Final = f"padding:.15em .7em;text-align:{{}};border-bottom:1px solid {_LINE}"


def _base_text(model: CompiledModel, assumption: Assumption) -> str:
    if assumption.base is None:
        return ""
    return model.input_forms.get(assumption.name, PLAIN).number(assumption.base)


@in_style_of("definitions.settings.number_style")
def model_html(model: CompiledModel) -> str:
    """Return assumptions, forecasts and filters as HTML; colours are those of the notebook."""
    assumptions = [
        (a.name, distribution_text(a), _base_text(model, a), a.units, "frozen" * a.frozen, a.source)
        for a in model.assumptions
    ]
    forecasts = [(f.name, f.units, str(f.cell)) for f in model.forecasts]
    filters = [(f.name, limits_text(f), f.because) for f in (*model.filters, *model.forecast_filters)]
    return "".join(
        (
            f"<p><b>{escape(model.workbook.name)}</b></p>",
            _table("Assumptions", ("Name", "Distribution", "Base value", "Units", "", "Source"), assumptions, {2}),
            _table("Forecasts", ("Name", "Units", "Cell"), forecasts),
            _table("Filters", ("Name", "Keeps", "Because"), filters) if filters else "",
            *_sentences("Notice", map(str, model.notices)),
        )
    )


@in_style_of("settings.number_style")
def run_html(run: RunResult) -> str:
    """Return warnings, answers with a small histogram each, filters and notices as HTML."""
    rows = summarise(run)
    headings, lines = summary_text(rows)
    drawn = {each.answer.name: _histogram(each.bins) for each in figures_of(run)}
    pictures = [drawn.get(row.name, "") for row in rows]
    filters = rejection_rows(run)
    further = further_sections(run, "notebook").values()
    changed = [] if run.changed_from is None else [run.changed_from.sentence]
    return "".join(
        (
            f"<p><b>{escape(run.model.workbook.name)}</b>: accepted {count_text(run.accepted)} of "
            f"{counted_text(run.evaluated, 'trial')}, "
            f"seed {run.settings.seed}</p>",
            *_sentences("Warning", (*changed, *run.warnings)),
            _table("Answers", headings, lines, set(range(1, len(headings))), pictures),
            _table("Trials rejected", ("Filter", "Keeps", "Rejected", "Only by it"), filters, {2, 3})
            if filters
            else "",
            *_sentences("Notice", map(str, run.notices)),
            *(f"<h3>{escape(heading)}</h3>{blocks_html(blocks).source}" for heading, blocks in further),
            f"<p style='font-size:smaller'>{escape(error_sentence(run.model.workbook))}</p>",
        )
    )


def _sentences(kind: str, texts: Iterable[str]) -> Iterator[str]:
    for text in texts:
        yield f"<p><b>{kind}</b> {escape(text)}</p>"


def _table(
    title: str,
    headings: Sequence[str],
    rows: Sequence[Sequence[str]],
    right: Iterable[int] = (),
    pictures: Sequence[str] = (),
) -> str:
    """Return a table.

    Args:
        title: above it.
        headings: of its columns.
        rows: of text.
        right: columns of numbers.
        pictures: markup behind each row.
    """
    to_right = set(right)
    aligned = ["right" if column in to_right else "left" for column in range(len(headings))]

    def line(tag: str, texts: Sequence[str], picture: str = "") -> str:
        cells = "".join(
            f"<{tag} style='{_CELL.format(to)}'>{escape(text)}</{tag}>" for to, text in zip(aligned, texts, strict=True)
        )
        return f"<tr>{cells}{f'<td>{picture}</td>' if pictures else ''}</tr>"

    body = [line("td", row, pictures[i] if pictures else "") for i, row in enumerate(rows[:_ROWS])]
    more = f"<p>… and {count_text(len(rows) - _ROWS)} more</p>" if len(rows) > _ROWS else ""
    head = line("th", headings)
    caption = f"<caption style='text-align:left;font-weight:bold'>{escape(title)}</caption>"
    return f"<table style='{_STYLE}'>{caption}<thead>{head}</thead><tbody>{''.join(body)}</tbody></table>{more}"


def _histogram(bins: Histogram) -> str:
    """Return a histogram as SVG; the central range is darker."""
    counts = bins.inside + bins.outside
    most, wide = max(1, int(counts.max())), _WIDTH / len(counts)
    bars = "".join(
        f"<rect x='{i * wide:.2f}' y='{_HEIGHT * (1 - n / most):.2f}' width='{max(wide - 0.4, 0.4):.2f}' "
        f"height='{_HEIGHT * n / most:.2f}' opacity='{0.85 if inside else 0.35}'/>"
        for i, (n, inside) in enumerate(zip(counts.tolist(), bins.inside.tolist(), strict=True))
        if n
    )
    return f"<svg width='{_WIDTH}' height='{_HEIGHT}' role='img' aria-label='Histogram' fill='#2E6DA8'>{bars}</svg>"
