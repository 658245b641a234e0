from __future__ import annotations

import numpy as np
import pytest

from xlmc.distributions.custom_data import BadData
from xlmc.distributions.data_families import DATA_FAMILIES, DataOptions
from xlmc.distributions.empirical_smoothed import silverman

COLUMN = [[4.0], [1.0], [None], [2.0], [1.0]]


@pytest.mark.parametrize("name", ["Custom", "DUniform", "Empirical"])
def test_one_column_is_drawn_from_as_it_is(name):
    family = DATA_FAMILIES[name].make(COLUMN, DataOptions())
    np.testing.assert_array_equal(family.ppf(np.array([0.0, 0.5, 0.51, 0.75, 0.76])), [1, 1, 2, 2, 4])
    assert family.name == name
    assert family.mean() == 2
    assert family.variance() == pytest.approx(1.5, rel=1e-14)


def test_discrete_takes_values_and_probabilities():
    family = DATA_FAMILIES["Discrete"].make([[1, 0.2], [2, 0.8]], DataOptions())
    assert family.mean() == pytest.approx(1.8)
    with pytest.raises(BadData, match="Discrete takes two columns, values and their probabilities; these data have 1"):
        DATA_FAMILIES["Discrete"].make(COLUMN, DataOptions())


def test_smoothing_takes_silvermans_bandwidth_or_the_given_one():
    smoothed = DATA_FAMILIES["Empirical smoothed"]
    assert smoothed.make(COLUMN, DataOptions()).bandwidth == silverman([4, 1, 2, 1])
    assert smoothed.make(COLUMN, DataOptions(bandwidth=0.5)).bandwidth == 0.5


@pytest.mark.parametrize(
    ("rows", "options", "message"),
    [
        ([[2.0], [2.0]], DataOptions(), "The values are all equal"),
        ([[None]], DataOptions(), "The data are blank"),
        ([[float(i)] for i in range(5000)], DataOptions(bandwidth=1e-6), "The bandwidth is very small"),
    ],
)
def test_data_that_cannot_be_smoothed(rows, options, message):
    with pytest.raises(BadData, match=message):
        DATA_FAMILIES["Empirical smoothed"].make(rows, options)
