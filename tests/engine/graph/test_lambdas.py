"""LAMBDA, its names and the functions that call one: as constants, and with every number drawn, in each engine.

The rules are Microsoft's: another number of arguments is `#VALUE!` (the page of LAMBDA), "not providing a LAMBDA
function or anything but a single value returned" is `#CALC!` (that of BYROW), a LAMBDA that nothing calls is `#CALC!`.
"""

from __future__ import annotations

import importlib.util
import sys

import numpy as np
import pytest

from xlmc.analysis.studies.verify import verify
from xlmc.engine.engines import ENGINES
from xlmc.engine.graph import recursion
from xlmc.engine.tracking import TrackingEvaluator
from xlmc.errors import ErrorCode, XlmcError

VALUE, CALC, NA = ErrorCode.VALUE, ErrorCode.CALC, ErrorCode.NA

NUMBERS = {"A1": 1.0, "A2": 2.0, "A3": 3.0, "B1": 10.0, "B2": 20.0, "B3": 30.0}
NAMES = {
    "Twice": "_xlfn.LAMBDA(_xlpm.x,2*_xlpm.x)",
    "Other!Twice": "_xlfn.LAMBDA(_xlpm.x,_xlpm.x&_xlpm.x)",
    "Alias": "Twice",
    "AliasOfAlias": "Alias",
    "Plus": "LAMBDA(a,LAMBDA(b,a+b))",
    "PlusTwo": "Plus(2)",
    "PlusA3": "Plus(S!$A$3)",
    "Made": "LET(k,S!$A$2,LAMBDA(x,x*k))",
    "Either": "LAMBDA(w,IF(w,Twice,PlusTwo))",
    "Total": "_xleta.SUM",
    "Factorial": "LAMBDA(n,IF(n<2,1,n*Factorial(n-1)))",
    "Fib": "LAMBDA(n,IF(n<2,n,Fib(n-1)+Fib(n-2)))",
    "Evens": "LAMBDA(n,IF(n=0,TRUE,Uneven(n-1)))",
    "Uneven": "LAMBDA(n,IF(n=0,FALSE,Evens(n-1)))",
    "Ackermann": "LAMBDA(m,n,IF(m=0,n+1,IF(n=0,Ackermann(m-1,1),Ackermann(m-1,Ackermann(m,n-1)))))",
    "Deep": "LAMBDA(n,LET(f,Deep,IF(n=0,0,1+f(n-1))))",
    "Spaced": '_xlfn.LAMBDA(_xlpm.t,IF(LEN(_xlpm.t)<2,_xlpm.t,LEFT(_xlpm.t)&" "&Spaced(MID(_xlpm.t,2,99))))',
    "Raised": "_xlfn.LAMBDA(_xlpm.a,_xlop.b,IF(_xlfn.ISOMITTED(_xlop.b),_xlpm.a^2,_xlpm.a^_xlop.b))",
    "Onwards": "LAMBDA(a,[b],Raised(a,b))",
    "Sheets": "LAMBDA(x,x+S!$A$1)",
    "Number": "5",
}

