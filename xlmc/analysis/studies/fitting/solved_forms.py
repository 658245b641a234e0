"""Families whose likelihood is highest where an equation of one unknown holds, or where a search finds it.

For the triangular family the two ends are searched for, and for given ends the likeliest value is one of the measured
ones. Its standard errors come from samples drawn from the fitted distribution (a parametric bootstrap), because its
likelihood has a corner where theory asks for a smooth top. Source: S. Kotz and J. R. van Dorp, *Beyond Beta*, 2004,
section 1.4.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.analysis.studies.fitting.candidate import Candidate, Errors, Floats, Params, Unfit, refuse

__all__ = ["SOLVED_FORMS", "TRIANGULAR", "maximise", "root"]

_AT_ZERO = frozenset({"Location"})
_MOST_FREEDOM = 200.0
"""Student's t with more degrees of freedom is a normal to the eye, and to any sample."""

_BOOTSTRAP_SAMPLES, _BOOTSTRAP_SEED = 100, 999
_NEAREST, _FARTHEST = -12.0, 5.0
"""Logarithms of the least and the greatest distance of an end from the values, in widths of these."""


def _gamma(x: Floats) -> Params:
    from scipy.special import digamma

    refuse(x[0] <= 0, "it takes values above 0 only")
    gap = float(np.log(x.mean()) - np.log(x).mean())
    shape = root(lambda k: float(digamma(k) - np.log(k)) + gap, 0.1, 10.0)
    return 0.0, float(x.mean()) / shape, shape


def _gamma_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    from scipy.special import gammaln

    z = (x - location) / scale
    return np.asarray((shape - 1) * np.log(z) - z - gammaln(shape) - np.log(scale))


def _gamma_cdf(x: Floats, location: float, scale: float, shape: float) -> Floats:
    from scipy.special import gammainc

    return np.asarray(gammainc(shape, (x - location) / scale))


def _weibull(x: Floats) -> Params:
    refuse(x[0] <= 0, "it takes values above 0 only")
    logs = np.log(x) - np.log(x[-1])

    def slope(shape: float) -> float:
        powers = np.exp(shape * logs)
        return float(np.sum(powers * logs) / np.sum(powers) - 1 / shape - logs.mean())

    shape = root(slope, 0.1, 10.0)
    return 0.0, float(x[-1] * np.mean(np.exp(shape * logs)) ** (1 / shape)), shape


def _weibull_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    z = np.log((x - location) / scale)
    return np.asarray(np.log(shape / scale) + (shape - 1) * z - np.exp(shape * z))


def _weibull_cdf(x: Floats, location: float, scale: float, shape: float) -> Floats:
    return np.asarray(-np.expm1(-(((x - location) / scale) ** shape)))


def _maximum_extreme(x: Floats) -> Params:
    mean, spread = float(x.mean()), float(x.std())
    z = (x - mean) / spread

    def slope(scale: float) -> float:
        weights = np.exp(-(z - z[0]) / scale)
        return scale + float(np.sum(z * weights) / np.sum(weights))

    scale = root(slope, 0.1, 2.0)
    likeliest = float(z[0]) - scale * float(np.log(np.mean(np.exp(-(z - z[0]) / scale))))
    return mean + spread * likeliest, spread * scale


def _maximum_log(x: Floats, likeliest: float, scale: float) -> Floats:
    z = (x - likeliest) / scale
    return np.asarray(-z - np.exp(-z) - np.log(scale))


def _maximum_cdf(x: Floats, likeliest: float, scale: float) -> Floats:
    return np.asarray(np.exp(-np.exp(-(x - likeliest) / scale)))


def _minimum_extreme(x: Floats) -> Params:
    likeliest, scale = _maximum_extreme(-x[::-1])
    return -likeliest, scale


def _minimum_log(x: Floats, likeliest: float, scale: float) -> Floats:
    return _maximum_log(-x, -likeliest, scale)


def _minimum_cdf(x: Floats, likeliest: float, scale: float) -> Floats:
    return np.asarray(-np.expm1(-np.exp((x - likeliest) / scale)))


def _logistic(x: Floats) -> Params:
    mean, spread = float(x.mean()), float(x.std())
    z = (x - mean) / spread
    middle, log_scale = maximise(lambda p: float(np.sum(_logistic_log(z, p[0], np.exp(p[1])))), [0.0, np.log(0.55)])
    return mean + spread * float(middle), spread * float(np.exp(log_scale))


def _logistic_log(x: Floats, mean: float, scale: float) -> Floats:
    z = np.abs(x - mean) / scale
    return np.asarray(-z - 2 * np.log1p(np.exp(-z)) - np.log(scale))


