"""The accepted trials over the drawing of the workbook."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.drawn_trials import drawn_trials
from xlmc.outputs.document.parts import Block, Figure

if TYPE_CHECKING:
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


def section(material: Material) -> Iterator[Block]:
    """Yield accepted trials over the workbook's chart."""
    drawn = drawn_trials(material.simulation)
    if drawn is not None:
        yield Figure(
            drawn,
            f"{drawn.description}: the curves are those of the workbook's chart, as it stored them.",
        )
