"""The study of what outputs cost: its book is what it says, a point has every step, and the table shows it."""

from __future__ import annotations

import growth_of_outputs as growth
import pytest

import xlmc


@pytest.mark.parametrize("rejected", [1, 10])
def test_the_book_has_what_was_asked_for(tmp_path, rejected):
    growth.write_book(tmp_path / "book.xlsx", assumptions=7, forecasts=3, cells=40, rejected=rejected)
    model = xlmc.load(tmp_path / "book.xlsx")
    assert (len(model.live), len(model.forecasts), len(model.filters)) == (7, 3, int(rejected > 1))
    formulas = sum(
        content.formula is not None
        for sheet in ("Model", "Answers")
        for content in model.workbook.sheets[sheet].cells.values()
    )
    assert formulas - int(rejected > 1) == 40
    run = model.simulate(4_000, seed=1)
    assert run.accepted / run.trials == pytest.approx(1.0 / rejected, rel=0.2)


def test_a_point_has_every_step(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(growth, "MIDDLE", {"assumptions": 3, "forecasts": 1, "cells": 10, "trials": 200, "rejected": 1})
    found = growth.measure({"trials": [200], "cells": [10]}, tmp_path, 300.0, report=False)
    [point] = found["trials"]
    steps = [step for step in growth.STEPS if step != "report"]
    assert all(point[step]["seconds"] >= 0.0 for step in steps)
    assert point["accepted"] == point["trials"] == 200
    assert {**found["cells"][0], "size": 200} == point  # the middle point is measured once
    assert not list(tmp_path.iterdir())
    lines = growth.table(found).splitlines()
    assert lines[0].startswith("| trials | load | check |")
    assert lines[2].startswith("| 200 |")


def test_the_slope_is_of_the_last_decade():
    points = [{"size": size, "run": {"seconds": size**2 / 1e4, "megabytes": 1.0}} for size in (10, 100, 1_000)]
    assert "| 2.00 |" in growth.table({"cells": points}).splitlines()[-1]
    assert "no answer" in growth.table({"cells": [{"size": 3, "absent": "no answer within 1 s"}]})
