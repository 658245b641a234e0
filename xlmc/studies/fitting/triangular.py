"""Triangular: the ends are searched for, and for given ends the likeliest value is one of the measured ones.

Its standard errors come from a parametric bootstrap: its corner makes the likelihood bend nowhere as theory wants it.

Source: S. Kotz and J. R. van Dorp, *Beyond Beta*, 2004, section 1.4.
"""

from __future__ import annotations

import numpy as np

from xlmc.studies.fitting.candidate import Candidate, Errors, Floats, Params, Unfit
from xlmc.studies.fitting.maximise import maximise

__all__ = ["TRIANGULAR"]

_SAMPLES, _SEED = 100, 999
_NEAREST, _FARTHEST = -12.0, 5.0
"""Logarithms of the least and the greatest distance of an end from the values, in widths of these."""


def _likeliest(x: Floats, low: float, high: float) -> tuple[float, float]:
    """The best of the values as the corner, and the log-likelihood there."""
    n, width = x.size, high - low
    rise, fall = np.log((x - low) / width), np.log((high - x) / width)
    before = np.concatenate([[0.0], np.cumsum(rise)[:-1]])
    after = np.concatenate([np.cumsum(fall[::-1])[::-1][1:], [0.0]])
    place = np.arange(n)
    totals = before - place * rise + after - (n - 1 - place) * fall
    best = int(np.argmax(totals))
    return float(x[best]), float(totals[best] + n * np.log(2 / width))


def _ends(x: Floats, tolerance: float = 1e-8) -> tuple[float, float]:
    """Beyond the smallest and the largest value, where neither has density 0."""
    spread = float(x[-1] - x[0])

    def moved(point: Floats) -> tuple[float, float]:
        return float(x[0] - spread * np.exp(point[0])), float(x[-1] + spread * np.exp(point[1]))

    def log_likelihood(point: Floats) -> float:
        # Ends on a value, or far away, are as good as ends near there: a slope keeps the search from wandering.
        return _likeliest(x, *moved(np.clip(point, _NEAREST, _FARTHEST)))[1] - float(
            np.sum(np.abs(point - np.clip(point, _NEAREST, _FARTHEST)))
        )

    return moved(np.clip(maximise(log_likelihood, [-2.5, -2.5], tolerance=tolerance), _NEAREST, _FARTHEST))


def _estimate(x: Floats) -> Params:
    low, high = _ends(x)
    return low, _likeliest(x, low, high)[0], high


def _log_density(x: Floats, low: float, likeliest: float, high: float) -> Floats:
    inside = (x >= low) & (x <= high)
    # A corner at an end leaves one slope: the other is not asked for.
    rise = (x - low) / np.where(likeliest > low, likeliest - low, 1.0)
    fall = (high - x) / np.where(high > likeliest, high - likeliest, 1.0)
    height = np.where(x < likeliest, rise, np.where(x > likeliest, fall, 1.0))
    return np.where(inside, np.log(2 / (high - low)) + np.log(height), -np.inf)


def _cdf(x: Floats, low: float, likeliest: float, high: float) -> Floats:
    width = high - low
    rise = (np.clip(x, low, likeliest) - low) ** 2 / (width * max(likeliest - low, 1e-300))
    fall = (high - np.clip(x, likeliest, high)) ** 2 / (width * max(high - likeliest, 1e-300))
    return np.where(x <= likeliest, rise, 1 - fall)


def _drawn(u: Floats, low: float, likeliest: float, high: float) -> Floats:
    width, share = high - low, (likeliest - low) / (high - low)
    rising = low + np.sqrt(u * width * (likeliest - low))
    falling = high - np.sqrt((1 - u) * width * (high - likeliest))
    return np.where(u < share, rising, falling)


def _errors(x: Floats, params: Params) -> Errors:
    random, found = np.random.default_rng(_SEED), []
    for _ in range(_SAMPLES):
        sample = np.sort(_drawn(random.random(x.size), *params))
        try:
            low, high = _ends(sample, 1e-2)
        except Unfit:
            continue
        found.append((low, _likeliest(sample, low, high)[0], high))
    if len(found) < _SAMPLES / 2:
        return None, None, None
    return tuple(float(error) for error in np.std(found, axis=0, ddof=1))


TRIANGULAR = Candidate(
    "Triangular",
    ("Low", "Likeliest", "High"),
    _estimate,
    _log_density,
    _cdf,
    errors=_errors,
    errors_from=f"parametric bootstrap of {_SAMPLES} samples",
    costly=True,
)
