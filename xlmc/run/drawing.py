"""Assumptions of a workbook as draws: constant parameters checked, dynamic ones compiled."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell
from xlmc.definitions.model import Assumption, DataRange, Parameter, name_key
from xlmc.definitions.tables.data import data_family
from xlmc.distributions import ByPercentiles, Family
from xlmc.errors import DefinitionError
from xlmc.evaluation.engine import Evaluator, Target
from xlmc.evaluation.graph.lower import Lowering
from xlmc.evaluation.numpy.numpy_engine import NumpyProgram
from xlmc.formula import ir
from xlmc.functions.values import ERROR, TEXT
from xlmc.sampling.draws import Draw, DynamicParameters

__all__ = ["draw_of", "dynamic_parameters", "parameter_target", "settled"]


def parameter_target(cell: Cell) -> Target:
    """A parameter's cell, taken as a number."""
    return Target(ir.Binary("+", cell, ir.Number(0.0)), cell)


def draw_of(assumption: Assumption, lowering: Lowering) -> Draw:
    """How an assumption is drawn; a parameter that no assumption reaches becomes a number here.

    Raises:
        DefinitionError: the numbers are no distribution.
    """
    data = assumption.data
    family = assumption.family if data is None else _from_data(assumption.family, data, assumption.name, lowering)
    parameters = tuple(settled(each, lowering) for each in family.bind((), assumption.parameters))
    cutoffs = None
    if assumption.lower_cutoff is not None or assumption.upper_cutoff is not None:
        lower = -np.inf if assumption.lower_cutoff is None else assumption.lower_cutoff
        upper = np.inf if assumption.upper_cutoff is None else assumption.upper_cutoff
        cutoffs = settled(lower, lowering), settled(upper, lowering)
    draw = Draw(name_key(assumption.name), family, parameters, cutoffs)
    if isinstance(family, ByPercentiles) and draw.varying:  # the member with these percentiles is looked for once
        message = f"{assumption.name}: a distribution given by percentiles cannot depend on another assumption"
        raise DefinitionError(message, where=draw.varying[0], hint="give it by its parameters, or by numbers")
    if (fault := draw.fault()) is not None:
        raise DefinitionError(f"{assumption.name}: {fault.message}", where=assumption.row, hint=fault.hint)
    return draw


def _from_data(family: Family, data: DataRange, name: str, lowering: Lowering) -> Family:
    """The family of the data that the cells compute to."""
    drawn = next((cell for cell in lowering.inputs if cell in data.area), None)
    if drawn is not None:
        raise _varying_data(name, drawn)

    def number(cell: Cell) -> float:
        value = settled(cell, lowering)
        if isinstance(value, Cell):
            raise _varying_data(name, cell)
        return value

    return data_family(family, data, number)


def _varying_data(name: str, cell: Cell) -> DefinitionError:
    return DefinitionError(
        f"The data of {name!r} vary with an assumption in this cell, and data must be fixed",
        where=cell,
        hint="Draw from fixed data, and let the cell that uses the draw vary with the assumption",
    )


def settled(parameter: Parameter, lowering: Lowering) -> Parameter:
    """The parameter's number; its cell where an assumption reaches it.

    Raises:
        DefinitionError: the cell is an error or a text.
    """
    if not isinstance(parameter, Cell):
        return float(parameter)
    value = lowering.known(parameter_target(parameter))
    if value is None:
        return parameter
    if int(value.kinds[0]) >= ERROR or int(value.kinds[0]) == TEXT:
        raise DefinitionError("the parameter is an error", where=parameter, hint="correct the cell's formula")
    return float(value.numbers[0])


@dataclass(frozen=True, slots=True)
class _Varying:
    """Computes parameters from draws; see `DynamicParameters`."""

    evaluator: Evaluator
    places: tuple[Cell, ...]

    def __call__(self, drawn: Mapping[str, NDArray[np.float64]], n: int) -> dict[Hashable, NDArray[np.float64]]:
        columns = self.evaluator.filters(drawn, n)
        return {cell: column.as_floats() for cell, column in zip(self.places, columns, strict=True)}


def dynamic_parameters(draws: Sequence[Draw], lowering: Lowering, block: int) -> DynamicParameters:
    """What computes the varying parameters of a stage from the draws of the stages before it; for one thread."""
    places = tuple(dict.fromkeys(p for draw in draws for p in draw.varying if isinstance(p, Cell)))
    targets = [parameter_target(cell) for cell in places]
    program = NumpyProgram.of(lowering, targets, [], frozenset(lowering.inputs.values()))
    return _Varying(program.evaluator(block), places)
