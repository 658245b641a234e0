"""How the answers move as each limit of each filter moves: the shares accepted, the slopes, and every answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.charts import limit_chart, width_of_range
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Figure, Heading, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.analysis.studies.sensitivity import (
        FilterLimit,
        ForecastSensitivity,
        LimitAnswer,
        LimitPoint,
        Sensitivities,
    )
    from xlmc.outputs.document.material import Material

__all__ = [
    "NOT_MOVED",
    "acceptance_table",
    "answers_table",
    "limit_blocks",
    "limit_figures",
    "limit_heading",
    "limit_sentences",
    "limit_text",
    "moved_caption",
    "nothing_moves",
    "section",
    "slopes_table",
]

NOT_MOVED: Final = "The accepted trials do not say by how much it could be moved."


def limit_blocks(result: Sensitivities) -> Iterator[Block]:
    """Yield what moving a limit means, then the charts and tables of each; nothing where no filter has one."""
    if not (result.filter_limits or result.varying_limits or result.omitted_limits):
        return
    for sentence in limit_sentences(result):
        yield Paragraph(sentence, "small")
    forecasts = {each.forecast: each for each in result.forecasts}
    for limit in result.filter_limits:
        yield Heading(limit_heading(limit), 2)
        if limit.points:
            yield from limit_figures(limit, forecasts)
            yield from (acceptance_table(limit), slopes_table(limit), answers_table(limit, forecasts))
        else:
            yield Paragraph(NOT_MOVED)


def limit_heading(limit: FilterLimit) -> str:
    """Name a limit."""
    return f"{limit.filter}: {limit.relation} {limit_text(limit)} ({limit.cell})"


def limit_text(limit: FilterLimit) -> str:
    """Write a limit as the cell of its filter shows numbers."""
    return limit.form.number(limit.limit, typed=True)


def limit_sentences(result: Sensitivities) -> list[str]:
    """Sentences that say what moving a limit means."""
    messages = [
        "One limit is moved; all others stay. A tighter limit keeps some of the accepted trials. A looser one also "
        "accepts trials that nothing else rejects; these come from the run's first trials, so their errors are larger. "
        "Changes and slopes compare runs that share trials, and their errors allow for that. A limit is evidence: "
        "this sheet shows how much its exact value matters, not which value is right."
    ]
    if result.varying_limits:
        messages.append(
            f"Not moved, because the limit varies with the assumptions: {', '.join(result.varying_limits)}."
        )
    if result.omitted_limits:
        messages.append(
            f"{count_text(result.omitted_limits)} further limits were left out: the last of very many, "
            "or all of them where "
            "accepted trials are rare, because trials near a limit are then not among those drawn before the search."
        )
    return messages


def acceptance_table(limit: FilterLimit) -> Table:
    """Return the share of the trials that is accepted at each value of the limit."""
    rows = (
        (_tighter_or_looser(each.limit, limit), _place(each, limit), cells.count(each.trials), _share(each))
        for each in limit.points
    )
    return Table("", ("Limit", "Value", "Trials", "Share"), tuple(rows))


def _place(point: LimitPoint, limit: FilterLimit) -> Shown:
    """Show one value of a limit, in the form of the filter's cell."""
    return cells.exact(point.limit, limit.form)


def _share(point: LimitPoint) -> Measured:
    return Measured(point.acceptance, "share")


def _tighter_or_looser(value: float, limit: FilterLimit) -> str:
    if value == limit.limit:
        return "as it is"
    looser = (value < limit.limit) == (limit.relation in ("at least", "above"))
    return "looser" if looser else "tighter"


def slopes_table(limit: FilterLimit) -> Table:
    """Return how fast the mean of each forecast changes with the limit."""
    rows = tuple((slope.forecast, Measured(slope.mean)) for slope in limit.slopes)
    return Table("", ("Change of the mean of …, per unit of the limit", "Slope"), rows)


def answers_table(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> Table:
    """Return every forecast at every value of the limit, a row for each value, the forecasts one after the other."""
    heads = ("Forecast", "Limit", "Mean", "Change of mean", "Range from", "to", "Change / range", "±")
    rows: list[tuple[Content, ...]] = []
    for index, slope in enumerate(limit.slopes):
        now = next(point.answers[index] for point in limit.points if point.limit == limit.limit)
        forecast = forecasts[slope.forecast]
        rows += [_answer(forecast, _place(point, limit), point.answers[index], now) for point in limit.points]
    return Table("", heads, tuple(rows))


def _answer(forecast: ForecastSensitivity, limit: Shown, answer: LimitAnswer, now: LimitAnswer) -> tuple[Content, ...]:
    width, look, form, like = width_of_range(forecast, now), "number", forecast.form, now.mean
    is_share = form.kind is Kind.YES_NO
    if answer is now:
        look = "second number"
    return (
        forecast.forecast,
        replace(limit, look=look),
        Measured(answer.mean, form=form, look=look, like=like),
        Measured(answer.change, "change", form, look, like=like),
        *(
            Measured(None if is_share else end, form=form, look=look, like=like, nothing=cells.NONE)
            for end in (answer.low, answer.high)
        ),
        *(
            Shown(None if each is None or width <= 0.0 else each / width, "0.0%", look)
            for each in (answer.change.value, answer.change.error)
        ),
    )


def limit_figures(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> Iterator[Block]:
    """Yield a chart for the forecasts of each unit and kind: changes in different units have no common axis.

    Where nothing moves a sentence takes their place.
    """
    if still := nothing_moves(limit):
        yield Paragraph(still.strip())
        return
    alike: dict[tuple[object, ...], list[int]] = {}
    for index, slope in enumerate(limit.slopes):
        each = forecasts[slope.forecast]
        alike.setdefault((each.change_units, *each.form.axis), []).append(index)
    for number, indexes in enumerate(alike.values()):
        first = forecasts[limit.slopes[indexes[0]].forecast]
        chart = limit_chart(limit, indexes, first.change_units, first.change_form)
        yield Figure(chart, "" if number else moved_caption(limit))


def moved_caption(limit: FilterLimit) -> str:
    """Return the caption of the chart of the changes."""
    return (
        f"How far each forecast's mean moves from that with the limit as it is ({limit_text(limit)}); whiskers "
        f"are standard errors of the change. Other filters and limits stay.{nothing_moves(limit)}"
    )


def nothing_moves(limit: FilterLimit) -> str:
    """Return the sentence on changes of 0 ± 0; empty if some change is not."""
    if len({point.trials for point in limit.points}) > 1:
        return ""
    return " No trial that everything else keeps lies between these limits, so nothing moves; with more trials it may."


def section(material: Material) -> Iterator[Block]:
    """Yield how the answers move with limits."""
    if material.simulation.weighting is None:
        yield from limit_blocks(sensitivities(material.simulation))
