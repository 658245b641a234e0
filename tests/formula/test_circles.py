from __future__ import annotations

from xlmc.address import Cell
from xlmc.formula.graph import circular


def cells(letters):
    return [Cell("S", 1, ord(letter) - 64) for letter in letters]


def graph(**needs):
    return {cell: tuple(cells(found)) for cell, found in zip(cells(needs), needs.values(), strict=True)}


def test_who_needs_itself_is_told_a_circle_it_is_in_with_the_others():
    found = circular(graph(A="B", B="CD", C="A", D="", E="E", F="A"))
    assert list(found) == cells("ABCE")
    assert "S!A1 → S!B1 → S!C1 → S!A1" in found[cells("B")[0]].message
    assert "S!E1 → S!E1" in found[cells("E")[0]].message


def test_two_circles_apart_are_told_apart():
    found = circular(graph(A="B", B="A", C="D", D="CA"))
    assert found[cells("A")[0]] is found[cells("B")[0]]
    assert found[cells("C")[0]] is found[cells("D")[0]] is not found[cells("A")[0]]


def test_the_circle_may_begin_after_the_first_cell_of_its_group():
    found = circular(graph(A="B", B="C", C="BA"))
    assert list(found) == cells("ABC")
    assert "circle: S!B1 → S!C1 → S!B1" in found[cells("A")[0]].message


def test_without_circles_there_is_nothing():
    assert circular(graph(A="B", B="C", C="")) == {}
