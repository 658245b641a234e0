from __future__ import annotations

import sys
from collections.abc import Sized

import pytest
from formulas.errors import FormulaError as ForeignFormulaError
from formulas.errors import TokenError
from formulas.parser import Parser
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.formula import compile_with_formulas, ir, parse
from xlmc.excel.formula.formula_tokens import TOKENS, tokens_at
from xlmc.excel.formula.parse import _TreeBuilder

TREES = {
    # numbers, texts, logicals, errors
    "12": "12",
    "12.5": "12.5",
    ".5": "0.5",
    "5.": "5",
    "1E5": "100000",
    "1e-3": "0.001",
    "2.5E+2": "250",
    "TRUE": "TRUE",
    "false": "FALSE",
    "TRUE()": "TRUE()",
    '"abc"': '"abc"',
    '""': '""',
    '"say ""hi"""': r'"say \"hi\""',
    '"two\nlines"': r'"two\nlines"',
    '"two\r\nlines"': r'"two\nlines"',
    '"tab\there"': r'"tab\there"',
    "#N/A": "#N/A",
    "#div/0!": "#DIV/0!",
    "#NAME?": "#NAME?",
    "#SPILL!": "#SPILL!",
    "#GETTING_DATA": "#GETTING_DATA",
    "#REF!": "#REF!",
    "Data!#REF!": "#REF!",
    "#REF!A1+1": "(+ #REF! 1)",
    "#REF!$A$1:$B$2": "#REF!",
    # operators, from tightest
    "A1:B2:C3": "(: A1:B2 C3)",
    "A1:B2 B1:B3": "(∩ A1:B2 B1:B3)",
    "A1 B1": "(∩ A1 B1)",
    "A1\tB1": "(∩ A1 B1)",
    "A1 (B1)": "(∩ A1 B1)",
    "--A1": "(- (- A1))",
    "---A1": "(- (- (- A1)))",
    "+A1": "(+ A1)",
    "- -1": "(- (- 1))",
    "1--1": "(- 1 (- 1))",
    "1-+-1": "(- 1 (+ (- 1)))",
    "2*-3": "(* 2 (- 3))",
    "-2^2": "(^ (- 2) 2)",
    "2^-1": "(^ 2 (- 1))",
    "2^3^2": "(^ (^ 2 3) 2)",
    "5%": "(% 5)",
    "5%%": "(% (% 5))",
    "5 %": "(% 5)",
    "A1%^2": "(^ (% A1) 2)",
    "-A1%": "(% (- A1))",
    "-(A1)%": "(% (- A1))",
    "10/5/2": "(/ (/ 10 5) 2)",
    "1+2*3": "(+ 1 (* 2 3))",
    "(1+2)*3": "(* (+ 1 2) 3)",
    "1-2-3": "(- (- 1 2) 3)",
    'A1&"x"&B1': '(& (& A1 "x") B1)',
    "1&2+3": "(& 1 (+ 2 3))",
    "1=1=1": "(= (= 1 1) 1)",
    'A1<>""': '(<> A1 "")',
    "A1<=B1": "(<= A1 B1)",
    "A1 >= B1": "(>= A1 B1)",
    "@A1:A3": "SINGLE(A1:A3)",
    "-@A1": "(- SINGLE(A1))",
    "A1#": "ANCHORARRAY(A1)",
    "A1#%": "(% ANCHORARRAY(A1))",
    # references
    "A1": "A1",
    "$A$1": "$A$1",
    "a$1": "A$1",
    "A1:$B2": "A1:$B2",
    "A1 : B2": "(: A1 B2)",
    "A:C": "A:C",
    "$A:C": "$A:C",
    "1:3": "1:3",
    "$1:3": "$1:3",
    "Data!A1": "Data!A1",
    "'My sheet'!A1:B2": "My sheet!A1:B2",
    "'It''s'!A1": "It's!A1",
    "Data!A1:Data!A3": "(: Data!A1 Data!A3)",
    "(A1):B2": "(: A1 B2)",
    "OFFSET(A1,1,1):B9": "(: OFFSET(A1 1 1) B9)",
    "Jan:Dec!A1": "Jan:Dec!A1",
    "'Jan:De c'!A1": "Jan:De c!A1",
    "[1]Data!A1": "[1]Data!A1",
    "'[Book.xlsx]Data'!A1": "[Book.xlsx]Data!A1",
    "XFD1048576": "XFD1048576",
    # names
    "Rate": "<Rate>",
    "Data!Rate": "<Data!Rate>",
    "'My sheet'!Rate": "<My sheet!Rate>",
    "[0]!Rate": "<[0]!Rate>",
    "Größe*2": "(* <Größe> 2)",
    "_x.y\\z?": "<_x.y\\z?>",
    "TRUEX": "<TRUEX>",
    "A1.B1": "<A1.B1>",
    "YAW1": "<YAW1>",  # beyond column XFD: no cell
    "A1048577": "<A1048577>",
    "Data!YAW1+1": "(+ <Data!YAW1> 1)",
    "Rate:B2": "(: <Rate> B2)",
    # tables
    "Table1[Low]": 'Table1["Low"]',
    "Table1[]": "Table1[]",
    "Table1[#All]": "Table1[#all]",
    "[@Low]": '[#this row "Low"]',
    "[@[Low likeliest]]": '[#this row "Low likeliest"]',
    "[@]": "[#this row]",
    "Table1[@[a]:[b]]": 'Table1[#this row "a":"b"]',
    "Table1[[#This Row],[a]:[b]]": 'Table1[#this row "a":"b"]',
    "Table1[[#Headers], [#Data], [a]]": 'Table1[#headers #data "a"]',
    "Table1[[a]:[b]]": 'Table1["a":"b"]',
    "Table1[[a,b]]": 'Table1["a,b"]',
    "Table1['[x'']": 'Table1["[x\'"]',
    "Table1['#x]*[@'@y]": '(* Table1["#x"] [#this row "@y"])',
    # calls and arrays
    "PI()": "PI()",
    "SUM(A1,,B2)": "SUM(A1 _ B2)",
    "SUM( A1 , B1 )": "SUM(A1 B1)",
    "SUM((A1,B2))": "SUM((∪ A1 B2))",
    "SUM(A1:B1 B1:C1)": "SUM((∩ A1:B1 B1:C1))",
    "IF(A1>0,,2)": "IF((> A1 0) _ 2)",
    "if(A1,B1)": "IF(A1 B1)",
    "LOG10(A1)": "LOG10(A1)",
    "_xlfn.STDEV.S(A1)": "STDEV.S(A1)",
    "_xlfn._xlws.SORT(A1)": "SORT(A1)",
    "[1]!CB.GetForeFN(A1)": "CB.GETFOREFN(A1)",
    "Sheet1!MyLambda(2)": "[<Sheet1!MyLambda>](2)",
    "LAMBDA(x,x+1)(2)": "[LAMBDA(<x> (+ <x> 1))](2)",
    "2*LAMBDA(x,LAMBDA(y,x))(1)(2)": "(* 2 [[LAMBDA(<x> LAMBDA(<y> <x>))](1)](2))",
    "SUM(LAMBDA(x,x)(1),2)": "SUM([LAMBDA(<x> <x>)](1) 2)",
    "ARRAY(1,2)": "ARRAY(1 2)",
    "{1,2;3,4}": "{1 2; 3 4}",
    '{-1, "a" ; TRUE ,#N/A }': '{(- 1) "a"; TRUE #N/A}',
    "SUM({1,2}*2)": "SUM((* {1 2} 2))",
    "A1\n+ B1": "(+ A1 B1)",
    "SUM(\r\n\tA1)": "SUM(A1)",
    "  A1  ": "A1",
}

