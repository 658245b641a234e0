"""Compound: the sum of a random number of random amounts, such as the claims of a year.

A draw is made of one uniform u, as any other: u gives the number of amounts, by its quantile function, and the bits of
u are the seed of a generator that gives the amounts. So a draw depends on u alone, whatever block or thread it is made
in, and the same number of amounts comes of the same rank. The generator is SplitMix64.

There is no formula for the distribution function of such a sum, and so no cutoffs. Mean and variance are exact:
E[S] = E[N]·E[Y] and Var[S] = E[N]·Var[Y] + Var[N]·E[Y]², with Y what is left of an amount after deductible and limit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.base import LARGEST, Array, Family, Member, Values
from xlmc.montecarlo.distributions.parameters import Fault, ParameterSpec, show
from xlmc.montecarlo.distributions.quadrature import gauss_legendre
from xlmc.montecarlo.distributions.split_mix import GOLDEN, mixed
from xlmc.montecarlo.distributions.truncated import Slice, Truncated
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = ["Compound", "Part"]

_MOST: Final = 1_000_000
"""The most amounts of one draw."""

_TOGETHER: Final = 1 << 19
"""Amounts that are drawn at a time, so that memory stays small."""

_NODES: Final = 512
_SAMPLE: Final = 1 << 16
"""Draws that percentiles are taken from: their probability is right to 0.2 % (one standard error)."""


@dataclass(frozen=True, slots=True)
class Part:
    """The number of amounts, or the amounts: a distribution within the compound, or a value of each trial.

    Attributes:
        name: what its parameters begin with.
        family: None for a value, which is then its one parameter.
        lower, upper: whether it has these cutoffs.
        shifted: whether something is added to each draw.
    """

    name: str
    family: Family | None = None
    lower: bool = False
    upper: bool = False
    shifted: bool = False

    @property
    def parameters(self) -> tuple[ParameterSpec, ...]:
        """The parameters of both distributions, with the name of each in front."""
        if self.family is None:
            return (self._spec("", self.name.capitalize()),)
        named = f"{self.name.capitalize()} ({self.family.name})"
        result = [self._spec(spec.key, f"{named}: {spec.heading}") for spec in self.family.parameters]
        for given, key, heading in (
            (self.lower, "lower cutoff", "lower cutoff"),
            (self.upper, "upper cutoff", "upper cutoff"),
            (self.shifted, "shift", "shift"),
        ):
            result += [self._spec(key, f"{named}: {heading}")] * given
        return tuple(result)

    def _spec(self, key: str, heading: str) -> ParameterSpec:
        return ParameterSpec(f"{self.name} {key}".strip(), (heading,))

    def _split(self, values: Sequence[Any]) -> tuple[Sequence[Any], Any, Any, Any]:
        """List the family's own parameters, both cutoffs, the shift."""
        assert self.family is not None
        rest = iter(values[len(self.family.parameters) :])
        lower = next(rest) if self.lower else -np.inf
        upper = next(rest) if self.upper else np.inf
        return values[: len(self.family.parameters)], lower, upper, next(rest) if self.shifted else 0.0

    def fault(self, values: Sequence[float]) -> Fault | None:
        """Say what is wrong with numbers for its parameters."""
        if self.family is None:
            return None
        own, lower, upper, _ = self._split(values)
        cut = self.lower or self.upper
        fault = Truncated(self.family).fault(lower, upper, *own) if cut else self.family.fault(*own)
        if fault is None:
            return None
        key = {"lower_cutoff": "lower cutoff", "upper_cutoff": "upper cutoff"}.get(fault.key, fault.key)
        return Fault(f"{self.name} {key}", f"{self.name.capitalize()}: {fault.message}", fault.hint)

    def valid(self, values: Sequence[Values]) -> Any:
        """Where its parameters keep every rule."""
        if self.family is None:
            return True
        own, lower, upper, _ = self._split(values)
        return self.family.valid(*own) & np.less(lower, upper)

    def ppf(self, u: Array, values: Sequence[Values]) -> Array:
        """Draws, from uniforms `(n,)`."""
        if self.family is None:
            return np.asarray(values[0] + 0 * u)
        own, lower, upper, shift = self._split(values)
        if not (self.lower or self.upper):
            return np.asarray(self.family.ppf(u, *own) + shift)
        return np.asarray(Truncated(self.family).ppf(u, lower, upper, *own) + shift)

    def moments(self, values: Sequence[float], deductible: float, limit: float) -> tuple[float, float]:
        """Mean and variance of what is left after a deductible and a limit, of numbers."""
        if self.family is None:
            return float(_left(np.asarray(values[0], dtype=float), deductible, limit)), 0.0
        own, lower, upper, shift = self._split(values)
        if not (self.lower or self.upper or np.isfinite(deductible) or np.isfinite(limit)):
            return float(self.family.mean(*own)) + shift, float(self.family.variance(*own))
        whole = Member(self.family, tuple(own))
        cut = Slice(whole, lower, upper) if self.lower or self.upper else whole
        kinks = [float(cut.cdf(end - shift)) for end in _kinks(deductible, limit)]
        edges = np.unique(np.clip([0.0, *kinks, 0.5, 0.99, 0.9999, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12], 0.0, 1 - 1e-12))
        nodes, weights = gauss_legendre(_NODES)
        first = second = 0.0
        for low, high in pairwise(edges.tolist()):
            x = _left(cut.ppf(low + (high - low) * (nodes + 1) / 2) + shift, deductible, limit)
            first += float(weights @ x) * (high - low) / 2
            second += float(weights @ x**2) * (high - low) / 2
        return first, max(second - first**2, 0.0)

    def count_moments(self, values: Sequence[float]) -> tuple[float, float]:
        """Mean and variance of the whole number of amounts, of numbers."""
        if self.family is None:
            return float(_counts(np.asarray(values[0], dtype=float))), 0.0
        if isinstance(self.family, WholeNumbers) and not (self.lower or self.upper or self.shifted):
            return float(self.family.mean(*values)), float(self.family.variance(*values))
        u = (np.arange(_SAMPLE) + 0.5) / _SAMPLE
        counts = _counts(self.ppf(u, values))
        return float(counts.mean()), float(counts.var())


