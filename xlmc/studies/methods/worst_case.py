"""The differential method, worst case: f ± Σ|∂f/∂x|·Δx, every assumption at its worst end at once."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from xlmc.run.model import Model
from xlmc.studies.methods.answer import Answer, Errors, MethodResult
from xlmc.studies.methods.expansion import expansion_of
from xlmc.studies.methods.points import box_of

__all__ = ["WorstCase"]


@dataclass(frozen=True, slots=True)
class WorstCase:
    """Bounds of the forecasts made straight. Δx reaches from the mean to either end, which may differ."""

    key: str = "worst-case"
    name: str = "Differential, worst case"
    errors: Errors = "once"
    cannot: str = (
        "gives two ends and no likelihood in between, does not see filters, and takes every curve for straight"
    )

    def run(self, model: Model, budget: int, seed: int) -> MethodResult:
        """See `Method`; it evaluates one point, with its first derivatives."""
        started = time.perf_counter()
        expansion, box = expansion_of(model, seed, 1), box_of(model, seed)
        answers = {}
        for name, found in expansion.forecasts.items():
            to_low, to_high = (found.gradient[0] * (end - expansion.moments.mean) for end in (box.low, box.high))
            value = float(found.value[0])
            down, up = np.minimum(to_low, to_high).sum(), np.maximum(to_low, to_high).sum()
            answers[name] = Answer(least=value + float(down), most=value + float(up))
        return MethodResult(time.perf_counter() - started, 1, answers, remarks=(*expansion.remarks, *box.remarks))
