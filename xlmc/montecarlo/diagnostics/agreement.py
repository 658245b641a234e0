"""Whether items of evidence agree with the model and with each other, and what each of them moves.

An item is judged by where its reading, with its own error, lies in the distribution of the model's quantity given all
other items: by the chance that a reading as far out, or farther, would have been made. How few trials it keeps is no
measure: a sharp reading keeps few and may agree perfectly. Letters: p that chance, on both sides; w the weight of a
trial, the product of the chances that the items keep it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo import statistics
from xlmc.montecarlo.definitions.evidence import Bell
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.diagnostics.evidence_trials import EvidenceTrials, evidence_trials
from xlmc.montecarlo.model.plain_words import list_of
from xlmc.montecarlo.number_text import count_text, fixed_text, number_text, styled_text
from xlmc.montecarlo.statistics import Estimate, Sample

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.evidence import Evidence, Law
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = [
    "INCONSISTENT",
    "STRAINED",
    "Agreement",
    "Answer",
    "ItemAgreement",
    "Pressed",
    "Verdict",
    "agreement",
]

STRAINED: Final = 0.01
INCONSISTENT: Final = 0.001
"""Chances, on both sides, below which a reading is strained, and inconsistent."""

PRESSED: Final = 0.25
"""The share of the weight in the outer twentieth of a range above which the range decides, not the evidence."""

_FEWEST: Final = 100.0
"""Effective trials below which nothing is said."""

_TELLING: Final = 10.0
"""Effective trials that should lie beyond a threshold, if its estimate alone is to decide."""

_BEYOND: Final = 2_000.0
"""Effective trials from which on a reading beyond all of them contradicts them."""

_HARDLY: Final = 1e-9
"""A trial with less than this share of the largest weight is not among those that the evidence keeps."""

_FAR: Final = 3.0
"""Standard deviations from the nearest trial beyond which a reading with a normal error lies beyond all of them."""

_APART: Final = 0.02
"""A ratio of shares nearer to 1 than that says nothing, however many trials there are."""

_Z95: Final = 1.959964

Floats = NDArray[np.float64]


class Verdict(Enum):
    """What is said of an item, and of all; the worst of the items is that of all."""

    CORROBORATES = "corroborates"
    INDEPENDENT = "independent"
    PULLS_APART = "pulls apart"
    TOO_FEW = "too few trials"
    STRAINED = "strained"
    INCONSISTENT = "inconsistent"


@dataclass(frozen=True, slots=True)
class ItemAgreement:
    """One item of evidence.

    Attributes:
        evidence: the row.
        alone: the share of the trials past the filters that it keeps.
        given_others: of those that all other items keep; nan where these keep none.
        ratio: of the two; nan where it cannot be formed.
        chance: p, that a reading so far out, or farther, is made, given the other items; nan where these keep none.
        effective: how many trials the other items leave, in effect.
        best_z: standard deviations between reading and model in the trial that agrees best with all items; None if
            the error is no bell, or no trial agrees.
        mean_z: the mean of them over the trials that all items keep; None likewise.
    """

    evidence: Evidence
    alone: Estimate
    given_others: Estimate
    ratio: Estimate
    chance: float
    effective: float
    best_z: float | None
    mean_z: float | None
    verdict: Verdict

    @property
    def name(self) -> str:
        return self.evidence.name

    @property
    def chance_text(self) -> str:
        """`37 %`; `below 0.22 %` where hardly a trial lies so far out, so that trials cannot tell; empty if unknown."""
        if math.isnan(self.chance):
            return ""
        if self.chance * self.effective / 2.0 >= 1.0:
            return (
                f"{styled_text(100.0 * self.chance, '.0f')} %"
                if self.chance >= 0.1
                else f"{number_text(100.0 * self.chance, 2)} %"
            )
        return f"below {number_text(200.0 * _interval(self.chance / 2.0, self.effective)[1], 2)} %"


@dataclass(frozen=True, slots=True)
class Pressed:
    """An assumption whose draws, given all evidence, pile up at a limit of its range.

    Attributes:
        end: `lower` or `upper`.
        share: of them in the outer twentieth there.
    """

    assumption: str
    end: str
    share: float

    @property
    def sentence(self) -> str:
        """The finding in words, without a full stop."""
        return (
            f"given the evidence, {styled_text(self.share, '.0%')} of {self.assumption!r} lies in the "
            f"{self.end} twentieth of its "
            "range: the range, not the evidence, decides there"
        )


@dataclass(frozen=True, slots=True)
class Answer:
    """A forecast with some of the evidence.

    Attributes:
        used: which items, in words: all of them, all but one, one alone, or none.
        items: their names.
        effective: how many trials carry as much as those that were weighted.
        low, high: the ends of the central range; nan where there are too few trials for them.
    """

    forecast: str
    units: str
    used: str
    items: tuple[str, ...]
    effective: float
    mean: Estimate
    standard_deviation: Estimate
    low: Estimate
    high: Estimate


@dataclass(frozen=True, eq=False)
class Agreement:
    """All items of a run.

    Attributes:
        items: in the order of the workbook.
        trials: drawn; `past` of them pass all filters but evidence.
        together: the share of these that all items keep.
        ratio: that share by the product of what each keeps alone; nan where it cannot be formed.
        effective: how many trials the items leave, in effect.
        best_z: the distance of all readings with a bell in the trial that agrees best; otherwise None.
    """

    model: CompiledModel
    items: tuple[ItemAgreement, ...]
    trials: int
    past: int
    together: Estimate
    ratio: Estimate
    effective: float
    best_z: float | None
    pressed: tuple[Pressed, ...]
    evidence_trials: EvidenceTrials

    @property
    def verdict(self) -> Verdict:
        """The worst of the items; where none is bad, what the ratio says of all of them together."""
        order = list(Verdict)
        worst = max((each.verdict for each in self.items), key=order.index)
        if order.index(worst) >= order.index(Verdict.TOO_FEW):
            return worst
        return _by_ratio(self.ratio) if len(self.items) > 1 else Verdict.INDEPENDENT

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        return _sentence(self)

    @property
    def conflicts(self) -> bool:
        """Whether the answers must not be used as they are."""
        return self.verdict is Verdict.INCONSISTENT

    @property
    def remarks(self) -> list[str]:
        """What else a person should hear: strain, the best trial far away, inputs at the ends of their ranges."""
        result = [self.sentence] if self.verdict in (Verdict.STRAINED, Verdict.TOO_FEW, Verdict.PULLS_APART) else []
        if self.best_z is not None and self.best_z > 2.0 and not self.conflicts:
            result.append(
                f"even the trial that agrees best with the evidence is {number_text(self.best_z, 2)} "
                "standard deviations off"
            )
        far = [
            f"{each.name!r} ({styled_text(each.mean_z, '+.2g')})"
            for each in self.items
            if each.mean_z is not None and abs(each.mean_z) > 2.0
        ]
        if far:
            result.append(
                f"the trials that are kept are more than two standard deviations from {list_of(far)} on average"
            )
        result += [each.sentence for each in self.pressed]
        return result

    @cached_property
    def answers(self) -> tuple[Answer, ...]:
        """Each forecast without evidence, with all, without each item, and with each alone."""
        trials, names = self.evidence_trials, [each.name for each in self.items]
        every = range(len(names))
        sets: dict[str, list[int]] = {"no evidence": [], "all evidence": list(every)}
        if len(names) > 2:
            sets |= {f"all but {name}": [i for i in every if i != left] for left, name in enumerate(names)}
        if len(names) > 1:
            without = [f", without {names[1 - i]}" if len(names) == 2 else "" for i in range(len(names))]
            sets |= {f"{name} alone{without[index]}": [index] for index, name in enumerate(names)}
        weights = {used: _weights(trials.log_weights[rows]) for used, rows in sets.items()}
        units = {each.name: (each.units, each.central) for each in self.model.forecasts}
        return tuple(
            _answer(name, *units[name], (used, tuple(names[i] for i in sets[used])), values, weights[used])
            for name, values in trials.forecasts.items()
            for used in sets
        )


def agreement(model: CompiledModel, seed: int, trials: int) -> Agreement | None:
    """Judge the evidence of a workbook; None if none is used.

    Args:
        model: the workbook.
        seed: of the run.
        trials: that the run evaluated.
    """
    items = [each.evidence for each in model.filters if each.evidence is not None]
    if not items:
        return None
    result = evidence_trials(model, seed, trials)
    logs = result.log_weights
    every = _weights(logs)
    best = int(np.argmax(logs.sum(axis=0))) if result.n and every.any() else None
    judged = tuple(_judge(index, each, result, best, every) for index, each in enumerate(items))
    bells = [each.best_z for each in judged if each.best_z is not None]
    ends = [(name, end, share) for name, both in result.at_ends.items() for end, share in zip(_ENDS, both, strict=True)]
    enough = _effective(every) >= _FEWEST
    return Agreement(
        model=model,
        items=judged,
        trials=result.trials,
        past=result.n,
        together=_mean(np.exp(logs.sum(axis=0))),
        ratio=_joint_ratio(np.exp(logs)),
        effective=_effective(every),
        best_z=math.hypot(*bells) if bells else None,
        pressed=tuple(Pressed(*each) for each in ends if enough and each[2] > PRESSED),
        evidence_trials=result,
    )


_ENDS: Final = ("lower", "upper")


def _judge(index: int, item: Evidence, trials: EvidenceTrials, best: int | None, every: Floats) -> ItemAgreement:
    logs, m = trials.log_weights, trials.quantities[index]
    others = _weights(np.delete(logs, index, axis=0)) if len(logs) > 1 else np.ones(trials.n)
    others = np.where(np.isnan(m), 0.0, others)  # where the quantity is an error nothing can be read
    chances, law = np.exp(logs[index]), item.law
    alone, given = _mean(chances), _mean(chances, others)
    ratio = _ratio(chances, others)
    effective = _effective(others)
    tail = _tail(law, m, others, given)
    certain = _effective(every) >= _FEWEST and _beyond_all(law, m[every > _HARDLY])
    verdict = _verdict(law, m[others > 0.0], tail, effective, certain=certain)
    if verdict is Verdict.INDEPENDENT and len(logs) > 1:
        verdict = _by_ratio(ratio)
    z = law.z(m) if isinstance(law, Bell) else None
    some = every > 0.0
    mean_z = None if z is None or best is None else float(np.sum(z[some] * every[some]) / every.sum())
    return ItemAgreement(
        evidence=item,
        alone=alone,
        given_others=given,
        ratio=ratio,
        chance=2.0 * tail if 2.0 * tail < 1.0 or math.isnan(tail) else 1.0,
        effective=effective,
        best_z=None if z is None or best is None else abs(float(z[best])),
        mean_z=mean_z,
        verdict=verdict,
    )


def _weights(logs: Floats) -> Floats:
    """`(n,)` the weights of `(k, n)` logarithms, as shares of the largest; 0 where no trial is kept."""
    total = logs.sum(axis=0)
    largest = total.max(initial=-np.inf)
    return np.exp(total - largest) if largest > -np.inf else np.zeros(total.size)


def _effective(weights: Floats) -> float:
    """(Σw)²/Σw²."""
    squares = float(np.sum(weights * weights))
    return float(np.sum(weights)) ** 2 / squares if squares else 0.0


def _mean(values: Floats, weights: Floats | None = None) -> Estimate:
    """Return the weighted mean of shares `(n,)`, its standard error, never 0, and interval; nan where nothing has a
    weight.
    """
    weights = np.ones(values.size) if weights is None else weights
    total = float(weights.sum())
    if not total:
        return Estimate(math.nan, n=values.size)
    value = min(1.0, float(np.sum(weights * values)) / total)
    low, high = _interval(value, _effective(weights))
    error = float(np.sqrt(np.sum((weights * (values - value)) ** 2))) / total
    return Estimate(value, error or (high - low) / (2.0 * _Z95), (low, high), n=values.size)


def _ratio(chances: Floats, others: Floats) -> Estimate:
    """Divide what an item keeps given the others by what it keeps alone."""
    alone, given = _mean(chances), _mean(chances, others)
    if not (alone.value > 0.0 and given.value >= 0.0):
        return Estimate(math.nan, n=chances.size)
    if not given.value:
        return Estimate(0.0, None, n=chances.size)
    pulls = (
        others * (chances - given.value) / (others.sum() * given.value) - (chances / alone.value - 1.0) / chances.size
    )
    value = given.value / alone.value
    return _with_error(value, value * float(np.sqrt(np.sum(pulls * pulls))), chances.size)


def _joint_ratio(chances: Floats) -> Estimate:
    """Divide what all items keep together by the product of what each keeps alone; `(k, n)`."""
    k, n = chances.shape
    alone, together = chances.mean(axis=1) if n else np.zeros(k), chances.prod(axis=0)
    if not alone.all():
        return Estimate(math.nan, n=n)
    joint = float(together.mean())
    value = joint / float(alone.prod())
    if not joint:
        return Estimate(0.0, None, n=n)
    pulls = together / joint - (chances / alone[:, None]).sum(axis=0) + (k - 1.0)
    return _with_error(value, value * float(np.sqrt(np.sum(pulls * pulls))) / n, n)


def _with_error(ratio: float, error: float, n: int) -> Estimate:
    return Estimate(ratio, error, (max(0.0, ratio - _Z95 * error), ratio + _Z95 * error), n)


def _tail(law: Law, m: Floats, others: Floats, given: Estimate) -> float:
    """Return the chance of a reading as far out as this one, on its nearer side; of one-sided evidence, half of what it
    keeps.

    Nan where the other items keep no trial.
    """
    weights = others[others > 0.0]
    if not weights.size:
        return math.nan
    if law.one_sided:
        return given.value
    reached = law.reached(m[others > 0.0])
    below = float(np.sum(weights * reached) / weights.sum())
    above = float(np.sum(weights * (1.0 - reached)) / weights.sum())
    return min(below, above)


def _verdict(law: Law, m: Floats, tail: float, effective: float, *, certain: bool) -> Verdict:
    """Return the verdict by the chance of such a reading; `INDEPENDENT` where the reading is no surprise.

    Args:
        law: of the reading's error.
        m: the quantity in the trials that the other items keep.
        tail: as `_tail` gives it.
        effective: how many trials these are, in effect.
        certain: whether the reading lies beyond all trials that all items keep, although these are many in effect.
    """
    if math.isnan(tail) or effective < _FEWEST:
        return Verdict.TOO_FEW
    low, high = (min(1.0, 2.0 * end) for end in _interval(tail, effective))
    p = min(1.0, 2.0 * tail)
    if effective >= _BEYOND and _beyond_all(law, m):
        return Verdict.INCONSISTENT
    if p < INCONSISTENT and (certain or high < INCONSISTENT or effective * INCONSISTENT / 2.0 >= _TELLING):
        return Verdict.INCONSISTENT
    telling = effective * STRAINED / 2.0 >= _TELLING
    if p < STRAINED:
        return Verdict.STRAINED if telling or high < STRAINED else Verdict.TOO_FEW
    return Verdict.INDEPENDENT if telling or low >= STRAINED else Verdict.TOO_FEW


def _interval(share: float, n: float) -> tuple[float, float]:
    """Wilson's, which holds for the mean of any numbers from 0 to 1."""
    middle, rest = share + _Z95**2 / (2.0 * n), 1.0 + _Z95**2 / n
    half = _Z95 * math.sqrt(max(0.0, share * (1.0 - share)) / n + _Z95**2 / (4.0 * n * n))
    return max(0.0, (middle - half) / rest), min(1.0, (middle + half) / rest)


