from __future__ import annotations

import pytest

from xlmc.engine.graph.lowering import Lowering
from xlmc.engine.graph.nodes import Apply, Constant, Input, Range
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, parse_address


@pytest.fixture
def nodes(lower):
    """The varying nodes behind one formula, in order."""

    def make(formula, cells=None, **of_workbook):
        lowering, (target,) = lower({**(cells or {}), "Z9": f"={formula}"}, ["A1", "A2"], ["Z9"], **of_workbook)
        return [lowering.dag.nodes[node] for node in lowering.dag.upstream([lowering.target(target)])]

    return make


def names(result):
    return [node.function.name if isinstance(node, Apply) else type(node).__name__ for node in result]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("A1+A2", ["Input", "Input", "+", "snap to zero"]),
        ("(A1+A2)", ["Input", "Input", "+"]),
        ("(A1+A2)*(A1+A2)", ["Input", "Input", "+", "*"]),  # a common part is computed once
        ("A1+2*3", ["Input", "+", "snap to zero"]),
        ("0+A1", ["Input"]),  # and what is known before the run
        ("SQRT(2)*A1", ["Input", "*"]),
        ("A1^2", ["Input", "*"]),
        ("+A1", ["Input"]),
        ("--A1", ["Input", "u-", "u-"]),
        ("RADIANS(A1)", ["Input", "*"]),
        ("A1/2", ["Input", "*"]),  # by a power of two the same to the last bit, and quicker
        ("A1/-0.25", ["Input", "*"]),
        ("A1/3", ["Input", "/"]),
        ("A1/0", ["Input", "/"]),
        ("2/A1", ["Input", "/"]),
        ("IF(TRUE,A1,A2)", ["Input"]),  # the branch that is not taken is not looked at
        ("IF(B1=1,A1,1/A2)", ["Input"]),
        ("IF(B1=2,A1,NOSUCH(A2))", []),
        ("IFERROR(A1+1,A2)", ["Input", "Input", "+", "IfErrorNode"]),
        ("SUM(A1:A2)", ["Input", "Input", "Range", "SUM"]),
        ("SUM((A1,A2))", ["Input", "Input", "Range", "Range", "SUM"]),
        ("POWER(A1,A2)", ["Input", "Input", "^"]),
        ("A1:A1+1", ["Input", "+", "snap to zero"]),
    ],
)
def test_the_nodes_of_a_formula(nodes, formula, expected):
    if "NOSUCH" in formula:
        with pytest.raises(FormulaError, match="NOSUCH"):
            nodes(formula, {"B1": 1.0})
    else:
        assert names(nodes(formula, {"B1": 1.0})) == expected


def test_cells_that_are_used_twice_are_computed_once(lower):
    cells = {"B1": "=SQRT(A1)", "C1": "=B1*2", "C2": "=SQRT(A1)+1", "C3": "=B1*2"}
    lowering, targets = lower(cells, ["A1"], ["C1", "C2", "C3"])
    nodes = [lowering.target(target) for target in targets]
    assert nodes[0] == nodes[2]
    assert sum(isinstance(node, Apply) and node.function.name == "SQRT" for node in lowering.dag.nodes) == 1


def test_a_held_cell_is_its_value(lower):
    lowering, (target,) = lower({"A1": 5.0, "B1": "=A1*2"}, [], ["B1"], held={"A1": 7.0})
    assert lowering.known(target).objects().tolist() == [14.0]


@pytest.mark.parametrize(
    ("formula", "known"), [("1+1", [2.0]), ("B1&1", ["x1"]), ("1/0", [ErrorCode.DIV0]), ("A1", None)]
)
def test_what_is_known_before_the_run(lower, formula, known):
    lowering, (target,) = lower({"B1": "x", "C1": f"={formula}"}, ["A1"], ["C1"])
    result = lowering.known(target)
    assert (None if result is None else result.objects().tolist()) == known


def test_a_formula_that_gives_nothing_gives_zero(lower):
    lowering, (one, other) = lower({"B1": "=C9", "B2": "=C9&C9"}, ["A1"], ["B1", "B2"])
    assert lowering.known(one).objects().tolist() == [0.0]
    assert lowering.known(other).objects().tolist() == [""]


REFUSED = [
    ("SQTR(A1)", "the function SQTR is not known to xlmc", "did you mean SQRT?"),
    (
        "MyOwn.Macro(A1)",
        "the function MYOWN.MACRO is not known to xlmc",
        "check its spelling; write code of a workbook or of an add-in in Python: --functions my_functions.py",
    ),
    ("SQRT(A1,2)", "SQRT has 2 arguments; it takes 1", None),
    ("SQRT()", "SQRT has 0 arguments; it takes 1", None),
    ("ROUND(A1)", "ROUND has 1 argument; it takes 2", None),
    ("LOG(A1,2,3)", "LOG has 3 arguments; it takes 1 to 2", None),
    ("SUM()", "SUM has 0 arguments; it takes 1 or more", None),
    ("IF(A1)", "IF has 1 argument; it takes 2 to 3", None),
    ("(A1,A2)+1", "one value is needed here, and several areas joined by commas are given", None),
]


