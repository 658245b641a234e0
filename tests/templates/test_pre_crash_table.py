"""A pre-crash table that is pasted as it is: what a braking vehicle made of it comes back."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm
from simulated import simulated
from typed_cells import computed_at, model_of, values_of, with_typed

from xlmc.excel.address import Cell

EDITIONS = [("edr-speed", 3600 / 5280), ("edr-speed-si", 3.6)]
FIRST_ROW = 6
KAPPA, BIAS = 0.12, 0.6


def pasted(book, table, typed=None):
    """The book with rows of time, speed, brake on its sheet Record."""
    cells = {Cell("Record", FIRST_ROW + i, 1 + j): value for i, row in enumerate(table) for j, value in enumerate(row)}
    return with_typed(book, cells | (typed or {}))


def record(step, count, brakes_at, before, rate, words, rounded=0.0):
    """The table of a vehicle that goes on at a speed and slows from a time on: true speeds, and rows as recorded."""
    times = np.round(np.arange(-count + 1, 1) * step, 10)
    true = before - rate * np.maximum(times - brakes_at, 0)
    on = times > brakes_at
    slips = on & (times > times[on].min()) if on.any() else on
    shown = np.where(slips, true * (1 - KAPPA), true - BIAS)
    shown = np.round(shown / rounded) * rounded if rounded else shown
    return true, [[float(t), float(v), words[bool(b)]] for t, v, b in zip(times, shown, on, strict=True)]


@pytest.fixture
def read_off(read):
    """`read_off(name, table, inputs, wanted)`: values of cells with a table pasted, every formula computed."""

    def values(name, table, inputs, wanted):
        return values_of(pasted(read(name), table, inputs), wanted)

    return values


@pytest.mark.parametrize("words", [("Off", "On"), (0, 1)], ids=["words", "digits"])
@pytest.mark.parametrize(("step", "count"), [(0.5, 11), (0.1, 51), (0.05, 101)])
@pytest.mark.parametrize(("name", "per_second"), EDITIONS)
def test_a_vehicle_that_brakes_comes_back(name, per_second, step, count, words, read_off):
    rate, before, brakes_at = 6.5 * per_second, 30.0 * per_second, -2.17 * step * 4
    if step < 0.5:
        brakes_at = -1.717
    true, table = record(step, count, brakes_at, before, rate, words)
    given = {"kappa": KAPPA, "bias": BIAS, "q": 0.0, "tau": 0.04}
    unit = "kmh" if name.endswith("-si") else "mph"
    wanted = [f"vi_{unit}", "a_brake", "x_record", "x_on", "t_braked", "checks_hold", f"v_on_{unit}"]
    speed, slowing, way, braked, time, holds, at_on = read_off(name, table, given, wanted)
    end = before + rate * brakes_at - rate * 0.04
    assert speed == pytest.approx(end, rel=1e-9)
    assert slowing == pytest.approx(rate / per_second, rel=1e-9)
    first_on = next(row[0] for row in table if row[2] == words[1])
    assert time == pytest.approx(0.04 - first_on, abs=1e-12)
    assert 0 <= -brakes_at + 0.04 - time <= step
    assert at_on == pytest.approx(before - rate * (first_on - brakes_at), rel=1e-12)
    # The way is the area under the speed: trapezoids are off by a·step²/8 in the interval in which braking began.
    whole = (before * (brakes_at - table[0][0]) + (before + end) / 2 * (0.04 - brakes_at)) / per_second
    assert way == pytest.approx(whole, abs=rate / per_second * step**2 / 8 + 1e-9)
    since = (at_on + end) / 2 * (0.04 - first_on) / per_second
    assert braked == pytest.approx(since, rel=1e-9)
    assert holds is True
    assert true[0] == before


@pytest.mark.parametrize(("name", "per_second"), EDITIONS)
def test_without_braking_the_last_sample_stands(name, per_second, read_off):
    _, table = record(0.1, 51, 9, 20 * per_second, 1.0, ("Off", "On"))
    unit = "kmh" if name.endswith("-si") else "mph"
    given = {"bias": BIAS, "q": 0.0, "tau": 0.1}
    speed, on, time = read_off(name, table, given, [f"vi_{unit}", "braked", "t_braked"])
    assert (speed, on, time) == (pytest.approx(20 * per_second), 0, "–")


def test_rounding_is_covered_by_the_error_of_the_line(read):
    """Records rounded to whole km/h: the true speed is off by the share of one sample's error that the line leaves."""
    rng, records = np.random.default_rng(3), 200
    before, rate, begun = (rng.uniform(*ends, records) for ends in ((80, 110), (20, 28), (1.2, 1.9)))
    tables = [record(0.1, 51, -begun[i], before[i], rate[i], (0.0, 1.0), rounded=1.0)[1] for i in range(records)]
    varies = {
        Cell("Record", FIRST_ROW + row, 1 + column): [table[row][column] for table in tables]
        for row in range(51)
        for column in (1, 2)
    }
    book = pasted(read("edr-speed-si"), tables[0], {"kappa": KAPPA, "bias": BIAS, "q": 0.0, "tau": 0.0})
    result = computed_at(book, varies, ["vi_kmh", "rec_share"])
    share = result["rec_share"]
    assert np.max(share) < 0.7
    off = (result["vi_kmh"] - (before - rate * begun)) * (1 - KAPPA) / (share / np.sqrt(12))
    assert 0.7 < np.std(off) < 1.3
    assert abs(np.mean(off)) < 4 / np.sqrt(records)


