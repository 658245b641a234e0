"""Cells that are solved for: in every trial, the value of one cell at which another has the value it is to have.

To all that follows such a cell holds a formula: a function, which no file holds, of the assumptions that the solution
depends on. It evaluates the cells between the two with the fast engine, again and again, for many trials at once. A
trial without a solution is `#N/A`, one with several `#NUM!`, unless the row says which of them is meant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.graph.lowering import Lowering, lower_cells
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.numpy.repeated import RepeatedProgram
from xlmc.engine.roots import SCANNED, find_roots
from xlmc.engine.roots import Function as Difference
from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Anything, Function, Kind
from xlmc.excel.functions.values import Codes, Value
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Definitions, Parameter, Solve
from xlmc.montecarlo.definitions.stating import Which
from xlmc.montecarlo.number_text import number_text

if TYPE_CHECKING:
    from xlmc.engine.llvm.root_loop import RootLoop

__all__ = ["Unknown", "fault_text", "unknown_of", "with_solved_cells"]

Floats = NDArray[np.float64]

_TOGETHER: Final = 3 << 12
"""Trials that are solved at once: few enough for the cache, and for memory that the next ones use again."""

_FINE: Final = 64
"""Into how many parts each part of a run's scan is divided at the base case, to see what the run would miss."""

_BY: Final = "\0by"
"""The name of the unknown among inputs; no assumption has it."""


@dataclass(frozen=True, slots=True)
class Unknown:
    """What a cell is for each value of another one, as a difference to what it is to be.

    Attributes:
        both: the program of the cell and of what it is to be; their difference is not rounded as Excel's is.
        ends: the program of both ends of the range; None where the range is given in another way.
        inputs: the assumptions that either needs, in order.
    """

    both: RepeatedProgram
    ends: NumpyProgram | None
    inputs: tuple[str, ...]

    def range_of(self, given: Mapping[str, Floats], n: int) -> tuple[Floats, Floats]:
        """Return both ends of the range, `(n,)` each; NaN for an error."""
        assert self.ends is not None
        at = {_BY: np.zeros(n), **given}
        low, high = (column.as_floats() for column in self.ends.evaluator(n).filters(at, n))
        return low, high

    def evaluated(self, given: Mapping[str, Floats]) -> Difference:
        """Return the difference as a function of the unknown and the trial, of assumptions `(n,)` each; for one thread.

        It has no number where the cell is an error, a text or blank.
        """
        both = self.both.evaluated(given, max((values.size for values in given.values()), default=1 << 12))

        def difference(at: Floats, trials: NDArray[np.intp] | None) -> Floats:
            result, start = np.empty(at.size), 0
            for value, to in both(at, trials):
                np.subtract(value, to, out=result[start : start + value.size])
                start += value.size
            return result

        return difference


