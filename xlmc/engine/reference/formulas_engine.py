"""The slow reference: the callables that the `formulas` package compiles itself, cell by cell and trial by trial."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, Evaluator, Target, column_of
from xlmc.engine.graph.lowering import Lowering
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, Cell, column_letters, host_of
from xlmc.excel.formula import compile_with_formulas, formula_text, ir
from xlmc.excel.formula.precedents import references
from xlmc.excel.functions.registry import Function
from xlmc.excel.functions.values import Floats, from_objects

__all__ = ["FormulasProgram"]

Cells = dict[Cell, object]

_OTHER_ENGINE = "use the engine `numpy`"


class FormulasProgram:
    """The needed cells as `formulas` computes them: the answers of the fast engine, some 100,000 times slower."""

    largest_block = 16

    def __init__(
        self, lowering: Lowering, filters: Sequence[Target], forecasts: Sequence[Target], may_err: frozenset[str]
    ) -> None:
        graph = lowering.graph
        if graph.circles:
            message = "the engine `formulas` has no cells that refer to themselves"
            raise FormulaError(message, where=next(iter(graph.circles)), hint=_OTHER_ENGINE)
        self.inputs = {cell: name for cell, name in lowering.inputs.items() if cell in graph.reached}
        self.content = lambda cell: graph.workbook.content(cell).value
        self.constants: Cells = {**lowering.saved, **lowering.frozen}
        computed = {cell: tree for cell, tree in graph.formulas.items() if cell not in lowering.saved}
        for cell in computed:
            match computed[cell]:
                case ir.Call(given=Function(home=home)):
                    message = f"the engine `formulas` cannot compute what {home} gives"
                    raise FormulaError(message, where=cell, hint=_OTHER_ENGINE)
            formula = graph.workbook.content(host_of(cell)).formula
            if formula is None or formula.array is not None or formula.dynamic:
                raise FormulaError("the engine `formulas` has no array formulas", where=cell, hint=_OTHER_ENGINE)
        self.cells = [(cell, _Compiled(tree, cell)) for cell, tree in computed.items()]
        self.filters = [_Compiled(target.tree, target.cell) for target in filters]
        self.forecasts = [_Compiled(target.tree, target.cell) for target in forecasts]

    def evaluator(self, block: int) -> Evaluator:
        """See `Program`."""
        return _FormulasEvaluator(self)


class _FormulasEvaluator:
    def __init__(self, program: FormulasProgram) -> None:
        self._program = program
        self._trials: list[Cells] = []

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        self._trials = [self._trial(inputs, i) for i in range(n)]
        return [self._column(target, range(n)) for target in self._program.filters]

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        return [self._column(target, survivors) for target in self._program.forecasts]

    def _trial(self, inputs: Mapping[str, Floats], i: int) -> Cells:
        program = self._program
        values: Cells = program.constants.copy()
        for cell, name in program.inputs.items():
            values[cell] = ErrorCode.NUM if np.isnan(inputs[name][i]) else float(inputs[name][i])
        for cell, compiled in program.cells:
            value = compiled(values, program.content)
            values[cell] = 0.0 if value is None else value
        return values

    def _column(self, target: _Compiled, trials: Sequence[int] | NDArray[np.intp]) -> Column:
        values = np.empty(len(trials), object)
        for position, i in enumerate(trials):
            values[position] = target(self._trials[i], self._program.content)
        return column_of(from_objects(values), len(trials))


class _Compiled:
    """A tree compiled by `formulas`. Its references get plain addresses, so that names of sheets do not matter."""

    def __init__(self, tree: ir.Expression, cell: Cell) -> None:
        self._cell, self._tree = cell, tree
        self._single = tree if isinstance(tree, Cell) else None
        self._names: dict[Cell | Area, str] = {}
        left = 1
        for reference in dict.fromkeys(references(tree)):
            rows, columns = (reference.rows, reference.columns) if isinstance(reference, Area) else (1, 1)
            last = f":{column_letters(left + columns - 1)}{rows}" if rows * columns > 1 else ""
            self._names[reference] = f"{column_letters(left)}1{last}"
            left += columns
        try:
            self._call = compile_with_formulas(formula_text(tree, self._name))
        except FormulaError as error:
            raise self._naming_cell(error) from None

    def __call__(self, values: Cells, content: Callable[[Cell], object]) -> object:
        def value(cell: Cell) -> object:
            return values[cell] if cell in values else content(cell)

        if self._single is not None:
            return value(self._single)
        try:
            return self._call({name: _argument_of(reference, value) for reference, name in self._names.items()})
        except FormulaError as error:
            raise self._naming_cell(error) from None

    def _name(self, reference: Cell | Area) -> str:
        """Return the address that stands for a reference; a reference that the formula only looks at (`ROW(D5)`) has
        none.
        """
        if reference not in self._names:
            raise FormulaError("the engine `formulas` cannot tell where a cell stands", hint=_OTHER_ENGINE)
        return self._names[reference]

    def _naming_cell(self, error: FormulaError) -> FormulaError:
        """Return the error, naming the cell and showing the formula with its own references."""
        return FormulaError(error.message, where=self._cell, hint=error.hint, text=formula_text(self._tree))


def _argument_of(reference: Cell | Area, value: Callable[[Cell], object]) -> Any:
    if isinstance(reference, Cell):
        return value(reference)
    grid = np.empty((reference.rows, reference.columns), object)
    for cell in reference.cells():
        grid[cell.row - reference.top, cell.column - reference.left] = value(cell)
    return grid
