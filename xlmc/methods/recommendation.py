"""Which method to use, in words, for the accuracy that was asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from xlmc.methods.answer import STATISTICS
from xlmc.methods.curve import Curve
from xlmc.methods.need import Need, Shortfall, need, shortfall
from xlmc.methods.sampled import MONTE_CARLO, Sampled
from xlmc.methods.study import Study

__all__ = ["ERROR_WORDS", "recommendation", "rounded", "seconds_text", "trials_text"]

_NO_MATTER: Final = 2.0
"""A method that is faster by less is not worth being another one."""

_SOON: Final = 5.0
"""Seconds that nobody minds waiting for."""

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
    drawing = {curve: need(study, curve) for curve in (*study.curves, *study.engines)}
    able = {curve: found for curve, found in drawing.items() if np.isfinite(found.seconds)}
    said = [_asked(study), *_heavy(study)]
    once = [(curve, shortfall(study, curve)) for curve in study.once if curve.answers]
    said += _without_drawing(once)
    if able:
        said += _drawing(study, able)
    else:
        said.append("No method that draws comes to this accuracy: ask for less, or in the forecasts' units.")
    said += [_unable(curve, found) for curve, found in drawing.items() if curve not in able]
    said += [_missed(study, curve, found) for curve, found in once if found.times > 1.0]
    said += _bounds(study)
    return [*said, ERROR_WORDS]


def _asked(study: Study) -> str:
    text, _, relative = study.accuracy
    what = f"{text} of each number" if relative else f"{text} in each forecast's units"
    return (
        f"Asked for: mean, standard deviation and both ends of the central range of every forecast to {what}, in 95 of "
        "100 runs."
    )


def _heavy(study: Study) -> list[str]:
    """What no method comes near to."""
    return [
        f"The {' and '.join(map(_spelt, lost))} of {name} {'do' if len(lost) > 1 else 'does'} not converge, for its "
        f"tail is too heavy, and no method brings {'them' if len(lost) > 1 else 'it'} nearer. Left out in what "
        "follows; report percentiles."
        for name, lost in study.reference.heavy.items()
        if name in study.varying
    ]


def _without_drawing(once: Sequence[tuple[Curve, Shortfall]]) -> list[str]:
    enough = [curve for curve, found in once if found.times <= 1.0]
    if not enough:
        return []
    names = " and ".join(curve.method.name for curve in enough)
    verbs = ("is", "needs") if len(enough) == 1 else ("are", "need")
    return [f"{names} {verbs[0]} near enough, and {verbs[1]} no draws at all."]


def _drawing(study: Study, able: dict[Curve, Need]) -> list[str]:
    fastest = min(able, key=lambda curve: able[curve].seconds)
    plain = next((curve for curve in able if curve.method is MONTE_CARLO), fastest)
    worth = able[plain].seconds > _SOON and able[plain].seconds > _NO_MATTER * able[fastest].seconds
    chosen = fastest if worth else plain
    found = able[chosen]
    said = [
        f"Recommended: {chosen.method.name}, about {trials_text(found.trials)} trials, "
        f"{seconds_text(found.seconds)}; the {_spelt(found.statistic)} of {found.forecast} needs the most."
    ]
    if chosen is plain and fastest is not plain:
        said[0] += (
            f" {fastest.method.name} would take {seconds_text(able[fastest].seconds)}, which saves too little to give "
            "up independent trials and errors that are known without replicates."
            if not _same_trials(study, fastest)
            else f" With {fastest.method.name.rpartition(', ')[2]} the same trials take "
            f"{seconds_text(able[fastest].seconds)}."
        )
    if found.beyond > _FAR:
        said[0] += (
            f" That is {found.beyond:,.0f} times as many trials as the longest measured runs had, and so a guess: let "
            "--precision end the run."
        )
    others = sorted((curve for curve in able if curve is not chosen), key=lambda curve: able[curve].seconds)
    said[0] += f" {_command(study, chosen, found)}"
    if others:
        rest = "; ".join(
            f"{curve.method.name} {trials_text(able[curve].trials)} trials, {seconds_text(able[curve].seconds)}"
            for curve in others
        )
        said.append(f"The others would need: {rest}.")
    return said


def _command(study: Study, curve: Curve, found: Need) -> str:
    method = curve.method
    if not isinstance(method, Sampled):
        call = f"xlmc.methods.{type(method).__name__}().run(model, {found.trials:.0f}, seed=1)"
        return f"It runs from Python: `{call}`."
    text = study.accuracy[0].replace(" ", "")
    options = [
        f"--{name} {chosen}"
        for name, chosen, usual in (
            ("sampling", method.method, MONTE_CARLO.method),
            ("engine", method.engine, MONTE_CARLO.engine),
            ("arithmetic", method.arithmetic, MONTE_CARLO.arithmetic),
        )
        if chosen != usual
    ]
    command = " ".join(["xlmc simulate", study.model.workbook.name, *options, f"--precision {text}"])
    command += f" --precision-of {'range' if study.reference.heavy else 'mean,sd,range'}"
    return f"`{command}` goes on until the run's own errors say that it is reached."


def _same_trials(study: Study, curve: Curve) -> bool:
    return curve in study.engines


def _unable(curve: Curve, found: Need) -> str:
    return (
        f"{curve.method.name} does not come to it however many trials it runs: the "
        f"{_spelt(found.statistic)} of {found.forecast} stays off."
    )


def _missed(study: Study, curve: Curve, found: Shortfall) -> str:
    if not np.isfinite(found.times):
        return f"{curve.method.name} has no number for {found.forecast}."
    truth = float(getattr(study.reference.answers[found.forecast], found.statistic))
    units = next((f.units for f in study.model.forecasts if f.name == found.forecast), "")
    share = f", {rounded(100.0 * found.error / abs(truth))} % of it" if truth else ""
    text = (
        f"{curve.method.name} misses the {_spelt(found.statistic)} of {found.forecast} by "
        f"{rounded(found.error)}{' ' if units else ''}{units}{share}"
    )
    kept = study.reference.acceptance.value
    if study.model.filters and kept < 1.0:
        return f"{text}: it does not see that the filters reject {_percent(1.0 - kept)} of the trials."
    return f"{text}: {_LEFT_OUT.get(curve.method.key, 'what it leaves out of the formulas')}."


_LEFT_OUT: Final = {
    "taylor-1": "it takes every curve for straight and every answer for normally distributed",
    "taylor-2": "over these ranges the formulas are more than quadratic polynomials",
}


def _bounds(study: Study) -> list[str]:
    curves = [curve for curve in study.once if curve.ranges]
    if not curves:
        return []
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


def _spelt(statistic: str) -> str:
    """As it stands in a sentence: `lower end`, `SD`."""
    name = STATISTICS[statistic]
    return name if name.isupper() else name.lower()


def _percent(share: float) -> str:
    return f"{100.0 * share:.3g} %"


def rounded(value: float) -> str:
    """Two significant digits."""
    return f"{float(f'{value:.2g}'):g}" if 0.001 <= abs(value) < 1e4 or value == 0.0 else f"{value:.1e}"


def trials_text(trials: float) -> str:
    """`1,200,000`: two significant digits.

    >>> trials_text(1_234_567.0)
    '1,200,000'
    """
    if not np.isfinite(trials):
        return "infinitely many"
    size = 10 ** max(len(f"{trials:.0f}") - 2, 0)
    return f"{round(trials / size) * size:,}"


def seconds_text(seconds: float) -> str:
    """`0.35 s`, `12 s`, `4 min`, `3 h`; a dash where no run came to an end.

    >>> seconds_text(0.0123), seconds_text(250.0), seconds_text(9_000.0)
    ('0.012 s', '4.2 min', '2.5 h')
    """
    if not np.isfinite(seconds):
        return "–"
    for length, name, top in ((1.0, "s", 120.0), (60.0, "min", 7_200.0), (3_600.0, "h", 172_800.0)):
        if seconds < top:
            return f"{float(f'{seconds / length:.2g}'):g} {name}"
    return f"{float(f'{seconds / 86_400.0:.2g}'):,g} days"
