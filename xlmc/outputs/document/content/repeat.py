"""How to repeat a run, and what its numbers depend on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.outputs.document.parts import Block, Code, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


def section(material: Material) -> Iterator[Block]:
    """Yield how to repeat the run."""
    record = material.record
    yield Paragraph(
        "The same workbook with the same seed and the same software gives the same numbers. With xlmc installed, type:"
    )
    yield Code(str(record["run.repeat"]))
    yield Paragraph("The fingerprint of the accepted trials, a SHA-256, is then:")
    yield Code(str(record["run.fingerprint"]))
    software = (f"{entry.label} {entry.value}" for entry in record.section("software").entries)
    machine = (str(entry.value) for entry in record.section("processor").entries)
    lines = [
        ("Sampling", str(record["sampling.method_in_words"])),
        ("Generator", str(record["sampling.generator"])),
        ("Engine", str(record["sampling.engine"])),
        ("Software", ", ".join(software)),
        ("Machine", ", ".join(each for each in machine if len(each) < 60)),
    ]
    yield Table(
        "",
        ("What", "Value"),
        tuple(lines),
        widths=(1.6, 5),
        caption="What the numbers depend on, beside what stands below the title.",
    )
