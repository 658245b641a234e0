"""The case study under narrowed filters, for rare_acceptance.py: its truth is a long run of plain trials."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from rare_problems import STATISTICS

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.statistics import Estimate

__all__ = ["CASE", "LABELS", "WORDS", "held", "model", "narrowed", "plain", "searched"]

WORDS = "the case study"
FORECASTS = ("Chevrolet delta-V", "Nissan impact speed")
LABELS = (STATISTICS[0], *(f"{name}, {each}" for name in FORECASTS for each in STATISTICS[1:]))
WANTED = 300

BOOK = Path(__file__).resolve().parent.parent / "examples" / "intersection.xlsx"
CASE: dict[str, dict[str, Any]] = {
    "Restitution, normal": {"at_least": 0.10, "below": 0.12},
    "Restitution, tangential": {"at_most": 0.01},
}
"""Limits of the case study's filters, narrowed until some 4 in 100,000 trials are accepted."""

Answers = list[Estimate]
"""By LABELS."""


def narrowed(model: CompiledModel) -> CompiledModel:
    """The case study with CASE's limits."""
    filters = tuple(replace(f, **CASE.get(f.name, {})) for f in model.filters)
    return CompiledModel(model.workbook, replace(model.definitions, filters=filters), model.path)


@cache
def model() -> CompiledModel:
    """The book with CASE's limits, once a process."""
    return narrowed(load(BOOK))


def plain(trials: int, jobs: int) -> tuple[Answers, int]:
    """What plain trials say, and how many were accepted."""
    run = run_model(model(), RunOptions.of(trials=trials, seed=1, engine="jit", jobs=jobs))
    return _answers(run), run.accepted


def searched(seed: int) -> tuple[Answers, int]:
    """What one search says, and how many trials it computed."""
    run = run_model(model(), RunOptions.of(trials=5 * 10**8, seed=seed, until_accepted=WANTED, rare="always", jobs=1))
    assert run.rare is not None
    return _answers(run), run.rare.evaluations


def _answers(run: Any) -> Answers:
    samples = [run[name].sample for name in FORECASTS]
    return [run.acceptance, *(each for sample in samples for each in of_forecast(sample))]


def of_forecast(sample: xs.Sample) -> list[Estimate]:
    """By STATISTICS without the first."""
    return [xs.mean(sample), xs.standard_deviation(sample), xs.median(sample), *xs.central_interval(sample)]


def within(mine: Estimate, true: Estimate) -> bool:
    """Whether an interval, widened by the error of the truth, holds it."""
    if mine.interval is None or not mine.error or not true.error:
        return False
    wider = math.hypot(1.0, true.error / mine.error)
    low, high = (mine.value + (end - mine.value) * wider for end in mine.interval)
    return low <= true.value <= high


def held(truth: Sequence[Estimate], estimates: Sequence[Estimate]) -> list[bool]:
    """Whether each interval holds its truth."""
    return [within(mine, true) for mine, true in zip(estimates, truth, strict=True)]
