"""Evidence as filters: a limit where its error is uniform, and where it is normal a chance of being kept.

A trial in which the model's quantity is z standard deviations from the reading is kept with probability exp(-z²/2): an
item has a uniform number U of its own, from a random stream of its own, and keeps the trial where U ≤ exp(-z²/2). What
is kept are then exact draws, of equal weight, from the inputs given the reading (rejection sampling).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from xlmc.address import Cell
from xlmc.definitions.definitions import Assumption, Filter, Parameter
from xlmc.definitions.evidence import Evidence
from xlmc.definitions.tables.evidence_rows import as_filter, check_sizes
from xlmc.errors import DefinitionError
from xlmc.evaluation.graph.lower import Lowering
from xlmc.run.draw_binding import fold_cell

__all__ = ["chances_of", "with_evidence_numbers"]


def with_evidence_numbers(filter_: Filter, lowering: Lowering) -> Filter:
    """The filter with a number for each reading and each size of an error that a formula computes.

    Raises:
        DefinitionError: such a cell depends on an assumption, or is no number.
    """
    evidence = filter_.evidence
    if evidence is None or not any(evidence.cells):
        return filter_
    reading = _number(evidence, evidence.reading, lowering)
    sizes = {key: _number(evidence, value, lowering) for key, value in evidence.sizes.items()}
    check_sizes(evidence, reading, sizes)
    return as_filter(replace(evidence, reading=reading, sizes=sizes))


def _number(evidence: Evidence, value: Parameter | None, lowering: Lowering) -> float:
    assert value is not None, "a row without a reading is no filter"
    found = fold_cell(value, lowering) if isinstance(value, Cell) else value
    if isinstance(found, Cell):
        message = f"A number of the evidence {evidence.name!r} varies with an assumption"
        hint = (
            "A reading and its error are fixed: where a reading rests on uncertain inputs, let Cell be the difference "
            "of the model's quantity and what they give, with Reading 0"
        )
        raise DefinitionError(message, where=found, hint=hint)
    return found


def chances_of(filters: Iterable[Filter]) -> tuple[Assumption, ...]:
    """The uniform numbers of the filters whose error is no limit; their base value, 0, keeps every trial."""
    items = [each.evidence for each in filters if each.evidence is not None]
    return tuple(
        Assumption(each.stream, each.chance, "Uniform", {"low": 0.0, "high": 1.0}, each.row, base=0.0)
        for each in items
        if each.by_chance
    )
