"""What people hold in Python: models and runs with the names that docs/python.md lists, and no others."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import numpy as np
import pytest
from simulated import simulated

import xlmc
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[1]
BOOK = ROOT / "examples" / "skid-100-ft.xlsx"
PAGE = ROOT / "docs" / "python.md"


@pytest.fixture(scope="module")
def book():
    return xlmc.load(BOOK)


@pytest.fixture(scope="module")
def run(book):
    return book.simulate(1_000)


def own_names(kind):
    return {name for name in vars(kind) if not name.startswith("_")}


def test_a_run_names_the_model_that_it_is_a_run_of(book, run):
    assert isinstance(run, xlmc.Simulation)
    assert isinstance(run.model, xlmc.Model)
    assert run.model.workbook is book.workbook


def test_an_opened_run_can_be_run_again(run, tmp_path):
    again = xlmc.open_run(run.keep(tmp_path / "a.xlmcrun")).model.simulate(1_000)
    assert {name: values.tolist() for name, values in again.forecasts.items()} == {
        name: values.tolist() for name, values in run.forecasts.items()
    }


def test_a_run_gives_what_the_result_in_it_gives(run):
    """Every property, and the result of a forecast by its name; a figure and files have tests of their own."""
    inner = simulated(load(BOOK), 1_000)
    public = xlmc.Simulation(inner)
    beside = {"model", "scenarios", "sentences", "weights"}
    properties = {name for name, each in vars(xlmc.Simulation).items() if isinstance(each, property)} - beside
    assert all(getattr(public, name) == getattr(inner, name) for name in properties - {"trial_index"})
    assert public.trial_index is inner.trial_index
    assert public["distance while RESPONDING"] is inner["Distance while responding"]
    assert public.frame().equals(run.frame())


def test_a_model_gives_what_the_compiled_model_in_it_gives(book):
    inner = load(BOOK)
    public = xlmc.Model(inner)
    names = {name for name, each in vars(xlmc.Model).items() if isinstance(each, property)}
    assert all(getattr(public, name) == getattr(inner, name) for name in names)
    assert public.quantiles(0.5) == inner.quantiles(0.5) == book.quantiles(0.5)
    bases = {name: 1.0 if base is None else base for name, base in public.bases.items()}
    computed = public.function(bases)
    assert computed.keys() == {each.name for each in public.forecasts}
    assert all(np.isfinite(values).all() for values in computed.values())


@pytest.mark.parametrize(("kind", "title"), [(xlmc.Model, "Model"), (xlmc.Simulation, "Simulation")])
def test_the_public_names_are_those_that_the_page_lists(kind, title):
    section = PAGE.read_text("utf-8").partition(f"\n## `{title}`")[2].partition("\n## ")[0]
    listed = set(re.findall(r"^\| `(?:run|model)\.(\w+)", section, re.MULTILINE))
    assert listed == own_names(kind)


@pytest.mark.parametrize("name", ["compare", "load", "open_run", "screen", "sensitivities"])
def test_the_public_functions_are_on_the_page(name):
    assert f"`xlmc.{name}(" in PAGE.read_text("utf-8")
    assert inspect.getdoc(getattr(xlmc, name))


def test_what_the_package_offers_is_there():
    assert all(getattr(xlmc, name) is not None for name in xlmc.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = xlmc.nothing
