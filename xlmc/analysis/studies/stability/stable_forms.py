"""Other forms of sums of nearly equal numbers, and of logarithms of numbers near 1, that keep their digits.

    K·COS(a) + R          (R+K) - 2K·SIN(a/2)^2               (1-COS, the law of cosines: R+K is a square then)
    R·(1-SIN(a)^2)        R·COS(a)^2, and the other way round
    R·(1-SIN(a))          2R·SIN(PI()/4-a/2)^2
    COS(a)-COS(b)         2·SIN((a+b)/2)·SIN((b-a)/2), and those of SIN and TAN
    EXP(a)-1              (u-1)·a/LN(u) with u = EXP(a)       (W. Kahan; a where u is 1)
    LN(1+x)               x·LN(u)/(u-1) with u = 1+x          (W. Kahan; x where u is 1); LN(a/b), LN(a)-LN(b), LOG
    R + K·SQRT(a)         (R²-K²·a)/(R-K·SQRT(a))             (differences of roots, the root of a quadratic)
    SUMSQ - SUM^2/n       DEVSQ                               (variance), and COVARIANCE.P
    1/a - 1/b             (b-a)/(a·b)
    what cancels          the polynomial that is left
    x-SIN(x), (1+x)^n-1, COSH(x)-1, ACOS near 1           see `rarer_forms`

These are proposals: `steadying` offers one only after it was computed again. See N. J. Higham, Accuracy and Stability
of Numerical Algorithms, 2nd ed., 2002, chapters 1 and 14.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from typing import Final

from xlmc.analysis.studies.stability.formula_trees import parts_of, terms
from xlmc.analysis.studies.stability.momentum import times
from xlmc.analysis.studies.stability.polynomials import ONE, Polynomial, Polynomials
from xlmc.analysis.studies.stability.rarer_forms import (
    TWO,
    UNIT,
    Form,
    Tree,
    calls,
    combined,
    half,
    less_one,
    of_arccosine,
    of_growth,
    of_hyperbolic_cosine,
    of_one_and,
    of_small_angle,
    scaled,
    squared,
)
from xlmc.excel.address import Area
from xlmc.excel.formula import ir

__all__ = ["LOGARITHMS", "Form", "forms"]

LOGARITHMS: Final = frozenset({"LN", "LOG10", "LOG"})


def forms(part: Tree, algebra: Polynomials) -> Iterator[Form]:
    """Return the other forms of a part of a formula."""
    if isinstance(part, ir.Call) and part.name in LOGARITHMS:
        yield from _of_logarithm(part, algebra)
        return
    if isinstance(part, ir.Call) and part.name == "ACOS":
        yield from of_arccosine(part, algebra, _of_sum)
        return
    yield from _of_sum(part, algebra)


def _of_sum(part: Tree, algebra: Polynomials) -> Iterator[Form]:
    try:
        polynomial = algebra.of(part)
    except OverflowError:
        return
    for rule in _RULES:
        yield from rule(part, polynomial, algebra)


def _of_cosine(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for key, angle in calls(polynomial, algebra, "COS"):
        split = algebra.split(polynomial, key, 1)
        if split is None:
            continue
        of, rest = split
        sine = squared(ir.Call("SIN", (half(angle),)))
        left = algebra.sum(rest, of)
        if not left:
            yield Form(scaled(algebra, of, sine, -2))
        elif (root := algebra.square_root(left)) is not None:
            grown = scaled(algebra, algebra.scaled(of, Fraction(-1)), sine, 2)
            yield Form(ir.Binary("+", squared(algebra.tree(root)), grown))
        if not algebra.sum(rest, algebra.scaled(of, Fraction(-1))):
            yield Form(scaled(algebra, of, squared(ir.Call("SIN", (half(_short_of(angle, 180.0)),))), 2))


def _of_squares(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for name, other in (("SIN", "COS"), ("COS", "SIN")):
        for key, angle in calls(polynomial, algebra, name):
            split = algebra.split(polynomial, key, 2)
            if split is not None and not algebra.sum(*split):
                yield Form(scaled(algebra, split[1], squared(ir.Call(other, (angle,)))))


def _of_sine(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for key, angle in calls(polynomial, algebra, "SIN"):
        split = algebra.split(polynomial, key, 1)
        if split is not None and not algebra.sum(*split):
            yield Form(scaled(algebra, split[1], squared(ir.Call("SIN", (half(_short_of(angle, 90.0)),))), 2))


def _short_of(angle: Tree, degrees: float) -> Tree:
    """Return what an angle lacks of a number of degrees, in radians."""
    match angle:
        case ir.Call("RADIANS", (inner,)):
            return ir.Call("RADIANS", (ir.Binary("-", ir.Number(degrees), inner),))
        case _:
            turn: Tree = ir.Call("PI", ())
            turn = turn if degrees == 180.0 else ir.Binary("/", turn, ir.Number(180.0 / degrees))
            return ir.Binary("-", turn, angle)


def _opposite(polynomial: Polynomial, algebra: Polynomials, name: str) -> Iterator[tuple[Polynomial, Tree, Tree]]:
    """`K`, a and b of `K·f(a) - K·f(b)`."""
    called = calls(polynomial, algebra, name)
    for key, first in called:
        for other, second in called:
            one = algebra.split(polynomial, key, 1) if key != other else None
            two = algebra.split(one[1], other, 1) if one is not None else None
            if one is not None and two is not None and not two[1] and not algebra.sum(one[0], two[0]):
                yield one[0], first, second


def _of_angles(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    def ofhalf(name: str, a: Tree, b: Tree, sign: int) -> Tree:
        return ir.Call(name, (half(combined(a, b, sign, algebra)),))

    for factor, a, b in _opposite(polynomial, algebra, "COS"):
        yield Form(scaled(algebra, factor, times(ofhalf("SIN", a, b, 1), ofhalf("SIN", b, a, -1)), 2))
    for factor, a, b in _opposite(polynomial, algebra, "SIN"):
        yield Form(scaled(algebra, factor, times(ofhalf("COS", a, b, 1), ofhalf("SIN", a, b, -1)), 2))
    for factor, a, b in _opposite(polynomial, algebra, "TAN"):
        below = times(ir.Call("COS", (a,)), ir.Call("COS", (b,)))
        yield Form(scaled(algebra, factor, ir.Call("SIN", (combined(a, b, -1, algebra),))), below)


def _of_exponential(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for key, x in calls(polynomial, algebra, "EXP"):
        split = algebra.split(polynomial, key, 1)
        if split is not None and not algebra.sum(*split):
            if split[0] == {ONE: Fraction(-1)}:
                yield Form(less_one(x, negative=True))
            else:
                yield Form(scaled(algebra, split[0], less_one(x)))
    for factor, a, b in _opposite(polynomial, algebra, "EXP"):
        change = algebra.tree(algebra.sum(algebra.of(a), algebra.scaled(algebra.of(b), Fraction(-1))))
        yield Form(scaled(algebra, factor, times(ir.Call("EXP", (b,)), less_one(change))))
    for key, x in calls(polynomial, algebra, "TANH"):
        split = algebra.split(polynomial, key, 1)
        if split is not None and not algebra.sum(*split):
            below = ir.Binary("+", ir.Call("EXP", (times(TWO, x),)), UNIT)
            yield Form(algebra.scaled(split[1], Fraction(2)), below)


def _of_logarithm(part: ir.Call, algebra: Polynomials) -> Iterator[Form]:
    u, *base = part.arguments
    try:
        polynomial = algebra.of(u)
    except OverflowError:
        return
    if len(polynomial) > 1 and polynomial.get(ONE) == 1:
        x = algebra.tree({monomial: coefficient for monomial, coefficient in polynomial.items() if monomial != ONE})
        yield Form(*_to_base(part.name, base, lambda name: of_one_and(name, u, x)))
    if isinstance(u, ir.Binary) and u.operator == "/":
        change = _change(u.left, u.right, algebra)
        yield Form(*_to_base(part.name, base, lambda name: of_one_and(name, u, ir.Binary("/", change, u.right))))


def _to_base(name: str, base: Sequence[Tree], made: Callable[[str], Tree]) -> tuple[Tree, Tree | None]:
    """Return a logarithm, and what it is divided by where it has a base of its own."""
    if name != "LOG":
        return made(name), None
    return (made("LN"), ir.Call("LN", (base[0],))) if base else (made("LOG10"), None)


def _change(a: Tree, b: Tree, algebra: Polynomials) -> Tree:
    return algebra.tree(algebra.sum(algebra.of(a), algebra.scaled(algebra.of(b), Fraction(-1))))


def _of_ratio(name: str, a: Tree, b: Tree, algebra: Polynomials) -> Tree:
    return of_one_and(name, ir.Binary("/", a, b), ir.Binary("/", _change(a, b, algebra), b))


def _of_logarithms(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for name in ("LN", "LOG10"):
        for factor, a, b in _opposite(polynomial, algebra, name):
            yield Form(scaled(algebra, factor, _of_ratio(name, a, b, algebra)))


def _of_root(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    for key, inside in calls(polynomial, algebra, "SQRT"):
        split = algebra.split(polynomial, key, 1)
        if split is None or not split[1]:
            continue
        of, rest = split
        try:
            squared = algebra.product(algebra.product(of, of), algebra.of(inside))
            above = algebra.sum(algebra.product(rest, rest), algebra.scaled(squared, Fraction(-1)))
            above = algebra.without_roots(above)
        except OverflowError:
            continue
        root: Polynomial = algebra.atom(algebra.atoms[key])
        below = algebra.sum(rest, algebra.scaled(algebra.product(of, root), Fraction(-1)))
        if all(coefficient < 0 for coefficient in below.values()):
            below, above = algebra.scaled(below, Fraction(-1)), algebra.scaled(above, Fraction(-1))
        yield Form(above, algebra.tree(below))
        if all(not monomial for monomial in of):
            side = "<" if of[ONE] > 0 else ">"
            yield Form(above, algebra.tree(below), ir.Binary(side, algebra.tree(rest), ir.Number(0.0)))
        elif len(of) == 1:
            ((monomial, size),) = of.items()
            share = algebra.product(rest, {tuple((one, -power) for one, power in monomial): 1 / size})
            yield Form(above, algebra.tree(below), ir.Binary("<", algebra.tree(share), ir.Number(0.0)))
        yield Form(above, algebra.tree(below), ir.Binary("<>", algebra.tree(below), ir.Number(0.0)))


def _areas(tree: Tree) -> list[Area]:
    """Return the ranges in a formula, each once."""
    return list(dict.fromkeys(part for part in parts_of(tree) if isinstance(part, Area)))


def _of_variance(part: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    areas = _areas(part)
    if len(areas) == 1:
        count = ir.Call("COUNT", (areas[0],))
        yield from _times_counts(ir.Call("DEVSQ", (areas[0],)), count)
    if len(areas) == 2:
        mean = ir.Call("COVARIANCE.P", tuple(areas))
        count = ir.Call("COUNT", (areas[0],))
        yield Form(mean)
        yield Form(times(count, mean))
        yield Form(times(squared(count), mean))
    squares = [monomial[0][0] for monomial in polynomial if len(monomial) == 1 and monomial[0][1] == 2]
    if len(squares) > 1 and not areas:
        single = ir.Call("DEVSQ", tuple(algebra.atoms[key] for key in squares))
        yield from _times_counts(single, ir.Number(float(len(squares))))


def _times_counts(tree: Tree, count: Tree) -> Iterator[Form]:
    less = ir.Binary("-", count, UNIT)
    yield Form(tree)
    yield Form(tree, count)
    yield Form(times(count, tree))
    yield Form(tree, less)


def _of_fractions(_: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    divisors = sorted({key for monomial in polynomial for key, power in monomial if power == -1})
    if divisors and len(polynomial) > 1:
        above = polynomial
        for key in divisors:
            above = algebra.product(above, algebra.atom(algebra.atoms[key]))
        plain: Polynomial = {}
        for monomial, coefficient in above.items():
            term: Polynomial = {ONE: coefficient}
            for key, power in monomial:
                if power < 0:
                    return
                term = algebra.product(term, algebra.power(_as_polynomial(algebra, key), power))
            plain = algebra.sum(plain, term)
        yield Form(plain, times(*(algebra.atoms[key] for key in divisors)))


def _as_polynomial(algebra: Polynomials, key: str) -> Polynomial:
    """Return an atom as the polynomial that it is, where it was one below the line."""
    return algebra.of(algebra.atoms[key])


def _of_what_is_left(part: Tree, polynomial: Polynomial, algebra: Polynomials) -> Iterator[Form]:
    if len(polynomial) < sum(len(algebra.of(term)) for _, term in terms(part)):
        yield Form(polynomial)


_RULES: Final[tuple[Callable[[Tree, Polynomial, Polynomials], Iterator[Form]], ...]] = (
    _of_cosine,
    _of_squares,
    _of_sine,
    _of_angles,
    _of_exponential,
    _of_logarithms,
    _of_root,
    _of_variance,
    _of_fractions,
    of_small_angle,
    of_growth,
    of_hyperbolic_cosine,
    _of_what_is_left,
)
