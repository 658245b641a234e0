"""What the targets need: their formula cells in dependency order, and which of them vary with an assumption.

Cells that need each other in a circle are listed apart: what a formula names it need not read, so that such cells can
often be computed. A cell may hold no formula and yet be computed: one that an array
formula in another cell fills (`Spills`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final, NamedTuple

import numpy as np

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, host_of
from xlmc.excel.formula import ir
from xlmc.excel.formula.precedents import references
from xlmc.excel.formula.resolve import Resolver
from xlmc.excel.formula.stencil import Stencil
from xlmc.excel.formula.strips import Needs, Part, Stretch, Strips
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["BREAK", "Filled", "Graph", "Spills", "build_graph", "circle_error", "circular", "downstream", "reached"]

BREAK: Final = "break the circle, or turn on iterative calculation in Excel's options, if it is meant"
"""What to do about cells that need each other."""

_MANY: Final = 64
"""Cells of a part that it is worth remembering."""


class Filled(NamedTuple):
    """A cell that a stencil's formula stands in, with the cells that it reads."""

    stencil: Stencil
    cells: list[Cell]


class _Trees(Mapping[Cell, ir.Expression]):
    """The resolved trees of formula cells; those of a stencil are made when they are asked for."""

    def __init__(self, ordered: Mapping[Cell, ir.Expression | Filled]) -> None:
        self.ordered = ordered

    def __getitem__(self, cell: Cell) -> ir.Expression:
        expression = self.ordered[cell]
        return expression.stencil.at(cell) if isinstance(expression, Filled) else expression

    def __iter__(self) -> Iterator[Cell]:
        return iter(self.ordered)

    def __len__(self) -> int:
        return len(self.ordered)


@dataclass(frozen=True)
class Graph:
    """The needed part of a workbook.

    Attributes:
        formulas: resolved trees of the needed formula cells, each after the cells it needs. A cell that an array
            formula in another cell fills has that other cell for a tree. Cells of a circle stand in any order.
        needs: every formula cell's own direct precedents that hold a formula or are inputs.
        varying: the cells among `formulas` and the inputs that depend on an input.
        reached: the inputs and held cells that something needs.
        faults: formula cells that cannot be read, where that was allowed.
        circles: formula cells that need themselves by what their formulas name, with one circle that each is in.
    """

    workbook: Workbook
    formulas: _Trees
    needs: Needs
    varying: frozenset[Cell]
    reached: frozenset[Cell]
    faults: Mapping[Cell, FormulaError]
    circles: Mapping[Cell, FormulaError]

    def text(self, cell: Cell) -> str:
        """Return the formula of a cell as the file holds it."""
        formula = self.workbook.content(host_of(cell)).formula
        return "" if formula is None else formula.text


def build_graph(
    resolver: Resolver,
    targets: Iterable[Cell],
    inputs: frozenset[Cell],
    frozen: frozenset[Cell] = frozenset(),
    *,
    more: Mapping[Cell, Iterable[Cell]] | None = None,
    strict: bool = True,
) -> Graph:
    """Walk upstream from `targets`; an input is taken as given, whatever its cell holds, and so is a held cell.

    Args:
        resolver: of the workbook.
        targets: the cells wanted.
        inputs: cells that vary.
        frozen: cells that do not, whatever they hold.
        more: cells that a formula cell turned out to need beside those its formula names.
        strict: raise at the first faulty formula; collect the faults otherwise.

    Raises:
        FormulaError: a needed formula cannot be read.
    """
    walk = _Walk(resolver, inputs | frozen, more or {}, strict)
    for target in targets:
        walk.upstream(target)
    circles = circular(walk.needs) if walk.circular else {}
    drawn = walk.reached & inputs
    varying = downstream(walk.needs, drawn) if circles else _varying(walk.ordered, walk.needs, drawn)
    reached = frozenset(walk.reached)
    return Graph(resolver.workbook, _Trees(walk.ordered), walk.needs, varying, reached, walk.faults, circles)


