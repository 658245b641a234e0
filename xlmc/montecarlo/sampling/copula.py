"""Rank correlation by a Gaussian copula, which turns independent uniforms into correlated ones, trial by trial.

**Contradictions.** No draws can have correlations that contradict each other. Instead the nearest matrix is used that
draws can have (`nearest_correlation`).

**Ties.** Assumptions that take few values, such as Yes-No, have equal draws, which share their mean rank. The Spearman
correlation of two draws is Pearson's of their mean ranks, F(x) − P(x)/2. With a Gaussian copula of parameter r, cuts h
and k of the normals between the values, and steps w and v of the mean ranks there,

    both step      cov = Σ Σ w v ∫ exp(-(h² + k² - 2hk·sin t) / (2cos² t)) dt / 2π        t from 0 to asin r
    one does not   cov = Σ w ∫ exp(-h² / (2cos² t)) dt / 2π                               t from 0 to asin(r/√2)

(Plackett 1954: the derivative of the bivariate normal probability is its density; sin t for the correlation as in
Drezner and Wesolowsky 1990). The largest and the smallest are those of r = ±1, Fréchet's bounds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.quadrature import gauss_legendre

__all__ = [
    "GaussianCopula",
    "Ties",
    "bounds",
    "nearest_by_weights",
    "nearest_correlation",
    "parameter",
    "spearman",
    "ties_of",
]

Floats = NDArray[np.float64]

Quantiles = Callable[[Floats], Floats]
"""Takes uniforms `(n,)` and gives the draws made from them."""

_HALF_STEP: Final = 2.0**-54

_LEAST: Final = 2.0**-80
"""The least probability that a draw is made from: less has a chance of 1e-24."""

_ROUNDING: Final = 1e-9
"""An eigenvalue that is below 0 by less counts as 0: no correlation need change by more than this."""

_PROJECTIONS: Final = 10_000
_CLOSE: Final = 1e-12
"""The projections have met when a round changes the matrix by less than this share."""

_CLOSE_ENOUGH: Final = 1e-10
_MET: Final = 1e-6
"""Copies of a matrix that differ by more after the last round do not become one."""

_PATIENCE: Final = 500
"""Rounds after which the copies must have come nearer."""

_ALMOST: Final = 99.9
"""The largest weight of a number that may change: where those of 100 contradict each other, they count as this."""

_GRID: Final = 4096
"""The number of probabilities at which draws are computed to find ties."""

_FEW: Final = 512
"""If the value changes no more often between these, draws are computed at the ends as well, where rare values lie."""

_ENDS: Final = 0.5 ** np.arange(13, 50)
"""Probabilities below the first of the grid; 1 minus these lie above the last."""

_NEGLIGIBLE: Final = 1e-4
"""Ties that reduce the variance of ranks by less are ignored: the correlation differs by half of it."""

_FINE: Final = 1 / 256
"""Values less probable than this are joined."""

_NEAR: Final = 1e-12
"""A correlation this near to a bound counts as the bound."""

_HALVINGS: Final = 60
_NODES: Final = 64
_CONTINUOUS_SPREAD: Final = float(np.sqrt(1 / 12))


class GaussianCopula:
    """Joins k uniforms so that the draws' Spearman correlations are those of `target`, or the nearest possible ones.

    The first keeps its own draws; each other mixes its own with those before it.

    Args:
        target: the matrix `(k, k)`, symmetric with a diagonal of 1.
        ties: the values that each of the k takes, None for a continuous one; by default all are continuous.
        weights: `(k, k)`, symmetric, from 0 to 100: how much each number of the target is kept where it is repaired.

    Attributes:
        wanted: the target, each number limited to what ties allow its pair.
        spearman: the Spearman correlations that the draws have.
        repaired: whether they differ from `wanted`, because no joint distribution of this kind has it.

    Source: the Pearson correlation of the normals is ρ = 2 sin(π r_s / 6) (Kruskal 1958), which is exact; the module
    says what it is for draws with few values. The matrix of these must be positive semidefinite, so it is repaired
    (Higham 2002), and the rank correlations follow from it.
    """

    def __init__(self, target: Floats, ties: Sequence[Ties | None] = (), weights: Floats | None = None) -> None:
        self._ties = ties
        pearson = 2 * np.sin(np.pi / 6 * target)
        np.fill_diagonal(pearson, 1.0)
        self.wanted = target.copy()
        for i, j in self._tied_pairs():
            least, most = bounds(ties[i], ties[j])
            self.wanted[i, j] = self.wanted[j, i] = min(max(float(target[i, j]), least), most)
            pearson[i, j] = pearson[j, i] = parameter(ties[i], ties[j], float(target[i, j])) if target[i, j] else 0.0
        self.repaired = bool(np.linalg.eigvalsh(pearson)[0] < -_ROUNDING)
        self._mix = _triangular_root(_repaired(pearson, weights) if self.repaired else pearson)
        normals = np.clip(self._mix @ self._mix.T, -1.0, 1.0)
        self.spearman = 6 / np.pi * np.arcsin(normals / 2)
        for i, j in self._tied_pairs():
            self.spearman[i, j] = self.spearman[j, i] = spearman(ties[i], ties[j], float(normals[i, j]))

    def _tied_pairs(self) -> Iterator[tuple[int, int]]:
        """Yield the pairs of which at least one takes few values."""
        rows = range(len(self._ties))
        return ((i, j) for i, j in combinations(rows, 2) if self._ties[i] or self._ties[j])

    def join(self, u: Floats) -> None:
        """Replace the rows of `u` (k, n), independent uniforms in [0, 1), by joined ones."""
        from scipy.special import ndtr, ndtri

        z = ndtri(np.maximum(u, _HALF_STEP))
        for i in range(len(u) - 1, 0, -1):  # each row needs only itself and the rows above it
            joined = self._mix[i, 0] * z[0]
            for j in range(1, i + 1):
                joined += self._mix[i, j] * z[j]
            u[i] = np.clip(ndtr(joined), _LEAST, 1 - 2.0**-53)


def _triangular_root(matrix: Floats) -> Floats:
    """Return the lower triangle (k, k) that, times its transpose, is the matrix, which may be singular.

    A square root by eigenvalues is rotated until it is triangular, which is accurate even for correlations of ±1. An
    eigenvalue of 1e-16, which is only rounding, would have a root of 1e-8, and ±1 would not remain ±1. The rows have
    length 1.
    """
    values, vectors = np.linalg.eigh(matrix)
    values[values < 4.0 * len(matrix) * np.finfo(np.float64).eps] = 0.0
    turned: Floats = np.linalg.qr((vectors * np.sqrt(np.maximum(values, 0.0))).T, mode="r")  # type: ignore[assignment]
    triangle = turned.T * np.where(np.diagonal(turned) < 0.0, -1.0, 1.0)
    return np.asarray(triangle / np.linalg.norm(triangle, axis=1, keepdims=True))


def _repaired(matrix: Floats, weights: Floats | None) -> Floats:
    """Find the nearest correlation matrix, by weights where there are any."""
    if weights is None or not weights.any():
        return nearest_correlation(matrix)
    values, met = nearest_by_weights(matrix, weights)
    return values if met else nearest_by_weights(matrix, np.minimum(weights, _ALMOST))[0]


def nearest_by_weights(matrix: Floats, weights: Floats) -> tuple[Floats, bool]:
    """Find the correlation matrix (k, k) with the least sum of (change)² / (1 - weight/100), and whether there is one.

    A weight of 100 allows no change, and there may be no correlation matrix that has all of these numbers. By the
    alternating direction method of multipliers (Boyd et al. 2011, chapter 5): one copy of the matrix is near the
    target, number by number, the other has no negative eigenvalue, and both become one.

    >>> target = np.array([[1.0, 0.9, 0.0], [0.9, 1.0, 0.9], [0.0, 0.9, 1.0]])
    >>> nearest_by_weights(target, 100.0 * (target == 0.9))[0].round(4).tolist()[0]
    [1.0, 0.9, 0.62]
    """
    free = 1 - weights / 100
    np.fill_diagonal(free, 0.0)
    free /= max(free.max(), 1 - _ALMOST / 100)
    share = free / (1 + free)
    values, turned = matrix.copy(), np.zeros_like(matrix)
    last = np.inf
    for round_ in range(_PROJECTIONS):
        inside = _drop_negative_eigenvalues(values + turned)
        turned += values - inside
        before, values = values, matrix + share * (inside - turned - matrix)
        apart = float(np.abs(values - inside).max())
        if max(apart, float(np.abs(values - before).max())) <= _CLOSE_ENOUGH:
            break
        if round_ % _PATIENCE == _PATIENCE - 1:
            if apart > max(_MET, 0.98 * last):
                break  # no nearer than so many rounds before
            last = apart
    return values, apart <= _MET


def nearest_correlation(matrix: Floats) -> Floats:
    """Find the correlation matrix (k, k) nearest to a symmetric one in the Frobenius norm.

    The matrix is projected by turns on the positive semidefinite matrices and on those with a diagonal of 1; Dykstra's
    correction of the first makes the turns meet at the nearest point, not just at any (Higham 2002, algorithm 3.3).

    >>> nearest_correlation(np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]))[0].round(4).tolist()
    [1.0, 0.7607, 0.1573]
    """
    values, correction = matrix.copy(), np.zeros_like(matrix)
    for _ in range(_PROJECTIONS):
        before = values
        corrected = before - correction
        inside = _drop_negative_eigenvalues(corrected)
        correction = inside - corrected
        values = inside.copy()
        np.fill_diagonal(values, 1.0)
        if np.linalg.norm(values - before) <= _CLOSE * np.linalg.norm(values):
            break
    return values


def _drop_negative_eigenvalues(matrix: Floats) -> Floats:
    """Return the matrix without its negative eigenvalues."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)


