"""Thin layers that filters leave, and the assumption that each is solved for.

Filters with two limits close together leave an assumption, all others given, an interval that is short beside its
spread. Where the formulas can be undone, that interval is computed in each trial.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.precedents import references
from xlmc.montecarlo.model.needed import upstream
from xlmc.montecarlo.rare.inverse_image import TURNS
from xlmc.montecarlo.rare.inverting import Inverting, Region, conjuncts
from xlmc.montecarlo.rare.limit_state import LimitState, leaves
from xlmc.montecarlo.rare.spans import Rearranged, Spans, intersection

if TYPE_CHECKING:
    from xlmc.engine.engine import Evaluator
    from xlmc.montecarlo.definitions.definitions import Assumption
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.rare.limit_state_function import Drawing
    from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["Layer", "layers_of"]

Floats = NDArray[np.float64]

_THIN: Final = 0.002
"""The longest interval that counts as thin, as a share of the range between an assumption's quartiles. Wider ones the
search describes well as they are."""

_OFTEN: Final = 0.01
"""The share of the trials in which it can be accepted at all, in which the intervals must be thin."""

_SOME: Final = 30
"""Trials, of those that are looked at, in which an assumption can be accepted."""

_LEAST: Final = 1e-12
"""Chance of an interval, on average over accepted trials; those that are shorter have too few of the 2^53 uniforms."""

_EXACT: Final = 1e-6
"""How much a uniform may differ after it went through its distribution and back."""

_MOST: Final = 1e300
_MOST_LAYERS: Final = 4
_MOST_CANDIDATES: Final = 64
_MOST_LOOKS: Final = 2_000_000
"""The most looks at cells, to see which vary with an assumption."""

_MOST_CONJUNCTS: Final = 8
"""The most filters that depend on one assumption and are tried in pairs."""


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """What some of the filters leave one assumption.

    Attributes:
        name: of the assumption.
        cell: of it.
        row: of its uniform.
        draw: how it is drawn.
        regions: what it may be, one for each part of the filters.
        evaluator: of what these must know.
        usual: median of −log of the chance of an interval.
    """

    name: str
    cell: Cell
    row: int
    draw: Draw
    regions: tuple[Region, ...]
    evaluator: Evaluator
    usual: float = 1.0

    def known(self, draws: dict[str, Floats], n: int) -> list[Floats]:
        """(n,) each, what the regions must know; NaN for errors."""
        return [column.as_floats() for column in self.evaluator.filters(draws, n)]

    def spans(self, known: Sequence[Floats]) -> Spans:
        """Return the values that are left to it."""
        return intersection([region(known) for region in self.regions])

    def rearranged(self, draws: dict[str, Floats], n: int) -> Rearranged:
        """Return the assumption's uniform number, reordered so that the intervals left to it come first."""
        return _rearranged(self.draw, self.spans(self.known(draws, n)))


def layers_of(model: CompiledModel, filters: Sequence[LimitState], drawing: Drawing, uniforms: Floats) -> list[Layer]:
    """Return the thin layers, in the order in which they can be solved: none asks about an assumption of a later one.

    Args:
        model: with filters.
        filters: what they ask.
        drawing: to draw with.
        uniforms: (n, d) of plain trials to look at, a block of them at most.
    """
    looking = _Looking(model, filters, drawing, uniforms)
    layers = list[Layer]()
    while len(layers) < _MOST_LAYERS:
        best = looking.best({layer.cell for layer in layers})
        if best is None:
            break
        layers.insert(0, best)
    return layers


