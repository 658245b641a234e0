from __future__ import annotations

import numpy as np
import pytest

from xlmc.compile.running import RunningTotals


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


@pytest.mark.parametrize("range_", ["B$1:B{r}", "B{r}:B$40", "$A$1:B{r}", "OFFSET(B$1,0,0,{r},1)"])
@pytest.mark.parametrize("name", FOLDS)
def test_filled_down_each_function_gives_what_it_gives_alone(run, name, range_):
    column = {f"B{row}": f"=A$1*{row}/7" for row in range(1, 41) if row != 30} | CONTENTS
    formulas = {f"C{r}": f"={name}({range_.format(r=r)})" for r in range(15, 31)}
    draws = {"A1": [0.3, 1.7, 2.0]}
    together = run(column | formulas, draws, list(formulas)).forecasts
    for at in (0, 1, 6, 8, 15):
        cell = [*formulas][at]
        assert run(column | {cell: formulas[cell]}, draws, [cell]).forecasts == [together[at]]
