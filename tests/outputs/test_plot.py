from __future__ import annotations

import re
import sys

import numpy as np
import openpyxl
import pytest
from openpyxl.worksheet.table import Table

from xlmc.api import Simulation, load
from xlmc.errors import SimulationError
from xlmc.montecarlo.diagnostics.weighing import Weighting
from xlmc.outputs.histogram import figures_of
from xlmc.outputs.plot import KINDS

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


def test_the_mean_stands_over_the_bars_and_below_the_top(run, figure):
    for axes, drawn, result in zip(figure.axes[::2], figures_of(run), run.results.values(), strict=True):
        [mean] = axes.collections
        [[(x, bottom), (top_x, top)]] = mean.get_segments()
        most = max(drawn.bins.inside + drawn.bins.outside)
        assert x == top_x == pytest.approx(result.mean.value)
        assert (bottom, axes.get_ylim()[0]) == (0.0, 0.0)
        assert most < top < axes.get_ylim()[1]
        assert axes.get_ylim()[1] <= 2.0 * most
        assert axes.get_xlim() == (drawn.bins.edges[0], drawn.bins.upper_edges[-1])
        edges = axes.patches[0].get_data().edges
        assert edges.tolist() == [*drawn.bins.edges, drawn.bins.upper_edges[-1]]
        assert axes.get_ylabel() == f"Trials per {drawn.bins.form.width(drawn.bins.width)} ft"
        assert not axes.texts
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        assert [label.partition(":")[0] for label in labels] == ["other accepted trials", "central 51 %", "mean"]


def test_the_tails_beside_the_central_range_are_marked_on_the_curve(run, figure):
    for axes, drawn in zip(figure.axes[1::2], figures_of(run), strict=True):
        heights = [y for each in axes.collections for segment in each.get_segments() for y in segment[:, 1]]
        assert heights == pytest.approx([24.5, 24.5, 75.5, 75.5])  # of 51 % in the middle
        assert axes.get_ylim() == (0.0, 100.0)
        assert axes.get_xlim() == (drawn.bins.edges[0], drawn.bins.upper_edges[-1])
        assert axes.lines[0].get_data()[1].size == 1001


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


_FORMULAS = {
    "number": ("=A1*3", "General"),
    "date": ("=46000+A1*30", "yyyy-mm-dd"),
    "money": ("=A1*1000", '"$"#,##0'),
    "share": ("=A1/9", "0.0%"),
    "yes or no": ("=A1>0.8", "General"),
    "text": ('=IF(A1>0.8,"late","early")', "General"),
}
"""What a forecast is -> its formula, and the number format of its cell."""

_SHARES_ONLY = {"cumulative": ("yes or no", "text"), "trend": ("yes or no", "text"), "tornado": ("text",)}
_SHARES_ONLY["scatter"] = _SHARES_ONLY["tornado"]


@pytest.fixture(scope="module", params=["even", "weighted"])
def mixed(request, tmp_path_factory):
    """A run with a forecast of each kind, whose trials count alike, or by weights.

    The assumption `A` is uniform on 0 to 1; `B` on 0 to 1 too, and the reading of it is .9.
    """
    book = openpyxl.Workbook()
    model, tables = book.active, book.create_sheet("Tables")
    model.title = "M"
    model["A1"], model["A2"], model["A3"] = 0.6, 0.5, "=A2*1"
    rows = [["Name", "Cell"]]
    for number, (name, (formula, digits)) in enumerate(_FORMULAS.items(), start=1):
        model[f"B{number}"], model[f"B{number}"].number_format = formula.replace("A1", "(A1*0.2+A2*0.8)"), digits
        rows.append([name, f"=M!B{number}"])
    filled = {
        "xlmc_assumptions": [
            ["Name", "Cell", "Distribution", "Low", "High"],
            ["A", "=M!A1", "Uniform", 0, 1],
            ["B", "=M!A2", "Uniform", 0, 1],
        ],
        "xlmc_forecasts": rows,
        "xlmc_evidence": [["Name", "Cell", "Reading", "Error", "Std dev"], ["seen", "=M!A3", 0.9, "normal", 0.05]],
    }
    if request.param == "even":
        del filled["xlmc_evidence"]
    top = 1
    for name, content in filled.items():
        for line in content:
            tables.append(line)
        last = openpyxl.utils.get_column_letter(len(content[0]))
        tables.add_table(Table(displayName=name, ref=f"A{top}:{last}{top + len(content) - 1}"))
        tables.append([])
        top += len(content) + 1
    path = tmp_path_factory.mktemp(request.param) / "book.xlsx"
    book.save(path)
    return load(path).simulate(3_000, seed=1, **({} if request.param == "even" else {"evidence": "weights"}))


