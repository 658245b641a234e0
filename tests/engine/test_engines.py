"""Every engine against the careful path: the same codes, and the same numbers to 1e-12, on one table of books."""

from __future__ import annotations

import importlib.util
from random import Random

import numpy as np
import pytest
from hypothesis import given, note, settings
from hypothesis import strategies as st

from xlmc.engine.tracking import TrackingEvaluator

RELATIVE = 1e-12

with_jit = pytest.mark.skipif(importlib.util.find_spec("llvmlite") is None, reason="the engine jit needs llvmlite")
ENGINE = pytest.mark.parametrize("engine", ["numpy", pytest.param("jit", marks=with_jit), "formulas"])
OURS = pytest.mark.parametrize("engine", ["numpy", pytest.param("jit", marks=with_jit)])

HELD = {"B1": 2.0, "B2": "x", "B4": True, "B5": "2", "B6": -0.5, "Data!A1": 7.0, "Data!A2": 8.0}
NAMES = {"Rate": "S!$B$1", "Data!Rate": "Data!$A$1"}

SOUND = [
    # with A1 and A2 between 1 and 2; where `formulas` is no oracle (DESIGN §4) is in ODD: 0^0, SIN beyond 2^27, …
    "A1+A2*3-A1/A2",
    "A1^2+A2^0.5",
    "A1^3+A2^-1+A1^1+A2^4+A1^A2",
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
    "IF(A1>1.5,A2>1.5,A1>A2)+1",
    "IF(A1-A1,A2,A1)",
    "IFERROR(SQRT(A1-1.5),-1)",
    "IFERROR(IF(A1>1.7,LN(-A1),A2),9)",
    "AND(A1>1.2,A2>1.2)+OR(A1>1.8,A2>1.8)*2+NOT(A1>1.5)*4",
    "SUM(A1:A2,B1,3)+MAX(A1:B1)-MIN(A1:A2,1.5)",
    "SUM(A1:B4)",
    "SUM(A1:A2,C1:C2)*PRODUCT(A1:A2)+SUMSQ(A1:A2)",
    "AVERAGE(A1:A2)*COUNT(A1:B4)",
    "STDEV(A1:A2,C1)+VAR(A1:A2,3)+STDEVP(A1:A2)+VARP(A1:A2,B1)",
    "SUMPRODUCT(A1:A2,C1:C2)+SUMPRODUCT(A1:A2)",
    "SUM(Data!A1:A2)*A1",
    "SUM(Data!A1:Data!A2)*A1",
    "SIN(A1)+COS(A2)+TAN(A1/2)+ATAN(A2)+ASIN(A1/2)+ACOS(A2/2)",
    "SIN(A1)*COS(A1)/TAN(A1)+SIN(-100*A2)+COS(1E6*A2)",
    "ATAN2(A1,A2)+ATAN2(-A1,A2)",
    "RADIANS(A1)+DEGREES(A2)+PI()",
    "SQRT(A1)+EXP(A2)+LN(A1)+LOG10(A2)+LOG(A1,3)+ABS(-A2)+SIGN(-A1)",
    "EXP(SIN(LN(A1)*A2))+SQRT(EXP(A1)+1)",
    "ROUND(A1,2)+INT(A2*10)+MOD(A1*10,3)+ROUNDUP(A1,1)+ROUNDDOWN(A2,1)+TRUNC(A1)",
    "INDEX(A1:A2,ROUND(A1,0))+VLOOKUP(A1,A1:B2,1,FALSE)",
    "SQRT(A1-1.5)",
    "LN(A1-1.5)+1",
    "1/(ROUND(A1,0)-1)",
    "ISNUMBER(A1)+ISERROR(A1/A2)*2+ISTEXT(A1>1)",
    "B2+A1",
    "B3+A1",
    "B4+A1",
    "B5*A1",
    "Rate*A1",
    "Data!Rate*A1",
]

