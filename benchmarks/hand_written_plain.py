"""The books `powers` and `wide` of `books.py` hand-written in NumPy, one block of trials at a time.

In `powers` the powers, exponentials and logarithms take nearly all the time; what the workbook computes twice is
computed once, and a power with a whole or half exponent is a product or a root. In `wide` terms and forecasts go into
arrays that are allocated once, and drawing counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from books import POWERS, WIDE_ASSUMPTIONS, WIDE_FORECASTS, WIDE_HIGH, WIDE_LOW, term_rows
from numpy.typing import NDArray

__all__ = ["BOOKS", "PlainBook"]

Array = NDArray[np.float64]
Kernel = Callable[[Array], Array]
"""Inputs (k, n), which it may overwrite -> forecasts (f, n)."""


@dataclass(frozen=True)
class PlainBook:
    """A book without filters.

    Attributes:
        low, high: of the uniform inputs, (k,).
        forecasts: how many.
        kernel: the trials in a block -> what evaluates them.
    """

    low: Array
    high: Array
    forecasts: int
    kernel: Callable[[int], Kernel]

    def simulate(self, trials: int, seed: int, chunk: int) -> Array:
        """Monte Carlo, one thread: the forecasts, (f, trials)."""
        rng = np.random.Generator(np.random.SFC64(seed))
        evaluate = self.kernel(chunk)
        low, width = self.low[:, None], (self.high - self.low)[:, None]
        inputs, answers = np.empty((len(self.low), chunk)), np.empty((self.forecasts, trials))
        for start in range(0, trials, chunk):
            rng.random(out=inputs)
            inputs *= width
            inputs += low
            part = answers[:, start : start + chunk]
            part[:] = evaluate(inputs)[:, : part.shape[1]]
        return answers


def _powers(n: int) -> Kernel:
    answers = np.empty((8, n))
    exp, log, sqrt, cbrt = np.exp, np.log, np.sqrt, np.cbrt

    def evaluate(inputs: Array) -> Array:
        metal, stress, creep_n, activation, hours, limit, air, pressure, wind, roughness, shear, height = inputs[:12]
        diameter, prandtl, cost, cost_sd, shape, scale, fatigue, basquin, charge, far, strain, rate = inputs[12:]
        creep = 1e6 * exp(activation / (-8.314 * metal)) * (stress / 10) ** creep_n
        answers[0] = creep * hours + 2e-5 * (stress / 100) ** 1.8 * cbrt(hours)
        used = _whole(metal * (20 + np.log10(hours)) / (1000 * limit), 12)
        answers[1] = hours / np.power(10.0, 1000 * limit / metal - 20) + used

        density = pressure / (287.05 * air)
        viscosity = 1.458e-6 * air * sqrt(air) / (air + 110.4)
        law = wind * log(height / roughness) / log(10 / roughness)
        blown = sqrt(law * wind * (height / 10) ** shear)
        reynolds = density * blown * diameter / viscosity
        drag = 24 / reynolds * (1 + 0.15 * reynolds**0.687) + 0.42 / (1 + 42500 * reynolds**-1.16)
        answers[2] = density * blown * blown / 2 * drag * diameter
        below = sqrt(sqrt(1 + cbrt(0.4 / prandtl) ** 2))
        nusselt = 0.3 + 0.62 * sqrt(reynolds) * cbrt(prandtl) / below * (1 + (reynolds / 282000) ** 0.625) ** 0.8
        transfer = nusselt * 0.0241 * (air / 273.15) ** 0.9 / diameter
        later = air + (metal - air) * exp(transfer * (-4 * 3600 / (7850 * 460)) / diameter)
        answers[3] = 0.8 * 5.67e-8 * (_whole(later, 4) - _whole(air, 4))

        variation = 1 + (cost_sd / cost) ** 2
        squared = log(variation)
        sigma, mu = sqrt(squared), log(cost) - squared / 2
        median, over = exp(mu), hours * 8 / scale
        survived = exp(-(over**shape))
        hazard = shape / scale * over ** (shape - 1)
        most = exp(1.6448536 * sigma) * median
        lives = np.power(np.log(2), 1 / shape), np.power(-np.log(0.9), 1 / shape)
        rest = (median / variation + scale * lives[0]) / (scale * lives[1])
        answers[4] = (1 - survived) * most + hazard * median * 100 + rest

        cycles = (stress * 2 / fatigue) ** (1 / basquin) / (1 - stress / (2 * fatigue)) ** (-1 / basquin)
        answers[5] = 1000 / cycles * (variation + 2) * sqrt(variation - 1) + np.log10(cycles)

        answers[6] = (
            350 * strain
            + 275 * strain**1.36 / 1.36
            + 0.01
            * ((350 + 275 * strain**0.36) * (1 + 0.022 * log(rate)) * (1 - ((metal - 298) / (1790 - 298)) ** 1.03))
        )

        root = cbrt(charge)
        scaled = far / root
        over_pressure = 100 * (0.84 + (2.7 + 7 / scaled) / scaled) / scaled
        arrival, lasting = root * 0.34 * scaled**1.4, sqrt(root) * 1.35 * sqrt(far)
        natural = log(over_pressure)
        probit = 6.91 * (natural + np.log(1000)) - 77.1
        answers[7] = probit * exp(-arrival / (lasting + arrival)) + natural
        return answers

    return evaluate


def _whole(x: Array, power: int) -> Any:
    """x⁴ or x¹² by products."""
    fourth = np.square(np.square(x))
    return fourth if power == 4 else fourth * fourth * fourth


def _wide(n: int) -> Kernel:
    rows = term_rows(WIDE_ASSUMPTIONS, WIDE_FORECASTS)
    answers, square, root = np.empty((len(rows), n)), np.empty(n), np.empty(n)

    def evaluate(inputs: Array) -> Array:
        for x in inputs:
            np.multiply(x, x, out=square)
            np.multiply(square, 0.1, out=square)
            np.add(x, square, out=x)
        for answer, (first, end, other) in zip(answers, rows, strict=True):
            np.add.reduce(inputs[first:end], axis=0, out=answer)
            np.sqrt(inputs[other], out=root)
            np.add(answer, root, out=answer)
        return answers

    return evaluate


BOOKS = {
    "powers": PlainBook(
        np.array([low for *_, low, _ in POWERS]), np.array([high for *_, high in POWERS]), 8, _powers
    ),
    "wide": PlainBook(
        np.full(WIDE_ASSUMPTIONS, WIDE_LOW), np.full(WIDE_ASSUMPTIONS, WIDE_HIGH), WIDE_FORECASTS, _wide
    ),
}  # fmt: skip
"""Name of a book -> how it is computed."""
