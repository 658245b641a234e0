"""`LET`, `LAMBDA` and names that hold one: what each name in them means."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.workbook import Formula

NAMES = {
    "Rate": "S!$C$3",
    "x": "S!$Z$1",
    "Twice": "LAMBDA(v,2*v)",
    "Data!Twice": "LAMBDA(v,v+v)",
    "Quad": "Twice(Twice(1))",
    "Apart": "x+1",
    "Scaled": "_xlfn.LAMBDA(_xlpm.v, _xlpm.v*Rate)",
    "Step": "LAMBDA(S!A1)",
    "Again": "LAMBDA(n,IF(n,Again(n-1),0))",
    "Area": "S!$A$1:$B$2",
    "Other": "Twice",
    "Made": "LET(_xlpm.k,3,LAMBDA(_xlpm.v,_xlpm.v*_xlpm.k))",
    "Plus": "LAMBDA(p,LAMBDA(q,p+q))",
    "AddTwo": "Plus(2)",
    "Chosen": "IF(S!$B$2,Twice,Scaled)",
    "Total": "_xleta.SUM",
    "Evens": "LAMBDA(n,IF(n,Uneven(n-1),TRUE))",
    "Uneven": "LAMBDA(n,IF(n,Evens(n-1),FALSE))",
}

TREES = {
    # LET: each binding sees those before it, and the innermost wins
    "LET(a,1,a+1)": "LET(a=1 (+ a 1))",
    "LET(a,A1,b,a*2,a+b)": "LET(a=S!A1 b=(* a 2) (+ a b))",
    "LET(a,1,LET(a,2,a)+a)": "LET(a=1 (+ LET(a=2 a) a))",
    "LET(a,1,a,a+1,a)": "LET(a=1 a=(+ a 1) a)",
    "LET(a,LET(b,1,b),a)": "LET(a=LET(b=1 b) a)",
    "LET(A,1,a)+0": "(+ LET(a=1 a) 0)",
    "SUM(LET(x,1,x),x)": "SUM(LET(x=1 x) S!Z1)",
    "LET(x,x,x)": "LET(x=S!Z1 x)",
    "LET(a,A1:A3,b,B3,SUM(a:b))": "LET(a=S!A1:A3 b=S!B3 SUM(S!A1:B1))",  # columns: files write `_xlpm.a:_xlpm.b`
    "LET(_xlpm.a,A1,_xlpm.b,B3,SUM(_xlpm.a:_xlpm.b))": "LET(a=S!A1 b=S!B3 SUM((: a b)))",
    "LET(rate,2,rate*S!Rate)": "LET(rate=2 (* rate S!C3))",
    "_xlfn.LET(_xlpm.a,1,_xlpm.A)": "LET(a=1 a)",
    "LET(größe,1,GRÖSSE)": "LET(grösse=1 grösse)",
    # LAMBDA
    "LAMBDA(a,a+x)": "λ(a (+ a S!Z1))",
    "LAMBDA(x,x)(x)": "[λ(x x)](S!Z1)",
    "LAMBDA(a,LAMBDA(b,a+b))(1)(2)": "[[λ(a λ(b (+ a b)))](1)](2)",
    "LAMBDA(a,LAMBDA(a,a)(a+1)+a)": "λ(a (+ [λ(a a)]((+ a 1)) a))",
    "LAMBDA(A1)()": "[λ(S!A1)]()",
    "LAMBDA(_xlpm.a,_xlop.b,_xlpm.a+_xlop.b)(1)": "[λ(a [b] (+ a b))](1)",
    "MAP(A1:A3,LAMBDA(v,v^2))": "MAP(S!A1:A3 λ(v (^ v 2)))",
    # variables that are called, and those that only share their name with a function
    "LET(f,LAMBDA(a,a+1),f(2))": "LET(f=λ(a (+ a 1)) [f](2))",
    "LET(f,LAMBDA(a,a),F(f(2)))": "LET(f=λ(a a) [f]([f](2)))",
    "LAMBDA(f,f(1))(LAMBDA(a,a))": "[λ(f [f](1))](λ(a a))",
    "LET(_xlpm.f,LAMBDA(a,a),_xlpm.f(2))": "LET(f=λ(a a) [f](2))",
    "LET(_xlpm.max,MAX(A1:A3),MAX(_xlpm.max,1))": "LET(max=MAX(S!A1:A3) MAX(max 1))",
    # names that hold one
    "Twice(3)": "[λ(v (* 2 v))](3)",
    "TWICE(A1)": "[λ(v (* 2 v))](S!A1)",
    "Twice": "λ(v (* 2 v))",
    "MAP(A1:A3,Twice)": "MAP(S!A1:A3 λ(v (* 2 v)))",
    "Quad": "[λ(v (* 2 v))]([λ(v (* 2 v))](1))",
    "Scaled(2)": "[λ(v (* v S!C3))](2)",
    "Step()": "[λ(S!B2)]()",
    "LET(twice,3,twice)": "LET(twice=3 twice)",
    # other ways to come to one
    "Other(3)": "[λ(v (* 2 v))](3)",
    "Made(3)": "[LET(k=3 λ(v (* v k)))](3)",
    "AddTwo(3)": "[[λ(p λ(q (+ p q)))](2)](3)",
    "Chosen(3)": "[IF(S!B2 λ(v (* 2 v)) λ(v (* v S!C3)))](3)",
    "Total(A1:A3)": "[ƒSUM](S!A1:A3)",
    "Rate(3)": "RATE(3)",  # a number: the call is of Excel's own
    "Data!Twice(3)": "[λ(v (+ v v))](3)",
    "[0]!Twice(3)": "[λ(v (* 2 v))](3)",
    "MAP(A1:A3,_xleta.ABS)": "MAP(S!A1:A3 ƒABS)",
    "MAP(A1:A3,_xlfn._xleta.STDEV.S)": "MAP(S!A1:A3 ƒSTDEV.S)",
    "LAMBDA(a,[b],a+b)(1)": "[λ(a [b] (+ a b))](1)",
    # one that calls itself, and two that call each other
    "Again(3)": "[LET!(=none!again=s=λ(n IF(n [=none!again=s]((- n 1)) 0)) =none!again=s)](3)",
    "Evens(3)": "[LET!(=none!evens=s=λ(n IF(n [λ(n IF(n [=none!evens=s]((- n 1)) FALSE))]((- n 1)) TRUE))"
    " =none!evens=s)](3)",
    # a name does not see the variables around it
    "LET(x,1,x+Apart)": "LET(x=1 (+ x (+ S!Z1 1)))",
    "LET(v,7,Twice(v))": "LET(v=7 [λ(v (* 2 v))](v))",
    "LAMBDA(rate,Scaled(rate))(1)": "[λ(rate [λ(v (* v S!C3))](rate))](1)",
    # what is not a variable's name
    "LET(x,1,Data!x)": "LET(x=1 S!Z1)",
    "LET(x,1,[0]!x)": "LET(x=1 S!Z1)",
    "LET(x,1,x1)": "LET(x=1 S!X1)",
}


@pytest.fixture
def see(resolved):
    """The tree that a formula gives in `S!B2`."""
    return lambda text, at="S!B2": resolved(text, at=at, names=NAMES, sheets=("Data",))


@pytest.mark.parametrize("text", TREES)
def test_what_the_names_mean(see, text):
    assert see(text) == TREES[text]


@pytest.mark.parametrize(
    ("text", "at", "expected"),
    [
        ("Twice(3)", "Data!A1", "[λ(v (+ v v))](3)"),  # a sheet's own name comes first
        ("LAMBDA(v,v+A1)(1)", "Data!C3", "[λ(v (+ v Data!A1))](1)"),
        ("Step()", "S!D4", "[λ(S!D4)]()"),  # relative, as from A1
    ],
)
def test_what_they_mean_elsewhere(see, text, at, expected):
    assert see(text, at) == expected


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("LET(1)", "LET takes pairs of a name and a value, and then a calculation", None),
        ("LET(a,1)", "LET takes pairs of a name and a value, and then a calculation", None),
        ("LET(a,1,b,2)", "LET takes pairs of a name and a value, and then a calculation", None),
        ("LET(1,2,3)", "LET needs a name where it has something else", "a name that looks like no cell"),
        ("LET(A1,2,3)", "LET needs a name where it has something else", "a name that looks like no cell"),
        ("LET(Data!a,2,3)", "LET needs a name where it has something else", "a name that looks like no cell"),
        ("LET(a,2,[1]!b,3,4)", "LET needs a name where it has something else", "a name that looks like no cell"),
        ("LAMBDA(A1,A1)", "LAMBDA needs a name where it has something else", "a name that looks like no cell"),
        ("LAMBDA(a+1,2)", "LAMBDA needs a name where it has something else", "a name that looks like no cell"),
        ("LAMBDA()", "LAMBDA takes at least a calculation", None),
        ("LET(a,b,b,1,a)", "there is no name 'b'", None),  # bindings do not see those after them
        ("LET(a,a,a)", "there is no name 'a'", None),
        ("LET(a,1,2)+a", "there is no name 'a'", None),
        ("LAMBDA(a,2)(a)", "there is no name 'a'", None),
        ("LAMBDA(a,b)(1)", "there is no name 'b'", None),
        ("LET(v,1,Hidden)", "there is no name 'v'", None),
        ("LET(hiden,1,hidn)", "there is no name 'hidn'", "did you mean 'Hidden'?"),
        ("Loop", "the name 'Loop' is defined by itself", "correct it under Formulas ▸ Name Manager"),
    ],
)
def test_what_may_not_be(resolved, text, message, hint):
    with pytest.raises(FormulaError) as caught:
        resolved(text, at="S!B2", names={"Hidden": "v*2", "Loop": "Ring", "Ring": "Loop"}, sheets=("Data",))
    assert (caught.value.message, caught.value.hint, caught.value.where) == (message, hint, "S!B2")


@pytest.mark.parametrize("broken", ["LET(v,1,v+nothing)", "LAMBDA(v,v+nothing)", "Broken", "-" * 199 + "nothing"])
def test_a_faulty_formula_leaves_nothing_behind(workbook, shown, broken):
    cell = Cell("S", 1, 2)
    resolver = Resolver(workbook({}, names={"v": "S!$Z$1", "Broken": "LET(w,1,w+nothing)", "Loop": "Broken"}))
    for _ in range(3):
        with pytest.raises(FormulaError, match="There is no name 'nothing'"):
            resolver.formula(cell, Formula(broken, 1, 2))
    assert shown(resolver.formula(cell, Formula("-" * 190 + "v", 1, 2))).count("-") == 190
    assert shown(resolver.formula(cell, Formula("v+A1", 1, 2))) == "(+ S!Z1 S!A1)"
    with pytest.raises(FormulaError, match="There is no name 'nothing'"):  # and not a name that is still open
        resolver.formula(cell, Formula("Loop", 1, 2))
