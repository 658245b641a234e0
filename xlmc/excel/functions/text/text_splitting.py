"""Texts cut at delimiters."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import align_ranges
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.per_element import object_text
from xlmc.excel.functions.registry import Anything, Cells, Kind, excel
from xlmc.excel.functions.text.text_parts import to_units
from xlmc.excel.functions.values import Objects, ShapeVaries, Value, constant, from_objects

__all__: list[str] = []

_LEFT_OUT: Final = constant(None)

Cut = Callable[[str, tuple[int, int]], str]


def _register(name: str, meaning: str, cut: Cut) -> None:
    """Register `TEXTBEFORE` or `TEXTAFTER`, which differ in the side of the delimiter that they keep."""

    def body(text: Value, delimiters: Value, *options: Value) -> Value:
        texts, *others = align_ranges(text, *options)
        marks = _marks(delimiters, texts.numbers.ndim)
        piece = np.frompyfunc(lambda *items: _piece(cut, *items), 2 + len(others), 1)
        return from_objects(np.asarray(piece(texts.objects(), marks, *(value.objects() for value in others)), object))

    body.__doc__ = meaning
    excel(name, Anything, Cells, *(Anything(default=None),) * 4, returns=Kind.ANY)(body)


def _marks(delimiters: Value, dimensions: int) -> Objects:
    """All delimiters of each trial as one tuple, (n,) or (n, 1, 1)."""
    objects = delimiters.objects()
    rows = [tuple(row) for row in objects.reshape(len(objects), -1)]
    box = np.empty(len(rows), object)
    box[:] = rows
    return box.reshape(-1, *(1,) * (dimensions - 1))


def _piece(
    cut: Cut,
    text: object,
    marks: Sequence[object],
    which: object = None,
    fold: object = None,
    at_end: object = None,
    instead: object = None,
) -> object:
    """Return what stands on one side of the n-th delimiter."""
    error = _first_error(text, *marks, which, fold, at_end)
    if error is not None:
        return error
    number, case, end = _whole_number(which, 1), _whole_number(fold, 0), _whole_number(at_end, 0)
    source = object_text(text)
    if not number or case not in (0, 1) or end not in (0, 1):
        return ErrorCode.VALUE
    if not source:
        return ""
    if abs(number) > len(to_units(source)):
        return ErrorCode.VALUE
    result = _occurrence(source, [object_text(mark) for mark in marks], number, bool(case), bool(end))
    if result is not None:
        return cut(source, result)
    return ErrorCode.NA if instead is None else instead


def _first_error(*items: object) -> ErrorCode | None:
    return next((item for item in items if isinstance(item, ErrorCode)), None)


def _whole_number(item: object, default: int) -> int | None:
    """Round a number down, -1.6 to -2; a default for what is left out."""
    if item is None:
        return default
    return math.floor(item) if isinstance(item, float | bool) else None


def _occurrence(text: str, marks: list[str], number: int, fold: bool, at_end: bool) -> tuple[int, int] | None:
    """Return the start and the end of the n-th delimiter, counted from the end if negative; None when there are fewer.

    With `at_end`, the end of the text that the count runs to is a delimiter, too. An empty delimiter is found at once.
    """
    far_end = (len(text), len(text)) if number > 0 else (0, 0)
    if "" in marks:
        return (0, 0) if number > 0 else (len(text), len(text))
    spans = [match.span() for match in _delimiter(marks, fold).finditer(text)]
    if at_end:
        spans = [*spans, far_end] if number > 0 else [far_end, *spans]
    if abs(number) > len(spans):
        return None
    return spans[number - 1 if number > 0 else number]


def _delimiter(marks: Iterable[str], fold: bool) -> re.Pattern[str]:
    """Compile a pattern that finds any of the delimiters, the longest first."""
    longest_first = sorted(set(marks), key=len, reverse=True)
    return re.compile("|".join(map(re.escape, longest_first)), re.IGNORECASE if fold else 0)


_register("TEXTBEFORE", "What stands before the n-th delimiter; `#N/A` without it.", lambda text, span: text[: span[0]])
_register("TEXTAFTER", "What stands after the n-th delimiter; `#N/A` without it.", lambda text, span: text[span[1] :])


@excel(
    "TEXTSPLIT",
    Anything,
    Cells,
    Cells(default=None),
    Anything(default=None),
    Anything(default=None),
    Anything(default=None),
    returns=Kind.ANY,
    facts=Facts(spills=True),
)
def text_split(text: Value, *options: Value) -> Value:
    """Cut a text into columns, and rows, at delimiters; short rows are filled up with `pad`. Several texts give the
    first piece of each.

    Raises:
        ShapeVaries: not all trials have as many pieces.
    """
    arguments = [text, *options, *[_LEFT_OUT] * (5 - len(options))]
    if text.numbers.ndim == 3 and text.shape[1:] != (1, 1):
        return _first_pieces(arguments)
    n = max(value.shape[0] for value in arguments)
    tables = [_table(*[_cells_of_trial(value, i) for value in arguments]) for i in range(n)]
    if len({table.shape for table in tables}) > 1:
        raise ShapeVaries
    return from_objects(np.stack(tables))


def _cells_of_trial(value: Value, index: int) -> list[object]:
    """Return the cells of one trial."""
    objects = value.objects()
    return list(objects[index : index + 1].ravel() if len(objects) > 1 else objects.ravel())


def _first_pieces(arguments: list[Value]) -> Value:
    n = max(value.shape[0] for value in arguments)
    trials = [[_cells_of_trial(value, i) for value in arguments] for i in range(n)]
    pieces = [_table([cell], *rest)[0, 0] for texts, *rest in trials for cell in texts]
    out = np.empty(len(pieces), object)
    out[:] = pieces
    return from_objects(out.reshape(n, *arguments[0].shape[1:]))


def _table(*cells: list[object]) -> Objects:
    """Rows of pieces, (r, c), or a single error."""
    text, columns, rows, ignore, fold, pad = cells
    error = _first_error(*text, *columns, *rows, *ignore, *fold)
    if error is not None:
        return _single_cell(error)
    skip, case = _whole_number(ignore[0], 0), _whole_number(fold[0], 0)
    marks = [[object_text(mark) for mark in part if mark is not None] for part in (rows, columns)]
    if skip is None or case not in (0, 1) or not any(marks) or "" in marks[0] + marks[1]:
        return _single_cell(ErrorCode.VALUE)
    lines = _cut(object_text(text[0]), marks[0], bool(skip), bool(case))
    pieces = [_cut(line, marks[1], bool(skip), bool(case)) for line in lines]
    return _fill_up(pieces, ErrorCode.NA if pad[0] is None else pad[0])


def _single_cell(item: object) -> Objects:
    table = np.empty((1, 1), object)
    table[0, 0] = item
    return table


def _cut(text: str, marks: list[str], ignore_empty: bool, fold: bool) -> list[str]:
    pieces = _delimiter(marks, fold).split(text) if marks else [text]
    return [piece for piece in pieces if piece] if ignore_empty else pieces


def _fill_up(rows: list[list[str]], pad: object) -> Objects:
    width = max((len(row) for row in rows), default=0)
    if not width:
        return _single_cell(ErrorCode.CALC)
    table = np.empty((len(rows), width), object)
    for index, row in enumerate(rows):
        table[index] = [*row, *[pad] * (width - len(row))]
    return table
