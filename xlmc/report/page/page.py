"""The whole page: one file that asks for nothing else, with its own style, scripts and data in it.

A Content-Security-Policy allows the scripts and styles that are in it, by their hashes, and nothing from anywhere.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterator
from html import escape
from importlib.resources import files
from string import Template
from typing import TYPE_CHECKING

from xlmc.report.figure import figures_of
from xlmc.report.page.answers import answers
from xlmc.report.page.dependence import dependence, limits
from xlmc.report.page.element import EMPTY, Html, element, joined
from xlmc.report.page.flow import Flow
from xlmc.report.page.forecasts import charts, overlays
from xlmc.report.page.inputs import inputs
from xlmc.report.page.payload import payload_text
from xlmc.report.page.recorded import recorded
from xlmc.report.sheets.accounting import write_accounting
from xlmc.report.sheets.certainty_sheet import write_ranges
from xlmc.report.sheets.checks_table import write_checks
from xlmc.report.sheets.pairs_sheet import pair_sentences, write_pair_table
from xlmc.report.sheets.results import LAST, write_counts
from xlmc.report.sheets.statistics_sheet import write_forecast
from xlmc.results.record import make_record
from xlmc.results.statements import pairs_of
from xlmc.studies.sensitivity import sensitivities

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["page_text"]

_STYLES = ("uplot/uPlot.min.css", "page.css", "charts.css", "print.css")
_SCRIPTS = (
    "sharp.js",
    "uplot/uPlot.iife.min.js",
    "numbers.js",
    "certainty.js",
    "chart.js",
    "grabbers.js",
    "panel.js",
    "overlay.js",
    "start.js",
)
_LICENCE = "uplot/LICENSE"

_LINKS = {
    "answer": "The answer",
    "forecasts": "Forecasts",
    "overlay": "Overlay",
    "certainty": "Certainty",
    "pairs": "Pairs",
    "statistics": "Statistics",
    "sensitivity": "Sensitivity",
    "checks": "Checks",
    "filters": "Filters",
    "limits": "Filter limits",
    "assumptions": "Assumptions",
    "notices": "Notices",
    "record": "Record",
}


def page_text(simulation: Simulation, *, command: str | None = None) -> str:
    """The page of a run; the same run gives the same text.

    Args:
        simulation: the finished run.
        command: what the person typed, for the record.
    """
    figures, name = figures_of(simulation), simulation.model.workbook.name
    found = sensitivities(simulation)
    parts = {
        "answer": answers(simulation),
        "forecasts": charts(simulation, figures),
        "overlay": overlays(figures),
        "certainty": _certainty(simulation),
        "pairs": _pairs(simulation),
        "statistics": _statistics(simulation),
        "sensitivity": dependence(found),
        "checks": _checks(simulation),
        "filters": _filters(simulation),
        "limits": limits(found),
        "assumptions": inputs(simulation),
        "notices": _notices(simulation),
        "record": recorded(make_record(simulation, command)),
    }
    styles, scripts = [_asset(path) for path in _STYLES], [_asset(path) for path in _SCRIPTS]
    return Template(_asset("page.html")).substitute(
        policy=escape(_policy(styles, scripts)),
        title=escape(f"{name}: results of the simulation"),
        licence=_asset(_LICENCE),
        styles="".join(f"<style>{style}</style>\n" for style in styles),
        header=_header(simulation, [key for key, part in parts.items() if part != EMPTY]).source,
        sections=joined(list(parts.values())).source,
        data=payload_text(simulation, figures),
        scripts="".join(f"<script>{script}</script>\n" for script in scripts),
    )


def _asset(path: str) -> str:
    return files("xlmc.report.page").joinpath(path).read_text(encoding="utf-8")


def _policy(styles: list[str], scripts: list[str]) -> str:
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


def _header(simulation: Simulation, keys: list[str]) -> Html:
    run = f"{simulation.evaluated:,} trials, {simulation.accepted:,} accepted; seed {simulation.settings.seed}"
    links = (element("a", label, href=f"#{key}") for key, label in _LINKS.items() if key in keys)
    return element(
        "header",
        element("h1", "Results of the simulation"),
        element("p", element("bdi", simulation.model.workbook.name), f": {run}", class_="subtitle"),
        element("nav", *links, aria_label="Parts of this page"),
    )


def _statistics(simulation: Simulation) -> Html:
    forecasts = []
    for result in simulation.results.values():
        flow = Flow()
        write_forecast(flow, result)
        forecasts.append(element("div", flow.html, class_="forecast-statistics"))
    said = "Of the accepted trials. The last two columns are the 95 % interval of each number."
    return element(
        "section", element("h2", "Statistics"), element("p", said, class_="remark"), *forecasts, id="statistics"
    )


def _certainty(simulation: Simulation) -> Html:
    flow = Flow()
    write_ranges(flow, simulation)
    said = "The share of the accepted trials below, in and above each central range, as it is rounded here."
    return element(
        "section", element("h2", "Certainty of ranges"), element("p", said, class_="remark"), flow.html, id="certainty"
    )


def _pairs(simulation: Simulation) -> Html:
    pairs = pairs_of(simulation)
    if not pairs:
        return EMPTY
    flow = Flow()
    write_pair_table(flow, pairs)
    remarks = (element("p", said, class_="remark") for said in pair_sentences(simulation, pairs))
    return element("section", element("h2", "Forecasts two at a time"), flow.html, *remarks, id="pairs")


def _checks(simulation: Simulation) -> Html:
    if not simulation.checks:
        return EMPTY
    flow = Flow()
    write_checks(flow, simulation, LAST)
    return element("section", element("h2", "Checks"), flow.html, id="checks")


def _filters(simulation: Simulation) -> Html:
    flow = Flow()
    write_counts(flow, simulation)
    write_accounting(flow, simulation, LAST)
    return element("section", element("h2", "Trials and filters"), flow.html, id="filters")


def _notices(simulation: Simulation) -> Html:
    if not simulation.notices:
        return EMPTY
    notices = (element("p", str(notice), class_="notice") for notice in simulation.notices)
    return element("section", element("h2", "Notices"), *notices, id="notices")
