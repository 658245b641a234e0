"""Several columns of measurements at once: the best family of each, how they hang together, and how sure that is.

What stands in one row was measured together. The rank correlation of two columns comes from the rows in which both have
a value. Of each pair the copula is given that describes their ranks best: its likelihood is that of the ranks, divided
by one more than their number (Genest, Ghoudi and Rivest 1995, "A semiparametric estimation procedure of dependence
parameters in multivariate families of distributions", Biometrika 82).

How uncertain parameters are, and how they hang together, comes from a bootstrap: whole rows are drawn with
replacement, and the same families fitted to them again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.fitting.candidate import Unfit
from xlmc.analysis.studies.fitting.fit import KINDS, Fitted, Fitting, fit
from xlmc.errors import SimulationError
from xlmc.montecarlo.statistics import Estimate, proportion, rank_correlation

__all__ = ["BOOTSTRAPS", "ColumnFit", "CopulaFit", "Fits", "PairFit", "fit_columns"]

Floats = NDArray[np.float64]
Cells = Sequence[float | str | None]

BOOTSTRAPS: Final = 400
_SEED: Final = 999
_FEWEST_PAIRS: Final = 10
_LEAST_REPEATED: Final = 0.9
"""The share of the bootstrap's samples that a family must be fitted to, so that its parameters are given."""


@dataclass(frozen=True, slots=True)
class ColumnFit:
    """What was found of one column.

    Attributes:
        name: its heading.
        values: `(n,)` its numbers, in the order of the rows; empty where it holds texts.
        fitting: of the numbers; None of a column of texts, or one that cannot be fitted.
        shares: of a column of texts, text -> its share, the most frequent first.
        why: it could not be fitted; empty where it could.
        repeated: heading of a parameter of the best family -> `(b,)` its values in the bootstrap; empty without one.
    """

    name: str
    values: Floats
    fitting: Fitting | None
    shares: Mapping[str, Estimate]
    why: str = ""
    repeated: Mapping[str, Floats] | None = None

    @property
    def best(self) -> Fitted | None:
        """The family that describes it best."""
        return None if self.fitting is None else self.fitting.fits[0]


@dataclass(frozen=True, slots=True)
class CopulaFit:
    """A copula fitted to the ranks of two columns; `turned` where the second one's ranks were turned over."""

    name: str
    parameters: Mapping[str, float]
    aic: float
    turned: bool = False


@dataclass(frozen=True, slots=True)
class PairFit:
    """Two columns.

    Attributes:
        n: rows in which both have a number.
        correlation: of their ranks.
        copulas: the best first; that of independence is among them.
    """

    first: str
    second: str
    n: int
    correlation: Estimate
    copulas: tuple[CopulaFit, ...]


@dataclass(frozen=True, slots=True)
class Fits:
    """All columns, and all pairs of those that hold numbers and were fitted."""

    columns: tuple[ColumnFit, ...]
    pairs: tuple[PairFit, ...]


def fit_columns(
    columns: Mapping[str, Cells], *, kind: str | None = None, by: str = "aic", bootstraps: int = 0, seed: int = _SEED
) -> Fits:
    """Fit every column of a table.

    Args:
        columns: heading -> its cells, all of one length: numbers, texts, and None for blank ones. A column with a
            text is one of texts.
        kind: as for `fit`.
        by: as for `fit`.
        bootstraps: samples of the bootstrap; 0 for none.
        seed: of the bootstrap.

    Raises:
        SimulationError: the columns are of different lengths, or none can be fitted.
    """
    if len({len(cells) for cells in columns.values()}) > 1:
        raise SimulationError("The columns are of different lengths", hint="Give one value, or None, for every row")
    fits = [_column(name, cells, kind, by) for name, cells in columns.items()]
    if all(each.fitting is None and not each.shares for each in fits):
        why = "; ".join(f"{each.name}: {each.why}" for each in fits) or "there is none"
        raise SimulationError(f"No column can be fitted: {why}", hint="Give columns with two different values or more")
    table = {each.name: _numbers(columns[each.name]) for each in fits if each.fitting is not None}
    if bootstraps:
        fits = _with_bootstrap(fits, table, bootstraps, seed)
    pairs = tuple(_pair(a, b, table[a], table[b]) for a, b in combinations(table, 2))
    return Fits(tuple(fits), tuple(each for each in pairs if each is not None))


