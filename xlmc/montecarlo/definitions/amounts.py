"""Widths, shares, durations and whole numbers as people type them: in Python, in options, in `xlmc_settings`."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from decimal import Decimal
from typing import Final

from xlmc.errors import SimulationError

__all__ = ["as_confidence", "as_numbers", "as_seconds", "as_tolerance", "typed_whole_number"]

_TIME = re.compile(r"(?:(\d+(?:\.\d+)?)\s*h)?\s*(?:(\d+(?:\.\d+)?)\s*m(?:in)?)?\s*(?:(\d+(?:\.\d+)?)\s*s?)?")
_PERCENTILE = re.compile(r"p(\d+(?:\.\d+)?)")

_GROUPED: Final = re.compile(
    r"([+-]?)([1-9][0-9]{0,2}([,_' \u2019\u00a0\u202f])[0-9]{3}(?:\3[0-9]{3}){0,9}|[0-9]{1,100})"
)

_SCALED: Final = re.compile(r"([+-]?[0-9]{1,18}(?:\.[0-9]{1,18})?)(?:e\+?([0-9]{1,2})| ?(k|m))", re.IGNORECASE)

_UNITS: Final = {"k": 3, "m": 6}


def as_tolerance(given: str | float) -> tuple[float, bool]:
    """Read a half width, and whether it is a share of the number itself: `1%` is, `0.1` is not.

    Raises:
        SimulationError: it is neither.

    >>> as_tolerance("1 %"), as_tolerance(0.1)
    ((0.01, True), (0.1, False))
    """
    text = str(given).strip()
    relative = text.endswith("%")
    value = _number(text.removesuffix("%"))
    if value is None or not 0.0 < value < math.inf:
        message = f"{text!r} is not a precision"
        raise SimulationError(message, hint="Give a percentage such as 1%, or a number in the forecast's units")
    return (value / 100.0 if relative else value), relative


def as_numbers(given: str | Sequence[str]) -> tuple[str, ...]:
    """Names of statistics, separated by commas: `mean`, `sd`, `range`, `p75.5`.

    Raises:
        SimulationError: one of them is none of these.

    >>> as_numbers("Mean, p75.5")
    ('mean', 'p75.5')
    """
    parts = given.split(",") if isinstance(given, str) else given
    names = tuple(dict.fromkeys(part.strip().casefold() for part in parts))
    for name in names:
        match = _PERCENTILE.fullmatch(name)
        if name not in ("mean", "sd", "range") and not (match and 0.0 < float(match[1]) < 100.0):
            hint = "Choose from mean, sd, range, and percentiles above 0 and below 100 such as p75.5"
            raise SimulationError(f"{name!r} is not a number whose precision can be asked for", hint=hint)
    if not names:
        raise SimulationError("no number was named whose precision counts", hint="Name one, such as mean")
    return names


def as_confidence(given: str | float) -> float:
    """Read a share from a percentage: `95%`, `95` or 0.95.

    Raises:
        SimulationError: it is not between 0 and 100 %.

    >>> as_confidence("95%"), as_confidence(0.99)
    (0.95, 0.99)
    """
    text = str(given).strip()
    value = _number(text.removesuffix("%"))
    if value is not None and (text.endswith("%") or value >= 1.0):
        value /= 100.0
    if value is None or not 0.0 < value < 1.0:
        raise SimulationError(f"{text!r} is not a confidence level", hint="Give a percentage such as 95")
    return value


def as_seconds(given: str | float) -> float:
    """Read a duration: `60s`, `5m`, `1h30m`, or a number of seconds.

    Raises:
        SimulationError: it is none.

    >>> as_seconds("1h30m"), as_seconds("90"), as_seconds(0.5)
    (5400.0, 90.0, 0.5)
    """
    text = str(given).strip().casefold()
    match = _TIME.fullmatch(text)
    parts = match.groups("0") if match else ()
    value = sum(float(part) * unit for part, unit in zip(parts, (3600.0, 60.0, 1.0), strict=False))
    if not 0.0 < value < math.inf:
        hint = "Give seconds, or a duration such as 60s, 5m or 1h30m"
        raise SimulationError(f"{text!r} is not a length of time", hint=hint)
    return value


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def typed_whole_number(text: str) -> int | None:
    """Read a number; None if the text holds none, or could mean two (`200.000`).

    >>> [typed_whole_number(text) for text in ("200000", "200,000", "2e5", "1.5e6", "200k", "1.5M", "200.000", "2,5")]
    [200000, 200000, 200000, 1500000, 200000, 1500000, None, None]
    """
    text = text.strip()
    grouped = _GROUPED.fullmatch(text)
    if grouped is not None:
        return int(grouped[1] + re.sub("[^0-9]", "", grouped[2]))
    scaled = _SCALED.fullmatch(text)
    if scaled is None:
        return None
    number, exponent, unit = scaled.groups()
    result = Decimal(number).scaleb(int(exponent) if exponent else _UNITS[unit.casefold()])
    return int(result) if result == result.to_integral_value() else None
