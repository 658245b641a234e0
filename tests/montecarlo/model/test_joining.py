"""Books whose answers feed another one: every trial goes through all of them, as through one book of all equations."""

from __future__ import annotations

import numpy as np
import pytest
from committed_books import BOOKS
from simulated import simulated
from typed_cells import named_cells
from workbook_files import workbook_of

from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.montecarlo.definitions.feeds import read_feeds
from xlmc.montecarlo.definitions.scenarios import Range, Typed
from xlmc.montecarlo.model.applied_changes import applied
from xlmc.montecarlo.model.loading import load

HEAD = ["Name", "Value", "Distribution", "Low", "High", "Units"]
MPH = 3600 / 5280
FEED = "end=impact.xlsx!impact"
"""What the book `skid` takes from the book `impact`."""


def _inputs(*rows):
    return [HEAD, *([name, (low + high) / 2, "Uniform", low, high, units] for name, low, high, units in rows)]


def _saved(folder, name, inputs, answers, filters=(), correlations=()):
    """A book: rows of assumptions, then (name, formula, units) of forecasts, and (name, formula, least) of filters."""
    sheets = {"In": _inputs(*inputs), "Out": [["Name", "Value", "Units"], *map(list, answers)]}
    tables = {"xlmc_assumptions": f"In!A1:F{len(inputs) + 1}", "xlmc_forecasts": f"Out!A1:C{len(answers) + 1}"}
    if filters:
        sheets["Keep"] = [["Name", "Value", "At least"], *map(list, filters)]
        tables["xlmc_filters"] = f"Keep!A1:C{len(filters) + 1}"
    if correlations:
        sheets["Tied"] = [["First", "Second", "Correlation"], *map(list, correlations)]
        tables["xlmc_correlations"] = f"Tied!A1:C{len(correlations) + 1}"
    path = folder / f"{name}.xlsx"
    workbook_of(sheets, tables).save(path)
    return path


ROAD = ("f", 0.6, 0.9, "g")
IMPACT = (("s", 20, 30, "ft"), ROAD)
SKID = (("d", 55, 65, "ft"), ROAD, ("end", 10, 40, "mph"))


@pytest.fixture
def books(tmp_path):
    """The paths of a run-out, a skid before it, and one book with the equations of both."""
    impact = _saved(
        tmp_path,
        "impact",
        IMPACT,
        [("impact", "=SQRT(2*32.2*In!B3*In!B2)*3600/5280", "mph"), ("other", "=In!B2*2", "ft")],
        [("not slow", "=Out!B2", 20)],
    )
    skid = _saved(
        tmp_path,
        "skid",
        SKID,
        [("start", f"=SQRT(2*32.2*In!B3*In!B2+(In!B4/{MPH})^2)*{MPH}", "mph")],
        [("not fast", "=-Out!B2", -52)],
    )
    whole = _saved(
        tmp_path,
        "whole",
        (*SKID[:2], IMPACT[0]),
        [
            ("start", f"=SQRT(2*32.2*In!B3*In!B2+(Out!B3/{MPH})^2)*{MPH}", "mph"),
            ("end", "=SQRT(2*32.2*In!B3*In!B4)*3600/5280", "mph"),
        ],
        [("not fast", "=-Out!B2", -52), ("not slow", "=Out!B3", 20)],
    )
    return {"impact": impact, "skid": skid, "whole": whole}


def fed(path, *feeds):
    """The model of a book fed by others of its folder."""
    there = [each.replace("=", f"={path.parent}/", 1) for each in feeds]
    return load(path, read_feeds(there))


@pytest.mark.parametrize("options", [{}, {"engine": "jit"}, {"jobs": 2, "scheduler": "processes"}], ids=str)
def test_a_chain_is_the_book_that_holds_all_equations_to_the_last_bit(books, options):
    chain, whole = simulated(fed(books["skid"], FEED), 20_000, **options), simulated(load(books["whole"]), 20_000)
    assert 0 < chain.accepted < chain.trials
    assert np.array_equal(chain.trial_index, whole.trial_index)
    for name in ("start", "end"):
        np.testing.assert_array_equal(chain.forecasts[name], whole.forecasts[name])
    assert dict(zip([f.name for f in chain.model.filters], chain.tally.rejected, strict=True)) == dict(
        zip([f.name for f in whole.model.filters], whole.tally.rejected, strict=True)
    )


