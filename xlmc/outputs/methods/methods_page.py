"""A study of methods as one HTML page that needs no other file: the recommendation, the figures as SVG, the tables."""

from __future__ import annotations

import io
from collections.abc import Sequence
from functools import lru_cache
from html import escape
from typing import Final

from xlmc.analysis.studies.methods import Study, recommendation
from xlmc.outputs.methods import methods_tables
from xlmc.outputs.methods.matplotlib_figure import draw
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, Work

__all__ = ["ENDS", "page", "svg"]

ENDS: Final = "Where the optimised bounds are reached: points that the workbook accepts"

_STYLE = """
body { font: 15px/1.5 "Segoe UI", "Helvetica Neue", Arial, sans-serif; color: #1F3044; margin: 2em auto;
  max-width: 1180px; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; }
h2 { font-size: 1.15em; margin-top: 2em; }
p.below { color: #52606D; margin-top: .2em; }
p.said { max-width: 62em; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; }
th { background: #1F3044; color: #fff; font-weight: 600; text-align: right; padding: .35em .6em; }
td { border-bottom: 1px solid #D5DBE3; padding: .3em .6em; text-align: right; font-variant-numeric: tabular-nums;
  white-space: nowrap; }
th.left, td.left { text-align: left; }
td.long { white-space: normal; text-align: left; }
figure { margin: 1em 0; }
svg { width: 100%; height: auto; }
code { background: #EEF4FA; padding: .1em .3em; }
@media print {
  body { margin: 0; max-width: none; font-size: 11px; }
  table { font-size: 9px; }
  h2 { break-after: avoid; }
}
"""


_WORKS: Final[tuple[tuple[Work, str], ...]] = (("seconds", "time"), ("evaluations", "evaluations of the workbook"))


def page(study: Study) -> str:
    """Write the page."""
    name = escape(study.model.workbook.name)
    words = "".join(f'<p class="said">{_text(each)}</p>\n' for each in recommendation(study))
    shown = (
        methods_tables.error_table(study), methods_tables.bounds_table(study), methods_tables.reference_table(study),
        methods_tables.forecast_table(study), methods_tables.length_table(study),
    )  # fmt: skip
    how = "".join(f'<p class="said">{escape(each)}</p>\n' for each in HOW_TO_READ) if study.varying else ""
    figures = "".join(
        f"<h2>Speed against accuracy: {what}</h2>\n{how if against == 'seconds' else ''}"
        f"<figure>{svg(study, against)}</figure>\n"
        for against, what in _WORKS
    )
    ends = methods_tables.ends_lines(study)
    points = f"<h2>{ENDS}</h2>\n{_lines(ends)}" if ends else ""
    first, *rest = (_table(each) for each in shown if each.rows)
    return (
        "<!DOCTYPE html>\n"
        f'<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>Methods: {name}</title>\n'
        f"<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<h1>Methods of uncertainty analysis</h1>\n<p class="below">{name}</p>\n'
        f"{words}{figures}{first}"
        f"<h2>What each method says of itself, and cannot do</h2>\n{_lines(methods_tables.cannot_lines(study))}"
        f"{''.join(rest)}{points}</body>\n</html>\n"
    )


def _lines(lines: Sequence[tuple[str, str]]) -> str:
    """Write a table of two columns, the second of which is wrapped."""
    rows = "".join(
        f'<tr><td class="left">{escape(name)}</td><td class="long">{escape(sentence)}</td></tr>\n'
        for name, sentence in lines
    )
    return f'<div class="wide"><table>{rows}</table></div>\n'


def _text(sentence: str) -> str:
    """Escaped, what stands between backticks as code."""
    parts = escape(sentence).split("`")
    return "".join(f"<code>{part}</code>" if index % 2 else part for index, part in enumerate(parts))


def _table(table: methods_tables.Table) -> str:
    head = "".join(
        f'<th class="left">{escape(each)}</th>' if index < table.right else f"<th>{escape(each)}</th>"
        for index, each in enumerate(table.headings)
    )
    rows = "".join(f"<tr>{_row(row, table.right)}</tr>\n" for row in table.rows)
    return f'<h2>{escape(table.title)}</h2>\n<div class="wide"><table><tr>{head}</tr>\n{rows}</table></div>\n'


def _row(row: tuple[str, ...], right: int) -> str:
    return "".join(
        f'<td class="left">{escape(cell)}</td>' if index < right else f"<td>{escape(cell)}</td>"
        for index, cell in enumerate(row)
    )


@lru_cache(maxsize=len(_WORKS))  # drawing takes a second, and page and document show the same
def svg(study: Study, against: Work) -> str:
    """Draw the figure of a study as SVG, its letters as shapes; the same study gives the same bytes."""
    import matplotlib as mpl

    drawn = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "path", "svg.hashsalt": "xlmc"}):
        draw(study, against, words=False).savefig(drawn, format="svg", metadata={"Date": None})
    text = drawn.getvalue()
    return text[text.index("<svg") :]
