"""The careful path: every node as a `Value`, with errors, texts and blanks in every trial. The fast path equals it.

A block that takes too much memory is evaluated in portions of its trials, which are halved until one fits. Trials do
not depend on each other, so that the numbers are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, column_of
from xlmc.engine.graph.graph import MANY, Dag, constants
from xlmc.engine.graph.node_values import apart, evaluate_node
from xlmc.engine.graph.nodes import Constant, Input, uses
from xlmc.errors import FormulaError
from xlmc.excel.functions import Kind
from xlmc.excel.functions.budget import MOST_LIVE, TooLargeError, ask_for_live
from xlmc.excel.functions.values import Floats, Value

if TYPE_CHECKING:
    from xlmc.engine.graph.lowering import Lowering

__all__ = ["TrackingEvaluator", "array_bytes", "fitting_block"]

_MOST_BYTES: Final = 1 << 26
"""The most bytes of a block's arrays and texts; functions need several times that while they work."""

_WIDE: Final = 1_000
"""An array of more cells is measured."""

Inputs = Mapping[str, Floats]
Trials = NDArray[np.intp]


class TrackingEvaluator:
    """Evaluates every node as a `Value`. `filters` and `forecasts` are nodes.

    What it evaluates is found when it is first used, for most runs never need it.
    """

    def __init__(self, dag: Dag, filters: Sequence[int], forecasts: Sequence[int]) -> None:
        self._dag = dag
        self._filters, self._forecasts = filters, forecasts
        self._inputs: Inputs = {}
        self._values: dict[int, Value] | None = {}
        self._portion = 1 << 62

    def filters(self, inputs: Inputs, n: int) -> list[Column]:
        """See `Evaluator`.

        Raises:
            FormulaError: a formula takes too much memory for a single trial; the error names its cell.
        """
        self._inputs, self._values = inputs, None
        if n <= self._portion:
            try:
                self._values = self._run_early(inputs)
                return _columns(self._values, self._filters, n)
            except TooLargeError as error:
                self._shrink(n, error)
        return self._by_portions(n, lambda at: _columns(self._run_early(_pick(inputs, at)), self._filters, at.size))

    def forecasts(self, survivors: Trials) -> list[Column]:
        """See `Evaluator`.

        Raises:
            FormulaError: a formula takes too much memory for a single trial; the error names its cell.
        """
        if self._values is not None:
            try:
                return self._run_late(self._values, survivors, self._inputs)
            except TooLargeError as error:
                self._shrink(survivors.size, error)
                self._values = None
        return self._by_portions(
            survivors.size, lambda at: self._repeat_forecasts(_pick(self._inputs, survivors[at]), at.size)
        )

    def peak(self, inputs: Inputs) -> int:
        """Return the most bytes that arrays, texts and what may be either take at a time, in the trials of these
        inputs.

        Raises:
            TooLargeError: they are too many.
        """
        early = self._run_early(inputs)
        (n,) = {column.size for column in inputs.values()} or {1}
        self._run_late(early, np.arange(n), inputs)
        return max(part.peak for part in self._parts[:2])

    @cached_property
    def _parts(self) -> tuple[_Part, _Part, set[int]]:
        """What the filters need; what the forecasts need beyond that; the nodes that these take from the filters'."""
        dag = self._dag
        first = dag.upstream(self._filters)
        early = set(first)
        late = [node for node in dag.upstream([*self._filters, *self._forecasts]) if node not in early]
        carried = early & {*self._forecasts, *(used for node in late for used in uses(dag.nodes[node]))}
        return _Part(dag, first, {*self._filters, *carried}), _Part(dag, late, set(self._forecasts)), carried

    @cached_property
    def _constants(self) -> dict[int, Value]:
        return dict(constants(self._dag))

    def _run_early(self, inputs: Inputs) -> dict[int, Value]:
        values = dict(self._constants)
        self._parts[0].run(values, inputs)
        return values

    def _run_late(self, early: Mapping[int, Value], survivors: Trials, inputs: Inputs) -> list[Column]:
        _, late, carried = self._parts
        values = self._constants | {node: early[node].take(survivors) for node in carried}
        late.run(values, {name: inputs[name][survivors] for name in late.inputs})
        return _columns(values, self._forecasts, survivors.size)

    def _repeat_forecasts(self, inputs: Inputs, n: int) -> list[Column]:
        """Evaluate the forecasts of a portion, whose filters are evaluated again for what they share."""
        return self._run_late(self._run_early(inputs), np.arange(n), inputs)

    def _by_portions(self, n: int, run: Callable[[Trials], list[Column]]) -> list[Column]:
        parts, start = [], 0
        while start < n:
            at = np.arange(start, min(start + self._portion, n))
            try:
                parts.append(run(at))
                start += at.size
            except TooLargeError as error:
                self._shrink(at.size, error)
        return [_side_by_side(columns) for columns in zip(*parts, strict=True)]

    def _shrink(self, n: int, error: TooLargeError) -> None:
        """Take half of so many trials at a time.

        Raises:
            FormulaError: it was a single one.
        """
        if n <= 1:
            raise self._dag.naming_cell(error) from None
        self._portion = n // 2