@pytest.mark.parametrize("sampling", ["lhs", "sobol"])
def test_other_ways_of_sampling_draw_the_inputs_of_all_books_together(books, sampling):
    chain = simulated(fed(books["skid"], FEED), 20_000, sampling=sampling)
    whole = simulated(load(books["whole"]), 20_000, sampling=sampling)
    for name in ("start", "end"):
        mine, other = (run.results[name].mean for run in (chain, whole))
        assert abs(mine.value - other.value) < 4 * np.hypot(mine.error, other.error)


def test_an_input_of_one_name_is_drawn_once(books):
    model = fed(books["skid"], FEED)
    assert [a.name for a in model.live] == ["d", "f", "s"]
    assert any("'f' is the same input in skid.xlsx and impact.xlsx" in str(each) for each in model.notices)


def test_inputs_of_one_name_that_are_defined_in_two_ways_are_refused(books, tmp_path):
    _saved(tmp_path, "impact", (IMPACT[0], ("f", 0.5, 0.9, "g")), [("impact", "=In!B2*In!B3", "mph")])
    with pytest.raises(DefinitionError, match=r"'f' is defined otherwise in skid.xlsx, In!A3") as refused:
        fed(books["skid"], FEED)
    assert str(refused.value.where) == "'[impact.xlsx]In'!A3"


def test_units_are_converted_and_an_assumption_may_feed_too(books, tmp_path):
    metric = _saved(tmp_path, "metric", (("v", 0, 100, "km/h"), ("g", 0, 1, "ft")), [("v2", "=In!B2+0*In!B3", "km/h")])
    run = simulated(fed(metric, FEED.replace("end", "v"), "g=impact.xlsx!s"), 5_000)
    speed = np.sqrt(2 * 32.2 * run.inputs["f"] * run.inputs["s"]) * MPH
    np.testing.assert_allclose(run.forecasts["v2"], speed * 1.609344, rtol=1e-12)
    np.testing.assert_array_equal(run.forecasts["g"], run.inputs["s"])


def test_several_books_in_a_row(books, tmp_path):
    before = _saved(tmp_path, "before", (("t", 1, 2, "s"), ("v", 20, 60, "mph")), [("way", "=In!B2*In!B3", "")])
    run = simulated(fed(before, "v=skid.xlsx!start", f"skid.xlsx!{FEED}"), 20_000)
    whole = simulated(load(books["whole"]), 20_000)
    assert np.array_equal(run.trial_index, whole.trial_index)
    np.testing.assert_array_equal(run.forecasts["v"], whole.forecasts["start"])
    np.testing.assert_allclose(run.forecasts["way"], run.inputs["t"] * run.forecasts["v"], rtol=1e-15)


def test_filters_of_one_name_in_two_books_both_hold(books, tmp_path):
    _saved(tmp_path, "impact", IMPACT, [("impact", "=In!B2", "mph")], [("not fast", "=Out!B2", 25)])
    run = simulated(fed(books["skid"], FEED), 5_000)
    assert [each.name for each in run.model.filters] == ["not fast", "not fast (impact.xlsx)"]
    assert run.forecasts["end"].min() >= 25


def test_correlations_of_the_other_book_hold(books, tmp_path):
    tied = [("s", "f", 0.9)]
    _saved(tmp_path, "impact", IMPACT, [("impact", "=In!B2", "mph")], correlations=tied)
    run = simulated(fed(books["skid"], FEED), 20_000)
    ranks = [np.argsort(np.argsort(run.inputs[name])) for name in ("s", "f")]
    assert np.corrcoef(ranks)[0, 1] == pytest.approx(0.9, abs=0.02)


