from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.engine.graph.nodes import uses
from xlmc.engine.graph.running_totals import RunningTotals
from xlmc.excel.address import Cell, column_letters
from xlmc.excel.formula import Resolver, build_graph


def totals(rows, contents=None):
    """A column to add up, and its running totals beside it."""
    cells = {f"B{row}": f"=A1*{row}" for row in range(1, rows + 1)} | (contents or {})
    return cells | {f"C{row}": f"=SUM(B$1:B{row})" for row in range(1, rows + 1)}


def test_a_row_more_is_one_node_more(lower):
    def nodes(rows):
        return len(lower(totals(rows), ["A1"], [f"C{row}" for row in range(1, rows + 1)])[0].dag.nodes)

    assert nodes(60) - nodes(50) == nodes(50) - nodes(40)


@pytest.mark.parametrize("contents", [{}, {"B3": "x", "B20": True, "B30": None}, {"B25": "=1/A1", "B28": "=LN(A1)"}])
def test_the_sums_are_those_of_whole_ranges(run, contents, monkeypatch):
    draws = {"A1": [*np.random.default_rng(1).uniform(0.1, 2.0, 20).tolist(), 0.0, -1.0]}
    cells = totals(40, {cell: content for cell, content in contents.items() if content is not None})
    for cell in (cell for cell, content in contents.items() if content is None):
        del cells[cell]
    forecasts = ["C15", "C16", "C17", "C25", "C29", "C40"]
    running = run(cells, draws, forecasts)
    monkeypatch.setattr(RunningTotals, "_column", lambda *_: None)
    assert run(cells, draws, forecasts).forecasts == running.forecasts


def test_the_largest_of_no_numbers_is_not_part_of_a_larger_range(run):
    cells = {f"B{row}": "x" for row in range(1, 21)} | {"B21": "=A1-9", "C20": "=MAX(B$1:B20)", "C21": "=MAX(B$1:B21)"}
    assert run(cells, {"A1": [1.0]}, ["C20", "C21"]).forecasts == [[0.0], [-8.0]]


FOLDS = ["AVERAGE", "COUNT", "COUNTA", "MAX", "MIN", "PRODUCT", "MEDIAN", "STDEV.S", "SUMSQ", "GEOMEAN", "AND", "OR"]
CONTENTS = {"B1": "Heading", "B3": True, "B20": "x", "B22": "=1/(A1-2)", "B25": "=A1&1"}


FILLED = ["B$1:B{r}", "B{r}:B$40", "$A$1:B{r}", "OFFSET(B$1,0,0,{r},1)"]


@pytest.mark.parametrize(("name", "range_"), [(name, FILLED[at % 4]) for at, name in enumerate(FOLDS)])
def test_filled_down_each_function_gives_what_it_gives_alone(run, name, range_):
    column = {f"B{row}": f"=A$1*{row}/7" for row in range(1, 41) if row != 30} | CONTENTS
    formulas = {f"C{r}": f"={name}({range_.format(r=r)})" for r in range(15, 31)}
    draws = {"A1": [0.3, 1.7, 2.0]}
    together = run(column | formulas, draws, list(formulas)).forecasts
    at = 3 if name in FOLDS[::2] else 15
    cell = [*formulas][at]
    assert run(column | {cell: formulas[cell]}, draws, [cell]).forecasts == [together[at]]


FOLDED = ["SUM", "COUNT", "COUNTA", "MAX", "MIN", "AVERAGE", "PRODUCT"]
RUNNING = ["B$1:B{r}", "A$1:B{r}", "B{r}:B${n}", "A{r}:B${n}"]
DOWN, UP = RUNNING[:2], RUNNING[2:]


def filled(name, range_, rows):
    """Two columns, and a function of ranges that grow or shrink filled down beside them."""
    cells = {f"B{r}": f"=A$1*{r}" for r in range(1, rows + 1)} | {f"A{r}": r / 7 for r in range(2, rows + 1)}
    return cells | {f"D{r}": f"={name}({range_.format(r=r, n=rows)})" for r in range(1, rows + 1)}


