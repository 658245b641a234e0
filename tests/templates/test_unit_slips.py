"""Slips that the templates' own checks must tell: a percentage entered as a number, an angle from another corner."""

from __future__ import annotations

import re

import numpy as np
import openpyxl
from cases import cases

import xlmc
from templates.checks import ALL_CHECKS
from templates.description import Role
from xlmc.run.checking import base_checks
from xlmc.workbook.package import read_parts
from xlmc.workbook.reader import read_workbook
from xlmc.workbook.writer import package_bytes

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
}
ANGLE = {
    "momentum": ("alpha_1",),
    "planar-impact": ("alpha_1",),
    "crush-energy": ("theta_1", "theta_2"),
    "pedestrian-throw": ("angle",),
    "airborne": ("theta",),
    "pedestrian": ("angle",),
}
RESTITUTION = {"collinear": ("e",), "planar-forward": ("e_n", "e_t"), "crush-energy": ("e",)}
SLIPS = {
    template: [
        (symbol, value)
        for slips, value in ((FRICTION, 75), (FRICTION, 0), (ANGLE, 278), (RESTITUTION, 15))
        for symbol in slips.get(template, ())
        if not (symbol == "mu" and value == 0 and template == "planar-forward")  # a contact may be without friction
    ]
    for template in sorted({*FRICTION, *ANGLE, *RESTITUTION})
}


def with_value(folder, path, symbol, value):
    """The model of a copy in which one number is changed."""
    book = read_workbook(path)
    (text,) = (name.text for name in book.names if name.name == symbol)
    sheet, cell = text.removeprefix("=").replace("$", "").split("!")
    part, parts = book.sheets[sheet].part, read_parts(path.read_bytes())
    number = rb'(<c r="%b"[^>]*><v>)[^<]*' % cell.encode()
    changed, times = re.subn(number, rb"\g<1>%d" % value, parts[part])
    assert times == 1
    (folder / "slip.xlsx").write_bytes(package_bytes(parts | {part: changed}))
    return xlmc.load(folder / "slip.xlsx")


@cases("edition", EDITIONS)
@cases("template", SLIPS)
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


def test_what_fails_is_told_with_its_cell(tmp_path, book_path):
    model = with_value(tmp_path, book_path["planar-forward"], "f_1", 75)
    (failing,) = [check.fault for check in base_checks(model) if check.holds is False]
    assert re.search(r": Model!D\d+ is FALSE: ", failing)


@cases("edition", EDITIONS)
@cases("template", SLIPS)
def test_a_template_as_it_comes_raises_no_alarm(run_of, template, edition):
    run = run_of(f"{template}{edition}")
    assert run.checks
    assert all(check.holds and not check.failed for check in run.checks)
    assert run.warnings == []


def test_a_filled_range_in_percent_fails_in_the_accepted_trials(tmp_path, book_path):
    book = openpyxl.load_workbook(book_path["skid"])
    sheet = book["Inputs"]
    for column, value in zip("GHIJKL", (None,) * 6, strict=True):
        sheet[f"{column}6"] = value
    sheet["F6"], sheet["G6"], sheet["H6"] = "Uniform", 60, 95
    book.save(tmp_path / "percent.xlsx")
    run = xlmc.load(tmp_path / "percent.xlsx").simulate(trials=20_000)
    friction = next(check for check in run.checks if "Friction" in check.name)
    assert friction.holds
    assert friction.failed == friction.trials == run.accepted
    assert "20,000 of 20,000 accepted trials (100.00%) fail the check" in run.warnings[0]
