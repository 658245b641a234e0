"""Database functions: of one field of the records that meet a range of criteria.

The first row of the database and of the criteria names fields, whatever their case. A record meets the criteria where
it meets all cells of one of their rows; an empty cell asks for nothing. Criteria are those of `criteria`, but a text
without an operator meets every text that begins with it. Letters: n trials, k records.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.functions.arguments import direct_errors, earliest, refused, where_wrong, with_errors
from xlmc.functions.criteria import met
from xlmc.functions.facts import EmptyCells, Facts
from xlmc.functions.logical import choose
from xlmc.functions.lookup.picked_cells import Indices, by_portions, cell_of, each_part, picked, side_by_side
from xlmc.functions.math import aggregate
from xlmc.functions.math.conditional import Reduce, numbers_held
from xlmc.functions.ordering import ordered
from xlmc.functions.registry import Anything, Cells, Kind, excel
from xlmc.functions.values import BLANK, NUMBER, TEXT, Bools, Value, constant

__all__: list[str] = []


def _meets(database: Value, criteria: Value, date1904: bool) -> Bools:
    """Which records meet the criteria: (n, k)."""
    result = np.zeros((1, database.shape[1] - 1), bool)
    for row in range(1, criteria.shape[1]):
        held = np.ones((1, 1), bool)
        for column in range(criteria.shape[2]):
            name, criterion = cell_of(criteria, 0, column), cell_of(criteria, row, column)
            held = held & _meets_cell(database, name, criterion, date1904)
        result = result | held
    return result


def _meets_cell(database: Value, name: Value, criterion: Value, date1904: bool) -> Bools:
    """Which records meet one cell of the criteria."""
    empty = np.asarray(criterion.kinds == BLANK)
    if criterion.texts is not None:
        empty = empty | ((criterion.kinds == TEXT) & (criterion.texts == ""))
    index = _field_named(database, name)
    if ((index < 0) & ~empty).any():
        raise FormulaError(
            "a criterion stands under a heading that is no field of the database",
            hint="computed criteria are not supported; compute them in a column of the database",
        )
    result = empty[:, None]
    for field in np.unique(index[index >= 0]):
        held = met(criterion, _records(database, field), begins=True, date1904=date1904)
        result = result | ((index == field)[:, None] & held)
    return result


def _records(database: Value, field: int) -> Value:
    return each_part(database, lambda part: part[:, 1:, field : field + 1])


def _field_named(database: Value, name: Value) -> Indices:
    """The first column with that heading, counted from 0, or -1: (n,)."""
    wanted, headings = ordered(name, each_part(database, lambda part: part[:, :1]))
    same = (headings.kinds == wanted.kinds) & (headings.order == wanted.order) & (wanted.kinds != BLANK)
    return np.where(same.any(axis=1), same.argmax(axis=1), -1)


def _field(database: Value, field: Value) -> tuple[Indices, Bools]:
    """The field's column, counted from 0, and whether there is one: by its name or its number."""
    index = np.where(field.kinds == TEXT, _field_named(database, field), np.trunc(field.numbers) - 1)
    known = (index >= 0) & (index < database.shape[2])
    return np.where(known, index, 0).astype(np.intp), known


def _of_records(database: Value, field: Value, criteria: Value, reduce: Reduce, date1904: bool) -> Value:
    """One value for each cell of `field`."""
    errors = earliest(direct_errors(database), direct_errors(criteria))
    cells, conditions = database.as_range(), criteria.as_range()
    if cells.shape[1] < 2 or conditions.shape[1] < 2:
        return refused(field, ErrorCode.VALUE, errors if field.numbers.ndim == 1 else errors.reshape(-1, 1, 1))

    def compute(cells: Value, field: Value, conditions: Value) -> Value:
        return with_errors(_reduced(cells, field, reduce, _meets(cells, conditions, date1904)), field.errors)

    width = cells.shape[1] * cells.shape[2]
    if field.numbers.ndim == 1:
        return with_errors(by_portions(compute, [cells, field, conditions], width), errors)
    shape = np.ndindex(*field.shape[1:])
    results = [by_portions(compute, [cells, cell_of(field, *each), conditions], width) for each in shape]
    return with_errors(side_by_side(results, *field.shape[1:]), errors.reshape(-1, 1, 1))


