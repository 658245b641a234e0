"""How a method's error falls with its trials: theory where there is one, measured runs where there is none.

The error of `n` trials is c·n^s, and 95 of 100 runs lie within hypot(1.96·c·n^s, floor).

- Independent trials: s = −1/2, and c is the reference's own standard error, as of one trial. The runs only check it. Of
  percentiles, c is that of the tolerance: what the reference's distribution within it says (`quantile_need`).
- Latin hypercubes and scrambled nets: they converge too, in the long run at least as fast (Owen 1997, 1998). s is −1/2
  unless the runs fall faster by more than chance; c is that of the runs. The same for weighted trials, with s = −1/2.
  Where the runs lie on no such line, as those of a percentile beside a gap, the law meets what the runs next to the
  tolerance show.
- Trials on a substitute for the workbook: as independent trials, down to a floor that more of them do not lower. The
  floor is bounded from both sides by the runs, for the number of comparisons that are made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import STATISTICS
from xlmc.analysis.studies.methods.curve import NORMAL_95, Curve, Rms, Runs, slope_of
from xlmc.analysis.studies.methods.study import Study

__all__ = ["Law", "law"]

Kind = tuple[str, str]
Floats = NDArray[np.float64]

_HALF: Final = -0.5
_ENDS: Final = ("low", "high")
_STEEPEST: Final = -1.5
_WINDOW: Final = 4
"""Run lengths that one line is fitted to: two decades. Over more, some curves bend."""

_CLEARLY: Final = 3.0
"""Standard errors by which a slope must be steeper than −1/2 to count as steeper."""

_HARDLY: Final = 1e-5
"""Probability below which the runs of independent trials say that theory's constant does not hold here."""

CONFIDENCE: Final = 0.95
"""The confidence of all comparisons of a study together."""


@dataclass(frozen=True, slots=True)
class Law:
    """The errors of one number of a forecast, in its units.

    Attributes:
        constant: c, of one trial; 0 where the number is never off from `least` trials on.
        slope: s.
        least: trials of the shortest runs that it holds for.
        floor: what 95 of 100 runs of any length are off by; 0 where none was found.
        floor_low, floor_high: where that lies, as far as the runs know.
        error: the standard error of the logarithm of the trials that are needed.
    """

    constant: float
    slope: float
    least: float
    floor: float = 0.0
    floor_low: float = 0.0
    floor_high: float = 0.0
    error: float = 0.0

    def reach(self, trials: float) -> float:
        """Return what 95 of 100 runs of so many trials keep within."""
        return float(np.hypot(NORMAL_95 * self.constant * trials**self.slope, self.floor))

    def trials(self, tolerance: float) -> float:
        """How many 95 of 100 runs keep a tolerance with; infinite where the floor is above it."""
        if np.isnan(self.constant) or not tolerance > self.floor:
            return np.inf
        if self.constant == 0.0:
            return self.least
        left = float(np.sqrt(tolerance**2 - self.floor**2)) / NORMAL_95
        return max(float((left / self.constant) ** (1.0 / self.slope)), self.least)


def _comparisons(study: Study) -> int:
    """How many numbers are asked for: a method has as many chances to seem wrong."""
    return sum(study.converges(name, each) for name in study.varying for each in STATISTICS)


def law(study: Study, curve: Curve, kind: Kind) -> Law:
    """Return the law of one number of a method that draws."""
    theory, tolerance = study.reference.theory(*kind, 1), study.tolerance(kind[0])
    lengths = curve.converged
    match curve.method.errors:
        case "independent":
            return _law_of_quantile(study, lengths, kind) or _law_of_independent(lengths, kind, theory, tolerance)
        case "floor":
            return _law_with_floor(study, lengths, kind, theory)
        case "weighted":
            return _fit_law(lengths[-_WINDOW:], kind, tolerance, may_be_steeper=False)
        case _:
            return _fit_law(lengths, kind, tolerance, may_be_steeper=True)


def _law_of_quantile(study: Study, lengths: Sequence[Runs], kind: Kind) -> Law | None:
    """Return the law that meets what a percentile needs; None for other numbers, and where the reference does not know
    it.
    """
    if kind[1] not in _ENDS:
        return None
    tolerance = study.tolerance(kind[0])
    forecast = next(each for each in study.model.forecasts if each.name == kind[0])
    need = study.reference.quantile_need(forecast, kind[1], tolerance)
    if need is None:
        return None
    return _law_that_meets(need.trials / study.reference.acceptance.value, tolerance, lengths[0].budget, need.error)


def _law_that_meets(trials: float, tolerance: float, least: float, error: float) -> Law:
    """Return the law by which so many trials keep the tolerance."""
    return Law(tolerance / NORMAL_95 * trials**0.5, _HALF, least, error=error)


def _law_of_independent(lengths: Sequence[Runs], kind: Kind, theory: float, tolerance: float) -> Law:
    """Return the law of theory, unless the runs contradict it: a quantile may lie where there is hardly any density."""
    from scipy.special import chdtr, chdtrc

    if not theory > 0.0:
        return _fit_law(lengths, kind, tolerance, may_be_steeper=False)
    ratios = [(each.n - 1, each.spread * runs.budget**0.5 / theory) for runs, each in _known_errors(lengths, kind)]
    free = sum(n for n, _ in ratios)
    squares = sum(n * ratio**2 for n, ratio in ratios)
    constant = theory
    if free and min(chdtr(free, squares), chdtrc(free, squares)) < _HARDLY:
        constant = theory * float(np.sqrt(squares / free))
    return Law(constant, _HALF, lengths[0].budget)


