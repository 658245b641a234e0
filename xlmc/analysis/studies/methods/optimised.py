"""Bounds by optimisation: the lowest and highest forecast that the box and the filters allow.

Sequential quadratic programming (SLSQP) from the extreme accepted trials of a pilot run, with exact derivatives of
forecasts and filter cells. A filter is a constraint on its cell, lowest or highest value; one that is only TRUE or
FALSE cannot be followed by an optimiser, and is only checked. Whatever the optimiser says, the end is a point that
the workbook itself accepts: from a final point that it rejects, the nearest one that it accepts is looked for.

All searches go on in step (`in_step`): the workbook is evaluated at the points of all of them at once.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Final, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.derivatives import derivatives
from xlmc.analysis.studies.methods.answer import Answer, Errors, Extreme, MethodResult
from xlmc.analysis.studies.methods.points import Box, Evaluation, box_of
from xlmc.engine.passes.derivatives import Derivative
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.functions.values import ERROR, TEXT
from xlmc.montecarlo.model.draw_binding import parameter_target
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_limits
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.simulation.simulate import simulate

__all__ = ["Optimised", "in_step", "widen_bounds"]

Asked = TypeVar("Asked")
Answered = TypeVar("Answered")
Result = TypeVar("Result")


def in_step(
    searches: Sequence[Callable[[Callable[[Asked], Answered]], Result]],
    answer: Callable[[list[Asked]], Sequence[Answered]],
) -> list[Result]:
    """Run every search in a thread of its own; each is given what answers one question, and waits for the others'.

    Args:
        searches: take the function to ask, give what they find.
        answer: takes one question of every search that goes on, in the order of the searches, gives their answers.

    Raises:
        Exception: whatever a search or an answer raised first.

    >>> def double(ask):
    ...     return ask(ask(1))
    >>> in_step([double, double], lambda questions: [2 * each for each in questions])
    [4, 4]
    """
    round_ = _Round(len(searches), answer)
    result: dict[int, Result] = {}

    def run(index: int) -> None:
        try:
            result[index] = searches[index](lambda question: round_.ask(index, question))
        except BaseException as error:
            round_.fail(error)
        finally:
            round_.leave()

    threads = [threading.Thread(target=run, args=(index,), daemon=True) for index in range(len(searches))]
    for thread in threads:
        thread.start()
    try:
        for thread in threads:
            thread.join()
    except BaseException as error:  # Ctrl-C, which the searches are not to outlive
        round_.fail(error)
        raise
    if round_.error is not None:
        raise round_.error
    return [result[index] for index in range(len(searches))]


class _Round(Generic[Asked, Answered]):
    """The questions that wait; the last search to ask, or to end, has them answered."""

    def __init__(self, going: int, answer: Callable[[list[Asked]], Sequence[Answered]]) -> None:
        self._going, self._answer = going, answer
        self._asked: dict[int, Asked] = {}
        self._answered: dict[int, Answered] = {}
        self._changed = threading.Condition()
        self.error: BaseException | None = None

    def ask(self, index: int, question: Asked) -> Answered:
        with self._changed:
            self._asked[index] = question
            self._answer_if_all()
            while index not in self._answered and self.error is None:
                self._changed.wait()
            if self.error is not None:
                raise self.error
            return self._answered.pop(index)

    def leave(self) -> None:
        with self._changed:
            self._going -= 1
            self._answer_if_all()

    def fail(self, error: BaseException) -> None:
        with self._changed:
            self.error = self.error or error
            self._changed.notify_all()

    def _answer_if_all(self) -> None:
        if self.error is not None or not self._asked or len(self._asked) < self._going:
            return
        indices = sorted(self._asked)
        try:
            answers = self._answer([self._asked[index] for index in indices])
            self._answered.update(zip(indices, answers, strict=True))
        except BaseException as error:
            self.error = error
        self._asked.clear()
        self._changed.notify_all()


_PILOT: Final = 32_768
_STARTS: Final = 2
"""The starts of the search for each end: the accepted trials of the pilot that are nearest to it."""

_MOST: Final = 200
"""Assumptions; a step's work grows with the third power of their number."""

