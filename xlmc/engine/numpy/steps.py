"""One node as one step on plain arrays.

A step reads and writes a `Frame`: a list of values by node. A NUMBER node is a float array (or a float, when
constant), a LOGICAL node a bool array (or a bool), any other node a `Value`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.node_values import Ragged, by_trial, evaluate_node, in_own_memory
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Range, Select, uses
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.budget import ask_for_live
from xlmc.excel.functions.denormals import Underflow, flush, tiny_to_zero
from xlmc.excel.functions.logical import zero_if_blank
from xlmc.excel.functions.registry import Elementwise
from xlmc.excel.functions.values import BLANK, LOGICAL, NUMBER, TEXT, Value

__all__ = ["Frame", "LeaveFastPath", "Step", "is_elementwise_ufunc", "make_step", "plain_constant", "reads"]


class LeaveFastPath(Exception):  # noqa: N818 - it is no error: another path takes over
    """The block cannot be computed on the fast path."""


@dataclass(slots=True)
class Frame:
    """The values of one set of `n` trials, and the buffers that steps may write to.

    Attributes:
        underflow: whether a result may be too small a number for Excel; the step that made it then calls `flush`.
        live: the bytes of `Value`s.
    """

    values: Any  # by node: a list, or a mapping of those that one step reads and writes
    buffers: Sequence[NDArray[Any]]
    n: int
    underflow: Underflow
    live: int = 0

    def flush(self, node: int) -> None:
        """Set the node's numbers that are too small for Excel to 0."""
        self.underflow.raised = False
        flush(self.values[node])


Step = Callable[[Frame], None]


def plain_constant(value: Value) -> Any:
    """Return a constant as steps take it: float, bool, or the `Value` itself."""
    if value.numbers.ndim == 1 and value.kinds.size == 1:
        kind = int(value.kinds[0])
        if kind == NUMBER:
            return float(value.numbers[0])
        if kind == LOGICAL:
            return bool(value.numbers[0])
    return value


def reads(dag: Dag, node_id: int) -> tuple[int, ...]:
    """Return the nodes whose values the step of a node needs.

    For a range that is folded these are its cells, or the node that stands for it. For an IFERROR it is the value
    alone: where that turns out to be an error, the block leaves the fast path, so that the other value is never needed
    here.
    """
    node = dag.nodes[node_id]
    if node_id in dag.folded:
        folded = dag.folded[node_id]
        beside = _cells_of(dag, node) if isinstance(node, Apply) and isinstance(dag.nodes[folded], Constant) else ()
        return (folded, *(cell for cell, _ in beside))  # a count, whose cells may turn out errors
    if isinstance(node, Apply) and not node.function.takes_sets:
        return node.arguments
    if isinstance(node, IfErrorNode) and dag.sizes[node.instead] is None:
        return (node.value,)
    if isinstance(node, Apply) and _find_folded(dag, node) is not None:
        return tuple(cell for cell, _ in _cells_of(dag, node))  # also what does not count: it may turn out an error
    return uses(node)


def make_step(dag: Dag, node_id: int, buffer: int | None) -> Step:
    """Make the step of a node; it writes to that buffer where it is given one, else to new memory.

    A node without a fast form runs as `Function` does; if it gives an error or a text, the block leaves the fast path.
    """
    node = dag.nodes[node_id]
    match node:
        case Apply(function, arguments):
            return _apply(dag, node_id, function, arguments, buffer)
        case Select(condition, yes, no) if dag.types[node_id] is not Kind.ANY:
            return _select(dag, node_id, (condition, yes, no), buffer)
        case IfErrorNode(value, instead) if dag.sizes[instead] is None:
            return _if_error(dag, node_id, value)
        case Select() | IfErrorNode() | Range():
            return _careful_step(dag, node_id)
        case _:
            raise TypeError(f"{node} is no step")


def is_elementwise_ufunc(dag: Dag, node_id: int) -> bool:
    """Whether the step may write over its own arguments."""
    node = dag.nodes[node_id]
    return isinstance(node, Apply) and not node.function.takes_sets and _fast_ufunc(dag, node)


def _apply(dag: Dag, node_id: int, function: Function, arguments: tuple[int, ...], buffer: int | None) -> Step:
    if node_id in dag.folded:
        return _copy(node_id, _readers(dag, (dag.folded[node_id],), Kind.NUMBER)[0], buffer)
    node = Apply(function, arguments)
    if function.takes_sets:
        folded = _find_folded(dag, node)
        if folded is None:
            return _careful_step(dag, node_id)
        return _fold(function, node_id, _readers(dag, folded, function.parameters[0].kind), buffer)
    readers = [_reader(dag, argument, _wanted_kind(dag, function, p)) for p, argument in enumerate(arguments)]
    if any(reader is None for reader in readers):
        return _careful_step(dag, node_id)
    result = [reader for reader in readers if reader is not None]
    if _fast_ufunc(dag, node) and function.ufunc is not None:
        return _ufunc(function.ufunc, function.guard, node_id, result, buffer)
    return _careful_step(dag, node_id) if function.takes_values else _body(function, node_id, result)


