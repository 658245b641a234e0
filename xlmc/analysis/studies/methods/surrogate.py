"""A surrogate with the exact filter: quadratic polynomials for smooth cells, and exact formulas from there on.

A filter on a ratio, such as a coefficient of restitution, is no polynomial; what it is the ratio of is nearly one. So
the surrogate replaces neither forecasts nor filters. From each of them the formulas are followed upwards to
the first cells that a quadratic polynomial of the assumptions, fitted by least squares to a pilot run, gives to 3 % of
their spread in trials that it was not fitted to. These cells become inputs; every formula below them is computed as it
stands, the filters too.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import Errors, MethodResult, answer_of
from xlmc.analysis.studies.methods.points import Evaluation
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import targets_of
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = ["Quadratic", "Surrogate", "fit_quadratic"]

_TOLERANCE: Final = 0.03
"""The largest error, as a share of a cell's standard deviation, of a polynomial that replaces it. An error of that size
that has nothing to do with the value widens its spread by one part in 2,000."""

_MOST_CELLS: Final = 2_000
_BLOCK: Final = 8_192
_TEST_SHARE: Final = 4
_APART: Final = 1 << 40
"""Between the seeds of the pilot and of the trials."""

Floats = NDArray[np.float64]

_MOST_WITH_PRODUCTS: Final = 60
"""Variables; with more, only their squares are taken, and no products of two."""

_AT_ONCE: Final = 1_024
"""Points whose terms stay in the cache."""

_RIDGE: Final = 1e-10
"""A share of a term's mean square, which decides between terms that say the same, as the square of a variable that has
two values.
"""


@dataclass(frozen=True, slots=True)
class Surrogate:
    """Pilot run, polynomials, and the budget of trials on them; only the pilot evaluates the workbook."""

    key: str = "surrogate"
    name: str = "Surrogate, exact filter"
    errors: Errors = "floor"
    cannot: str = "more trials do not remove the error of its polynomials"

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`.

        Raises:
            SimulationError: no cell is smooth enough, or too many cells vary.
        """
        started = time.perf_counter()
        pilot = _pilot_size(len(model.live))
        cells = tuple(cell for cell in model.needed.graph.formulas if cell in model.needed.graph.varying)
        if len(cells) > _MOST_CELLS:
            message = (
                f"{count_text(len(cells))} cells vary, and the surrogate looks at no more than "
                f"{count_text(_MOST_CELLS)}"
            )
            raise SimulationError(message, hint="use a method that draws")
        points = _draws(model, pilot, seed)
        values = Evaluation(model, cells)(points).cells
        inputs = _cut(model, dict(zip(cells, _errors(points, values).tolist(), strict=True)))
        replaced = [cell for cell in inputs if cell in cells]
        if not replaced:
            message = (
                "no cell on the way to the answers is a quadratic polynomial to "
                f"{number_text(100 * _TOLERANCE)} % of its spread"
            )
            raise SimulationError(message, hint="use a method that draws")
        polynomials = fit_quadratic(points, values[:, [cells.index(cell) for cell in replaced]])
        accepted, columns = _run(model, replaced, polynomials, budget, seed + _APART)
        answers = {f.name: answer_of(c, None, f.central) for f, c in zip(model.forecasts, columns.T, strict=True)}
        names = ", ".join(map(str, replaced))
        remark = f"fitted to {count_text(pilot)} trials; polynomials instead of {names}"
        return MethodResult(time.perf_counter() - started, pilot, answers, accepted / budget, remarks=(remark,))


