"""What a book could do without: assumptions that may be held at their base values, filters that decide nothing.

1. **Ranked** by what the accepted trials of one run already tell: those whose draw lies nearest to the base value (a
   fifth of the prior) are what a run with the assumption held there would accept, but for the width of the fifth and
   for correlations. How far their mean, SD and central range lie from those of all accepted trials, and their share of
   the accepted from a fifth, is the expected cost.
2. **Verified**, each by a run of its own with the assumption held and the same draws of all others. Correlated ones of
   which one at least is needed alone are also held in groups: two that cancel each other move an answer only apart.
   Of more than `ALONE` assumptions the cheapest are held at once first, as many as may be, found by halving; these are
   not run alone. Of the others, those that reach no common forecast (`reach`) are held in one run, which says of each
   what it costs alone.
3. **Together**: the cheapest that are within the tolerance, as many as still are when held at once. The end is one run
   with all of them held; costs are not added up.
4. **Filters**, in the same way, on top of it: left out one by one, then together. The cells that only they need are not
   needed any more.
5. **At the ends**, if asked: each assumption that may be held at its base value is held at both ends of its range. If
   no answer moves then, either, it need not be known better: no other model, and no measurement, has to give it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import log2
from time import perf_counter
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.cost import Cost
from xlmc.analysis.studies.comparison.differences import Difference, acceptance, difference
from xlmc.analysis.studies.comparison.paired_statistics import Accepted, named_shares
from xlmc.analysis.studies.comparison.tolerances import (
    Tolerances,
    Verdict,
    chance_of,
    chance_tolerance,
    in_tolerances,
    judge,
    read_tolerances,
)
from xlmc.analysis.studies.comparison.variations import names_of_rows, with_changes, with_plain_sampling
from xlmc.analysis.studies.reach import apart, reach_of
from xlmc.analysis.studies.shown import Shown
from xlmc.analysis.studies.steps import Steps, Tell
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Assumption, Forecast
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "ACCEPTANCE_TOLERANCE",
    "ALONE",
    "ENDS",
    "AtEnds",
    "Cost",
    "Expected",
    "ScreenArguments",
    "Screening",
    "screen",
]

ACCEPTANCE_TOLERANCE: Final = 0.1
"""The change of the share of accepted trials, as a share of it, that counts as none."""

SLICE: Final = 0.2
"""The part of the prior around the base value: wide enough to hold trials, narrow enough to represent the value."""

ENDS: Final = (0.025, 0.975)
"""Percentiles of an assumption that stand for the ends of its range."""

_CORRELATED: Final = 0.5
"""The rank correlation from which on two assumptions are held at once: of a − b, holding both can cost less only above
it."""

_RANKED: Final = 8_192
"""Trials that rank correlations are computed from."""

_FEWEST: Final = 2
"""Values of a forecast: a standard deviation takes so many."""

ALONE: Final = 20
"""With more assumptions than this, the cheapest are held at once before the others are held one by one."""

_RUNS_OF_COMPARING: Final = 3.0
"""Runs whose time a further run takes with the comparison of its answers, about."""

Floats = NDArray[np.float64]


class ScreenArguments(TypedDict, total=False):
    """The arguments of `screen` beside the model and the tolerance."""

    chance: float | None
    acceptance_tolerance: float
    sets: Iterable[str]
    judged_by: Iterable[str]
    ends: bool
    trials: int | None
    seed: int | None
    engine: str | None
    jobs: int
    tell: Tell | None
    plan: Tell | None


@dataclass(frozen=True, slots=True)
class Expected:
    """The expected cost of holding an assumption, measured in tolerances, from the accepted trials near its base."""

    name: str
    size: float


@dataclass(frozen=True, slots=True)
class AtEnds:
    """An assumption held at either end of its range.

    Attributes:
        values: the ends, its percentiles `ENDS`.
        costs: of holding it there.
    """

    name: str
    values: tuple[float, float]
    costs: tuple[Cost, Cost]

    @property
    def free(self) -> bool:
        """Whether the answers stay within the tolerances at both ends."""
        return all(cost.judgement.verdict is Verdict.WITHIN for cost in self.costs)


@dataclass(frozen=True, slots=True, repr=False)
class Screening(Shown):
    """What a book could do without.

    Attributes:
        run: the book as it is.
        tolerances: forecast -> the tolerance in its unit, and whether it was stated.
        chance: the tolerance of P(> threshold) as it was stated; None for that of `chance_tolerance`.
        acceptance_tolerance: relative.
        idle: assumptions that no forecast or filter needs.
        baseless: assumptions without a base value, which cannot be held.
        valueless: forecasts that have an answer in fewer than two accepted trials, which judge nothing.
        unasked: forecasts that were not to judge.
        expected: the cheap ranking, the cheapest first.
        single: each assumption held alone, in that order.
        groups: correlated assumptions held at once, the most correlated first.
        joint: those that may be held together, in one run; None if there are none.
        sets: the sets asked for, each held at once.
        filters: each filter left out, with the assumptions of `joint` held.
        reduced: those assumptions held and the filters left out that may be, in one run; None if no filter may.
        constant: formula cells that then do not vary any more.
        dropped: formula cells that are needed no more once the filters are left out.
        cells: how many formula cells the book as it is needs.
        varying: how many then vary.
        runs: how many were made.
        ends: those of `single` that are within the tolerance, held at either end; None if that was not asked.
        at_once: the cheapest of many, held at once because each is expected to be within; none of them was held alone.
            None of few assumptions, or where no such group may be held.
        ended: why it ended before everything was run; empty if it did not.
    """

    run: RunResult
    tolerances: Mapping[str, tuple[float, bool]]
    chance: float | None
    acceptance_tolerance: float
    idle: tuple[str, ...]
    baseless: tuple[str, ...]
    valueless: tuple[str, ...]
    unasked: tuple[str, ...]
    expected: tuple[Expected, ...]
    single: tuple[Cost, ...]
    groups: tuple[Cost, ...]
    joint: Cost | None
    sets: tuple[Cost, ...]
    filters: tuple[Cost, ...]
    reduced: Cost | None
    constant: tuple[Cell, ...]
    dropped: tuple[Cell, ...]
    cells: int
    varying: int
    runs: int
    ends: tuple[AtEnds, ...] | None = None
    at_once: Cost | None = None
    ended: str = ""

    @property
    def only_alone(self) -> tuple[str, ...]:
        """Assumptions that may be held alone, but were left out of `joint`."""
        joint = self.joint.names if self.joint else ()
        alone = (cost.names[0] for cost in self.single if cost.judgement.verdict is Verdict.WITHIN)
        return tuple(name for name in alone if name not in joint)

    @property
    def undecided(self) -> tuple[Cost, ...]:
        """The changes of which these trials cannot say whether they are within the tolerance."""
        every = (*self.single, *self.groups, *self.filters)
        return tuple(cost for cost in every if cost.judgement.verdict is Verdict.UNDECIDED)


def screen(
    model: CompiledModel,
    tolerance: Iterable[str] | str = (),
    *,
    chance: float | None = None,
    acceptance_tolerance: float = ACCEPTANCE_TOLERANCE,
    sets: Iterable[str] = (),
    judged_by: Iterable[str] = (),
    ends: bool = False,
    trials: int | None = None,
    seed: int | None = None,
    engine: str | None = None,
    jobs: int = 1,
    tell: Tell | None = None,
    plan: Tell | None = None,
) -> Screening:
    """Find which assumptions may be held, and which filters left out, without moving an answer beyond the tolerance.

    A first Ctrl-C ends it after the run that is under way, with what is known by then (`Screening.ended`); the first
    run ends with the blocks of trials in progress. The model and its workbook stay as they are. The trials are plain
    Monte Carlo, whatever its settings say.

    Args:
        model: to screen.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD), `Name=0.5 mph`; a tenth of the SD where none is
            stated. It holds for mean, SD and both ends of the central range.
        chance: the change of P(forecast > its threshold) that counts as none, in percentage points; by default a tenth
            of it or of its complement, and a tenth of a point at least.
        acceptance_tolerance: the relative change of the share of accepted trials that counts as none.
        sets: names of assumptions to hold at once, joined by commas, `*` for any letters.
        judged_by: names of the forecasts that count, in the same form; all where there are none.
        ends: also hold each assumption that may be held at both ends of its range.
        trials: of every run; as in `Model.simulate`, like what follows.
        seed: of every run.
        engine: of every run.
        jobs: of every run.
        tell: called before every run with what it is for, how many are left, and how long they may take.
        plan: called after the first run with how many further ones are to come, if they take long.

    Raises:
        SimulationError: an argument is out of its range, no name fits a set, or fewer than two trials are accepted, or
            give a number for any forecast.
    """
    if not acceptance_tolerance > 0.0:
        message = f"the tolerance of the acceptance is {number_text(acceptance_tolerance)}"
        raise SimulationError(message, hint="give a positive number, such as 0.1 for a tenth")
    stated = read_tolerances([tolerance] if isinstance(tolerance, str) else tolerance, model.forecasts)
    wanted = [names_of_rows(pattern, model.live, "assumption that is drawn") for pattern in sets]
    asked = [name for text in judged_by for name in names_of_rows(text, model.forecasts, "forecast")]
    with Steps(tell, plan=plan) as steps:
        steps.begin("the book as it is")
        began = perf_counter()
        run = steps.first_run(
            partial(
                simulate,
                with_plain_sampling(model),
                trials=trials,
                seed=seed,
                engine=engine,
                jobs=jobs,
                keep_interrupted=True,
            )
        )
        if run.accepted < _FEWEST:
            message = (
                f"{run.accepted} of {count_text(run.trials)} trials were accepted, too few to compare anything with"
            )
            raise SimulationError(
                message, hint="run more trials, or see whether the filters contradict the assumptions"
            )
        seconds = perf_counter() - began
        screened = _Screen(run, stated, chance_of(chance), acceptance_tolerance, engine, jobs, steps, asked, seconds)
        return screened.screening(wanted, ends=ends)


class _Screen:
    """The runs of one screening."""

    def __init__(
        self,
        run: RunResult,
        stated: Tolerances,
        chance: float | None,
        acceptance_tolerance: float,
        engine: str | None,
        jobs: int,
        steps: Steps,
        asked: Sequence[str],
        seconds: float,
    ) -> None:
        self._seconds = seconds
        self._run, self._chance, self._acceptance_tolerance = run, chance, acceptance_tolerance
        self._engine, self._jobs, self._steps = engine, jobs, steps
        self._accepted = {f.name: Accepted.of_run(run, f.name) for f in run.model.forecasts}
        wanted = [f for f in run.model.forecasts if not asked or f.name in asked]
        self._unasked = tuple(f.name for f in run.model.forecasts if f not in wanted)
        self._judged = [f for f in wanted if self._accepted[f.name].m >= _FEWEST]
        self._valueless = tuple(f.name for f in wanted if f not in self._judged)
        if not self._judged:
            message = "no forecast has an answer in two accepted trials or more"
            raise SimulationError(message, hint="xlmc simulate says in which cells the trials are lost to errors")
        self._shares = {name: named_shares(each, each) for name, each in self._accepted.items()}
        if all(self._shares[f.name] for f in self._judged):
            stated.refuse_for_shares(self._judged)
        self._tolerances = {
            f.name: stated.of_share(f, self._accepted[f.name].scale, chance)
            if self._shares[f.name]
            else stated.of(f, self._accepted[f.name].scale)
            for f in self._judged
        }
        self._runs = 1
        self._reach = reach_of(run.model) if len(run.model.live) > ALONE else {}
        self._as_it_is: dict[str, Difference] = {}
        self._every: dict[str, _Every] = {}

    def screening(self, sets: Sequence[tuple[str, ...]], *, ends: bool) -> Screening:
        model = self._run.model
        self._steps.can_end()
        self._steps.begin("what the accepted trials tell")
        freezable = [a for a in model.live if a.base is not None]
        ranked = (Expected(a.name, self._expect_cost(a)) for a in self._steps.each(freezable))
        expected = sorted(ranked, key=lambda each: each.size)
        further = len(sets) + len(model.filters) + (2 * len(freezable) if ends else 0)
        seconds = perf_counter()
        at_once = None if ends or len(expected) <= ALONE else self._at_once(expected, further)
        alone = [each for each in expected if at_once is None or each.name not in at_once.names]
        rounds = self._rounds([(each.name,) for each in alone])
        made, most = self._runs - 1, 2 * len(rounds) + int(log2(len(alone) + 1)) + further
        each_run = (perf_counter() - seconds) / made if made else _RUNS_OF_COMPARING * self._seconds
        self._steps.say_plan(
            f"Holds {count_text(len(alone))} assumptions in {count_text(len(rounds))} runs, then together: about "
            f"{count_text(most)} further runs of {count_text(self._run.trials)} trials",
            most * each_run,
        )
        self._steps.expect(2 * len(rounds) + int(log2(len(alone) + 1)) + further)
        costs = [cost for names in self._steps.each(rounds) for cost in self._freeze_apart(names)]
        rank = {each.name: number for number, each in enumerate(expected)}
        single = tuple(sorted(costs, key=lambda cost: rank[cost.names[0]]))
        correlated = self._correlated(single, at_once.names if at_once else ())
        self._steps.expect(len(correlated) + int(log2(len(alone) + 1)) + further)
        groups = tuple(self._freeze(names) for names in self._steps.each(correlated))
        joint = self._together((*single, *groups), self._freeze, at_once)
        frozen = joint.names if joint else ()
        self._steps.expect(further)

        def left_out(names: Sequence[str]) -> Cost:
            return self._cost(names, frozen, names, f"without {_names_text(names)}")

        filters = tuple(left_out([f.name]) for f in self._steps.each(model.filters))
        reduced = self._together(filters, left_out)
        within = [cost.names[0] for cost in single if cost.judgement.verdict is Verdict.WITHIN]
        self._steps.expect(len(sets) + (2 * len(within) if ends else 0))
        at_ends = tuple(self._at_ends(name) for name in self._steps.each(within)) if ends else None
        before = model.needed.graph
        after = with_changes(model, frozen=frozen, without=reduced.names if reduced else ()).needed.graph
        return Screening(
            run=self._run,
            tolerances=self._tolerances,
            chance=self._chance,
            acceptance_tolerance=self._acceptance_tolerance,
            idle=tuple(a.name for a in model.needed.idle),
            valueless=self._valueless,
            unasked=self._unasked,
            baseless=tuple(a.name for a in model.live if a.base is None),
            expected=tuple(expected),
            single=single,
            groups=groups,
            joint=joint,
            sets=tuple(self._freeze(names) for names in self._steps.each(sets)),
            filters=filters,
            reduced=reduced,
            constant=tuple(c for c in sorted(after.formulas) if c in before.varying and c not in after.varying),
            dropped=tuple(cell for cell in sorted(before.formulas) if cell not in after.formulas),
            cells=len(before.formulas),
            varying=sum(cell in after.varying for cell in after.formulas),
            runs=self._runs,
            ends=at_ends,
            at_once=at_once,
            ended=self._steps.why_ended,
        )

    def _at_once(self, expected: Sequence[Expected], further: int) -> Cost | None:
        """Hold as many of the cheapest at once as may be, found by halving, from those that the ranking expects."""
        best, low, high = None, 1, len(expected)
        length = min(max(sum(each.size <= 1.0 for each in expected), 2), high)
        while low < high and not self._steps.ended:
            self._steps.expect(int(log2(high - low)) + 1 + len(expected) - low + further)
            cost = self._freeze([each.name for each in expected[:length]])
            if cost.judgement.verdict is Verdict.WITHIN:
                best, low = cost, length
            else:
                high = length - 1
            length = (low + high + 1) // 2
        return best

    def _at_ends(self, name: str) -> AtEnds:
        low, high = (float(end) for end in np.quantile(self._run.prior[name], ENDS, method="inverted_cdf"))
        costs = tuple(
            self._cost([name], [name], (), f"{name} held at {number_text(value)}", {name: value})
            for value in (low, high)
        )
        return AtEnds(name, (low, high), (costs[0], costs[1]))

    def _freeze(self, names: Sequence[str]) -> Cost:
        return self._cost(names, names, (), f"{_names_text(names)} held")

    def _cost(
        self,
        names: Sequence[str],
        frozen: Sequence[str],
        without: Sequence[str],
        purpose: str,
        frozen_at: Mapping[str, float] | None = None,
    ) -> Cost:
        """Run the book with a change, over the same trials, and compare the answers."""
        return self._compare(tuple(names), self._run_with(frozen, without, purpose, frozen_at))

    def _run_with(
        self,
        frozen: Sequence[str],
        without: Sequence[str],
        purpose: str,
        frozen_at: Mapping[str, float] | None = None,
    ) -> RunResult:
        """Run the book with a change, over the same trials."""
        self._steps.begin(purpose)
        self._runs += 1
        model = with_changes(self._run.model, frozen=frozen, without=without, frozen_at=frozen_at)
        settings = self._run.settings
        return simulate(
            model, trials=settings.trials, seed=settings.seed, engine=self._engine, jobs=self._jobs, keep_inputs=0
        )

    def _compare(
        self, names: tuple[str, ...], run: RunResult, only: Collection[str] | None = None, *, distances: bool = True
    ) -> Cost:
        """Compare a run with that of the book as it is; the answers beside `only` are taken for unchanged.

        `distances` of the distribution functions are not wanted of what nobody is told.
        """
        accepted = acceptance(self._run, run)
        result = {
            f.name: self._difference(f, run if only is None or f.name in only else self._run, distances=distances)
            for f in self._judged
        }
        limits = {name: each.tolerances(self._tolerances[name][0], self._chance) for name, each in result.items()}
        sizes = {
            f"{name}, {number}": (change.difference, limits[name][number])
            for name, each in result.items()
            for number, change in each.changes
        }
        sizes["acceptance"] = accepted.relative, self._acceptance_tolerance
        size = max(in_tolerances(*each) for each in sizes.values())
        return Cost(names, accepted, result, judge(sizes), size)

    def _difference(self, forecast: Forecast, run: RunResult, *, distances: bool = True) -> Difference:
        """Compare a forecast; what the change does not reach, most of the answers of a large book, only once."""
        name, first = forecast.name, self._accepted[forecast.name]

        def compared(second: Accepted, *, distances: bool = True) -> Difference:
            form = self._run.results[name].form
            return difference(first, second, forecast.central, forecast.threshold, form, distances=distances)

        own = self._run.forecasts[name]
        same = np.array_equal(run.trial_index, self._run.trial_index)
        if first.is_share or not same or not np.array_equal(run.forecasts[name], own, equal_nan=True):
            return compared(Accepted.of_run(run, name), distances=distances)
        if name not in self._as_it_is:
            self._as_it_is[name] = compared(first)
        return self._as_it_is[name]

    def _together(
        self, single: Sequence[Cost], changed: Callable[[Sequence[str]], Cost], at_once: Cost | None = None
    ) -> Cost | None:
        """As many of the changes that are within alone as are within together, the cheapest first.

        The longest list of the cheapest by halving, then each of the others on top of it; of many on top of those that
        are held `at_once`.
        """
        alone = sorted((c for c in single if c.judgement.verdict is Verdict.WITHIN), key=lambda cost: cost.size)
        if not alone:
            return at_once
        if at_once is not None:
            return self._with_more(at_once, [cost.names for cost in alone])
        best, low, high = alone[0], 1, len(alone)
        length = high
        while low < high and not self._steps.ended:
            cost = changed(_all_names(alone[:length]))
            if cost.judgement.verdict is Verdict.WITHIN:
                best, low = cost, length
            else:
                high = length - 1
            length = (low + high + 1) // 2
        rest = alone[low + 1 :]  # the one after the longest list is known not to fit
        if len(rest) > ALONE and changed == self._freeze:
            return self._with_more(best, [cost.names for cost in rest])
        for each in self._steps.each(rest):
            cost = changed(_all_names((best, each)))
            if cost.judgement.verdict is Verdict.WITHIN:
                best = cost
        return best

    def _with_more(self, best: Cost, rest: Sequence[tuple[str, ...]]) -> Cost:
        """Return the most assumptions that may be held together: the best so far, and of the rest what also fits.

        As if each were held on top of all that fit before it: what reaches no common forecast, in one run.
        """
        names = list(best.names)
        rounds = self._rounds(rest)
        for number, round_ in enumerate(rounds):
            if self._steps.ended:
                return best
            self._steps.expect(len(rounds) - number + 1)
            costs = self._freeze_apart(round_, names)
            fitting = [cost.names for cost in costs if cost.judgement.verdict is Verdict.WITHIN]
            names = list(dict.fromkeys((*names, *(name for each in fitting for name in each))))
        together = self._freeze(names) if len(names) > len(best.names) and not self._steps.ended else best
        return together if together.judgement.verdict is Verdict.WITHIN else best

    def _rounds(self, candidates: Sequence[tuple[str, ...]]) -> list[list[tuple[str, ...]]]:
        """Put what is to be held into runs: of many assumptions those that reach no common forecast into one."""
        if not self._reach:
            return [[names] for names in candidates]
        return apart(candidates, [self._reached(names) for names in candidates])

    def _reached(self, names: Iterable[str]) -> frozenset[str]:
        return frozenset[str]().union(*(self._reach[name] for name in names))

    def _freeze_apart(self, round_: Sequence[tuple[str, ...]], also: Sequence[str] = ()) -> list[Cost]:
        """Hold several that reach no common forecast in one run, and return what each costs, on top of what is held
        with all.
        """
        held = list(dict.fromkeys((*also, *(name for names in round_ for name in names))))
        if len(round_) == 1:
            return [replace(self._freeze(held), names=round_[0])]
        run = self._run_with(held, (), f"{len(held)} held, {len(round_)} of them apart from each other")
        return [self._compare(names, run, self._reached(names), distances=not also) for names in round_]

    def _correlated(self, single: Sequence[Cost], at_once: Sequence[str]) -> list[tuple[str, ...]]:
        """Return groups of correlated assumptions with one at least that cannot be held alone."""
        alone = {cost.names[0]: cost.judgement.verdict is Verdict.WITHIN for cost in single}
        alone |= dict.fromkeys(at_once, True)
        drawn = np.array([self._run.prior[name][:_RANKED] for name in alone])
        if len(drawn) < 2:
            return []
        groups = _groups(np.asarray(np.nan_to_num(np.corrcoef(_ranks(drawn)))))
        named = [tuple(name for index, name in enumerate(alone) if index in group) for group in groups]
        return [names for names in named if not all(alone[name] for name in names)]

    def _expect_cost(self, assumption: Assumption) -> float:
        """Return the expected cost of holding an assumption, from the accepted trials near its base value."""
        drawn, prior = self._run.inputs[assumption.name], self._run.prior[assumption.name]
        base = assumption.base or 0.0
        width = float(np.quantile(np.abs(prior - base), SLICE))
        near = np.abs(drawn - base) <= width
        if np.count_nonzero(near) < 2:
            return float("inf")
        share = float(near.mean() / np.mean(np.abs(prior - base) <= width))
        sizes = [abs(share - 1.0) / self._acceptance_tolerance]
        for forecast in self._judged:
            if self._reach and forecast.name not in self._reach[assumption.name]:
                continue
            values, tolerance = self._run.forecasts[forecast.name][: drawn.size], self._tolerances[forecast.name][0]
            if shares := self._shares[forecast.name]:
                sizes.append(_largest_move_of_shares(values, near, shares.values(), tolerance, self._chance))
            else:
                if forecast.name not in self._every:
                    self._every[forecast.name] = _Every.of(values, forecast)
                sizes.append(_largest_move(values, near, self._every[forecast.name], forecast, tolerance, self._chance))
        return max(sizes)


def _all_names(costs: Iterable[Cost]) -> list[str]:
    return list(dict.fromkeys(name for cost in costs for name in cost.names))


def _ranks(drawn: Floats) -> Floats:
    """Return the ranks of `(k, n)` draws in each row."""
    return np.asarray(drawn.argsort(axis=1, kind="stable").argsort(axis=1, kind="stable"), np.float64)


def _groups(correlations: Floats) -> list[frozenset[int]]:
    """Return the groups that grow as `(k, k)` correlations are gone through, the strongest first: k − 1 at most.

    >>> [sorted(group) for group in _groups(np.array([[1, 0.6, 0.1], [0.6, 1, -0.9], [0.1, -0.9, 1]]))]
    [[1, 2], [0, 1, 2]]
    """
    size = np.abs(correlations)
    rows, columns = np.nonzero(np.triu(size >= _CORRELATED, 1))
    own = {index: frozenset([index]) for index in range(len(size))}
    result = []
    for pair in np.argsort(-size[rows, columns], kind="stable").tolist():
        joined = own[int(rows[pair])] | own[int(columns[pair])]
        if joined not in (own[int(rows[pair])], own[int(columns[pair])]):
            result.append(joined)
            own |= dict.fromkeys(joined, joined)
    return result


@dataclass(frozen=True, slots=True)
class _Every:
    """What all values of a forecast are like: `known` are those that are numbers."""

    known: NDArray[np.bool_]
    mean: float
    sd: float
    ends: Floats
    above: float | None

    @classmethod
    def of(cls, values: Floats, forecast: Forecast) -> _Every:
        known = ~np.isnan(values)
        every = values[known]
        above = None if forecast.threshold is None else float(np.mean(every > forecast.threshold))
        return cls(known, every.mean(), every.std(), np.quantile(every, _tails(forecast)), above)


def _tails(forecast: Forecast) -> list[float]:
    return [(1.0 - forecast.central) / 2.0, (1.0 + forecast.central) / 2.0]


def _largest_move(
    values: Floats,
    near: NDArray[np.bool_],
    every: _Every,
    forecast: Forecast,
    tolerance: float,
    chance: float | None,
) -> float:
    """Return the largest move of mean, SD, central range and P(> threshold) from all values to those near, in
    tolerances.
    """
    some = values[every.known & near]
    if some.size < _FEWEST:
        return float("inf")
    moves = [some.mean() - every.mean, some.std() - every.sd, *(np.quantile(some, _tails(forecast)) - every.ends)]
    sizes = [in_tolerances(Estimate(float(move)), tolerance) for move in moves]
    if forecast.threshold is not None and every.above is not None:
        after = float(np.mean(some > forecast.threshold))
        limit = chance_tolerance(every.above) if chance is None else chance
        sizes.append(in_tolerances(Estimate(after - every.above), limit))
    return max(sizes)


def _largest_move_of_shares(
    values: Floats,
    near: NDArray[np.bool_],
    shares: Iterable[tuple[float, ...]],
    tolerance: float,
    chance: float | None,
) -> float:
    """Return the same of the shares of answers that are counted."""
    known = ~np.isnan(values)
    every, some = values[known], values[known & near]
    if some.size < _FEWEST:
        return float("inf")
    sizes = []
    for positions in shares:
        before, after = (float(np.isin(x, positions).mean()) for x in (every, some))
        default = chance_tolerance(before) if chance is None else chance
        sizes.append(in_tolerances(Estimate(after - before), default if np.isnan(tolerance) else tolerance))
    return max(sizes)


def _names_text(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{len(names)} at once"