ODD = [
    "AVERAGE(A1:A2,B1:B6,A2)",  # `formulas` makes an error of the text in it
    # A1 is 0 in some trials, and is large, small or negative in others
    "1/A1",
    "0/A1",
    "1/(1/A1)",
    "A1-1/A1*0",
    "MIN(1,1/A1)",
    "MAX(1,-1/ABS(A1))",
    "SIGN(1/A1)",
    "ATAN(1/A1)",
    "EXP(-1/ABS(A1))",
    "1/A1>0",
    "IF(1/A1,1,2)",
    "NOT(1/A1)",
    "AND(A1>0,1/A1>0)",
    "OR(TRUE,1/A1)",
    "XOR(A1>1,1/A1>0)",
    "LN(A1)",
    "EXP(LN(A1))",
    "LOG10(A1)",
    "SQRT(A1-1E-9)",
    "EXP(1/(A1+1E-3))",
    "A1*1E200*A1",
    "1/(A1*1E200*A1)",
    "SUM(A1,A1*1E308,A1*1E308)",
    "AVERAGE(A1,A1*1E308,-A1*1E308)",
    "A1^0",
    "A1^A1",
    "A1^-1",
    "A1^3",
    "A1^0.5",
    "(A1-1)^0.5",
    "ATAN2(A1,A1)",
    "ATAN2(A1,0)",
    "SIN(A1*1E9)",
    "COS(IF(A1,A1,-2^27))",
    "TAN(IF(A1,A1,2^27))",
    "IF(A1<2^27,SIN(A1*2^26),9)",
    "MOD(1,A1)",
    "ASIN(2-A1)",
    "ROUND(1/A1,2)",
    "SUM(A1:A2,1/A1)",
    "SUMPRODUCT(A1:A2,C1:C2)",
    "IF(A1>0,A1,1/A1)",
    "IF(A1<>0,1/A1,7)",
    "IF(A1>0,LN(A1),IF(A1=0,-1,SQRT(-A1)))",
    "IF(A1>0,IF(A1>1,1/(A1-1),1/(A1-2)),IF(A1=0,A2,1/A1))",
    "IF(A1<1,MIN(1,1/A1),5)",
    "IF(A1>2,5,IF(A1<1,MIN(1,1/A1),5))",
    "MIN(1,1/A1)+IF(A1>0,MIN(1,1/A1)+1,5)",
    "IF(A1>0,MIN(1,1/A1)+1,5)-IF(A1>-1,MIN(1,1/A1)+1,7)",
    "IF(A1=0,B2+1,A1)",
    "IF(A1>0,A1)+1",
    "IF(A1>0,A1)",
    "IFNA(1/A1,9)",
    "IFERROR(1/A1,9)",
    "IFERROR(1/A1,A1^A1)",
    "IFERROR(A1^A1,A1>0)",
    "ISERROR(1/A1)",
    "ISNUMBER(1/A1)",
    "IF(ISERROR(1/A1),-1,A1)",
    "ERROR.TYPE(1/A1)",
    'IF(A1=0,"none",A1)',
    'IF(A1=0,"",A1)+1',
    'IF(A1=0,"7",A1)+1',
    'IF(IF(A1>1,TRUE,"x"),1/A1,2)',
    "VLOOKUP(A1,{0,5;1,6},2,FALSE)*2",
    "SIN(VLOOKUP(A1,{0,5;1,6},2))+1/A1",
    "CHOOSE(A1+1,A2,1/A1,-A2)",
    "SUM(A1:A2)+MAX(A1:A3,B3)+MIN(A1,B1)",
    "SUM(A1:A2,C3:C3)",  # a logical in a range does not count, yet may be an error
    "MEDIAN(A1:A2,1/A1)",
    "COUNT(A1:A2,C2)",
]
ODD_DRAWS = [0.0, 1.0, -1.0, 2.0, 1e200, -3.5, 0.5, 1e-300, 3e8, -0.0, 1.5, 1.0, 2.75, 1e-9]


def _columns(evaluator, draws, n):
    """Codes and numbers of filters, then of forecasts on the survivors, as engines are asked; copies."""

    def taken(columns):
        result = []
        for column in columns:
            codes = np.zeros(column.values.size, int) if column.codes is None else column.codes.astype(int)
            result.append((codes, np.where(codes > 0, 0.0, column.values.astype(float))))
        return result

    early = taken(evaluator.filters(draws, n))
    kept = np.logical_and.reduce([np.ones(n, bool), *((codes == 0) & (x == 1) for codes, x in early)])
    return early + taken(evaluator.forecasts(np.flatnonzero(kept)) if kept.any() else [])


