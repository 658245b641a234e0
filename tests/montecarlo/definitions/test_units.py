from __future__ import annotations

import math

import pytest

from xlmc.montecarlo.definitions import units
from xlmc.montecarlo.definitions.units import factor_between


@pytest.mark.parametrize(
    ("source", "target", "factor"),
    [
        ("mph", "mph", 1.0),
        ("widgets", "Widgets", 1.0),
        ("", "", 1.0),
        ("km/h", "m/s", 1 / 3.6),
        ("mph", "ft/s", 5280 / 3600),
        ("ft", "in", 12.0),
        ("rad", "deg", 180 / math.pi),
        ("kg", "lb", 1 / 0.45359237),
        ("g", "ft/s²", 9.80665 / 0.3048),
        ("ft·lb", "J", 1.3558179483314004),
        ("", "mph", None),
        ("mph", "deg", None),
        ("widgets", "mph", None),
    ],
)
def test_units(source, target, factor):
    result = factor_between(source, target)
    assert result is None if factor is None else result == pytest.approx(factor, rel=1e-12)


IN_SI = {
    "m/s": "m/s 1, km/h 0.2777777777777778, kph 0.2777777777777778, mph 0.44704, mi/h 0.44704, ft/s 0.3048, "
    "fps 0.3048, ft/sec 0.3048, kn 0.5144444444444445",
    "m": "m 1, mm 0.001, cm 0.01, km 1000, in 0.0254, ft 0.3048, yd 0.9144, mi 1609.344",
    "rad": "rad 1, deg 0.017453292519943295, ° 0.017453292519943295",
    "rad/s": "rad/s 1, deg/s 0.017453292519943295, °/s 0.017453292519943295, rpm 0.10471975511965977",
    "s": "s 1, sec 1, ms 0.001, min 60, h 3600",
    "kg": "kg 1, lb 0.45359237",
    "m/s²": "m/s² 1, m/s^2 1, m/s2 1, ft/s² 0.3048, ft/s^2 0.3048, ft/s2 0.3048, g 9.80665, g's 9.80665",
    "N": "n 1, lbf 4.4482216152605",
    "J": "j 1, kj 1000, ft·lb 1.3558179483314004, ft-lb 1.3558179483314004, ft*lb 1.3558179483314004",
    "kg·m²": "kg·m² 1, lb·ft·s² 1.3558179483314004",
}
"""SI unit -> units of its kind, and how much of it they are: NIST SP 811, appendix B."""


def test_every_unit_is_as_much_of_the_si_unit_as_it_is():
    listed = {si: dict(row.rsplit(" ", 1) for row in rows.split(", ")) for si, rows in IN_SI.items()}
    assert {unit for rows in listed.values() for unit in rows} == set(units._UNITS)
    result = {unit: factor_between(unit, si) for si, rows in listed.items() for unit in rows}
    wanted = {unit: float(factor) for rows in listed.values() for unit, factor in rows.items()}
    assert result == pytest.approx(wanted, rel=1e-14)
