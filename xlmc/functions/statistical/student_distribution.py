"""Student's t distribution."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.registry import Logical, Number, excel
from xlmc.functions.statistical.cumulative import by_form
from xlmc.functions.statistical.freedom import degrees_of_freedom
from xlmc.functions.statistical.incomplete_beta import incomplete_beta, inverse_beta
from xlmc.functions.statistical.saddle_point import deviance, stirling_error
from xlmc.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["t_of_outside", "t_outside"]

_FAR: Final = 1e17
"""From this t²/freedom on, the first term of the tail's series is all of it."""

_HALF: Final = np.asarray(0.5)
_ROOT_2PI: Final = float(np.sqrt(2 * np.pi))


def _log_tail(freedom: Floats) -> Floats:
    """Logarithm of c in the tail c·(t²/freedom)^(-freedom/2) that the distribution tends to."""
    from scipy.special import betaln

    return np.asarray(-np.log(freedom / 2) - betaln(freedom / 2, 0.5))


def t_outside(t: Floats, freedom: Floats) -> Floats:
    """Probability that a t number is farther from 0 than t, which is not below 0; arrays that broadcast."""
    root = t / np.sqrt(freedom)
    far = root > np.sqrt(_FAR)
    ratio = np.where(far, 1.0, root) * np.where(far, 1.0, root)
    near = incomplete_beta(freedom / 2, _HALF, 1 / (1 + ratio), ratio / (1 + ratio))
    tail = np.exp(_log_tail(freedom) - freedom * np.log(np.where(far, root, 1.0)))
    return np.where(far, tail, near)


def t_of_outside(p: Floats, freedom: Floats) -> Floats:
    """The t number, 0 or more, that a t number is farther from 0 than with probability p; arrays that broadcast."""
    rest, share = inverse_beta(freedom / 2, _HALF, p)
    far = rest < 1 / _FAR
    near = np.sqrt(freedom * (share / np.where(far, 1.0, rest)))
    tail = np.exp(np.where(far, _log_tail(freedom) - np.log(p), 0.0) / freedom) * np.sqrt(freedom)
    return np.where(far, tail, near)


def _density(t: Floats, freedom: Floats) -> Floats:
    more = (freedom + 1) / 2
    log_scale = stirling_error(more) - stirling_error(freedom / 2) - deviance(freedom / 2, more)
    return np.exp(log_scale - more * np.log1p(t / freedom * t)) / _ROOT_2PI


def _below(t: Floats, freedom: Floats) -> Floats:
    outside = t_outside(np.abs(t), freedom) / 2
    return np.where(t < 0, outside, 1 - outside)


@excel("T.DIST", Number, Number, Logical)
def t_dist(t: Floats, freedom: Floats, cumulative: Bools) -> Floats:
    """Student's t distribution; of the density with 0 degrees of freedom Excel says `#DIV/0!`."""
    valid, k = degrees_of_freedom(freedom)
    result = by_form(cumulative, lambda: _below(t, k), lambda: _density(t, k))
    error = np.where((np.floor(freedom) == 0) & ~np.asarray(cumulative), DIV0, NUM)
    return np.where(valid, result, error)


@excel("T.DIST.RT", Number, Number)
def t_dist_rt(t: Floats, freedom: Floats) -> Floats:
    """Probability that a t number is above t."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid, _below(-t, k), NUM)


@excel("T.DIST.2T", Number, Number)
def t_dist_2t(t: Floats, freedom: Floats) -> Floats:
    """Probability that a t number is farther from 0 than t, which must not be negative."""
    valid, k = degrees_of_freedom(freedom)
    return np.where(valid & (t >= 0), t_outside(np.abs(t), k), NUM)


@excel("TDIST", Number, Number, Number)
def tdist(t: Floats, freedom: Floats, tails: Floats) -> Floats:
    """Probability that a t number is above t (1 tail), or farther from 0 than t (2 tails); t must not be negative."""
    both, sides = t_dist_2t(t, freedom), np.floor(tails)
    return np.where((sides == 1) | (sides == 2), np.where(sides == 1, both / 2, both), NUM)


@excel("T.INV", Number, Number)
def t_inv(p: Floats, freedom: Floats) -> Floats:
    """The t number that a probability lies below."""
    valid, k = degrees_of_freedom(freedom)
    inside = valid & (p > 0) & (p < 1)
    q = np.where(inside, p, 0.5)
    size = t_of_outside(2 * np.minimum(q, 1 - q), k)
    return np.where(inside, np.where(q < 0.5, -size, size), NUM)


@excel("T.INV.2T", Number, Number, aliases=("TINV",))
def t_inv_2t(p: Floats, freedom: Floats) -> Floats:
    """The t number, 0 or more, that a t number is farther from 0 than with a probability."""
    valid, k = degrees_of_freedom(freedom)
    inside = valid & (p > 0) & (p <= 1)
    return np.where(inside, t_of_outside(np.where(inside, p, 0.5), k), NUM)


@excel("CONFIDENCE.T", Number, Number, Number)
def confidence_t(alpha: Floats, deviation: Floats, size: Floats) -> Floats:
    """Half the width of the interval that holds a mean with probability 1 - alpha; the deviation is of the sample."""
    k = np.floor(size)
    inside = (np.asarray(alpha) > 0) & (alpha < 1) & (deviation > 0) & (k > 1)
    t = t_of_outside(np.where(inside, alpha, 0.5), np.where(inside, k, 2.0) - 1)
    alone = (np.asarray(alpha) > 0) & (alpha < 1) & (deviation > 0) & (k == 1)
    return np.where(inside, t * deviation / np.sqrt(np.maximum(k, 1.0)), np.where(alone, DIV0, NUM))
