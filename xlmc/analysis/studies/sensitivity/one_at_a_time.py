"""Tornado and spider: one assumption moved at a time, all others at their base values.

The model is evaluated, nothing is drawn: there is no noise, and there are no probabilities. An assumption is put at
each of `PERCENTS` of its own distribution, before filtering and whatever it is correlated with, so that a case may be
one that the filters would reject; that is marked.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.measures import PERCENTS, Bar
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.statistics.estimate import finite

if TYPE_CHECKING:
    from xlmc.engine.engine import Column
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["OneAtATime", "one_at_a_time"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class OneAtATime:
    """Tornado and spider of every forecast.

    Attributes:
        base: one a forecast, in the order of the workbook; None if it is no number.
        bars: one list a forecast, the widest first.
        medians: assumptions without a base value, held at their median.
    """

    base: tuple[float | None, ...]
    bars: tuple[tuple[Bar, ...], ...]
    medians: tuple[str, ...]


def one_at_a_time(
    model: CompiledModel,
    assumptions: Sequence[str],
    forecasts: Collection[int] | None = None,
    most: int | None = None,
    asked: Collection[str] = (),
) -> OneAtATime:
    """Move each of the live assumptions of these names.

    Args:
        model: to evaluate.
        assumptions: names of live ones.
        forecasts: numbers of those whose bars are wanted; None for all.
        most: bars of a forecast, the widest; None for all.
        asked: names of assumptions whose bars are wanted, too, however narrow.
    """
    quantiles = model.quantiles([*(percent / 100.0 for percent in PERCENTS), 0.5])
    base = {a.name: float(quantiles[a.name][-1]) if a.base is None else float(a.base) for a in model.live}
    units = {a.name: a.units for a in model.live}
    moved = {name: quantiles[name][:-1] for name in assumptions}
    answers, rejected = _evaluate(model, base, moved)
    fails, count = rejected[1:].reshape(-1, len(PERCENTS)), len(assumptions) if most is None else most
    bars: list[tuple[Bar, ...]] = []
    for number, each in enumerate(answers):
        if forecasts is not None and number not in forecasts:
            bars.append(())
            continue
        answer = each[1:].reshape(-1, len(PERCENTS))
        chosen = [
            index for place, index in enumerate(_widest_first(answer)) if place < count or assumptions[index] in asked
        ]
        made = [
            _bar(name, units[name], base[name], moved[name], answer[index], fails[index])
            for index in chosen
            for name in [assumptions[index]]
        ]
        bars.append(tuple(replace(bar, form=model.input_forms.get(bar.assumption, PLAIN)) for bar in made))
    return OneAtATime(
        base=tuple(finite(each[0]) for each in answers),
        bars=tuple(bars),
        medians=tuple(a.name for a in model.live if a.base is None),
    )


def _evaluate(model: CompiledModel, base: dict[str, float], moved: dict[str, Floats]) -> tuple[list[Floats], Floats]:
    """Evaluate the base case and every move, one after another: one `(cases,)` a forecast, and whether the filters
    reject.
    """
    cases = 1 + len(moved) * len(PERCENTS)
    starts = {name: 1 + index * len(PERCENTS) for index, name in enumerate(moved)}
    program = model.program("numpy")
    block = min(cases, program.largest_block)
    evaluator = program.evaluator(block)
    answers: list[list[Floats]] = []
    rejected = []
    for first in range(0, cases, block):
        checkpoint()
        n = min(block, cases - first)
        columns = {name: np.full(n, value) for name, value in base.items()} | model.certain(n)
        for name, start in starts.items():
            rows = np.arange(start, start + len(PERCENTS)) - first
            inside = (rows >= 0) & (rows < n)
            columns[name][rows[inside]] = moved[name][inside]
        filters = evaluator.filters(columns, n)
        rejected.append(np.logical_or.reduce([np.zeros(n, bool), *(_fails(column) for column in filters)]))
        answers.append([column.as_floats() for column in evaluator.forecasts(np.arange(n))])
    return [np.concatenate(parts) for parts in zip(*answers, strict=True)], np.concatenate(rejected)


def _widest_first(answers: Floats) -> list[int]:
    """Return the rows of `(m, 5)` answers by their span, the widest first; one without a number spans nothing."""
    known = np.isfinite(answers)
    lowest = np.min(answers, axis=1, where=known, initial=math.inf)
    highest = np.max(answers, axis=1, where=known, initial=-math.inf)
    with np.errstate(over="ignore"):  # from the smallest to the largest double
        span = np.where(known.any(axis=1), highest - lowest, 0.0)
    return list(map(int, np.argsort(-span, kind="stable")))


def _bar(assumption: str, units: str, base: float, inputs: Floats, answers: Floats, rejected: Floats) -> Bar:
    known = bool(np.isfinite(answers).all())
    before, after = answers[:-1], answers[1:]
    return Bar(
        assumption=assumption,
        units=units,
        base=base,
        inputs=tuple(inputs.tolist()),
        answers=tuple(finite(answer) for answer in answers),
        rejected=tuple(bool(each) for each in rejected),
        monotonic=bool((after >= before).all() or (after <= before).all()) if known else None,
    )


def _fails(column: Column) -> NDArray[np.bool_]:
    fails = column.values == 0
    return np.asarray(fails if column.codes is None else fails | (column.codes > 0))
