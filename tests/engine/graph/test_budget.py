"""Formulas that ask for too much are refused with their cell, or take little: each in a process of bounded memory."""

from __future__ import annotations

import os
import sys
import traceback

import numpy as np
import pytest

from xlmc.engine.llvm.program import JitProgram
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.tracking import TrackingEvaluator
from xlmc.errors import XlmcError

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork and limits of memory")

MORE_MEMORY = 1_000_000_000
"""Bytes."""


def down(column, first, last, formula):
    return {f"{column}{row}": formula.format(r=row, p=row - 1) for row in range(first, last + 1)}


RUNS = {
    "a sum of a million constants": {"Z1": "=SUM(SEQUENCE(1000000))+A1"},
    "a sum of 300,000 numbers that vary": {"Z1": "=SUM(SEQUENCE(300000,1,A1))"},
    "an outer product that varies": {"Z1": "=SUMPRODUCT(SEQUENCE(500)*SEQUENCE(1,500)*A1)"},
    "a size that varies": {"Z1": "=SUM(SEQUENCE(INT(A1*200000)))"},
    "a text that doubles in each cell": {"B1": "a"}
    | down("B", 2, 99, "=B{p}&B{p}")
    | {"Z1": "=IFERROR(LEN(B99),0)+A1"},
    "a text that varies and doubles": {"B1": "=A1&0"}
    | down("B", 2, 99, "=B{p}&B{p}")
    | {"Z1": "=IFERROR(LEN(B99),A1)"},
    "REDUCE that doubles a text": {"Z1": '=IFERROR(LEN(REDUCE(A1&"a",SEQUENCE(60),LAMBDA(p,q,p&p))),A1)'},
    "a text joined of 1,360": {"Z1": "=LEN(" + "&".join(["A1"] * 1360) + ")"},
    "a number that doubles in each of 2,000 cells": down("A", 2, 2000, "=A{p}+A{p}") | {"Z1": "=IFERROR(A2000,A1)"},
    "2,000 sums of one column": down("B", 1, 1000, "=A$1*{r}") | down("C", 1, 2000, "=SUM(B:B)") | {"Z1": "=SUM(C:C)"},
    "running sums": down("B", 1, 1000, "=A$1*{r}") | down("C", 1, 1000, "=SUM($B$1:$B{r})") | {"Z1": "=SUM(C:C)"},
    "a column with a cell far down": {"B1": 1.0, "B65536": 2.0, "Z1": "=SUM(B1:B65536)+A1"},
    "the rest of a sheet": {
        "B1": 1.0,
        "Z2": '=SUM(INDIRECT("B1:Y1048576"))+SUM(OFFSET(B2,0,0,1048575,9))',
        "Z1": "=Z2+A1",
    },
    "a sheet by INDIRECT": {"Z1": '=SUM(INDIRECT("A2:XFC1048575"))+A1'},
    "a sheet by OFFSET": {"Z1": "=SUM(OFFSET(A2,0,0,1048574,16383))+A1"},
    "calls of the same twice": {"Z1": "=LET(f,LAMBDA(f,n,IF(n=0,A1,f(f,n-1)+f(f,n-1))),f(f,50))"},
    "a sheet": {"Z1": "=SUM(A2:XFC1048575)+A1"},
}

MORE_MEMORY_OF = {
    "a sum of 300,000 numbers that vary": 300_000_000,
    "an outer product that varies": 250_000_000,
    "2,000 sums of one column": 100_000_000,
    "running sums": 45_000_000,
    "a column with a cell far down": 250_000_000,
}
"""Bytes of some runs, 300 to a number of an array, 50 to a cell that a formula reads, 4,000 to a cell of a column."""

REFUSED = {
    "SEQUENCE of a sheet": ("=SUM(SEQUENCE(1048576,16384))+A1", "1,048,576 rows and 16,384 columns"),
    "an outer product": ("=SUMPRODUCT(SEQUENCE(1,9999)*SEQUENCE(99999))+A1", "99,999 rows and 9,999 columns"),
    "MMULT": ("=SUM(MMULT(SEQUENCE(100000),SEQUENCE(1,9999)))+A1", "100,000 rows and 9,999 columns"),
    "MMULT of many steps": ("=SUM(MMULT(SEQUENCE(2000,2000),SEQUENCE(2000,2000)))+A1", "8,000,000,000 steps"),
    "MUNIT": ("=SUM(MUNIT(16384))+A1", "16,384 rows and 16,384 columns"),
    "EXPAND": ("=SUM(EXPAND(A1,1048576,1000,0))", "1,048,576 rows and 1,000 columns"),
    "HSTACK": ("=SUM(HSTACK(" + ",".join(["SEQUENCE(99999)"] * 99) + "))+A1", "cells"),
    "a doubling array": ("=SUM(REDUCE(A1,SEQUENCE(60),LAMBDA(p,q,VSTACK(p,p))))", "cells"),
    "MAKEARRAY": ("=SUM(MAKEARRAY(1000,1000,LAMBDA(r,c,r*c)))+A1", "LAMBDAs more than 100,000 times"),
    "calls that call twice": ("=LET(f,LAMBDA(f,n,IF(n<2,A1,f(f,n-1)+f(f,n-2))),f(f,50))", "steps"),
    "a formula of 60,000 characters": ("=" + "+".join(["A1"] * 20_000), "Excel takes 8,192"),
    "as many texts": ("=SUM(LEN(SEQUENCE(1000000,4)&A1))", "texts in one array"),
}


