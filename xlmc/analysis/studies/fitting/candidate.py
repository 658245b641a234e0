"""A family that may be fitted: how its likelihood is maximised, and what is needed to judge the result.

Standard errors come from the observed information, that is, from how sharply the logarithm of the likelihood bends at
its highest point, unless the family has errors of its own.

Shapes: `x` are the values `(n,)`, in rising order; parameters are numbers in the order of `headings`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["INFORMATION", "Candidate", "Errors", "Floats", "Params", "Unfit", "refuse", "standard_errors"]

Floats = NDArray[np.float64]
Params = tuple[float, ...]
Errors = tuple[float | None, ...]

INFORMATION = "observed information"

_DROP = 0.005
"""How far the log-likelihood falls over a step: a tenth of a standard error, far above rounding."""

_FLAT = 1e-7
"""Least bend, beside that along the parameters themselves, that counts as one."""


class Unfit(Exception):  # noqa: N818 - the data do not suit the family; nothing is wrong
    """The family cannot have given these values; the message says why, without a full stop."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A family as the fit sees it.

    Attributes:
        name: as `xlmc.montecarlo.distributions` spells it.
        headings: its parameters, as the table `xlmc_assumptions` names them.
        estimate: the maximum-likelihood parameters; raises `Unfit`.
        log_density: of `(x, *params)`, `(n,)`: the logarithm of the density, or of the probability of a count.
        cdf: of `(x, *params)`, `(n,)`: P(X <= x).
        fixed: headings whose values are not estimated.
        errors: standard errors of `(x, params)`; None: from the observed information.
        errors_from: what they come from, in words.
        costly: `errors` take long, so that they are worked out only where the family is in the race.
    """

    name: str
    headings: tuple[str, ...]
    estimate: Callable[[Floats], Params]
    log_density: Callable[..., Any]
    cdf: Callable[..., Any]
    fixed: frozenset[str] = frozenset()
    errors: Callable[[Floats, Params], Errors] | None = None
    errors_from: str = INFORMATION
    costly: bool = False

    @property
    def free(self) -> int:
        """How many parameters are estimated."""
        return len(self.headings) - len(self.fixed)

    def log_likelihood(self, x: Floats, params: Params) -> float:
        """Return the logarithm of the likelihood; minus infinity where a value is impossible."""
        with np.errstate(all="ignore"):
            total = float(np.sum(self.log_density(x, *np.asarray(params))))  # NumPy's numbers overflow to infinity
        return total if total == total else -np.inf


def refuse(impossible: bool, reason: str) -> None:
    """Say why the family is out of the question.

    Raises:
        Unfit: it is.
    """
    if impossible:
        raise Unfit(reason)


def standard_errors(log_likelihood: Callable[[Params], float], params: Params, free: Sequence[int]) -> Errors:
    """Return the roots of the diagonal of the inverse of the negative second derivatives; otherwise None.

    Args:
        log_likelihood: of all parameters.
        params: where it is highest.
        free: the indices of the parameters that were estimated.
    """
    top = log_likelihood(params)

    def at(*moves: tuple[int, float]) -> float:
        moved = list(params)
        for index, by in moves:
            moved[index] += by
        return log_likelihood(tuple(moved))

    def fall(index: int, h: float) -> float:
        return top - (at((index, h)) + at((index, -h))) / 2

    steps = {index: _step(partial(fall, index), params[index]) for index in free}
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
        for index, variance in zip(free, np.diag(np.linalg.inv(bend)), strict=True):
            errors[index] = float(np.sqrt(variance))
    return tuple(errors)


def _bends_everywhere(bend: NDArray[np.float64]) -> bool:
    """Whether there is no direction in which it is flat, as far as differences can tell."""
    if not (np.isfinite(bend).all() and (np.diag(bend) > 0).all()):
        return False
    scale = np.sqrt(np.diag(bend))
    return bool((np.linalg.eigvalsh(bend / np.outer(scale, scale)) > _FLAT).all())


def _step(drop: Callable[[float], float], value: float) -> float:
    """Return a step over which the log-likelihood falls by about `_DROP`."""
    h = 1e-3 * max(abs(value), 1e-6)
    for _ in range(40):
        fall = drop(h)
        if _DROP / 2 < fall < _DROP * 2:
            break
        factor = np.sqrt(_DROP / fall) if np.isfinite(fall) and fall > 1e-9 else (4.0 if fall < 1 else 0.25)
        h *= float(np.clip(factor, 0.25, 4.0))
    return h