FAULTS = {
    # formula -> where the marked part begins
    "": 0,
    "1+": 1,
    "*5": 0,
    "%5": 0,
    "5+%3": 2,
    "SUM(A1": 4,
    "A1)": 2,
    "A1)-(B1": 2,
    "1)*(2": 1,
    'SUM("(")+A1)*(3': 11,
    "Table1[a(b]+1)*(2": 13,
    "()": 1,
    '"abc': 0,
    "A1;B1": 2,
    "SUM(A1;B1)": 6,
    "SUM(A1}": 6,
    "SUM({1,2)": 8,
    "1 + (2)(3)": 9,
    "(A1)(2)": 6,
    "(1)2": 3,
    'A1"b"': 2,
    "10%5": 3,
    "SUM(1,*5)": 6,
    "SUM(5,1+,2)": 8,
    "(A1,)": 4,
    "A1=<B1": 3,
    "==1": 0,
    "{1;2,3}": 6,
    "{}": 1,
    "{A1}": 3,
    "{1,{2}}": 6,
    "{1,}": 3,
    "1.5.2": 0,
    "1E999": 0,
    "#FOO!": 0,
    "#A1": 0,
    "Table1[[a],[b]]": 0,
    "1+Table1[[a]x[b]]": 2,
    "Table1[[#All],a]": 0,
    "Table1[[a]:[b]:[c]]": 0,
    "Data!Table1[a]": 0,
    "$YAW$1": 0,
    "YAW1:B2": 0,
    "$A$1:$B": 5,
    "R[1]C": 0,
    "A1+👍": 3,
    "\x00": 0,
}