@dataclass(frozen=True, eq=False)
class Ties:
    """The probabilities of the values that a draw takes.

    Attributes:
        cuts: the rising probabilities at which one value ends and the next begins, `(m - 1,)` of m values.
    """

    cuts: Floats

    @cached_property
    def chances(self) -> Floats:
        """The probability of each value, `(m,)`."""
        return np.diff(self.cuts, prepend=0.0, append=1.0)

    @cached_property
    def steps(self) -> Floats:
        """The growth of the mean rank from one value to the next, `(m - 1,)`."""
        return np.asarray((self.chances[:-1] + self.chances[1:]) / 2)

    @cached_property
    def normals(self) -> Floats:
        """The cuts as quantiles of the normal distribution, `(m - 1,)`."""
        from scipy.special import ndtri

        return np.asarray(ndtri(self.cuts))

    @property
    def spread(self) -> float:
        """The standard deviation of the mean ranks."""
        return float(np.sqrt((1 - np.sum(self.chances**3)) / 12))


def ties_of(quantiles: Quantiles) -> Ties | None:
    """Find the values that a draw takes; None if hardly any two draws are equal, or all."""
    u = (np.arange(_GRID) + 0.5) / _GRID
    values = quantiles(u)
    new = np.flatnonzero(values[1:] != values[:-1])
    if new.size <= _FEW:
        u = np.concatenate([_ENDS[::-1], u, 1 - _ENDS])
        values = quantiles(u)
        new = np.flatnonzero(values[1:] != values[:-1])
    if new.size in (0, u.size - 1):
        return None
    ties = Ties(_join_rare_values(_refined_cuts(quantiles, u, values, new)))
    return ties if np.sum(ties.chances**3) > _NEGLIGIBLE else None


