"""Many frames of a video: least squares of speed and deceleration, with times as measured."""

from __future__ import annotations

import numpy as np
import pytest
from simulated import simulated
from typed_cells import model_of, values_of, with_typed

from xlmc.excel.address import Cell

EDITIONS = [("video-speed", 3600 / 5280, 32.174), ("video-speed-si", 3.6, 9.80665)]


def entered(book, times, positions, typed=None):
    """The book with frames on its sheet Record."""
    cells = {Cell("Record", 6 + i, 2): float(time) for i, time in enumerate(times)}
    cells |= {Cell("Record", 6 + i, 3): float(place) for i, place in enumerate(positions)}
    return with_typed(book, cells | (typed or {}))


def uneven(rng, frames, rate=30):
    """Time stamps of a file whose rate varies, some frames dropped."""
    return np.cumsum(rng.choice([1, 1, 1, 2, 3], frames) / rate * rng.uniform(0.8, 1.2, frames))


@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize(("name", "per_second", "g"), EDITIONS)
def test_speed_and_deceleration_come_back_from_uneven_frames(name, per_second, g, backward, read):
    times = uneven(np.random.default_rng(1), 23)
    t = times - times[0]
    pixels = (20 * t - 0.4 * g * t**2 / 2) / 0.05
    pixels = 900 - pixels if backward else 100 + pixels
    wanted = [f"v_{'kmh' if name.endswith('si') else 'mph'}", f"vend_{'kmh' if name.endswith('si') else 'mph'}"]
    book = entered(read(name), times, pixels, {"scale": 0.05})
    mean, end, slowing, first, sd, holds = values_of(book, [*wanted, "a_fit", "v_first", "rec_sd", "checks_hold"])
    assert first == pytest.approx(20, rel=1e-9)
    assert slowing == pytest.approx(0.4, rel=1e-9)
    assert end == pytest.approx((20 - 0.4 * g * t[-1]) * per_second, rel=1e-9)
    assert mean == pytest.approx((20 - 0.4 * g * t[-1] / 2) * per_second, rel=1e-9)
    assert sd == pytest.approx(0, abs=1e-8)
    assert holds is True


def test_times_as_counted_by_the_mean_rate_would_be_wrong(read):
    """The stamps of a file that dropped frames say another speed at its end than 1/fps does."""
    times = uneven(np.random.default_rng(2), 20)
    t = times - times[0]
    places = 60 * t - 0.5 * 32.174 * t**2 / 2
    right, ratio = values_of(entered(read("video-speed"), times, places), ["v_end", "rec_longest"])
    wrong, even = values_of(entered(read("video-speed"), np.linspace(0, t[-1], 20), places), ["v_end", "rec_longest"])
    assert right == pytest.approx(60 - 0.5 * 32.174 * t[-1], rel=1e-9)
    assert abs(wrong - right) > 1
    assert ratio > 2
    assert even == pytest.approx(1)


def test_a_steady_speed_is_a_straight_line(read):
    times, places = [0.0, 0.1, 0.23, 0.31], [0.0, 4.1, 9.0, 12.6]
    slope, _ = np.polyfit(times, places, 1)
    result = values_of(
        entered(read("video-speed"), times, places, {"bend": 0}), ["v_end", "v_first", "a_fit", "rec_free"]
    )
    assert result == [pytest.approx(slope), pytest.approx(slope), "–", 2]


@pytest.mark.parametrize("typed_error", [True, False], ids=["error typed", "from the scatter"])
def test_ranges_hold_the_truth_as_often_as_they_say(typed_error, read):
    """Of videos with marks off by chance, 80 of 100 central ranges of 80 % hold speed and deceleration."""
    rng, held, videos = np.random.default_rng(3), {"end": 0, "slowing": 0}, 50
    for _ in range(videos):
        times = uneven(rng, 8)
        t = times - times[0]
        places = 50 * t - 0.3 * 32.174 * t**2 / 2 + 0.2 * rng.standard_normal(8)
        given = {"mark_error": 0.2} if typed_error else {}
        held_fixed = {"scale": 1.0}
        run = simulated(model_of(entered(read("video-speed"), times, places, given | held_fixed)), 4_000)
        scale = run.inputs["Many frames: length of one unit of the positions on sheet Record"]
        truth = {"end": (50 - 0.3 * 32.174 * t[-1]) * 3600 / 5280, "slowing": 0.3}
        result = {
            "end": run["Vehicle speed at the last mark"].values / scale,
            "slowing": run["Vehicle deceleration, of many frames"].values / scale,
        }
        for what, values in result.items():
            low, high = np.quantile(values, [0.1, 0.9])
            held[what] += low <= truth[what] <= high
    for what, count in held.items():
        assert abs(count / videos - 0.8) < 4 * np.sqrt(0.8 * 0.2 / videos), what


def test_marks_that_scatter_more_than_their_error_are_said(read):
    rng = np.random.default_rng(4)
    times = np.arange(20) / 30
    places = 50 * times + rng.standard_normal(20)
    assert values_of(entered(read("video-speed"), times, places, {"mark_error": 1.0}), ["check_table"]) == [True]
    assert values_of(entered(read("video-speed"), times, places, {"mark_error": 0.2}), ["check_table"]) == [False]
    gap = {Cell("Record", 10, 3): None}
    assert values_of(with_typed(entered(read("video-speed"), times, places), gap), ["check_table"]) == [False]


def test_without_frames_two_marks_stand(read):
    run = simulated(model_of(read("video-speed")), 2_000)
    assert set(run.forecasts) == {"Vehicle mean speed between the marks", "Vehicle speed at the last mark"}
    assert not [name for name in run.inputs if name.startswith("Many frames")]
