from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xlmc.montecarlo.sampling.streams import Stream

SEED = 999


def first(n, name="a", seed=SEED):
    out = np.empty(n)
    Stream(seed, name).uniforms(0, out)
    return out


@settings(max_examples=50)
@given(st.integers(0, 400), st.integers(1, 100))
def test_a_uniform_depends_on_its_trial_alone(start, n):
    stream, out = Stream(SEED, "a"), np.empty(n)
    stream.uniforms(300, np.empty(7))  # what was asked before is no matter
    stream.uniforms(start, out)
    assert np.array_equal(out, first(500)[start : start + n])


def test_the_same_trials_may_be_asked_for_again():
    stream, out = Stream(SEED, "a"), np.empty((2, 5))
    for row in out:
        stream.uniforms(10, row)
    assert np.array_equal(out[0], out[1])


def test_far_trials_are_reached_at_once():
    far, near = np.empty(3), np.empty(1)
    Stream(SEED, "a").uniforms(10**15, far)
    Stream(SEED, "a").uniforms(10**15 + 2, near)
    assert far[2] == near[0]


def test_names_and_seeds_have_streams_of_their_own():
    streams = [first(1000, name, seed) for name in ("a", "b", "ab", "Größe") for seed in (0, 1, 999)]
    worst = max(abs(np.corrcoef(one, other)[0, 1]) for i, one in enumerate(streams) for other in streams[:i])
    assert worst < 4.5 / np.sqrt(1000)  # 66 pairs: one in 2000 runs of true independence would go beyond


def test_uniforms_lie_on_the_grid():
    u = first(10_000)
    assert ((u >= 0) & (u < 1)).all()
    assert np.array_equal(u * 2.0**53, np.floor(u * 2.0**53))


def test_uniforms_are_uniform():
    u = first(100_000)
    distance = np.abs(np.sort(u) - (np.arange(u.size) + 0.5) / u.size).max()
    assert distance < 1.95 / np.sqrt(u.size)  # Kolmogorov-Smirnov, one seed in a thousand


@pytest.mark.parametrize(
    ("name", "seed", "trial", "expected"),
    [
        ("a", 999, 0, [0.24939992449715154, 0.3398050979537476, 0.6023083705147441]),
        ("a", 999, 1_000_000, [0.24202125680777065]),
        ("alpha1", 999, 0, [0.08424002994382629]),
        ("grösse", 2**70, 0, [0.1277712589581228]),
        (" Größe", 2**70, 0, [0.1277712589581228]),  # case and outer blanks do not count
    ],
)
def test_the_numbers_are_the_same_on_every_machine_and_in_every_version(name, seed, trial, expected):
    out = np.empty(len(expected))
    Stream(seed, name).uniforms(trial, out)
    assert out.tolist() == expected
