"""Each lookup in constant numbers beside the same lookup as the functions' own bodies compute it, in every engine."""

from __future__ import annotations

import pytest

from xlmc.engine.graph.nodes import Apply
from xlmc.engine.graph.number_lookups import NumberLookups
from xlmc.excel.functions.lookup.search_and_pick import POSITION

COLUMNS = {
    "D": [0.0, 10.0, 20.0, 30.0, 40.0, 50.0],
    "E": [-8.0, -1.0, 0.0, 1.0, 8.0, 27.0],
    "F": [-0.1, -0.2, -0.4, -0.8, -1.6, -3.2],
    "G": [5.0, 3.0, 9.0, 3.0, 1.0, 7.0],
    "H": [50.0, 40.0, 30.0, 20.0, 10.0, 0.0],
}
"""D rises evenly, E rises, F falls, G is in no order and has 3 twice, H falls evenly."""
TABLE = {f"{column}{row}": cell for column, cells in COLUMNS.items() for row, cell in enumerate(cells, 1)}
MIXED = {"J1": 1.0, "J2": "x", "J3": 3.0, "K1": True, "K2": 2.0, "K3": 3.0, "K4": 4.0}
ROWS = {"D11": 0.0, "E11": 1.0, "F11": 2.0, "G11": 3.0, "D12": 4.0, "E12": 8.0, "F12": 15.0, "G12": 16.0}
KEYS = [-1.0, 0.0, 3.0, 9.999999999999999, 10.0, 20.0, 20.000000000000004, 49.5, 50.0, 1e9]

LOOKUPS = """
VLOOKUP(A1,D1:G6,2)  VLOOKUP(A1,D1:G6,4,TRUE)  VLOOKUP(A1,D1:G6,3,FALSE)  VLOOKUP(A1,D1:G6,1,1)
VLOOKUP(A1,D1:G6,2.9,0)  VLOOKUP(A1,D1:G6,5)  VLOOKUP(A1,D1:G6,0)  VLOOKUP(A1,D1:G6,-1,0)  VLOOKUP(A1,D1:G6,1/0)
VLOOKUP(A1,E1:G6,2)  VLOOKUP(A1,G1:H6,2)  VLOOKUP(A1,G1:H6,2,FALSE)  VLOOKUP(A1,H1:H6,1)  VLOOKUP(A1,J1:K4,2)
VLOOKUP(A1,J1:K4,2,FALSE)  VLOOKUP(A1,K2:K4,1)  VLOOKUP(A1,K1:K4,1,FALSE)  HLOOKUP(A1,D11:G12,2)
HLOOKUP(A1,D11:G12,2,FALSE)  HLOOKUP(A1,D11:G12,3)  LOOKUP(A1,D1:D6,F1:F6)  LOOKUP(A1,D1:F6)  LOOKUP(A1,D11:G12)
LOOKUP(A1,D1:D4,D11:G11)  LOOKUP(A1,D1:D6)  LOOKUP(A1,D1:D6,E1:E3)  LOOKUP(A1,G1:G6,F1:F6)  XLOOKUP(A1,D1:D6,G1:G6)
XLOOKUP(A1,G1:G6,D1:D6)  XLOOKUP(A1,D1:D6,G1:G5)  XLOOKUP(A1,D11:G11,D12:G12)  MATCH(A1,D1:D6)  MATCH(A1,E1:E6,1)
MATCH(A1,H1:H6,-1)  MATCH(A1,F1:F6,-1)  MATCH(A1,G1:G6,0)  MATCH(A1,D1:E6)  MATCH(A1,H1:H6,1)  MATCH(A1,D1:D6,-1)
MATCH(A1,H1:H6,-7)  MATCH(A1,D1:D6,0.5)  MATCH(A1,D11:G11)  INDEX(E1:E6,MATCH(A1,D1:D6,1))
INDEX(D1:G6,MATCH(A1,D1:D6,0),3)  INDEX(E1:E3,MATCH(A1,D1:D6,1))  INDEX(D1:G6,MATCH(A1,D1:D6),9)
INDEX(D12:G12,MATCH(A1,D11:G11))  INDEX(D12:G12,MATCH(A1,D11:G11),1)  INDEX(K1:K4,MATCH(A1,D1:D4))
LEN(INDEX(J1:J4,MATCH(A1,D1:D4)))  INDEX(D1:G6,MATCH(A1,D1:D6),MATCH(A1,D11:G11))
IFERROR(VLOOKUP(A1,D1:G6,2,FALSE),-1)  IF(A1>5,VLOOKUP(A1,D1:G6,2),0)  SUM(VLOOKUP(A1,D1:G6,2),1)
"""


@pytest.mark.parametrize(("number", "formula"), [*enumerate(LOOKUPS.split())])
def test_every_lookup_finds_what_its_own_body_finds(trials, monkeypatch, number, formula):
    """In the compiled engine every third."""
    table = TABLE | MIXED | ROWS
    result = trials(table, formula, KEYS) if number % 3 == 0 else trials(table, formula, KEYS, ["numpy"])
    assert len({repr(answers) for answers in result.values()}) == 1, result
    with monkeypatch.context() as as_written:
        as_written.setattr(NumberLookups, "apply", lambda *_: None)
        assert trials(table, formula, KEYS, ["numpy"], constants=False) == {"numpy": result["numpy"]}


def searches(lower, cells, *targets):
    dag = lower(cells, ["A1", "A2"], targets)[0].dag
    return sum(isinstance(node, Apply) and node.function.name == POSITION.name for node in dag.nodes)


def test_lookups_of_one_key_in_one_column_share_the_search(lower):
    cells = {"A1": 12.0, "A2": 3.0, **TABLE, "B1": "=VLOOKUP(A1,D1:G6,2)", "B2": "=HLOOKUP(A1,TRANSPOSE(D1:G6),3)"}
    cells |= {"B3": "=INDEX(F1:F6,MATCH(A1,D1:D6,1))", "B4": "=LOOKUP(A1,D1:D6,G1:G6)", "B5": "=VLOOKUP(A2,D1:G6,2)"}
    assert searches(lower, cells, "B1", "B3", "B4") == 1
    assert searches(lower, cells, "B1", "B2", "B3", "B4", "B5") == 2


@pytest.mark.parametrize("key", ['A1&""', 'IF(A1>2,A2,"x")', "INDEX(D1:D6,A2)"])
def test_a_key_that_may_be_no_number_is_searched_as_it_was(lower, key):
    assert searches(lower, {"A1": 12.0, "A2": 3.0, **TABLE, "B1": f"=VLOOKUP({key},D1:G6,2)"}, "B1") == 0


def test_an_index_of_a_position_elsewhere_looks_at_each_cell(ways):
    """B1 is a position that a lookup gave, B2 one that may be 0 or too large: filled down, one formula takes both."""
    cells = {"A1": 25.0, "A2": 2.0, **TABLE, "B1": "=MATCH(A1,$D$1:$D$6)", "B2": "=A2*3"}
    formulas = [("C1", "INDEX($E$1:$E$6,B1)"), ("C2", "INDEX($E$1:$E$6,B2)"), ("C3", "INDEX($E$1:$E$6,B2+1)")]
    result = ways(cells, formulas, held=tuple(TABLE))
    assert result["constants"] == [0.0, 27.0, "#REF!"]
    assert len({repr(answers) for answers in result.values()}) == 1