def _beyond_all(law: Law, m: Floats) -> bool:
    """Whether the reading lies on one side of all trials, by more than its tolerance."""
    if isinstance(law, Bell):
        z = law.z(m)
        return bool(z.min() > _FAR or z.max() < -_FAR)
    low, high = law.low, law.high
    return bool((low is not None and m.max() < low) or (high is not None and m.min() > high))


def _by_ratio(ratio: Estimate) -> Verdict:
    """Say what a ratio of shares means, beyond its error."""
    apart, error = ratio.value - 1.0, ratio.error or 0.0
    if math.isnan(apart):
        return Verdict.TOO_FEW
    if abs(apart) <= max(2.0 * error, _APART):
        return Verdict.INDEPENDENT
    return Verdict.CORROBORATES if apart > 0.0 else Verdict.PULLS_APART


def _answer(
    name: str, units: str, central: float, used: tuple[str, tuple[str, ...]], values: Floats, weights: Floats
) -> Answer:
    known = ~np.isnan(values)
    sample = Sample.of(values[known], weights[known])
    enough = sample.n > 1 and sample.effective * (1.0 - central) / 2.0 >= _TELLING
    nothing = Estimate(math.nan)
    low, high = statistics.central_interval(sample, central) if enough else (nothing, nothing)
    some = sample.n > 1 and sample.effective > 2.0
    return Answer(
        name,
        units,
        *used,
        sample.effective,
        statistics.mean(sample) if some else nothing,
        statistics.standard_deviation(sample) if some else nothing,
        low,
        high,
    )


