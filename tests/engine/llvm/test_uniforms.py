"""The compiled streams against NumPy's generator, to the bit."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.engine.llvm.machine import machine
from xlmc.engine.llvm.uniforms import filler
from xlmc.montecarlo.sampling.streams import Stream


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 9])
@pytest.mark.parametrize("start", [0, 1, 32_768, 10**12])
def test_the_uniforms_of_every_stream(count, start):
    streams = [Stream(7, f"input {k}") for k in range(count)]
    rows, expected = np.empty((2, count, 1000))
    filler(streams, [(0.0, 1.0)] * count, rows)(start)
    for stream, row in zip(streams, expected, strict=True):
        stream.uniforms(start, row)
    assert np.array_equal(rows, expected)


@pytest.mark.parametrize("n", [1, 7, 8, 9, 63, 64, 2049])
@pytest.mark.parametrize("wide", [None, False])
def test_any_number_of_trials_and_nothing_beyond_them(n, wide, monkeypatch):
    if wide is not None:
        monkeypatch.setattr(machine(), "multiplies_52_bits", wide)
    streams = [Stream(7, f"input {k}") for k in range(5)]
    rows, expected = np.full((2, 5, n + 9), -1.0)
    filler(streams, [(0.0, 1.0)] * 5, rows[:, :n])(12_345)
    for stream, row in zip(streams, expected, strict=True):
        stream.uniforms(12_345, row[:n])
    assert np.array_equal(rows, expected)


@pytest.mark.parametrize(("low", "width"), [(0.6, 0.95 - 0.6), (5.0, 0.0), (-1e300, 3e300), (0.0, 1e-300)])
def test_offsets_and_factors_round_as_numpy_does(low, width):
    stream, row, expected = Stream(1, "a"), np.empty((1, 5000)), np.empty(5000)
    filler([stream], [(low, width)], row)(0)
    stream.uniforms(0, expected)
    assert np.array_equal(row[0], expected * width + low)


BOOKS = {
    "uniform": {"a": {"cell": "A1", "low": 0.1, "high": 0.7}, "b": {"cell": "A2", "low": 5, "high": 5}},
    "overshooting": {
        "a": {"cell": "A1", "low": -0.1, "high": 0.7000000000000001},
        "b": {"cell": "A2", "low": -1e-3, "high": 0.3},
    },
    "other families": {
        "a": {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1},
        "b": {"cell": "A2", "low": 0, "high": 4, "lower_cutoff": 1.0},
    },
    "dynamic": {"a": {"cell": "A1", "low": 1, "high": 2}, "b": {"cell": "A2", "low": "B9", "high": 9}},
}


CORRELATED = {("a", "b"): 0.5}
"""Draws of a model whose parameters do not depend on each other may be correlated."""


@pytest.mark.parametrize(
    ("kind", "correlations"),
    [*((kind, {}) for kind in BOOKS), *((kind, CORRELATED) for kind in BOOKS if kind != "dynamic")],
)
def test_a_model_draws_the_same_on_every_engine(book, kind, correlations):
    cells = {"A1": 1.0, "A2": 2.0, "B9": "=A1*2", "C1": "=A1+A2"}
    model = book(cells, BOOKS[kind], {"sum": "C1"}, correlations=correlations)
    one, other = (model.sampler(3, 500, engine) for engine in ("numpy", "jit"))
    for start in (0, 500, 77_000):
        expected, result = one.draw(start), other.draw(start)
        assert result.keys() == expected.keys()
        assert all(np.array_equal(result[name], values) for name, values in expected.items())