class _Looking:
    """A search for assumptions that a thin layer can be solved for."""

    def __init__(self, model: CompiledModel, filters: Sequence[LimitState], drawing: Drawing, uniforms: Floats) -> None:
        self._model, self._block = model, drawing.block
        draws, self._n = drawing.draw_at(uniforms)
        self._draws = {name: values.copy() for name, values in draws.items()}
        self._parts = list(conjuncts(filters))
        grouped = {name for group in model.groups for name in group.names}
        graph = model.needed.graph
        asked = upstream(graph, {cell for each in self._parts for cell in _cells(each)}, self._led_to)
        varied = upstream(graph, [cell for each in model.live for cell in each.cells], self._led_to)
        self._formulas = [cell for cell in graph.formulas if cell in asked or cell in varied]
        candidates = [each for each in model.live if each.cell in asked and each.name not in grouped]
        most = min(_MOST_CANDIDATES, _MOST_LOOKS // max(1, len(self._formulas)))
        self._candidates = [each for each in candidates if self._is_smooth(each)][:most]
        self._row_of = drawing.row_of
        self._moved = {each.cell: self._downstream(each.cell) for each in self._candidates}

    @property
    def _led_to(self) -> dict[Cell, set[Cell]]:
        return self._model.lowering.led_to

    def best(self, taken: set[Cell]) -> Layer | None:
        """Return the layer whose intervals have the most even chances, of those that ask nothing about what
        is taken.
        """
        moved = set[Cell]().union(*(self._moved[cell] for cell in taken))
        free = [part for part in self._parts if not any(_meets(tree, moved) for tree in _trees(part))]
        result = [
            each
            for assumption in self._candidates
            if assumption.cell not in taken
            for each in self._layers(assumption, free)
        ]
        return max(result, key=lambda each: each[0], default=(0.0, None))[1]

    def _layers(self, assumption: Assumption, parts: Sequence[LimitState]) -> Iterator[tuple[float, Layer]]:
        """Yield the layers that some of the parts leave an assumption, and how even their chances are."""
        moved = self._moved[assumption.cell]
        formulas, gates = self._model.needed.graph.formulas, self._gates(assumption.cell)
        undoing = Inverting(assumption.cell, formulas, lambda tree: _meets(tree, moved), gates)
        varying = [part for part in parts if any(_meets(tree, moved) for tree in _trees(part))]
        regions = [region for part in varying if (region := undoing.region(part)) is not None]
        if not regions:
            return
        draw = self._model.draws[assumption.name]
        row = self._row_of[draw.name]
        evaluator = self._model.evaluator(undoing.targets, self._block)
        known = Layer(assumption.name, assumption.cell, row, draw, (), evaluator).known(self._draws, self._n)
        if any(np.nanmax(np.abs(known[turned]), initial=0.0) > TURNS for turned in undoing.turned):
            return
        spans = [region(known) for region in regions]
        for taken in _subsets(len(regions)):
            pair = self._judged(draw, intersection([spans[i] for i in taken]))
            if pair is not None:
                even, usual = pair
                chosen = tuple(regions[i] for i in taken)
                yield even, Layer(assumption.name, assumption.cell, row, draw, chosen, evaluator, usual)

    def _judged(self, draw: Draw, spans: Spans) -> tuple[float, float] | None:
        """How even the chances of a layer are, (Σc)²/(nΣc²), and what is usual; None if it is none, or not thin."""
        chance = _rearranged(draw, spans).total
        here = chance > 0.0
        if np.count_nonzero(here) < _SOME or float(np.sum(chance**2)) < _LEAST * float(np.sum(chance)):
            return None
        quartiles = np.array([0.25, 0.75])
        draw.fill(quartiles, {})
        with np.errstate(invalid="ignore"):
            longest = np.max(np.where(spans.low < np.inf, spans.high - spans.low, 0.0), axis=0)
        thin = longest <= _THIN * float(quartiles[1] - quartiles[0])
        if np.count_nonzero(thin & here) < _OFTEN * np.count_nonzero(here):
            return None
        even = float(np.sum(chance)) ** 2 / (chance.size * float(np.sum(chance**2)))
        return even, max(float(np.median(-np.log(chance[here]))), 1e-3)

    def _gates(self, cell: Cell) -> list[Cell]:
        """Cells, each of which is all that reads the one before, the first all that reads an assumption."""
        cells = [cell]
        asked = {cell for part in self._parts for cell in _cells(part)}
        formulas = self._model.needed.graph.formulas
        while cells[-1] not in asked:
            readers = [each for each in self._moved[cell] if each in formulas and cells[-1] in self._read(each)]
            if len(readers) != 1:
                break
            cells += readers
        return cells[1:]

    def _read(self, cell: Cell) -> set[Cell]:
        """Return what a formula cell reads of formula cells and inputs."""
        return {*self._model.needed.graph.needs.get(cell, ()), *self._led_to.get(cell, ())}

    def _is_smooth(self, assumption: Assumption) -> bool:
        """Whether uniforms and draws go with each other one by one, with parameters that do not vary."""
        draw = self._model.draws[assumption.name]
        if not draw.fixed:
            return False
        uniforms = np.linspace(0.0, 1.0, 1_001)[1:-1]
        values = uniforms.copy()
        draw.fill(values, {})
        with np.errstate(all="ignore"):
            return bool(np.all(np.diff(values) > 0.0) and np.all(np.abs(draw.reached(values) - uniforms) < _EXACT))

    def _downstream(self, cell: Cell) -> set[Cell]:
        """Return what varies with an assumption, it and other assumptions among them."""
        cells, size = {cell}, 0
        while len(cells) > size:
            size = len(cells)
            for each in self._formulas:
                if not cells.isdisjoint(self._read(each)):
                    cells.add(each)
            cells |= {a.cell for a in self._model.live if not cells.isdisjoint(a.cells)}
        return cells


def _rearranged(draw: Draw, spans: Spans) -> Rearranged:
    full = spans.low < spans.high
    with np.errstate(all="ignore"):
        low, high = (_reached(draw, np.where(full, ends, 0.0)) for ends in (spans.low, spans.high))
    return Rearranged.of(
        np.where(full, np.where(np.isnan(low), 0.0, low), np.inf),
        np.where(full, np.where(np.isnan(high), 1.0, high), -np.inf),
    )


def _reached(draw: Draw, ends: Floats) -> Floats:
    return draw.reached(np.clip(ends, -_MOST, _MOST).ravel()).reshape(ends.shape)


def _subsets(count: int) -> Iterator[tuple[int, ...]]:
    """All of several parts, then each alone, then each two."""
    yield tuple(range(count))
    if 1 < count <= _MOST_CONJUNCTS:
        yield from ((index,) for index in range(count))
    if 2 < count <= _MOST_CONJUNCTS:
        yield from combinations(range(count), 2)


def _trees(of: LimitState) -> list[ir.Expression]:
    return [leaf.holds.tree for leaf in leaves(of)]


def _cells(of: LimitState) -> Iterator[Cell]:
    for tree in _trees(of):
        for each in references(tree):
            yield from [each] if isinstance(each, Cell) else each.cells()


def _meets(tree: ir.Expression, cells: set[Cell]) -> bool:
    """Whether a tree reads one of the cells."""
    return any(each in cells if isinstance(each, Cell) else any(c in each for c in cells) for each in references(tree))
