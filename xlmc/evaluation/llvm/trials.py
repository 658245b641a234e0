"""The values of one set of trials while they are evaluated: arrays for loops, `Value`s for everything else."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.evaluation.engine import Column, column_of
from xlmc.evaluation.graph.dag import Constant, Dag
from xlmc.evaluation.llvm.recipes import Operand
from xlmc.functions import Kind
from xlmc.functions.values import Floats, Value

__all__ = ["Trials"]


class Trials:
    """Values by node.

    Args:
        wider: the set that these trials were chosen from, by `survivors`: what was computed there is not again.

    Attributes:
        n: how many trials.
        arrays: what loops read and write: doubles, and truth values for LOGICAL nodes, `(n,)`.
        values: what was computed outside of loops.
        wrong: `(n,)` 1 where the trial must be computed again.
    """

    def __init__(
        self, dag: Dag, n: int, wrong: NDArray[np.uint8], wider: Trials | None, survivors: NDArray[np.intp]
    ) -> None:
        self.n, self.wrong, self.wider, self.survivors = n, wrong, wider, survivors
        self.arrays: dict[int, NDArray[Any]] = {}
        self.values: dict[int, Value] = {}
        self._dag = dag
        self._converted: dict[Operand, Floats] = {}

    def array(self, operand: Operand) -> NDArray[Any]:
        """What a loop reads of these trials: contiguous, `(n,)`; of a `Value` doubles, NaN for errors."""
        if operand.place in self.arrays:
            return self.arrays[operand.place]
        if operand not in self._converted:
            self._converted[operand] = self._as_doubles(operand)
        return self._converted[operand]

    def _as_doubles(self, operand: Operand) -> Floats:
        value = self.values[operand.place]
        numbers, errors = value.to_numbers() if operand.kind is Kind.NUMBER else value.to_logicals()
        doubles = np.where(errors > 0, np.nan, numbers)
        return np.ascontiguousarray(np.broadcast_to(doubles, (self.n,)), np.float64)

    def value(self, place: int) -> Value:
        """A node's value, whatever it is. In trials that are wrong it may be an error by another name."""
        node = self._dag.nodes[place]
        if isinstance(node, Constant):
            return node.value
        if place not in self.values:
            self.values[place] = self._as_value(place)
        return self.values[place]

    def _as_value(self, place: int) -> Value:
        if place in self.arrays:
            array = self.arrays[place]
            return Value.of_logicals(array) if array.dtype == np.bool_ else Value.of_numbers(array)
        assert self.wider is not None
        return self.wider.value(place).take(self.survivors)

    def column(self, place: int, fallible: bool) -> Column:
        """A node as a result; of a loop's, whose errors `wrong` tells, and of sound draws just the numbers."""
        if not fallible and place in self.arrays:
            return Column(self.arrays[place])
        if not fallible and self.wider is not None and place in self.wider.arrays:
            return Column(self.wider.arrays[place][self.survivors])
        return column_of(self.value(place), self.n)
