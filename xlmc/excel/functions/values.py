"""Excel values over trials: numbers, logicals, texts, blanks and errors, all in one array.

Trials are axis 0: a scalar cell is `(n,)`, a range `(n, r, c)`; a constant has n = 1 and broadcasts.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, Concatenate, Final, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.excel.functions.budget import ask_for_characters, ask_for_texts, bytes_of
from xlmc.excel.functions.denormals import TINIEST, tiny_to_zero
from xlmc.excel.functions.number_text import general_text, parse_number

__all__ = [
    "BLANK",
    "DIV0",
    "ERROR",
    "LOGICAL",
    "NA",
    "NUM",
    "NUMBER",
    "REF",
    "TEXT",
    "VALUE",
    "Bools",
    "Codes",
    "Floats",
    "Objects",
    "ShapeVaries",
    "Value",
    "constant",
    "from_objects",
    "general_text",
    "kept_with_table",
    "parse_number",
    "unbox_errors",
]

P = ParamSpec("P")
T = TypeVar("T")

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Codes = NDArray[np.uint8]
Objects = NDArray[Any]

NUMBER: Final = 0
LOGICAL: Final = 1
TEXT: Final = 2
BLANK: Final = 3
ERROR: Final = 16
"""Kinds of value; an error's kind is ERROR + its `ErrorCode`."""

_QUIET_NAN = 0x7FF8_0000_0000_0000


def _box(code: ErrorCode) -> float:
    return float(np.array(_QUIET_NAN | int(code), dtype=np.uint64).view(np.float64))


DIV0: Final = _box(ErrorCode.DIV0)
VALUE: Final = _box(ErrorCode.VALUE)
REF: Final = _box(ErrorCode.REF)
NUM: Final = _box(ErrorCode.NUM)
NA: Final = _box(ErrorCode.NA)
"""Errors that a function body puts into its float result: NaNs that carry their code. Put them there last, with
`np.where`: arithmetic on a NaN may lose the code."""


def unbox_errors(x: Floats) -> Codes:
    """Return each element's error, 0 for none: the code that a NaN carries, `#NUM!` for a plain NaN or infinity."""
    bad = ~np.isfinite(x)
    if not bad.any():
        return np.zeros(x.shape, np.uint8)
    payload = (np.ascontiguousarray(x).view(np.uint64) & np.uint64(0xFF)).astype(np.uint8)
    carried = np.isnan(x) & (payload > 0)
    return np.where(bad, np.where(carried, payload, np.uint8(ErrorCode.NUM)), np.uint8(0))


