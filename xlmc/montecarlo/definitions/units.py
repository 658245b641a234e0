"""Units of one kind, and how many of one make another."""

from __future__ import annotations

from typing import Final

__all__ = ["factor_between"]

_FT: Final = 0.3048
_MI: Final = 1609.344
_LB: Final = 0.45359237
_G: Final = 9.80665
_DEG: Final = 0.017453292519943295

_SCALES: Final = {
    "speed": {"m/s": 1.0, "km/h": 1 / 3.6, "kph": 1 / 3.6, "mph": _MI / 3600, "mi/h": _MI / 3600, "ft/s": _FT,
              "fps": _FT, "ft/sec": _FT, "kn": 1852 / 3600},
    "length": {"m": 1.0, "mm": 0.001, "cm": 0.01, "km": 1000.0, "in": _FT / 12, "ft": _FT, "yd": 3 * _FT, "mi": _MI},
    "angle": {"rad": 1.0, "deg": _DEG, "°": _DEG},
    "yaw rate": {"rad/s": 1.0, "deg/s": _DEG, "°/s": _DEG, "rpm": 6 * _DEG},
    "time": {"s": 1.0, "sec": 1.0, "ms": 0.001, "min": 60.0, "h": 3600.0},
    "mass": {"kg": 1.0, "lb": _LB},
    "acceleration": {"m/s²": 1.0, "m/s^2": 1.0, "m/s2": 1.0, "ft/s²": _FT, "ft/s^2": _FT, "ft/s2": _FT, "g": _G,
                     "g's": _G},
    "force": {"n": 1.0, "lbf": _LB * _G},
    "energy": {"j": 1.0, "kj": 1000.0, "ft·lb": _FT * _LB * _G, "ft-lb": _FT * _LB * _G, "ft*lb": _FT * _LB * _G},
    "inertia": {"kg·m²": 1.0, "lb·ft·s²": _FT * _LB * _G},
}  # fmt: skip
"""Kind -> unit -> how many of the SI unit it is. `lb` of an energy is a pound-force; `g` is the acceleration."""

_UNITS: Final = {name: (kind, scale) for kind, scales in _SCALES.items() for name, scale in scales.items()}


def factor_between(source: str, target: str) -> float | None:
    """How many of the target unit one of the source unit is; None where they are no units of one kind, as known here.

    Units that read the same are the same, known or not.

    >>> round(factor_between("km/h", "mph"), 6)
    0.621371
    >>> factor_between("mph", "deg") is None
    True
    """
    mine, theirs = _plain(source), _plain(target)
    if mine == theirs:
        return 1.0
    if mine not in _UNITS or theirs not in _UNITS or _UNITS[mine][0] != _UNITS[theirs][0]:
        return None
    return _UNITS[mine][1] / _UNITS[theirs][1]


def _plain(unit: str) -> str:
    return "".join(unit.casefold().split())
