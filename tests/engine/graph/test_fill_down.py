"""Filled-down formulas get the same nodes by pattern as they get when each is lowered for itself."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.engine.graph.fill_down import FillDownCache
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Range, Select, uses

FORMULAS = [
    "A{r}+B{r}*2",
    "A{r}*A{r}+B$1",
    "SUM(A{r}:B{r})/C$2",
    'IF(A{r}>B{r},A{r}-B{r},"low")',
    "IF(C{r}>0,SQRT(A{r}),C{r})",
    "IFERROR(A{r}/C{r},B{r})",
    "MAX(A{r}:C{r},A$1:B$2)",
    "E{up}+A{r}",
    "E{up}",
    "-B{r}%",
    "B{r}^2+0",
    "B{r}+0",
    "CHOOSE(C{r},A{r},B{r},1/0)",
    "A{r}&B{r}",
    "C{r}*2",
    "AND(A{r}>0,C{r})",
    "ROUND(A{r},C{r})*B{r}",
    "ROW(A{r})*A{r}",
    "SUMPRODUCT(A$1:A{r},B$1:B{r})",
    "INDEX(A$1:A$4,2)+D{r}",
    'IF(D{r}="",0,D{r}+A{r})',
]
CONTENTS = [1.0, 2.0, 0.0, -3.5, True, "x", "", None]


def a_book(draw):
    """Four rows: A and B vary or not, C and D hold anything, E to G hold formulas filled down."""
    cells, inputs = {}, []
    for row in range(1, 5):
        for column in "AB":
            if draw(st.booleans()):
                inputs.append(f"{column}{row}")
            cells[f"{column}{row}"] = draw(st.sampled_from([0.5, 2.0]))
        for column in "CD":
            content = draw(st.sampled_from(CONTENTS))
            if content is not None:
                cells[f"{column}{row}"] = content
    for column in "EFG":
        formula = draw(st.sampled_from(FORMULAS))
        for row in range(1, 5):
            up = f"E{row - 1}" if row > 1 else "A1"
            cells[f"{column}{row}"] = "=" + formula.replace("E{up}", up if column != "E" or row > 1 else "A1").format(
                r=row, up=row - 1
            )
    return cells, inputs or ["A1"]


def canonical(lowering):
    """cell -> a number that two cells share only if all that they are computed by is the same."""
    known, numbers = {}, []
    for node_id, node in enumerate(lowering.dag.nodes):
        match node:
            case Constant(value):
                key = ("constant", value.shape, tuple(map(repr, value.objects().ravel())))
            case Input(name):
                key = ("input", name)
            case Apply(function):
                key = ("apply", function.name, *(numbers[used] for used in uses(node)))
            case IfErrorNode(_, _, only_na):
                key = ("rescue", only_na, *(numbers[used] for used in uses(node)))
            case Select() | Range():
                key = (type(node).__name__, *(numbers[used] for used in uses(node)))
        numbers.append(known.setdefault((key, lowering.dag.types[node_id], lowering.dag.sizes[node_id]), key))
    return {cell: numbers[lowering.cell(cell)] for cell in lowering.graph.formulas}


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_a_pattern_gives_what_lowering_gives(lower, data):
    cells, inputs = a_book(data.draw)
    targets = [f"{column}{row}" for column in "EFG" for row in range(1, 5)]
    by_pattern, _ = lower(cells, inputs, targets)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FillDownCache, "lower", lambda self, stencil, leaves, lower: lower())
        one_by_one, _ = lower(cells, inputs, targets)
    assert canonical(by_pattern) == canonical(one_by_one)
    assert by_pattern.notices == one_by_one.notices


@pytest.fixture
def lowered_cells(lower, monkeypatch):
    """`lowered_cells(cells, targets)`: how many formulas are lowered the long way."""
    from xlmc.engine.graph.lowering import Lowering

    count = []
    original = Lowering.lower_cell
    monkeypatch.setattr(Lowering, "lower_cell", lambda *args: count.append(1) or original(*args))

    def make(cells, inputs, targets):
        count.clear()
        lower(cells, inputs, targets)
        return len(count)

    return make


@pytest.mark.parametrize(
    "formula", ["A{r}+B{r}", "IF(A{r}>1,B{r},0)", "SUM(A{r}:B{r})", "SIN(A{r})*$B$1+IFERROR(B{r},2)"]
)
def test_the_long_way_is_gone_once_or_twice_a_shape(lowered_cells, formula):
    rows = range(1, 101)
    cells = {f"C{row}": "=" + formula.format(r=row) for row in rows}
    inputs = [f"{column}{row}" for row in rows for column in "AB"]
    assert lowered_cells(cells, inputs, [f"C{row}" for row in rows]) <= 2 + (formula.count("$B$1") > 0)


def test_where_two_cells_are_one_node_nothing_is_learned(lower):
    """Row 1 adds a cell to itself under another name; that is no pattern for row 2, whose cells differ."""
    cells = {"B1": "=A1", "B2": "=A2*3", "C1": "=A1*B1", "C2": "=A2*B2"}
    lowering, (c1, c2) = lower(cells, ["A1", "A2"], ["C1", "C2"])
    first, second = (lowering.dag.nodes[lowering.target(target)] for target in (c1, c2))
    assert first.arguments[0] == first.arguments[1]
    assert second.arguments[0] != second.arguments[1]
