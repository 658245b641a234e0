"""How many independent trials a percentile needs, from the distribution that a reference shows.

A percentile of `n` trials lies within a tolerance of the true one, q, if fewer than a share p of the trials lie below
q − tolerance, and at least p of them up to q + tolerance. Both counts are binomial, so that with F(q ± tolerance) at
p ± d, 95 of 100 runs do so where Φ(√n·d₊/s₊) + Φ(√n·d₋/s₋) − 1 = 0.95, s² = F(1 − F). Where the density f is constant
over the tolerance, this is the usual error √(p(1 − p))/(f·√n); where it is not, as beside a gap, that one is wrong.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

__all__ = ["QuantileNeed", "quantile_need"]

_CONFIDENCE: Final = 0.95
_RANGE: Final = (1.0, 1e18)


@dataclass(frozen=True, slots=True)
class QuantileNeed:
    """Accepted trials that 95 of 100 runs keep a tolerance with.

    Attributes:
        trials: how many.
        error: the standard error of their logarithm.
    """

    trials: float
    error: float


def quantile_need(
    ordered: NDArray[np.float64], p: float, tolerance: float, accepted: int, gain: float = 1.0
) -> QuantileNeed | None:
    """Return the need of the percentile at p; None if the reference does not know it.

    Args:
        ordered: `(m,)` accepted values of the reference, ascending, evenly thinned.
        p: between 0 and 1.
        tolerance: in the forecast's units.
        accepted: trials of the reference.
        gain: the errors of the reference over those of as many independent trials.

    >>> quantile_need(np.linspace(0.0, 1.0, 100_001), 0.5, 0.01, 10**6).trials.__round__(-2)
    9600.0
    """
    at = float(np.quantile(ordered, p))
    up = float(np.searchsorted(ordered, at + tolerance, "right")) / ordered.size
    down = float(np.searchsorted(ordered, at - tolerance, "left")) / ordered.size
    nearest = min(up - p, p - down)
    shift = gain * float(np.sqrt(p * (1.0 - p) / accepted))
    if not nearest > 2.0 * max(shift, 1.0 / ordered.size):
        return None
    own = float(np.hypot(shift, gain * np.sqrt(nearest / accepted)))
    return QuantileNeed(_solved(up, down, p), 2.0 * own / nearest)


def _solved(up: float, down: float, p: float) -> float:
    from scipy.optimize import brentq
    from scipy.special import ndtr

    def missing(log_trials: float) -> float:
        certainty = -1.0
        for share in (up, down):
            spread = share * (1.0 - share)
            certainty += 1.0 if spread <= 0.0 else float(ndtr(np.exp(log_trials / 2.0) * abs(share - p) / spread**0.5))
        return certainty - _CONFIDENCE

    low, high = (float(np.log(end)) for end in _RANGE)
    if missing(low) >= 0.0:
        return _RANGE[0]
    return float(np.exp(brentq(missing, low, high)))
