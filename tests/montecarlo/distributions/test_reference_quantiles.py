"""Quantiles that SciPy did not compute: mpmath, roots of the distribution function to 50 digits."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.distributions import FAMILIES

P = np.array([1e-6, 0.25, 0.5, 0.75, 1 - 1e-6])
GAMMA = {
    0.05: (5.84463205728658e-121, 5.31566188991698e-13, 5.57387844074624e-7, 0.00185673568384, 8.69686266789374),
    0.7: (2.3395393357732638e-9, 0.12976492383600589, 0.40742374847644127, 0.9615070868943008, 12.768858085316349),
    3: (0.018254282963279292, 1.7272994178605194, 2.6740603137235603, 3.92040206029256, 19.129168188572924),
    50: (23.250665357946591, 45.066609873169657, 49.667064617994228, 54.570620535040301, 91.063388559713072),
    2000: (1794.57165888084, 1969.6569631264706, 1999.6666765450128, 2029.9796762130579, 2219.8229698269802),
}
BETA = {
    (0.3, 0.4): (4.15973986087426e-20, 0.04018081321011, 0.34317039842153, 0.82951054847315, 0.99999999999999),
    (2, 5): (0.0002582878293540636, 0.16116291679032652, 0.26444998329565996, 0.38947948520072443, 0.95557304802992422),
    (40, 0.5): (0.7401300499261533, 0.98349290504910894, 0.99429400099901156, 0.99872372119422737, 0.99999999999998024),
    (300, 700): (0.23432612992469, 0.29015308566940, 0.29986661939179, 0.30970160785209, 0.37139825721302),
}
STUDENTS_T = {
    0.5: (-102849115631.63401, -1.5537739740300373, 0, 1.5537739740300373, 102849115625.71901),
    1.5: (-5219.469324706946, -0.87259466254157064, 0, 0.87259466254157064, 5219.4693246068863),
    4: (-41.577854150450975, -0.74069708411268263, 0, 0.74069708411268263, 41.577854150151499),
    25: (-6.1458649844304748, -0.68442996490427036, 0, 0.68442996490427036, 6.1458649844189969),
    1000: (-4.7816086204583506, -0.67473516460700944, 0, 0.67473516460700944, 4.7816086204524386),
}


@pytest.mark.parametrize(("shape", "expected"), GAMMA.items())
def test_gamma(shape, expected):
    np.testing.assert_allclose(FAMILIES["Gamma"].ppf(P, 0.0, 1.0, shape), expected, rtol=1e-11)


@pytest.mark.parametrize(("shapes", "expected"), BETA.items())
def test_beta(shapes, expected):
    np.testing.assert_allclose(FAMILIES["Beta"].ppf(P, 0.0, 1.0, *shapes), expected, rtol=1e-11)


@pytest.mark.parametrize(("degrees", "expected"), STUDENTS_T.items())
def test_students_t(degrees, expected):
    np.testing.assert_allclose(FAMILIES["Student's t"].ppf(P, 0.0, 1.0, degrees), expected, rtol=1e-11)


def test_beta_pert():
    """Likeliest a fifth of the way: alpha 1.8, beta 4.2 has the mode 0.2 and the mean 0.3."""
    beta, pert = FAMILIES["Beta"], FAMILIES["BetaPERT"]
    np.testing.assert_allclose(pert.ppf(P, 0.0, 0.2, 1.0), beta.ppf(P, 0.0, 1.0, 1.8, 4.2), rtol=1e-13)
    assert pert.mean(0.0, 0.2, 1.0) == pytest.approx(0.3, rel=1e-15)
    assert pert.variance(0.0, 0.2, 1.0) == pytest.approx(beta.variance(0.0, 1.0, 1.8, 4.2), rel=1e-13)