class _Walk:
    """Upstream through the precedents, depth first, each formula cell once."""

    def __init__(
        self, resolver: Resolver, given: frozenset[Cell], more: Mapping[Cell, Iterable[Cell]], strict: bool
    ) -> None:
        self._resolver, self._given, self._more, self._strict = resolver, given, more, strict
        self._workbook, self._spills = resolver.workbook, Spills(resolver.workbook)
        self.ordered: dict[Cell, ir.Expression | Filled] = {}
        self.needs = Needs()
        self._strips = Strips(self._counts, lambda area: _filled_cells(self._workbook, area, given), resolver.last_cell)
        self.reached: set[Cell] = set()
        self.faults: dict[Cell, FormulaError] = {}
        self.circular = False
        self._walked: set[int] = set()  # parts that are kept, by their identity
        self._trail: dict[Cell, Iterator[Cell]] = {}
        self._open: dict[Cell, ir.Expression | Filled] = {}
        self._computed: dict[Cell, bool] = {}

    def upstream(self, target: Cell) -> None:
        """Add a cell to the order, after all cells that it needs."""
        trail, ordered = self._trail, self.ordered
        self._enter(target)
        while trail:
            cell = next(reversed(trail))
            before = len(trail)
            for following in trail[cell]:
                if following in ordered:
                    continue
                if following in trail:
                    self.circular = True
                else:
                    self._enter(following)
                    if len(trail) > before:
                        break
            else:
                ordered[cell] = self._open.pop(cell)
                trail.popitem()  # `del` would leave a gap that each later look at the end has to pass
                for part in self.needs.parts[cell]:
                    if isinstance(part, Stretch):
                        part.note_ordered()
                    elif len(part) > _MANY:
                        self._walked.add(id(part))

    def _enter(self, cell: Cell) -> None:
        if cell in self._given:
            self.reached.add(cell)
        elif cell not in self.ordered and (expression := self._rewritten(cell) or self._read(cell)) is not None:
            self._open[cell] = expression
            self.needs.parts[cell] = parts = self._precedents(cell, expression)
            self._trail[cell] = self._waiting(parts)

    def _waiting(self, parts: tuple[Part, ...]) -> Iterator[Cell]:
        """Return the cells of the parts, but for most of those that are in order."""
        if len(parts) == 1 and type(parts[0]) is tuple and id(parts[0]) not in self._walked:
            return iter(parts[0])
        left = (part.waiting() if isinstance(part, Stretch) else part for part in parts if id(part) not in self._walked)
        return chain.from_iterable(left)

    def _read(self, cell: Cell) -> ir.Expression | Filled | None:
        formula = self._workbook.content(cell).formula
        if formula is None:
            return self._spills.anchor(cell)
        try:
            expression = self._resolver.tree_or_stencil(cell, formula)
            return Filled(expression, expression.cells(cell)) if isinstance(expression, Stencil) else expression
        except FormulaError as error:
            if self._strict:
                raise
            self.faults[cell] = error
            return ir.Missing()

    def _precedents(self, cell: Cell, expression: ir.Expression | Filled) -> tuple[Part, ...]:
        """Return the cells that one needs and that hold a formula or are given."""
        parts: list[Part]
        if isinstance(expression, Filled):
            known = self._computed
            parts = [
                tuple([need for need in expression.cells if (known[need] if need in known else self._counts(need))])
            ]
        else:
            reads = dict.fromkeys(references(expression))
            parts = [part for read in reads if isinstance(read, Area) for part in self._strips.of(read)]
            parts.append(tuple([read for read in reads if isinstance(read, Cell) and self._counts(read)]))
        if cell in self._more:
            parts.append(tuple(self._more[cell]))
        return tuple(parts)

    def _rewritten(self, cell: Cell) -> ir.Expression | None:
        """Return what replaces a cell's own formula, if anything does."""
        expression = self._resolver.rewritten.get(cell)
        if not isinstance(expression, FormulaError):
            return expression
        if self._strict:
            raise expression
        self.faults[cell] = expression
        return ir.Missing()

    def _counts(self, cell: Cell) -> bool:
        known = self._computed.get(cell)
        if known is None:
            known = cell in self._given or cell in self._resolver.rewritten
            known = known or self._workbook.content(cell).formula is not None
            self._computed[cell] = known = known or self._spills.anchor(cell) is not None
        return known


def _filled_cells(workbook: Workbook, area: Area, inputs: frozenset[Cell]) -> Iterator[Cell]:
    """Return the area's cells that hold something, row by row."""
    sheet = workbook.sheet_of(area)
    if sheet is None:
        return
    if area.rows * area.columns <= len(sheet.cells):
        yield from area.cells()
        return
    extra = {cell for cell in inputs if cell in area}
    frozen = {Cell(area.sheet, row, column) for row, column in sheet.cells}
    yield from sorted(cell for cell in frozen | extra if cell in area)


def _varying(formulas: Iterable[Cell], needs: Needs, inputs: Iterable[Cell]) -> frozenset[Cell]:
    varying = set(inputs)
    constant: set[int] = set()  # large parts, by their identity
    for cell in formulas:  # in dependency order: what a cell needs was decided before it
        for part in needs.parts[cell]:
            if isinstance(part, Stretch):
                varies = part.varies(varying)
            else:
                varies = id(part) not in constant and not varying.isdisjoint(part)
                if not varies and len(part) > _MANY:
                    constant.add(id(part))
            if varies:
                varying.add(cell)
                break
    return frozenset(varying)


def reached(start: Iterable[Cell], following: Callable[[Cell], Iterable[Cell]]) -> Iterator[Cell]:
    """Yield these cells and all that they lead to, each once.

    Args:
        start: the first ones.
        following: the cells that a cell leads to, such as those that it needs.
    """
    seen: set[Cell] = set()
    open_ = list(start)
    while open_:
        cell = open_.pop()
        if cell not in seen:
            seen.add(cell)
            yield cell
            open_ += following(cell)


