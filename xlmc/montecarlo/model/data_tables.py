"""What-if data tables in a run: in every trial, what a formula would be with other values in its input cells.

Excel fills such a table by putting values into one input cell or two and computing a formula for each. To a run each
of its cells is a function, which no file holds, of these values and of the assumptions that the formula needs. Each
formula is compiled once, with the input cells as inputs, and evaluated for all trials of a block at once. A table is
computed so where its formulas can be; one that shows results of the run, or is fed by texts, is not.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.graph.lowering import lower_cells
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Anything, Function, Kind
from xlmc.excel.functions.values import Value
from xlmc.excel.workbook.workbook import DataTable, Workbook
from xlmc.montecarlo.definitions.definitions import Definitions

__all__ = ["with_data_tables"]

Floats = NDArray[np.float64]

_INPUTS: Final = ("\0row input", "\0column input")
"""The names of the input cells among inputs; no assumption has them."""


def with_data_tables(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with a call for each cell of a data table that varies and can be computed.

    A table may need cells of another one: those are made again and again until no more can be.
    """
    left, found = _varying(workbook, definitions), definitions
    while left:
        made = {table: calls for table in left if (calls := _calls(workbook, found, table)) is not None}
        if not made:
            break
        rewritten = {cell: call for calls in made.values() for cell, call in calls.items()}
        found = replace(
            found,
            rewritten={**found.rewritten, **rewritten},
        )
        left = [table for table in left if table not in made]
    return found


def _varying(workbook: Workbook, definitions: Definitions) -> list[DataTable]:
    """Return the tables that vary, whose cells are faults until they are computed; none that shows results."""
    corners = ((table, Cell(table.area.sheet, table.area.top, table.area.left)) for table in workbook.data_tables)
    return [
        table
        for table, corner in corners
        if isinstance(definitions.rewritten.get(corner), FormulaError) and corner not in definitions.unavailable
    ]


@dataclass(frozen=True, slots=True)
class _Body:
    """What the engines call: the values of the input cells and of the assumptions in, `(n,)` answers out.

    Attributes:
        program: of the formula.
        names: of what it takes, in order.
        formula: the cell that holds it.
    """

    program: NumpyProgram
    names: tuple[str, ...]
    formula: Cell

    def __call__(self, *values: Value) -> Value:
        """Return the answers; an error among what it takes is that error."""
        n = max(value.shape[0] for value in values)
        errors, given = np.zeros(n, np.uint8), dict[str, Floats]()
        for name, value in zip(self.names, values, strict=True):
            numbers, codes = value.to_numbers()
            errors = np.where(errors > 0, errors, codes).astype(np.uint8)
            given[name] = np.array(np.broadcast_to(numbers, (n,)), np.float64)
        block = min(self.program.largest_block, n)
        evaluator = self.program.evaluator(block)
        answers, faults = np.empty(n), np.empty(n, np.uint8)
        for start in range(0, n, block):
            part = slice(start, min(start + block, n))
            inputs = {name: column[part] for name, column in given.items()}
            (found,) = evaluator.filters(inputs, part.stop - part.start)
            answers[part] = found.as_floats(copy=False)
            faults[part] = 0 if found.codes is None else found.codes
        codes = np.where(errors > 0, errors, faults)
        codes = np.where(codes > max(ErrorCode), np.uint8(ErrorCode.VALUE), codes).astype(np.uint8)
        return Value.of_numbers(np.where(codes > 0, 0.0, answers), codes)


def _calls(workbook: Workbook, definitions: Definitions, table: DataTable) -> dict[Cell, ir.Call] | None:
    """Return the call of each cell of a table; None where a formula cannot be computed, or it has texts for values."""
    if not table.inputs or len(table.inputs) < 1 + table.two_inputs:
        return None
    cells = [*table.area.cells()]
    if any(isinstance(workbook.content(value).value, str) for cell in cells for value in table.values_of(cell)):
        return None
    try:
        bodies = {formula: _body(workbook, definitions, table, formula) for formula in {*map(table.formula_of, cells)}}
    except FormulaError:
        return None
    known: Mapping[str, Cell] = {each.name: each.cell for each in definitions.assumptions}
    found = {}
    for cell in cells:
        formula = table.formula_of(cell)
        body = bodies[formula]
        row = Function(
            f"the data table of {formula}",
            (Anything(repeat=True),),
            body,
            Kind.NUMBER,
            facts=Facts(),
            home="a what-if data table",
        )
        rest = (known[name] for name in body.names[len(table.inputs) :])
        found[cell] = ir.Call(f"TABLE.{formula}", (*table.values_of(cell), *rest), given=row)
    return found


def _body(workbook: Workbook, definitions: Definitions, table: DataTable, formula: Cell) -> _Body:
    """Compile a formula of a table as a function of the input cells and the assumptions.

    Raises:
        FormulaError: it cannot be computed.
    """
    inputs = dict(zip(table.inputs, _INPUTS, strict=False))
    named = {a.cell: a.name for a in definitions.assumptions if a.cell not in inputs}
    rewritten = {cell: tree for cell, tree in definitions.rewritten.items() if cell not in inputs}
    resolver = Resolver(workbook, [*named, *inputs], rewritten=rewritten)
    lowered = lower_cells(resolver, [formula], {**named, **inputs}, {})
    target = Target(ir.Binary("+", formula, ir.Number(0.0)), formula)
    program = NumpyProgram.of(lowered, [target], [], frozenset())
    reached, solved = set(lowered.graph.reached), {each.by for each in definitions.solves}
    for cell in lowered.graph.formulas:
        call = definitions.rewritten.get(cell)
        body = call.given.body if isinstance(call, ir.Call) and isinstance(call.given, Function) else None
        inner = [body.formula] if isinstance(body, _Body) else []
        if cell in solved or not inputs.keys().isdisjoint(
            lower_cells(resolver, inner, {**named, **inputs}, {}).graph.reached
        ):  # compiled with the values that the input cells hold
            raise FormulaError("A data table needs another one, or a solution, with its own input", where=cell)
    return _Body(program, (*inputs.values(), *(name for at, name in named.items() if at in reached)), formula)
