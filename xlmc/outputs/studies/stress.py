"""What `xlmc stress` found, as a document: the answers with assumptions in their tails, and what sets answers apart."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.stating import Kind

if TYPE_CHECKING:
    from xlmc.analysis.studies.stress import Moved, Part, Scenario, Stressed, Tail
    from xlmc.montecarlo.definitions.definitions import Forecast
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.document.measured import Measured
    from xlmc.outputs.document.parts import Block, Content, Figure, Table
    from xlmc.outputs.study_report import StudyReport

__all__ = ["stress_report"]

_DRAWN: Final = 12
"""Assumptions of a chart."""

_MOST_NAMED: Final = 3
"""Inputs that a sentence names."""


def stress_report(result: Stressed) -> StudyReport:
    """Make the report."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    run = result.run
    below = (
        f"{run.model.workbook.name}: {count_text(run.accepted)} accepted of {count_text(run.trials)} trials, "
        f"seed {run.settings.seed}"
    )
    blocks = blocks_of([*_sentences(result), *_blocks(result), *_meaning(result)])
    return StudyReport("Where do the answers go?", below, blocks, "Stress", partial(_as_json, result), run)


def _percent(share: float) -> str:
    from xlmc.montecarlo.number_text import number_text

    return f"{number_text(share, 3)} %"


def _sentences(result: Stressed) -> Iterator[str]:
    for forecast in result.forecasts:
        pair = next(iter(result.ranked(forecast.name)), None)
        if pair is None:
            continue
        tails = [each for each in pair if forecast.name in each.parts]
        if tails:
            tail = max(tails, key=lambda each: abs(each.parts[forecast.name].changes["mean"].value))
            yield _strongest(result, forecast, tail)
    for scenario in result.scenarios:
        yield _distinguishing(result, scenario)
    if result.valueless:
        yield f"A number in hardly any accepted trial: {'; '.join(result.valueless)}."


def _strongest(result: Stressed, forecast: Forecast, tail: Tail) -> str:
    """Say which tail moves the mean of a forecast most."""
    from xlmc.outputs.summary import share_text

    part, form = tail.parts[forecast.name], result.forms[forecast.name]
    change, is_share = part.changes["mean"], "low" not in part.numbers
    if change.error is not None and abs(change.value) < 3.0 * change.error:
        return f"{forecast.name}: these trials show no assumption whose tails move the mean."
    share = f"share of “{result.texts[forecast.name]}”" if forecast.name in result.texts else "probability"
    what = share if form.factor != 1.0 and is_share else "mean"
    units = f" {forecast.units}" if forecast.units and not is_share else ""
    side = "highest" if tail.is_high else "lowest"
    written = share_text if is_share else form.estimate
    return (
        f"{forecast.name} moves most with {tail.assumption}: with its {side} {_percent(result.share)} the {what} is "
        f"{written(part.numbers['mean'])}{units}, instead of "
        f"{written(result.base[forecast.name].numbers['mean'])}{units}."
    )


def _distinguishing(result: Stressed, scenario: Scenario) -> str:
    """Say which inputs set the trials of a scenario apart."""
    from xlmc.montecarlo.number_text import count_text

    what = f"{scenario.forecast} {scenario.words}{_limits(result, scenario)}"
    if not scenario.inputs:
        return f"{what}: they say nothing of inputs."
    sure = [each for each in scenario.inputs if each.is_sure]
    if not sure:
        return f"{what}: no input has another median there than in all trials, as far as these tell."
    named = "; ".join(f"{each.assumption} ({_shift(each.shift)} SD)" for each in sure[:_MOST_NAMED])
    more = f"; and {count_text(len(sure) - _MOST_NAMED)} more" if len(sure) > _MOST_NAMED else ""
    return f"{what} is distinguished by {named}{more}."


def _limits(result: Stressed, scenario: Scenario) -> str:
    """Write how many trials a scenario has, and its limits where the words have percentiles."""
    from xlmc.montecarlo.number_text import count_text

    form, trials = result.forms[scenario.forecast], f"{count_text(scenario.trials)} trials"
    mean = result.base[scenario.forecast].numbers["mean"]

    def limit(value: float) -> str:
        return form.number(value) if form.kind is Kind.WHOLE else form.beside(value, mean)

    if "p" not in scenario.words.casefold():
        return f" ({trials})"
    if math.isinf(scenario.high):
        return f" ({limit(scenario.low)} or more, {trials})"
    if math.isinf(scenario.low):
        return f" ({limit(scenario.high)} or less, {trials})"
    return f" ({limit(scenario.low)} to {limit(scenario.high)}, {trials})"