def _kinks(deductible: float, limit: float) -> Iterator[float]:
    """Return the amounts at which what is left of them bends."""
    if np.isfinite(deductible):
        yield deductible
    if np.isfinite(limit):
        yield limit + (deductible if np.isfinite(deductible) else 0.0)


def _left(amounts: Array, deductible: Any, limit: Any) -> Array:
    """Return what is left of amounts; -inf for no deductible, inf for no limit."""
    with np.errstate(invalid="ignore"):
        rest = np.where(np.isfinite(deductible), np.maximum(amounts - deductible, 0.0), amounts)
    return np.asarray(np.minimum(rest, limit))


def _counts(numbers: Array) -> NDArray[np.int64]:
    """Whole numbers of amounts: the fraction is cut off, and none is below 0."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.clip(np.nan_to_num(numbers, nan=0.0), 0.0, _MOST).astype(np.int64))


class Compound(Family):
    """The sum of a random number of independent amounts, each less a deductible and up to a limit.

    Args:
        count: how many there are; fractions are cut off.
        amount: what each is.
        deductible, limit: whether there are any; from an amount at least 0 is left then.

    >>> from xlmc.montecarlo.distributions.exponential import Exponential
    >>> from xlmc.montecarlo.distributions.poisson import Poisson
    >>> claims = Compound(Part("frequency", Poisson()), Part("severity", Exponential()))
    >>> claims.keys
    ('frequency rate', 'severity rate')
    >>> print(claims.mean(3.0, 0.1), claims.variance(3.0, 0.1).round(9))
    30.0 600.0
    >>> claims.check(3.0, 0.0)
    'Severity: Rate (0) must be above 0'
    """

    name = "Compound"
    parameters: tuple[ParameterSpec, ...] = ()
    truncates = False
    formula = "the sum of as many independent amounts as a count says"
    source = "@RISK's manual, Compound; Klugman, Panjer and Willmot, Loss Models (2012), ch. 9"
    elsewhere = ("@RISK Compound(frequency, severity, deductible, limit)",)

    def __init__(self, count: Part, amount: Part, deductible: bool = False, limit: bool = False) -> None:
        self.count, self.amount = count, amount
        more = [ParameterSpec("deductible", ("Deductible",))] * deductible + [
            ParameterSpec("limit", ("Limit",))
        ] * limit
        self.parameters = (*count.parameters, *amount.parameters, *more)
        self._deducts, self._limits = deductible, limit
        searched = (part.family.given_by for part in (count, amount) if part.family is not None)
        self.given_by = next((each for each in searched if each), "")

    def __reduce__(self) -> tuple[Any, ...]:
        return Compound, (self.count, self.amount, self._deducts, self._limits)

    def _split(self, values: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Any], Any, Any]:
        first, second = len(self.count.parameters), len(self.count.parameters) + len(self.amount.parameters)
        rest = iter(values[second:])
        deductible = next(rest) if self._deducts else -np.inf
        return values[:first], values[first:second], deductible, next(rest) if self._limits else np.inf

    def broken_rule(self, *values: float) -> Fault | None:
        """Return the first rule that these numbers break, if any."""
        if fault := super().broken_rule(*values):
            return fault
        counts, amounts, _, limit = self._split(values)
        if fault := self.count.fault(counts) or self.amount.fault(amounts):
            return fault
        if not limit >= 0:
            return Fault("limit", f"Limit ({show(limit)}) must be 0 or more", "Correct the number")
        most = float(self.count.ppf(np.array([1 - 2.0**-53]), counts)[0])
        if not most <= _MOST:
            counted = f"{self.count.name.capitalize()} may be {number_text(most)}"
            message = f"{counted}, and at most {count_text(_MOST)} amounts are added"
            hint = "Draw the sum of so many amounts from a normal distribution"
            return Fault(self.count.parameters[0].key, message, hint)
        return None

    def valid(self, *params: Values, **named: Values) -> Any:
        """Where the parameters keep every rule."""
        values = self.bind(params, named)
        counts, amounts, _, limit = self._split(values)
        valid_here: Any = self.count.valid(counts) & self.amount.valid(amounts) & np.greater_equal(limit, 0)
        for value in values:
            valid_here = valid_here & (value >= -LARGEST) & (value <= LARGEST)
        return valid_here

    def _ppf(self, u: Array, *values: Values) -> Array:
        given, amounts, deductible, limit = self._split(values)
        counts = _counts(self.count.ppf(u, given)).ravel()
        seeds = mixed(np.ascontiguousarray(u, dtype=np.float64).ravel().view(np.uint64))
        columns = [np.broadcast_to(value, u.shape).ravel() if np.ndim(value) else value for value in amounts]
        ends = [np.broadcast_to(end, u.shape).ravel() if np.ndim(end) else end for end in (deductible, limit)]
        sums = np.zeros(counts.size)
        if self.amount.family is None:
            return np.asarray(_left(np.asarray(columns[0]), *ends) * counts).reshape(u.shape)
        for first, last in _pieces(counts):
            which = np.repeat(np.arange(first, last), counts[first:last])
            starts = np.cumsum(counts[first:last]) - counts[first:last]
            number = (np.arange(which.size) - np.repeat(starts, counts[first:last]) + 1).astype(np.uint64)
            uniforms = (mixed(seeds[which] + number * GOLDEN) >> np.uint64(11)).astype(np.float64) * 2.0**-53
            own = [column[which] if np.ndim(column) else column for column in columns]
            left = _left(self.amount.ppf(uniforms, own), *(end[which] if np.ndim(end) else end for end in ends))
            sums[first:last] = np.bincount(which - first, left, last - first)
        return sums.reshape(u.shape)

    def order(self, u: Array, *values: Values) -> Array:
        """Return the number of amounts: it is what ranks and correlations are about."""
        return _counts(self.count.ppf(u, self._split(values)[0])).astype(float)

    def percentile(self, p: Array, *values: Values) -> Array:
        """Return the percentile of many draws, which are always the same."""
        own = [np.asarray(value).ravel()[0] for value in values]
        drawn = self._ppf((np.arange(_SAMPLE) + 0.5) / _SAMPLE, *own)
        return np.asarray(np.quantile(drawn, p) if np.isfinite(drawn).all() else np.full(np.shape(p), np.nan))

    def _cdf(self, x: Values, *values: Values) -> Values:
        raise TypeError("a Compound has no formula for its distribution function")

    def _sf(self, x: Values, *values: Values) -> Values:
        raise TypeError("a Compound has no formula for its distribution function")

    def _isf(self, q: Array, *values: Values) -> Array:
        raise TypeError("a Compound has no formula for its distribution function")

    def _mean(self, *values: Values) -> Values:
        return self._each(values, 0)

    def _variance(self, *values: Values) -> Values:
        return self._each(values, 1)

    def _each(self, values: tuple[Values, ...], which: int) -> Values:
        """Mean or variance for each trial."""
        shape = np.broadcast_shapes(*map(np.shape, values))
        columns = [np.broadcast_to(value, shape).ravel().tolist() for value in values]
        result = [self._moments(*row)[which] for row in zip(*columns, strict=True)]
        return np.array(result).reshape(shape)

    def _moments(self, *values: float) -> tuple[float, float]:
        given, amounts, deductible, limit = self._split(values)
        mean, variance = self.count.count_moments(given)
        each, spread = self.amount.moments(amounts, deductible, limit)
        if self.amount.family is None:
            return mean * each, variance * each**2
        return mean * each, mean * spread + variance * each**2

    def _support(self, *values: Values) -> tuple[Values, Values]:
        shape = np.broadcast_shapes(*map(np.shape, values))
        return np.full(shape, -np.inf), np.full(shape, np.inf)


def _pieces(counts: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Trials, from one up to another, that have some amounts, and not many together."""
    totals = np.cumsum(counts)
    first, done = 0, 0
    while first < counts.size:
        last = max(first + 1, int(np.searchsorted(totals, done + _TOGETHER, side="right")))
        if totals[last - 1] > done:
            yield first, last
        first, done = last, int(totals[last - 1])
