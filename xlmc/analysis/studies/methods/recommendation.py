"""Which method to use, in words, for the accuracy that was asked for, and why the answers of other methods are off.

The error of an answer that was given once has two parts, measured apart: its distance from the answer without filters,
which the method made of the formulas alone, and the distance from there to the answer with them, which it cannot see.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.results.record.make import simulate_command
from xlmc.analysis.studies.methods.answer import percent_words, rounded_text, seconds_text, statistic_words, trials_text
from xlmc.analysis.studies.methods.curve import Curve
from xlmc.analysis.studies.methods.need import ENGINE_READY, NO_TIME, Choice, Need, WorstError, choice, worst_error
from xlmc.analysis.studies.methods.sampled import MONTE_CARLO, Sampled
from xlmc.analysis.studies.methods.study import Study
from xlmc.analysis.studies.steps import ended_early
from xlmc.errors import capitalised
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.number_text import fixed_text, number_text, styled_text

__all__ = ["Parts", "parts_of", "recommendation"]

_FAR: Final = 64.0
"""If errors are carried on to more than this many times the measured runs, a sentence says so."""

_NOTABLE: Final = 0.05
"""The relative standard error from which on a number of trials that no run had is given with it."""

_ERROR_WORDS: Final = (
    "All errors here are those of computing the answer, measured against the reference; none says whether the model "
    "{fits}, or whether the ranges of the assumptions are right."
)

_BEYOND: Final = 3.0
"""Standard errors from which on a part counts as measured."""

_LEFT_OUT: Final = {
    "taylor-1": "it takes every curve for straight and every answer for normally distributed",
    "taylor-2": "over these ranges the formulas are more than quadratic polynomials",
}
_ELSE: Final = "it leaves something out of the formulas"


def recommendation(study: Study) -> list[str]:
    """Paragraphs: what to use, why, what else would do, and what the others cannot."""
    warned = [f"Warning: {warning}; the answers must not be used as they are." for warning in study.reference.warnings]
    left_out = (
        [f"Left out, because no method computes a mean of texts: {'; '.join(study.texts)}."] if study.texts else []
    )
    few = "Fewer runs were made than were to be, so that errors are known less well."
    ended = [ended_early("study", study.ended, few)] if study.ended else []
    return [*warned, *ended, *_paragraphs(study), *left_out]


def _paragraphs(study: Study) -> list[str]:
    if not study.varying:
        numbers = any(np.isfinite(answer.mean) for answer in study.reference.answers.values())
        return [
            "No forecast varies: there is nothing to compute with any method."
            if numbers
            else "No forecast is a number in more than one trial: there is nothing to compute with any method."
        ]
    result = choice(study)
    once = [(curve, worst_error(study, curve)) for curve in study.once if curve.answers]
    verdict, *others = _drawing_text(study, result)
    sentences = [verdict, _accuracy_text(study), *_heavy_text(study), *others, *_once_text(once)]
    sentences += [_never_text(study, curve, each) for curve, each in result.needs.items() if each.reaches == "no"]
    sentences += [_unknown_text(curve, each) for curve, each in result.needs.items() if each.reaches == "unknown"]
    sentences += [_missed_text(study, curve, each) for curve, each in once if each.reaches == "no"]
    sentences += [_undecided_text(study, curve, each) for curve, each in once if each.reaches == "unknown"]
    sentences += _bounds_text(study)
    return [*sentences, vocabulary_of(study.model.workbook).fill(_ERROR_WORDS)]


def _accuracy_text(study: Study) -> str:
    text, _, relative = study.accuracy
    text = f"{text[:-1].rstrip()} %" if text.endswith("%") else text
    what = f"{text} of its 5–95 % range" if relative else f"{text} in its units"
    numbers = "mean, standard deviation and both ends of the central range of every forecast"
    if any(study.reference.form(name).kind is Kind.YES_NO for name in study.varying):
        numbers += " (of a yes/no answer its share)"
    sentences = f"Asked for: {numbers}, each known to within {what}, in 95 of 100 runs."
    if relative:
        sentences += (
            " The 5–95 % range of a forecast is what nine tenths of its accepted trials lie in: "
            f"{'; '.join(_range(study, name) for name in study.varying)}."
        )
    return sentences


def _range(study: Study, name: str) -> str:
    return f"{name} {study.amount(name, study.reference.widths[name], 3)} wide"


def _heavy_text(study: Study) -> list[str]:
    """Return the statistics that no method can find."""
    return [
        f"The {' and '.join(map(statistic_words, lost))} of {name} {'do' if len(lost) > 1 else 'does'} not converge, "
        "as far as these trials show, because its tail is too heavy: more trials help no method. All else "
        "leaves this out; report percentiles."
        for name, lost in study.reference.heavy.items()
        if name in study.varying
    ]


def _drawing_text(study: Study, result: Choice) -> list[str]:
    if result.chosen is None:
        return ["No method that draws reaches this accuracy: ask for an accuracy above 0."]
    chosen, wanted = result.chosen, result.needs[result.chosen]
    sentences = (
        f"Recommended: {chosen.method.name}, about {trials_text(wanted.trials)} trials, "
        f"{seconds_text(wanted.seconds)}; the {statistic_words(wanted.statistic)} of {wanted.forecast} needs the most. "
        f"{_saving(result)}"
    )
    if wanted.beyond > _FAR:
        sentences += (
            f" That is {fixed_text(wanted.beyond, 0)} times as many trials as the longest measured "
            "runs had; it is computed from "
            "how their errors fall."
        )
    if wanted.beyond > 1.0 and wanted.error >= _NOTABLE:
        sentences += (
            f" The number of trials is computed, and known to a factor of {number_text(np.exp(2.0 * wanted.error), 2)}."
        )
    others = sorted(
        (curve for curve, each in result.needs.items() if curve is not chosen and each.usable),
        key=lambda curve: result.needs[curve].seconds,
    )
    rest = "; ".join(
        f"{curve.method.name} {trials_text(result.needs[curve].trials)} trials, "
        f"{seconds_text(result.needs[curve].seconds)}"
        for curve in others
    )
    return [f"{sentences} {_command(study, chosen, wanted)}", *([f"The others would need: {rest}."] if rest else [])]


def _saving(result: Choice) -> str:
    """Return what the clock alone would choose."""
    assert result.chosen is not None
    least = result.cheapest[0]
    if result.chosen in result.cheapest:
        saved = result.needs[result.chosen].seconds - result.needs[least].seconds
        if saved <= NO_TIME:
            return "No other method saves a tenth of a second."
        return f"{_names([c for c in result.cheapest if c is not result.chosen])} take the same time within 20 %."
    tied = [curve for curve in result.cheapest if curve is not least]
    sentences = f"By the clock alone {least.method.name} is cheapest, {seconds_text(result.needs[least].seconds)}"
    if tied:
        sentences += f", and {_names(tied)} take the same time within 20 % or a tenth of a second"
    saved = result.needs[result.chosen].seconds - result.needs[least].seconds
    return f"{sentences}: it saves {seconds_text(saved)}{_price(least, result.chosen)}."


def _price(cheap: Curve, chosen: Curve) -> str:
    """Return what a method that is cheaper by the clock costs otherwise."""
    if isinstance(cheap.method, Sampled) and cheap.method.engine != MONTE_CARLO.engine:
        return f" of the run, and takes about {seconds_text(ENGINE_READY)} to compile"
    lost = chosen.method.errors == "independent" and cheap.method.errors != "independent"
    return ", and gives up independent trials" if lost else ""


def _names(curves: Sequence[Curve]) -> str:
    names = [curve.method.name for curve in curves]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _command(study: Study, curve: Curve, wanted: Need) -> str:
    method = curve.method
    if not isinstance(method, Sampled):
        call = f"xlmc.analysis.studies.methods.{type(method).__name__}().run(model, {wanted.trials:.0f}, seed=1)"
        return f"It runs from Python: `{call}`."
    text, _, relative = study.accuracy
    text = f"{text[:-1].rstrip()} %" if text.endswith("%") else text
    model = study.model
    asked = RunOptions(
        trials=_upwards(wanted.trials) if relative else None,
        sampling=method.method,
        engine=method.engine,
        evidence="rejection" if model.chances else None,
    )
    command = simulate_command(model.workbook.name, asked.arguments(model.definitions.settings))
    if relative:
        return f"`{command}` runs it, and prints what each number is known to."
    numbers = "range" if study.reference.heavy else "mean,sd,range"
    command += f" --precision {text.replace(' ', '')} --precision-of {numbers}"
    return f"`{command}` goes on until the run's own errors say that the accuracy is reached."


def _upwards(trials: float) -> int:
    """Two significant digits, never fewer trials than that.

    >>> _upwards(383_000.0)
    390000
    """
    size = int(10 ** max(len(f"{trials:.0f}") - 2, 0))
    return math.ceil(trials / size) * size


def _once_text(once: Sequence[tuple[Curve, WorstError]]) -> list[str]:
    enough = [curve for curve, result in once if result.reaches == "yes"]
    if not enough:
        return []
    verbs = ("is", "needs") if len(enough) == 1 else ("are", "need")
    sentences = (
        f"{_names(enough)} {verbs[0]} near enough, and {verbs[1]} no draws at all; only the reference shows that."
    )
    return [sentences]


def _never_text(study: Study, curve: Curve, need: Need) -> str:
    off = study.amount(need.forecast, need.floor * study.tolerance(need.forecast))
    return (
        f"{curve.method.name} never reaches it: the {statistic_words(need.statistic)} of {need.forecast} stays off "
        f"by about {off}, {rounded_text(need.floor)} times what was asked for, however many "
        "trials it runs."
    )


def _unknown_text(curve: Curve, need: Need) -> str:
    if curve.method.errors != "floor":
        return (
            f"These runs cannot tell what {curve.method.name} needs: too few of them gave a number for the "
            f"{statistic_words(need.statistic)} of {need.forecast}. Longer runs can."
        )
    return (
        f"These runs cannot tell whether {curve.method.name} reaches it: more trials do not remove all of its error, "
        f"and only more and longer runs can show whether what is left of it in the {statistic_words(need.statistic)} "
        f"of {need.forecast} is small enough."
    )


def _undecided_text(study: Study, curve: Curve, result: WorstError) -> str:
    off, own, wanted = (
        study.amount(result.forecast, each)
        for each in (abs(result.error), result.own, study.tolerance(result.forecast))
    )
    return (
        f"This reference cannot tell whether {curve.method.name} is near enough: it is off by "
        f"{off} ± {own} in the {statistic_words(result.statistic)} of {result.forecast}, where {wanted} was asked for. "
        "More --reference-trials can."
    )


def _bounds_text(study: Study) -> list[str]:
    curves = [curve for curve in study.once if curve.ranges]
    widths = []
    for curve in curves:
        ratios = [
            (most - least) / (answer.high - answer.low)
            for name, (least, most) in curve.ranges.items()
            if name in study.varying and (answer := study.reference.answers[name]).high > answer.low
        ]
        if ratios:
            low, high = styled_text(min(ratios), ".1f"), styled_text(max(ratios), ".1f")
            widths.append(f"{curve.method.name} {low}" + (f" to {high}" if high != low else ""))
    if not widths:
        return []
    return [
        "Bounds answer another question, what is possible and not what is likely. Their widths, in central ranges: "
        f"{'; '.join(widths)}."
    ]


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of an error, in the forecast's units, with its sign.

    Attributes:
        filters: what the filters do, which the method does not see.
        formulas: what it leaves out of the formulas.
        error: the standard error of each of them.
    """

    filters: float
    formulas: float
    error: float


