"""Error functions, Bessel functions of whole order, and two step functions. SciPy computes the first two kinds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.excel.functions.registry import Anything, excel
from xlmc.excel.functions.toolpak import OneCell, numbers_only
from xlmc.excel.functions.values import NUM, Floats

__all__: list[str] = []


@excel("ERF", OneCell, OneCell(default=None))
@numbers_only
def erf_between(lower: Floats, upper: Floats | None = None) -> Floats:
    """Error function, or the difference of its values at two numbers.

    Far from 0 the difference is that of the complements, because 1 - 1 would lose the digits.
    """
    from scipy.special import erf, erfc

    if upper is None:
        return np.asarray(erf(lower))
    side = np.sign(lower) * (np.sign(lower) == np.sign(upper))
    apart = side * (erfc(side * lower) - erfc(side * upper))
    return np.asarray(np.where(side == 0, erf(upper) - erf(lower), apart))


@excel("ERF.PRECISE", Anything)
@numbers_only
def erf_precise(x: Floats) -> Floats:
    """Error function."""
    from scipy.special import erf

    return np.asarray(erf(x))


@excel("ERFC.PRECISE", Anything)
@excel("ERFC", OneCell)
@numbers_only
def erf_complement(x: Floats) -> Floats:
    """1 - error function."""
    from scipy.special import erfc

    return np.asarray(erfc(x))


def _compute_bessel(function: Callable[[Floats, Floats], Floats], x: Floats, order: Floats) -> Floats:
    """Compute a Bessel function of whole order; `#NUM!` for an order below 0."""
    n = np.trunc(order)
    return np.where(n < 0, NUM, function(np.where(n < 0, 0.0, n), x))


@excel("BESSELJ", OneCell, OneCell)
@numbers_only
def bessel_j(x: Floats, order: Floats) -> Floats:
    """Bessel function of the first kind."""
    from scipy.special import jv

    return _compute_bessel(jv, x, order)


@excel("BESSELI", OneCell, OneCell)
@numbers_only
def bessel_i(x: Floats, order: Floats) -> Floats:
    """Return the modified Bessel function of the first kind."""
    from scipy.special import iv

    return _compute_bessel(iv, x, order)


@excel("BESSELY", OneCell, OneCell)
@numbers_only
def bessel_y(x: Floats, order: Floats) -> Floats:
    """Bessel function of the second kind; `#NUM!` unless `x` is above 0."""
    from scipy.special import yv

    return np.where(x <= 0, NUM, _compute_bessel(yv, np.where(x <= 0, 1.0, x), order))


@excel("BESSELK", OneCell, OneCell)
@numbers_only
def bessel_k(x: Floats, order: Floats) -> Floats:
    """Return the modified Bessel function of the second kind; `#NUM!` unless `x` is above 0."""
    from scipy.special import kv

    return np.where(x <= 0, NUM, _compute_bessel(kv, np.where(x <= 0, 1.0, x), order))


@excel("DELTA", OneCell, OneCell(default=None))
@numbers_only
def delta(x: Floats, y: Floats | None = None) -> Floats:
    """1 if the numbers are equal, else 0; the second one is 0 if left out."""
    return np.where(x == (0.0 if y is None else y), 1.0, 0.0)


@excel("GESTEP", OneCell, OneCell(default=None))
@numbers_only
def step(x: Floats, threshold: Floats | None = None) -> Floats:
    """1 from a threshold on, else 0; the threshold is 0 if left out."""
    return np.where(x >= (0.0 if threshold is None else threshold), 1.0, 0.0)
