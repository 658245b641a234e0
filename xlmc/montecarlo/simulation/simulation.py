"""The result of a run: accepted trials, counts, statistics."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from decimal import ROUND_CEILING, Context, Decimal
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import Notice, SimulationError
from xlmc.montecarlo import statistics
from xlmc.montecarlo.columns import parts
from xlmc.montecarlo.definitions.run_options import KEPT_INPUTS, RunOptions
from xlmc.montecarlo.definitions.run_settings import DETAILED, Settings
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.diagnostics.agreement import Agreement, agreement
from xlmc.montecarlo.diagnostics.base_formulas import base_formulas
from xlmc.montecarlo.diagnostics.cell_errors import Root, error_roots
from xlmc.montecarlo.diagnostics.checking import CheckResult, check_results
from xlmc.montecarlo.diagnostics.digit_watch import lost_digits
from xlmc.montecarlo.diagnostics.directions import direction_notices
from xlmc.montecarlo.diagnostics.iteration_watch import unconverged_notices
from xlmc.montecarlo.diagnostics.result_answers import Answers, RunFacts
from xlmc.montecarlo.diagnostics.result_cells import ShownResults, shown_results
from xlmc.montecarlo.diagnostics.weighing import Weighting, weighting_of
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.loop.blocks import FilterTally
from xlmc.montecarlo.loop.forecast_result import ForecastResult, Replicates, tail_notices
from xlmc.montecarlo.loop.stopping import Stopped
from xlmc.montecarlo.loop.stopping.stopped import ALL_TRIALS
from xlmc.montecarlo.model.plain_words import list_of
from xlmc.montecarlo.number_text import count_text, counted_text, number_text, styled_text
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.sample import MOST_GROUPS

if TYPE_CHECKING:
    import pandas

    from xlmc.excel.address import Cell
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.rare.account import RareAccount

__all__ = [
    "ERROR_SHARE",
    "KEPT_INPUTS",
    "TRIAL",
    "ChangedFrom",
    "Origin",
    "RunResult",
    "assumption_heading",
    "forecast_heading",
    "weight_heading",
]

ERROR_SHARE: Final = 0.001
"""If a larger share of the trials is lost to errors, the answer must not be used as it is."""

TRIAL: Final = "Trial"
"""The heading of the trials' numbers in tables of trials."""

LEAST_ACCEPTED: Final = 10
"""Accepted trials for each replicate that errors come from, on average, if they are to be trusted: docs/sampling.md."""

FEW: Final = 100
"""Accepted trials below which the interval of a standard deviation may be too short: docs/stress.md."""

Floats = NDArray[np.float64]

_OF_FEW = (
    "Intervals of percentiles and of shares hold with few trials too; those of the mean of a skewed forecast, of the "
    "standard deviation, the skewness, the kurtosis and the coefficient of variation can then be too short: "
    "--until-accepted 1000, say, goes on until there are more"
)


def _rounded_up(number: float) -> str:
    """Write an upper bound with two digits, as the table of trials does: 0.1917 is 0.2, not 0.19."""
    return number_text(float(Context(prec=2, rounding=ROUND_CEILING).plus(Decimal(number))), 2)


@dataclass(frozen=True, slots=True)
class Origin:
    """The software and the processor of a saved run.

    Attributes:
        software: name -> version.
        processor: what it was, for people and for comparing.
    """

    software: Mapping[str, str]
    processor: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class ChangedFrom:
    """The workbook that the run's own was made of, by typing a changed state into a copy of it.

    Attributes:
        name: of the workbook.
        sha256: of its file.
        changes: what differs from it, in words, one a phrase.
    """

    name: str
    sha256: str
    changes: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """What must be said before the answers."""
        changed = "; ".join(self.changes)
        return f"These are not results of {self.name} as it is, but of a copy with changes: {changed}."


def _as_array(index: NDArray[np.int64] | range) -> NDArray[np.int64]:
    return np.arange(index.start, index.stop) if isinstance(index, range) else index


def _replicates(plan: SamplingPlan, index: Callable[[], NDArray[np.int64]]) -> Replicates | None:
    """Return the replicate of each accepted trial; see `SamplingPlan.replicate_of`."""
    return plan.replicate_of(index()) if plan.size else None


