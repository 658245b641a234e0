"""Formulas of cells that draw or mark an answer, as they stand between runs: with base cases instead of draws."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import ir
from xlmc.excel.formula.substitute import substitute
from xlmc.montecarlo.definitions.definitions import Assumption, Definitions
from xlmc.montecarlo.definitions.in_cells.theory import Distribution
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["base_formulas"]


def base_formulas(definitions: Definitions, draws: Mapping[str, Draw]) -> dict[Cell, ir.Expression | FormulaError]:
    """Return the formulas of the workbook's own cells that hold calls, computable without drawing, or why one is not.

    Args:
        definitions: of the workbook.
        draws: name of an assumption -> how it is drawn, as far as it is.
    """
    bases = {each.cell: _base(each, draws.get(each.name)) for each in definitions.assumptions}
    return {
        cell: _with_bases(cell, tree, bases)
        for cell, tree in definitions.rewritten.items()
        if not isinstance(tree, FormulaError) and not isinstance(cell, InFormula)
    }


def _base(assumption: Assumption, draw: Draw | None) -> float | None:
    """Return what stands for the draw in the base case: its own value, or the mean, if there is one."""
    if assumption.base is not None or draw is None or not draw.fixed:
        return assumption.base
    mean = Distribution(draw.distribution).mean()
    return mean if np.isfinite(mean) else None


def _with_bases(host: Cell, tree: ir.Expression, bases: Mapping[Cell, float | None]) -> ir.Expression | FormulaError:
    unknown: list[InFormula] = []

    def change(part: ir.Expression) -> ir.Expression | None:
        if isinstance(part, ir.Array):
            return ir.Array(tuple(tuple(substitute(each, change) for each in row) for row in part.rows))
        if not isinstance(part, InFormula):
            return None
        base = bases.get(part)
        if base is None:
            unknown.append(part)
            return None
        return ir.Number(base)

    expression = substitute(tree, change)
    if unknown:
        hint = "Let Excel calculate the workbook, or add RiskStatic with the value"
        return FormulaError("the formula draws at random, and its base case is not known", where=host, hint=hint)
    return expression