@pytest.mark.parametrize(("name", "range_"), [(name, RUNNING[at % 4]) for at, name in enumerate(FOLDED)])
def test_a_row_more_is_a_few_cells_more_to_read(lower, name, range_):
    def read(rows):
        wanted = [f"D{row}" for row in range(1, rows + 1)]
        nodes = lower(filled(name, range_, rows), ["A1"], wanted)[0].dag.nodes
        return sum(len(uses(node)) for node in nodes)

    few, more, most = map(read, (80, 115, 150))
    assert most - more < 1.2 * (more - few)


@pytest.mark.parametrize("range_", RUNNING)
def test_the_order_in_which_the_cells_are_asked_for_does_not_matter(lower, range_):
    def read(wanted):
        nodes = lower(filled("MAX", range_, 150), ["A1"], wanted)[0].dag.nodes
        return sum(len(uses(node)) for node in nodes)

    wanted = [f"D{row}" for row in range(1, 151)]
    assert read(wanted[::-1]) == read(wanted)


def test_formulas_of_which_each_needs_the_one_below_are_linear(lower):
    def read(rows):
        cells = {f"B{r}": f"=A$1*{r}" for r in range(1, rows + 1)} | {f"C{rows + 1}": 0.0}
        cells |= {f"C{r}": f"=C{r + 1}+MAX(B$1:B{r})" for r in range(1, rows + 1)}
        return sum(len(uses(node)) for node in lower(cells, ["A1"], ["C1"])[0].dag.nodes)

    few, more, most = map(read, (80, 115, 150))
    assert most - more < 1.2 * (more - few)


def test_what_two_columns_need_is_not_listed_for_each_range(workbook):
    def kept(rows):
        cells = {f"{c}{r}": f"=Z$1*{r}" for c in "AB" for r in range(1, rows + 1)}
        cells |= {f"C{r}": f"=SUM(A$1:B{r})" for r in range(1, rows + 1)}
        book = workbook(cells | {"Z1": 1.0})
        graph = build_graph(Resolver(book, {}), [Cell("S", r, 3) for r in range(1, rows + 1)], frozenset())
        listed = [part for parts in graph.needs.parts.values() for part in parts if isinstance(part, tuple)]
        return sum(map(len, listed))

    assert kept(160) - kept(130) == kept(130) - kept(100)


def alone(run, cells, draws, wanted):
    """What a formula gives where no other of its column is there."""
    return run({c: f for c, f in cells.items() if c == wanted or c[0] != "D"}, draws, [wanted]).forecasts[0]


HELD = [1.0, -2.5, 0.1, 3e-7, "x", "", "7", True, False, None]
DRAWN = ["=A$1", "=A$1*3", "=1/(A$1-2)", "=A$1&1", "=A$1>1", "=LN(A$1-1)", '=IF(A$1>1,A$1,"none")', "=IF(A$1>1,B$99,7)"]


@settings(deadline=None, max_examples=30)
@given(
    st.lists(st.sampled_from(HELD + DRAWN), min_size=20, max_size=40),
    st.sampled_from(FOLDED),
    st.sampled_from(DOWN),
    st.lists(st.integers(0, 39), max_size=12),
    st.integers(0, 39),
)
def test_a_running_fold_is_the_fold_of_the_whole_range(run, held, name, range_, missing, at):
    rows = len(held)
    cells = {"A1": 0.0} | {f"B{r}": item for r, item in enumerate(held, 1) if item is not None}
    cells |= {
        f"A{r}": item for r, item in enumerate(held[::-1], 2) if item is not None and not str(item).startswith("=")
    }
    formulas = {f"D{r}": f"={name}({range_.format(r=r)})" for r in range(1, rows + 1) if r not in missing}
    wanted = [*formulas][at % len(formulas)]
    draws = {"A1": [0.5, 1.0, 1.5, 2.0]}
    together = run(cells | formulas, draws, [*formulas]).forecasts[[*formulas].index(wanted)]
    assert together == alone(run, cells | formulas, draws, wanted)


EXACT = [
    1.0,
    -2.5,
    3.0,
    "x",
    "",
    True,
    None,
    "=A$1",
    "=A$1*3",
    "=1/(A$1-2)",
    "=SQRT(A$1-1)",
    "=A$1&1",
    '=IF(A$1>1,1,"")',
]


