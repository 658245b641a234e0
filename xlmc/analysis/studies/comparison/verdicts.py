"""What a comparison or a screening found, in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from xlmc.analysis.studies.comparison.comparison import Cause, Comparison, ForecastComparison
from xlmc.analysis.studies.comparison.cost import Cost
from xlmc.analysis.studies.comparison.differences import Change
from xlmc.analysis.studies.comparison.rivalry import Rivalry, RivalVerdict
from xlmc.analysis.studies.comparison.tolerances import Judgement, Verdict
from xlmc.montecarlo.definitions.forms import Form, span_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, fixed_text, number_text
from xlmc.montecarlo.statistics import Estimate, format_estimate

__all__ = [
    "amount",
    "book_names",
    "inputs_text",
    "is_chance",
    "points",
    "tolerance_text",
    "undecided_text",
    "verdict_text",
]


def book_names(comparison: Comparison) -> tuple[str, str]:
    """Name the two books: by their file names, or their paths where the names are the same."""
    first, second = comparison.first.model.path, comparison.second.model.path
    return (str(first), str(second)) if first.name == second.name else (first.name, second.name)


def verdict_text(comparison: Comparison) -> list[str]:
    """Yield the verdict, a sentence or two for each kind of it."""
    books = book_names(comparison)
    return [
        *_enough(comparison, books),
        *_apart_in_trials(comparison),
        *_rivals(comparison.rivals, books),
        *(_too_little(comparison, each, books) for each in comparison.of(Verdict.BEYOND)),
        *_undecided_text(comparison),
        *_lost(comparison, books),
    ]


def _lost(comparison: Comparison, books: tuple[str, str]) -> Iterator[str]:
    """Yield which answers of a book are of some of the trials only, since errors in cells take the others."""
    for name, run, side in zip(books, (comparison.first, comparison.second), ("first", "second"), strict=True):
        losing = [getattr(each, side).name for each in comparison.forecasts]
        losing = [each for each in losing if run.loses_too_many(each)]
        if losing:
            most = number_text(100.0 * max(map(run.lost_share, losing)), 2)
            answers = _join_names([repr(each) for each in losing])
            yield (
                f"In {name} errors in cells take up to {most} % of the trials: what is said of {answers} concerns the "
                "trials that are left."
            )


def _subject(comparison: Comparison, books: tuple[str, str]) -> str:
    if comparison.source is not None:
        return f"{books[0]} without {comparison.source.model.path.name}"
    return "" if comparison.simpler is None else f"The simpler model, {books[comparison.simpler]},"


def _enough(comparison: Comparison, books: tuple[str, str]) -> Iterator[str]:
    within = comparison.of(Verdict.WITHIN)
    if not within:
        return
    names = _join_names([f"{_name(each)} to {_tolerance(each)}" for each in within])
    subject = _subject(comparison, books)
    yield f"{subject} is enough for {names}." if subject else f"The two books agree for {names}."


def _apart_in_trials(comparison: Comparison) -> Iterator[str]:
    """Return the answers that agree as a whole only; of books that draw other inputs, trials say nothing of
    each other.
    """
    if not any(comparison.inputs.drawn):
        yield from (_only_as_a_whole(each) for each in comparison.of(Verdict.WITHIN) if each.only_distributions_agree)


def _only_as_a_whole(each: ForecastComparison) -> str:
    """Two answers with one distribution that are not one number, as 10 + z and 10 − z."""
    difference, units = each.difference, f" {each.first.units}" if each.first.units else ""
    if difference.shares:
        how = f"give another answer in {number_text(100 * difference.typical**2, 2)} % of the trials that both accept"
    else:
        typical, largest = (
            f"{tolerance_text(one, difference.form)}{units}" for one in (difference.typical, difference.largest)
        )
        how = f"give numbers that differ by {typical} (root mean square), {largest} at most"
    return (
        f"Of {_name(each)} only the distributions agree, and the trials do not: from the same draws the books {how}. "
        "What is computed from it together with other answers may not agree."
    )


def _too_little(comparison: Comparison, each: ForecastComparison, books: tuple[str, str]) -> str:
    change = dict(each.difference.changes)[each.judgement.largest]
    number = _differs(each, each.judgement.largest, change.difference)
    subject = _subject(comparison, books)
    verdict = f"{subject} is not enough for" if subject else "The two books do not agree for"
    because = "" if each.cause is None else f"{', ' * bool(each.cause.steps)}{_because(each.cause, each, books)}"
    ending = _trial_by_trial(each, comparison.acceptance.both)
    return f"{verdict} {_name(each)} to {_tolerance(each)}: {number}{because}.{ending}"


def _rivals(each: Sequence[ForecastComparison], books: tuple[str, str]) -> Iterator[str]:
    """Two models of one scene: which tells more, in one sentence for all answers, and one for each."""
    result = [(one, one.rivalry) for one in each if one.rivalry is not None]
    if len(result) > 1:
        yield _rivals_summary([rivals for _, rivals in result], books)
    yield from (_rival(one, rivals, books) for one, rivals in result)


def _rivals_summary(rivalries: Sequence[Rivalry], books: tuple[str, str]) -> str:
    counts = {side: sum(rivals.sharper == side for rivals in rivalries) for side in (0, 1)}
    more = [f"{books[side]} tells more of {count}" for side, count in counts.items() if count]
    worst = max((rivals.agreement for rivals in rivalries), key=list(RivalVerdict).index)
    tells = _join_names(more) if more else "neither tells more of any, as far as these trials say"
    return (
        f"Each book computes {len(rivalries)} answers from inputs that the other has not: {tells}; {_ALL_AGREE[worst]}."
    )


_ALL_AGREE = {
    RivalVerdict.AGREE: "all agree",
    RivalVerdict.TOO_FEW: "of some, too few trials say whether they agree",
    RivalVerdict.STRAINED: "some are strained",
    RivalVerdict.CONTRADICT: "some contradict each other",
}


def _rival(each: ForecastComparison, rivalry: Rivalry, books: tuple[str, str]) -> str:
    """Which of two models tells more of an answer, and whether they agree."""
    if books[0] == books[1]:  # one book that answers twice
        books = (repr(each.first.name), repr(each.second.name))
    spreads = (rivalry.deviation, rivalry.width)
    deviations, widths = (_spreads(spread, each.difference.form, each.first.units) for spread in spreads)
    share = f"{number_text(100 * each.difference.share, 3)} % range"
    if rivalry.sharper is not None:
        mine, theirs = rivalry.sharper, 1 - rivalry.sharper
        name, sizes = (share, widths) if rivalry.by_range else ("standard deviation", deviations)
        tells = f"{books[mine]} tells more, with a {name} of {sizes[mine]} against {sizes[theirs]} of {books[theirs]}"
    elif rivalry.contrary:
        tells = (
            f"neither tells more: standard deviations of {_join_names(deviations)}, but {share}s of "
            f"{_join_names(widths)}; look at the percentiles"
        )
    else:
        tells = f"neither tells more, as far as these trials say: standard deviations of {_join_names(deviations)}"
    return f"{_name(each)}: {tells}. {_AGREE[rivalry.agreement].format(chance=_chance_text(rivalry))}"


def _spreads(spread: Change, form: Form, units: str) -> list[str]:
    return [f"{form.spread(each)} {units}".rstrip() for each in (spread.first, spread.second)]


_AGREE = {
    RivalVerdict.AGREE: "The two answers agree.",
    RivalVerdict.STRAINED: "The two answers are strained: {chance}.",
    RivalVerdict.CONTRADICT: "The two answers contradict each other: {chance}. A range, or a model, is wrong.",
    RivalVerdict.TOO_FEW: "Too few trials are accepted by both to say whether the answers agree.",
}


def _chance_text(rivalry: Rivalry) -> str:
    if not rivalry.chance:
        return f"in all {count_text(rivalry.both)} trials that both accept they differ in one direction"
    return f"a difference as far from 0 as theirs, or farther, has a chance of {number_text(100 * rivalry.chance, 2)} %"


_WHY = {
    "filter": ("the filter {names} of {book} moves it", "the filters {names} of {book} move it"),
    "evidence": ("the evidence {names} of {book} moves it", "the evidence {names} of {book} moves it"),
    "assumption": ("only {book} draws {names}", "only {book} draws {names}"),
    "distribution": ("{names} is drawn differently", "{names} are drawn differently"),
}
_WITHOUT = {
    "filter": "without {it}",
    "evidence": "without {it}",
    "assumption": "with {it} held at the base value",
    "distribution": "drawn alike",
}


def _because(cause: Cause, each: ForecastComparison, books: tuple[str, str]) -> str:
    left = _differs(each, cause.number, cause.left)
    if not cause.steps:
        return (
            ". No filter, drawn assumption or distribution in which the books differ explains this: the cause is in "
            "the formulas or in values that are held"
        )
    reasons, remedies = [], []
    for kind, why in _WHY.items():
        for side in (0, 1):
            names = [repr(s.name) for s in cause.steps if s.word == kind and s.side == side]
            if names:
                reasons.append(why[len(names) > 1].format(names=_join_names(names), book=books[side]))
                remedy = _WITHOUT[kind].format(it="it" if len(names) == 1 else "them")
                remedies.append(remedy)
    return f"because {_join_names(reasons)}; {_join_names(list(dict.fromkeys(remedies)))} {left}"


def _trial_by_trial(each: ForecastComparison, both: int) -> str:
    if each.same_in_every_trial:
        what = "answer" if each.difference.shares else "number"
        same = f"In each of the {count_text(both)} trials that both accept they give the same {what}"
        return f" {same}: they differ only in which trials they accept."
    return ""


def _undecided_text(comparison: Comparison) -> Iterator[str]:
    for each in comparison.of(Verdict.UNDECIDED):
        change = dict(each.difference.changes)[each.judgement.largest]
        start = f"Undecided for {_name(each)} at {count_text(comparison.first.trials)} trials"
        if math.isnan(change.difference.value) or change.difference.error is None:
            yield f"{start}: {_too_few(comparison, each)}."
            continue
        number = _differs(each, each.judgement.largest, change.difference)
        more = _more(each.judgement, comparison)
        yield f"{start}: {number}, which is too near to the tolerance of {_tolerance(each)}; {more}."


def _too_few(comparison: Comparison, each: ForecastComparison) -> str:
    runs = ((comparison.first, each.first.name), (comparison.second, each.second.name))
    texts = [run.results[name].kind is Kind.CATEGORY for run, name in runs]
    if texts[0] != texts[1]:
        books = book_names(comparison)
        mine, theirs = (books[texts.index(kind)] for kind in (True, False))
        return f"its answers are texts in {mine} and numbers in {theirs}, which cannot be compared"
    for book, (run, name) in zip(book_names(comparison), runs, strict=True):
        numbers = int(np.count_nonzero(~np.isnan(run.forecasts[name])))
        if numbers < run.accepted and numbers < _ENOUGH:
            count = "none" if not numbers else f"only {numbers}"
            return f"it is a number in {count} of the {count_text(run.accepted)} trials that {book} accepts"
    return "too few of them are accepted"


_ENOUGH: Final = 100
"""The fewest numbers that are enough to know an error."""


def _more(judgement: Judgement, comparison: Comparison) -> str:
    if math.isinf(judgement.times):
        return (
            "the difference is as large as the tolerance, and no number of trials will decide: state another tolerance"
        )
    return f"about {_two_digits(judgement.times * comparison.first.trials)} trials would decide"


def _two_digits(trials: float) -> str:
    """Round up, for the number is a guess: 10,423,263 -> 11,000,000."""
    step = math.pow(10.0, max(0, math.floor(math.log10(trials)) - 1))
    return fixed_text(math.ceil(trials / step) * step, 0)


def inputs_text(comparison: Comparison) -> list[str]:
    """Which assumptions and filters the books share, and which they do not."""
    inputs, books = comparison.inputs, book_names(comparison)
    alike = len(inputs.alike)
    lines = [f"{alike} assumption{' is' if alike == 1 else 's are'} drawn alike in both books."]
    lines += [
        f"{u.name!r} is not the same: {u.first} | {u.second}." for u in (*inputs.unlike, *inputs.frozen_differently)
    ]
    for book, drawn, filters, unpaired in zip(books, inputs.drawn, inputs.filters, comparison.unpaired, strict=True):
        for what, names in (("Drawn", drawn), ("Filters", filters), ("Forecasts", unpaired)):
            if names:
                lines.append(f"{what} only in {book}: {'; '.join(names)}.")
    return lines


def undecided_text(cost: Cost, trials: int) -> str:
    """Name a change that is undecided, and what would decide it: `Weight (about 260,000 trials would decide)`."""
    names = ", ".join(cost.names)
    if cost.lost:
        return f"{names} ({_join_names([repr(name) for name in cost.lost])} is then hardly ever a number)"
    if cost.judgement.blind:
        return f"{names} (too few trials are accepted)"
    if math.isinf(cost.judgement.times):
        return f"{names} (as large as the tolerance)"
    return f"{names} (about {_two_digits(cost.judgement.times * trials)} trials would decide)"


def _name(each: ForecastComparison) -> str:
    same = each.first.name.casefold() == each.second.name.casefold()
    return each.first.name if same else f"{each.first.name} ({each.second.name})"


def _tolerance(each: ForecastComparison) -> str:
    if each.difference.shares:
        return _join_names([f"{points(limit)} of {number}" for number, limit in each.limits.items()])
    chances = [f"{number} to {points(limit)}" for number, limit in each.limits.items() if is_chance(number)]
    return " and ".join(
        [f"{tolerance_text(each.tolerance, each.difference.form)} {each.first.units}".rstrip(), *chances]
    )


def _differs(each: ForecastComparison, number: str, difference: Estimate) -> str:
    form, units = each.difference.form, each.first.units
    return f"{'' if is_chance(number) else 'the '}{number} differs by {amount(number, difference, form, units)}"


def is_chance(number: str) -> bool:
    """Whether a number is a probability: P(> threshold), P(yes) or that of a text."""
    return number.startswith("P(")


def points(share: float) -> str:
    """Write a difference of probabilities: `1.2 points`."""
    return f"{number_text(100 * share, 3)} point{'s' * (share != 0.01)}"


def tolerance_text(value: float, form: Form) -> str:
    """Write a tolerance, or another difference without an error, in four digits at most; of dates a span of time."""
    if not math.isfinite(value):
        return ""
    return span_text(value) if form.kind is Kind.DATE else form.rough(float(f"{value:.4g}"))


def amount(number: str, estimate: Estimate, form: Form, units: str = "") -> str:
    """Write a difference of a number with its error: of a probability in percentage points, of dates a span of time."""
    if math.isnan(estimate.value):
        return "no number"
    if is_chance(number):
        scaled = None if estimate.error is None else 100 * estimate.error
        return f"{format_estimate(100 * estimate.value, scaled)} points"
    return f"{form.spread(estimate)} {units}".rstrip()


def _join_names(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