def test_the_table_is_run_and_its_answers_wait_without_it(read):
    book = read("edr-speed")
    free = simulated(model_of(book), 2_000)
    waiting = ["Vehicle way from the first sample to the impact", "Vehicle time from brake on to the impact, at least"]
    assert not set(waiting) & set(free.forecasts)
    _, table = record(0.1, 51, -1.717, 60, 15.0, ("Off", "On"), rounded=1.0)
    run = simulated(model_of(pasted(book, table)), 2_000)
    assert set(waiting) < set(run.forecasts)
    assert run.results["Vehicle speed at the impact"].standard_deviation.value > 0


REPORT = (
    "Times (sec)",
    "Accelerator Pedal, % Full (%)",
    "Service Brake (On, Off)",
    "Engine RPM (Combined)",
    "ABS Activity (Engaged, Non Engaged)",
    "Speed, Vehicle Indicated ({units})",
)


def as_printed(table, units, written):
    """The rows of `record` as a report prints them: other columns, other order, texts."""
    rows = [(REPORT[0], *REPORT[1:-1], REPORT[-1].format(units=units))]
    for time, speed, brake in table:
        pressed = 0 if brake == "On" else 12.5
        rows.append((f"{time:.2f} ".replace("-", "−"), pressed, brake, 1800, "Non Engaged", written(speed)))
    return rows


@pytest.mark.parametrize(
    ("name", "units", "written"),
    [
        ("edr-speed", "MPH [km/h]", lambda v: f"{v:.4f} [{v * 1.609344:.4f}]"),
        ("edr-speed-si", "MPH [km/h]", lambda v: f"{v / 1.609344:.6f} [{v:.6f}]"),
        ("edr-speed-si", "km/h [mph]", lambda v: f"{v:.6f} [{v / 1.609344:.6f}]"),
        ("edr-speed", "mph", lambda v: v),
    ],
)
def test_the_table_of_a_report_is_read_as_it_is_printed(name, units, written, read):
    per_second = dict(EDITIONS)[name]
    _, plain = record(0.5, 11, -1.717, 28 * per_second, 6 * per_second, ("Off", "On"))
    printed = as_printed(plain, units, written)
    cells = {Cell("Record", FIRST_ROW - 1 + i, 1 + j): v for i, row in enumerate(printed) for j, v in enumerate(row)}
    unit = "kmh" if name.endswith("-si") else "mph"
    wanted = [f"vi_{unit}", "a_brake", "x_record", "t_braked", "t_released", "checks_hold"]
    given = {"kappa": KAPPA, "bias": BIAS, "q": 0.0, "tau": 0.04}
    result = values_of(with_typed(read(name), cells | given), wanted)
    alone = values_of(pasted(read(name), plain, given), wanted)
    assert result[:4] == pytest.approx(alone[:4], rel=1e-6)
    released = max(time for time, _, brake in plain if brake == "Off")
    assert result[4:] == [pytest.approx(0.04 - released), True]


