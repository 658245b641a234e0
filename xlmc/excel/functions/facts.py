"""What a row of the registry states about its function, beside its arguments and its body.

Whoever needs such a fact reads it here: there is no list of names elsewhere. Each default is safe for a function of
which nothing is known: it may cost time, or refuse a formula, or leave a note out, but it never makes a number wrong.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

__all__ = ["NOTHING", "Domain", "EmptyCells", "Facts", "Repeats"]


class EmptyCells(Enum):
    """What a function makes of the empty cells at the end of a whole column that is its argument."""

    REFUSED = "nobody knows, and a whole column is refused"
    IGNORED = "nothing"
    IGNORED_IN_FIRST = "nothing in the first argument; a whole column in another one is refused"
    PAIRED = "nothing where they are empty in all the ranges, which are of one size"

    __hash__ = object.__hash__


class Repeats(Enum):
    """What a function of arrays makes of cells that are all alike, at the end of an array."""

    REFUSED = "nobody knows, and an array of a whole column is refused"
    ADD_UP = "what one of them gives, times their number, is added to the result"
    ONCE = "the same as one of them"
    NUMBERS_COUNT = "nothing, if they are texts or logicals; else nobody knows"

    __hash__ = object.__hash__


@dataclass(frozen=True, slots=True)
class Domain:
    """The numbers that a function of one number takes.

    Attributes:
        low, high: the least and the largest.
        with_ends: whether it takes these two themselves.
    """

    low: float
    high: float = math.inf
    with_ends: bool = True


@dataclass(frozen=True, slots=True)
class Facts:
    """What is known of a function.

    Attributes:
        spills: its result is many cells, or may be, even where each argument is a single value.
        sized_by_numbers: it spills, and arguments that are single values decide how many cells the result has.
        never_errs: it gives no error for numbers and logicals, infinity apart, so that it may be computed in trials
            that do not need it.
        factor: it multiplies by this number, to the last bit.
        empty_cells, repeats: see the classes.
        ends_suffice: of numbers that rise by equal steps from cell to cell, the first and the last are enough: either
            the mean of their results is the mean of all (where repeats add up), or no other cell changes the result
            (where repeats count once).
        mode_argument: it is a lookup, and this argument, counted from 0, says how it searches: for 0 and FALSE it wants
            an equal value and starts at the first cell. The number is that of no argument where it always halves.
        jumps: its result jumps from one cell of a range to the next.
        exact_steps: it gives a whole number, a multiple or a logical, which is exact if its arguments are.
        unrounded: its result is not rounded: it is an argument, or minus an argument, or a whole number.
        adds: it adds or subtracts its arguments.
        measures: `xlmc stability` takes a number typed into its arguments for a measurement, unless it is a count.
        condition: it compares, or joins conditions.
        result_range: the least and the largest number that it ever gives.
        domain: which numbers it takes; None if it takes all, or where it is not known.
    """

    spills: bool = False
    sized_by_numbers: bool = False
    never_errs: bool = False
    factor: float | None = None
    empty_cells: EmptyCells = EmptyCells.REFUSED
    repeats: Repeats = Repeats.REFUSED
    ends_suffice: bool = False
    mode_argument: int | None = None
    jumps: bool = False
    exact_steps: bool = False
    unrounded: bool = False
    adds: bool = False
    measures: bool = False
    condition: bool = False
    result_range: tuple[float, float] | None = None
    domain: Domain | None = None

    def __post_init__(self) -> None:
        """Refuse facts that do not go together."""
        if self.sized_by_numbers and not self.spills:
            raise ValueError("a function whose numbers decide on its size spills")


NOTHING: Final = Facts()
"""The facts of a function of which nothing is stated."""