CALLS = [
    ("LAMBDA(x,x+1)(A2)", 3.0),
    ("LAMBDA(7)()", 7.0),
    ("LAMBDA(x,y,x-y)(A3,A1)", 2.0),
    ("LAMBDA(x,LAMBDA(x,x)(x+1)+x)(A1)", 3.0),
    ("LAMBDA(x,x+1)()", VALUE),
    ("LAMBDA(x,x+1)(A1,A2)", VALUE),
    ("LAMBDA(a,b,a+b)(A1)", VALUE),
    ("IFERROR(LAMBDA(x,x+1)(A1,A2),-1)", -1.0),
    ("ISERROR(Twice())*1", 1.0),
    # currying
    ("LAMBDA(a,LAMBDA(b,a+b))(A1)(A2)", 3.0),
    ("LAMBDA(a,LAMBDA(b,LAMBDA(c,a*100+b*10+c)))(A1)(A2)(A3)", 123.0),
    ("LET(add,LAMBDA(a,LAMBDA(b,a+b)),two,add(A2),two(A3)+add(A1)(A1))", 7.0),
    ("LAMBDA(f,LAMBDA(x,f(f(x))))(LAMBDA(y,y*3))(A2)", 18.0),
    ("LET(k,A2,f,LAMBDA(x,x*k),k,100,f(A3))", 6.0),  # the scope it was written in
    ("Plus(A1)(A2)", 3.0),
    # names
    ("Twice(A2)", 4.0),
    ("Alias(A2)", 4.0),
    ("AliasOfAlias(A2)", 4.0),
    ("S!Alias(A2)", 4.0),
    ("Other!Twice(A2)", "22"),
    ("LEN(Other!Twice(A2))", 2.0),
    ("PlusTwo(A3)", 5.0),
    ("PlusA3(A1)", 4.0),
    ("Made(A3)", 6.0),
    ("Either(A1=1)(A3)", 6.0),
    ("Either(A1>1)(A3)", 5.0),
    ("CHOOSE(2,Twice,PlusTwo)(A3)", 5.0),
    ("IF(A1=1,LAMBDA(x,x+1),LAMBDA(x,1/0))(A3)", 4.0),
    ("LET(f,Alias,f(A2))", 4.0),
    ("Total(A1:A3)", 6.0),
    ("Sheets(A1)", 2.0),
    # parameters that may be left out
    ("Raised(A3)", 9.0),
    ("Raised(A3,)", 9.0),
    ("Raised(A2,A3)", 8.0),
    ("Raised()", VALUE),
    ("Raised(A1,A2,A3)", VALUE),
    ("Onwards(A3)", 9.0),
    ("Onwards(A2,A3)", 8.0),
    ("LAMBDA(a,[b],[c],a+b+c)(A1)", 1.0),
    ("LAMBDA(a,[b],IF(ISOMITTED(b),A3,b)+a)(A1)", 4.0),
    ("LAMBDA([a],ISOMITTED(a)*1)()", 1.0),
    ("LAMBDA(a,ISOMITTED(a)*1)(A1)", 0.0),
    ('LAMBDA(x,y,x&IF(ISOMITTED(y),"no",y))(A1,)', "1no"),
]

RECURSIVE = [
    ("Factorial(5)", 120.0),
    ("Factorial(A3)", 6.0),
    ("Fib(A3+A3)", 8.0),
    ("Evens(A3)*1", 0.0),
    ("Uneven(A3)*1", 1.0),
    ("Ackermann(A2,A2)", 7.0),
    ("Deep(A3)", 3.0),
    ('Spaced("abc")', "a b c"),
    ("SUM(MAP(A1:A3,Factorial))", 9.0),
    ("REDUCE(0,A1:A3,LAMBDA(a,x,a+Fib(x)))", 4.0),
    ("LET(f,LAMBDA(me,n,IF(n=0,0,n+me(me,n-1))),f(f,A3))", 6.0),
]

