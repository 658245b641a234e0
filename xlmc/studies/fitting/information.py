"""Standard errors from the observed information: how sharply the log-likelihood bends at its highest point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from xlmc.studies.fitting.candidate import Errors, Params

__all__ = ["standard_errors"]

_DROP = 0.005
"""How far the log-likelihood falls over a step: a tenth of a standard error, far above rounding."""

_FLAT = 1e-7
"""Least bend, beside that along the parameters themselves, that counts as one."""


def standard_errors(log_likelihood: Callable[[Params], float], params: Params, free: Sequence[int]) -> Errors:
    """The roots of the diagonal of the inverse of the negative second derivatives; None where there are none.

    Args:
        log_likelihood: of all parameters.
        params: where it is highest.
        free: the places of the parameters that were estimated.
    """
    top = log_likelihood(params)

    def at(*moves: tuple[int, float]) -> float:
        moved = list(params)
        for place, by in moves:
            moved[place] += by
        return log_likelihood(tuple(moved))

    def fall(place: int, h: float) -> float:
        return top - (at((place, h)) + at((place, -h))) / 2

    steps = {place: _step(partial(fall, place), params[place]) for place in free}
    bend = np.empty((len(free), len(free)))
    for row, i in enumerate(free):
        h = steps[i]
        bend[row, row] = (2 * top - at((i, h)) - at((i, -h))) / (h * h)
        for column, j in enumerate(free[:row]):
            k = steps[j]
            mixed = at((i, h), (j, k)) - at((i, h), (j, -k)) - at((i, -h), (j, k)) + at((i, -h), (j, -k))
            bend[row, column] = bend[column, row] = -mixed / (4 * h * k)
    errors: list[float | None] = [None] * len(params)
    if _bends_everywhere(bend):
        for place, variance in zip(free, np.diag(np.linalg.inv(bend)), strict=True):
            errors[place] = float(np.sqrt(variance))
    return tuple(errors)


def _bends_everywhere(bend: NDArray[np.float64]) -> bool:
    """Whether there is no direction in which it is flat, as far as differences can tell."""
    if not (np.isfinite(bend).all() and (np.diag(bend) > 0).all()):
        return False
    scale = np.sqrt(np.diag(bend))
    return bool((np.linalg.eigvalsh(bend / np.outer(scale, scale)) > _FLAT).all())


def _step(drop: Callable[[float], float], value: float) -> float:
    """A step over which the log-likelihood falls by about `_DROP`."""
    h = 1e-3 * max(abs(value), 1e-6)
    for _ in range(40):
        fall = drop(h)
        if _DROP / 2 < fall < _DROP * 2:
            break
        factor = np.sqrt(_DROP / fall) if np.isfinite(fall) and fall > 1e-9 else (4.0 if fall < 1 else 0.25)
        h *= float(np.clip(factor, 0.25, 4.0))
    return h