@pytest.mark.parametrize("text", TREES)
def test_a_formula_and_its_tree(parsed, text):
    assert parsed(text) == TREES[text]


@pytest.mark.parametrize("text", FAULTS)
def test_a_fault_is_marked_where_it_stands(text):
    with pytest.raises(FormulaError, match="cannot be read") as caught:
        parse(text)
    assert caught.value.text == text
    assert caught.value.span == (FAULTS[text], FAULTS[text] + 1)


def test_line_breaks_leave_the_mark_in_place():
    with pytest.raises(FormulaError) as caught:
        parse('A1+\r\n"x\r\ny"&/2')
    assert caught.value.span == (12, 13)


ALPHABET = ["A1", "$B$2", "C:C", "3:4", "Data!A1", "Rate", "Table1[a]", "[@b]", "SUM(", "IF(", "1", "2.5", "1E5", '"t"']
ALPHABET += ["TRUE", "#N/A", "#REF!", "'a b'!A1", "[1]X!A1", *"{};,()+-*/^&=<>%:@# \t\n\"'![]é$."]


@settings(max_examples=1500)
@given(st.lists(st.sampled_from(ALPHABET), max_size=12).map("".join) | st.text(max_size=20))
def test_any_text_is_a_tree_or_a_fault_within_it(text):
    fault = None
    try:
        assert isinstance(parse(text), ir.Expression)
    except FormulaError as error:
        fault = error
    if fault is not None:
        start, end = fault.span
        assert fault.text == text
        assert 0 <= start < end <= max(1, len(text))


@given(st.lists(st.sampled_from(ALPHABET), max_size=6).map("".join) | st.text(max_size=8))
def test_what_is_not_tried_at_a_text_does_not_match_it(text):
    matching = [token for token in TOKENS if token._re.match(text)]
    assert [token for token in tokens_at(text) if token in matching] == matching


MANY = sys.getrecursionlimit() + 100
"""More than Python's own calls may be deep."""


@pytest.mark.parametrize("part", ["+A1", "&A1", "%"])
def test_long_formulas(part):
    tree = parse("A1" + part * MANY)
    depth = 0
    while isinstance(tree, ir.Binary | ir.Unary):
        tree = tree.left if isinstance(tree, ir.Binary) else tree.operand
        depth += 1
    assert depth == MANY


