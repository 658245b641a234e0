"""Functions that only `formulas` has are computed by it, trial by trial, and the person is told."""

from __future__ import annotations

import numpy as np


def test_a_function_of_formulas(book):
    cells = {"A1": 1.0, "B1": '=IF(REGEXTEST("v"&ROUND(A1,0),"v[0-4]"),1,2)'}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"answer": "B1"})
    got = model.function({"a": np.array([0.0, 4.0, 5.0, 9.0])})["answer"]
    assert got.tolist() == [1.0, 1.0, 2.0, 2.0]
    (notice,) = model.notices
    assert "REGEXTEST is computed by the formulas package, trial by trial" in notice.message
    assert str(notice.where) == "S!B1"


def test_a_constant_range_and_a_varying_number(book):
    cells = {"A1": 7.0, **{f"C{i}": float(i) for i in range(1, 7)}, "B1": "=_xlfn.PERCENTOF(A1,C1:C6)"}
    model = book(cells, {"a": {"cell": "A1", "low": 7, "high": 9}}, {"answer": "B1"})
    assert model.function({"a": [2.1, 4.2, 21.0]})["answer"].tolist() == [0.1, 0.2, 1.0]
