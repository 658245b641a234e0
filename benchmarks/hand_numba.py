"""The case study and the skid sheet as fused loops compiled by numba, one thread, draws by NumPy's SFC64.

`libm` calls the C library's sine and cosine, as a loop does that one writes down. `polynomial` reduces the angle by
Cody and Waite's method in three parts and evaluates the fdlibm polynomials, without branches, so that the compiler can
do several trials at once; it is right to 2 ulp for angles up to some 10⁵ radians, far more than the case study has.
Arithmetic is strict, but for fused multiply-adds, in both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from hand_written import DEGREE, MPH, G
from numba import njit
from numpy.typing import NDArray

__all__ = ["CASE_KERNELS", "case_kernel", "simulate", "skid_kernel"]

Array = NDArray[np.float64]
OPTIONS: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}, "nogil": True}

_TWO_OVER_PI = 2 / math.pi
_ROUND = 1.5 * 2.0**52
_PI_1, _PI_2, _PI_3 = 1.57079632673412561417e00, 6.07710050630396597660e-11, 2.02226624879595063154e-21


@njit(**OPTIONS)
def _sincos_libm(x):
    return math.sin(x), math.cos(x)


@njit(**OPTIONS)
def _sincos_polynomial(x):
    k = (x * _TWO_OVER_PI + _ROUND) - _ROUND
    r = ((x - k * _PI_1) - k * _PI_2) - k * _PI_3
    z = r * r
    sine = 1.58969099521155010221e-10
    sine = sine * z - 2.50507602534068634195e-08
    sine = sine * z + 2.75573137070700676789e-06
    sine = sine * z - 1.98412698298579493134e-04
    sine = sine * z + 8.33333333332248946124e-03
    sine = sine * z - 1.66666666666666324348e-01
    sine = r + r * z * sine
    cosine = -1.13596475577881948265e-11
    cosine = cosine * z + 2.08757232129817482790e-09
    cosine = cosine * z - 2.75573143513906633035e-07
    cosine = cosine * z + 2.48015872894767294178e-05
    cosine = cosine * z - 1.38888888888741095749e-03
    cosine = cosine * z + 4.16666666666666019037e-02
    cosine = 1.0 - (0.5 * z - z * z * cosine)
    quarter = k - 4.0 * math.floor(k * 0.25)
    odd = quarter == 1.0 or quarter == 3.0
    s = cosine if odd else sine
    c = sine if odd else cosine
    return (-s if quarter >= 2.0 else s), (-c if quarter == 1.0 or quarter == 2.0 else c)


def case_kernel(sincos: Any) -> Any:
    """(inputs (17, chunk), n, work (6, chunk), out (4, m), kept) -> how many of the first `n` are accepted."""

    @njit(**OPTIONS)
    def kernel(inputs, n, work, out, kept):
        for j in range(n):
            w1, i1, al1, be1 = inputs[0, j], inputs[1, j], inputs[2, j], inputs[3, j]
            w2, i2, al2, be2 = inputs[6, j], inputs[7, j], inputs[8, j], inputs[9, j]
            x1, y1, x2, y2 = inputs[12, j], inputs[13, j], inputs[14, j], inputs[15, j]
            m1, m2 = w1 / G, w2 / G
            v1f, v2f = math.sqrt(2 * G * inputs[5, j] * inputs[4, j]), math.sqrt(2 * G * inputs[11, j] * inputs[10, j])
            half, mean = (al1 - al2) * (DEGREE / 2), (al1 + al2) * (DEGREE / 2)
            sin_half, cos_half = sincos(half)
            sin_m, cos_m = sincos(mean)
            sin_delta = sincos((al1 - al2) * DEGREE)[0]
            sin_11, sin_22 = sincos((be1 - al1) * DEGREE)[0], sincos((be2 - al2) * DEGREE)[0]
            sin_12, sin_21 = sincos((be1 - al2) * DEGREE)[0], sincos((be2 - al1) * DEGREE)[0]
            p1, p2 = m1 * v1f * sin_11, m2 * v2f * sin_22
            v1i = (v1f * sin_12 + p2 / m1) / sin_delta
            v2i = -(v2f * sin_21 + p1 / m2) / sin_delta
            along, across = -(p1 + p2) / (2 * sin_half), (p1 - p2) / (2 * cos_half)
            px, py = along * cos_m - across * sin_m, along * sin_m + across * cos_m
            sa1, ca1 = sincos(al1 * DEGREE)
            sa2, ca2 = sincos(al2 * DEGREE)
            sb1, cb1 = sincos(be1 * DEGREE)
            sb2, cb2 = sincos(be2 * DEGREE)
            sg, cg = sincos(inputs[16, j] * DEGREE)
            a1, b1 = -(x1 * ca1 + y1 * sa1) / 12, -(x1 * sa1 - y1 * ca1) / 12
            a2, b2 = -(x2 * ca2 + y2 * sa2) / 12, -(x2 * sa2 - y2 * ca2) / 12
            om1, om2 = (px * b1 - py * a1) / i1, (py * a2 - px * b2) / i2
            sep_x = v1f * cb1 + b1 * om1 - v2f * cb2 - b2 * om2
            sep_y = v2f * sb2 - a2 * om2 - v1f * sb1 + a1 * om1
            close_x, close_y = v2i * ca2 - v1i * ca1, v1i * sa1 - v2i * sa2
            e_n = (sep_x * sg + sep_y * cg) / (close_x * sg + close_y * cg)
            e_t = (sep_y * sg - sep_x * cg) / (close_y * sg - close_x * cg)
            total = math.sqrt(along * along + across * across) * MPH
            work[0, j], work[1, j], work[2, j], work[3, j] = total / m1, total / m2, v1i * MPH, v2i * MPH
            work[4, j], work[5, j] = e_n, e_t
        result = 0
        for j in range(n):
            e_n, e_t = work[4, j], work[5, j]
            if (e_n >= 0) & (e_n < 1) & (e_t >= 0) & (e_t <= 0.25) & (work[3, j] > 0):
                for k in range(4):
                    out[k, kept + result] = work[k, j]
                result += 1
        return result

    return kernel


CASE_KERNELS: dict[str, Callable[[], Any]] = {
    "libm": lambda: case_kernel(_sincos_libm),
    "polynomial": lambda: case_kernel(_sincos_polynomial),
}


def skid_kernel() -> Any:
    """(inputs (3, chunk), n, unused, out (1, m), kept) -> n."""

    @njit(**OPTIONS)
    def kernel(inputs, n, work, out, kept):
        for j in range(n):
            t = inputs[2, j] / 100
            drag = (inputs[0, j] + t) / math.sqrt(1 + t * t)
            out[0, kept + j] = math.sqrt(2 * G * inputs[1, j] * drag) * MPH
        return n

    return kernel


@njit(**OPTIONS)
def _stretch(inputs, low, high):
    for k in range(inputs.shape[0]):
        for j in range(inputs.shape[1]):
            inputs[k, j] = low[k] + inputs[k, j] * (high[k] - low[k])


def simulate(kernel: Any, forecasts: int, low: Array, high: Array, trials: int, seed: int, chunk: int) -> Array:
    """Forecasts of the accepted trials, (f, m)."""
    rng = np.random.Generator(np.random.SFC64(seed))
    inputs, work = np.empty((len(low), chunk)), np.empty((6, chunk))
    out, parts = np.empty((forecasts, chunk)), []
    for start in range(0, trials, chunk):
        rng.random(out=inputs)
        _stretch(inputs, low, high)
        result = kernel(inputs, min(chunk, trials - start), work, out, 0)
        parts.append(out[:, :result].copy())
    return np.concatenate(parts, axis=1)
