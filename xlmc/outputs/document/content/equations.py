"""The equations that the workbook prints."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.equations import equations_of
from xlmc.outputs.document.parts import Block, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


def section(material: Material) -> Iterator[Block]:
    """Yield the equations."""
    equations = equations_of(material.simulation.model)
    if not equations:
        return
    yield Paragraph(
        "The equations as the workbook prints them beside the cells that the answers need, with the source that it "
        "names. xlmc computes the cells' formulas, not these texts."
    )
    heads = ("Quantity", "Symbol", "Units", "Equation", "Source")
    yield Table("", heads, tuple(map(tuple, equations)), (), (2.5, 0.9, 0.7, 4.0, 1.7), "The equations.")
