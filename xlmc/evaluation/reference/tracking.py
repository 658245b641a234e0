"""The path that minds everything: errors, texts and blanks in every trial. The fast path must equal it.

A block that takes too much memory is evaluated in portions of its trials, which are halved until one fits. Trials do
not depend on each other, so that the numbers are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import FormulaError
from xlmc.evaluation.engine import Column, column_of
from xlmc.evaluation.graph.dag import Constant, Dag, Input, constants, evaluated, uses
from xlmc.functions.budget import TooLargeError, ask_for_live
from xlmc.functions.values import Floats, Value

__all__ = ["TrackingEvaluator"]

Inputs = Mapping[str, Floats]
Places = NDArray[np.intp]


class TrackingEvaluator:
    """Evaluates every node as a `Value`. `filters` and `forecasts` are node places."""

    def __init__(self, dag: Dag, filters: Sequence[int], forecasts: Sequence[int]) -> None:
        self._dag = dag
        self._filters, self._forecasts = filters, forecasts
        first = dag.upstream(filters)
        early = set(first)
        late = [place for place in dag.upstream([*filters, *forecasts]) if place not in early]
        self._carried = early & {*forecasts, *(used for place in late for used in uses(dag.nodes[place]))}
        self._first = _Part(dag, first, {*filters, *self._carried})
        self._late = _Part(dag, late, set(forecasts))
        self._constants = dict(constants(dag))
        self._inputs: Inputs = {}
        self._values: dict[int, Value] | None = {}
        self._portion = 1 << 62

    def filters(self, inputs: Inputs, n: int) -> list[Column]:
        """See `Evaluator`.

        Raises:
            FormulaError: a formula takes too much memory for a single trial; told of its cell.
        """
        self._inputs, self._values = inputs, None
        if n <= self._portion:
            try:
                self._values = self._early(inputs)
                return _columns(self._values, self._filters, n)
            except TooLargeError as error:
                self._shrink(n, error)
        return self._by_portions(n, lambda at: _columns(self._early(_picked(inputs, at)), self._filters, at.size))

    def forecasts(self, survivors: Places) -> list[Column]:
        """See `Evaluator`.

        Raises:
            FormulaError: a formula takes too much memory for a single trial; told of its cell.
        """
        if self._values is not None:
            try:
                return self._finished(self._values, survivors, self._inputs)
            except TooLargeError as error:
                self._shrink(survivors.size, error)
                self._values = None
        return self._by_portions(survivors.size, lambda at: self._again(_picked(self._inputs, survivors[at]), at.size))

    def peak(self, inputs: Inputs) -> int:
        """The bytes that values take at a time, of the trials of these inputs.

        Raises:
            TooLargeError: they are too many.
        """
        early = self._early(inputs)
        (n,) = {column.size for column in inputs.values()} or {1}
        self._finished(early, np.arange(n), inputs)
        return max(self._first.peak, self._late.peak)

    def _early(self, inputs: Inputs) -> dict[int, Value]:
        values = dict(self._constants)
        self._first.run(values, inputs)
        return values

    def _finished(self, early: Mapping[int, Value], survivors: Places, inputs: Inputs) -> list[Column]:
        values = self._constants | {place: early[place].take(survivors) for place in self._carried}
        self._late.run(values, {name: inputs[name][survivors] for name in self._late.inputs})
        return _columns(values, self._forecasts, survivors.size)

    def _again(self, inputs: Inputs, n: int) -> list[Column]:
        """The forecasts of a portion, whose filters are evaluated again for what they share."""
        return self._finished(self._early(inputs), np.arange(n), inputs)

    def _by_portions(self, n: int, run: Callable[[Places], list[Column]]) -> list[Column]:
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
            raise self._dag.told(error) from None
        self._portion = n // 2


class _Part:
    """Nodes that are evaluated one after another; values that nothing reads any more are let go.

    Attributes:
        inputs: the names of the inputs among the nodes.
        peak: the bytes of the values at a time, in the last run.
    """

    def __init__(self, dag: Dag, places: Sequence[int], kept: set[int]) -> None:
        self._dag, self._places = dag, places
        self.inputs = [node.name for place in places if isinstance(node := dag.nodes[place], Input)]
        self.peak = 0
        own = set(places)
        last = {used: place for place in places for used in uses(dag.nodes[place]) if used in own}
        self._done: dict[int, list[int]] = {}
        for used, place in last.items():
            if used not in kept:
                self._done.setdefault(place, []).append(used)

    def run(self, values: dict[int, Value], inputs: Inputs) -> None:
        """Evaluate the nodes into `values`.

        Raises:
            TooLargeError: they take too much memory; told of the node.
            FormulaError: a value is of a kind that xlmc does not compute with; told of the cell.
        """
        nodes, sizes = self._dag.nodes, dict[int, int]()
        live = self.peak = 0
        for place in self._places:
            node = nodes[place]
            assert not isinstance(node, Constant)
            try:
                found = Value.of_numbers(inputs[node.name]) if isinstance(node, Input) else evaluated(node, values)
                values[place] = found
                sizes[place] = found.nbytes
                live += sizes[place]
                ask_for_live(live)
            except TooLargeError as error:
                error.node = place
                raise
            except FormulaError as error:
                raise self._dag.told_of(error, place) from None
            self.peak = max(self.peak, live)
            for gone in self._done.get(place, ()):
                del values[gone]
                live -= sizes.pop(gone)


def _columns(values: Mapping[int, Value], places: Iterable[int], n: int) -> list[Column]:
    return [column_of(values[place], n) for place in places]


def _picked(inputs: Inputs, at: Places) -> dict[str, Floats]:
    return {name: column[at] for name, column in inputs.items()}


def _side_by_side(columns: Sequence[Column]) -> Column:
    codes = None
    if any(column.codes is not None for column in columns):
        parts = [np.zeros(c.values.size, np.uint8) if c.codes is None else c.codes for c in columns]
        codes = np.concatenate(parts)
    return Column(np.concatenate([column.values for column in columns]), codes)
