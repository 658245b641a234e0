"""Conditions. Every branch is a value per trial; an error in the branch not taken does no harm."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.facts import EmptyCells, Facts, Repeats
from xlmc.excel.functions.registry import Anything, Kind, Logical, Logicals, excel
from xlmc.excel.functions.values import (
    BLANK,
    ERROR,
    LOGICAL,
    NUMBER,
    TEXT,
    VALUE,
    Bools,
    Codes,
    Floats,
    Objects,
    Value,
    constant,
)

__all__ = ["choose", "zero_if_blank"]

_NA: Final = ERROR + ErrorCode.NA
"""The kind of `#N/A`."""


def choose(condition: Bools, yes: Value, no: Value, errors: Codes | None = None) -> Value:
    """Return `yes` where the condition holds, else `no`; an error of the condition itself goes before both."""
    if yes.numbers.ndim == 3 or no.numbers.ndim == 3 or condition.ndim == 3:
        yes, no = yes.as_range(), no.as_range()
        condition = condition if condition.ndim == 3 else condition.reshape(-1, 1, 1)
    kinds = np.where(condition, yes.kinds, no.kinds)
    if errors is not None and errors.any():
        errors = errors if errors.ndim == kinds.ndim else errors.reshape(-1, 1, 1)
        kinds = np.where(errors > 0, errors + np.uint8(ERROR), kinds)
    texts = None
    if yes.texts is not None or no.texts is not None:
        texts = np.where(condition, _texts(yes), _texts(no))
    return Value(np.where(condition, yes.numbers, no.numbers), kinds.astype(np.uint8), texts)


def _texts(value: Value) -> Objects:
    return np.full(1, "", object) if value.texts is None else value.texts


@excel("IF", Anything, Anything, Anything(default=None), returns=Kind.ANY)
def if_(condition: Value, yes: Value, no: Value | None = None) -> Value:
    """Return the second argument where the first is TRUE, else the third; a blank branch is 0."""
    truth, errors = condition.to_logicals()
    return choose(truth, zero_if_blank(yes), constant(False) if no is None else zero_if_blank(no), errors)


def zero_if_blank(value: Value) -> Value:
    """Put 0 in place of each blank: that is what a formula gives for an empty cell."""
    return Value(value.numbers, np.where(value.kinds == BLANK, np.uint8(NUMBER), value.kinds), value.texts)


@excel("IFERROR", Anything, Anything, returns=Kind.ANY)
def if_error(value: Value, instead: Value) -> Value:
    """Return the first argument, or the second where the first is an error."""
    return choose(value.kinds >= ERROR, zero_if_blank(instead), zero_if_blank(value))


@excel("IFNA", Anything, Anything, returns=Kind.ANY)
def if_na(value: Value, instead: Value) -> Value:
    """Return the first argument, or the second where the first is `#N/A`."""
    return choose(value.kinds == _NA, zero_if_blank(instead), zero_if_blank(value))


@excel("NOT", Logical, returns=Kind.LOGICAL, ufunc=np.logical_not, facts=Facts(never_errs=True, condition=True))
def not_(x: Bools) -> Bools:
    """Return TRUE for FALSE, and FALSE for TRUE."""
    return np.logical_not(x)


def _unless_none_counts(counts: Bools, result: Bools) -> Floats:
    """Return the result, or `#VALUE!` where the arguments hold no logical at all."""
    return np.where(counts.any(axis=1), result, VALUE)


@excel(
    "AND",
    Logicals,
    returns=Kind.LOGICAL,
    ufunc=np.logical_and,
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.ONCE, condition=True),
)
def and_(x: Bools, counts: Bools) -> Value:
    """Whether all are TRUE."""
    return _logical(_unless_none_counts(counts, np.asarray((x | ~counts).all(axis=1))))


@excel(
    "OR",
    Logicals,
    returns=Kind.LOGICAL,
    ufunc=np.logical_or,
    facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.ONCE, condition=True),
)
def or_(x: Bools, counts: Bools) -> Value:
    """Whether any is TRUE."""
    return _logical(_unless_none_counts(counts, np.asarray((x & counts).any(axis=1))))


@excel(
    "XOR",
    Logicals,
    returns=Kind.LOGICAL,
    ufunc=np.logical_xor,
    facts=Facts(empty_cells=EmptyCells.IGNORED, condition=True),
)
def xor(x: Bools, counts: Bools) -> Value:
    """Whether an odd number of them is TRUE."""
    return _logical(_unless_none_counts(counts, (x & counts).sum(axis=1) % 2 == 1))


def _logical(x: Floats) -> Value:
    boxed = Value.of_numbers(x)
    return Value(boxed.numbers, np.where(boxed.kinds == NUMBER, np.uint8(LOGICAL), boxed.kinds))


@excel("TRUE", returns=Kind.LOGICAL)
def true() -> Bools:
    """Return TRUE."""
    return np.ones(1, bool)


@excel("FALSE", returns=Kind.LOGICAL)
def false() -> Bools:
    """Return FALSE."""
    return np.zeros(1, bool)


def _register_test(name: str, meaning: str, test: object) -> None:
    def body(x: Value) -> Value:
        return Value.of_logicals(np.broadcast_to(test(x.kinds), x.shape))  # type: ignore[operator]

    body.__doc__ = meaning
    excel(name, Anything, returns=Kind.LOGICAL, facts=Facts(exact_steps=True))(body)


_register_test("ISERROR", "Whether it is any error.", lambda kinds: kinds >= ERROR)
_register_test("ISERR", "Whether it is an error other than `#N/A`.", lambda k: (k >= ERROR) & (k != _NA))
_register_test("ISNA", "Whether it is `#N/A`.", lambda kinds: kinds == _NA)
_register_test("ISNUMBER", "Whether it is a number.", lambda kinds: kinds == NUMBER)
_register_test("ISLOGICAL", "Whether it is TRUE or FALSE.", lambda kinds: kinds == LOGICAL)
_register_test("ISTEXT", "Whether it is a text.", lambda kinds: kinds == TEXT)
_register_test("ISNONTEXT", "Whether it is anything but a text.", lambda kinds: kinds != TEXT)
_register_test("ISBLANK", "Whether the cell is empty.", lambda kinds: kinds == BLANK)
