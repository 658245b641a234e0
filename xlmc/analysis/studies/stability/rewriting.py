"""Forms of known formulas that do not lose digits. Each is recomputed with 50 digits beside the one it replaces.

(16′) V2 = -(V2f·SIN(β2-α1) + m1/m2·V1f·SIN(β1-α1)) / SIN(α1-α2)     no COS(α2), no V1
(15′) SIN(RADIANS(β-α)) instead of SIN(RADIANS(β)-RADIANS(α))        angles subtracted in degrees are exact
(23′) ATAN2(x, y) instead of ATAN(y/x)                               keeps the quadrant
(filters) lo·ABS(c) <= s·SIGN(c) instead of lo <= s/c                no division
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Case
from xlmc.analysis.studies.stability.formula_trees import factors, terms
from xlmc.analysis.studies.stability.momentum import angle_of, components, sine, spin, times
from xlmc.engine.passes.exact import Exact, as_double
from xlmc.engine.passes.random_rounding import closure
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.substitute import substitute
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.model.needed import filter_limits

__all__ = ["angles_in_degrees", "of_small_changes", "same", "with_quadrant", "without_cosine", "without_quotient"]

_TRIALS: Final = 4
_AWAY: Final = 1.001
"""Times the draws: where a cell has no value in any trial, as one that divides by COS of 270°."""


@dataclass(frozen=True, slots=True)
class _Term:
    """A term of momentum: a mass, a speed, and the cosine of an angle."""

    sign: int
    masses: tuple[ir.Expression, ...]
    below: tuple[ir.Expression, ...]
    angle: ir.Expression


def _term(sign: int, tree: ir.Expression) -> _Term | None:
    above, below = factors(tree)
    angles = [angle for part in above if (angle := angle_of(part, "COS")) is not None]
    if len(angles) != 1:
        return None
    rest = [part for part in above if angle_of(part, "COS") is None]
    for part in [one for one in rest if one == ir.Number(-1.0)]:
        sign = -sign
        rest.remove(part)
    return _Term(sign, tuple(rest), tuple(below), angles[0])


def without_cosine(case: Case, cell: Cell, cosine: ir.Expression) -> ir.Expression | None:
    """(16′) instead of (16): momentum along X solved for a speed, divided by the cosine of its angle.

    The whole cell must be `(m1·V1f·COS(β1) + m2·V2f·COS(β2) - m1·V1·COS(α1)) / (m2·COS(α2))`, its parts in any order.
    """
    above, below = factors(case.trees.formula(cell))
    above = [part for part in above if part != ir.Number(1.0)]
    own = angle_of(cosine, "COS")
    if cosine not in below or own is None or len(above) != 1:
        return None
    mass = [part for part in below if part != cosine]
    result = [_term(sign, term) for sign, term in terms(above[0])]
    if len(result) != 3 or len(mass) != 1 or any(term is None or term.below for term in result):
        return None
    known = [term for term in result if term is not None]
    own_departure = [term for term in known if term.sign > 0 and mass[0] in term.masses]
    approach = [term for term in known if term.sign < 0]
    other = [term for term in known if term.sign > 0 and mass[0] not in term.masses]
    if not len(own_departure) == len(approach) == len(other) == 1:
        return None
    shared = [part for part in other[0].masses if part in approach[0].masses]
    speeds = [[part for part in term.masses if part not in (*shared, mass[0])] for term in (own_departure[0], other[0])]
    if len(shared) != 1 or any(len(speed) != 1 for speed in speeds):
        return None
    own_part = times(speeds[0][0], sine(own_departure[0].angle, approach[0].angle))
    other_part = times(ir.Binary("/", shared[0], mass[0]), speeds[1][0], sine(other[0].angle, approach[0].angle))
    total = ir.Binary("+", own_part, other_part)
    return ir.Binary("/", ir.Unary("-", total), sine(approach[0].angle, own))


def _difference(left: ir.Expression, right: ir.Expression) -> ir.Expression | None:
    match left, right:
        case ir.Call("RADIANS", (a,)), ir.Call("RADIANS", (b,)):
            return ir.Call("RADIANS", (ir.Binary("-", a, b),))
        case _:
            return None


def of_small_changes(case: Case, cell: Cell) -> ir.Expression | None:
    """(17′) or (20′) instead of (17) or (20), differences of nearly equal numbers where a change of speed is small."""
    tree = case.trees.formula(cell)
    turned = spin(tree)
    candidates = [*([] if turned is None else [turned]), *components(case, tree)]
    return next((one for one in candidates if same(case, cell, one)), None)


def angles_in_degrees(tree: ir.Expression) -> ir.Expression | None:
    """(15′): differences of RADIANS as RADIANS of differences; otherwise None."""

    def change(part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, ir.Binary) and part.operator == "-":
            return _difference(part.left, part.right)
        return None

    changed = substitute(tree, change)
    return None if changed == tree else changed


def with_quadrant(
    tree: ir.Expression, part: ir.Expression, above: ir.Expression, below: ir.Expression
) -> ir.Expression:
    """(23′): `ATAN(y/x)` as `ATAN2(x, y)`, the whole brought above -180 and up to 180 where it is in degrees.

    Args:
        tree: the formula.
        part: the arctangent in it.
        above: y.
        below: x.
    """
    angle = ir.Call("ATAN2", (below, above))
    changed = substitute(tree, lambda one: angle if one == part else None)
    degrees = ir.Call("DEGREES", (angle,))
    if any(term == degrees for _, term in terms(changed)) and len(terms(changed)) > 1:
        half = ir.Number(180.0)
        turned = ir.Binary("-", half, changed)
        return ir.Binary("-", half, ir.Call("MOD", (turned, ir.Number(360.0))))
    return changed


def without_quotient(case: Case, filter_: Filter, tree: ir.Expression) -> ir.Expression | None:
    """Write a filter of a quotient, its limits numbers or cells, as a test without division."""
    limits = filter_limits(filter_)
    if not (isinstance(tree, ir.Binary) and tree.operator == "/" and limits):
        return None
    size, turned = ir.Call("ABS", (tree.right,)), ir.Binary("*", tree.left, ir.Call("SIGN", (tree.right,)))
    tests: list[ir.Expression] = [ir.Binary("<>", tree.right, ir.Number(0.0))]
    for relation, bound in limits:
        limit = bound if isinstance(bound, Cell) else ir.Number(float(bound))
        product = limit if limit == ir.Number(0.0) else size if limit == ir.Number(1.0) else times(limit, size)
        tests.append(ir.Binary(relation, turned, product))
    return ir.Call("AND", tuple(tests))


def same(case: Case, cell: Cell, tree: ir.Expression, digits: int = 30) -> bool:
    """Whether a formula gives in a cell what the cell's own gives, to 30 digits, in some trials and beside them."""
    node = case.trees.node_of(tree, cell)
    if node is None:
        return False
    old = case.node[cell]
    exact = Exact(case.dag, closure(case.dag, [node, old]))
    compared = 0
    for trial in np.linspace(case.special, case.n - 1, _TRIALS).astype(int):
        for away in (1.0, _AWAY):
            result = exact.trial({key: float(draws[trial]) * away for key, draws in case.draws.items()})
            wanted = result[old]
            if np.isnan(as_double(wanted)):
                continue
            compared += 1
            if np.isnan(as_double(result[node])) or abs(result[node] - wanted) > abs(wanted) * 10.0**-digits:
                return False
    return compared > 0
