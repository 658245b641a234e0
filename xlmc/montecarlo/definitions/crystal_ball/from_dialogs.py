"""What Crystal Ball's dialogs define, and whether a workbook may hold any: most do not."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Correlation, Decision, Filter, Forecast

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.crystal_ball.stored_objects import Precision

__all__ = ["UNPROVEN", "FromDialogs", "may_hold_blocks"]

UNPROVEN: Final = "this was not yet met in a genuine file: compare once in Crystal Ball"


@dataclass(slots=True)
class FromDialogs:
    """What the dialogs define.

    Attributes:
        assumptions, forecasts: by sheet, row and column.
        rewritten: cells of their own for parameters that are formulas, and cells that cannot be read, each with why.
        precisions: what is asked of the precision of forecasts, by name.
        damages: blocks and objects that cannot be read, in words.
        stored: whether the workbook holds blocks of Crystal Ball at all.
    """

    assumptions: list[Assumption] = field(default_factory=list)
    forecasts: list[Forecast] = field(default_factory=list)
    filters: list[Filter] = field(default_factory=list)
    correlations: list[Correlation] = field(default_factory=list)
    decisions: list[Decision] = field(default_factory=list)
    rewritten: dict[Cell, ir.Expression | FormulaError] = field(default_factory=dict)
    precisions: dict[str, Precision] = field(default_factory=dict)
    damages: list[str] = field(default_factory=list)
    stored: bool = False

    @property
    def refused(self) -> dict[Cell, FormulaError]:
        """The cells that cannot be read, each with why."""
        return {cell: why for cell, why in self.rewritten.items() if isinstance(why, FormulaError)}

    def __bool__(self) -> bool:
        return bool(self.assumptions or self.forecasts or self.rewritten or self.damages)


def may_hold_blocks(workbook: Workbook) -> bool:
    """Whether a drawing may hold a block of Crystal Ball's objects."""
    parts = workbook.parts or workbook.origin
    drawings = (content for name, content in parts.items() if name.lower().endswith(".vml"))
    return any(b"CB_" in content or b"\0" in content[:4] for content in drawings)
