"""Every part at its full size; `fewer` divides the runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stressing import accepted, dependence, discrete
from stressing import few as few_trials
from stressing import stops as rules
from stressing import tails as heavy
from stressing.rounding import measured
from stressing.sweeps import SWEEPS
from stressing.workbook import FORMS_ENGINES, forms_book

__all__ = ["correlations", "counts", "few", "forms", "samplers", "shares", "stops", "tails"]

Found = Mapping[str, Any]


def forms(fewer: int) -> Found:
    """Sweep -> errors by engine and cell, and conditioning."""
    model, result = forms_book(), {}
    for name, sweep in SWEEPS.items():
        at = measured(model, sweep.points()[::fewer], FORMS_ENGINES)
        result[name] = {
            "x": at.x.tolist(),
            "errors": {
                engine: {cell: np.minimum(errors, 1e300).tolist() for cell, errors in cells.items()}
                for engine, cells in at.errors.items()
            },
            "conditions": {cell: values.tolist() for cell, values in at.conditions.items()},
        }
    return result


PER_REPLICATE = {1e-2: (0.5, 1, 2, 3, 5, 8, 12, 20, 50), 1e-3: (1, 3, 8, 20)}
"""Acceptance -> accepted trials that a replicate has on average, of 16 replicates."""


def samplers(fewer: int) -> Found:
    """How often intervals hold the truth after filters, by method, acceptance, and accepted trials."""
    runs = {1e-2: 1000 // fewer, 1e-3: 200 // fewer}
    cells = [
        accepted.after_filters(method, share, round(16 * each / share), runs[share])
        for share, counts in PER_REPLICATE.items()
        for method in accepted.METHODS
        for each in counts
    ]
    return {"cells": cells}


def shares(fewer: int) -> Found:
    """Exact coverage of acceptances from 1e-2 to 1e-6, of trials that were fixed before and of those waited for."""
    expected = np.geomspace(0.05, 100.0, 90)[::fewer]
    wanted = (2, 3, 5, 10, 30, 100, 1000)[::fewer]
    rates = (1e-2, 1e-4, 1e-6)
    return {
        "fixed": [accepted.shares(rate, expected) for rate in rates],
        "waited": [{"acceptance": rate, "wanted": n} | accepted.waited_for(rate, n) for rate in rates for n in wanted],
    }


def tails(fewer: int) -> Found:
    """A ladder of trials with a few seeds, and many seeds of 10,000 trials."""
    model = heavy.book()
    ladder = [10**k for k in range(3, 7)][: 5 - min(fewer, 4)]
    return {
        "ladder": [heavy.measure(model, trials, seed) for trials in ladder for seed in range(6)],
        "many": [heavy.measure(model, 10_000, 1_000 + seed) for seed in range(400 // fewer)],
    }


def correlations(fewer: int) -> Found:
    """Pairs from 0 to ±1, and matrices of three."""
    sizes = (0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999, 1.0)
    trials, seeds = 100_000, range(max(2, 20 // fewer))
    pairs, matrices = [], []
    for asked in sorted({side * size for size in sizes[1:] for side in (-1.0, 1.0)}):
        named = {("first", "second"): asked}
        model = dependence.book(named)
        for sampling in ("mc", "lhs"):
            result = [dependence.measure(model, named, trials, seed, sampling)[0] for seed in seeds]
            pairs.append({"sampling": sampling, "asked": asked, "found": result})
    for name, named in dependence.MATRICES.items():
        model = dependence.book(named)
        notices = [str(notice.message) for notice in model.notices]
        matrices.append({"name": name, "notices": notices, "found": dependence.measure(model, named, trials, 1)})
    return {"trials": trials, "pairs": pairs, "matrices": matrices}


def counts(fewer: int) -> Found:
    """Percentiles and mode of whole numbers."""
    runs = 300 // fewer
    return {
        "cells": [discrete.measure(name, trials, runs) for name in discrete.LAWS for trials in (10, 100, 1000, 10_000)]
    }


def few(fewer: int) -> Found:
    """Coverage of every statistic of 2 to 1,000 accepted trials."""
    sizes = (2, 3, 5, 10, 20, 50, 100, 300, 1000)
    return {"cells": [few_trials.coverage(name, n, 1500 // fewer) for name in few_trials.FORECASTS for n in sizes]}


NEEDED = (1_000, 10_000, 50_000)
SCALES = {"normal": (2.0, 3.0, 4.5, 6.0, 9.0), "exponential": (2.0, 3.0, 4.5, 6.0), "lognormal, σ 1": (0.7, 1.1)}
"""Forecast -> by what it is multiplied: the larger, the more sequences are needed for two digits."""


def stops(fewer: int) -> Found:
    """Runs that end by themselves: `--precision` where so many trials are needed, `--adaptive` from 20 and 2 on."""
    runs = 1000 // fewer
    precise = []
    for name, forecast in rules.FORECASTS.items():
        for needed in NEEDED:
            tolerance = 1.96 * forecast.deviation / forecast.mean / needed**0.5
            if tolerance < 0.7:  # beyond, there is nothing that anybody would ask for
                precise.append(rules.precise_runs(name, tolerance, runs))
    stable = []
    for least in (rules.adaptive.LEAST_SEQUENCES, 2):
        with rules.least_sequences(least):
            for name, scales in SCALES.items():
                stable += [{"least": least} | rules.stable_runs(name, 2, scale, runs // 4) for scale in scales]
    return {"precise": precise, "stable": stable}
