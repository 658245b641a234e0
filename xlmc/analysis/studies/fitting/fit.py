"""Fit every family to the values by maximum likelihood, rank the fits, and say what they may not be taken for.

The distances from the values to a fit (Anderson-Darling, Kolmogorov-Smirnov) are given without p-values: the usual ones
hold for a distribution that was known beforehand, and are far too large for one that was fitted to the same values.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from xlmc.analysis.studies.fitting.candidate import Candidate, Errors, Floats, Params, Unfit, refuse, standard_errors
from xlmc.analysis.studies.fitting.closed_forms import CLOSED_FORMS
from xlmc.analysis.studies.fitting.count_families import COUNTS
from xlmc.analysis.studies.fitting.skewed_forms import SKEWED_FORMS
from xlmc.analysis.studies.fitting.solved_forms import SOLVED_FORMS, TRIANGULAR
from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.number_text import count_text, number_text

__all__ = [
    "CRITERIA",
    "FEW",
    "KINDS",
    "Fitted",
    "Fitting",
    "anderson_darling",
    "cautions",
    "fit",
    "kolmogorov_smirnov",
    "kolmogorov_smirnov_of_counts",
    "parameter_texts",
    "rounded_value",
    "row_to_paste",
    "share_at_most",
]

KINDS: Mapping[str, tuple[Candidate, ...]] = {
    "continuous": (*CLOSED_FORMS, TRIANGULAR, *SOLVED_FORMS, *SKEWED_FORMS),
    "counts": COUNTS,
}
"""What is fitted: densities and probabilities are not compared with each other."""

CRITERIA = ("aic", "bic", "ad", "ks")
_LEAST = 2
_LARGEST = 1e100
"""Beyond it, third powers of values overflow."""
_NEAR, _IN_THE_RACE = 2.0, 10.0

FEW, _ENOUGH = 15, 30
"""Below the first, families cannot be distinguished at all; below the second, hardly."""

_CLOSE = 2.0
"""Families whose AIC differ by less are about equally likely (K. P. Burnham and D. R. Anderson, 2002)."""

_LEAST_DIGITS, _MOST_DIGITS = 6, 17
"""Of a parameter: mostly more than a fit determines; and all that a double has."""

_SAME = 1e-4
"""How far rounding may move the share that lies below a number: less than any fit determines."""

_LOOKED_AT = np.array([0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999])
"""Shares at whose quantiles a distribution is compared with what rounding makes of it."""


_TOO_FEW_DIGITS = "the values have too few digits, or are too large or small, for its parameters"


@dataclass(frozen=True, slots=True)
class Fitted:
    """A family with its maximum-likelihood parameters.

    Attributes:
        parameters: by heading.
        errors: their standard errors; None for one without.
        errors_from: what these come from.
        fixed: headings that were not estimated.
        aic, bic: Akaike's and the Bayesian information criterion: smaller is better.
        ad, ks: Anderson-Darling's A² (None for counts) and Kolmogorov-Smirnov's D: smaller is better.
    """

    name: str
    parameters: Mapping[str, float]
    errors: Mapping[str, float | None]
    errors_from: str
    fixed: frozenset[str]
    log_likelihood: float
    aic: float
    bic: float
    ad: float | None
    ks: float


@dataclass(frozen=True, slots=True, repr=False)
class Fitting:
    """All families that could be fitted, the best first.

    Attributes:
        kind: `continuous` or `counts`.
        n: how many values there were.
        by: what they are ranked by.
        unfit: family -> why it was not fitted.
        cautions: what a person should know, in words.
    """

    kind: str
    n: int
    by: str
    fits: tuple[Fitted, ...]
    unfit: Mapping[str, str]
    cautions: tuple[str, ...]

    def __repr__(self) -> str:
        lines = [f"{count_text(self.n)} values as {self.kind}, the best by {self.by.upper()} first:"]
        for each in self.fits[:5]:
            numbers = ", ".join(f"{heading} {number_text(value)}" for heading, value in each.parameters.items())
            lines.append(f"  {each.name}: {numbers}; {self.by.upper()} {number_text(getattr(each, self.by))}")
        return "\n".join([*lines, *self.cautions])


def fit(values: ArrayLike, *, kind: str | None = None, by: str = "aic", errors: bool = True) -> Fitting:
    """Fit the families of a kind.

    Args:
        values: `(n,)`, two or more, not all equal.
        kind: `continuous` or `counts`; None: counts where every value is a whole number from 0 up.
        by: one of `CRITERIA`.
        errors: whether standard errors of the parameters are worked out.

    Raises:
        SimulationError: there are too few values, all are equal, or they are no counts where counts are asked for.
    """
    x = np.sort(np.asarray(values, dtype=float).ravel())
    _refuse_hopeless(x)
    whole = bool(np.all((x == np.floor(x)) & (x >= 0)))
    kind = kind or ("counts" if whole else "continuous")
    if kind == "counts" and not whole:
        raise SimulationError("not every value is a whole number from 0 up", hint="Fit them as continuous values")
    with np.errstate(all="ignore"):  # what is no number is refused, or ends an interval
        result, unfit = _estimates(kind, x)
        fits = _judged(kind, x, result, errors=errors)
    fits.sort(key=lambda each: (_criterion(each, by), each.aic))
    near = sorted(fits, key=lambda each: each.aic)
    rivals = [each.name for each in near if each.aic - near[0].aic < _NEAR]
    return Fitting(kind, x.size, by, tuple(fits), unfit, cautions(x.size, rivals))


def _judged(kind: str, x: Floats, result: Sequence[tuple[Candidate, Params, float]], *, errors: bool) -> list[Fitted]:
    """Return the families found with their errors and their distances from the values."""
    best = min((_aic(candidate, top) for candidate, _, top in result), default=0.0)
    fits = []
    for candidate, params, top in result:
        sentences: tuple[Errors, str] = (None,) * len(params), "not worked out"
        if errors:
            sentences = _errors(candidate, params, x, _aic(candidate, top) - best < _IN_THE_RACE)
        fits.append(_judge_fit(candidate, params, top, x, kind, *sentences))
    return fits


def _refuse_hopeless(x: Floats) -> None:
    if x.size < _LEAST:
        count = "no value" if x.size == 0 else "one value"
        hint = (
            "One measurement justifies a uniform range only: choose Low and High so that nothing possible is left out"
        )
        raise SimulationError(f"there is {count} to fit", hint=hint)
    if not np.isfinite(x).all():
        raise SimulationError("a value is not a finite number", hint="Correct it, or leave it out")
    if max(-x[0], x[-1]) > _LARGEST:
        raise SimulationError(
            f"a value is beyond {number_text(_LARGEST)}: too large to fit", hint="Give them in a larger unit"
        )
    if x[0] == x[-1]:
        hint = "Equal measurements say nothing of the spread: choose Low and High from what the measurement resolves"
        raise SimulationError(f"all {count_text(x.size)} values are equal", hint=hint)


def _estimates(kind: str, x: Floats) -> tuple[list[tuple[Candidate, Params, float]], dict[str, str]]:
    """Return the families with their parameters and the height of the likelihood; and why others have none."""
    result: list[tuple[Candidate, Params, float]] = []
    unfit: dict[str, str] = {}
    for candidate in KINDS[kind]:
        try:
            params = candidate.estimate(x)
            refuse(not np.isfinite(params).all(), _TOO_FEW_DIGITS)
            top = candidate.log_likelihood(x, params)
            refuse(not np.isfinite(top), "its likelihood has no highest point")
            result.append((candidate, params, top))
        except Unfit as reason:
            unfit[candidate.name] = str(reason)
        except ArithmeticError:  # a spread that is 0 to the last digit, a power beyond the largest number
            unfit[candidate.name] = _TOO_FEW_DIGITS
    return result, unfit


def _aic(candidate: Candidate, top: float) -> float:
    return 2 * candidate.free - 2 * top


def _judge_fit(
    candidate: Candidate, params: Params, top: float, x: Floats, kind: str, errors: Errors, errors_from: str
) -> Fitted:
    if kind == "counts":
        ad, ks = None, kolmogorov_smirnov_of_counts(x, lambda k: np.asarray(candidate.cdf(k, *np.asarray(params))))
    else:
        at = np.asarray(candidate.cdf(x, *np.asarray(params)))
        ad, ks = anderson_darling(at), kolmogorov_smirnov(at)
    return Fitted(
        name=candidate.name,
        parameters=dict(zip(candidate.headings, params, strict=True)),
        errors=dict(zip(candidate.headings, errors, strict=True)),
        errors_from=errors_from,
        fixed=candidate.fixed,
        log_likelihood=top,
        aic=_aic(candidate, top),
        bic=candidate.free * float(np.log(x.size)) - 2 * top,
        ad=ad,
        ks=ks,
    )


def _errors(candidate: Candidate, params: Params, x: Floats, costly: bool) -> tuple[Errors, str]:
    if candidate.errors is not None:
        if candidate.costly and not costly:
            return (None,) * len(params), f"not worked out: AIC more than {number_text(_IN_THE_RACE)} above the best"
        return candidate.errors(x, params), candidate.errors_from
    free = [index for index, heading in enumerate(candidate.headings) if heading not in candidate.fixed]
    return standard_errors(lambda moved: candidate.log_likelihood(x, moved), params, free), candidate.errors_from


def _criterion(fitted: Fitted, by: str) -> float:
    value = {"aic": fitted.aic, "bic": fitted.bic, "ad": fitted.ad, "ks": fitted.ks}[by]
    return np.inf if value is None else value


def anderson_darling(at: Floats) -> float:
    """A² of the distribution function at the values, `(n,)` rising; infinite where a value lies on its end.

    Source: T. W. Anderson and D. A. Darling, "A test of goodness of fit", 1954.
    """
    n = at.size
    if at[0] <= 0 or at[-1] >= 1:
        return np.inf
    weights = 2 * np.arange(1, n + 1) - 1
    return float(-n - np.sum(weights * (np.log(at) + np.log1p(-at[::-1]))) / n)


def kolmogorov_smirnov(at: Floats) -> float:
    """Return the largest distance between the distribution function, `(n,)` rising at the values, and the steps of
    these.
    """
    n = at.size
    steps = np.arange(n + 1) / n
    return float(max(np.max(steps[1:] - at), np.max(at - steps[:-1])))


def kolmogorov_smirnov_of_counts(x: Floats, cdf: Callable[[Floats], Floats]) -> float:
    """Return the same for whole numbers `(n,)`, rising: both functions are steps, compared on every whole number."""
    k = np.unique(np.concatenate([x - 1, x]))
    steps = np.searchsorted(x, k, side="right") / x.size
    return float(np.max(np.abs(steps - cdf(k))))


def cautions(n: int, rivals: list[str]) -> tuple[str, ...]:
    """Return what a person should know before using a fit.

    Args:
        n: how many values there are.
        rivals: the families whose AIC lies within 2 of the best, the best first.
    """
    sentences = []
    if n < FEW:
        sentences.append(
            f"{n} values cannot tell families of distributions apart. Their order is chance as much as evidence; a "
            "uniform range, wide enough for every value that is possible, claims less"
        )
    elif n < _ENOUGH:
        sentences.append(
            f"{n} values tell families of distributions apart only roughly; a uniform range, wide enough for every "
            "value that is possible, claims less"
        )
    if len(rivals) > 1:
        sentences.append(
            f"{_join_names(rivals)} describe the values about equally well: their AIC lie within {number_text(_CLOSE)}"
        )
    return tuple(sentences)


def _join_names(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"


def share_at_most(fitted: Fitted, x: ArrayLike) -> Floats:
    """Return the share that a fitted family has at most at each of `(n,)` numbers, those outside its support
    included.
    """
    return FAMILIES[fitted.name].cdf(np.asarray(x, dtype=float), **_by_key(fitted))


def _by_key(fitted: Fitted) -> dict[str, float]:
    return {
        spec.key: fitted.parameters[heading]
        for spec in FAMILIES[fitted.name].parameters
        for heading in spec.headings
        if heading in fitted.parameters
    }


def parameter_texts(fitted: Fitted, least: int = _LEAST_DIGITS, same: float = _SAME) -> dict[str, str]:
    """Heading -> its parameter, to as few digits as leave the distribution what it is.

    A mean of 1234567 beside a standard deviation of 0.05, or two ends that differ in the eighth digit, need many.

    Args:
        fitted: the distribution.
        least: digits that a parameter has at least.
        same: how far rounding may move the share that lies below a number.
    """
    family, named = FAMILIES[fitted.name], _by_key(fitted)
    at = family.ppf(_LOOKED_AT, *family.bind((), named))
    own = share_at_most(fitted, at)
    for digits in range(least, _MOST_DIGITS):
        texts = {heading: f"{value:.{digits}g}" for heading, value in fitted.parameters.items()}
        rounded = replace(fitted, parameters={heading: float(text) for heading, text in texts.items()})
        if (np.abs(share_at_most(rounded, at) - own) <= same).all():  # no numbers where it is no distribution any more
            return texts
    return {heading: repr(value) for heading, value in fitted.parameters.items()}


def rounded_value(fitted: Fitted, value: float) -> float:
    """Write a number among the values, to as many digits as distinguish it from its neighbours; see
    `parameter_texts`.
    """
    own = share_at_most(fitted, value)
    rounded = (float(f"{value:.{digits}g}") for digits in range(_LEAST_DIGITS, _MOST_DIGITS))
    return next((each for each in rounded if abs(share_at_most(fitted, each) - own) <= _SAME), value)


def row_to_paste(fitted: Fitted, name: str, source: str) -> dict[str, str]:
    """Heading -> what stands under it."""
    return {"Name": name, "Distribution": fitted.name, **parameter_texts(fitted), "Source": source}
