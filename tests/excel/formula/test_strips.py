"""Columns and rows that are looked through once: which cells of a range count, and which are in order."""

from __future__ import annotations

import pytest

from xlmc.excel.address import Area, Cell
from xlmc.excel.formula.strips import Needs, Stretch, Strips, _Span

LAST = 120, 100


@pytest.fixture
def strips():
    """Those of a sheet in which every third cell of a row or column counts; `looked` are the areas looked through."""
    looked = []

    def filled(area):
        looked.append(area)
        return area.cells()

    made = Strips(lambda cell: (cell.row + cell.column) % 3 == 0, filled, lambda sheet: LAST)
    made.looked = looked
    return made


def counted(area):
    return [cell for cell in area.cells() if (cell.row + cell.column) % 3 == 0]


@pytest.mark.parametrize(
    ("area", "parts", "stretches"),
    [
        (Area("S", 1, 1, 64, 1), 1, True), (Area("S", 1, 1, 63, 1), 1, False), (Area("S", 5, 2, 100, 9), 8, True),
        (Area("S", 5, 2, 100, 10), 1, False), (Area("S", 7, 3, 7, 80), 1, True), (Area("S", 7, 3, 14, 80), 8, True),
        (Area("S", 7, 3, 15, 80), 1, False), (Area("S", 2, 2, 9, 9), 8, True), (Area("S", 110, 1, 200, 1), 1, True),
        (Area("S", 2, 2, 3, 32), 1, False), (Area("S", 2, 2, 3, 33), 2, True),
    ],
)  # fmt: skip
def test_the_cells_of_a_range(strips, area, parts, stretches):
    """Ranges of 64 cells and more, of up to eight columns or rows, are stretches; others are listed."""
    result = list(strips.of(area))
    assert len(result) == parts
    assert all(isinstance(part, Stretch) == stretches for part in result)
    within = [cell for cell in counted(area) if not stretches or (cell.row <= LAST[0] and cell.column <= LAST[1])]
    assert sorted(cell for part in result for cell in part) == sorted(within)
    for cell in Area("S", 1, 1, 20, 40).cells():
        assert any(cell in part for part in result) == (cell in within)
    assert "x" not in result[0]


def test_each_is_looked_through_once(strips):
    for area in (Area("S", 1, 2, 100, 2), Area("S", 9, 2, 90, 3), Area("S", 1, 1, 4, 4), Area("S", 1, 1, 4, 4)):
        list(strips.of(area))
    columns = [Area("S", 1, 2, LAST[0], 2), Area("S", 1, 3, LAST[0], 3)]
    assert strips.looked == [*columns, Area("S", 1, 1, 4, 4)]
    list(strips.of(Area("S", 3, 1, 3, 90)))
    list(strips.of(Area("S", 3, 5, 3, 99)))
    assert strips.looked[3:] == [Area("S", 3, 1, 3, LAST[1])]


@pytest.mark.parametrize(
    ("known", "asked", "outside"),
    [
        ((3, 6), (0, 10), [0, 1, 2, 6, 7, 8, 9]), ((3, 6), (4, 5), []), ((3, 6), (0, 3), [0, 1, 2]),
        ((3, 6), (6, 8), [6, 7]), ((3, 6), (0, 2), [0, 1]), ((3, 6), (8, 9), [8]),
        ((3, 6), (5, 8), [6, 7]), ((3, 6), (1, 4), [1, 2]), ((0, 0), (0, 2), [0, 1]),
    ],
)  # fmt: skip
def test_indices_that_are_not_known_to_be_in_order(known, asked, outside):
    assert [index for part in _Span(*known).outside(*asked) for index in part] == outside


@pytest.mark.parametrize(
    ("known", "added", "run"),
    [
        ((3, 6), (6, 9), (3, 9)), ((3, 6), (1, 3), (1, 6)), ((3, 6), (4, 5), (3, 6)), ((3, 6), (8, 10), (3, 6)),
        ((3, 6), (8, 11), (3, 6)), ((3, 6), (8, 12), (8, 12)), ((0, 0), (4, 7), (4, 7)), ((3, 6), (0, 9), (0, 9)),
        ((5, 7), (1, 3), (5, 7)), ((5, 7), (1, 4), (1, 4)),
    ],
)  # fmt: skip
def test_the_longest_run_that_is_known(known, added, run):
    span = _Span(*known)
    span.add(*added)
    assert (span.start, span.stop) == run


def test_what_waits(strips):
    (stretch,) = strips.of(Area("S", 1, 2, 100, 2))  # rows 1, 4, …, 100
    cells = list(stretch)
    assert list(stretch.waiting()) == cells
    stretch.strip.ordered.add(stretch.start, stretch.start + 5)
    assert list(stretch.waiting()) == cells[5:]
    (lower,) = strips.of(Area("S", 37, 2, 110, 2))
    assert lower.strip is stretch.strip
    assert lower.key != stretch.key
    assert next(iter(lower)) == Cell("S", 37, 2)
    assert stretch.key == next(iter(strips.of(Area("S", 1, 2, 100, 2)))).key


def test_needs_of_cells(strips):
    needs = Needs()
    a, b, c = (Cell("S", row, 60) for row in (1, 2, 3))
    column, table = Area("S", 1, 2, 100, 2), Area("S", 1, 1, 4, 4)
    needs.parts[a] = (*strips.of(column), *strips.of(table))
    needs.parts[b] = tuple(strips.of(column))
    needs.parts[c] = (*strips.of(table), *strips.of(Area("S", 1, 2, 99, 2)))
    assert len(needs) == 3
    assert list(needs) == [a, b, c]
    assert needs[b] == tuple(counted(column))
    assert list(needs.of(a)) == [*counted(column), *counted(table)]
    assert needs.names(b, Cell("S", 4, 2))
    assert not needs.names(b, Cell("S", 4, 5))
    parts, links = needs.linked()
    assert len(parts) == 3
    assert links == {a: [0, 1], b: [0], c: [1, 2]}


def test_what_varies(strips):
    """Rows 1, 4, …, 100 of column 2 count; row 37 varies, and which part is constant is looked at once."""
    looked = []

    class Varying(set):
        def __contains__(self, cell):
            looked.append(cell.row)
            return super().__contains__(cell)

    varying = Varying({Cell("S", 37, 2)})
    whole, upper, lower = (
        next(strips.of(Area("S", *rows))) for rows in ((1, 2, 100, 2), (1, 2, 70, 2), (40, 2, 120, 2))
    )
    assert whole.varies(varying)
    assert looked == list(range(1, 38, 3))
    looked.clear()
    assert upper.varies(varying)
    assert looked == [37]
    looked.clear()
    assert not lower.varies(varying)
    assert looked == list(range(40, 121, 3))
    looked.clear()
    assert not lower.varies(varying)
    assert looked == []
    lower.note_ordered()
    assert list(lower.waiting()) == []
    assert [cell.row for cell in whole.waiting()] == list(range(1, 40, 3))
