"""CONVERT: a measurement in another unit of the same kind.

The constants are those of Excel 2010 and later. Most are exact by definition (an inch is 25.4 mm); the electron volt
and the atomic mass unit are those of CODATA 2006.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.arguments import align_ranges, first_error
from xlmc.excel.functions.registry import excel
from xlmc.excel.functions.toolpak import OneCell, strict_numbers
from xlmc.excel.functions.values import NA, Floats, Value

__all__ = ["unit_named"]


@dataclass(frozen=True, slots=True)
class _Unit:
    """A unit: a measurement `x` in it is `(x·prefix - zero)·scale` in the base unit of its group.

    Attributes:
        group: what it measures, such as "length".
        scale: see above.
        zero: the reading of a thermometer in this unit at 0 °C; 0 for other units.
        prefix: the factor of the prefix, 1 without one.
        absolute: it measures temperatures from absolute zero.
    """

    group: str
    scale: float
    zero: float = 0.0
    prefix: float = 1.0
    absolute: bool = False


_IN, _FT, _YD, _MI, _NMI = 0.0254, 0.3048, 0.9144, 1609.344, 1852.0
_LIGHT_YEAR, _PICA = 9460730472580800.0, 0.0254 / 72
_LBM, _LBF = 453.59237, 4.4482216152605
_HORSEPOWER, _GALLON, _US_FOOT = 550 * _FT * _LBF, 231 * _IN**3, 1200 / 3937

_SCALES: Final[dict[str, dict[str, float]]] = {
    "mass": {  # grams
        "g": 1.0, "sg": _LBF / _FT * 1000, "lbm": _LBM, "u": 1.660538782e-24, "ozm": _LBM / 16, "grain": _LBM / 7000,
        "cwt shweight": _LBM * 100, "uk_cwt lcwt hweight": _LBM * 112, "stone": _LBM * 14, "ton": _LBM * 2000,
        "uk_ton LTON brton": _LBM * 2240,
    },
    "length": {  # metres
        "m": 1.0, "mi": _MI, "Nmi": _NMI, "in": _IN, "ft": _FT, "yd": _YD, "ang": 1e-10, "ell": 45 * _IN,
        "ly": _LIGHT_YEAR, "parsec pc": 30856775812815500.0, "Picapt Pica": _PICA, "pica": _IN / 6,
        "survey_mi": 5280 * _US_FOOT,
    },
    "time": {"yr": 31557600.0, "day d": 86400.0, "hr": 3600.0, "mn min": 60.0, "sec s": 1.0},
    "pressure": {
        "Pa p": 1.0, "atm at": 101325.0, "mmHg": 133.322, "psi": _LBF / _IN**2, "Torr": 101325 / 760,
    },
    "force": {"N": 1.0, "dyn dy": 1e-5, "lbf": _LBF, "pond": 0.00980665},
    "energy": {
        "J": 1.0, "e": 1e-7, "c": 4.184, "cal": 4.1868, "eV ev": 1.602176487e-19, "HPh hh": _HORSEPOWER * 3600,
        "Wh wh": 3600.0, "flb": _FT * _LBF, "BTU btu": 1055.05585262,
    },
    "power": {"HP h": _HORSEPOWER, "W w": 1.0, "PS": 735.49875},
    "magnetism": {"T": 1.0, "ga": 1e-4},
    "volume": {  # cubic metres
        "tsp": _GALLON / 768, "tspm": 5e-6, "tbs": _GALLON / 256, "oz": _GALLON / 128, "cup": _GALLON / 16,
        "pt us_pt": _GALLON / 8, "uk_pt": 0.00056826125, "qt": _GALLON / 4, "uk_qt": 0.0011365225, "gal": _GALLON,
        "uk_gal": 0.00454609, "l L lt": 0.001, "ang3 ang^3": 1e-30, "barrel": _GALLON * 42,
        "bushel": 0.03523907016688, "ft3 ft^3": _FT**3, "in3 in^3": _IN**3, "ly3 ly^3": _LIGHT_YEAR**3,
        "m3 m^3": 1.0, "mi3 mi^3": _MI**3, "yd3 yd^3": _YD**3, "Nmi3 Nmi^3": _NMI**3,
        "Picapt3 Picapt^3 Pica3 Pica^3": _PICA**3, "GRT regton": 100 * _FT**3, "MTON": 40 * _FT**3,
    },
    "area": {  # square metres
        "uk_acre": 4840 * _YD**2, "us_acre": 43560 * _US_FOOT**2, "ang2 ang^2": 1e-20, "ar": 100.0,
        "ft2 ft^2": _FT**2, "ha": 10000.0, "in2 in^2": _IN**2, "ly2 ly^2": _LIGHT_YEAR**2, "m2 m^2": 1.0,
        "Morgen": 2500.0, "mi2 mi^2": _MI**2, "Nmi2 Nmi^2": _NMI**2, "Picapt2 Picapt^2 Pica2 Pica^2": _PICA**2,
        "yd2 yd^2": _YD**2,
    },
    "information": {"bit": 1.0, "byte": 8.0},
    "speed": {  # metres per second
        "admkn": 6080 * _FT / 3600, "kn": _NMI / 3600, "m/h m/hr": 1 / 3600, "m/s m/sec": 1.0, "mph": _MI / 3600,
    },
}  # fmt: skip
"""A key holds all names of a unit."""

_TEMPERATURES: Final = {  # degrees Celsius
    "C": _Unit("temperature", 1.0), "cel": _Unit("temperature", 1.0), "F": _Unit("temperature", 5 / 9, 32.0),
    "fah": _Unit("temperature", 5 / 9, 32.0), "K": _Unit("temperature", 1.0, 273.15, absolute=True),
    "kel": _Unit("temperature", 1.0, 273.15, absolute=True),
    "Rank": _Unit("temperature", 5 / 9, 491.67, absolute=True),
    "Reau": _Unit("temperature", 1.25),
}  # fmt: skip

_UNITS: Final = _TEMPERATURES | {
    name: _Unit(group, scale) for group, units in _SCALES.items() for names, scale in units.items()
    for name in names.split()
}  # fmt: skip

_METRIC: Final = """
g u m ang ly parsec pc sec s Pa p atm at mmHg N dyn dy pond J e c cal eV ev Wh wh W w T ga K kel l L lt ar bit byte
m/h m/hr m/s m/sec ang2 ang^2 m2 m^2 ang3 ang^3 m3 m^3
"""
_TAKE_PREFIXES: Final = frozenset(_METRIC.split())

_POWERS: Final = {"2": 2, "3": 3}
"""The power of the prefix in units of area and volume: km2 is the square of a kilometre."""

_PREFIXES: Final = {
    "Y": 1e24, "Z": 1e21, "E": 1e18, "P": 1e15, "T": 1e12, "G": 1e9, "M": 1e6, "k": 1e3, "h": 1e2, "da": 1e1,
    "e": 1e1, "d": 1e-1, "c": 1e-2, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12, "f": 1e-15, "a": 1e-18, "z": 1e-21,
    "y": 1e-24,
}  # fmt: skip
_BINARY_PREFIXES: Final = {f"{letter}i": 2.0 ** (10 * i) for i, letter in enumerate("kMGTPEZY", start=1)}


@lru_cache(maxsize=1024)
def unit_named(name: str) -> _Unit | None:
    """Return the unit of a name, with or without a prefix, case-sensitive; None if there is none."""
    if name in _UNITS:
        return _UNITS[name]
    return next(_with_prefix(name), None)


def _with_prefix(name: str) -> Iterator[_Unit]:
    for length in (1, 2):
        prefix, rest = name[:length], name[length:]
        if rest not in _TAKE_PREFIXES:
            continue
        if prefix in _PREFIXES:
            yield replace(_UNITS[rest], prefix=_PREFIXES[prefix] ** _POWERS.get(rest[-1], 1))
        elif prefix in _BINARY_PREFIXES and _UNITS[rest].group == "information":
            yield replace(_UNITS[rest], prefix=_BINARY_PREFIXES[prefix])


_UNKNOWN = _Unit("", 1.0)


def _units(value: Value) -> NDArray[Any]:
    """Return the unit that each text names, `_UNKNOWN` if it names none."""
    names, _ = value.to_texts()
    units = np.empty(names.shape, object)
    for index in np.ndindex(*names.shape):
        units[index] = unit_named(str(names[index])) or _UNKNOWN
    return units


def _part(units: NDArray[Any], attribute: str) -> Floats:
    return np.array([getattr(unit, attribute) for unit in units.ravel()], np.float64).reshape(units.shape)


def _groups(units: NDArray[Any]) -> NDArray[Any]:
    return np.array([unit.group for unit in units.ravel()], object).reshape(units.shape)


@excel("CONVERT", OneCell, OneCell, OneCell)
def convert(number: Value, source: Value, target: Value) -> Value:
    """Convert a measurement to another unit; `#N/A` for units that are unknown or measure different things."""
    number, source, target = align_ranges(number, source, target)
    x, errors = strict_numbers(number)
    old, new = _units(source), _units(target)
    proportional = _part(old, "absolute") * _part(new, "absolute") > 0  # zeros would cost digits
    from_zero, to_zero = (np.where(proportional, 0.0, _part(part, "zero")) for part in (old, new))
    base = (x * _part(old, "prefix") - from_zero) * _part(old, "scale")
    result = (base / _part(new, "scale") + to_zero) / _part(new, "prefix")
    groups = _groups(old)
    values = np.where((groups == _groups(new)) & (groups != ""), result, NA)
    return Value.of_numbers(values, first_error(errors, source.errors, target.errors))