_MOST_STEPS: Final = 60
_MARGINS: Final = (1e-9, 1e-7, 1e-5, 1e-3)
"""How far a point is moved away from the constraints, in widths of the box, until the workbook accepts it."""

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Goal = Callable[[Floats], tuple[float, Floats]]
End = tuple[str, str]
"""Forecast, and `least` or `most`."""

Point = Mapping[str, float]
"""Assumption -> its value."""


@dataclass(frozen=True, slots=True)
class Optimised:
    """The range that no accepted trial leaves, as far as the search finds it.

    Attributes:
        seconds: how long the search may take.
    """

    key: str = "optimised"
    name: str = "Bounds, optimised"
    errors: Errors = "once"
    cannot: str = (
        "gives two ends and no likelihood in between; a search may end at an extreme that is not the outermost"
    )
    seconds: float = np.inf

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`; the budget is not looked at.

        Raises:
            SimulationError: the pilot run has no accepted trial to start from, there are too many assumptions, or the
                search takes too long.
        """
        started = time.perf_counter()
        if len(model.live) > _MOST:
            message = (
                f"{count_text(len(model.live))} assumptions are drawn, and the search handles no more than {_MOST}"
            )
            raise SimulationError(message, hint="bounds by corners look at as many as there are")
        pilot = simulate(model, trials=_PILOT, seed=seed, sampling="mc", engine="numpy", keep_inputs=None)
        if not pilot.accepted:
            message = f"the filters accept none of {count_text(_PILOT)} trials, so the search has nothing to start from"
            raise SimulationError(message, hint="see whether the filters contradict the assumptions")
        search = _Search(model, box_of(model, seed), np.column_stack([pilot.inputs[a.name] for a in model.live]))
        search.deadline = started + self.seconds
        answers, ends = search.answers(pilot.forecasts)
        evaluations = _PILOT + search.points
        return MethodResult(
            time.perf_counter() - started, evaluations, answers, remarks=search.remarks, ends=ends
        )  # fmt: skip


def widen_bounds(
    model: CompiledModel, seed: int, bounds: Mapping[str, tuple[float, float]], extremes: Iterable[Extreme]
) -> tuple[dict[str, Answer], dict[End, Point]]:
    """Wider bounds where accepted trials lie outside those that were found, by a search from these trials.

    Args:
        model: the workbook.
        seed: of the box.
        bounds: forecast -> least and most, as they were found.
        extremes: accepted trials.

    Returns:
        The wider bounds, NaN where the found ones hold, and the points that they are reached at.
    """
    box, evaluate, names = box_of(model, seed), Evaluation(model), [a.name for a in model.live]
    columns = [f.name for f in model.forecasts]
    answers: dict[str, Answer] = {}
    ends: dict[End, Point] = {}
    for (name, end), each in _outside(bounds, extremes).items():
        drawn = model.sampler(each.seed, 1, plan=each.plan).draw(each.trial)
        point = np.column_stack([drawn[assumption] for assumption in names])
        outcomes = evaluate(point)
        if not outcomes.accepted[0]:
            continue
        values = {name: outcomes.forecasts[:, columns.index(name)]}
        wider, where = _Search(model, box, point).answers(values)
        answers[name] = replace(answers.get(name, Answer()), **{end: getattr(wider[name], end)})
        ends[name, end] = where[name, end]
    return answers, ends


def _outside(bounds: Mapping[str, tuple[float, float]], extremes: Iterable[Extreme]) -> dict[End, Extreme]:
    """Return the outermost trial beyond each end."""
    result: dict[End, Extreme] = {}
    for each in extremes:
        if each.forecast not in bounds:
            continue
        key, sign = (each.forecast, each.end), 1.0 if each.end == "least" else -1.0
        bound = result[key].value if key in result else bounds[each.forecast][each.end == "most"]
        if sign * each.value < sign * bound:
            result[key] = each
    return result


class _Search:
    """The optimisations of one run. Points are counted in widths of the box, so that all assumptions weigh alike.

    Attributes:
        deadline: the time of the clock from which on no more points are evaluated.
    """

    def __init__(self, model: CompiledModel, box: Box, accepted: Floats) -> None:
        self._model, self._box, self._accepted = model, box, accepted
        self._evaluate = Evaluation(model)
        self._names = [a.name for a in model.live]
        self._low, self._width = box.low, np.where(box.width > 0.0, box.width, 1.0)
        self._derived, self.deadline = 0, np.inf
        self._one_at_a_time = threading.Lock()
        self._filters = {f.name: [(sense, _number(model, at)) for sense, at in filter_limits(f)] for f in model.filters}

    @property
    def points(self) -> int:
        """How many were evaluated, with and without derivatives."""
        return self._evaluate.count + self._derived

    @property
    def remarks(self) -> tuple[str, ...]:
        result = [
            f"{_STARTS} searches for each end, with exact derivatives, from accepted trials of a pilot run",
            "each end is the forecast of a point that the workbook accepts; --json and the files of -o name it",
        ]
        unseen = [name for name, limits in self._filters.items() if any(at is None for _, at in limits) or not limits]
        if unseen:
            result.append(f"checked, but not followed by the search: {', '.join(unseen)}")
        if self._whole.any():
            whole_names = ", ".join(name for name, whole in zip(self._names, self._whole, strict=True) if whole)
            result.append(
                f"held at their values in the starting trials, because they are not continuous: {whole_names}"
            )
        return (*result, *self._box.remarks)

    @cached_property
    def _whole(self) -> Bools:
        """(k,) which assumptions take so few values that they count as discrete."""
        return np.array([2 * np.unique(column).size < column.size > 8 for column in self._accepted.T], bool)

    def answers(self, forecasts: Mapping[str, Floats]) -> tuple[dict[str, Answer], dict[End, Point]]:
        """Return the bounds of every forecast, given its values in the accepted trials, and where they are reached."""
        ends = [
            (name, sign, trial)
            for name, values in forecasts.items()
            for sign in (1.0, -1.0)
            for trial in np.argsort(sign * values)[: min(_STARTS, np.count_nonzero(~np.isnan(values)))].tolist()
        ]
        searches = [partial(self._search, name, sign, self._accepted[trial]) for name, sign, trial in ends]
        best: dict[End, tuple[float, Floats]] = {}
        for (name, sign, trial), result in zip(ends, in_step(searches, self._derivatives), strict=True):
            end = name, "least" if sign > 0.0 else "most"
            sampled = float(forecasts[name][trial]), self._accepted[trial]
            candidates = [each for each in (best.get(end), sampled, result) if each is not None]
            best[end] = min(candidates, key=lambda each: sign * each[0])
        answers = {name: Answer() for name in forecasts}
        for (name, which), (value, _) in best.items():
            answers[name] = replace(answers[name], **{which: value})
        where: dict[End, Point] = {
            end: dict(zip(self._names, point.tolist(), strict=True)) for end, (_, point) in best.items()
        }
        return answers, where

    def _search(
        self, name: str, sign: float, start: Floats, ask: Callable[[Floats], _Point]
    ) -> tuple[float, Floats] | None:
        """Return the end found from one accepted trial, in the forecast's units, and its point; otherwise None."""
        at, known = (start - self._low) / self._width, _Known(ask)
        value, _ = known(at).forecasts[name]
        factor = sign / max(abs(value), 1e-300)

        def goal(z: Floats) -> tuple[float, Floats]:
            value, slope = known(z).forecasts[name]
            return factor * value, factor * slope

        end = self._minimum(goal, at, self._constraints(known, 0.0))
        result = self._if_accepted(name, end)
        for margin in _MARGINS:
            if result is not None:
                return result
            # The optimiser keeps to constraints but for rounding: on to the nearest point that is clear of them.
            near = partial(_distance, end)
            result = self._if_accepted(name, self._minimum(near, end, self._constraints(known, margin)))
        return result

    def _minimum(self, goal: Goal, start: Floats, constraints: list[dict[str, Any]]) -> Floats:
        from scipy.optimize import minimize

        free = (self._box.width > 0.0) & ~self._whole
        with np.errstate(all="ignore"):
            ended = minimize(
                goal, start, jac=True, method="SLSQP", constraints=constraints,
                bounds=[(0.0, 1.0) if moves else (fixed, fixed) for moves, fixed in zip(free, start, strict=True)],
                options={"maxiter": _MOST_STEPS, "ftol": 1e-8},
            )  # fmt: skip
        return np.where(free, np.clip(np.nan_to_num(ended.x, nan=0.5), 0.0, 1.0), start)

    def _if_accepted(self, name: str, point: Floats) -> tuple[float, Floats] | None:
        """Return the forecast at a point, and the point in the assumptions' units, if the workbook accepts it."""
        at = self._low + point * self._width
        with self._one_at_a_time:
            outcomes = self._evaluate(at[None, :])
        value = float(outcomes.forecasts[0, [f.name for f in self._model.forecasts].index(name)])
        return (value, at) if outcomes.accepted[0] and not np.isnan(value) else None

    def _constraints(self, known: _Known, margin: float) -> list[dict[str, Any]]:
        return [
            _constraint(known, name, 1.0 if sense[0] == ">" else -1.0, limit, margin)
            for name, limits in self._filters.items()
            for sense, limit in limits
            if limit is not None
        ]

    def _derivatives(self, points: list[Floats]) -> list[_Point]:
        """Values and slopes at points of as many searches.

        Raises:
            SimulationError: the time is over.
        """
        if time.perf_counter() > self.deadline:
            raise SimulationError("the search took longer than the study has for it")
        at = self._low + np.array(points) * self._width
        result = derivatives(self._model, dict(zip(self._names, at.T, strict=True)))
        self._derived += len(points)

        def one(each: Derivative, index: int) -> tuple[float, Floats]:
            return float(each.value[index]), np.nan_to_num(each.gradient[index] * self._width)

        return [
            _Point(
                {name: one(each, index) for name, each in result.forecasts.items()},
                {name: one(each, index) for name, each in result.filters.items()},
            )
            for index in range(len(points))
        ]


@dataclass(frozen=True, slots=True, eq=False)
class _Point:
    """Name -> value and slope, of the forecasts and of the filters' cells."""

    forecasts: Mapping[str, tuple[float, Floats]]
    filters: Mapping[str, tuple[float, Floats]]


class _Known:
    """Asks once for a point that goal and constraints all want."""

    def __init__(self, ask: Callable[[Floats], _Point]) -> None:
        self._ask, self._at, self._point = ask, b"", _Point({}, {})

    def __call__(self, z: Floats) -> _Point:
        if z.tobytes() != self._at:
            self._at, self._point = z.tobytes(), self._ask(z.copy())
        return self._point


def _constraint(known: _Known, name: str, direction: float, limit: float, margin: float) -> dict[str, Any]:
    """`direction` (cell − limit) ≥ 0, with room for a step of `margin` widths of the box."""

    def distance(z: Floats) -> float:
        value, slope = known(z).filters[name]
        return direction * (value - limit) - margin * float(np.linalg.norm(slope))

    return {"type": "ineq", "fun": distance, "jac": lambda z: direction * known(z).filters[name][1]}


def _distance(end: Floats, z: Floats) -> tuple[float, Floats]:
    """Half the squared distance from a point, and its slope."""
    return 0.5 * float(np.sum((z - end) ** 2)), z - end


def _number(model: CompiledModel, limit: float | Cell) -> float | None:
    """Return a limit that does not vary; None if it does, or is no number."""
    if not isinstance(limit, Cell):
        return limit
    value = model.lowering.known(parameter_target(limit))
    if value is None or int(value.kinds[0]) >= ERROR or int(value.kinds[0]) == TEXT:
        return None
    return float(value.numbers[0])
