"""What `xlmc decide` found, as a document: the answers for every combination of decisions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.decisions import Combination, Decided
    from xlmc.montecarlo.definitions.definitions import Decision
    from xlmc.outputs.document.parts import Block, Figure, Table
    from xlmc.outputs.study_report import StudyReport

__all__ = ["decide_report"]


_MOST_LINES = 6
_MOST_NAMED = 4


def decide_report(result: Decided) -> StudyReport:
    """Make the report."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    run, count = result.run, len(result.combinations) + len(result.impossible)
    below = (
        f"{run.model.workbook.name}: {count_text(count)} combination{'s' * (count != 1)} of "
        f"{', '.join(each.name for each in result.decisions)}, {count_text(run.trials)} trials each, "
        f"seed {run.settings.seed}"
    )
    blocks = blocks_of([*_sentences(result), *_blocks(result), _MEANING])
    title = "What each decision gives"
    return StudyReport(title, below, blocks, "Decisions", partial(_as_json, result), run)


_MEANING = (
    "Each combination is run over the same random numbers, so that differences come from the decisions, and their ± "
    "from the differences trial by trial. Difference: to the workbook as it is. ± is the standard error "
    "(Monte Carlo error)."
)


def _sentences(result: Decided) -> Iterator[str]:
    from xlmc.analysis.studies.decisions import of_forecast
    from xlmc.analysis.studies.steps import ended_early

    names = " and ".join(each.name for each in result.decisions)
    same = [each.name for each in result.run.model.forecasts if not result.does_matter(each.name)]
    for forecast in result.run.model.forecasts:
        if forecast.name in same:
            continue
        losing = result.losing(forecast.name)
        for least, word in ((False, "largest"), (True, "smallest")):
            best = result.best(forecast.name, least=least)
            if best is None:
                if not losing:
                    yield f"{forecast.name} is a number with none of them."
                break
            answer = of_forecast(result.base, forecast.name)
            share = "probability" if answer.text is None else f"share of “{answer.text}”"
            form, what = answer.form, "mean" if answer.has_range else share
            units = f" {forecast.units}" if forecast.units and answer.has_range else ""
            mean = f"{form.estimate(best.mean)}{units}"
            text = f"The {what} of {forecast.name} is {word}, {mean}, with {best.combination.answers.name}"
            if best.next is None or best.ahead is None:
                yield f"{text}."
                break
            if not best.ahead.value and not best.ahead.error:
                yield f"{text}, and the same with {best.next.answers.name}."
                continue
            side = "below" if least else "above"
            ahead = form.spread(best.ahead).lstrip("-")
            doubt = "" if best.is_sure else ", and these trials cannot tell the two apart"
            yield f"{text}; that is {ahead} {side} the next, {best.next.answers.name}{doubt}."
        if losing:
            yield _losing_text(losing, forecast.name)
    if result.ended:
        yield ended_early("table", result.ended, "Combinations that are not in it were not run.")
    if same and not (result.impossible or result.ended):
        are = "are" if len(result.decisions) > 1 else "is"
        yield f"Whatever {names} {are}, these stay as they are: {'; '.join(same)}."
    elif same and len(result.combinations) > 1:
        yield f"In the combinations that were run these stay as they are: {'; '.join(same)}."


def _losing_text(losing: Sequence[Combination], forecast: str) -> str:
    from xlmc.montecarlo.number_text import number_text
    from xlmc.montecarlo.simulation.simulation import ERROR_SHARE

    def percent(share: float) -> str:
        return f"{number_text(100.0 * share, 2)} %"

    named = "; ".join(
        f"{each.answers.name} ({percent(each.answers.run.lost_share(forecast))})" for each in losing[:_MOST_NAMED]
    )
    more = f"; and {len(losing) - _MOST_NAMED} more" if len(losing) > _MOST_NAMED else ""
    return (
        f"Left out of the largest and smallest of {forecast}, since errors in cells take more than "
        f"{percent(ERROR_SHARE)} of the trials: {named}{more}."
    )


def _blocks(result: Decided) -> Iterator[Block]:
    for index, answer in enumerate(result.base.forecasts):
        if not result.does_matter(answer.forecast.name):
            continue
        yield _table(result, index)
        if len(result.decisions) < 3:
            figure = _trend(result, index)
            if figure is not None:
                yield figure