@pytest.mark.parametrize(
    "spoilt",
    [{(-1, 5): "Speed (km/h)"}, {(-1, 2): "Clutch"}, {(3, 5): "n/a"}, {(3, 0): "data not available"}],
    ids=["another unit", "no brake", "no number", "no time"],
)
def test_a_table_that_cannot_be_read_is_said(spoilt, read):
    _, plain = record(0.5, 11, -1.717, 50, 12, ("Off", "On"))
    printed = as_printed(plain, "mph", lambda v: v)
    cells = {Cell("Record", FIRST_ROW - 1 + i, 1 + j): v for i, row in enumerate(printed) for j, v in enumerate(row)}
    assert values_of(with_typed(read("edr-speed"), cells), ["check_table"]) == [True]
    cells |= {Cell("Record", FIRST_ROW + row, 1 + column): value for (row, column), value in spoilt.items()}
    assert values_of(with_typed(read("edr-speed"), cells), ["check_table"]) == [False]


@pytest.mark.parametrize(("name", "per_second"), EDITIONS)
def test_speeds_at_further_events_follow_from_each_delta_v(name, per_second, read):
    g = 9.80665 if name.endswith("-si") else 32.174
    unit = "kmh" if name.endswith("-si") else "mph"
    events = {"dv_1st": -4.0 * per_second, "t_2nd": 0.8, "f_2nd": 0.3, "dv_2nd": -9.0 * per_second, "t_3rd": 1.5}
    given = events | {"g": g, "tau": 0.0, "f": 0.1, "q": 0.0, "kappa": 0.0, "v_last": 30 * per_second}
    wanted = [f"vi_{unit}", f"v_2nd_{unit}", f"v_3rd_{unit}"]
    first, second, third = values_of(with_typed(read(name), given), wanted)
    assert first == pytest.approx(30 * per_second)
    assert second == pytest.approx((26 - 0.3 * g * 0.8) * per_second)
    assert third == pytest.approx(second - 9 * per_second)
    assert values_of(read(name), wanted[1:]) == ["–", "–"]
    run = simulated(model_of(with_typed(read(name), given)), 4_000)
    waits = ["Vehicle speed at the second event", "Vehicle speed at the third event"]
    assert set(waits) < set(run.forecasts)
    drawn = run.prior["Recorded delta-V over the true one"]
    assert (drawn.min(), drawn.max()) == (pytest.approx(0.9, abs=1e-3), pytest.approx(1.1, abs=1e-3))
    assert not set(waits) & set(simulated(model_of(read(name)), 1_000).forecasts)


def test_a_recorded_delta_v_is_evidence_of_the_speed(read):
    """It keeps the trials whose speed gives it; cut off, those whose speed gives it or more."""
    scene = {"w_own": 3500.0, "w_other": 4000.0, "v_other": 5.0}
    book = with_typed(read("edr-speed"), scene)
    (whole, cut) = (row for row in range(6, 12) if "delta-V" in str(book.sheets["Evidence"].cells.get((row, 1))))
    free = simulated(model_of(with_typed(book, {Cell("Evidence", cut, 4): -100.0})), 20_000)
    assert free.accepted == 20_000
    speed, e = free["Vehicle speed at the impact"].values, free.inputs["Restitution, along one line"]
    gives = (speed - 5) * (1 + e) / (1 + 3500 / 4000)
    kept = simulated(model_of(with_typed(book, {Cell("Evidence", whole, 4): 22.0})), 20_000)
    np.testing.assert_array_equal(
        kept.trial_index, free.trial_index[(gives >= (22 - 0.31) / 1.1) & (gives <= (22 + 0.31) / 0.9)]
    )
    low = simulated(model_of(with_typed(book, {Cell("Evidence", cut, 4): 22.0})), 20_000)
    np.testing.assert_array_equal(low.trial_index, free.trial_index[gives >= (22 - 0.31) / 1.1])
    assert 0 < kept.accepted < low.accepted < free.accepted
    blank = {Cell("Evidence", cut, column): None for column in (8, 9)}
    soft = with_typed(book, {Cell("Evidence", cut, 4): 22.0, Cell("Evidence", cut, 7): 1.0} | blank)
    tail = simulated(model_of(soft), 20_000, evidence="rejection")
    chance = norm.cdf(gives - 22)
    assert abs(tail.accepted - chance.sum()) < 4 * np.sqrt(np.sum(chance * (1 - chance)))