BY_NAME = [
    ("SUM(MAP(A1:A3,_xleta.SQRT)^2)", 6.0),
    ("SUM(BYROW(A1:B3,_xleta.SUM))", 66.0),
    ("SUM(BYROW(A1:B3,_xleta.MAX))", 60.0),
    ("SUM(BYCOL(A1:B3,_xlfn._xleta.STDEV.S))", 11.0),
    ("REDUCE(0,A1:A3,_xleta.SUM)", 6.0),
    ("SUM(MAP(A1:A3,B1:B3,_xleta.MAX))", 60.0),
    ("SUM(MAP(A1:A3,_xleta.ATAN2))", VALUE),
    ("LET(f,_xleta.MAX,f(A1:A3))", 3.0),
    ("LAMBDA(f,f(A1:A3))(_xleta.AVERAGE)", 2.0),
    ("_xleta.ABS", CALC),
    # what LAMBDAs are given
    ("SUM(MAP(A1:A3,LAMBDA(x,ROW(x))))", 6.0),
    ("SUM(BYROW(A1:B3,LAMBDA(r,COUNTIF(r,\">2\"))))", 4.0),
    ("SUM(BYCOL(A1:B3,LAMBDA(c,SUBTOTAL(9,c))))", 66.0),
    ("SUM(BYROW(A1:B3,LAMBDA(r,INDEX(r,1,2)/COLUMNS(r))))", 30.0),
    ("SUM(MAP(A1:A3,{1;2},LAMBDA(x,y,IFERROR(x*y,100))))", 105.0),
    ("SUM(MAP(A1:A3,A2,LAMBDA(x,y,x*y)))", 12.0),
    ("SUM(MAP(A1:A3*2,LAMBDA(x,x+1)))", 15.0),
    ("ROWS(MAP(A1:B3,LAMBDA(x,x)))", 3.0),
    ("SUM(MAP(A1:A3,LAMBDA(x,y,x)))", VALUE),
    ("SUM(MAP(A1:A3,B1:B3,Twice))", VALUE),
    ("SUM(MAP(A1:A3,LAMBDA(x,SEQUENCE(2))))", CALC),
    ("SUM(BYROW(A1:B3,LAMBDA(r,r)))", CALC),
    ("SUM(BYROW(A1:B3,LAMBDA(r,s,1)))", VALUE),
    ("REDUCE(A1,A1:A3,LAMBDA(a,x,a*10+x))", 1123.0),
    ("REDUCE(,A1:A3,LAMBDA(a,x,a*10+x))", 123.0),
    ("REDUCE(0,A1:A3,LAMBDA(x,x))", VALUE),
    ("SUM(REDUCE(A1:A2,A1:A3,LAMBDA(a,x,a+x)))", 15.0),
    ("SUM(SCAN(0,A1:A3,LAMBDA(a,x,a+x)))", 10.0),
    ("SUM(SCAN(0,A1:A3,LAMBDA(a,x,VSTACK(a,x))))", CALC),
    ("INDEX(SCAN(\"\",A1:A3,LAMBDA(a,x,a&x)),3)", "123"),
    ("SUM(MAKEARRAY(ROWS(A1:A3),COLUMNS(A1:B3),LAMBDA(r,c,r*10+c)))", 129.0),
    ("SUM(MAKEARRAY(2.9,1,LAMBDA(r,c,r+A1)))", 5.0),
    ("SUM(MAKEARRAY(0,1,LAMBDA(r,c,r)))", VALUE),
    ("SUM(MAKEARRAY(-1,1,LAMBDA(r,c,r)))", VALUE),
    ("SUM(MAKEARRAY(2,2,LAMBDA(r,r)))", VALUE),
    ("SUM(MAKEARRAY(1/0,2,LAMBDA(r,c,r)))", ErrorCode.DIV0),
    ("LET(f,LAMBDA(x,x^2),s,SEQUENCE(3),SUM(MAP(s,f))+f(A2))", 18.0),
    # nothing calls them
    ("LAMBDA(x,x)", CALC),
    ("Twice", CALC),
    ("Alias", CALC),
    ("Factorial", CALC),
    ("LAMBDA(a,LAMBDA(b,a+b))(A1)", CALC),
    ("LET(f,LAMBDA(x,x+A1),f)", CALC),
    ("PlusTwo", CALC),
]  # fmt: skip
ALL = [*CALLS, *RECURSIVE, *BY_NAME]
CALL = pytest.mark.parametrize(("formula", "expected"), ALL)

ENGINES_HERE = ["numpy", *(["jit"] if importlib.util.find_spec("llvmlite") else [])]


def same(got, expected):
    if isinstance(expected, float):
        return isinstance(got, float) and got == pytest.approx(expected, rel=1e-14)
    return type(got) is type(expected) and got == expected


@CALL
def test_of_constants(workbook, formula, expected):
    book = workbook({**NUMBERS, "H9": f"={formula}"}, names=NAMES, sheets=("Other",))
    (check,) = verify(book).cells
    assert check.reason == ""
    assert same(check.got, expected), check.got


@pytest.fixture(scope="module")
def drawn(lower):
    """`drawn("=…", {"A1": [1.0, 2.0]})`: what the formula gives in each trial; every engine named must agree."""

    def evaluate(formula, draws=None, names=NAMES, engines=ENGINES_HERE):
        draws = {name: np.asarray(values) for name, values in (draws or {}).items()}
        n = len(next(iter(draws.values())))
        lowering, targets = lower({**NUMBERS, "H9": formula}, draws, ["H9"], names=names, sheets=("Other",))
        node = lowering.target(targets[0])
        careful = TrackingEvaluator(lowering.dag, [], [node])
        careful.filters(draws, n)
        result = _shown(careful.forecasts(np.arange(n))[0])
        for engine in engines:
            evaluator = ENGINES[engine].load()(lowering, [], targets, frozenset()).evaluator(n)
            evaluator.filters(draws, n)
            again = _shown(evaluator.forecasts(np.arange(n))[0])
            assert all(agree(a, b) for a, b in zip(again, result, strict=True)), (engine, again, result)
        return result

    return evaluate