@dataclass(frozen=True, slots=True)
class _Body:
    """What the engines call: values of the assumptions in, `(n,)` solutions out."""

    unknown: Unknown
    root: Which | None

    def __call__(self, *values: Value) -> Value:
        """Return the solutions; an error of an assumption is that error."""
        return self._solved(values, None)

    def compiled(self) -> Callable[..., Value] | None:
        """See `Compilable`."""
        from xlmc.engine.llvm.root_loop import root_loop

        loop = root_loop(self.unknown.both)
        return None if loop is None else lambda *values: self._solved(values, loop)

    def _solved(self, values: Sequence[Value], loop: RootLoop | None) -> Value:
        n = max(value.shape[0] for value in values)
        read = [value.to_numbers() for value in values]
        errors = np.zeros(n, np.uint8)
        for _, codes in read:
            errors = np.where(errors > 0, errors, codes).astype(np.uint8)
        given = {
            name: np.array(np.broadcast_to(numbers, (n,)), np.float64)
            for name, (numbers, _) in zip(self.unknown.inputs, read, strict=False)
        }
        solved, codes = np.empty(n), np.empty(n, np.uint8)
        for start in range(0, n, _TOGETHER):
            part = slice(start, min(start + _TOGETHER, n))
            here = {name: numbers[part] for name, numbers in given.items()}
            solved[part], codes[part] = self._solve(here, errors[part], loop)
        return Value.of_numbers(solved, codes)

    def _solve(self, given: Mapping[str, Floats], errors: Codes, loop: RootLoop | None) -> tuple[Floats, Codes]:
        """Solve some of the trials, few enough for the cache: solutions and errors, `(m,)` each."""
        m = errors.size
        low, high = self.unknown.range_of(given, m)
        low = np.where(errors > 0, np.nan, low)
        known = None if loop is None else self.unknown.both.read(given, m)
        if loop is not None and known is not None:
            solved, single = loop(known, low, high)
            left = np.flatnonzero(~single)
            if not left.size:
                return solved, np.zeros(m, np.uint8)
            given = {name: numbers[left] for name, numbers in given.items()}
            codes = np.zeros(m, np.uint8)
            solved[left], codes[left] = self._find(given, errors[left], low[left], high[left])
            return solved, codes
        return self._find(given, errors, low, high)

    def _find(self, given: Mapping[str, Floats], errors: Codes, low: Floats, high: Floats) -> tuple[Floats, Codes]:
        m = errors.size
        roots = find_roots(self.unknown.evaluated(given), low, high)
        counts = roots.counts(m)
        codes = np.where(counts == 0, np.uint8(ErrorCode.NA), np.uint8(0))
        if self.root is None:
            codes = np.where(counts > 1, np.uint8(ErrorCode.NUM), codes)
        codes = np.where(errors > 0, errors, codes).astype(np.uint8)
        solved = np.where(codes > 0, 0.0, roots.chosen(m, last=self.root is Which.LAST))
        return solved, codes


def unknown_of(
    workbook: Workbook,
    definitions: Definitions,
    cell: Cell,
    to: Parameter,
    by: Cell,
    ends: tuple[Parameter, Parameter] | None,
    where: Cell | str,
) -> Unknown:
    """Compile what a cell is, less what it is to be, as a function of another cell.

    Args:
        workbook: with both.
        definitions: its assumptions, which the function takes, too, and the formulas that stand for calls.
        cell: that is to have the value.
        to: the value.
        by: the cell that is unknown.
        ends: of its range, if formulas may give them.
        where: what asks for it, for messages.

    Raises:
        DefinitionError: the cell does not depend on the unknown one, or an end of the range does.
        FormulaError: a cell between them cannot be computed.
    """
    named = {a.cell: a.name for a in definitions.assumptions if a.cell != by}
    resolver = Resolver(workbook, [*named, by], rewritten=definitions.rewritten)

    def lower(cells: Iterable[Cell]) -> Lowering:
        return lower_cells(resolver, list(cells), {**named, by: _BY}, {})

    wanted = lower(each for each in (cell, to) if isinstance(each, Cell))
    if by not in lower([cell]).graph.reached:
        hint = f"Choose an input that {cell} is computed from" if cell != by else "Name another cell"
        raise DefinitionError(f"{cell} does not depend on {by}", where=where, hint=hint)
    reached, program = set(wanted.graph.reached), None
    if ends is not None:
        limits = lower(each for each in ends if isinstance(each, Cell))
        if by in limits.graph.reached:
            raise DefinitionError(
                f"The range of {by} depends on {by}", where=where, hint="Give Low and High as numbers"
            )
        reached |= limits.graph.reached
        targets = [Target(ir.Binary("+", _tree(each), ir.Number(0.0)), by) for each in ends]
        program = NumpyProgram.of(limits, targets, [], frozenset())
    both = [_as_number(wanted, Target(_tree(each), cell)) for each in (cell, to)]
    inputs = tuple(name for at, name in named.items() if at in reached)
    return Unknown(RepeatedProgram.of(wanted, both, _BY), program, inputs)


def _as_number(lowering: Lowering, target: Target) -> Target:
    """Return what arithmetic reads of a target: of a text its number."""
    if lowering.dag.types[lowering.target(target)] is Kind.NUMBER:
        return target
    return Target(ir.Binary("+", target.tree, ir.Number(0.0)), target.cell)


def _tree(given: Parameter) -> ir.Expression:
    return given if isinstance(given, Cell) else ir.Number(given)


