"""What `xlmc screen` found, as a document: which assumptions the answer does not need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from math import isfinite, isnan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.screening import AtEnds, Cost, Screening
    from xlmc.outputs.document.parts import Block, Table
    from xlmc.outputs.study_report import StudyReport

from xlmc.analysis.studies.steps import ended_early

__all__ = ["printed", "screen_report"]

_MOST_IN_FULL = 4
"""Forecasts for each of which the terminal shows a table of every change; of more it shows one table."""


def screen_report(screening: Screening) -> StudyReport:
    """Make the report."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import blocks_of
    from xlmc.outputs.study_report import StudyReport

    run = screening.run
    below = (
        f"{run.model.workbook.name}: {screening.runs} runs of {count_text(run.trials)} trials, seed {run.settings.seed}"
    )
    blocks = blocks_of([*_verdicts(screening), *_tables(screening), *_meaning(screening)])
    title = "What the book could do without"
    return StudyReport(title, below, blocks, "Screening", partial(_as_json, screening), run)


def printed(screening: Screening) -> tuple[Block, ...]:
    """Return what the terminal shows: the report, but of many forecasts one table instead of one for each."""
    from xlmc.outputs.document.parts import blocks_of

    every = [*screening.single, *screening.groups, *screening.sets, *screening.filters]
    if not every or len(screening.tolerances) <= _MOST_IN_FULL:
        return blocks_of([*_verdicts(screening), *_tables(screening), *_meaning(screening)])
    return blocks_of(
        [
            *_verdicts(screening),
            *_of_changes(screening),
            *_of_every_forecast(screening, every),
            *_meaning(screening, in_full=False),
        ]
    )


def _tables(screening: Screening) -> Iterator[Block]:
    yield from _of_changes(screening)
    if screening.single or screening.groups or screening.sets or screening.filters:
        for name in screening.tolerances:
            yield _of_forecast(screening, name)


def _of_changes(screening: Screening) -> Iterator[Block]:
    sizes = {each.name: _size(each.size) for each in screening.expected}
    expected = [sizes[cost.names[0]] for cost in screening.single]
    each = "Each other assumption" if screening.at_once else "Each assumption"
    title = f"{each} held at its base value, the least expected cost first"
    if screening.single:
        yield _table(screening, title, screening.single, ("Held", _names(screening.single)), ("Expected", expected))
    if screening.groups:
        yield _table(
            screening, "Correlated assumptions held at once", screening.groups, ("Held", _names(screening.groups))
        )
    if screening.sets:
        yield _table(screening, "Held at once, as asked", screening.sets, ("Held", _names(screening.sets)))
    if screening.ends:
        yield _at_ends(screening, screening.ends)
    if screening.filters:
        held = " with the assumptions named above held" if screening.joint else ""
        what = "filter and item of evidence" if _has_evidence(screening) else "filter"
        yield _table(
            screening, f"Each {what} left out{held}", screening.filters, ("Left out", _names(screening.filters))
        )


def _table(screening: Screening, title: str, costs: Sequence[Cost], *first: tuple[str, Sequence[str]]) -> Table:
    """Make a table of what each change costs. `first` are columns with headings."""
    from xlmc.outputs.document.parts import Table

    accepted = ["Accepted, %"] if screening.run.model.filters else []  # without filters nothing can change it
    headings = (*(heading for heading, _ in first), "Cost", *accepted)
    rows = tuple(
        (
            *(column[index] for _, column in first),
            "no number" if cost.lost else _size(cost.size),
            *(_percent(cost) for _ in accepted),
            cost.judgement.verdict.value,
        )
        for index, cost in enumerate(costs)
    )
    return Table(title, (*headings, "Verdict"), rows, tuple(range(1, len(headings))))


def _at_ends(screening: Screening, ends: Sequence[AtEnds]) -> Table:
    """Make a table of what holding each assumption at an end of its range costs."""
    from xlmc.montecarlo.number_text import number_text

    pairs = [
        (f"{each.name} = {number_text(value)}", cost)
        for each in ends
        for value, cost in zip(each.values, each.costs, strict=True)
    ]
    title = "Each of these held at an end of its range, its 2.5 % and 97.5 % points"
    return _table(screening, title, [cost for _, cost in pairs], ("Held", [name for name, _ in pairs]))