def agree(got, expected):
    """The same code, or the same number but for the last bits of powers."""
    return got == expected or (isinstance(got, float) and got == pytest.approx(expected, rel=1e-12))


def _shown(column):
    codes = np.zeros(column.values.size, int) if column.codes is None else column.codes.astype(int)
    kinds = {code.value: code for code in ErrorCode}
    return [kinds.get(c, "text") if c else float(x) for c, x in zip(codes, column.values, strict=True)]


@pytest.mark.parametrize(("number", "formula", "expected"), [(number, *call) for number, call in enumerate(ALL)])
def test_of_draws(drawn, number, formula, expected):
    """In the compiled engine every fourth."""
    draws = {name: np.full(3, value) for name, value in NUMBERS.items()}
    result = drawn(f"={formula}", draws, engines=ENGINES_HERE if number % 4 == 0 else ["numpy"])
    wanted = "text" if isinstance(expected, str) else expected
    assert all(same(got, wanted) for got in result), result


def test_which_lambda_is_called_may_vary(drawn):
    assert drawn("=IF(A1>1,Twice,PlusTwo)(A2)", {"A1": [0.0, 2.0], "A2": [5.0, 7.0]}) == [7.0, 14.0]


def test_a_cell_that_shows_calc_is_read_as_such(workbook):
    book = workbook({"H9": "=LAMBDA(x,x)", "H10": "=H9", "H11": "=IFERROR(H9,5)", "H12": "=SUM(H9,1)"})
    got = {str(check.cell): check.got for check in verify(book).cells}
    assert got == {"S!H9": CALC, "S!H10": CALC, "S!H11": 5.0, "S!H12": CALC}


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("1+LAMBDA(x,x)", "Nothing calls this LAMBDA"),
        ("SUM(MAP(A1:A3,LAMBDA(x,LAMBDA(y,x))))", "Nothing calls this LAMBDA"),
        ("LET(f,5,f(2))", "What is called here is not a LAMBDA"),
        ("SUM(MAP(A1:A3,5))", "What is called here is not a LAMBDA"),
        ("Number(2)", "The function NUMBER is not known"),
        ("Nowhere!Twice(2)", "There is no sheet 'Nowhere'"),
        ("Other!Nothing(2)", "There is no name 'Nothing'"),
        ("SUM(MAKEARRAY(A1,1,LAMBDA(r,c,r)))", "The size of an array must be a fixed number"),
        ("SUM(B1:INDEX(B1:B3,A1))", "An end of a range must be fixed"),
    ],
)
def test_what_is_refused_with_its_cell(book, formula, message):
    with pytest.raises(XlmcError, match="S!H9") as refused:
        book(
            {**NUMBERS, "H9": f"=A1+{formula}"},
            {"a": {"cell": "A1", "low": 1, "high": 2}},
            {"answer": "H9"},
            names=NAMES,
            sheets=("Other",),
        )
    assert message in str(refused.value)


