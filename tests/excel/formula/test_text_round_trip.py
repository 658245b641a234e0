"""Resolved trees written as text and read again: the same tree."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Resolver, formula_text, ir, parse
from xlmc.excel.workbook.workbook import Formula

HERE = Cell("It's", 3, 3)
NAMES = {"Rate": "S!$C$3", "Twice": "LAMBDA(v,2*v)", "Half": "Rate/2", "Next": "!B1"}
LEAVES = [
    "A1",
    "$B$2:C3",
    "Data!A1",
    "'a b'!B2:B4",
    "A:A",
    "Jan:Data!A1",
    "Rate",
    "Half",
    "Next",
    "T[Low]",
    "[@Low]",
    "1.5",
    "1E-300",
    "12345678901234567",
    "0.1",
    "TRUE",
    "#SPILL!",
    "#N/A",
    '"a ""b"" c"',
    '"two\nlines, (and) {more}"',
    '""',
    '{1,-2.5;"x;y",#REF!}',
    "p",
]
templates = [
    "({}+{})",
    "({}-({}))",
    "({}^({}))",
    "({}&{})",
    "({}<>{})",
    "-({})",
    "--({})",
    "+({})",
    "({})%",
    "@({})",
    "SUM({},({},{}))",
    "IF({},,{})",
    "IF({},{},)",
    "OFFSET(A1,{},0):B9",
    "INDEX(A1:B2,{}) B:B",
    "LET(p,{},q,{},p+q)",
    "LET(_xlpm.p,{},_xlpm.q,{},SUM(_xlpm.p:_xlpm.q))",
    "LAMBDA(p,{}*p)({})",
    "LAMBDA(p,q,{})",
    "LAMBDA(_xlpm.p,_xlop.q,IF(ISOMITTED(_xlop.q),{},_xlpm.q))({})",
    "MAP({},_xleta.ABS)",
    "LET(f,LAMBDA(p,{}),f({}))",
    "Twice({})",
    "A1#+{}",
]


def filled(parts):
    def fill(template):
        return st.tuples(*[parts] * template.count("{}")).map(lambda given: template.format(*given))

    return st.sampled_from(templates).flatmap(fill)


@pytest.fixture(scope="module")
def resolver(workbook, table):
    sheets = {"'It''s'!E9": 1.0, "Jan!A1": 1.0, "'a b'!A1": 1.0, "Data!A7": 1.0}
    tables = [table("T", "'It''s'!B2:C5", "Low", "High")]
    return Resolver(workbook(sheets, names=NAMES | {"p": "7"}, tables=tables))


def round_trip(resolver, text):
    """The tree of a formula, and of its text, which has brackets around all of it."""
    tree = resolver.formula(HERE, Formula(text, HERE.row, HERE.column))
    if isinstance(tree, ir.Binary):
        tree = replace(tree, last=False)
    return tree, resolver.tree(parse(formula_text(tree, whole)), HERE)


def whole(place):
    return str(place.whole if isinstance(place, Area) else place)


@pytest.mark.parametrize("text", LEAVES + [template.replace("{}", "1.5") for template in templates])
def test_each_kind_of_part(resolver, text):
    tree, again = round_trip(resolver, text)
    assert again == tree


@settings(max_examples=300, deadline=None)
@given(st.recursive(st.sampled_from(LEAVES), filled, max_leaves=8))
def test_any_tree(resolver, text):
    tree, again = round_trip(resolver, text)
    assert again == tree


@settings(max_examples=200, deadline=None)
@given(st.floats(min_value=0, allow_infinity=False), st.text(st.characters(exclude_characters="\0\r", codec="utf-8")))
def test_any_number_and_any_text(resolver, number, text):
    quoted = text.replace('"', '""')
    tree, again = round_trip(resolver, f'F({number!r},"{quoted}")')
    assert (tree.arguments[0].value, tree.arguments[1].value) == (number, text)
    assert again == tree


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LET(p,A1,p*2)", "LET(_xlpm.p,'It''s'!A1,(_xlpm.p*2.0))"),
        ("LAMBDA(p,q,p+q)(1,2)", "LAMBDA(_xlpm.p,_xlpm.q,(_xlpm.p+_xlpm.q))(1.0,2.0)"),
        ("LET(f,LAMBDA(1),f())", "LET(_xlpm.f,LAMBDA(1.0),_xlpm.f())"),
        ("Twice(A1:B2)", "LAMBDA(_xlpm.v,(2.0*_xlpm.v))('It''s'!A1:B2)"),
        ("Jan:Data!A1", "((Jan!A1,'a b'!A1),Data!A1)"),
        ("[@Low]", "'It''s'!B3"),
        ("@A1:A3", "SINGLE('It''s'!A1:A3)"),
        ("A1#", "ANCHORARRAY('It''s'!A1)"),
        ("OFFSET(A1,1,0):B9", "(OFFSET('It''s'!A1,1.0,0.0):'It''s'!B9)"),
    ],
)
def test_how_it_is_written(resolver, text, expected):
    assert formula_text(round_trip(resolver, text)[0]) == expected