def downstream(needs: Needs, inputs: Iterable[Cell]) -> frozenset[Cell]:
    """Find the inputs and all cells that need one of them, in whatever order they stand."""
    parts, links = needs.linked()
    users: dict[Cell, list[int]] = {}
    for number, part in enumerate(parts):
        for need in part:
            users.setdefault(need, []).append(number)
    cells: list[list[Cell]] = [[] for _ in parts]
    for cell, numbers in links.items():
        for number in numbers:
            cells[number].append(cell)
    result, open_ = set(inputs), list(inputs)
    while open_:
        for number in users.pop(open_.pop(), ()):
            new = [cell for cell in cells[number] if cell not in result]
            cells[number] = []
            result.update(new)
            open_ += new
    return frozenset(result)


def circular(needs: Needs) -> dict[Cell, FormulaError]:
    """Every cell that needs itself, directly or through others, with one circle of those that it is in with.

    Args:
        needs: cell -> the cells it needs; those that are no keys need nothing.
    """
    cells = list(needs)
    groups = _groups(needs)
    result: dict[Cell, FormulaError] = {}
    for cell in cells:
        alone = len(groups[cell]) == 1 and not needs.names(cell, cell)
        if cell not in result and not alone and (loop := _loop(cell, needs, groups)):
            fault = circle_error(loop)
            result |= dict.fromkeys(groups[cell], fault)
    return result


def circle_error(cells: Sequence[Cell]) -> FormulaError:
    """Make what is said of cells that need each other in a circle, each the next one."""
    loop = " → ".join(str(cell) for cell in [*cells, cells[0]])
    return FormulaError(
        f"the cells need each other in a circle: {loop}",
        where=cells[0],
        hint=BREAK,
    )


def _groups(needs: Needs) -> dict[Cell, dict[Cell, None]]:
    """Find the strongly connected component of every cell, in the order of the cells."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    numbers = {cell: number for number, cell in enumerate(needs)}
    parts, links = needs.linked()
    edges = [(numbers[cell], len(numbers) + part) for cell, linked in links.items() for part in linked]
    for number, part in enumerate(parts, len(numbers)):
        edges += [(number, numbers[need]) for need in part if need in numbers]
    rows, columns = np.array(edges, np.int64).T
    size = len(numbers) + len(parts)
    matrix = coo_array((np.ones(len(edges), np.int8), (rows, columns)), shape=(size, size))
    _, labels = connected_components(matrix.tocsr(), connection="strong")
    members: dict[int, dict[Cell, None]] = {}
    for cell, label in zip(numbers, labels.tolist(), strict=False):
        members.setdefault(label, {})[cell] = None
    return {cell: members[label] for cell, label in zip(numbers, labels.tolist(), strict=False)}


def _loop(start: Cell, needs: Needs, groups: Mapping[Cell, dict[Cell, None]]) -> list[Cell]:
    """Follow needs within the group until a cell comes up again; nothing where the cell is in no circle."""
    group, trail = groups[start], {start: None}
    while True:
        following = next((need for need in needs.of(next(reversed(trail))) if need in group), None)
        if following is None:
            return []
        if following in trail:
            return [*trail][[*trail].index(following) :]
        trail[following] = None


_MOST_LISTED: Final = 10_000
"""Cells of an array formula that are listed one by one."""


class Spills:
    """Array formulas of a workbook by what they fill; a sheet is looked through when it is first asked about."""

    def __init__(self, workbook: Workbook) -> None:
        self._workbook = workbook
        self._sheets: dict[str, tuple[dict[Cell, Cell], list[tuple[Area, Cell]]]] = {}

    def anchor(self, cell: Cell) -> Cell | None:
        """Return the cell whose array formula fills this other one; otherwise None."""
        if cell.sheet not in self._sheets:
            sheet = self._workbook.sheets.get(cell.sheet)
            self._sheets[cell.sheet] = ({}, []) if sheet is None else _filled(sheet.arrays)
        listed, large = self._sheets[cell.sheet]
        if cell in listed:
            return listed[cell]
        return next((anchor for area, anchor in large if cell in area and cell != anchor), None) if large else None


def _filled(arrays: Mapping[Cell, Area]) -> tuple[dict[Cell, Cell], list[tuple[Area, Cell]]]:
    """Return the anchors of the cells that array formulas fill, and large areas with theirs."""
    listed: dict[Cell, Cell] = {}
    large = []
    for anchor, area in arrays.items():
        if area.rows * area.columns == 1:
            continue
        if area.rows * area.columns > _MOST_LISTED:
            large.append((area, anchor))
        else:
            for cell in area.cells():
                if cell != anchor:
                    listed.setdefault(cell, anchor)
    return listed, large
