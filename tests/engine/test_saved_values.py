"""Which saved values are those of their formulas."""

from __future__ import annotations

from dataclasses import replace

import pytest

from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.saved_values import (
    TOLERANCE,
    faults_of,
    filled_cells,
    is_saved_value,
    relative_difference,
    same_value,
)
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.iteration import Iteration
from xlmc.excel.workbook.workbook import CellContent, Formula


@pytest.mark.parametrize(
    ("saved", "got", "same"),
    [
        (1.0, 1.0, True),
        (1, 1.0, True),
        (1.0, 1.0 + 0.9e-9, True),
        (1.0, 1.0 + 1.2e-9, False),
        (1e9, 1e9 + 0.9, True),
        (1e9, 1e9 - 1.2, False),
        (-2.0, 2.0, False),
        (0.0, 0.0, True),
        (0.0, 1e-300, False),  # nothing but 0 is 0
        (5e-324, 0.0, False),
        ("a", "a", True),
        ("a", "A", False),
        ("", None, True),
        ("a", None, False),
        (None, None, True),
        (None, 0.0, False),
        (True, True, True),
        (True, 1.0, False),
        (1.0, True, False),
        ("1", 1.0, False),
        (ErrorCode.NA, ErrorCode.NA, True),
        (ErrorCode.NA, ErrorCode.DIV0, False),
        (7.0, ErrorCode.NA, False),
    ],
)
def test_values_match(saved, got, same):
    assert TOLERANCE == 1e-9
    assert same_value(saved, got) is same


@pytest.mark.parametrize(
    ("saved", "got", "difference"),
    [
        (2.0, 1.0, 0.5),
        (1.0, 2.0, 0.5),
        (-1.0, 1.0, 2.0),
        (0.0, 3.0, 1.0),
        (0.0, 0.0, 0.0),
        (True, 1.0, None),
        ("a", 1, None),
    ],
)
def test_the_difference_is_relative_to_the_larger(saved, got, difference):
    assert relative_difference(saved, got) == difference


def lowered(book, *cells, audit=True):
    graph = build_graph(Resolver(book), [parse_address(cell, "S") for cell in cells], frozenset(), strict=False)
    return Lowering(graph, {}, {}, audit=audit)


@pytest.mark.parametrize(
    ("formula", "saved", "got", "same"),
    [
        ("=SIN(A1)", 0.5, 0.5 + 0.9 * 1e6 * 2.0**-65, True),  # 32-bit Excel's angle is off by 2⁻⁶⁵ of itself
        ("=SIN(A1)", 1e-7, 1e-7 + 0.9 * 1e6 * 2.0**-65, True),
        ("=SIN(A1)", 1e-7, 1e-7 + 1.2 * 1e6 * 2.0**-65, False),
        ("=COS(A1)", 1e-7, 1e-7 - 0.9 * 1e6 * 2.0**-65, True),
        ("=TAN(A1)", 1e-7, 1e-7 + 0.9 * 1e6 * 2.0**-65, True),
        ("=SQRT(A1)", 1e-7, 1e-7 + 0.9 * 1e6 * 2.0**-65, False),
        ("=SIN(A1)", "x", 0.5, False),
    ],
)
def test_sines_of_32_bit_excel(workbook, formula, saved, got, same):
    lowering = lowered(workbook({"A1": 1e6, "B1": (formula, 0.5)}), "B1")
    assert is_saved_value(lowering, Cell("S", 1, 2), saved, got) is same


@pytest.mark.parametrize(
    ("libreoffice", "saved", "got", "same"),
    [
        (True, 1.0, True, True),
        (True, 0.0, False, True),
        (True, 1.0, False, False),
        (False, 1.0, True, False),
        (True, True, 1.0, False),
    ],
)
def test_logicals_of_libreoffice(workbook, libreoffice, saved, got, same):
    book = replace(workbook({"A1": 1.0, "B1": ("=A1>0", True)}), libreoffice=libreoffice)
    assert is_saved_value(lowered(book, "B1"), Cell("S", 1, 2), saved, got) is same


@pytest.mark.parametrize(
    ("got", "same"), [(2.0, True), (2.24, True), (1.76, True), (2.26, False), (2.25, False), ("x", False)]
)
def test_cells_that_excel_iterated_until_they_hardly_changed(workbook, got, same):
    book = workbook({"A1": ("=A1/2+1", 2.0), "B1": ("=1+1", 2.0)}, iteration=Iteration(count=100, change=0.25))
    lowering = lowered(book, "A1", "B1")
    assert is_saved_value(lowering, Cell("S", 1, 1), 2.0, got) is same
    if got != 2.0:
        assert not is_saved_value(lowering, Cell("S", 1, 2), 2.0, got)  # in no circle


def test_formulas_without_a_value_of_their_own(workbook):
    book = workbook({"A1": 1.0, "B1": ("=A1+1", 2.0), "B2": ("=NOSUCH(A1)", 3.0), "B3": ("=B2+1", 4.0)})
    result = faults_of(lowered(book, "B1", "B2", "B3"), "why not")
    assert list(map(str, result)) == ["S!B2"]
    assert "NOSUCH" in result[Cell("S", 2, 2)]


def array_of_two(workbook, formula, area):
    place = parse_address(area, "S")
    spilled = CellContent(1.0, Formula(formula, 1, 2, array=place, dynamic=True))
    return workbook({"A1": 1.0, "A2": 2.0, "A3": 3.0, "B1": spilled, "B2": CellContent(2.0)})


@pytest.mark.parametrize(
    ("formula", "area", "moved"),
    [
        ("A1:A2*1", "B1:B2", False),
        ("A1:A3*1", "B1:B2", True),
        ("A1*1", "B1:B2", True),
        ("TRANSPOSE(A1:A2)", "B1:B2", True),
    ],
)
def test_a_formula_that_spills_elsewhere_now(workbook, formula, area, moved):
    result = faults_of(lowered(array_of_two(workbook, formula, area), "B1"), "why not")
    assert list(result.values()) == (["the formula spills into another area than when the file was saved"] * moved)


def test_cells_that_an_array_formula_fills(workbook):
    lowering = lowered(array_of_two(workbook, "A1:A2*10", "B1:B2"), "B1")
    assert list(filled_cells(lowering, Cell("S", 1, 2))) == [(Cell("S", 2, 2), 20.0)]
    assert list(filled_cells(lowered(workbook({"A1": 1.0, "B1": ("=A1", 1.0)}), "B1"), Cell("S", 1, 2))) == []
