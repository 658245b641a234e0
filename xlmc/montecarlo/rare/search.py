"""From a model to accepted trials where these are rare: the search, its trials as blocks, and the account of it."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.loop.blocks import Block, ModelRunner, Task
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.rare.account import RareAccount
from xlmc.montecarlo.rare.layered import Layered, SearchSpace, search_space_of
from xlmc.montecarlo.rare.learning import Learned, Round, Say, count_on, learn, learn_again, search_on
from xlmc.montecarlo.rare.limit_state_function import GivenUniforms, LimitStateFunction
from xlmc.montecarlo.rare.rare_switch import SEARCH_PART, search_limit
from xlmc.montecarlo.rare.resampling import Accepts, Resampled, resample
from xlmc.montecarlo.rare.splitting import Distance
from xlmc.montecarlo.rare.unexplained import Evidence, Tempered, plain_assumptions, wide_assumptions
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.statistics.estimate import Estimate, with_relative_error

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Search", "SearchResult", "accepted_blocks", "find", "plain_uniforms", "search"]

_AGAIN: Final = 3
"""Times that a proposal is learnt anew because a trial was much heavier than any known."""

_SURVEY: Final = 65_536
"""Trials from the widened assumptions, before and after."""

_BATCH: Final = 8_192
"""Trials of a survey that are drawn at a time."""

_LOOKED_AT: Final = 32
"""A survey takes at most one in this many of the limit's trials."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchResult:
    """What came of it.

    Attributes:
        learned: what the search found.
        used: the round whose proposal the trials come from; otherwise None.
        resampled: the trials; None likewise.
        checked: trials that were drawn from the widened assumptions afterwards.
        unexplained: accepted trials of other origin that the proposal hardly ever draws.
        evaluations: trials that all this took.
    """

    learned: Learned
    used: Round | None
    resampled: Resampled | None
    evaluations: int
    checked: int = 0
    unexplained: Evidence | None = None


def find(
    distance: Distance,
    accepts: Accepts,
    dimensions: int,
    wanted: int,
    most: int,
    learning: np.random.Generator,
    drawing: np.random.Generator,
    say: Say = lambda _: None,
    plain: Sequence[Evidence] = (),
    strata: Sequence[Distance] = (),
) -> SearchResult:
    """Draw `wanted` accepted trials of equal weight.

    Args:
        distance: 0 where a point of `dimensions` standard normals is accepted.
        accepts: where that is so; it may be faster.
        dimensions: of the points.
        wanted: trials.
        most: evaluations, of which learning takes what it needs.
        learning: random numbers to learn with.
        drawing: others, to draw the trials with: what they come from must not have served to learn.
        say: called with the evaluations so far.
        plain: trials from before the search.
        strata: see `learn`.
    """
    spread, checked, trials = wide_assumptions(dimensions), 0, min(_SURVEY, most // _LOOKED_AT)
    first = _survey(accepts, spread, trials, learning)
    before = first.trials
    learned = learn(distance, dimensions, learning, count_on(before, say), most - before, (*plain, first), strata)
    for tries_left in range(_AGAIN, -1, -1):
        used, done = learned.best, learned.evaluations + before
        if used is None or wanted > used.rate * (most - done):
            return SearchResult(learned, None, None, done, checked)
        drawn = resample(
            accepts,
            used.proposal,
            used.envelope,
            learned.unevenness(used),
            wanted,
            most - done,
            drawing,
            count_on(done, say),
            surprises=tries_left > 0,
        )
        if drawn.surprise is not None:
            before += drawn.proposals
            learned = learn_again(distance, learned, drawn.surprise, learning, count_on(before, say), most - before)
            continue
        check = _survey(accepts, spread, trials, drawing)
        checked += check.trials
        missed = learned.unexplained(used.proposal, (*plain, check))
        if not tries_left or not missed.tells(drawn.acceptance.value):
            break
        before += drawn.proposals + check.trials
        learned = search_on(distance, learned, missed, learning, count_on(before, say), most - before)
    return SearchResult(learned, used, drawn, done + drawn.proposals + check.trials, checked, missed)


def _survey(accepts: Accepts, spread: Tempered, trials: int, random: np.random.Generator) -> Evidence:
    """Trials from the widened assumptions."""
    result = list[Floats]()
    for start in range(0, trials, _BATCH):
        points = spread.draw(min(_BATCH, trials - start), random)
        result.append(points[accepts(points)])
    return Evidence.of(spread, trials, np.concatenate(result))


Floats = NDArray[np.float64]

_PURPOSE: Final = "rare acceptance: "

_MOST_PLAIN: Final = 4_096
"""Accepted plain trials that are looked at: the first of them."""


@dataclass(frozen=True, slots=True, eq=False)
class Search:
    """What came of a search.

    Attributes:
        uniforms: (m, d) of accepted trials of equal weight; none where it failed.
        account: None likewise.
        failure: why there are none, in words without a full stop.
        evaluations: trials that it took.
    """

    uniforms: Floats
    account: RareAccount | None
    failure: str
    evaluations: int


def search(
    model: CompiledModel, settings: Settings, plain: int, accepted: NDArray[np.int64], say: Callable[[int], None]
) -> Search:
    """Look for as many accepted trials as the settings ask for; a pure function of the model and these.

    Args:
        model: with filters and drawn assumptions.
        settings: of the run.
        plain: trials that were run before, which count towards the limit.
        accepted: (k,) the numbers of those among them that were accepted.
        say: called with the evaluations so far.
    """
    learning, drawing = _random(settings.seed, "learning"), _random(settings.seed, "drawing")
    function = search_space_of(model, LimitStateFunction(model, learning), _random(settings.seed, "layers"))
    wanted, most = settings.stopping.accepted or 0, search_limit(settings.trials, plain)
    independent = METHODS[settings.sampling].independent
    evidence = [_plain(model, settings, plain, accepted, function)] if independent else []
    result = find(
        function.distance,
        function.accepts,
        function.dimensions,
        wanted,
        most,
        learning,
        drawing,
        say,
        evidence,
        function.strata,
    )
    drawn = result.resampled
    if drawn is None or result.used is None or len(drawn.points) < wanted:
        failure = _failure(model, function, result, wanted, settings.trials - plain - most)
        return Search(np.empty((0, function.dimensions)), None, failure, function.evaluations)
    proposal = result.used.proposal
    account = RareAccount(
        evaluations=plain + function.evaluations,
        learning=function.evaluations - drawn.proposals - result.checked,
        proposals=drawn.proposals,
        proposals_accepted=drawn.accepted,
        fresh=drawn.fresh,
        kept=len(drawn.points),
        acceptance=_acceptance(drawn, result.unexplained),
        effective=drawn.effective,
        size=drawn.size,
        searched=result.learned.searched,
        explored=result.learned.explored,
        levels=max(len(each.levels) for each in result.learned.descents),
        components=proposal.mixture.shares.size,
        directions=proposal.directions,
        dimensions=function.dimensions,
        lost=function.lost,
        plain=plain,
        plain_accepted=accepted.size,
        checked=result.checked,
        ways=len(function.strata),
        missed=0.0 if result.unexplained is None else result.unexplained.mass,
        solved=tuple(layer.name for layer in function.layers) if isinstance(function, Layered) else (),
    )
    return Search(function.uniforms(drawn.points), account, "", function.evaluations)


def _plain(
    model: CompiledModel, settings: Settings, trials: int, accepted: NDArray[np.int64], function: SearchSpace
) -> Evidence:
    """Return the plain trials, or the first of them where many were accepted."""
    few = accepted[:_MOST_PLAIN]
    counted = int(few[-1]) + 1 if few.size < accepted.size else trials
    points = function.points(plain_uniforms(model, settings.seed, few))
    return Evidence.of(plain_assumptions(function.dimensions), counted, points[function.accepts(points)])


def _acceptance(drawn: Resampled, unexplained: Evidence | None) -> Estimate:
    """Return the probability of acceptance, with the mass of what the proposal hardly ever comes to as a
    further error.
    """
    estimate = drawn.acceptance
    if unexplained is None or not len(unexplained.points) or estimate.error is None or estimate.n is None:
        return estimate
    error = math.hypot(estimate.error, unexplained.mass)
    return with_relative_error(estimate.value, error, drawn.effective - 1.0, 0.95, estimate.n)


def _random(seed: int, purpose: str) -> np.random.Generator:
    """Random numbers that no other part of a run uses."""
    words = np.frombuffer(hashlib.sha256(f"{_PURPOSE}{purpose}".encode()).digest(), dtype="<u4").tolist()
    return np.random.Generator(np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=words)))


