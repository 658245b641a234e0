"""Formulas as polynomials: read, multiplied, split, and written again as formulas of the same value."""

from __future__ import annotations

from fractions import Fraction

import pytest

from xlmc.analysis.studies.stability.polynomials import Polynomials
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.formula.substitute import substitute

F = Fraction
A = "A1"


def read(formula):
    """The tree of a formula, its cells on one sheet."""

    def cell(part):
        return Cell("S", part.first.row, part.first.column) if isinstance(part, ir.Reference) else None

    return substitute(parse(formula), cell)


def text(tree):
    return ir.formula_text(tree, lambda cell: str(cell).removeprefix("S!"))


@pytest.fixture
def reader():
    return Polynomials(text)


def monomial(**powers):
    return tuple(sorted((f"{name.upper()}1", power) for name, power in powers.items()))


@pytest.mark.parametrize(
    ("formula", "terms"),
    [
        ("3", {monomial(): F(3)}),
        ("0", {}),
        ("0.1", {monomial(): F(1, 10)}),
        ("A1", {monomial(a=1): F(1)}),
        ("+A1", {monomial(a=1): F(1)}),
        ("-A1", {monomial(a=1): F(-1)}),
        ("A1%", {monomial(a=1): F(1, 100)}),
        ("A1+A1", {monomial(a=1): F(2)}),
        ("A1-A1", {}),
        ("A1-B1", {monomial(a=1): F(1), monomial(b=1): F(-1)}),
        ("A1*B1*A1", {monomial(a=2, b=1): F(1)}),
        ("A1/B1", {monomial(a=1, b=-1): F(1)}),
        ("A1/A1", {monomial(): F(1)}),
        ("A1/(4*B1)", {monomial(a=1, b=-1): F(1, 4)}),
        ("(A1+5)^2-25", {monomial(a=2): F(1), monomial(a=1): F(10)}),
        ("(A1-B1)^3", {monomial(a=3): F(1), monomial(a=2, b=1): F(-3), monomial(a=1, b=2): F(3), monomial(b=3): F(-1)}),
        ("(A1+1)*(A1-1)", {monomial(a=2): F(1), monomial(): F(-1)}),
        ("A1^0", {monomial(): F(1)}),
        ("A1^4", {monomial(a=4): F(1)}),
        ("A1^-1", {monomial(a=-1): F(1)}),
        ("POWER(A1,2)", {monomial(a=2): F(1)}),
    ],
)
def test_a_formula_is_read_with_exact_coefficients(reader, formula, terms):
    assert reader.of(read(formula)) == terms


@pytest.mark.parametrize(
    ("formula", "atom"),
    [("A1^0.5", "SQRT(A1)"), ("A1^(1/2)", "SQRT(A1)"), ("A1^5", "A1^5"), ("A1^B1", "A1^B1"), ("SIN(A1)", "SIN(A1)")],
)
def test_what_is_no_sum_product_or_small_power_is_one_atom(reader, formula, atom):
    assert reader.of(read(formula)) == {((text(read(atom)), 1),): 1}


def test_a_quotient_by_a_sum_has_the_sum_as_an_atom(reader):
    ((powers, coefficient),) = reader.of(read("2*A1/(A1+B1)")).items()
    assert coefficient == 2
    assert sorted(power for _, power in powers) == [-1, 1]


def test_too_many_terms_are_refused(reader):
    sums = "+".join(f"A{row}" for row in range(1, 61))
    assert len(reader.of(read(sums))) == 60
    assert len(reader.of(read(f"2*({sums})"))) == 60
    with pytest.raises(OverflowError):
        reader.of(read(f"({sums})*(A1+1)"))


@pytest.mark.parametrize(
    ("formula", "power", "of", "rest"),
    [
        ("3*A1+B1", 1, {monomial(): F(3)}, {monomial(b=1): F(1)}),
        ("A1^2*B1-7", 2, {monomial(b=1): F(1)}, {monomial(): F(-7)}),
        ("A1", 1, {monomial(): F(1)}, {}),
    ],
)
def test_a_polynomial_is_split_by_a_power_of_an_atom(reader, formula, power, of, rest):
    assert reader.split(reader.of(read(formula)), A, power) == (of, rest)


@pytest.mark.parametrize("formula", ["B1", "A1^2", "A1+A1^2", "A1/B1+1/A1"])
def test_an_atom_in_another_power_or_in_none_splits_nothing(reader, formula):
    assert reader.split(reader.of(read(formula)), A, 1) is None


@pytest.mark.parametrize(
    ("formula", "without"),
    [
        ("SQRT(A1)^2", "A1"),
        ("SQRT(A1+B1)^2-A1", "B1"),
        ("SQRT(A1)*3", "SQRT(A1)*3"),
        ("SQRT(A1)^3", "A1*SQRT(A1)"),
        ("SQRT(A1)^4+B1", "A1^2+B1"),
        ("A1^2", "A1^2"),
    ],
)
def test_squares_of_roots_are_what_the_roots_are_of(reader, formula, without):
    assert reader.without_roots(reader.of(read(formula))) == reader.of(read(without))


@pytest.mark.parametrize(
    ("formula", "root"),
    [
        ("A1^2+2*A1*B1+B1^2", "A1+B1"),
        ("A1^2-2*A1*B1+B1^2", "A1-B1"),
        ("4*A1^2+12*A1+9", "2*A1+3"),
        ("A1^2/4-A1+1", "A1/2-1"),
        ("A1^4+2*A1^2+1", "A1^2+1"),
        ("A1^2+A1*B1+B1^2", None),
        ("A1^2+B1^2", None),
        ("2*A1^2+4*A1+2", None),
        ("A1^3+B1", None),
    ],
)
def test_the_root_of_a_square_of_two_terms(reader, formula, root):
    result = reader.square_root(reader.of(read(formula)))
    if root is None:
        assert result is None
        return
    expected = reader.of(read(root))
    assert result in (expected, reader.scaled(expected, F(-1)))


@pytest.mark.parametrize(
    ("formula", "written"),
    [
        ("A1-A1", "0"),
        ("B1-A1", "B1-A1"),
        ("-A1+B1", "B1-A1"),
        ("-A1-B1", "-A1-B1"),
        ("A1/3", "A1/3"),
        ("A1*0.25", "0.25*A1"),
        ("2/3", "2/3"),
        ("1/A1", "1/A1"),
        ("A1^2/(B1*3)", "A1^2/(3*B1)"),
        ("-2*A1/B1^2", "-2*A1/B1^2"),
    ],
)
def test_a_polynomial_is_written_as_a_formula(reader, formula, written):
    tree = reader.tree(reader.of(read(formula)))
    assert text(tree) == text(read(written))
    assert reader.of(tree) == reader.of(read(formula))
