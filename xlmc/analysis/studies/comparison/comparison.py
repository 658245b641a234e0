"""Two books of one scene over the same trials: whether the simpler one is enough, and if not, why.

Where each answers from inputs that the other has not, neither is simpler: see `rivalry`. A book may also be compared
with itself, as it is and with an assumption drawn from what another book answers: see `feeding`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil, inf
from typing import TypedDict

from xlmc.analysis.studies.comparison.causes import Inputs, Step, Variations, cause_of, inputs_of, steps_between
from xlmc.analysis.studies.comparison.differences import Acceptance, Difference, acceptance, difference
from xlmc.analysis.studies.comparison.feeding import fed_model
from xlmc.analysis.studies.comparison.paired_statistics import Accepted
from xlmc.analysis.studies.comparison.rivalry import Rivalry, rivalry
from xlmc.analysis.studies.comparison.tolerances import (
    Judgement,
    Tolerances,
    Verdict,
    chance_of,
    in_tolerances,
    judge,
    read_tolerances,
)
from xlmc.analysis.studies.comparison.variations import with_plain_sampling
from xlmc.analysis.studies.shown import Shown
from xlmc.analysis.studies.steps import Steps
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.units import factor_between
from xlmc.montecarlo.distributions.spelling import by_names, name_key
from xlmc.montecarlo.model.cell_forms import forms_of
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.simulation.simulate import simulate
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate

__all__ = ["Cause", "CompareArguments", "Comparison", "ForecastComparison", "compare"]


class CompareArguments(TypedDict, total=False):
    """The arguments of `compare` beside the books and the tolerance."""

    pairs: Mapping[str, str] | None
    feeds: Mapping[str, str] | None
    trials: int | None
    seed: int | None
    engine: str | None
    jobs: int
    chance: float | None
    causes: bool
    tell: Callable[[str], None] | None


@dataclass(frozen=True, slots=True)
class Cause:
    """Why a forecast differs.

    Attributes:
        steps: what, taken out of the books, brings the difference within the tolerance; empty where nothing does.
        number: the name of the number that then differs most, measured in its tolerance.
        left: its difference.
    """

    steps: tuple[Step, ...]
    number: str
    left: Estimate


@dataclass(frozen=True, slots=True)
class ForecastComparison:
    """A forecast of the first book and its counterpart in the second, in the first one's unit.

    Attributes:
        factor: by which the second's numbers were multiplied, to be in the first's unit.
        tolerance: in that unit; `stated` where it was asked for, else a tenth of the standard deviation; nan of
            shares of which none is stated.
        limits: number -> its tolerance; that of a probability is a share.
        cause: where the difference is beyond the tolerance.
        rivalry: where each book answers from inputs that the other has not; None if one of them has all.
    """

    first: Forecast
    second: Forecast
    factor: float
    tolerance: float
    stated: bool
    limits: Mapping[str, float]
    difference: Difference
    judgement: Judgement
    cause: Cause | None
    rivalry: Rivalry | None = None

    @property
    def apart(self) -> bool:
        """Whether the books are two models of this answer, and their answers are not the same within the tolerance."""
        return self.rivalry is not None and self.judgement.verdict is not Verdict.WITHIN

    @property
    def same_in_every_trial(self) -> bool:
        """In every trial that both books accept they give one number, to 1e-9 of it, or one text."""
        if self.difference.shares:
            return self.difference.largest == 0.0
        size = abs(self.difference.mean.first.value) + self.difference.standard_deviation.first.value
        return self.difference.largest <= 1e-9 * size

    @property
    def only_distributions_agree(self) -> bool:
        """The answers agree as a whole, but in one and the same trial the books differ by more than the tolerance."""
        apart, tolerance = self.difference.typical, self.tolerance
        if self.difference.shares:  # the share of the trials in which the answers differ
            apart, tolerance = apart**2, max(self.limits.values())
        return self.judgement.verdict is Verdict.WITHIN and apart > tolerance


@dataclass(frozen=True, slots=True, repr=False)
class Comparison(Shown):
    """Two books of one scene over the same trials.

    Attributes:
        first, second: the runs.
        simpler: 0 or 1, the book that draws fewer assumptions, or else needs fewer cells, or has fewer filters; None
            where they are alike in all three.
        acceptance: what either accepts.
        inputs: the assumptions and filters they share, and those they do not.
        forecasts: the pairs.
        unpaired: for either book, the forecasts without a counterpart.
        runs: how many were made.
        source: the run of the book whose answers feed the second, which is the first with other draws; None elsewhere.
        ended: why the search for causes ended early; empty if it did not.
    """

    first: RunResult
    second: RunResult
    simpler: int | None
    acceptance: Acceptance
    inputs: Inputs
    forecasts: tuple[ForecastComparison, ...]
    unpaired: tuple[tuple[str, ...], tuple[str, ...]]
    runs: int
    source: RunResult | None = None
    ended: str = ""

    def of(self, verdict: Verdict) -> tuple[ForecastComparison, ...]:
        """Return the forecasts of which this is the verdict, but for those of which the books are rival models."""
        return tuple(each for each in self.forecasts if each.judgement.verdict is verdict and not each.apart)

    @property
    def rivals(self) -> tuple[ForecastComparison, ...]:
        """The forecasts of which the books are two models that do not give the same answer within the tolerance."""
        return tuple(each for each in self.forecasts if each.apart)

    @property
    def trials_needed(self) -> int | None:
        """About how many trials would decide what is undecided; None if no number would."""
        times = max((each.judgement.times for each in self.of(Verdict.UNDECIDED)), default=1.0)
        return None if times == inf else ceil(times * self.first.trials)


def compare(
    first: CompiledModel,
    second: CompiledModel,
    tolerance: Iterable[str] | str = (),
    *,
    pairs: Mapping[str, str] | None = None,
    feeds: Mapping[str, str] | None = None,
    trials: int | None = None,
    seed: int | None = None,
    engine: str | None = None,
    jobs: int = 1,
    chance: float | None = None,
    causes: bool = True,
    tell: Callable[[str], None] | None = None,
) -> Comparison:
    """Run two books of one scene over the same trials, and judge whether their answers agree.

    A first Ctrl-C ends the search for causes (`Comparison.ended`). Before both are run, it ends a run with the blocks
    of trials in progress, and both books are compared over these trials.

    An assumption of the same name takes the same random numbers in both. Forecasts are paired by name. The trials are
    plain Monte Carlo, whatever the books' settings say.

    Args:
        first: a book; numbers are given in its units.
        second: the other; either may be the simpler.
        tolerance: `0.5`, `0.5 mph`, `10 %` (of the forecast's SD in the first book), `Name=0.5 mph`; a tenth of the SD
            where none is stated. It holds for mean, SD and both ends of the central range.
        pairs: further pairs, name in the first -> name in the second.
        feeds: asks instead whether the first book needs the second: assumption of the first -> forecast of the second.
            The first book is compared with itself, these assumptions drawn from what the second book answers.
        trials: of each run; by default the larger of the books' own settings.
        seed: of each run; by default the first book's.
        engine: as in `Model.simulate`.
        jobs: as in `Model.simulate`.
        chance: the change of P(forecast > threshold) that counts as none, in percentage points; by default a tenth of
            it or of its complement, and a tenth of a point at least. The threshold is the first book's; that of the
            second where the first has none.
        causes: look for the cause of what differs; each step is a further run.
        tell: called before every run with what it is for, and while the books are run how many are left.

    Raises:
        SimulationError: no forecast has a counterpart, a pair has units of two kinds, or an argument is out of its
            range.
    """
    first, second = with_plain_sampling(first), with_plain_sampling(second)
    _refuse_other_dates(first, second)
    trials = trials or max(model.definitions.settings.trials for model in (first, second))
    seed = first.definitions.settings.seed if seed is None else seed
    with Steps(tell) as steps:
        return _compared(first, second, tolerance, pairs, feeds, trials, seed, engine, jobs, chance, causes, steps)


def _refuse_other_dates(first: CompiledModel, second: CompiledModel) -> None:
    """Refuse books with dates of which one counts from 1904: the numbers of one day are 1,462 apart.

    Raises:
        SimulationError: they are such books.
    """
    books = first.workbook, second.workbook
    if books[0].date1904 == books[1].date1904:
        return
    for model in (first, second):
        named = *(each.cell for each in model.forecasts), *(each.cell for each in model.live)
        cells = [cell for cell in named if isinstance(cell, Cell)]
        dated = next(
            (c for c, f in zip(cells, forms_of(model.workbook, cells), strict=True) if f.kind is Kind.DATE), None
        )
        if dated is not None:
            message = f"dates of {first.path.name} and of {second.path.name} do not count from the same day"
            hint = "set both to the 1900 date system, in Excel's options"
            raise SimulationError(message, where=f"{model.path.name} {dated}", hint=hint)


class _EndedEarly(Exception):  # noqa: N818 - it is no fault
    """No further run is to be made."""


def _compared(
    first: CompiledModel,
    second: CompiledModel,
    tolerance: Iterable[str] | str,
    pairs: Mapping[str, str] | None,
    feeds: Mapping[str, str] | None,
    trials: int,
    seed: int,
    engine: str | None,
    jobs: int,
    chance: float | None,
    causes: bool,
    steps: Steps,
) -> Comparison:
    made = 0

    def run(model: CompiledModel, purpose: str, keep_inputs: int = 0) -> RunResult:
        nonlocal made
        if steps.ended:
            raise _EndedEarly
        made += 1
        steps.begin(purpose)
        return simulate(model, trials=trials, seed=seed, engine=engine, jobs=jobs, keep_inputs=keep_inputs)

    def first_run(model: CompiledModel, purpose: str) -> RunResult:
        """Run a book, which Ctrl-C ends with the trials that it has by then, once; all others then have so many."""
        nonlocal made, trials
        made += 1
        steps.begin(purpose)
        again = partial(simulate, model, trials=trials, seed=seed, engine=engine, jobs=jobs, keep_inputs=0)
        result = again() if steps.ended else steps.first_run(partial(again, keep_interrupted=True))
        trials = result.trials
        return result

    source = None
    steps.expect(3 if feeds else 2)
    if feeds:
        if pairs:
            raise SimulationError("a book that feeds another is not paired with it", hint="leave the pairs out")
        source = first_run(second, second.path.name)
        second = fed_model(first, source, feeds)
    matched = _match_forecasts(first, second, pairs or {})
    factors = [_factor(*pair) for pair in matched]
    stated = read_tolerances([tolerance] if isinstance(tolerance, str) else tolerance, [mine for mine, _ in matched])
    books = first_run(first, first.path.name), first_run(second, second.path.name)
    if books[0].trials > trials:  # the second was interrupted
        books = first_run(first, first.path.name), books[1]
    fewer = steps.ended
    steps.can_end()
    inputs = inputs_of(*books)
    search = _Search(books, inputs, Variations(*books, run), chance_of(chance), causes and source is None)
    forecasts = tuple(
        search.compare_pair(mine, theirs, factor, stated)
        for (mine, theirs), factor in zip(matched, factors, strict=True)
    )
    if all(each.difference.shares for each in forecasts):
        stated.refuse_for_shares([each.first for each in forecasts])
    return Comparison(
        first=books[0],
        second=books[1],
        simpler=_simpler(first, second) if source is None else 0,
        acceptance=acceptance(*books),
        inputs=inputs,
        forecasts=forecasts,
        unpaired=_unpaired_forecasts(first, second, matched),
        runs=made,
        source=source,
        ended=steps.why_ended if search.ended or fewer else "",
    )


class _Search:
    """Differences of two books, as they are and with steps taken."""

    def __init__(
        self,
        books: tuple[RunResult, RunResult],
        inputs: Inputs,
        variations: Variations,
        chance: float | None,
        causes: bool,
    ) -> None:
        self._books, self._variations, self._chance = books, variations, chance
        self._steps = steps_between(inputs, *books) if causes else ()
        self._causes, self.ended = causes, False

    def compare_pair(self, mine: Forecast, theirs: Forecast, factor: float, stated: Tolerances) -> ForecastComparison:
        result, own = self._difference((), mine, theirs, factor), Accepted.of_run(self._books[0], mine.name)
        if result.shares:
            tolerance, was_stated = stated.of_share(mine, own.scale, self._chance)
        else:
            tolerance, was_stated = stated.of(mine, own.scale)
        limits = result.tolerances(tolerance, self._chance)
        judgement = judge({name: (change.difference, limits[name]) for name, change in result.changes})
        rivals, cause = None if result.shares else self._rivalry(mine, theirs, factor), None
        if judgement.verdict is Verdict.BEYOND and self._causes and rivals is None:
            try:
                cause = None if self.ended else self._cause(mine, theirs, factor, limits)
            except _EndedEarly:
                self.ended = True
        return ForecastComparison(mine, theirs, factor, tolerance, was_stated, limits, result, judgement, cause, rivals)

    def _rivalry(self, mine: Forecast, theirs: Forecast, factor: float) -> Rivalry | None:
        first, second = self._books
        answers = Accepted.of_run(first, mine.name), Accepted.of_run(second, theirs.name, factor)
        return rivalry(self._books, (mine, theirs), answers)

    def _difference(self, steps: Iterable[Step], mine: Forecast, theirs: Forecast, factor: float) -> Difference:
        first, second = self._variations.pair(steps)
        return difference(
            Accepted.of_run(first, mine.name),
            Accepted.of_run(second, theirs.name, factor),
            mine.central,
            _threshold(mine, theirs, factor),
            self._books[0].results[mine.name].form,
        )

    def _cause(self, mine: Forecast, theirs: Forecast, factor: float, limits: Mapping[str, float]) -> Cause:
        def largest(steps: Iterable[Step]) -> tuple[float, str, Estimate]:
            changes = self._difference(steps, mine, theirs, factor).changes
            sizes = [(in_tolerances(c.difference, limits[name]), name, c.difference) for name, c in changes]
            return max(sizes, key=lambda size: size[0])

        steps = cause_of(self._steps, lambda taken: largest(taken)[0])
        _, number, left = largest(steps)
        return Cause(steps, number, left)


def _threshold(mine: Forecast, theirs: Forecast, factor: float) -> float | None:
    if mine.threshold is not None or theirs.threshold is None:
        return mine.threshold
    return theirs.threshold * factor


def _match_forecasts(
    first: CompiledModel, second: CompiledModel, pairs: Mapping[str, str]
) -> list[tuple[Forecast, Forecast]]:
    """Return the forecasts of the first book with their counterparts, in its order.

    Raises:
        SimulationError: a pair names a forecast that is not there, or there are no pairs at all.
    """
    mine, theirs = ({name_key(f.name): f for f in model.forecasts} for model in (first, second))

    def key_of(name: str, model: CompiledModel) -> str:
        if (result := by_names(model.forecasts).get(name_key(name))) is None:
            hint = f"there are {', '.join(repr(f.name) for f in model.forecasts)}"
            raise SimulationError(f"there is no forecast {name.strip()!r}", where=model.path.name, hint=hint)
        return name_key(result.name)

    given = {key_of(here, first): key_of(there, second) for here, there in pairs.items()}
    taken = set(given.values())
    given |= {key: key for key in mine if key in theirs and key not in given and key not in taken}
    if not given:
        hint = "pair them by hand: --pair 'name in the first=name in the second'"
        raise SimulationError("no forecast has the same name in both books", hint=hint)
    return [(forecast, theirs[given[key]]) for key, forecast in mine.items() if key in given]


def _factor(mine: Forecast, theirs: Forecast) -> float:
    """Return the factor that converts the second book's numbers.

    Raises:
        SimulationError: the units are not of one kind.
    """
    factor = factor_between(theirs.units, mine.units)
    if factor is None:
        units = " and ".join(repr(f.units) if f.units else "no unit" for f in (mine, theirs))
        message = f"the forecasts {mine.name!r} and {theirs.name!r} have the units {units}, which cannot be converted"
        raise SimulationError(message, where=mine.cell, hint="give both the same Units, or such as mph, km/h, ft/s, m")
    return factor


def _unpaired_forecasts(
    first: CompiledModel, second: CompiledModel, matched: Sequence[tuple[Forecast, Forecast]]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    mine, theirs = {a.name for a, _ in matched}, {b.name for _, b in matched}
    return (
        tuple(f.name for f in first.forecasts if f.name not in mine),
        tuple(f.name for f in second.forecasts if f.name not in theirs),
    )


def _simpler(first: CompiledModel, second: CompiledModel) -> int | None:
    mine, theirs = (
        (len(model.live), len(model.needed.graph.formulas), len(model.filters)) for model in (first, second)
    )
    return None if mine == theirs else int(theirs < mine)