class ShapeVaries(Exception):  # noqa: N818 - it is no error: the body asks to be called for one trial at a time
    """The shape of the result differs between trials: evaluate trial by trial."""


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Value:
    """One Excel value per trial (and per cell of a range).

    Attributes:
        numbers: `(n,)` or `(n, r, c)`; 1.0 or 0.0 for a logical; 0.0 for any other kind.
        kinds: the same shape, or one that broadcasts to it.
        texts: strings where the kind is TEXT; None when there is none.
    """

    numbers: Floats
    kinds: Codes
    texts: Objects | None = None

    @classmethod
    def of_numbers(cls, x: Floats, errors: Codes | None = None) -> Value:
        """Make numbers of floats, with errors boxed in them or beside them; 0 where they are too small for Excel."""
        if errors is None and x.size == 1:  # as nearly every constant
            number = x.item()
            if number == 0.0 or TINIEST <= abs(number) < math.inf:
                return cls(x, np.zeros((1,) * x.ndim, np.uint8))
        x = tiny_to_zero(x)
        codes = unbox_errors(x) if errors is None else np.where(errors > 0, errors, unbox_errors(x))
        return cls._with_errors(x, codes, NUMBER)

    @classmethod
    def of_logicals(cls, x: Bools, errors: Codes | None = None) -> Value:
        """Make logicals of booleans, with errors beside them."""
        codes = np.zeros(1, np.uint8) if errors is None else errors
        return cls._with_errors(x.astype(np.float64), codes, LOGICAL)

    @classmethod
    def of_texts(cls, x: Objects, errors: Codes | None = None) -> Value:
        """Make texts of strings, with errors beside them."""
        zeros = np.zeros(x.shape)
        kinds = np.full(x.shape, TEXT, np.uint8)
        if errors is not None:
            kinds = np.where(errors > 0, errors + np.uint8(ERROR), kinds).astype(np.uint8)
        return cls(zeros, kinds, x)

    @classmethod
    def of_errors(cls, codes: Codes) -> Value:
        """Make errors of codes, none of which is 0."""
        return cls(np.zeros(codes.shape), (codes + np.uint8(ERROR)).astype(np.uint8))

    @classmethod
    def _with_errors(cls, x: Floats, codes: Codes, kind: int) -> Value:
        if not codes.any():
            return cls(x, np.full((1,) * x.ndim, kind, np.uint8))
        kinds = np.where(codes > 0, codes + np.uint8(ERROR), np.uint8(kind)).astype(np.uint8)
        return cls(np.where(codes > 0, 0.0, x), kinds)

    @property
    def shape(self) -> tuple[int, ...]:
        own: tuple[int, ...] = self.numbers.shape
        return own if self.kinds.shape == own else np.broadcast_shapes(own, self.kinds.shape)

    @property
    def errors(self) -> Codes:
        """The error codes, 0 where there is none; they broadcast to the shape."""
        if self.kinds.size == 1 and self.kinds.item() < ERROR:  # as nearly every constant
            return np.zeros(self.kinds.shape, np.uint8)
        return np.maximum(self.kinds, np.uint8(ERROR)) - np.uint8(ERROR)

    @property
    def has_errors(self) -> bool:
        return bool((self.kinds >= ERROR).any())

    @property
    def plain(self) -> bool:
        """Whether there is neither a text nor an error, so that arithmetic may ignore the kinds."""
        return not (self.kinds >= ERROR).any() and not (self.kinds == TEXT).any()

    def take(self, index: NDArray[np.intp]) -> Value:
        """Return the trials of `index`; a constant stays as it is."""
        if self.shape[0] == 1:
            return self
        pick = [None if a is None else (a if a.shape[0] == 1 else a[index]) for a in self.arrays()]
        return Value(pick[0], pick[1], pick[2])  # type: ignore[arg-type]  # only texts may be None

    def arrays(self) -> tuple[NDArray[Any] | None, ...]:
        """Return numbers, kinds and texts."""
        return self.numbers, self.kinds, self.texts

    def as_range(self) -> Value:
        """Return a scalar `(n,)` as the range `(n, 1, 1)`, and a range as it is."""
        if self.numbers.ndim == 3:
            return self
        parts = [None if a is None else a.reshape(-1, 1, 1) for a in self.arrays()]
        return Value(parts[0], parts[1], parts[2])  # type: ignore[arg-type]  # only texts may be None

    def to_numbers(self) -> tuple[Floats, Codes]:
        """Convert for arithmetic: logicals to 1 and 0, blanks to 0, texts to the numbers they read as or `#VALUE!`."""
        if self.texts is None or not (self.kinds == TEXT).any():
            return self.numbers, self.errors
        numbers, errors = (np.array(np.broadcast_to(a, self.shape)) for a in (self.numbers, self.errors))
        is_text = np.broadcast_to(self.kinds == TEXT, self.shape)
        ask_for_texts(int(np.count_nonzero(is_text)))
        read = [parse_number(text) for text in np.broadcast_to(self.texts, self.shape)[is_text].tolist()]
        numbers[is_text] = [0.0 if number is None else number for number in read]
        errors[is_text] = [ErrorCode.VALUE if number is None else 0 for number in read]
        return numbers, errors

    def to_logicals(self) -> tuple[Bools, Codes]:
        """Convert for a condition: numbers by `<> 0`, blanks to FALSE; texts but TRUE and FALSE to `#VALUE!`."""
        truth, errors = self.numbers != 0, self.errors
        if self.texts is None or not (self.kinds == TEXT).any():
            return truth, errors
        folded = np.array([str(t).casefold() for t in self.texts.ravel()], object).reshape(self.texts.shape)
        is_text = self.kinds == TEXT
        truth = np.where(is_text, folded == "true", truth)
        bad = is_text & (folded != "true") & (folded != "false")
        return truth, np.where(bad, np.uint8(ErrorCode.VALUE), errors).astype(np.uint8)

    def to_texts(self) -> tuple[Objects, Codes]:
        """Convert as `&` does: numbers to General format, logicals to `TRUE` and `FALSE`, blanks to empty texts."""
        errors = np.broadcast_to(self.errors, self.shape)
        if self.texts is not None and (self.kinds == TEXT).all():
            return np.broadcast_to(self.texts, self.shape), errors
        if errors.all():
            return np.full(self.shape, "", object), errors
        return self._map(_text), errors

    def objects(self) -> Objects:
        """Return each element as a Python object: float, bool, str, `ErrorCode`, or None for a blank."""
        return self._map(_object)

    def _map(self, function: Callable[[float, int, str], object]) -> Objects:
        """Call the function with the number, kind and text of each element."""
        shape = self.shape
        out: Objects = np.empty(shape, object)
        if out.size == 1:  # as nearly every constant
            out.flat[0] = function(
                self.numbers.item(), self.kinds.item(), "" if self.texts is None else self.texts.item()
            )
            return out
        ask_for_texts(out.size)
        numbers, kinds = (np.broadcast_to(part, shape).ravel().tolist() for part in (self.numbers, self.kinds))
        texts = [""] * out.size if self.texts is None else np.broadcast_to(self.texts, shape).ravel().tolist()
        out.reshape(-1)[:] = [function(*parts) for parts in zip(numbers, kinds, texts, strict=True)]
        return out

    @property
    def nbytes(self) -> int:
        """About how much memory it takes."""
        return bytes_of(self.arrays())


