"""Solve thin layers in the limit-state function: the accepted values of some assumptions come first in their uniforms.

Where filters leave a thin bent layer, one assumption of each is rearranged (see `spans`), so that the layer is the
tail of its normal. Every point still stands for a trial, as likely as before, and is accepted where the filters accept
that trial. The distance of a point whose position is beyond the accepted values is how far it is from them in the
order, as a logarithm; what the other filters ask is measured as if it were within.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.rare.layers import Layer, layers_of
from xlmc.montecarlo.rare.limit_state_function import OUTSIDE, Drawing, LimitStateFunction, points_of, uniforms_of
from xlmc.montecarlo.rare.splitting import Distance

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Layered", "SearchSpace", "search_space_of"]

Floats = NDArray[np.float64]

_LOOKED_AT: Final = 8_192
"""Draws that layers are looked for with."""

_LEAST: Final = 1e-300


class Layered:
    """For one thread; what `LimitStateFunction` gives of points, of points in these coordinates.

    Args:
        function: of the same model.
        drawing: of the same model.
        layers: one or more, in the order in which they can be solved.

    Attributes:
        layers: the same.
    """

    def __init__(self, function: LimitStateFunction, drawing: Drawing, layers: Sequence[Layer]) -> None:
        self._function, self._drawing, self.layers = function, drawing, layers
        self.dimensions = function.dimensions

    @property
    def evaluations(self) -> int:
        """Trials evaluated so far."""
        return self._function.evaluations

    @property
    def lost(self) -> int:
        """The number of evaluations in which a filter or a draw is an error."""
        return self._function.lost

    @property
    def strata(self) -> list[Distance]:
        """See `LimitStateFunction.strata`."""
        return [partial(self._distance, each) for each in self._function.strata_at]

    def distance(self, points: Floats) -> Floats:
        """(n,) 0 where points are accepted, infinite where a filter cannot decide."""
        return self._distance(self._function.distance_at, points)

    def accepts(self, points: Floats) -> NDArray[np.bool_]:
        """(n,) whether they are accepted."""
        return self._function.accepts_at(self.uniforms(points))

    def by_filter(self, points: Floats) -> list[Floats]:
        """For each filter, (n,) how far points are from what it asks."""
        return self._function.by_filter_at(self.uniforms(points))

    def uniforms(self, points: Floats) -> Floats:
        """(n, d) the uniforms of the trials that points stand for."""
        values = uniforms_of(points)
        for part in self._blocks(values):
            for layer in self.layers:
                draws, n = self._drawing.draw_at(part)
                part[:, layer.row] = layer.rearranged(draws, n).uniform_at(part[:, layer.row])
        return values

    def points(self, uniforms: Floats) -> Floats:
        """(n, d) the points that stand for trials with these uniforms."""
        values = points_of(uniforms)
        for start, part in zip(range(0, len(values), self._drawing.block), self._blocks(uniforms), strict=True):
            for layer in self.layers:
                draws, n = self._drawing.draw_at(part)
                positions = layer.rearranged(draws, n).position_of(part[:, layer.row])
                values[start : start + n, layer.row] = _normal(positions)
        return values

    def _blocks(self, rows: Floats) -> list[Floats]:
        return [rows[start : start + self._drawing.block] for start in range(0, len(rows), self._drawing.block)]

    def _distance(self, inner: Distance, points: Floats) -> Floats:
        """Return the distance of points, (n,); `inner` is that of uniforms, for those within the layers."""
        uniforms = uniforms_of(points)
        parts = [self._within(part) for part in self._blocks(uniforms)]
        beyond = np.concatenate([np.empty(0), *(part for part, _ in parts)])
        outside = np.concatenate([np.empty(0, bool), *(part for _, part in parts)])
        values = inner(uniforms)
        if inner == self._function.distance_at:
            values = np.log1p(values)
        nearest = np.maximum(values, np.log1p(beyond))
        return np.where(outside | (values >= OUTSIDE), values + OUTSIDE, nearest)

    def _within(self, uniforms: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        """How far the positions of a block are beyond the layers, (n,), and where there is nothing to be accepted.

        The uniforms, (n, d), become those of a trial within them.
        """
        beyond, outside = np.zeros(len(uniforms)), np.zeros(len(uniforms), bool)
        for layer in self.layers:
            draws, n = self._drawing.draw_at(uniforms)
            order, positions = layer.rearranged(draws, n), uniforms[:, layer.row].copy()
            some = order.total > 0.0
            farther = np.log(np.maximum(positions, _LEAST)) - np.log(np.where(some, order.total, 1.0))
            beyond = np.maximum(beyond, np.where(some & (positions >= order.total), farther, 0.0) / layer.usual)
            outside |= ~some
            uniforms[:, layer.row] = order.uniform_at(order.fold(positions))
        return beyond, outside


SearchSpace = LimitStateFunction | Layered
"""What a search evaluates at its points."""


def search_space_of(model: CompiledModel, function: LimitStateFunction, random: np.random.Generator) -> SearchSpace:
    """Return the limit-state function with its thin layers solved, or itself without layers that can be solved.

    Args:
        model: that the function is of.
        function: of it.
        random: for draws to look at, and nothing else.
    """
    drawing = Drawing(model)
    looked_at = min(_LOOKED_AT, drawing.block)
    uniforms = uniforms_of(random.standard_normal((looked_at, function.dimensions)))
    layers = layers_of(model, function.asked, drawing, uniforms)
    return Layered(function, drawing, layers) if layers else function


def _normal(positions: Floats) -> Floats:
    from scipy.special import ndtri

    return np.asarray(ndtri(np.maximum(positions, _LEAST)))