def parts_of(study: Study, result: WorstError) -> Parts | None:
    """Return the parts of an error; None if there are no filters that reject anything, or no answer without them."""
    if study.unfiltered is None:
        return None
    free, own = study.unfiltered.answers[result.forecast], study.unfiltered.errors[result.forecast]
    truth = study.reference.answers[result.forecast]
    filters = float(getattr(free, result.statistic)) - float(getattr(truth, result.statistic))
    error = float(np.nan_to_num(getattr(own, result.statistic)))
    return Parts(filters, result.error - filters, float(np.hypot(error, np.nan_to_num(result.own))))


def _missed_text(study: Study, curve: Curve, result: WorstError) -> str:
    """Return what a method misses by the most, and why, in a sentence or two."""
    if not np.isfinite(result.times):
        return f"{curve.method.name} has no number for {result.forecast}."
    share = abs(result.error) / study.reference.widths[result.forecast]
    text = (
        f"{curve.method.name} misses the {statistic_words(result.statistic)} of {result.forecast} by "
        f"{study.amount(result.forecast, abs(result.error))}, {percent_words(share)} of its 5–95 % range"
    )
    why = _LEFT_OUT.get(curve.method.key, _ELSE)
    rejected = 1.0 - study.reference.acceptance.value
    if not study.model.filters or rejected == 0.0:
        return f"{text}: {why}."
    seen = f"it does not see the filters, which reject {percent_words(rejected)} of the trials"
    parts = parts_of(study, result)
    if parts is None:
        return (
            f"{text}. {capitalised(seen)}; and {why}. No answer without filters is known that would tell the "
            "two parts from each other."
        )

    def part(value: float, because: str, otherwise: str) -> str:
        return _part(study, result.forecast, value, parts, because, otherwise)

    filters = part(parts.filters, f"because {seen}", "for the filters, which it does not see")
    formulas = part(parts.formulas, f"because {why}", "for what it leaves out of the formulas")
    return f"{text}. Measured apart: {filters}; {formulas}."


def _part(study: Study, forecast: str, value: float, parts: Parts, because: str, otherwise: str) -> str:
    if abs(value) <= _BEYOND * parts.error:
        return f"no more than chance (±{study.amount(forecast, _BEYOND * parts.error)}) {otherwise}"
    return f"{'+' if value > 0.0 else '−'}{study.amount(forecast, abs(value))} {because}"
