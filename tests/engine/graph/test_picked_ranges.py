"""Which cells of a range are read by functions that pick: the others need not be there."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Range
from xlmc.engine.graph.picked_ranges import PICKING, range_as_read
from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, parse_address
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import constant, from_objects


class Book:
    """Cells of which some are in a circle: `read` are those that are asked for first."""

    def __init__(self, waiting, constants=()):
        self.dag, self.waiting, self.read = Dag(), {parse_address(cell, "S") for cell in waiting}, None
        self.constants = {parse_address(cell, "S"): value for cell, value in dict(constants).items()}

    def not_there(self, area):
        return {cell for cell in area.cells() if cell in self.waiting}

    def read_first(self, cells):
        self.read = list(cells)

    def cell(self, cell):
        known = self.constants.get(cell)
        return self.dag.input(str(cell)) if known is None else self.dag.constant(constant(known))

    def range(self, area):
        nodes = [self.cell(cell) for cell in area.cells()]
        starts = range(0, len(nodes), area.columns)
        return self.dag.add(Range(tuple(tuple(nodes[start : start + area.columns]) for start in starts)))

    def array(self, rows):
        box = np.empty((1, len(rows), len(rows[0])), object)
        box[0] = rows
        return self.dag.constant(from_objects(box))


KEYS = [[12.0], [14.0], [14.0], [16.0]]
COLUMN = Area("S", 1, 2, 4, 2)


def unread(book, name, area, given):
    """The cells that are left empty; None where it is not known which are read."""
    nodes = {
        position: [book.array(value) if isinstance(value, list) else book.dag.constant(constant(value))]
        if not isinstance(value, str) or not value.startswith("=")
        else [book.dag.input(value)]
        for position, value in given.items()
    }
    node = range_as_read(book, REGISTRY[name], PICKING[name], area, nodes)
    if node is None:
        return None
    rows = book.dag.nodes[node].rows
    assert (len(rows), len(rows[0])) == (area.rows, area.columns)
    cells = zip(area.cells(), (cell for row in rows for cell in row), strict=True)
    empty = book.dag.constant(constant(None))
    left = [cell.a1 for cell, made in cells if made == empty]
    assert [cell.a1 for cell in book.read] == [cell.a1 for cell in area.cells() if cell.a1 not in left]
    return left


@pytest.mark.parametrize(
    ("name", "given", "waiting", "expected"),
    [
        ("SUMIFS", {1: KEYS, 2: 14.0}, ["B4"], ["B4"]),
        ("SUMIFS", {1: KEYS, 2: 14.0}, ["B1", "B2", "B4"], ["B1", "B4"]),
        ("SUMIFS", {1: KEYS, 2: 14.0}, ["B2", "B3"], []),
        ("SUMIFS", {1: KEYS, 2: 99.0}, ["B1", "B2", "B4"], ["B1", "B2", "B4"]),
        ("SUMIFS", {1: KEYS, 2: 14.0}, [], None),
        ("SUMIFS", {1: KEYS, 2: "=A9"}, ["B4"], None),
        ("AVERAGEIFS", {1: KEYS, 2: 12.0}, ["B2", "B3"], ["B2", "B3"]),
        ("MAXIFS", {1: KEYS, 2: 16.0}, ["B3", "B4"], ["B3"]),
        ("SUMIF", {0: KEYS, 1: 16.0}, ["B1", "B4"], ["B1"]),
        ("LOOKUP", {0: 13.0, 1: KEYS}, ["B1", "B4"], ["B4"]),
        ("XLOOKUP", {0: 14.0, 1: KEYS}, ["B2", "B3"], ["B3"]),
        ("XLOOKUP", {0: 16.0, 1: KEYS}, ["B1", "B2", "B3"], ["B1", "B2", "B3"]),
    ],
)  # fmt: skip
def test_cells_beside_those_that_decide(name, given, waiting, expected):
    assert unread(Book(waiting), name, COLUMN, given) == expected


TABLE = {"A1": 12.0, "A2": 14.0, "A3": "x", "A4": 16.0}
ACROSS = {"A1": 12.0, "B1": 14.0, "C1": "x", "D1": 16.0}


@pytest.mark.parametrize(
    ("key", "exact", "waiting", "expected"),
    [
        (14.0, False, ["B1", "B2", "C2", "B4"], ["B1", "C2", "B4"]),
        ("x", False, ["B1", "B3"], ["B1"]),
        (16.0, False, ["B3", "C4"], ["B3", "C4"]),
        (14.0, False, ["A4", "B1"], None),
        (99.0, False, ["B1", "B4"], ["B1", "B4"]),
    ],
)
def test_tables_that_are_searched(key, exact, waiting, expected):
    """Of a table of four rows and three columns its second column is read in one row, and its first one everywhere."""
    book = Book(waiting, TABLE)
    assert unread(book, "VLOOKUP", Area("S", 1, 1, 4, 3), {0: key, 2: 2.0, 3: exact}) == expected
    turned = {f"{'ABCD'[int(cell[1]) - 1]}{'ABC'.index(cell[0]) + 1}": cell for cell in waiting}
    book = Book(turned, ACROSS)
    result = unread(book, "HLOOKUP", Area("S", 1, 1, 3, 4), {0: key, 2: 2.0, 3: exact})
    assert (None if result is None else {turned[cell] for cell in result}) == (
        None if expected is None else set(expected)
    )


def test_a_first_column_that_varies():
    varying = Book(["B1"], {"A1": 12.0, "A2": 14.0, "A3": 15.0})
    assert unread(varying, "VLOOKUP", Area("S", 1, 1, 4, 2), {0: 14.0, 2: 2.0, 3: False}) is None


def test_errors_among_the_others_are_known_values():
    book = Book(["B1", "B4"])
    assert unread(book, "SUMIFS", COLUMN, {1: [[12.0], [ErrorCode.NA], [14.0], [14.0]], 2: 14.0}) == ["B1"]
