"""Formulas that campaigns found: tracebacks, and answers that differed between two ways to compute them."""

from __future__ import annotations

import pytest

FORMULAS = [
    "AGGREGATE(A1:A4,{1,2;3,4},-1,-657434,100)",
    "AND(COUPPCD(1,2,3,0,5),B:B)",
    "IFS(A2,VARA(LOOKUP((A1:A2,B1:B2),1.5,B:B)))",
    "AREAS(A3,ANCHORARRAY(E1),{1,2,3})",
    "CELL()",
    "CORREL(CUMIPMT(H9,A1,(ODDLPRICE(-2147483649,0.5,B2,7,0.05,B2,TRANSPOSE(B1:D2))"
    '<>{"x",1;TRUE,2}),32767,DDB(A1:A9,MOD(OFFSET(A1,-1,0),A8),A8,),A1),B1:D1)',
    "IF(INDEX(B1:D6,0,1),INDEX(B1:D6,Data[[x]:[y]]))",
    'INDEX(B1:D6,0,1)&A1:A4 A2:B3/"1"',
    "ISOMITTED()",
    'SHEETS(INDIRECT("1",FALSE))',
    "SORTBY(IFS(),OFFSET(A1:D1,1,-1))",
    "TAKE(SEQUENCE(3)-INDEX(B1:D6,0,1),(A9))",
    'TOCOL(INDIRECT("no such"))',
    'VALUETOTEXT({"x",1;TRUE,2},_xlfn.T.DIST.2T($A$1,{TRUE,#N/A}))',
    "XLOOKUP((AREAS(A1,$A$1,-1,1)*DAVERAGE(MUNIT(3),39448,A3)),-1,A6,A4)",
    "DVAR(Data[#All],C4,B1:D1+B1:B6)",
    "YEARFRAC(A5,_xlfn.DCOUNTA({-1.5;2;#DIV/0!},60,INDEX(B1:D6,0,1)),2)",
    "XLOOKUP(A1,A8,OFFSET(A1,-1,0))",
    'XMATCH(ODDLPRICE(KURT(SEQUENCE(0),10)-UNIQUE(B1:B6),HEX2OCT(255,A7)>(H9^ROW(1:5)),A3,"1/0"&(45000.75*{1;2;3}),'
    'WRAPCOLS(100,-1.5),D6,BITAND(ERF(0.5,A2),QUARTILE(HSTACK(A1,B1:B2),"x"))),_xlfn.CHIINV(PEARSON(H1:I3,'
    "HSTACK(A1,B1:B2)),A8),A2,B1:B6*2)",
]


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize("text", FORMULAS)
@pytest.mark.parametrize("form", ["plain", "array", "dynamic"])
def test_a_formula_that_was_found(text, form, tmp_path):
    from fuzzing import formulas
    from fuzzing.child import judged
    from fuzzing.inputs import Input, Kind

    given = Input("formula.txt", text.encode(), f"={text}", (form, "jit"))
    result = judged("found", Kind(lambda _: given, formulas.run), 1, 1, tmp_path).finding
    assert result is None, (result.key, result.detail)


FORMS = ("array", "block", "dynamic")

STILL = [
    "INDEX(--A4,VALUE(HOUR(1E-100))>=C2:D3)",
    "INDEX(1.5,(B2/B1:D1))",
    "INDEX(A5,0.94,OFFSET(A1,1,1,2,2))",
    "SUM(SEQUENCE(B1:B2))",
    "SUM(TAKE(B1:D6,B4:B5,1))",
    "SUM(TAKE(A1:A5,SORT(B4:B5+3)))",
    "WRAPROWS(-3.5E-10,B1:B6)",
    "WRAPROWS(B1:D1+B1:B6,B1:B6)",
]


@pytest.mark.usefixtures("small_blocks")
@pytest.mark.parametrize(
    ("text", "form"), [(text, form) for number, text in enumerate(STILL) for form in ("plain", FORMS[number % 3])]
)
def test_a_frozen_assumption_is_one_that_varies_by_nothing(text, form, tmp_path):
    from fuzzing import formulas
    from fuzzing.inputs import Input, Reached

    given = Input("formula.txt", text.encode(), f"={text}", (form, "constants"))
    assert formulas.run(given, tmp_path) is Reached.RAN  # raises where the two differ
