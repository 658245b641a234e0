"""The whole page: one file with its own style, scripts and data, which loads nothing else.

A Content-Security-Policy allows the scripts and styles that are in it, by their hashes, and no others.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
from collections.abc import Iterator, Mapping
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING

from xlmc.analysis.results.record import make_record
from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.errors import WorkbookError
from xlmc.excel.workbook.seal import sealed_text
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import check_folder, write_workbook
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.montecarlo.number_text import count_text, counted_text
from xlmc.outputs.document import further_sections
from xlmc.outputs.document.build import units_of
from xlmc.outputs.document.element import EMPTY, Html, element, join
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.document.sections import in_order
from xlmc.outputs.document.unbroken import in_units
from xlmc.outputs.histogram import figures_of
from xlmc.outputs.page.forecast_charts import charts, overlays
from xlmc.outputs.page.payload import payload_text
from xlmc.outputs.page.second_run import second_run
from xlmc.outputs.page.sensitivity_sections import dependence, limits
from xlmc.outputs.page.sheet_sections import (
    answer,
    assumptions,
    certainty,
    checks,
    evidence,
    filters,
    notices,
    record,
    statistics,
)

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["check_page_path", "page_policy", "page_text", "plain_page", "save_page"]

ENDINGS = (".html", ".htm")

_STYLES = ("uplot/uPlot.min.css", "page.css", "charts.css", "print.css")

_PLAIN_STYLES = _STYLES[1:]

_SCRIPTS = (
    "sharp.js",
    "uplot/uPlot.iife.min.js",
    "numbers.js",
    "certainty.js",
    "chart.js",
    "grabbers.js",
    "panel.js",
    "overlay.js",
    "copies.js",
    "later.js",
    "start.js",
)

_MANY = 13
"""Forecasts from which on none are laid over each other, as in `later.js`."""
_LARGE = 3_000_000
"""Characters of a page from which on some sections are packed."""
_PACKED = ("certainty", "statistics", "sensitivity", "limits", "assumptions", "record")

_LICENCE = "uplot/LICENSE"

_LINKS = {
    "answer": "The answer",
    "second": "Second run",
    "forecasts": "Forecasts",
    "overlay": "Overlay",
    "certainty": "Certainty",
    "scenarios": "Scenarios",
    "pairs": "Pairs",
    "statistics": "Statistics",
    "sensitivity": "Sensitivity",
    "checks": "Checks",
    "evidence": "Evidence",
    "filters": "Filters",
    "limits": "Filter limits",
    "assumptions": "Assumptions",
    "notices": "Notices",
    "record": "Record",
}


def save_page(
    simulation: RunResult,
    path: Path,
    *,
    beside: RunResult | None = None,
    command: str | None = None,
    overwrite: bool = False,
) -> Path:
    """Write the page whole or not at all; an untouched page of the same workbook is replaced.

    Args:
        simulation: the finished run.
        path: where to; it ends in `.html` or `.htm`.
        beside: a second run, which stands beside it.
        command: what the person typed, for the record.
        overwrite: replace any other file too.

    Returns:
        The path.

    Raises:
        TakenError: the file is not ours to replace.
        WorkbookError: the file has another ending, or cannot be written.
    """
    check_page_path(path)
    read = (*simulation.model.files, *(() if beside is None else beside.model.files))
    target = Target(path, simulation.model.workbook.name, overwrite, read=read)
    target.check()
    # Half of a surrogate pair, which a damaged name can hold, has no UTF-8: the browser shows a reference's mark.
    text = page_text(simulation, beside=beside, command=command).encode("utf-8", "xmlcharrefreplace")
    write_workbook(path, sealed_text(text, ".html", target.book), target.check)
    return path


def check_page_path(path: Path) -> None:
    """Refuse, before a long run, a file of another kind, or one that `check_folder` refuses.

    Raises:
        WorkbookError: it is one of these.
    """
    if path.suffix.casefold() not in ENDINGS:
        hint = f"Name it '{path.stem or 'results'}.html'"
        raise WorkbookError("the page must end in .html", where=path, hint=hint)
    check_folder(path)


@in_style_of("settings.number_style")
def page_text(simulation: RunResult, *, beside: RunResult | None = None, command: str | None = None) -> str:
    """Return the page of a run as HTML; the same run gives the same text.

    Args:
        simulation: the finished run.
        beside: a second run, which stands beside it.
        command: what the person typed, for the record.
    """
    scenario_answers(simulation)  # cells may ask about them, and warnings tell of those that cannot
    with in_units(units_of(simulation.model)):
        return _page(simulation, beside, command)


def _page(simulation: RunResult, beside: RunResult | None, command: str | None) -> str:
    figures, name = figures_of(simulation, simulation.detailed), simulation.model.workbook.name
    result = None if simulation.weighting is not None else sensitivities(simulation)
    parts = {
        "answer": answer(simulation),
        "second": EMPTY if beside is None else second_run(simulation, beside),
        "forecasts": charts(simulation, figures),
        "overlay": overlays(figures) if len(figures) < _MANY else EMPTY,
        "statistics": statistics(simulation),
        "certainty": certainty(simulation),
        "sensitivity": EMPTY if result is None else dependence(result, simulation.model.workbook),
        "checks": checks(simulation),
        "evidence": evidence(simulation),
        "filters": filters(simulation),
        "limits": EMPTY if result is None else limits(result),
        "assumptions": assumptions(simulation),
        "notices": notices(simulation),
        "record": record(make_record(simulation, command)),
    }
    further = further_sections(simulation, "page")
    others = {
        key: element("section", element("h2", heading), blocks_html(blocks), id=key)
        for key, (heading, blocks) in further.items()
    }
    parts = in_order("page", parts, others)
    links = {key: heading for key, (heading, _) in further.items()} | _LINKS
    data = payload_text(simulation, figures, beside)
    if sum(len(part.source) for part in parts.values()) + len(data) > _LARGE:
        parts |= {key: _packed_section(key, parts[key]) for key in _PACKED if parts[key] != EMPTY}
        data = f'"{_packed(data)}"'
    styles, scripts = _code()
    return Template(_asset("page.html")).substitute(
        policy=escape(page_policy()),
        title=escape(f"{name}: results of the simulation"),
        licence=_asset(_LICENCE),
        styles="".join(f"<style>{style}</style>\n" for style in styles),
        header=_header(simulation, {key: links[key] for key, part in parts.items() if part != EMPTY}).source,
        sections=join(list(parts.values())).source,
        data=data,
        scripts="".join(f"<script>{script}</script>\n" for script in scripts),
    )


def _packed_section(key: str, part: Html) -> Html:
    """Make a section that holds another one packed until its button is pressed: many elements make browsers slow."""
    button = element("button", "Show", type="button", data_packed=_packed(part.source))
    notice = element("p", button, " This page is large: this part is shown, and printed, when it is asked for.")
    return element("section", element("h2", _LINKS[key]), notice, id=key)


def _packed(text: str) -> str:
    """Pack a text, in letters that can stand in an attribute."""
    packed = gzip.compress(text.encode("utf-8", "xmlcharrefreplace"), mtime=0)
    return base64.b64encode(packed).decode()


def plain_page(title: str, below: str, content: Html) -> str:
    """Return a page without scripts, in the style of the others: a title, the line below it, and the content."""
    styles = [_asset(path) for path in _PLAIN_STYLES]
    header = element("header", element("h1", title), element("p", below, class_="subtitle"))
    return Template(_asset("plain.html")).substitute(
        policy=escape("default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'"),  # of drawings
        title=escape(title),
        styles="".join(f"<style>{style}</style>\n" for style in styles),
        header=header.source,
        sections=content.source,
    )


def _asset(path: str) -> str:
    return files("xlmc.outputs.page").joinpath(path).read_text(encoding="utf-8")


def _code() -> tuple[list[str], list[str]]:
    """Return the styles and the scripts of a page."""
    return [_asset(path) for path in _STYLES], [_asset(path) for path in _SCRIPTS]


def page_policy() -> str:
    """Return the Content-Security-Policy of a page: its own scripts and styles, and nothing else."""
    styles, scripts = _code()
    return "; ".join(
        (
            "default-src 'none'",
            f"style-src {' '.join(_hashes(styles))}",
            f"script-src {' '.join(_hashes(scripts))}",
            "img-src data:",
            "base-uri 'none'",
            "form-action 'none'",
        )
    )


def _hashes(texts: list[str]) -> Iterator[str]:
    for text in texts:
        yield f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _header(simulation: RunResult, parts: Mapping[str, str]) -> Html:
    run = (
        f"{counted_text(simulation.evaluated, 'trial')}, {count_text(simulation.accepted)} accepted; "
        f"seed {simulation.settings.seed}"
    )
    links = (element("a", label, href=f"#{key}") for key, label in parts.items())
    return element(
        "header",
        element("h1", "Results of the simulation"),
        element("p", element("bdi", simulation.model.workbook.name), f": {run}", class_="subtitle"),
        element("nav", *links, *_buttons(), aria_label="Parts of this page"),
    )


def _buttons() -> Iterator[Html]:
    """Yield the buttons for the tables that are closed at first; only open tables are printed."""
    for key, label in (("open", "Open all tables"), ("closed", "Close them")):
        yield element("button", label, type="button", data_all=key)
