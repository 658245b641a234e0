from __future__ import annotations

import numpy as np
import pytest

from xlmc.address import Area
from xlmc.compile.formulas_engine import FormulasProgram
from xlmc.compile.numpy_engine import NumpyProgram
from xlmc.errors import FormulaError
from xlmc.workbook.model import CellContent, Formula

HELD = {"B1": 2.0, "B2": "x", "B4": True, "B5": "2", "B6": -0.5, "Data!A1": 7.0, "Data!A2": 8.0}

RIGHT = [
    # where `formulas` is no oracle (DESIGN §4) is left out: 0^0, SIN beyond 2^27, …; the seam's repairs are in
    "A1+A2*3-A1/A2",
    "A1^2+A2^0.5",
    "-A1^2",
    "--A1",
    "5%%*A1",
    "1E20*A1+1E-20",
    "A1%+A2",
    "A1>A2",
    "(A1>=A2)+(A1<>A2)*2",
    'A1&"x"&A2>"1"',
    "IF(A1>1.5,A2,-A2)",
    "IF(A1>1.5,1/(A1-1.5),SQRT(1.5-A1))",
    "IFERROR(SQRT(A1-1.5),-1)",
    "IFERROR(IF(A1>1.7,LN(-A1),A2),9)",
    "AND(A1>1.2,A2>1.2)+OR(A1>1.8,A2>1.8)*2+NOT(A1>1.5)*4",
    "SUM(A1:A2,B1,3)+MAX(A1:B1)-MIN(A1:A2,1.5)",
    "SUM(A1:B4)",
    "AVERAGE(A1:A2)*COUNT(A1:B4)",
    "SUM(Data!A1:A2)*A1",
    "SUM(Data!A1:Data!A2)*A1",
    "SIN(A1)+COS(A2)+TAN(A1/2)+ATAN(A2)+ASIN(A1/2)+ACOS(A2/2)",
    "ATAN2(A1,A2)+ATAN2(-A1,A2)",
    "RADIANS(A1)+DEGREES(A2)+PI()",
    "SQRT(A1)+EXP(A2)+LN(A1)+LOG10(A2)+LOG(A1,3)+ABS(-A2)+SIGN(-A1)",
    "ROUND(A1,2)+INT(A2*10)+MOD(A1*10,3)+ROUNDUP(A1,1)+ROUNDDOWN(A2,1)+TRUNC(A1)",
    "SQRT(A1-1.5)",
    "LN(A1-1.5)+1",
    "1/(ROUND(A1,0)-1)",
    "B2+A1",
    "B3+A1",
    "B4+A1",
    "B5*A1",
    "Rate*A1",
    "Data!Rate*A1",
]


@pytest.fixture
def both(lower):
    """The columns of both engines, filters then forecasts, of 30 trials."""

    def run(cells, filters, forecasts):
        generator = np.random.default_rng(7)
        draws = {"A1": generator.uniform(1, 2, 30), "A2": generator.uniform(1, 2, 30)}
        names = {"Rate": "S!$B$1", "Data!Rate": "Data!$A$1"}
        lowering, targets = lower(HELD | cells, ["A1", "A2"], [*filters, *forecasts], names=names)
        split = targets[: len(filters)], targets[len(filters) :]
        columns = []
        for engine in (NumpyProgram, FormulasProgram):
            evaluator = engine(lowering, *split, frozenset()).evaluator(30)
            early = [(c.as_floats(), c.codes) for c in evaluator.filters(draws, 30)]
            survivors = np.flatnonzero(
                np.logical_and.reduce([np.ones(30, bool), *(values == 1 for values, _ in early)])
            )
            columns.append(early + [(c.as_floats(), c.codes) for c in evaluator.forecasts(survivors)])
        return columns

    return run


@pytest.mark.parametrize("formula", RIGHT)
def test_both_engines_agree(both, formula):
    ours, theirs = both({"C1": "=A1*1.01", "Z9": f"={formula}", "Z8": "=Z9+C1", "D1": "=C1>1.2"}, ["D1"], ["Z9", "Z8"])
    for (values, codes), (expected, their_codes) in zip(ours, theirs, strict=True):
        assert values == pytest.approx(expected, rel=1e-12, nan_ok=True)
        assert np.array_equal(
            np.zeros(values.size) if codes is None else codes,
            np.zeros(values.size) if their_codes is None else their_codes,
        )


def test_a_draw_that_is_an_error(lower):
    lowering, (target,) = lower({"C1": "=IFERROR(A1,-1)"}, ["A1"], ["C1"])
    evaluator = FormulasProgram(lowering, [target], [], frozenset({"A1"})).evaluator(2)
    (column,) = evaluator.filters({"A1": np.array([np.nan, 3.0])}, 2)
    assert column.as_floats().tolist() == [-1.0, 3.0]


def test_saved_and_held_values_stand_in_here_too(lower):
    cells = {"B1": ("=MYFUNC(2)", 42.0), "C1": "=B1+A1+A2"}
    lowering, (target,) = lower(cells, ["A1"], ["C1"], held={"A2": 0.5})
    (column,) = FormulasProgram(lowering, [target], [], frozenset()).evaluator(1).filters({"A1": np.array([1.0])}, 1)
    assert column.as_floats().tolist() == [43.5]


def test_what_formulas_cannot_compute_is_told_of_its_cell(lower):
    lowering, (target,) = lower({"C1": "=SUM((A1,A2))"}, ["A1", "A2"], ["C1"])
    draws = {"A1": np.array([2.0]), "A2": np.array([3.0])}
    with pytest.raises(FormulaError, match="the engine `formulas` cannot compute this") as caught:
        FormulasProgram(lowering, [target], [], frozenset()).evaluator(1).filters(draws, 1)
    assert caught.value.where == "S!C1"


def test_array_formulas_are_refused(lower):
    anchor = CellContent(None, Formula("A1*{1;2}", 1, 3, Area("S", 1, 3, 2, 3)))
    lowering, (target,) = lower({"C1": anchor, "C2": 4.0, "D1": "=C2+1"}, ["A1"], ["D1"])
    with pytest.raises(FormulaError, match="no array formulas") as caught:
        FormulasProgram(lowering, [target], [], frozenset())
    assert caught.value.where == "S!C1"


def test_a_formula_that_names_an_empty_cell_gives_zero(both):
    ours, theirs = both({"C1": "=C9", "C2": "=C1&A1"}, [], ["C1", "C2", "C9"])
    assert [values.tolist()[:1] for values, _ in ours[:1]] == [[0.0]]
    for (_, codes), (_, their_codes) in zip(ours, theirs, strict=True):
        assert (codes is None) is (their_codes is None)
        assert codes is None or codes.tolist() == their_codes.tolist()