def _on_numbers(dag: Dag, function: Function, arguments: tuple[int, ...]) -> bool:
    """Whether all arguments are plain numbers for a ufunc: true of nearly every node, and quickly seen."""
    if not function.on_numbers or function.ufunc is None or len(arguments) != function.ufunc.nin:
        return False
    return all(dag.types[argument] is Kind.NUMBER for argument in arguments)


def _fast_ufunc(dag: Dag, node: Apply) -> bool:
    function = node.function
    if _on_numbers(dag, function, node.arguments):
        return True
    if function.ufunc is None or len(node.arguments) != function.ufunc.nin or _compares_unlike_kinds(dag, node):
        return False
    wanted = [_reader(dag, a, _wanted_kind(dag, function, p)) for p, a in enumerate(node.arguments)]
    return all(reader is not None for reader in wanted)


def _wanted_kind(dag: Dag, function: Function, position: int) -> Kind:
    """Return the kind that an argument is read as; comparisons take numbers here, as their ufunc does."""
    kind = function.parameter(position).kind
    return Kind.NUMBER if kind is Kind.ANY and function.ufunc is not None else kind


Reader = Callable[[list[Any]], Any]


def _reader(dag: Dag, node_id: int, kind: Kind) -> Reader | None:
    """How a step gets an argument as plain numbers or logicals; None if only the careful path can tell."""
    node, result = dag.nodes[node_id], dag.types[node_id]
    if isinstance(node, Constant):
        return _constant_reader(node.value, kind)
    if result is kind and kind in (Kind.NUMBER, Kind.LOGICAL):
        return lambda values: values[node_id]
    if result is Kind.LOGICAL and kind is Kind.NUMBER:
        return lambda values: values[node_id].astype(np.float64)
    if result is Kind.NUMBER and kind is Kind.LOGICAL:
        return lambda values: values[node_id] != 0
    return None


def _constant_reader(value: Value, kind: Kind) -> Reader | None:
    if value.numbers.ndim != 1 or value.kinds.size != 1 or kind not in (Kind.NUMBER, Kind.LOGICAL):
        return None
    if int(value.kinds[0]) not in (NUMBER, LOGICAL, BLANK):
        return None
    plain = float(value.numbers[0]) if kind is Kind.NUMBER else bool(value.numbers[0])
    return lambda values: plain


def _compares_unlike_kinds(dag: Dag, node: Apply) -> bool:
    """Whether a comparison has an argument that is no number: Excel then orders by kind, not by size."""
    return node.function.takes_values and any(dag.types[argument] is not Kind.NUMBER for argument in node.arguments)


def _ufunc(
    ufunc: Elementwise, guard: Callable[..., bool] | None, node: int, readers: list[Reader], buffer: int | None
) -> Step:
    def step(frame: Frame) -> None:
        arguments = [read(frame.values) for read in readers]
        if guard is not None and not guard(*arguments):
            raise LeaveFastPath
        out = None if buffer is None else frame.buffers[buffer]
        frame.values[node] = ufunc(*arguments, out=out)
        if frame.underflow.raised:
            frame.flush(node)

    return step


def _copy(node: int, read: Reader, buffer: int | None) -> Step:
    """Make the step of a node for which another one stands, perhaps a constant: a number for each trial."""

    def step(frame: Frame) -> None:
        out = np.empty(frame.n) if buffer is None else frame.buffers[buffer]
        frame.values[node] = np.positive(read(frame.values), out=out)

    return step


def _body(function: Function, node: int, readers: list[Reader]) -> Step:
    defaults = [p.default for p in function.parameters[len(readers) :] if not p.repeat]
    logical = function.returns is Kind.LOGICAL

    def step(frame: Frame) -> None:
        result = function.body(*(read(frame.values) for read in readers), *defaults)
        if np.ndim(result.numbers if isinstance(result, Value) else result) > 1:
            raise function.spill_error()
        if isinstance(result, Value):
            result = _plain_array(result, function.returns)
        elif not logical and not np.isfinite(result).all():
            raise LeaveFastPath
        frame.values[node] = np.broadcast_to(result if logical else tiny_to_zero(result), (frame.n,))

    return step


def _find_folded(dag: Dag, node: Apply) -> list[int] | None:
    """Return the cells that a set function folds, without those that do not count; None for the careful path."""
    function = node.function
    if not function.takes_sets or function.ufunc is None:
        return None
    kind = function.parameters[0].kind
    folded = [cell for cell, in_range in _cells_of(dag, node) if not in_range or _counts(dag, cell, kind)]
    return folded if folded and all(_foldable(dag, cell, kind) for cell in folded) else None


