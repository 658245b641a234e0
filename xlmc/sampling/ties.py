"""Rank correlation of assumptions that take few values, such as Yes-No: equal draws share their mean rank.

The Spearman correlation of two draws is Pearson's of their mean ranks, F(x) less half of P(x). With a Gaussian copula
of parameter r, cuts h and k of the normals between the values, and steps w and v of the mean ranks there,

    both step      cov = Σ Σ w v ∫ exp(-(h² + k² - 2hk·sin t) / (2cos² t)) dt / 2π        t from 0 to asin r
    one does not   cov = Σ w ∫ exp(-h² / (2cos² t)) dt / 2π                               t from 0 to asin(r/√2)

(Plackett 1954: the derivative of the bivariate normal probability is its density; sin t for the correlation as in
Drezner and Wesolowsky 1990). The most and the least are those of r = ±1, Fréchet's bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from xlmc.sampling.draws import Draw

__all__ = ["Ties", "bounds", "parameter", "spearman", "ties_of"]

Floats = NDArray[np.float64]

_GRID: Final = 4096
"""Places at which a draw is looked at."""

_FEW: Final = 512
"""Changes of value at these places: with no more of them the ends are looked at as well, where rare values lie."""

_ENDS: Final = 0.5 ** np.arange(13, 50)
"""Probabilities beyond the first and the last of these places."""

_NEGLIGIBLE: Final = 1e-4
"""Of the variance of ranks, that ties take away: the correlation differs by less than half of that."""

_FINE: Final = 1 / 256
"""Values less probable than that are taken together."""

_NEAR: Final = 1e-12
"""Of a bound: what is so near to it is the bound."""

_HALVINGS: Final = 60
_NODES: Final = 64
_CONTINUOUS_SPREAD: Final = float(np.sqrt(1 / 12))


@dataclass(frozen=True, eq=False)
class Ties:
    """The values that a draw takes.

    Attributes:
        cuts: the probabilities, rising, at which it goes from one value to the next, `(m - 1,)` of m values.
    """

    cuts: Floats

    @cached_property
    def chances(self) -> Floats:
        """The probability of each value, `(m,)`."""
        return np.diff(self.cuts, prepend=0.0, append=1.0)

    @cached_property
    def steps(self) -> Floats:
        """By how much the mean rank grows from one value to the next, `(m - 1,)`."""
        return np.asarray((self.chances[:-1] + self.chances[1:]) / 2)

    @cached_property
    def normals(self) -> Floats:
        """The cuts of a normal number."""
        from scipy.special import ndtri

        return np.asarray(ndtri(self.cuts))

    @property
    def spread(self) -> float:
        """The standard deviation of the mean ranks."""
        return float(np.sqrt((1 - np.sum(self.chances**3)) / 12))


def ties_of(draw: Draw) -> Ties | None:
    """The values that a draw takes; None where hardly any two draws are equal, or all, or where parameters vary."""
    if not draw.fixed:
        return None
    u = (np.arange(_GRID) + 0.5) / _GRID
    found = _filled(draw, u)
    new = np.flatnonzero(found[1:] != found[:-1])
    if new.size <= _FEW:
        u = np.concatenate([_ENDS[::-1], u, 1 - _ENDS])
        found = _filled(draw, u)
        new = np.flatnonzero(found[1:] != found[:-1])
    if new.size in (0, u.size - 1):
        return None
    ties = Ties(_coarse(_cuts(draw, u, found, new)))
    return ties if np.sum(ties.chances**3) > _NEGLIGIBLE else None


def _filled(draw: Draw, u: Floats) -> Floats:
    found = u.copy()
    draw.fill(found, {})
    return found


def _cuts(draw: Draw, u: Floats, found: Floats, new: NDArray[np.intp]) -> Floats:
    """Where the value changes after each of some places, by halving."""
    low, high, before = u[new].copy(), u[new + 1].copy(), found[new]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        grown = _filled(draw, middle) > before
        low, high = np.where(grown, low, middle), np.where(grown, middle, high)
    return high


def _coarse(cuts: Floats) -> Floats:
    """The cuts without those between values that are all improbable."""
    following = np.append(cuts[1:], 1.0)
    kept, last = [], 0.0
    for cut, after in zip(cuts, following, strict=True):
        if cut - last >= _FINE or after - cut >= 2 * _FINE:
            kept.append(cut)
            last = cut
    return np.array(kept)


def spearman(first: Ties | None, second: Ties | None, r: float) -> float:
    """The rank correlation of two draws that a Gaussian copula of parameter r joins; None for a continuous one."""
    if first is None and second is None:
        return float(6 / np.pi * np.arcsin(np.clip(r, -1.0, 1.0) / 2))
    if first is None or second is None:
        one = first or second
        assert one is not None
        return _beside_continuous(one, r) / (one.spread * _CONTINUOUS_SPREAD)
    if abs(r) >= 1.0:
        return _extreme(first, second, r) / (first.spread * second.spread)
    return _both(first, second, r) / (first.spread * second.spread)


def _nodes(end: float) -> tuple[Floats, Floats]:
    """Places and weights from 0 to the end (Gauss and Legendre)."""
    x, w = np.polynomial.legendre.leggauss(_NODES)
    return end * (x + 1) / 2, end * w / 2


def _beside_continuous(ties: Ties, r: float) -> float:
    t, w = _nodes(float(np.arcsin(np.clip(r, -1.0, 1.0) / np.sqrt(2))))
    density = np.exp(-(ties.normals[:, None] ** 2) / (2 * np.cos(t) ** 2))
    return float(ties.steps @ density @ w / (2 * np.pi))


def _both(first: Ties, second: Ties, r: float) -> float:
    total = 0.0
    h, k = first.normals[:, None], second.normals[None, :]
    for t, w in zip(*_nodes(float(np.arcsin(r))), strict=True):
        density = np.exp(-(h**2 + k**2 - 2 * h * k * np.sin(t)) / (2 * np.cos(t) ** 2))
        total += w * float(first.steps @ density @ second.steps)
    return total / (2 * np.pi)


def _extreme(first: Ties, second: Ties, r: float) -> float:
    """The covariance of mean ranks where both draws come from one uniform, or from u and 1-u."""
    above, beyond = 1 - first.cuts[:, None], 1 - second.cuts[None, :]
    both = np.minimum(above, beyond) if r > 0 else np.maximum(above + beyond - 1, 0.0)
    return float(first.steps @ (both - above * beyond) @ second.steps)


def bounds(first: Ties | None, second: Ties | None) -> tuple[float, float]:
    """The least and the most that the rank correlation can be."""
    return spearman(first, second, -1.0), spearman(first, second, 1.0)


def parameter(first: Ties | None, second: Ties | None, wanted: float) -> float:
    """The copula's parameter that gives a rank correlation; ±1 where it is out of reach.

    >>> round(parameter(None, Ties(np.array([0.5])), 0.5), 4)
    0.6195
    """
    least, most = bounds(first, second)
    if wanted >= most - _NEAR:
        return 1.0
    if wanted <= least + _NEAR:
        return -1.0
    low, high = -1.0, 1.0
    while high - low > 1e-13:
        middle = (low + high) / 2
        if spearman(first, second, middle) < wanted:
            low = middle
        else:
            high = middle
    return (low + high) / 2
