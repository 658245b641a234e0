"""The highest point of a log-likelihood that has no closed form."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.studies.fitting.candidate import Floats, Unfit

__all__ = ["maximise", "root"]


def maximise(
    log_likelihood: Callable[[Floats], float], start: list[float], *, tolerance: float = 1e-10, most: int = 4000
) -> Floats:
    """Where it is highest, by the simplex method, begun twice so that a simplex that collapsed early is found out.

    Args:
        log_likelihood: of parameters that may be any numbers.
        start: a point near it.
        tolerance: of the parameters.
        most: how often each of the two may ask for it.

    Raises:
        Unfit: it has no highest point that can be found.
    """
    from scipy.optimize import minimize

    def loss(point: Floats) -> float:
        value = log_likelihood(point)
        return -value if np.isfinite(value) else 1e300

    point = np.array(start, dtype=float)
    for _ in range(2):
        options = {"xatol": tolerance, "fatol": tolerance / 10 * (1 + abs(loss(point))), "maxfev": most}
        found = minimize(loss, point, method="Nelder-Mead", options=options)
        point = np.asarray(found.x)
    if not found.success or not found.fun < 1e300:
        raise Unfit("its likelihood has no highest point")
    return point


def root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function of a positive number crosses zero; the bracket is widened as need be.

    Raises:
        Unfit: it does not, within 1e-6 to 1e6.
    """
    from scipy.optimize import brentq

    while rising(low) > 0 and low > 1e-6:
        low /= 4
    while rising(high) < 0 and high < 1e6:
        high *= 4
    if not rising(low) <= 0 <= rising(high):
        raise Unfit("its likelihood has no highest point")
    return float(brentq(rising, low, high, xtol=1e-14, rtol=1e-14))
