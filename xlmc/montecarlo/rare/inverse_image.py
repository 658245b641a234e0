"""What the argument of a function must be for its value to lie within bounds: the inverse, for intervals.

The same for arithmetic, where one of two operands is known: `o` is the known one, (n,).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.spans import Spans, choose, intersection, union, union_of_pairs

__all__ = [
    "FUNCTIONS",
    "PERIODIC",
    "TURNS",
    "divisor",
    "exponent",
    "factor",
    "largest",
    "line",
    "negated",
    "numerator",
    "powered",
    "ratio",
    "smallest",
    "term",
]

Floats = NDArray[np.float64]

TURNS: Final = 2.0 * math.pi
"""How far from 0 the argument of SIN, COS and TAN may be; beyond, not all of it would be found."""


def term(value: Spans, o: Floats) -> Spans:
    """Invert s + o."""
    return Spans(value.low - o, value.high - o)


def negated(value: Spans) -> Spans:
    """Invert −s."""
    return union_of_pairs([(-value.high, -value.low)])


def factor(value: Spans, o: Floats) -> Spans:
    """Invert s · o."""
    with np.errstate(all="ignore"):
        spans = union_of_pairs([_ordered(value.low / o, value.high / o, (value.low <= value.high) & (o != 0.0))])
    return choose(o == 0.0, _anything(value), spans)


def numerator(value: Spans, o: Floats) -> Spans:
    """Invert s / o; nothing is divided by 0."""
    with np.errstate(all="ignore"):
        return union_of_pairs([_ordered(value.low * o, value.high * o, (value.low <= value.high) & (o != 0.0))])


def divisor(value: Spans, o: Floats) -> Spans:
    """Invert o / s."""
    above = _reciprocal(value.low, value.high, o)
    below = _reciprocal(-value.high, -value.low, o)
    return choose(o == 0.0, _anything(value), union_of_pairs([above, (-below[1], -below[0])]))


def line(value: Spans, start: Floats, slope: Floats) -> Spans:
    """Invert start + slope·s."""
    return factor(term(value, start), slope)


def ratio(value: Spans, a: Floats, b: Floats, c: Floats, d: Floats) -> Spans:
    """Invert (a + b·s) / (c + d·s)."""
    above, below = _not_negative(c, d), _not_negative(-c, -d)
    spans = []
    for low, high in zip(value.low, value.high, strict=True):
        some = (low <= high) & (low < np.inf) & (high > -np.inf)
        full, low, high = Spans.where(some), np.where(some, low, 0.0), np.where(some, high, 0.0)
        over, under = _beyond(a, b, c, d, low), _beyond(-a, -b, -c, -d, high)
        reversed_ = _beyond(-a, -b, -c, -d, low), _beyond(a, b, c, d, high)
        spans += [intersection([full, above, over, under]), intersection([full, below, *reversed_])]
    return union(spans)


def _beyond(a: Floats, b: Floats, c: Floats, d: Floats, end: Floats) -> Spans:
    """Return the values of s with a + b·s ≥ end·(c + d·s); all values if the end is infinite."""
    finite = np.isfinite(end)
    finite_end = np.where(finite, end, 0.0)
    return choose(finite, _not_negative(a - finite_end * c, b - finite_end * d), Spans.whole(end.size))


def _not_negative(start: Floats, slope: Floats) -> Spans:
    """Return the values of s with which start + slope·s is not negative."""
    return factor(Spans.between(-start, np.full(start.size, np.inf)), slope)


def _reciprocal(low: Floats, high: Floats, o: Floats) -> tuple[Floats, Floats]:
    """Invert o / s, as far as the value is above 0."""
    low = np.maximum(low, 0.0)
    with np.errstate(all="ignore"):
        far = np.where(low > 0.0, o / low, np.copysign(np.inf, o))
        return _ordered(o / high, far, (low <= high) & (high > 0.0))


def _anything(value: Spans) -> Spans:
    """All numbers where 0 will do, whatever they are multiplied by 0 or divide."""
    return Spans.where(value.contain(np.zeros(value.low.shape[1])))


def _ordered(first: Floats, second: Floats, full: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    return np.where(full, np.minimum(first, second), np.inf), np.where(full, np.maximum(first, second), -np.inf)


def powered(value: Spans, power: float) -> Spans:
    """Invert s ^ power, with a constant power other than 0."""
    if power < 0.0:
        return powered(divisor(value, np.ones(value.low.shape[1])), -power)
    whole = power == int(power)
    if whole and int(power) % 2:
        return Spans(_root(value.low, power), _root(value.high, power))
    upper = _root(np.maximum(value.low, 0.0), power), _root(value.high, power)
    return union_of_pairs([upper, (-upper[1], -upper[0])]) if whole else union_of_pairs([upper])


def _root(values: Floats, power: float) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(np.copysign(np.abs(values) ** (1.0 / power), values))


def exponent(value: Spans, o: Floats) -> Spans:
    """Invert o ^ s for o above 0."""
    with np.errstate(all="ignore"):
        return factor(_exponential(value), np.log(np.where(o > 0.0, o, np.nan)))


def largest(value: Spans, o: Floats) -> Spans:
    """Invert MAX(s, o)."""
    reached = np.where((value.low <= o) & (o <= value.high), -np.inf, value.low)
    return union_of_pairs([(np.where(o <= value.high, reached, np.inf), value.high)])


def smallest(value: Spans, o: Floats) -> Spans:
    """Invert MIN(s, o)."""
    return negated(largest(negated(value), -o))


def _exponential(value: Spans) -> Spans:
    with np.errstate(all="ignore"):
        return union_of_pairs([(np.log(np.maximum(value.low, 0.0)), np.log(value.high))])


def _square_root(value: Spans) -> Spans:
    low = np.maximum(value.low, 0.0)
    return union_of_pairs(
        [(np.where(low <= value.high, low, np.inf) ** 2, np.where(value.high >= 0, value.high**2, -np.inf))]
    )


def _logarithm(value: Spans) -> Spans:
    with np.errstate(over="ignore"):
        return Spans(np.exp(value.low), np.where(value.high == -np.inf, -np.inf, np.exp(value.high)))


def _absolute(value: Spans) -> Spans:
    low = np.maximum(value.low, 0.0)
    return union_of_pairs([(low, value.high), (-value.high, -low)])


def _sine(value: Spans) -> Spans:
    low, high = _arc(value, np.arcsin, -1.0, 1.0)
    turns = [2.0 * math.pi * turn for turn in (-1, 0, 1)]
    return union_of_pairs(
        [part for by in turns for part in ((low + by, high + by), (math.pi - high + by, math.pi - low + by))]
    )


def _tangent(value: Spans) -> Spans:
    low, high = np.arctan(value.low), np.arctan(value.high)
    full = value.low <= value.high
    turns = [math.pi * turn for turn in range(-2, 3)]
    return union_of_pairs([(np.where(full, low + by, np.inf), np.where(full, high + by, -np.inf)) for by in turns])


def _arc(value: Spans, function: Callable[[Floats], Floats], least: float, most: float) -> tuple[Floats, Floats]:
    """Apply a monotone function to what lies within its domain."""
    low, high = np.maximum(value.low, least), np.minimum(value.high, most)
    full = low <= high
    ends = [function(np.where(full, end, 0.5 * (least + most))) for end in (low, high)]
    return _ordered(ends[0], ends[1], full)


def _arc_tangent(value: Spans) -> Spans:
    quarter = 0.5 * math.pi
    low, high = _arc(value, np.tan, -quarter, quarter)
    low = np.where((value.low <= -quarter) & (low <= high), -np.inf, low)
    return union_of_pairs([(low, np.where((value.high >= quarter) & (low <= high), np.inf, high))])


def _scaled(by: float) -> Callable[[Spans], Spans]:
    return lambda value: Spans(value.low / by, value.high / by)


FUNCTIONS: Final[Mapping[str, Callable[[Spans], Spans]]] = {
    "SQRT": _square_root,
    "EXP": _exponential,
    "LN": _logarithm,
    "LOG10": lambda value: _logarithm(_scaled(1.0 / math.log(10.0))(value)),
    "ABS": _absolute,
    "SIN": _sine,
    "COS": lambda value: term(_sine(value), np.full(value.low.shape[1], 0.5 * math.pi)),
    "TAN": _tangent,
    "ASIN": lambda value: union_of_pairs([_arc(value, np.sin, -0.5 * math.pi, 0.5 * math.pi)]),
    "ACOS": lambda value: union_of_pairs([_arc(value, np.cos, 0.0, math.pi)]),
    "ATAN": _arc_tangent,
    "RADIANS": _scaled(math.pi / 180.0),
    "DEGREES": _scaled(180.0 / math.pi),
    "-": negated,
    "+": lambda value: value,
    "%": _scaled(0.01),
}
"""Functions of one argument, and the operators before or after a value."""

PERIODIC: Final = frozenset({"SIN", "COS", "TAN"})
"""The functions of one argument that are periodic: their periods are counted up to `TURNS`."""
