"""The words of the report."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.outputs.document.glossary import GLOSSARY, WORDS_OF_EVIDENCE, WORDS_OF_SCENARIOS
from xlmc.outputs.document.parts import Block, Bullets

if TYPE_CHECKING:
    from xlmc.outputs.document.material import Material

__all__ = ["section"]


def section(material: Material) -> Iterator[Block]:
    """Yield the words that the report uses."""
    simulation = material.simulation
    model = simulation.model
    absent = {
        "Filter": not model.filters and not model.forecast_filters,
        "Check": not simulation.checks,
        "Threshold": all(each.threshold is None for each in model.forecasts),
    }
    words = [
        *(each for each in GLOSSARY if not absent.get(each[0])),
        *(WORDS_OF_EVIDENCE if simulation.agreement is not None else ()),
        *(WORDS_OF_SCENARIOS if simulation.settings.scenarios else ()),
    ]
    fill = vocabulary_of(simulation.model.workbook).fill
    yield Bullets(tuple(f"{word}: {fill(says)}" for word, says in words), "small")
