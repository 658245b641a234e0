"""Assumptions of a workbook as draws: constant parameters checked, dynamic ones compiled; and numbers that are fixed.

A parameter that is computed from its assumption's own cell, `Low` as `=D7*0.97`, is computed from the base value of
that cell: a draw cannot have limits that move with itself. What a person means is 3 % below the value in the cell.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence, Set
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Evaluator, Target
from xlmc.engine.graph.lowering import Lowering, lower_cells
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.errors import DefinitionError, ErrorCode, Notice
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.functions.values import ERROR, TEXT
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, DataRange, Definitions, Filter, Parameter
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.definitions.tables.data import data_family
from xlmc.montecarlo.definitions.tables.evidence_rows import as_filter, check_sizes
from xlmc.montecarlo.distributions import Family
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.model.needed import upstream
from xlmc.montecarlo.sampling.draws import Draw, DynamicParameters

__all__ = ["VaryingError", "base_point", "draw_of", "dynamic_parameters", "parameter_target", "with_numbers"]


class VaryingError(DefinitionError):
    """What a distribution is made from varies with an assumption, and may not."""


def parameter_target(cell: Cell) -> Target:
    """Take a parameter's cell as a number."""
    return Target(ir.Binary("+", cell, ir.Number(0.0)), cell)


def base_point(bases: Mapping[str, float | None]) -> dict[str, NDArray[np.float64]] | None:
    """Name of each assumption -> `(1,)` its base value; None if one of them has none."""
    known = {name: np.full(1, base) for name, base in bases.items() if base is not None}
    return known if len(known) == len(bases) else None


def draw_of(assumption: Assumption, lowering: Lowering) -> Draw:
    """How an assumption is drawn; a parameter that no assumption reaches becomes a number here.

    Numbers are checked, unless they were as the row was read.

    Raises:
        VaryingError: the data, or what it is searched by, vary.
        DefinitionError: the numbers are not a distribution.
    """
    data = assumption.data
    family = assumption.family if data is None else _from_data(assumption.family, data, assumption.name, lowering)
    computed = {
        key: _fold_cell(cell, lowering, f"{assumption.headings[key]} of {assumption.name!r}")
        for key, cell in assumption.formulas.items()
    }
    given = {**assumption.given, **computed}
    draw = Draw.of(assumption.name, family, given, assumption.stream)
    if family.given_by and draw.varying:  # the member is searched for once
        message = f"{assumption.name}: a distribution given by {family.given_by} cannot depend on another assumption"
        raise VaryingError(message, where=draw.varying[0], hint="give it by its parameters, or by numbers")
    if draw != assumption.checked and (fault := draw.fault()) is not None:
        raise DefinitionError(f"{assumption.name}: {fault.message}", where=assumption.row, hint=fault.hint)
    return draw


def _from_data(family: Family, data: DataRange, name: str, lowering: Lowering) -> Family:
    """Return the family of the data that the cells compute to."""
    drawn = next((cell for cell in lowering.inputs if cell in data.area), None)
    if drawn is not None:
        raise _varying_data(name, drawn)

    def number(cell: Cell) -> float:
        value = _fold_cell(cell, lowering, f"The data of {name!r}")
        if isinstance(value, Cell):
            raise _varying_data(name, cell)
        return value

    return data_family(family, data, number)


def _varying_data(name: str, cell: Cell) -> VaryingError:
    return VaryingError(
        f"The data of {name!r} vary with an assumption in this cell, and data must be fixed",
        where=cell,
        hint="Draw from fixed data, and let the cell that uses the draw vary with the assumption",
    )


def _fold_cell(cell: Cell, lowering: Lowering, what: str) -> Parameter:
    """Return the number of a parameter's cell; the cell where an assumption reaches it.

    Args:
        cell: the cell.
        lowering: that has it.
        what: the parameter in words, for the message.

    Raises:
        DefinitionError: the cell is an error or a text.
    """
    value = lowering.known(parameter_target(cell))
    if value is None:
        return cell
    if int(value.kinds[0]) >= ERROR or int(value.kinds[0]) == TEXT:
        result = value.objects().ravel()[0]
        shown = f"the error {result.text}" if isinstance(result, ErrorCode) else f"the text {result!r}, not a number"
        raise DefinitionError(f"{what} is {shown}", where=cell, hint="Correct the cell's formula")
    return float(value.numbers[0])