@settings(deadline=None, max_examples=15)
@given(
    st.lists(st.sampled_from(EXACT), min_size=95, max_size=105),
    st.sampled_from(sorted({*FOLDED} - {"PRODUCT"})),
    st.sampled_from(UP),
    st.sets(st.integers(1, 60), max_size=10),
    st.integers(1, 60),
)
def test_upwards_it_is_so_too_where_no_digit_is_lost(run, held, name, range_, missing, at):
    rows = len(held)
    cells = {"A1": 0.0} | {f"B{r}": item for r, item in enumerate(held, 1) if item is not None}
    formulas = filled(name, range_, rows)
    formulas = {f"D{r}": formulas[f"D{r}"] for r in range(1, rows + 1) if r == at or r not in missing}
    draws = {"A1": [0.5, 1.25, 2.0]}
    together = run(cells | formulas, draws, [f"D{at}"]).forecasts[0]
    assert together == alone(run, cells | formulas, draws, f"D{at}")


@pytest.mark.parametrize("name", ["SUM", "AVERAGE", "PRODUCT"])
def test_upwards_no_more_differs_than_rounding(run, name):
    rng = np.random.default_rng(5)
    rows = 200
    cells = {"A1": 0.0} | {f"B{r}": f"=A$1*{x}" for r, x in enumerate(rng.uniform(0.7, 1.3, rows).tolist(), 1)}
    formulas = {f"D{r}": f"={name}(B{r}:B${rows})" for r in range(1, rows + 1)}
    draws = {"A1": [0.9, 1.0, 1.1]}
    together = run(cells | formulas, draws, [f"D{r}" for r in (1, 2, 100)]).forecasts
    for at, result in zip((1, 2, 100), together, strict=True):
        by_itself = np.array(alone(run, cells | formulas, draws, f"D{at}"))
        np.testing.assert_allclose(result, by_itself, rtol=2 * rows * 2.0**-53, atol=0)


def test_upwards_the_digits_do_not_depend_on_which_ranges_there_are(run):
    cells = {"A1": 0.0} | {f"B{r}": f"=A$1/{r}" for r in range(1, 201)}
    every = {f"D{r}": f"=SUM(B{r}:B$200)" for r in range(1, 201)}
    some = {cell: formula for cell, formula in every.items() if int(cell[1:]) % 2}
    draws = {"A1": [0.3, 0.7]}
    assert run(cells | every, draws, ["D7"]).forecasts == run(cells | some, draws, ["D7"]).forecasts


def test_up_and_down_in_one_column_do_not_meet(run):
    cells = {"A1": 0.0} | {f"B{r}": f"=A$1/{r}" for r in range(1, 201)}
    up = {f"D{r}": f"=SUM(B{r}:B$200)" for r in range(1, 201)}
    down = {f"E{r}": f"=SUM(B$4:B{r})" for r in range(150, 201)}
    draws = {"A1": [0.3, 0.7]}
    for wanted, others in (("E200", {}), ("D5", up)):
        both = run(cells | up | down, draws, [wanted]).forecasts
        assert both == run(cells | others | {wanted: (up | down)[wanted]}, draws, [wanted]).forecasts


def test_a_fold_over_its_own_column(run):
    cells = {"B1": "=A1", "A1": 0.0} | {f"B{r}": f"=MAX(B$1:B{r - 1})+1" for r in range(2, 101)}
    assert run(cells, {"A1": [1.0, -5.0]}, ["B100"]).forecasts == [[100.0, 94.0]]


def test_ranges_filled_right_over_one_row(run):
    columns = [column_letters(c) for c in range(3, 60)]
    cells = {"A1": 0.0} | {f"{c}1": f"=$A$1*{i}" for i, c in enumerate(columns, 1)}
    cells |= {f"{c}2": f"=AVERAGE($C1:{c}1)" for c in columns} | {f"{c}3": f"=MIN({c}1:$BG1)" for c in columns}
    got = run(cells, {"A1": [2.0]}, ["Z2", "Z3", "BG2"]).forecasts
    assert got == [[25.0], [48.0], [58.0]]


