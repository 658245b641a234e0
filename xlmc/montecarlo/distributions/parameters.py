"""What a family must be given, parameters or data: their names, what they must keep, what is said if they do not."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from xlmc.montecarlo.number_text import number_text

__all__ = [
    "HIGH",
    "LIKELIEST",
    "LOCATION",
    "LOW",
    "MEAN",
    "SCALE",
    "SHAPE",
    "STD_DEV",
    "Constraint",
    "DataError",
    "DataSpec",
    "Fault",
    "ParameterSpec",
    "Role",
    "above_zero",
    "at_most",
    "range_text",
    "rising",
    "show",
]

Role = Literal["location", "scale", "rate", "log scale", "shape", "ordered"]
"""What a parameter does: moves, stretches or bends the distribution; those that are ordered rise in their order."""


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """A parameter: the key the code uses and the column headings people may write, the usual one first.

    With a default the parameter may be left out, and its column blank.
    """

    key: str
    headings: tuple[str, ...]
    default: float | None = None

    @property
    def heading(self) -> str:
        return self.headings[0]


LOW = ParameterSpec("low", ("Low", "Minimum", "Min"))
HIGH = ParameterSpec("high", ("High", "Maximum", "Max"))
LIKELIEST = ParameterSpec("likeliest", ("Likeliest", "Mode", "Most likely"))
MEAN = ParameterSpec("mean", ("Mean", "Average"))
STD_DEV = ParameterSpec("std_dev", ("Std dev", "Standard deviation", "SD", "Std. dev.", "St dev"))
LOCATION = ParameterSpec("location", ("Location", "Loc"), default=0.0)
SCALE = ParameterSpec("scale", ("Scale",))
SHAPE = ParameterSpec("shape", ("Shape",))


@dataclass(frozen=True, slots=True)
class Constraint:
    """What the parameters must keep.

    Attributes:
        blames: the key of the parameter whose cell a person should look at first.
        holds: of the parameters in order; works on numbers and on `(n,)` arrays. False where a parameter is NaN.
        message: what is wrong when it does not hold; `{key}` stands for the value of a parameter.
        hint: what to do then.
    """

    blames: str
    holds: Callable[..., Any]
    message: str
    hint: str


def above_zero(parameters: Sequence[ParameterSpec], key: str, hint: str = "Give a positive number") -> Constraint:
    """Require the parameter with this key to be positive."""
    index, heading = _index_of(parameters, key)
    return Constraint(key, lambda *values: values[index] > 0, f"{heading} ({{{key}}}) must be above 0", hint)


def at_most(parameters: Sequence[ParameterSpec], key: str, limit: float, hint: str) -> Constraint:
    """Require the parameter with this key to be no larger than a value."""
    index, heading = _index_of(parameters, key)
    message = f"{heading} ({{{key}}}) must be at most {show(limit)}"
    return Constraint(key, lambda *values: values[index] <= limit, message, hint)


def rising(parameters: Sequence[ParameterSpec], lower: str, upper: str) -> Constraint:
    """Require the parameter `lower` not to be above the parameter `upper`."""
    (left, below), (right, above) = _index_of(parameters, lower), _index_of(parameters, upper)
    message = f"{below} ({{{lower}}}) is above {above} ({{{upper}}})"
    hint = "Exchange the two, or correct the wrong one"
    return Constraint(lower, lambda *values: values[left] <= values[right], message, hint)


def _index_of(parameters: Sequence[ParameterSpec], key: str) -> tuple[int, str]:
    return next((index, spec.heading) for index, spec in enumerate(parameters) if spec.key == key)


@dataclass(frozen=True, slots=True)
class Fault:
    """A broken rule in words, with the key of the parameter to look at first."""

    key: str
    message: str
    hint: str


def show(value: float) -> str:
    """Write a number as a person would, with all that was typed of it."""
    return number_text(float(value), 12)


def range_text(low: float, high: float, written: Callable[[float], str] = show) -> str:
    """Write a range as a person would say it; an infinite end is left out.

    >>> range_text(20, 80.5), range_text(-math.inf, 10), range_text(20, math.inf)
    ('from 20 to 80.5', 'at most 10', 'at least 20')
    """
    if not math.isfinite(low):
        return f"at most {written(high)}"
    return f"from {written(low)} to {written(high)}" if math.isfinite(high) else f"at least {written(low)}"


@dataclass(frozen=True, slots=True)
class DataSpec:
    """What the range under Data must hold for a family that is built from data.

    Attributes:
        columns: the numbers of columns it may have; empty for any.
        content: what the columns are, for people: `values, cumulative probabilities`.
        options: headings of the assumptions table that say how to read it; `built` takes them in small letters.
        truncates: whether what is built may have cutoffs.
    """

    columns: tuple[int, ...]
    content: str
    options: tuple[str, ...] = ()
    truncates: bool = True


class DataError(ValueError):
    """Numbers that no distribution can be built from.

    Attributes:
        message, hint: what is wrong, and what to do; `{also}` in the message stands for the other cell.
        row, column: where to look first, counted from 0; None for the data as a whole.
        also: the row and column that it disagrees with.
    """

    def __init__(
        self,
        message: str,
        hint: str,
        row: int | None = None,
        column: int | None = None,
        also: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(message)
        self.message, self.hint, self.row, self.column, self.also = message, hint, row, column, also