def _reduced(cells: Value, field: Value, reduce: Reduce, held: Bools) -> Value:
    index, known = _field(cells, field)
    column = picked(cells, np.arange(1, cells.shape[1])[None, :, None], index[:, None, None])
    return with_errors(reduce(column, held), where_wrong(~known, ErrorCode.VALUE))


_OF_NUMBERS: Final = Facts(empty_cells=EmptyCells.IGNORED_IN_FIRST)


def _register(name: str, meaning: str, reduce: Reduce, returns: Kind = Kind.NUMBER, facts: Facts = _OF_NUMBERS) -> None:
    def body(database: Value, field: Value, criteria: Value, *, date1904: bool = False) -> Value:
        return _of_records(database, field, criteria, reduce, date1904)

    body.__doc__ = meaning
    excel(name, Cells, Anything, Cells, returns=returns, dated=True, facts=facts)(body)


_register("DSUM", "Sum of the field's numbers.", numbers_held(aggregate.sum_))
_register("DPRODUCT", "Product of the field's numbers; 0 of none.", numbers_held(aggregate.product))
_register("DAVERAGE", "Mean of the field's numbers; `#DIV/0!` of none.", numbers_held(aggregate.average))
_register("DMIN", "Smallest of the field's numbers; 0 of none.", numbers_held(aggregate.minimum))
_register("DMAX", "Largest of the field's numbers; 0 of none.", numbers_held(aggregate.maximum))
_register("DVAR", "Variance, the records being a sample.", numbers_held(aggregate.sample_variance))
_register("DVARP", "Variance of the records.", numbers_held(aggregate.population_variance))
_register("DSTDEV", "Standard deviation, the records being a sample.", numbers_held(aggregate.sample_deviation))
_register("DSTDEVP", "Standard deviation of the records.", numbers_held(aggregate.population_deviation))


def _the_one(column: Value, held: Bools) -> Value:
    """The cell of the only record; `#VALUE!` for none, `#NUM!` for several."""
    found = picked(column, held.argmax(axis=1), np.zeros(1, np.intp))
    count = held.sum(axis=1)
    none, several = where_wrong(count == 0, ErrorCode.VALUE), where_wrong(count > 1, ErrorCode.NUM)
    return with_errors(found, earliest(none, several))


_register("DGET", "The field of the only record that meets the criteria.", _the_one, Kind.ANY, Facts())


def _count(name: str, meaning: str, counts: Callable[[Value], Bools]) -> None:
    """A count needs no field: without one it counts the records."""

    def of_field(column: Value, held: Bools) -> Value:
        kept = np.broadcast_to(counts(column), column.shape)[:, :, 0]
        return Value.of_numbers((held & kept).sum(axis=1).astype(np.float64))

    def of_all(column: Value, held: Bools) -> Value:
        return Value.of_numbers(held.sum(axis=1).astype(np.float64))

    def body(database: Value, field: Value, criteria: Value, *, date1904: bool = False) -> Value:
        counted = _of_records(database, field, criteria, of_field, date1904)
        absent = field.kinds == BLANK
        if not absent.any():
            return counted
        return choose(absent, _of_records(database, constant(1), criteria, of_all, date1904), counted)

    body.__doc__ = meaning
    excel(name, Cells, Anything, Cells, dated=True, facts=_OF_NUMBERS)(body)


_count("DCOUNT", "How many of the records have a number in the field.", lambda column: column.kinds == NUMBER)
_count("DCOUNTA", "How many of the records have anything in the field.", lambda column: column.kinds != BLANK)
