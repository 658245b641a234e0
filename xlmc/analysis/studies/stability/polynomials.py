"""Formulas as polynomials with exact coefficients, so that terms that cancel are seen to.

A polynomial maps monomials to coefficients; a monomial is a set of atoms with whole powers, negative ones too; an atom
is whatever part of a formula is no sum, product, quotient or whole power, known by its text. `(A1+5)^2-25` is
`{A1²: 1, A1: 10}`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from itertools import combinations
from typing import Final

from xlmc.analysis.studies.stability.momentum import times
from xlmc.excel.formula import ir

__all__ = ["ONE", "Monomial", "Polynomial", "Polynomials"]

Tree = ir.Expression
Monomial = tuple[tuple[str, int], ...]
Polynomial = Mapping[Monomial, Fraction]

ONE: Final[Monomial] = ()

_MOST_TERMS: Final = 60
_MOST_POWER: Final = 4


class Polynomials:
    """Reads formulas as polynomials, and writes them as formulas.

    Args:
        text: of a formula; two atoms of one text are the same.
    """

    def __init__(self, text: Callable[[Tree], str]) -> None:
        self._text = text
        self.atoms: dict[str, Tree] = {}

    def of(self, tree: Tree) -> Polynomial:
        """Read a formula as a polynomial.

        Raises:
            OverflowError: it has too many terms.
        """
        match tree:
            case ir.Number(value):
                return _clean({ONE: Fraction(repr(float(value)))})
            case ir.Unary("-", operand):
                return self.scaled(self.of(operand), Fraction(-1))
            case ir.Unary("+", operand):
                return self.of(operand)
            case ir.Unary("%", operand):
                return self.scaled(self.of(operand), Fraction(1, 100))
            case ir.Binary("+", left, right):
                return self.sum(self.of(left), self.of(right))
            case ir.Binary("-", left, right):
                return self.sum(self.of(left), self.scaled(self.of(right), Fraction(-1)))
            case ir.Binary("*", left, right):
                return self.product(self.of(left), self.of(right))
            case ir.Binary("/", left, right):
                return self.product(self.of(left), self._inverse(right))
            case ir.Binary("^", base, ir.Number(power)) if power in range(_MOST_POWER + 1):
                return self.power(self.of(base), int(power))
            case ir.Binary("^", base, ir.Unary("-", ir.Number(1.0)) | ir.Number(-1.0)):
                return self._inverse(base)
            case ir.Call("POWER", (base, power)):
                return self.of(ir.Binary("^", base, power))
            case ir.Binary("^", base, ir.Number(0.5) | ir.Binary("/", ir.Number(1.0), ir.Number(2.0))):
                return self.atom(ir.Call("SQRT", (base,)))
            case _:
                return self.atom(tree)

    def atom(self, tree: Tree, power: int = 1) -> Polynomial:
        """Read a part of a formula that is one thing."""
        key = self._text(tree)
        self.atoms.setdefault(key, tree)
        return {((key, power),): Fraction(1)}

    def _inverse(self, tree: Tree) -> Polynomial:
        polynomial = self.of(tree)
        if len(polynomial) != 1:
            return self.atom(tree, -1)
        ((monomial, coefficient),) = polynomial.items()
        return {tuple((key, -power) for key, power in monomial): 1 / coefficient}

    def sum(self, *polynomials: Polynomial) -> Polynomial:
        polynomial: dict[Monomial, Fraction] = {}
        for one in polynomials:
            for monomial, coefficient in one.items():
                polynomial[monomial] = polynomial.get(monomial, Fraction(0)) + coefficient
        return _clean(polynomial)

    def scaled(self, polynomial: Polynomial, by: Fraction) -> Polynomial:
        return _clean({monomial: coefficient * by for monomial, coefficient in polynomial.items()})

    def product(self, left: Polynomial, right: Polynomial) -> Polynomial:
        """Multiply; raises OverflowError where the product has too many terms."""
        if len(left) * len(right) > _MOST_TERMS**2:
            raise OverflowError
        polynomial: dict[Monomial, Fraction] = {}
        for one, a in left.items():
            for other, b in right.items():
                monomial = _join((one, other))
                polynomial[monomial] = polynomial.get(monomial, Fraction(0)) + a * b
        if len(polynomial) > _MOST_TERMS:
            raise OverflowError
        return _clean(polynomial)

    def power(self, polynomial: Polynomial, power: int) -> Polynomial:
        result: Polynomial = {ONE: Fraction(1)}
        for _ in range(power):
            result = self.product(result, polynomial)
        return result

    def split(self, polynomial: Polynomial, key: str, power: int) -> tuple[Polynomial, Polynomial] | None:
        """`K` and `R` of `K·atom^power + R`; None if the atom stands there in another power, or not at all."""
        of, rest = {}, {}
        for monomial, coefficient in polynomial.items():
            powers = dict(monomial)
            if key not in powers:
                rest[monomial] = coefficient
            elif powers.pop(key) == power:
                of[tuple(sorted(powers.items()))] = coefficient
            else:
                return None
        return (of, rest) if of else None

    def without_roots(self, polynomial: Polynomial) -> Polynomial:
        """Replace `SQRT(a)^2` by `a` in the polynomial."""
        result: Polynomial = {}
        for monomial, coefficient in polynomial.items():
            term: Polynomial = {ONE: coefficient}
            for key, power in monomial:
                atom = self.atoms[key]
                if isinstance(atom, ir.Call) and atom.name == "SQRT" and power >= 2:
                    term = self.product(term, self.power(self.of(atom.arguments[0]), power // 2))
                    power %= 2
                term = self.product(term, {_join([((key, power),)]): Fraction(1)})
            result = self.sum(result, term)
        return result

    def tree(self, polynomial: Polynomial) -> Tree:
        """Write the polynomial as a formula, with what is added before what is subtracted."""
        terms = sorted(polynomial.items(), key=lambda each: each[1] < 0)
        built: Tree | None = None
        for monomial, coefficient in terms:
            if built is None:
                built = self._term(monomial, abs(coefficient), negative=coefficient < 0)
            else:
                built = ir.Binary("-" if coefficient < 0 else "+", built, self._term(monomial, abs(coefficient)))
        return ir.Number(0.0) if built is None else built

    def _term(self, monomial: Monomial, coefficient: Fraction, *, negative: bool = False) -> Tree:
        above = [self._power(key, power) for key, power in monomial if power > 0]
        below = [self._power(key, -power) for key, power in monomial if power < 0]
        number, divisor = _as_numbers(coefficient)
        if number != 1 or not above:
            above.insert(0, ir.Number(number))
        if divisor != 1:
            below.insert(0, ir.Number(divisor))
        if negative:
            above[0] = ir.Unary("-", above[0])
        built = times(*above)
        return ir.Binary("/", built, times(*below)) if below else built

    def _power(self, key: str, power: int) -> Tree:
        atom = self.atoms[key]
        return atom if power == 1 else ir.Binary("^", atom, ir.Number(float(power)))

    def square_root(self, polynomial: Polynomial) -> Polynomial | None:
        """Return `a ± b` of `a² ± 2ab + b²`, or the root of a single square; None if it is neither."""
        squares = [(m, c) for m, c in polynomial.items() if c > 0 and all(power % 2 == 0 for _, power in m)]
        roots = [(m, r) for m, c in squares if (r := _root(c)) is not None]
        halves = [(tuple((key, power // 2) for key, power in m), r) for m, r in roots]
        for first, second in combinations(halves, 2):
            for sign in (1, -1):
                root = self.sum({first[0]: first[1]}, {second[0]: sign * second[1]})
                if self.product(root, root) == polynomial:
                    return root
        return None


def _clean(polynomial: Mapping[Monomial, Fraction]) -> Polynomial:
    return {monomial: coefficient for monomial, coefficient in polynomial.items() if coefficient}


def _join(monomials: Iterable[Monomial]) -> Monomial:
    powers: dict[str, int] = {}
    for monomial in monomials:
        for key, power in monomial:
            powers[key] = powers.get(key, 0) + power
    return tuple(sorted((key, power) for key, power in powers.items() if power))


def _root(x: Fraction) -> Fraction | None:
    """Return the root of a square of a fraction; otherwise None."""
    root = Fraction(float(x) ** 0.5).limit_denominator(10**9)
    return root if root * root == x else None


def _as_numbers(x: Fraction) -> tuple[float, float]:
    """Split a quotient into a number and a divisor: 1/3 is 1 and 3, .25 is .25 and 1."""
    decimal = float(f"{float(x):.15g}")
    if Fraction(repr(decimal)) == x:
        return decimal, 1.0
    return float(x.numerator), float(x.denominator)
