"""Rules that end a run when its numbers look good enough: how often they do by luck, and what that does to the numbers.

The rules are xlmc's own; what they are given is a stream of accepted trials with a known answer, in small blocks, so
that they may look often and early. Forecasts that vary little until something rare happens are there to be stopped at.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

import xlmc.montecarlo.statistics as xs
from xlmc.montecarlo.definitions.stopping import Precision, StableDigits
from xlmc.montecarlo.loop.stopping import adaptive
from xlmc.montecarlo.loop.stopping.adaptive import UntilStable
from xlmc.montecarlo.loop.stopping.precision import UntilPrecise

__all__ = ["FORECASTS", "Forecast", "fixed_runs", "least_sequences", "precise_runs", "stable_runs"]

Floats = NDArray[np.float64]

MOST_NUMBERS: Final = 3_000_000
UPPER: Final = float(ndtri(0.755))


class Forecast(NamedTuple):
    """A forecast with known answers.

    Attributes:
        draw: generator and count -> values.
        mean, deviation, low, high: the truth; the ends of the 51 % range.
    """

    draw: Callable[[np.random.Generator, int], Floats]
    mean: float
    deviation: float
    low: float
    high: float


def _lognormal(sigma: float) -> Forecast:
    mean = math.exp(sigma**2 / 2.0)
    ends = (math.exp(side * sigma * UPPER) for side in (-1.0, 1.0))
    return Forecast(
        lambda rng, n: np.exp(sigma * rng.standard_normal(n)), mean, mean * math.sqrt(math.expm1(sigma**2)), *ends
    )


def _rare(p: float) -> Forecast:
    """1 with the probability p, else 0."""
    return Forecast(lambda rng, n: (rng.random(n) < p).astype(float), p, math.sqrt(p * (1.0 - p)), 0.0, 0.0)


FORECASTS: Final[Mapping[str, Forecast]] = {
    "normal": Forecast(lambda rng, n: 1.0 + rng.standard_normal(n), 1.0, 1.0, 1.0 - UPPER, 1.0 + UPPER),
    "exponential": Forecast(
        lambda rng, n: rng.standard_exponential(n), 1.0, 1.0, -math.log(0.755), -math.log(0.245)
    ),
    "lognormal, σ 1": _lognormal(1.0),
    "lognormal, σ 1.5": _lognormal(1.5),
    "1 in 100": _rare(0.01),
    "1 in 1,000": _rare(0.001),
}  # fmt: skip


class _Seen(NamedTuple):
    """What a rule sees of a block."""

    trials: int
    accepted: NDArray[np.int64]
    forecasts: list[Floats]


def _run(rule: Any, forecast: Forecast, rng: np.random.Generator, block: int) -> Floats | None:
    """The values at which the rule ends the run; None where it does not."""
    columns: list[Floats] = []
    for start in range(0, MOST_NUMBERS, block):
        columns.append(forecast.draw(rng, block))
        if rule.reached(_Seen(block, np.arange(start, start + block), columns[-1:]), lambda _: np.concatenate(columns)):
            return np.concatenate(columns)
    return None


def fixed_runs(name: str, length: int, runs: int, first: int = 0) -> dict[str, Any]:
    """Runs of so many accepted trials, which nothing ends: what intervals of the mean hold then, and its bias."""
    forecast, held, scaled = FORECASTS[name], 0, []
    for seed in range(first, first + runs):
        result = xs.mean(forecast.draw(np.random.default_rng((seed, 8)), length))
        assert result.interval is not None
        held += result.interval[0] <= forecast.mean <= result.interval[1]
        if result.error:
            scaled.append((result.value - forecast.mean) / result.error)
    return {"held": held, "bias": float(np.mean(scaled))}


def precise_runs(name: str, tolerance: float, runs: int, block: int = 500, first: int = 0) -> dict[str, Any]:
    """Runs until the mean is known to a share of itself: how often its interval at the stop holds the truth.

    `bias` is the average of (mean at the stop − truth) over its error, of runs that had one, with its own error;
    `fixed` is the same of runs that are as long on average, without a rule.
    """
    forecast = FORECASTS[name]
    held = ended = unvaried = 0
    lengths, scaled = [], []
    for seed in range(first, first + runs):
        rule = UntilPrecise(Precision(tolerance, True, ("mean",)), [(0, name, 0.51)])
        values = _run(rule, forecast, np.random.default_rng((seed, 5)), block)
        if values is None:
            continue
        result = xs.mean(values)
        assert result.interval is not None
        ended += 1
        held += result.interval[0] <= forecast.mean <= result.interval[1]
        unvaried += result.error == 0.0
        lengths.append(values.size)
        if result.error:
            scaled.append((result.value - forecast.mean) / result.error)
    needed = (1.96 * forecast.deviation / forecast.mean / tolerance) ** 2
    fixed = fixed_runs(name, round(float(np.mean(lengths))), runs, first)
    return {
        "forecast": name, "tolerance": tolerance, "runs": runs, "ended": ended, "held": held, "unvaried": unvaried,
        "length": float(np.mean(lengths)), "needed": needed,
        "bias": float(np.mean(scaled)), "error of bias": float(np.std(scaled, ddof=1) / math.sqrt(len(scaled))),
        "fixed": fixed,
    }  # fmt: skip


@contextmanager
def least_sequences(count: int) -> Iterator[None]:
    """With another least number of sequences than xlmc's: 2 is what the standard says."""
    usual = adaptive.LEAST_SEQUENCES
    adaptive.LEAST_SEQUENCES = count  # type: ignore[misc]  # final but for this measurement
    try:
        yield
    finally:
        adaptive.LEAST_SEQUENCES = usual  # type: ignore[misc]  # as above


def stable_runs(name: str, digits: int, scale: float, runs: int, first: int = 0) -> dict[str, Any]:
    """Runs until numbers are stable to so many digits: how often each is within the tolerance of the truth.

    Args:
        name: of the forecast, which is multiplied by `scale`: it decides how many sequences are needed.
        digits: significant ones of the standard deviation.
        scale: the standard deviation becomes so many times itself.
        runs: how many.
        first: seed.
    """
    law = FORECASTS[name]
    truth = scale * np.array([law.mean, law.deviation, law.low, law.high])
    tolerance = adaptive.numerical_tolerance(scale * law.deviation, digits)
    forecast = law._replace(draw=lambda rng, n: scale * law.draw(rng, n))
    within, lengths, ended = np.zeros(4, int), [], 0
    for seed in range(first, first + runs):
        rule = UntilStable(StableDigits(digits), [(0, name, 0.51)])
        values = _run(rule, forecast, np.random.default_rng((seed, 6)), adaptive.sequence_length(0.51))
        if values is None:
            continue
        result = [values.mean(), values.std(ddof=1), *np.quantile(values, (0.245, 0.755))]
        within += np.abs(result - truth) <= tolerance
        lengths.append(values.size)
        ended += 1
    return {
        "forecast": name, "digits": digits, "scale": scale, "runs": runs, "ended": ended, "tolerance": tolerance,
        "sequences": float(np.mean(lengths)) / adaptive.sequence_length(0.51), "within": within.tolist(),
    }  # fmt: skip