def _cells_of(dag: Dag, node: Apply) -> Iterator[tuple[int, bool]]:
    """Return the arguments, ranges cell by cell, and whether each is a cell of a range."""
    for argument in node.arguments:
        part = dag.nodes[argument]
        if isinstance(part, Range):
            for row in part.rows:
                for cell in row:
                    yield cell, True
        else:
            yield argument, False


def _foldable(dag: Dag, node: int, kind: Kind) -> bool:
    if kind not in (Kind.NUMBER, Kind.LOGICAL) or dag.sizes[node] is not None:
        return False
    return dag.types[node] is kind or _reader(dag, node, kind) is not None


def _readers(dag: Dag, nodes: Sequence[int], kind: Kind) -> list[Reader]:
    return [reader for node in nodes if (reader := _reader(dag, node, kind)) is not None]


def _counts(dag: Dag, cell: int, kind: Kind) -> bool:
    """Whether a range's cell may count. One whose kind is not known before the run may; it has no reader.

    A text that varies has none either: it never counts, but it may be an error.
    """
    result = dag.types[cell]
    if result is kind:
        return True
    node = dag.nodes[cell]
    if isinstance(node, Constant) and int(node.value.kinds.flat[0]) in (BLANK, TEXT):
        return False
    return not (kind is Kind.NUMBER and result is Kind.LOGICAL)


def _fold(function: Function, node: int, operands: list[Reader], buffer: int | None) -> Step:
    ufunc = function.ufunc
    assert ufunc is not None
    dtype = np.bool_ if function.returns is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        out = np.empty(frame.n, dtype) if buffer is None else frame.buffers[buffer]
        first, *rest = (read(frame.values) for read in operands)
        np.copyto(out, first)
        for operand in rest:
            ufunc(out, operand, out=out)
            if frame.underflow.raised:
                frame.underflow.raised = False
                flush(out)
        frame.values[node] = out

    return step


def _select(dag: Dag, node: int, parts: tuple[int, int, int], buffer: int | None) -> Step:
    kind = dag.types[node]
    read = [_reader(dag, part, want) for part, want in zip(parts, (Kind.LOGICAL, kind, kind), strict=True)]
    if any(reader is None for reader in read):
        return _careful_step(dag, node)
    condition, yes, no = (reader for reader in read if reader is not None)
    dtype = np.bool_ if kind is Kind.LOGICAL else np.float64

    def step(frame: Frame) -> None:
        out = np.empty(frame.n, dtype) if buffer is None else frame.buffers[buffer]
        np.copyto(out, no(frame.values))
        np.copyto(out, yes(frame.values), where=condition(frame.values))
        frame.values[node] = out

    return step


def _if_error(dag: Dag, node: int, value: int) -> Step:
    """On the fast path the value is no error, and stays as it is; but a blank becomes 0.

    An IFERROR whose other value has many cells may be larger than its value, and is evaluated by `_careful_step`.
    """

    def step(frame: Frame) -> None:
        result = frame.values[value]
        if isinstance(result, Value):
            if result.has_errors:
                raise LeaveFastPath
            result = _zeros_for_blanks(result)
        frame.values[node] = result if dag.types[node] is dag.types[value] else as_value(result, dag.types[value])

    return step


def _zeros_for_blanks(value: Value) -> Value:
    if isinstance(value, Ragged):
        return by_trial(lambda trial: zero_if_blank(trial[0]), {0: value})
    return zero_if_blank(value)


def _careful_step(dag: Dag, node_id: int) -> Step:
    node = dag.nodes[node_id]
    assert isinstance(node, Apply | Select | IfErrorNode | Range)
    kind = dag.types[node_id]

    def step(frame: Frame) -> None:
        arguments = {p: as_value(frame.values[p], dag.types[p]) for p in uses(node)}
        with np.errstate(all="ignore"):
            result = evaluate_node(node, arguments)
        if isinstance(node, Apply):
            result = in_own_memory(result, arguments.values())
        if kind in (Kind.NUMBER, Kind.LOGICAL):
            frame.values[node_id] = np.broadcast_to(_plain_array(result, kind), (frame.n,))
        else:
            frame.values[node_id] = result
            frame.live += result.nbytes
            ask_for_live(frame.live)

    return step


def _plain_array(value: Value, kind: Kind) -> NDArray[Any]:
    if not value.plain:
        raise LeaveFastPath
    return value.numbers != 0 if kind is Kind.LOGICAL else value.numbers


def as_value(value: Any, kind: Kind) -> Value:
    """Turn a step's plain array or constant into a `Value`."""
    if isinstance(value, Value):
        return value
    array = np.atleast_1d(np.asarray(value))
    code = LOGICAL if kind is Kind.LOGICAL else NUMBER
    return Value(array.astype(np.float64, copy=False), np.full(1, code, np.uint8))
