"""Sentences on a run that people quote, and the certainties that they rest on.

Each share stands with its error, and no number has more digits than its error supports.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.significant_digits import (
    EVEN,
    RoundedRange,
    percent_text,
    rounded_range,
    surely_above,
)
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind, Role
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.distributions.parameters import range_text
from xlmc.montecarlo.number_text import count_text, counted_text, number_text
from xlmc.montecarlo.statistics import Estimate, complement, probability_above, probability_between

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult
    from xlmc.montecarlo.statistics import Sample

__all__ = ["Certainty", "Statement", "certainties", "meaning", "stated_range", "statements"]


LIKELIER: Final = 0.55
"""The largest share of a range that is asked for to say where the answer more probably lies than not, such as 51 %."""

_SHARES: Final = (
    "Each share is a share of the accepted trials, counted for the range as it is printed here, and has its standard "
    "error beside it."
)
_LIKELY: Final = (
    "“More probable than not” is said only where the whole 95 % interval of the share lies above 50 %; ends are "
    "rounded outwards until it does."
)
_BOUNDS: Final = (
    "Of a bound one side alone is stated, and a share of trials in which the bound lies there is a least probability."
)
_HOLDS: Final = (
    "All of this holds only if the model and the ranges of its assumptions are right: the error given is Monte Carlo "
    "error, not {model_error}."
)


def meaning(workbook: Workbook, result: Sequence[Statement]) -> str:
    """Return the note that stands below the sentences of a workbook, on what these say."""
    notes = [_SHARES]
    if any("more probable than not" in each.text for each in result):
        notes.append(_LIKELY)
    if any(each.kind == "bound" for each in result):
        notes.append(_BOUNDS)
    return vocabulary_of(workbook).fill(" ".join([*notes, _HOLDS]))


@dataclass(frozen=True, slots=True)
class Statement:
    """A sentence on a forecast.

    Attributes:
        forecast: its name.
        kind: `range`, `bound` or `probability` (of a yes/no answer); `threshold`; or `certainty`.
        text: the sentence, without a full stop.
    """

    forecast: str
    kind: str
    text: str


def statements(simulation: RunResult) -> list[Statement]:
    """Say of every forecast, but diagnostics, where its central range lies or how probable a yes is, and how probable
    values above its threshold and in the range that was asked for are.
    """
    balances = vocabulary_of(simulation.model.workbook).balances
    return [each for result in simulation.results.values() for each in _of(result, balances)]


def stated_range(result: ForecastResult) -> RoundedRange | None:
    """Round the range that is stated of a forecast: its central one, or the side of it that a bound has.

    None if too few trials have a number.
    """
    definition, share = result.definition, result.definition.central
    ends: tuple[Estimate | None, Estimate | None] = result.statistics.central
    if definition.role is Role.LOWER:
        ends = result.percentile_at(100.0 * (1.0 - share)), None
    elif definition.role is Role.UPPER:
        ends = None, result.percentile_at(100.0 * share)
    return rounded_range(result.sample, ends, share, definition.report_to, result.form)


def _of(result: ForecastResult, balances: bool) -> list[Statement]:
    definition = result.definition
    if definition.role is Role.DIAGNOSTIC:
        return []
    part = _part_text(result)
    main = _main(result, part, balances)
    if main is None:
        what = "an answer" if result.kind in (Kind.YES_NO, Kind.CATEGORY) else "a number"
        why = "too few effective trials for its central range"
        if not result.sample.n:
            why = f"no accepted trial has {what}" if result.column.size else "no trial is accepted"
        return [Statement(definition.name, "range", f"{definition.name}: {why}")]
    return [main, *(replace(each, text=f"{each.text}{part}") for each in _probabilities(result))]


def _main(result: ForecastResult, part: str, balances: bool) -> Statement | None:
    """Return the sentence that answers the question; None if there are too few trials for one."""
    definition, trials = result.definition, result.statistics.trials
    name, units = definition.name, f" {definition.units}" if definition.units else ""
    if result.categories:
        return Statement(name, "probability", f"{name}: {_texts_text(result.categories)}{part}")
    if result.yes is not None:
        return Statement(name, "probability", f"{name}: {_yes_text(result, result.yes, balances)}{part}")
    rounded = stated_range(result)
    if rounded is None:
        return None
    if definition.role.is_bound:
        text = _bound_text(rounded, definition.central, units, trials, balances)
        return Statement(name, "bound", f"{name}: {text}{part}")
    text = _range_text(rounded, definition.central, units, trials, balances)
    return Statement(name, "range", f"{name}: {text}{part}")


def _texts_text(categories: Mapping[str, Estimate]) -> str:
    """`high with probability 45.1 % ± 0.4 %, middle 30.3 % ± 0.4 %, low 24.6 % ± 0.3 %`."""
    messages = [f"{text or '(empty)'} {percent_text(share)}" for text, share in categories.items()]
    first, share = next(iter(categories.items()))
    if share.value == 1.0:
        return f"{first or '(empty)'} in {percent_text(share)}"
    more = f", and {count_text(len(messages) - _MOST_TEXTS)} rarer texts" if len(messages) > _MOST_TEXTS else ""
    return ", ".join([f"{first or '(empty)'} with probability {percent_text(share)}", *messages[1:_MOST_TEXTS]]) + more


_MOST_TEXTS: Final = 6
"""Texts of one answer whose shares a sentence gives."""


def _yes_text(result: ForecastResult, yes: Estimate, balances: bool) -> str:
    """`yes with probability 84.2 % ± 0.4 %, more probable than not`; any number but 0 is a yes, as in Excel.

    Which of yes and no is more probable is said where that `balances`, as in court. That a lower bound is a yes makes
    the answer one; where it is a no, the answer may be either.
    """
    role = result.definition.role
    says = "" if result.sample.yes_no_at_most else "; numbers other than 0 and 1 count as yes"
    if (role, yes.value) in ((Role.LOWER, 0.0), (Role.UPPER, 1.0)):
        return f"the bound does not tell{says}"
    if yes.value in (0.0, 1.0):
        return f"yes in {percent_text(yes)}{says}"
    likelier = ""
    if balances and role is not Role.UPPER and surely_above(yes, EVEN):
        likelier = ", more probable than not"
    elif balances and role is not Role.LOWER and surely_above(complement(yes), EVEN):
        likelier = ", so no is more probable than yes"
    return f"yes with {_OF_ROLE.get(role, 'probability')} {percent_text(yes)}{likelier}{says}"


_OF_ROLE: Final = {Role.LOWER: "a probability of at least", Role.UPPER: "a probability of at most"}


def _probabilities(result: ForecastResult) -> Iterator[Statement]:
    """Return what was asked of a forecast beside its range; that a yes/no is above its limit is stated as a yes."""
    definition, above = result.definition, result.statistics.probability_above
    name, units = definition.name, f" {definition.units}" if definition.units else ""
    limit = definition.threshold
    as_yes = limit is not None and 0 <= limit < 1 and result.yes is not None and result.sample.yes_no_at_most
    if limit is not None and above is not None and not as_yes:
        event = f"{name} > {result.form.number(limit)}{units}"
        yield Statement(name, "threshold", _probability_text(event, above, _relation(definition.role, "above")))
    if definition.asked is not None and result.certainty is not None:
        event = f"{name} {range_text(*definition.asked, result.form.number)}{units}"
        side = "below" if math.isinf(definition.asked[0]) else "above" if math.isinf(definition.asked[1]) else "between"
        relation = _relation(definition.role, side)
        yield Statement(name, "certainty", _probability_text(event, result.certainty, relation))


def _relation(role: Role, side: str) -> str:
    """How the probability of a range of the quantity compares with the share of trials in which the forecast is in it.

    A lower bound that lies above a limit puts the quantity above it, too; it says nothing of both ends of a range.
    """
    if not role.is_bound:
        return "="
    if side == "between":
        return ""
    return "≥" if (role is Role.LOWER) == (side == "above") else "≤"


def _probability_text(event: str, share: Estimate, relation: str) -> str:
    """`P(Speed > 35 mph) = 1.6 % ± 0.3 %`; `P(Speed > 35 mph) ≥ 1.6 % ± 0.3 %` where the speed is a lower bound."""
    empty = {"≥": 0.0, "≤": 1.0}.get(relation)
    if not relation or share.value == empty:
        return f"P({event}): the bound does not tell"
    joined = ":" if share.value in (0.0, 1.0) else f" {relation}"
    return f"P({event}){joined} {percent_text(share)}"


def _part_text(result: ForecastResult) -> str:
    """Which of the accepted trials the shares are of, where a forecast has no answer in some of them."""
    numbers, others, discarded = result.statistics.trials, result.faults.total(), result.discards.total()
    if discarded:
        every = counted_text(numbers + others + discarded, "accepted trial")
        return f"; counted in the {count_text(numbers)} of {every} that its filters keep"
    if not others:
        return ""
    every = counted_text(numbers + others, "accepted trial")
    what = "has an answer" if result.kind in (Kind.YES_NO, Kind.CATEGORY) else "is a number"
    return f"; counted in the {count_text(numbers)} of {every} in which it {what}"


def _range_text(rounded: RoundedRange, nominal: float, units: str, trials: int, balances: bool) -> str:
    """`more probable than not (52.1 % ± 0.8 %) between 22.0 and 24.2 mph`, where that is so and what matters; else
    `the 80 % range (80.1 % ± 0.3 %) lies between 20.0 and 80.0 mph`.
    """
    share, between = rounded.share, rounded.words(units, "between", "and")
    if rounded.low == rounded.high:
        if share.value == 1.0:
            return f"{rounded.low_text}{units} in {_all(trials)}"
        between = f"equal to {rounded.low_text}{units}"
    elif share.value == 1.0:
        return f"{between} in {percent_text(share)}"
    if nominal > LIKELIER or not balances:
        lies = f"is {rounded.low_text}{units}" if rounded.low == rounded.high else f"lies {between}"
        return f"the {number_text(100.0 * nominal)} % range ({percent_text(share)}) {lies}"
    if surely_above(share, EVEN):
        return f"more probable than not ({percent_text(share)}) {between}"
    if nominal > EVEN:
        return f"{percent_text(share)} {between}; there are too few trials to call it more probable than not"
    return f"{percent_text(share)} {between}"


def _bound_text(rounded: RoundedRange, nominal: float, units: str, trials: int, balances: bool) -> str:
    """`at least 22 mph, more probable than not (51.3 % ± 0.4 %)`."""
    share, side = rounded.share, rounded.words(units)
    if share.value == 1.0:
        return f"{side} in {_all(trials)}"
    if balances and surely_above(share, EVEN) and nominal <= LIKELIER:
        return f"{side}, more probable than not ({percent_text(share)})"
    return f"{side}, with a probability of at least {percent_text(share)}"


def _all(trials: int) -> str:
    return f"all {count_text(trials)} trials" if trials > 1 else "the only trial"


@dataclass(frozen=True, slots=True)
class Certainty:
    """The share of a forecast's accepted trials in a range.

    Attributes:
        kind: `below`, `between` or `above` for the range that is stated; `at most` or `over` for the threshold;
            `asked` for the range that was asked for.
        low, high: the ends of the range, infinite where it has none. The ends of `below`, `above` and `over` do not
            belong to the range.
        words: the range in words, with units.
        share: the share of the trials in it, with its 95 % interval (Wilson's).
    """

    kind: str
    low: float
    high: float
    words: str
    share: Estimate


def certainties(result: ForecastResult) -> list[Certainty]:
    """Return the certainties below, in and above the range that is stated, as it is printed; those of the threshold, if
    any, and of the range that was asked for, if any. Answers that are counted have no range.
    """
    definition, sample = result.definition, result.sample
    units = f" {definition.units}" if definition.units else ""
    spoken = None if result.yes is not None else stated_range(result)
    results = [] if spoken is None else _around(spoken, sample, result.form, units)
    threshold, above = definition.threshold, result.statistics.probability_above
    if threshold is not None and above is not None and sample.n:
        at_most = probability_between(sample, -math.inf, threshold)
        form, limit = result.form, f"{result.form.number(threshold)}{units}"
        results.append(Certainty("at most", -math.inf, threshold, f"{form.side('at most')} {limit}", at_most))
        results.append(Certainty("over", threshold, math.inf, f"{form.side('above')} {limit}", above))
    if definition.asked is not None and result.certainty is not None:
        words = f"{range_text(*definition.asked, result.form.number)}{units}"
        results.append(Certainty("asked", *definition.asked, words, result.certainty))
    return results


def _around(spoken: RoundedRange, sample: Sample, form: Form, units: str) -> list[Certainty]:
    """Return the certainties below, in and above a range; below or above alone beside one that has no other end."""
    low, high = spoken.low, spoken.high
    result = [Certainty("between", low, high, spoken.words(units), spoken.share)]
    if spoken.low_text:
        under = probability_between(sample, -math.inf, math.nextafter(low, -math.inf))
        result.insert(0, Certainty("below", -math.inf, low, f"{form.side('below')} {spoken.low_text}{units}", under))
    if spoken.high_text:
        over = probability_above(sample, high)
        result.append(Certainty("above", high, math.inf, f"{form.side('above')} {spoken.high_text}{units}", over))
    return result
