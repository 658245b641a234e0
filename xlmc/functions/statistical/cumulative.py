"""Distribution functions come in two forms, chosen in every trial by an argument of theirs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from xlmc.functions.values import Bools, Floats

__all__ = ["by_form"]


def by_form(cumulative: Bools, probability: Callable[[], Any], density: Callable[[], Any]) -> Floats:
    """The probability up to a point where `cumulative`, else the density at it; neither is computed for nothing."""
    below = probability() if np.any(cumulative) else 0.0
    at = 0.0 if np.all(cumulative) else density()
    return np.where(cumulative, below, at)
