from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.graph.nodes import Constant
from xlmc.excel.address import Area, column_letters, parse_address
from xlmc.excel.workbook.workbook import CellContent, Formula

ROWS, COLUMNS = 102, 101  # more cells than are made nodes of their own
DATA = np.round(np.random.default_rng(3).normal(size=(ROWS, COLUMNS)), 3)
LAST = column_letters(COLUMNS)
K = f"K!$A$1:${LAST}${ROWS}"
ROW, COLUMN = f"B$1:{column_letters(COLUMNS + 1)}$1", f"$A2:$A{ROWS + 1}"
A1 = np.array([0.5, 2.0, -3.0])


def cells(formula, changed=()):
    """The matrix on sheet K; a varying row and a varying column beside A1; the formula at ZZ1."""
    made = {f"K!{column_letters(c + 1)}{r + 1}": float(DATA[r, c]) for r in range(ROWS) for c in range(COLUMNS)}
    made |= {f"{column_letters(c + 2)}1": f"=A$1*{c + 1}" for c in range(COLUMNS)}
    made |= {f"A{r + 2}": f"=A$1+{r}" for r in range(ROWS)}
    return made | {"ZZ1": f"={formula}"} | dict(changed)


def row(a):
    return a * np.arange(1, COLUMNS + 1)[None, :]


def column(a):
    return a + np.arange(ROWS)[:, None]


@pytest.mark.parametrize(
    ("formula", "products"),
    [
        (f"SUMPRODUCT({K}*A1)", lambda a: DATA * a),
        (f"SUMPRODUCT(A1*{K})", lambda a: a * DATA),
        (f"SUMPRODUCT(({K}>0.5)*{K}*A1)", lambda a: (DATA > 0.5) * DATA * a),
        (f"SUMPRODUCT(A1*({K}*({K}<0)*A1))", lambda a: a * DATA * (DATA < 0) * a),
        (f"SUMPRODUCT({K}/A1)", lambda a: DATA / a),
        (f"SUMPRODUCT(A1/({K}+9))", lambda a: a / (DATA + 9)),
        (f"SUMPRODUCT({K}*{ROW})", lambda a: DATA * row(a)),
        (f"SUMPRODUCT({ROW}/A1*{K})", lambda a: row(a) / a * DATA),
        (f"SUMPRODUCT({K}*{COLUMN})", lambda a: DATA * column(a)),
        (f"SUMPRODUCT(--({K}>1)*{COLUMN}*A1)", lambda a: (DATA > 1) * column(a) * a),
        (f"SUMPRODUCT((K!$A$1:$A${ROWS}>0)*{ROW})", lambda a: (DATA[:, :1] > 0) * row(a)),
    ],
)
def test_the_sum_is_that_of_all_products(run, lower, formula, products):
    outcome = run(cells(formula), {"A1": A1}, ["ZZ1"])
    for value, a in zip(outcome.forecasts[0], A1, strict=True):
        assert value == pytest.approx(products(a).sum(), rel=0, abs=1e-13 * np.abs(products(a)).sum())
    assert _largest(lower(cells(formula), ["A1"], ["ZZ1"])) <= max(ROWS, COLUMNS)


def test_a_row_and_a_column_that_both_vary_are_multiplied_out(run, lower):
    formula = f"SUMPRODUCT({K}*{ROW}*{COLUMN})"
    outcome = run(cells(formula), {"A1": A1}, ["ZZ1"])
    for value, a in zip(outcome.forecasts[0], A1, strict=True):
        products = DATA * row(a) * column(a)
        assert value == pytest.approx(products.sum(), rel=0, abs=1e-13 * np.abs(products).sum())
    assert _largest(lower(cells(formula), ["A1"], ["ZZ1"])) == ROWS * COLUMNS


def test_an_array_formula_sums_too(run):
    at = parse_address("S!ZZ1")
    formula = Formula(f"SUM({K}*A1)", at.row, at.column, array=Area("S", at.row, at.column, at.row, at.column))
    outcome = run(cells("0", {"ZZ1": CellContent(None, formula)}), {"A1": A1}, ["ZZ1"])
    assert outcome.forecasts[0] == pytest.approx(list(DATA.sum() * A1), rel=1e-12)