def _fit_law(lengths: Sequence[Runs], kind: Kind, tolerance: float, *, may_be_steeper: bool) -> Law:
    from scipy.special import chdtrc

    exact = _exact_from(lengths, kind)
    if exact is not None:
        return Law(0.0, _HALF, exact)
    known = [(runs, each) for runs, each in _known_errors(lengths, kind) if each.value > 0.0]
    least = float(lengths[0].budget)
    if not known:
        return Law(np.nan, _HALF, least)
    budgets = np.array([float(runs.budget) for runs, _ in known])
    values = np.array([each.value for _, each in known])
    weights = np.array([2.0 * (each.n - 1) for _, each in known])
    slope = _slope(budgets, values, weights) if may_be_steeper else _HALF
    height = float(np.average(np.log(values) - slope * np.log(budgets), weights=weights))
    off = np.log(values) - (height + slope * np.log(budgets))
    if tolerance > 0.0 and len(known) > 2 and chdtrc(len(known) - 2, float(np.sum(weights * off**2))) < _HARDLY:
        trials = _trials_between(budgets, NORMAL_95 * values / tolerance)
        return _law_that_meets(trials, tolerance, least, float(weights[-1]) ** -0.5 / -_HALF)
    return Law(float(np.exp(height)), slope, least, error=float(np.sum(weights)) ** -0.5 / abs(slope))


def _trials_between(budgets: Floats, reach: Floats) -> float:
    """Where what runs keep within, in tolerances, is one from then on: between two lengths, or beyond the longest."""
    beyond = np.flatnonzero(reach > 1.0)
    if not beyond.size:
        return float(budgets[0])
    last = beyond[-1]
    if last == len(budgets) - 1:
        return float(budgets[-1] * reach[-1] ** (-1.0 / _HALF))
    share = np.log(reach[last]) / np.log(reach[last] / reach[last + 1])
    return float(budgets[last] * (budgets[last + 1] / budgets[last]) ** share)


def _slope(budgets: Floats, values: Floats, weights: Floats) -> float:
    """−1/2, unless the line is steeper by more than chance. A value of n runs has the variance 1/(2(n − 1)) in logs."""
    value = slope_of(budgets.tolist(), values.tolist(), weights.tolist())
    if np.isnan(value):
        return _HALF
    across = np.log(budgets)
    error = float(np.sum(weights * (across - np.average(across, weights=weights)) ** 2)) ** -0.5
    return max(value, _STEEPEST) if value < _HALF - _CLEARLY * error else _HALF


def _law_with_floor(study: Study, lengths: Sequence[Runs], kind: Kind, theory: float) -> Law:
    """Theory's errors of independent trials, on a floor: a mean error, and one that varies with the seed.

    Only the lengths that could show a floor at the tolerance are looked at; where no run was so long, the longest.
    """
    from scipy.special import chdtri, stdtrit

    known = _known_errors(lengths, kind)
    if not known:
        return Law(np.nan, _HALF, lengths[0].budget)
    tolerance = study.tolerance(kind[0])
    constant = theory if theory > 0.0 else 0.0
    able = [pair for pair in known if NORMAL_95 * constant * pair[0].budget ** _HALF <= tolerance]
    near = able if able and constant > 0.0 else known[-1:]
    rare = (1.0 - CONFIDENCE) / _comparisons(study) / 4.0  # mean and spread, each from both sides
    free = sum(each.n - 1 for _, each in near)
    variance = sum((each.n - 1) * each.spread**2 for _, each in near) / free
    noise = sum((each.n - 1) * constant**2 / runs.budget for runs, each in near) / free
    extra = [float(np.sqrt(max(variance * free / chdtri(free, p) - noise, 0.0))) for p in (rare, 1.0 - rare)]
    last = near[-1][1]
    own = float(np.nan_to_num(getattr(study.reference.errors[kind[0]], kind[1])))
    chance = float(-stdtrit(last.n - 1, rare)) * float(np.hypot(last.spread / last.n**0.5, own))
    low = float(np.hypot(max(abs(last.bias) - chance, 0.0), NORMAL_95 * extra[0]))
    high = float(np.hypot(abs(last.bias) + chance, NORMAL_95 * extra[1]))
    return Law(
        constant, _HALF, lengths[0].budget, min(max(_likely_floor(last, own, variance, noise), low), high), low, high
    )


def _likely_floor(last: Rms, own: float, variance: float, noise: float) -> float:
    """Return the floor itself, as far as it is more than what chance would give."""
    bias = max(last.bias**2 - last.spread**2 / last.n - own**2, 0.0)
    return float(np.sqrt(bias + NORMAL_95**2 * max(variance - noise, 0.0)))


def _known_errors(lengths: Sequence[Runs], kind: Kind) -> list[tuple[Runs, Rms]]:
    """Return the run lengths with two numbers or more."""
    return [(runs, each) for runs in lengths if (each := runs.errors[kind]).n >= 2]


def _exact_from(lengths: Sequence[Runs], kind: Kind) -> float | None:
    """Trials from which on no run was off at all, as those of whole numbers; None if the longest ones are."""
    value = None
    for runs in reversed(lengths):
        if runs.errors[kind].value != 0.0:
            break
        value = float(runs.budget)
    return value
