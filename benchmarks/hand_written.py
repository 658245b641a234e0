"""The case study hand-written in NumPy: the yardstick for the speed of compiled workbooks.

The equations are those of `templates/planar-impact.xlsx`, term by term, as a careful NumPy programmer writes them for
this one model: sines and cosines shared, whole blocks of trials small enough for the cache, answers only for accepted
trials. `plain` lets NumPy make its temporaries; `buffered` computes into arrays that are allocated once.

`python benchmarks/hand_written.py` prints trials per second, one thread, over the block size. Every figure comes from a
process of its own: after large arrays were freed, the allocator can slow later ones by a third.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

__all__ = ["HIGH", "KERNELS", "LOW", "SYMBOLS", "buffered", "plain", "simulate"]

Array = NDArray[np.float64]
Kernel = Callable[[Array], Array]
"""Inputs (17, n), which it may overwrite -> forecasts (4, accepted), mph: both delta-Vs, both impact speeds."""

SYMBOLS = (
    *("w_1", "I_1", "alpha_1", "beta_1", "s_1", "f_1"),
    *("w_2", "I_2", "alpha_2", "beta_2", "s_2", "f_2"),
    *("x_1", "y_1", "x_2", "y_2", "gamma_t"),
)
LOW = np.array([6661, 4712, 181, 187, 20, 0.6, 3410, 1849, 272, 192, 20, 0.6, 97.5, -16, -3.2, -28.6, 96])
HIGH = np.array([6861, 5208, 191, 197, 22, 0.95, 3510, 2043, 292, 202, 24, 0.95, 103.5, -10, 3.2, -22.6, 106])
"""Table 1 of SAE 2001-01-3347, all uniform, in the order of SYMBOLS."""

G = 32.174
DEGREE = np.pi / 180
MPH = 3600 / 5280
BLOCKS = (2_048, 4_096, 8_192, 16_384, 32_768)


def simulate(trials: int, seed: int, chunk: int, kernel: str = "buffered") -> tuple[int, Array]:
    """Monte Carlo of the case study, one thread.

    Returns:
        How many trials were accepted, and their forecasts, (4, accepted), mph.
    """
    rng = np.random.Generator(np.random.SFC64(seed))
    evaluate = KERNELS[kernel](chunk)
    low, width = LOW[:, None], (HIGH - LOW)[:, None]
    inputs = np.empty((len(LOW), chunk))
    kept = []
    for start in range(0, trials, chunk):
        rng.random(out=inputs)
        inputs *= width
        inputs += low
        kept.append(evaluate(inputs[:, : trials - start]))
    forecasts = np.concatenate(kept, axis=1)
    return forecasts.shape[1], forecasts


def plain(_chunk: int) -> Kernel:
    """The equations as one writes them down."""

    def evaluate(inputs: Array) -> Array:
        w1, i1, alpha1, beta1, s1, f1, w2, i2, alpha2, beta2, s2, f2, x1, y1, x2, y2, gamma = inputs
        m1, m2 = w1 / G, w2 / G
        v1f, v2f = np.sqrt(2 * G * f1 * s1), np.sqrt(2 * G * f2 * s2)
        delta = alpha1 - alpha2
        sin_delta = np.sin(delta * DEGREE)
        p1 = m1 * v1f * np.sin((beta1 - alpha1) * DEGREE)
        p2 = m2 * v2f * np.sin((beta2 - alpha2) * DEGREE)
        v1i = (v1f * np.sin((beta1 - alpha2) * DEGREE) + p2 / m1) / sin_delta
        v2i = -(v2f * np.sin((beta2 - alpha1) * DEGREE) + p1 / m2) / sin_delta

        half, mean = delta * (DEGREE / 2), (alpha1 + alpha2) * (DEGREE / 2)
        along, across = -(p1 + p2) / (2 * np.sin(half)), (p1 - p2) / (2 * np.cos(half))
        sin_mean, cos_mean = np.sin(mean), np.cos(mean)
        px, py = along * cos_mean - across * sin_mean, along * sin_mean + across * cos_mean

        a1r, a2r, b1r, b2r, gr = (angle * DEGREE for angle in (alpha1, alpha2, beta1, beta2, gamma))
        sin_a1, cos_a1, sin_a2, cos_a2 = np.sin(a1r), np.cos(a1r), np.sin(a2r), np.cos(a2r)
        a1, b1 = -(x1 * cos_a1 + y1 * sin_a1) / 12, -(x1 * sin_a1 - y1 * cos_a1) / 12
        a2, b2 = -(x2 * cos_a2 + y2 * sin_a2) / 12, -(x2 * sin_a2 - y2 * cos_a2) / 12
        omega1, omega2 = (px * b1 - py * a1) / i1, (py * a2 - px * b2) / i2

        sep_x = v1f * np.cos(b1r) + b1 * omega1 - v2f * np.cos(b2r) - b2 * omega2
        sep_y = v2f * np.sin(b2r) - a2 * omega2 - v1f * np.sin(b1r) + a1 * omega1
        close_x, close_y = v2i * cos_a2 - v1i * cos_a1, v1i * sin_a1 - v2i * sin_a2
        sin_g, cos_g = np.sin(gr), np.cos(gr)
        e_n = (sep_x * sin_g + sep_y * cos_g) / (close_x * sin_g + close_y * cos_g)
        e_t = (sep_y * sin_g - sep_x * cos_g) / (close_y * sin_g - close_x * cos_g)

        accepted = np.flatnonzero((e_n >= 0) & (e_n < 1) & (e_t >= 0) & (e_t <= 0.25) & (v2i > 0))
        total = np.sqrt(along[accepted] ** 2 + across[accepted] ** 2)
        answers = total / m1[accepted], total / m2[accepted], v1i[accepted], v2i[accepted]
        return np.array(answers) * MPH

    return evaluate


def buffered(chunk: int) -> Kernel:
    """The same, into arrays allocated once, with one call for all the sines and one for all the cosines."""
    angle_buffer, sine_buffer = np.empty((12, chunk)), np.empty((12, chunk))
    cosine_buffer, work_buffer = np.empty((7, chunk)), np.empty((8, chunk))
    test_buffer = np.empty((2, chunk), dtype=bool)

    def evaluate(inputs: Array) -> Array:
        n = inputs.shape[1]
        w1, i1, alpha1, beta1, s1, f1, w2, i2, alpha2, beta2, s2, f2, x1, y1, x2, y2, gamma = inputs
        angles, sines, cosines = angle_buffer[:, :n], sine_buffer[:, :n], cosine_buffer[:, :n]
        t, u, along, across, px, py, a1, a2 = work_buffer[:, :n]
        test, accepted = test_buffer[:, :n]
        mul, add, sub, div = np.multiply, np.add, np.subtract, np.divide

        # Rows 0-6 need both sine and cosine, rows 7-11 the sine alone.
        angles[:5] = alpha1, alpha2, beta1, beta2, gamma
        add(alpha1, alpha2, out=angles[5])
        sub(alpha1, alpha2, out=angles[6])
        sub(beta1, alpha1, out=angles[7])
        sub(beta2, alpha2, out=angles[8])
        sub(beta1, alpha2, out=angles[9])
        sub(beta2, alpha1, out=angles[10])
        angles[11] = angles[6]
        angles[5:7] *= 0.5
        angles *= DEGREE
        np.sin(angles, out=sines)
        np.cos(angles[:7], out=cosines)
        sin_a1, sin_a2, sin_b1, sin_b2, sin_g, sin_mean, sin_half, sin_11, sin_22, sin_12, sin_21, sin_delta = sines
        cos_a1, cos_a2, cos_b1, cos_b2, cos_g, cos_mean, cos_half = cosines

        m1, m2 = div(w1, G, out=w1), div(w2, G, out=w2)
        v1f, v2f = mul(f1, s1, out=f1), mul(f2, s2, out=f2)
        for speed in (v1f, v2f):
            mul(speed, 2 * G, out=speed)
            np.sqrt(speed, out=speed)
        p1, p2 = mul(m1, v1f, out=s1), mul(m2, v2f, out=s2)
        mul(p1, sin_11, out=p1)
        mul(p2, sin_22, out=p2)

        v1i, v2i = mul(v1f, sin_12, out=sin_12), mul(v2f, sin_21, out=sin_21)
        add(v1i, div(p2, m1, out=t), out=v1i)
        add(v2i, div(p1, m2, out=t), out=v2i)
        div(v1i, sin_delta, out=v1i)
        np.negative(sin_delta, out=sin_delta)
        div(v2i, sin_delta, out=v2i)

        add(p1, p2, out=along)
        mul(sin_half, -2, out=t)
        div(along, t, out=along)
        sub(p1, p2, out=across)
        mul(cos_half, 2, out=t)
        div(across, t, out=across)
        mul(along, cos_mean, out=px)
        sub(px, mul(across, sin_mean, out=t), out=px)
        mul(along, sin_mean, out=py)
        add(py, mul(across, cos_mean, out=t), out=py)

        # a = -(x cos + y sin) / 12, b = (y cos - x sin) / 12; b takes the place of y.
        for x, y, sine, cosine, a in ((x1, y1, sin_a1, cos_a1, a1), (x2, y2, sin_a2, cos_a2, a2)):
            mul(x, cosine, out=a)
            add(a, mul(y, sine, out=t), out=a)
            div(a, -12, out=a)
            mul(y, cosine, out=y)
            sub(y, mul(x, sine, out=t), out=y)
            div(y, 12, out=y)
        b1, b2 = y1, y2
        omega1, omega2 = mul(px, b1, out=x1), mul(py, a2, out=x2)
        sub(omega1, mul(py, a1, out=t), out=omega1)
        sub(omega2, mul(px, b2, out=t), out=omega2)
        div(omega1, i1, out=omega1)
        div(omega2, i2, out=omega2)

        sep_x, sep_y = mul(v1f, cos_b1, out=cos_b1), mul(v2f, sin_b2, out=sin_b2)
        add(sep_x, mul(b1, omega1, out=t), out=sep_x)
        sub(sep_x, mul(v2f, cos_b2, out=t), out=sep_x)
        sub(sep_x, mul(b2, omega2, out=t), out=sep_x)
        sub(sep_y, mul(a2, omega2, out=t), out=sep_y)
        sub(sep_y, mul(v1f, sin_b1, out=t), out=sep_y)
        add(sep_y, mul(a1, omega1, out=t), out=sep_y)
        close_x, close_y = mul(v2i, cos_a2, out=cos_a2), mul(v1i, sin_a1, out=sin_a1)
        sub(close_x, mul(v1i, cos_a1, out=t), out=close_x)
        sub(close_y, mul(v2i, sin_a2, out=t), out=close_y)

        np.greater(v2i, 0, out=accepted)
        e = mul(sep_x, sin_g, out=px)
        add(e, mul(sep_y, cos_g, out=t), out=e)
        mul(close_x, sin_g, out=u)
        div(e, add(u, mul(close_y, cos_g, out=t), out=u), out=e)
        np.logical_and(accepted, np.greater_equal(e, 0, out=test), out=accepted)
        np.logical_and(accepted, np.less(e, 1, out=test), out=accepted)
        e = mul(sep_y, sin_g, out=px)
        sub(e, mul(sep_x, cos_g, out=t), out=e)
        mul(close_y, sin_g, out=u)
        div(e, sub(u, mul(close_x, cos_g, out=t), out=u), out=e)
        np.logical_and(accepted, np.greater_equal(e, 0, out=test), out=accepted)
        np.logical_and(accepted, np.less_equal(e, 0.25, out=test), out=accepted)

        keep = np.flatnonzero(accepted)
        total = np.sqrt(along[keep] ** 2 + across[keep] ** 2)
        return np.array((total / m1[keep], total / m2[keep], v1i[keep], v2i[keep])) * MPH

    return evaluate


KERNELS: dict[str, Callable[[int], Kernel]] = {"plain": plain, "buffered": buffered}


def trials_per_second(kernel: str, chunk: int, trials: int = 1_000_000, repeats: int = 5) -> float:
    """The best of several runs after a warm-up, in this process."""
    simulate(4 * chunk, 1, chunk, kernel)
    times = []
    for seed in range(repeats):
        start = perf_counter()
        simulate(trials, seed, chunk, kernel)
        times.append(perf_counter() - start)
    return trials / min(times)


def _in_fresh_process(kernel: str, chunk: int) -> float:
    command = [sys.executable, __file__, "--kernel", kernel, "--chunk", str(chunk)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description="Trials per second of the hand-written case study, one thread.")
    parser.add_argument("--kernel", choices=KERNELS, help="measure this one alone, in this process")
    parser.add_argument("--chunk", type=int, default=16_384, help="trials in a block, with --kernel")
    chosen = parser.parse_args()
    if chosen.kernel:
        print(trials_per_second(chosen.kernel, chosen.chunk))
        return
    print(f"{'block':>8}" + "".join(f"{kernel:>14}" for kernel in KERNELS) + "   million trials/s")
    for chunk in BLOCKS:
        print(f"{chunk:>8}" + "".join(f"{_in_fresh_process(kernel, chunk) / 1e6:>14.2f}" for kernel in KERNELS))


if __name__ == "__main__":
    main()
