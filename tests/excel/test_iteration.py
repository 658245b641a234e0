from __future__ import annotations

from xlmc.excel.iteration import Iteration


def test_a_workbook_that_says_no_more_has_the_numbers_of_excel():
    """100 iterations and a change of 0.001: the defaults of `calcPr` (ECMA-376, 18.2.2)."""
    assert Iteration() == Iteration(count=100, change=0.001)
