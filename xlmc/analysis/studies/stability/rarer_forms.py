"""Other forms of segments of circles, of growth, of catenaries, and of angles between directions.

K·(x-SIN(x))          K·x³/6·(1-x²/20·(1-x²/42·(…)))      where x is below .5: to 20 digits there
K·((1+x)^n-1)         K·(EXP(y)-1), y = n·LN(1+x)          both by W. Kahan's forms
K·(COSH(x)-1)         2K·SINH(x/2)^2
ACOS(u)               2·ASIN(SQRT(h)), h = (1-u)/2         where a form of 1-u is known
ACOS(SIN(a)·SIN(b)+COS(a)·COS(b)·COS(c))                    h = SIN((a-b)/2)^2+COS(a)·COS(b)·SIN(c/2)^2 (haversine)
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from xlmc.analysis.studies.stability.momentum import times
from xlmc.analysis.studies.stability.polynomials import ONE, Monomial, Polynomial, Polynomials
from xlmc.excel.formula import ir

__all__ = [
    "TWO",
    "UNIT",
    "Form",
    "Tree",
    "calls",
    "combined",
    "half",
    "less_one",
    "of_arccosine",
    "of_growth",
    "of_hyperbolic_cosine",
    "of_one_and",
    "of_small_angle",
    "scaled",
    "squared",
]

Tree = ir.Expression

TWO: Final = ir.Number(2.0)
UNIT: Final = ir.Number(1.0)

_NEAR: Final = 0.5
_SERIES: Final = (20, 42, 72, 110, 156, 210, 272)
"""Divisors of the terms of `6·(x-SIN(x))/x³`, each as a share of the one before; the next one is below 1E-21 at .5."""


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


def calls(polynomial: Polynomial, algebra: Polynomials, name: str) -> list[tuple[str, Tree]]:
    """Return the atoms of a polynomial that call a function: their keys and arguments."""
    keys = {key: algebra.atoms[key] for monomial in polynomial for key, _ in monomial}
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
    """Return a sum or difference of angles, without what cancels; in degrees where both are."""
    match first, second:
        case ir.Call("RADIANS", (a,)), ir.Call("RADIANS", (b,)):
            return ir.Call("RADIANS", (combined(a, b, sign, algebra),))
        case _:
            other = algebra.scaled(algebra.of(second), Fraction(sign))
            return algebra.tree(algebra.sum(algebra.of(first), other))


def scaled(algebra: Polynomials, factor: Polynomial, tree: Tree, by: int = 1) -> Tree:
    """Write a polynomial times a number times a formula."""
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
    """Write the logarithm of `u`, which is `1+x`."""
    near = ir.Binary("/", times(x, ir.Call(name, (u,))), ir.Binary("-", u, UNIT))
    at_one = x if name == "LN" else ir.Binary("/", x, ir.Call("LN", (ir.Number(10.0),)))
    return ir.Call("IF", (ir.Binary("=", u, UNIT), at_one, near))


def of_small_angle(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    """Write a steady form of `x-SIN(x)`."""
    for key, x in calls(polynomial, algebra, "SIN"):
        split = algebra.split(polynomial, key, 1)
        if split is None:
            continue
        of, rest = split
        try:
            left = algebra.sum(rest, algebra.product(of, algebra.of(x)))
        except OverflowError:
            continue
        if not left:
            near = ir.Binary("<", ir.Call("ABS", (x,)), ir.Number(_NEAR))
            plain = ir.Binary("-", x, ir.Call("SIN", (x,)))
            yield Form(scaled(algebra, of, ir.Call("IF", (near, _series(x), plain)), -1))


def _series(x: Tree) -> Tree:
    built: Tree = UNIT
    for divisor in reversed(_SERIES):
        share = ir.Binary("/", squared(x), ir.Number(float(divisor)))
        built = ir.Binary("-", UNIT, share if built == UNIT else times(share, built))
    return times(ir.Binary("/", ir.Binary("^", x, ir.Number(3.0)), ir.Number(6.0)), built)


def of_growth(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    """Write a steady form of `(1+x)^n-1`."""
    for key in dict.fromkeys(key for monomial in polynomial for key, _ in monomial):
        atom = algebra.atoms[key]
        split = algebra.split(polynomial, key, 1)
        if not isinstance(atom, ir.Binary) or atom.operator != "^" or split is None or algebra.sum(*split):
            continue
        try:
            base = algebra.of(atom.left)
        except OverflowError:
            continue
        if len(base) > 1 and base.get(ONE) == 1:
            x = algebra.tree({monomial: size for monomial, size in base.items() if monomial != ONE})
            yield Form(scaled(algebra, split[0], less_one(times(atom.right, of_one_and("LN", atom.left, x)))))


def of_hyperbolic_cosine(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    """Write a steady form of `COSH(x)-1`."""
    for key, x in calls(polynomial, algebra, "COSH"):
        split = algebra.split(polynomial, key, 1)
        if split is not None and not algebra.sum(*split):
            yield Form(scaled(algebra, split[0], squared(ir.Call("SINH", (half(x),))), 2))


def of_arccosine(
    part: ir.Call, algebra: Polynomials, of_sum: Callable[[Tree, Polynomials], Iterator[Form]]
) -> Iterator[Form]:
    """Write a steady form of `ACOS(u)` where u is near 1, kept at 1 by MIN or not.

    Args:
        part: the call.
        algebra: reads formulas.
        of_sum: gives other forms of a sum.
    """
    u = _without_bounds(part.arguments[0])
    try:
        polynomial = algebra.of(u)
    except OverflowError:
        return
    great = _great_circle(polynomial, algebra)
    if great is not None:
        yield Form(_of_haversine(great))
    left = algebra.sum({ONE: Fraction(1)}, algebra.scaled(polynomial, Fraction(-1)))
    if len(left) < len(polynomial) + 1:
        yield Form(_of_haversine(ir.Binary("/", algebra.tree(left), TWO)))
    for form in of_sum(ir.Binary("-", UNIT, u), algebra):
        above = algebra.tree(form.above) if isinstance(form.above, Mapping) else form.above
        if form.only_if is None:
            whole = above if form.below is None else ir.Binary("/", above, form.below)
            yield Form(_of_haversine(ir.Binary("/", whole, TWO)))


def _of_haversine(h: Tree) -> Tree:
    """Write the angle whose haversine, `(1-COS)/2`, is h: rounding may bring it above 1 at half a turn."""
    return times(TWO, ir.Call("ASIN", (ir.Call("MIN", (UNIT, ir.Call("SQRT", (h,)))),)))


def _without_bounds(u: Tree) -> Tree:
    """Return the argument without `MIN(1,…)` and `MAX(-1,…)`."""
    bounds = (UNIT, ir.Number(-1.0), ir.Unary("-", UNIT))
    while isinstance(u, ir.Call) and u.name in ("MIN", "MAX") and len(u.arguments) == 2:
        inner = [one for one in u.arguments if one not in bounds]
        if len(inner) != 1:
            return u
        u = inner[0]
    return u


def _great_circle(polynomial: Polynomial, algebra: Polynomials) -> Tree | None:
    """Write the haversine of `SIN(a)·SIN(b)+COS(a)·COS(b)·COS(c)`, or with SIN and COS of a and b the other way round.

    None if it is something else.
    """
    if len(polynomial) != 2 or any(size != 1 for size in polynomial.values()):
        return None
    short, long = sorted(polynomial, key=_degree)
    for name, other in (("SIN", "COS"), ("COS", "SIN")):
        pair, rest = _arguments(short, name, algebra), _arguments(long, other, algebra)
        between = [one for one in _arguments(long, "COS", algebra) if other == "SIN" or one not in pair]
        between = between or [one for one in pair if rest.count(one) > pair.count(one)]
        if _degree(short) == len(pair) == 2 and _degree(long) == 3 and len(between) == 1:
            a, b = pair
            if sorted(map(repr, rest)) == sorted(map(repr, [*pair, *(between if other == "COS" else [])])):
                across = squared(ir.Call("SIN", (half(combined(a, b, -1, algebra)),)))
                beside = times(ir.Call(other, (a,)), ir.Call(other, (b,)))
                along = times(beside, squared(ir.Call("SIN", (half(between[0]),))))
                return along if a == b else ir.Binary("+", across, along)
    return None


def _degree(monomial: Monomial) -> int:
    return sum(power for _, power in monomial)


def _arguments(monomial: Monomial, name: str, algebra: Polynomials) -> list[Tree]:
    """Return the arguments of the calls of a function that a monomial has for factors."""
    result: list[Tree] = []
    for key, power in monomial:
        atom = algebra.atoms[key]
        if isinstance(atom, ir.Call) and atom.name == name:
            result += [atom.arguments[0]] * power
    return result
