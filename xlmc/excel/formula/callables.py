"""Which names stand for a LAMBDA: by itself, by another name, by LET, or by a call that gives one."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["calls_function", "function_named_by", "gives_function", "stands_for_function"]

_FUNCTION: Final = re.compile(r"(?:_xlfn\.)?_xleta\.((?:_xlfn\.|_xlws\.)*)(?P<name>.+)", re.IGNORECASE)
_CHOOSING: Final = frozenset({"IF", "IFS", "SWITCH", "CHOOSE", "IFERROR", "IFNA"})

_Bound = Mapping[str, ir.Expression]


def function_named_by(name: str) -> str | None:
    """Return the function that a file gives as a value: `_xleta.SUM` is SUM; None of any other name."""
    match = _FUNCTION.fullmatch(name)
    return None if match is None else match["name"].upper()


def stands_for_function(workbook: Workbook, name: str, sheet: str | None) -> bool:
    """Whether a defined name, as a sheet or the whole workbook sees it, stands for a LAMBDA or another function."""
    return _defined(workbook, name, sheet, frozenset()) is not None


def calls_function(workbook: Workbook, name: str, sheet: str | None) -> bool:
    """Whether a call by that name calls what a defined name stands for.

    Excel's own functions go first: `Sum(2)` is SUM, whatever `Sum` is defined as. A file marks those that came after
    Excel 2007 by `_xlfn.`, so that without the mark the name of one of these is the defined name's.
    """
    return stands_for_function(workbook, name, sheet) and not _is_excels_own(name)


def _is_excels_own(name: str) -> bool:
    """Whether it is a function that files name without a mark."""
    from openpyxl.utils import FORMULAE  # slow to import

    return name.upper() in FORMULAE


def gives_function(tree: ir.Expression) -> bool:
    """Whether a resolved tree, as the whole formula of a cell, gives a LAMBDA that nothing calls."""
    return _last(tree, {}, 0) is not None


_DEEPEST: Final = 60


def _last(tree: ir.Expression, bound: _Bound, depth: int) -> ir.Lambda | ir.FunctionName | None:
    """Return the function that a resolved tree gives; None if it gives none, or that cannot be seen."""
    if depth > _DEEPEST:
        return None
    match tree:
        case ir.Lambda() | ir.FunctionName():
            return tree
        case ir.Variable(name) if name in bound:
            return _last(bound[name], bound, depth + 1)
        case ir.Let(bindings, body):
            return _last(body, {**bound, **dict(bindings)}, depth + 1)
        case ir.Invoke(function, arguments):
            called = _last(function, bound, depth + 1)
            if not isinstance(called, ir.Lambda):
                return None
            given = dict(zip(called.parameters, arguments, strict=False))
            return _last(called.body, {**bound, **given}, depth + 1)
        case ir.Call(name, arguments) if name in _CHOOSING:
            return next((result for part in arguments[1:] if (result := _last(part, bound, depth + 1))), None)
        case _:
            return None


def _defined(workbook: Workbook, name: str, sheet: str | None, seen: frozenset[str]) -> ir.Expression | None:
    """Return the LAMBDA, as written, that a defined name stands for."""
    defined_name = workbook.defined_name(name, sheet)
    if defined_name is None or name.casefold() in seen:
        return None
    try:
        tree = parse(defined_name.text)
    except FormulaError:
        return None
    seen_as = sheet if defined_name.sheet is not None else None
    return _written(workbook, tree, seen_as, {}, seen | {name.casefold()})


def _written(
    workbook: Workbook, tree: ir.Expression, sheet: str | None, bound: _Bound, seen: frozenset[str]
) -> ir.Expression | None:
    """Return the LAMBDA that a tree as written gives; a function that is named stands for itself."""

    def of(part: ir.Expression, more: _Bound = bound) -> ir.Expression | None:
        return _written(workbook, part, sheet, more, seen)

    match tree:
        case ir.Call("LAMBDA"):
            return tree
        case ir.Call("LET", arguments):
            names = [part.name.casefold() for part in arguments[:-1:2] if isinstance(part, ir.Name)]
            return of(arguments[-1], {**bound, **dict(zip(names, arguments[1::2], strict=False))})
        case ir.Call(name, arguments) if name in _CHOOSING:
            return next((expression for part in arguments[1:] if (expression := of(part))), None)
        case ir.Call(name) if not _is_excels_own(name):
            return _result(of(ir.Name(name)), of)
        case ir.Invoke(function):
            return _result(of(function), of)
        case ir.Name(name) if function_named_by(name):
            return tree
        case ir.Name(name, None) if name.casefold() in bound:
            return of(bound[name.casefold()], {key: part for key, part in bound.items() if key != name.casefold()})
        case ir.Name(name, named_sheet):
            return _defined(workbook, name, named_sheet or sheet, seen)
        case _:
            return None


def _result(
    function: ir.Expression | None, of: Callable[[ir.Expression], ir.Expression | None]
) -> ir.Expression | None:
    """Return the LAMBDA that a call of a LAMBDA gives, as `LAMBDA(a, LAMBDA(b, a+b))(1)` does."""
    return of(function.arguments[-1]) if isinstance(function, ir.Call) and function.arguments else None