def outcome(work, more_memory=MORE_MEMORY):
    """What `work` returns, or the message it raises, in a process that may take so much more memory than this one."""
    import resource

    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        text = "failed"
        try:
            with (
                open("/proc/self/statm", encoding="utf-8")
                if sys.platform == "linux"
                else open(os.devnull, encoding="utf-8") as file
            ):
                now = int((file.read().split() or ["0"])[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (now + more_memory, resource.RLIM_INFINITY))
            resource.setrlimit(resource.RLIMIT_CPU, (120, 120))
            text = str(work())
        except XlmcError as error:
            text = str(error)
        except BaseException:
            text = traceback.format_exc()
        finally:
            os.write(writer, text[-4000:].encode())
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        text = pipe.read().decode()
    os.waitpid(child, 0)
    return text


def answer(book, cells):
    """The mean of Z1 over 8 trials of A1, between 1 and 2."""
    model = book({"A1": 1.5} | cells, {"x": {"cell": "A1", "low": 1.0, "high": 2.0}}, {"f": "Z1"})
    return float(np.nanmean(model.function({"x": np.linspace(1.0, 2.0, 8)})["f"]))


@pytest.mark.parametrize("name", RUNS)
def test_what_excel_computes_takes_bounded_memory(book, name):
    more = MORE_MEMORY_OF.get(name, MORE_MEMORY)
    assert np.isfinite(float(outcome(lambda: answer(book, RUNS[name]), more)))


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_too_large_is_refused_with_its_cell(book, name, monkeypatch):
    monkeypatch.setattr("xlmc.engine.graph.recursive_calls.MOST_STEPS", 1_000)  # so that it takes no second
    if name == "a doubling array":
        monkeypatch.setattr("xlmc.excel.functions.budget.MOST_CELLS", 1 << 18)
    formula, sentence = REFUSED[name]
    message = outcome(lambda: answer(book, {"Z1": formula}))
    assert message.startswith("S!Z1: "), message
    assert sentence in message


SHEETS = ['=SUM(INDIRECT("A2:XFC1048575"))+A1', "=SUM(OFFSET(A2,0,0,1048574,16383))+A1", "=SUM(A2:XFC1048575)+A1"]


@pytest.mark.parametrize("formula", SHEETS)
def test_a_sheet_that_is_filled_to_its_end_is_refused(book, formula):
    message = outcome(lambda: answer(book, {"Z1": formula, "XFC1048575": 1.0}))
    assert message.startswith("S!Z1: "), message
    assert "1,048,574 rows and 16,383 columns" in message


def test_the_values_of_large_constants(run):
    cells = {"Z1": "=SUM(SEQUENCE(1000000))+A1", "Z2": '=LEN(REPT("a",32767)&"b")', "Z3": '=LEN(REPT("a",32766)&"b")'}
    outcome = run(cells, {"A1": [1.0]}, ["Z1", "Z2", "Z3"])
    assert outcome.forecasts[0] == [500_000_500_001.0]
    assert outcome.forecasts[2] == [32767.0]
    assert outcome.forecasts[1] != [32768.0]


def test_portions_of_a_block_give_the_numbers_of_the_whole(lower, monkeypatch):
    cells = {"Z1": "=IF(A1>0.5,SUM(SEQUENCE(100,1,A1)),1/0)", "Z2": '=LEN(A1&"x")+Z1', "Z3": "=A1<0.9"}
    lowering, targets = lower(cells, ["A1"], ["Z3", "Z1", "Z2"])
    nodes = [lowering.target(target) for target in targets]
    draws = {"A1": np.random.default_rng(3).uniform(size=200)}
    survivors = np.flatnonzero(draws["A1"] < 0.9)

    def columns():
        evaluator = TrackingEvaluator(lowering.dag, nodes[:1], nodes[1:])
        result = [*evaluator.filters(draws, 200), *evaluator.forecasts(survivors)]
        return [(c.values.tolist(), None if c.codes is None else c.codes.tolist()) for c in result], evaluator._portion

    whole, portion = columns()
    assert portion > 200
    monkeypatch.setattr("xlmc.excel.functions.budget.MOST_LIVE", 20_000)
    parts, portion = columns()
    assert portion < 200
    assert parts == whole


@pytest.mark.parametrize(("rows", "block"), [(10, 32768), (100_000, 64), (1_000_000, 8)])
def test_a_block_holds_the_fewer_trials_the_larger_its_arrays_are(lower, rows, block):
    lowering, targets = lower({"Z1": f"=SUM(SEQUENCE({rows},1,A1))"}, ["A1"], ["Z1"])
    assert NumpyProgram.of(lowering, targets, [], frozenset()).largest_block == block


@pytest.mark.parametrize("program", [NumpyProgram.of, JitProgram])
def test_a_range_that_is_folded_cell_by_cell_takes_no_array(lower, program):
    cells = {f"A{row}": f"=A{row - 1}*1.001+A1" for row in range(2, 400)}
    lowering, targets = lower({**cells, "Z1": "=SUM(A2:A399)"}, ["A1"], ["Z1"])
    assert program(lowering, targets, [], frozenset()).largest_block >= 1 << 15


@pytest.mark.parametrize(("cells", "block"), [(1, 64), (600, 64)])
def test_single_numbers_take_no_room_of_arrays(lower, cells, block):
    numbers = {f"B{row}": f"=A1+{row}" for row in range(1, cells + 1)}
    total = f"=SUM(SEQUENCE(100000,1,A1))+SUM(B1:B{cells})"
    lowering, targets = lower({**numbers, "Z1": total}, ["A1"], ["Z1"])
    assert NumpyProgram.of(lowering, targets, [], frozenset()).largest_block == block