def _has_evidence(screening: Screening) -> bool:
    return any(each.evidence is not None for each in screening.run.model.filters)


def _size(tolerances: float) -> str:
    """Count a move in tolerances; infinite where the forecast does not vary and so has no tolerance."""
    from xlmc.montecarlo.number_text import number_text

    return number_text(tolerances, 2) if isfinite(tolerances) else "infinite"


def _of_forecast(screening: Screening, name: str) -> Table:
    """Make a table of the number of a forecast that each change moves most, measured in its tolerance."""
    from xlmc.outputs.document.parts import Table

    units = screening.run[name].definition.units
    rows = tuple(
        _moved(screening, cost, name)
        for cost in (*screening.single, *screening.groups, *screening.sets, *screening.filters)
    )
    title = f"{name}{f', {units}' if units else ''}: what each moves most"
    return Table(title, ("Held or left out", "Number", "Moves by", "Tolerances"), rows, (2, 3))


def _moved(screening: Screening, cost: Cost, name: str) -> tuple[str, str, str, str]:
    """Return what was changed, the number of a forecast that it moves most, by how much and how many tolerances."""
    from xlmc.analysis.studies.comparison.verdicts import amount

    number, size = _most_moved(screening, cost, name)
    each = cost.forecasts[name]
    moved = amount(number, dict(each.changes)[number].difference, each.form)
    return ", ".join(cost.names), number, moved, "" if name in cost.lost else _size(size)


def _of_every_forecast(screening: Screening, costs: Sequence[Cost]) -> Iterator[Block | str]:
    """Yield a table with the change that moves each forecast most, and where all changes stand."""
    from xlmc.montecarlo.number_text import count_text
    from xlmc.outputs.document.parts import Table

    rows = []
    for name in screening.tolerances:
        answered = [cost for cost in costs if name not in cost.lost] or costs
        most = max(answered, key=lambda cost: _most_moved(screening, cost, name)[1])
        rows.append((name, *_moved(screening, most, name)))
    heads = ("Forecast", "Held or left out", "Number", "Moves by", "Tolerances")
    yield Table("What moves each forecast most", heads, tuple(rows), (3, 4))
    yield (
        f"What each of the {count_text(len(costs))} changes moves in each of the {count_text(len(rows))} forecasts is "
        "written with -o found.xlsx (or .html, .pdf, .docx), and printed for a few forecasts with --forecast."
    )


def _most_moved(screening: Screening, cost: Cost, name: str) -> tuple[str, float]:
    """Return the number of a forecast that moves most, and by how many tolerances."""
    from xlmc.analysis.studies.comparison.tolerances import in_tolerances

    each = cost.forecasts[name]
    limits = each.tolerances(screening.tolerances[name][0], screening.chance)
    sizes = {number: in_tolerances(change.difference, limits[number]) for number, change in each.changes}
    number = max(sizes, key=sizes.__getitem__)
    return number, sizes[number]


def _most_moved_json(screening: Screening, cost: Cost, name: str) -> tuple[str, float | None]:
    from xlmc.montecarlo.statistics.estimate import finite

    number, size = _most_moved(screening, cost, name)
    return number, finite(size)


def _tolerance(screening: Screening, name: str) -> str:
    """Return the tolerance of a forecast in words: `1 mph, and P(> 18) 1.2 points`."""
    from xlmc.analysis.studies.comparison.verdicts import is_chance, points, tolerance_text

    value, stated = screening.tolerances[name]
    result, limits = screening.run[name], _limits(screening, name)
    chances = [f"{number} {points(limit)}" for number, limit in limits.items() if is_chance(number)]
    if isnan(value) or (limits and len(chances) == len(limits)):
        return ", ".join(chances)
    text = f"{tolerance_text(value, result.form)} {result.definition.units}".rstrip()
    return ", and ".join([text + ("" if stated else " (a tenth of the SD)"), *chances])


def _limits(screening: Screening, name: str) -> Mapping[str, float]:
    """Return the tolerance of each number of a forecast; nothing where nothing was left out."""
    costs = (*screening.single, *screening.groups, *screening.sets, *screening.filters)
    compared = next((cost.forecasts[name] for cost in costs if name in cost.forecasts), None)
    return {} if compared is None else compared.tolerances(screening.tolerances[name][0], screening.chance)


