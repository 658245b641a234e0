"""A family that is given by percentiles: "10 % of drivers react within 0.8 s, 90 % within 2 s".

Which member of the family has these percentiles? Most families are moved, stretched and bent: quantile = location +
scale · q(p; shape). Given the shape, percentiles fix location and scale in closed form, and what is left is one
equation in the shape. The others have `ordered` parameters, such as Low ≤ Likeliest ≤ High; they are solved by least
squares in coordinates that keep the order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise, product
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Member, Values
from xlmc.montecarlo.distributions.parameters import Fault, ParameterSpec, Role, show
from xlmc.montecarlo.distributions.solved_member import SolvedMember

__all__ = ["ByPercentiles", "by_percentiles", "match_percentiles"]

Points = Sequence[tuple[float, float]]
"""(p, x): the value x is not exceeded with probability p."""

Solution = tuple[float, ...] | None

_COORDINATES = np.linspace(-35.0, 35.0, 281)

_LOG_SHAPES = np.linspace(math.log(1e-3), math.log(1e6), 400)

_MET = 1e-9  # of the spread of the percentiles: they are met when the member's are this near


def by_percentiles(family: Family, given: Collection[str], percents: Sequence[float]) -> ByPercentiles:
    """Return the family with percentiles instead of the parameters that are not given.

    Args:
        family: one whose parameters have roles.
        given: the keys of the parameters that are.
        percents: above 0 and below 100.

    Raises:
        ValueError: there are more or fewer percentiles than parameters left; one with a default may be left, too.
    """
    left = [spec for spec in family.parameters if spec.key not in given]
    required = [spec for spec in left if spec.default is None]
    if len(percents) == len(left):
        required = left
    if len(percents) != len(required):
        names = ", ".join(spec.heading for spec in left) or "no parameter"
        raise ValueError(f"{len(percents)} percentiles stand for {names}")
    unknown = {spec.key for spec in required}
    return ByPercentiles(family, tuple(key for key in family.keys if key not in unknown), tuple(sorted(percents)))


class ByPercentiles(SolvedMember):
    """The member of a family that has some parameters as given and these percentiles; before any truncation.

    Its parameters are those given, in the family's order, then the percentiles by rising percentage. They are numbers:
    unlike other families', they cannot vary by trial.

    >>> from xlmc.montecarlo.distributions.normal import Normal
    >>> reaction = ByPercentiles(Normal(), (), (10.0, 90.0))
    >>> reaction.keys
    ('p10', 'p90')
    >>> print(reaction.ppf(np.array([0.1, 0.5, 0.9]), p10=0.8, p90=2.0).round(12))
    [0.8 1.4 2. ]
    >>> reaction.check(p10=2.0, p90=0.8)
    'P10 (2) is not below P90 (0.8)'
    """

    given_by = "percentiles"

    def __init__(self, family: Family, given: tuple[str, ...], percents: tuple[float, ...]) -> None:
        self.percents = percents
        headings = [f"P{percent:.12g}" for percent in percents]
        super().__init__(family, given, tuple(ParameterSpec(each.lower(), (each,)) for each in headings))

    def __reduce__(self) -> tuple[Any, ...]:
        """Look again for the members that it has found."""
        return ByPercentiles, (self.family, tuple(spec.key for spec in self._given), self.percents)

    def broken_rule(self, *values: float) -> Fault | None:
        """Return the first thing wrong with these numbers, if any."""
        if fault := super().broken_rule(*values):
            return fault
        percentiles = list(zip(self.parameters, values, strict=True))[len(self._given) :]
        for (lower, below), (upper, above) in pairwise(percentiles):
            if not below < above:
                message = f"{lower.heading} ({show(below)}) is not below {upper.heading} ({show(above)})"
                return Fault(lower.key, message, "Exchange the two, or correct the wrong one")
        if self._member(*values) is None:
            shown = ", ".join(
                f"{spec.heading} {show(value)}" for spec, value in zip(self.parameters, values, strict=True)
            )
            message = f"No single {self.name} has {shown}"
            return Fault(percentiles[-1][0].key, message, "Correct the percentiles, or choose another distribution")
        return None

    def _find(self, *values: float) -> tuple[float, ...] | None:
        given = {spec.key: float(value) for spec, value in zip(self._given, values, strict=False)}
        points = [
            (percent / 100, float(x)) for percent, x in zip(self.percents, values[len(self._given) :], strict=True)
        ]
        return match_percentiles(self.family, given, points)


def match_percentiles(family: Family, given: Mapping[str, float], points: Points) -> Solution:
    """Return the parameters of the member, in the family's order; None if none fits, or where any shape does.

    Where several members fit, the one whose shape is nearest to 1 is taken, or else the narrowest.

    Args:
        family: one with `roles`.
        given: its parameters that are known, by key.
        points: as many percentiles as parameters are missing, rising.
    """
    if len(points) + len(given) != len(family.parameters):
        raise TypeError(f"{family.name} needs {len(family.parameters) - len(given)} percentiles, not {len(points)}")
    if not all(map(math.isfinite, (*given.values(), *(x for _, x in points)))):
        return None
    p, x = (np.array(each) for each in zip(*points, strict=True))
    candidates = _ordered(family, given, points) if "ordered" in family.roles else _moved(family, given, points)
    with np.errstate(all="ignore"):
        for result in candidates:
            if family.broken_rule(*result) is None:
                away = np.abs(Member(family, result).ppf(p) - x)
                if np.all(away <= _MET * _spread(given, points)):
                    return result
    return None


def _spread(given: Mapping[str, float], points: Points) -> float:
    """Choose a length to measure by: from the least to the greatest of what is known; from 0 for a single number."""
    lengths = [x for _, x in points] + [given[key] for key in ("low", "likeliest", "high", "location") if key in given]
    return max(lengths) - min(lengths) or abs(lengths[0]) or 1.0


def _moved(family: Family, given: Mapping[str, float], points: Points) -> Iterator[tuple[float, ...]]:
    member = _Moved(family, given, points)
    shapes = [math.nan if member.shape is None else member.shape]
    if "shape" in family.roles and member.shape is None:
        spread = _spread(given, points)
        roots = _roots(lambda logs: member.misfit(np.exp(logs)) / spread, _LOG_SHAPES)
        shapes = [math.exp(root) for root in sorted(roots, key=abs)]
    for shape in shapes:
        if (result := member.parameters(shape)) is not None:
            yield result


class _Moved:
    """quantile = location + scale · q(p; shape), with what is known of the three."""

    def __init__(self, family: Family, given: Mapping[str, float], points: Points) -> None:
        self.family = family
        known = {role: given.get(key) for role, key in zip(family.roles, family.keys, strict=True)}
        self.location = known.get("location", 0.0)
        self.scale = next(_scale(role, known[role]) for role in known if role not in ("location", "shape"))
        self.shape = known.get("shape")
        self.p, self.x = (np.array(each) for each in zip(*points, strict=True))

    def parameters(self, shape: float) -> Solution:
        """Return the family's parameters with this shape; None if they would be none."""
        location, scale = (float(each) for each in self.fit(self.quantiles(shape)))
        if not (scale > 0 and math.isfinite(location)):
            return None
        return tuple(float(value) for value in self._as_parameters(location, scale, shape))

    def misfit(self, shape: Array) -> Array:
        """How far the member with this shape misses the percentile that location and scale have not been fitted to."""
        q = self.quantiles(shape)
        location, scale = self.fit(q)
        left = {3: 1, 2: 1 - self._farthest if self.location is not None else 0, 1: 0}[len(self.x)]
        return location + scale * q[left] - self.x[left]  # type: ignore[no-any-return]  # as SciPy has no types

    def quantiles(self, shape: Values) -> Array:
        """q(p; shape), `(points,)` or `(points, shapes)`."""
        return np.array([self.family.ppf(p, *self._as_parameters(0.0, 1.0, shape)) for p in self.p])

    def fit(self, q: Array) -> tuple[Any, Any]:
        """Location and scale, as given or fitted to the outer percentiles."""
        location, scale = self.location, self.scale
        if location is None and scale is None:
            scale = (self.x[-1] - self.x[0]) / (q[-1] - q[0])
            return self.x[0] - scale * q[0], scale
        if location is None:
            return self.x[-1] - scale * q[-1], scale
        if scale is None:
            return location, (self.x[self._farthest] - location) / q[self._farthest]
        return location, scale

    @property
    def _farthest(self) -> int:
        """The percentile farthest from the location, which tells the scale best."""
        return int(np.argmax(np.abs(self.x - self.location)))

    def _as_parameters(self, location: Values, scale: Values, shape: Values) -> tuple[Values, ...]:
        values: dict[Role, Values] = {
            "location": location,
            "scale": scale,
            "rate": 1 / scale,
            "log scale": np.log(scale),
            "shape": shape,
        }
        return tuple(values[role] for role in self.family.roles)


