"""Cells that need themselves by what their formulas name: computed where they do not read themselves."""

from __future__ import annotations

import pytest

from xlmc.analysis.studies.verify import Status, verify
from xlmc.errors import FormulaError
from xlmc.montecarlo.diagnostics.cell_errors import errors_at_base
from xlmc.montecarlo.simulation.simulate import simulate

SHEET = {"A1": 10.0, "A2": 12.0, "A3": 14.0, "A4": 16.0, "B1": 1.0, "B2": 2.0, "B3": 3.0, "D1": 1.0, "D2": 2.0}
"""The drawn cell is A1."""

POINTED = [
    ("A6", "SUM(A1:OFFSET(A6,-1,0))", 52.0),
    ("A6", "SUM(A1:INDEX(A:A,ROW()-1))", 52.0),
    ("A6", "SUM(INDEX(A:A,1):INDEX(A:A,ROW()-1))", 52.0),
    ("A6", "SUM(OFFSET(A6,-5,0,5,1))", 52.0),
    ("A6", "SUM(OFFSET(OFFSET(A6,0,0),-5,0,5,1))", 52.0),
    ("A6", "SUM(OFFSET(INDEX(A:A,ROW()),-5,0,5))", 52.0),
    ("A6", 'SUM(INDIRECT("A1:A"&ROW()-1))+0*ROWS(A1:A6)', 52.0),
    ("B4", "A4+INDEX(B:B,ROW()-1)", 19.0),
    ("B4", "A4+OFFSET(B4,-1,0)", 19.0),
    ("B4", "A4+INDEX($B$1:$B$4,3)", 19.0),
    ("B4", "INDEX(A1:B4,ROW()-1,COLUMN())", 3.0),
    ("B40", 'CHOOSE(2,B40,"x")&A1', "x10"),
    ("B40", "CHOOSE(2,B40,A1)", 10.0),
    ("A12", "IF(FALSE,A12,5)+B1", 6.0),
    ("A12", "IF(TRUE,A1,A12)", 10.0),
    ("A12", "IF(B1=2,A12,A1)", 10.0),
    ("A12", "IFS(B1=2,A12,B1=1,A1,TRUE,A12)", 10.0),
    ("A12", "SWITCH(B2,1,A12,2,A1,A12)", 10.0),
    ("A12", "IFERROR(B1,A12)+A1", 11.0),
    ("A12", "IFNA(B1,A12)+A1", 11.0),
    ("A12", "ROW(A12)+COLUMN(A12)+ROWS(A1:A12)+A1", 35.0),
    ("A12", "ROW(OFFSET(A12,0,0))+COLUMNS(OFFSET(A12,0,0,1,2))+A1", 24.0),
    ("A12", "LET(x,A12,y,A1,y+1)", 11.0),
    ("A12", "LET(x,A12,ROW(x))+A1", 22.0),
    ("A12", "IF(ISREF(A12),A1,0)", 10.0),
    ("B4", 'SUMIFS(B:B,A:A,"<>"&A4)', 6.0),
    ("B4", "SUMIFS(B:B,A:A,A2)", 2.0),
    ("B4", 'SUMIF(A1:A4,"<13",B1:B4)', 3.0),
    ("B4", 'AVERAGEIFS(B1:B4,A1:A4,"<13")', 1.5),
    ("B4", 'MAXIFS(B1:B4,A1:A4,"<"&A4)', 3.0),
    ("B4", "VLOOKUP(12,A1:B4,2,FALSE)", 2.0),
    ("B4", "VLOOKUP(16,A1:D4,1,FALSE)", 16.0),
    ("B4", "XLOOKUP(14,A1:A4,B1:B4)", 3.0),
    ("B4", "LOOKUP(13,A1:A4,B1:B4)", 2.0),
]


@pytest.mark.parametrize(("cell", "formula", "expected"), POINTED, ids=[formula for _, formula, _ in POINTED])
@pytest.mark.parametrize("held", [(), tuple(SHEET)], ids=["drawn", "constant"])
def test_what_is_only_pointed_into_is_not_read(gives, cell, formula, expected, held):
    assert gives(SHEET | {cell: f"={formula}"}, [(cell, expected)], held) == []


def test_subtotals_of_the_own_column(gives):
    """A chart of accounts: each subtotal adds up the rows of its group, in the column that all subtotals are in."""
    cells, expected, row = {"A1": 1.0}, [], 2
    for group in range(12):
        for _ in range(3):
            cells |= {f"C{row}": "item", f"D{row}": f"g{group}", f"E{row}": f"=A1+{row}", f"F{row}": f"=A1*{row}"}
            row += 1
        cells |= {f"C{row}": "sum", f"D{row}": f"g{group}", f"E{row}": f'=SUMIFS(E:E,C:C,"item",D:D,D{row})'}
        cells |= {f"G{row}": f"t{group}", f"F{row}": f'=SUMIF(D$2:D${row - 1},"g{group}",F$2:F${row - 1})'}
        expected += [(f"E{row}", sum(range(row - 3, row), 3.0)), (f"F{row}", float(sum(range(row - 3, row))))]
        row += 1
    assert gives(cells, expected, ["A1"]) == gives(cells, expected) == []