DEEP = {
    "Total": "LAMBDA(n,IF(n<1,0,n+Sum.Down(n-1)))",
    "Sum.Down": "LAMBDA(n,IF(n<1,0,n+Sum.Down(n-1)))",
    "Tail": "LAMBDA(n,s,IF(n<1,s,Tail(n-1,s+n)))",
    "Forever": "LAMBDA(n,Forever(n+1))",
    "Twofold": "LAMBDA(n,Twofold(n-1)+Twofold(n-2))",
    "Fib": "LAMBDA(n,IF(n<2,n,Fib(n-1)+Fib(n-2)))",
    "Root": "LAMBDA(x,a,IF(ABS(x*x-a)<1E-12*a,x,Root((x+a/x)/2,a)))",
    "Halve": "LAMBDA(lo,hi,k,LET(m,(lo+hi)/2,IF(k=0,m,IF(m^3-m-S!$A$1>0,Halve(lo,m,k-1),Halve(m,hi,k-1)))))",
    "Collatz": "LAMBDA(n,IF(n=1,0,1+Collatz(IF(MOD(n,2)=0,n/2,3*n+1))))",
    "Over": "LAMBDA(r,i,IF(i>ROWS(r),0,INDEX(r,i)+Over(r,i+1)))",
    "Try": "LAMBDA(n,IFERROR(1/(n>3),Try(n+1)))",
    "Mixed": 'LAMBDA(n,IF(n<1,"end",IF(n<2,1/0,IF(n<3,Mixed(n-2),Mixed(n-1)))))',
    "Sized": "LAMBDA(v,n,IF(n<1,SUM(v),Sized(v*2,n-1)))",
    "Within": "LAMBDA(n,IF(n<1,0,REDUCE(0,S!$B$1:$B$3,LAMBDA(a,x,a+x))+Within(n-1)))",
    "Inner": "LAMBDA(n,IF(n<1,0,Sum.Down(n)+Inner(n-1)))",
    "Crossed": "LAMBDA(n,IF(n<1,0,LET(g,LAMBDA(me,k,IF(k<1,Crossed(n-1)+1,me(me,k-1))),g(g,n))))",
}
DEEP_CALLS = {
    "Total(A1)": lambda x: sum(x - k for k in range(int(np.ceil(x))) if x - k >= 1),
    "Tail(A1,0)": lambda x: sum(x - k for k in range(int(np.ceil(x))) if x - k >= 1),
    "Fib(INT(A1/3))": lambda x: [0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144, 233, 377][int(x / 3)],
    "Root(1,A1)": lambda x: x**0.5,
    "Halve(0,5,60)^3-Halve(0,5,60)": lambda x: x,
    "Collatz(INT(A1))": lambda x: collatz(int(x)),
    "Over(A1:A3,INT(A1)/INT(A1))": lambda x: x + 5,
    "Try(A1-30)": lambda x: 1.0,
    "Within(INT(A1))": lambda x: 60 * int(x),
    "Crossed(INT(A1))": lambda x: int(x),
    "Inner(INT(A1))": lambda x: sum(k * (k + 1) / 2 for k in range(int(x) + 1)),
}


def collatz(n):
    return 0 if n == 1 else 1 + collatz(n // 2 if n % 2 == 0 else 3 * n + 1)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("Sum(A1,2)", 5.0),  # Excel's own goes first
        ("SUM(A1,2)", 5.0),
        ("S!Sum(A1,2)", 1.0),  # a name of a sheet is no function's
        ("Edate(A1,0)", 3.0),
        ("SORT(A1,2)", 1.0),  # without the mark _xlfn. it is none of Excel's
        ("Through(A1,2)", 5.0),
    ],
)
def test_a_lambda_named_like_a_function_of_excel(drawn, formula, expected):
    names = dict.fromkeys(("Sum", "Edate", "Sort"), "LAMBDA(a,b,a-b)")
    names["Through"] = "LAMBDA(a,b,Sum(a,b))"
    assert drawn(f"={formula}", {"A1": [3.0, 3.0]}, names) == [expected] * 2


@pytest.mark.parametrize(("number", "formula"), [*enumerate(DEEP_CALLS)])
def test_each_trial_ends_its_calls_by_itself(drawn, number, formula):
    """In the compiled engine every fourth."""
    draws = np.random.default_rng(2).uniform(1, 12, 12)
    result = drawn(f"={formula}", {"A1": draws}, DEEP, ENGINES_HERE if number % 4 == 0 else ["numpy"])
    assert result == pytest.approx([DEEP_CALLS[formula](x) for x in draws], rel=1e-10)


def test_results_of_all_kinds_stay_with_their_trials(drawn):
    draws = [0.5, 1.5, 2.5, 7.5, 6.5, 1.0, 0.0, 2.0]
    ends = ["text", ErrorCode.DIV0, "text", ErrorCode.DIV0]
    assert drawn("=Mixed(A1)", {"A1": draws}, DEEP)[:3] == ends[:3]
    alone = [drawn("=Mixed(A1)", {"A1": [x]}, DEEP)[0] for x in draws]
    assert drawn("=Mixed(A1)", {"A1": draws}, DEEP) == alone


