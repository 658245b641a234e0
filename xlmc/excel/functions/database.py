"""Database functions: they reduce one field of the records that match a range of criteria.

The first row of the database and of the criteria names the fields, in upper or lower case. A record matches if it
matches all cells of at least one row of the criteria; an empty cell matches every record. Criteria are described in
`criteria`, but here a text without an operator matches every text that begins with it. Letters: n trials, k records.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.arguments import error_everywhere, error_where, errors_unless_range, first_error, with_errors
from xlmc.excel.functions.criteria import which_meet
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.logical import choose
from xlmc.excel.functions.lookup.picked_cells import Indices, arrange, by_portions, cell_of, map_parts, pick
from xlmc.excel.functions.math import aggregate
from xlmc.excel.functions.math.conditional import Reduce, fold_of_numbers
from xlmc.excel.functions.ordering import to_ordered
from xlmc.excel.functions.registry import Anything, Cells, Kind, excel
from xlmc.excel.functions.values import BLANK, ERROR, NUMBER, TEXT, Bools, Value, constant

__all__: list[str] = []


def _match(database: Value, criteria: Value, date1904: bool) -> Bools:
    """Return which records match the criteria: (n, k)."""
    result = np.zeros((1, database.shape[1] - 1), bool)
    for row in range(1, criteria.shape[1]):
        matching = np.ones((1, 1), bool)
        for column in range(criteria.shape[2]):
            name, criterion = cell_of(criteria, 0, column), cell_of(criteria, row, column)
            matching = matching & _match_cell(database, name, criterion, date1904)
        result = result | matching
    return result


def _match_cell(database: Value, name: Value, criterion: Value, date1904: bool) -> Bools:
    """Return which records match one cell of the criteria."""
    empty = np.asarray(criterion.kinds == BLANK)
    if criterion.texts is not None:
        empty = empty | ((criterion.kinds == TEXT) & (criterion.texts == ""))
    index = _field_named(database, name)
    if ((index < 0) & ~empty).any():
        raise FormulaError(
            "a criterion stands under a heading that is not a field of the database",
            hint="computed criteria are not supported; compute them in a column of the database",
        )
    result = empty[:, None]
    for field in np.unique(index[index >= 0]):
        matching = which_meet(criterion, _records(database, field), begins=True, date1904=date1904)
        result = result | ((index == field)[:, None] & matching)
    return result


def _records(database: Value, field: int) -> Value:
    return map_parts(database, lambda part: part[:, 1:, field : field + 1])


def _field_named(database: Value, name: Value) -> Indices:
    """Return the first column with that heading, counted from 0, or -1: (n,). Headings are texts: 1 is `1`."""
    wanted, headings = to_ordered(_as_heading(name), _as_heading(map_parts(database, lambda part: part[:, :1])))
    same = (headings.kinds == wanted.kinds) & (headings.order == wanted.order) & (wanted.kinds != BLANK)
    return np.where(same.any(axis=1), same.argmax(axis=1), -1)


def _as_heading(value: Value) -> Value:
    """Numbers and logicals as the texts that `&` makes of them."""
    texts, _ = value.to_texts()
    is_text = np.broadcast_to((value.kinds != BLANK) & (value.kinds < ERROR), texts.shape)
    kinds = np.where(is_text, np.uint8(TEXT), value.kinds).astype(np.uint8)
    return Value(np.broadcast_to(value.numbers, texts.shape), kinds, texts)


def _find_field(database: Value, field: Value) -> tuple[Indices, Bools]:
    """Return the column of a field, given by name or number, counted from 0; and whether there is one."""
    index = np.where(field.kinds == TEXT, _field_named(database, field), np.trunc(field.numbers) - 1)
    known = (index >= 0) & (index < database.shape[2])
    return np.where(known, index, 0).astype(np.intp), known


def _reduce_records(database: Value, field: Value, criteria: Value, reduce: Reduce, date1904: bool) -> Value:
    """Return one value for each cell of `field`."""
    errors = first_error(errors_unless_range(database), errors_unless_range(criteria))
    cells, conditions = database.as_range(), criteria.as_range()
    if cells.shape[1] < 2 or conditions.shape[1] < 2:
        return error_everywhere(field, ErrorCode.VALUE, errors if field.numbers.ndim == 1 else errors.reshape(-1, 1, 1))

    def compute(cells: Value, field: Value, conditions: Value) -> Value:
        return with_errors(_reduce_field(cells, field, reduce, _match(cells, conditions, date1904)), field.errors)

    width = cells.shape[1] * cells.shape[2]
    if field.numbers.ndim == 1:
        return with_errors(by_portions(compute, [cells, field, conditions], width), errors)
    shape = np.ndindex(*field.shape[1:])
    results = [by_portions(compute, [cells, cell_of(field, *each), conditions], width) for each in shape]
    return with_errors(arrange(results, *field.shape[1:]), errors.reshape(-1, 1, 1))


def _reduce_field(cells: Value, field: Value, reduce: Reduce, matching: Bools) -> Value:
    index, known = _find_field(cells, field)
    column = pick(cells, np.arange(1, cells.shape[1])[None, :, None], index[:, None, None])
    return with_errors(reduce(column, matching), error_where(~known, ErrorCode.VALUE))


_OF_NUMBERS: Final = Facts(empty_cells=EmptyCells.IGNORED_IN_FIRST)


def _register(name: str, meaning: str, reduce: Reduce, returns: Kind = Kind.NUMBER, facts: Facts = _OF_NUMBERS) -> None:
    def body(database: Value, field: Value, criteria: Value, *, date1904: bool = False) -> Value:
        return _reduce_records(database, field, criteria, reduce, date1904)

    body.__doc__ = meaning
    excel(name, Cells, Anything, Cells, returns=returns, dated=True, facts=facts)(body)


_register("DSUM", "Sum of the field's numbers.", fold_of_numbers(aggregate.sum_))
_register("DPRODUCT", "Product of the field's numbers; 0 of none.", fold_of_numbers(aggregate.product))
_register("DAVERAGE", "Mean of the field's numbers; `#DIV/0!` of none.", fold_of_numbers(aggregate.average))
_register("DMIN", "Smallest of the field's numbers; 0 of none.", fold_of_numbers(aggregate.minimum))
_register("DMAX", "Largest of the field's numbers; 0 of none.", fold_of_numbers(aggregate.maximum))
_register("DVAR", "Variance, the records being a sample.", fold_of_numbers(aggregate.sample_variance))
_register("DVARP", "Variance of the records.", fold_of_numbers(aggregate.population_variance))
_register("DSTDEV", "Standard deviation, the records being a sample.", fold_of_numbers(aggregate.sample_deviation))
_register("DSTDEVP", "Standard deviation of the records.", fold_of_numbers(aggregate.population_deviation))


def _only_cell(column: Value, matching: Bools) -> Value:
    """Return the cell of the only record; `#VALUE!` for no record, `#NUM!` for several."""
    value = pick(column, matching.argmax(axis=1), np.zeros(1, np.intp))
    count = matching.sum(axis=1)
    none, several = error_where(count == 0, ErrorCode.VALUE), error_where(count > 1, ErrorCode.NUM)
    return with_errors(value, first_error(none, several))


_register("DGET", "The field of the only record that matches the criteria.", _only_cell, Kind.ANY, Facts())


def _register_count(name: str, meaning: str, counts: Callable[[Value], Bools]) -> None:
    """Register a count, which needs no field: without one it counts the records."""

    def of_field(column: Value, matching: Bools) -> Value:
        is_counted = np.broadcast_to(counts(column), column.shape)[:, :, 0]
        return Value.of_numbers((matching & is_counted).sum(axis=1).astype(np.float64))

    def of_all(column: Value, matching: Bools) -> Value:
        return Value.of_numbers(matching.sum(axis=1).astype(np.float64))

    def body(database: Value, field: Value, criteria: Value, *, date1904: bool = False) -> Value:
        counted = _reduce_records(database, field, criteria, of_field, date1904)
        absent = field.kinds == BLANK
        if not absent.any():
            return counted
        return choose(absent, _reduce_records(database, constant(1), criteria, of_all, date1904), counted)

    body.__doc__ = meaning
    excel(name, Cells, Anything, Cells, dated=True, facts=_OF_NUMBERS)(body)


_register_count("DCOUNT", "How many of the records have a number in the field.", lambda column: column.kinds == NUMBER)
_register_count("DCOUNTA", "How many of the records have anything in the field.", lambda column: column.kinds != BLANK)