LONG = [{}, {"B3": "x", "B90": True}, {"B70": "=1/(A1-2)"}, {"B2": "=A1&1", "B5": "=-A1"}]


@pytest.mark.parametrize(
    ("name", "contents"),
    [(name, held) for at, name in enumerate(("SUM", "MAX", "PRODUCT")) for held in LONG[at % 2 :: 2]],
)
def test_a_long_set_gives_what_its_cells_give(run, name, contents):
    """Two long ranges, one of them a cell longer, in formulas of their own; and the same cells in four parts."""
    cells = {f"B{row}": f"=(A1-{row})/77" for row in range(1, 100)} | contents
    parts = "B1:B30,B31:B60,B61:B80,B81:B"
    cells |= {
        "D1": f"={name}(B1:B98)",
        "E9": f"={name}(B1:B99)",
        "F3": f"={name}({parts}99)",
        "G4": f"=1*{name}({parts}98)",
    }
    shorter, longer, parted, before = run(cells, {"A1": [0.3, 1.7, 2.0]}, ["D1", "E9", "F3", "G4"]).forecasts
    assert parted == longer
    assert before == shorter


def test_the_largest_of_texts_is_not_part_of_a_longer_range(run):
    cells = {f"B{row}": "=A1&1" for row in range(1, 81)} | {"B81": "=A1-9", "C1": "=MAX(B1:B80)", "D5": "=MAX(B1:B81)"}
    assert run(cells, {"A1": [1.0]}, ["C1", "D5"]).forecasts == [[0.0], [-8.0]]


def test_a_moving_sum_is_not_taken_apart(lower):
    def nodes(rows):
        cells = {f"B{row}": f"=A1*{row}" for row in range(1, rows + 80)}
        cells |= {f"C{row}": f"=SUM(B{row}:B{row + 79})" for row in range(1, rows + 1)}
        return len(lower(cells, ["A1"], [f"C{row}" for row in range(1, rows + 1)])[0].dag.nodes)

    assert nodes(60) - nodes(50) < 10 * 10


def test_an_error_counts_before_an_overflow_of_the_cells_before_it(run):
    cells = {f"B{row}": "=1.7E308-A1" for row in range(1, 6)} | {f"B{row}": "=1+A1" for row in range(6, 100)}
    cells |= {"B98": "=1/(A1-A1)", "C2": "=SUM(B1:B99)", "D3": "=PRODUCT(B1:B99)", "E4": "=SUM(B2:B97)"}
    assert run(cells, {"A1": [0.5]}, ["C2", "D3", "E4"]).forecasts == [["#DIV/0!"], ["#DIV/0!"], ["#NUM!"]]


def test_a_long_sum_in_a_branch(run):
    cells = {f"B{row}": f"=A1+{row}" for row in range(1, 101)} | {"C1": "=IF(A1>0,SUM(B1:B100)/A1,1/A1)"}
    assert run(cells, {"A1": [1.0, -1.0]}, ["C1"]).forecasts == [[5150.0, -1.0]]


OVERFLOWING = [
    ("SUM", "B$1:B{r}"),
    ("SUM", "B{r}:B$99"),
    ("PRODUCT", "OFFSET(B$1,0,0,{r},1)"),
    ("PRODUCT", "B{r}:B$99"),
]


@pytest.mark.parametrize(
    ("name", "range_"), [*OVERFLOWING, ("AVERAGE", "B$1:B{r}"), ("AVERAGE", "OFFSET(B$1,0,0,{r},1)")]
)
def test_an_error_counts_before_an_overflow_of_a_shorter_range(run, name, range_):
    """The numbers overflow at both ends, and in two trials there is an error in between."""
    cells = {f"B{row}": "=1.7E308-A1" for row in (1, 2, 3, 97, 98, 99)} | {f"B{row}": "=1+A1" for row in range(4, 97)}
    cells |= {"B40": "=1/(A1-2)", "B60": "=IF(A1<1,NA(),1)", "B1": "=1.7E308", "B2": "=1.6E308", "B20": "x"}
    cells |= {f"D{r}": f"={name}({range_.format(r=r)})" for r in range(1, 100)}
    draws = {"A1": [3.0, 2.0, 0.5]}
    wanted = [f"D{row}" for row in (18, 50, 70, 98)]
    together = run(cells, draws, wanted).forecasts
    assert together == [alone(run, cells, draws, cell) for cell in wanted]
    assert ["#NUM!", "#DIV/0!", "#N/A"] in together