def _scale(role: Role, value: float | None) -> float | None:
    if value is None:
        return None
    return {"scale": value, "rate": 1 / value if value else math.inf, "log scale": float(np.exp(value))}[role]


def _roots(function: Callable[[Array], Array], grid: Array) -> Iterator[float]:
    """Return the numbers at which the function changes its sign, from the lowest on; none if it is 0 everywhere."""
    from scipy.optimize import brentq

    values = function(grid)
    if not np.nanmax(np.abs(np.where(np.isfinite(values), values, 0.0))) > _MET:
        return
    for left in np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) <= 0):
        yield brentq(lambda s: float(function(np.array([s]))[0]), grid[left], grid[left + 1], xtol=1e-15, rtol=1e-15)


def _ordered(family: Family, given: Mapping[str, float], points: Points) -> Iterator[tuple[float, ...]]:
    chart = _Chart(family, given, points)
    p, x = (np.array(each) for each in zip(*points, strict=True))

    def misfit(coordinates: Array) -> Array:
        away = (family.ppf(p, *chart.parameters(coordinates)) - x) / chart.spread
        return np.where(np.isfinite(away), away, 1e6)

    if len(points) == 1:
        roots = _roots(lambda grid: np.array([misfit(np.array([each]))[0] for each in grid]), _COORDINATES)
        yield from (chart.parameters(np.array([root])) for root in roots)
    else:
        yield from (chart.parameters(values) for values in _least(misfit, chart.starts()))


