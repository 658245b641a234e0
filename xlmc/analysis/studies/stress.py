"""Stress: the answers where one assumption lies in its low or high tail, and which inputs set some answers apart.

Both look at parts of one run. The trials in which an assumption is among the lowest tenth of its accepted values are
what a run would accept if it were drawn from there, with all that is correlated with it or depends on it. The trials in
which a forecast lies above its 90th percentile, or in any other range, have inputs of their own: where the median of an
input lies far from that of all trials, it is what makes these answers.

Errors. A statistic of a part is pulled by each of its trials, as the same statistic of a run is (`paired_statistics`).
Where the limit of the part is a quantile, the limit is uncertain, too: a trial that lies below it pushes it down, and
with it the statistic moves by what the trials at the limit pull it by. With p the pulls of the part of share s, c the
mean of the pulls of its trials next to the limit times their number, and n the trials of the run, each trial so adds
c (s − [it is in the part])/(n s). The same trials pull the statistic of all; the error of the difference is the root of
the sum of the squared differences.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final, TypedDict

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.paired_statistics import (
    Accepted,
    Statistic,
    mean_of,
    quantile_of,
    share_above,
    share_of,
)
from xlmc.analysis.studies.comparison.variations import names_of_rows, with_plain_sampling
from xlmc.analysis.studies.shown import Shown
from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import with_error
from xlmc.montecarlo.statistics.proportions import least_error

__all__ = [
    "MOST",
    "SCENARIO",
    "SHARE",
    "Moved",
    "Part",
    "Scenario",
    "StressArguments",
    "Stressed",
    "Tail",
    "stress",
]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Tell = Callable[[str], None]

SHARE: Final = 10.0
SCENARIO: Final = "above P90"

MOST: Final = 20
"""Forecasts that are shown where none is named, and assumptions for each of them."""

_LEAST: Final = 30
"""Trials that a part must have for a statistic of it."""

_SURE: Final = 3.0
"""Errors by which a median must have moved for an input to be said to distinguish a part."""

_NUMBER: Final = r"(?P<p{0}>[pP])?(?P<x{0}>[-+]?(?:\d[\d,]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?P<c{0}>\s*%)?"
_ONE_SIDED: Final = re.compile(rf"(?P<side>above|below)\s+{_NUMBER.format(1)}", re.IGNORECASE)
_BETWEEN: Final = re.compile(rf"between\s+{_NUMBER.format(1)}\s+(?:and|to)\s+{_NUMBER.format(2)}", re.IGNORECASE)


class StressArguments(TypedDict, total=False):
    """The arguments of `stress` beside the model."""

    share: float
    assumptions: Iterable[str]
    forecasts: Iterable[str]
    scenarios: Sequence[str]
    trials: int | None
    seed: int | None
    engine: str | None
    jobs: int
    tell: Tell | None


@dataclass(frozen=True, slots=True)
class Part:
    """The answers of one forecast in some of the trials.

    Attributes:
        trials: how many they are.
        numbers: `mean`, `low`, `high` of the central range, `above` its threshold; of answers that are counted the mean
            is a share, and stands alone.
        changes: each less that of all trials; empty for all trials themselves.
    """

    trials: int
    numbers: dict[str, Estimate]
    changes: dict[str, Estimate]


@dataclass(frozen=True, slots=True)
class Tail:
    """An assumption restricted to one of its tails.

    Attributes:
        is_high: whether that is the high one.
        limit: the value from which, or up to which, it is restricted.
        trials: accepted ones with it.
        parts: the answers, by the forecasts' names.
    """

    assumption: str
    is_high: bool
    limit: float
    trials: int
    parts: dict[str, Part]


@dataclass(frozen=True, slots=True)
class Moved:
    """An input in some trials of a forecast against all trials.

    Attributes:
        median: in all trials.
        within: its median in these trials.
        shift: how far that has moved, in standard deviations of the input.
        at: the share of all trials that lie below the median of these.
        chance: the probability of so large a shift, or a larger one, of an input that has nothing to do with it.
    """

    assumption: str
    median: Estimate
    within: Estimate
    shift: Estimate
    at: float
    chance: float

    @property
    def is_sure(self) -> bool:
        """Whether it has moved by three errors or more."""
        error = self.shift.error
        return error is not None and abs(self.shift.value) >= _SURE * error and self.shift.value != 0.0


@dataclass(frozen=True, slots=True)
class Scenario:
    """Some trials of a forecast, and what sets their inputs apart.

    Attributes:
        words: as asked: `above P90`.
        low: the least answer that belongs to it; minus infinity for none.
        high: the largest one, likewise.
        trials: how many these are.
        inputs: those that moved most first, 20 at most; none where the trials are too few.
    """

    forecast: str
    words: str
    low: float
    high: float
    trials: int
    inputs: tuple[Moved, ...]


@dataclass(frozen=True, slots=True, repr=False)
class Stressed(Shown):
    """What the answers are where assumptions lie in their tails, and what distinguishes some answers.

    Attributes:
        run: of the workbook.
        share: of the accepted trials in a tail, in percent.
        forecasts: those that are shown.
        forms: how the numbers of each are written; of a share as one.
        texts: of answers that are texts, the one whose share is shown.
        base: the answers of all trials.
        tails: of each assumption the low one, then the high one; each has the forecasts of which the assumption is
            among the 20 that move the mean most.
        scenarios: of each forecast that is a number.
        left_out: forecasts, from the 21st on, that are not shown since nobody asked for them.
        still: assumptions that have one value in all accepted trials, or hardly more.
        valueless: forecasts that are a number in hardly any trial.
    """

    run: RunResult
    share: float
    forecasts: tuple[Forecast, ...]
    forms: dict[str, Form]
    texts: dict[str, str]
    base: dict[str, Part]
    tails: tuple[Tail, ...]
    scenarios: tuple[Scenario, ...]
    left_out: int
    still: tuple[str, ...]
    valueless: tuple[str, ...]

    def ranked(self, forecast: str) -> list[tuple[Tail, Tail]]:
        """Return the low and the high tail of each assumption, those first that move the mean of a forecast most."""

        def moves(pair: tuple[Tail, Tail]) -> float:
            sizes = [abs(each.parts[forecast].changes["mean"].value) for each in pair if forecast in each.parts]
            return max((size for size in sizes if not math.isnan(size)), default=-1.0)

        pairs = list(zip(self.tails[::2], self.tails[1::2], strict=True))
        return sorted(pairs, key=moves, reverse=True)


def stress(
    model: CompiledModel,
    *,
    share: float = SHARE,
    assumptions: Iterable[str] = (),
    forecasts: Iterable[str] = (),
    scenarios: Sequence[str] = (SCENARIO,),
    trials: int | None = None,
    seed: int | None = None,
    engine: str | None = None,
    jobs: int = 1,
    tell: Tell | None = None,
) -> Stressed:
    """Find the answers where each assumption in turn lies in its tails, and the inputs that distinguish some answers.

    The model and its workbook stay as they are. The trials are plain Monte Carlo, whatever its settings say.

    Args:
        model: of a workbook.
        share: of the accepted trials in each tail, in percent; above 0 and up to 50.
        assumptions: names of those that are stressed, joined by commas, `*` for any letters; all that are drawn where
            there are none.
        forecasts: names of those to show, in the same form; the first 20 where there are none.
        scenarios: the answers whose inputs are looked at: `above P90`, `below 20`, `between P5 and P10`; a number
            without P is in the unit of the forecast.
        trials: of the run; as in `Model.simulate`, like what follows.
        seed: of the run.
        engine: of the run.
        jobs: of the run.
        tell: called with what is done.

    Raises:
        SimulationError: an argument is out of its range, no name fits, nothing is drawn, or few trials are accepted.
    """
    if not 0.0 < share <= 50.0:
        raise SimulationError(
            f"A tail of {number_text(share)} % is none", hint="Give a percentage above 0 and up to 50"
        )
    ranges = [(words, _range_of(words)) for words in scenarios]
    live = [each.name for each in model.live]
    stressed = [
        *dict.fromkeys(n for text in assumptions for n in names_of_rows(text, model.live, "assumption that is drawn"))
    ]
    asked = {n for text in forecasts for n in names_of_rows(text, model.forecasts, "forecast")}
    stressed, reported = stressed or live, [each for each in model.forecasts if not asked or each.name in asked]
    left_out = 0 if asked else max(len(reported) - MOST, 0)
    reported = reported[: len(reported) - left_out]
    if not stressed:
        raise SimulationError(
            "Nothing is drawn", where=model.workbook.name, hint="xlmc check shows which assumptions are not needed"
        )
    tell = tell or (lambda _: None)
    tell("the workbook as it is")
    options = RunOptions.of(trials=trials, seed=seed, engine=engine, jobs=jobs, evidence="rejection", keep_inputs=None)
    run = run_model(with_plain_sampling(model), options)
    if run.accepted * share < 100.0 * _LEAST:
        accepted = f"{count_text(run.accepted)} of {count_text(run.trials)} trials"
        message = f"{accepted} were accepted, and a tail of {number_text(share)} % then has fewer than {_LEAST}"
        raise SimulationError(message, hint="Give more trials (-n), or larger tails (--share)")
    columns = {each.name: _Answers.of(run, each) for each in reported}
    valueless = tuple(name for name, each in columns.items() if each.accepted.m < _LEAST)
    reported = [each for each in reported if each.name not in valueless]
    base = {each.name: columns[each.name].of_all for each in reported}
    tell("the tails of the assumptions")
    moves = {
        name: result for name in stressed if (result := _moves(run, name, share / 100.0, reported, columns)) is not None
    }
    chosen = {each.name: {*sorted(moves, key=lambda name: -moves[name][each.name])[:MOST]} for each in reported}
    tails: list[Tail] = []
    for name in moves:
        tell(name)
        here = [each for each in reported if name in chosen[each.name]]
        tails += [_tail(run, name, share / 100.0, is_high, here, columns) for is_high in (False, True) if here]
    tell("what distinguishes answers")
    inputs = _Inputs(run, tuple(moves))
    parts = [
        _scenario(inputs, columns[each.name], words, wanted)
        for each in reported
        if not columns[each.name].is_counted
        for words, wanted in ranges
    ]
    return Stressed(
        run=run,
        share=share,
        forecasts=tuple(reported),
        forms={each.name: columns[each.name].form for each in reported},
        texts={each.name: text for each in reported if (text := columns[each.name].text) is not None},
        base=base,
        tails=tuple(tails),
        scenarios=tuple(parts),
        still=tuple(name for name in stressed if name not in moves),
        left_out=left_out,
        valueless=valueless,
    )


@dataclass(frozen=True, slots=True)
class _End:
    """An end of a range of answers: a percentile, or a number in the unit of the forecast."""

    number: float
    is_percentile: bool

    def of(self, x: Floats) -> float:
        return float(np.percentile(x, self.number)) if self.is_percentile else self.number


_Range = tuple[_End | None, _End | None]


def _range_of(words: str) -> _Range:
    """Read a range of answers.

    Raises:
        SimulationError: it is none.

    >>> _range_of("between P5 and 20")
    (_End(number=5.0, is_percentile=True), _End(number=20.0, is_percentile=False))
    """
    text = " ".join(words.split())
    one, two = _ONE_SIDED.fullmatch(text), _BETWEEN.fullmatch(text)
    if one is not None:
        end = _end(one, "1", words)
        return (end, None) if one["side"].casefold() == "above" else (None, end)
    if two is not None:
        low, high = _end(two, "1", words), _end(two, "2", words)
        if low.is_percentile == high.is_percentile and not low.number < high.number:
            raise SimulationError(f"In {words!r} the first end is not below the second", hint="Exchange them")
        return low, high
    hint = "Such as 'above P90', 'below 20' in the forecast's unit, or 'between P5 and P10'"
    raise SimulationError(f"{words!r} is no range of answers", hint=hint)


def _end(match: re.Match[str], which: str, words: str) -> _End:
    number = float(match[f"x{which}"].replace(",", ""))
    is_percentile = match[f"p{which}"] is not None
    if is_percentile and (match[f"c{which}"] or not 0.0 < number < 100.0):
        raise SimulationError(f"In {words!r}: P{number_text(number)} is no percentile", hint="Such as P90")
    return _End(number / 100.0 if match[f"c{which}"] else number, is_percentile)


@dataclass(frozen=True, slots=True)
class _Answers:
    """The answers of a forecast, `(m,)` accepted trials, and its statistics.

    Attributes:
        accepted: those trials in which it has one, by their row among the accepted ones.
        text: the one that is counted, of answers that are texts.
        statistics: name -> of some of the trials.
        all: the same of all of them.
    """

    forecast: Forecast
    accepted: Accepted
    form: Form
    text: str | None
    statistics: dict[str, Callable[[Accepted], Statistic]]
    all: dict[str, Statistic]

    @classmethod
    def of(cls, run: RunResult, forecast: Forecast) -> _Answers:
        rows, result = np.arange(run.accepted), run.results[forecast.name]
        text = next(iter(result.categories), None)
        column, kind = run.forecasts[forecast.name], result.kind
        if text is not None:
            column, kind, result = run.indicator(forecast.name, text), Kind.YES_NO, run.saying(forecast.name, text)
        accepted = Accepted.of(rows, np.asarray(column), kind)
        if kind is Kind.YES_NO:
            wanted: dict[str, Callable[[Accepted], Statistic]] = {"mean": lambda part: share_of(part, (1.0,))}
        else:
            tail, threshold = (1.0 - forecast.central) / 2.0, forecast.threshold
            wanted = {
                "mean": mean_of,
                "low": lambda part: quantile_of(part, tail),
                "high": lambda part: quantile_of(part, 1.0 - tail),
            }
            if threshold is not None:
                wanted["above"] = lambda part: share_above(part, threshold)
        results = {name: of(accepted) for name, of in wanted.items()} if accepted.m >= _LEAST else {}
        return cls(forecast, accepted, result.form, text, wanted, results)

    @property
    def is_counted(self) -> bool:
        """Whether the answers are yes and no, or texts."""
        return self.accepted.kind is Kind.YES_NO

    @property
    def of_all(self) -> Part:
        """The answers of all trials."""
        return Part(self.accepted.m, {name: each.estimate for name, each in self.all.items()}, {})

    def part(self, part: _Some) -> Part | None:
        """Return the answers in some of the accepted trials; None where too few have one."""
        inside = part.inside[self.accepted.trials]
        if np.count_nonzero(inside) < _LEAST:
            return None
        some = Accepted(self.accepted.trials[inside], self.accepted.values[inside], self.accepted.kind)
        numbers, changes = {}, {}
        for name, of in self.statistics.items():
            statistic, whole = of(some), self.all[name]
            numbers[name], changes[name] = _against(
                statistic, whole, inside, part.beside(some.trials, self.accepted.trials)
            )
        return Part(some.m, numbers, changes)


def _against(
    statistic: Statistic, whole: Statistic, inside: Bools, moves: Callable[[Floats], Floats]
) -> tuple[Estimate, Estimate]:
    """Return a statistic of a part, and its difference from that of all, with the errors that the limit adds.

    Args:
        statistic: of the part.
        whole: of all `(m,)` trials.
        inside: `(m,)` the part.
        moves: gives what each of the m trials adds by moving the limit, of the pulls of the part.
    """
    value, n = statistic.estimate.value - whole.estimate.value, statistic.estimate.n
    if statistic.influence is None or whole.influence is None:
        return statistic.estimate, Estimate(value, n=n)
    pulls = moves(statistic.influence.pulls)
    pulls[inside] += statistic.influence.pulls
    least = least_error(n) if statistic.hits is not None else 0.0
    own, apart = max(_error(pulls), least), max(_error(pulls - whole.influence.pulls), least)
    stated = with_error(statistic.estimate.value, own, n - 1.0, 0.95, n)
    if statistic.hits is not None and statistic.estimate.error is not None and own <= statistic.estimate.error:
        stated = statistic.estimate
    return stated, with_error(value, apart, n - 1.0, 0.95, n)


def _error(pulls: Floats) -> float:
    return float(np.sqrt(np.sum(pulls * pulls)))


@dataclass(frozen=True, slots=True)
class _Some:
    """Some of the accepted trials: those in which a column lies between limits.

    Attributes:
        inside: `(m,)` which these are.
        nearest: for each limit that is a quantile: the rows inside next to it, and which trials lie on its far side
            from the part, `(m,)`.
    """

    inside: Bools
    nearest: tuple[tuple[NDArray[np.intp], Bools], ...]

    @classmethod
    def of(cls, x: Floats, low: float, high: float, *, moving: tuple[bool, bool]) -> _Some:
        """Take the trials between two limits, of which some are quantiles; NaN lies nowhere.

        A quantile at a value that many trials have does not move.
        """
        inside = (x >= low) & (x <= high)
        rows = np.flatnonzero(inside)
        order = rows[np.argsort(x[rows], kind="stable")]
        many = max(10, round(math.sqrt(rows.size)))
        result = []
        limits = ((low, moving[0], order[:many], x < low), (high, moving[1], order[::-1][:many], x > high))
        for limit, moves, ends, beyond in limits:
            if moves and rows.size and np.count_nonzero(x == limit) <= max(2, 1e-4 * x.size):
                result.append((ends, beyond))
        return cls(inside, tuple(result))

    def beside(self, some: NDArray[np.int64], all_rows: NDArray[np.int64]) -> Callable[[Floats], Floats]:
        """Return what gives, of the pulls of the part `(rows of some,)`, what each trial `(m,)` adds by the limits.

        A trial beyond a limit moves it outwards, any other inwards, so that the same share stays beyond it. The part
        then has more of the trials at the limit, or fewer, which pull it as those next to the limit do.
        """

        def moves(pulls: Floats) -> Floats:
            values = np.zeros(all_rows.size)
            for ends, beyond in self.nearest:
                at = np.isin(some, ends)
                if at.any():
                    outside = beyond[all_rows]
                    values += float(pulls[at].mean()) * (outside - outside.mean())
            return values

        return moves


def _limit(x: Floats, share: float, is_high: bool) -> float:
    return float(np.quantile(x, 1.0 - share if is_high else share, method="higher" if is_high else "lower"))


def _moves(
    run: RunResult, name: str, share: float, reported: Sequence[Forecast], columns: dict[str, _Answers]
) -> dict[str, float] | None:
    """Return by how much the tails of an assumption move the mean of each forecast; None where it has no tails."""
    x = np.asarray(run.inputs[name])
    sides = [x >= (limit := _limit(x, share, True)), x <= (lower := _limit(x, share, False))]
    if limit == lower or any(not _LEAST <= np.count_nonzero(inside) < x.size for inside in sides):
        return None
    result = {}
    for each in reported:
        answers = columns[each.name].accepted
        means = [answers.values[inside[answers.trials]] for inside in sides]
        whole = float(answers.values.mean())
        result[each.name] = max((abs(float(part.mean()) - whole) for part in means if part.size), default=0.0)
    return result


def _tail(
    run: RunResult, name: str, share: float, is_high: bool, reported: Sequence[Forecast], columns: dict[str, _Answers]
) -> Tail:
    """Restrict an assumption to a tail."""
    x = np.asarray(run.inputs[name])
    limit = _limit(x, share, is_high)
    low, high = (limit, math.inf) if is_high else (-math.inf, limit)
    some = _Some.of(x, low, high, moving=(is_high, not is_high))
    parts = {each.name: part for each in reported if (part := columns[each.name].part(some)) is not None}
    return Tail(name, is_high, limit, int(np.count_nonzero(some.inside)), parts)


class _Inputs:
    """The draws of assumptions in the accepted trials, each with its median and its standard deviation.

    Args:
        run: that has them.
        names: of the assumptions.
    """

    def __init__(self, run: RunResult, names: tuple[str, ...]) -> None:
        self._run, self.names, self.accepted = run, names, run.accepted
        self._known: dict[str, tuple[Statistic, float]] = {}

    def of(self, name: str, rows: NDArray[np.int64]) -> tuple[Floats, Statistic, float]:
        """Return the draws in some accepted trials `(m,)`, their median, and their standard deviation."""
        x = np.asarray(self._run.inputs[name])
        if rows.size < self.accepted:
            x = x[rows]
            return x, quantile_of(Accepted(rows, x), 0.5), float(x.std(ddof=1))
        if name not in self._known:
            self._known[name] = quantile_of(Accepted(rows, x), 0.5), float(x.std(ddof=1))
        return x, *self._known[name]


def _scenario(draws: _Inputs, answers: _Answers, words: str, wanted: _Range) -> Scenario:
    """Find the inputs whose medians in some trials of a forecast differ from those in all."""
    column, values = np.full(draws.accepted, np.nan), answers.accepted.values
    column[answers.accepted.trials] = values
    low = -math.inf if wanted[0] is None else wanted[0].of(values)
    high = math.inf if wanted[1] is None else wanted[1].of(values)
    moving = (wanted[0] is not None and wanted[0].is_percentile, wanted[1] is not None and wanted[1].is_percentile)
    some = _Some.of(column, low, high, moving=moving)
    if wanted[0] is not None and not wanted[0].is_percentile:  # above 20 is more than 20
        some = _Some(some.inside & (column > low), some.nearest)
    count = int(np.count_nonzero(some.inside))
    inputs: list[Moved] = []
    if _LEAST <= count < answers.accepted.m:
        shifts = {name: _shift(draws, name, answers, some) for name in draws.names}
        inputs = [_moved(draws, name, answers, some) for name in sorted(shifts, key=lambda name: -shifts[name])[:MOST]]
        inputs.sort(key=lambda each: -abs(each.shift.value))
    return Scenario(answers.forecast.name, words, low, high, count, tuple(inputs))


def _shift(draws: _Inputs, name: str, answers: _Answers, some: _Some) -> float:
    """Return how far the median of an input moves, in standard deviations."""
    rows = answers.accepted.trials
    x, median, spread = draws.of(name, rows)
    return abs(float(np.median(x[some.inside[rows]])) - median.estimate.value) / spread if spread else 0.0


def _moved(draws: _Inputs, name: str, answers: _Answers, some: _Some) -> Moved:
    rows = answers.accepted.trials
    x, all_of_them, spread = draws.of(name, rows)
    spread = spread or 1.0
    inside = some.inside[rows]
    part = Accepted(rows[inside], x[inside])
    within = quantile_of(part, 0.5)
    median, shift = _against(within, all_of_them, inside, some.beside(part.trials, rows))
    error = None if shift.error is None else shift.error / spread
    moved = Estimate(shift.value / spread, error, n=shift.n)
    if error:
        moved = with_error(moved.value, error, shift.n - 1.0, 0.95, shift.n)
    chance = 2.0 * NormalDist().cdf(-abs(moved.value) / error) if error else float(not moved.value)
    at = float((x < within.estimate.value).mean() + (x <= within.estimate.value).mean()) / 2.0
    return Moved(name, all_of_them.estimate, median, moved, at, chance)
