"""Forecasts next to the largest and the smallest number: every output is written, and no number overflows on the way.

Warnings are errors in all tests, so an overflow of NumPy's would be one.
"""

from __future__ import annotations

import json

import openpyxl
import pytest
from openpyxl.worksheet.table import Table
from simulated import simulated

from xlmc.api import Simulation
from xlmc.montecarlo.model.loading import load

FORECASTS = {
    "both ends": "=IF(B2<0.5,-1E308,1E308)",
    "the farthest ends": "=IF(B2<0.5,-1.7E308,1.7E308)",
    "wide": "=(B2-0.5)*1.7E308",
    "high": "=B2*1E200",
    "denormal": "=B2*1E-320",
    "nearly one number": "=1+B2*4E-16",
    "two numbers": "=IF(B2<0.5,0,5E-324)",
}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "S"
    rows = [("Name", "Value", "Low", "High"), ("a", 0.5, 0.0, 1.0), (), ("Name", "Value"), *FORECASTS.items()]
    for row in rows:
        sheet.append(row)
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:D2"))
    sheet.add_table(Table(displayName="xlmc_forecasts", ref=f"A4:B{4 + len(FORECASTS)}"))
    path = tmp_path_factory.mktemp("extreme") / "book.xlsx"
    book.save(path)
    return simulated(load(path), trials=2_000)


@pytest.mark.parametrize(
    ("write", "name"),
    [("save", "r.xlsx"), ("save_page", "r.html"), ("save_json", "r.json"), ("extract", "r.csv"), ("keep", "r.xlmcrun")],
)
def test_every_output_is_written(run, tmp_path, write, name):
    getattr(Simulation(run), write)(tmp_path / name)
    assert (tmp_path / name).stat().st_size > 1_000


def test_no_number_in_the_json_is_infinite(run, tmp_path):
    def refused(token):
        raise AssertionError(token)

    Simulation(run).save_json(tmp_path / "r.json")
    json.loads((tmp_path / "r.json").read_text("utf-8"), parse_constant=refused)


def test_means_and_deviations_are_there_up_to_the_largest_number(run):
    """Half of the trials at each end: the deviation is the end itself, to three standard errors of a share of 2,000."""
    share = 3 * 0.5 / 2_000**0.5
    for name, end in (("both ends", 1e308), ("the farthest ends", 1.7e308)):
        assert abs(run[name].mean.value) <= 2 * share * end
        assert run[name].standard_deviation.value == pytest.approx(end, rel=4 * share**2)
