"""Which method to use for an accuracy, and which are cheapest by the clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

from xlmc.studies.methods.curve import Curve
from xlmc.studies.methods.need import Need, need
from xlmc.studies.methods.sampled import MONTE_CARLO
from xlmc.studies.methods.study import Study

__all__ = ["NO_TIME", "TIE", "Choice", "choice"]

TIE: Final = 1.2
"""Methods whose seconds are within this factor of the least are a tie: clocks and fits tell no more."""

NO_TIME: Final = 0.1
"""Seconds that nobody saves."""

_NO_MATTER: Final = 2.0
"""A method that is faster by less is not worth being another one."""

_SOON: Final = 5.0
"""Seconds that nobody minds waiting for."""


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Methods that draw, for one accuracy.

    Attributes:
        chosen: what to use; None where no method comes to the accuracy, as for a tolerance of zero.
        needs: what each method needs.
        cheapest: the method of the least seconds, and those that tie with it, the least first.
    """

    chosen: Curve | None
    needs: Mapping[Curve, Need]
    cheapest: tuple[Curve, ...]


def choice(study: Study, accuracy: tuple[str, float, bool] | None = None) -> Choice:
    """Choose for the accuracy of a study, or for another one.

    Monte Carlo, whose trials are independent and whose errors come out of the run itself, unless that takes more than
    five seconds and another method takes less than half.
    """
    asked = study if accuracy is None else replace(study, accuracy=accuracy)
    needs = {curve: need(asked, curve) for curve in (*study.curves, *study.engines)}
    usable = sorted((curve for curve, found in needs.items() if found.usable), key=lambda curve: needs[curve].seconds)
    if not usable:
        return Choice(None, needs, ())
    least = needs[usable[0]].seconds
    cheapest = tuple(c for c in usable if needs[c].seconds <= max(TIE * least, least + NO_TIME))
    plain = next((curve for curve in usable if curve.method.key == MONTE_CARLO.key), usable[0])
    slow = needs[plain].seconds > _SOON and needs[plain].seconds > _NO_MATTER * least
    return Choice(usable[0] if slow else plain, needs, cheapest)
