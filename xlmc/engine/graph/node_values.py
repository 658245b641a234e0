"""Compute the value of a node from those of the nodes that it uses.

It has errors, texts and blanks as in Excel. Arrays that are computed together may have sizes that are known only during
the run: as in Excel, a cell that one lacks is #N/A. Where an array's size differs between trials, as that of `FILTER`
may, each trial is computed alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, assert_never

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.nodes import Apply, IfErrorNode, Range, Select, uses
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Function
from xlmc.excel.functions.budget import ask_for_cells, ask_for_live
from xlmc.excel.functions.logical import if_, if_error, if_na
from xlmc.excel.functions.lookup.picked_cells import join_values
from xlmc.excel.functions.values import ERROR, ShapeVaries, Value, constant

__all__ = ["Ragged", "align", "apart", "arguments_of", "by_trial", "corner", "evaluate_node", "in_own_memory", "single"]

_NA = np.uint8(ERROR + ErrorCode.NA)
_CALC_ERROR = constant(ErrorCode.CALC)


def evaluate_node(node: Apply | Select | IfErrorNode | Range, values: Mapping[int, Value]) -> Value:
    """Evaluate a node: on the careful path, and if it is constant while formulas are lowered."""
    needed = {node_id: values[node_id] for node_id in uses(node)}
    if isinstance(node, Range):
        ask_for_cells(max(value.shape[0] for value in needed.values()), len(node.rows), len(node.rows[0]))
    if not any(isinstance(value, Ragged) for value in needed.values()):
        try:
            return _evaluate(node, needed)
        except ShapeVaries:
            pass  # trial by trial, then
    return by_trial(lambda trial: _evaluate(node, trial), needed)


def in_own_memory(result: Value, arguments: Iterable[Value]) -> Value:
    """Return the result in memory apart from the arguments, whose buffers are soon written to again."""
    if any(np.may_share_memory(result.numbers, argument.numbers) for argument in arguments):
        return Value(result.numbers.copy(), result.kinds, result.texts)
    return result


def apart(value: Value) -> Value:
    """Return a part of a larger array in memory of its own: else all of the array would stay with it."""
    if isinstance(value, Ragged):
        return value
    parts: list[Any] = []
    for part in value.arrays():
        is_part = part is not None and isinstance(part.base, np.ndarray) and part.nbytes < part.base.nbytes
        parts.append(np.array(part) if is_part else part)
    return value if all(part is old for part, old in zip(parts, value.arrays(), strict=True)) else Value(*parts)


def _evaluate(node: Apply | Select | IfErrorNode | Range, values: Mapping[int, Value]) -> Value:
    match node:
        case Apply(function, arguments):
            given = arguments_of(function, [values[node_id] for node_id in arguments])
            return function.check_spill(function(given), given)
        case Select(condition, yes, no):
            _ask_for_all(values[condition], values[yes], values[no])
            return _select(values[condition], values[yes], values[no])
        case IfErrorNode(value, instead, only_na):
            _ask_for_all(values[value], values[instead])
            return _if_error(values[value], values[instead], only_na)
        case Range(rows):
            return _stack([[values[node_id] for node_id in row] for row in rows])
        case _:
            assert_never(node)


def _ask_for_all(*values: Value) -> None:
    """Ask for the memory of the array that the values spread to."""
    shapes = [value.shape for value in values]
    tables = [shape for shape in shapes if len(shape) == 3]
    if tables:
        n = max(shape[0] for shape in shapes)
        ask_for_cells(n, max(shape[1] for shape in tables), max(shape[2] for shape in tables))


def _select(condition: Value, yes: Value, no: Value) -> Value:
    selected: Value = if_(*align((condition, yes, no)))
    return selected


def _if_error(value: Value, instead: Value, only_na: bool) -> Value:
    value, instead = align((value, instead))
    result: Value = if_na(value, instead) if only_na else if_error(value, instead)
    return result


def _stack(rows: list[list[Value]]) -> Value:
    cells = [single(value) for row in rows for value in row]
    sizes = {value.numbers.size for value in cells} | {value.kinds.size for value in cells}
    (n,) = (sizes - {1}) or {1}
    size = (n, len(rows), len(rows[0]))
    texts = None
    if any(value.texts is not None for value in cells):
        texts = _grid([np.full(1, "", object) if v.texts is None else v.texts for v in cells], size, object)
    numbers = _grid([v.numbers for v in cells], size, np.float64)
    return Value(numbers, _grid([v.kinds for v in cells], size, np.uint8), texts)


def _grid(columns: list[Any], size: tuple[int, int, int], dtype: Any) -> Any:
    """Columns (n,) to (n, r, c), each column's trials side by side in memory."""
    out = np.empty((size[1] * size[2], size[0]), dtype)
    for target, column in zip(out, columns, strict=True):
        target[:] = column
    return out.T.reshape(size)


