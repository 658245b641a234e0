"""What calls that ask for results of a run get: `RiskMean(B9)`, `CB.GetForePercentFN(B9, 90)`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell, host_of
from xlmc.excel.formula import ir
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.in_cells.result_functions import CRYSTAL_BALL_STATISTICS, Limits, ResultCall
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.loop.forecast_result import ForecastResult
from xlmc.montecarlo.number_text import number_text
from xlmc.montecarlo.sampling.draws import Draw
from xlmc.montecarlo.statistics import rank_correlation

__all__ = ["Answers", "RunFacts", "Simulations"]

Simulations = Mapping[int, Sequence[ForecastResult]]
"""Number of a simulation, from 1 -> the results of its forecasts."""

_Numbers = Callable[[ir.Expression], float | None]
"""Gives the number that an argument is; otherwise None."""


@dataclass(frozen=True, slots=True)
class RunFacts:
    """What of a run cells may ask for beside its forecasts.

    Attributes:
        trials: that were run.
        most: that were asked for.
        assumptions: of the workbook.
        draws: name of an assumption -> how it is drawn, as far as it is.
    """

    trials: int
    most: int
    assumptions: Sequence[Assumption]
    draws: Mapping[str, Draw]


@dataclass(frozen=True, slots=True)
class Answers:
    """What the calls that ask for results get.

    Attributes:
        simulations: the run itself, which is the first, and those of the other values of `RiskSimtable`.
        run: the facts of the first.
    """

    simulations: Simulations
    run: RunFacts

    def answer(self, asked: ResultCall, numbers: _Numbers) -> ir.Expression:
        """Return what a call shows: a number or a text, or an error where there is none.

        Args:
            asked: the call.
            numbers: of its arguments.

        Raises:
            FormulaError: it is about a simulation that was not run.
        """
        results = self._simulated(asked, numbers)
        number = None
        if asked.number is not None:
            number = numbers(asked.number)
            if number is None:
                return ir.ErrorLiteral(ErrorCode.VALUE)
        if asked.what in ("assumption", "percent of the assumption"):
            return self._of_assumption(asked, number)
        if asked.of is None:
            if asked.what == "preference" and number != 1:
                return ir.ErrorLiteral(ErrorCode.NA)
            return ir.Number(float(self.run.trials if asked.what == "trials run" else self.run.most))
        result = _result(results, asked.of)
        if result is not None and asked.limits is not None:
            result = _between(result, asked.limits, numbers)
        other = None if asked.other is None else _result(results, asked.other)
        if result is None or result.values.size == 0 or (asked.other is not None and other is None):
            return ir.ErrorLiteral(ErrorCode.NA)
        value = _statistic(result, asked, number) if other is None else _correlation(result, other, number)
        return ir.ErrorLiteral(ErrorCode.NUM) if value is None or not np.isfinite(value) else ir.Number(value)

    def _simulated(self, asked: ResultCall, numbers: _Numbers) -> Sequence[ForecastResult]:
        number = 1.0 if asked.simulation is None else numbers(asked.simulation)
        if number is None or number not in self.simulations:
            which = "a simulation by no number" if number is None else f"simulation {number_text(number)}"
            raise FormulaError(f"{asked.function} asks for {which}, and only simulate --scenarios runs further ones")
        return self.simulations[int(number)]

    def _of_assumption(self, asked: ResultCall, number: float | None) -> ir.Expression:
        """Return a percentile of an assumption's distribution; its name (1), or its cutoffs (6 and 7)."""
        assumptions = [
            a
            for a in self.run.assumptions
            if asked.of in (a.cell, host_of(a.cell))
            or (isinstance(asked.of, str) and name_key(asked.of) in map(name_key, a.names))
        ]
        if len(assumptions) != 1 or number is None:
            return ir.ErrorLiteral(ErrorCode.NA)
        (assumption,) = assumptions
        draw = self.run.draws.get(assumption.name) or assumption.checked
        if asked.what == "assumption":
            if number == 1:
                return ir.Text(assumption.name)
            cutoff = assumption.cutoffs.get({6: "lower_cutoff", 7: "upper_cutoff"}.get(int(number), ""))
            return ir.Number(cutoff) if isinstance(cutoff, float) else ir.ErrorLiteral(ErrorCode.NA)
        if draw is None or not draw.fixed or not 0 <= number <= 100:
            return ir.ErrorLiteral(ErrorCode.NUM)
        value = float(draw.percentiles(np.array([number / 100]), {})[0])
        return ir.Number(value) if np.isfinite(value) else ir.ErrorLiteral(ErrorCode.NUM)


