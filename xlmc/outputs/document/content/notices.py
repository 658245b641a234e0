"""The notices of a run: what its reader should know."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.parts import Block, Paragraph

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["notice_blocks", "section"]


def notice_blocks(simulation: RunResult) -> Iterator[Block]:
    """Yield a paragraph for each notice."""
    for notice in simulation.notices:
        yield Paragraph(str(notice), "notice")


def section(material: Material) -> Iterator[Block]:
    """Yield the notices."""
    return notice_blocks(material.simulation)
