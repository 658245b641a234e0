"""What-if data tables in a run: in every trial, what a formula would be with other values in its input cells.

Excel fills such a table by putting values into one input cell or two and computing a formula for each. To a run each
of its cells is a function, which no file holds, of these values and of the assumptions that the formula needs. Each
formula is compiled once, with the input cells as inputs, and evaluated for all trials of a block at once. A table is
computed so where its formulas can be; one that shows results of the run, or is fed by texts, is not.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.graph.lowering import lower_cells
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.engine.saved_values import same_value
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph, ir
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.registry import Anything, Function, Kind
from xlmc.excel.functions.values import Value
from xlmc.excel.workbook.workbook import DataTable, Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.unavailable import faults_of, tables_of_run
from xlmc.montecarlo.model.needed import targets_of

__all__ = ["cells_read", "computed_tables", "with_data_tables"]

Floats = NDArray[np.float64]

_INPUTS: Final = ("\0row input", "\0column input")
"""The names of the input cells among inputs; no assumption has them."""


def with_data_tables(workbook: Workbook, definitions: Definitions, varied: Collection[Cell] = ()) -> Definitions:
    """Return the definitions with a call for each cell of a data table that varies and can be computed.

    What Excel saved in a table belongs to what it saved in the cells that the table is computed from. Where one of
    these holds something else now, is solved for, or is varied, the table varies, too. One that does not vary is
    computed where a program has saved other values in it than its formulas give, or none.

    Args:
        workbook: whose tables.
        definitions: of the run.
        varied: further cells that a study gives values; the calls take them as they take assumptions.
    """
    if not workbook.data_tables:
        return definitions
    changed = workbook.typed.union(varied, (each.by for each in definitions.solves))
    if changed:
        more = tables_of_run(workbook, changed, (), definitions.rewritten).varying
        definitions = replace(definitions, rewritten={**faults_of(workbook, more), **definitions.rewritten})
    result = _with_calls(workbook, definitions, _varying(workbook, definitions), varied)
    return _with_stale_tables(workbook, result, varied)


def _with_calls(
    workbook: Workbook, definitions: Definitions, tables: Collection[DataTable], varied: Collection[Cell]
) -> Definitions:
    """Return the definitions with calls for the cells of those tables that can be computed.

    A table may need cells of another one: those are made again and again until no more can be.
    """
    left, result = [*tables], definitions
    while left:
        made = {table: calls for table in left if (calls := _calls(workbook, result, table, varied)) is not None}
        if not made:
            break
        rewritten = {cell: call for calls in made.values() for cell, call in calls.items()}
        result = replace(result, rewritten={**result.rewritten, **rewritten})
        left = [table for table in left if table not in made]
    return result


def _with_stale_tables(workbook: Workbook, definitions: Definitions, varied: Collection[Cell]) -> Definitions:
    """Return the definitions with calls for the needed tables that do not vary, and hold what they do not give."""
    tables = _needed_constants(workbook, definitions)
    waiting = {**faults_of(workbook, tables), **definitions.rewritten}  # until one that another needs is computed
    computed = _with_calls(workbook, replace(definitions, rewritten=waiting), tables, varied).rewritten
    made = ((cell, tree) for cell, tree in computed.items() if cell not in definitions.rewritten)
    calls = {cell: tree for cell, tree in made if isinstance(tree, ir.Call)}
    values = _constants(workbook, definitions, calls)
    stale = [t for t in tables if any(_is_stale(workbook, at, values[at]) for at in t.area.cells() if at in values)]
    message = "the values saved in this what-if data table are not those that its formulas give, which the run uses"
    return replace(
        definitions,
        rewritten={**definitions.rewritten, **{at: calls[at] for each in stale for at in each.area.cells()}},
        notices=(*definitions.notices, *(Notice(message, each.area) for each in stale)),
    )


def _needed_constants(workbook: Workbook, definitions: Definitions) -> list[DataTable]:
    """Return the tables that forecasts and filters need, directly or through others, and that do not vary."""
    fixed = [t for t in workbook.data_tables if definitions.rewritten.keys().isdisjoint(t.area.cells())]
    inside = {cell: table for table in fixed for cell in table.area.cells()}
    given = frozenset(inside).union(a.cell for a in definitions.assumptions)
    resolver = Resolver(workbook, given, strict=False, rewritten=definitions.rewritten)
    wanted = targets_of(definitions.forecasts, (*definitions.filters, *definitions.forecast_filters))
    wanted += [cell for a in definitions.assumptions if not a.frozen for cell in a.cells]
    wanted += [check.cell for check in definitions.checks]
    result: dict[DataTable, None] = {}
    while wanted:
        reached = build_graph(resolver, wanted, given, strict=False).reached
        more = [t for t in dict.fromkeys(inside[cell] for cell in reached if cell in inside) if t not in result]
        result |= dict.fromkeys(more)
        wanted = [cell for table in more for cell in table.margins()]
    return list(result)


def _constants(workbook: Workbook, definitions: Definitions, calls: Mapping[Cell, ir.Call]) -> dict[Cell, object]:
    """Return what the calls give where that is the same in every trial."""
    named = {a.cell: a.name for a in definitions.assumptions if not a.frozen}
    frozen = {a.cell: a.base for a in definitions.assumptions if a.frozen and a.base is not None}
    resolver = Resolver(workbook, [*named, *frozen], rewritten={**definitions.rewritten, **calls})
    try:
        lowered = lower_cells(resolver, [*calls], named, frozen)
    except FormulaError:
        return {}
    known = ((cell, lowered.value(cell)) for cell in calls)
    return {cell: value.objects().ravel()[0] for cell, value in known if value is not None}


def _is_stale(workbook: Workbook, cell: Cell, given: object) -> bool:
    """Report whether a cell of a table holds nothing, or another number; texts and logicals are not compared."""
    saved = workbook.content(cell).value
    if saved is None:
        return True
    return isinstance(saved, int | float) and not isinstance(saved, bool | ErrorCode) and not same_value(saved, given)


def _varying(workbook: Workbook, definitions: Definitions) -> list[DataTable]:
    """Return the tables that vary, whose cells are faults until they are computed; none that shows results."""
    corners = ((table, Cell(table.area.sheet, table.area.top, table.area.left)) for table in workbook.data_tables)
    return [
        table
        for table, corner in corners
        if isinstance(definitions.rewritten.get(corner), FormulaError) and corner not in definitions.unavailable
    ]


def computed_tables(definitions: Definitions) -> dict[Cell, _Body]:
    """Return the cells of data tables that are computed, each with what computes it."""
    calls = ((cell, call) for cell, call in definitions.rewritten.items() if isinstance(call, ir.Call))
    bodies = ((cell, call.given.body) for cell, call in calls if isinstance(call.given, Function))
    return {cell: body for cell, body in bodies if isinstance(body, _Body) and body.formula.sheet == cell.sheet}


def cells_read(definitions: Definitions, cells: Iterable[Cell]) -> frozenset[Cell]:
    """Return what the formulas of data tables read to compute the cells of tables among these."""
    tables = computed_tables(definitions)
    return frozenset().union(*(tables[cell].read for cell in cells if cell in tables)) if tables else frozenset()


@dataclass(frozen=True, slots=True)
class _Body:
    """What the engines call: the values of the input cells and of the assumptions in, `(n,)` answers out.

    Attributes:
        program: of the formula.
        names: of what it takes, in order.
        formula: the cell that holds it.
        read: the cells that the formula is computed from, but for the input cells.
    """

    program: NumpyProgram
    names: tuple[str, ...]
    formula: Cell
    read: frozenset[Cell]

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
            (result,) = evaluator.filters(inputs, part.stop - part.start)
            answers[part] = result.as_floats(copy=False)
            faults[part] = 0 if result.codes is None else result.codes
        codes = np.where(errors > 0, errors, faults)
        codes = np.where(codes > max(ErrorCode), np.uint8(ErrorCode.VALUE), codes).astype(np.uint8)
        return Value.of_numbers(np.where(codes > 0, 0.0, answers), codes)


def _calls(
    workbook: Workbook, definitions: Definitions, table: DataTable, varied: Collection[Cell]
) -> dict[Cell, ir.Call] | None:
    """Return the call of each cell of a table; None where a formula cannot be computed, or it has texts for values."""
    if not table.inputs or len(table.inputs) < 1 + table.two_inputs:
        return None
    cells = [*table.area.cells()]
    if any(isinstance(workbook.content(value).value, str) for cell in cells for value in table.values_of(cell)):
        return None
    try:
        named = _named(definitions, varied)
        formulas = {*map(table.formula_of, cells)}
        bodies = {formula: _body(workbook, definitions, table, formula, named) for formula in formulas}
    except FormulaError:
        return None
    known: Mapping[str, Cell] = {name: cell for cell, name in named.items()}
    result = {}
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
        result[cell] = ir.Call(f"TABLE.{formula}", (*table.values_of(cell), *rest), given=row)
    return result


def _named(definitions: Definitions, varied: Collection[Cell]) -> dict[Cell, str]:
    """Return what the calls take beside the input cells: the assumptions and what is varied, by cell."""
    return {cell: f"\0{cell}" for cell in varied} | {a.cell: a.name for a in definitions.assumptions}


def _body(
    workbook: Workbook, definitions: Definitions, table: DataTable, formula: Cell, known: Mapping[Cell, str]
) -> _Body:
    """Compile a formula of a table as a function of the input cells and the assumptions.

    Raises:
        FormulaError: it cannot be computed.
    """
    inputs = dict(zip(table.inputs, _INPUTS, strict=False))
    named = {cell: name for cell, name in known.items() if cell not in inputs}
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
    read = (lowered.read | cells_read(definitions, lowered.graph.formulas)) - inputs.keys()
    return _Body(program, (*inputs.values(), *(name for at, name in named.items() if at in reached)), formula, read)