def _names(costs: Sequence[Cost]) -> list[str]:
    return [", ".join(cost.names) for cost in costs]


def _percent(cost: Cost) -> str:
    from xlmc.montecarlo.statistics import format_estimate

    change = cost.acceptance.relative
    return format_estimate(100.0 * change.value, None if change.error is None else 100.0 * change.error)


def _acceptance_text(screening: Screening, cost: Cost) -> str:
    """How the share of accepted trials changes; nothing where no filter could change it."""
    change = cost.acceptance
    if not screening.run.model.filters:
        return ""
    if not change.first_only + change.second_only:
        return "; the same trials are accepted"
    return f"; the acceptance changes by {_percent(cost)} % of itself"


def _verdicts(screening: Screening) -> Iterable[str]:
    from xlmc.analysis.studies.comparison.verdicts import undecided_text
    from xlmc.montecarlo.number_text import count_text, styled_text

    if screening.ended:
        yield ended_early("screening", screening.ended, "What is not in the tables was not run.")
    if screening.joint:
        yield (
            f"Not needed: {'; '.join(screening.joint.names)}. With all of them held at their base values in one run, "
            f"no number moves by more than {styled_text(screening.joint.size, '.2f')} of its "
            f"tolerance{_acceptance_text(screening, screening.joint)}."
        )
    elif not screening.ended:
        yield "Every assumption is needed, as far as these trials tell."
    if screening.at_once:
        yield (
            f"The {count_text(len(screening.at_once.names))} assumptions that are expected to cost least were held at "
            "once, and none of them alone: two of them may cancel each other."
        )
    if screening.only_alone:
        yield f"Within the tolerance alone, but not surely together with those: {'; '.join(screening.only_alone)}."
    if screening.ends is not None:
        yield _ends_text([each.name for each in screening.ends if each.free])
    if screening.unasked:
        yield f"Judged by {'; '.join(screening.tolerances)} only."
    if screening.idle:
        yield f"No forecast or filter needs {'; '.join(screening.idle)}."
    if screening.valueless:
        yield (
            f"Not judged, with an answer in fewer than two accepted trials: {'; '.join(screening.valueless)}. What "
            "these forecasts need is not known."
        )
    if screening.baseless:
        yield f"Not screened, because their cells are blank: {'; '.join(screening.baseless)}."
    if screening.reduced:
        yield (
            f"{'Filters and evidence' if _has_evidence(screening) else 'Filters'} that then make no difference here: "
            f"{'; '.join(screening.reduced.names)}. Without them no number moves by "
            f"more than {styled_text(screening.reduced.size, '.2f')} of its tolerance. A filter that "
            "rejects the impossible may stay."
        )
    if screening.undecided:
        names = "; ".join(undecided_text(cost, screening.run.trials) for cost in screening.undecided)
        yield f"Undecided at {count_text(screening.run.trials)} trials, and therefore kept: {names}."


def _ends_text(free: Sequence[str]) -> str:
    if not free:
        return (
            "None of these may be anywhere in its range: held at one end at least, each of them changes an answer by "
            "more than its tolerance, or it is undecided whether it does."
        )
    plural = len(free) > 1
    return (
        f"Not needed, wherever in {'their ranges they lie' if plural else 'its range it lies'}: {'; '.join(free)}. "
        f"Held at either end, {'each alone, they move' if plural else 'it moves'} no number beyond its tolerance: no "
        "other model, and no better measurement, has to give it."
    )