def _sentence(result: Agreement) -> str:
    """Return the verdict in one sentence, without a full stop; reasons after it where there is a conflict."""
    by = {verdict: [repr(each.name) for each in result.items if each.verdict is verdict] for verdict in Verdict}
    match result.verdict:
        case Verdict.INCONSISTENT:
            return _conflict(result, by[Verdict.INCONSISTENT])
        case Verdict.STRAINED:
            others = "the model and the other evidence" if len(result.items) > 1 else "the model"
            strained = [each for each in result.items if each.verdict is Verdict.STRAINED]
            least = min(strained, key=lambda each: each.chance)
            return (
                f"{list_of(by[Verdict.STRAINED])} {_are(by[Verdict.STRAINED])} strained: given {others}, a reading so "
                f"far out has a chance {'' if least.chance_text.startswith('below') else 'of '}{least.chance_text}"
            )
        case Verdict.TOO_FEW:
            return (
                f"too few trials to tell whether the evidence agrees: {count_text(result.past)} of "
                f"{count_text(result.trials)} pass the "
                f"filters, and the evidence leaves {fixed_text(result.effective, 0)} in effect"
            )
        case Verdict.CORROBORATES:
            return f"the items corroborate each other: {_together(result)}"
        case Verdict.PULLS_APART:
            return f"the items pull apart, but within their errors: {_together(result)}"
    if len(result.items) == 1:
        return f"{result.items[0].name!r} agrees with the model; there is no other item to compare it with"
    return "the items agree with the model and neither corroborate nor contradict each other"


def _together(result: Agreement) -> str:
    return f"together they keep {number_text(result.ratio.value, 3)} times as many trials as independent items would"


def _conflict(result: Agreement, names: Sequence[str]) -> str:
    shown = [each for each in result.items if each.verdict is Verdict.INCONSISTENT]
    message = f"the evidence is inconsistent: {list_of(names)} {_are(names)} out of reach of the model"
    if len(result.items) > 1:
        message += " given the other evidence"
        if not result.together.value:
            shown = list(result.items)
            every = list_of([repr(each.name) for each in shown])
            message = f"the evidence is inconsistent: no trial agrees with {every} together"
    alone = list_of([f"{number_text(each.alone.value * 100.0, 2)} %" for each in shown])
    they = "it keeps" if len(shown) == 1 else "they keep"
    misfits = vocabulary_of(result.model.workbook).misfits
    return (
        f"{message}. Alone {they} {alone} of the trials that pass the filters. Either a measurement is wrong by more "
        f"than its stated error, or a range of an assumption is too narrow, or the model does not apply{misfits}"
    )


def _are(names: Sequence[str]) -> str:
    return "is" if len(names) == 1 else "are"
