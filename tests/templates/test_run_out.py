"""Run-outs of several segments, speeds typed in, and skids before the impact: motions made forward come back."""

from __future__ import annotations

import numpy as np
import pytest
from committed_books import BOOKS
from simulated import simulated
from typed_cells import model_of as model
from typed_cells import named_cells, with_typed

from xlmc.montecarlo.definitions.feeds import read_feeds
from xlmc.montecarlo.model.loading import fed

NAMES = ("momentum", "planar-impact", "momentum-energy")
EDITIONS = [(name + units, 32.174 if not units else 9.80665, 3600 / 5280 if not units else 3.6)
            for name in NAMES for units in ("", "-si")]  # fmt: skip
LOW, HIGH, FROZEN = 7, 8, 16
"""Columns of the table on sheet Run-out."""


def drag(friction, share, rolling, grade):
    """In g: the share of the weight on sliding wheels, the rest on rolling ones, and the slope."""
    slope = np.arctan(grade / 100)
    return (share * friction + (1 - share) * rolling) * np.cos(slope) + np.sin(slope)


def slowed(speed, deceleration, distance):
    """The speed after a distance, by the time it takes, and that time."""
    time = 2 * distance / (speed + np.sqrt(speed**2 - 2 * deceleration * distance))
    return speed - deceleration * time, time


@pytest.mark.parametrize(("name", "g", "per_second"), EDITIONS)
def test_a_run_out_over_four_segments_comes_back(name, g, per_second, cells):
    rng, n, long = np.random.default_rng(61), 200, 60 if g > 10 else 18
    before = rng.uniform(1.5, 2.5, n) * long
    speed, given = before, {"f_roll": 0.015, "f_1": rng.uniform(0.6, 0.8, n)}
    for k in (1, 2, 3, 4):
        friction, share, grade = rng.uniform(0.3, 0.9, n), rng.uniform(0.2, 1, n), rng.uniform(-5, 8, n)
        length = rng.uniform(0, 0.1, n) * before**2 / g
        given |= {f"share_1_{k}": share, f"grade_1_{k}": grade}
        given |= {"s_1": length} if k == 1 else {f"s_1_{k}": length}
        if k == 3:
            friction = given["f_1"]  # blank: as the first segment
        else:
            given["f_1" if k == 1 else f"f_1_{k}"] = friction
        speed, _ = slowed(speed, drag(friction, share, 0.015, grade) * g, length)
    given["v_end_1"] = speed * per_second
    result = cells(name, given, ["V1_f", "way_1", "way_2", "check_run_out"])
    np.testing.assert_allclose(result["V1_f"], before, rtol=1e-12)
    assert [result[symbol][0] for symbol in ("way_1", "way_2", "check_run_out")] == [1, 0, 1]


@pytest.mark.parametrize(("name", "g", "per_second"), EDITIONS)
def test_a_speed_that_is_typed_in_takes_the_place_of_the_run_out(name, g, per_second, cells):
    result = cells(name, {"v_after_2": np.array([18.0, 0.0]), "s_2": 1e9, "s_2_2": 5.0}, ["V2_f", "way_2"])
    np.testing.assert_allclose(result["V2_f"], [18.0 / per_second, 0.0], rtol=1e-15)
    assert (result["way_2"] == 2).all()


@pytest.mark.parametrize(("name", "g", "per_second"), EDITIONS)
def test_entries_that_change_nothing_change_nothing(name, g, per_second, cells):
    plain = cells(name, {"f_1": 0.7}, ["V1_f", "way_1"])
    message = cells(
        name, {"f_1": 0.7, "share_1_1": 1.0, "grade_1_1": 0.0, "v_end_1": 0.0, "s_1_3": 0.0}, ["V1_f", "way_1"]
    )
    assert [plain["way_1"].item(), message["way_1"].item()] == [0, 1]
    assert message["V1_f"].item() == pytest.approx(plain["V1_f"].item(), rel=1e-15)


@pytest.mark.parametrize("wrong", [{"share_1_2": 70.0}, {"grade_2_1": -90.0}, {"v_end_1": -3.0}])
def test_a_slip_on_the_sheet_turns_its_check_red(wrong, cells):
    assert cells("momentum", wrong, ["check_run_out"])["check_run_out"].item() == 0


@pytest.mark.parametrize(("name", "g", "per_second"), EDITIONS)
def test_a_skid_before_the_impact_comes_back(name, g, per_second, cells):
    """From the impact backwards in time: the vehicle had been as fast as braking made it slower."""
    rng, n = np.random.default_rng(7), 100
    given = {"f_1": rng.uniform(0.6, 0.9, n), "d_pre_1": rng.uniform(5, 30, n), "t_pre_1": 1.5}
    given |= {"grade_pre_1": rng.uniform(-6, 6, n)}
    wanted = ["V1_i", "Vpre1_kmh" if name.endswith("-si") else "Vpre1_mph", "ahead_1"]
    impact, before, way = cells(name, given, wanted).values()
    end, _ = slowed(before / per_second, drag(given["f_1"], 1, 0, given["grade_pre_1"]) * g, given["d_pre_1"])
    np.testing.assert_allclose(end, np.abs(impact), rtol=1e-10)
    np.testing.assert_allclose(way, before / per_second * 1.5 + given["d_pre_1"], rtol=1e-12)


def test_rows_before_the_impact_are_the_chain_of_two_books(tmp_path):
    """The skid of planar-impact is that of skid.xlsx fed by it, trial by trial, with one friction for both."""
    feeds = {
        "Speed at the end of the skid": "planar-impact.xlsx!Vehicle 1 impact speed",
        "Surface 1 friction": "planar-impact.xlsx!Vehicle 1 post-impact deceleration",
    }
    path = tmp_path / "planar-impact.xlsx"
    path.write_bytes(BOOKS["planar-impact"].read_bytes())
    feeds = read_feeds({mine: f"{tmp_path}/{theirs}" for mine, theirs in feeds.items()})
    from xlmc.excel.workbook.reader import read_workbook

    skid = with_typed(read_workbook(BOOKS["skid-100-ft"]), {"d_1": 60.0})
    chain = simulated(fed(model(skid), feeds), 50_000)
    rows = simulated(model(with_typed(read_workbook(path), {"d_pre_1": 60.0})), 50_000)
    assert np.array_equal(chain.trial_index, rows.trial_index)
    np.testing.assert_allclose(
        chain.forecasts["Speed at the beginning of the skid"],
        rows.forecasts["Vehicle 1 speed before its skid"],
        rtol=1e-12,
    )
    assert "Vehicle 2 speed before its skid" not in rows.forecasts


def test_a_row_with_a_range_is_drawn_and_one_without_a_value_is_none(read):
    book = read("momentum")
    row = named_cells(book)["s_1_2"]
    at = {key: row._replace(column=column) for key, column in (("low", LOW), ("high", HIGH), ("frozen", FROZEN))}
    assert not any("segment" in each.name for each in model(book).assumptions)
    typed = {row: 10.0, at["low"]: 8.0, at["high"]: 12.0, at["frozen"]: False}
    run = simulated(model(with_typed(book, typed)), 5_000)
    drawn = run.inputs["Vehicle 1 run-out, segment 2: length"]
    assert 8 <= drawn.min() < 8.1 < 11.9 < drawn.max() <= 12
    held = model(with_typed(book, {row: 10.0}))
    (result,) = [each for each in held.assumptions if "segment 2" in each.name]
    assert (result.frozen, result.base) == (True, 10.0)
