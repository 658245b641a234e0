"""A formula in which the part that loses digits stands in another form, offered only after both were computed.

It must be the same to 20 digits, have a number wherever the old one has, and be off by a tenth of what the old one is
at most, in the trials in which that is worst and in others, also when its roundings are made at random.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell
from xlmc.compile.replicas import Jitter, closure, evaluation, numbers
from xlmc.formula import ir
from xlmc.stability.case import Case, Floats
from xlmc.stability.polynomials import Polynomial, Polynomials
from xlmc.stability.rewriting import same
from xlmc.stability.stable_forms import Form, forms
from xlmc.stability.trees import factors, replaced

__all__ = ["steadied"]

_STEPS_BACK: Final = 3
"""Formulas of other cells are looked into as far as that."""

_DIGITS: Final = 20
_BETTER: Final = 0.1
_OTHERS: Final = 16
_WITH_A_NUMBER: Final = 256
"""Trials in which it must have a number where the old one has."""

_REPLICAS: Final = 3
_LONGEST: Final = 1000
"""Characters: nobody would type more."""


def steadied(case: Case, cell: Cell, part: ir.Expression, worst: Sequence[int]) -> ir.Expression | None:
    """A cell's formula with another form of one part of it; None where none is known to be better.

    Args:
        case: the evidence.
        cell: whose formula.
        part: of it, which loses the digits.
        worst: trials in which it does.
    """
    return next((tree for tree in _candidates(case, cell, part) if _is_better(case, cell, tree, worst)), None)


def _candidates(case: Case, cell: Cell, part: ir.Expression) -> Iterator[ir.Expression]:
    tree = case.lowering.graph.formulas[cell]
    algebra = Polynomials(lambda one: case.trees.text(one, cell))
    opened: ir.Expression | None = part
    for _ in range(_STEPS_BACK + 1):
        if opened is None:
            return
        for form in forms(opened, algebra):
            yield from _placed(tree, part, form, algebra)
        further = case.trees.opened(opened)
        opened = None if further == opened else further


def _placed(tree: ir.Expression, part: ir.Expression, form: Form, algebra: Polynomials) -> Iterator[ir.Expression]:
    """The whole formula with a form in it, the factors beside it drawn in where that is possible."""
    if isinstance(form.above, Mapping):
        product = _product(tree, part)
        if product is not None:
            try:
                drawn = _drawn(product, part, form.above, algebra)
            except OverflowError:
                drawn = None
            if drawn is not None:
                yield replaced(tree, product, _chosen(form, algebra.tree(drawn), product))
    above = algebra.tree(form.above) if isinstance(form.above, Mapping) else form.above
    yield replaced(tree, part, _chosen(form, above, part))


def _chosen(form: Form, above: ir.Expression, old: ir.Expression) -> ir.Expression:
    new = above if form.below is None else ir.Binary("/", above, form.below)
    return new if form.only_if is None else ir.Call("IF", (form.only_if, new, old))


def _product(tree: ir.Expression, part: ir.Expression) -> ir.Expression | None:
    """The outermost product in a formula of which a part is a factor."""
    open_ = [tree]
    while open_:
        one = open_.pop()
        above, below = factors(one)
        if len(above) + len(below) > 1 and any(each is part for each in above):
            return one
        match one:
            case ir.Unary(_, operand):
                open_.append(operand)
            case ir.Binary(_, left, right):
                open_ += [right, left]
            case ir.Call(_, arguments):
                open_ += reversed(arguments)
            case _:
                pass
    return None


def _drawn(product: ir.Expression, part: ir.Expression, above: Polynomial, algebra: Polynomials) -> Polynomial | None:
    """What stands above the line, times the other factors; None where these are sums."""
    found = above
    others, below = factors(product)
    for one in others:
        if one is not part:
            found = algebra.product(found, algebra.of(one))
    for one in below:
        divisor = algebra.of(one)
        if len(divisor) != 1:
            return None
        found = algebra.product(found, algebra.of(ir.Binary("/", ir.Number(1.0), one)))
    return found


def _is_better(case: Case, cell: Cell, tree: ir.Expression, worst: Sequence[int]) -> bool:
    place = case.trees.place(tree, cell)
    if place is None or len(case.trees.text(tree, cell)) > _LONGEST or not same(case, cell, tree, _DIGITS):
        return False
    node = case.node[cell]
    trials = sorted({*worst, *_some(case, _OTHERS)})
    rows = np.array([*trials, *_some(case, _WITH_A_NUMBER)])
    new = _evaluated(case, place, rows)
    old = case.number(node)
    if (np.isfinite(old[rows]) & ~np.isfinite(new)).any():
        return False
    exact = np.array([case.exact_number(node, trial) for trial in trials])
    with np.errstate(all="ignore"):
        size = np.fmax(case.inherent(cell)[trials], np.abs(exact) * np.finfo(float).eps)
        was = np.abs(old[trials] - exact) / size
        is_ = np.abs(new[:, : len(trials)] - exact) / size
    return bool(np.nanmax(is_, initial=0.0) <= _BETTER * np.nanmax(was, initial=0.0))


def _some(case: Case, count: int) -> list[int]:
    return [int(trial) for trial in np.linspace(0, case.n - 1, count)]


def _evaluated(case: Case, place: int, rows: NDArray[np.intp]) -> Floats:
    """A node's numbers in some trials, plain and with roundings made at random, `(1 + replicas, m)`."""
    order = closure(case.dag, [place])
    draws = {key: draw[rows] for key, draw in case.draws.items()}
    jitters = [None, *(Jitter((_OTHERS, replica)) for replica in range(_REPLICAS))]
    return np.array([numbers(evaluation(case.dag, order, draws, one)[place], rows.size) for one in jitters])