@pytest.mark.parametrize("name", _FORMULAS)
@pytest.mark.parametrize("kind", [None, *(kind for kind in KINDS if kind not in ("before-after", "drawing"))])
def test_each_kind_of_picture_shows_each_kind_of_answer_or_says_why_not(mixed, tmp_path, monkeypatch, kind, name):
    leave_out_layout(monkeypatch)
    if name in _SHARES_ONLY.get(kind, ()):
        with pytest.raises(SimulationError, match=rf"{name}.*kind=\"histogram\""):
            mixed.plot(name, kind)
        return
    mixed.plot(name, kind).savefig(tmp_path / "run.png", dpi=30)


@pytest.mark.parametrize(
    ("name", "pattern"),
    [
        ("date", r"20\d\d-\d\d-\d\d"),
        ("money", r"\\\$[\d,]+"),
        ("share", r"[\d.]+ %"),
        ("yes or no", "no|yes"),
        ("text", "early|late"),
    ],
)
def test_numbers_beside_an_axis_have_the_form_of_the_cell(mixed, name, pattern):
    figure = mixed.plot(name, "histogram")
    figure.draw_without_rendering()
    written = [label.get_text() for label in figure.axes[0].get_xticklabels()]
    assert written
    assert all(re.fullmatch(pattern, text) for text in written if text)


def test_dots_of_a_scatter_are_as_the_trials_count(mixed):
    """Their mean is the statistics' own, within its error, whether trials are weighted or not."""
    for name in ("number", "date"):
        dots = np.asarray(mixed.plot(name, "scatter").axes[0].lines[0].get_ydata())
        mean = mixed[name].statistics.mean
        assert abs(dots.mean() - mean.value) < 5.0 * mixed[name].statistics.standard_deviation.value / dots.size**0.5
    assert "rank correlation" in mixed.plot("number", "scatter").axes[0].get_title("left")


def test_what_never_varies_follows_nothing(make):
    run = make.simulate({"A1": 0.3, "B1": "=A1>9"}, [make.uniform("a", "A1", 0.0, 1.0)], [make.forecast("never", "B1")])
    with pytest.raises(SimulationError, match="'never' is the same in all accepted trials"):
        Simulation(run).plot(kind="scatter")


def test_trials_are_drawn_in_proportion_to_their_weights():
    weights = np.array([1.0, 0.0, 0.25, 0.5, 0.25, 1.0] * 50)
    rows = Weighting(weights, 0.5, 1.0).even_rows(weights.size)
    result = np.bincount(rows, minlength=weights.size).reshape(-1, 6).sum(axis=0)
    assert rows.size == int(weights.sum() ** 2 / (weights**2).sum())
    assert result == pytest.approx(rows.size * weights.reshape(-1, 6).sum(axis=0) / weights.sum(), abs=2.0)
    assert not Weighting(np.zeros(3), 0.0, 0.0).even_rows(3).size


def test_the_assumption_that_weights_move_most_is_shown(mixed):
    title = mixed.plot(kind="before-after").axes[0].get_title("left")
    if mixed.weights is not None:
        assert title.startswith("B,")


def test_a_trend_holds_what_shares_an_axis(mixed):
    figure = mixed.plot("money", "trend")
    assert [label.get_text() for label in figure.axes[0].get_xticklabels()] == ["money"]


def test_texts_have_their_names_below_the_bars_and_no_range(mixed):
    [axes] = mixed.plot("text", "histogram").axes
    shares = mixed["text"].categories
    assert [label.get_text() for label in axes.get_xticklabels()] == [*shares]
    [legend] = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend.startswith(next(iter(shares)))
    assert "mean" not in legend
