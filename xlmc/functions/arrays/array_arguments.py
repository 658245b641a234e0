"""What functions that give arrays ask of their arguments: all that decides on the shape must be the same in all trials.

A body raises `Refusal` where the result is one error instead of an array.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import direct_errors, first_errors, if_blank, same_in_all_trials
from xlmc.functions.facts import Facts
from xlmc.functions.logical import choose
from xlmc.functions.lookup.picking import Places, flattened, picked
from xlmc.functions.registry import Kind, Parameter, excel
from xlmc.functions.values import BLANK, Bools, Codes, Value, constant

__all__ = ["Refusal", "array_function", "decided", "grid_of", "kept", "padded", "refuse_errors"]


class Refusal(Exception):  # noqa: N818 - it is no error of ours: Excel shows one
    """The whole result is an error."""

    def __init__(self, code: ErrorCode) -> None:
        super().__init__(code.text)
        self.code = code


def array_function(
    name: str, *parameters: Parameter, sized_by_numbers: bool = False
) -> Callable[[Callable[..., Value]], Callable[..., Value]]:
    """Register a body that gives an array, (n, r, c), or raises `Refusal`; see `Facts` for what sizes it."""
    facts = Facts(spills=True, sized_by_numbers=sized_by_numbers)

    def register(body: Callable[..., Value]) -> Callable[..., Value]:
        @wraps(body)
        def refusing(*values: Value) -> Value:
            try:
                return body(*values)
            except Refusal as refusal:
                return constant(refusal.code)

        excel(name, *parameters, returns=Kind.ANY, facts=facts)(refusing)
        return body

    return register


def refuse_errors(codes: Codes) -> None:
    """Refuse where the first error of each trial, (n,), is one.

    Raises:
        Refusal: there is that error in all trials.
        ShapeVaries: it differs between trials.
    """
    code = int(same_in_all_trials(codes))
    if code:
        raise Refusal(ErrorCode(code))


def grid_of(value: Value) -> Value:
    """An argument as a range; a single error is refused."""
    refuse_errors(direct_errors(value))
    return value.as_range()


def decided(value: Value | None, default: float | None = None) -> int | None:
    """A whole number that decides on the shape; the default where it is left out or empty."""
    if value is None or same_in_all_trials(flattened(value.kinds == BLANK, value)).all():
        return None if default is None else int(default)
    numbers, errors = if_blank(value).to_numbers()
    refuse_errors(first_errors(flattened(errors, value)))
    if value.numbers.ndim == 3 and value.shape[1:] != (1, 1):
        raise Refusal(ErrorCode.CALC)  # each of many numbers would make an array of its own
    return int(np.trunc(same_in_all_trials(flattened(numbers, value))[0]))


def kept(mask: Bools) -> Places:
    """The places that are kept: (n, k) -> (n, as many as are TRUE).

    Raises:
        ShapeVaries: as many differ between trials.
        Refusal: there are none.
    """
    count = int(same_in_all_trials(mask.sum(axis=1)))
    if count == 0:
        raise Refusal(ErrorCode.CALC)
    return np.argsort(~mask, axis=1, kind="stable")[:, :count]


def padded(cells: Value, rows: Places, columns: Places, pad: Value | None) -> Value:
    """The cells at these places, (1, r, c) together; the pad, or `#N/A`, where a place lies outside."""
    inside = (rows < cells.shape[1]) & (columns < cells.shape[2])
    found = picked(cells, np.minimum(rows, cells.shape[1] - 1), np.minimum(columns, cells.shape[2] - 1))
    missing = pad is None or bool((pad.kinds == BLANK).all())
    return choose(inside, found, constant(ErrorCode.NA) if pad is None or missing else pad)