@dataclass(frozen=True, slots=True)
class _Varying:
    """Computes parameters from draws; see `DynamicParameters`."""

    evaluator: Evaluator
    cells: tuple[Cell, ...]

    def __call__(self, drawn: Mapping[str, NDArray[np.float64]], n: int) -> dict[Cell, NDArray[np.float64]]:
        columns = self.evaluator.filters(drawn, n)
        return {cell: column.as_floats() for cell, column in zip(self.cells, columns, strict=True)}


def dynamic_parameters(draws: Sequence[Draw], lowering: Lowering, block: int) -> DynamicParameters:
    """Make what computes the varying parameters of a stage from the draws of the stages before it; for one thread."""
    cells = tuple(dict.fromkeys(p for draw in draws for p in draw.varying))
    targets = [parameter_target(cell) for cell in cells]
    program = NumpyProgram.of(lowering, targets, [], frozenset(lowering.inputs.values()))
    return _Varying(program.evaluator(block), cells)


def with_numbers(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with a number for what formulas compute and no assumption may vary.

    These are parameters that depend on their assumption's own cell, readings and errors of evidence, and rank
    correlations.

    Raises:
        DefinitionError: such a cell depends on an assumption, or does not hold what it must.
        FormulaError: one cannot be computed.
    """
    definitions = _with_base_parameters(workbook, definitions)
    cells = [cell for each in definitions.filters if each.evidence for cell in each.evidence.cells]
    cells += [row.value for row in definitions.correlations if isinstance(row.value, Cell)]
    if not cells:
        return definitions
    lowering = _lower_fixed(workbook, definitions, cells)
    return replace(
        definitions,
        filters=tuple(_with_evidence_numbers(each, lowering) for each in definitions.filters),
        correlations=tuple(_with_coefficient(row, lowering) for row in definitions.correlations),
    )


def _lower_fixed(workbook: Workbook, definitions: Definitions, cells: Collection[Cell]) -> Lowering:
    """Cells of definitions that must hold numbers, lowered: `_fold_cell` finds the number, or that it varies."""
    assumptions = definitions.assumptions
    drawn = {a.cell: a.name for a in assumptions if not a.frozen}
    frozen = {a.cell: a.base for a in assumptions if a.frozen and a.base is not None}
    resolver = Resolver(workbook, [a.cell for a in assumptions], rewritten=definitions.rewritten)
    return lower_cells(resolver, cells, drawn, frozen)


def _with_evidence_numbers(filter_: Filter, lowering: Lowering) -> Filter:
    """Return the filter with a number for each reading and each size of an error that a formula computes."""
    evidence = filter_.evidence
    if evidence is None or not any(evidence.cells):
        return filter_
    reading = _number(evidence, evidence.reading, lowering)
    sizes = {key: _number(evidence, value, lowering) for key, value in evidence.sizes.items()}
    check_sizes(evidence, reading, sizes)
    return as_filter(replace(evidence, reading=reading, sizes=sizes))


def _number(evidence: Evidence, value: Parameter | None, lowering: Lowering) -> float:
    assert value is not None, "a row without a reading is no filter"
    what = f"A number of the evidence {evidence.name!r}"
    result = _fold_cell(value, lowering, what) if isinstance(value, Cell) else value
    if isinstance(result, Cell):
        message = f"{what} varies with an assumption"
        hint = (
            "A reading and its error are fixed: where a reading rests on uncertain inputs, let Cell be the difference "
            "of the model's quantity and what they give, with Reading 0"
        )
        raise DefinitionError(message, where=result, hint=hint)
    return result


def _with_coefficient(row: Correlation, lowering: Lowering) -> Correlation:
    """Return the row with a number for the rank correlation, which a formula may compute."""
    what = f"The rank correlation of {row.first!r} and {row.second!r}"
    value = _fold_cell(row.value, lowering, what) if isinstance(row.value, Cell) else row.value
    if isinstance(value, Cell):
        raise DefinitionError(
            f"{what} varies with an assumption", where=value, hint="A correlation is one number for all trials: type it"
        )
    if not -1 <= value <= 1:
        message = f"Correlation ({show(value)}) must lie between -1 and 1"
        raise DefinitionError(message, where=row.row, hint="Correct the formula: a rank correlation is from -1 to 1")
    return replace(row, value=value)


def _with_base_parameters(workbook: Workbook, definitions: Definitions) -> Definitions:
    """Return the definitions with a number for every parameter and cutoff that depends on its assumption's own cell.

    Raises:
        DefinitionError: such a parameter depends on another assumption, too, or the cell is blank.
        FormulaError: its formula cannot be computed.
    """
    assumptions = definitions.assumptions
    sought = [cell for a in assumptions if not isinstance(a.cell, InFormula) for cell in a.formulas.values()]
    if not sought:
        return definitions
    rows = {a.cell: a for a in assumptions if not isinstance(a.cell, InFormula)}
    resolver = Resolver(workbook, [a.cell for a in assumptions], rewritten=definitions.rewritten)
    given = frozenset(a.cell for a in assumptions)
    graph = build_graph(resolver, sought, given, strict=False)
    if given.isdisjoint(graph.reached):
        return definitions
    changed = {cell: _Own(resolver, definitions, assumption).result(graph) for cell, assumption in rows.items()}
    numbers = {cell: result for cell, result in changed.items() if result}
    if not numbers:
        return definitions
    notices = (_notice(rows[cell], results) for cell, results in numbers.items())
    changed_ones = tuple(a.with_numbers(numbers[a.cell]) if a.cell in numbers else a for a in assumptions)
    return replace(definitions, assumptions=changed_ones, notices=(*definitions.notices, *notices))


class _Own:
    """One assumption, and those of its parameters that its own cell reaches."""

    def __init__(self, resolver: Resolver, definitions: Definitions, assumption: Assumption) -> None:
        self._resolver, self._definitions, self._assumption = resolver, definitions, assumption

    def result(self, graph: Graph) -> dict[str, float]:
        """Key of each such parameter -> its number."""
        reached = ((key, cell, upstream(graph, [cell], {})) for key, cell in self._assumption.formulas.items())
        numbers = {key: self._number(key, cell, up) for key, cell, up in reached if self._assumption.cell in up}
        return {key: number for key, number in numbers.items() if number is not None}

    def _number(self, key: str, cell: Cell, upstream: Set[Cell]) -> float | None:
        """Return the number; None if another assumption reaches it and this one is frozen, so that nothing
        asks for it.
        """
        own = self._assumption
        if own.base is None:
            message = f"{own.headings[key]} of {own.name!r} depends on the assumption's own cell, which is blank"
            raise DefinitionError(message, where=cell, hint=f"Type the measured value into {own.cell}")
        others = (a for a in self._definitions.assumptions if not a.frozen and a.cell != own.cell)
        value = self._computed(cell, f"{own.headings[key]} of {own.name!r}")
        if isinstance(value, Cell) and own.frozen:
            return None
        if isinstance(value, Cell):
            other = next((a for a in others if a.cell in upstream), None)
            more = "another assumption" if other is None else f"the assumption {other.name!r}"
            message = f"{own.headings[key]} of {own.name!r} depends on the assumption's own cell and on {more}"
            hint = f"In its formula, type the number {show(own.base)} instead of {own.cell}"
            raise DefinitionError(message, where=cell, hint=hint)
        return value

    def _computed(self, cell: Cell, what: str) -> Parameter:
        """Return what the cell is with the assumption at its base value; the cell where another assumption
        reaches it.
        """
        assumptions, own = self._definitions.assumptions, self._assumption.cell
        drawn = {a.cell: a.name for a in assumptions if not a.frozen and a.cell != own}
        frozen = {a.cell: a.base for a in assumptions if a.cell not in drawn and a.base is not None}
        return _fold_cell(cell, lower_cells(self._resolver, [cell], drawn, frozen), what)


def _notice(assumption: Assumption, numbers: Mapping[str, float]) -> Notice:
    base = "" if assumption.base is None else f" ({show(assumption.base)})"
    shown = ", ".join(f"{assumption.headings[key]} {show(number)}" for key, number in numbers.items())
    return Notice(
        f"parameters are computed from the base value of the assumption's own cell{base}: {shown}", assumption.row
    )