def _least(misfit: Callable[[Array], Array], starts: Iterable[Array]) -> Iterator[Array]:
    """Return the parameters with which all percentiles are met, searched from each start."""
    from scipy.optimize import least_squares

    for start in starts:
        value = least_squares(misfit, start, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15)
        if np.all(np.abs(value.fun) <= _MET):
            yield value.x


class _Chart:
    """Coordinates without bounds for the missing parameters of a family whose first ones must rise.

    A parameter with known ones on both sides is a share of the way to the next of these. Any other is a step away from
    its neighbour; where nothing is known, the first is a step below the lowest percentile.
    """

    def __init__(self, family: Family, given: Mapping[str, float], points: Points) -> None:
        self.spread, self.lowest = _spread(given, points), points[0][1]
        self.known = [given.get(key, math.nan) for key in family.keys]
        self.missing = [i for i, value in enumerate(self.known) if math.isnan(value)]
        self.roles = family.roles
        ordered = range(family.roles.count("ordered"))
        self.ends = [i for i in ordered if i not in self.missing]
        self.after = range(self.ends[0] + 1 if self.ends else 1, len(ordered))

    def starts(self) -> Iterator[Array]:
        """Return the points from which the search begins."""
        for start in product((-1.0, 0.5, 2.0), repeat=len(self.missing)):
            yield np.array(start)

    def parameters(self, coordinates: Array) -> tuple[float, ...]:
        """Return the parameters at these coordinates, `(missing,)`."""
        values, move = list(self.known), dict(zip(self.missing, coordinates.tolist(), strict=True))
        if not self.ends and self.roles[0] == "ordered":
            values[0] = self.lowest - self._step(move[0])
        for i in reversed(range(self.ends[0] if self.ends else 0)):
            values[i] = values[i + 1] - self._step(move[i])
        for i in self.missing:
            if i in self.after:
                end = next((self.known[j] for j in self.ends if j > i), None)
                onwards = self._step(move[i]) if end is None else (end - values[i - 1]) * _share(move[i])
                values[i] = values[i - 1] + onwards
            elif self.roles[i] != "ordered":
                values[i] = self._step(move[i]) if self.roles[i] == "scale" else _power(move[i])
        return tuple(values)

    def _step(self, coordinate: float) -> float:
        return self.spread * _power(coordinate)


def _power(coordinate: float) -> float:
    return math.exp(min(coordinate, 300.0))


def _share(coordinate: float) -> float:
    return 1 / (1 + _power(-coordinate))
