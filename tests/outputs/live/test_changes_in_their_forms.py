"""Dates, percentages and money are written as in their cells where the window says what has changed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from kinds_book import write_book

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Definitions, Forecast, Solve
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.outputs.live.adjustments_in_words import changed_text
from xlmc.outputs.live.what_changed import what_changed

HERE = Cell("S", 1, 1)
DATES, SHARES = Form(Kind.DATE, "yyyy-mm-dd"), Form(Kind.PERCENT, "0%")


@pytest.fixture(scope="module")
def kinds(tmp_path_factory):
    return load(write_book(tmp_path_factory.mktemp("kinds") / "book.xlsx", filtered=False))


@pytest.mark.parametrize(
    ("name", "before", "after", "text"),
    [
        ("End", 46130.0, 46131.0, "End: threshold 2026-04-18 → 2026-04-19"),
        ("Rate", 0.1, None, "Rate: threshold 10 % → none"),
        ("Avoided", 0.5, 0.25, "Avoided: threshold 0.5 → 0.25"),
    ],
)
def test_a_threshold_that_was_saved_anew(kinds, name, before, after, text):
    def with_threshold(threshold):
        forecasts = (
            replace(each, threshold=threshold) if each.name == name else each for each in kinds.definitions.forecasts
        )
        return CompiledModel(kinds.workbook, replace(kinds.definitions, forecasts=tuple(forecasts)), Path("book.xlsx"))

    assert what_changed(with_threshold(before), with_threshold(after)) == [text]


@pytest.mark.parametrize(
    ("of", "name", "key", "before", "after", "text"),
    [
        ("forecast", "End", "threshold", 46130.0, 46131.0, "threshold 2026-04-18 → 2026-04-19"),
        ("forecast", "End", "central", 51.0, 80.0, "central range 51 % → 80 %"),
        ("solve", "Start", "to", 46130.0, 46131.0, "To 2026-04-18 → 2026-04-19"),
        ("solve", "Start", "low", 0.1, 0.2, "Low 10 % → 20 %"),
    ],
)
def test_what_the_window_moves(of, name, key, before, after, text):
    definitions = Definitions(
        forecasts=(Forecast("End", HERE, HERE, form=DATES),),
        solves=(Solve("Start", HERE, 46130.0, HERE, 0.1, 0.9, HERE, form=DATES, form_by=SHARES),),
    )
    assert changed_text(definitions, of, name, key, before, after) == text
