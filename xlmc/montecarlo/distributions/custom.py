"""Custom: Crystal Ball's distribution of single values and ranges, read from one to five columns."""

from __future__ import annotations

from typing import Any

from xlmc.montecarlo.distributions.base import Array
from xlmc.montecarlo.distributions.custom_data import custom_pieces, rows_of
from xlmc.montecarlo.distributions.parameters import DataSpec
from xlmc.montecarlo.distributions.pieces import Pieces

__all__ = ["Custom"]


class Custom(Pieces):
    """Single values, flat ranges, steps and slopes; `custom_data` says what the columns are.

    >>> import numpy as np
    >>> unit_cost = Custom().built(np.array([[5, 15, 0.75], [16, 21, 0.25]]))
    >>> print(unit_cost.ppf(np.array([0.0, 0.375, 0.75, 0.875])))
    [ 5.  10.  15.  18.5]
    """

    name = "Custom"
    data = DataSpec(
        (),
        "values; or values, weights; or low, high, weight; the same with step; the same with the heights at both ends",
        options=("Cumulative",),
        truncates=False,
    )
    formula = "each row of Data with its share of the weights: a value, a flat range, steps, or a slope"
    source = "Oracle Crystal Ball User's Guide, appendix A, Using the Custom Distribution"
    elsewhere = ("Crystal Ball CB.Custom(range)",)

    def built(self, data: Array, **options: Any) -> Custom:
        return Custom(custom_pieces(rows_of(data), cumulative=bool(options.get("cumulative", False))))
