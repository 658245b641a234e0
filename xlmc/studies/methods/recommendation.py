"""Which method to use, in words, for the accuracy that was asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.studies.methods.causes import missed
from xlmc.studies.methods.choice import NO_TIME, Choice, choice
from xlmc.studies.methods.curve import Curve
from xlmc.studies.methods.need import Need, Shortfall, shortfall
from xlmc.studies.methods.number_words import rounded, seconds_text, spelt, trials_text
from xlmc.studies.methods.sampled import MONTE_CARLO, Sampled
from xlmc.studies.methods.study import Study

__all__ = ["ERROR_WORDS", "recommendation"]

_FAR: Final = 64.0
"""So many times beyond the measured runs, errors are only carried on with a word of warning."""

ERROR_WORDS: Final = (
    "All errors here are those of computing the answer, measured against the reference; none says whether the model "
    "fits the crash, or whether the ranges of the assumptions are right."
)


def recommendation(study: Study) -> list[str]:
    """Paragraphs: what to use, why, what else would do, and what the others cannot."""
    warned = [
        f"Warning: {warning}; the answers must not be used as they stand." for warning in study.reference.warnings
    ]
    return [*warned, *_paragraphs(study)]


def _paragraphs(study: Study) -> list[str]:
    if not study.varying:
        numbers = any(np.isfinite(answer.mean) for answer in study.reference.answers.values())
        return [
            "No forecast varies: there is nothing to compute with any method."
            if numbers
            else "No forecast is a number in more than one trial: there is nothing to compute with any method."
        ]
    found = choice(study)
    once = [(curve, shortfall(study, curve)) for curve in study.once if curve.answers]
    said = [_asked(study), *_heavy(study), *_drawing(study, found), *_without_drawing(once)]
    said += [_never(study, curve, each) for curve, each in found.needs.items() if each.reaches == "no"]
    said += [_unknown(curve, each) for curve, each in found.needs.items() if each.reaches == "unknown"]
    said += [missed(study, curve, each) for curve, each in once if each.reaches == "no"]
    said += [_undecided(study, curve, each) for curve, each in once if each.reaches == "unknown"]
    said += _bounds(study)
    return [*said, ERROR_WORDS]


def _asked(study: Study) -> str:
    text, _, relative = study.accuracy
    what = f"{text} of its 5–95 % range" if relative else f"{text} in its units"
    numbers = "mean, standard deviation and both ends of the central range of every forecast"
    said = f"Asked for: {numbers}, each known to within {what}, in 95 of 100 runs."
    if relative:
        said += (
            " The 5–95 % range of a forecast is what nine tenths of its accepted trials lie in: "
            f"{'; '.join(_range(study, name) for name in study.varying)}."
        )
    return said


def _range(study: Study, name: str) -> str:
    units = next((f" {f.units}" for f in study.model.forecasts if f.name == name and f.units), "")
    return f"{name} {study.reference.widths[name]:.3g}{units} wide"


def _heavy(study: Study) -> list[str]:
    """What no method comes near to."""
    return [
        f"The {' and '.join(map(spelt, lost))} of {name} {'do' if len(lost) > 1 else 'does'} not converge as far as "
        "these trials show, for its tail is too heavy: more of them bring no method nearer. Left out in what follows; "
        "report percentiles."
        for name, lost in study.reference.heavy.items()
        if name in study.varying
    ]


def _drawing(study: Study, found: Choice) -> list[str]:
    if found.chosen is None:
        return ["No method that draws comes to this accuracy: ask for one that is more than nothing."]
    chosen, wanted = found.chosen, found.needs[found.chosen]
    said = (
        f"Recommended: {chosen.method.name}, about {trials_text(wanted.trials)} trials, "
        f"{seconds_text(wanted.seconds)}; the {spelt(wanted.statistic)} of {wanted.forecast} needs the most. "
        f"{_saving(found)}"
    )
    if wanted.beyond > _FAR:
        said += (
            f" That is {wanted.beyond:,.0f} times as many trials as the longest measured runs had, and carried on from "
            "them."
        )
    others = sorted(
        (curve for curve, each in found.needs.items() if curve is not chosen and each.usable),
        key=lambda curve: found.needs[curve].seconds,
    )
    rest = "; ".join(
        f"{curve.method.name} {trials_text(found.needs[curve].trials)} trials, "
        f"{seconds_text(found.needs[curve].seconds)}"
        for curve in others
    )
    return [f"{said} {_command(study, chosen, wanted)}", *([f"The others would need: {rest}."] if rest else [])]


def _saving(found: Choice) -> str:
    """What the clock alone would choose."""
    assert found.chosen is not None
    least = found.cheapest[0]
    if found.chosen in found.cheapest:
        saved = found.needs[found.chosen].seconds - found.needs[least].seconds
        if saved <= NO_TIME:
            return "No other method saves a tenth of a second."
        return f"{_names([c for c in found.cheapest if c is not found.chosen])} cost the same within 20 %."
    tied = [curve for curve in found.cheapest if curve is not least]
    said = f"By the clock alone {least.method.name} is cheapest, {seconds_text(found.needs[least].seconds)}"
    if tied:
        said += f", and {_names(tied)} within 20 % or a tenth of a second of it, which is a tie"
    saved = found.needs[found.chosen].seconds - found.needs[least].seconds
    why = "" if _same_trials(least, found.chosen) else ", and gives up independent trials"
    return f"{said}: it saves {seconds_text(saved)}{why}."


def _same_trials(curve: Curve, chosen: Curve) -> bool:
    methods = curve.method, chosen.method
    return all(isinstance(each, Sampled) and each.method == MONTE_CARLO.method for each in methods)


def _names(curves: Sequence[Curve]) -> str:
    names = [curve.method.name for curve in curves]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _command(study: Study, curve: Curve, wanted: Need) -> str:
    method = curve.method
    if not isinstance(method, Sampled):
        call = f"xlmc.studies.methods.{type(method).__name__}().run(model, {wanted.trials:.0f}, seed=1)"
        return f"It runs from Python: `{call}`."
    text, _, relative = study.accuracy
    options = [
        f"--{name} {chosen}"
        for name, chosen, usual in (
            ("sampling", method.method, MONTE_CARLO.method),
            ("engine", method.engine, MONTE_CARLO.engine),
        )
        if chosen != usual
    ]
    command = " ".join(["xlmc simulate", study.model.workbook.name, *options])
    if relative:
        return f"`{command} -n {_upwards(wanted.trials)}` runs it, and prints what each number is known to."
    numbers = "range" if study.reference.heavy else "mean,sd,range"
    command += f" --precision {text.replace(' ', '')} --precision-of {numbers}"
    return f"`{command}` goes on until the run's own errors say that it is reached."


def _upwards(trials: float) -> int:
    """Two significant digits, never fewer trials than that.

    >>> _upwards(383_000.0)
    390000
    """
    size = int(10 ** max(len(f"{trials:.0f}") - 2, 0))
    return math.ceil(trials / size) * size


def _without_drawing(once: Sequence[tuple[Curve, Shortfall]]) -> list[str]:
    enough = [curve for curve, found in once if found.reaches == "yes"]
    if not enough:
        return []
    verbs = ("is", "needs") if len(enough) == 1 else ("are", "need")
    return [f"{_names(enough)} {verbs[0]} near enough, and {verbs[1]} no draws at all."]


def _never(study: Study, curve: Curve, found: Need) -> str:
    off = found.floor * study.tolerance(found.forecast)
    units = next((f" {f.units}" for f in study.model.forecasts if f.name == found.forecast and f.units), "")
    return (
        f"{curve.method.name} never comes to it: the {spelt(found.statistic)} of {found.forecast} stays off by about "
        f"{rounded(off)}{units}, {rounded(found.floor)} times what was asked for, however many trials it runs."
    )


def _unknown(curve: Curve, found: Need) -> str:
    if curve.method.errors != "floor":
        return (
            f"These runs cannot tell what {curve.method.name} needs: too few of them gave a number for the "
            f"{spelt(found.statistic)} of {found.forecast}. Longer runs would."
        )
    return (
        f"These runs cannot tell whether {curve.method.name} comes to it: more trials do not remove all of its error, "
        f"and whether what is left in the {spelt(found.statistic)} of {found.forecast} is small enough takes more and "
        "longer runs to see."
    )


def _undecided(study: Study, curve: Curve, found: Shortfall) -> str:
    units = next((f" {f.units}" for f in study.model.forecasts if f.name == found.forecast and f.units), "")
    return (
        f"This reference cannot tell whether {curve.method.name} is near enough: it is off by "
        f"{rounded(abs(found.error))} ± {rounded(found.own)}{units} in the {spelt(found.statistic)} of "
        f"{found.forecast}, where {rounded(study.tolerance(found.forecast))}{units} was asked for. More "
        "--reference-trials would."
    )


def _bounds(study: Study) -> list[str]:
    curves = [curve for curve in study.once if curve.ranges]
    widths = []
    for curve in curves:
        ratios = [
            (most - least) / (answer.high - answer.low)
            for name, (least, most) in curve.ranges.items()
            if name in study.varying and (answer := study.reference.answers[name]).high > answer.low
        ]
        if ratios:
            low, high = f"{min(ratios):.1f}", f"{max(ratios):.1f}"
            widths.append(f"{curve.method.name} {low}" + (f" to {high}" if high != low else ""))
    if not widths:
        return []
    return [
        "Bounds answer another question, what is possible and not what is likely. Their widths, in central ranges: "
        f"{'; '.join(widths)}."
    ]
