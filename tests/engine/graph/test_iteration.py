"""Cells of a circle in a workbook with iterative calculation: in each trial from the saved values until they settle."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.stability import stability
from xlmc.analysis.studies.verify import Status, verify
from xlmc.errors import FormulaError
from xlmc.excel.address import parse_address
from xlmc.excel.iteration import Iteration
from xlmc.excel.workbook.workbook import CellContent, Formula
from xlmc.montecarlo.simulation.simulate import simulate

FINE = Iteration(100, 1e-12)
LOAN = {"A1": 0.05, "B1": 1000.0, "B2": "=A1*(B1+B3)/2", "B3": "=B1+B2"}
"""Interest on the mean of the opening and the closing balance: the closing one is 1000 (1 + r/2) / (1 - r/2)."""


@pytest.fixture(scope="session")
def iterated(lower, load_program):
    """`iterated(cells, target, draws, iteration)`: what the target is in each trial, A1 being drawn, in each engine."""

    def compute(cells, target, draws, iteration=FINE, **of_workbook):
        lowering, result = lower({"A1": 0.0, **cells}, ["A1"], [target], iteration=iteration, **of_workbook)
        answers = []
        for engine in ("numpy", "jit"):
            evaluator = load_program(engine)(lowering, [], result, frozenset()).evaluator(len(draws))
            list(evaluator.filters({"A1": np.array(draws)}, len(draws)))
            (column,) = evaluator.forecasts(np.arange(len(draws)))
            answers.append(column)
        first, second = answers
        assert first.values.tobytes() == second.values.tobytes()
        assert (first.codes is None) == (second.codes is None)
        return list(np.where(np.zeros(len(draws)) if first.codes is None else first.codes, np.nan, first.values))

    return compute


def test_a_circle_ends_where_its_equations_hold(iterated):
    rates = np.linspace(0.0, 0.5, 40)
    result = iterated({key: LOAN[key] for key in ("B1", "B2", "B3")}, "B3", rates)
    assert result == pytest.approx(1000 * (1 + rates / 2) / (1 - rates / 2), rel=1e-12)


ORDERS = [
    ({"B1": "=B2", "B2": "=B1+1"}, "B1", 4.0),
    ({"B1": "=B2", "B2": "=B1+1"}, "B2", 5.0),
    ({"B2": "=C1", "C1": "=B2+1"}, "B2", 5.0),
    ({"B1": "=C1", "C1": "=B1+1"}, "B1", 4.0),
    ({"T!A1": "=S!B9+1", "B9": "=T!A1"}, "B9", 4.0),
    ({"B1": ("=B1+1", 41.0)}, "B1", 46.0),
    ({"B1": ("=IF(B1<43,B1+1,B1)", 41.0)}, "B1", 43.0),
    ({"B1": ('=IF(B1="up","down","up")', "up"), "C1": '=IF(B1="down",1,2)'}, "C1", 1.0),
    ({"B1": ("=B1+SUM(B2:B3)", 1.0), "B2": 2.0, "B3": "=B1*0"}, "B1", 11.0),
]


@pytest.mark.parametrize(("cells", "target", "expected"), ORDERS)
def test_cells_are_computed_by_tab_row_and_column_from_what_was_saved(iterated, cells, target, expected):
    """Five iterations; the cells do not depend on what is drawn, or by nothing."""
    assert iterated(cells, target, [0.5, 0.7], Iteration(5, 0.0)) == [expected] * 2
    moved = {key: (f"{cell[0]}+0*A1", cell[1]) if isinstance(cell, tuple) else cell for key, cell in cells.items()}
    if target != "C1":
        assert iterated(moved, target, [0.5, 0.7], Iteration(5, 0.0)) == [expected] * 2


def _by_hand(drawn, iteration):
    """B1 = B1/2 + C1/4 + A1 and C1 = B1*A1, in plain numbers."""
    b, c = 0.25, 4.0
    for _ in range(iteration.count):
        before = b, c
        b = b / 2 + c / 4 + drawn
        c = b * drawn
        if max(abs(b - before[0]), abs(c - before[1])) < iteration.change:
            break
    return b


@pytest.mark.parametrize("iteration", [Iteration(3, 1e-9), Iteration(100, 0.1), Iteration(200, 1e-6)])
def test_each_trial_ends_by_itself(iterated, iteration):
    draws = np.linspace(0.0, 1.9, 9)
    cells = {"B1": ("=B1/2+C1/4+A1", 0.25), "C1": ("=B1*A1", 4.0)}
    result = iterated(cells, "B1", draws, iteration)
    assert result == [_by_hand(drawn, iteration) for drawn in draws.tolist()]
    assert iterated(cells, "B1", draws[4:5], iteration) == result[4:5]


def test_errors_stay(iterated):
    result = iterated({"B1": ("=IF(A1>0.5,1/0,B1/2)", 1.0)}, "B1", [0.2, 0.7], Iteration(3, 0.0))
    assert result[0] == 0.125
    assert np.isnan(result[1])
    kept = iterated({"B1": ("=IFERROR(1/(B1-1),7)+A1", 1.0)}, "B1", [0.0, 1.0], Iteration(1, 0.0))
    assert kept == [7.0, 8.0]


def test_what_is_only_pointed_through_is_not_iterated(lower):
    cells = {"A1": 1.0, "A2": 2.0, "A3": ("=SUM(A1:OFFSET(A3,-1,0))", 99.0), "B1": "=IF(A2=2,A1,B1)"}
    lowering, _ = lower(cells, ["A1"], ["A3", "B1"], iteration=Iteration())
    assert (lowering.iterated, lowering.notices) == ([], [])


def test_ranges_that_others_read_hold_the_settled_values(iterated):
    cells = {"B1": "=B2/2+A1", "B2": "=SUM(B1:B1)", "C1": "=SUM(B1:B2)", "C2": "=SUM(B1:B1)"}
    assert iterated(cells, "C1", [1.0, 3.0]) == pytest.approx([4.0, 12.0], rel=1e-11)
    assert iterated(cells, "C2", [1.0, 3.0]) == pytest.approx([2.0, 6.0], rel=1e-11)


def test_an_array_formula_in_a_circle_is_refused(lower):
    array = CellContent(0.0, Formula("A1+C1*{1;2}", 1, 2, array=parse_address("S!B1:B2")))
    with pytest.raises(FormulaError, match="S!B1: An array formula is in a circle"):
        lower({"A1": 1.0, "B1": array, "C1": "=B2"}, ["A1"], ["C1"], iteration=FINE)


@pytest.fixture(scope="module")
def loan(book):
    def make(cells, forecast, iteration, low=0.02, high=0.1):
        return book(cells, {"rate": {"cell": "A1", "low": low, "high": high}}, {"x": forecast}, iteration=iteration)

    return make


def test_a_run_says_that_cells_are_iterated_and_whether_they_settle(loan):
    run = simulate(loan(LOAN, "B3", FINE), trials=500, seed=1)
    assert [str(note.where) for note in run.notices if "computed iteratively" in note.message] == ["S!B2"]
    assert not any("settle" in note.message for note in run.notices)
    run = simulate(loan({"A1": 0.05, "B1": "=IF(A1>0.06,B1+1,0.5)"}, "B1", Iteration()), trials=500, seed=1)
    many = int((run.prior["rate"] > 0.06).sum())
    (text,) = [note.message for note in run.notices if "settle" in note.message]
    assert f"does not settle in {many} of 500 trials" in text


STARTS = [
    (LOAN, "B3", False),
    ({"A1": 0.05, "B1": ("=(B1+A1/B1)/2", 1.0)}, "B1", True),
    ({"A1": 0.05, "B1": ("=B1+A1", 0.0)}, "B1", True),
    ({"A1": 0.05, "B1": ("=IF(B1>0.9,0.9+A1,A1)", 0.0)}, "B1", True),
]


@pytest.mark.parametrize(("cells", "forecast", "depends"), STARTS, ids=["loan", "root", "count", "threshold"])
def test_stability_says_when_the_answer_depends_on_the_start(loan, cells, forecast, depends):
    result = stability(loan(cells, forecast, Iteration(25, 1e-12)), trials=100, seed=1).findings
    assert [(one.cell.a1, one.level.name) for one in result if one.kind == "start"] == [("B1", "WRONG")] * depends


def test_verify_allows_for_where_excel_stopped(workbook):
    cells = {"A1": 0.1, "B1": 1000.0, "B2": ("=A1*(B1+B3)/2", 105.2631), "B3": ("=B1+B2", 1105.263)}
    cells |= {"C1": ("=B3*2", 2210.5), "D1": ("=D2+1", 5.0), "D2": ("=D1", 5.0)}
    result = {check.cell.a1: check.status for check in verify(workbook(cells, iteration=Iteration())).cells}
    wrong = {"C1", "D1"}
    assert result == {a: Status.DIFFERING if a in wrong else Status.MATCHED for a in ("B2", "B3", "C1", "D1", "D2")}


def test_verify_of_a_circle_that_offset_leads_round(workbook):
    cells = {"B1": ("=SUM(OFFSET(B1,1,0,2,1))", 0.0), "B2": ("=OFFSET(B2,-1,0)/2", 0.0), "B3": ("=B1*0", 0.0)}
    result = verify(workbook(cells, iteration=Iteration())).cells
    assert [check.status for check in result] == [Status.MATCHED] * 3
