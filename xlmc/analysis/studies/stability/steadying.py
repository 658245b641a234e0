"""Offer a formula with another form of the part that loses digits, but only after both were computed.

What is computed is what is read from its text. It must be the same to 20 digits, have a number wherever the old one
has, in all trials and in the corners of the ranges, and be off by a tenth of what the old one is at most, in the trials
in which that is worst and in others, also when its roundings are made at random. In no trial may it be off much more
than the old one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case, Floats
from xlmc.analysis.studies.stability.formula_trees import factors, parts_of, replace_part
from xlmc.analysis.studies.stability.polynomials import Polynomial, Polynomials
from xlmc.analysis.studies.stability.rewriting import same
from xlmc.analysis.studies.stability.stable_forms import Form, forms
from xlmc.engine.passes.random_rounding import RandomRounding, closure, evaluate, numbers_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir

__all__ = ["steady_form"]

_STEPS_BACK: Final = 3
"""How many cells back formulas are followed."""

_DIGITS: Final = 20
_BETTER: Final = 0.1
_OTHERS: Final = 16
_MOST_RANGES: Final = 4
"""Up to this number of assumptions all corners are tried, with more only the two extreme ones."""

_WORSE: Final = 10.0
_UNLIKE: Final = 30.0
"""Times what rounding does to the old one: where the two differ by more, 50 digits say which is off."""

_SUSPECTS: Final = 4
_REPLICAS: Final = 3
_LONGEST: Final = 1000
"""Characters of a formula: nobody would type more."""


def steady_form(case: Case, cell: Cell, part: ir.Expression, worst: Sequence[int]) -> ir.Expression | None:
    """Write a cell's formula with another form of one part of it; None if none is known to be better.

    Args:
        case: the evidence.
        cell: whose formula.
        part: of it, which loses the digits.
        worst: trials in which it does.
    """
    for tree in _candidates(case, cell, part):
        typed = case.trees.read_back(tree, cell) if len(case.trees.text(tree, cell)) <= _LONGEST else None
        if typed is not None and _is_better(case, cell, typed, worst):
            return typed
    return None


def _candidates(case: Case, cell: Cell, part: ir.Expression) -> Iterator[ir.Expression]:
    tree = case.trees.formula(cell)
    algebra = Polynomials(lambda one: case.trees.text(one, cell))
    opened: ir.Expression | None = part
    for _ in range(_STEPS_BACK + 1):
        if opened is None:
            return
        for form in forms(opened, algebra):
            yield from _insert_form(tree, part, form, algebra)
        further = case.trees.open_references(opened)
        opened = None if further == opened else further


def _insert_form(tree: ir.Expression, part: ir.Expression, form: Form, algebra: Polynomials) -> Iterator[ir.Expression]:
    """Write the whole formula with a form in it, the factors beside it drawn in where that is possible."""
    if isinstance(form.above, Mapping):
        whole = _product(tree, part)
        if whole is not None:
            try:
                drawn = _draw_in(whole, part, form.above, algebra)
            except OverflowError:
                drawn = None
            if drawn is not None:
                yield replace_part(tree, whole, _choose(form, algebra.tree(drawn), whole))
    above = algebra.tree(form.above) if isinstance(form.above, Mapping) else form.above
    yield replace_part(tree, part, _choose(form, above, part))


def _choose(form: Form, above: ir.Expression, old: ir.Expression) -> ir.Expression:
    new = above if form.below is None else ir.Binary("/", above, form.below)
    return new if form.only_if is None else ir.Call("IF", (form.only_if, new, old))


def _product(tree: ir.Expression, part: ir.Expression) -> ir.Expression | None:
    """Return the outermost product in a formula of which a part is a factor."""
    for one in parts_of(tree):
        above, below = factors(one)
        if len(above) + len(below) > 1 and any(each is part for each in above):
            return one
    return None


def _draw_in(whole: ir.Expression, part: ir.Expression, above: Polynomial, algebra: Polynomials) -> Polynomial | None:
    """Return what stands above the line, times the other factors; None if these are sums."""
    polynomial = above
    others, below = factors(whole)
    for one in others:
        if one is not part:
            polynomial = algebra.product(polynomial, algebra.of(one))
    for one in below:
        divisor = algebra.of(one)
        if len(divisor) != 1:
            return None
        polynomial = algebra.product(polynomial, algebra.of(ir.Binary("/", ir.Number(1.0), one)))
    return polynomial


def _is_better(case: Case, cell: Cell, tree: ir.Expression, worst: Sequence[int]) -> bool:
    node = case.trees.node_of(tree, cell)
    if node is None or not same(case, cell, tree, _DIGITS):
        return False
    old_node = case.node[cell]
    if _loses_numbers(case, old_node, node, _corners(case, old_node)):
        return False
    trials = sorted({*worst, *_some(case, _OTHERS), *_unlike(case, cell, node)})
    new = _evaluate(case, node, {key: draw[trials] for key, draw in case.draws.items()})
    old = case.number(old_node)[trials]
    exact = np.array([case.exact_number(old_node, trial) for trial in trials])
    with np.errstate(all="ignore"):
        size = np.fmax(case.inherent(cell)[trials], np.abs(exact) * np.finfo(float).eps)
        was = np.abs(old - exact) / size
        is_ = np.abs(new - exact) / size
    if (is_[0] > _WORSE * np.fmax(was, _WORSE)).any():
        return False
    return bool(np.nanmax(is_, initial=0.0) <= _BETTER * np.nanmax(was, initial=0.0))


def _loses_numbers(case: Case, old_node: int, node: int, corners: Mapping[str, Floats]) -> bool:
    """Whether a node has no number somewhere where another one has."""
    for draws in (case.draws, corners):
        old, new = (_evaluate(case, one, draws, replicas=0)[0] for one in (old_node, node))
        if (np.isfinite(old) & ~np.isfinite(new)).any():
            return True
    return False


def _corners(case: Case, node: int) -> dict[str, Floats]:
    """Draws with the assumptions that a node needs at the ends of their ranges, and at 0, the others as in a trial."""
    needed = [key for key in case.names if key in case.inputs_of(node)]
    ends = [sorted({float(case.draws[key].min()), float(case.draws[key].max()), *_zero(case, key)}) for key in needed]
    rows = list(product(*ends)) if len(needed) <= _MOST_RANGES else [*zip(*((e[0], e[-1]) for e in ends), strict=True)]
    result = {key: np.full(len(rows), draw[0]) for key, draw in case.draws.items()}
    return result | {key: np.array([row[at] for row in rows]) for at, key in enumerate(needed)}


def _zero(case: Case, key: str) -> tuple[float, ...]:
    draws = case.draws[key]
    return (0.0,) if draws.min() < 0 < draws.max() else ()


def _unlike(case: Case, cell: Cell, node: int) -> list[int]:
    """Return the trials in which another form differs most from the old one, by more than rounding does to that."""
    old = case.node[cell]
    with np.errstate(all="ignore"):
        rounding = np.fmax(case.errors[old], np.nan_to_num(case.inherent(cell)))
        unlike = np.nan_to_num(
            np.abs(_evaluate(case, node, case.draws, replicas=0)[0] - case.number(old)) / (_UNLIKE * rounding)
        )
    return [int(trial) for trial in np.argsort(unlike)[::-1][:_SUSPECTS] if unlike[trial] > 1]


def _some(case: Case, count: int) -> list[int]:
    return [int(trial) for trial in np.linspace(0, case.n - 1, count)]


def _evaluate(case: Case, node: int, draws: Mapping[str, Floats], replicas: int = _REPLICAS) -> Floats:
    """Return a node's numbers for some draws, plain and with roundings made at random, `(1 + replicas, m)`."""
    order = closure(case.dag, [node])
    count = next((draw.size for draw in draws.values()), 1)
    roundings = [None, *(RandomRounding((_OTHERS, replica)) for replica in range(replicas))]
    return np.array([numbers_of(evaluate(case.dag, order, draws, one)[node], count) for one in roundings])
