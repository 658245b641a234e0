"""Discrete: single values, each with a probability of its own; DUniform: values that are equally likely."""

from __future__ import annotations

from typing import Any

from xlmc.montecarlo.distributions.base import Array
from xlmc.montecarlo.distributions.custom_data import rows_of, value_pieces, weighted_pieces
from xlmc.montecarlo.distributions.parameters import DataSpec
from xlmc.montecarlo.distributions.pieces import Pieces

__all__ = ["DUniform", "Discrete"]


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


class DUniform(Pieces):
    """Values from any number of columns; one that comes twice counts twice.

    >>> import numpy as np
    >>> print(DUniform().built(np.array([[4.0], [1.0], [2.0], [1.0]])).ppf(np.array([0.0, 0.5, 0.51, 0.76])))
    [1. 1. 2. 4.]
    """

    name = "DUniform"
    aliases = ("Discrete values",)
    data = DataSpec((), "values")
    formula = "P(value) = 1 / number of values"
    source = "@RISK's manual, DUniform"
    elsewhere = ("@RISK DUniform({x})", "Crystal Ball Custom with one column")

    def built(self, data: Array, **_: Any) -> DUniform:
        return DUniform(value_pieces(rows_of(data)))
