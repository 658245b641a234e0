"""What `formulas` alone rejects or reads wrongly, and what stands close to it."""

from __future__ import annotations

import sys

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir, parse

TREES = {
    # signs, powers, per cents
    "2^-1%": "(^ 2 (% (- 1)))",
    "-2^-2": "(^ (- 2) (- 2))",
    "2^-x^3": "(^ (^ 2 (- <x>)) 3)",
    "1/-2": "(/ 1 (- 2))",
    "-5%%": "(% (% (- 5)))",
    "A1>=-1": "(>= A1 (- 1))",
    "--(A1>0)*2": "(* (- (- (> A1 0))) 2)",
    # spills and single values
    "-A1#^2": "(^ (- ANCHORARRAY(A1)) 2)",
    "A1#-1": "(- ANCHORARRAY(A1) 1)",
    "A1#+-1": "(+ ANCHORARRAY(A1) (- 1))",
    "@A1#": "SINGLE(ANCHORARRAY(A1))",
    "-@A1%": "(% (- SINGLE(A1)))",
    "@INDEX(A1:A3,1)": "SINGLE(INDEX(A1:A3 1))",
    "1+@Rate": "(+ 1 SINGLE(<Rate>))",
    "@T[a]": 'SINGLE(T["a"])',
    "Data!A1#": "ANCHORARRAY(Data!A1)",
    "SUM(A1#,T[a]#)": 'SUM(ANCHORARRAY(A1) ANCHORARRAY(T["a"]))',
    "_xlfn.SINGLE(A1)+_xlfn.ANCHORARRAY(A1)": "(+ SINGLE(A1) ANCHORARRAY(A1))",
    # ranges of ranges bind before intersections, and these before lists
    "B1:B5 OFFSET(A1,1,0):B9": "(∩ B1:B5 (: OFFSET(A1 1 0) B9))",
    "B9:INDEX(A:A,2) B:B": "(∩ (: B9 INDEX(A:A 2)) B:B)",
    "INDEX(A:A,2):INDEX(A:A,5)": "(: INDEX(A:A 2) INDEX(A:A 5))",
    "A1# B:B": "(∩ ANCHORARRAY(A1) B:B)",
    "A1 @B1": "(∩ A1 SINGLE(B1))",
    "A:A #REF!": "(∩ A:A #REF!)",
    "A1:B2 -B1": "(- A1:B2 B1)",
    "SUM((A1:B2,C3 C:C))": "SUM((∪ A1:B2 (∩ C3 C:C)))",
    "SUM((A1,B2) B1:B3)": "SUM((∩ (∪ A1 B2) B1:B3))",
    "Data!A1:A3 Data!A2:C2": "(∩ Data!A1:A3 Data!A2:C2)",
    # sheets and books
    "Data!A:A": "Data!A:A",
    "Data!$1:1": "Data!$1:1",
    "Jan:Dec!$A:B": "Jan:Dec!$A:B",
    "Jan1:Dec1!A1": "Jan1:Dec1!A1",
    "'Jan 1:Dec 2'!A1:B2": "Jan 1:Dec 2!A1:B2",
    "Données.2!A1": "Données.2!A1",
    "'a ''b'' c'!A1": "a 'b' c!A1",
    "'[1]My data'!A1": "[1]My data!A1",
    "'[1]My data'!Rate": "<[1]My data!Rate>",
    "'C:\\x\\[Book.xlsx]My data'!A1:B2": "C:\\x\\[Book.xlsx]My data!A1:B2",
    "[1]!Rate": "<[1]!Rate>",
    "[12]!CB.GetForeStatFN(A1,2)": "CB.GETFORESTATFN(A1 2)",
    "!A1": "A1",
    # columns of tables: `'` escapes, and Alt+Enter makes line breaks
    "T[two\nlines]": r'T["two\nlines"]',
    "T[[#This Row],[two\r\nlines]]": r'T[#this row "two\nlines"]',
    "[@[two\nlines]]\n*2": r'(* [#this row "two\nlines"] 2)',
    "T[Speed '[m/s']]": 'T["Speed [m/s]"]',
    "T[@[Speed '[m/s']]:[b'#c]]": 'T[#this row "Speed [m/s]":"b#c"]',
    "T[driver''s]&\"'\"": '(& T["driver\'s"] "\'")',
    'T[say "a]&"]"': r'(& T["say \"a"] "]")',
    "T['@x]": 'T["@x"]',
    "T[#this row]": "T[#this row]",
    "T[ [#Totals] , [a] ]": 'T[#totals "a"]',
    # texts that look like something else
    '"A1:B2"&"[@x]"': '(& "A1:B2" "[@x]")',
    '"it\'s"&A1&"\'"': '(& (& "it\'s" A1) "\'")',
    '"(,;{"': '"(,;{"',
    '"a ""quoted"" b"': r'"a \"quoted\" b"',
    '"a\n\nb"&A1': r'(& "a\n\nb" A1)',
    '" "': '" "',
    # numbers, cells and names that look alike
    "1E5+E5": "(+ 100000 E5)",
    "1.E2": "100",
    "0.1E-2%": "(% 0.001)",
    "TAX2024": "TAX2024",  # column TAX is on the sheet
    "R1C1": "<R1C1>",
    "RC+R": "(+ <RC> <R>)",
    "A0": "<A0>",
    "A1B": "<A1B>",
    "a?A1": "<a?A1>",
    "\\A1": "<\\A1>",
    "TRUE+TRUE1X": "(+ TRUE <TRUE1X>)",
    # functions and their prefixes
    "_xlfn.LET(_xlpm.x,1,_xlpm.x)": "LET(<_xlpm.x> 1 <_xlpm.x>)",
    "_xlfn.LAMBDA(_xlpm.x,_xlop.y,_xlpm.x)(2)": "[LAMBDA(<_xlpm.x> <_xlop.y> <_xlpm.x>)](2)",
    "_xll.RiskUniform(1,2)": "RISKUNIFORM(1 2)",
    "_xludf.DUMMY(1)": "DUMMY(1)",
    "_xlfn.F.DIST.RT(1,2,3)": "F.DIST.RT(1 2 3)",
    "(LAMBDA(x,x))(1)": "[LAMBDA(<x> <x>)](1)",
    "LAMBDA(3)()": "[LAMBDA(3)]()",
    "LET(f,LAMBDA(x,x),f(2))(3)": "[LET(<f> LAMBDA(<x> <x>) F(2))](3)",
    "IF(,)": "IF(_ _)",
    "IF(A1,B1,)": "IF(A1 B1 _)",
    "F((1,2),,)": "F((∪ 1 2) _ _)",
    "F( )": "F()",
    # array constants
    "{-1.5E3}": "{(- 1500)}",
    "{+1,-2}": "{(+ 1) (- 2)}",
    '{"a;b","c}",""}': '{"a;b" "c}" ""}',
    "{#REF!;#N/A}": "{#REF!; #N/A}",
    "SUM({1;2}*{3,4})": "SUM((* {1; 2} {3 4}))",
    "{ 1 , 2 ;\n3 , 4 }": "{1 2; 3 4}",
}