@pytest.fixture(scope="module")
def programs(lower, load_program):
    """An engine's program of cells, and the graph and the nodes of its filters and forecasts, for the careful path."""

    def make(engine, cells, inputs, forecasts, filters, may_err=(), in_vectors=False):
        lowering, targets = lower(cells, inputs, [*filters, *forecasts], names=NAMES)
        split = targets[: len(filters)], targets[len(filters) :]
        nodes = [[lowering.target(target) for target in part] for part in split]
        return load_program(engine, in_vectors)(lowering, *split, frozenset(may_err)), lowering.dag, nodes

    return make


@pytest.fixture(scope="module")
def differences(programs):
    """The columns of an engine beside those of the careful path."""

    def run(engine, cells, draws, forecasts, filters, may_err=(), in_vectors=False):
        draws = {name: np.asarray(values, float) for name, values in draws.items()}
        n = len(next(iter(draws.values())))
        program, dag, nodes = programs(engine, cells, draws, forecasts, filters, may_err, in_vectors)
        expected = _columns(TrackingEvaluator(dag, *nodes), draws, n)
        return list(zip(_columns(program.evaluator(n), draws, n), expected, strict=True))

    return run


def agree(columns, relative=RELATIVE):
    for (codes, numbers), (expected_codes, expected) in columns:
        assert codes.tolist() == expected_codes.tolist()
        np.testing.assert_allclose(numbers, expected, rtol=relative, atol=0)


def a_book(formula, above):
    return HELD | {"C1": "=A1*1.01", "C2": "=1/A2", "C3": "=1/A1>0", "Z9": f"={formula}", "Z8": "=Z9+C1", "D1": above}


OF_A_BOOK = ("Z9", "Z8", "A1")
BOOKS_IN_A_PROGRAM = 15


@pytest.fixture(scope="module")
def agree_in_loops(programs):
    """Check formulas in loops, each in a book of its own, but several books in one program: it is compiled sooner.

    A trial in which there may be an error is computed again on the careful path, all of it, which could hide what a
    loop makes of another book. Therefore each book has a sheet, inputs and trials of its own. In these trials the
    inputs of the others are those of a calm trial: the filter is true, or whatever `accepts` says that it can be, and
    nothing has to be computed again.
    """

    def calm_trials(dag, filters, forecasts, inputs, m, accepts):
        """Of each book the one of its trials that is calm, as far as the careful path tells, and least odd."""
        columns = _columns(TrackingEvaluator(dag, [], [*filters, *forecasts]), inputs, m)
        result = []
        for k, (codes, accepted) in enumerate(columns[: len(filters)]):
            mine = columns[len(filters) + len(OF_A_BOOK) * k :][: len(OF_A_BOOK)]
            calm = np.flatnonzero(
                (accepted == accepts) & np.logical_and.reduce([codes == 0, *(each == 0 for each, _ in mine)])
            )
            result.append(min(calm, key=lambda trial: abs(inputs[f"F{k}!A1"][trial] - 1.6)))
        return result

    def check(books, *draws, accepts=True, may_err=(), relative=RELATIVE, in_vectors=True):
        sheets = range(len(books))
        cells = HELD | {f"F{k}!{at}": held for k in sheets for at, held in books[k].items() if "!" not in at}
        names = [f"F{k}!{name}" for k in sheets for name in draws[0]]
        filters, forecasts = [f"F{k}!D1" for k in sheets], [f"F{k}!{at}" for k in sheets for at in OF_A_BOOK]
        fallible = [f"F{k}!{name}" for k in sheets for name in may_err]
        program, dag, nodes = programs("jit", cells, names, forecasts, filters, fallible, in_vectors)
        for some in draws:
            m = len(some["A1"])
            n = 1 + m * len(books)
            inputs = {f"F{k}!{name}": np.asarray(values, float) for k in sheets for name, values in some.items()}
            for k, calm in enumerate(calm_trials(dag, *nodes, inputs, m, accepts)):
                for name in some:
                    given = inputs[f"F{k}!{name}"]
                    column = inputs[f"F{k}!{name}"] = np.full(n, given[calm])
                    column[1 + m * k :][:m] = given
            evaluator, one = program.evaluator(1), {name: column[:1] for name, column in inputs.items()}
            evaluator._tracking = None  # no careful path: the calm trial does without
            assert not any(codes.any() for codes, _ in _columns(evaluator, one, 1))
            expected = _columns(TrackingEvaluator(dag, *nodes), inputs, n)
            agree(zip(_columns(program.evaluator(n), inputs, n), expected, strict=True), relative)

    return check


