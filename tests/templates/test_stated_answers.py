"""How the templates' forecasts are stated: bounds on one side, diagnostics without a sentence, yes/no as chances."""

from __future__ import annotations

import pytest

from xlmc.montecarlo.definitions.stating import Kind, Role
from xlmc.montecarlo.model.loading import load

BOUNDS = [
    ("time-distance", "Highest speed that still stops (without braking: at most)", Role.UPPER, None),
    ("time-distance", "Implied response time (without braking: at least)", Role.LOWER, None),
    ("time-distance", "Same driver: avoided, at least (1 = yes)", Role.LOWER, Kind.YES_NO),
    ("time-distance", "Same driver: avoided, at most (1 = yes)", Role.UPPER, Kind.YES_NO),
    ("time-distance", "Ordinary driver: avoided (1 = yes)", Role.ANSWER, Kind.YES_NO),
    ("pedestrian", "Same driver at the limit: stops, at least (1 = yes)", Role.LOWER, Kind.YES_NO),
    ("pedestrian-throw", "Projection speed, at least", Role.LOWER, None),
    ("crush-energy", "Force balance", Role.DIAGNOSTIC, None),
    ("planar-impact", "Energy lost", Role.DIAGNOSTIC, None),
    ("planar-forward", "Energy lost", Role.DIAGNOSTIC, None),
]


@pytest.mark.parametrize(("template", "name", "role", "kind"), BOUNDS, ids=[f"{row[0]}: {row[1]}" for row in BOUNDS])
@pytest.mark.parametrize("edition", ["", "-si"], ids=["US", "SI"])
def test_forecast_of_template_says_what_it_is(template, name, role, kind, edition):
    model = load(f"templates/{template}{edition}.xlsx")
    result = {each.name: each for each in model.forecasts}[name]
    assert (result.role, result.kind) == (role, kind)
