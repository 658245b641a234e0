"""Choices between ranges of different sizes: what varies gives, trial by trial, what it gives where it is known."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engines import ENGINES
from xlmc.engine.graph.arrays import MOST_OUTCOMES
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {"B1": 1.0, "C1": 2.0, "D1": 3.0, "B2": 10.0, "C2": 20.0, "D2": 30.0}
DRAWS = [-1.0, 0.0, 1.0, 2.0, 3.0, np.nan]

FORMULAS = [
    "SUM(IF(A1>0,5,B1:D1))",
    "SUM(IF(A1>0,B1:D1,5))",
    "SUM(IF(A1>0,B1:C1,B1:D2))",
    "AVERAGE(IF(A1>0,B1:C1,B1:D2),IF(A1>1,B1:D1,7))",
    "SUM(CHOOSE(A1,B1,B1:C1,B1:D2))",
    "COUNT(CHOOSE(A1,B1,B1:C1,B1:D2))",
    "SUM(IFS(A1>2,B1:C1,A1>0,B1:D2,TRUE,4))",
    "SUM(SWITCH(A1,1,B1:C1,2,B1:D2,4))",
    "SUM(IFERROR(1/A1,B1:D1))",
    "SUM(IFNA(1/A1,B1:D1))",
    "SUM(IF(A1>0,IF(A1>1,B1:D1,B1:C1),B1:D2))",
    "IFERROR(SUM(IF(1/A1>0,B1:D1,7)),-1)",
    "ISERROR(IF(1/A1>0,B1:D1,7))*1",
    "SUM(IF(1/A1>0,B1:D1,7),1)",
    "SUMPRODUCT(IF(A1>0,B1:D1,B1:C1),IF(A1>0,B2:D2,B2:C2))",
    "INDEX(IF(A1>0,B1:D1,B2:C2),3)",
    "MATCH(20,IF(A1>0,B1:C1,B2:D2),0)",
    "LARGE(IF(A1>0,B1:C1,B2:D2),2)",
    'TEXTJOIN(",",TRUE,IF(A1>0,B1:C1,B2:D2))="1,2"',
]
ARRAYS = [
    "SUM(IF(A1>0,B1:D1,5)*2)",
    "SUM(IF(A1>0,B1:D1,5)*B2:D2)",
    "IF(A1>0,B1:D1,5)",
    "COLUMNS(IF(A1>0,B1:D1,5)+{1;2})",
    "SUM(TRANSPOSE(IF(A1>0,B1:D1,B1:C2)))",
    "SUM(IF(IF(A1>0,B1:D1,5)>1,1,0))",
    "SUM(IF(A1>0,FILTER(B1:D1,B1:D1>A1,9),4))",
    "+".join(f"SUM(IF(A1>{i},B1:D1,{i})*IF(A1>{i + 1},B1:D1,B1:C1))" for i in range(3)),
    "SUM(" + "+".join(f"IF(A1>{i % 3},B1:D1,{i})" for i in range(8)) + ")",
]


def known(lower, formula, draw):
    cells = CELLS | {"A1": CellContent(ErrorCode.NUM if np.isnan(draw) else draw), "Z9": formula}
    lowering, (target,) = lower(cells, {}, ["Z9"])
    item = lowering.known(target).objects().ravel()[0]
    return item.text if isinstance(item, ErrorCode) else float(item)


def array(text):
    return CellContent(None, Formula(text, 9, 26, Area("S", 9, 26, 9, 26)))


@pytest.mark.parametrize("formula", [*(f"={text}" for text in FORMULAS), *map(array, ARRAYS)], ids=FORMULAS + ARRAYS)
def test_each_trial_has_its_own_size(run, lower, formula):
    """The compiled engine does the same with those that are no array formulas."""
    outcome = run(CELLS | {"A1": 0.0, "Z9": formula}, {"A1": DRAWS}, ["Z9"])
    expected = [known(lower, formula, draw) for draw in DRAWS]
    assert outcome.forecasts[0] == expected
    assert not isinstance(formula, str) or compiled(lower, formula) == expected


def compiled(lower, formula):
    cells = CELLS | {"A1": 0.0, "Z9": formula}
    lowering, targets = lower(cells, {"A1": DRAWS}, ["Z9"])
    (column,) = (
        ENGINES["jit"].load()(lowering, targets, [], frozenset({"A1"})).evaluator(6).filters({"A1": np.array(DRAWS)}, 6)
    )
    codes = np.zeros(6, int) if column.codes is None else column.codes
    return [ErrorCode(int(c)).text if c else float(v) for v, c in zip(column.values, codes, strict=True)]


def test_sums_of_choices_stay_on_the_fast_path(run):
    cells = CELLS | {"A1": 0.0, "Z9": "=SUM(IF(A1>0,B1:D1,5))"}
    assert not run(cells, {"A1": DRAWS[:-1]}, ["Z9"]).careful


def test_many_choices_together_are_not_written_out(lower):
    text = "SUM(" + "+".join(f"IF(A1>{i},B1:D1,{i})" for i in range(40)) + ")"
    lowering, _ = lower(CELLS | {"A1": 0.0, "Z9": array(text)}, ["A1"], ["Z9"])
    assert len(lowering.dag.nodes) < 40 * MOST_OUTCOMES


@pytest.mark.parametrize("formula", ["=ISREF(INDEX(B1:D1,A1))", "=ISREF(IF(A1>0,B1,5))", "=ISREF(CHOOSE(A1,B1,5))"])
def test_whether_a_varying_choice_is_a_reference_is_refused(lower, formula):
    with pytest.raises(FormulaError, match="varies"):
        lower(CELLS | {"A1": 0.0, "Z9": formula}, ["A1"], ["Z9"])


# B1 is empty, C1 a text, and so on: a range has none of these as numbers, whichever trial it is chosen in
CELLS_OF_REFERENCES = {"A1": 1.0, "C1": "10", "D1": 7.0, "B2": 6.0, "D2": "y"}


@pytest.mark.parametrize(
    ("formula", "answers"),
    [
        ("AVERAGE(IF(A1>1,B1:D1,B2:D2))", [6.0, 7.0, 7.0]),
        ("COUNTA(CHOOSE(A1,B1:D1,B2:D2,B1))", [2.0, 2.0, 0.0]),
        ("AVERAGE(IF(A1>1,B1,2),4)", [3.0, 4.0, 4.0]),
        ("AVERAGE(IF(A1>1,B1),4)", [2.0, 4.0, 4.0]),
        ("SUM(INDEX(B1:D1,A1),1)", [1.0, 1.0, 8.0]),
        ("COUNT(XLOOKUP(A1,{1,2,3},B1:D1))", [0.0, 0.0, 1.0]),
    ],
)
def test_a_reference_that_varies_has_the_empty_cells_and_texts_of_a_range(trials, formula, answers):
    for result in trials(CELLS_OF_REFERENCES, formula, [1.0, 2.0, 3.0]).values():
        assert result == answers
