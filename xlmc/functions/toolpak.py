"""How the functions of the former Analysis ToolPak take their arguments.

To them a logical is no number but `#VALUE!`; a text that stands for a number is one wherever it stands, in a range
too, and a blank is 0. Where they want one value, a range of several cells is `#VALUE!`, in array formulas too; an array
is not: `EDATE(A1:A3,1)` is `#VALUE!`, and `EDATE(+A1:A3,1)` in an array formula gives three dates. The file format has
these arguments as references, not values.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import earliest, leveled
from xlmc.functions.lookup.picking import flattened as in_rows
from xlmc.functions.registry import Anything, Ranges
from xlmc.functions.values import LOGICAL, Codes, Floats, Value, from_objects, parse_number

__all__ = ["OneCell", "flattened", "number_of", "numbers_only", "per_object", "strict_numbers"]


OneCell: Final = Anything(ranges=Ranges.ONE_CELL)
"""An argument that takes one value of any kind."""


def strict_numbers(value: Value) -> tuple[Floats, Codes]:
    """The numbers and their errors, `#VALUE!` for a logical."""
    numbers, errors = value.to_numbers()
    return numbers, np.where(value.kinds == LOGICAL, np.uint8(ErrorCode.VALUE), errors).astype(np.uint8)


def number_of(item: object) -> float | ErrorCode:
    """The same for one Python object of `Value.objects`."""
    match item:
        case None:
            return 0.0
        case bool():
            return ErrorCode.VALUE
        case str():
            number = parse_number(item)
            return ErrorCode.VALUE if number is None else number
        case ErrorCode() | float():
            return item
        case _:
            raise TypeError(f"{item!r} is no Excel value")


def numbers_only(body: Callable[..., Any]) -> Callable[..., Value]:
    """A body for `Anything` arguments from one that takes and gives arrays, as those of `Number` arguments do."""

    @wraps(body)
    def strict(*values: Value) -> Value:
        pairs = [strict_numbers(value) for value in leveled(*values)]
        result = np.atleast_1d(body(*(numbers for numbers, _ in pairs)))
        errors = earliest(*(found for _, found in pairs))
        return Value.of_logicals(result, errors) if result.dtype == bool else Value.of_numbers(result, errors)

    return strict


def per_object(function: Callable[..., object]) -> Callable[..., Value]:
    """A body for `Anything` arguments from a function of Python objects, called once an element.

    The function takes floats, bools, strings and None, never an error: the first error among the arguments is the
    result without it. It returns one of these, or an `ErrorCode`.
    """

    @wraps(function)
    def body(*values: Value) -> Value:
        arguments = [value.objects() for value in leveled(*values)]
        shape = np.broadcast_shapes(*(items.shape for items in arguments))
        spread = [np.broadcast_to(items, shape) for items in arguments]
        out = np.empty(shape, object)
        for place in np.ndindex(*shape):
            items = [array[place] for array in spread]
            error = next((item for item in items if isinstance(item, ErrorCode)), None)
            out[place] = function(*items) if error is None else error
        return from_objects(out)

    return body


def flattened(values: Sequence[Value]) -> tuple[Floats, Codes]:
    """All cells of all arguments side by side as strict numbers, and their errors: (n, k), (n, k)."""
    parts = [(value, *strict_numbers(value)) for value in values]
    n = max(value.shape[0] for value in values)
    numbers = np.concatenate([_tall(in_rows(x, value), n) for value, x, _ in parts], axis=1)
    errors = np.concatenate([_tall(in_rows(codes, value), n) for value, _, codes in parts], axis=1)
    return numbers, errors


def _tall(rows: NDArray[Any], n: int) -> NDArray[Any]:
    return np.broadcast_to(rows, (n, rows.shape[1]))