def _pilot_size(k: int) -> int:
    """Four trials for each coefficient, and as many again to test with as are a third of these."""
    return max(1_024, 16 * Quadratic.coefficients(k) // 3)


def _draws(model: CompiledModel, trials: int, seed: int) -> Floats:
    """Independent draws, `(trials, k)`, without those that are no number because parameters were no distribution."""
    drawn = model.sampler(seed, trials).draw(0)
    points = np.column_stack([drawn[a.name] for a in model.live])
    return np.asarray(points[~np.isnan(points).any(axis=1)])


def _errors(points: Floats, values: Floats) -> Floats:
    """(cells,) the root mean square error of each cell's polynomial in trials that it was not fitted to, over its SD.

    Infinite where a cell is not a number in every trial.
    """
    tested = len(points) // _TEST_SHARE
    sound = np.isfinite(values).all(axis=0)
    result = np.full(values.shape[1], np.inf)
    good = values[:, sound]
    if not sound.any():
        return result
    missed = fit_quadratic(points[tested:], good[tested:])(points[:tested]) - good[:tested]
    spread = good.std(axis=0)
    result[sound] = np.sqrt(np.mean(missed**2, axis=0)) / np.where(spread > 0.0, spread, 1.0)
    return result


def _cut(model: CompiledModel, errors: dict[Cell, float]) -> list[Cell]:
    """Return the cells at which following the formulas upwards ends: smooth ones, and the assumptions themselves."""
    needs, result = model.needed.graph.needs, dict[Cell, None]()
    seen: set[Cell] = set()
    open_ = targets_of(model.forecasts, model.filters)[::-1]
    ends = {a.cell for a in model.live} | {cell for cell, error in errors.items() if error <= _TOLERANCE}
    while open_:
        cell = open_.pop()
        if cell in ends:
            result[cell] = None
        elif cell not in seen:
            seen.add(cell)
            open_ += needs.get(cell, ())
    return [*result]


def _run(
    model: CompiledModel, replaced: list[Cell], polynomials: Quadratic, trials: int, seed: int
) -> tuple[int, Floats]:
    """How many trials are accepted, and their forecasts, `(m, f)`."""
    inputs = {cell: f"surrogate of {cell}" for cell in replaced}
    stand_ins = tuple(
        Assumption(name, cell, "Uniform", {"low": 0.0, "high": 1.0}, row=cell) for cell, name in inputs.items()
    )
    definitions = replace(model.definitions, assumptions=(*model.assumptions, *stand_ins), correlations=())
    rest = CompiledModel(model.workbook, definitions, model.path)
    evaluate, made = Evaluation(rest), model.sampler(seed, _BLOCK)
    count, columns = 0, []
    for start in range(0, trials, _BLOCK):
        drawn = made.draw(start)
        n = min(_BLOCK, trials - start)
        points = np.column_stack([drawn[a.name][:n] for a in model.live])
        given = {a.name: column for a, column in zip(model.live, points.T, strict=True)}
        given |= {inputs[cell]: c for cell, c in zip(replaced, polynomials(points).T, strict=True)}
        outcomes = evaluate(np.column_stack([given[a.name] for a in rest.live]))
        accepted = outcomes.accepted & ~np.isnan(points).any(axis=1)
        count += int(np.count_nonzero(accepted))
        columns.append(outcomes.forecasts[accepted])
    return count, np.concatenate(columns)


@dataclass(frozen=True, slots=True, eq=False)
class Quadratic:
    """Polynomials in z = (x − centre) / scale: weights · (1, z, products of two).

    Attributes:
        centre, scale: `(k,)`.
        weights: `(q, coefficients)`.
    """

    centre: Floats
    scale: Floats
    weights: Floats

    @staticmethod
    def coefficients(k: int) -> int:
        """How many each polynomial of `k` variables has."""
        return 1 + 2 * k + (k * (k - 1) // 2 if k <= _MOST_WITH_PRODUCTS else 0)

    def __call__(self, points: Floats) -> Floats:
        """Return the values at `(n, k)` points, `(n, q)`."""
        parts = [points[start : start + _AT_ONCE] for start in range(0, len(points), _AT_ONCE)]
        # Not a matrix product: these are small, and its threads would wait for each other.
        result = [np.einsum("qt,tn->qn", self.weights, _terms((part - self.centre) / self.scale)) for part in parts]
        return np.concatenate(result, axis=1).T


def fit_quadratic(points: Floats, values: Floats) -> Quadratic:
    """Fit the polynomials of least squares through `(n, k)` points and their values `(n, q)`."""
    centre, spread = points.mean(axis=0), points.std(axis=0)
    scale = np.where(spread > 0.0, spread, 1.0)
    terms = _terms((points - centre) / scale)
    normal = terms @ terms.T
    normal[np.diag_indices(len(normal))] += _RIDGE * len(points)
    return Quadratic(centre, scale, np.asarray(np.linalg.solve(normal, terms @ values).T, np.float64))


def _terms(z: Floats) -> Floats:
    """(coefficients, n): 1, the variables, their squares and, of few variables, their products."""
    n, k = z.shape
    columns = np.ascontiguousarray(z.T)
    values = np.empty((Quadratic.coefficients(k), n))
    values[0], values[1 : 1 + k] = 1.0, columns
    np.multiply(columns, columns, out=values[1 + k : 1 + 2 * k])
    start = 1 + 2 * k
    for i in range(k - 1 if k <= _MOST_WITH_PRODUCTS else 0):
        np.multiply(columns[i], columns[i + 1 :], out=values[start : start + k - 1 - i])
        start += k - 1 - i
    return values
