"""Many values as one text."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import first_error, first_error_in_row, with_errors
from xlmc.excel.functions.budget import ask_for_texts, count_characters
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.per_element import object_text, per_element, per_object
from xlmc.excel.functions.registry import Anything, Cells, Kind, Logical, Text, excel
from xlmc.excel.functions.text.text_parts import LONGEST, fits_in_a_cell
from xlmc.excel.functions.values import Codes, Objects, Value, constant, from_objects

__all__: list[str] = []


@excel("CONCATENATE", Text(repeat=True), returns=Kind.TEXT, aliases=("&",))
@per_element
def concatenate(*texts: str) -> object:
    """Join the texts, one after the other; `a & b & c` is one call, for two would copy the first texts twice."""
    joined = "".join(texts)
    return joined if fits_in_a_cell(joined) else ErrorCode.VALUE


@excel("CONCAT", Cells(repeat=True), returns=Kind.TEXT, facts=Facts(empty_cells=EmptyCells.IGNORED))
def concat(*values: Value) -> Value:
    """Return the texts of all cells, row by row."""
    texts, errors = _texts_of_cells(values)
    return with_errors(_value_of_trials(_join_within_limit(row) for row in texts.tolist()), errors)


def _join_within_limit(texts: list[str]) -> str:
    """Join the texts; where they are much too long together, a text that is just too long stands for them."""
    return "".join(texts) if sum(map(len, texts)) <= 2 * LONGEST else "x" * (LONGEST + 1)


@excel("TEXTJOIN", Cells, Logical, Cells(repeat=True), returns=Kind.TEXT)
def text_join(delimiters: Value, ignore_empty: Value, *values: Value) -> Value:
    """Join the texts of all cells with a delimiter between each two; several delimiters take turns.

    Where `ignore_empty`, empty texts are left out.
    """
    between, wrong = _texts_of_cells([delimiters])
    ignore, unclear = ignore_empty.to_logicals()
    texts, errors = _texts_of_cells(values)
    n = max(len(between), len(texts), ignore.shape[0])
    marks, words = _tall(between, n), _tall(texts, n)
    skip = np.broadcast_to(ignore, (n, *ignore.shape[1:]))
    out = np.empty(skip.shape, object)
    trials = np.broadcast_to(np.arange(n).reshape(n, *(1,) * (skip.ndim - 1)), skip.shape).ravel().tolist()
    rows = zip(trials, skip.ravel().tolist(), strict=True)
    out.reshape(-1)[:] = list(count_characters(_join(marks[i].tolist(), words[i].tolist(), flag) for i, flag in rows))
    inner = (-1, *(1,) * (ignore.ndim - 1))
    return with_errors(from_objects(out), first_error(wrong.reshape(inner), unclear, errors.reshape(inner)))


def _join(delimiters: list[str], texts: list[str], ignore_empty: bool) -> object:
    joined_texts = [text for text in texts if text] if ignore_empty else texts
    whole, rest = divmod(max(len(joined_texts) - 1, 0), len(delimiters))
    lengths = [len(delimiter) for delimiter in delimiters]
    if sum(map(len, joined_texts)) + whole * sum(lengths) + sum(lengths[:rest]) > LONGEST:
        return ErrorCode.VALUE
    turns = [*delimiters * whole, *delimiters[:rest], ""]
    joined = "".join(text + delimiter for text, delimiter in zip(joined_texts, turns, strict=False))
    return joined if fits_in_a_cell(joined) else ErrorCode.VALUE


def _texts_of_cells(values: Iterable[Value]) -> tuple[Objects, Codes]:
    """Return the texts of all cells, (n, k), and the first error of each trial."""
    columns, codes = [], []
    for value in values:
        texts, errors = value.to_texts()
        columns.append(texts.reshape(texts.shape[0], -1))
        codes.append(np.broadcast_to(errors, texts.shape).reshape(texts.shape[0], -1))
    n = max(column.shape[0] for column in columns)
    ask_for_texts(n * sum(column.shape[1] for column in columns))
    texts, errors = (np.concatenate([_tall(part, n) for part in parts], axis=1) for parts in (columns, codes))
    return texts, first_error_in_row(errors)


def _tall(rows: Objects, n: int) -> Objects:
    return np.broadcast_to(rows, (n, rows.shape[1]))


def _value_of_trials(texts: Iterable[str]) -> Value:
    joined = list(texts)
    box = np.empty(len(joined), object)
    box[:] = joined
    return _refuse_long(box)


def _refuse_long(texts: Objects) -> Value:
    """`#VALUE!` for texts longer than a cell holds."""
    flat = texts.ravel().tolist()
    codes = [0 if fits_in_a_cell(text) else ErrorCode.VALUE for text in flat]
    joined_texts = ["" if code else text for text, code in zip(flat, codes, strict=True)]
    box: Objects = np.empty(texts.shape, object)
    box.reshape(-1)[:] = list(count_characters(joined_texts))
    return Value.of_texts(box, np.array(codes, np.uint8).reshape(texts.shape))


def _quote(item: object) -> str:
    """Write a value as in a formula: texts in quotes."""
    return '"{}"'.format(item.replace('"', '""')) if isinstance(item, str) else object_text(item)


@excel("VALUETOTEXT", Anything, Anything(default=0.0), returns=Kind.ANY)
def value_to_text(value: Value, style: Value | None = None) -> Value:
    """Any value as a text, errors too; in style 1 as it is written in a formula."""
    concise, strict = (np.asarray(np.frompyfunc(write, 1, 1)(value.objects())) for write in (object_text, _quote))
    return _choose_style(from_objects(concise), from_objects(strict), style)


def _choose_style(concise: Value, strict: Value, style: Value | None) -> Value:
    """Return the text in the style asked for; `#VALUE!` for a style that is neither 0 nor 1."""
    return _in_style(concise, strict, constant(0.0) if style is None else style)


@per_object
def _in_style(concise: str, strict: str, style: float | bool | str | None) -> object:
    if isinstance(style, str) or not 0 <= (style or 0) < 2:
        return ErrorCode.VALUE
    return strict if (style or 0) >= 1 else concise


@excel("ARRAYTOTEXT", Cells, Anything(default=0.0), returns=Kind.TEXT)
def array_to_text(cells: Value, style: Value | None = None) -> Value:
    """All cells as one text, errors too; in style 1 as an array is written in a formula, in braces."""
    tables = cells.as_range().objects()
    concise = _value_of_trials(", ".join(map(object_text, table.ravel())) for table in tables)
    strict = _value_of_trials(_array_literal(table) for table in tables)
    return _choose_style(concise, strict, style)


def _array_literal(table: Objects) -> str:
    return "{{{}}}".format(";".join(",".join(map(_quote, row)) for row in table))
