"""The path that minds everything: errors, texts and blanks in every trial. The fast path must equal it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.compile.dag import Constant, Dag, Input, constants, evaluated
from xlmc.compile.engine import Column, column_of
from xlmc.functions.values import Floats, Value

__all__ = ["TrackingEvaluator"]


class TrackingEvaluator:
    """Evaluates every node as a `Value`. `filters` and `forecasts` are node places."""

    def __init__(self, dag: Dag, filters: Sequence[int], forecasts: Sequence[int]) -> None:
        self._dag = dag
        self._filters, self._forecasts = filters, forecasts
        self._first = dag.upstream(filters)
        early = set(self._first)
        self._late = [place for place in dag.upstream([*filters, *forecasts]) if place not in early]
        self._constants = dict(constants(dag))
        self._inputs: Mapping[str, Floats] = {}
        self._values: dict[int, Value] = {}

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """See `Evaluator`."""
        self._inputs = inputs
        self._values = dict(self._constants)
        self._run(self._first, self._values, None)
        return [column_of(self._values[place], n) for place in self._filters]

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """See `Evaluator`."""
        values = {place: value.take(survivors) for place, value in self._values.items()}
        self._run(self._late, values, survivors)
        return [column_of(values[place], survivors.size) for place in self._forecasts]

    def _run(self, places: list[int], values: dict[int, Value], survivors: NDArray[np.intp] | None) -> None:
        for place in places:
            node = self._dag.nodes[place]
            if isinstance(node, Input):
                draws = self._inputs[node.name]
                values[place] = Value.of_numbers(draws if survivors is None else draws[survivors])
            elif not isinstance(node, Constant):
                values[place] = evaluated(node, values)
