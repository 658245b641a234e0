"""A number and how well it is known: value, standard error, interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

__all__ = ["Estimate"]

LEAST_DOF = 1.0 - 1e-9
"""Fewer degrees of freedom give no error; the margin is for the rounding of an effective sample size."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """One printed number, in the unit of the values it came from.

    The error is Monte Carlo error alone: what another seed would change. It says nothing of the inputs or the model.

    Attributes:
        value: the point estimate; nan where it does not exist.
        error: its standard error; None where there is none to give (extremes, too few trials).
        interval: its confidence interval, 95 % unless asked otherwise; an end is infinite where the sample cannot
            bound it, as in the far tail of a small sample.
        n: the trials it rests on.
    """

    value: float
    error: float | None = None
    interval: tuple[float, float] | None = None
    n: int = 0


def with_error(value: float, error: float, dof: float, confidence: float, n: int) -> Estimate:
    """Value ± Student's t times its error; without an error where fewer than two independent units stand behind it."""
    if dof < LEAST_DOF or not (math.isfinite(value) and math.isfinite(error)):
        return Estimate(value, n=n)
    half = t_quantile(dof, confidence) * error
    return Estimate(value, error, (value - half, value + half), n)


def with_relative_error(value: float, error: float, dof: float, confidence: float, n: int) -> Estimate:
    """As `with_error` for a positive scale: the interval is symmetric in the logarithm, so that it stays positive."""
    plain = with_error(value, error, dof, confidence, n)
    if plain.interval is None or error == 0.0:
        return plain
    with np.errstate(over="ignore"):  # two trials at a confidence near 1 reach infinity, and that is the answer
        factor = float(np.exp(t_quantile(dof, confidence) * error / value))
    return Estimate(value, error, (value / factor, value * factor), n)


def t_quantile(dof: float, confidence: float) -> float:
    """The two-sided quantile of Student's t; with infinite `dof` that of the normal distribution."""
    from scipy.special import stdtrit

    return float(stdtrit(dof, 1.0 - one_tail(confidence)))


def one_tail(confidence: float) -> float:
    """The probability left on either side.

    Raises:
        ValueError: the confidence is not between 0 and 1.
    """
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"a confidence lies between 0 and 1, not at {confidence}")
    return (1.0 - confidence) / 2.0