@pytest.mark.parametrize(
    ("formula", "changed", "values"),
    [
        (f"SUMPRODUCT({K}*ZZ2)", {"ZZ2": "=IF(A1>0,A1,NA())"}, [0.5, 2.0, "#N/A"]),
        (f"SUMPRODUCT({K}*ZZ2)", {"ZZ2": '=IF(A1>0,A1,"x")'}, [0.5, 2.0, "#VALUE!"]),
        (f"SUMPRODUCT({K}*ZZ2)", {"ZZ2": '=IF(A1>0,A1,"-3")'}, [0.5, 2.0, -3.0]),
        (f"SUMPRODUCT({K}*ZZ2)", {"ZZ2": "=IF(A1>0,A1,ZZ3)"}, [0.5, 2.0, 0.0]),
        (f"SUMPRODUCT({K}/ZZ2)", {"ZZ2": "=IF(A1>0,1/A1,0)"}, [0.5, 2.0, "#DIV/0!"]),
        (f"SUMPRODUCT({K}*A1)", {"K!B7": "x"}, ["#VALUE!"] * 3),
        (f"SUMPRODUCT({K}*A1)", {"K!B7": "=1/0"}, ["#DIV/0!"] * 3),
        (f"SUMPRODUCT({K}*A1)", {"K!C1:C2": None}, [0.5, 2.0, -3.0]),
    ],
)
def test_errors_texts_and_blanks_are_excels(run, formula, changed, values):
    made = cells(formula, [each for each in changed.items() if each[1] is not None])
    total = DATA.sum()
    if None in changed.values():
        del made["K!C1"], made["K!C2"]
        total -= DATA[:2, 2].sum()
    expected = [value if isinstance(value, str) else pytest.approx(value * total, rel=1e-12) for value in values]
    assert run(made, {"A1": A1}, ["ZZ1"]).forecasts[0] == expected


def test_a_product_that_overflows_is_an_error_though_the_sum_would_not(run):
    made = cells(f"SUMPRODUCT({K}*A1)", {"K!A1": 1e200, "K!B1": -1e200})
    smaller = DATA.sum() - DATA[0, 0] - DATA[0, 1]
    first, second, third = run(made, {"A1": [1e-200, 1e150, -1e150]}, ["ZZ1"]).forecasts[0]
    assert (second, third) == ("#NUM!", "#NUM!")
    assert first == pytest.approx(smaller * 1e-200, abs=1e-13)


def test_constants_that_cancel_one_after_the_other_give_nothing(run):
    """They are added from left to right, as Excel adds the products."""
    pairs = {
        f"K!{column_letters(c + 1)}{r + 1}": 0.1 * (r + c // 2 + 1) * (-1) ** c
        for r in range(ROWS)
        for c in range(COLUMNS - 1)
    }
    last = {f"K!{LAST}{r + 1}": 0.0 for r in range(ROWS)}
    assert run(cells(f"SUMPRODUCT({K}*A1)", pairs | last), {"A1": A1}, ["ZZ1"]).forecasts[0] == [0.0] * 3


def test_whole_columns_stay_what_they_are(run):
    made = cells(f"SUMPRODUCT((K!$A:$A>0)*K!$A:${LAST}*A1)")
    expected = ((DATA[:, :1] > 0) * DATA).sum() * A1
    assert run(made, {"A1": A1}, ["ZZ1"]).forecasts[0] == pytest.approx(list(expected), rel=1e-12)


def _largest(lowered):
    """The most cells of a varying array that the targets need."""
    lowering, targets = lowered
    dag = lowering.dag
    needed = dag.upstream([lowering.target(target) for target in targets])
    sizes = [dag.sizes[node] or (1, 1) for node in needed if not isinstance(dag.nodes[node], Constant)]
    return max(rows * columns for rows, columns in sizes)
