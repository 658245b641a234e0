"""Nodes of arrays: which cell of which, where sizes do not fit, and what is folded or taken apart."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.graph import arrays
from xlmc.engine.graph.arrays import (
    as_range,
    beside,
    cell_by_cell,
    either,
    either_reference,
    element,
    grid,
    pick,
    share_out,
    size_of,
    sizes_differ,
    spread,
)
from xlmc.engine.graph.graph import MANY, Dag
from xlmc.engine.graph.nodes import Apply, Constant, Input, Range, Select
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.values import ShapeVaries, constant, from_objects
from xlmc.excel.workbook.workbook import CellContent, Formula

NA, VALUE = ErrorCode.NA, ErrorCode.VALUE


def value(rows):
    box = np.empty((1, len(rows), len(rows[0])), object)
    box[0] = rows
    return from_objects(box)


@pytest.fixture
def dag():
    return Dag()


def items(dag, node):
    """What a constant node holds: rows of cells, or one item."""
    held = dag.nodes[node].value.objects()[0]
    return held.tolist() if isinstance(held, np.ndarray) else held


def cells(dag, node):
    """The items of an array of constant nodes."""
    made = dag.nodes[node]
    if isinstance(made, Constant):
        return items(dag, node)
    return [[items(dag, each) for each in row] for row in made.rows]


GRID, ROW, COLUMN = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], [[1.0, 2.0, 3.0]], [[1.0], [4.0]]


@pytest.mark.parametrize(
    ("rows", "row", "column", "expected"),
    [
        (GRID, 0, 0, 1.0), (GRID, 1, 2, 6.0), (GRID, 2, 0, NA), (GRID, 0, 3, NA), (GRID, 1, 0, 4.0),
        (ROW, 0, 2, 3.0), (ROW, 5, 1, 2.0), (ROW, 0, 3, NA), (COLUMN, 1, 0, 4.0), (COLUMN, 1, 9, 4.0),
        (COLUMN, 2, 0, NA), ([[7.0]], 3, 4, 7.0),
    ],
)  # fmt: skip
def test_one_cell(dag, rows, row, column, expected):
    """Of a constant, of a range of nodes, and of a value whose size is known only in a run."""
    node = dag.constant(value(rows))
    assert items(dag, element(dag, node, row, column)) == expected
    range_ = dag.add(Range(tuple(tuple(dag.constant(constant(cell)) for cell in line) for line in rows)))
    assert items(dag, element(dag, range_, row, column)) == expected
    assert pick(value(rows), row, column).objects().tolist() == [expected]


@pytest.mark.parametrize(("row", "column"), [(2, 0), (0, 2), (2, 2)])
def test_beyond_a_range_of_what_varies(dag, row, column):
    node = dag.add(Range(((dag.input("a"), dag.input("b")), (dag.input("c"), dag.input("d")))))
    assert items(dag, element(dag, node, row, column)) is NA
    assert dag.nodes[element(dag, node, 1, 0)].name == "c"


def test_one_cell_of_a_single_value(dag):
    node = dag.input("x")
    assert element(dag, node, 3, 4) == node
    assert pick(constant(5.0), 3, 4).objects().tolist() == [5.0]


def test_one_cell_of_what_is_computed_whole(dag):
    x = dag.input("x")
    node = element(dag, dag.add(Apply(REGISTRY["SEQUENCE"], (x,))), 1, 2)
    made = dag.nodes[node]
    assert made.function.name == "cell 1,2"
    assert made.function([value(GRID)]).objects().tolist() == [6.0]


@pytest.mark.parametrize(
    ("rows", "row", "column", "expected"),
    [
        (COLUMN, 1, 7, 4.0), (COLUMN, 0, -3, 1.0), (COLUMN, 2, 0, VALUE), (COLUMN, -1, 0, VALUE), (ROW, 9, 2, 3.0),
        (ROW, 9, 0, 1.0), (ROW, 0, 3, VALUE), (ROW, 0, -1, VALUE), (GRID, 0, 0, VALUE), ([[7.0]], 4, 4, 7.0),
    ],
)  # fmt: skip
def test_the_cell_beside_a_formula(dag, rows, row, column, expected):
    assert items(dag, beside(dag, dag.constant(value(rows)), row, column)) == expected


def test_a_single_value_is_beside_every_formula(dag):
    node = dag.input("x")
    assert beside(dag, node, 5, 6) == node


def test_sizes(dag):
    assert size_of(dag, dag.constant(value(GRID))) == (2, 3)
    assert size_of(dag, dag.constant(constant(1.0))) is None
    node = dag.add(Apply(REGISTRY["SEQUENCE"], (dag.input("x"),)))
    assert dag.sizes[node] == MANY
    with pytest.raises(FormulaError, match="known only during the run"):
        size_of(dag, node)


def test_a_grid_of_nodes(dag):
    node = grid(dag, 2, 3, lambda row, column: dag.constant(constant(10.0 * row + column)))
    assert dag.sizes[node] == (2, 3)
    assert cells(dag, node) == [[0.0, 1.0, 2.0], [10.0, 11.0, 12.0]]


def pairs(dag):
    """The sums of the cells given, each a constant."""
    return lambda picked: dag.add(Apply(REGISTRY["+"], picked))


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ([[1.0], [2.0], [3.0]], [[10.0], [20.0]], [[11.0], [22.0], [NA]]),
        ([[1.0, 2.0, 3.0]], [[10.0, 20.0]], [[11.0, 22.0, NA]]),
        ([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]], [[10.0, 20.0], [30.0, 40.0]], [[11.0, 22.0], [33.0, 44.0], [NA, NA]]),
    ],
)
def test_cells_without_a_partner(dag, left, right, expected):
    node = cell_by_cell(dag, tuple(dag.constant(value(rows)) for rows in (left, right)), pairs(dag))
    assert cells(dag, node) == expected


def test_what_is_not_taken_apart(dag, monkeypatch):
    """Single values, values of unknown size, constants that fit each other, and very many cells."""
    x, row, column = dag.input("x"), dag.constant(value(ROW)), dag.constant(value(COLUMN))
    many = dag.add(Apply(REGISTRY["SEQUENCE"], (x,)))
    assert cell_by_cell(dag, (x, x), pairs(dag)) is None
    assert cell_by_cell(dag, (many, row), pairs(dag)) is None
    assert cell_by_cell(dag, (row, column), pairs(dag)) is None
    assert cells(dag, cell_by_cell(dag, (row, column), pairs(dag), constants=True)) == [[2, 3, 4], [5, 6, 7]]
    assert dag.sizes[cell_by_cell(dag, (row, x), pairs(dag))] == (1, 3)
    monkeypatch.setattr(arrays, "LARGEST", 5)
    assert dag.sizes[cell_by_cell(dag, (row, x), pairs(dag))] == (1, 3)
    assert cell_by_cell(dag, (row, column, x), pairs(dag)) is None
    with pytest.raises(FormulaError, match="6 cells would each make an array"):
        cell_by_cell(dag, (row, column), pairs(dag), constants=True)


def test_numbers_of_index_that_are_0(dag):
    """One 0 for all gives whole rows, one among many a call for each cell; other numbers are computed at once."""
    index, table = REGISTRY["INDEX"], dag.constant(value(GRID))

    def apply(picked):
        return dag.add(Apply(index, (table, *picked)))

    def numbers(*rows):
        return dag.constant(value([list(rows)]))

    zero, half, one = (dag.constant(constant(number)) for number in (0.0, -0.5, 1.0))
    assert spread(dag, index, (zero, numbers(1.0, 2.0)), apply) is None
    assert spread(dag, index, (half, numbers(1.0, 2.0)), apply) is None
    assert spread(dag, index, (one, numbers(1.0, 2.0)), apply) is None
    assert spread(dag, index, (dag.input("x"), one), apply) is None
    apart = spread(dag, index, (one, numbers(1.0, 0.0)), apply)
    assert dag.sizes[apart] == (1, 2)
    wrong = numbers(1.0, ErrorCode.NUM)
    assert spread(dag, index, (one, wrong), apply) is None


def test_functions_whose_numbers_decide_on_a_size(dag):
    sequence, counts = REGISTRY["SEQUENCE"], dag.constant(value([[1.0, 2.0]]))
    node = spread(dag, sequence, (counts,), lambda picked: dag.add(Apply(REGISTRY["ABS"], picked)))
    assert dag.sizes[node] == (1, 2)
    assert spread(dag, REGISTRY["ABS"], (counts,), lambda picked: picked[0]) is None


def _choice(dag, yes=GRID, no=None):
    condition = dag.input("condition")
    return condition, either(
        dag, condition, dag.constant(value(yes)), dag.constant(constant(9.0) if no is None else value(no))
    )


def test_choices_between_sizes(dag):
    condition, node = _choice(dag)
    one = dag.constant(constant(9.0))
    two = dag.constant(value(GRID))
    assert sizes_differ(dag, condition, two, one)
    assert not sizes_differ(dag, condition, two, dag.constant(value(GRID[::-1])))
    assert not sizes_differ(dag, two, two, one)
    assert sizes_differ(dag, condition, node, node)
    first = dag.nodes[element(dag, node, 1, 2)]
    assert isinstance(first, Select)
    assert [items(dag, each) for each in (first.yes, first.no)] == [6.0, 9.0]


@pytest.mark.parametrize(
    ("condition", "expected"), [([1.0], 1.0), ([0.0], 9.0), ([ErrorCode.NUM], ErrorCode.NUM), (["x"], VALUE)]
)
def test_the_size_chosen(dag, condition, expected):
    _, node = _choice(dag)
    chosen = dag.nodes[node].function([from_objects(np.array(condition, object)), value(GRID), constant(9.0)])
    assert chosen.objects().ravel()[0] == expected


def test_trials_that_choose_differently_are_computed_one_by_one(dag):
    _, node = _choice(dag)
    function = dag.nodes[node].function
    for condition in ([1.0, 0.0], [1.0, ErrorCode.NUM], [0.0, ErrorCode.NUM]):
        with pytest.raises(ShapeVaries):
            function([from_objects(np.array(condition, object)), value(GRID), constant(9.0)])
    same = function([from_objects(np.array([1.0, 2.0], object)), value(GRID), constant(9.0)])
    assert same.shape == (1, 2, 3)


def test_a_function_of_a_choice_is_a_choice(dag):
    """The function of each branch, and of the condition where that is an error."""
    condition, node = _choice(dag)
    other = dag.input("y")

    def select(test, yes, no):
        return ("select", test, yes, no)

    shared = share_out(dag, (other, node), lambda parts: ("made", *parts), lambda part: ("error", part), select)
    _, yes, no = dag.nodes[node].arguments
    wrong, branch_1, branch_2 = (("made", other, part) for part in (condition, yes, no))
    assert shared == ("select", ("error", condition), wrong, ("select", condition, branch_1, branch_2))
    assert share_out(dag, (other,), lambda parts: None, lambda part: None, select) is None


def test_too_many_outcomes_are_no_choice(dag, monkeypatch):
    """A choice within a choice has five outcomes, two of them errors; two such arguments have 25."""
    _, inner = _choice(dag)
    outer = either(dag, dag.input("z"), dag.constant(value(ROW)), inner)
    other = either(dag, dag.input("z"), inner, dag.constant(value(ROW)))
    for limit, made in ((25, True), (24, False)):
        monkeypatch.setattr(arrays, "MOST_OUTCOMES", limit)
        result = share_out(dag, (outer, other), lambda parts: 1, lambda part: 1, lambda *parts: 1)
        assert (result is not None) == made


def test_ranges_of_one_cell(dag):
    x, many = dag.input("x"), dag.constant(value(GRID))
    assert dag.nodes[as_range(dag, x)] == Range(((x,),))
    assert items(dag, as_range(dag, many)) == GRID


def test_empty_cells_of_a_chosen_range_stay_empty(dag):
    condition = dag.input("condition")
    yes, no = dag.constant(value([[1.0, None]])), dag.constant(value([[3.0, 4.0]]))
    made = dag.nodes[either_reference(dag, condition, yes, no)]
    first, second = (dag.nodes[cell] for cell in made.rows[0])
    assert isinstance(first, Select)
    assert isinstance(second, Apply)
    truth = from_objects(np.array([1.0, 0.0], object))
    assert second.function([truth, constant(None), constant(4.0)]).objects().tolist() == [None, 4.0]
    single = dag.nodes[either_reference(dag, condition, dag.constant(constant(1.0)), dag.constant(constant(None)))]
    assert isinstance(single, Apply)


TABLE = {"A1": 3.0, "A2": 5.0, "B1": 4.0, "C1": "x", "D1": "=1/0"}


@pytest.mark.parametrize(
    ("formula", "nodes"),
    [
        ("A1+0", 0), ("0+A1", 0), ("A1*4/4", 2), ("A1^2", 1), ("A1^3", 1), ("IF(1,A1,7)", 0), ("IF(0,7,A1)", 0),
        ("A1*1", 1), ("A1/8", 1), ("A1/3", 1),
    ],
)  # fmt: skip
def test_what_needs_no_node(lower, formula, nodes):
    """Beside the input, and beside constants."""
    lowering, _ = lower({**TABLE, "H9": f"={formula}"}, ["A1"], ["H9"])
    made = [node for node in lowering.dag.nodes if not isinstance(node, Constant | Input)]
    assert len(made) == nodes


@pytest.mark.parametrize(
    ("formula", "name"), [("A1/8", "*"), ("A1/-0.25", "*"), ("A1/3", "/"), ("A1/2^70", "/"), ("A1/2^-70", "/"),
                          ("A1/0", "/"), ("A1/TRUE", "/"), ("A1^2", "*"), ("A1^3", "^"), ("RADIANS(A1)", "*"),
                          ("A1/2^59", "*"), ("A1/2^60", "/"), ("A1/2^-60", "/"), ("A1/2^-59", "*"), ("A1/1", "*")],
)  # fmt: skip
def test_quotients_by_powers_of_two_are_products(lower, formula, name):
    lowering, _ = lower({**TABLE, "H9": f"={formula}"}, ["A1"], ["H9"])
    (node,) = [node for node in lowering.dag.nodes if isinstance(node, Apply)]
    assert node.function.name == name


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("A1/8", [0.375, 0.625]), ("A1/-0.25", [-12.0, -20.0]), ("A1^2", [9.0, 25.0]), ("A1+0", [3.0, 5.0]),
        ("0+A1", [3.0, 5.0]), ("Z99", [0.0, 0.0]),
        ("SUM(IF(A1>4,A1:B1,C1)*2)", [0.0, 18.0]), ("SUM(A1:A2*B1)", [32.0, 40.0]),
        ("SUM(IF(A1>4,B1:B2,7))", [7.0, 4.0]), ("COUNT(A1:A2/{1,0})", [2.0, 2.0]),
    ],
)  # fmt: skip
def test_what_is_computed_in_another_way_is_the_same(run, formula, expected):
    cells_ = TABLE | {"C1": 0.0, "H9": CellContent(None, Formula(formula, 9, 8, dynamic=True))}
    assert run(cells_, {"A1": [3.0, 5.0]}, ["H9"]).forecasts == [expected]