@pytest.mark.parametrize(
    ("feeds", "message"),
    [
        (["x=impact.xlsx!impact"], "There is no assumption 'x'"),
        (["end=impact.xlsx!x"], "There is no forecast or assumption 'x'"),
        (["end=impact.xlsx!other"], "have the units 'mph' and 'ft'"),
        (["end=impact.xlsx!impact", "END=impact.xlsx!impact"], "fed twice"),
        (["impact.xlsx!s=skid.xlsx!start"], "skid.xlsx: This is the workbook that is run, and it cannot feed itself"),
        (["other.xlsx!s=impact.xlsx!impact"], "No workbook of this run is called 'other.xlsx'"),
        (["end=impact"], "cannot be read"),
    ],
)
def test_what_cannot_be_fed_is_refused(books, feeds, message):
    with pytest.raises(SimulationError, match=message):
        fed(books["skid"], *feeds)


def test_a_correlated_assumption_cannot_be_fed(books, tmp_path):
    path = _saved(tmp_path, "tied", SKID, [("start", "=In!B2+In!B4", "mph")], correlations=[("end", "d", 0.5)])
    with pytest.raises(SimulationError, match="'end' and 'd' are correlated, and one of them is fed"):
        fed(path, FEED)


@pytest.mark.parametrize("formula", ['=INDIRECT("In!B2")', "=SUM(In!B2:B3)"])
def test_references_in_texts_are_refused_and_others_hold(books, tmp_path, formula):
    _saved(tmp_path, "impact", IMPACT, [("impact", formula, "mph")])
    if "INDIRECT" in formula:
        with pytest.raises(SimulationError, match="calls INDIRECT") as refused:
            fed(books["skid"], FEED)
        assert str(refused.value.where) == "'[impact.xlsx]Out'!B2"
    else:
        run = simulated(fed(books["skid"], FEED), 2_000)
        np.testing.assert_allclose(run.forecasts["end"], run.inputs["s"] + run.inputs["f"], rtol=1e-15)


def test_a_changed_input_leaves_the_book_fed(books):
    model = fed(books["skid"], FEED)
    for change in (Range("d", 60, 61), Range("s", 24, 25), Typed(model.assumptions[0].row._replace(column=4), 59.0)):
        run = simulated(applied(model, [change]), 5_000)
        assert np.all(run.forecasts["end"] > 19)
        np.testing.assert_allclose(
            run.forecasts["start"],
            np.sqrt(2 * 32.2 * run.inputs["f"] * run.inputs["d"] + (run.forecasts["end"] / MPH) ** 2) * MPH,
            rtol=1e-12,
        )
    assert run.inputs["d"].min() >= 59


def test_the_case_of_the_paper_with_a_skid_before_it(tmp_path):
    """60 ft of skid on the same road: trials carried through against mean and SD, computed independently."""
    for name in ("skid-100-ft", "intersection"):
        (tmp_path / f"{name}.xlsx").write_bytes(BOOKS[name].read_bytes())
    skid = tmp_path / "skid-100-ft.xlsx"
    model = fed(
        skid,
        "Speed at the end of the skid=intersection.xlsx!Chevrolet impact speed",
        "Surface 1 friction=intersection.xlsx!Chevrolet post-impact deceleration",
    )
    length = named_cells(read_workbook(skid))["d_1"]
    run = simulated(applied(model, [Typed(length, 60.0)]), 400_000, seed=1)
    result = run.results["Speed at the beginning of the skid"]
    speeds = run.forecasts["Speed at the beginning of the skid"]
    above = np.mean(speeds > 48)
    assert abs(result.mean.value - 49.08) < 4 * result.mean.error + 0.005
    assert abs(result.standard_deviation.value - 2.76) < 4 * result.standard_deviation.error + 0.005
    assert abs(above - 0.59) < 4 * np.sqrt(0.59 * 0.41 / run.accepted) + 0.005
    low, high = result.central()
    for number, expected in ((low, 46.75), (high, 51.19)):
        assert abs(number.value - expected) < 4 * number.error + 0.005
