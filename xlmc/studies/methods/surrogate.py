"""A surrogate with the exact filter: quadratic polynomials in place of smooth cells, and exact formulas from there on.

A filter on a ratio, such as a coefficient of restitution, is no polynomial; what it is the ratio of is nearly one. So
the surrogate takes the place of neither forecasts nor filters. From each of them the formulas are followed upwards to
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

from xlmc.address import Cell
from xlmc.definitions.model import Assumption, name_key
from xlmc.errors import SimulationError
from xlmc.run.model import Model
from xlmc.run.scene import targets_of
from xlmc.studies.methods.answer import Errors, MethodResult, answer_of
from xlmc.studies.methods.evaluation import Evaluation
from xlmc.studies.methods.quadratic import Quadratic, fitted

__all__ = ["TOLERANCE", "Surrogate"]

TOLERANCE: Final = 0.03
"""Of a cell's standard deviation: the largest error of a polynomial that takes its place. An error of that size that
has nothing to do with the value widens its spread by one part in 2,000."""

_MOST_CELLS: Final = 2_000
_BLOCK: Final = 8_192
_TEST_SHARE: Final = 4
_APART: Final = 1 << 40
"""Between the seeds of the pilot and of the trials."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Surrogate:
    """Pilot run, polynomials, and the budget of trials on them; only the pilot evaluates the workbook."""

    key: str = "surrogate"
    name: str = "Surrogate, exact filter"
    errors: Errors = "floor"
    cannot: str = "more trials do not remove the error of its polynomials"

    def run(self, model: Model, budget: int, seed: int) -> MethodResult:
        """See `Method`.

        Raises:
            SimulationError: no cell is smooth enough, or too many cells vary.
        """
        started = time.perf_counter()
        pilot = _pilot_size(len(model.live))
        cells = tuple(cell for cell in model.scene.graph.formulas if cell in model.scene.graph.varying)
        if len(cells) > _MOST_CELLS:
            message = f"{len(cells):,} cells vary, and the surrogate looks at no more than {_MOST_CELLS:,}"
            raise SimulationError(message, hint="use a method that draws")
        points = _draws(model, pilot, seed)
        values = Evaluation(model, cells)(points).cells
        inputs = _cut(model, dict(zip(cells, _errors(points, values).tolist(), strict=True)))
        replaced = [cell for cell in inputs if cell in cells]
        if not replaced:
            message = (
                f"no cell on the way to the answers is a quadratic polynomial to {100 * TOLERANCE:g} % of its spread"
            )
            raise SimulationError(message, hint="use a method that draws")
        polynomials = fitted(points, values[:, [cells.index(cell) for cell in replaced]])
        accepted, columns = _run(model, replaced, polynomials, budget, seed + _APART)
        answers = {f.name: answer_of(c, None, f.central) for f, c in zip(model.forecasts, columns.T, strict=True)}
        places = ", ".join(map(str, replaced))
        said = f"fitted to {pilot:,} trials; polynomials in place of {places}"
        return MethodResult(time.perf_counter() - started, pilot, answers, accepted / budget, remarks=(said,))


def _pilot_size(k: int) -> int:
    """Four trials for each coefficient, and as many again to test with as are a third of these."""
    return max(1_024, 16 * Quadratic.coefficients(k) // 3)


def _draws(model: Model, trials: int, seed: int) -> Floats:
    """Independent draws, `(trials, k)`, without those that are no number because parameters were no distribution."""
    drawn = model.sampler(seed, trials).draw(0)
    points = np.column_stack([drawn[name_key(a.name)] for a in model.live])
    return np.asarray(points[~np.isnan(points).any(axis=1)])


def _errors(points: Floats, values: Floats) -> Floats:
    """(cells,) the root mean square error of each cell's polynomial in trials that it was not fitted to, over its SD.

    Infinite where a cell is not a number in every trial.
    """
    tested = len(points) // _TEST_SHARE
    sound = np.isfinite(values).all(axis=0)
    found = np.full(values.shape[1], np.inf)
    good = values[:, sound]
    if not sound.any():
        return found
    missed = fitted(points[tested:], good[tested:])(points[:tested]) - good[:tested]
    spread = good.std(axis=0)
    found[sound] = np.sqrt(np.mean(missed**2, axis=0)) / np.where(spread > 0.0, spread, 1.0)
    return found


def _cut(model: Model, errors: dict[Cell, float]) -> list[Cell]:
    """The cells at which following the formulas upwards ends: smooth ones, and the assumptions themselves."""
    needs, found = model.scene.graph.needs, dict[Cell, None]()
    seen: set[Cell] = set()
    open_ = targets_of(model.forecasts, model.filters)[::-1]
    ends = {a.cell for a in model.live} | {cell for cell, error in errors.items() if error <= TOLERANCE}
    while open_:
        cell = open_.pop()
        if cell in ends:
            found[cell] = None
        elif cell not in seen:
            seen.add(cell)
            open_ += needs.get(cell, ())
    return [*found]


def _run(model: Model, replaced: list[Cell], polynomials: Quadratic, trials: int, seed: int) -> tuple[int, Floats]:
    """How many trials are accepted, and their forecasts, `(m, f)`."""
    inputs = {cell: f"surrogate of {cell}" for cell in replaced}
    stand_ins = tuple(
        Assumption(name, cell, "Uniform", {"low": 0.0, "high": 1.0}, row=cell) for cell, name in inputs.items()
    )
    definitions = replace(model.definitions, assumptions=(*model.assumptions, *stand_ins), correlations=())
    rest = Model(model.workbook, definitions, model.path)
    evaluate, made = Evaluation(rest), model.sampler(seed, _BLOCK)
    count, columns = 0, []
    for start in range(0, trials, _BLOCK):
        drawn = made.draw(start)
        n = min(_BLOCK, trials - start)
        points = np.column_stack([drawn[name_key(a.name)][:n] for a in model.live])
        given = {name_key(a.name): column for a, column in zip(model.live, points.T, strict=True)}
        given |= {name_key(inputs[cell]): c for cell, c in zip(replaced, polynomials(points).T, strict=True)}
        found = evaluate(np.column_stack([given[name_key(a.name)] for a in rest.live]))
        accepted = found.accepted & ~np.isnan(points).any(axis=1)
        count += int(np.count_nonzero(accepted))
        columns.append(found.forecasts[accepted])
    return count, np.concatenate(columns)
