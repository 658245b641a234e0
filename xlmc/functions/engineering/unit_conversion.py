"""CONVERT: a measurement in another unit of the same kind."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.arguments import earliest, leveled
from xlmc.functions.engineering.units import Unit, unit_named
from xlmc.functions.registry import excel
from xlmc.functions.toolpak import OneCell, strict_numbers
from xlmc.functions.values import NA, Floats, Value

__all__: list[str] = []

_UNKNOWN = Unit("", 1.0)


def _units(value: Value) -> NDArray[Any]:
    """The unit that each text names, `_UNKNOWN` where it names none."""
    names, _ = value.to_texts()
    units = np.empty(names.shape, object)
    for place in np.ndindex(*names.shape):
        units[place] = unit_named(str(names[place])) or _UNKNOWN
    return units


def _part(units: NDArray[Any], attribute: str) -> Floats:
    return np.array([getattr(unit, attribute) for unit in units.ravel()], np.float64).reshape(units.shape)


def _groups(units: NDArray[Any]) -> NDArray[Any]:
    return np.array([unit.group for unit in units.ravel()], object).reshape(units.shape)


@excel("CONVERT", OneCell, OneCell, OneCell)
def convert(number: Value, source: Value, target: Value) -> Value:
    """A measurement in another unit; `#N/A` for units that are unknown or measure different things."""
    number, source, target = leveled(number, source, target)
    x, errors = strict_numbers(number)
    old, new = _units(source), _units(target)
    proportional = _part(old, "absolute") * _part(new, "absolute") > 0  # else a tiny one would lose its digits
    from_zero, to_zero = (np.where(proportional, 0.0, _part(part, "zero")) for part in (old, new))
    base = (x * _part(old, "prefix") - from_zero) * _part(old, "scale")
    result = (base / _part(new, "scale") + to_zero) / _part(new, "prefix")
    groups = _groups(old)
    found = np.where((groups == _groups(new)) & (groups != ""), result, NA)
    return Value.of_numbers(found, earliest(errors, source.errors, target.errors))