def _result(results: Sequence[ForecastResult], of: Cell | str) -> ForecastResult | None:
    for result in results:
        definition = result.definition
        if definition.cell == of or (isinstance(of, str) and name_key(definition.name) == name_key(of)):
            return result
    return None


def _between(result: ForecastResult, limits: Limits, numbers: _Numbers) -> ForecastResult | None:
    """Return the part of the values that a call asks about; None if its limits are no numbers."""
    ends = [None if end is None else numbers(end) for end in (limits.lower, limits.upper)]
    if any(end is None for end, tree in zip(ends, (limits.lower, limits.upper), strict=True) if tree is not None):
        return None
    if limits.percents:
        if not all(end is None or 0 <= end <= 1 for end in ends):
            return None
        ends = [None if end is None else _percentile(result, 100 * end) for end in ends]
    low, high = (given if given is not None else end for given, end in zip(ends, (-np.inf, np.inf), strict=True))
    return result.between(low, high)


def _statistic(result: ForecastResult, asked: ResultCall, number: float | None) -> float | None:
    """One number of a result; None if there is no such percentile, trial or statistic."""
    what = asked.what
    if what == "mean_absolute_deviation":
        return float(np.mean(np.abs(result.values - result.values.mean())))
    if number is None:
        return _by_name(result, what)
    match what:
        case "statistic":
            known = number.is_integer() and 1 <= number <= len(CRYSTAL_BALL_STATISTICS)
            return _by_name(result, CRYSTAL_BALL_STATISTICS[int(number) - 1]) if known else None
        case "percent" | "share" | "share from above":
            percent = number if what == "percent" else 100 * (number if what == "share" else 1 - number)
            return _percentile(result, percent) if 0 <= percent <= 100 else None
        case "certainty":
            return 1 - result.probability_above(number).value
        case "certainty in percent":
            return 100 * (1 - result.probability_above(number).value)
        case "certainty from above":
            return result.probability_above(number).value
        case "trial":
            exists = number.is_integer() and 1 <= number <= result.values.size
            return float(result.values[int(number) - 1]) if exists else None
        case "confidence":
            ends = result.mean_interval(number) if 0 < number < 1 else None
            return None if ends is None else ends[asked.upper]
        case _:
            raise ValueError(what)


def _percentile(result: ForecastResult, percent: float) -> float:
    """Return a percentile; where values repeat, as counts do, the add-ins show one of them: see `Sample.reaching`."""
    value, sample = result.percentile_at(percent).value, result.sample
    repeats = bool((sample.x[1:] == sample.x[:-1]).any())
    return sample.reaching(percent / 100) if repeats and not np.isnan(value) else value


def _correlation(first: ForecastResult, second: ForecastResult, kind: float | None) -> float | None:
    """Pearson's (1) or Spearman's (2) of the trials in which both are numbers; None for any other kind."""
    x, y = first.column, second.column
    both = ~(np.isnan(x) | np.isnan(y))
    if both.sum() < 2 or kind not in (1, 2):
        return None
    if kind == 2:
        return rank_correlation(x[both], y[both]).value
    with np.errstate(all="ignore"):
        return float(np.corrcoef(x[both], y[both])[0, 1])


def _by_name(result: ForecastResult, what: str) -> float:
    value = getattr(result.statistics, what)
    return float(value) if what == "trials" else float(value.value)
