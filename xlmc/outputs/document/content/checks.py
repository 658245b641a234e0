"""The checks of a workbook: what each asks, and how many accepted trials fail it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.montecarlo.diagnostics.checking import checks_sentence
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import NONE, Shown
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.montecarlo.diagnostics.checking import CheckResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["check_blocks", "section"]


def check_blocks(simulation: RunResult) -> Iterator[Block]:
    """Yield the checks; nothing where the workbook has none."""
    checks = simulation.checks
    if not checks:
        return
    yield Table(
        "",
        ("Check", "Cell", "Base case", "Trials failing", "Share", "Because"),
        tuple(map(_row, checks)),
        widths=(2.2, 1.1, 0.6, 0.7, 1.2, 4.4),
        caption="Checks: each cell must be TRUE.",
        spans=(1, 1, 1, 1, 1, 6),
    )
    yield Paragraph(f"{checks_sentence(checks)}. A check rejects no trial.", "small")


def _row(check: CheckResult) -> tuple[Content, ...]:
    text = check.base.content
    return (
        check.name,
        str(check.cell),
        Shown(NONE if text is None else text, look="warning" if check.holds is False else "text"),
        cells.count(check.failed),
        Measured(check.share, "share"),
        check.because or NONE,
    )


def section(material: Material) -> Iterator[Block]:
    """Yield the checks."""
    return check_blocks(material.simulation)