def _refined_cuts(quantiles: Quantiles, u: Floats, values: Floats, new: NDArray[np.intp]) -> Floats:
    """Find by halving where the value changes after each of some probabilities."""
    low, high, before = u[new].copy(), u[new + 1].copy(), values[new]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        grown = quantiles(middle) > before
        low, high = np.where(grown, low, middle), np.where(grown, middle, high)
    return high


def _join_rare_values(cuts: Floats) -> Floats:
    """Return the cuts without those between improbable values."""
    following = np.append(cuts[1:], 1.0)
    distinct, last = [], 0.0
    for cut, after in zip(cuts, following, strict=True):
        if cut - last >= _FINE or after - cut >= 2 * _FINE:
            distinct.append(cut)
            last = cut
    return np.array(distinct)


def spearman(first: Ties | None, second: Ties | None, r: float) -> float:
    """Return the rank correlation of two draws under a copula of parameter r; None stands for a continuous draw."""
    if first is None and second is None:
        return float(6 / np.pi * np.arcsin(np.clip(r, -1.0, 1.0) / 2))
    if first is None or second is None:
        one = first or second
        assert one is not None
        return _beside_continuous(one, r) / (one.spread * _CONTINUOUS_SPREAD)
    if abs(r) >= 1.0:
        return _at_the_bound(first, second, r) / (first.spread * second.spread)
    return _both_tied(first, second, r) / (first.spread * second.spread)


def _quadrature(end: float) -> tuple[Floats, Floats]:
    """Return Gauss and Legendre's points and weights from 0 to `end`."""
    x, w = gauss_legendre(_NODES)
    return end * (x + 1) / 2, end * w / 2


def _beside_continuous(ties: Ties, r: float) -> float:
    t, w = _quadrature(float(np.arcsin(np.clip(r, -1.0, 1.0) / np.sqrt(2))))
    density = np.exp(-(ties.normals[:, None] ** 2) / (2 * np.cos(t) ** 2))
    return float(ties.steps @ density @ w / (2 * np.pi))


def _both_tied(first: Ties, second: Ties, r: float) -> float:
    total = 0.0
    h, k = first.normals[:, None], second.normals[None, :]
    for t, w in zip(*_quadrature(float(np.arcsin(r))), strict=True):
        density = np.exp(-(h**2 + k**2 - 2 * h * k * np.sin(t)) / (2 * np.cos(t) ** 2))
        total += w * float(first.steps @ density @ second.steps)
    return total / (2 * np.pi)


def _at_the_bound(first: Ties, second: Ties, r: float) -> float:
    """Return the covariance of mean ranks if both draws come from one uniform, or from u and 1-u."""
    above, beyond = 1 - first.cuts[:, None], 1 - second.cuts[None, :]
    both = np.minimum(above, beyond) if r > 0 else np.maximum(above + beyond - 1, 0.0)
    return float(first.steps @ (both - above * beyond) @ second.steps)


def bounds(first: Ties | None, second: Ties | None) -> tuple[float, float]:
    """Return the smallest and the largest rank correlation that is possible."""
    return spearman(first, second, -1.0), spearman(first, second, 1.0)


def parameter(first: Ties | None, second: Ties | None, wanted: float) -> float:
    """Find the parameter of the copula that gives a rank correlation; ±1 if it is out of reach.

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
