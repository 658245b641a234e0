"""Lookups have the derivatives of the cell found, and 0 in the key; other functions only move cells about.

To see which cells such a function picks, it is called with the numbers of the cells in their place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.passes.derivatives.conditions import constant_jet
from xlmc.engine.passes.derivatives.jet import Jet, align, concatenate, flat
from xlmc.engine.passes.derivatives.rules import RULES, DerivativeRule, Operand, Outcome, level_jets, rule
from xlmc.excel.functions import Function
from xlmc.excel.functions.lookup.picked_cells import join_values, map_parts, transpose_cells
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT, POSITION
from xlmc.excel.functions.values import ERROR, LOGICAL, NUMBER, Bools, Value

__all__ = ["Drawer"]

_AT_A_STEP: Final = "the key lies where the lookup goes from one cell to the next"

_NEAR: Final = 1e-14

Values = list[Value]


class Drawer(NamedTuple):
    """The cells of some operands in one row, numbered from 1; 0 stands for anything else.

    Attributes:
        cells: `(n, m)`, none of them active where `active` is empty.
        tags: the operands with their numbers replaced by those of the cells.
    """

    cells: Jet
    tags: list[Value]

    @classmethod
    def of(cls, operands: Sequence[Operand]) -> Drawer:
        """Return the cells of these operands."""
        jets = align([flat(operand.jet, operand.value) for operand in operands])
        n = max(jet.x.shape[0] for jet in jets)
        tags, count = [], 0
        for operand in operands:
            shape = operand.value.shape[1:]
            size = int(np.prod(shape))
            numbers = np.arange(count + 1.0, count + size + 1).reshape(1, *shape)
            count += size
            tags.append(_tag(operand.value, numbers))
        return cls(concatenate(jets, n), tags)

    def draw(self, value: Value, result: Value) -> Jet:
        """Return the cells that a function found among the tags, as its result."""
        cells = np.where(value.kinds == NUMBER, value.numbers, 0.0)
        cells = np.broadcast_to(cells, value.shape).astype(np.intp)
        n = max(cells.shape[0], self.cells.x.shape[0])
        trials = np.arange(n).reshape(n, *(1,) * (cells.ndim - 1))

        def pick(part: NDArray[Any], axes: int) -> NDArray[Any]:
            padded = np.concatenate([np.zeros((*part.shape[:-1], 1)), part], axis=-1)
            wide = np.broadcast_to(padded, (*padded.shape[:axes], n, padded.shape[-1]))
            return wide[..., trials, cells]

        return self.cells.each(pick, result.numbers)


def _tag(value: Value, numbers: NDArray[np.float64]) -> Value:
    """Return the value with other numbers; texts and errors stay, logicals become numbers, for a logical
    holds no tag.
    """
    kinds = np.where(value.kinds == LOGICAL, np.uint8(NUMBER), value.kinds)
    shape = np.broadcast_shapes(kinds.shape, numbers.shape)
    return Value(np.broadcast_to(numbers, shape), np.broadcast_to(kinds.astype(np.uint8), shape), value.texts)


@rule("MATCH", "XMATCH", POSITION.name, why=_AT_A_STEP, jumps=True)
def match(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Derive a position: 0 except where it steps."""
    step = _steps(function, result, [operand.value for operand in operands])
    return Outcome(constant_jet(result, level_jets([operands[0]]), step), result.numbers)


def _steps(call: Callable[[Values], Value], value: Value, values: Values) -> Bools:
    """Find the trials in which a key that differs in the 15th digit finds another cell; where it finds none, the key is
    a label.
    """
    step = np.zeros(1, bool)
    for nudge in (1 - _NEAR, 1 + _NEAR):
        key = replace(values[0], numbers=values[0].numbers * nudge)
        other = call([key, *values[1:]])
        step = step | ((other.numbers != value.numbers) & (other.kinds < ERROR))
    return step


def _look_up(call: Callable[[Values], Value], result: Value, operands: Sequence[Operand], drawer: Drawer) -> Outcome:
    """Return the cell that a call finds among tags, by the first operand as a key."""
    values = [operand.value for operand in operands]
    value = call(values)
    jet = drawer.draw(value, result)
    key = operands[0].jet
    if key.active:
        level = key.as_range() if jet.x.ndim == 3 else key
        jet = replace(jet + constant_jet(result, [level], _steps(call, value, values)), x=result.numbers)
    return Outcome(_without(jet, operands[2:]), value.numbers)


