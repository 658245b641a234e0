"""What is no more than noise is called noise, and what is more is not."""

from __future__ import annotations

import pytest

from xlmc.analysis.studies.sensitivity.measures import ForecastSensitivity, Influence, noise
from xlmc.montecarlo.statistics import Estimate


def influence(**given):
    plain = {
        "assumption": "a",
        "units": "",
        "rank_correlation": Estimate(0.5, 0.01),
        "contribution": Estimate(0.5, 0.01),
        "explained": Estimate(0.5, 0.01),
        "explained_floor": 0.02,
        "dependence": Estimate(0.5, 0.01),
        "dependence_floor": 0.02,
    }
    return Influence(**plain | given)


def of(*influences):
    return noise(ForecastSensitivity("f", "", 1000, influences, 0, None, ()))


def test_what_is_strong_is_no_noise():
    (result,) = of(influence(first_order=Estimate(0.4, 0.01), total=Estimate(0.5, 0.01)))
    assert not any((result.explained, result.dependence, result.correlation, result.first_order, result.total))


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("errors", "count", "is_noise"), [(1.9, 1, True), (2.0, 1, False), (2.0, 20, True), (3.1, 20, False)]
)
def test_of_many_assumptions_the_largest_lies_farther_off_by_chance(sign, errors, count, is_noise):
    weak = influence(rank_correlation=Estimate(sign * errors * 0.01, 0.01))
    assert {each.correlation for each in of(*[weak] * count)} == {is_noise}


def test_each_measure_has_its_own_floor():
    (result,) = of(influence(explained=Estimate(0.02, 0.01), total=Estimate(-0.01, 0.02), first_order=None))
    assert (result.explained, result.dependence, result.total, result.first_order) == (True, False, True, False)


def test_without_an_error_nothing_is_called_noise():
    (result,) = of(influence(rank_correlation=Estimate(0.001, None)))
    assert not result.correlation