def _meaning(screening: Screening, *, in_full: bool = True) -> Iterable[str]:
    from xlmc.montecarlo.number_text import count_text, number_text

    if screening.constant:
        yield f"Formula cells that then do not vary: {', '.join(map(str, screening.constant))}."
    if screening.dropped:
        yield f"Formula cells that then are not needed: {', '.join(map(str, screening.dropped))}."
    yield f"Of {screening.cells} formula cells that the book needs, {screening.varying} then vary."
    named = [name for name, (_, stated) in screening.tolerances.items() if stated or in_full]
    tolerances = "; ".join(f"{name} {_tolerance(screening, name)}" for name in named)
    if len(named) < len(screening.tolerances):
        whose = "those of the others" if named else f"those of the {count_text(len(screening.tolerances))} forecasts"
        tolerances += f"{'; ' if named else ''}{whose}, a tenth of the SD for numbers, stand in the files"
    accepted = (
        f"; acceptance {number_text(100 * screening.acceptance_tolerance)} % of itself"
        if screening.run.model.filters
        else ""
    )
    yield (
        "Cost: the largest change of any number, divided by its tolerance; above 1 the answer changes. The numbers of "
        "a forecast are its mean, SD, both ends of its central range, and the probability of being above its "
        f"threshold where it has one; of yes/no answers and texts their shares. Tolerances: {tolerances}{accepted}."
    )
    yield (
        f"{screening.runs} runs of {count_text(screening.run.trials)} trials, seed {screening.run.settings.seed}, "
        "over the same draws; ± is "
        "the standard error of a change (Monte Carlo error). A verdict is given only where a change is at least three "
        "errors away from the tolerance."
    )


def _as_json(screening: Screening) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite
    from xlmc.outputs.studies.json_numbers import estimate_json

    run = screening.run
    return {
        "book": str(run.model.path),
        "trials": run.trials,
        "seed": run.settings.seed,
        "acceptance": estimate_json(run.acceptance),
        "tolerances": {
            name: {"value": finite(value), "stated": stated, "of_each": _limits_json(screening, name)}
            for name, (value, stated) in screening.tolerances.items()
        },
        "chance_tolerance": screening.chance,
        "acceptance_tolerance": screening.acceptance_tolerance,
        "not_needed_by_any_cell": screening.idle,
        "without_base_value": screening.baseless,
        "forecasts_not_asked": screening.unasked,
        "forecasts_without_numbers": screening.valueless,
        "ended_early": screening.ended or None,
        "cheapest_held_at_once": None if screening.at_once is None else _entry(screening.at_once, screening),
        "held_alone": [_entry(cost, screening) for cost in screening.single],
        "correlated_held_at_once": [_entry(cost, screening) for cost in screening.groups],
        "held_together": None if screening.joint is None else _entry(screening.joint, screening),
        "held_as_asked": [_entry(cost, screening) for cost in screening.sets],
        "held_at_ends": None
        if screening.ends is None
        else [
            {"name": each.name, "at": value, "free": each.free, **_entry(cost, screening)}
            for each in screening.ends
            for value, cost in zip(each.values, each.costs, strict=True)
        ],
        "filters_left_out_alone": [_entry(cost, screening) for cost in screening.filters],
        "filters_left_out_together": None if screening.reduced is None else _entry(screening.reduced, screening),
        "cells": {
            "needed": screening.cells,
            "varying_then": screening.varying,
            "constant_then": [str(cell) for cell in screening.constant],
            "not_needed_then": [str(cell) for cell in screening.dropped],
        },
        "runs": screening.runs,
    }


def _limits_json(screening: Screening, name: str) -> dict[str, float | None]:
    from xlmc.montecarlo.statistics.estimate import finite

    return {number: finite(limit) for number, limit in _limits(screening, name).items()}


def _entry(cost: Cost, screening: Screening) -> dict[str, object]:
    from xlmc.montecarlo.statistics.estimate import finite
    from xlmc.outputs.studies.json_numbers import acceptance_json, difference_json

    expected = {each.name: each.size for each in screening.expected}
    return {
        "names": cost.names,
        "expected_cost": finite(expected.get(cost.names[0])) if len(cost.names) == 1 else None,
        "cost": finite(cost.size),
        "verdict": cost.judgement.verdict.value,
        "decided_by": cost.judgement.largest,
        "trials_needed": finite(cost.judgement.times * screening.run.trials),
        "acceptance": acceptance_json(cost.acceptance),
        "moves_most": {
            name: dict(zip(("number", "tolerances"), _most_moved_json(screening, cost, name), strict=True))
            for name in screening.tolerances
            if name not in cost.lost
        },
        "forecasts": {name: difference_json(each) for name, each in cost.forecasts.items()},
    }
