"""Slips that the templates' own checks must tell: a percentage entered as a number, an angle from another corner."""

from __future__ import annotations

import re

import numpy as np
import pytest
from recalculated_books import RECALCULATED
from simulated import simulated

from templates.checks import ALL_CHECKS
from templates.description import Role
from xlmc.excel.address import parse_address
from xlmc.montecarlo.diagnostics.checking import base_checks

EDITIONS = ["", "-si"]
FRICTION = {
    "skid": ("f_1", "f_2", "f_3"),
    "critical-speed-yaw": ("f",),
    "momentum": ("f_1", "f_2"),
    "planar-impact": ("f_1", "f_2"),
    "planar-forward": ("f_1", "f_2", "mu"),
    "pedestrian-throw": ("mu",),
    "time-distance": ("f",),
    "airborne": ("f",),
    "edr-speed": ("f",),
    "momentum-energy": ("f_1", "f_2"),
    "pedestrian": ("f", "mu"),
    "low-speed": ("f_after",),
    "motorcycle": ("f_upright", "f_slide", "f_1", "f_2", "mu"),
}
ANGLE = {
    "momentum": ("alpha_1",),
    "planar-impact": ("alpha_1",),
    "crush-energy": ("theta_1", "theta_2"),
    "pedestrian-throw": ("angle",),
    "airborne": ("theta",),
    "pedestrian": ("angle",),
    "motorcycle": ("angle",),
}
RESTITUTION = {
    "collinear": ("e",),
    "low-speed": ("e",),
    "planar-forward": ("e_n", "e_t"),
    "crush-energy": ("e",),
    "edr-speed": ("e",),
}
SLIPS = {
    template: [
        (symbol, value)
        for slips, value in ((FRICTION, 75), (FRICTION, 0), (ANGLE, 278), (RESTITUTION, 15))
        for symbol in slips.get(template, ())
        if not (symbol == "mu" and value == 0 and template == "planar-forward")  # a contact may be without friction
    ]
    for template in sorted({*FRICTION, *ANGLE, *RESTITUTION})
}


@pytest.mark.parametrize("edition", EDITIONS)
@pytest.mark.parametrize("template", SLIPS)
def test_a_slip_fails_a_check_at_the_base_case(template, edition, cells, shown, described):
    """All slips of a workbook are computed at once, one a row."""
    name, slips = f"{template}{edition}", SLIPS[template]
    base, rows = shown(name), np.arange(len(slips))
    inputs = {
        symbol: np.where([each == symbol for each, _ in slips], [value for _, value in slips], base[symbol])
        for symbol, _ in slips
    }
    assert all(np.count_nonzero([inputs[symbol][row] != base[symbol] for symbol in inputs]) == 1 for row in rows)
    checks = [row.symbol for row in described[name].equations if row.role is Role.CHECK and row.symbol != ALL_CHECKS]
    holds = cells(name, inputs, checks)
    passed = [slips[row] for row in rows if all(holds[symbol][row] == 1 for symbol in checks)]
    assert passed == []


def test_what_fails_is_told_with_its_cell(typed):
    model = typed("planar-forward", {"f_1": 75})
    (failing,) = [check.fault for check in base_checks(model) if check.holds is False]
    assert re.search(r": Model!D\d+ is FALSE: ", failing)


@pytest.mark.parametrize("name", RECALCULATED)
def test_a_template_as_it_comes_raises_no_alarm(run_of, name):
    """One edition of each; `test_editions.py` shows that the other has the same checks."""
    run = run_of(name)
    assert run.accepted > 100
    assert not run.model.definitions.problems
    assert run.checks
    assert all(check.holds and not check.failed for check in run.checks)
    assert run.warnings == []


def test_a_filled_range_in_percent_fails_in_the_accepted_trials(typed):
    row = dict(zip("FGHIJKL", ("Uniform", 60, 95, *(None,) * 4), strict=True))
    run = simulated(typed("skid", {parse_address(f"Inputs!{column}6"): value for column, value in row.items()}), 20_000)
    friction = next(check for check in run.checks if "Friction" in check.name)
    assert friction.holds
    assert friction.failed == friction.trials == run.accepted
    assert "20,000 of 20,000 accepted trials (100.00 %) fail the check" in run.warnings[0]