def _trials(count: int) -> str:
    return f"{counted_text(count, 'trial')} {'was' if count == 1 else 'were'}"


@dataclass(frozen=True, eq=False, repr=False)
class RunResult:
    """A finished run. Of a large one the columns lie in temporary files, as read-only arrays, for as long as it lives.

    Attributes:
        model, settings, block: what it is a function of.
        plan: the sampling method, and how it divides the trials into replicates.
        trials: how many were run; where accepted ones are rare, drawn plainly, which the counts are of.
        accepted_index: `(m,)` the accepted ones, counted from 0; where they are rare, in the order they were drawn in.
            A range where all of not too many are accepted; `trial_index` is always an array.
        inputs: assumption -> its accepted draws, `(m,)`, or of the first accepted trials where not all were asked for.
        prior: assumption -> its draws before filtering, of the first trials.
        forecasts: forecast -> `(m,)`, NaN where it has no number.
        faults: forecast -> fault -> accepted trials in which it has no number.
        tally: what the filters rejected.
        invalid: assumption -> trials in which its parameters were no distribution.
        error_trials: trials lost to errors: undecided by a filter, drawn from no distribution, or accepted without a
            number in some forecast. Each counts once.
        stopped: what ended it.
        origin: where it was made, if it was saved and opened again; None for one that was made here.
        discards: forecast with filters of its own -> filter -> accepted trials that it discards for it alone; a trial
            that several discard counts for the first.
        rare: where the accepted trials come from, where that is a learned proposal; None with plain trials.
        changed_from: where its workbook is a changed copy of another one that a person knows; None elsewhere.
        labels: forecast whose answers are texts -> the texts, each at its number in the column of the forecast.
        tabulated: number of a further value of `RiskSimtable` -> the run with it, as far as they were made.
    """

    model: CompiledModel
    settings: Settings
    plan: SamplingPlan
    block: int
    trials: int
    accepted_index: NDArray[np.int64] | range
    inputs: Mapping[str, Floats]
    prior: Mapping[str, Floats]
    forecasts: Mapping[str, Floats]
    faults: Mapping[str, Counter[str]]
    tally: FilterTally
    invalid: Counter[str]
    error_trials: int
    stopped: Stopped = ALL_TRIALS
    origin: Origin | None = None
    rare: RareAccount | None = None
    discards: Mapping[str, Counter[str]] = field(default_factory=dict)
    changed_from: ChangedFrom | None = None
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    tabulated: dict[int, RunResult] = field(default_factory=dict)

    def __getitem__(self, name: str) -> ForecastResult:
        """Return the result of a forecast, by name whatever its case.

        Raises:
            KeyError: there is no such forecast.
        """
        for definition in self.model.forecasts:
            if name_key(definition.name) == name_key(name):
                return self.results[definition.name]
        raise KeyError(f"there is no forecast {name!r}; there are {', '.join(map(repr, self.forecasts))}")

    @cached_property
    def results(self) -> dict[str, ForecastResult]:
        """Every forecast's result, in the order of the workbook.

        They do not hold the run: its columns are large, and go with it at once.
        """
        return {
            f.name: ForecastResult(
                f,
                partial(self.forecasts.__getitem__, f.name),
                self.faults[f.name],
                partial(_replicates, self.plan, self._index),
                self.discards.get(f.name, Counter()),
                partial(_weights, self._weigh),
                still=f.cell in self.model.still,
                labels=self.labels.get(f.name),
                code=self.model.formats[f.name],
                date1904=self.model.workbook.date1904,
                two_valued=f.name in self.model.two_valued,
            )
            for f in self.model.forecasts
        }

    @property
    def detailed(self) -> tuple[str, ...]:
        """The forecasts that sensitivity, charts and page tell of: the first ones of the workbook."""
        return tuple(f.name for f in self.model.forecasts[: self.settings.detailed or DETAILED])

    @cached_property
    def weighting(self) -> Weighting | None:
        """The weights of the accepted trials; None if they count alike."""
        return self._weigh()

    @cached_property
    def _weigh(self) -> Callable[[], Weighting | None]:
        return cache(partial(weighting_of, self.model, self.inputs, self.accepted))

    @property
    def replicate(self) -> Replicates | None:
        """`(m,)` the replicate of each accepted trial; None if the trials themselves are independent."""
        return self.plan.replicate_of(self.trial_index)

    @property
    def trial_index(self) -> NDArray[np.int64]:
        """`(m,)` the accepted trials; see `accepted_index`."""
        return self._index()

    @cached_property
    def _index(self) -> Callable[[], NDArray[np.int64]]:
        return cache(partial(_as_array, self.accepted_index))

    @property
    def accepted(self) -> int:
        return len(self.accepted_index)

    @property
    def repeating(self) -> RunOptions:
        """The options that give this run again."""
        by, weighable = self.stopped.by, bool(self.model.chances)
        return RunOptions.repeating(self.settings, trials=self.trials, by=by, weighable=weighable)

    @property
    def evaluated(self) -> int:
        """Trials that were computed in all: the plain ones, and those of a search."""
        return self.trials if self.rare is None else self.rare.evaluations

    @property
    def acceptance(self) -> Estimate:
        """The share of accepted trials; the trials may have gone on until there were enough. Where nothing can reject
        a trial, all are accepted, exactly.
        """
        may_fail = self.model.filters or any(draw.varying for draw in self.model.draws.values())
        if not may_fail and self.rare is None and 0 < self.accepted == self.trials:
            return Estimate(1.0, 0.0, interval=(1.0, 1.0), n=self.trials)
        if self.rare is not None:
            return self.rare.acceptance
        if self.stopped.by == "accepted":
            return statistics.inverse_proportion(self.accepted, self.trials)
        if not self.plan.size:
            return statistics.proportion(self.accepted, self.trials)
        sizes = np.full(-(-self.trials // self.plan.size), self.plan.size)
        sizes[-1] -= sizes.sum() - self.trials
        return statistics.replicated_proportion(self.accepted_by_replicate, sizes)

    @property
    def filters_act(self) -> bool:
        """Whether something rejects or weights trials, so that accepted draws may differ from all draws."""
        return bool(self.model.filters) or self.weighting is not None or self.accepted != self.trials

    @cached_property
    def accepted_by_replicate(self) -> Replicates:
        """How many trials each replicate has accepted; of none where the trials themselves are independent."""
        count = -(-self.trials // self.plan.size) if self.plan.size else 0
        values = np.zeros(count, np.int64)
        for part in parts(self.trial_index) if count else ():
            values += np.bincount(part // self.plan.size, minlength=count)
        return values

    @property
    def _effective(self) -> int:
        """How many trials of equal weight say as much as the accepted ones."""
        return self.accepted if self.weighting is None else round(self.weighting.effective)

    @property
    def has_few(self) -> bool:
        """Whether fewer than `FEW` trials were accepted, or count as such, but not none."""
        return 0 < self._effective < FEW

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What the person should know of the model and of this run."""
        return (*self.model.notices, *self.notices_of_run)

    @cached_property
    def notices_of_run(self) -> tuple[Notice, ...]:
        """What the person should know of this run alone."""
        notices: list[Notice] = []
        effective = self._effective
        if not self.plan.replicates and self.has_few:
            few = f"only {_trials(self.accepted)} accepted" if self.weighting is None else ""
            few = few or f"the accepted trials say as much as {effective} trials of equal weight"
            notices.append(Notice(f"{few}. {_OF_FEW}"))
        samples = {name: result.sample for name, result in self.results.items() if name not in self.labels}
        notices += [Notice(each) for each in self.agreement.remarks] if self.agreement else []
        notices += direction_notices(each for name, each in self.results.items() if name not in self.labels)
        notices += unconverged_notices(self.model, self.prior)
        return (*notices, *tail_notices(samples, METHODS[self.plan.method].name))

    @property
    def warnings(self) -> list[str]:
        """Why the answer must not be used as it is; empty when it may be."""
        missing = [self.shown_results.warning] if self.shown_results.warning else []
        return [*self.warnings_of_trials, *missing]

    @property
    def warnings_of_trials(self) -> list[str]:
        """The same, but for what the workbook's own cells cannot show."""
        result = []
        if self.accepted == 0 and self.stopped.by != "search":
            most = self.acceptance.interval
            fewer = "" if most is None else f", or accept fewer than {_rounded_up(100.0 * most[1])} % of the trials"
            why = f"the filters contradict the assumptions{fewer}{self._by_itself}"
            if self.error_trials >= self.trials:
                why = "every trial was lost to an error in a cell"
            result.append(f"no trial was accepted: {why}")
        if not self.stopped.reached and not self.stopped.interrupted:
            result.append(self.stopped.sentence)
        if self.error_trials > ERROR_SHARE * self.trials:
            share = self.error_trials / self.trials
            result.append(
                f"{counted_text(self.error_trials, 'trial')} ({styled_text(share, '.2%')}) "
                f"{'was' if self.error_trials == 1 else 'were'} lost to errors in cells"
            )
        failing = [warning for check in self.checks for warning in check.warnings]
        if self.agreement is not None and self.agreement.conflicts:
            failing.append(self.agreement.sentence)
        rare = () if self.rare is None else self.rare.warnings
        return [*self.refused, *failing, *result, *self._sparse(), *self._lost_digits, *rare]

    @property
    def _by_itself(self) -> str:
        """Which filters reject all trials, in words after others; or that none does by itself."""
        counts = zip(self.model.filters, self.tally.rejected, strict=True)
        names = [repr(each.name) for each, rejected in counts if rejected >= self.trials]
        if names:
            rejects, itself = ("rejects", "itself") if len(names) == 1 else ("reject", "themselves")
            return f". {list_of(names)} {rejects} all trials by {itself}"
        return ". No filter rejects all trials by itself"

    def lost_share(self, forecast: str) -> float:
        """Return the share of the trials that errors take from a forecast: in a draw, in a filter that cannot decide,
        in its own cell.
        """
        lost = self.tally.by_error + self.invalid.total() + self.faults[forecast].total()
        return min(self.error_trials, lost) / self.trials

    def loses_too_many(self, forecast: str) -> bool:
        """Whether errors take so many trials from a forecast that its answer must not be used as it is."""
        return self.lost_share(forecast) > ERROR_SHARE

    @property
    def refused(self) -> list[str]:
        """The warnings that concern only a forecast without an answer: the answers of others may be used."""
        return [str(each).rstrip(".") for each in self.model.definitions.refused]

    @cached_property
    def shown_results(self) -> ShownResults:
        """What the workbook's own cells show of this run, `=RiskMean(B9)` and all that depends on it."""
        asked = self.model.definitions
        if not (asked.results or asked.unavailable):
            return ShownResults()
        run = RunFacts(self.trials, self.plan.trials, self.model.assumptions, self.model.draws)
        simulations = {1: self, **self.tabulated}
        answers = Answers({n: tuple(each.results.values()) for n, each in simulations.items()}, run)
        at_base = base_formulas(asked, self.model.draws)
        return shown_results(self.model.workbook, asked.results, asked.unavailable, answers, at_base)

    def take_tabulated(self, runs: Mapping[int, RunResult]) -> None:
        """Take the runs with further values of `RiskSimtable`, about which cells may ask, too."""
        self.tabulated.update(runs)
        self.__dict__.pop("shown_results", None)

    @cached_property
    def error_roots(self) -> dict[Cell, Root]:
        """Cell of a forecast or filter that was an error in some trials -> the cell it comes from, and its error."""
        cells = [f.cell for f, errors in zip(self.model.filters, self.tally.errors, strict=True) if errors.total()]
        cells += [f.cell for f in self.model.forecasts if self.faults[f.name].total()]
        return error_roots(self.model, cells, (self.prior, self.inputs)) if cells else {}

    @cached_property
    def checks(self) -> tuple[CheckResult, ...]:
        """The workbook's checks at the base case and in the accepted trials; evaluated when they are first asked."""
        return check_results(self.model, self.inputs, self.accepted)

    @cached_property
    def agreement(self) -> Agreement | None:
        """Whether the evidence agrees with the model and with itself; None if none is used."""
        return agreement(self.model, self.settings.seed, self.evaluated)

    @cached_property
    def _lost_digits(self) -> list[str]:
        """Which forecasts have no digits; looked for when it is first asked."""
        return lost_digits(self.model, self.inputs)

    def _sparse(self) -> list[str]:
        """Whether too few trials were accepted in a replicate for errors that come from the replicates."""
        groups = min(self.plan.replicates, MOST_GROUPS)
        if not 0 < self.accepted < LEAST_ACCEPTED * groups:
            return []
        return [
            f"only {_trials(self.accepted)} accepted in "
            f"{count_text(self.plan.replicates)} replicates, fewer than "
            f"{count_text(LEAST_ACCEPTED * groups)}, so errors and intervals are not to be trusted: "
            "run more trials, or sample "
            f"by {METHODS['mc'].name}"
        ]

    @property
    def kept_inputs(self) -> int:
        """The number of accepted trials, from the first on, whose draws are kept."""
        return next((int(values.size) for values in self.inputs.values()), self.accepted)

    def frame(self, *, inputs: bool = True) -> pandas.DataFrame:
        """Return accepted trials, one a row, indexed by trial: assumptions, then forecasts.

        An assumption with the name of a forecast is called `name (assumption)`; what is called `Trial`, as the
        index is, `Trial (assumption)` or `Trial (forecast)`.

        Args:
            inputs: with the assumptions.

        Raises:
            SimulationError: not all draws were kept.
        """
        import pandas

        if inputs and self.kept_inputs < self.accepted:
            every = counted_text(self.accepted, "accepted trial")
            message = f"the draws of {count_text(self.kept_inputs)} of {every} were kept"
            raise SimulationError(message, hint="use frame(inputs=False), or simulate(…, keep_inputs=None)")
        columns: dict[str, Any] = {
            forecast_heading(name): self._as_texts(name, values) for name, values in self.forecasts.items()
        }
        if inputs:
            drawn = {assumption_heading(name, self.forecasts): values for name, values in self.inputs.items()}
            columns = drawn | columns
        result = pandas.DataFrame(columns, index=pandas.Index(self.trial_index, name=TRIAL))
        units = {assumption_heading(a.name, self.forecasts): a.units for a in self.model.assumptions}
        units |= {forecast_heading(f.name): f.units for f in self.model.forecasts}
        result.attrs["units"] = {name: units.get(name, "") for name in result.columns}
        return result

    def numbers_of(self, name: str) -> Floats:
        """Return the column of a forecast, `(m,)`; NaN where its answers are texts."""
        values = self.forecasts[name]
        return values if name not in self.labels else np.full(values.size, np.nan)

    def indicator(self, name: str, text: str) -> Floats:
        """`(m,)` 1 where a text is the answer, 0 where another is, NaN where there is none."""
        values, labels = self.forecasts[name], self.labels.get(name, ())
        number = labels.index(text) if text in labels else -1
        return np.where(np.isnan(values), np.nan, values == number)

    def saying(self, name: str, text: str) -> ForecastResult:
        """Return the result of a forecast whose answers are texts, as the share of the trials in which a text is it."""
        known = self.results[name]
        asked = replace(known.definition, kind=Kind.YES_NO)
        weights = None if self.weighting is None else self.weighting.weights
        return ForecastResult(
            asked, lambda: self.indicator(name, text), known.faults, lambda: self.replicate, weights=lambda: weights
        )

    def _as_texts(self, name: str, values: Floats) -> Floats | list[str | None]:
        """Return the texts of a forecast whose answers are texts, None in a trial without one; else its numbers."""
        labels = self.labels.get(name)
        if labels is None:
            return values
        return [None if math.isnan(each) else labels[int(each)] for each in values.tolist()]


def forecast_heading(name: str) -> str:
    """Name a forecast in a table of trials, in which no two columns may have one name."""
    return f"{name} (forecast)" if name == TRIAL else name


def assumption_heading(name: str, forecasts: Collection[str]) -> str:
    """Name an assumption in such a table.

    Args:
        name: of the assumption.
        forecasts: the names of all forecasts.
    """
    return f"{name} (assumption)" if name == TRIAL or name in forecasts else name


def weight_heading(others: Collection[str]) -> str:
    """Name the weights of trials in such a table, beside columns with these names."""
    return "Weight" if "Weight" not in others else "Weight of the trial"


def _weights(weigh: Callable[[], Weighting | None]) -> NDArray[np.float64] | None:
    weighting = weigh()
    return None if weighting is None else weighting.weights
