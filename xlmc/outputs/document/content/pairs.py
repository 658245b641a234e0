"""Pairs: forecasts two at a time, their joint probabilities and their rank correlation."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.pairs import PAIRS, Pair, pairs_of
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document.cells import NONE
from xlmc.outputs.document.measured import Measured, counted_share
from xlmc.outputs.document.parts import Block, Content, Paragraph, Table

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.outputs.document.material import Material

__all__ = ["pair_blocks", "section"]

_FORECASTS: Final = 6
"""The most forecasts; with more there are more pairs than a table shows."""

_HEADS: Final = ("First (A) and its limit a", "Second (B) and its limit b", "A > a and B > b", "A > a or B > b")


def pair_blocks(simulation: RunResult, pairs: Sequence[Pair]) -> Iterator[Block]:
    """Yield a row for each pair, and what the numbers are; nothing where there are no pairs."""
    if pairs:
        yield Table("", (*_HEADS, "A > B", "Rank correlation"), tuple(map(_row, pairs)), spans=(3, 3, 4, 2, 2, 4))
        for sentence in _sentences(simulation, pairs):
            yield Paragraph(sentence, "small")


def _row(pair: Pair) -> tuple[Content, ...]:
    return (
        *pair.limit_texts,
        counted_share(pair.both_above),
        Measured(pair.either_above, "share"),
        Measured(pair.first_greater, "share", nothing=NONE),
        Measured(pair.correlation, interval=True),
    )


def _sentences(simulation: RunResult, pairs: Sequence[Pair]) -> Iterator[str]:
    trials, ranked = {pair.trials for pair in pairs}, {pair.ranked for pair in pairs}
    counted = count_text(min(trials))
    if len(trials) > 1:
        counted = f"{counted} to {count_text(max(trials))}"
    message = (
        "A limit is the forecast's threshold or, if it has none, its median; it is used as the number printed here. A "
        "yes/no answer lies above its limit where it is a yes. Probabilities are shares of the accepted trials in "
        f"which both forecasts are numbers ({counted})."
    )
    if max(ranked) < max(trials):
        message += f" Rank correlations come from the first {count_text(max(ranked))} of them."
    yield f"{message} A > B is given where both have the same units."
    if len(pairs) == PAIRS and len(simulation.model.forecasts) > _FORECASTS:
        yield f"At most {PAIRS} pairs of forecasts are here, the first ones of the workbook."


def section(material: Material) -> Iterator[Block]:
    """Yield the pairs of the chosen forecasts."""
    asked = {*material.forecasts}
    pairs = pairs_of(material.simulation) if material.simulation.weighting is None else []
    shown = [each for each in pairs if {each.first.name, each.second.name} <= asked]
    return pair_blocks(material.simulation, shown)
