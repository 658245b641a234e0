"""What a row of the registry states of its function beside what it takes and computes.

Whoever needs such a fact reads it here: there is no list of names elsewhere. Each default is what may be assumed of a
function of which nothing is known: it costs time, or something is refused or not said, but no number is wrong.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

__all__ = ["NOTHING", "Domain", "EmptyCells", "Facts", "Repeats"]


class EmptyCells(Enum):
    """What the empty cells at the end of a whole column, which is an argument, are to a function."""

    REFUSED = "nobody knows, and a whole column is refused"
    IGNORED = "nothing"
    IGNORED_IN_FIRST = "nothing in the first argument; a whole column in another one is refused"
    PAIRED = "nothing where they are empty in all the ranges, which are of one size"

    __hash__ = object.__hash__


class Repeats(Enum):
    """What cells that are all alike, at the end of an array, are to a function of one array, or of several."""

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
        with_ends: whether it takes these, too.
    """

    low: float
    high: float = math.inf
    with_ends: bool = True


@dataclass(frozen=True, slots=True)
class Facts:
    """What is known of a function.

    Attributes:
        spills: it gives many cells, or may, though its arguments of single values are single.
        sized_by_numbers: it spills, and arguments of single values decide how many cells it gives.
        never_errs: with numbers and logicals it gives no error, infinity apart, so that it may be computed in trials
            that do not need it.
        factor: it is a multiplication by this number, to the last bit.
        empty_cells, repeats: see the classes.
        ends_tell: of numbers that rise by the same from cell to cell, the first and the last tell all: the mean of what
            they give is that of what all give (where repeats add up), or no other one matters (where they count once).
        mode_argument: it looks something up, and this argument, counted from 0, says how: 0 and FALSE exactly, from the
            first cell on. It is one that the function does not have where it always looks up by halves.
        finds: its result steps from one cell of a range to the next.
        exact_steps: it gives a whole number, a multiple or a logical, which is exact if its arguments are.
        unrounded: its result is not rounded: an argument, that with another sign, or a whole number.
        adds: it adds or subtracts its arguments.
        measures: a number typed in as its argument, one that is no count, counts as a measurement in `xlmc stability`.
        condition: it compares, or joins conditions.
        between: the least and the largest number that it gives, whatever it takes.
        domain: which numbers it takes; None where it takes all, or nobody has said.
    """

    spills: bool = False
    sized_by_numbers: bool = False
    never_errs: bool = False
    factor: float | None = None
    empty_cells: EmptyCells = EmptyCells.REFUSED
    repeats: Repeats = Repeats.REFUSED
    ends_tell: bool = False
    mode_argument: int | None = None
    finds: bool = False
    exact_steps: bool = False
    unrounded: bool = False
    adds: bool = False
    measures: bool = False
    condition: bool = False
    between: tuple[float, float] | None = None
    domain: Domain | None = None

    def __post_init__(self) -> None:
        """Refuse facts that do not go together."""
        if self.sized_by_numbers and not self.spills:
            raise ValueError("what is sized by its numbers spills")


NOTHING: Final = Facts()
"""Of a function of which nothing is said."""
