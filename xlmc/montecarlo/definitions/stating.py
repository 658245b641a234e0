"""The words of a row: what a forecast is to the question asked, what its numbers are, and why an assumption varies."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeVar

from xlmc.montecarlo.distributions.spelling import plain

__all__ = ["NOT_ROUNDED", "Kind", "Named", "Role", "Uncertainty", "Which", "named"]


class Role(StrEnum):
    """What a forecast is to the question: the quantity asked for, a bound of it, or a number to judge the model by."""

    ANSWER = "answer"
    LOWER = "lower bound"
    UPPER = "upper bound"
    DIAGNOSTIC = "diagnostic"

    @property
    def is_bound(self) -> bool:
        """Whether one side alone can be stated."""
        return self in (Role.LOWER, Role.UPPER)


class Kind(StrEnum):
    """What the numbers of a forecast are."""

    NUMBER = "number"
    WHOLE = "whole number"
    YES_NO = "yes/no"
    CATEGORY = "category"
    DATE = "date or time"
    PERCENT = "percent"
    CURRENCY = "currency"


class Uncertainty(StrEnum):
    """Why an assumption varies: nobody knows its one value, or it has another value each time."""

    UNCERTAIN = "uncertain"
    VARIABLE = "variable"


class Which(StrEnum):
    """Which of several values that solve for a cell is taken."""

    FIRST = "first"
    LAST = "last"


NOT_ROUNDED = (Kind.YES_NO, Kind.CATEGORY)
"""Kinds whose numbers stand for words, so that they are not rounded."""

_ALSO = {
    "integer": Kind.WHOLE,
    "yes or no": Kind.YES_NO,
    "true/false": Kind.YES_NO,
    "date": Kind.DATE,
    "time": Kind.DATE,
    "date/time": Kind.DATE,
}

Named = TypeVar("Named", Role, Kind, Uncertainty, Which)


def named(kind: type[Named], text: str) -> Named | None:
    """Return the word of a kind that a person means, whatever its case and blanks; None for another word.

    >>> named(Role, "Lower Bound"), named(Kind, "Yes or no"), named(Kind, "speed")
    (<Role.LOWER: 'lower bound'>, <Kind.YES_NO: 'yes/no'>, None)
    """
    spellings = {plain(each.value): each for each in kind}
    also = {plain(word): each for word, each in _ALSO.items() if isinstance(each, kind)}
    return (spellings | also).get(plain(text))
