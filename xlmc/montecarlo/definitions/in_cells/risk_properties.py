"""@RISK's property functions: what a call says of its draw behind the parameters.

| function | meaning |
|---|---|
| RiskTruncate(min, max) | cutoffs before the shift |
| RiskTruncate2(min, max) | cutoffs after it |
| RiskTruncateP(p1, p2) | cutoffs as the probabilities below them |
| RiskShift(x) | is added to each draw |
| RiskName("…"), RiskUnits("…") | for reports, and for the random stream |
| RiskStatic(x) | the base case |
| RiskLock() | hold the draw at its base case |
| RiskCorrmat(matrix, position, [instance]) | rank correlations |
| RiskCopula(range, position, [instance]) | the same in the shape of a copula |
| RiskIndepC("name"), RiskDepC("name", r) | the draw that others depend on, and one that does |
| RiskSeed(…) | has no effect: every draw has a stream of its own |

Source: Palisade's @RISK manual, "Distribution Property Functions".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.in_cells.call_arguments import is_left_out, number_of
from xlmc.montecarlo.definitions.in_cells.call_draws import MatrixRow, Partner, Properties

__all__ = ["is_property", "is_property_name", "properties_of"]

_MOST_JOINED: Final = 250

_Given = tuple[ir.Expression, ...]
_Taken = Callable[[Properties, _Given], Properties]


def is_property_name(name: str) -> bool:
    """Whether a function, by its name in capitals, is a property function."""
    return name in _BY_NAME


def is_property(tree: ir.Expression) -> bool:
    """Whether an argument is a property function: parameters stand before the first."""
    return isinstance(tree, ir.Call) and tree.name in _BY_NAME


def properties_of(function: str, calls: _Given) -> Properties:
    """Return what these property functions say together.

    Args:
        function: whose they are, for messages.
        calls: the arguments from the first property function on.

    Raises:
        FormulaError: one is none, comes twice or has wrong arguments.
    """
    properties = Properties()
    seen: set[str] = set()
    for call in calls:
        if is_left_out(call):
            continue
        if not isinstance(call, ir.Call) or call.name not in _BY_NAME:
            message = f"{function} has an argument behind its property functions that is none of them"
            raise FormulaError(message, hint=f"use {', '.join(_PROPERTIES)}")
        name, fewest, most, taken = _BY_NAME[call.name]
        if not fewest <= len(call.arguments) <= most:
            takes = str(fewest) if fewest == most else f"{fewest} to {most}"
            raise FormulaError(f"{name} has {len(call.arguments)} arguments; it takes {takes}", hint="correct them")
        if name in seen or (name.startswith("RiskTruncate") and any(each.startswith("RiskTruncate") for each in seen)):
            raise FormulaError(f"{function} is given {name} beside another like it", hint="keep one of them")
        seen.add(name)
        properties = taken(properties, call.arguments)
    return properties


def _filled(arguments: _Given, index: int) -> ir.Expression | None:
    return arguments[index] if index < len(arguments) and not is_left_out(arguments[index]) else None


def _truncate(properties: Properties, arguments: _Given) -> Properties:
    return replace(properties, lower=_filled(arguments, 0), upper=_filled(arguments, 1))


def _truncate_shifted(properties: Properties, arguments: _Given) -> Properties:
    return replace(_truncate(properties, arguments), shifted_cutoffs=True)


def _truncate_percents(properties: Properties, arguments: _Given) -> Properties:
    limits = []
    for index, default in enumerate((0.0, 1.0)):
        given = _filled(arguments, index)
        limits.append(default if given is None else number_of(given))
    low, high = limits
    if low is None or high is None or not 0 <= low < high <= 1:
        hint = "write RiskTruncateP(0.05, 0.95): the lower one first"
        raise FormulaError("RiskTruncateP takes two probabilities, as numbers from 0 to 1", hint=hint)
    return replace(properties, percents=(low, high))


def _corrmat(properties: Properties, arguments: _Given) -> Properties:
    matrix, position = arguments[0], number_of(arguments[1])
    if isinstance(matrix, Cell) or not isinstance(matrix, Area) or matrix.rows != matrix.columns:
        hint = "give it a range with as many rows as columns, without headings"
        raise FormulaError("RiskCorrmat's matrix is not a square range of cells", hint=hint)
    if position is None or not position.is_integer() or not 1 <= position <= matrix.rows:
        message = f"RiskCorrmat's position must be a whole number from 1 to {matrix.rows}"
        raise FormulaError(message, hint="write the row of the matrix that belongs to this draw, as a number")
    instance = _filled(arguments, 2)
    if instance is not None and not isinstance(instance, ir.Number | ir.Text):
        raise FormulaError("RiskCorrmat's instance must be a number or a text", hint="write it, or leave it out")
    return replace(
        properties, matrix=MatrixRow(matrix, int(position), "" if instance is None else str(instance.value).casefold())
    )


def _copula(properties: Properties, arguments: _Given) -> Properties:
    area, position, instance = arguments[0], number_of(arguments[1]), _filled(arguments, 2)
    if isinstance(area, Cell) or not isinstance(area, Area):
        hint = "name the range that says which copula it is, such as K1:L3 with Clayton, and Theta and its number"
        raise FormulaError("RiskCopula's first argument is not a range of cells", hint=hint)
    if position is None or not position.is_integer() or not 1 <= position <= _MOST_JOINED:
        message = f"RiskCopula's position must be a whole number from 1 to {_MOST_JOINED}"
        raise FormulaError(message, hint="write which of the joined draws this is, as a number")
    if instance is not None and not isinstance(instance, ir.Number | ir.Text):
        raise FormulaError("RiskCopula's instance must be a number or a text", hint="write it, or leave it out")
    text = "" if instance is None else str(instance.value).casefold()
    return replace(properties, copula=MatrixRow(area, int(position), text))


def _partner(depends: bool) -> _Taken:
    def taken(properties: Properties, arguments: _Given) -> Properties:
        name = arguments[0]
        function = "RiskDepC" if depends else "RiskIndepC"
        if not isinstance(name, ir.Text | ir.Number):
            hint = 'write the same text in both, such as RiskIndepC("price") and RiskDepC("price", 0.8)'
            raise FormulaError(f"{function} needs a text", hint=hint)
        return replace(properties, partner=Partner(str(name.value).casefold(), arguments[1] if depends else None))

    return taken


def _library(_of_call: Properties, _arguments: _Given) -> Properties:
    hint = "to draw from the distribution as it is written in this cell, take RiskLibrary out"
    raise FormulaError(
        "RiskLibrary replaces the distribution by one of a library that is not in the workbook", hint=hint
    )


def _idle(name: str) -> _Taken:
    return lambda properties, _: replace(properties, idle=(*properties.idle, name))


def _ignored(properties: Properties, _: _Given) -> Properties:
    return properties


_PROPERTIES: Final[dict[str, tuple[int, int, _Taken]]] = {
    "RiskTruncate": (0, 2, _truncate),
    "RiskTruncate2": (0, 2, _truncate_shifted),
    "RiskTruncateP": (0, 2, _truncate_percents),
    "RiskShift": (1, 1, lambda properties, given: replace(properties, shift=given[0])),
    "RiskName": (1, 1, lambda properties, given: replace(properties, name=given[0])),
    "RiskUnits": (1, 1, lambda properties, given: replace(properties, units=given[0])),
    "RiskStatic": (1, 1, lambda properties, given: replace(properties, static=given[0])),
    "RiskLock": (0, 1, lambda properties, _: replace(properties, locked=True)),
    "RiskCorrmat": (2, 3, _corrmat),
    "RiskCopula": (2, 3, _copula),
    "RiskIndepC": (1, 1, _partner(False)),
    "RiskDepC": (2, 2, _partner(True)),
    "RiskSeed": (0, 2, _idle("RiskSeed")),
    "RiskCollect": (0, 1, _ignored),
    "RiskCategory": (0, 1, _ignored),
    "RiskConvergence": (0, 9, _ignored),
    "RiskFit": (0, 9, _ignored),
    "RiskIsDate": (0, 1, _ignored),
    "RiskIsDiscrete": (0, 1, _ignored),
    "RiskLibrary": (0, 9, _library),
    "RiskSixSigma": (0, 9, _ignored),
}
"""Property function -> fewest arguments, most, and what it says."""

_BY_NAME: Final = {name.upper(): (name, *row) for name, row in _PROPERTIES.items()}