def batches(formulas, above):
    """Books of these formulas, some at a time."""
    books = [a_book(formula, above) for formula in formulas]
    return [books[start : start + BOOKS_IN_A_PROGRAM] for start in range(0, len(books), BOOKS_IN_A_PROGRAM)]


SOUND_DRAWS = dict(zip(("A1", "A2"), np.random.default_rng(7).uniform(1, 2, (2, 30)), strict=True))
ODD_BESIDE = {"A1": ODD_DRAWS, "A2": np.linspace(1, 2, len(ODD_DRAWS))}
NEVER_CALM = ["B2+A1", "ERROR.TYPE(1/A1)"]
NEVER_BELOW = ["1/A1>0", "NOT(1/A1)", "AND(A1>0,1/A1>0)", "OR(TRUE,1/A1)", "XOR(A1>1,1/A1>0)", "ISERROR(1/A1)"]
NEVER_BELOW += ["ISNUMBER(1/A1)", *NEVER_CALM]


@pytest.mark.parametrize("formula", SOUND)
def test_the_engine_numpy_agrees_with_the_careful_path(differences, formula):
    agree(differences("numpy", a_book(formula, "=C1>1.2"), SOUND_DRAWS, ["Z9", "Z8"], ["D1"]))


@with_jit
def test_loops_agree_with_the_careful_path(agree_in_loops, differences):
    for books in batches([formula for formula in SOUND if formula not in NEVER_CALM], "=C1>1.2"):
        agree_in_loops(books, SOUND_DRAWS)
    for formula in set(SOUND) & set(NEVER_CALM):
        agree(differences("jit", a_book(formula, "=C1>1.2"), SOUND_DRAWS, ["Z9", "Z8"], ["D1"]))


def test_the_engine_formulas_agrees_with_the_careful_path(differences):
    """All formulas in one book: it computes each cell and each trial by itself."""
    draws = {name: values[:6] for name, values in SOUND_DRAWS.items()}
    cells = a_book("A1", "=C1>1.2") | {f"F{row}": f"={formula}" for row, formula in enumerate(SOUND, 1)}
    cells |= {f"G{row}": f"=F{row}+C1" for row in range(1, len(SOUND) + 1)}
    asked = [f"{column}{row}" for column in "FG" for row in range(1, len(SOUND) + 1)]
    agree(differences("formulas", cells, draws, asked, ["D1"]))


@pytest.mark.parametrize("above", ["=Z9<1E300", "=A2<1.95"])
@pytest.mark.parametrize("formula", ODD)
def test_errors_are_the_same_trial_by_trial(differences, formula, above):
    agree(differences("numpy", a_book(formula, above), ODD_BESIDE, ["Z9", "Z8", "A1"], ["D1"]))


@with_jit
def test_errors_in_loops_are_the_same_trial_by_trial(agree_in_loops, differences):
    """In a filter and behind one that is true: of the formulas that may be asked in both ways, every other in each."""
    either = [formula for formula in ODD if formula not in NEVER_BELOW]
    behind = [formula for formula in NEVER_BELOW if formula in ODD and formula not in NEVER_CALM]
    for above, formulas in (("=Z9<1E300", either[::2]), ("=A2<1.95", either[1::2] + behind)):
        for books in batches(formulas, above):
            agree_in_loops(books, ODD_BESIDE)
        for formula in set(ODD) & set(NEVER_CALM):
            agree(differences("jit", a_book(formula, above), ODD_BESIDE, ["Z9", "Z8", "A1"], ["D1"]))
    for books in batches(behind, "=Z9<1E300"):
        agree_in_loops(books, ODD_BESIDE, accepts=False)


CELLS_THAT_MAY_ERR = ["1/(A1-1)", "LN(A1-1)", "SINH(1/(A1-1))", "EXP(A1*1000)", "NA()*A1", "A1>1/(A1-1)"]
CELLS_THAT_MAY_ERR += ["ISEVEN(1/(A1-1))", 'ISEVEN(IF(A1>1,"x","2"))', 'IF(A1>1,"x",2)', "IF(A1>1,1/(A1-3),2)"]
OF_RANGES = [
    f"{name}(B1:B2)" for name in ("SUM", "COUNT", "AVERAGE", "MAX", "COUNTA", "AND", "SUMSQ", "VAR", "PRODUCT")
]
OF_RANGES += [
    "SUMPRODUCT(B1:B2,C1:C2)",
    "SUMPRODUCT(C1:C2,B1:B2)",
    "SUMPRODUCT(B1:B2,C1:C2,B1:B2)",
    "SUMPRODUCT(B1:B2)",
]
OF_RANGES += ["COUNT(B1:B2,C1:C2)", "IF(A1>0.5,COUNT(B1:B2),SUMPRODUCT(B1:B2,C1:C2))", "IF(A1>2,1,COUNT(B1:B2))*A1"]