def _table(result: Decided, index: int) -> Table:
    from xlmc.outputs.document.content.scenarios import answer_heads, answer_rows
    from xlmc.outputs.document.parts import Table

    answers = [result.base, *(each.answers for each in result.combinations)]
    decisions = [", ".join(filter(None, (each.name, each.units))) for each in result.decisions]
    values = [(result.base.name, *[""] * (len(decisions) - 1))]
    values += [
        tuple(one.shown(at) for one, at in zip(result.decisions, each.values, strict=True))
        for each in result.combinations
    ]
    heads = (*decisions, *answer_heads(answers, index)[1:])
    rows = tuple((*at, *row[1:]) for at, row in zip(values, answer_rows(answers, index), strict=True))
    return Table(answers[0].forecasts[index].title, heads, rows, tuple(range(len(heads))))


def _trend(result: Decided, index: int) -> Figure | None:
    """Draw the means over the values of the first decision: of two a line for each value of the second."""
    from xlmc.outputs.document.parts import Chart, Figure, Line, Lines

    first, *others = result.decisions
    answer = result.base.forecasts[index]
    points = [(each.values, each.answers.forecasts[index]) for each in result.combinations]
    if len(first.values) < 2 or len(points) < 2 or first.contents:
        return None
    if others:
        (second,) = others
        lines = [
            (
                f"{second.name} = {second.shown(at)}",
                [(v[0], a.mean.value, a.mean.error) for v, a in points if v[1] == at],
            )
            for at in second.values[:_MOST_LINES]
        ]
    else:
        ends = ("low", "high") if answer.has_range else ()
        lines = [("Mean", [(v[0], a.mean.value, a.mean.error) for v, a in points])]
        lines += [
            (f"Central range, {end} end", [(v[0], getattr(a, end).value, None) for v, a in points]) for end in ends
        ]
    drawn = tuple(
        Line(name, tuple(sorted(each for each in those if each[1] == each[1])))
        for name, those in lines  # no NaN
    )
    drawn = tuple(line for line in drawn if len(line.points) > 1)
    if not drawn:
        return None
    data = Lines(drawn, answer.title, dots=True, form_upwards=answer.form)
    across = f"{first.name}, {first.units}" if first.units else first.name
    message = f"{answer.forecast.name} for the values of {' and '.join(each.name for each in result.decisions)}"
    return Figure(Chart("", across, data, message), message)


def _as_json(result: Decided) -> dict[str, object]:
    from xlmc.outputs.json_document import scenario_json

    run = result.run
    return {
        "book": str(run.model.path),
        "trials": run.trials,
        "seed": run.settings.seed,
        "decisions": [
            {
                "name": each.name,
                "cell": str(each.cell),
                "units": each.units,
                "values": _contents([each] * len(each.values), each.values),
            }
            for each in result.decisions
        ],
        "as_it_is": scenario_json(result.base),
        "combinations": [
            {"values": _contents(result.decisions, each.values), **scenario_json(each.answers)}
            for each in result.combinations
        ],
        "best": [_best_json(result, each.name) for each in run.model.forecasts],
        "ended_early": result.ended or None,
        "impossible": [
            {"values": _contents(result.decisions, values), "why": why} for values, why in result.impossible.items()
        ],
    }


def _contents(decisions: Sequence[Decision], values: Sequence[float]) -> list[float | str | bool]:
    """Return what is typed into the cells of the decisions."""
    return [each.content(value) for each, value in zip(decisions, values, strict=True)]


def _best_json(result: Decided, forecast: str) -> dict[str, object]:
    """Return the combinations with the largest and the smallest mean of a forecast, and how far the next one lies."""
    from xlmc.outputs.studies.json_numbers import estimate_json

    document: dict[str, object] = {"forecast": forecast}
    for name, least in (("largest", False), ("smallest", True)):
        best = result.best(forecast, least=least)
        document[name] = best and {
            "values": _contents(result.decisions, best.combination.values),
            "mean": estimate_json(best.mean),
            "next": best.next and _contents(result.decisions, best.next.values),
            "ahead": best.ahead and estimate_json(best.ahead),
            "is_sure": best.is_sure,
        }
    document["losing_trials"] = [
        {"values": _contents(result.decisions, each.values), "lost": each.answers.run.lost_share(forecast)}
        for each in result.losing(forecast)
    ]
    return document
