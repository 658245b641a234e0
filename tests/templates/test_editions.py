from __future__ import annotations

import math

import pytest

from templates.build import TEMPLATES
from templates.description import Equation
from templates.editions import Both, Edition, edition

# Unit of the imperial edition -> unit of the SI edition, and how many of these it is. Masses: pounds over 32.174 are
# slugs, 14.593903 kg each, so that both editions mean the same mass whatever the digits of g.
SLUG = 4.4482216152605 / 0.3048
CONVERSION = {
    "ft": ("m", 0.3048),
    "in": ("m", 0.0254),
    "ft/s": ("m/s", 0.3048),
    "ft/s²": ("m/s²", 0.3048),
    "ft²/s²": ("m²/s²", 0.3048**2),
    "mph": ("km/h", 1.609344),
    "lb": ("kg", SLUG / 32.174),
    "lb·s²/ft": ("kg", SLUG),
    "lb·s": ("N·s", 4.4482216152605),
    "ft·lb": ("J", 4.4482216152605 * 0.3048),
    "lb·ft·s²": ("kg·m²", 4.4482216152605 * 0.3048),
}


def converted(imperial, unit):
    return imperial * CONVERSION[unit][1] if unit in CONVERSION else imperial


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
            if all(both):
                yield both[0][0], both[1][0]


@pytest.mark.parametrize("name", TEMPLATES)
def test_units_of_the_editions_are_counterparts(name):
    for imperial, si in pairs(name):
        if imperial.unit != si.unit and imperial.symbol not in ("ft_per_mile",):
            assert CONVERSION[imperial.unit][0] == si.unit, imperial.symbol


@pytest.mark.parametrize("name", TEMPLATES)
def test_both_editions_give_the_same_crash(name, cells, shown, described):
    """The SI workbook, given the imperial base case in its own units, shows the imperial answers in its own units."""
    inputs = {given.symbol for given in described[name].inputs}
    rows = [(i, s) for i, s in pairs(name) if i.symbol != "ft_per_mile"]
    imperial = shown(name)
    given = {
        s.symbol: converted(imperial[i.symbol], i.unit)
        for i, s in rows
        if i.symbol in inputs
        if is_number(imperial[i.symbol])
    }
    wanted = {s.symbol: i for i, s in rows if i.symbol not in inputs and is_number(imperial[i.symbol])}
    found = cells(f"{name}-si", given, list(wanted))
    assert len(wanted) > 5
    for symbol, row in wanted.items():
        truth = converted(imperial[row.symbol], row.unit)
        assert math.isclose(found[symbol].item(), truth, rel_tol=1e-9, abs_tol=1e-9), symbol


def is_number(value):
    return isinstance(value, int | float) and not isinstance(value, bool)
