"""The case study's gradient and Hessian, against mpmath's differences of the equations as the paper prints them."""

from __future__ import annotations

from pathlib import Path

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from xlmc.analysis.studies.derivatives import derivatives
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[4]
MPH = mpf(3600) / 5280


def equations(w1, i1, a1, b1, s1, f1, w2, i2, a2, b2, s2, f2, x1, y1, x2, y2, gamma):
    """(9)-(22) of SAE 2001-01-3347, with the readings of its table: forecasts, then e_n and e_t."""
    g, sin, cos = mpf("32.174"), mpmath.sin, mpmath.cos
    a1, b1, a2, b2, gamma = (mpmath.radians(angle) for angle in (a1, b1, a2, b2, gamma))
    m1, m2 = w1 / g, w2 / g
    v1f, v2f = mpmath.sqrt(2 * g * f1 * s1), mpmath.sqrt(2 * g * f2 * s2)
    ax1, by1 = -(x1 * cos(a1) + y1 * sin(a1)) / 12, -(x1 * sin(a1) - y1 * cos(a1)) / 12
    ax2, by2 = -(x2 * cos(a2) + y2 * sin(a2)) / 12, -(x2 * sin(a2) - y2 * cos(a2)) / 12
    v1 = (m1 * v1f * sin(b1 - a2) - m2 * v2f * sin(a2 - b2)) / (m1 * sin(a1 - a2))
    v2 = (-m1 * v1 * cos(a1) + m1 * v1f * cos(b1) + m2 * v2f * cos(b2)) / (m2 * cos(a2))
    o1 = m1 / i1 * (v1f * (cos(b1) * by1 - sin(b1) * ax1) - v1 * (cos(a1) * by1 - sin(a1) * ax1))
    o2 = m2 / i2 * (v2f * (cos(b2) * by2 - sin(b2) * ax2) - v2 * (cos(a2) * by2 - sin(a2) * ax2))
    dv1 = mpmath.hypot(v1f * cos(b1) - v1 * cos(a1), v1f * sin(b1) - v1 * sin(a1))
    dv2 = mpmath.hypot(v2f * cos(b2) - v2 * cos(a2), v2f * sin(b2) - v2 * sin(a2))
    sep = (
        v1f * cos(b1) + by1 * o1 - v2f * cos(b2) - by2 * o2,
        v2f * sin(b2) - ax2 * o2 - v1f * sin(b1) + ax1 * o1,
    )
    close = v2 * cos(a2) - v1 * cos(a1), v1 * sin(a1) - v2 * sin(a2)
    e_n = (sep[0] * sin(gamma) + sep[1] * cos(gamma)) / (close[0] * sin(gamma) + close[1] * cos(gamma))
    e_t = (sep[1] * sin(gamma) - sep[0] * cos(gamma)) / (close[1] * sin(gamma) - close[0] * cos(gamma))
    return [dv1 * MPH, dv2 * MPH, v1 * MPH, v2 * MPH, e_n, e_t]


STEP = mpf(10) ** -20


def differences(point):
    """Values, gradients and Hessians of all six, by central differences at 80 digits: (6,), (6, k), (6, k, k)."""
    k = len(point)

    def at(*moves):
        moved = list(point)
        for index, sign in moves:
            moved[index] += sign * STEP
        return equations(*moved)

    middle = at()
    up, down = [at((i, 1)) for i in range(k)], [at((i, -1)) for i in range(k)]
    first = [[(up[i][f] - down[i][f]) / (2 * STEP) for i in range(k)] for f in range(6)]
    second = np.zeros((6, k, k), object)
    for i in range(k):
        for j in range(i + 1):
            both = at((i, 1), (j, 1)), at((i, -1), (j, -1))
            for f in range(6):
                sides = up[i][f] + up[j][f] + down[i][f] + down[j][f]
                value = (both[0][f] + both[1][f] - sides + 2 * middle[f]) / (2 * STEP**2)
                if i == j:
                    value = (up[i][f] - 2 * middle[f] + down[i][f]) / STEP**2
                second[f, i, j] = second[f, j, i] = value
    return middle, first, second


@pytest.fixture(scope="module")
def model():
    return load(ROOT / "examples" / "intersection.xlsx")


def test_gradient_and_hessian_of_the_case_study(model):
    """At some point of the ranges, to 1e-10 of the largest derivative in the assumption's own range."""
    ranges = [(float(a.parameters["low"]), float(a.parameters["high"])) for a in model.live]
    shares = np.random.default_rng(1).random(len(ranges))
    points = [low + share * (high - low) for (low, high), share in zip(ranges, shares, strict=True)]
    inputs = dict(zip((a.name for a in model.live), points, strict=True))
    result = derivatives(model, inputs, order=2)
    assert not result.undefined
    assert not result.numerical
    cells = [*result.forecasts.values(), *result.filters.values()][:6]
    with mpmath.workdps(80):
        middle, first, second = differences([mpf(value) for value in inputs.values()])
    width = np.array([high - low for low, high in ranges])
    for f, cell in enumerate(cells):
        assert cell.value[0] == pytest.approx(float(middle[f]), rel=1e-12)
        exact = np.array(first[f], float) * width
        assert np.abs(cell.gradient[0] * width - exact).max() <= 1e-10 * np.abs(exact).max()
        curves = second[f].astype(float) * np.outer(width, width)
        assert np.abs(cell.hessian[0] * np.outer(width, width) - curves).max() <= 1e-10 * np.abs(curves).max()
        assert np.array_equal(cell.hessian[0], cell.hessian[0].T)


def test_second_order_taylor_of_the_case_study(model):
    """The means and standard deviations were computed independently: uniform assumptions, variance width² / 12."""
    result = derivatives(model, {a.name: a.base for a in model.live}, order=2)
    ranges = np.array([(float(a.parameters["low"]), float(a.parameters["high"])) for a in model.live])
    variance = (ranges[:, 1] - ranges[:, 0]) ** 2 / 12
    means = [one.value[0] + np.diag(one.hessian[0]) @ variance / 2 for one in result.forecasts.values()]
    spreads = [np.sqrt(one.gradient[0] ** 2 @ variance) for one in result.forecasts.values()]
    assert np.round(means, 3).tolist() == pytest.approx([12.166, 23.771, 33.692, 8.897], abs=0.0011)
    assert np.round(spreads, 3).tolist() == pytest.approx([1.105, 2.143, 1.764, 4.165], abs=0.0011)
