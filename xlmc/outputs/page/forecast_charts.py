"""The charts of the page: one for each forecast with its two grabbers and boxes, and one that shows several forecasts.

The frame is written here; `panel.js` draws into it and counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import count_text, number_text, percent
from xlmc.outputs.document.charts import shares_chart
from xlmc.outputs.document.element import EMPTY, Html, element, join, void
from xlmc.outputs.document.html_writer import estimate_html, picture_html, share_html
from xlmc.outputs.histogram import Figure
from xlmc.outputs.page.payload import counted_figures, most_values, overlays_of
from xlmc.outputs.summary import SummaryRow, first_forecasts, frequent_texts, shares_of

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["charts", "overlays"]

_VIEWS = (("frequency", "Frequency"), ("cumulative", "Cumulative"), ("reverse", "Reverse cumulative"))

_PERCENTS = (5.0, 25.0, 50.0, 75.0, 95.0)

_HOW = (
    "Drag the two grabbers below a chart, or move them with the arrow keys: the certainty is the share of the accepted "
    "trials between them, both ends included. Or type the ends, or a certainty: as many trials then lie below the "
    "grabbers as above. Shaded: the central range of the answer above."
)

_PLAIN_SHARE = (
    "± of the certainty is that of as many independent trials; the samples of this run are more even, so it is rather "
    "too large."
)

_NOTHING = "No forecast has a number in an accepted trial: nothing to draw."


def charts(simulation: RunResult, figures: Sequence[Figure]) -> Html:
    """Return the section with a chart for every forecast."""
    counted = counted_figures(figures)
    charts = len(simulation.detailed)
    beyond = first_forecasts("Charts are drawn of", charts, len(simulation.model.forecasts) - charts)
    return element(
        "section",
        element("h2", "Forecasts"),
        *([element("p", beyond, class_="remark")] if charts < len(simulation.model.forecasts) else []),
        *(_how_to_read(simulation, counted) if counted else []),
        *([] if figures else [element("p", _NOTHING, class_="alarm")]),
        element("noscript", element("p", "The charts need JavaScript; every number below is here without it.")),
        *(
            _shares(figure)
            if figure.answer.is_share
            else _chart(figure, simulation.results[figure.answer.name], counted.index(figure))
            for figure in figures
        ),
        id="forecasts",
    )


def _how_to_read(simulation: RunResult, figures: Sequence[Figure]) -> Iterator[Html]:
    yield element("p", _HOW, class_="how")
    if simulation.plan.size:
        yield element("p", _PLAIN_SHARE, class_="remark")
    most = most_values(len(figures))
    if max(figure.answer.trials for figure in figures) > most:
        yield element(
            "p",
            f"Of a forecast with more than {count_text(most)} trials the page holds only "
            f"{count_text(most)} values, evenly spaced in the "
            "sorted trials, and the number of trials between them. So the count at an end may be wrong by up to "
            f"{number_text(100 / (most - 1), 2)} % of the trials, as the certainty says; it is exact "
            "at the ends of the central "
            "range.",
            class_="remark",
        )


def _shares(figure: Figure) -> Html:
    """Return the bars of an answer that is yes or no, or a text, and the share of each."""
    shares = shares_of(figure.answer)
    frequent, others, left = frequent_texts(shares)
    rows = [
        element("tr", element("th", text or "(empty)", scope="row"), element("td", share_html(share), class_="number"))
        for text, share in frequent.items()
    ]
    if others:
        share = f"{number_text(100.0 * left, 3)} %"
        rows.append(element("tr", element("th", others, scope="row"), element("td", share, class_="number")))
    drawing = element(
        "div",
        picture_html(shares_chart(figure)),
        element("p", figure.caption, class_="caption"),
        class_="drawing",
    )
    caption = element("caption", "Share of the accepted trials")
    table = element("table", caption, element("tbody", *rows), class_="beside")
    panel = element("div", table, class_="panel")
    return element("article", element("h3", figure.name), element("div", drawing, panel, class_="figure"))


def _chart(figure: Figure, result: ForecastResult, index: int) -> Html:
    answer, number = figure.answer, figure.number
    about = f"chart-{number}"
    panel = element(
        "div",
        _views(about),
        _choices(answer),
        element("p", class_="certainty", role="status"),
        element(
            "div",
            _box("Lower end", "low", answer.units),
            _box("Upper end", "high", answer.units),
            _box("Certainty", "share", "%"),
            class_="boxes",
        ),
        element("p", class_="fault", role="alert"),
        element("button", f"Central {percent(answer.share)} range", type="button", class_="reset"),
        _statistics(result),
        class_="panel",
    )
    drawing = element(
        "div",
        element("div", class_="chart", role="group", aria_label=f"Chart of {answer.name}, with two grabbers"),
        element("p", class_="readout"),
        element("p", figure.caption, class_="caption"),
        element("p", class_="fitted", role="status"),
        class_="drawing",
    )
    return element(
        "article",
        element("h3", figure.name),
        element("div", drawing, panel, class_="figure"),
        id=about,
        class_="forecast",
        data_forecast=str(index),
    )


def _statistics(result: ForecastResult) -> Html:
    """Return the numbers that a reader of the chart asks for first; the section Statistics has all."""
    description = result.statistics
    shown = {
        "Mean": description.mean,
        "Standard deviation": description.standard_deviation,
        "Minimum": description.minimum,
        **{f"{number_text(each)} %": description.percentiles[each] for each in _PERCENTS},
        "Maximum": description.maximum,
    }
    rows = (
        element(
            "tr", element("th", label, scope="row"), element("td", _statistic(result, label, each), class_="number")
        )
        for label, each in shown.items()
    )
    return element("table", element("caption", "All accepted trials"), element("tbody", *rows), class_="beside")


def _statistic(result: ForecastResult, label: str, estimate: Estimate) -> Html:
    return estimate_html(estimate, result.form.spread if label == "Standard deviation" else result.form.estimate)


def _views(about: str) -> Html:
    buttons = [
        element(
            "label",
            void("input", type="radio", name=f"{about}-view", value=key, checked="" if key == "frequency" else None),
            label,
        )
        for key, label in _VIEWS
    ]
    return element("fieldset", element("legend", "Chart"), *buttons, class_="views")


def _choices(answer: SummaryRow) -> Html:
    """How many bars are drawn as one, what is marked, and what fitted distribution is drawn over them."""
    options = (
        element("option", label, value=str(together))
        for together, label in ((1, "each"), (2, "two as one"), (4, "four as one"))
    )
    bars = element("label", "Bars ", element("select", *options, class_="together"))
    lines = {"Mean": answer.mean, "Base case": answer.base, "Threshold": answer.threshold}
    marked = (
        element("label", void("input", type="checkbox", class_="line", value=label, checked=""), label)
        for label, value in lines.items()
        if value is not None
    )
    hint = {"placeholder": "5, 50, 95", "size": "9", "autocomplete": "off"}
    percentiles = element("label", "Mark at ", void("input", type="text", class_="percentiles", **hint), " %")
    fits = element("label", "Fit ", element("select", element("option", "none"), class_="fit"))
    return element("p", bars, *marked, percentiles, fits, class_="choices")


def _box(label: str, key: str, units: str) -> Html:
    box = void("input", type="text", inputmode="text", autocomplete="off", spellcheck="false", class_=key)
    return element("label", element("span", label), box, element("span", units, class_="unit"))


def overlays(figures: Sequence[Figure]) -> Html:
    """Return the section with forecasts of one unit in one chart; nothing if no two share a unit."""
    figures = counted_figures(figures)
    groups = overlays_of(figures)
    if not groups:
        return EMPTY
    return element("section", element("h2", "Overlay"), join(_overlays(figures, groups)), id="overlay")


def _overlays(figures: Sequence[Figure], groups: Sequence[Sequence[int]]) -> list[Html]:
    return [
        element(
            "article",
            _views(f"overlay-{number}"),
            element(
                "div",
                class_="chart",
                role="img",
                aria_label=f"Chart of {', '.join(figures[index].name for index in group)}",
            ),
            element("ul", class_="legend"),
            class_="overlay",
            data_overlay=str(number),
        )
        for number, group in enumerate(groups)
    ]
