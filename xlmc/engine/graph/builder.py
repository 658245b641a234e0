"""Makes nodes of nodes while formulas are lowered.

A function that takes single values and is given arrays becomes an array of calls, cell by cell.
"""

from __future__ import annotations

import math
from functools import partial

from xlmc.engine.graph.arrays import cell_by_cell, either, element, share_out, sizes_differ, spread
from xlmc.engine.graph.circles import refuse_hidden
from xlmc.engine.graph.dag import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Select
from xlmc.engine.graph.number_lookups import NumberLookups
from xlmc.engine.graph.running_totals import PAIRED_OR_COUNTED, RunningTotals
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import BLANK, Value, constant

__all__ = ["NodeBuilder"]


class NodeBuilder:
    """Makes nodes of nodes.

    Attributes:
        dag: takes the nodes.
    """

    def __init__(self, dag: Dag, totals: RunningTotals) -> None:
        self.dag, self._totals, self._lookups = dag, totals, NumberLookups(dag)
        self._numbers: dict[float, int] = {}

    def number(self, value: float) -> int:
        """The node of a number."""
        if value not in self._numbers:
            self._numbers[value] = self.dag.constant(constant(value))
        return self._numbers[value]

    def error(self, code: ErrorCode) -> int:
        """The node of an error."""
        return self.dag.constant(constant(code))

    def first_cell(self, node: int) -> int:
        """The node of one cell of a value: the first of many."""
        return element(self.dag, node, 0, 0)

    def lookup_constant(self, node_id: int) -> Value | None:
        """The value of a single constant; None of any other node."""
        node = self.dag.nodes[node_id]
        return node.value if isinstance(node, Constant) and self.dag.sizes[node_id] is None else None

    def lookup_condition(self, node: int) -> bool | None:
        """What a condition is known to be; None where it varies, is an error, a text or many cells."""
        known = self.lookup_constant(node)
        return None if known is None or not known.plain else bool(known.numbers[0])

    def zero_if_blank(self, node: int) -> int:
        """What a formula gives for an empty cell."""
        known = self.lookup_constant(node)
        return self.number(0.0) if known is not None and int(known.kinds[0]) == BLANK else node

    def select(self, condition: int, yes: int, no: int) -> int:
        """The node of an IF between two nodes."""
        known = self.lookup_condition(condition)
        if known is not None:
            return yes if known else no
        if sizes_differ(self.dag, condition, yes, no):
            return either(self.dag, condition, yes, no)
        cells = cell_by_cell(self.dag, (condition, yes, no), lambda picked: self.select(*picked))
        return self.dag.add(Select(condition, yes, no)) if cells is None else cells

    def call(self, name: str, arguments: tuple[int, ...]) -> int:
        """The node of an operator, or of a function that takes single values."""
        if name == "+" and self.number(0.0) in arguments:
            other = arguments[arguments[0] == self.number(0.0)]
            if self.dag.types[other] is Kind.NUMBER:
                return other
        if name == "^" and arguments[1] == self.number(2.0):
            return self.call("*", (arguments[0], arguments[0]))
        return self.apply(REGISTRY[name], arguments)

    def apply(self, function: Function, arguments: tuple[int, ...]) -> int:
        """The node of a function of nodes, cell by cell where it takes single values and is given many."""
        if self.dag.missing:
            refuse_hidden(self.dag, function, arguments)
        if function.facts.factor is not None:
            return self.call("*", (arguments[0], self.number(function.facts.factor)))
        if function.name == "/" and (factor := self._inverse(arguments[1])) is not None:
            return self.call("*", (arguments[0], self.number(factor)))
        chosen = self._share_out(function, arguments)
        if chosen is not None:
            return chosen
        if function.takes_sets or function.name in PAIRED_OR_COUNTED:
            return self._totals.apply(function, arguments)
        found = self._lookups.apply(function, arguments)
        if found is not None:
            return found
        if all(self.dag.sizes[node] is None for node in arguments):
            return self.dag.add(Apply(function, arguments))
        loose = tuple(p for i, p in enumerate(arguments) if not function.parameter(i).ranged)
        cells = spread(
            self.dag, function, loose, lambda picked: self.apply(function, _merge(function, arguments, picked))
        )
        return self.dag.add(Apply(function, arguments)) if cells is None else cells

    def _share_out(self, function: Function, arguments: tuple[int, ...]) -> int | None:
        """The function of a choice between sizes, as a choice between two results; None without such an argument."""
        return share_out(
            self.dag,
            arguments,
            partial(self.apply, function),
            lambda node: self.call("ISERROR", (node,)),
            self.select,
        )

    def _inverse(self, node_id: int) -> float | None:
        """The inverse of a power of two: to multiply by it gives the quotient to the last bit. None of other nodes."""
        node = self.dag.nodes[node_id]
        if not isinstance(node, Constant) or self.dag.types[node_id] is not Kind.NUMBER:
            return None
        number = float(node.value.numbers[0])
        return 1.0 / number if abs(math.frexp(number)[0]) == 0.5 and 2.0**-60 < abs(number) < 2.0**60 else None


def _merge(function: Function, arguments: tuple[int, ...], picked: tuple[int, ...]) -> tuple[int, ...]:
    """The arguments with those that take single values replaced, in order."""
    singles = iter(picked)
    return tuple(p if function.parameter(i).ranged else next(singles) for i, p in enumerate(arguments))