def _without(jet: Jet, operands: Sequence[Operand]) -> Jet:
    """Return the jet without derivatives where an operand that decides on the cell has none."""
    for operand in operands:
        first = operand.jet.first
        if not np.isfinite(first).all():
            axes = tuple(axis for axis in range(first.ndim) if axis != 1)
            lost = ~np.isfinite(first).all(axis=axes)
            jet = jet.lost(lost.reshape(-1, *(1,) * (jet.x.ndim - 1)))
    return jet


@rule("VLOOKUP", "HLOOKUP", why=_AT_A_STEP, jumps=True)
def table_lookup(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Give the table its tags as further columns (rows), and move the number of the column (row) on to these."""
    drawer = Drawer.of([operands[1]])
    axis = 2 if function.name == "VLOOKUP" else 1
    width = operands[1].value.as_range().shape[axis]

    def call(values: Values) -> Value:
        key, table, column, *near = values
        shifted = replace(column, numbers=column.numbers + width)
        return function([key, _beside(table, drawer.tags[0], axis), shifted, *near])

    return _look_up(call, result, operands, drawer)


def _beside(table: Value, tags: Value, axis: int) -> Value:
    left, right = table.as_range(), tags.as_range()
    n = max(left.shape[0], right.shape[0])
    tall = [map_parts(v, lambda part: np.broadcast_to(part, (n, *part.shape[1:]))) for v in (left, right)]
    return join_values(tall, axis)


@rule("LOOKUP", why=_AT_A_STEP, jumps=True)
def lookup(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Tag the results; without them, the last row or column of the array."""
    if len(operands) > 2:
        drawer = Drawer.of([operands[2]])
        return _look_up(lambda values: function([*values[:2], *drawer.tags]), result, operands, drawer)
    drawer = Drawer.of([operands[1]])

    def call(values: Values) -> Value:
        grid, tags = values[1].as_range(), drawer.tags[0].as_range()
        if grid.shape[2] > grid.shape[1]:
            grid, tags = transpose_cells(grid), transpose_cells(tags)
        first = map_parts(grid, lambda part: part[:, :, :1])
        return function([values[0], first, map_parts(tags, lambda part: part[:, :, -1:])])

    return _look_up(call, result, operands, drawer)


@rule("XLOOKUP", why=_AT_A_STEP, jumps=True)
def xlookup(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Tag the results, and the value for a key that is not found."""
    drawer = Drawer.of(operands[2:4])

    def call(values: Values) -> Value:
        return function([*values[:2], *drawer.tags, *values[2:]])

    return _look_up(call, result, [*operands[:2], *operands[4:]], drawer)


def register_moving(data: Callable[[int], Sequence[int]], *names: str, why: str = "", jumps: bool = False) -> None:
    """Register functions that move cells about: the operands at `data(how many there are)` are the cells."""

    def apply(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
        moving = [index for index in data(len(operands)) if index < len(operands)]
        drawer = Drawer.of([operands[index] for index in moving])
        values = [operand.value for operand in operands]
        for index, tags in zip(moving, drawer.tags, strict=True):
            values[index] = tags
        value = function(values)
        rest = [operand for index, operand in enumerate(operands) if index not in moving]
        single = value.numbers.ndim == 1
        return Outcome(_without(drawer.draw(value, result), rest), value.numbers if single else None)

    for name in names:
        RULES[name] = DerivativeRule(apply, why, jumps)


register_moving(lambda _: (0,), "INDEX", why="the row or column has no derivative there", jumps=True)
register_moving(lambda _: (0,), "TRANSPOSE", "TAKE", "DROP", "CHOOSEROWS", "CHOOSECOLS", "TOCOL", "TOROW", "SORTBY")
register_moving(lambda _: (0, 2), "FILTER", "WRAPROWS", "WRAPCOLS")
register_moving(lambda _: (0, 3), "EXPAND")
register_moving(range, "VSTACK", "HSTACK")


@rule(CELL_AT.name)
def cell_at(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Return a constant number: its derivative is that of the position, 0 where it does not step."""
    return Outcome(constant_jet(result, level_jets([operands[1]]), np.zeros(1, bool)))
