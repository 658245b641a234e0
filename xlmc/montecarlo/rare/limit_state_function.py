"""Evaluate the limit state of a model at points of standard normal space: how far a point is from acceptance.

Each drawn assumption has a normal, whatever its distribution: its uniform is what the normal distribution leaves below.
Correlations, cutoffs, whole numbers and parameters that vary follow from the uniforms, as in any run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column
from xlmc.montecarlo.model.needed import filter_condition
from xlmc.montecarlo.rare.limit_state import Leaf, LimitState, leaves, lengths, limit_state, measure
from xlmc.montecarlo.rare.splitting import Distance
from xlmc.montecarlo.rare.strata import strata_of

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.sampling.streams import Stream

__all__ = ["OUTSIDE", "Drawing", "GivenUniforms", "LimitStateFunction", "points_of", "uniforms_of"]

Floats = NDArray[np.float64]

SCALING_TRIALS: Final = 16_384
"""Draws whose distances, the median of each, all distances are measured by."""

OUTSIDE: Final = 1e3
"""A number above the logarithm of any distance."""

_LARGEST: Final = 1.0 - 2.0**-53
_LEAST: Final = 2.0**-54


def uniforms_of(points: Floats) -> Floats:
    """Return the uniforms, in [0, 1), of standard normals."""
    from scipy.special import ndtr

    return np.asarray(np.minimum(ndtr(points), _LARGEST))


def points_of(uniforms: Floats) -> Floats:
    """Return the standard normals of uniforms."""
    from scipy.special import ndtri

    return np.asarray(ndtri(np.maximum(uniforms, _LEAST)))


class GivenUniforms:
    """Uniforms that are given, instead of a seed's streams.

    Attributes:
        uniforms: (n, d) to draw from next; trial `start` of a block takes row `start`.
    """

    def __init__(self) -> None:
        self.uniforms = np.empty((0, 0))

    def filler(
        self, _streams: Sequence[Stream], maps: Sequence[tuple[float, float]], rows: Floats
    ) -> Callable[[int], None]:
        """See `sampling.draws.Filler`."""

        def fill(start: int) -> None:
            given = self.uniforms[start : start + rows.shape[1]]
            for row, column, (offset, factor) in zip(rows, given.T, maps, strict=True):
                row[: len(given)] = offset + factor * column
                row[len(given) :] = offset + factor * 0.5  # a block is drawn whole, and cut

        return fill


class Drawing:
    """Draws of the assumptions at given uniforms; for one thread.

    Attributes:
        block: trials at a time, at most.
        row_of: name of an assumption -> its row among the uniforms.
    """

    def __init__(self, model: CompiledModel) -> None:
        self.block = model.program("numpy").largest_block
        self._given = GivenUniforms()
        self._sampler = model.sampler(0, self.block, filler=self._given.filler)
        self.row_of = self._sampler.row_of

    def draw_at(self, uniforms: Floats) -> tuple[dict[str, Floats], int]:
        """Draw at (n, d) uniforms, up to a block of them; returns the draws and how many they are."""
        self._given.uniforms = uniforms
        n = len(uniforms)
        return {name: values[:n] for name, values in self._sampler.draw(0).items()}, n


class LimitStateFunction:
    """For one thread. What is asked of points is asked of their uniforms by the methods that end in `_at`.

    Args:
        model: with at least one filter and one drawn assumption.
        random: for the draws that the distances are scaled by.

    Attributes:
        dimensions: of its points.
        evaluations: trials evaluated so far.
        lost: of them, those in which a filter is an error.
    """

    def __init__(self, model: CompiledModel, random: np.random.Generator) -> None:
        formulas = model.needed.graph.formulas
        self.dimensions = len(model.draws)
        self._filters = [limit_state(filter_condition(f), f.cell, formulas) for f in model.filters]
        self._strata = strata_of(model, self._filters)
        gates = [gate for stratum in self._strata for gate in stratum]
        self._leaves = list(dict.fromkeys(leaf for each in (*self._filters, *gates) for leaf in leaves(each)))
        targets = [*model.filter_targets, *(leaf.holds for leaf in self._leaves)]
        gauged = [leaf for leaf in self._leaves if leaf.gap is not None]
        self._gaps = {leaf: len(targets) + i for i, leaf in enumerate(gauged)}
        targets += [leaf.gap for leaf in self._gaps if leaf.gap is not None]
        self._drawing = Drawing(model)
        self._block = self._drawing.block
        self._evaluator = model.evaluator(targets, self._block)
        self._deciding = model.program("numpy").evaluator(self._block)
        self.evaluations = self.lost = 0
        self._scales = self._usual(uniforms_of(random.standard_normal((SCALING_TRIALS, self.dimensions))))

    @property
    def asked(self) -> Sequence[LimitState]:
        """What the filters ask."""
        return self._filters

    def uniforms(self, points: Floats) -> Floats:
        """(n, d) of points: see `uniforms_of`."""
        return uniforms_of(points)

    def points(self, uniforms: Floats) -> Floats:
        """(n, d) of uniforms: see `points_of`."""
        return points_of(uniforms)

    def distance(self, points: Floats) -> Floats:
        """(n,) of (n, d) points: 0 where they are accepted, infinite where a filter cannot decide."""
        return self.distance_at(uniforms_of(points))

    def distance_at(self, uniforms: Floats) -> Floats:
        """Do the same for (n, d) uniforms."""
        parts = [np.maximum.reduce(list(each)) for each in self._of_filters(uniforms)]
        return np.concatenate([*parts, np.empty(0)])

    def accepts(self, points: Floats) -> NDArray[np.bool_]:
        """(n,) whether they are accepted."""
        return self.accepts_at(uniforms_of(points))

    def accepts_at(self, uniforms: Floats) -> NDArray[np.bool_]:
        """Do the same for (n, d) uniforms."""
        parts = [np.empty(0, bool)]
        for start in range(0, len(uniforms), self._block):
            draws, n = self._drawing.draw_at(uniforms[start : start + self._block])
            columns = self._deciding.filters(draws, n)
            self._count(columns, n)
            accepted = np.ones(n, bool)
            for column in columns:
                accepted &= column.values != 0
                if column.codes is not None:
                    accepted &= column.codes == 0
            parts.append(accepted)
        return np.concatenate(parts)

    def by_filter(self, points: Floats) -> list[Floats]:
        """For each filter, (n,) how far points are from what it asks."""
        return self.by_filter_at(uniforms_of(points))

    def by_filter_at(self, uniforms: Floats) -> list[Floats]:
        """Do the same for (n, d) uniforms."""
        return [np.concatenate(parts) for parts in zip(*self._of_filters(uniforms), strict=True)]

    def _of_filters(self, uniforms: Floats) -> Iterator[list[Floats]]:
        for columns in self._columns(uniforms):
            yield self._asked(columns, self._scaled(columns))

    def _scaled(self, columns: Sequence[Column]) -> dict[Leaf, Floats]:
        return {leaf: values / self._scales[leaf] for leaf, values in self._lengths(columns).items()}

    def _asked(self, columns: Sequence[Column], scaled: Mapping[Leaf, Floats]) -> list[Floats]:
        """For each filter, (n,) how far a block's trials are from what it asks."""
        return [_exact(measure(each, scaled), column) for each, column in zip(self._filters, columns, strict=False)]

    @property
    def strata(self) -> list[Distance]:
        """Return the distance of each stratum, 0 where a trial of it is accepted; each trial is in one stratum."""
        return [partial(_of_points, each) for each in self.strata_at]

    @property
    def strata_at(self) -> list[Distance]:
        """The same of (n, d) uniforms."""
        if len(self._strata) < 2:
            return [self.distance_at]
        return [partial(self._in_stratum, stratum) for stratum in self._strata]

    def _in_stratum(self, stratum: Sequence[LimitState], uniforms: Floats) -> Floats:
        """Return (n,) the distance in a stratum; outside of it, that from the stratum, which is above any within."""
        parts = [np.empty(0)]
        for columns in self._columns(uniforms):
            scaled = self._scaled(columns)
            within = np.log1p(np.maximum.reduce(self._asked(columns, scaled)))
            outside = np.maximum.reduce([measure(gate, scaled) for gate in stratum])
            parts.append(np.where(outside > 0.0, OUTSIDE + np.log1p(outside), within))
        return np.concatenate(parts)

    def _columns(self, uniforms: Floats) -> Iterator[list[Column]]:
        """Block by block, every target."""
        for start in range(0, len(uniforms), self._block):
            draws, n = self._drawing.draw_at(uniforms[start : start + self._block])
            columns = self._evaluator.filters(draws, n)
            self._count(columns[: len(self._filters)], n)
            yield columns

    def _count(self, filters: Sequence[Column], n: int) -> None:
        lost = np.zeros(n, bool)
        for column in filters:
            if column.codes is not None:
                lost |= column.codes > 0
        self.evaluations += lost.size
        self.lost += int(np.count_nonzero(lost))

    def _lengths(self, columns: Sequence[Column]) -> dict[Leaf, Floats]:
        first = len(self._filters)
        return {
            leaf: lengths(columns[first + i], columns[self._gaps[leaf]] if leaf in self._gaps else None)
            for i, leaf in enumerate(self._leaves)
        }

    def _usual(self, uniforms: Floats) -> dict[Leaf, float]:
        """Return the median length of every comparison where it fails."""
        parts = [list(self._lengths(columns).values()) for columns in self._columns(uniforms)]
        result = [_median(np.concatenate(each)) for each in zip(*parts, strict=True)]
        return dict(zip(self._leaves, result, strict=True))


def _of_points(distance: Distance, points: Floats) -> Floats:
    return distance(uniforms_of(points))


def _median(values: Floats) -> float:
    failing = values[(values > 0.0) & np.isfinite(values)]
    return float(np.median(failing)) if failing.size else 1.0


def _exact(values: Floats, column: Column) -> Floats:
    """Give what the filter itself says the last word."""
    holds = column.values != 0
    values = np.where(holds, 0.0, np.maximum(values, np.finfo(np.float64).tiny))
    if column.codes is not None:
        values[column.codes > 0] = np.inf
    return values
