from __future__ import annotations

import re

import numpy as np
import pytest
from committed_books import BOOKS

from templates.build import TEMPLATES
from templates.description import Equation
from templates.editions import Both, Edition, edition

# Unit of the imperial edition -> unit of the SI edition, and how many of these it is. Masses: pounds over 32.174 are
# slugs, 14.593903 kg each, so that both editions mean the same mass whatever the digits of g.
SLUG = 4.4482216152605 / 0.3048
POUND_FORCE = 4.4482216152605
CONVERSION = {
    ("ft", "m"): 0.3048,
    ("in", "m"): 0.0254,
    ("in", "cm"): 2.54,
    ("in²", "cm²"): 2.54**2,
    ("ft/s", "m/s"): 0.3048,
    ("ft/s²", "m/s²"): 0.3048,
    ("ft²/s²", "m²/s²"): 0.3048**2,
    ("mph", "km/h"): 1.609344,
    ("mph/in", "(km/h)/cm"): 1.609344 / 2.54,
    ("in", "mm"): 25.4,
    ("in³", "cm³"): 2.54**3,
    ("in⁴", "cm⁴"): 2.54**4,
    ("ksi", "MPa"): POUND_FORCE / 0.0254**2 / 1000,
    ("kip/ft", "kN/m"): POUND_FORCE / 0.3048,
    ("kip·ft", "kN·m"): POUND_FORCE * 0.3048,
    ("°F", "K"): 5 / 9,
    ("10⁻⁶/°F", "10⁻⁶/K"): 9 / 5,
    ("lb", "kg"): SLUG / 32.174,
    ("lb", "N"): POUND_FORCE,
    ("lb/in", "N/cm"): POUND_FORCE / 2.54,
    ("lb/in²", "N/cm²"): POUND_FORCE / 2.54**2,
    ("lb·s²/ft", "kg"): SLUG,
    ("ft/(lb·s²)", "1/kg"): 1 / SLUG,
    ("lb·s", "N·s"): POUND_FORCE,
    ("ft·lb", "J"): POUND_FORCE * 0.3048,
    ("lb·ft·s²", "kg·m²"): POUND_FORCE * 0.3048,
}
VEHICLE = re.compile("«.*?»")
DEFINITIONS = ("ft_per_mile", "in_per_ft")


def converted(value, imperial, si):
    """A value of an imperial cell in the units of its SI counterpart."""
    return value if imperial.unit == si.unit else value * CONVERSION[imperial.unit, si.unit]


def test_a_choice_follows_the_units():
    row = Equation("V_[mph|kmh]", "V", "Speed", "[mph|km/h]", "v*[ft_per_mile|m_per_km]", number_format="0.0[|0]")
    imperial, si = (edition(row, units) for units in Edition)
    assert (imperial.symbol, imperial.unit, imperial.number_format) == ("V_mph", "mph", "0.0")
    assert (si.symbol, si.formula, si.number_format) == ("V_kmh", "v*m_per_km", "0.00")


def test_numbers_and_empty_rows_follow_too():
    rows = (Equation("[m|]", "", "", "", "w/g"), Equation("v", "", "", "", "2"))
    assert [row.symbol for row in edition(rows, Edition.SI)] == ["v"]
    assert edition({"Low": Both(3, 1)}, Edition.SI) == {"Low": 1}
    assert edition("Monson and Germane [23]", Edition.SI) == "Monson and Germane [23]"


def pairs(name):
    """(imperial, SI) of each input and equation that both editions have."""
    template = TEMPLATES[name]
    for rows in (template.assumptions, template.constants, template.optional, template.equations):
        for row in rows:
            both = [edition((row,), units) for units in Edition]
            if all(both) and both[0][0].symbol not in DEFINITIONS:
                yield both[0][0], both[1][0]


@pytest.mark.parametrize("name", TEMPLATES)
def test_labels_of_the_editions_name_the_same_vehicles_and_units_are_counterparts(name):
    for imperial, si in pairs(name):
        assert VEHICLE.findall(imperial.name) == VEHICLE.findall(si.name)
        assert imperial.unit == si.unit or (imperial.unit, si.unit) in CONVERSION, imperial.symbol


def drawn(given, rng, n):
    """Values of an input over its range, `(n,)`."""
    p = given.parameters
    deviation = p.get("Std dev") or p.get("Mean", 0) * p.get("CoV %", 0) / 100
    return rng.uniform(p["Low"], p["High"], n) if "Low" in p else rng.normal(p["Mean"], deviation, n)


@pytest.mark.parametrize("name", [name for name in TEMPLATES if f"{name}-si" in BOOKS])
def test_both_editions_give_the_same_case(name, cells, shown, described):
    """100 draws of the imperial assumptions; the SI workbook, given them in its own units, answers in its own units."""
    template, rng, n = described[name], np.random.default_rng(9), 100
    inputs = {given.symbol for given in template.inputs}
    base = shown(name)
    draws = {given.symbol: drawn(given, rng, n) for given in template.assumptions}
    rows = [(i, s) for i, s in pairs(name) if is_number(base[i.symbol])]
    wanted = [(i, s) for i, s in rows if i.symbol not in inputs]
    imperial = cells(name, draws, [i.symbol for i, _ in wanted])
    given = {s.symbol: converted(draws.get(i.symbol, base[i.symbol]), i, s) for i, s in rows if i.symbol in inputs}
    si = cells(f"{name}-si", given, [s.symbol for _, s in wanted])
    assert len(wanted) > 5
    for i, s in wanted:
        truth = converted(imperial[i.symbol], i, s)
        scale = np.nanmax(np.abs(truth))
        np.testing.assert_allclose(si[s.symbol], truth, rtol=1e-9, atol=1e-9 * scale, err_msg=s.symbol)


def is_number(value):
    """Whether a cell shows a number, or whether a check holds."""
    return isinstance(value, int | float)
