"""Adjustment weights of matrices of `RiskCorrmat`: which coefficients give way where a matrix contradicts itself.

A matrix that has the name `M` is accompanied by one of the same size that is named `M_Weights`. Its numbers go from 0,
any change is allowed, to 100, none is; they stand below the diagonal, or above it, or both.

Source: Palisade's knowledge base, "How @RISK Adjusts an Invalid Correlation Matrix", and its manual, "Correlation
Adjustment Weights".
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.workbook.workbook import DefinedName, Workbook
from xlmc.montecarlo.definitions.tables.table_rows import number_in
from xlmc.montecarlo.distributions.parameters import show

__all__ = ["MOST_WEIGHT", "weight_of", "weights_of_matrices"]

MOST_WEIGHT: Final = 100.0
_ENDING: Final = "_weights"


def weights_of_matrices(workbook: Workbook, matrices: Collection[Area]) -> dict[Area, Area]:
    """Those of the matrices that have weights -> the areas of these.

    Raises:
        DefinitionError: a name ends so beside that of a matrix, and is no range of the same size.
    """
    suffixed = [each for each in workbook.names if each.name.lower().endswith(_ENDING)]
    result = {}
    for weights in suffixed:
        of = weights.name.lower().removesuffix(_ENDING)
        matrix = next((_area(workbook, each) for each in _named(workbook, of, weights.sheet)), None)
        if matrix is None or matrix not in matrices:
            continue
        area = _area(workbook, weights)
        if area is None or (area.rows, area.columns) != (matrix.rows, matrix.columns):
            message = (
                f"The name {weights.name} is no range of {matrix.rows} rows and columns, as its matrix {matrix} is"
            )
            raise DefinitionError(message, where=workbook.name, hint="Let it name the weights, a cell for each number")
        result[matrix] = area
    return result


def _named(workbook: Workbook, name: str, sheet: str | None) -> list[DefinedName]:
    """Return the names that are called so, those of the same sheet, or of the workbook, first."""
    defined_names = [each for each in workbook.names if each.name.lower() == name]
    return sorted(defined_names, key=lambda each: each.sheet != sheet)


def _area(workbook: Workbook, name: DefinedName) -> Area | None:
    """Return the range that a name stands for; None if it stands for something else."""
    host = Cell(name.sheet or next(iter(workbook.sheets)), 1, 1)
    try:
        tree: ir.Expression = Resolver(workbook, strict=False).tree(parse(name.text), host)
    except FormulaError:
        return None
    return tree if isinstance(tree, Area) else None


def weight_of(workbook: Workbook, weights: Mapping[Area, Area], matrix: Area, lower: int, upper: int) -> float:
    """Return the weight of the coefficient in this row and column of a matrix, counted from 1; 0 where it has none.

    Raises:
        DefinitionError: it is no number from 0 to 100.
    """
    area = weights.get(matrix)
    if area is None:
        return 0.0
    for row, column in ((lower, upper), (upper, lower)):
        cell = Cell(area.sheet, area.top + row - 1, area.left + column - 1)
        content = workbook.content(cell)
        if not content.is_blank:
            weight = number_in("The adjustment weight", content, cell)
            if not 0 <= weight <= MOST_WEIGHT:
                message = f"The adjustment weight ({show(weight)}) must lie between 0 and 100"
                raise DefinitionError(message, where=cell, hint="100 keeps the correlation as it is, 0 does not")
            return weight
    return 0.0
