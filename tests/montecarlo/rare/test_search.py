"""The whole search on half-lines whose probability is known, and what it says where it fails."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.definitions.run_settings import Settings
from xlmc.montecarlo.definitions.stopping import AcceptedTrials, Stopping
from xlmc.montecarlo.rare import search as module
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction
from xlmc.montecarlo.rare.search import accepted_blocks, find, plain_uniforms, search
from xlmc.montecarlo.rare.unexplained import plain_assumptions
from xlmc.montecarlo.statistics import Estimate

LIMIT = 4.0


@pytest.fixture(autouse=True)
def small_surveys(monkeypatch):
    monkeypatch.setattr(module, "_SURVEY", 4_096)
    monkeypatch.setattr(module, "_BATCH", 1_000)


def beyond(points):
    return np.maximum(LIMIT - points[:, 0], 0.0)


def accepts(points):
    return points[:, 0] >= LIMIT


def searched(wanted, most, **more):
    said = []
    generators = np.random.default_rng(3), np.random.default_rng(4)
    return find(beyond, accepts, 2, wanted, most, *generators, said.append, **more), said


def test_trials_are_found_and_counted():
    result, said = searched(500, 10**7)
    truth = stats.norm.sf(LIMIT)
    assert len(result.resampled.points) == 500
    assert accepts(result.resampled.points).all()
    assert abs(result.resampled.acceptance.value - truth) < 5 * result.resampled.acceptance.error
    assert result.used in result.learned.rounds
    assert result.checked == 4_096
    assert result.evaluations == result.learned.evaluations + result.resampled.proposals + 2 * 4_096
    assert said == sorted(said)
    assert said[-1] == result.evaluations - 4_096  # the survey afterwards comes last
    assert result.unexplained.mass < 0.05 * truth
    tail = stats.truncnorm(LIMIT, np.inf)
    assert stats.kstest(result.resampled.points[:, 0], tail.cdf).pvalue > 1e-4


@pytest.mark.parametrize(("wanted", "most"), [(10**9, 10**6), (500, 40_000)])
def test_no_trials_where_they_would_take_too_many(wanted, most):
    result, _ = searched(wanted, most)
    assert (result.used, result.resampled, result.unexplained, result.checked) == (None, None, None, 0)
    assert result.evaluations > 0
    assert result.learned.probability > 0


def test_surveys_are_a_part_of_the_limit():
    """One in 32 of 64,000 trials is 2,000: two batches."""
    asked = []

    def counting(points):
        asked.append(len(points))
        return accepts(points)

    find(beyond, counting, 2, 10**9, 64_000, np.random.default_rng(3), np.random.default_rng(4))
    assert asked == [1_000, 1_000]


def test_a_survey_weighs_its_trials():
    evidence = module._survey(accepts, plain_assumptions(2), 2_500, np.random.default_rng(1))
    assert evidence.trials == 2_500
    everything = module._survey(lambda points: points[:, 0] < 9, plain_assumptions(2), 2_500, np.random.default_rng(1))
    assert len(everything.points) == 2_500
    assert everything.mass == pytest.approx(1.0)


def test_random_numbers_of_their_own():
    one, again, other, seed = (module._random(*each).random(4).tolist() for each in
                               ((5, "learning"), (5, "learning"), (5, "drawing"), (6, "learning")))  # fmt: skip
    assert one == again
    assert len({tuple(each) for each in (one, other, seed)}) == 3


def test_what_is_hardly_ever_drawn_is_a_further_error():
    drawn = SimpleNamespace(acceptance=Estimate(0.5, 0.03, (0.4, 0.6), 900), effective=101.0)
    plain = module._acceptance(drawn, None)
    assert plain is drawn.acceptance
    empty = SimpleNamespace(points=np.empty((0, 1)), mass=0.04)
    assert module._acceptance(drawn, empty) is drawn.acceptance
    more = module._acceptance(drawn, SimpleNamespace(points=np.ones((3, 1)), mass=0.04))
    assert (more.value, more.n) == (0.5, 900)
    assert more.error == pytest.approx(0.05)
    t = stats.t.ppf(0.975, 100)
    assert more.interval == pytest.approx((0.5 * math.exp(-t * 0.1), 0.5 * math.exp(t * 0.1)))
    unknown = SimpleNamespace(acceptance=Estimate(0.0, n=9), effective=0.0)
    assert module._acceptance(unknown, SimpleNamespace(points=np.ones((3, 1)), mass=0.04)) is unknown.acceptance


CELLS = {"A1": 0.0, "A2": 0.0, "B1": "=A1+A2", "B2": "=A1*100"}
GIVEN = {
    "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
    "b": {"cell": "A2", "low": 0, "high": 1},
}


@pytest.fixture
def model(book):
    """`model(filters)`: of a normal a in A1 and a uniform b in A2, with forecasts of their sum and of 100 a."""
    return lambda filters: book(CELLS, GIVEN, {"sum": "B1", "hundred": "B2"}, filters)


def settings(accepted, **more):
    return Settings(seed=7, stopping=Stopping(AcceptedTrials(accepted)), **more)


def test_a_search_of_a_model(model):
    """a at least 3.5, beside two plain trials of which one was accepted; the account adds up."""
    made = model({"f": {"cell": "A1", "at_least": 3.5}})
    result = search(made, settings(300, trials=1 << 23), 2, np.array([1]), lambda _: None)
    account, truth = result.account, stats.norm.sf(3.5)
    assert result.failure == ""
    assert result.uniforms.shape == (300, 2)
    row = made.sampler(0, 1).row_of["a"]
    assert (stats.norm.ppf(result.uniforms[:, row]) >= 3.5).all()
    assert abs(account.acceptance.value - truth) < 5 * account.acceptance.error
    assert account.evaluations == result.evaluations + 2
    assert account.evaluations == 2 + account.learning + account.proposals + account.checked
    assert (account.kept, account.dimensions, account.plain, account.plain_accepted) == (300, 2, 2, 1)
    assert (account.lost, account.ways, account.solved) == (0, 1, ())
    assert account.searched + account.explored == pytest.approx(truth, rel=0.7)
    again = search(made, settings(300, trials=1 << 23), 2, np.array([1]), lambda _: None)
    assert again.uniforms.tolist() == result.uniforms.tolist()


def test_a_search_that_fails(model):
    made = model({"f": {"cell": "A1", "at_least": 9.0}, "g": {"cell": "A1", "at_most": 8.0}})
    result = search(made, settings(300, trials=1 << 23), 0, np.empty(0, np.int64), lambda _: None)
    assert result.account is None
    assert result.uniforms.shape == (0, 2)
    assert "so the filters contradict each other" in result.failure


@pytest.mark.parametrize(("accepted", "counted"), [(3, 50), (4, 50), (6, 31)])
def test_plain_trials_up_to_the_last_that_is_looked_at(model, random, monkeypatch, accepted, counted):
    """Every tenth of 50 was accepted; of more than four, these are of the first 31 trials."""
    monkeypatch.setattr(module, "_MOST_PLAIN", 4)
    made = model({"f": {"cell": "A1", "at_least": -9.0}})
    numbers = 10 * np.arange(accepted)
    evidence = module._plain(made, settings(300), 50, numbers, LimitStateFunction(made, random))
    assert evidence.trials == counted
    assert len(evidence.points) == min(accepted, 4)


def test_failures_in_words():
    descents = SimpleNamespace(reached=False, nearest=np.array([3.0]))
    lengths = [np.array([2.0]), np.array([0.0]), np.array([1.0])]
    function = SimpleNamespace(distance=lambda points: points[:, 0], by_filter=lambda points: lengths)
    made = SimpleNamespace(filters=[SimpleNamespace(name=name) for name in ("x", "y", "z")])
    result = SimpleNamespace(learned=SimpleNamespace(descents=[descents]), evaluations=12_345)
    text = module._failure(made, function, result, 10, 0)
    assert "a search of 12,345 trials found none" in text
    assert "still fails 'x' and 'z', so" in text
    learned = SimpleNamespace(descents=[SimpleNamespace(reached=True)], probability=2e-7, best=None)
    result = SimpleNamespace(learned=learned, evaluations=12_345, used=None)
    assert "could not describe where they lie" in module._failure(made, function, result, 10, 0)
    learned.best = "a round"
    assert "10 of them would take more than the limit (-n)" in module._failure(made, function, result, 10, 0)
    text = module._failure(made, function, result, 10, 5)
    assert "the part of the limit (-n) that a search may take, one in 16" in text


def test_trials_at_accepted_uniforms(model):
    """Evaluated block by block, and filtered again: the second is not accepted."""
    made = model({"f": {"cell": "A1", "at_least": 0.0}})
    rows = made.sampler(0, 1).row_of
    uniforms = np.empty((3, 2))
    uniforms[:, rows["a"]], uniforms[:, rows["b"]] = [0.5, 0.25, 0.75], [0.25, 0.5, 0.75]
    blocks = list(accepted_blocks(made, uniforms, 2, lambda: False))
    assert [block.accepted.tolist() for block in blocks] == [[0], [2]]
    values = [np.concatenate([np.asarray(block.forecasts[i]) for block in blocks]) for i in (0, 1)]
    quarter = stats.norm.ppf(0.75)
    assert values[0] == pytest.approx([0.25, quarter + 0.75])
    assert values[1] == pytest.approx([0.0, 100 * quarter])


def test_uniforms_of_plain_trials(model):
    """Those that the run itself draws with: b is uniform, and has them as its values."""
    made = model({"f": {"cell": "A1", "at_least": 0.0}})
    sampler = made.sampler(7, 64)
    drawn = sampler.draw(0)
    numbers = np.array([3, 0, 41, 63])
    uniforms = plain_uniforms(made, 7, numbers)
    assert uniforms.shape == (4, 2)
    assert uniforms[:, sampler.row_of["b"]] == pytest.approx(drawn["b"][numbers])
    assert stats.norm.ppf(uniforms[:, sampler.row_of["a"]]) == pytest.approx(drawn["a"][numbers])