def _shift(estimate: Estimate) -> str:
    from xlmc.montecarlo.number_text import number_text
    from xlmc.montecarlo.statistics import format_estimate

    text = format_estimate(estimate.value, estimate.error) if estimate.error else number_text(estimate.value, 3)
    return f"{'+' if estimate.value > 0 else ''}{text}"


def _blocks(result: Stressed) -> Iterator[Block]:
    for forecast in result.forecasts:
        ranked = result.ranked(forecast.name)
        if not ranked:
            continue
        yield _table(result, forecast, ranked)
        figure = _chart(result, forecast, ranked[:_DRAWN])
        if figure is not None:
            yield figure
    for scenario in result.scenarios:
        if scenario.inputs:
            yield _of_scenario(result, scenario)


def _title(result: Stressed, forecast: Forecast) -> str:
    text = f"share of “{result.texts[forecast.name]}”" if forecast.name in result.texts else ""
    return ", ".join(filter(None, (forecast.name, forecast.units, text)))


def _table(result: Stressed, forecast: Forecast, ranked: list[tuple[Tail, Tail]]) -> Table:
    from xlmc.montecarlo.number_text import number_text
    from xlmc.outputs.document.parts import Table

    base, form = result.base[forecast.name], result.forms[forecast.name]
    heads = ["Assumption", "Restricted to"]
    if "low" in base.numbers:
        share = number_text(100.0 * forecast.central, 3)
        heads += ["Mean", "Change", f"{share} % range from", "to"]
    else:
        heads += ["Share", "Change, points"]
    if "above" in base.numbers:
        heads += [f"Above {form.number(forecast.threshold or 0.0)}", "Change, points"]
    rows: list[tuple[Content, ...]] = [("all trials", "", *_numbers(result, forecast, base))]
    for tail in (each for pair in ranked for each in pair):
        if forecast.name in tail.parts:
            cells = _numbers(result, forecast, tail.parts[forecast.name])
            rows.append((tail.assumption, _restricted(result, tail), *cells))
    return Table(_title(result, forecast), tuple(heads), tuple(rows), tuple(range(2, len(heads))))


def _restricted(result: Stressed, tail: Tail) -> str:
    """Write the range of a tail: `up to 12.3 mph`."""
    from xlmc.montecarlo.number_text import number_text

    row = next(each for each in result.run.model.assumptions if each.name == tail.assumption)
    form = result.run.model.input_forms.get(tail.assumption)
    limit = number_text(tail.limit, 4) if form is None else form.beside_units(row.units).number(tail.limit)
    return f"{'from' if tail.is_high else 'up to'} {limit}{f' {row.units}' if row.units else ''}"


def _numbers(result: Stressed, forecast: Forecast, part: Part) -> Iterator[Measured]:
    """Yield the cells of a row: mean and shares with how far they have moved, and the ends of the range."""
    from xlmc.outputs.document.measured import Measured

    form = result.forms[forecast.name]
    for name, number in part.numbers.items():
        change = part.changes.get(name)
        if name == "above" or "low" not in part.numbers:
            yield from (Measured(number, "share"), Measured(change, "points"))
        elif name != "mean":
            yield Measured(number, form=form)
        else:
            yield from (Measured(number, form=form), Measured(change, "change", form))


def _chart(result: Stressed, forecast: Forecast, ranked: list[tuple[Tail, Tail]]) -> Figure | None:
    """Draw how far the mean moves with each assumption in its low tail, and in its high one."""
    from xlmc.outputs.document.parts import Bar, Bars, Chart, Figure

    bars = []
    for pair in ranked:
        moves = [
            (each, each.parts[forecast.name].changes["mean"].value) for each in pair if forecast.name in each.parts
        ]
        pieces = tuple((0.0, move, "dark" if each.is_high else "light") for each, move in moves if math.isfinite(move))
        if pieces:
            bars.append(Bar(pair[0].assumption, pieces))
    if not bars:
        return None
    is_mean, units = "low" in result.base[forecast.name].numbers, f", {forecast.units}" if forecast.units else ""
    what = "Change of the mean" if is_mean else "Change of the share"
    looks = (("light", f"lowest {_percent(result.share)}"), ("dark", "highest"))
    message = f"{_title(result, forecast)}: {what[0].lower()}{what[1:]} with each assumption in its tails"
    data = Bars(tuple(bars), result.forms[forecast.name], looks)
    return Figure(Chart("", f"{what}{units * is_mean}", data, message, 125.0), message)


