"""Cells that need themselves by what their formulas name, computed where they do not read themselves.

Excel calls a cell circular when its value is read while it is computed. `SUM(A2:OFFSET(A6,-1,0))` in A6 only points
through A6, and `CHOOSE(2,B40,"x")` in B40 never reads B40. So cells of a circle are lowered when their values are asked
for, one after another, as Excel computes them. What is asked for while it is lowered itself is a `Circle`: a value that
is not there. Where every trial reads it, the cells are refused; where a condition that varies decides, the trials that
read it are errors, `#CALC!`. A function that would hide the error, as IFERROR does, is refused.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, Protocol

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Range, Select, uses
from xlmc.engine.graph.picked_ranges import PICKING
from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula.graph import BREAK, circle_error
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.values import ERROR

__all__ = ["CircleError", "Iterates", "Lowers", "hidden_error", "lower_as_read", "refuse_hidden"]

_MOST_OPEN: Final = 8
"""Cells of one circle that may be asked for while they are lowered; each may make the others be lowered once more."""

_HIDING: Final = frozenset(
    {
        *("ISERROR", "ISERR", "ISNA", "ISNUMBER", "ISLOGICAL", "ISTEXT", "ISNONTEXT", "ISBLANK", "ERROR.TYPE", "TYPE"),
        *("COUNT", "COUNTA", "COUNTBLANK", "COUNTIF", "COUNTIFS", "SUBTOTAL", "AGGREGATE", "VALUETOTEXT"),
        *("ARRAYTOTEXT", "MATCH", "XMATCH", "VLOOKUP", "HLOOKUP", "LOOKUP", "XLOOKUP", "SUMIF", "AVERAGEIF", "SUMIFS"),
        *("AVERAGEIFS", "MAXIFS", "MINIFS", "DSUM", "DPRODUCT", "DAVERAGE", "DMIN", "DMAX", "DVAR", "DVARP", "DSTDEV"),
        *("DSTDEVP", "DGET", "DCOUNT", "DCOUNTA", "TAKE", "CHOOSEROWS", "CHOOSECOLS", "FILTER", "SORT", "SORTBY"),
        *("XNPV", "XIRR", "SERIESSUM", "IFERROR", "IFNA"),
    }
)
"""Functions whose result may be no error although an argument is one, or a cell of it."""


class Iterates(Exception):  # noqa: N818 - it asks for another way; nothing is wrong
    """A cell reads itself, perhaps not in each trial, and the workbook has such cells iterated."""

    def __init__(self, cell: Cell) -> None:
        super().__init__(cell)
        self.cell = cell


class CircleError(FormulaError):
    """A formula reads, or may hide that it reads, the value of a cell that is being computed."""


def refuse_hidden(dag: Dag, function: Function, arguments: Sequence[int]) -> None:
    """Refuse a function that gives no error although it reads a value that is not there.

    Raises:
        CircleError: it is such a function.
    """
    if function.name not in _HIDING:
        return
    picked = PICKING.get(function.name)
    for position, argument in enumerate(arguments):
        hides = function.parameter(position).kind is Kind.ANY and argument in dag.missing
        if hides and (position != picked or _is_searched(dag, function.name, argument)):
            raise hidden_error(function.name)


def hidden_error(name: str) -> CircleError:
    """Make what is said of a function that would hide a circle."""
    return CircleError(f"{name} reads a cell that needs itself in a circle", hint=BREAK)


def _is_searched(dag: Dag, name: str, table: int) -> bool:
    """Whether a lookup searches the cells of a table whose values are not there."""
    if name not in ("VLOOKUP", "HLOOKUP"):
        return False
    match dag.nodes[table]:
        case Range(rows):
            searched = [row[0] for row in rows] if name == "VLOOKUP" else rows[0]
            return not dag.missing.isdisjoint(searched)
        case Constant(value):
            kinds = value.kinds.reshape(value.shape)
            return bool(np.any((kinds[:, :, :1] if name == "VLOOKUP" else kinds[:, :1]) >= ERROR))
        case _:
            return True


def _reads_always(dag: Dag, node_id: int) -> bool:
    """Whether a node reads a value that is not there in every trial, as far as that is known."""
    known: dict[int, bool] = {}
    for at in sorted(dag.missing):
        known[at] = _reads_here(dag, at, known)
    return known.get(node_id, False)


def _reads_here(dag: Dag, at: int, known: Mapping[int, bool]) -> bool:
    match dag.nodes[at]:
        case Constant():
            return True
        case Select(condition, yes, no):
            return known.get(condition, False) or (known.get(yes, False) and known.get(no, False))
        case IfErrorNode(value):
            return known.get(value, False)
        case Range():
            return False
        case Apply(function, arguments) if function.name in PICKING or function.name == "INDEX":
            return any(known.get(each, False) for i, each in enumerate(arguments) if not function.parameter(i).ranged)
        case Apply(_, arguments):
            return any(known.get(cell, False) for each in arguments for cell in (each, *_cells(dag, each)))
        case _:
            return False


def _cells(dag: Dag, node: int) -> Sequence[int]:
    return uses(dag.nodes[node]) if isinstance(dag.nodes[node], Range) else ()


class Lowers(Protocol):
    """What lowers the cells of a graph, as far as `lower_as_read` asks it to."""

    dag: Dag
    circle: set[Cell]
    """Cells that are being lowered and were asked for meanwhile: their values are not there."""

    def is_lowered(self, cell: Cell) -> bool:
        """Whether the node of a cell is there."""

    def lower_next(self, cell: Cell) -> Collection[Cell]:
        """Lower a cell; if that asks for cells that are not lowered, return these instead."""

    def forget(self, cell: Cell) -> None:
        """Have a cell lowered again."""

    def node_of(self, cell: Cell) -> int:
        """Return the node of a cell that is lowered."""

    def refuse(self, cells: Sequence[Cell], error: FormulaError) -> None:
        """Take cells for faulty that need each other in a circle, or raise the error."""

    def iterate(self, cell: Cell) -> None:
        """Lower the cells of the circle that a cell is in, to be computed again and again."""

    def note_circle(self, cell: Cell) -> None:
        """Note that some trials may read a cell while it is computed."""


@dataclass(slots=True)
class _Open:
    """A cell that is being lowered, and what it waits for."""

    cell: Cell
    waits: list[Cell] = field(default_factory=list)
    loop: list[Cell] = field(default_factory=list)
    """Where it was asked for meanwhile: the circle."""
    without: list[Cell] = field(default_factory=list)
    """The cells that were lowered without its value."""


def lower_as_read(cells: Iterable[Cell], lowers: Lowers) -> None:
    """Lower cells in the order in which their values are read."""
    for cell in cells:
        while not lowers.is_lowered(cell):
            try:
                _lower_with_needs(cell, lowers)
            except Iterates as iterates:
                lowers.iterate(iterates.cell)


def _lower_with_needs(first: Cell, lowers: Lowers) -> None:
    open_ = {first: _Open(first)}
    while open_:
        at = next(reversed(open_.values()))
        while at.waits and lowers.is_lowered(at.waits[-1]):
            at.waits.pop()
        if lowers.is_lowered(at.cell):  # found to be in a circle meanwhile
            open_.popitem()
            lowers.circle.discard(at.cell)
        elif not at.waits:
            at.waits = [need for need in lowers.lower_next(at.cell) if not _is_open(need, at, open_, lowers)]
            if lowers.is_lowered(at.cell):
                _close(at, open_, lowers)
        else:
            need = at.waits.pop()
            if need not in open_:
                open_[need] = _Open(need)


def _is_open(need: Cell, at: _Open, open_: Mapping[Cell, _Open], lowers: Lowers) -> bool:
    """Whether a cell that is asked for is being lowered itself; from then on its value is not there."""
    if need not in open_:
        return False
    trail = list(open_)
    asked = open_[need]
    asked.loop = trail[trail.index(need) :]
    lowers.circle.add(need)
    if len(lowers.circle) > _MOST_OPEN:
        lowers.refuse(asked.loop, _too_many(list(lowers.circle)))
    return True


def _too_many(cells: Sequence[Cell]) -> FormulaError:
    """Say that too many cells may read each other."""
    listed = ", ".join(map(str, sorted(cells)))
    message = f"more than {_MOST_OPEN} cells may need each other in a circle, others in each trial: {listed}"
    hint = "have numbers that do not vary decide which cells are read, or break the circle"
    return FormulaError(message, where=min(cells), hint=hint)


def _close(at: _Open, open_: dict[Cell, _Open], lowers: Lowers) -> None:
    """Go on after a cell was lowered: what was lowered without its value is lowered again, if it is needed."""
    open_.popitem()  # it is the last; `del` would leave a gap that each later look at the end has to pass
    lowers.circle.discard(at.cell)
    node = lowers.node_of(at.cell)
    for cell in at.without:
        lowers.forget(cell)
    if node not in lowers.dag.missing:
        return
    outer = next((each for each in reversed(open_.values()) if each.loop), None)
    if outer is not None:
        outer.without.append(at.cell)
    elif at.loop and _reads_always(lowers.dag, node):
        lowers.forget(at.cell)
        lowers.refuse(at.loop, circle_error(at.loop))
    elif at.loop:
        lowers.note_circle(at.cell)