def _failure(model: CompiledModel, function: SearchSpace, result: SearchResult, wanted: int, left: int) -> str:
    """Why there are no trials, in words."""
    reached = [each for each in result.learned.descents if each.reached]
    if not reached:
        nearest = np.stack([each.nearest for each in result.learned.descents])
        index = int(np.argmin(function.distance(nearest)))
        lengths = function.by_filter(nearest[index : index + 1])
        names = [repr(f.name) for f, (length,) in zip(model.filters, lengths, strict=True) if length > 0.0]
        return (
            f"a search of {count_text(result.evaluations)} trials found none that the filters accept: "
            "the nearest one still "
            f"fails {' and '.join(names)}, so the filters contradict each other or the assumptions, or accept less "
            "than one trial in 10¹⁵"
        )
    share = f"about {number_text(result.learned.probability, 1)} of all trials are accepted"
    if result.used is None and result.learned.best is None:
        return (
            f"a search of {count_text(result.evaluations)} trials found that {share}, but could not "
            "describe where they lie"
        )
    more = f"the part of the limit (-n) that a search may take, one in {SEARCH_PART}" if left else "the limit (-n)"
    return (
        f"a search of {count_text(result.evaluations)} trials found that {share}, described badly where "
        "they lie, and gave up, "
        f"as {count_text(wanted)} of them would take more than {more},"
    )


def accepted_blocks(
    model: CompiledModel, uniforms: Floats, block: int, wants_inputs: Callable[[], bool]
) -> Iterator[Block]:
    """Yield the trials at accepted uniforms, evaluated and filtered like any others: no filter is taken for granted."""
    given = GivenUniforms()
    given.uniforms = uniforms
    sampler = model.sampler(0, block, filler=given.filler)
    evaluator = model.program("numpy").evaluator(block)
    runner = ModelRunner(sampler, evaluator, block, len(model.forecasts), model.fallible, model.categories)
    for start in range(0, len(uniforms), block):
        count = min(block, len(uniforms) - start)
        yield runner.run(Task(start, count, prior=False, inputs=wants_inputs()))


def plain_uniforms(model: CompiledModel, seed: int, accepted: NDArray[np.int64]) -> Floats:
    """(k, d) the uniforms of plain trials with these numbers, (k,)."""
    streams = model.sampler(seed, 1).streams
    uniforms = np.empty((len(streams), accepted.size))
    for row, stream in zip(uniforms, streams, strict=True):
        for index, trial in enumerate(accepted.tolist()):
            stream.uniforms(trial, row[index : index + 1])
    return uniforms.T
