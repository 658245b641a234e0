"""What a saved run says beside its columns, as JSON holds it, and back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np

from xlmc.blocks import FilterTally
from xlmc.definitions.model import Settings
from xlmc.definitions.stopping import MOST_TRIALS, Precision, Stopping
from xlmc.rare.account import RareAccount
from xlmc.rounding import Rounding
from xlmc.sampling import METHODS, Plan
from xlmc.simulation import Origin
from xlmc.statistics import Estimate
from xlmc.stopping import Stopped

__all__ = [
    "FORMAT",
    "VERSION",
    "origin_of",
    "plan_of",
    "rare_of",
    "rounding_of",
    "settings_of",
    "stopped_of",
    "tally_document",
    "tally_of",
    "told",
]

FORMAT: Final = "xlmc saved run"
VERSION: Final = 1

Document = Mapping[str, Any]

_ENDS: Final = frozenset({"trials", "accepted", "precision", "adaptive", "time", "interruption", "search"})


def settings_of(found: Document) -> Settings:
    """The settings again.

    Raises:
        KeyError, TypeError, ValueError, SimulationError: they are none.
    """
    stopping = dict(found["stopping"])
    precision = stopping["precision"]
    if precision is not None:
        stopping["precision"] = Precision(**{**precision, "numbers": tuple(precision["numbers"])})
    stopping["forecasts"] = tuple(stopping["forecasts"])
    settings = Settings(**{**found, "stopping": Stopping(**stopping)})
    told(type(settings.trials) is int and 1 <= settings.trials <= MOST_TRIALS, "its number of trials")
    told(type(settings.seed) is int and settings.seed >= 0, "its seed")
    told(settings.sampling in METHODS, "its sampling")
    return settings


def plan_of(settings: Settings, order: list[str]) -> Plan:
    """The plan again: a function of the settings, but for the order of the dimensions."""
    return replace(Plan.of(settings.sampling, settings.trials), order=tuple(map(str, order)))


def tally_document(tally: FilterTally) -> dict[str, Any]:
    """The counts of the filters as lists."""
    return {
        "rejected": tally.rejected.tolist(),
        "only": tally.only.tolist(),
        "together": tally.together.tolist(),
        "errors": [dict(sorted(errors.items())) for errors in tally.errors],
        "by_error": tally.by_error,
    }


def tally_of(found: Document, filters: int) -> FilterTally:
    """The counts of so many filters again.

    Raises:
        KeyError, TypeError, ValueError: they are none.
    """
    tally = FilterTally(
        rejected=np.array(found["rejected"], np.int64),
        only=np.array(found["only"], np.int64),
        together=np.array(found["together"], np.int64).reshape(filters, filters),
        errors=[Counter(errors) for errors in found["errors"]],
        by_error=int(found["by_error"]),
    )
    told(tally.rejected.shape == tally.only.shape == (filters,) and len(tally.errors) == filters, "its filters")
    return tally


def stopped_of(found: Document) -> Stopped:
    """What ended the run."""
    told(isinstance(found, dict) and found.get("by") in _ENDS, "its end")
    words = (found.get("because"), found.get("goal") or "")
    told(all(isinstance(each, str) for each in words), "its end")
    return Stopped(**found)


def rounding_of(found: Document | None) -> Rounding | None:
    """What float32 changed."""
    return None if found is None else Rounding(**found)


def rare_of(found: Document | None) -> RareAccount | None:
    """Where the accepted trials come from, if they are rare."""
    if found is None:
        return None
    acceptance = dict(found["acceptance"])
    ends = acceptance["interval"]
    acceptance["interval"] = None if ends is None else tuple(ends)
    return RareAccount(**{**found, "acceptance": Estimate(**acceptance)})


def told(kept: bool, what: str) -> None:
    """Refuse what cannot be.

    Raises:
        ValueError: it cannot be.
    """
    if not kept:
        raise ValueError(what)


def origin_of(found: Document) -> Origin:
    """Where the run was made."""
    return Origin(dict(found["software"]), dict(found["processor"]))