@pytest.mark.parametrize(("opening", "closing"), [("(", ")"), ("ABS(", ")"), ("-", ""), ("1+(", ")")])
def test_deep_formulas(opening, closing):
    assert isinstance(parse(opening * MANY + "A1" + closing * MANY), ir.Expression)


def test_the_same_text_is_parsed_once():
    assert parse("A1+Rate") is parse("A1+Rate")


class TestTheSeam:
    """What of `formulas` the parser leans on: where one of these breaks, so does the parser."""

    def test_the_builder_and_the_tokens_are_class_attributes(self):
        assert isinstance(Parser.filters, list)
        assert isinstance(Parser.ast_builder, type)
        assert all(isinstance(token, type) for token in Parser.filters)

    def test_a_parser_gives_the_postfix_stream_to_its_builder(self):
        class Recorder(list):
            def __init__(self, match=None):
                super().__init__()
                self.seen = []

            def append(self, token):
                self.seen.append(token.name)
                del self[:]
                super().append(token)

            def finish(self):
                self.finished = True

        class Listening(Parser):
            ast_builder = Recorder

        tokens, builder = Listening().ast("=1+A1*SUM(2,3)")
        assert builder.seen == ["1", "A1", "2", "3", "SUM", "*", "+"]
        assert builder.finished
        assert [token.name for token in tokens][:3] == ["1", "+", "A1"]

    def test_a_filter_is_asked_with_the_rest_of_the_text(self):
        asked = []

        class Listening(Parser):
            def __init__(self):
                super().__init__()
                self.filters = [self.note, *Parser.filters]

            def note(self, text, context, parser):
                asked.append(text)
                raise TokenError(text)

        Listening().ast("=1+22")
        assert asked == ["1+22", "+22", "22"]

    def test_a_token_knows_its_own_text(self):
        token = Parser.filters[4]("A1 + 1", None, Parser())
        assert (token.name, token.source[: token.end_match]) == ("A1", "A1")

    def test_calls_know_how_many_arguments_they_took(self):
        class Counting(_TreeBuilder):
            counts = ()

            def append(self, token):
                if token.name == "SUM":
                    type(self).counts += (token.get_n_args,)
                super().append(token)

        class Listening(Parser):
            ast_builder = Counting

            def __init__(self):
                super().__init__()
                self.filters = TOKENS

        Listening().ast("=SUM()+SUM(1)+SUM(1,,2)")
        assert Counting.counts == (0, 1, 3)

    def test_a_mistake_is_a_formula_error(self):
        with pytest.raises(ForeignFormulaError):
            Parser().ast("=1+")
        assert issubclass(TokenError, ForeignFormulaError)
        assert issubclass(_TreeBuilder, Sized)


@pytest.mark.parametrize(
    ("text", "values", "expected"),
    [
        ("A1+B1*2", {"A1": 1.0, "B1": 3.0}, 7.0),
        ("A1>1", {"A1": 2.0}, True),
        ("1/A1", {"A1": 0.0}, ErrorCode.DIV0),
        ("A1+1", {"A1": ErrorCode.NA}, ErrorCode.NA),
        ("A1+1", {"A1": None}, 1.0),
        ('A1&"x"', {"A1": "y"}, "yx"),
        ("1+1", {}, 2.0),
    ],
)
def test_what_formulas_compiles_itself(text, values, expected):
    result = compile_with_formulas(text)(values)
    assert (type(result), result) == (type(expected), expected)


@pytest.mark.parametrize(
    ("text", "values"), [("NOSUCH(A1)", {"A1": 1.0}), ("#SPILL!", {}), ("(A1,B1)", {"A1": 1.0, "B1": 2.0})]
)
def test_what_formulas_cannot_compute(text, values):
    with pytest.raises(FormulaError, match="The engine `formulas` cannot compute this"):
        compile_with_formulas(text)(values)
