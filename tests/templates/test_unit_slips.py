"""Slips that the templates' own checks must tell: a percentage entered as a number, an angle from another corner."""

from __future__ import annotations

import re

import openpyxl
import pytest

import xlmc
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
CASES = [
    (template, symbol, value)
    for slips, value in ((FRICTION, 75), (FRICTION, 0), (ANGLE, 278), (RESTITUTION, 15))
    for template, symbols in slips.items()
    for symbol in symbols
    if not (symbol == "mu" and value == 0 and template == "planar-forward")  # a contact without friction is possible
]


def with_value(folder, path, symbol, value):
    """The number is changed in the sheet's own bytes: openpyxl takes long to read and to save so many books."""
    book = read_workbook(path)
    (text,) = (name.text for name in book.names if name.name == symbol)
    sheet, cell = text.removeprefix("=").replace("$", "").split("!")
    part, parts = book.sheets[sheet].part, read_parts(path.read_bytes())
    number = rb'(<c r="%b"[^>]*><v>)[^<]*' % cell.encode()
    changed, times = re.subn(number, rb"\g<1>%d" % value, parts[part])
    assert times == 1
    (folder / "slip.xlsx").write_bytes(package_bytes(parts | {part: changed}))
    return xlmc.load(folder / "slip.xlsx")


@pytest.mark.parametrize("edition", EDITIONS)
@pytest.mark.parametrize(("template", "symbol", "value"), CASES)
def test_a_slip_fails_a_check_at_the_base_case(tmp_path, book_path, template, symbol, value, edition):
    model = with_value(tmp_path, book_path[f"{template}{edition}"], symbol, value)
    failing = [check.fault for check in base_checks(model) if check.holds is False]
    assert failing
    assert all(": Model!D" in fault for fault in failing)


@pytest.mark.parametrize("edition", EDITIONS)
@pytest.mark.parametrize("template", sorted({*FRICTION, *ANGLE, *RESTITUTION}))
def test_a_template_as_it_comes_raises_no_alarm(book_path, template, edition):
    run = xlmc.load(book_path[f"{template}{edition}"]).simulate(trials=20_000)
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
