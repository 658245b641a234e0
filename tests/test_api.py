"""What people hold: pure models and runs, with the doors that reach everything else."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

import xlmc
from xlmc.montecarlo.model import loading
from xlmc.montecarlo.simulation import simulate, simulation

BOOK = Path(__file__).resolve().parents[1] / "examples" / "skid-100-ft.xlsx"


@pytest.fixture(scope="module")
def book():
    return xlmc.load(BOOK)


def test_a_run_holds_the_model_that_it_is_a_run_of(book):
    run = book.simulate(1_000)
    assert run.model is book
    assert isinstance(run, xlmc.Simulation)
    assert isinstance(dataclasses.replace(run, trials=1_000), xlmc.Simulation)


def test_an_opened_run_can_be_run_again(book, tmp_path):
    run = book.simulate(1_000)
    again = xlmc.open_run(run.keep(tmp_path / "a.xlmcrun")).model.simulate(1_000)
    assert {name: values.tolist() for name, values in again.forecasts.items()} == {
        name: values.tolist() for name, values in run.forecasts.items()
    }


def test_doors_change_nothing_that_a_run_holds(book):
    pure = simulate.simulate(loading.load(BOOK), trials=1_000)
    assert type(pure) is simulation.Simulation
    held = xlmc.Simulation.of(pure)
    assert all(getattr(held, each.name) is getattr(pure, each.name) for each in dataclasses.fields(pure)[1:])
    assert held.warnings == pure.warnings
    assert held.model.workbook is pure.model.workbook


def test_what_the_package_offers_is_there():
    assert all(getattr(xlmc, name) is not None for name in xlmc.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = xlmc.nothing