def test_how_deep_calls_may_go(workbook):
    """With one argument 8,191 calls, as in Excel; the test below shows that one more than so many is too many.

    Here they go deeper than Python's own calls may.
    """
    depth = sys.getrecursionlimit() + 100
    (check,) = verify(workbook({"H9": f"=Sum.Down({depth})"}, names=DEEP)).cells
    assert check.reason == ""
    assert same(check.got, depth * (depth + 1) / 2), check.got
    assert recursion.DEEPEST == 2 * 8_192


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("Sum.Down(127)", 8_128.0),
        ("Sum.Down(128)", ErrorCode.NUM),
        ("Tail(84,0)", 3_570.0),
        ("Tail(85,0)", ErrorCode.NUM),
        ("Forever(1)", ErrorCode.NUM),
        ("Twofold(1)", ErrorCode.NUM),
        ("IFERROR(Forever(1),7)", 7.0),
    ],
)
def test_calls_with_more_arguments_may_go_less_deep(workbook, formula, expected, monkeypatch):
    """With a 64th of the depth, which takes a 64th of the time."""
    monkeypatch.setattr("xlmc.engine.graph.recursion.DEEPEST", 256)
    (check,) = verify(workbook({"H9": f"={formula}"}, names=DEEP)).cells
    assert check.reason == ""
    assert same(check.got, expected), check.got


def test_trials_that_never_end_are_num_and_the_others_are_not(drawn, monkeypatch):
    monkeypatch.setattr("xlmc.engine.graph.recursion.DEEPEST", 240)
    result = drawn("=IF(A1>1,Forever(A1),A1)+Sum.Down(A1*100)", {"A1": [0.5, 2.0, 1.0, 90.0]}, DEEP)
    assert result == [1275.5, ErrorCode.NUM, 5051.0, ErrorCode.NUM]
    assert drawn("=Sum.Down(A1)", {"A1": [3.0, 299.5, 2.0, 9000.0]}, DEEP)[::2] == [6.0, 3.0]


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("Fib(A1+30)", "calls of a LAMBDA by itself take more than 100 steps"),
    ],
)
def test_calls_that_cannot_be_computed_are_refused_with_their_cell(drawn, formula, message, monkeypatch):
    monkeypatch.setattr("xlmc.engine.graph.recursive_calls.MOST_STEPS", 100)
    with pytest.raises(XlmcError, match="S!H9") as refused:
        drawn(f"={formula}", {"A1": [1.5, 2.5]}, DEEP)
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("Sized({1;2}*A1,INT(A1))", [6.0, 528.0, 3 * 29.5 * 2.0**29]),
        ("Sized({1;2}*A1,3)", [24.0, 132.0, 708.0]),
    ],
)
def test_an_array_may_be_handed_on_from_call_to_call(drawn, formula, expected):
    assert drawn(f"={formula}", {"A1": [1.0, 5.5, 29.5]}, {"Sized": DEEP["Sized"]}) == expected


@pytest.mark.parametrize(
    "formula",
    [
        "MAKEARRAY(100,11,LAMBDA(r,c,7))",
        "MAP(SEQUENCE(100,11),LAMBDA(x,7))",
        "REDUCE(0,SEQUENCE(100,11),LAMBDA(a,x,7))",
        "SCAN(0,SEQUENCE(100,11),LAMBDA(a,x,7))",
        "BYROW(SEQUENCE(1001),LAMBDA(x,7))",
        "BYCOL(SEQUENCE(1,1001),LAMBDA(x,7))",
    ],
)
def test_too_many_calls_are_refused_before_the_first(drawn, formula, monkeypatch):
    made = []
    monkeypatch.setattr("xlmc.excel.functions.budget.MOST_CALLS", 1_000)
    monkeypatch.setattr("xlmc.excel.functions.budget.CallCount.add", lambda _: made.append(1))
    with pytest.raises(XlmcError, match=r"S!H9: .*more than 1,000 times\. Make its arrays smaller"):
        drawn(f"=SUM({formula})+A1", {"A1": [1.5, 2.5]})
    assert not made
