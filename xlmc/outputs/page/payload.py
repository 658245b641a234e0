"""What the page's charts are drawn and counted from, as JSON inside the page.

`forecasts`: for each its trials (a `RankTable`; `counts` null where all are 1, `gaps` null where all are 0), its own
central range, its bins as the sheet Bins has them, the values to be marked, and the distributions that describe it best
(`FittedCurve`); `second`, the trials of the same forecast in a second run, or null. `overlays`: the numbers of
forecasts in one unit. `z`: the quantile of the normal distribution that 95 % intervals are made with.

A page has room for a limited number of trials. Of a forecast with no more than `most` trials every one is there, and
every count is exact. Of one with more, the trials of `most` ranks at equal distances are there, each with how many
trials lie between it and the next: a count is then exact where an end is one of the values given, and elsewhere its
error at each end is less than the trials of one such gap.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.columns import picked, release
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import number_text, percent, signs
from xlmc.montecarlo.statistics.estimate import t_quantile
from xlmc.outputs.histogram import Figure
from xlmc.outputs.page.fitted_curves import FittedCurve, fitted_curves
from xlmc.outputs.page.second_run import partner_of
from xlmc.outputs.summary import base_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.forms import Form
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "ALL_VALUES",
    "MOST_VALUES",
    "RankTable",
    "axis_of",
    "forecast_payload",
    "form_json",
    "most_values",
    "overlays_of",
    "payload",
    "payload_text",
    "rank_table",
]

CONFIDENCE = 0.95

ALL_VALUES = 50_000
"""Values on a page, of all its forecasts together: some 1.2 MB."""

MOST_VALUES, _FEWEST = 20_000, 200
"""Values of one forecast."""

MOST_FITTED = 20
"""Forecasts, the first ones, that distributions are fitted to: each takes some hundredths of a second."""

Floats = NDArray[np.float64]

Counts = NDArray[np.int64]


def payload_text(simulation: RunResult, figures: Sequence[Figure], beside: RunResult | None = None) -> str:
    """Return the payload as JSON without any character that could end its HTML element."""
    text = json.dumps(payload(simulation, figures, beside), allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def payload(simulation: RunResult, figures: Sequence[Figure], beside: RunResult | None = None) -> dict[str, Any]:
    """Return the payload as plain values; `beside` is a second run. Answers that are shares have no values to count."""
    figures = counted_figures(figures)
    most = most_values(len(figures) * (1 if beside is None else 2))
    return {
        "z": t_quantile(math.inf, CONFIDENCE),
        "signs": signs_json(),
        "forecasts": [
            {
                **forecast_payload(simulation, each, most, fits=number < MOST_FITTED),
                "second": _second(each, beside, most),
            }
            for number, each in enumerate(figures)
        ],
        "overlays": overlays_of(figures),
    }


def counted_figures(figures: Sequence[Figure]) -> list[Figure]:
    """Return the figures whose answers are numbers, so that trials between two limits can be counted."""
    return [figure for figure in figures if not figure.answer.is_share]


def overlays_of(figures: Sequence[Figure]) -> list[list[int]]:
    """Return the indices of the figures of each overlay: two or more in one unit, all dates, say, or all amounts."""
    by_units: dict[tuple[object, ...], list[int]] = {}
    for index, figure in enumerate(figures):
        by_units.setdefault(axis_of(figure), []).append(index)
    return [group for group in by_units.values() if len(group) > 1]


def axis_of(figure: Figure) -> tuple[object, ...]:
    """Return what figures have in common whose answers fit one axis: units, and how their numbers are written."""
    return figure.answer.units, *figure.answer.form.axis


def forecast_payload(simulation: RunResult, figure: Figure, most: int, *, fits: bool = True) -> dict[str, Any]:
    """Return the data that one forecast's chart is drawn and counted from.

    Args:
        simulation: the finished run.
        figure: of the forecast.
        most: how many of its values at most.
        fits: with fitted distributions, which take some hundredths of a second.
    """
    answer = figure.answer
    result = simulation.results[answer.name]
    low, high = answer.low.value, answer.high.value
    marks = [low, high] if answer.threshold is None else [low, high, answer.threshold]
    return {
        "name": answer.name,
        "units": answer.units,
        "form": form_json(answer.form),
        **_trials(result, most, marks),
        "range": {
            "share": answer.share,
            "said": percent(answer.share),
            "low": low,
            "high": high,
            "lowText": answer.form.value(answer.low),
            "highText": answer.form.value(answer.high),
        },
        "bins": _bins(figure),
        "fits": [_fit(each) for each in fitted_curves(result.sample.even, figure.bins)] if fits else [],
        "marks": [{"label": label, "value": value, "text": text} for label, value, text in _marks(figure)],
    }


def _trials(result: ForecastResult, most: int, marks: Iterable[float] = ()) -> dict[str, Any]:
    table = rank_table(result.sample.even, most, marks)
    return {
        "trials": int(result.sample.even.size),
        "values": table.values.tolist(),
        "counts": _unless_all(1, table.counts),
        "gaps": _unless_all(0, table.gaps),
    }


def _second(figure: Figure, beside: RunResult | None, most: int) -> dict[str, Any] | None:
    """Return the trials of the same forecast in the second run; None if there is none."""
    partner = None if beside is None else partner_of(figure.answer, beside)
    if beside is None or partner is None:
        return None
    return _trials(beside.results[partner.name], most, [figure.answer.low.value, figure.answer.high.value])


def _fit(curve: FittedCurve) -> dict[str, Any]:
    return {
        "name": curve.name,
        "parameters": curve.parameters,
        "distance": f"{number_text(100 * curve.distance, 2)} %",
        "parts": curve.parts,
        "shares": curve.shares.tolist(),
    }


def _unless_all(usual: int, numbers: NDArray[np.int64]) -> list[int] | None:
    return None if bool(np.all(numbers == usual)) else numbers.tolist()


def signs_json() -> dict[str, str]:
    """Return the signs of thousands and decimals, which the script writes and reads numbers with."""
    return dict(zip(("thousands", "decimal"), signs(), strict=True))


def form_json(form: Form) -> dict[str, Any]:
    """How the script writes numbers of a forecast."""
    before, after = form.affixes
    moment = {"moment": form.shows, "order": form.order} if form.kind is Kind.DATE else {"moment": None}
    return {"factor": form.factor, "before": before, "after": after, **moment, "epoch": form.epoch}


def _bins(figure: Figure) -> dict[str, Any]:
    bins = figure.bins
    to_number = 0.0 if bins.names is None else 0.5  # the script draws bars of whole numbers over these itself
    return {
        "edges": [edge + to_number for edge in (*bins.edges.tolist(), float(bins.upper_edges[-1]))],
        "counts": (bins.inside + bins.outside).tolist(),
        "below": bins.below,
        "above": bins.above,
        "width": bins.width,
        "decimals": bins.decimals,
    }


def _marks(figure: Figure) -> Iterator[tuple[str, float, str]]:
    answer = figure.answer
    yield "Mean", answer.mean.value, answer.form.value(answer.mean)
    if answer.base is not None:
        yield "Base case", answer.base, base_text(answer)
    if answer.threshold is not None:
        yield "Threshold", answer.threshold, answer.form.number(answer.threshold)


@dataclass(frozen=True, slots=True)
class RankTable:
    """Trials by value.

    Attributes:
        values: `(k,)` ascending, all different.
        counts: `(k,)` trials at each.
        gaps: `(k - 1,)` trials between each and the next.
    """

    values: Floats
    counts: Counts
    gaps: Counts

    @property
    def exact(self) -> bool:
        """Whether every trial is at one of the values."""
        return not self.gaps.any()


def most_values(forecasts: int) -> int:
    """How many values of each forecast a page of so many has room for."""
    return min(max(ALL_VALUES // max(forecasts, 1), _FEWEST), MOST_VALUES)


def rank_table(x: Floats, most: int, marks: Iterable[float] = ()) -> RankTable:
    """Return the rank table of ascending `(n,)` trials.

    Args:
        x: in memory or on disk; none of them NaN.
        most: values to give, 2 or more.
        marks: further values at which counts must be exact; those that are not finite are left out.
    """
    ranks = np.arange(x.size) if x.size <= most else np.rint(np.linspace(0, x.size - 1, most)).astype(np.intp)
    finite: list[float] = [mark for mark in marks if np.isfinite(mark)]
    values = np.unique(np.concatenate([picked(x, ranks), finite]))
    while True:
        below, upto = np.searchsorted(x, values, side="left"), np.searchsorted(x, values, side="right")
        gaps = below[1:] - upto[:-1]
        wide = np.flatnonzero(gaps)[: max(most - values.size, 0)]
        if not wide.size:
            break
        # Ranks of whole numbers fall on the same values: there is room for those between.
        values = np.union1d(values, picked(x, upto[wide] + gaps[wide] // 2))
    release(x)
    return RankTable(values, upto - below, gaps)
