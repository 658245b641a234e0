from __future__ import annotations

import sys

import numpy as np
import pytest

from xlmc.api import Simulation
from xlmc.errors import SimulationError
from xlmc.outputs.histogram import figures_of

pytest.importorskip("matplotlib")


def leave_out_layout(patch):
    """Have the parts of pictures stand where they happen to, which takes half the time."""
    patch.setattr("matplotlib.layout_engine.ConstrainedLayoutEngine.execute", lambda *_: None)


@pytest.fixture(scope="module")
def figure(run):
    return Simulation(run).plot()


def test_every_forecast_has_a_histogram_and_a_cumulative_curve(run, figure):
    assert [axes.get_title("left") for axes in figure.axes] == ["area", "Cumulative", "difference", "Cumulative"]
    assert [axes.get_xlabel() for axes in figure.axes] == ["ft"] * 4
    assert f"{run.accepted:,} of {run.trials:,} trials accepted" in figure.get_suptitle()


def test_the_bars_are_those_of_the_sheets(run, figure):
    for axes, drawn in zip(figure.axes[::2], figures_of(run), strict=True):
        whole, inside = (patch.get_data().values for patch in axes.patches)
        assert np.array_equal(inside, drawn.bins.inside)
        assert np.array_equal(whole, drawn.bins.inside + drawn.bins.outside)


def test_the_curve_and_the_shade_are_the_runs(run, figure):
    for axes, result in zip(figure.axes[1::2], run.results.values(), strict=True):
        values, share = axes.lines[0].get_data()
        for percent, estimate in result.statistics.percentiles.items():
            index = round(10 * percent)
            assert (values[index], share[index]) == pytest.approx((estimate.value, percent), rel=1e-12)
        low, high = result.central()
        [shade] = axes.patches
        assert (shade.get_x(), shade.get_x() + shade.get_width()) == pytest.approx((low.value, high.value))


def test_the_threshold_is_marked(figure):
    assert [text.get_text() for text in figure.axes[1].get_legend().get_texts()] == ["threshold 16"]
    assert figure.axes[3].get_legend() is None


def test_it_can_be_written(figure, tmp_path, monkeypatch):
    for ending in ("png", "svg"):
        figure.savefig(tmp_path / f"run.{ending}", dpi=50)
        assert (tmp_path / f"run.{ending}").stat().st_size > 10_000
        leave_out_layout(monkeypatch)


def test_it_opens_no_window_and_leaves_nothing_behind(run):
    Simulation(run).plot()
    assert "matplotlib.pyplot" not in sys.modules or not sys.modules["matplotlib.pyplot"].get_fignums()


def test_names_and_units_are_taken_as_they_are(make, tmp_path):
    r"""A dollar sign would begin a formula of matplotlib's, and a `\frac` without an end raise an error."""
    cells = {"A1": 0.5, "B1": "=A1*2"}
    forecast = make.forecast(r"cost $\frac " + "long " * 30, "B1", units="$/$", threshold=1.0)
    figure = Simulation(make.simulate(cells, [make.uniform("a", "A1", 0.0, 1.0)], [forecast])).plot()
    figure.savefig(tmp_path / "run.png", dpi=30)
    assert figure.axes[0].get_title("left").endswith("…")


@pytest.mark.parametrize("formula", ["=A1*0+3", "=ROUND(A1*9,0)", "=1/(A1-0.5)^9", "=1E100*A1"])
def test_odd_forecasts_are_drawn_without_a_warning(make, tmp_path, monkeypatch, formula):
    leave_out_layout(monkeypatch)
    run = make.simulate(
        {"A1": 0.3, "B1": formula}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("x", "B1", threshold=5.0)]
    )
    Simulation(run).plot().savefig(tmp_path / "run.png", dpi=30)


def test_nothing_to_draw_is_a_message(none_accepted):
    with pytest.raises(SimulationError, match="nothing to draw"):
        Simulation(none_accepted).plot()


def test_without_matplotlib_it_is_a_message(run, monkeypatch):
    monkeypatch.setattr("xlmc.outputs.plot.find_spec", lambda name: None)
    with pytest.raises(SimulationError, match=r"need matplotlib, which is not installed.*pip install \"matplotlib"):
        Simulation(run).plot()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("ends", [(-1.7e8, 1.7e8), (1e8, 1.7e8), (-1e6, 1e6)])
def test_numbers_that_span_all_doubles_are_drawn(make, tmp_path, monkeypatch, ends):
    if ends != (-1.7e8, 1.7e8):  # which has the widest labels
        leave_out_layout(monkeypatch)
    run = make.simulate({"A1": 0.0, "B1": "=A1*1E300"}, [make.uniform("x", "A1", *ends)], [make.forecast("vast", "B1")])
    Simulation(run).plot().savefig(tmp_path / "run.png", dpi=50)
    assert (tmp_path / "run.png").stat().st_size > 10_000
    assert np.isfinite(run["vast"].statistics.mode.value)