def _numbers(cells: Cells) -> Floats:
    """Return the cells as numbers, `(rows,)`; NaN for blank ones."""
    return np.array([math.nan if each is None else float(each) for each in cells], np.float64)


def _column(name: str, cells: Cells, kind: str | None, by: str) -> ColumnFit:
    known = [each for each in cells if each is not None]
    if any(isinstance(each, str) for each in known):
        texts = [each if isinstance(each, str) else f"{each:g}" for each in known]
        counts = {text: texts.count(text) for text in dict.fromkeys(texts)}
        ordered = sorted(counts, key=lambda text: -counts[text])
        return ColumnFit(name, np.empty(0), None, {text: proportion(counts[text], len(texts)) for text in ordered})
    values = np.array(known, np.float64)
    try:
        return ColumnFit(name, values, fit(values, kind=kind, by=by), {})
    except SimulationError as error:
        return ColumnFit(name, values, None, {}, error.message)


def _with_bootstrap(
    fits: Sequence[ColumnFit], table: Mapping[str, Floats], bootstraps: int, seed: int
) -> list[ColumnFit]:
    """Fit the best families again to rows drawn with replacement, the same rows of all columns."""
    rows = len(next(iter(table.values())))
    rng = np.random.default_rng(seed)
    drawn = rng.integers(rows, size=(bootstraps, rows))
    again = {}
    for each in fits:
        if each.fitting is not None:
            best = each.fitting.fits[0]
            candidate = next(c for c in KINDS[each.fitting.kind] if c.name == best.name)
            repeated = np.full((bootstraps, len(candidate.headings)), np.nan)
            for number, sample in enumerate(drawn):
                x = table[each.name][sample]
                x = np.sort(x[~np.isnan(x)])
                try:
                    with np.errstate(all="ignore"):
                        if x.size > 1 and x[0] < x[-1]:
                            repeated[number] = candidate.estimate(x)
                except (Unfit, ArithmeticError):
                    continue
            whole = np.isfinite(repeated).all(axis=1)
            again[each.name] = (repeated, whole, candidate.headings, best.fixed)
    kept = np.logical_and.reduce([whole for _, whole, *_ in again.values()])
    enough = kept.mean() >= _LEAST_REPEATED
    result = []
    for each in fits:
        if each.name not in again or not enough:
            result.append(each)
            continue
        repeated, _, headings, fixed = again[each.name]
        named = {h: repeated[kept, at] for at, h in enumerate(headings) if h not in fixed}
        result.append(ColumnFit(each.name, each.values, each.fitting, each.shares, each.why, named))
    return result


def _pair(first: str, second: str, x: Floats, y: Floats) -> PairFit | None:
    both = ~(np.isnan(x) | np.isnan(y))
    n = int(np.count_nonzero(both))
    if n < _FEWEST_PAIRS:
        return None
    x, y = x[both], y[both]
    estimate = rank_correlation(x, y)
    if math.isnan(estimate.value):
        return None
    return PairFit(first, second, n, estimate, tuple(_copulas(_ranks(x), _ranks(y), estimate.value)))


def _ranks(x: Floats) -> Floats:
    """Return the ranks `(n,)` of values, divided by n + 1; those of equal values are their mean."""
    _, where, counts = np.unique(x, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - (counts - 1.0) / 2.0)[where] / (x.size + 1.0))


