"""Which candidate is best: ranking and selection over growing samples, and how sure that is.

Trials go where candidates cannot yet be told apart: those that are clearly worse than the best over the same trials, or
clearly miss a requirement, are left behind, and the others get twice as many. What is chosen by trials looks better in
them than it is. So it is judged by fresh ones: other random numbers than those that it was chosen by.

The confidence: with b the chosen candidate, d the indifference and k any other, the probabilities that k is better than
b by more than d are added up over all candidates that were tried, those that are compared by fresh trials by these.
Whatever depends on what, the probability that any of them is, is no more than the sum (Bonferroni). Goldsman and Nelson
1998, "Comparing systems via simulation", Handbook of Simulation, chapter 8, has the ideas.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final

import numpy as np

from xlmc.analysis.studies.optimising.candidates import SURE, Ended, Standing, Tried
from xlmc.montecarlo.loop.candidates import Values
from xlmc.montecarlo.number_text import count_text

__all__ = ["Rival", "indifference_of", "judged", "leader", "race", "rivals_of"]

_ROUND: Final = 0.15
"""The part of the trials that are left that one round may take."""
_FRESH: Final = 16
"""Candidates that are compared with the best by fresh trials, at most."""
_MORE: Final = 8
"""Multiples of a run's trials that a candidate gets at most where they cannot be told apart."""
_SPREAD_SHARE: Final = 0.01
_UNLIKELY: Final = 1e-5
_SURE_ENOUGH: Final = 0.975

_chance = NormalDist().cdf


@dataclass(frozen=True, slots=True)
class Rival:
    """Another candidate, compared with the best.

    Attributes:
        ahead: by how much it is better, in the unit of the goal; below 0 where it is worse.
        error: of that.
        chance: the probability that it meets the requirements and is better by more than the indifference.
        trials: over which.
        meets: whether it meets the requirements, as surely as the best must.
    """

    candidate: Values
    ahead: float
    error: float
    chance: float
    trials: int
    meets: bool

    @property
    def significant(self) -> bool:
        """Whether it is worse, or better, by three standard errors or more."""
        return abs(self.ahead) >= 3.0 * self.error and self.ahead != 0.0


def leader(tried: Tried) -> Standing:
    """Return the candidate that stands best, of those with half as many trials as any has, or more."""
    most = max(map(tried.length, tried.columns))
    known = [tried.standing(each) for each in tried.columns if 2 * tried.length(each) >= most]
    best = max(known, key=lambda each: each.rank)
    if best.meets:
        return best
    return max((tried.standing(each) for each in tried.columns), key=lambda each: (each.meets, each.n, each.rank))


def indifference_of(tried: Tried, first: Sequence[Values], n: int, trials: int) -> float:
    """Return a difference too small to matter: 1 % of that between the best candidate and a middling one of the first
    ones, and not less than two errors of the best one's goal in a run.
    """
    known = tried.standings(first, n)
    meeting = [each.goal.value for each in known if each.meets] or [each.goal.value for each in known]
    values = np.array([value for value in meeting if math.isfinite(value)])
    if not values.size:
        return 0.0
    error = known[0].goal.error * math.sqrt(n / trials)
    return max(_SPREAD_SHARE * float(values.max() - np.median(values)), 2.0 * error if math.isfinite(error) else 0.0)


def race(tried: Tried, indifference: float, trials: int, tell: Callable[[str], None]) -> None:
    """Give more trials to the candidates that may be better than the best, until they are told apart.

    In each round those get twice as many that are the likeliest to be better by more than the indifference.

    Raises:
        Ended: the trials are spent, or somebody asked to stop.
    """
    while True:
        best = leader(tried)
        rivals = rivals_of(tried, best.candidate, indifference, trials)
        doubt = math.fsum(each.chance for each in rivals)
        if doubt <= 1.0 - _SURE_ENOUGH and best.n >= trials:
            return
        unsure = [each.candidate for each in rivals if each.chance > _UNLIKELY]
        unsure = [each for each in unsure if tried.length(each) < _MORE * trials]
        tell(f"telling {count_text(len(unsure))} candidates from the best, which has {count_text(best.n)} trials")
        if not unsure and best.n >= trials:
            return
        room, longest = _ROUND * (tried.most - tried.trials.computed), 0
        for number, candidate in enumerate(unsure):
            n = tried.length(candidate)
            room -= n
            if room < 0.0 and number:
                break
            tried.extend([candidate], 2 * n)
            longest = max(longest, 2 * n)
        tried.extend([best.candidate], max(longest, min(2 * best.n, trials)))


def _rival(tried: Tried, best: Values, other: Values, indifference: float, trials: int) -> Rival:
    ahead, error = tried.better(best, other)
    standing = tried.standing(other)
    sureness, n = standing.sureness, standing.n
    unknown = math.isnan(ahead)  # too few trials count: more of them may tell
    chance = float(min(tried.length(best), n) < trials) if unknown else _exceeds(ahead, error, indifference)
    if not math.isinf(sureness):  # the probability that so many trials would show that it meets the requirements
        chance = min(chance, _chance(sureness - SURE * math.sqrt(min(n / trials, 1.0))))
    elif sureness < 0.0:
        chance = 0.0
    return Rival(other, ahead, error, chance, min(tried.length(best), n), meets=sureness >= SURE)


def _exceeds(ahead: float, error: float, indifference: float) -> float:
    """Return the probability that a difference is larger than the indifference."""
    if not error:
        return float(ahead > indifference)
    return 1.0 if math.isinf(error) else _chance((ahead - indifference) / error)


def rivals_of(tried: Tried, best: Values, indifference: float, trials: int) -> list[Rival]:
    """Return all other candidates that were tried, those first that are most likely better."""
    rivals = [_rival(tried, best, each, indifference, trials) for each in tried.columns if each != best]
    return sorted(
        rivals, key=lambda each: (each.chance if each.chance > _UNLIKELY else 0.0, each.meets, each.ahead), reverse=True
    )


def judged(
    fresh: Tried, best: Values, rivals: Sequence[Rival], indifference: float, trials: int
) -> tuple[list[Rival], float]:
    """Compare the best with the most likely rivals by fresh trials; their number is doubled where they do not suffice.

    Returns:
        The rivals by fresh trials, and the confidence that no candidate is better by more than the indifference.
    """
    few, others = rivals[:_FRESH], rivals[_FRESH:]
    doubt = math.fsum(each.chance for each in others)
    names = [each.candidate for each in few]
    fresh.extend([best, *names], trials)
    result = {each: _fresh_rival(fresh, best, each, indifference, trials) for each in names}
    n = trials
    try:
        while math.fsum(each.chance for each in result.values()) + doubt > 1.0 - _SURE_ENOUGH and n < _MORE * trials:
            unsure = [each for each in result if result[each].chance > _UNLIKELY]
            n *= 2
            fresh.extend([best, *unsure], n)
            result |= {each: _fresh_rival(fresh, best, each, indifference, trials) for each in unsure}
    except Ended:
        pass
    confidence = max(0.0, 1.0 - math.fsum(each.chance for each in result.values()) - doubt)
    known = (each for each in result.values() if not math.isnan(each.ahead))
    return sorted(known, key=lambda each: (each.meets, each.ahead), reverse=True), confidence


def _fresh_rival(fresh: Tried, best: Values, other: Values, indifference: float, trials: int) -> Rival:
    """Compare over fresh trials: one that does not meet the requirements as surely as the best must is no rival."""
    rival = _rival(fresh, best, other, indifference, trials)
    return rival if rival.meets else Rival(other, rival.ahead, rival.error, 0.0, rival.trials, meets=False)
