"""The closed form of `solving.py`, its loop over SciPy, and its workbook agree."""

from __future__ import annotations

import numpy as np
from solving import APART, closed_form, loop, write

import xlmc


def test_loop_workbook_and_closed_form_agree(tmp_path):
    write(tmp_path / "stop.xlsx")
    run = xlmc.load(tmp_path / "stop.xlsx").simulate(2_000, keep_inputs=None)
    drawn = [run.inputs[name] for name in ("Reaction", "Friction", "Distance")]
    exact = closed_form(*drawn)
    assert np.max(np.abs(run.forecasts["Speed"] / exact - 1)) < APART
    assert np.max(np.abs(loop(*drawn) / exact - 1)) < 1e-9