def _of_scenario(result: Stressed, scenario: Scenario) -> Table:
    from xlmc.outputs.document.parts import Table

    heads = ("Assumption", "Median", "In these trials", "Moved by, SD", "Lies at", "By chance", "Distinguishes")
    rows = tuple(_moved_row(result, each) for each in scenario.inputs)
    title = f"Inputs where {scenario.forecast} is {scenario.words}{_limits(result, scenario)}"
    return Table(title, heads, rows, (1, 2, 3, 4, 5))


def _moved_row(result: Stressed, each: Moved) -> tuple[str, ...]:
    from xlmc.montecarlo.definitions.forms import PLAIN

    form = result.run.model.input_forms.get(each.assumption, PLAIN)
    return (
        each.assumption,
        form.estimate(each.median),
        form.estimate(each.within),
        _shift(each.shift),
        f"P{_percent(100.0 * each.at).removesuffix(' %')}",
        _chance(each.chance),
        "yes" if each.is_sure else "no",
    )


def _chance(chance: float) -> str:
    """Write a probability of chance.

    >>> [_chance(chance) for chance in (1e-9, 0.034, 1.0)]
    ['< 0.001', '0.034', '1']
    """
    from xlmc.montecarlo.number_text import number_text

    return "< 0.001" if chance < 0.001 else number_text(chance, 2)


def _meaning(result: Stressed) -> Iterator[str]:
    from xlmc.analysis.studies.stress import MOST
    from xlmc.montecarlo.number_text import count_text

    share = _percent(result.share)
    if result.still:
        yield f"Of hardly more than one value in the accepted trials, and so without tails: {'; '.join(result.still)}."
    if len(result.run.model.live) > MOST:
        yield f"Of more than {MOST} assumptions each forecast has the {MOST} that move it most."
    if result.left_out:
        yield f"Shown are the first {MOST} forecasts; {count_text(result.left_out)} more can be named (--forecast)."
    filtered = "accepted " if result.run.accepted < result.run.trials else ""
    yield (
        f"A tail: the trials in which the assumption is among the lowest, or highest, {share} of its {filtered}values. "
        "What is correlated with it or depends on it moves as it then does. Change: to all trials; its ± comes from "
        "the trials that both share. ± is the standard error (Monte Carlo error)."
    )
    if result.scenarios:
        yield (
            "Moved by: the median in these trials less that in all, in standard deviations of the input. Lies at: the "
            "percentile of all trials at which the median of these lies. By chance: the probability of so large a move "
            "of an input that has nothing to do with it. It distinguishes where it has moved by three errors or more."
        )


def _as_json(result: Stressed) -> dict[str, object]:
    run = result.run
    return {
        "book": str(run.model.path),
        "trials": run.trials,
        "accepted": run.accepted,
        "seed": run.settings.seed,
        "share": result.share,
        "forecasts": [
            {
                "name": each.name,
                "cell": str(each.cell),
                "units": each.units,
                "text": result.texts.get(each.name),
                "all_trials": _part_json(result.base[each.name]),
                "tails": [
                    {
                        "assumption": tail.assumption,
                        "tail": "high" if tail.is_high else "low",
                        "limit": tail.limit,
                        **_part_json(tail.parts[each.name]),
                    }
                    for pair in result.ranked(each.name)
                    for tail in pair
                    if each.name in tail.parts
                ],
            }
            for each in result.forecasts
        ],
        "scenarios": [_scenario_json(each) for each in result.scenarios],
        "without_tails": result.still,
        "forecasts_without_numbers": result.valueless,
    }


def _part_json(part: Part) -> dict[str, object]:
    from xlmc.outputs.studies.json_numbers import estimate_json

    return {
        "trials": part.trials,
        **{name: estimate_json(each) for name, each in part.numbers.items()},
        "changes": {name: estimate_json(each) for name, each in part.changes.items()},
    }


def _scenario_json(scenario: Scenario) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite
    from xlmc.outputs.studies.json_numbers import estimate_json

    return {
        "forecast": scenario.forecast,
        "range": scenario.words,
        "from": finite(scenario.low),
        "to": finite(scenario.high),
        "trials": scenario.trials,
        "inputs": [
            {
                "assumption": each.assumption,
                "median": estimate_json(each.median),
                "median_in_range": estimate_json(each.within),
                "moved_by_standard_deviations": estimate_json(each.shift),
                "percentile": 100.0 * each.at,
                "probability_by_chance": each.chance,
                "distinguishes": each.is_sure,
            }
            for each in scenario.inputs
        ],
    }
