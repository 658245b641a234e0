"""The scene: the base case as the chart of the workbook draws it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.parts import Block, Figure
from xlmc.outputs.document.scene_drawing import scene_drawing

if TYPE_CHECKING:
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


def section(material: Material) -> Iterator[Block]:
    """Yield the base case as the workbook's chart draws it."""
    drawn = scene_drawing(material.simulation.model.workbook)
    if drawn is not None:
        yield Figure(
            drawn,
            "The base case as the chart of the workbook draws it, with the numbers that were stored in "
            "the chart when the workbook was last saved.",
        )
