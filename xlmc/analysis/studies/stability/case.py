"""The evidence: trials of a run, their values, what rounding does to these, and some of them with 50 digits.

Letters: n trials, the base case and the ends of the ranges first; k assumptions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.derivatives import Movements, derivatives
from xlmc.analysis.studies.stability.digit_findings import Where
from xlmc.analysis.studies.stability.extent import Extent
from xlmc.analysis.studies.stability.formula_trees import Trees
from xlmc.engine.graph.nodes import Apply, Input, uses
from xlmc.engine.passes.derivatives import Derivatives
from xlmc.engine.passes.exact import Exact, as_double
from xlmc.engine.passes.random_rounding import (
    DOUBLE,
    RandomRounding,
    closure,
    evaluate,
    formula_of,
    numbers_of,
    term_sizes,
)
from xlmc.excel.address import Cell
from xlmc.excel.formula.graph import reached
from xlmc.excel.functions.values import Value
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["RELATIONS", "Case"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_REPLICAS: Final = 6
"""Evaluations with random rounding: their root mean square is known to a third of itself."""

RELATIONS: Final = frozenset({"<", "<=", ">", ">=", "=", "<>"})


class Case:
    """What is known of a model from a run of it.

    Args:
        extent: what is looked at of a model.
        run: accepted trials and draws of it.
        seed: of the random rounding.
    """

    def __init__(self, extent: Extent, run: RunResult, seed: int = 0) -> None:
        model = extent.model
        self.model, self.run, self._seed = model, run, seed
        self.trees = Trees(model)
        self.lowering, self.dag = model.lowering, extent.graph
        self.cells, self.node, self.conditions = extent.cells, extent.node, extent.conditions
        self.nodes, self._prior, self._accepted = extent.nodes, extent.prior, extent.accepted
        self.names = [a.name for a in model.live]
        self._exact = Exact(self.dag, self.nodes)
        self._known: dict[int, dict[int, float]] = {}
        self._inherent: dict[Cell, Floats] = {}
        self.movements = Movements({cell: self.node[cell] for cell in self.cells})

    @cached_property
    def draws(self) -> dict[str, Floats]:
        """Assumption -> `(n,)`."""
        if not self.names:
            return {}
        special = self._special()
        prior = np.column_stack([self.run.prior[a.name][: self._prior] for a in self.model.live])
        accepted = np.column_stack([self.run.inputs[a.name][: self._accepted] for a in self.model.live])
        rows = np.concatenate([special, prior, accepted])
        rows = rows[np.isfinite(rows).all(axis=1)]
        return {name: np.ascontiguousarray(column) for name, column in zip(self.names, rows.T, strict=True)}

    def _special(self) -> Floats:
        """Return the base case, and each assumption at either end of its range with the others at their base."""
        prior = [self.run.prior[a.name] for a in self.model.live]
        base = np.array([_base(a.base, draws) for a, draws in zip(self.model.live, prior, strict=True)])
        rows = [base]
        for index, assumption in enumerate(self.model.live):
            ends = [assumption.parameters.get(key) for key in ("low", "high", "minimum", "maximum")]
            numbers_ = [float(end) for end in ends if isinstance(end, int | float)]
            for end in {*numbers_, float(np.nanmin(prior[index])), float(np.nanmax(prior[index]))}:
                row = base.copy()
                row[index] = end
                rows.append(row)
        return np.array(rows)

    @cached_property
    def special(self) -> int:
        """How many of the trials are the base case and ends of ranges."""
        return len(self._special()) if self.names else 0

    @cached_property
    def first_accepted(self) -> int:
        """The index of the first accepted trial; the trials before it are of all that were drawn."""
        stored = min(self.run.kept_inputs, self.run.accepted, self._accepted)
        return self.n - stored if self.names else self.n

    @property
    def n(self) -> int:
        return next((draws.size for draws in self.draws.values()), 1)

    @cached_property
    def values(self) -> dict[int, Value]:
        """Node -> its values."""
        return evaluate(self.dag, self.nodes, self.draws)

    @cached_property
    def errors(self) -> dict[int, Floats]:
        """Node of a cell -> the size of its error by rounding, `(n,)`, in the root mean square of the replicas."""
        return self._spread(lambda replica: {"rounding": RandomRounding((self._seed, replica))})

    def _spread(self, how: Callable[[int], dict[str, RandomRounding]]) -> dict[int, Floats]:
        """Return the root mean square of what differs in evaluations that move something."""
        squares: dict[int, Floats] = {}
        for replica in range(_REPLICAS):
            wanted = {*self.node.values()}
            result = evaluate(self.dag, self.nodes, self.draws, keep=wanted, **how(replica))
            for node in wanted:
                off = numbers_of(result[node], self.n) - self.number(node)
                with np.errstate(over="ignore"):
                    squares[node] = squares.get(node, 0.0) + np.where(np.isnan(off), 0.0, off) ** 2
        return {node: np.sqrt(square / _REPLICAS) for node, square in squares.items()}

    def number(self, node: int) -> Floats:
        """Return a node's numbers, `(n,)`; NaN where it has none."""
        return numbers_of(self.values[node], self.n)

    @cached_property
    def users(self) -> dict[int, list[int]]:
        """Node -> the nodes that use it."""
        result: dict[int, list[int]] = {}
        for node in self.nodes:
            for part in uses(formula_of(self.dag, node)):
                result.setdefault(part, []).append(node)
        return result

    @cached_property
    def comparisons(self) -> list[int]:
        """The nodes that compare."""
        formulas = ((node, formula_of(self.dag, node)) for node in self.nodes)
        return [node for node, formula in formulas if isinstance(formula, Apply) and formula.function.name in RELATIONS]

    def after(self, *nodes: int) -> list[int]:
        """Return the nodes that follow from some, each after those that it needs."""
        result: set[int] = set()
        open_ = list(nodes)
        while open_:
            new = [user for user in self.users.get(open_.pop(), ()) if user not in result]
            result.update(new)
            open_ += new
        return sorted(result, key=self._order.__getitem__)

    @cached_property
    def _order(self) -> dict[int, int]:
        return {node: at for at, node in enumerate(self.nodes)}

    @cached_property
    def derivatives(self) -> Derivatives:
        """The derivatives of forecasts and filters; `movements` are gathered with them."""
        return derivatives(self.model, self.draws, movements=self.movements)

    def moved(self, cell: Cell) -> tuple[Floats, Floats]:
        """Return by how much a needed cell moves with all assumptions, `(n,)`, and with each in all trials, `(k,)`."""
        assert self.derivatives
        return self.movements.of_trials[self.node[cell]], self.movements.of_assumptions[self.node[cell]]

    @cached_property
    def of_inputs(self) -> dict[int, Floats]:
        """Node of a cell -> by how much it moves with the last digit of assumptions and typed numbers, `(n,)`."""
        result = self._spread(lambda replica: {"of_inputs": RandomRounding((self._seed, _REPLICAS, replica), _MOVE)})
        return {node: spread * (2 * DOUBLE / _MOVE) for node, spread in result.items()}

    @cached_property
    def term_sizes(self) -> dict[int, float]:
        """Node -> the largest number added or subtracted on the way to it."""
        return term_sizes(self.dag, self.nodes, self.values)

    def inherent(self, cell: Cell) -> Floats:
        """Return the error that rounding the assumptions, and the result, would bring alone, `(n,)`; NaN
        where unknown.
        """
        if cell not in self._inherent:
            moved, node = self.moved(cell)[0], self.node[cell]
            self._inherent[cell] = np.fmax(DOUBLE * (moved + np.abs(self.number(node))), self.of_inputs[node])
        return self._inherent[cell]

    def scale(self, cell: Cell) -> float:
        """Return the width of a cell's central range, or its size where it hardly varies; 1 for 0."""
        values = self.number(self.node[cell])[self.special :]
        values = values[np.isfinite(values)]
        if not values.size:
            return 1.0
        low, middle, high = np.quantile(values, [0.245, 0.5, 0.755])
        size = float(high - low)
        if size <= 1e-9 * abs(middle):
            size = abs(float(middle))
        return size or 1.0

    def exact_number(self, node: int, trial: int) -> float:
        """Return a node's value in a trial with 50 digits, as a double; NaN where it is no number."""
        if trial not in self._known:
            result = self._exact.trial({key: float(draws[trial]) for key, draws in self.draws.items()})
            self._known[trial] = {one: as_double(value) for one, value in result.items()}
        return self._known[trial][node]

    @property
    def recomputed(self) -> int:
        return len(self._known)

    @property
    def unchecked(self) -> set[int]:
        """The nodes of functions that were not computed with 50 digits."""
        return self._exact.unchecked | self.dag.closed

    def where(self, trials: Bools, node: int, most: int = 2) -> tuple[Where, ...]:
        """Return the assumptions whose ranges tell the trials from others: those that they take up least of.

        An assumption is named only where the node depends on it, and where so many trials, drawn by chance, would
        hardly ever lie so close together in its range.

        Args:
            trials: which.
            node: the one that it happens to.
            most: assumptions to name.
        """
        among = trials[self.special :]
        count, drawn = int(among.sum()), self.n - self.special
        if count < _FEWEST or count == drawn:
            return ()
        needed = self.inputs_of(node)
        shares = []
        for number, assumption in enumerate(self.model.live):
            draws = self.draws[assumption.name][self.special :]
            here = draws[among]
            share = float(np.mean((draws >= here.min()) & (draws <= here.max())))
            width = float(draws.max() - draws.min())
            if assumption.name in needed and width > 0 and _by_chance(share, count) * len(needed) < _RARELY:
                drawn_here = self.draws[assumption.name][trials]
                shares.append((float(here.max() - here.min()) / width, number, assumption, drawn_here))
        shares.sort(key=lambda each: each[:2])
        named = [each for each in shares if each[0] < _TELLING][:most]
        return tuple(
            Where(assumption.name, float(here.min()), float(here.max()), assumption.units or "")
            for _, _, assumption, here in named
        )

    def inputs_of(self, node: int) -> set[str]:
        """Return the names of the assumptions that a node depends on."""
        formulas = (formula_of(self.dag, part) for part in closure(self.dag, [node]))
        return {formula.name for formula in formulas if isinstance(formula, Input)}

    def upstream(self, cell: Cell) -> set[Cell]:
        """Return the cells that a cell needs, itself among them."""
        needs = self.lowering.graph.needs
        return {*reached([cell], lambda one: needs.get(one, ()))}

    def forecasts_of(self, cells: Iterable[Cell]) -> list[str]:
        """Return the forecasts and filters that a cell reaches."""
        wanted = set(cells)
        result = []
        rows = [(row.cell, row.name) for row in self.model.forecasts]
        rows += [(row.cell, row.name) for row in self.model.filters]
        for cell, name in rows:
            if wanted & self.upstream(cell) and name not in result:
                result.append(name)
        return result


_MOVE: Final = 2.0**-30
"""The share by which inputs are moved: far more than the roundings on the way."""

_FEWEST: Final = 5
"""Trials that take up little of some range for no reason."""

_TELLING: Final = 0.5
"""A share of an assumption's range: if trials cover more than that, the finding has nothing to do with it."""


_RARELY: Final = 1e-3


def _by_chance(share: float, count: int) -> float:
    """Return the probability that so many trials lie within a share of the range by chance (David and Nagaraja 2003,
    §2.3).
    """
    return count * share ** (count - 1) - (count - 1) * share**count


def _base(base: object, draws: Floats) -> float:
    known = isinstance(base, int | float) and not isinstance(base, bool)
    return float(base) if known else float(np.nanmedian(draws))  # type: ignore[arg-type]  # a number, then