def test_programs_with_running_totals_can_be_sent_to_another_process(run):
    program = run(totals(20), {"A1": [1.0]}, ["C18", "C20"]).program
    again = pickle.loads(pickle.dumps(program)).evaluator(1)
    again.filters({"A1": np.array([1.7e307])}, 1)
    assert [column.codes.tolist() for column in again.forecasts(np.arange(1))] == [[6], [6]]


SETS = ["SUMPRODUCT({b},{w})", "SUMPRODUCT({b},{b},{c})", "SUMPRODUCT({c})", "AVERAGE({b})", "AVERAGE({b},{c})"]
SETS += [
    "COUNT({b})",
    "COUNT({b},{c})",
    "IF(A1>0.8,COUNT({b}),AVERAGE({c}))",
    "SUMPRODUCT(({b}>1)*{c})",
    "SUMPRODUCT({b},{{1;2;3;4;5}})",
    "IF(A1>0.8,AVERAGE({c}),SUMPRODUCT({b},{c}))",
]


def sets(formula, rows=9):
    """A formula of five numbers each, filled down."""
    cells = {f"B{r}": f"=A$1*{r}/7" for r in range(1, rows + 5)} | {
        f"C{r}": f"=2/(A$1*{r})" for r in range(1, rows + 5)
    }
    cells |= {f"W{r}": r / 3 for r in range(1, 6)}
    filled = {
        f"D{r}": "=" + formula.format(b=f"B{r}:B{r + 4}", c=f"C{r}:C{r + 4}", w="W$1:W$5") for r in range(1, rows)
    }
    return cells | filled, [*filled]


@pytest.mark.parametrize("formula", SETS)
def test_sums_of_products_means_and_counts_of_numbers_are_computed_number_by_number(run, formula):
    """`run` sees that the bits are those of the careful path."""
    cells, wanted = sets(formula)
    outcome = run(cells, {"A1": [0.7, 1.1, 2.0]}, wanted)
    assert not outcome.careful
    run(cells, {"A1": [0.7, 0.0, 2.0]}, wanted)
    dag = outcome.program._dag
    nodes = [at for at, node in enumerate(dag.nodes) if getattr(node, "function", None) and node.function.name in NAMES]
    assert {*nodes} <= {*dag.folded}
    assert len(nodes) >= len(wanted)


NAMES = ("SUMPRODUCT", "AVERAGE", "COUNT")


def test_of_sums_of_products_the_first_range_has_the_first_error(run):
    cells = {"B1": "=A1", "B2": "=1/(A1-1)", "C1": "=LN(A1-2)", "C2": "=A1+1", "D1": "=SUMPRODUCT(B1:B2,C1:C2)"}
    assert run(cells, {"A1": [3.0, 2.0, 1.0]}, ["D1"]).forecasts == [[2.0, "#NUM!", "#DIV/0!"]]


@pytest.mark.parametrize("b1", ["x", True, "=A1&1", "=A1>1", '=IF(A1>1,1,"")'])
def test_what_is_no_number_is_left_to_the_careful_path(run, b1):
    cells = {"B1": b1, "B2": "=A1", "C1": "=A1", "C2": "=A1*3"}
    cells |= {"D1": "=SUMPRODUCT(B1:B2,C1:C2)", "D2": "=AVERAGE(B1:B2)"}
    cells |= {"D3": "=COUNT(B1:B2)"}
    products, mean, count = run(cells, {"A1": [3.0, 2.0]}, ["D1", "D2", "D3"]).forecasts
    assert count == ([2.0, 2.0] if b1 == '=IF(A1>1,1,"")' else [1.0, 1.0])
    assert products == ([30.0, 14.0] if b1 == '=IF(A1>1,1,"")' else [27.0, 12.0])
    assert mean == ([2.0, 1.5] if b1 == '=IF(A1>1,1,"")' else [3.0, 2.0])
