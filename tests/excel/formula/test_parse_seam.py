"""What more of `formulas` the parser leans on than its token lists: the stack machine, seen through its own tokens."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
from formulas.errors import FormulaError, ParenthesesError, TokenError
from formulas.parser import Parser
from formulas.tokens import Token
from formulas.tokens.function import Array, Function
from formulas.tokens.operand import Empty, Error, Number, Operand, Range, String
from formulas.tokens.operator import Intersect, Operator, OperatorToken, Separator
from formulas.tokens.parenthesis import Parenthesis, _update_n_args

from xlmc.excel.formula.formula_tokens import TOKENS, _Operator

PYPROJECT = Path(__file__).parents[3] / "pyproject.toml"


class Recorder:
    """A builder that keeps the postfix stream."""

    def __init__(self, match):
        self.match = match
        self.stream = []

    def __len__(self):
        return 1

    def __getitem__(self, index):
        return self.stream[index]

    def append(self, token):
        if isinstance(token, Operand):
            self.stream.append("Empty" if isinstance(token, Empty) else token.name)
        else:
            self.stream.append(f"{type(token).__name__}{token.name.replace(' ', '∩')}{token.get_n_args}")

    def finish(self):
        self.stream = tuple(self.stream)


class Listening(Parser):
    ast_builder = Recorder


def stream(text):
    return Listening().ast(f"={text}")[1].stream


def test_the_release_is_the_one_that_was_measured():
    pinned = tomllib.loads(PYPROJECT.read_text(encoding="utf-8"))["project"]["dependencies"]
    assert "formulas==1.3.*" in pinned
    assert re.match(r"1\.3\.", version("formulas"))


def test_the_kinds_of_token_and_the_order_they_are_tried_in():
    kept = [token for token in Parser.filters if token.__name__ not in ("Lambda", "Range", "Number")]
    assert kept == [Error, String, OperatorToken, Separator, Function, Array, Parenthesis, Intersect]
    assert {Number, Range} < set(Parser.filters)
    replaced = [base for base in kept if any(issubclass(token, base) for token in TOKENS)]
    assert replaced == [OperatorToken, Separator, Function, Array, Parenthesis, Intersect]
    assert sum(issubclass(token, Operand) for token in TOKENS) == 7


def test_what_a_token_offers():
    token = Function("SUM(1)+2", None, Parser())
    assert (token.source, token.end_match, token.source[: token.end_match]) == ("SUM(1)+2", 4, "SUM(")
    assert (token.name, token.get_name, token.has_name, token.has_call) == ("SUM", "SUM", True, False)
    assert Function("PI()").has_call


def test_a_token_class_of_ones_own_needs_an_expression_and_no_more():
    class Word(Token):
        _re = re.compile(r"(?P<name>\w+)(?P<other>!)?")

    assert Word("abc").attr == {"name": "abc"}
    assert Word("abc!").attr == {"name": "abc", "other": "!"}
    with pytest.raises(TokenError):
        Word("-")


def test_what_process_gives_becomes_the_attributes():
    class Named(Intersect):
        def process(self, match, context=None, parser=None):
            return {"name": "x", "parser": parser, "context": context}

    assert Named("  ", "c", "p").attr == {"name": "x", "parser": "p", "context": "c"}


def test_the_precedences():
    ranks = Operator._precedences
    tight = [{":", " ", ","}, {"u-", "u+", "@"}, {"%"}, {"^"}, {"*", "/"}, {"+", "-"}, {"&"}]
    order = [*tight, {"=", "<", ">", "<=", ">=", "<>"}]
    levels = sorted(set(ranks.values()), reverse=True)
    assert [{name for name in ranks if ranks[name] == level} for level in levels] == order
    ours = _Operator._precedences
    assert ours["#"] > ours[":"] > ours[" "] == ranks[" "] > ours["u-"] == ours["@"] == ranks["u-"]


STREAMS = {
    # formula -> operands, and of what takes some: class, name and how many
    "1+2*3": "1 2 3 OperatorToken*2 OperatorToken+2",
    "1-2-3": "1 2 OperatorToken-2 3 OperatorToken-2",
    "-2^2": "2 OperatorTokenu-1 2 OperatorToken^2",
    "2%": "2 OperatorToken%1",
    "F()": "FunctionF0",
    "F(1,,2)": "1 Empty 2 FunctionF3",
    "F(,)": "Empty Empty FunctionF2",
    "F((1,2),3)": "1 2 Separator,2 3 FunctionF2",
    "(A1,B1,C1)": "A1 B1 C1 Separator,2 Separator,2",
    "A1 B1": "A1 B1 Intersect∩2",
    "{1,2;3,4}": "1 2 FunctionARRAY2 3 4 FunctionARRAY2 FunctionARRAY2",
}


@pytest.mark.parametrize("text", STREAMS)
def test_the_postfix_stream(text):
    assert " ".join(stream(text)) == STREAMS[text]


def test_the_builder_gets_the_match_and_is_measured_and_finished():
    _, builder = Listening().ast("=1+2")
    assert builder.match["name"] == "1+2"
    assert isinstance(builder.stream, tuple)


@pytest.mark.parametrize("text", ["(1", "F(1", "1)", "{1", "{1,2;3}", "{1}}"])
def test_brackets_that_do_not_pair_are_mistakes(text):
    with pytest.raises(FormulaError):
        stream(text)
    assert issubclass(ParenthesesError, FormulaError)


def test_an_operand_beside_another_is_left_to_the_next_kind_of_token():
    with pytest.raises(TokenError):
        Number("1").ast([Number("2")], [], Recorder(None))
    with pytest.raises(TokenError):
        Parenthesis("(").ast([Number("2")], [], Recorder(None))


def test_brackets_count_their_operands_on_the_stack():
    opened = Parenthesis("(")
    stack = []
    opened.ast([], stack, Recorder(None))
    assert stack == [opened]
    assert (opened.has_start, opened.has_end, opened.n_args) == (True, False, 0)
    _update_n_args(stack)
    _update_n_args([*stack, Number("1")])
    assert opened.n_args == 1


def test_an_open_bracket_says_how_many_operands_it_wants():
    stack = []
    Array("{1}").ast([], stack, Recorder(None))
    names = [token.name for token in stack]
    assert names == ["ARRAY", "(", "ARRAY", "("]
    assert [type(token) for token in stack[::2]] == [Function, Function]
    assert (Array("{").has_start, Array(";").has_sep, Array("}").has_end) == (True, True, True)


def test_line_breaks_are_lost_before_any_token_sees_them():
    assert stream('"a\nb"') == ("ab",)  # why the parser hides them from it
    assert stream('"a\0b"') == ("a\0b",)


def test_the_first_that_reads_it_has_it():
    asked = []

    def first(text, context, parser):
        asked.append((text, context, type(parser)))
        raise TokenError(text)

    parser = Listening()
    parser.filters = [first, *Parser.filters]
    parser.ast("=1+2", context="c")
    assert asked == [("1+2", "c", Listening), ("+2", "c", Listening), ("2", "c", Listening)]


def test_a_formula_error_ends_it_at_once():
    def never(text, context, parser):
        raise FormulaError(text)

    parser = Listening()
    parser.filters = [never, *Parser.filters]
    with pytest.raises(FormulaError):
        parser.ast("=1")
