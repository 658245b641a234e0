"""An answer that is a speed, in mph or km/h."""

from __future__ import annotations

from templates.description import Equation, Role
from templates.units import MPH

__all__ = ["speed_answer"]


def speed_answer(symbol: str, notation: str, name: str, quantity: str, note: str = "") -> Equation:
    """The speed `quantity`, in ft/s or m/s, as an answer; the unit ends its symbol and its notation.

    So that no equation prints a speed as itself times a conversion.
    """
    return Equation(
        f"{symbol}_[mph|kmh]",
        f"{notation} ([mph|km/h])",
        name,
        "[mph|km/h]",
        f"{quantity}*{MPH}",
        "conversion",
        note,
        Role.ANSWER,
        "0.00",
    )
