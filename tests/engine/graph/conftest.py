"""What single formulas give from constants, as lists of rows where they give arrays."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent, Formula

_AT = Cell("S", 9, 8)


@pytest.fixture(scope="session")
def value_of(lower):
    """`value_of(cells, formula, at=H9, array=False)`: what a formula in a cell gives."""

    def make(cells, formula, at=_AT, array=False, **of_workbook):
        content = CellContent(None, Formula(formula, at.row, at.column, dynamic=array))
        lowering, _ = lower({**cells, str(at): content}, [], [str(at)], **of_workbook)
        node = lowering.dag.nodes[lowering.array(at) if array else lowering.cell(at)]
        items = node.value.objects()[0]
        return items.tolist() if isinstance(items, np.ndarray) else items

    return make
