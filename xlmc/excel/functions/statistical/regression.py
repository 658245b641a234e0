"""LINEST and its kin: planes of least squares, each trial by itself, in logarithms for exponential curves.

Letters: n trials, m observations, p variables. If known y are a column, each column of known x is a variable; if they
are a row, each row is. With one variable, known x have the same size as known y.

The columns are made orthogonal one after the other (Gram-Schmidt, every column twice, which is as good as Householder's
reflections: Giraud, Langou & Rozložník 2005), and the solution is refined once by its own residuals. Sums run from left
to right: a trial has the same bits alone and among others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import error_where, first_error, first_error_in_row, require_same_in_all_trials
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.lookup.picked_cells import flatten_cells
from xlmc.excel.functions.registry import Anything, Arrays, Kind, Ranges, excel
from xlmc.excel.functions.samples import mean_of, row_sums
from xlmc.excel.functions.values import BLANK, ERROR, NA, NUM, NUMBER, Bools, Codes, Floats, Value, constant

__all__ = ["fit"]

_SETTING = Anything(default=None, ranges=Ranges.SINGLE)
_OPTIONS = (Arrays(default=None), _SETTING, _SETTING)


@dataclass(frozen=True, slots=True, eq=False)
class _Known:
    """Observations.

    Attributes:
        y: (n, m).
        x: (n, m, p).
        errors: the first error, or `#VALUE!` for what is not a number: (n,).
        in_row: whether the observations stand in a row.
        shape: rows and columns of known y.
    """

    y: Floats
    x: Floats
    errors: Codes
    in_row: bool
    shape: tuple[int, ...]

    @property
    def has_several_variables(self) -> bool:
        return bool(self.x.shape[2] > 1)


def _none_if_blank(value: Value | None) -> Value | None:
    """Return the argument; None if it is left out, or left empty between commas."""
    if value is None or value.numbers.ndim == 3:
        return value
    return None if require_same_in_all_trials(value.kinds == BLANK) else value


def _numbers(value: Value) -> tuple[Floats, Codes]:
    """Return a range all of numbers (n, r, c), and its first error: (n,)."""
    cells = value.as_range()
    kinds = flatten_cells(cells.kinds, cells)
    wrong = error_where((kinds != NUMBER) & (kinds < ERROR), ErrorCode.VALUE)
    return np.broadcast_to(cells.numbers, cells.shape), first_error_in_row(
        first_error(flatten_cells(cells.errors, cells), wrong)
    )


def _read_known(ys: Value, xs: Value | None) -> _Known | None:
    """Return the observations; None if the sizes of y and x do not go together. Without x it is 1, 2, 3, …"""
    y, wrong_y = _numbers(ys)
    shape = y.shape[1:]
    if (given := _none_if_blank(xs)) is None:
        count = np.arange(1.0, y[0].size + 1).reshape(1, *shape)
        x, wrong_x = count, np.zeros(1, np.uint8)
    else:
        x, wrong_x = _numbers(given)
    in_row = shape[0] == 1 and shape[1] > 1
    variables = _variables(x, in_row, shape)
    if variables is None:
        return None
    return _Known(y.reshape(y.shape[0], -1), variables, first_error(wrong_y, wrong_x), in_row, shape)


def _variables(x: Floats, in_row: bool, shape: tuple[int, ...]) -> Floats | None:
    """Known x as (n, m, p)."""
    if x.shape[1:] == shape:
        return x.reshape(x.shape[0], -1, 1)
    turned = x.swapaxes(1, 2) if in_row else x
    fits = 1 in shape and turned.shape[1] == max(shape)
    return turned if fits else None


def _read_condition(value: Value | None, otherwise: bool) -> tuple[Bools, Codes]:
    """Return a condition that may be left out: (n,) each."""
    if value is None:
        return np.full(1, otherwise), np.zeros(1, np.uint8)
    truth, errors = value.to_logicals()
    truth = np.where((value.kinds == BLANK) & (value.numbers.ndim == 1), otherwise, truth)
    return flatten_cells(truth, value)[:, 0], flatten_cells(errors, value)[:, 0]


def _logarithms(known: _Known) -> _Known:
    """Return the observations of ln y; `#NUM!` where some y is not above 0."""
    positive = np.asarray(known.y > 0)
    errors = first_error(known.errors, error_where(np.asarray((known.y <= 0).any(axis=1)), ErrorCode.NUM))
    return _Known(np.log(np.where(positive, known.y, 1.0)), known.x, errors, known.in_row, known.shape)


def _ratio(above: Floats, below: Floats) -> Floats:
    return np.where(below > 0, above / np.where(below > 0, below, 1.0), NUM)


def _coefficients(results: _Fit, *, exponential: bool) -> Floats:
    """Return the coefficients, that of the last variable first, then the intercept: (n, p + 1)."""
    result = np.concatenate([results.slopes[:, ::-1], results.intercept[:, None]], axis=1)
    return np.exp(result) if exponential else result


def _table(result: _Fit, free: Bools, first: Floats) -> Floats:
    """Return the five rows of LINEST under the first: (n, 5, p + 1)."""
    n = max(first.shape[0], free.shape[0])
    table = np.full((n, 5, first.shape[1]), NA)
    left = result.freedom > 0
    variance = np.where(left, result.residual / np.where(left, result.freedom, 1.0), 0.0)
    error = np.sqrt(variance)
    table[:, 0] = first
    table[:, 1, :-1] = (result.slope_spread * error[:, None])[:, ::-1]
    table[:, 1, -1] = np.where(free, result.intercept_spread * error, NA)
    table[:, 2, 0], table[:, 2, 1] = _ratio(result.regression, result.regression + result.residual), error
    table[:, 3, 0] = _ratio(result.regression, np.where(left, result.used * variance, 0.0))
    table[:, 3, 1] = np.maximum(result.freedom, 0.0)
    table[:, 4, 0], table[:, 4, 1] = result.regression, result.residual
    return table


def _estimate(known: _Known | None, const: Value | None, stats: Value | None, *, exponential: bool) -> Value:
    if known is None:
        return constant(ErrorCode.REF)
    known = _logarithms(known) if exponential else known
    (free, wrong), (whole, wrong_too) = _read_condition(const, True), _read_condition(stats, False)
    results = fit(known.y, known.x, free)
    first = _coefficients(results, exponential=exponential)
    in_full = bool(require_same_in_all_trials(whole))
    result = _table(results, free, first) if in_full else first[:, None, :]
    return Value.of_numbers(result, first_error(known.errors, wrong, wrong_too)[:, None, None])


@excel("LINEST", Arrays, *_OPTIONS, returns=Kind.ANY, facts=Facts(spills=True))
def linest(ys: Value, xs: Value | None = None, const: Value | None = None, stats: Value | None = None) -> Value:
    """Coefficients of the plane of least squares, the last variable's first: (n, 1, p + 1), with `stats` (n, 5, p + 1).

    The rows are: coefficients; their standard errors; r² and the standard error of y; F and the degrees of freedom; the
    sums of squares explained and left. A variable that is a sum of others gets 0. `#REF!` for sizes that do not fit.

    Raises:
        ShapeVaries: `stats` differs between trials.
    """
    return _estimate(_read_known(ys, xs), const, stats, exponential=False)


@excel("LOGEST", Arrays, *_OPTIONS, returns=Kind.ANY, facts=Facts(spills=True))
def logest(ys: Value, xs: Value | None = None, const: Value | None = None, stats: Value | None = None) -> Value:
    """Bases of the exponential curve b·m₁^x₁·m₂^x₂…, as LINEST of ln y gives it; the statistics are those of ln y.

    Raises:
        ShapeVaries: `stats` differs between trials.
    """
    return _estimate(_read_known(ys, xs), const, stats, exponential=True)


def _read_new(known: _Known, xs: Value | None, new: Value | None) -> tuple[Floats, Codes, tuple[int, ...]] | None:
    """Return new observations (n, m, p), their errors, and rows and columns of the result; None if they do not fit."""
    given = _none_if_blank(new)
    if given is None:
        return known.x, np.zeros(1, np.uint8), known.shape
    x, errors = _numbers(given)
    if not known.has_several_variables:
        return x.reshape(x.shape[0], -1, 1), errors, x.shape[1:]
    turned = x.swapaxes(1, 2) if known.in_row else x
    if turned.shape[2] != known.x.shape[2]:
        return None
    m = turned.shape[1]
    return turned, errors, (1, m) if known.in_row else (m, 1)


def _predict(ys: Value, xs: Value | None, new: Value | None, const: Value | None, *, exponential: bool) -> Value:
    known = _read_known(ys, xs)
    result = None if known is None else _read_new(known, xs, new)
    if known is None or result is None:
        return constant(ErrorCode.REF)
    known = _logarithms(known) if exponential else known
    x, wrong_x, shape = result
    free, wrong = _read_condition(const, True)
    y = fit(known.y, known.x, free).at(x)
    y = np.exp(y) if exponential else y
    return Value.of_numbers(y.reshape(y.shape[0], *shape), first_error(known.errors, wrong_x, wrong)[:, None, None])


_NEW = (Arrays(default=None), Arrays(default=None), _SETTING)


@excel("TREND", Arrays, *_NEW, returns=Kind.ANY, facts=Facts(spills=True))
def trend(ys: Value, xs: Value | None = None, new: Value | None = None, const: Value | None = None) -> Value:
    """Return the plane of least squares at new x, or at the known ones: (n, rows, columns of these).

    `#REF!` for sizes that do not go together.
    """
    return _predict(ys, xs, new, const, exponential=False)


@excel("GROWTH", Arrays, *_NEW, returns=Kind.ANY, facts=Facts(spills=True))
def growth(ys: Value, xs: Value | None = None, new: Value | None = None, const: Value | None = None) -> Value:
    """Return the exponential curve of LOGEST at new x, or at the known ones; `#NUM!` where some y is not above 0."""
    return _predict(ys, xs, new, const, exponential=True)


_DEPENDENT: Final = 1e-10
"""A column that differs from a sum of those before it by less than this share gets the coefficient 0, as in Excel."""


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
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
        """Return the plane at new observations: (n, m, p) -> (n, m)."""
        result = self.intercept[:, None] + np.zeros(x.shape[:2])
        for j in range(x.shape[2]):
            result = result + self.slopes[:, j, None] * x[:, :, j]
        return result


def fit(y: Floats, x: Floats, free: Bools) -> _Fit:
    """Fit a plane to observations y (n, m) at x (n, m, p); with an intercept where `free` (n,), else through 0."""
    m = y.shape[1]
    mean_y, centred = _centre(y, free)
    means, columns = zip(*(_centre(x[:, :, j], free) for j in range(x.shape[2])), strict=True)
    frame = _orthogonalize(columns)
    slopes = frame.solve(centred)
    rest = frame.residual(centred, slopes)
    slopes = [a + b for a, b in zip(slopes, frame.solve(rest), strict=True)]
    rest = frame.residual(centred, slopes)
    inverse = frame.inverse()
    leverage = [sum(mean * row[j] for mean, row in zip(means, inverse, strict=True)) for j in range(len(means))]
    used = np.stack(frame.independent).sum(axis=0).astype(np.float64)
    return _Fit(
        _side_by_side(slopes),
        mean_y - sum(slope * mean for slope, mean in zip(slopes, means, strict=True)),
        _side_by_side([np.sqrt(sum(part * part for part in row)) for row in inverse]),
        np.sqrt(1 / m + sum(part * part for part in leverage)),
        row_sums((centred - rest) * (centred - rest)),
        row_sums(rest * rest),
        used,
        m - used - free,
    )


def _centre(x: Floats, free: Bools) -> tuple[Floats, Floats]:
    """Return the mean of each row and the distances from it, or 0 and the row where not `free`: (n, m) ->
    (n,), (n, m).
    """
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
        independent: whether a column does not depend on others, p of (n,).
    """

    columns: Sequence[Floats]
    directions: list[Floats]
    parts: list[list[Floats]]
    independent: list[Bools]

    def solve(self, y: Floats) -> list[Floats]:
        """Find the coefficients with which the columns come closest to y: (n, m) -> p of (n,)."""
        p = len(self.columns)
        result: list[Floats] = [np.zeros(1)] * p
        for i in reversed(range(p)):
            total = row_sums(self.directions[i] * y)
            for j in range(i + 1, p):
                total = total - self.parts[i][j] * result[j]
            result[i] = np.where(self.independent[i], total / self.parts[i][i], 0.0)
        return result

    def residual(self, y: Floats, slopes: list[Floats]) -> Floats:
        """Return what remains of y without the columns times these coefficients: (n, m)."""
        for slope, column in zip(slopes, self.columns, strict=True):
            y = y - slope[:, None] * column
        return y

    def inverse(self) -> list[list[Floats]]:
        """Return the inverse of the triangle, 0 for what depends on others: p rows of p (n,)."""
        p = len(self.columns)
        rows: list[list[Floats]] = [[np.zeros(1)] * p for _ in range(p)]
        for j in range(p):
            for i in reversed(range(j + 1)):
                total = np.asarray(float(i == j)) - sum(self.parts[i][h] * rows[h][j] for h in range(i + 1, j + 1))
                rows[i][j] = np.where(self.independent[i] & self.independent[j], total / self.parts[i][i], 0.0)
        return rows


def _orthogonalize(columns: Sequence[Floats]) -> _Frame:
    p = len(columns)
    directions: list[Floats] = []
    parts: list[list[Floats]] = [[np.zeros(1)] * p for _ in range(p)]
    independent: list[Bools] = []
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
        independent.append(own)
    return _Frame(columns, directions, parts, independent)