def _logistic_cdf(x: Floats, mean: float, scale: float) -> Floats:
    from scipy.special import expit

    return np.asarray(expit((x - mean) / scale))


def _student(x: Floats) -> Params:
    """Fit Student's t, on values measured from their median in interquartile ranges, from three degrees of
    freedom up.
    """
    quarter, middle, three_quarters = (float(value) for value in np.percentile(x, [25, 50, 75]))
    spread = three_quarters - quarter
    refuse(not spread > 0, "half of the values are equal")
    z = (x - middle) / spread
    values = maximise(
        lambda p: float(np.sum(_student_log(z, p[0], np.exp(p[1]), np.exp(p[2])))), [0.0, -0.4, np.log(3)]
    )
    midpoint, scale, freedom = float(values[0]), float(np.exp(values[1])), float(np.exp(values[2]))
    refuse(freedom > _MOST_FREEDOM, "the values have no heavier tails than the normal's")
    refuse(freedom < 0.1, "its likelihood has no highest point")
    return middle + spread * midpoint, spread * scale, freedom


def _student_log(x: Floats, midpoint: float, scale: float, freedom: float) -> Floats:
    from scipy.special import betaln

    z = (x - midpoint) / scale
    height = -betaln(0.5, freedom / 2) - np.log(freedom) / 2 - np.log(scale)
    return np.asarray(height - (freedom + 1) / 2 * np.log1p(z * z / freedom))


def _student_cdf(x: Floats, midpoint: float, scale: float, freedom: float) -> Floats:
    from scipy.special import stdtr

    return np.asarray(stdtr(freedom, (x - midpoint) / scale))


def _beta(x: Floats) -> Params:
    refuse(x[0] <= 0 or x[-1] >= 1, "it is fitted to values between 0 and 1 only")
    mean, variance = float(x.mean()), float(x.var())
    both = max(mean * (1 - mean) / variance - 1, 0.1)
    start = [np.log(mean * both), np.log((1 - mean) * both)]
    values = maximise(lambda p: float(np.sum(_beta_log(x, 0.0, 1.0, np.exp(p[0]), np.exp(p[1])))), start)
    return 0.0, 1.0, float(np.exp(values[0])), float(np.exp(values[1]))


def _beta_log(x: Floats, low: float, high: float, alpha: float, beta: float) -> Floats:
    from scipy.special import betaln

    z = (x - low) / (high - low)
    return np.asarray((alpha - 1) * np.log(z) + (beta - 1) * np.log1p(-z) - betaln(alpha, beta) - np.log(high - low))


def _beta_cdf(x: Floats, low: float, high: float, alpha: float, beta: float) -> Floats:
    from scipy.special import betainc

    return np.asarray(betainc(alpha, beta, (x - low) / (high - low)))


SOLVED_FORMS = (
    Candidate("Gamma", ("Location", "Scale", "Shape"), _gamma, _gamma_log, _gamma_cdf, fixed=_AT_ZERO),
    Candidate("Weibull", ("Location", "Scale", "Shape"), _weibull, _weibull_log, _weibull_cdf, fixed=_AT_ZERO),
    Candidate("Maximum Extreme", ("Likeliest", "Scale"), _maximum_extreme, _maximum_log, _maximum_cdf),
    Candidate("Minimum Extreme", ("Likeliest", "Scale"), _minimum_extreme, _minimum_log, _minimum_cdf),
    Candidate("Logistic", ("Mean", "Scale"), _logistic, _logistic_log, _logistic_cdf),
    Candidate("Student's t", ("Midpoint", "Scale", "Degrees of freedom"), _student, _student_log, _student_cdf),
    Candidate("Beta", ("Low", "High", "Alpha", "Beta"), _beta, _beta_log, _beta_cdf, fixed=frozenset({"Low", "High"})),
)


def _triangular_likeliest(x: Floats, low: float, high: float) -> tuple[float, float]:
    """Return the best of the values as the corner, and the log-likelihood there."""
    n, width = x.size, high - low
    rise, fall = np.log((x - low) / width), np.log((high - x) / width)
    before, after, rank = np.zeros(n), np.zeros(n), np.arange(n)
    rise[:-1].cumsum(out=before[1:])
    fall[:0:-1].cumsum(out=after[-2::-1])
    totals = before - rank * rise + after - rank[::-1] * fall
    best = int(totals.argmax())
    return float(x[best]), float(totals[best] + n * np.log(2 / width))


