"""Copulas other than the Gaussian one: Student's t, Clayton, Gumbel and Frank, with their reflections; that of trials.

As many independent uniforms go in as come out.

The t copula and Clayton's, and Frank's of two variables, join one variable after another: the next is the quantile, at
its own uniform, of the distribution that it has where those before it are known (Rosenblatt 1952). The first stays what
it was.

Gumbel's, and Frank's of more variables, have a frailty V that all variables share (Marshall and Olkin 1988): uⱼ becomes
ψ(−ln(uⱼ)/V). Here V is made of the bits of the uniforms, by the generator SplitMix64, and no others are needed.

    Clayton   ψ(t) = (1 + t)^(−1/θ)
    Frank     ψ(t) = −ln(1 − (1 − e^−θ)·e^−t)/θ     V logarithmic with p = 1 − e^−θ (drawn as in Kemp 1981)
    Gumbel    ψ(t) = exp(−t^(1/θ))                  V positive stable (drawn as in Kanter 1975)

Source: McNeil, Frey and Embrechts, Quantitative Risk Management (2015), ch. 7; Demarta and McNeil, Int. Stat. Rev. 73
(2005), 111–129, for the t copula.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.split_mix import GOLDEN, mixed
from xlmc.montecarlo.sampling.copula import nearest_correlation

__all__ = ["Archimedean", "Clayton", "Frank", "Gumbel", "Joining", "Reflected", "SameTrials", "StudentTCopula"]

Floats = NDArray[np.float64]

_LEAST: Final = 2.0**-80
_MOST: Final = 1 - 2.0**-53
_HALF_STEP: Final = 2.0**-54
_SIDE: Final = 512
_T_SIDE: Final = 128
_NEGATIVE: Final = 1e-9


class Joining(Protocol):
    """What joins draws.

    Attributes:
        wanted: the rank correlations that were asked for, `(k, k)`.
        spearman: those that the draws have.
        repaired: whether what was asked for contradicts itself, and the nearest that does not is used.
    """

    @property
    def wanted(self) -> Floats: ...

    @property
    def spearman(self) -> Floats: ...

    @property
    def repaired(self) -> bool: ...

    def join(self, u: Floats) -> None:
        """Replace the rows of `u` (k, n), independent uniforms in [0, 1), by joined ones."""


class _Joined(ABC):
    """What these copulas have in common."""

    size: int
    repaired = False

    @abstractmethod
    def join(self, u: Floats) -> None:
        """See `Joining`."""

    @cached_property
    def spearman(self) -> Floats:
        """The rank correlations that the draws have, `(k, k)`, right to 1e-3."""
        values = np.eye(self.size)
        for i in range(self.size):
            for j in range(i + 1, self.size):
                values[i, j] = values[j, i] = self.pair(i, j)
        return values

    @abstractmethod
    def pair(self, i: int, j: int) -> float:
        """Return the rank correlation of the variables i and j."""

    @property
    def wanted(self) -> Floats:
        return self.spearman


class StudentTCopula(_Joined):
    """The copula of the multivariate t distribution.

    Args:
        matrix: the correlations of the t distribution, `(k, k)`; Kendall's tau is 2·asin(r)/π.
        degrees: of freedom; few make the draws extreme together.
    """

    def __init__(self, matrix: Floats, degrees: float) -> None:
        self.size, self.degrees = len(matrix), degrees
        self.repaired = bool(np.linalg.eigvalsh(matrix)[0] < -_NEGATIVE)
        self.matrix = nearest_correlation(matrix) if self.repaired else matrix
        values, vectors = np.linalg.eigh(self.matrix)
        root = np.linalg.qr((vectors * np.sqrt(np.maximum(values, 0.0))).T, mode="r")
        self._mix = root.T * np.where(np.diagonal(root) < 0.0, -1.0, 1.0)  # type: ignore[attr-defined]

    def join(self, u: Floats) -> None:
        from scipy.special import stdtr

        z = np.empty_like(u)
        squares = np.zeros(u.shape[1])
        for i, row in enumerate(u):
            degrees = self.degrees + i
            z[i] = _t_quantile(np.maximum(row, _HALF_STEP), degrees) * np.sqrt((self.degrees + squares) / degrees)
            squares += z[i] ** 2
        for i in range(1, len(u)):
            u[i] = np.clip(stdtr(self.degrees, self._mix[i, : i + 1] @ z[: i + 1]), _LEAST, _MOST)

    def pair(self, i: int, j: int) -> float:
        """Compute the rank correlation 12·E[UV] − 3, over a grid of the uniforms that are joined."""
        middle = (np.arange(_T_SIDE) + 0.5) / _T_SIDE
        u = np.stack([np.repeat(middle, _T_SIDE), np.tile(middle, _T_SIDE)])
        StudentTCopula(self.matrix[np.ix_([i, j], [i, j])], self.degrees).join(u)
        return 12 * float(np.mean(u[0] * u[1])) - 3


def _t_quantile(u: Floats, degrees: float) -> Floats:
    from xlmc.montecarlo.distributions.students_t import StudentsT

    return StudentsT().ppf(u, 0.0, 1.0, degrees)


class SameTrials(_Joined):
    """Values that stand together, each trial's as likely as the others: their empirical copula.

    Its uniforms are the middles of the steps of the empirical distributions of these values.

    Args:
        values: `(k, m)`, of m trials.
    """

    def __init__(self, values: Floats) -> None:
        self.size = len(values)
        rising = values[:, np.argsort(values[0], kind="stable")]
        self._ranks = np.argsort(np.argsort(rising, axis=1, kind="stable"), axis=1, kind="stable")

    def join(self, u: Floats) -> None:
        """Join the uniforms; the first of them says which trial is taken."""
        m = self._ranks.shape[1]
        taken = np.minimum((u[0] * m).astype(np.intp), m - 1)
        u[:] = (self._ranks[:, taken] + 0.5) / m

    def pair(self, i: int, j: int) -> float:
        return float(np.corrcoef(self._ranks[i], self._ranks[j])[0, 1])


class Archimedean(_Joined):
    """A copula of one parameter, the same for every pair.

    Args:
        size: how many it joins.
        theta: its parameter.
    """

    def __init__(self, size: int, theta: float) -> None:
        self.size, self.theta = size, theta

    def join(self, u: Floats) -> None:
        with np.errstate(all="ignore"):
            frailty = self.frailty(*_more_uniforms(u))
            np.maximum(u, _HALF_STEP, out=u)
            np.clip(self.generator(-np.log(u) / frailty), _LEAST, _MOST, out=u)

    def pair(self, i: int, j: int) -> float:
        """Compute the rank correlation 12·∫∫C − 3, over a grid."""
        middle = self.inverse((np.arange(_SIDE) + 0.5) / _SIDE)
        with np.errstate(all="ignore"):
            return 12 * float(np.mean(self.generator(middle[:, None] + middle))) - 3

    @abstractmethod
    def generator(self, t: Floats) -> Floats:
        """ψ(t)."""

    @abstractmethod
    def inverse(self, u: Floats) -> Floats:
        """φ(u), the inverse of ψ."""

    def frailty(self, u: Floats, v: Floats) -> Floats:
        """V, from two uniforms above 0 and below 1."""
        raise NotImplementedError


def _more_uniforms(u: Floats) -> tuple[Floats, Floats]:
    """Two uniforms more of each trial, above 0 and below 1, that its own (k, n) decide."""
    seed = np.zeros(u.shape[1], dtype=np.uint64)
    for row in u:
        seed = mixed(seed + GOLDEN ^ np.ascontiguousarray(row).view(np.uint64))
    first, second = (mixed(seed + step) >> np.uint64(11) for step in np.array([1, 2], dtype=np.uint64) * GOLDEN)
    return (first.astype(np.float64) + 0.5) * 2.0**-53, (second.astype(np.float64) + 0.5) * 2.0**-53


class Clayton(Archimedean):
    """Extreme together at the low end: tail dependence 2^(−1/θ) there, τ = θ/(θ + 2), θ above 0."""

    def generator(self, t: Floats) -> Floats:
        return np.asarray(np.exp(-np.log1p(t) / self.theta))

    def inverse(self, u: Floats) -> Floats:
        return np.asarray(np.expm1(-self.theta * np.log(u)))

    def join(self, u: Floats) -> None:
        """One after another; ln(1 + T), T the sum of φ of those before, keeps the smallest and the largest."""
        np.maximum(u, _HALF_STEP, out=u)
        log_total = -self.theta * np.log(u[0])
        for k in range(1, len(u)):
            power = self.theta / (1 + self.theta * k)
            log_step = log_total + np.log(np.expm1(-power * np.log(u[k])))
            u[k] = np.clip(np.exp(-np.logaddexp(0.0, log_step) / self.theta), _LEAST, _MOST)
            log_total = np.logaddexp(log_total, log_step)


class Frank(Archimedean):
    """Joined evenly from end to end, without tail dependence; θ may be negative for two variables.

    τ = 1 − 4·(1 − D(θ))/θ, D Debye's function of order 1.
    """

    def join(self, u: Floats) -> None:
        if len(u) > 2:
            super().join(u)
            return
        first, v, theta = np.maximum(u[0], _HALF_STEP), np.maximum(u[1], _HALF_STEP), self.theta
        if theta < 0:  # the mirror image of the positive one
            first, theta = 1 - first, -theta
        # From P(U₂ ≤ u₂ | u₁) = v.
        grown = np.exp(-theta * first)
        whole = v + grown * (1 - v)
        share, rest = v * -np.expm1(-theta) / whole, (grown * (1 - v) + v * np.exp(-theta)) / whole  # their sum is 1
        log_rest = np.where(share < 0.5, np.log1p(-np.minimum(share, 0.5)), np.log(rest))
        u[1] = np.clip(-log_rest / theta, _LEAST, _MOST)

    def generator(self, t: Floats) -> Floats:
        rest = -np.expm1(-t) + np.exp(-t - self.theta)  # 1 - (1 - e^-θ)·e^-t, to its last digits where it is small
        far = np.log1p(np.maximum(np.expm1(-self.theta) * np.exp(-t), -0.7))
        return np.asarray(-np.where(t < 0.5, np.log(rest), far) / self.theta)

    def inverse(self, u: Floats) -> Floats:
        return np.asarray(-np.log(np.expm1(-self.theta * u) / np.expm1(-self.theta)))

    def frailty(self, u: Floats, v: Floats) -> Floats:
        q, near = -np.expm1(-self.theta * u), np.exp(-self.theta * u)
        more = 1 + np.floor(np.log(v) / np.where(near < 0.5, np.log1p(-np.minimum(near, 0.5)), np.log(q)))
        return np.where(v > -np.expm1(-self.theta), 1.0, np.where(v < q * q, more, np.where(v > q, 1.0, 2.0)))


class Gumbel(Archimedean):
    """Extreme together at the high end: tail dependence 2 − 2^(1/θ) there, τ = 1 − 1/θ, θ from 1."""

    def generator(self, t: Floats) -> Floats:
        return np.asarray(np.exp(-(t ** (1 / self.theta))))

    def inverse(self, u: Floats) -> Floats:
        return np.asarray((-np.log(u)) ** self.theta)

    def frailty(self, u: Floats, v: Floats) -> Floats:
        a, angle = 1 / self.theta, np.pi * u
        rest = (np.sin((1 - a) * angle) / -np.log(v)) ** ((1 - a) / a)
        return np.asarray(np.sin(a * angle) / np.sin(angle) ** (1 / a) * rest)


class Reflected:
    """A copula with some variables turned over: 1 − u instead of u.

    Args:
        of: the copula.
        turned: which variables are.
    """

    def __init__(self, of: Joining, turned: Sequence[bool]) -> None:
        self.of, self.turned = of, np.array(turned)

    @property
    def repaired(self) -> bool:
        return self.of.repaired

    @property
    def spearman(self) -> Floats:
        sign = np.where(self.turned, -1.0, 1.0)
        return np.asarray(self.of.spearman * np.outer(sign, sign))

    @property
    def wanted(self) -> Floats:
        return self.spearman

    def join(self, u: Floats) -> None:
        """See `Joining`. The first variable stays what it is here, too."""
        if self.turned[0]:
            u[0] = np.minimum(1 - u[0], _MOST)
        self.of.join(u)
        u[self.turned] = np.clip(1 - u[self.turned], _LEAST, _MOST)
