"""Empirical: the measurements themselves, each as likely as the others."""

from __future__ import annotations

from typing import Any

from xlmc.montecarlo.distributions.base import Array
from xlmc.montecarlo.distributions.custom_data import rows_of, value_pieces
from xlmc.montecarlo.distributions.parameters import DataSpec
from xlmc.montecarlo.distributions.pieces import Pieces

__all__ = ["Empirical"]


class Empirical(Pieces):
    """Draws are measurements, so nothing lies beyond the smallest and the largest: `EmpiricalSmoothed` reaches further.

    >>> import numpy as np
    >>> print(Empirical().built(np.array([[0.71], [0.74], [0.78]])).ppf(np.array([0.0, 0.5, 0.9])))
    [0.71 0.74 0.78]
    """

    name = "Empirical"
    aliases = ("Resampled",)
    data = DataSpec((), "measurements")
    formula = "F(x) = share of the measurements that are at most x"
    source = "B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap, 1993, chapter 4"
    elsewhere = ("Crystal Ball Custom with one column", "@RISK DUniform({x})")

    def built(self, data: Array, **_: Any) -> Empirical:
        return Empirical(value_pieces(rows_of(data)))
