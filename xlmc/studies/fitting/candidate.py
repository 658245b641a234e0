"""A family that may be fitted: how its likelihood is maximised, and what is needed to judge the result.

Shapes: `x` are the values `(n,)`, in rising order; parameters are numbers in the order of `headings`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["INFORMATION", "Candidate", "Errors", "Floats", "Params", "Unfit", "refuse"]

Floats = NDArray[np.float64]
Params = tuple[float, ...]
Errors = tuple[float | None, ...]

INFORMATION = "observed information"


class Unfit(Exception):  # noqa: N818 - the data do not suit the family; nothing is wrong
    """The family cannot have given these values; the message says why, without a full stop."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A family as the fit sees it.

    Attributes:
        name: as `xlmc.distributions` spells it.
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
        """The logarithm of the likelihood; minus infinity where a value is impossible."""
        with np.errstate(all="ignore"):
            total = float(np.sum(self.log_density(x, *params)))
        return total if total == total else -np.inf


def refuse(impossible: bool, reason: str) -> None:
    """Say why the family is out of the question.

    Raises:
        Unfit: it is.
    """
    if impossible:
        raise Unfit(reason)
