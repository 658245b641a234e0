"""Sums of products in which a large array is constant: it is added up once, before the run.

`SUMPRODUCT((K1:OM403>0)*K1:OM403*A1)`, where only A1 varies, is A1 times a constant; with a row of varying cells in
place of A1, it is the sum of one product for each column. Excel adds up every product: the same but for the rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Final

import numpy as np

from xlmc.engine.graph.arrays import LARGEST
from xlmc.engine.graph.graph import MANY
from xlmc.engine.graph.nodes import Constant
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.excel.address import Area
from xlmc.excel.formula import ir
from xlmc.excel.formula.precedents import references
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.samples import row_sums
from xlmc.excel.functions.values import NUMBER, Floats, Value

__all__ = ["SUMS"]


def _sum(name: str, lowering: TreeLowering, arguments: tuple[ir.Expression, ...], scope: Scope) -> int | None:
    """Lower the sum of one product; None where no large constant array can be added up by itself."""
    factors = list(_factors(arguments[0])) if len(arguments) == 1 else []
    scope = scope.inside().of(REGISTRY[name].parameter(0).ranges).inside()
    if len(factors) < 2 or not scope.array or not _may_be_large(arguments[0]):
        return None
    dag = lowering.dag
    nodes = [(operator, lowering.lower(factor, scope)) for operator, factor in factors]
    sizes = {node: dag.sizes[node] or (1, 1) for _, node in nodes}
    if MANY in sizes.values():
        return None
    rows, columns = (max(size[i] for size in sizes.values()) for i in (0, 1))
    varying = [(operator, node) for operator, node in nodes if not isinstance(dag.nodes[node], Constant)]
    spread = [max((sizes[node][i] for _, node in varying), default=1) for i in (0, 1)]  # rows and columns of those
    fits = all(size[0] in (1, rows) and size[1] in (1, columns) for size in sizes.values())
    if not fits or rows * columns <= LARGEST or 1 not in spread or spread == [rows, columns] or not varying:
        return None
    product = lowering.number(1.0)
    for operator, node in nodes:
        if isinstance(dag.nodes[node], Constant):
            product = lowering.call(operator, (product, node))
    known = dag.nodes[product]
    if not isinstance(known, Constant) or (known.value.kinds != NUMBER).any():
        return None
    numbers = np.broadcast_to(known.value.as_range().numbers, (1, rows, columns))
    lines = numbers[0].T if spread[0] == 1 else numbers[0]  # each is added up, from left to right as SUM does
    if spread == [1, 1]:
        lines = numbers.reshape(1, -1)
    with np.errstate(over="ignore", invalid="ignore"):
        total, most = (each.reshape(1, *spread) for each in (row_sums(lines), np.abs(lines).max(axis=1)))
    if not np.isfinite(total).all():
        return None
    terms, largest = (_times(lowering, each, varying) for each in (total, most))
    overflows = lowering.call("*", (largest, lowering.number(0.0)))  # 0, but #NUM! where one of the products would be
    return lowering.apply(REGISTRY[name], (lowering.call("+", (terms, overflows)),))


def _factors(tree: ir.Expression) -> Iterator[tuple[str, ir.Expression]]:
    """Yield what a product multiplies and divides by, from left to right; the tree itself if it is no product."""
    rest: list[tuple[str, ir.Expression]] = []
    while isinstance(tree, ir.Binary) and tree.operator in ("*", "/"):
        rest.append((tree.operator, tree.right))
        tree = tree.left
    yield "*", tree
    for operator, part in reversed(rest):
        if operator == "*":
            yield from _factors(part)
        else:
            yield operator, part


def _may_be_large(tree: ir.Expression) -> bool:
    """Whether the areas in a tree may make a large array; whole columns and rows, of which a part is read, do not."""
    areas = [each for each in references(tree) if isinstance(each, Area)]
    if not areas or any(area.is_cut for area in areas):
        return False
    return max(area.rows for area in areas) * max(area.columns for area in areas) > LARGEST


def _times(lowering: TreeLowering, numbers: Floats, factors: list[tuple[str, int]]) -> int:
    """Return the node of constants `(1, r, c)`, a single one as such, times the factors."""
    node = lowering.dag.constant(Value.of_numbers(numbers if numbers.size > 1 else numbers.ravel()))
    for operator, factor in factors:
        node = lowering.call(operator, (node, factor))
    return node


SUMS: Final[Mapping[str, Callable[[TreeLowering, tuple[ir.Expression, ...], Scope], int | None]]] = {
    name: partial(_sum, name) for name in ("SUM", "SUMPRODUCT")
}
"""Functions whose only argument may be such a product."""
