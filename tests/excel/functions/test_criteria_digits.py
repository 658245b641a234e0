"""Criteria see 15 digits of a number: a text that a formula joins holds no more of it."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated

DRAWN = {f"a{row}": {"cell": f"A{row}", "low": 0, "high": 1} for row in range(1, 6)}
CELLS = {f"A{row}": 0.1 * row for row in range(1, 6)}
RANKS = {
    "COUNTIF": 'COUNTIF(A$1:A$5,">"&A{r})+1',
    "COUNTIFS": 'COUNTIFS(A$1:A$5,">="&A{r})',
    "SUMPRODUCT of <=": '6-COUNTIF(A$1:A$5,"<="&A{r})',
    "equal": 'COUNTIF(A$1:A$5,"="&A{r})*3',
    "equal to a number": "COUNTIF(A$1:A$5,A{r})*3",
    "unequal": '(6-COUNTIF(A$1:A$5,"<>"&A{r}))*1.5',
}


@pytest.mark.parametrize("engine", ["numpy", "jit"])
@pytest.mark.parametrize("formula", RANKS.values(), ids=[*RANKS])
def test_five_ranks_sum_to_15_in_every_trial(book, formula, engine):
    ranks = {f"B{row}": f"={formula.format(r=row)}" for row in range(1, 6)}
    model = book(CELLS | ranks | {"C1": "=SUM(B1:B5)"}, DRAWN, {"sum": "C1"})
    values = simulated(model, 500, seed=3, engine=engine).forecasts["sum"]
    np.testing.assert_array_equal(values, 15.0)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ('SUMIF(D1:D3,"="&D1,E1:E3)', 1.0),
        ('SUMIFS(E1:E3,D1:D3,"<"&D2)', 1.0),
        ('AVERAGEIFS(E1:E3,D1:D3,">"&D1)', 4.0),
        ('AVERAGEIF(D1:D3,"<="&D2,E1:E3)', 2.0),
        ('MAXIFS(E1:E3,D1:D3,"<"&D3)', 3.0),
        ('MINIFS(E1:E3,D1:D3,">"&D2)', 5.0),
        ('COUNTIF(D1:D3,"<"&PERCENTILE(D1:D3,0.5))', 1.0),
        ('DSUM(G1:H4,"e",J1:J2)', 8.0),
        ('DCOUNT(G1:H4,"e",J1:J2)', 2.0),
    ],
)
def test_both_sides_have_15_digits(book, formula, expected):
    """Each number has 17 digits, and is not below or above the text of itself."""
    numbers = (3.8185309649543897, 4.1234567890123456, 5.9876543210987654)
    cells = {f"D{row}": number for row, number in enumerate(numbers, 1)} | {"E1": 1.0, "E2": 3.0, "E3": 5.0}
    cells |= {"G1": "d", "H1": "e", "J1": "d", "J2": '=">"&D1'}
    cells |= {
        f"{column}{row + 1}": f"={source}{row}" for row in (1, 2, 3) for column, source in (("G", "D"), ("H", "E"))
    }
    model = book(cells | {"A1": 0.5, "C1": f"={formula}+0*A1"}, {"a": DRAWN["a1"]}, {"x": "C1"})
    np.testing.assert_array_equal(simulated(model, 5).forecasts["x"], expected)
