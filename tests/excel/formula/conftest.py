"""Trees in one line, so that a table can hold them: `(+ A1 SUM(B1 2))`."""

from __future__ import annotations

import json

import pytest

from xlmc.excel.address import Area, Cell, column_letters, parse_address
from xlmc.excel.formula import Resolver, build_graph, ir, parse
from xlmc.excel.workbook.workbook import CellContent, Formula

SIGNS = {" ": "∩", ",": "∪"}


def _corner(corner):
    column = ("$" * corner.column_fixed + column_letters(corner.column)) if corner.column else ""
    return column + (("$" * corner.row_fixed + str(corner.row)) if corner.row else "")


def _prefix(tree):
    sheets = ":".join(name for name in (tree.sheet, getattr(tree, "last_sheet", None)) if name)
    return f"{tree.book or ''}{sheets}!" if tree.book or sheets else ""


def _shown(tree):
    match tree:
        case Cell() | Area():
            return str(tree)
        case ir.Number(value):
            return format(value, ".15g")
        case ir.Text(value):
            return json.dumps(value, ensure_ascii=False)
        case ir.Logical(value):
            return str(value).upper()
        case ir.ErrorLiteral(code):
            return code.text
        case ir.Missing():
            return "_"
        case ir.Reference(first, last):
            return _prefix(tree) + ":".join(_corner(corner) for corner in (first, last) if corner)
        case ir.Name(name):
            return f"<{_prefix(tree)}{name}>"
        case ir.TableReference(table, items, first, last):
            columns = ":".join(json.dumps(name, ensure_ascii=False) for name in (first, last) if name is not None)
            return f"{table or ''}[{' '.join([*items, *([columns] if columns else [])])}]"
        case ir.Unary(operator, operand):
            return f"({operator} {_shown(operand)})"
        case ir.Binary(operator, left, right):
            return f"({SIGNS.get(operator, operator)} {_shown(left)} {_shown(right)})"
        case ir.Call(name, arguments):
            return f"{name}({' '.join(map(_shown, arguments))})"
        case ir.Variable(name):
            return name
        case ir.FunctionName(name):
            return f"ƒ{name}"
        case ir.Let(bindings, body, recursive):
            bound = " ".join(f"{name}={_shown(value)}" for name, value in bindings)
            return f"LET{'!' * recursive}({bound} {_shown(body)})"
        case ir.Lambda(parameters, body, optional):
            shown = [f"[{p}]" if i >= len(parameters) - optional else p for i, p in enumerate(parameters)]
            return f"λ({' '.join([*shown, _shown(body)])})"
        case ir.Invoke(called, arguments):
            return f"[{_shown(called)}]({' '.join(map(_shown, arguments))})"
        case ir.Array(rows):
            return "{" + "; ".join(" ".join(map(_shown, row)) for row in rows) + "}"
    raise TypeError(tree)


@pytest.fixture(scope="session")
def shown():
    """A tree in one line."""
    return _shown


@pytest.fixture(scope="session")
def parsed():
    """The tree of a formula, in one line."""
    return lambda text: _shown(parse(text))


@pytest.fixture(scope="session")
def resolved(workbook):
    """`resolved("Rate*2", at="S!B1", cells={…}, names={…})`: the tree seen from that cell, in one line."""

    def resolve(text, at="S!B1", written_for=None, cells=None, **of_workbook):
        book = workbook(cells or {}, **of_workbook)
        host = parse_address(at)
        origin = parse_address(written_for or at)
        return _shown(Resolver(book).formula(host, Formula(text, origin.row, origin.column)))

    return resolve


@pytest.fixture(scope="session")
def graph_of(workbook):
    """`graph_of(cells, targets, inputs, held)`: the graph, all places as addresses."""

    def build(cells, targets, inputs=(), held=(), **of_workbook):
        def places(addresses):
            return [parse_address(address, "S") for address in addresses]

        book = workbook(cells, **of_workbook)
        return build_graph(Resolver(book), places(targets), frozenset(places(inputs)), frozenset(places(held)))

    return build


@pytest.fixture(scope="session")
def array():
    """`array("=A1:A3*2", "S!B1:B3", 7.0)`: the anchor of an array formula, with its cached value."""

    def make(text, area, cached=None, dynamic=False):
        filled = parse_address(area, "S")
        filled = filled if isinstance(filled, Area) else Area(filled.sheet, *(filled.row, filled.column) * 2)
        return CellContent(cached, Formula(text[1:], filled.top, filled.left, filled, dynamic))

    return make