STEPS, BEFORE = 30, 3
FINISHES = [
    ("D{r}+B{r}", "IF(C{r}=0,0,VLOOKUP(C{r},A:E,5,FALSE))"),
    ("D{r}+B{r}", "IF(C{r}=0,0,XLOOKUP(C{r},A$2:A$50,E$2:E$50))"),
    ("B{r}+D{r}", "MAXIFS(E:E,A:A,C{r})"),
    ("B{r}+SUMIF(A:A,C{r},E:E)", "0"),
    ("B{r}+IF(C{r}=0,0,LOOKUP(C{r},A$2:A$50,E$2:E$50))", "0"),
    ("B{r}+IFERROR(INDEX(E:E,MATCH(C{r},A:A,0)),0)", "0"),
    ("B{r}+N(OFFSET(E$1,IF(C{r}=0,99,C{r}),0))", "0"),
]


@pytest.mark.parametrize(
    ("finish", "start"), FINISHES, ids=["VLOOKUP", "XLOOKUP", "MAXIFS", "SUMIF", "LOOKUP", "INDEX", "OFFSET"]
)
def test_a_plan_that_looks_up_its_own_steps(gives, finish, start):
    """Each step begins when the one that its row names has ended; that one stands below it. Durations are drawn."""
    cells, ends = {"A1": "step"}, {0: 0.0}
    for step in range(STEPS, 0, -1):
        row, before = step + 1, step + BEFORE if step + BEFORE <= STEPS else 0
        ends[step] = ends[before] + step % 5 + 1
        cells |= {f"A{row}": float(step), f"B{row}": step % 5 + 1.0, f"C{row}": float(before)}
        cells |= {f"D{row}": f"={start.format(r=row)}", f"E{row}": f"={finish.format(r=row)}"}
    held = [address for address in cells if address[0] in "AC"]
    assert gives(cells, [(f"E{step + 1}", ends[step]) for step in (1, 2, 9, STEPS)], held) == []


def test_circles_over_sheets(gives):
    cells = {"A1": 2.0, "T!A1": "=IF(S!A1>1,5,S!B1)", "B1": "=IF(A1>1,T!A1*2,3)"}
    assert gives(cells, [("B1", 10.0)]) == []


def test_too_many_cells_that_may_read_each_other(lower):
    cells = {f"D{row}": float(row) for row in range(1, 11)} | {"E1": 5.0, "A1": 1.0}
    cells |= {f"E{row}": f"=SUMIFS(E$1:E$10,D$1:D$10,A1+{row - 2})" for row in range(2, 11)}
    with pytest.raises(FormulaError, match=r"More than 8 cells may need each other.*S!E2, S!E3"):
        lower(cells, ["A1"], ["E10"])


@pytest.mark.parametrize(
    "formula",
    [
        "A12+1",
        "CHOOSE({1,2},A12,A1)",
        "SUM(A1:A12)",
        "COUNT(A1:A12)",
        "COUNTIF(A1:A12,5)",
        "SUM(A1:OFFSET(A12,0,0))",
        "OFFSET(A12,0,0)",
        "IF(TRUE,A12,5)",
        "IF(A12>0,1,2)",
        "CHOOSE(1,A12,2)",
        "IFERROR(A12,5)",
        "ISERROR(A12)+0",
        "MATCH(5,A1:A12,0)",
        "IFERROR(NA(),A12)",
        'SUMIFS(A:A,A:A,"<5")',
        "VLOOKUP(5,A1:B12,2,FALSE)",
        "LET(x,A12,x+1)",
        "IF(B1>5,A1,A12)",
        "IF(A1>0,A12,A12+1)",
    ],
)
def test_what_reads_itself_is_a_circle(lower, formula):
    with pytest.raises(FormulaError, match="circle"):
        lower({**SHEET, "A12": f"={formula}"}, ["A1"], ["A12"])


@pytest.mark.parametrize("formula", ['SUMIFS(A1:A12,B1:B12,"")', "INDEX(A1:A12,B3*4)", "VLOOKUP(0,D11:A12,1)+A12"])
def test_known_criteria_and_numbers_decide_what_is_read(lower, formula):
    with pytest.raises(FormulaError, match="circle"):
        lower({**SHEET, "A12": f"={formula}"}, [], ["A12"])


def test_a_switch_between_two_ways_round_is_no_circle(ways):
    """The circularity breaker of financial models: interest on the average balance, or on the opening one."""
    cells = {"A1": 100.0, "A2": 0.0, "B1": "=IF(A2=1,B3*2,A1)", "B2": "=B1+1", "B3": "=IF(A2=1,A1,B2)"}
    for answers in ways(cells, ["B1+B3"], held=["A2"]).values():
        assert answers == [201.0]
    for answers in ways({**cells, "A2": 1.0}, ["B1+B3"], held=["A2"]).values():
        assert answers == [300.0]


