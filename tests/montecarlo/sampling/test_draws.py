from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.copula import GaussianCopula
from xlmc.montecarlo.sampling.draws import CorrelatedGroup, Draw, DrawStage, Sampler
from xlmc.montecarlo.sampling.streams import Stream

UNIFORM, NORMAL = FAMILIES["Uniform"], FAMILIES["Normal"]
PAIR = np.array([[1.0, 0.8], [0.8, 1.0]])


def uniform(name, low=0.0, high=1.0):
    return Draw(name, UNIFORM, (low, high))


def sampler(*draws, groups=(), block=64, seed=999):
    return Sampler(seed, [DrawStage(draws)], groups, [], block)


def drawn(montecarlo, blocks, block=64):
    """Trials of several blocks put together, name -> (n,)."""
    parts = [{k: v.copy() for k, v in montecarlo.draw(i * block).items()} for i in range(blocks)]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def test_a_draw_is_the_quantile_of_the_streams_uniform():
    u = np.empty(64)
    Stream(999, "a").uniforms(128, u)
    result = sampler(uniform("a", 2.0, 5.0)).draw(128)["a"]
    assert np.array_equal(result, UNIFORM.ppf(u, 2.0, 5.0))


def test_draws_do_not_depend_on_the_block_size():
    draws = uniform("a"), Draw("b", NORMAL, (1.0, 2.0)), Draw("c", NORMAL, (0.0, 1.0), cutoffs=(-1.0, 0.5))
    groups = [CorrelatedGroup(("a", "b"), GaussianCopula(PAIR))]
    small = drawn(sampler(*draws, groups=groups, block=16), 12, 16)
    large = drawn(sampler(*draws, groups=groups, block=96), 2, 96)
    assert {name: values.tolist() for name, values in small.items()} == {n: v.tolist() for n, v in large.items()}


def test_blocks_may_come_in_any_order():
    montecarlo = sampler(uniform("a"), block=8)
    later = montecarlo.draw(800)["a"].copy()
    montecarlo.draw(0)
    assert np.array_equal(montecarlo.draw(800)["a"], later)


def test_other_assumptions_change_nothing():
    alone = sampler(uniform("b")).draw(0)["b"].copy()
    among = sampler(uniform("a"), uniform("b"), Draw("c", NORMAL, (0.0, 1.0))).draw(0)["b"]
    assert np.array_equal(alone, among)


def test_a_group_changes_nothing_for_those_outside_it_and_nothing_for_its_first():
    groups = [CorrelatedGroup(("b", "a"), GaussianCopula(PAIR))]
    plain = sampler(uniform("a"), uniform("b"), uniform("c")).draw(0)
    plain = {name: values.copy() for name, values in plain.items()}
    joined = sampler(uniform("a"), uniform("b"), uniform("c"), groups=groups).draw(0)
    assert np.array_equal(joined["b"], plain["b"])
    assert np.array_equal(joined["c"], plain["c"])
    assert not np.array_equal(joined["a"], plain["a"])
    assert np.corrcoef(joined["a"], joined["b"])[0, 1] > 0.5


def test_a_group_is_joined_before_its_quantiles():
    groups = [CorrelatedGroup(("a", "b"), GaussianCopula(PAIR))]
    montecarlo = sampler(Draw("a", NORMAL, (0.0, 1.0)), Draw("b", NORMAL, (0.0, 1.0)), groups=groups, block=100_000)
    result = montecarlo.draw(0)
    pearson, n = 2 * np.sin(np.pi / 6 * 0.8), 100_000
    assert abs(np.corrcoef(result["a"], result["b"])[0, 1] - pearson) < 4 * (1 - pearson**2) / np.sqrt(n)


def test_truncation():
    result = sampler(Draw("a", NORMAL, (0.0, 1.0), cutoffs=(0.5, np.inf)), block=1000).draw(0)["a"]
    assert result.min() >= 0.5
    assert result.max() > 2.0


def test_parameters_may_depend_on_earlier_stages():
    def parameters(earlier, n):
        assert set(earlier) == {"a"}
        return {"2a": 2 * earlier["a"][:n]}

    stages = [DrawStage((uniform("a"),)), DrawStage((Draw("b", UNIFORM, ("2a", 3.0)),), dynamic=True)]
    result = Sampler(999, stages, [], [parameters], 64).draw(0)
    u = np.empty(64)
    Stream(999, "b").uniforms(0, u)
    assert np.array_equal(result["b"], UNIFORM.ppf(u, 2 * result["a"], 3.0))


@pytest.mark.parametrize("bad", [np.nan, 4.0])
def test_trials_whose_parameters_are_no_distribution_are_nan(bad):
    def parameters(earlier, n):
        return {"low": np.where(earlier["a"] > 0.5, bad, 0.0)}

    stages = [DrawStage((uniform("a"),)), DrawStage((Draw("b", UNIFORM, ("low", 3.0)),), dynamic=True)]
    result = Sampler(999, stages, [], [parameters], 64).draw(0)
    assert np.array_equal(np.isnan(result["b"]), result["a"] > 0.5)


def test_stages_have_parameters_of_their_own_in_order():
    seen = []

    def note(name):
        def parameters(earlier, n):
            seen.append((name, sorted(earlier)))
            return {f"{name} high": np.full(n, 2.0)}

        return parameters

    stages = [DrawStage((uniform("a"),))]
    stages += [DrawStage((Draw(name, UNIFORM, (0.0, f"{name} high")),), dynamic=True) for name in ("b", "c")]
    Sampler(1, stages, [], [note("b"), note("c")], 8).draw(0)
    assert seen == [("b", ["a"]), ("c", ["a", "b"])]


def test_a_draw_that_is_too_small_for_a_cell_is_0():
    tiny = Draw("tiny", UNIFORM, (-1e-307, 1e-307)), Draw("bell", NORMAL, (0.0, 1e-307))
    result = sampler(*tiny, block=512).draw(0)
    for values in result.values():
        assert (values == 0).any()
        assert (values[values != 0] >= 2.0**-1022).any()
        assert (np.abs(values[values != 0]) >= 2.0**-1022).all()
