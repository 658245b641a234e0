"""Texts that are dates, as numbers, in workbooks whose days count from 1904: 1,462 less than from 1900."""

from __future__ import annotations

import pickle

from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.registry import from_1904

DAY = 42_369.0
"""1 January 2020."""
CELLS = {"A1": 3.0, "B1": "2020-01-01", "B2": "2020-01-02", "C1": DAY}
FORMULAS = {
    'A1+"2020-01-01"': DAY + 3,
    "A1+B1": DAY + 3,
    '-"2020-01-01"': -DAY,
    'SUM("2020-01-01",A1)': DAY + 3,
    "SUM(B1:B2,A1)": 3.0,  # texts in cells do not count
    "SUMPRODUCT(--(B1:B2))+A1": 2 * DAY + 4,
    'YEAR("2020-01-01")+A1': 2_023.0,
    'YEAR("2020-01-0"&A1)': 2_020.0,  # a text that varies
    'EOMONTH("2020-01-0"&A1,0)': DAY + 30,
    'A1+IF(A1>0,B1,"x")': DAY + 3,
    'VALUE("2020-01-01")=A1+42366': 1.0,
    'COUNTIF(C1,"2020-01-01")': 1.0,
    'A1+"12:00"': 3.5,
    'A1&"2020-01-01"=A1&B1': 1.0,
}


def test_every_use_of_a_text_as_a_number_reads_it_by_the_calendar_of_the_workbook(ways):
    for way, result in ways(CELLS, list(FORMULAS), date1904=True).items():
        assert dict(zip(FORMULAS, result, strict=True)) == FORMULAS, way
    for way, result in ways(CELLS, ["A1+B1"]).items():
        assert result == [DAY + 1_462 + 3], way


def test_a_function_of_such_a_workbook_can_be_sent_to_another_process():
    row = from_1904(REGISTRY["+"])
    assert pickle.loads(pickle.dumps(row)) is row
