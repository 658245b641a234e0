"""Answers of any scale and of any spread: every output is written, and the JSON holds finite numbers."""

from __future__ import annotations

import json

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from simulated import simulated
from workbook_files import workbook_of

from xlmc.analysis.studies.fitting import fit
from xlmc.api import Simulation
from xlmc.montecarlo.model.loading import load


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scales")


def refuse(constant):
    raise AssertionError(f"the JSON holds {constant}")


@given(
    exponent=st.integers(-300, 300),
    spread=st.sampled_from([0.0, 1e-15, 1e-12, 1e-8, 1e-4, 0.3, 1.0, 1e3, 1e6]),
    sign=st.sampled_from([1, -1]),
    curved=st.booleans(),
)
@example(exponent=-290, spread=0.3, sign=1, curved=False)
@example(exponent=1, spread=1e-12, sign=1, curved=False)
@example(exponent=-150, spread=1e6, sign=1, curved=True)
@settings(max_examples=40)
def test_every_output_is_written(folder, exponent, spread, sign, curved):
    scale = f"1E{exponent}" if exponent + 6 < 300 else "1E290"
    power = "^2" if curved and abs(exponent) < 145 else "*1"
    rows = [["Name", "Value", "Low", "High"], ["x", sign, sign, sign + spread], []]
    rows += [["Name", "Value"], ["y", f"=({scale}*B2){power}"]]
    book = folder / "book.xlsx"
    workbook_of({"S": rows}, {"xlmc_assumptions": "S!A1:D2", "xlmc_forecasts": "S!A4:B5"}).save(book)
    run = simulated(load(book), trials=2000)
    assert run.accepted == 2000
    whole = Simulation(run)
    written = whole.save_json(folder / "o.json", overwrite=True)
    document = json.loads(written.read_text(encoding="utf-8"), parse_constant=refuse)
    assert document["forecasts"]
    for save, name in ((whole.save, "o.xlsx"), (whole.save_page, "o.html"), (whole.keep, "o.xlmcrun")):
        assert save(folder / name, overwrite=True).exists()
    values = run["y"].values
    if values.min() < values.max() and abs(values).max() < 1e100:
        assert fit(values).fits
