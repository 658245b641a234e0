"""What the answers depend on: influences among the accepted trials, and moves of one assumption alone."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.influences import MEASURED
from xlmc.analysis.studies.sensitivity.measures import Noise, noise
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.number_text import count_text, counted_text, fixed_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE, Shown
from xlmc.outputs.document.charts import influence_charts, tornado_chart
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Figure, Paragraph, Table
from xlmc.outputs.summary import first_forecasts, share_text

if TYPE_CHECKING:
    from xlmc.analysis.studies.sensitivity import Bar, ForecastSensitivity, Influence, Sensitivities
    from xlmc.excel.workbook.workbook import Workbook as SourceBook
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.document.material import Material

__all__ = [
    "BARS",
    "BENT",
    "EXPLAINED_CHART",
    "MOST_LINES",
    "ROWS",
    "SPIDER",
    "TORNADO_CHART",
    "base_text",
    "change_format",
    "explained_text",
    "influence_captions",
    "influence_rows",
    "influence_table",
    "is_bent",
    "move_captions",
    "move_table",
    "section",
    "sensitivity_figures",
    "sensitivity_sentences",
]

_MOST_BARS, _MOST_OF_MANY = 6, 3
"""Bars of a report, and where it tells of many forecasts."""
_FEW: Final = 4
"""Forecasts that have a chart of their own in a report; of more there is a table alone."""

BARS: Final = 10
"""Bars on a chart: more would not have readable names."""

ROWS: Final = 40
"""Rows in a table."""

MOST_LINES: Final = 6
"""The most lines of a spider chart; more cannot be told apart."""

EXPLAINED_CHART: Final = (
    "Variance explained: how much of the forecast's variance would vanish, on average, if the assumption's true "
    "value were known. It is found from the accepted trials, so it holds with filters and correlations; shares "
    "need not add up to 100 %. Pale bars, and the word noise in the table: no more than chance alone would show."
)

TORNADO_CHART: Final = (
    "Tornado: how far the forecast moves from its base case when one assumption goes to its 10th or 90th "
    "percentile and all others stay at their base values. It uses no trials, so probabilities, filters and "
    "correlations have no part in it."
)

SPIDER: Final = "Spider: the same over five points of each assumption's own distribution before filtering."

BENT: Final = "Where the table says that it does not only rise or fall, the bar hides what lies between."


def sensitivity_sentences(result: Sensitivities, source: SourceBook) -> list[str]:
    """Return the sentences that say what the numbers are and rest on."""
    messages = [
        "Influences are those among the accepted trials: filters change which assumptions matter. ± is the standard "
        "error that comes from a limited number of trials. No sensitivity says whether the model "
        f"{vocabulary_of(source).fits}."
    ]
    if result.sobol_reason:
        messages.append(f"{result.sobol_reason}.")
    if result.examined < result.accepted:
        messages.append(
            f"Influences rest on {count_text(result.examined)} of the {count_text(result.accepted)} "
            "accepted trials; the variance explained, "
            "where the forecast jumps or bends, on up to "
            f"{count_text(131_072)}."
        )
    if any(each.explained_at_least for forecast in result.forecasts for each in forecast.influences):
        messages.append(
            "Variance explained “at least” so much: the forecast jumps or bends more finely than the trials show, or a "
            "few trials decide the number, and it may be larger than its error says. More trials help."
        )
    if omitted := max((each.omitted for each in result.forecasts), default=0):
        messages.append(
            f"For each forecast those {MEASURED} assumptions are measured that matter most in a first look at all; the "
            f"other {count_text(omitted)} have less influence."
        )
    if result.omitted_forecasts:
        messages.append(first_forecasts("Sensitivity is shown of", len(result.forecasts), result.omitted_forecasts))
    if result.medians:
        messages.append(f"Held at their medians, because their cells are blank: {', '.join(result.medians)}.")
    return messages


def sensitivity_figures(sensitivity: ForecastSensitivity, pairs: int) -> Iterator[Figure]:
    """Yield the charts of a forecast; `pairs` of trials gave Sobol indices, 0 where there are none."""
    if sensitivity.influences:
        explained, _, _, contribution = map(
            Figure, influence_charts(sensitivity, BARS), influence_captions(sensitivity, pairs)
        )
        yield from (explained, contribution)
    if sensitivity.bars and sensitivity.base is not None:
        yield Figure(tornado_chart(sensitivity, BARS), move_captions(sensitivity)[0])


def influence_table(sensitivity: ForecastSensitivity, sobol: bool) -> Table:
    """Return all influences on a forecast, with Sobol indices where they are right."""
    heads = ["Assumption", "Units", "Variance explained", "Noise up to", "Dependence", "Noise up to"]
    heads += ["Rank correlation", "Contribution to variance", *["First order", "Total effect"] * sobol]
    pairs = zip(sensitivity.influences[:ROWS], noise(sensitivity), strict=False)
    return Table("", tuple(heads), tuple(_influence(each, weak, sobol) for each, weak in pairs))


def _influence(influence: Influence, weak: Noise, sobol: bool) -> tuple[Content, ...]:
    indices = ((influence.first_order, weak.first_order), (influence.total, weak.total)) if sobol else ()
    return (
        influence.assumption,
        influence.units,
        Measured(influence.explained, "share", noise=weak.explained, at_least=influence.explained_at_least),
        _floor(influence.explained_floor, influence.explained),
        Measured(influence.dependence, "share", noise=weak.dependence),
        _floor(influence.dependence_floor, influence.dependence),
        Measured(influence.rank_correlation, noise=weak.correlation, nothing=NONE),
        Measured(influence.contribution, "share", noise=weak.correlation, nothing=NONE),
        *(Measured(index, "share", noise=is_noise) for index, is_noise in indices),
    )


def _floor(floor: float, of: Estimate) -> Shown:
    """Return what chance alone would show, in the digits of the number."""
    return Shown(floor, cells.share_format(of), "error")


def influence_rows(sensitivity: ForecastSensitivity, most: int) -> Iterator[tuple[Content, ...]]:
    """Yield the largest influences on a forecast in brief, or that nothing moves it."""
    if not sensitivity.influences:
        yield sensitivity.forecast, "No assumption moves it, or there are too few trials to tell.", NONE, NONE
    for index, (each, weak) in enumerate(zip(sensitivity.influences[:most], noise(sensitivity), strict=False)):
        yield (
            "" if index else sensitivity.forecast,
            each.assumption,
            Measured(each.explained, "share", noise=weak.explained, written=explained_text(each)),
            Measured(each.rank_correlation, noise=weak.correlation, nothing=NONE),
        )


def explained_text(influence: Influence) -> str:
    """Return the share of variance explained as text, `at least 81.4 ± 1.2 %` where it is a lower bound; to hundredths
    of a percent, which no decision needs, where it is known better.
    """
    share, error = influence.explained.value, influence.explained.error
    text = share_text(influence.explained)
    if error is not None and math.isfinite(share) and error < _KNOWN_WELL:
        text = f"{fixed_text(100.0 * share, 2)} %"
    return f"{'at least ' if influence.explained_at_least else ''}{text}"


_KNOWN_WELL: Final = 5e-5
"""The error of a share that two decimals of a percentage do not show."""


def move_table(sensitivity: ForecastSensitivity) -> Table:
    """Return how far a forecast moves as each assumption is moved alone."""
    heads = ["Assumption, moved alone", "Units", "Base value", "10th percentile", "90th percentile"]
    heads += ["at 10 %", "at 25 %", "at 50 %", "at 75 %", "at 90 %", "Only rises or falls", "Cases rejected by filters"]
    base, changed = sensitivity.base or 0.0, change_format(sensitivity)
    return Table("", tuple(heads), tuple(_move(bar, base, changed) for bar in sensitivity.bars[:ROWS]))


def _move(bar: Bar, base: float, changed: str) -> tuple[Content, ...]:
    digits = cells.spread_format(bar.inputs[-1] - bar.inputs[0], bar.form)
    changes = [None if answer is None else answer - base for answer in bar.answers]
    rises = NONE if bar.monotonic is None else "yes" if bar.monotonic else "no"
    return (
        bar.assumption,
        bar.units,
        *(Shown(value, digits, date1904=bar.form.date1904) for value in (bar.base, bar.inputs[0], bar.inputs[-1])),
        *(Shown(change, changed) for change in changes),
        Shown(rises, look="moved" if bar.monotonic is False else "number"),
        Shown(f"{sum(bar.rejected)} of {len(bar.rejected)}", look="number"),
    )


def base_text(sensitivity: ForecastSensitivity) -> str:
    """Say what the base case gives, behind the words "its base case"; nothing where that is not known."""
    return f" of {sensitivity.base_text}" if sensitivity.base_text else ""


def change_format(sensitivity: ForecastSensitivity) -> str:
    """Return the format of changes of a forecast; of dates they are days."""
    widest = sensitivity.bars[0].span if sensitivity.bars else 0.0
    return cells.spread_format(widest, sensitivity.change_form)


def is_bent(sensitivity: ForecastSensitivity) -> bool:
    """Whether it does not only rise or fall with an assumption that is drawn."""
    return any(bar.monotonic is False for bar in sensitivity.bars[:BARS])


def influence_captions(sensitivity: ForecastSensitivity, pairs: int) -> list[str]:
    """Return a caption for each chart of influences: what it is and what it is not."""
    dependence = (
        "Dependence (index of Cramér and von Mises): 0 only if no part of the forecast's distribution depends on the "
        "assumption, 100 % if nothing else matters. Unlike variance explained it also shows an assumption that "
        "only widens the forecast or acts only together with others; it is not a share of the variance."
    )
    total = (
        f"Total effect (Sobol), from {count_text(pairs)} pairs of trials of their own: the variance "
        "that would be left, on "
        "average, if all other assumptions were known. It counts what the assumption does together with others, so the "
        "effects add up to 100 % or more. (Sobol's total index; first order is the part that it explains alone.)"
    )
    rank = (
        f"Rank correlation on {counted_text(sensitivity.trials, 'accepted trial')}: whether the forecast rises or "
        "falls with the assumption. It does not show effects that rise and fall, and it is not a share of the variance."
    )
    contribution = (
        "Contribution to variance as Crystal Ball shows it: squared rank correlations scaled to 100 %. Approximate, "
        "and wrong where filters or correlations tie assumptions together or an effect rises and falls: trust variance "
        "explained then."
    )
    return [EXPLAINED_CHART, total if pairs else dependence, rank, contribution]


def move_captions(sensitivity: ForecastSensitivity) -> list[str]:
    """Return a caption for tornado and spider: what each is and what it is not."""
    tornado = TORNADO_CHART.replace("its base case", f"its base case{base_text(sensitivity)}")
    if is_bent(sensitivity):
        tornado += f" {BENT}"
    lines = min(MOST_LINES, len(sensitivity.bars))
    spider = (
        f"Spider: the same over five points of each assumption's own distribution before filtering, for the {lines} "
        "that move it most; a bent line is an effect that a correlation describes badly. A steep line does not mean "
        "that a change is probable: it shows how the model reacts."
    )
    return [tornado, spider]


def section(material: Material) -> Iterator[Block]:
    """Yield what the chosen forecasts depend on most."""
    if material.simulation.weighting is not None:
        return
    simulation = material.simulation
    # Those that a person names are shown, wherever they stand.
    named = None if len(material.forecasts) == len(simulation.model.forecasts) else material.forecasts
    within = named is None or set(named) <= set(simulation.detailed)
    result, fits = sensitivities(simulation, None if within else named), vocabulary_of(simulation.model.workbook).fits
    shown = [each for each in result.forecasts if each.forecast in material.once]
    if not shown:
        return
    yield Paragraph(
        "Variance explained: how much of the forecast's variance would vanish, on average, if the assumption's true "
        "value were known. It is found from the accepted trials; shares need not add up to 100 %. “Noise” means: no "
        "more than chance alone would show. The rank correlation says whether the forecast rises (above 0) or falls "
        f"with the assumption. No sensitivity says whether the model {fits}."
    )
    if named is None and result.omitted_forecasts:
        yield Paragraph(first_forecasts("Sensitivity is shown of", len(shown), result.omitted_forecasts))
    lines: list[tuple[Content, ...]] = []
    most = _MOST_BARS if len(shown) <= _FEW else _MOST_OF_MANY
    for each in shown:
        if each.influences and len(shown) <= _FEW:
            caption = f"What {material.called(each.forecast)} depends on most."
            yield Figure(replace(influence_charts(each, most)[0], title=""), caption)
        lines += influence_rows(each, most)
    if lines:
        heads = ("Forecast", "Assumption", "Variance explained", "Rank correlation")
        caption = f"The assumptions that each forecast depends on most, {most} at most."
        yield Table("", heads, tuple(lines), (2, 3), (2, 3, 1.5, 1.5), caption)
