"""Lines and planes of least squares, each trial by itself.

Letters: n trials, m observations, p variables. The columns are made orthogonal one after the other (Gram-Schmidt, every
column twice, which is as good as Householder's reflections: Giraud, Langou & Rozložník 2005), and the solution is
refined once by its own residuals. Sums run from left to right: a trial has the same bits alone and among others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.functions.samples import mean_of, row_sums
from xlmc.functions.values import Bools, Floats

__all__ = ["Fit", "fit"]

_DEPENDENT: Final = 1e-10
"""A column of which less than this is its own adds nothing to those before it: its coefficient is 0, as in Excel."""


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """A plane of least squares and how well it fits.

    Attributes:
        slopes: coefficients of the variables, (n, p).
        intercept: (n,); 0 where the plane goes through 0.
        slope_spread: standard errors of the slopes, in units of the standard error of y: (n, p).
        intercept_spread: the same for the intercept, (n,).
        regression: sum of the squares that the plane explains, (n,).
        residual: sum of the squares left, (n,).
        used: how many variables are not sums of others, (n,).
        freedom: degrees of freedom left, (n,).
    """

    slopes: Floats
    intercept: Floats
    slope_spread: Floats
    intercept_spread: Floats
    regression: Floats
    residual: Floats
    used: Floats
    freedom: Floats

    def at(self, x: Floats) -> Floats:
        """The plane at new observations: (n, m, p) -> (n, m)."""
        result = self.intercept[:, None] + np.zeros(x.shape[:2])
        for j in range(x.shape[2]):
            result = result + self.slopes[:, j, None] * x[:, :, j]
        return result


def fit(y: Floats, x: Floats, free: Bools) -> Fit:
    """The plane through observations y (n, m) at x (n, m, p); with an intercept where `free` (n,), else through 0."""
    m = y.shape[1]
    mean_y, centred = _about_the_mean(y, free)
    means, columns = zip(*(_about_the_mean(x[:, :, j], free) for j in range(x.shape[2])), strict=True)
    frame = _orthogonal(columns)
    slopes = frame.solved(centred)
    rest = frame.residual(centred, slopes)
    slopes = [a + b for a, b in zip(slopes, frame.solved(rest), strict=True)]
    rest = frame.residual(centred, slopes)
    inverse = frame.inverse()
    leverage = [sum(mean * row[j] for mean, row in zip(means, inverse, strict=True)) for j in range(len(means))]
    used = np.stack(frame.kept).sum(axis=0).astype(np.float64)
    return Fit(
        _side_by_side(slopes),
        mean_y - sum(slope * mean for slope, mean in zip(slopes, means, strict=True)),
        _side_by_side([np.sqrt(sum(part * part for part in row)) for row in inverse]),
        np.sqrt(1 / m + sum(part * part for part in leverage)),
        row_sums((centred - rest) * (centred - rest)),
        row_sums(rest * rest),
        used,
        m - used - free,
    )


def _about_the_mean(x: Floats, free: Bools) -> tuple[Floats, Floats]:
    """The mean of each row and the distances from it, or 0 and the row where not `free`: (n, m) -> (n,), (n, m)."""
    mean, distance, _ = mean_of(x, np.ones(x.shape, bool))
    return np.where(free, mean, 0.0), np.where(free[:, None], distance, x)


def _side_by_side(columns: Sequence[Floats]) -> Floats:
    return np.stack(np.broadcast_arrays(*columns), axis=1)


@dataclass(frozen=True, slots=True, eq=False)
class _Frame:
    """Columns as sums of orthogonal ones: column j is the sum over i <= j of part[i][j] times direction i.

    Attributes:
        columns: as they were given, p of (n, m).
        directions: of length 1, or 0 where the column depends on those before it; p of (n, m).
        parts: an upper triangle of (n,); 1 on its diagonal for a column that depends on others.
        kept: whether a column does not depend on others, p of (n,).
    """

    columns: Sequence[Floats]
    directions: list[Floats]
    parts: list[list[Floats]]
    kept: list[Bools]

    def solved(self, y: Floats) -> list[Floats]:
        """Coefficients of the columns that come closest to y: (n, m) -> p of (n,)."""
        p = len(self.columns)
        found: list[Floats] = [np.zeros(1)] * p
        for i in reversed(range(p)):
            total = row_sums(self.directions[i] * y)
            for j in range(i + 1, p):
                total = total - self.parts[i][j] * found[j]
            found[i] = np.where(self.kept[i], total / self.parts[i][i], 0.0)
        return found

    def residual(self, y: Floats, slopes: list[Floats]) -> Floats:
        """What of y the columns with these coefficients leave: (n, m)."""
        for slope, column in zip(slopes, self.columns, strict=True):
            y = y - slope[:, None] * column
        return y

    def inverse(self) -> list[list[Floats]]:
        """The inverse of the triangle, 0 for what depends on others: p rows of p (n,)."""
        p = len(self.columns)
        rows: list[list[Floats]] = [[np.zeros(1)] * p for _ in range(p)]
        for j in range(p):
            for i in reversed(range(j + 1)):
                total = np.asarray(float(i == j)) - sum(self.parts[i][h] * rows[h][j] for h in range(i + 1, j + 1))
                rows[i][j] = np.where(self.kept[i] & self.kept[j], total / self.parts[i][i], 0.0)
        return rows


def _orthogonal(columns: Sequence[Floats]) -> _Frame:
    p = len(columns)
    directions: list[Floats] = []
    parts: list[list[Floats]] = [[np.zeros(1)] * p for _ in range(p)]
    kept: list[Bools] = []
    for j, column in enumerate(columns):
        rest = column
        for _ in range(2):
            for i, direction in enumerate(directions):
                part = row_sums(direction * rest)
                parts[i][j] = parts[i][j] + part
                rest = rest - part[:, None] * direction
        before, after = (np.sqrt(row_sums(each * each)) for each in (column, rest))
        own = after > _DEPENDENT * before
        parts[j][j] = np.where(own, after, 1.0)
        directions.append(np.where(own[:, None], rest / parts[j][j][:, None], 0.0))
        kept.append(own)
    return _Frame(columns, directions, parts, kept)