WITH_EVERY_FORMULA = ['IF(A1>1,"x",2)', 'ISEVEN(IF(A1>1,"x","2"))']


@OURS
def test_errors_in_cells_of_ranges_are_the_same(differences, engine):
    """Also where the cell does not count: a count without it, or a logical value, which a function outside gave.

    Each formula is asked for alone, as the error that another one finds has the trial computed again; cells that are
    no errors in most trials are seen by all of them, too.
    """
    draws = {"A1": [0.2, 1.0, 2.0, 3.0]}
    held = {"B1": "=A1", "C1": "=A1*2", "C2": "=A1+1"}
    held |= {f"D{row}": f"={formula}" for row, formula in enumerate(OF_RANGES, 1)}
    for number in range(2 * len(CELLS_THAT_MAY_ERR)):
        cells = held | {"B2": f"={CELLS_THAT_MAY_ERR[number % len(CELLS_THAT_MAY_ERR)]}"}
        agree(differences(engine, cells, draws, [f"D{1 + number % len(OF_RANGES)}"], []))
    for cell in WITH_EVERY_FORMULA:
        cells = held | {"B2": f"={cell}"}
        agree(differences(engine, cells, draws, [f"D{row}" for row in range(1, len(OF_RANGES) + 1)], []))


@OURS
def test_products_too_small_for_excel_add_nothing(differences, engine):
    cells = {"B1": "=A1*1E-200", "B2": "=A1", "C1": "=A1*1E-110", "C2": "=A1*1E-307", "E1": "=A1*1E150"}
    cells |= {"D1": "=SUMPRODUCT(B1:B2,C1:C2)", "D2": "=SUMPRODUCT(B1:B1,C1:C1,E1:E1)*1E300"}
    agree(differences(engine, cells, {"A1": [1.0, 2.0, 0.01]}, ["D1", "D2"], []), relative=0)


OUTSIDE_LOOPS = ["INT(A1*3)", "QUOTIENT(A1,A2)", "QUOTIENT(A1>1,A2-1.5)", "SINH(A1)", "ASINH(INT(A1))", "LOG(A1,3)"]
OUTSIDE_LOOPS += ["ROUND(A1,2)+ROUND(A2,1)", "QUOTIENT(SINH(A1),INT(A2*4)-5)", "IF(A1>1,SINH(A1)*2,LOG(-A1,A2))"]
OUTSIDE_LOOPS += ["SINH(TRUE)+SINH(A1>1)", "CEILING(A1,0.1)", "COSH(A1)^2-SINH(A1)^2", "COUNTIF(A1:A2,A1>1)+1"]
OUTSIDE_LOOPS += [
    "SINH(B2)",
    "SINH(C9)+A1",
    "FACT(INT(A1))",
    "IF(INT(A2*4)>6,1/INT(A1),2)",
    "NOT(INT(A1))",
    "SINH(A1*1E-320)",
]
OUTSIDE_LOOPS += ["SUM(SINH(A1),INT(A2))", "IF(SINH(A1),1,2)", "AND(SINH(A1),TRUE)+2", "SINH(LN(A1))", "SINH(1/(A1-1))"]


OUTSIDE_DRAWS = [{"A1": a1, "A2": np.linspace(1, 2, len(a1))} for a1 in (np.linspace(1.01, 2.9, 33), ODD_DRAWS, [1.5])]
WITH_ERRORS = {"A1": [1.5, np.nan, 2.5, 0.3], "A2": np.linspace(1, 2, 4)}
OUTSIDE_ALONE = ["SINH(B2)", "NOT(INT(A1))", "SINH(LN(A1))"]
"""The first two are never calm, or not behind each filter; logarithms differ in the last bit."""