def _copulas(u: Floats, v: Floats, correlation: float) -> list[CopulaFit]:
    """Fit each copula to ranks `(n,)`; those that know no negative dependence to the second one's turned over."""
    from scipy.optimize import minimize, minimize_scalar

    turned = correlation < 0.0
    w = 1.0 - v if turned else v
    fits = [CopulaFit("independent", {}, 0.0)]

    def best(
        density: Callable[[Floats, Floats, float], Floats], at: Floats, low: float, high: float
    ) -> tuple[float, float]:
        result = minimize_scalar(lambda p: -float(density(u, at, p).sum()), bounds=(low, high), method="bounded")
        return float(result.x), 2.0 + 2.0 * float(result.fun)

    rho, aic = best(_gaussian, v, -0.999, 0.999)
    fits.append(CopulaFit("Gaussian", {"correlation": rho}, aic))
    result = minimize(
        lambda p: -float(_student(u, v, math.tanh(p[0]), 2.0 + math.exp(p[1])).sum()),
        [math.atanh(rho), math.log(6.0)],
        method="Nelder-Mead",
    )
    degrees = 2.0 + math.exp(result.x[1])
    fits.append(
        CopulaFit("t", {"correlation": math.tanh(result.x[0]), "degrees of freedom": degrees}, 4.0 + 2.0 * result.fun)
    )
    for name, density, low, high in (("Clayton", _clayton, 1e-3, 30.0), ("Gumbel", _gumbel, 1.0, 30.0)):
        theta, aic = best(density, w, low, high)
        fits.append(CopulaFit(name, {"theta": theta}, aic, turned))
    theta, aic = best(_frank, w, 1e-3, 30.0)
    fits.append(CopulaFit("Frank", {"theta": theta}, aic, turned))
    return sorted((each for each in fits if math.isfinite(each.aic)), key=lambda each: each.aic)


def _gaussian(u: Floats, v: Floats, rho: float) -> Floats:
    from scipy.special import ndtri

    x, y = ndtri(u), ndtri(v)
    one = 1.0 - rho * rho
    return np.asarray(-0.5 * math.log(one) - (rho * rho * (x * x + y * y) - 2.0 * rho * x * y) / (2.0 * one))


def _student(u: Floats, v: Floats, rho: float, degrees: float) -> Floats:
    from scipy.special import gammaln, stdtrit

    x, y = stdtrit(degrees, u), stdtrit(degrees, v)
    one = 1.0 - rho * rho
    if one <= 0.0 or degrees > 1e4:
        return _gaussian(u, v, math.copysign(min(abs(rho), 0.999999), rho))
    constant = gammaln(degrees / 2 + 1) + gammaln(degrees / 2) - 2 * gammaln((degrees + 1) / 2) - 0.5 * math.log(one)
    joint = -(degrees / 2 + 1) * np.log1p((x * x + y * y - 2 * rho * x * y) / (degrees * one))
    single = (degrees + 1) / 2 * (np.log1p(x * x / degrees) + np.log1p(y * y / degrees))
    return np.asarray(constant + joint + single)


def _clayton(u: Floats, v: Floats, theta: float) -> Floats:
    a, b = -theta * np.log(u), -theta * np.log(v)
    larger = np.maximum(a, b)
    total = larger + np.log(np.exp(a - larger) + np.exp(b - larger) - np.exp(-larger))
    return np.asarray(math.log1p(theta) - (1.0 + theta) * (np.log(u) + np.log(v)) - (2.0 + 1.0 / theta) * total)


def _gumbel(u: Floats, v: Floats, theta: float) -> Floats:
    x, y = -np.log(u), -np.log(v)
    a = np.exp(np.logaddexp(theta * np.log(x), theta * np.log(y)) / theta)
    inner = (theta - 1.0) * (np.log(x) + np.log(y)) + (1.0 - 2.0 * theta) * np.log(a) + np.log(a + theta - 1.0)
    return np.asarray(x + y - a + inner)


def _frank(u: Floats, v: Floats, theta: float) -> Floats:
    whole = -math.expm1(-theta)
    below = whole - np.expm1(-theta * u) * np.expm1(-theta * v)
    with np.errstate(divide="ignore"):
        return np.asarray(math.log(theta * whole) - theta * (u + v) - 2.0 * np.log(below))
