"""Bounds by corners: every combination of lowest and highest values."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import Answer, Errors, MethodResult
from xlmc.analysis.studies.methods.points import Evaluation, assumptions_of, box_of
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, counted_text

__all__ = ["Corners"]

_MOST_CORNERS: Final = 1 << 16
_MOST_NUMBERS: Final = 1 << 22
"""Assumptions times corners: very many assumptions have fewer corners looked at."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Corners:
    """The paper's "upper and lower bound" method, over the assumptions that the forecasts depend on.

    Up to 16 of them, all 2^k corners; of more, as many random ones, and the run says so.
    """

    key: str = "corners"
    name: str = "Bounds, corners"
    errors: Errors = "once"
    cannot: str = (
        "gives two ends and no likelihood in between, does not see filters, and misses extremes inside the box"
    )

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`; the budget is not looked at."""
        started = time.perf_counter()
        box, evaluate = box_of(model, seed), Evaluation(model)
        reaching = assumptions_of(model, [forecast.cell for forecast in model.forecasts])
        corners, remarks = _corners(len(reaching), seed)
        points = np.tile((box.low + box.high) / 2.0, (len(corners), 1))
        points[:, reaching] = np.where(corners, box.high[reaching], box.low[reaching])
        values = evaluate(points).forecasts
        answers = {f.name: _bounds(column) for f, column in zip(model.forecasts, values.T, strict=True)}
        lost = int(np.count_nonzero(np.isnan(values).any(axis=1)))
        if lost:
            remarks = (*remarks, f"left out: {counted_text(lost, 'corner')} in which a forecast is not a number")
        return MethodResult(time.perf_counter() - started, evaluate.count, answers, remarks=(*remarks, *box.remarks))


def _corners(k: int, seed: int) -> tuple[NDArray[np.bool_], tuple[str, ...]]:
    """Which end each assumption is at, (corners, k), and what to say of it."""
    if 1 << k <= _MOST_CORNERS:
        numbers = np.arange(1 << k)
        plural = "s" * (k != 1)
        remark = f"all 2^{k} = {count_text(1 << k)} corners of the {k} assumption{plural} that the forecasts depend on"
        return (numbers[:, None] >> np.arange(k)) & 1 == 1, (remark,)
    count = min(_MOST_CORNERS, _MOST_NUMBERS // k)
    remark = f"{count_text(count)} random corners of 2^{k}: the true bounds may be wider"
    return np.random.default_rng(seed).random((count, k)) < 0.5, (remark,)


def _bounds(column: Floats) -> Answer:
    known = column[~np.isnan(column)]
    return Answer(least=float(known.min()), most=float(known.max())) if known.size else Answer()