def outside_alone(programs, engine, formula, above, may_err):
    program, dag, nodes = programs(engine, a_book(formula, above), ("A1", "A2"), OF_A_BOOK, ["D1"], may_err)
    for inputs in [WITH_ERRORS] if may_err else OUTSIDE_DRAWS:
        inputs, n = {name: np.asarray(values, float) for name, values in inputs.items()}, len(inputs["A1"])
        result = _columns(program.evaluator(n), inputs, n)
        expected = _columns(TrackingEvaluator(dag, *nodes), inputs, n)
        agree(zip(result, expected, strict=True), relative=1e-15 if "LN" in formula else 0)


ABOVE = ["=C1>1.2", "=Z9<1E300"]


def test_functions_outside_of_loops_give_the_bits_of_the_careful_path(programs):
    """In a filter or on its survivors, and where draws are errors; they feed each other.

    Every other formula is in a filter; where draws are errors, it is the other way round.
    """
    for at, formula in enumerate(OUTSIDE_LOOPS):
        outside_alone(programs, "numpy", formula, ABOVE[at % 2], [])
        outside_alone(programs, "numpy", formula, ABOVE[1 - at % 2], ["A1"])


@with_jit
def test_functions_between_loops_give_the_bits_of_the_careful_path(programs, agree_in_loops):
    """The same, where they feed loops, too: in one of the two ways, for what is compiled is the same in both."""
    together = {(at, fallible): [] for at in (0, 1) for fallible in (False, True)}
    for number, formula in enumerate(OUTSIDE_LOOPS):
        fallible = number // 2 % 2 == 1
        at = (number + fallible) % 2
        if formula in OUTSIDE_ALONE:
            outside_alone(programs, "jit", formula, ABOVE[at], ["A1"] if fallible else [])
        else:
            together[at, fallible].append(a_book(formula, ABOVE[at]))
    for (_, fallible), books in together.items():
        if fallible:
            agree_in_loops(books, WITH_ERRORS, may_err=["A1"], relative=0, in_vectors=False)
        else:
            agree_in_loops(books, *OUTSIDE_DRAWS, relative=0, in_vectors=False)


@OURS
def test_a_value_that_a_function_hands_on_stays_when_its_memory_is_used_again(differences, engine):
    """HYPERLINK gives its second argument as it is, an array that nothing else reads."""
    cells = {"B1": "=A1+1", "C1": '=HYPERLINK("x",B1)', "D1": "=C1*2+1", "E1": "=SINH(D1)", "F1": "=E1*3"}
    draws = {"A1": np.linspace(0.1, 2.0, 20)}
    agree(differences(engine, cells, draws, ["C1", "D1", "F1"], []), relative=1e-15)


@OURS
def test_draws_that_are_errors(differences, engine):
    cells = {"C1": "=A1+1", "C2": "=IFERROR(A1,7)", "C3": "=IF(A2>1,A1,A2)", "C4": "=A1>0", "D1": "=A2<3"}
    draws = {"A1": [np.nan, 1.0, np.nan, 2.0], "A2": [1.0, 2.0, 2.0, 3.0]}
    result = differences(engine, cells, draws, ["C1", "C2", "C3", "C4", "A1"], ["D1", "C4"], may_err=["A1"])
    agree(result)
    agree(differences(engine, cells, draws, ["C1", "C2", "C3", "C4", "A1"], [], may_err=["A1"]))
    agree(differences(engine, {}, draws, ["A1"], [], may_err=["A1"]))  # which nothing computes


@ENGINE
def test_a_formula_that_names_an_empty_cell_gives_zero(differences, engine):
    cells = {"C1": "=C9", "C2": "=C1&A1", "C3": "=C9+A1"}
    result = differences(engine, cells, {"A1": [1.0, 2.0]}, ["C1", "C2", "C3", "C9"], [])
    agree(result)
    assert result[0][0][1].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("engine", "depth"), [("numpy", 30), *(pytest.param("jit", depth, marks=with_jit) for depth in (3, 30, 300))]
)
def test_branches_within_branches(differences, engine, depth):
    cells = {"B1": "=1/A1"} | {f"B{k}": f"=IF(A1>{k}/1000,SQRT(B{k - 1}),B{k - 1})" for k in range(2, depth)}
    draws = [0.0, *np.random.default_rng(1).uniform(-0.01, depth / 1000, 40)]
    agree(differences(engine, cells, {"A1": draws}, [f"B{depth - 1}"], []))


