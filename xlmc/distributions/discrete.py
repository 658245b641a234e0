"""Discrete: single values, each with a probability of its own."""

from __future__ import annotations

from typing import Any

from xlmc.distributions.base import Array
from xlmc.distributions.custom_data import rows_of, weighted_pieces
from xlmc.distributions.parameters import DataSpec
from xlmc.distributions.pieces import Pieces

__all__ = ["Discrete"]


class Discrete(Pieces):
    """Values with probabilities, which need not add up to 1.

    >>> import numpy as np
    >>> print(Discrete().built(np.array([[1, 0.2], [2, 0.8]])).ppf(np.array([0.0, 0.2, 0.21])))
    [1. 1. 2.]
    """

    name = "Discrete"
    data = DataSpec((2,), "values, probabilities", options=("Cumulative",))
    formula = "P(value) = its probability / the sum of all"
    source = "@RISK's manual, Discrete"
    elsewhere = ("@RISK Discrete({x}, {p})", "Crystal Ball Custom with two columns")

    def built(self, data: Array, **options: Any) -> Discrete:
        return Discrete(weighted_pieces(rows_of(data), cumulative=bool(options.get("cumulative", False))))