def with_solved_cells(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with the call that solves for it in each cell that is solved for.

    Cells are solved one after another: one may need the solution of another, and not the other way round as well.

    Raises:
        DefinitionError: two solutions need each other, or a row solves for a cell that its other cell does not need.
        FormulaError: a cell that a solution needs cannot be computed.
    """
    if all(solve.by in definitions.rewritten for solve in definitions.solves):
        return definitions
    left, result = list(definitions.solves), definitions
    while left:
        ready = next((each for each in left if not _awaits(workbook, result, each, left)), None)
        if ready is None:
            names = " and ".join(repr(each.name) for each in left)
            hint = "Solve for one of the cells here, and compute the other by a formula"
            raise DefinitionError(f"{names} need each other's solutions", where=left[0].row, hint=hint)
        left.remove(ready)
        result = replace(result, rewritten={**result.rewritten, ready.by: _call(workbook, result, ready)})
    return result


def _awaits(workbook: Workbook, definitions: Definitions, solve: Solve, left: Sequence[Solve]) -> bool:
    """Whether a solution needs another one that is not there yet."""
    others = {each.by: each.name for each in left if each is not solve}
    named = {a.cell: a.name for a in definitions.assumptions if a.cell not in others and a.cell != solve.by}
    inputs = {**named, **others, solve.by: _BY}
    resolver = Resolver(workbook, [*inputs], rewritten=definitions.rewritten)
    cells = [each for each in (solve.cell, solve.to, solve.low, solve.high) if isinstance(each, Cell)]
    return not others.keys().isdisjoint(lower_cells(resolver, cells, inputs, {}).graph.reached)


def _call(workbook: Workbook, definitions: Definitions, solve: Solve) -> ir.Call:
    unknown = unknown_of(workbook, definitions, solve.cell, solve.to, solve.by, (solve.low, solve.high), solve.row)
    _check_scan(definitions, unknown, solve)
    body = _Body(unknown, solve.root)
    row = Function(
        f"solve for {solve.name}",
        (Anything(repeat=True),),
        body,
        Kind.NUMBER,
        facts=Facts(),
        home="a row of xlmc_solve",
    )
    cells: dict[str, Cell] = {a.name: a.cell for a in definitions.assumptions}
    arguments = tuple(cells[name] for name in unknown.inputs) or (ir.Number(0.0),)
    return ir.Call(f"SOLVE.{solve.name}", arguments, given=row)


def _check_scan(definitions: Definitions, unknown: Unknown, solve: Solve) -> None:
    """Refuse a range in which a finer scan of the base case finds other values than that of a run.

    Two values within one part of the scan cancel, three look like one, and where a cell has the value throughout a
    range, the scan's own points are found. Nothing is looked at where an assumption has no base value.

    Raises:
        DefinitionError: the scans differ.
    """
    bases = {a.name: a.base for a in definitions.assumptions}
    given = {name: np.full(1, value) for name in unknown.inputs if (value := bases[name]) is not None}
    if len(given) < len(unknown.inputs):
        return
    low, high = unknown.range_of(given, 1)
    if not low[0] < high[0] < np.inf:
        return
    seen = find_roots(unknown.evaluated(given), low, high).values
    edges = np.linspace(low[0], high[0], _FINE * SCANNED + 1)
    columns = {name: np.full(edges.size - 1, value[0]) for name, value in given.items()}
    exact = np.unique(find_roots(unknown.evaluated(columns), edges[:-1], edges[1:]).values)
    if exact.size != seen.size:
        message = (
            f"At the base case {solve.cell} has its value at {exact.size} values of {solve.by} from "
            f"{number_text(low[0])} to "
            f"{number_text(high[0])}, as a fine scan finds, and a run would find {seen.size}"
        )
        raise DefinitionError(message, where=solve.row, hint="Give a narrower range, in which there is one")


def fault_text(solves: Iterable[Solve], cell: Cell, code: ErrorCode | None) -> str:
    """Say why a cell that is solved for is an error in a trial; empty for any other cell or error."""
    for each in solves:
        if each.by == cell and code is not None and code in (ErrorCode.NA, ErrorCode.NUM):
            return each.words(code)
    return ""