@OURS
def test_more_nodes_than_one_loop_holds(differences, engine):
    cells = {"B1": "=A1+1"} | {f"B{k}": f"=B{k - 1}+A1/{k}" for k in range(2, 161)}
    cells |= {"C1": "=SQRT(B160-2000)+B7"}
    agree(differences(engine, cells, {"A1": [0.0, 1.0, 500.0]}, ["C1", "B160"], []))


@OURS
@pytest.mark.parametrize(
    "formula", ["SUM(B1:B{n})", "MAX(B1:B{n})*2", "SUMPRODUCT(B1:B{n},B1:B{n})", "STDEV(B1:B{n},A1)"]
)
def test_ranges_wider_than_a_loop_reads(differences, engine, formula):
    for n in (3, 201):
        cells = {f"B{k}": f"=A1/{k}" for k in range(1, n + 1)} | {"C1": "=" + formula.format(n=n)}
        agree(differences(engine, cells, {"A1": [0.0, 1.0, -500.0, 1e308]}, ["C1"], []))


ONE = ("SQRT", "ABS", "INT", "SIGN", "NOT", "ISERROR", "ISNUMBER", "ASINH")
TWO = ("IFERROR", "IFNA", "AND", "OR", "XOR", "MOD", "QUOTIENT", "ROUND", "MAX", "IF", "SUM")
MANY = ("SUM", "MIN", "MAX", "PRODUCT", "AVERAGE", "COUNT", "AND", "OR", "SUMSQ", "VAR", "SUMPRODUCT", "MEDIAN")
RANGES = ("A1:A3", "B1:B3", "B4:B6", "A1:B2", "B3:B3")
LEAVES = ("A1", "A2", "A3", "A1", "A2", "B1", "B2", "B3", "B4", "B5", "B6", "0", "1", "2", "0.5", "10%")


def random_formula(random, cells, depth):
    """Of what every engine computes to the last bit: no powers, exponentials, logarithms, sines and their kin."""
    if random.random() < 0.25 or depth == 0:
        return random.choice((*LEAVES, *cells, *cells))

    def part():
        return random_formula(random, cells, depth - 1)

    ranges = (*RANGES, *([f"C1:C{len(cells)}"] if cells else []))
    return random.choice(
        (
            lambda: f"({part()}{random.choice('+-*/')}{part()})",
            lambda: f"({part()}{random.choice(('+', '=', '<>', '<', '<=', '>', '>=', '&'))}{part()})",
            lambda: f"(-{part()})",
            lambda: f"{random.choice(ONE)}({part()})",
            lambda: f"{random.choice(TWO)}({part()},{part()})",
            lambda: f"IF({part()},{part()},{part()})",
            lambda: f"IF({part()}>{part()},{part()},SQRT(A1-{random.random()}))",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)},{random.choice(ranges)})",
            lambda: f"{random.choice(MANY)}({random.choice(ranges)})",
            lambda: f"SUM({{1,2,3}}*{part()})",
        )
    )()


def random_book(seed):
    """Cells that build on each other, a filter or none, forecasts, and draws, harmless ones or any."""
    random = Random(seed)
    cells, names = dict(HELD), []
    for row in range(1, random.randint(2, 6)):
        cells[f"C{row}"] = "=" + random_formula(random, names, 3)
        names.append(f"C{row}")
    filters = ["D1"] * random.randint(0, 1)
    cells["D1"] = f"={random.choice(names)}>{random.choice(('0', '0.7', 'A1'))}"
    cells["E1"] = "=" + "".join(f"{random.choice('+-')}{name}" for name in names)
    forecasts = ["E1", *random.sample((*names, "A1", "A2"), 2)]
    odd = random.choice(((), (0.0, 1.0, -1.0, 2.0, 1e200, -3.5), (1.0, 2.0, 0.75)))
    numbers = [*odd, *(random.uniform(0.1, 2.0) for _ in range(10))]
    return cells, {name: random.choices(numbers, k=20) for name in ("A1", "A2", "A3")}, forecasts, filters


@with_jit
@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**40))
def test_loops_give_the_same_bits_where_no_sine_or_its_kin_is_taken(differences, seed):
    cells, draws, forecasts, filters = random_book(seed)
    note((cells, draws, forecasts, filters))
    agree(differences("jit", cells, draws, forecasts, filters, in_vectors=True), relative=0)
