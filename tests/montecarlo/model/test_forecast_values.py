from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engine import TEXT_RESULT, Column
from xlmc.montecarlo.model.forecast_values import are_texts

CELLS = {"A1": 1.0, "A2": 1.0, "A3": 0.0, "A4": 2.0}


@pytest.mark.parametrize(
    ("formula", "two"),
    [
        ("=A1>0.5", True),
        ("=NOT(A1>0.5)", True),
        ("=IF(A1>0.5,1,0)", True),
        ("=IF(A1>0.5,A2,A3)", True),
        ("=IF(A1>0.5,1,IF(A1>0.2,0,1))", True),
        ("=IF(A1>0.5,1,IF(A1>0.2,0,2))", False),
        ("=IF(A1>0.5,1,2)", False),
        ("=IF(A1>0.5,1,A1)", False),
        ('=IF(A1>0.5,1,"x")', False),
        ("=IF(A1>0.5,1,A1>0.2)", True),
        ("=IF(A1>0.5,A1>0.7,0)", True),
        ("=IF(A1>0.5,1)", True),
        ("=IF(A1>0.5,B2,0)", True),
        ("=IF(A1>0.5,1,A9)", True),  # a blank cell gives 0
        ("=IF(A1>0.5,1,NA())", True),
        ("=IFERROR(IF(A1>0.5,1,0),0)", True),
        ("=IFERROR(IF(A1>0.5,1,0),2)", False),
        ("=CHOOSE(1+(A1>0.5),0,1)", True),
        ("=CHOOSE(1+(A1>0.5),0,2)", False),
        ("=IFS(A1>0.5,1,A1>0.2,FALSE)", True),
        ("=(A1>0.2)*(A1<0.5)", True),
        ("=(A1>0.2)*(A1<0.5)*2", False),
        ("=(A1>0.2)*A1", False),
        ("=--(A1>0.5)", True),
        ("=-(A1>0.5)", False),
        ("=-(-A1)", False),
        ("=(A1>0.2)+(A1<0.5)", False),  # 0, 1 or 2
        ("=MAX(A1>0.9,A1<0.1)", True),
        ("=MAX(A1>0.9,A1)", False),
        ("=N(A1>0.5)", True),
        ("=NA()", False),
        ("=A1", False),
        ("=A1*0", False),
        ("=A2", False),  # a number known before the run
        ("=A3", False),
        ("=SUM(A2,A3)", False),
    ],
)
def test_formulas_of_two_values(book, formula, two):
    model = book({**CELLS, "B1": formula, "B2": "=A1>0.6"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"})
    assert model.two_valued == (frozenset({"x"}) if two else frozenset())


@pytest.mark.parametrize(
    ("formula", "texts"),
    [
        ('=IF(A1>0.5,"slid","held")', True),
        ('=IF(A1>0.5,"slid",1)', False),
        ('=IF(A1>0.5,"slid","")', True),
        ('=IF(A1>2,"slid","")', False),  # empty in every trial
        ('=IF(A1>0.5,"slid",1/0)', True),  # an error is no number
        ("=A1", False),
        ("=A1>0.5", False),
        ('="slid"', True),
    ],
)
def test_formulas_of_texts(book, formula, texts):
    model = book(
        {**CELLS, "B1": formula, "B2": "=A1*2"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"y": "B2", "x": "B1"}
    )
    assert model.categories == ((1,) if texts else ())


def test_columns_of_numbers_alone_are_no_texts():
    assert not are_texts(Column(np.zeros(3)))
    codes = np.full(3, TEXT_RESULT, np.uint8)
    assert are_texts(Column(np.zeros(3), codes, np.array(["a", "", "b"], object)))
    assert not are_texts(Column(np.zeros(3), codes, np.array(["", "", ""], object)))
    codes[1] = 0
    assert not are_texts(Column(np.zeros(3), codes, np.array(["a", "", "b"], object)))
