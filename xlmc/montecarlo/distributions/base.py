"""What a family of distributions is: parameters by name, rules about them, and functions of arrays.

A family is one small class: its name, its parameters, the rules they must keep, and the hooks `_ppf`, `_cdf`, `_mean`,
`_variance`, `_support` and `_mirrored`, written for parameters that keep every rule. The public methods around them
accept parameters that vary by trial and give NaN in the trials where a rule is broken, without floating-point flags.

Shapes: `n` trials; `u`, `x` and each parameter are a number or `(n,)`, and broadcast.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.parameters import Constraint, DataSpec, Fault, ParameterSpec, Role, show

__all__ = ["LARGEST", "SMALLEST_U", "TRIED_U", "Array", "Family", "Member", "Values", "ends", "point_where", "share"]

Array = NDArray[np.float64]
Values = float | Array
"""A number, or one number for each trial, `(n,)`."""


SMALLEST_U = 2.0**-54
"""What u = 0 stands for where the quantile of 0 is infinite: half a step of the grid k·2^-53 that u comes from."""

LARGEST = 1e150
"""No parameter may be larger, so that squares and products of parameters stay finite."""


TRIED_U = (2.0**-80, SMALLEST_U, 1e-12, 1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999, 1 - 1e-12, 1 - 2.0**-53)
"""Probabilities at which quantiles are tried before a run. No sampling method asks for one beyond the first and the
last.
"""


class Family(ABC):
    """A family of distributions. The parameters of every method follow the order of `parameters`, or go by key.

    Attributes:
        name: as people see it, and as `FAMILIES` spells it.
        aliases: other names that people type.
        parameters: in the usual order.
        rules: what the parameters must keep.
        open_below: the quantile of 0 is minus infinity, so u = 0 is read as `SMALLEST_U`.
        always_finite: every draw is a finite number if the parameters keep every rule; otherwise draws are tried out.
        roles: of each parameter, so that percentiles may be given instead; empty where they may not.
        data: what a family that is built from data needs; None for one that has parameters alone.
        formula: its density, distribution or quantile function in the headings of its parameters, for people.
        source: where the formula is written down.
        elsewhere: what other programs call it, such as `@RISK Gamma(shape, scale)`.
        given_by: what its member is searched by, such as `percentiles`, which takes too long for each trial: a workbook
            may not let such parameters depend on an assumption. Empty where nothing is searched.
        truncates: whether it may have cutoffs.
    """

    name: str
    aliases: tuple[str, ...] = ()
    parameters: tuple[ParameterSpec, ...]
    rules: tuple[Constraint, ...] = ()
    open_below: bool = False
    always_finite: bool = False
    roles: tuple[Role, ...] = ()
    data: DataSpec | None = None
    formula: str = ""
    source: str = ""
    elsewhere: tuple[str, ...] = ()
    given_by: str = ""
    truncates: bool = True

    def __init_subclass__(cls) -> None:
        """Refuse a family whose upper tail nobody has written: cutoffs would meet it in the midst of a run.

        Raises:
            TypeError: it has neither `_mirrored` nor both `_sf` and `_isf`.
        """
        mirrored = cls._mirrored is not Family._mirrored
        if not mirrored and (cls._sf is Family._sf or cls._isf is Family._isf):
            raise TypeError(f"{cls.__name__} has no upper tail: write `_mirrored`, or both `_sf` and `_isf`")

    @property
    def keys(self) -> tuple[str, ...]:
        return tuple(spec.key for spec in self.parameters)

    def built(self, data: Array, **options: Any) -> Family:
        """Return the family of this name that belongs to these data; its parameters, if any, are still to be given.

        Args:
            data: `(rows, columns)`, NaN where a cell is blank.
            **options: those of `DataSpec.options` that are filled in.

        Raises:
            DataError: no distribution can be built from them.
        """
        raise TypeError(f"{self.name} is not built from data")

    def fault(self, *params: float, **named: float) -> Fault | None:
        """Return the first rule that these numbers break, if any, or that draws would be too large for a number."""
        return Member(self, self.bind(params, named)).fault()

    def overflow_fault(self, values: tuple[Any, ...], hint: str) -> Fault:
        """Say that draws would not be finite; it blames the parameter that bends the distribution most."""
        blame = {"shape": 0, "rate": 1, "log scale": 2, "scale": 3, "ordered": 4, "location": 5}
        roles = self.roles or ("location",) * len(values)
        spec, value, _ = min(zip(self.parameters, values, roles, strict=True), key=lambda each: blame[each[2]])
        message = f"{spec.heading} ({show(value)}) is too extreme: not all draws are numbers up to 1.8E308, the largest"
        return Fault(spec.key, message, hint)

    def broken_rule(self, *values: float) -> Fault | None:
        """Return the first rule that these numbers, one for each parameter, break, if any."""
        for spec, value in zip(self.parameters, values, strict=True):
            if not -LARGEST <= value <= LARGEST:
                message = f"{spec.heading} ({show(value)}) must be a number between -1E150 and 1E150"
                return Fault(spec.key, message, "Correct the number")
        if self.point(*values) is not None:
            return None
        for rule in self.rules:
            if not rule.holds(*values):
                shown = {key: show(value) for key, value in zip(self.keys, values, strict=True)}
                return Fault(rule.blames, rule.message.format(**shown), rule.hint)
        return None

    def check(self, *params: float, **named: float) -> str | None:
        """Say what is wrong with these numbers, in words; None when nothing is."""
        fault = self.fault(*params, **named)
        return None if fault is None else fault.message

    def valid(self, *params: Values, **named: Values) -> bool | NDArray[np.bool_]:
        """Where the parameters keep every rule: a logical, or one for each trial, `(n,)`."""
        values = self.bind(params, named)
        valid_here: Any = True
        for value in values:
            valid_here = valid_here & (value >= -LARGEST) & (value <= LARGEST)
        for rule in self.rules:
            valid_here = valid_here & rule.holds(*values)
        points = self.point(*values)
        return valid_here if points is None else valid_here | np.isfinite(points)  # type: ignore[no-any-return]  # as the values are

    def checked(self, *params: Values, **named: Values) -> Member:
        """Make the member of the family that has these parameters: they are checked here, and by none of its
        functions.
        """
        values = self.bind(params, named)
        valid = self.valid(*values)
        if valid is True or np.all(valid):
            return Member(self, values)
        return Member(self, tuple(np.where(valid, value, np.nan) for value in values), ~np.asarray(valid))

    def ppf(self, u: Values, *params: Values, out: Array | None = None, **named: Values) -> Array:
        """Quantiles of probabilities in [0, 1); NaN in trials with invalid parameters.

        Where parameters vary by trial, NaN too in the trials whose draw is too large for a number.

        Args:
            u: probabilities, a number or `(n,)`, drawn from the grid k·2^-53.
            *params: the parameters in order, or by key in `named`; each a number or `(n,)`.
            **named: the parameters by key.
            out: `(n,)`, filled with the result; may be `u` itself, and then no memory is needed for it.
        """
        return self.checked(*params, **named).ppf(u, out)

    def isf(self, q: Values, *params: Values, **named: Values) -> Array:
        """Return the values exceeded with probability q: `ppf(1 - q)` without the loss of digits for small q."""
        return self.checked(*params, **named).isf(q)

    def cdf(self, x: Values, *params: Values, **named: Values) -> Array:
        """P(X <= x), shapes as in `ppf`."""
        return self.checked(*params, **named).cdf(x)

    def sf(self, x: Values, *params: Values, **named: Values) -> Array:
        """P(X >= x), exact in the upper tail; differs from `1 - cdf` only where one value has a probability."""
        return self.checked(*params, **named).sf(x)

    def mean(self, *params: Values, **named: Values) -> Array:
        """Return the mean, `()` or `(n,)`."""
        return self.checked(*params, **named).mean()

    def variance(self, *params: Values, **named: Values) -> Array:
        """Return the variance, `()` or `(n,)`."""
        return self.checked(*params, **named).variance()

    def support(self, *params: Values, **named: Values) -> tuple[Array, Array]:
        """Return the lowest and the highest possible value, each `()` or `(n,)`; may be infinite."""
        return self.checked(*params, **named).support()

    def point(self, *values: Values) -> Values | None:
        """Return the one value that parameters without scatter leave, such as the mean of a standard deviation of 0.

        Programs that draw say of such a distribution that it is its one value.

        Args:
            *values: the parameters in order, each a number or `(n,)`.

        Returns:
            It, a number or `(n,)`, NaN in trials in which the draws scatter; None if they do in all.
        """
        if not self.roles or self.roles[0] != "location" or self.roles.count("scale") != 1:
            return None
        scale = self.roles.index("scale")
        if np.ndim(values[scale]) == 0 and values[scale] != 0.0:
            return None
        degenerate: Any = np.equal(values[scale], 0.0)
        for rule in self.rules:
            if rule.blames != self.keys[scale]:
                degenerate = degenerate & rule.holds(*values)
        return point_where(degenerate, values[0])

    def cutoffs(self, lower: Values, upper: Values) -> tuple[tuple[Values, Values], tuple[Values, Values]]:
        """Return what cutoffs, which are kept themselves, mean to the family.

        Returns:
            The lowest value kept and the highest below it; the highest value kept and the lowest above it. Where no
            single value has a probability, these are the cutoffs themselves.
        """
        return (lower, lower), (upper, upper)

    def order(self, u: Array, *values: Values) -> Array:
        """Return what ranks the draws that are made of uniforms, which rises with them; most often the draws
        themselves.
        """
        return self._ppf(u, *values)

    def percentile(self, p: Array, *values: Values) -> Array:
        """Return the values that are not exceeded with these probabilities, `(q,)`; most often what these uniforms
        draw.
        """
        return self._ppf(p, *values)

    @abstractmethod
    def _ppf(self, u: Array, *args: Any, **kwargs: Any) -> Array:
        """Compute the quantiles of `u`, which belongs to the hook: it may overwrite it and return it."""

    @abstractmethod
    def _cdf(self, x: Values, *args: Any, **kwargs: Any) -> Values: ...

    @abstractmethod
    def _mean(self, *args: Any, **kwargs: Any) -> Values: ...

    @abstractmethod
    def _variance(self, *args: Any, **kwargs: Any) -> Values: ...

    @abstractmethod
    def _support(self, *args: Any, **kwargs: Any) -> tuple[Values, Values]: ...

    def _mirrored(self, *args: Any, **kwargs: Any) -> tuple[Values, ...]:
        """Return the parameters of -X in the same family; a family without mirror images overrides `_sf` and `_isf`
        instead.
        """
        raise NotImplementedError(f"{self.name} has no mirror image")

    def _sf(self, x: Values, *args: Any, **kwargs: Any) -> Values:
        return self._cdf(-x, *self._mirrored(*args, **kwargs))

    def _isf(self, q: Array, *args: Any, **kwargs: Any) -> Array:
        return -self._ppf(q, *self._mirrored(*args, **kwargs))

    def bind(self, params: Sequence[Any], named: Mapping[str, Any]) -> tuple[Any, ...]:
        """Return the parameters in order, defaults for those that are left out.

        Raises:
            TypeError: one without default is missing, or one is unknown or given twice.
        """
        if len(params) == len(self.parameters) and not named:
            return tuple(params)
        given = {**dict(zip(self.keys, params, strict=False)), **named}
        defaults = {spec.key: spec.default for spec in self.parameters if spec.default is not None}
        if len(given) < len(params) + len(named) or {*defaults, *given} != {*self.keys}:
            raise TypeError(f"{self.name} takes {', '.join(self.keys)}")
        return tuple(map((defaults | given).__getitem__, self.keys))


@dataclass(frozen=True, slots=True, eq=False)
class Member:
    """A family with its parameters. Nothing is checked when it is made: `fault` or `Family.checked` does that.

    Its functions are those of `Family`, and give NaN in the trials whose parameters break a rule.

    Attributes:
        family: that it belongs to.
        values: the parameters in order, each a number or `(n,)`; NaN in trials that break a rule.
        invalid: which trials these are; None for none.
    """

    family: Family
    values: tuple[Any, ...]
    invalid: Any = None

    def fault(self) -> Fault | None:
        """See `Family.fault`; the parameters are numbers."""
        if broken := self.family.broken_rule(*self.values):
            return broken
        if self.family.always_finite or not self.values or np.isfinite(self.ppf(np.array(TRIED_U))).all():
            return None
        return self.family.overflow_fault(self.values, "Correct the number, or cut the distribution off at both ends")

    def ppf(self, u: Values, out: Array | None = None) -> Array:
        """See `Family.ppf`."""
        own = _own_copy(u, self.values) if out is None else out
        if out is not None and out is not u:
            out[...] = u
        x = self._evaluate(self.family._ppf, _open(self.family, own))
        if any(map(np.ndim, self.values)):
            x = np.where(np.isfinite(x), x, np.nan)
        if out is None:
            return x
        if x is not out:
            out[...] = x
        return out

    def isf(self, q: Values) -> Array:
        return self._evaluate(self.family._isf, _own_copy(q, self.values))

    def order(self, u: Values) -> Array:
        """See `Family.order`."""
        return self._evaluate(self.family.order, _open(self.family, _own_copy(u, self.values)))

    def percentile(self, p: Values) -> Array:
        """See `Family.percentile`."""
        return self._evaluate(self.family.percentile, _open(self.family, _own_copy(p, self.values)))

    def cdf(self, x: Values) -> Array:
        return self._evaluate(self.family._cdf, x, of_point=lambda point: 1.0 * np.greater_equal(x, point))

    def sf(self, x: Values) -> Array:
        return self._evaluate(self.family._sf, x, of_point=lambda point: 1.0 * np.less_equal(x, point))

    def mean(self) -> Array:
        return self._evaluate(self.family._mean)

    def variance(self) -> Array:
        return self._evaluate(self.family._variance, of_point=lambda point: 0.0 * point)

    def support(self) -> tuple[Array, Array]:
        return (
            self._evaluate(lambda *values: self.family._support(*values)[0]),
            self._evaluate(lambda *values: self.family._support(*values)[1]),
        )

    def _evaluate(self, hook: Callable[..., Any], *at: Values, of_point: Callable[[Any], Any] = np.asarray) -> Array:
        """Return what the hook gives; if the parameters leave one value only, `of_point` of it (`Family.point`)."""
        point = self.family.point(*self.values)
        if point is not None and np.ndim(point) == 0:
            shape = np.broadcast_shapes(*map(np.shape, at))
            return np.array(np.broadcast_to(of_point(point), shape), dtype=float)
        with np.errstate(all="ignore"):
            result = self._masked(hook(*at, *self.values))
        return result if point is None else np.where(np.isnan(point), result, of_point(point))

    def _masked(self, result: Values) -> Array:
        if self.invalid is not None:
            result = np.where(self.invalid, np.nan, result)
        return np.asarray(result, dtype=float)


def point_where(degenerate: Any, value: Values) -> Values | None:
    """Return the value where the parameters leave one only, NaN elsewhere; None if they never do."""
    return np.where(degenerate, value, np.nan) if np.any(degenerate) else None


def _open(family: Family, u: Array) -> Array:
    """Return the same, changed in place where the quantile of 0 is infinite."""
    if family.open_below:
        np.copyto(u, SMALLEST_U, where=u == 0.0)
    return u


def _own_copy(u: Values, values: tuple[Any, ...]) -> Array:
    """`u` in memory of its own, in the shape that the result will have."""
    shape = np.broadcast_shapes(np.shape(u), *map(np.shape, values))
    return np.array(np.broadcast_to(u, shape), dtype=float)


def share(part: Values, whole: Values) -> Array:
    """`part / whole`, and 0 where the whole is 0: a piece of no width holds nothing."""
    whole = np.asarray(whole)
    return np.asarray(part / np.where(whole > 0, whole, 1.0) * (whole > 0))


def ends(low: float, high: float, *parameters: Values) -> tuple[Array, Array]:
    """Two fixed ends of the support in the shape of the parameters, e.g. 0 and infinity."""
    shape = np.broadcast_shapes(*(np.shape(each) for each in parameters))
    return np.full(shape, low), np.full(shape, high)
