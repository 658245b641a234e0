"""The candidates of an optimisation: what they can be, and what is known of those that were tried."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.optimising.measures import Goal, Measured, Requirement, apart
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.loop.candidates import CandidateTrials, Values

__all__ = ["MARGIN", "SURE", "Axis", "Ended", "Space", "Standing", "Tried"]

Floats = NDArray[np.float64]

SURE: Final = 1.6448536269514722
"""Errors by which a requirement must hold, so that it does with 95 % confidence."""

MARGIN: Final = 2.0
"""Errors by which it must hold in the search, so that other trials are likely to say so, too."""

_FINEST: Final = 1e-4
"""The grid of a decision that may have any value, as a share of its range; rounded to a power of ten."""


class Ended(Exception):  # noqa: N818  # it is no error
    """The search is to end: it was interrupted, or its trials are spent."""


@dataclass(frozen=True, slots=True)
class Axis:
    """The values of a decision, by number: listed, or from the least in equal steps.

    Attributes:
        count: how many there are.
        ordered: whether neighbours are alike.
        fine: whether they stand for any value of a range.
        computed: whether an equality computes it from the others, so that it has no values of its own.
    """

    decision: Decision
    count: int
    ordered: bool
    fine: bool
    step: float = 0.0
    computed: bool = False

    @classmethod
    def of(cls, decision: Decision) -> Axis:
        """Return the axis of a decision."""
        if decision.between is None:
            return cls(decision, len(decision.values), not decision.listed, fine=False)
        low, high = decision.between
        step = 10.0 ** math.floor(math.log10((high - low) * 10.0 * _FINEST))
        return cls(decision, math.ceil((high - low) / step - 1e-9) + 1, ordered=True, fine=True, step=step)

    def value(self, number: int) -> float:
        """Return a value by its number."""
        if not self.fine:
            return self.decision.values[number]
        assert self.decision.between is not None
        low, high = self.decision.between
        if number == 0 or number >= self.count - 1:
            return low if number == 0 else high
        return min(high, round(low + number * self.step, 9 - math.floor(math.log10(self.step))))

    def number(self, value: float) -> int | None:
        """Return the number of a value; None if it is none of them."""
        if self.computed:
            return 0
        result = min(range(self.count), key=lambda at: abs(self.value(at) - value)) if not self.fine else None
        if result is None:
            assert self.decision.between is not None
            result = min(max(round((value - self.decision.between[0]) / self.step), 0), self.count - 1)
        same = math.isclose(self.value(result), value, rel_tol=1e-9, abs_tol=1e-12)
        return result if same else None


@dataclass(frozen=True, slots=True)
class Equalities:
    """Sums of decisions that must be 0, solved for as many decisions that may have any value.

    With F of `(e, d)` factors and c of `(e,)` constants they are F v + c = 0; v of the computed decisions D is then
    −F_D⁻¹ (c + F_rest v_rest).

    Attributes:
        computed: the numbers of the decisions D.
        factors: `(e, d)`, of D 0.
        constants: `(e,)`.
    """

    computed: tuple[int, ...]
    factors: Floats
    constants: Floats

    @classmethod
    def of(cls, decisions: Sequence[Decision], requirements: Sequence[Requirement]) -> Equalities | None:
        """Solve the equalities among requirements; None where there is none, or none has a decision of any value."""
        sums = [each.slack for each in requirements if each.equal]
        factors = np.zeros((len(sums), len(decisions)))
        for row, each in zip(factors, sums, strict=True):
            for term in each.terms:
                row[term.at] += term.factor
        constants, fine = np.array([each.constant for each in sums]), [d.between is not None for d in decisions]
        pivots: dict[int, int] = {}
        for number in range(len(sums)):  # Gauss and Jordan, with the largest factor of a decision of any value as pivot
            left = [at for at in range(len(decisions)) if fine[at] and at not in pivots.values()]
            sizes = np.abs(factors[number])
            at = max(left, key=sizes.__getitem__, default=None)
            if at is None or sizes[at] <= 1e-12 * sizes.max():
                continue
            constants[number] /= factors[number, at]
            factors[number] /= factors[number, at]
            for other in range(len(sums)):
                if other != number and factors[other, at]:
                    constants[other] -= factors[other, at] * constants[number]
                    factors[other] -= factors[other, at] * factors[number]
            pivots[number] = at
        if not pivots:
            return None
        rows, computed = [*pivots], tuple(pivots.values())
        kept = factors[rows].copy()
        kept[:, computed] = 0.0
        return cls(computed, kept, constants[rows])

    def completed(self, values: Values) -> Values:
        """Return the values of a candidate with those that are computed."""
        result, given = [*values], np.array(values)
        for at, value in zip(self.computed, (-(self.constants + self.factors @ given)).tolist(), strict=True):
            size = max(abs(value), *map(abs, values), 1e-300)
            result[at] = round(value, 12 - math.floor(math.log10(size))) + 0.0  # so that no rounding is shown
        return tuple(result)


@dataclass(frozen=True, slots=True)
class Space:
    """All candidates: a value of each decision, as far as what is required of decisions alone allows."""

    axes: tuple[Axis, ...]
    requirements: tuple[Requirement, ...]
    equalities: Equalities | None = None

    @classmethod
    def of(cls, decisions: Sequence[Decision], requirements: tuple[Requirement, ...]) -> Space:
        """Return the space of decisions: equalities compute some of those that may have any value from the others."""
        axes, equalities = tuple(map(Axis.of, decisions)), Equalities.of(decisions, requirements)
        if equalities is not None:
            axes = tuple(
                replace(axis, count=1, fine=False, computed=True) if number in equalities.computed else axis
                for number, axis in enumerate(axes)
            )
        return cls(axes, requirements, equalities)

    @property
    def size(self) -> int:
        """How many combinations there are, whether they are allowed or not."""
        return math.prod(each.count for each in self.axes)

    @property
    def finite(self) -> bool:
        """Whether no decision may have any value of a range."""
        return not any(each.fine for each in self.axes)

    def candidate(self, numbers: Iterable[int]) -> Values:
        """Return a candidate by the numbers of its values."""
        values = tuple(axis.value(int(number)) for axis, number in zip(self.axes, numbers, strict=True))
        return values if self.equalities is None else self.equalities.completed(values)

    def allows(self, candidate: Values) -> bool:
        """Whether what is required of decisions alone is met."""
        meets = all(each.holds_for(candidate) for each in self.requirements)
        return meets and not self._beyond(candidate)

    def _beyond(self, candidate: Values) -> float:
        """Return how far computed decisions lie beyond their ranges, as shares of these; added up."""
        result = 0.0
        for axis, value in zip(self.axes, candidate, strict=True):
            if axis.computed and axis.decision.between is not None:
                low, high = axis.decision.between
                result += max(0.0, low - value, value - high) / (high - low)
        return result

    def every(self) -> Iterator[Values]:
        """Yield all candidates that are allowed."""
        return filter(self.allows, map(self.candidate, product(*(range(axis.count) for axis in self.axes))))

    def excess(self, candidate: Values) -> float:
        """Return by how much decisions alone miss what is required; 0 where they meet it."""
        slacks = (each.measured(np.empty((0, 0)), candidate).value for each in self.requirements if each.slack.exact)
        return math.fsum((*(max(0.0, -slack) for slack in slacks), self._beyond(candidate)))


@dataclass(frozen=True, slots=True)
class Standing:
    """What is known of a candidate from its first n trials.

    Attributes:
        goal: with its sign, so that larger is better.
        slacks: how far each requirement holds.
        lost: the share of the trials that errors take.
        excess: by how much that is clearly more than is allowed; else 0.
    """

    candidate: Values
    n: int
    goal: Measured
    slacks: tuple[Measured, ...]
    lost: float = 0.0
    excess: float = 0.0

    @property
    def sureness(self) -> float:
        """By how many errors the requirement holds that holds the least; minus infinity where too many trials are
        lost, since what the lost ones would have been is not known.
        """
        return -math.inf if self.excess else min((_errors(each) for each in self.slacks), default=math.inf)

    @property
    def meets(self) -> bool:
        """Whether all requirements hold with a margin, the goal is a number, and errors take few enough trials."""
        return self.sureness >= MARGIN and not math.isnan(self.goal.value)

    @property
    def rank(self) -> tuple[bool, float]:
        """What a better candidate has more of: meeting the requirements, then the goal or how nearly they are met."""
        if math.isnan(self.goal.value):
            return False, -math.inf
        return (True, self.goal.value) if self.meets else (False, -self.missing)

    @property
    def missing(self) -> float:
        """By how much the requirements are missed, as a share of what is asked for; added up."""
        return math.fsum((*(_missing(each) for each in self.slacks), 1e9 * self.excess))


def _errors(slack: Measured) -> float:
    if math.isnan(slack.value):
        return -math.inf
    return slack.value / slack.error if slack.error else math.copysign(math.inf, slack.value or 1.0)


def _missing(slack: Measured) -> float:
    if math.isnan(slack.value) or not math.isfinite(slack.error):
        return 1e9
    return max(0.0, MARGIN * slack.error - slack.value)


@dataclass
class Tried:
    """The candidates that were tried, and their trials.

    Args:
        trials: computes them.
        goal: of the search.
        requirements: of statistics, and of decisions.
        most: trials that may be spent.
        interrupted: whether somebody asked to stop.
        allowed: the share of the trials that a candidate may lose to errors.
    """

    trials: CandidateTrials
    goal: Goal
    requirements: tuple[Requirement, ...]
    most: float
    interrupted: Callable[[], bool]
    allowed: float
    columns: dict[Values, Floats] = field(default_factory=dict)
    _lost: dict[Values, dict[int, int]] = field(default_factory=dict)
    _known: dict[tuple[Values, int], Standing] = field(default_factory=dict)

    def extend(self, candidates: Sequence[Values], n: int) -> None:
        """Compute candidates until each has n trials.

        Raises:
            Ended: the search is to end.
        """
        wanted = [each for each in dict.fromkeys(candidates) if self.length(each) < n]
        for have in sorted({self.length(each) for each in wanted}):
            group = [each for each in wanted if self.length(each) == have]
            for at in range(0, len(group), 64):
                self._check()
                some = group[at : at + 64]
                for candidate, more in zip(some, self.trials.forecasts(some, have, n), strict=True):
                    known, lost = self.columns.get(candidate), self._lost.setdefault(candidate, {0: 0})
                    self.columns[candidate] = (
                        more.columns if known is None else np.concatenate([known, more.columns], axis=1)
                    )
                    lost[n] = lost[have] + more.lost

    def _check(self) -> None:
        if self.interrupted() or self.trials.computed >= self.most:
            raise Ended

    def length(self, candidate: Values) -> int:
        """Return how many trials a candidate has."""
        known = self.columns.get(candidate)
        return 0 if known is None else known.shape[1]

    def standing(self, candidate: Values, n: int | None = None) -> Standing:
        """Return what is known of a candidate that was tried, from its first n trials; by default from all."""
        n = self.length(candidate) if n is None else n
        key = candidate, n
        if key not in self._known:
            columns = self.columns[candidate][:, :n]
            goal = self.goal.measure.of(columns, candidate)
            slacks = tuple(each.measured(columns, candidate) for each in self.requirements)
            signed = Measured(self.goal.sign * goal.value, _times(self.goal.sign, goal), goal.least)
            lost, of = self._lost_of(candidate, n)
            usual = self.allowed * of
            clearly = lost > 1.0 + usual + 2.0 * math.sqrt(usual)
            excess = lost / of - self.allowed if clearly else 0.0
            self._known[key] = Standing(candidate, n, signed, slacks, lost / max(of, 1), excess)
        return self._known[key]

    def _lost_of(self, candidate: Values, n: int) -> tuple[int, int]:
        """Return how many trials errors took, and of how many: of the first n, or a few more as they were computed."""
        counts = self._lost[candidate]
        of = min(each for each in counts if each >= n)
        return counts[of], of

    def forget(self) -> None:
        """Give the memory of standings back; the trials stay."""
        self._known.clear()

    def standings(self, candidates: Iterable[Values], n: int) -> list[Standing]:
        """Return what is known of candidates from their first n trials, the best first.

        Raises:
            Ended: the search is to end.
        """
        candidates = [*dict.fromkeys(candidates)]
        self.extend(candidates, n)
        return sorted((self.standing(each, n) for each in candidates), key=lambda standing: standing.rank, reverse=True)

    def better(self, best: Values, other: Values) -> tuple[float, float]:
        """Return by how much another candidate is better than the best, over the same trials, and its error."""
        n = min(self.length(best), self.length(other))
        return apart(self.standing(best, n).goal, self.standing(other, n).goal)


def _times(sign: float, measured: Measured) -> Floats | None:
    return None if measured.pulls is None else measured.pulls if sign > 0 else -measured.pulls
