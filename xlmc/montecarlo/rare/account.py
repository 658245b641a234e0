"""What was done where accepted trials are rare, and how well it went: the same words on paper, sheet and screen."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from xlmc.montecarlo.number_text import count_text, counted_text, fixed_text, number_text
from xlmc.montecarlo.statistics import Estimate, format_estimate

__all__ = ["RareAccount", "probability_text"]

MOST_LOST: Final = 0.001
"""Above this share of trials lost to errors the answer must not be used as it is, as of plain trials."""

MOST_MISSED: Final = 0.01
"""A share of the probability of acceptance: if more was met and not found, a warning says so."""

LEAST_CHANCE: Final = 1e-3
"""If the chance of so many accepted plain trials is below this, they are no coincidence."""

MOST_APART: Final = math.log(2.0)
"""Two estimates of the probability of acceptance, as logarithms: the first is known to some tenths, and less well where
the populations of several strata share its points."""


@dataclass(frozen=True, slots=True)
class RareAccount:
    """How the accepted trials of a run were found.

    Attributes:
        evaluations: trials in all, plain ones with them.
        learning: of them, to find the region and describe it.
        proposals: of them, independent draws from what was learned.
        proposals_accepted: of those, by the filters.
        kept: of those, with equal weight.
        fresh: of the proposals, those that say how likely acceptance is.
        acceptance: the probability that a plain trial is accepted.
        effective: (Σw)²/Σw² of the accepted ones among those, w being their weights.
        size: the effective sample size of the kept ones: a few stand more than once.
        searched: the same probability as the populations had it that found the region by splitting.
        levels: distances from acceptance that these went through.
        components, directions: of the mixture of normal distributions that was learned.
        dimensions: assumptions that are drawn.
        lost: of all but the plain trials, those in which a filter or a draw is an error.
        plain: of the evaluations, plain trials before the search.
        plain_accepted: of those, by the filters.
        checked: of the evaluations, those from widened assumptions after the search, to look for what it missed.
        missed: the probability of accepted trials that were met so, or among the plain ones, and that the proposals
            hardly ever come to.
        ways: the number of strata: parts of all trials, by branches and discrete assumptions, searched apart.
        explored: the probability of parts that splitting did not find, and that other accepted trials led to.
        solved: the assumptions that thin layers were solved for.
        faulty: of the kept ones, those in which a forecast is an error; known when the run has evaluated them.
    """

    evaluations: int
    learning: int
    proposals: int
    proposals_accepted: int
    fresh: int
    kept: int
    acceptance: Estimate
    effective: float
    size: float
    searched: float
    levels: int
    components: int
    directions: int
    dimensions: int
    lost: int
    plain: int
    plain_accepted: int
    checked: int
    missed: float
    ways: int
    explored: float
    solved: tuple[str, ...]
    faulty: int = 0

    @property
    def at_least(self) -> bool:
        """Whether the probability of acceptance is known from below only: a part of the region is missing."""
        return self.missed > MOST_MISSED * self.acceptance.value or self.implausible

    @property
    def implausible(self) -> bool:
        """Whether more plain trials were accepted than the upper end of the interval lets expect."""
        most = (self.acceptance.interval or (0.0, self.acceptance.value))[1]
        return _chance_of_more(self.plain_accepted, self.plain * most) < LEAST_CHANCE

    @property
    def plain_trials(self) -> float:
        """The trials that plain rejection would have needed, on average."""
        return self.kept / self.acceptance.value

    @property
    def method(self) -> str:
        """The method in a few words."""
        return "rejection from a learned proposal: independent trials of equal weight"

    @property
    def sentence(self) -> str:
        """What was done."""
        directions = f"{self.directions} of {self.dimensions} directions"
        return (
            f"About {_about(self.plain_trials)} plain trials would have been needed to accept as many. So the search "
            f"learned from {count_text(self.learning)} trials where accepted trials lie (by splitting, "
            f"in {self.levels} levels"
            f"{self._apart}{self._solved_for}; then by a mixture of {self.components} normal distributions in "
            f"{directions}). It drew {count_text(self.proposals)} further trials there. "
            f"{count_text(self.proposals_accepted)} of them pass "
            "all filters, and each of these was kept with a chance that gives all kept trials equal weight. The "
            f"{count_text(self.kept)} kept trials are independent, and distributed as those that plain "
            "trials would have left "
            f"(effective sample size {fixed_text(self.size, 0)}, because a few occur more than once). "
            f"{self._of_acceptance}No "
            "method can rule out that a separate part of the accepted region was not found."
        )

    @property
    def _apart(self) -> str:
        return f", in {self.ways} strata by branches and discrete assumptions" if self.ways > 1 else ""

    @property
    def _solved_for(self) -> str:
        """The filters say what these must be, all others given."""
        return f", with the filters solved for {' and '.join(map(repr, self.solved))}" if self.solved else ""

    @property
    def _of_acceptance(self) -> str:
        if not self.fresh:
            return ""
        return (
            f"The probability of acceptance comes from {count_text(self.fresh)} trials that were drawn "
            "after enough had been "
            "kept; their number was fixed beforehand. "
        )

    @property
    def _disagree(self) -> bool:
        """Whether splitting has much more than was drawn, or, where it is all that led there, much less."""
        factor = math.exp(MOST_APART * math.sqrt(self.ways))
        fewer = not self.explored and self.searched * factor < self.acceptance.value
        return fewer or self.searched > factor * self.acceptance.value

    @property
    def warnings(self) -> list[str]:
        """Why the answer must not be used as it is."""
        result = []
        if self._disagree:
            result.append(
                "the search for rare trials has a probability of acceptance of "
                f"{number_text(self.searched, 2)}, and the trials "
                f"that it led to have {number_text(self.acceptance.value, 2)}: part of the accepted "
                "region may be missing"
            )
        if self.missed > MOST_MISSED * self.acceptance.value:
            result.append(
                "accepted trials were met in a part of the region that the search could not describe: "
                f"the probability of acceptance is at least {number_text(self.acceptance.value, 2)}, "
                "and that part, from which "
                f"there are no trials here, may add {number_text(self.missed, 2)}"
            )
        if self.implausible:
            result.append(
                f"of {counted_text(self.plain, 'plain trial')} {count_text(self.plain_accepted)} "
                f"{'was' if self.plain_accepted == 1 else 'were'} accepted, where "
                f"{number_text(self.plain * self.acceptance.value, 2)} were to be expected: the "
                "probability of acceptance is at "
                f"least {number_text(self.acceptance.value, 2)}, and part of the accepted region is missing"
            )
        rare = self.learning + self.proposals + self.checked
        if self.lost > MOST_LOST * rare:
            result.append(
                f"{count_text(self.lost)} of the {count_text(rare)} trials of the search were lost to errors in cells"
            )
        if self.faulty > MOST_LOST * self.kept:
            result.append(
                f"a forecast is an error in {count_text(self.faulty)} of the {count_text(self.kept)} accepted trials"
            )
        return result


def probability_text(account: RareAccount) -> str:
    """`(1.002 ± 0.004)e-06`, or `at least` that."""
    text = format_estimate(account.acceptance.value, account.acceptance.error)
    return f"at least {text}" if account.at_least else text


def _chance_of_more(count: int, expected: float) -> float:
    """P(K ≥ count) of a Poisson count."""
    from scipy.special import pdtrc

    return float(pdtrc(count - 1, expected)) if count else 1.0


def _about(count: float) -> str:
    """Two digits of it."""
    if not math.isfinite(count):
        return "more than can be counted"
    size = 10 ** max(0, int(math.log10(count)) - 1)
    return count_text(round(count / size) * size)