class _Part:
    """Nodes that are evaluated one after another; a value is dropped when nothing reads it any more.

    Attributes:
        inputs: the names of the inputs among the nodes.
        peak: the most bytes that values other than single numbers took at a time in the last run.
    """

    def __init__(self, dag: Dag, nodes: Sequence[int], outputs: set[int]) -> None:
        self._dag, self._nodes = dag, nodes
        self.inputs = [node.name for node_id in nodes if isinstance(node := dag.nodes[node_id], Input)]
        self.peak = 0
        own = set(nodes)
        last = {used: node_id for node_id in nodes for used in uses(dag.nodes[node_id]) if used in own}
        self._done: dict[int, list[int]] = {}
        for used, node_id in last.items():
            if used not in outputs:
                self._done.setdefault(node_id, []).append(used)

    def run(self, values: dict[int, Value], inputs: Inputs) -> None:
        """Evaluate the nodes into `values`.

        Raises:
            TooLargeError: they take too much memory; the error names the node.
            FormulaError: a value is of a kind that xlmc does not compute with; the error names the cell.
        """
        nodes, sizes = self._dag.nodes, dict[int, int]()
        live = in_arrays = self.peak = 0
        for node_id in self._nodes:
            node = nodes[node_id]
            assert not isinstance(node, Constant)
            try:
                if isinstance(node, Input):
                    value = Value.of_numbers(inputs[node.name])
                else:
                    value = apart(evaluate_node(node, values))
                values[node_id] = value
                sizes[node_id] = value.nbytes
                live += sizes[node_id]
                in_arrays += self._in_arrays(node_id, sizes[node_id])
                ask_for_live(live)
            except TooLargeError as error:
                error.node = node_id
                raise
            except FormulaError as error:
                raise self._dag.naming_cell_of(error, node_id) from None
            self.peak = max(self.peak, in_arrays)
            for gone in self._done.get(node_id, ()):
                del values[gone]
                in_arrays -= self._in_arrays(gone, sizes[gone])
                live -= sizes.pop(gone)

    def _in_arrays(self, node: int, size: int) -> int:
        """Count the bytes of a value that belong to arrays, not to a single number."""
        return 0 if self._dag.sizes[node] is None and self._dag.types[node] in (Kind.NUMBER, Kind.LOGICAL) else size


def _columns(values: Mapping[int, Value], nodes: Iterable[int], n: int) -> list[Column]:
    return [column_of(values[node], n) for node in nodes]


def _pick(inputs: Inputs, at: Trials) -> dict[str, Floats]:
    return {name: column[at] for name, column in inputs.items()}


def _side_by_side(columns: Sequence[Column]) -> Column:
    codes, texts = None, None
    if any(column.codes is not None for column in columns):
        parts = [np.zeros(c.values.size, np.uint8) if c.codes is None else c.codes for c in columns]
        codes = np.concatenate(parts)
    if any(column.texts is not None for column in columns):
        texts = np.concatenate([np.full(c.values.size, "", object) if c.texts is None else c.texts for c in columns])
    return Column(np.concatenate([column.values for column in columns]), codes, texts)


def array_bytes(lowering: Lowering, filters: Sequence[int], forecasts: Sequence[int], nodes: Iterable[int]) -> int:
    """Measure the most bytes that arrays and texts take at a time in one trial, with the inputs at their base values.

    It is 0, unmeasured, for a model without texts or wide arrays that vary.

    Args:
        lowering: of the model.
        filters: nodes.
        forecasts: nodes.
        nodes: that the engine computes: a range of which it takes the cells is not among them.
    """
    dag = lowering.dag
    if not any(_may_be_wide(dag, node) for node in nodes):
        return 0
    base = {name: lowering.graph.workbook.content(cell).value for cell, name in lowering.inputs.items()}
    inputs = {name: np.full(1, float(x) if isinstance(x, int | float) else 1.0) for name, x in base.items()}
    try:
        return TrackingEvaluator(dag, filters, forecasts).peak(inputs)
    except TooLargeError:
        return MOST_LIVE


def _may_be_wide(dag: Dag, node: int) -> bool:
    size = dag.sizes[node]
    if size is None:
        return dag.types[node] is Kind.TEXT
    return size == MANY or size[0] * size[1] > _WIDE


def fitting_block(block: int, array_bytes: int, number_bytes: int) -> int:
    """Return the largest power of two up to `block` whose trials fit into the memory; 1 where not even that does.

    Args:
        block: to start from.
        array_bytes: what arrays and texts take in a trial.
        number_bytes: what single numbers take.
    """
    while block > 1 and (block * array_bytes > _MOST_BYTES or block * number_bytes > MOST_LIVE):
        block //= 2
    return block
