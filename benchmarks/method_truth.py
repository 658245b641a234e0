"""Is what `xlmc methods` says of a workbook true? Eight books whose forecast has a known distribution.

`python benchmarks/method_advice.py --truth` runs the quick test on each book of `known_books.py`, and writes
`results/method-truth.json` and the table of docs/methods.md. It takes less than ten minutes on an idle core; the
seconds in it depend on the machine.

The true need of independent trials comes from the distribution itself: of mean and standard deviation from its moments,
of percentiles from the beta distribution of order statistics. That of every other method is looked for: 200 runs of one
length, then of half or twice as many trials, until 95 of 100 keep the tolerance in every number with one length and not
with the other; down to 128, the shortest runs of a study, and up to a million, from where errors are carried on as
1/√n. Weighted trials and surrogates that are said to need more than a million are left out.

The bars:

- the number of trials that is stated of the recommended method is within a factor of two of the true need (those of the
  others, which come from eight short runs of each length, are compared, too, and what differs by more is printed);
- the recommended method costs at most one and a half times what the cheapest one costs, or a tenth of a second more.
  Costs are seconds of a run of the true need, the fastest of several that take turns; another engine's are those of
  getting ready, too. Methods that draw nothing are not among them: they cannot tell how far off they are.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from known_books import KNOWN, KnownBook
from scipy.optimize import brentq
from scipy.special import betainc, ndtri
from tables import placed

from xlmc.analysis.studies.methods import Curve, Method, Study, quick_settings, study
from xlmc.analysis.studies.methods.need import ENGINE_READY, NO_TIME, Need, choice
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

__all__ = [
    "PAGE",
    "RESULTS",
    "Truth",
    "compare_with_truth",
    "misses",
    "misstated",
    "need_of_percentile",
    "table",
    "true_need",
    "truth_of",
]

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "methods.md"
RESULTS = HERE / "results" / "method-truth.json"

RUNS, MOST_RUN = 200, 1_000_000
KEPT, FACTOR, DEARER = 0.95, 2.0, 1.5
TURNS = 15
SHARES: Final = (np.arange(1 << 22) + 0.5) / (1 << 22)
NORMAL_95: Final = float(ndtri((1.0 + KEPT) / 2.0))

Record = dict[str, Any]


class Truth(NamedTuple):
    """Of a known forecast, whose accepted values have a closed distribution.

    Attributes:
        numbers: mean, standard deviation, and both ends of the central range.
        tolerance: 1 % of the 5–95 % range.
        trials: that independent ones need, with those that the filter rejects.
    """

    numbers: tuple[float, float, float, float]
    tolerance: float
    trials: float


def truth_of(book: KnownBook, share: float = 0.51) -> Truth:
    """The numbers of a known forecast, and what Monte Carlo needs for them."""
    y = book.quantile(SHARES)
    mean, deviation = float(y.mean()), float(y.std())
    tails = (1.0 - share) / 2.0, (1.0 + share) / 2.0
    low, high, five, ninety_five = (float(q) for q in np.quantile(y, [*tails, 0.05, 0.95]))
    tolerance = 0.01 * (ninety_five - five)
    kurtosis = float(np.mean((y - mean) ** 4)) / deviation**4
    moments = [(NORMAL_95 * deviation * each / tolerance) ** 2 for each in (1.0, (kurtosis - 1.0) ** 0.5 / 2.0)]
    percentiles = [
        need_of_percentile(p, *(float(np.searchsorted(y, q + side * tolerance)) / y.size for side in (-1.0, 1.0)))
        for p, q in zip(tails, (low, high), strict=True)
    ]
    return Truth((mean, deviation, low, high), tolerance, max(*moments, *percentiles) / book.accepted)


def need_of_percentile(p: float, below: float, above: float) -> float:
    """Independent trials whose p-percentile lies between two others in 95 of 100 runs, by the law of order statistics.

    >>> round(need_of_percentile(0.5, 0.49, 0.51), -2)
    9600.0
    """

    def missing(log_trials: float) -> float:
        n = math.exp(log_trials)
        rank = p * (n - 1.0) + 1.0
        return float(betainc(rank, n - rank + 1.0, above) - betainc(rank, n - rank + 1.0, below)) - KEPT

    return math.exp(brentq(missing, math.log(8.0), math.log(1e12)))


def kept_share(model: CompiledModel, method: Method, trials: float, truth: Truth) -> float:
    """The share of 200 runs within the tolerance, in the number in which it is least."""
    kept = np.zeros(len(truth.numbers))
    for seed in range(RUNS):
        answer = method.run(model, round(trials), 10_000 + seed).answers["y"]
        off = np.abs(np.subtract((answer.mean, answer.sd, answer.low, answer.high), truth.numbers))
        kept += off <= truth.tolerance
    return float(kept.min()) / RUNS


def true_need(model: CompiledModel, method: Method, stated: float, fewest: int, truth: Truth) -> float:
    """The trials that 95 of 100 runs keep the tolerance with, between two lengths of which one does and one does not.

    The shares kept are read as those of normal errors, whose scale falls between the lengths as a power of them.
    """
    trials = min(stated, MOST_RUN)
    share = kept_share(model, method, trials, truth)
    step = 0.5 if share >= KEPT else 2.0
    while True:
        if step > 1.0 and trials * step > MOST_RUN:
            return trials * (NORMAL_95 / _normal(share)) ** 2
        if trials * step < fewest:
            return max(trials, fewest)
        other = kept_share(model, method, trials * step, truth)
        if (other >= KEPT) != (share >= KEPT):
            break
        trials, share = trials * step, other
    here, there = math.log(_normal(share)), math.log(_normal(other))
    return trials * step ** ((math.log(NORMAL_95) - here) / (there - here))


def _normal(share: float) -> float:
    """How many standard deviations either way hold such a share of the runs, of which none or all need not be so."""
    return float(ndtri((1.0 + min(max(share, 0.5 / RUNS), 1.0 - 0.5 / RUNS)) / 2.0))


def measure(book: KnownBook, folder: Path) -> Record:
    """What is stated of a book, what is true, and what either costs."""
    model, truth = load(book.write(folder)), truth_of(book)
    result = study(model, seed=1, **quick_settings({}))
    best = choice(result)
    usable = [each for each in (*result.curves, *result.engines) if _is_judged(each, best.needs[each])]
    needs: dict[str, Record] = {}
    for curve in usable:
        stated = best.needs[curve].trials
        exact = curve.method.errors == "independent"
        true = truth.trials if exact else true_need(model, curve.method, stated, result.ladder[0], truth)
        needs[curve.method.key] = {"stated": round(stated), "true": round(true), "ratio": round(stated / true, 3)}
    for curve, seconds in zip(usable, true_seconds(result, usable, needs), strict=True):
        needs[curve.method.key]["seconds"] = float(f"{seconds:.3g}")
    return {"recommended": best.chosen and best.chosen.method.key, "needs": needs}


def _is_judged(curve: Curve, stated: Need) -> bool:
    """Whether a method can be recommended, and its true need be found in the time there is."""
    quick = curve.method.errors in ("independent", "consistent") or stated.trials <= MOST_RUN
    return stated.usable and curve.lengths[-1].measured and quick


def true_seconds(result: Study, curves: Sequence[Curve], needs: dict[str, Record]) -> list[float]:
    """Seconds of a run of the true need; beyond a million trials at the rate of a million."""
    fastest = [math.inf] * len(curves)
    for turn in range(TURNS):
        for place, curve in enumerate(curves):
            true = needs[curve.method.key]["true"]
            run = min(true, MOST_RUN)
            seconds = curve.method.run(result.model, run, 20_000 + turn).seconds
            fastest[place] = min(fastest[place], seconds * true / run)
    return [each + ENGINE_READY * (curve in result.engines) for each, curve in zip(fastest, curves, strict=True)]


def misses(records: dict[str, Record]) -> list[str]:
    """Where a bar is missed."""
    message = []
    for book, result in records.items():
        needs, recommended = result["needs"], result["recommended"]
        if recommended is None:
            message.append(f"{book}: nothing is recommended")
            continue
        message += _beyond(book, {recommended: needs[recommended]})
        least = min(needs, key=lambda key: needs[key]["seconds"])
        cost, cheapest = needs[recommended]["seconds"], needs[least]["seconds"]
        if cost > max(DEARER * cheapest, cheapest + NO_TIME):
            message.append(f"{book}: {recommended} is recommended, {cost:.2g} s, where {least} takes {cheapest:.2g} s")
    return message


def misstated(records: dict[str, Record]) -> list[str]:
    """Needs of methods that are not recommended and that are stated wrong by more than a factor of two: no miss."""
    return [
        message
        for book, result in records.items()
        for message in _beyond(
            book, {key: each for key, each in result["needs"].items() if key != result["recommended"]}
        )
    ]


def _beyond(book: str, needs: dict[str, Record]) -> list[str]:
    return [
        f"{book}: {key} is said to need {each['stated']:,} trials, and needs {each['true']:,}"
        for key, each in needs.items()
        if not 1.0 / FACTOR <= each["ratio"] <= FACTOR
    ]


def table(records: dict[str, Record]) -> str:
    """One row a book: its forecast, and of every method that was judged the stated and the true need."""
    keys = list(dict.fromkeys(key for results in records.values() for key in results["needs"] if "/" not in key))
    rows = [
        f"| Forecast | Recommended | Its cost over the least | {' | '.join(f'{key}: stated, true' for key in keys)} |",
        f"| --- | --- | ---: |{' ---: |' * len(keys)}",
    ]
    formulas = {book.name: book.words for book in KNOWN}
    for name, result in records.items():
        needs, recommended = result["needs"], result["recommended"]
        cost = needs[recommended]["seconds"] / min(each["seconds"] for each in needs.values())
        more = needs[recommended]["seconds"] - min(each["seconds"] for each in needs.values())
        shown = f"{cost:.2f}" if cost <= DEARER else f"{cost:.1f}, {1_000 * more:.0f} ms more"
        cells = [f"{needs[key]['stated']:,}, {needs[key]['true']:,}" if key in needs else "–" for key in keys]
        rows.append(f"| {formulas[name]} | {recommended} | {shown} | {' | '.join(cells)} |")
    return "\n".join(rows)


def compare_with_truth(folder: Path, books: Sequence[KnownBook] = KNOWN) -> list[str]:
    """Measure every book, write the result, and give what misses the bars."""
    records: dict[str, Record] = {}
    for book in books:
        records[book.name] = measure(book, folder)
        print(book.name, json.dumps(records[book.name]), flush=True)
        RESULTS.write_text(json.dumps(records, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    PAGE.write_text(placed(PAGE.read_text(encoding="utf-8"), "truth", table(records)), encoding="utf-8")
    print("\n".join(f"of a method that is not recommended: {message}" for message in misstated(records)))
    return misses(records)