def arguments_of(function: Function, values: Sequence[Value]) -> list[Value]:
    """Give the arguments that are taken element by element one size; ranges that are taken whole stay."""
    loose = [i for i in range(len(values)) if not function.parameter(i).ranged]
    if sum(values[i].numbers.ndim == 3 for i in loose) < 2:
        return list(values)
    given = list(values)
    for i, value in zip(loose, align([values[i] for i in loose]), strict=True):
        given[i] = value
    return given


def align(values: Sequence[Value]) -> list[Value]:
    """Arrays (n, r, c) of one size (r, c), or of one row, one column or one cell, which broadcast to it.

    Single values (n,) stay as they are. Where no array is larger than another, none is changed.
    """
    sizes = {value.shape[1:] for value in values if value.numbers.ndim == 3}
    rows, columns = ({size[axis] for size in sizes} - {1} for axis in (0, 1))
    if len(rows) < 2 and len(columns) < 2:
        return list(values)
    to = max(rows, default=1), max(columns, default=1)
    return [_pad(value, *to) if value.numbers.ndim == 3 else value for value in values]


def _pad(value: Value, rows: int, columns: int) -> Value:
    """Pad the array with #N/A below and to the right; a single row or column is not filled up, as it broadcasts."""
    shape = value.shape
    lacks = [(0, 0), *((0, 0 if has == 1 else to - has) for has, to in zip(shape[1:], (rows, columns), strict=True))]
    if not any(more for _, more in lacks):
        return value
    filled: list[tuple[Any, Any]] = [(value.numbers, 0.0), (value.kinds, _NA), (value.texts, "")]
    parts: list[Any] = [
        None if part is None else np.pad(np.broadcast_to(part, shape), lacks, constant_values=by) for part, by in filled
    ]
    return Value(parts[0], parts[1], parts[2])


def single(value: Value) -> Value:
    """Return the value for one cell of an array: a single value, or an array of one cell; a larger array there is
    #CALC!.
    """
    if value.numbers.ndim == 1:
        return value
    return corner(value) if value.shape[1:] == (1, 1) else _CALC_ERROR


def corner(value: Value) -> Value:
    """Return what a cell shows of an array that it does not spill: its upper left value; #CALC! where it has
    no cell.
    """
    if value.numbers.ndim == 1:
        return value
    if 0 in value.shape[1:]:
        return _CALC_ERROR
    shape = value.shape
    parts: list[Any] = [None if part is None else np.broadcast_to(part, shape)[:, 0, 0] for part in value.arrays()]
    return Value(parts[0], parts[1], parts[2])


class Ragged(Value):
    """One value for each trial, each with its own size. Only single trials may be read from it."""

    __slots__ = ("trials",)

    trials: Sequence[Value]

    def __init__(self, trials: Sequence[Value]) -> None:
        super().__init__(np.zeros((len(trials), 0, 0)), np.zeros((1, 1, 1), np.uint8))
        object.__setattr__(self, "trials", trials)

    @property
    def has_errors(self) -> bool:
        return any(trial.has_errors for trial in self.trials)

    @property
    def plain(self) -> bool:
        return all(trial.plain for trial in self.trials)

    def take(self, index: NDArray[np.intp]) -> Value:
        """Return the trials of `index`."""
        return Ragged([self.trials[i] for i in index])


def by_trial(evaluate: Callable[[Mapping[int, Value]], Value], values: Mapping[int, Value]) -> Value:
    """Evaluate each trial alone; one value where all are of one size, a `Ragged` otherwise."""
    n = max(value.shape[0] for value in values.values())
    result: list[Value] = []
    size = 0
    for i in range(n):
        result.append(evaluate({node: _trial(value, i) for node, value in values.items()}))
        size += result[-1].nbytes
        ask_for_live(size)
    if len({value.shape for value in result}) > 1:
        return Ragged(result)
    return join_values(result, axis=0)


def _trial(value: Value, i: int) -> Value:
    if isinstance(value, Ragged):
        return value.trials[i]
    return value.take(np.array([i], np.intp))
