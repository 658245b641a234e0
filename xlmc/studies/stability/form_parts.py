"""What other forms of formulas are made of."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from xlmc.formula import ir
from xlmc.studies.stability.momentum import times
from xlmc.studies.stability.polynomials import ONE, Polynomial, Polynomials

__all__ = ["TWO", "UNIT", "Form", "Tree", "calls", "combined", "half", "less_one", "of_one_and", "scaled", "squared"]

Tree = ir.Expression

TWO: Final = ir.Number(2.0)
UNIT: Final = ir.Number(1.0)


@dataclass(frozen=True, slots=True)
class Form:
    """Another form of a part of a formula: `above`, divided by `below` if there is one.

    Attributes:
        above: a formula, or a polynomial, which a factor beside the part may be drawn into.
        below: a formula.
        only_if: it keeps the digits only where this is true; the old form does where it is not.
    """

    above: Tree | Polynomial
    below: Tree | None = None
    only_if: Tree | None = None


def calls(found: Polynomial, algebra: Polynomials, name: str) -> list[tuple[str, Tree]]:
    """The atoms of a polynomial that call a function: their keys and arguments."""
    keys = {key: algebra.atoms[key] for monomial in found for key, _ in monomial}
    return [
        (key, atom.arguments[0])
        for key, atom in keys.items()
        if isinstance(atom, ir.Call) and atom.name == name and len(atom.arguments) == 1
    ]


def squared(tree: Tree) -> Tree:
    return ir.Binary("^", tree, TWO)


def half(angle: Tree) -> Tree:
    return ir.Binary("/", angle, TWO)


def combined(first: Tree, second: Tree, sign: int, algebra: Polynomials) -> Tree:
    """A sum or difference of angles, without what cancels; in degrees where both are."""
    match first, second:
        case ir.Call("RADIANS", (a,)), ir.Call("RADIANS", (b,)):
            return ir.Call("RADIANS", (combined(a, b, sign, algebra),))
        case _:
            other = algebra.scaled(algebra.of(second), Fraction(sign))
            return algebra.tree(algebra.sum(algebra.of(first), other))


def scaled(algebra: Polynomials, factor: Polynomial, tree: Tree, by: int = 1) -> Tree:
    """A polynomial times a number times a formula."""
    grown = algebra.scaled(factor, Fraction(by))
    if grown == {ONE: Fraction(1)}:
        return tree
    if grown == {ONE: Fraction(-1)}:
        return ir.Unary("-", tree)
    return times(algebra.tree(grown), tree)


def less_one(x: Tree, *, negative: bool = False) -> Tree:
    """`EXP(x)-1`, or `1-EXP(x)`. Far from 0 the old form serves, and the logarithm might be one of 0."""
    u = ir.Call("EXP", (x,))
    change = ir.Binary("-", UNIT, u) if negative else ir.Binary("-", u, UNIT)
    quotient = ir.Binary("/", times(change, x), ir.Call("LN", (u,)))
    near = ir.Call("IF", (ir.Binary("=", u, UNIT), ir.Unary("-", x) if negative else x, quotient))
    return ir.Call("IF", (ir.Binary("<", ir.Call("ABS", (x,)), UNIT), near, change))


def of_one_and(name: str, u: Tree, x: Tree) -> Tree:
    """The logarithm of `u`, which is `1+x`."""
    near = ir.Binary("/", times(x, ir.Call(name, (u,))), ir.Binary("-", u, UNIT))
    at_one = x if name == "LN" else ir.Binary("/", x, ir.Call("LN", (ir.Number(10.0),)))
    return ir.Call("IF", (ir.Binary("=", u, UNIT), at_one, near))
