"""The notices of a run: what its reader should know."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.parts import Block, Paragraph

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["notice_blocks"]


def notice_blocks(simulation: RunResult) -> Iterator[Block]:
    """Yield a paragraph for each notice."""
    for notice in simulation.notices:
        yield Paragraph(str(notice), "notice")