def test_two_cells_that_read_each_other_in_turn_are_no_circle(trials):
    cells = {"B1": "=IF(A1>0.5,B2*2,5)", "B2": "=IF(A1>0.5,6,B1+1)"}
    result = trials(cells, "10*B1+B2+0*A1", [0.2, 0.7, 0.4], constants=False)
    assert set(map(tuple, result.values())) == {(56.0, 126.0, 56.0)}


@pytest.mark.parametrize(
    "formula",
    [
        "IF(A1>0.5,B1,5)",
        "CHOOSE(1+(A1>0.5),5,B1)",
        "IFS(A1>0.5,B1+1,TRUE,5)",
        "SWITCH(A1>0.5,TRUE,B1,5)",
        "IF(A1>0.5,IF(A1>0.6,B1,B1),5)",
        "IFERROR(5/(A1<0.5),B1)",
        "INDEX(B1:B2,1+(A1<0.5))*1",
        'SUMIFS(B1:B2,C1:C2,IF(A1<0.5,"x","y"))',
        "VLOOKUP(IF(A1<0.5,2,1),{1;2},1)+IF(A1<0.5,3,B1)",
    ],
)
def test_trials_that_read_the_own_cell_are_errors(trials, lower, formula):
    cells = {"B1": f"={formula}", "B2": 5.0, "C1": "y", "C2": "x"}
    result = trials(cells, "B1+A1*0", [0.2, 0.7, 0.4], constants=False)
    assert set(map(tuple, result.values())) == {(5.0, "#CALC!", 5.0)}
    lowering, _ = lower({"A1": 0.0, **cells}, ["A1"], ["B1"])
    assert [(str(notice.where), "#CALC!" in notice.message) for notice in lowering.notices] == [("S!B1", True)]


def test_an_error_of_a_circle_is_not_hidden(lower):
    cells = {"A1": 0.0, "B1": "=IF(A1>0.5,B1,5)", "C1": "=IFERROR(B1,0)", "D1": "=COUNT(B1:B3)"}
    for target in ("C1", "D1"):
        with pytest.raises(FormulaError, match="circle"):
            lower(cells, ["A1"], [target])


def test_a_long_column_that_points_through_itself(lower):
    n = 600
    cells = {f"A{row}": float(row) for row in range(1, n + 1)} | {"B1": "=A1"}
    cells |= {f"B{row}": f"=A{row}+INDEX(B:B,ROW()-1)" for row in range(2, n + 1)}
    lowering, (target,) = lower(cells, ["A1"], [f"B{n}"])
    assert lowering.known(target) is None
    assert len(lowering.graph.circles) == n - 1
    assert lowering.graph.varying >= lowering.graph.circles.keys()


def test_verify_computes_what_is_pointed_through_and_names_the_circles(workbook):
    cells = {"A1": 1.0, "A2": 2.0, "A3": ("=SUM(A1:OFFSET(A3,-1,0))", 3.0), "B1": ("=B2+1", 0.0), "B2": ("=B1", 0.0)}
    result = {check.cell.a1: check for check in verify(workbook(cells)).cells}
    assert {address: check.status for address, check in result.items()} == {
        "A3": Status.MATCHED,
        "B1": Status.UNSUPPORTED,
        "B2": Status.UNSUPPORTED,
    }
    assert "in a circle: S!B" in result["B1"].reason


@pytest.fixture(scope="module")
def turning(book):
    """Of two cells each reads the other one in one trial of ten; also at the base case."""
    cells = {"A1": 0.95, "B1": "=IF(A1>0.9,B2,5)", "B2": "=IF(A1>0.9,B1,5)+1", "C1": "=B1+A1"}
    return book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"sum": "C1"})


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_a_run_names_the_cell_whose_trials_are_errors(turning, engine):
    run = simulate(turning, trials=2_000, seed=1, engine=engine)
    lost = int((run.prior["a"] > 0.9).sum())
    assert dict(run["sum"].faults) == {"#CALC!": lost}
    assert abs(lost / 2_000 - 0.1) < 4 * 0.3 / 2_000**0.5
    assert [str(cell) for cell, _ in run.error_roots.values()] == ["S!B2"]


def test_the_base_case_of_a_circle_has_its_errors(turning):
    result = errors_at_base(turning)
    assert {str(cell) for cell in result.roots} == {"S!B1", "S!B2"}
    assert {str(cell) for cell in result.others} == {"S!C1"}


def test_the_engine_formulas_refuses_circles(turning):
    with pytest.raises(FormulaError, match="no cells that refer to themselves"):
        simulate(turning, trials=10, engine="formulas")
