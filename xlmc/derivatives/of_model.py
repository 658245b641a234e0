"""The derivatives of a workbook's cells."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

from xlmc.address import Cell
from xlmc.derivatives.found import Derivatives

if TYPE_CHECKING:
    from xlmc.model import Model

__all__ = ["derivatives"]


def derivatives(
    model: Model, inputs: Mapping[str, ArrayLike], *, order: int = 1, cells: Iterable[Cell] = ()
) -> Derivatives:
    """First, and second, derivatives of every forecast and of every filter's cell, at the points given.

    Filters are not asked: give accepted trials for derivatives there. Assumptions whose parameters depend on others
    count as independent of them: their draws are what varies.

    Args:
        model: the workbook.
        inputs: name of every live assumption -> `(n,)` or a number.
        order: 1, or 2 for second derivatives too; these take k times the time and memory.
        cells: more cells that are wanted; see `Model.needed`.

    Raises:
        SimulationError: an assumption is missing, unknown or frozen, the values are of different lengths, the order is
            neither, or a cell is not needed by any forecast or filter.
    """
    raise NotImplementedError
