"""Rows that wait until they are needed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from simulated import simulated
from typed_cells import with_typed

from templates.writer.cached import computed

TURNING = ("momentum", "planar-impact")


@pytest.mark.parametrize("name", TURNING)
def test_the_turn_limits_speed_once_its_radius_is_entered(name, typed, run_of):
    off = run_of(name)
    on = simulated(typed(name, {"R_turn_2": 5.0}), 20_000)
    limit = math.sqrt(0.95 * 32.174 * 5.0) * 3600 / 5280
    assert off["Vehicle 2 impact speed"].values.max() > limit
    assert 0 < on.accepted < off.accepted
    assert on["Vehicle 2 impact speed"].values.max() <= limit
    kept = off["Vehicle 2 impact speed"].values <= limit
    np.testing.assert_array_equal(on["Vehicle 2 impact speed"].values, off["Vehicle 2 impact speed"].values[kept])


@pytest.mark.parametrize("name", TURNING)
def test_duration_gives_mean_acceleration_and_the_neglected_impulse(name, cells, shown):
    assert shown(name)["dV_tyres_1"] == "–"
    given = {"t_impact": 0.1, "f_1": 0.8}
    result = cells(name, given, ["dV_tyres_1", "a_mean_1", "dV_1", "share_tyres_1"])
    assert result["dV_tyres_1"].item() == pytest.approx(1.8, abs=0.05)  # DOMAIN: about 1.8 mph for 0.1 s at 0.8
    assert result["a_mean_1"].item() == pytest.approx(result["dV_1"].item() / 0.1 / 32.174, rel=1e-12)
    assert result["share_tyres_1"].item() == pytest.approx(100 * 0.8 * 32.174 * 0.1 / result["dV_1"].item(), rel=1e-12)


@pytest.mark.parametrize("name", [*TURNING, "planar-forward"])
@pytest.mark.parametrize(
    ("friction", "duration", "message"), [(0.8, None, True), (0.01, None, False), (0.8, 0.001, False)]
)
def test_tyres_that_matter_are_named_without_a_duration_too(name, friction, duration, message, read):
    """By 0.1 s of contact; on sheet Inputs beside the checks."""
    given = {"f_1": friction, "f_2": friction} | ({} if duration is None else {"t_impact": duration})
    slow = {"w_1": 4000.0} if name == "planar-forward" else {"s_1": 4.0, "s_2": 4.0}
    done = computed(with_typed(read(name), given | slow))
    status = done["Inputs", 2, 0]
    assert ("use a model that keeps them" in status) == message
    assert ("in 0.10 s" in status) == message


@pytest.mark.parametrize("name", [*TURNING, "momentum-energy"])
def test_stuck_together_is_one_switch(name, cells):
    """The same as typing the departure of vehicle 1 for vehicle 2, too, whatever the row of vehicle 2 says."""
    wanted = ["V1_i", "V2_i", "dV_1", "E_after"]
    first = {"beta_1": 200, "s_1": 21, "f_1": 0.7}
    other = {"beta_2": 170, "s_2": 60, "f_2": 0.9}
    switched = cells(name, first | other | {"together": 1}, wanted)
    typed = cells(name, first | {symbol[:-1] + "2": value for symbol, value in first.items()}, wanted)
    left_alone = cells(name, first | other, wanted)
    for symbol in wanted:
        np.testing.assert_array_equal(switched[symbol], typed[symbol])
        assert switched[symbol] != left_alone[symbol]


@pytest.mark.parametrize("name", TURNING)
def test_the_shared_road_is_ready_and_off(name, model_of):
    [row] = model_of(name).definitions.correlations
    assert (row.first, row.second) == ("Vehicle 1 post-impact deceleration", "Vehicle 2 post-impact deceleration")
    assert row.value == 0


def test_the_case_study_asks_for_the_papers_forecasts_and_filters_and_no_more(model_of):
    model = model_of("intersection")
    assert len(model.forecasts) == 4
    assert len(model.filters) == 3
    assert not model.definitions.correlations
    assert len(model.live) == 17


@pytest.mark.parametrize("name", TURNING)
def test_directions_of_force_are_reported_every_way(name, shown):
    base = shown(name)
    assert base["PDOF2_cw"] == pytest.approx(-base["PDOF_2"] % 360)
    assert base["PDOF2_clock"] == 9  # struck on its left
    assert 80 < base["PDOF_2"] < 95
