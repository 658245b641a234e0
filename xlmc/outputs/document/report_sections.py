"""What makes the blocks of each section from a run; `sections` has the rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record.definition_tables import correlations_met
from xlmc.analysis.results.statements import pairs_of
from xlmc.analysis.results.statements.in_words import (
    distribution_text,
    status,
)
from xlmc.analysis.studies.scenario_answers import impossible_scenarios, scenario_answers
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.measures import noise
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.number_text import count_text, exact_text, fixed_text, number_text
from xlmc.outputs.document.charts import influence_chart, shape_chart, shares_chart
from xlmc.outputs.document.content.answers import answer_blocks
from xlmc.outputs.document.content.certainty import certainty_blocks
from xlmc.outputs.document.content.checks import check_blocks
from xlmc.outputs.document.content.evidence import evidence_blocks
from xlmc.outputs.document.content.filters import filter_blocks
from xlmc.outputs.document.content.notices import notice_blocks
from xlmc.outputs.document.content.pairs import pair_blocks
from xlmc.outputs.document.content.scenarios import scenario_blocks
from xlmc.outputs.document.content.statistics import statistics_blocks
from xlmc.outputs.document.drawings import forecast_drawing
from xlmc.outputs.document.drawn_trials import drawn_trials
from xlmc.outputs.document.equations import equations_of
from xlmc.outputs.document.glossary import GLOSSARY, WORDS_OF_EVIDENCE, WORDS_OF_SCENARIOS
from xlmc.outputs.document.parts import Block, Bullets, Code, Content, Figure, Paragraph, Table
from xlmc.outputs.document.scene_drawing import scene_drawing
from xlmc.outputs.filter_effect import filter_effect_of
from xlmc.outputs.histogram import figures_of, not_drawn
from xlmc.outputs.summary import (
    answer_text,
    central_text,
    estimate_text,
    first_forecasts,
    percent,
    share_text,
)

if TYPE_CHECKING:
    from xlmc.analysis.results.record import Record
    from xlmc.analysis.studies.sensitivity import ForecastSensitivity, Influence
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["MAKERS", "Material"]

_MOST_BARS, _MOST_OF_MANY = 6, 3
_FEW: Final = 4
"""Forecasts whose figures are large, two a page; those of more stand four a page, and their influences in a table."""
_MOST_FIGURES: Final = 12
"""Forecasts that a report draws."""
_LARGE, _SMALL = 160.0, 100.0
"""Widths of the figures of forecasts, in millimetres."""
_NONE: Final = "–"


@dataclass
class Material:
    """What sections are made from.

    Attributes:
        simulation: the finished run.
        record: its record.
        forecasts: the names of those that the report is about, in the order of the workbook.
    """

    simulation: RunResult
    record: Record
    forecasts: tuple[str, ...]


def _table(
    caption: str,
    heads: Sequence[str],
    rows: Sequence[Sequence[Content]],
    widths: Sequence[float],
    right: Sequence[int] = (),
) -> Table:
    return Table("", tuple(heads), tuple(map(tuple, rows)), tuple(right), tuple(widths), caption)


def _answer(material: Material) -> Iterator[Block]:
    return answer_blocks(material.simulation, material.forecasts)


def _scene(material: Material) -> Iterator[Block]:
    drawn = scene_drawing(material.simulation.model.workbook)
    if drawn is not None:
        yield Figure(
            drawn,
            "The base case as the chart of the workbook draws it, with the numbers that were stored in "
            "the chart when the workbook was last saved.",
        )


def _trials_over_scene(material: Material) -> Iterator[Block]:
    drawn = drawn_trials(material.simulation)
    if drawn is not None:
        yield Figure(
            drawn,
            f"{drawn.said}: the curves are those of the workbook's chart, as it stored them.",
        )


def _many(simulation: RunResult) -> str:
    """Return how many forecasts sheets and page draw, in words."""
    told = len(simulation.detailed)
    return "all of them" if told == len(simulation.model.forecasts) else f"the first {told} (--detailed)"


def _forecasts(material: Material) -> Iterator[Block]:
    simulation = material.simulation
    width = _LARGE if len(material.forecasts) <= _FEW else _SMALL
    shown = figures_of(simulation, material.forecasts)
    if len(shown) > _MOST_FIGURES:
        yield Paragraph(
            f"Figures of the first {_MOST_FIGURES} of {len(shown)} forecasts. The sheet Charts of the result workbook "
            f"and the page show {_many(simulation)}; --forecasts chooses those of the report."
        )
    for figure in shown[:_MOST_FIGURES]:
        row, bins = figure.answer, figure.bins
        units = f" {row.units}" if row.units else ""
        per = f" per {bins.form.width(bins.width)}{units}" if bins.names is None else ""
        caption = (
            f"{figure.name}. Above, the accepted trials{per}; below, the share of them that "
            f"is not above each value. Dark: the central {percent(row.share)} of {count_text(row.trials)} accepted "
            f"trials, from {central_text(row)}{units}. Vertical line: the mean, {answer_text(row)}{units}."
        )
        if row.is_share:
            caption = f"{figure.name}: {figure.said}."
        if bins.counted < row.trials:
            caption += f" Trials are weighted: the figure shows {count_text(bins.counted)} trials of equal weight."
        if bins.below or bins.above:
            caption += not_drawn(bins)
        drawing = (
            shares_chart(figure) if row.is_share else forecast_drawing(figure, simulation.results[row.name], width)
        )
        yield Figure(drawing, caption)


def _filters(material: Material) -> Iterator[Block]:
    return filter_blocks(material.simulation, full=False)


def _evidence(material: Material) -> Iterator[Block]:
    return evidence_blocks(material.simulation, material.forecasts, full=False)


def _scenarios(material: Material) -> Iterator[Block]:
    found = scenario_answers(material.simulation)
    return scenario_blocks(found, impossible_scenarios(material.simulation), material.forecasts)


def _assumptions(material: Material) -> Iterator[Block]:
    simulation = material.simulation
    acts = simulation.filters_act
    if acts:
        yield Paragraph(
            "Filters keep only the combinations in which they hold. So an assumption that they bear on "
            "is distributed differently among the accepted trials, although its range is the same. In the pictures, "
            "the draws before filtering are pale, and the line is the accepted ones."
        )
    rows: list[Sequence[Content]] = [_assumption_row(simulation, each) for each in simulation.model.assumptions]
    heads = (
        "Assumption",
        "Distribution and source",
        "Mean, before and accepted" if acts else "Mean",
        "SD, before and accepted" if acts else "SD",
        "Picture",
    )
    yield _table(
        "The assumptions before and after filtering." if acts else "The assumptions.",
        heads,
        rows,
        (1.9, 2.9, 1.9, 1.7, 1.95),
    )
    early = max((values.size for values in simulation.prior.values()), default=0)
    said = (
        f"{'Before filtering: t' if simulation.filters_act else 'T'}he first {count_text(early)} "
        "trials. ± is the standard error."
    )
    if simulation.kept_inputs < simulation.accepted:
        said += (
            f" Accepted: the first {count_text(simulation.kept_inputs)} of "
            f"{count_text(simulation.accepted)} accepted trials."
        )
    yield Paragraph(said, "small")
    met = correlations_met(simulation)
    if met:
        lines = [
            (
                pair.first,
                pair.second,
                _NONE if pair.asked is None else exact_text(pair.asked),
                _NONE if pair.used is None else number_text(pair.used),
                _NONE if pair.accepted is None else estimate_text(pair.accepted),
            )
            for pair in met
        ]
        heads = ("First", "Second", "Asked for", "Drawn with", "Accepted")
        yield _table("Rank correlations of assumptions.", heads, lines, (3, 3, 1, 1, 1.5), (2, 3, 4))


def _assumption_row(simulation: RunResult, each: Assumption) -> list[Content]:
    name = f"{each.name}, {each.units}" if each.units else each.name
    words = f"{distribution_text(each)}. {each.source}".strip()
    found = filter_effect_of(simulation, each.name)
    form = simulation.model.input_forms.get(each.name, PLAIN)
    if found is None:
        base = "" if each.base is None else form.number(each.base)
        return [name, words, f"{status(simulation.model, each.name, each.frozen)}: {base}", _NONE, _NONE]
    both = (found.prior, found.accepted) if simulation.filters_act else (found.prior,)
    shape = shape_chart(simulation, each.name)
    return [
        name,
        words,
        "\n".join(form.estimate(marginal.mean) for marginal in both),
        "\n".join(form.spread(marginal.standard_deviation) for marginal in both),
        shape or _NONE,
    ]


def _sensitivity(material: Material) -> Iterator[Block]:
    if material.simulation.weighting is not None:
        return
    simulation = material.simulation
    # Those that a person names are told of, wherever they stand.
    named = None if len(material.forecasts) == len(simulation.model.forecasts) else material.forecasts
    within = named is None or set(named) <= set(simulation.detailed)
    found, fits = sensitivities(simulation, None if within else named), vocabulary_of(simulation.model.workbook).fits
    shown = [each for each in found.forecasts if each.forecast in material.forecasts]
    if not shown:
        return
    yield Paragraph(
        "Variance explained: how much of the forecast's variance would vanish, on average, if the assumption's true "
        "value were known. It is found from the accepted trials; shares need not add up to 100 %. “Noise” means: no "
        "more than chance alone would show. The rank correlation says whether the forecast rises (above 0) or falls "
        f"with the assumption. No sensitivity says whether the model {fits}."
    )
    if named is None and found.omitted_forecasts:
        yield Paragraph(first_forecasts("Sensitivity is told of", len(shown), found.omitted_forecasts))
    lines: list[tuple[str, ...]] = []
    most = _MOST_BARS if len(shown) <= _FEW else _MOST_OF_MANY
    for each in shown:
        if each.influences and len(shown) <= _FEW:
            caption = f"What {each.forecast} depends on most."
            yield Figure(influence_chart(each, most), caption)
        lines += _influence_rows(each, most)
    if lines:
        heads = ("Forecast", "Assumption", "Variance explained", "Rank correlation")
        caption = f"The assumptions that each forecast depends on most, {most} at most."
        yield _table(caption, heads, lines, (2, 3, 1.5, 1.5), (2, 3))


def _influence_rows(found: ForecastSensitivity, most: int) -> Iterator[tuple[str, ...]]:
    if not found.influences:
        yield found.forecast, "No assumption moves it, or there are too few trials to tell.", _NONE, _NONE
    for index, (each, weak) in enumerate(zip(found.influences[:most], noise(found), strict=False)):
        rank = "noise" if weak.correlation else estimate_text(each.rank_correlation)
        yield (
            "" if index else found.forecast,
            each.assumption,
            "noise" if weak.explained else explained_text(each),
            rank if rank and not math.isnan(each.rank_correlation.value) else _NONE,
        )


def explained_text(found: Influence) -> str:
    """Return the share of variance explained as text, `at least 81.4 ± 1.2 %` where it is a lower bound; to hundredths
    of a percent, which no decision needs, where it is known better.
    """
    share, error = found.explained.value, found.explained.error
    text = share_text(found.explained)
    if error is not None and math.isfinite(share) and error < _KNOWN_WELL:
        text = f"{fixed_text(100.0 * share, 2)} %"
    return f"{'at least ' if found.explained_at_least else ''}{text}"


_KNOWN_WELL: Final = 5e-5
"""The error of a share that two decimals of a percentage do not show."""


def _certainty(material: Material) -> Iterator[Block]:
    yield Paragraph("The share of the accepted trials below, in and above each range, as it is rounded here.")
    yield from certainty_blocks(material.simulation, material.forecasts)


def _pairs(material: Material) -> Iterator[Block]:
    told = {*material.forecasts}
    pairs = pairs_of(material.simulation) if material.simulation.weighting is None else []
    shown = [each for each in pairs if {each.first.name, each.second.name} <= told]
    return pair_blocks(material.simulation, shown)


def _statistics(material: Material) -> Iterator[Block]:
    return statistics_blocks(material.simulation, material.forecasts)


def _checks(material: Material) -> Iterator[Block]:
    return check_blocks(material.simulation)


def _equations(material: Material) -> Iterator[Block]:
    found = equations_of(material.simulation.model)
    if not found:
        return
    yield Paragraph(
        "The equations as the workbook prints them beside the cells that the answers need, with the source that it "
        "names. xlmc computes the cells' formulas, not these texts."
    )
    heads = ("Quantity", "Symbol", "Units", "Equation", "Source")
    yield _table("The equations.", heads, [tuple(each) for each in found], (2.5, 0.9, 0.7, 4.0, 1.7))


def _notices(material: Material) -> Iterator[Block]:
    return notice_blocks(material.simulation)


def _repeat(material: Material) -> Iterator[Block]:
    record = material.record
    yield Paragraph(
        "The same workbook with the same seed and the same software gives the same numbers. With xlmc installed, type:"
    )
    yield Code(str(record["run.repeat"]))
    yield Paragraph("The fingerprint of the accepted trials, a SHA-256, is then:")
    yield Code(str(record["run.fingerprint"]))
    software = [(str(entry.label), str(entry.value)) for entry in record.section("software").entries]
    machine = [(str(entry.label), str(entry.value)) for entry in record.section("processor").entries]
    lines = [
        ("Workbook", str(record["file.name"])),
        ("SHA-256 of the workbook", str(record["file.sha256"])),
        ("Seed", str(record["settings.seed"])),
        ("Trials", count_text(material.simulation.trials)),
        ("Accepted trials", count_text(material.simulation.accepted)),
        ("Sampling", str(record["sampling.method_in_words"])),
        ("Generator", str(record["sampling.generator"])),
        ("Engine", str(record["sampling.engine"])),
        *software,
        *(each for each in machine if len(each[1]) < 60),
    ]
    yield _table("What the numbers depend on.", ("What", "Value"), lines, (1.6, 5))


def _glossary(material: Material) -> Iterator[Block]:
    simulation = material.simulation
    words = [
        *GLOSSARY,
        *(WORDS_OF_EVIDENCE if simulation.agreement is not None else ()),
        *(WORDS_OF_SCENARIOS if simulation.settings.scenarios else ()),
    ]
    fill = vocabulary_of(simulation.model.workbook).fill
    yield Bullets(tuple(f"{word}: {fill(says)}" for word, says in words), "small")


MAKERS: Final[Mapping[str, Callable[[Material], Iterator[Block]]]] = {
    "answer": _answer,
    "scene": _scene,
    "scene-trials": _trials_over_scene,
    "forecasts": _forecasts,
    "filters": _filters,
    "evidence": _evidence,
    "scenarios": _scenarios,
    "assumptions": _assumptions,
    "sensitivity": _sensitivity,
    "certainty": _certainty,
    "pairs": _pairs,
    "statistics": _statistics,
    "checks": _checks,
    "equations": _equations,
    "notices": _notices,
    "repeat": _repeat,
    "glossary": _glossary,
}
"""Name of a section -> what makes its blocks; `sections` has their rows."""