def _triangular_ends(x: Floats, tolerance: float = 1e-8) -> tuple[float, float]:
    """Beyond the smallest and the largest value, where neither has density 0."""
    spread = float(x[-1] - x[0])

    def ends_at(point: Floats) -> tuple[float, float]:
        return float(x[0] - spread * np.exp(point[0])), float(x[-1] + spread * np.exp(point[1]))

    def log_likelihood(point: Floats) -> float:
        # Ends on a value, or far away, are as good as ends near there: a slope keeps the search from wandering.
        within = np.minimum(np.maximum(point, _NEAREST), _FARTHEST)
        return _triangular_likeliest(x, *ends_at(within))[1] - float(np.abs(point - within).sum())

    return ends_at(np.clip(maximise(log_likelihood, [-2.5, -2.5], tolerance=tolerance), _NEAREST, _FARTHEST))


def _triangular(x: Floats) -> Params:
    low, high = _triangular_ends(x)
    return low, _triangular_likeliest(x, low, high)[0], high


def _triangular_log(x: Floats, low: float, likeliest: float, high: float) -> Floats:
    inside = (x >= low) & (x <= high)
    # A corner at an end leaves one slope: the other is not asked for.
    rise = (x - low) / np.where(likeliest > low, likeliest - low, 1.0)
    fall = (high - x) / np.where(high > likeliest, high - likeliest, 1.0)
    height = np.where(x < likeliest, rise, np.where(x > likeliest, fall, 1.0))
    return np.where(inside, np.log(2 / (high - low)) + np.log(height), -np.inf)


def _triangular_cdf(x: Floats, low: float, likeliest: float, high: float) -> Floats:
    width = high - low
    rise = (np.clip(x, low, likeliest) - low) ** 2 / (width * max(likeliest - low, 1e-300))
    fall = (high - np.clip(x, likeliest, high)) ** 2 / (width * max(high - likeliest, 1e-300))
    return np.where(x <= likeliest, rise, 1 - fall)


def _draw_triangular(u: Floats, low: float, likeliest: float, high: float) -> Floats:
    width, share = high - low, (likeliest - low) / (high - low)
    rising = low + np.sqrt(u * width * (likeliest - low))
    falling = high - np.sqrt((1 - u) * width * (high - likeliest))
    return np.where(u < share, rising, falling)


def _triangular_errors(x: Floats, params: Params) -> Errors:
    random, result = np.random.default_rng(_BOOTSTRAP_SEED), []
    for _ in range(_BOOTSTRAP_SAMPLES):
        sample = np.sort(_draw_triangular(random.random(x.size), *params))
        try:
            low, high = _triangular_ends(sample, 1e-2)
        except Unfit:
            continue
        result.append((low, _triangular_likeliest(sample, low, high)[0], high))
    if len(result) < _BOOTSTRAP_SAMPLES / 2:
        return None, None, None
    return tuple(float(error) for error in np.std(result, axis=0, ddof=1))


TRIANGULAR = Candidate(
    "Triangular",
    ("Low", "Likeliest", "High"),
    _triangular,
    _triangular_log,
    _triangular_cdf,
    errors=_triangular_errors,
    errors_from=f"parametric bootstrap of {_BOOTSTRAP_SAMPLES} samples",
    costly=True,
)


def maximise(
    log_likelihood: Callable[[Floats], float], start: list[float], *, tolerance: float = 1e-10, most: int = 4000
) -> Floats:
    """Find the highest point, by the simplex method, begun twice so that a simplex that collapsed early is noticed.

    Args:
        log_likelihood: of parameters that may be any numbers.
        start: a point near it.
        tolerance: of the parameters.
        most: how often each of the two may ask for it.

    Raises:
        Unfit: it has no highest point that can be found.
    """
    from scipy.optimize import minimize

    def loss(point: Floats) -> float:
        value = log_likelihood(point)
        return -value if np.isfinite(value) else 1e300

    point = np.array(start, dtype=float)
    for _ in range(2):
        options = {"xatol": tolerance, "fatol": tolerance / 10 * (1 + abs(loss(point))), "maxfev": most}
        result = minimize(loss, point, method="Nelder-Mead", options=options)
        point = np.asarray(result.x)
    if not result.success or not result.fun < 1e300:
        raise Unfit("its likelihood has no highest point")
    return point


def root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Find the zero of a rising function of a positive number; the bracket is widened as needed.

    Raises:
        Unfit: it does not, within 1e-6 to 1e6.
    """
    from scipy.optimize import brentq

    while rising(low) > 0 and low > 1e-6:
        low /= 4
    while rising(high) < 0 and high < 1e6:
        high *= 4
    if not rising(low) <= 0 <= rising(high):
        raise Unfit("its likelihood has no highest point")
    return float(brentq(rising, low, high, xtol=1e-14, rtol=1e-14))