FAULTS = [
    "1+«+»",
    "1«-»",
    "2^«^»3",
    "1>«<»2",
    "1<>«=»2",
    "A1«@»",
    "A1«@»B1",
    "A1«#»B1",
    "A1«#»N/A",
    "SUM(1)«)»",
    "((1«)»",
    "SUM()«)»",
    "SUM(A1)«B»1",
    "«1»E",
    "«1»E+",
    "«.»",
    "«T»[",
    "«T»[a",
    "«T»[@[a],[#All]]",
    "«T»[a]b",
    "«T»[a']",
    "«[»1]!T[a]",
    "«D»ata!",
    "«D»ata!!A1",
    "«D»ata!1",
    "Jan:Dec«!»Rate",
    "«'»abc!A1",
    'A1&«"»abc',
    "{1+1«}»",
    "{--1«}»",
    "{-TRUE«}»",
    "{1;«}»",
    "{1}«{»2}",
    "LAMBDA(x,x)(1)«(»",
    "5%«(»2)",
    "A1«!»",
    "A1 «~» B1",
    "«A»1:XFE2",
    "«A»BC:ZZZ",
    "«1»:1048577",
    "«$»A$",
]


@pytest.mark.parametrize("text", TREES)
def test_a_formula_and_its_tree(parsed, text):
    assert parsed(text) == TREES[text]


@pytest.mark.parametrize("marked", FAULTS)
def test_a_fault_is_marked_where_it_stands(marked):
    text = marked.replace("«", "").replace("»", "")
    with pytest.raises(FormulaError, match="cannot be read") as caught:
        parse(text)
    start = marked.index("«")
    assert (caught.value.text, caught.value.span) == (text, (start, start + 1))


def test_sixty_calls_within_one_another():
    tree = parse("IF(A1>0," * 60 + "1" + ",2)" * 60)
    for _ in range(60):
        assert isinstance(tree, ir.Call)
        tree = tree.arguments[1]
    assert tree == ir.Number(1.0)


def test_a_call_with_more_arguments_than_python_calls_may_be_deep():
    many = sys.getrecursionlimit() + 100
    assert parse("SUM(" + ",".join(["A1"] * many) + ")").arguments == (parse("A1"),) * many


def test_as_much_as_excel_takes():
    text = "A1" + "+A1" * 2730
    assert len(text) == 8192
    first, rest = ir.chain(parse(text))
    assert (first, {*rest}, len(rest)) == (parse("A1"), {("+", parse("A1"))}, 2730)
