"""Sines, cosines and tangents of the compiled loop against mpmath, in units in the last place of the true value."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("llvmlite")
import mpmath

from xlmc.evaluation.llvm.sine import HALF_PI
from xlmc.functions.denormals import flushed

LIMIT = 2.0**27


def near_multiples():
    """Doubles around the multiples of π/2, odd and even, small and large."""
    with mpmath.workprec(200):
        counts = [*range(1, 400), *(2**k + j for k in range(9, 26) for j in (-1, 0, 1))]
        centres = np.array([float(mpmath.pi / 2 * k) for k in counts])
    steps = (centres, np.nextafter(centres, 0), np.nextafter(centres, np.inf))
    return np.concatenate([part[part < LIMIT] for part in steps])


def closest():
    """The doubles that come closest to a multiple of π/2, where most digits cancel.

    q·2^e lies by p·π/2 where p/q is a convergent of the continued fraction of 2^e / (π/2).
    """
    found = []
    with mpmath.workprec(400):
        for exponent in range(-52, -25):
            rest = mpmath.ldexp(1, exponent) / (mpmath.pi / 2)
            before, q = 1, 0
            while True:
                whole = int(mpmath.floor(rest))
                before, q = q, whole * q + before
                if q >= 2**53:
                    break
                found.append(q * 2.0**exponent)
                rest = 1 / (rest - whole)
    return np.array([x for x in found if 0.1 < x < LIMIT])


GENERATOR = np.random.default_rng(3)
ANGLES = {
    "dense": np.linspace(-7, 7, 3001),
    "degrees": np.radians(np.arange(-720, 721)),
    "quarters": np.arange(-40, 41) * (np.pi / 4),
    "near multiples": near_multiples(),
    "closest": closest(),
    "any size": np.exp(GENERATOR.uniform(np.log(1e-12), np.log(LIMIT), 2000)) * GENERATOR.choice([-1, 1], 2000),
    "large": GENERATOR.uniform(LIMIT / 2, LIMIT, 1000),
    "tiny": np.array(
        [0.0, 5e-324, 1e-310, 2.2e-308, 1e-300, 1e-200, 1e-20, 1e-8, -1e-8, -5e-324, np.nextafter(LIMIT, 0)]
    ),
}


@pytest.mark.parametrize("angles", ANGLES)
def test_within_a_unit_in_the_last_place(compiled, distance, angles):
    with mpmath.workprec(300):
        exact = [mpmath.mpf(float(angle)) for angle in flushed(ANGLES[angles])]  # Excel knows no smaller ones
        sine, cosine, tangent = compiled({"B1": "=SIN(A1)", "B2": "=COS(A1)", "B3": "=TAN(A1)"})(ANGLES[angles])
        assert distance(sine, map(mpmath.sin, exact)) < 1
        assert distance(cosine, map(mpmath.cos, exact)) < 1
        assert distance(tangent, map(mpmath.tan, exact)) < 2


def test_hard_angles_are_among_them():
    """Below 2^27 some double comes within 2^-58 of a multiple of π/2."""
    with mpmath.workprec(300):
        halves = [mpmath.mpf(float(x)) / (mpmath.pi / 2) for x in ANGLES["closest"]]
        assert min(abs(half - mpmath.nint(half)) for half in halves) < mpmath.ldexp(1, -58)


def test_half_pi_to_159_bits():
    with mpmath.workprec(300):
        assert abs(mpmath.fsum(map(mpmath.mpf, HALF_PI)) - mpmath.pi / 2) < mpmath.mpf(2) ** -159
