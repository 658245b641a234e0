"""Distributions as Python writes them against the families that a workbook names."""

from __future__ import annotations

import pytest

import xlmc
from xlmc.montecarlo.distributions import FAMILIES


@pytest.mark.parametrize(
    ("made", "same"),
    [
        (xlmc.Gamma(2.0, 3.0), xlmc.Gamma(2.0, 3.0, 0.0)),
        (xlmc.Lognormal(10.0, 2.0), xlmc.Lognormal(10.0, 2.0, 0.0)),
        (xlmc.Weibull(2.0, 1.5), xlmc.Weibull(2.0, 1.5, 0.0)),
    ],
    ids=lambda each: repr(each),
)
def test_a_location_that_is_left_out_is_0(made, same):
    assert made == same
    assert FAMILIES[made.family].mean(*made.given.values()) > 0


def test_means_by_their_formulas():
    gamma, lognormal = xlmc.Gamma(2.0, 3.0, 5.0), xlmc.Lognormal(10.0, 2.0)
    assert FAMILIES["Gamma"].mean(*gamma.given.values()) == pytest.approx(5 + 2 * 3)
    assert FAMILIES["Lognormal"].mean(*lognormal.given.values()) == pytest.approx(10)