@pytest.mark.parametrize(("formula", "message", "hint"), REFUSED)
def test_what_cannot_be_computed(lower, formula, message, hint):
    with pytest.raises(FormulaError) as caught:
        lower({"B1": f"={formula}", "C1": "=B1+1"}, ["A1"], ["C1"])
    error = caught.value
    assert (error.where, error.message, error.hint, error.text) == ("S!B1", message, hint, formula)


def test_where_no_assumption_reaches_the_saved_value_stands_in(lower):
    cells = {"B1": 2.0, "B2": ("=MYFUNC(B1)", 42.0), "C1": "=B2+A1", "C2": "=B2*2"}
    lowering, (varying, known) = lower(cells, ["A1"], ["C1", "C2"])
    assert lowering.known(known).objects().tolist() == [84.0]
    assert lowering.known(varying) is None
    (notice,) = lowering.notices
    assert str(notice.where) == "S!B2"
    assert "The function MYFUNC is not known to xlmc" in notice.message
    assert "Excel's saved value is used" in notice.message
    assert lowering.saved == {parse_address("S!B2"): 42.0}


def test_without_a_saved_value_it_is_refused(lower):
    with pytest.raises(FormulaError, match="MYFUNC"):
        lower({"B1": "=MYFUNC(2)"}, ["A1"], ["B1"])


def test_where_an_assumption_reaches_the_saved_value_is_not_used(lower):
    with pytest.raises(FormulaError, match="MYFUNC"):
        lower({"B1": ("=MYFUNC(A1)", 42.0)}, ["A1"], ["B1"])


def test_a_cell_beside_the_formula_is_taken_of_a_range(lower):
    cells = {"B1": 10.0, "B2": 20.0, "C1": "=B1:B3*2", "C2": "=B1:B3*2", "C9": "=B1:B3*2", "D2": "=@B1:B3"}
    lowering, targets = lower(cells, ["A1"], ["C1", "C2", "C9", "D2"])
    assert [lowering.known(target).objects().tolist() for target in targets] == [
        [20.0],
        [40.0],
        [ErrorCode.VALUE],
        [20.0],
    ]


def test_what_a_wide_range_leaves_out(lower):
    lowering, (target,) = lower({"B1": 1.0, "C1": "=SUM(A1:B2,E:E)"}, ["A1"], ["C1"])
    dag = lowering.dag
    cells = [dag.nodes[p] for node in dag.nodes if isinstance(node, Range) for row in node.rows for p in row]
    assert sum(isinstance(node, Input) for node in cells) == 1
    assert all(isinstance(node, Input | Constant) for node in cells)
    assert lowering.known(target) is None


def at(address):
    return parse_address(address, "S")


LED = "SUM(OFFSET(B1,0,0,30,1))"
"""OFFSET leads to B1:B30, of which B7 is computed from a draw."""


def test_an_area_that_awaits_none_is_looked_through_once(lower, monkeypatch):
    """And each formula that is led there is known to need the cells in it: draws come in that order."""
    looked = []
    true_awaits = Lowering.awaits
    monkeypatch.setattr(Lowering, "awaits", lambda self, cell: looked.append(cell) or true_awaits(self, cell))
    cells = {f"B{row}": float(row) for row in range(1, 31)} | {"B7": "=A1*2"}
    wanted = [f"D{row}" for row in range(1, 21)]
    formulas = {address: f"={LED}+{number}" for number, address in enumerate(wanted)}
    lowering, _ = lower(cells | formulas, ["A1"], wanted)
    led = Area("S", 1, 2, 30, 2)
    assert lowering.awaited(led) == ()
    assert {address: lowering.led_to[at(address)] for address in wanted} == {address: {at("B7")} for address in wanted}
    assert looked.count(at("B1")) == 20 + 1  # at first all await B7; once the graph holds it, one looks for all


def test_an_area_is_looked_through_until_all_in_it_is_lowered(lower):
    """B7 is lowered after what is led to it, so the first formula waits, and the graph is made again."""
    lowering, _ = lower({"B7": "=A1*2", "D1": f"={LED}"}, ["A1"], ["D1"])
    fresh = type(lowering)(lowering.graph, {at("A1"): "A1"}, {})
    assert fresh.awaited(Area("S", 1, 2, 30, 2)) == ()
    assert fresh.awaited(Area("S", 1, 2, 30, 2)) == ()
    other, _ = lower({"B7": "=A1*2", "D1": "=A1+1"}, ["A1"], ["D1"])  # D1 does not lead to B7: it is not lowered
    assert list(other.awaited(Area("S", 1, 2, 30, 2))) == [at("B7")]
    assert list(other.awaited(Area("S", 1, 2, 30, 2))) == [at("B7")]  # and asked for again