def _text(number: float, kind: int, text: str) -> str:
    if kind == NUMBER:
        return general_text(number)
    if kind == LOGICAL:
        return "TRUE" if number else "FALSE"
    return text if kind == TEXT else ""


def _object(number: float, kind: int, text: str) -> object:
    if kind >= ERROR:
        return ErrorCode(kind - ERROR)
    return {NUMBER: number, LOGICAL: bool(number), TEXT: text}.get(kind)


def from_objects(items: Objects) -> Value:
    """Make a value of Python objects: the inverse of `Value.objects`."""
    ask_for_texts(items.size)
    flat = items.ravel().tolist()
    kinds = np.array([_kind(item) for item in flat], np.uint8).reshape(items.shape)
    numbers = tiny_to_zero(np.array([_number(item) for item in flat], np.float64).reshape(items.shape))
    if not (kinds == TEXT).any():
        return Value(numbers, kinds)
    written = [item if isinstance(item, str) else "" for item in flat]
    ask_for_characters(sum(map(len, written)))
    texts: Objects = np.empty(items.shape, object)
    texts.reshape(-1)[:] = written
    return Value(numbers, kinds, texts)


def _number(item: Any) -> float:
    return 0.0 if item is None or isinstance(item, str | ErrorCode) else float(item)


def _kind(item: object) -> int:
    match item:
        case None:
            return BLANK
        case bool() | np.bool_():
            return LOGICAL
        case ErrorCode():
            return ERROR + int(item)
        case str():
            return TEXT
        case _:
            return NUMBER


def kept_with_table(make: Callable[Concatenate[Value, P], T]) -> Callable[Concatenate[Value, P], T]:
    """Keep what a function makes of a value that does not vary as long as that value lives: lookups share tables.

    The arguments besides the value are hashable, and what is made does not hold the value.
    """
    kept: WeakKeyDictionary[Value, dict[tuple[object, ...], T]] = WeakKeyDictionary()

    @wraps(make)
    def made(value: Value, /, *args: P.args, **kwargs: P.kwargs) -> T:
        if value.shape[0] != 1 or kwargs:
            return make(value, *args, **kwargs)
        result = kept.setdefault(value, {})
        if args not in result:
            result[args] = make(value, *args, **kwargs)
        return result[args]

    return made


def constant(item: object) -> Value:
    """Make a constant, `(1,)`, of a Python object."""
    if type(item) is float:  # as nearly every cell of a table
        number = 0.0 if 0.0 < abs(item) < TINIEST else item
        return Value(np.array([number]), np.array([NUMBER], np.uint8))
    box = np.empty(1, object)
    box[0] = item
    return from_objects(box)
