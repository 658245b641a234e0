"""Formulas from a grammar: any function of the registry with any argument, in any nesting."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from functools import cache
from typing import Final

from fuzzing import hostile
from fuzzing.books import ROOT
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.registry import Function, Kind, Parameter

__all__ = ["formula", "names"]

_MOST_ARGUMENTS: Final = 6
_DEEPEST: Final = 4
_CELLS: Final = (
    "A1",
    "A2",
    "A3",
    "A4",
    "A5",
    "A6",
    "A7",
    "A8",
    "A9",
    "B1",
    "B2",
    "B3",
    "C4",
    "D6",
    "$A$1",
    "H9",
    "XFD1",
)
_RANGES: Final = (
    "A1:A4", "A1:A9", "B1:D6", "B1:B6", "B1:D1", "C2:D3", "A1:D1", "$B$1:$D$6", "H1:I3", "B:B", "2:2", "A1:A1", "D6:B1",
    "S!B1:D6", "Data", "Data[x]", "Data[[x]:[y]]", "Data[#All]", "Data[#Headers]", "rates", "E1#", "ANCHORARRAY(E1)",
    "A1:A4 A2:B3", "(A1:A2,B1:B2)", "S:T!A1", "OFFSET(A1,1,1,2,2)", 'INDIRECT("B1:C3")', "INDEX(B1:D6,0,1)",
    "OFFSET(B1,A5,0)", 'INDIRECT("no such")', "OFFSET(A1,-1,0)", "Q!A1", "B1:INDEX(B1:D6,2,2)", "IF(A1>0,B1:B3,C1:C2)",
)  # fmt: skip
_ARRAYS: Final = (
    "{1,2,3}", "{1;2;3}", "{1,2;3,4}", '{"a","b"}', "{TRUE,#N/A}", "{1}", "{-1.5;2;#DIV/0!}", '{"x",1;TRUE,2}',
    "SEQUENCE(3)", "SEQUENCE(2,3)", "TRANSPOSE(B1:D2)", "B1:B6*2", "B1:D1+B1:B6", "ROW(1:5)", "SEQUENCE(0)",
    "FILTER(B1:B6,B1:B6>1E9)", "MUNIT(3)", "HSTACK(A1,B1:B2)", "UNIQUE(B1:B6)", "SORT(B1:B6)",
)  # fmt: skip
_OPERATORS: Final = ("+", "-", "*", "/", "^", "&", "=", "<>", "<", ">", "<=", ">=", ":", " ", ",")
_WEIGHTS: Final = (9, 9, 9, 9, 5, 3, 2, 1, 2, 2, 1, 1, 0.2, 0.2, 0.2)
_NAMES: Final = ("rates", "Twice", "nope", "_xlfn.X", "x", "A1B", "TRUE", "T!local")
_SPECIAL: Final = (
    "IF", "IFERROR", "IFNA", "IFS", "SWITCH", "CHOOSE", "LET", "LAMBDA", "MAP", "REDUCE", "SCAN", "BYROW", "BYCOL",
    "MAKEARRAY", "ISOMITTED", "INDIRECT", "OFFSET", "INDEX", "ROW", "COLUMN", "ROWS", "COLUMNS", "AREAS", "CELL",
    "SUBTOTAL", "AGGREGATE", "SUMIF", "SUMIFS", "COUNTIF", "AVERAGEIF", "MAXIFS", "ISREF", "FORMULATEXT", "ISFORMULA",
    "SUMPRODUCT", "XLOOKUP", "VLOOKUP", "MATCH", "XMATCH", "LOOKUP", "INDEX", "FILTER", "SORTBY", "TAKE", "DROP",
)  # fmt: skip


@cache
def names() -> tuple[str, ...]:
    """Every function that xlmc computes, as its page lists them."""
    listed = (ROOT / "docs" / "functions.md").read_text(encoding="utf-8")
    return tuple(sorted(set(re.findall("`([A-Z][A-Z0-9.]*)`", listed))))


def formula(rng: random.Random, depth: int | None = None) -> str:
    """A formula without its `=`; often one that parses."""
    depth = rng.choice([1, 2, 2, 3, 3, _DEEPEST]) if depth is None else depth
    return _call(rng, depth) if rng.random() < 0.75 else _expression(rng, depth)


def _expression(rng: random.Random, depth: int) -> str:
    if depth <= 0:
        return _leaf(rng)
    made = rng.choices(_FORMS, _FORM_WEIGHTS)[0]
    return made(rng, depth)


def _leaf(rng: random.Random) -> str:
    return rng.choices(_LEAVES, _LEAF_WEIGHTS)[0](rng)


def _number(rng: random.Random) -> str:
    if rng.random() < 0.5:
        return rng.choice(["0", "1", "2", "3", "-1", "0.5", "10", "1.5", "4", "100", "0.05", "12", "39448", "45000"])
    result = hostile.number(rng)
    return result if re.fullmatch(r"-?\d+(\.\d+)?([Ee][+-]?\d+)?", result) else "7"


def _text(rng: random.Random) -> str:
    if rng.random() < 0.5:
        return rng.choice(
            ['"x"', '"1"', '">1"', '"a*"', '"B1"', '"yyyy-mm-dd"', '"0.00"', '"i"', '"m"', '"1+2i"', '""']
        )
    return '"' + hostile.text(rng)[:200].replace('"', '""') + '"'


def _binary(rng: random.Random, depth: int) -> str:
    left, right = _expression(rng, depth - 1), _expression(rng, depth - 1)
    result = f"{left}{rng.choices(_OPERATORS, _WEIGHTS)[0]}{right}"
    return f"({result})" if rng.random() < 0.5 else result


def _unary(rng: random.Random, depth: int) -> str:
    inner = _expression(rng, depth - 1)
    return rng.choice([f"-{inner}", f"+{inner}", f"--{inner}", f"({inner})%", f"@{inner}", f"({inner})"])


def _call(rng: random.Random, depth: int) -> str:
    if rng.random() < 0.25:
        return _special(rng, depth)
    name = rng.choice(names())
    row = function_named(name)
    if row is None:
        return _special(rng, depth, name)
    return f"{_prefix(rng)}{name}({','.join(_arguments(rng, row, depth))})"


def _prefix(rng: random.Random) -> str:
    return "_xlfn." if rng.random() < 0.05 else ""


def _arguments(rng: random.Random, row: Function, depth: int) -> list[str]:
    fewest, most = row.arity()
    count = rng.randint(fewest, min(most, max(fewest, _MOST_ARGUMENTS)))
    if rng.random() < 0.03:
        count = max(0, count + rng.choice([-1, 1]))
    return [_argument(rng, row, position, depth) for position in range(count)]


def _argument(rng: random.Random, row: Function, position: int, depth: int) -> str:
    if rng.random() < 0.03:
        return ""  # left out
    if rng.random() < 0.4 or position >= len(row.parameters):
        return _expression(rng, depth - 1)
    return _fitting(rng, row.parameters[position], depth)


def _fitting(rng: random.Random, parameter: Parameter, depth: int) -> str:
    if parameter.ranged and rng.random() < 0.7:
        return rng.choice(_RANGES if rng.random() < 0.7 else _ARRAYS)
    if rng.random() < 0.4:
        return rng.choice(_CELLS)
    if parameter.kind is Kind.TEXT:
        return _text(rng)
    if parameter.kind is Kind.LOGICAL:
        return rng.choice(["TRUE", "FALSE", "0", "1", "A1>0"])
    return _number(rng) if rng.random() < 0.6 else _expression(rng, depth - 1)


def _special(rng: random.Random, depth: int, name: str | None = None) -> str:
    name = rng.choice(_SPECIAL) if name is None else name
    made = _OWN_SHAPE.get(name)
    if made is not None and rng.random() < 0.9:
        return made(rng, depth)
    arguments = [_expression(rng, depth - 1) for _ in range(rng.choice([0, 1, 1, 2, 2, 3, 3, 4, 5]))]
    return f"{name}({','.join(arguments)})"


def _let(rng: random.Random, depth: int) -> str:
    value = _expression(rng, depth - 1)
    body = _splice(rng, _expression(rng, depth - 1), "v")
    return f"LET(v,{value},w,v{rng.choice('+*&')}1,{body})"


def _splice(rng: random.Random, body: str, *variables: str) -> str:
    """The body with its cells replaced by variables, some of them."""
    return re.sub(r"\b[AB][1-4]\b", lambda result: rng.choice([*variables, result[0]]), body)


def _lambda(rng: random.Random, depth: int, *parameters: str) -> str:
    body = _splice(rng, _expression(rng, depth - 1), *parameters) if parameters else _expression(rng, depth - 1)
    if rng.random() < 0.5 and parameters:
        body = "+".join(parameters) if rng.random() < 0.5 else parameters[-1]
    return f"LAMBDA({','.join([*parameters, body])})"


def _called(rng: random.Random, depth: int) -> str:
    parameters = ["p", "q", "r"][: rng.randint(0, 3)]
    given = [_expression(rng, depth - 1) for _ in parameters]
    if rng.random() < 0.1:
        given.append("1")
    return f"{_lambda(rng, depth, *parameters)}({','.join(given)})"


def _mapped(name: str, *parameters: str) -> Callable[[random.Random, int], str]:
    def made(rng: random.Random, depth: int) -> str:
        before = {"REDUCE": [_expression(rng, depth - 1)], "SCAN": [_expression(rng, depth - 1)]}.get(name, [])
        over = rng.choice(_RANGES if rng.random() < 0.5 else _ARRAYS)
        sizes = [_number(rng) if rng.random() < 0.1 else str(rng.randint(0, 4)) for _ in range(2)]
        given = sizes if name == "MAKEARRAY" else [*before, over]
        return f"{name}({','.join(given)},{_lambda(rng, depth, *parameters)})"

    return made


def _indirect(rng: random.Random, depth: int) -> str:
    inside = [
        f'"{hostile.address(rng)}"',
        '"B"&A5',
        '"B"&ROW()',
        '"Data[x]"',
        '"rates"',
        '"S!B1:B"&2',
        _expression(rng, depth - 1),
    ]
    return f"INDIRECT({rng.choice(inside)}{rng.choice(['', '', ',TRUE', ',FALSE', ',A1'])})"


def _offset(rng: random.Random, depth: int) -> str:
    start = rng.choice(_CELLS + _RANGES[:12])
    numbers = [rng.choice(["0", "1", "-1", "2", "A5", "", _number(rng), _expression(rng, depth - 1)]) for _ in range(4)]
    return f"OFFSET({start},{','.join(numbers[: rng.randint(2, 4)])})"


_OWN_SHAPE: Final[dict[str, Callable[[random.Random, int], str]]] = {
    "LET": _let,
    "LAMBDA": _called,
    "MAP": _mapped("MAP", "p"),
    "REDUCE": _mapped("REDUCE", "p", "q"),
    "SCAN": _mapped("SCAN", "p", "q"),
    "BYROW": _mapped("BYROW", "p"),
    "BYCOL": _mapped("BYCOL", "p"),
    "MAKEARRAY": _mapped("MAKEARRAY", "p", "q"),
    "INDIRECT": _indirect,
    "OFFSET": _offset,
}
_LEAVES: Final[Sequence[Callable[[random.Random], str]]] = (
    lambda rng: rng.choice(_CELLS),
    _number,
    _text,
    lambda rng: rng.choice(["TRUE", "FALSE"]),
    lambda rng: rng.choice(hostile.ERRORS),
    lambda rng: rng.choice(_RANGES),
    lambda rng: rng.choice(_ARRAYS),
    lambda rng: rng.choice(_NAMES),
    hostile.address,
)
_LEAF_WEIGHTS: Final = (12, 8, 4, 2, 1, 5, 3, 0.6, 0.4)
_FORMS: Final[Sequence[Callable[[random.Random, int], str]]] = (
    lambda rng, _: _leaf(rng),
    _binary,
    _unary,
    _call,
)
_FORM_WEIGHTS: Final = (4, 4, 1, 6)
