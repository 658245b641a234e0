"""Sines and cosines in float32 against those of the same angle in float64."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")

from xlmc.evaluation.llvm import machine as machines
from xlmc.evaluation.llvm import program as programs
from xlmc.evaluation.llvm.program import JitProgram
from xlmc.evaluation.llvm.single_sine import HALF_PI_PARTS, LARGEST_ANGLE

GENERATOR = np.random.default_rng(5)
ANGLES = {
    "dense": np.linspace(-7, 7, 20_001),
    "near multiples": np.arange(1, 5000) * (np.pi / 2),
    "any size": np.exp(GENERATOR.uniform(np.log(1e-12), np.log(LARGEST_ANGLE), 20_000)),
    "beyond": GENERATOR.uniform(LARGEST_ANGLE, 2.0**27, 500),
}


@pytest.fixture(params=[True, False], ids=["fused", "twice rounded"])
def columns(request, lower, monkeypatch):
    made = machines.this_machine()
    if request.param and not made.fused:
        pytest.skip("this processor does not fuse")
    made.fused = request.param
    monkeypatch.setattr(programs, "machine", lambda: made)
    lowering, targets = lower({"A1": 0.0, "B1": "=SIN(A1)", "B2": "=COS(A1)"}, ["A1"], ["B1", "B2"])

    def compute(angles):
        evaluator = JitProgram(lowering, targets, [], frozenset(), single=True).evaluator(angles.size)
        return [column.as_floats() for column in evaluator.filters({"A1": angles}, angles.size)]

    return compute


@pytest.mark.parametrize("kind", ANGLES)
def test_within_one_unit_of_one(columns, kind):
    """2^-23 of float32's own angle; beyond the largest the careful path computes in float64."""
    angles = ANGLES[kind].astype(np.float32).astype(np.float64)
    sines, cosines = columns(angles)
    bound = 2.0**-23 if kind != "beyond" else 1e-15
    assert np.abs(sines - np.sin(angles)).max() <= bound
    assert np.abs(cosines - np.cos(angles)).max() <= bound


def test_small_angles_keep_their_digits(columns):
    angles = np.geomspace(1e-30, 0.7, 2000).astype(np.float32).astype(np.float64)
    np.testing.assert_allclose(columns(angles)[0], np.sin(angles), rtol=2 * 2.0**-24, atol=0)


def test_the_parts_of_half_pi():
    assert [np.float32(part) == part for part in HALF_PI_PARTS] == [True] * 3
    assert [int(part * 2.0**k) == part * 2.0**k for part, k in zip(HALF_PI_PARTS, (10, 22), strict=False)] == [True] * 2
    assert abs(sum(HALF_PI_PARTS) - np.pi / 2) < 2e-15
