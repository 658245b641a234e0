"""Where the candidates come from: all of them, or a search by differential evolution and then step by step.

Every candidate meets the same trials, so that over a given number of them the goal is a function without noise
(a sample average approximation), and its best candidate moves to that of the workbook as trials grow. The search takes
few trials where it is far away and more as its steps become smaller.

Sources: Storn and Price 1997, "Differential evolution", Journal of Global Optimization 11, as SciPy has it; Deb 2000,
"An efficient constraint handling method for genetic algorithms", for the order of candidates that miss a requirement;
Hooke and Jeeves 1961, "Direct search solution of numerical and statistical problems", for the steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.optimising.candidates import MARGIN, Space, Standing, Tried
from xlmc.analysis.studies.optimising.measures import Measured
from xlmc.montecarlo.loop.candidates import Values
from xlmc.montecarlo.number_text import count_text

__all__ = ["MOST_ENUMERATED", "search"]

MOST_ENUMERATED: Final = 2_000
"""Combinations that are all tried."""

_LEAST_TRIALS: Final = 128
_ACCEPTED: Final = 64
"""Trials that must be accepted of those of a candidate."""
_POPULATION, _LARGEST_POPULATION = 10, 80
"""Candidates of a generation for each decision, and at most."""
_CANDIDATES, _MOST_CANDIDATES = 250, 2_500
"""Candidates of differential evolution for each decision, and at most."""
_PAIRED: Final = 12
"""Decisions of which pairs are moved together; of more, some pairs."""
_FIRST_STEP: Final = 0.08
"""The first step of the local search, as a share of a range."""
_SLIDING: Final = 12
"""Candidates along the edge of what is required, for each decision."""
_UNREACHED: Final = 1e100

Tell = Callable[[str], None]


def search(tried: Tried, space: Space, first: Values | None, trials: int, seed: int, tell: Tell) -> str:
    """Try candidates; says in words how they were chosen.

    Args:
        tried: takes them.
        space: of all candidates.
        first: the workbook's own decisions, if they are a candidate.
        trials: of a whole run.
        seed: of what is chosen by chance.
        tell: called with what is done.

    Raises:
        Ended: the search is to end.
    """
    least = max(_LEAST_TRIALS, 1 << max(0, math.ceil(math.log2(max(trials, 2) / 128))))
    least = _enough(tried, space, first, least, trials)
    if space.finite and space.size <= MOST_ENUMERATED:
        tell(f"all of {count_text(space.size)} combinations")
        tried.extend([*space.every()], least)
        return "every combination"
    tell("searching by differential evolution")
    _evolve(tried, space, first, least, seed)
    if not tried.columns:
        return "a search that found none"
    edged = any(not each.slack.exact for each in tried.requirements)
    for divisor, share in ((32, _FIRST_STEP), (8, _FIRST_STEP / 8), (2, _FIRST_STEP / 32)):
        n = max(least, 1 << round(math.log2(max(trials // divisor, 2))))
        tell(f"searching step by step, {count_text(n)} trials each")
        best = max((tried.standing(each) for each in _leading(tried, n)), key=lambda standing: standing.rank)
        if tried.requirements:
            best = _slide(tried, space, best, n, share, _SLIDING * len(space.axes))
        if divisor > 2 or not (edged and all(axis.fine for axis in space.axes)):
            _step_by_step(tried, space, best, n, share, seed)
    if edged:  # more trials need less of a margin
        n = 2 * trials
        tell(f"nearer to what is required, {count_text(n)} trials each")
        best = max((tried.standing(each) for each in _leading(tried, n, 2)), key=lambda result: result.rank)
        _slide(tried, space, best, n, _FIRST_STEP / 4, 6 + 4 * len(space.axes))
    return "differential evolution, then step by step"


def _enough(tried: Tried, space: Space, first: Values | None, least: int, trials: int) -> int:
    """Return how many trials the first candidates get: more where few of them are accepted.

    Raises:
        Ended: the search is to end.
    """
    middle = space.candidate(axis.count // 2 for axis in space.axes)
    tried_first = middle if first is None else first
    if not space.allows(tried_first):
        return least
    n = least
    while True:
        tried.extend([tried_first], n)
        columns = tried.columns[tried_first]
        if n >= trials or not columns.size or int((~np.isnan(columns)).sum(axis=1).min()) >= _ACCEPTED:
            return n
        n = min(4 * n, 1 << math.ceil(math.log2(trials)))


def _leading(tried: Tried, n: int, count: int = 5) -> list[Values]:
    """Return the candidates that are best by what is known, with n trials."""
    ranked = sorted((tried.standing(each) for each in tried.columns), key=lambda standing: standing.rank, reverse=True)
    leading = [each.candidate for each in ranked[:count]]
    tried.extend(leading, n)
    return leading


def _evolve(tried: Tried, space: Space, first: Values | None, n: int, seed: int) -> None:
    """Let populations of candidates evolve, over n trials each."""
    from scipy.optimize import differential_evolution

    k = len(space.axes)
    size = min(max(_POPULATION * k, 20), _LARGEST_POPULATION)
    generations = max(4, min(_CANDIDATES * k, _MOST_CANDIDATES) // size - 1)
    rng = np.random.default_rng(np.random.SeedSequence([seed, k]))

    def energies(at: NDArray[np.float64]) -> NDArray[np.float64]:
        candidates = [space.candidate(np.rint(column)) for column in at.T]
        tried.extend([each for each in candidates if space.allows(each)], n)
        return np.array([_energy(tried, space, each, n) for each in candidates])

    start = np.array([[rng.integers(axis.count) for axis in space.axes] for _ in range(size)], np.float64)
    corners = np.linspace(0.0, 1.0, size)
    for at, axis in enumerate(space.axes):  # a Latin hypercube: every part of a range is looked at
        start[:, at] = np.rint(rng.permutation(corners) * (axis.count - 1))
    if first is not None:
        start[0] = [axis.number(value) or 0 for axis, value in zip(space.axes, first, strict=True)]
    differential_evolution(
        energies,
        [(0, axis.count - 1 if axis.count > 1 else 1e-9) for axis in space.axes],
        init=np.unique(start, axis=0) if len(np.unique(start, axis=0)) > 4 else start,
        maxiter=generations,
        tol=0.0,
        polish=False,
        updating="deferred",
        vectorized=True,
        integrality=[not axis.fine and axis.count > 1 for axis in space.axes],
        rng=rng,
    )


def _energy(tried: Tried, space: Space, candidate: Values, n: int) -> float:
    """Return a number that is less for a better candidate: of those that miss a requirement, larger than any goal."""
    if not space.allows(candidate):
        return _UNREACHED * (2.0 + min(space.excess(candidate), 1e50))
    meets, rank = tried.standing(candidate, n).rank
    if meets:
        return -rank
    return _UNREACHED * (1.0 + min(-rank, 1e90) / (1.0 + min(-rank, 1e90)))


def _slide(tried: Tried, space: Space, best: Standing, n: int, share: float, most: int) -> Standing:
    """Move along the edge of what is required, where steps along the axes find nothing better, over n trials each.

    Only decisions that may have any value move. SciPy's COBYLA has linear models of goal and requirements.
    """
    from scipy.optimize import minimize

    moving = [number for number, axis in enumerate(space.axes) if axis.fine]
    if not moving or not best.meets:
        return best
    start = [axis.number(value) or 0 for axis, value in zip(space.axes, best.candidate, strict=True)]
    ranges = np.array([space.axes[number].count - 1.0 for number in moving])
    scale, met = max(abs(best.goal.error), 1e-300), {best.candidate: None}

    def standing(at: NDArray[np.float64]) -> Standing:
        numbers = [*start]
        for number, value in zip(moving, np.rint(np.clip(at, 0.0, 1.0) * ranges), strict=True):
            numbers[number] = int(value)
        candidate = space.candidate(numbers)
        tried.extend([candidate], n)
        met[candidate] = None
        return tried.standing(candidate, n)

    def slacks(at: NDArray[np.float64]) -> NDArray[np.float64]:
        result = standing(at)
        edges = [*at, *(1.0 - at)]
        return np.array([*(_beyond_margin(each) for each in result.slacks), *edges])

    minimize(
        lambda at: -standing(at).goal.value / scale,
        np.array([start[number] for number in moving]) / ranges,
        method="COBYLA",
        constraints=[{"type": "ineq", "fun": slacks}],
        options={"rhobeg": share / 2.0, "maxiter": max(most, len(moving) + 2)},
        tol=share / 16.0,
    )
    return max((tried.standing(each, n) for each in met), key=lambda results: results.rank)


def _beyond_margin(slack: Measured) -> float:
    """Return by how many errors a requirement holds beyond its margin; of decisions alone, by how much."""
    if math.isnan(slack.value) or math.isinf(slack.error):
        return -1e6
    return slack.value / slack.error - MARGIN if slack.error else slack.value


def _step_by_step(tried: Tried, space: Space, best: Standing, n: int, share: float, seed: int) -> Standing:
    """Move to better neighbours, in steps that become smaller, over n trials each; gives where it ends."""
    at = [axis.number(value) or 0 for axis, value in zip(space.axes, best.candidate, strict=True)]
    rng = np.random.default_rng(np.random.SeedSequence([seed, n]))
    steps = [max(1, round(share * axis.count)) if axis.ordered else 1 for axis in space.axes]
    finest = [max(1, round(share / 4 * axis.count)) if axis.fine else 1 for axis in space.axes]
    known = best.rank
    while True:
        moved = False
        neighbours = {space.candidate(each): each for each in _neighbours(at, steps, space, rng)}
        allowed = [each for each in neighbours if space.allows(each)]
        if allowed:
            standing = tried.standings(allowed, n)[0]
            if standing.rank > known:
                at, known, moved = neighbours[standing.candidate], standing.rank, True
        if not moved:
            if all(step <= least for step, least in zip(steps, finest, strict=True)):
                return tried.standing(space.candidate(at), n)
            steps = [max(least, step // 2) for step, least in zip(steps, finest, strict=True)]


def _neighbours(at: Sequence[int], steps: Sequence[int], space: Space, rng: np.random.Generator) -> Iterator[list[int]]:
    """Yield what lies a step away: along each axis, and along two of them together."""
    moves: list[list[tuple[int, int]]] = []
    for number, axis in enumerate(space.axes):
        if axis.ordered:
            moves.append([(number, at[number] + side * steps[number]) for side in (-1, 1)])
        else:
            others = [each for each in range(axis.count) if each != at[number]]
            moves.append([(number, each) for each in (others if len(others) < 9 else rng.choice(others, 8, False))])
    pairs = [*combinations(moves, 2)]
    if len(moves) > _PAIRED:
        pairs = [pairs[each] for each in rng.choice(len(pairs), _PAIRED * 6, replace=False)]
    for several in [*([each] for one in moves for each in one), *([a, b] for x, y in pairs for a in x for b in y)]:
        result = list(at)
        for number, value in several:
            result[number] = min(max(int(value), 0), space.axes[number].count - 1)
        if result != list(at):
            yield result
