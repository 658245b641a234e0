"""Trigen: a triangle defined by its likeliest value and two percentiles, when nobody knows the extremes."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values
from xlmc.montecarlo.distributions.parameters import LIKELIEST, Constraint, ParameterSpec, rising
from xlmc.montecarlo.distributions.triangular import Triangular

__all__ = ["Trigen"]

_TRIANGULAR = Triangular()
_HALVINGS = 60  # of an interval that is at most 1 wide


class Trigen(Family):
    """The triangle with its peak at likeliest whose `bottom %` and `top %` percentiles are bottom and top.

    >>> trigen = Trigen()
    >>> reaction = {"bottom": 0.9, "likeliest": 1.2, "top": 2.0, "bottom_percent": 10, "top_percent": 90}
    >>> print(trigen.ppf(np.array([0.1, 0.5, 0.9]), **reaction).round(6))
    [0.9      1.373126 2.      ]
    >>> trigen.check(**(reaction | {"top_percent": 0.9}))
    'Top % (0.9) must be above 1 and at most 100'
    >>> print(trigen.ppf(0.5, 0.9, np.array([1.2, 2.1]), 2.0, 10.0, 90.0).round(6))
    [1.373126      nan]
    """

    name = "Trigen"
    parameters = (
        ParameterSpec("bottom", ("Bottom",)),
        LIKELIEST,
        ParameterSpec("top", ("Top",)),
        ParameterSpec("bottom_percent", ("Bottom %", "Bottom percent", "Bottom perc")),
        ParameterSpec("top_percent", ("Top %", "Top percent", "Top perc")),
    )
    rules = (
        rising(parameters, "bottom", "likeliest"),
        rising(parameters, "likeliest", "top"),
        Constraint(
            "bottom",
            lambda bottom, _likeliest, top, _below, _above: bottom < top,
            "Bottom ({bottom}) and Top ({top}) must differ",
            "Give two values with Likeliest between them",
        ),
        Constraint(
            "bottom_percent",
            lambda _bottom, _likeliest, _top, below, _above: below >= 0,
            "Bottom % ({bottom_percent}) must be 0 or more",
            "Type a percentage, such as 10",
        ),
        Constraint(
            "top_percent",
            lambda _bottom, _likeliest, _top, _below, above: (above > 1) & (above <= 100),
            "Top % ({top_percent}) must be above 1 and at most 100",
            "Type a percentage, such as 90, not a share",
        ),
        Constraint(
            "bottom_percent",
            lambda _bottom, _likeliest, _top, below, above: below < above,
            "Bottom % ({bottom_percent}) is not below Top % ({top_percent})",
            "Exchange the two, or correct the wrong one",
        ),
    )
    formula = "Triangular with P(X ≤ Bottom) = Bottom %, P(X ≤ Top) = Top % and its peak at Likeliest"
    source = "@RISK's manual, Trigen; the equations are in `xlmc/montecarlo/distributions/trigen.py`"
    elsewhere = ("@RISK Trigen(bottom, likeliest, top, bottom %, top %)", "Crystal Ball Triangular by percentiles")

    def _ppf(self, u: Array, *parameters: Values) -> Array:
        return _TRIANGULAR._ppf(u, *_triangle(*parameters))

    def _cdf(self, x: Values, *parameters: Values) -> Values:
        return _TRIANGULAR._cdf(x, *_triangle(*parameters))

    def _mean(self, *parameters: Values) -> Values:
        return _TRIANGULAR._mean(*_triangle(*parameters))

    def _variance(self, *parameters: Values) -> Values:
        return _TRIANGULAR._variance(*_triangle(*parameters))

    def _support(self, *parameters: Values) -> tuple[Values, Values]:
        return _TRIANGULAR._support(*_triangle(*parameters))

    def _mirrored(
        self, bottom: Values, likeliest: Values, top: Values, bottom_percent: Values, top_percent: Values
    ) -> tuple[Values, ...]:
        return -top, -likeliest, -bottom, 100 - top_percent, 100 - bottom_percent


def _triangle(
    bottom: Values, likeliest: Values, top: Values, bottom_percent: Values, top_percent: Values
) -> tuple[Array, Array, Array]:
    """Low, likeliest and high.

    Let the triangle be w wide with a share t of it left of the peak, so that low = likeliest − t·w. Then P(X ≤ bottom)
    = p means (bottom − low)² = p·w·(t·w), hence likeliest − bottom = w·(t − √(p·t)); above, likewise. Their ratio is an
    equation in t alone, which rises from t = p, where the bottom is at the peak, to 1 − q, where the top is.
    """
    p, q = np.divide(bottom_percent, 100), np.divide(np.subtract(100, top_percent), 100)
    down, up = np.subtract(likeliest, bottom), np.subtract(top, likeliest)

    def left(t: Array) -> Array:
        return np.asarray(np.sqrt(t) * np.maximum(np.sqrt(t) - np.sqrt(p), 0.0))

    def right(t: Array) -> Array:
        return np.asarray(np.sqrt(1 - t) * np.maximum(np.sqrt(1 - t) - np.sqrt(q), 0.0))

    shape = np.broadcast_shapes(*(np.shape(each) for each in (p, q, down, up)))
    least, most = np.broadcast_to(p, shape), np.broadcast_to(1 - q, shape)
    for _ in range(_HALVINGS):
        middle = (least + most) / 2
        short = up * left(middle) < down * right(middle)
        least, most = np.where(short, middle, least), np.where(short, most, middle)
    t = (least + most) / 2
    width = (down + up) / (left(t) + right(t))
    return likeliest - t * width, likeliest + 0 * width, likeliest + (1 - t) * width
