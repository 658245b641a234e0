"""The figure of a study: its lines from the numbers of the study, and words that do not lie on each other."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from xlmc.analysis.studies.methods import STATISTICS
from xlmc.outputs.methods.matplotlib_figure import STYLES, _tick, draw, png, svg
from xlmc.outputs.methods.speed_chart import column_of, picture_of


@pytest.fixture(scope="module")
def picture(timed):
    return picture_of(timed, "seconds")


@pytest.fixture(scope="module")
def figure(timed):
    made = draw(timed)
    FigureCanvasAgg(made).draw()
    return made


@pytest.fixture(scope="module")
def drawn(figure):
    """Colour -> the points of the lines of that colour in the large panel."""
    result = {}
    for line in figure.axes[0].lines:
        result.setdefault(line.get_color(), []).append(np.column_stack(line.get_data()))
    return result


def log(values):
    return np.log10(np.array(values, float))


def test_every_method_has_its_line(figure, drawn, picture):
    for line in picture.lines:
        style = STYLES[line.curve.method.key]
        lines = drawn[style.colour]
        measured = np.array([[each.x, each.y] for each in line.points])
        assert any(result.shape == measured.shape and np.allclose(result, measured) for result in lines)
        if line.once:
            level = [[line.points[0].x, line.points[0].y], [picture.frame[1], line.points[0].y]]
            assert any(results.shape == (2, 2) and np.allclose(results, level) for results in lines)
        if line.ahead:
            assert any(answer.shape == (6, 2) and np.allclose(answer, line.ahead) for answer in lines)
    bars = [each for each in figure.axes[0].containers if each.has_yerr]
    assert len(bars) == len(picture.lines)
    for bar, line in zip(bars, picture.lines, strict=True):
        segments = np.array(bar.lines[2][0].get_segments())
        expected = [[max(0.0, min(each.low, each.y)), each.high] for each in line.points]
        assert segments[:, :, 1] == pytest.approx(np.array(expected), rel=1e-9)


def test_levels_guides_and_the_recommended_run(figure, drawn, picture):
    axis = figure.axes[0]
    left, right, bottom, top = picture.frame
    assert axis.get_ylim() == (bottom, top)
    wide = log(right / left)
    assert log(axis.get_xlim()) == pytest.approx([log(left) - 0.36 * wide, log(right) + 0.62 * wide])
    for mark, result in zip(picture.marks, drawn["#B00020"], strict=True):
        assert result == pytest.approx(np.array([[axis.get_xlim()[0], mark.y], [right, mark.y]]))
    slopes = [log(results[1, 1] / results[0, 1]) / log(results[1, 0] / results[0, 0]) for results in drawn["#6B7785"]]
    assert slopes == pytest.approx([-0.5, -1.0])
    (ring,) = (line for line in axis.lines if line.get_markersize() == 15)
    assert tuple(np.ravel(ring.get_data())) == picture.chosen[:2]
    assert ring.get_markerfacecolor() == "none"
    assert tuple(drawn["#1F3044"][0][0]) == picture.chosen[:2]  # where its label leads to
    assert {axis.get_xlabel(), axis.get_ylabel()} == {picture.across, picture.upwards}
    assert all(left * 0.999 <= tick <= right * 1.001 for tick in axis.get_xticks())
    assert len(axis.get_xticks()) > 2


def test_words_do_not_lie_on_each_other(figure, picture):
    axis = figure.axes[0]
    column = [each.text for each in column_of(picture)]
    texts = [text for text in axis.texts if text.get_text() in column]
    assert [text.get_text() for text in texts] == column
    boxes = [text.get_window_extent() for text in texts]
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    levels = [text.xy[1] for text in texts]
    shares = log(levels / np.float64(picture.frame[2])) / log(picture.frame[3] / picture.frame[2])
    assert all(above - below > 0.047 - 1e-9 for above, below in pairwise(shares))
    assert 0.03 - 1e-9 <= shares.min() < shares.max() <= 0.97 + 1e-9
    assert max(box.x1 for box in boxes) <= figure.bbox.x1
    weights = [text.get_fontweight() for text in texts]
    assert weights.count("bold") == 1
    assert texts[weights.index("bold")].get_text() == picture.chosen[2]
    words = {text.get_text() for text in axis.texts}
    assert {"\n".join(mark.words) for mark in picture.marks} <= words


def test_small_panels_show_each_number_against_the_trials(figure, timed):
    for axis, statistic in zip(figure.axes[1:5], STATISTICS, strict=True):
        assert axis.get_title(loc="left") == STATISTICS[statistic]
        lines = {
            line.get_color(): np.column_stack(line.get_data()) for line in axis.lines if line.get_marker() != "None"
        }
        for curve in timed.curves:
            known = [(r.budget, 100 * r.shares[statistic]) for r in curve.lengths if r.shares[statistic] > 0]
            assert lines[STYLES[curve.method.key].colour] == pytest.approx(np.array(known))
        half = np.column_stack(next(line for line in axis.lines if line.get_color() == "#6B7785").get_data())
        assert log(half[1, 1] / half[0, 1]) / log(half[1, 0] / half[0, 0]) == pytest.approx(-0.5)
        below, left = axis.get_ylim()[0], axis.get_xlim()[0]
        assert half[0, 0] == pytest.approx(1.5 * left)
        assert half[1, 1] == pytest.approx(3 * below * 0.5)  # beneath everything, and still inside
    share = figure.axes[5]
    assert share.get_title(loc="left") == "Accepted share, % of it"
    accepted = timed.reference.acceptance.value
    line = next(each for each in share.lines if each.get_color() == STYLES["mc"].colour)
    plain = next(curve for curve in timed.curves if curve.method.key == "mc")
    assert np.column_stack(line.get_data()) == pytest.approx(
        np.array([(r.budget, 100 * r.acceptance.value / accepted) for r in plain.lengths])
    )


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.01, "0.01"),
        (1e-3, "0.001"),
        (9e-4, "10⁻³"),
        (100, "100"),
        (9999, "9999"),
        (1e4, "10⁴"),
        (1e-5, "10⁻⁵"),
        (1e12, "10¹²"),
    ],
)
def test_ticks(value, text):
    assert _tick(value, 0.0).replace(",", "") == text


def test_a_workbook_whose_forecasts_do_not_vary(timed):
    still = replace(timed, reference=replace(timed.reference, widths=dict.fromkeys(timed.reference.widths, 0.0)))
    assert not still.varying
    axis = draw(still).axes[0]
    assert [text.get_text() for text in axis.texts] == ["No forecast varies."]


def test_the_figure_says_what_it_shows(figure, timed):
    below = " ".join(figure.subfigs[1].get_suptitle().split())
    assert f"over up to {timed.replicates} runs and {len(timed.model.forecasts)} forecasts" in below
    assert "Monte Carlo, engine formulas is not drawn" in below
    above = figure.subfigs[0].get_suptitle().splitlines()
    assert above[0] == f"Speed against accuracy: {timed.model.workbook.name}"
    assert max(map(len, [*above, *below.splitlines()][:3])) <= 150


def test_pictures(timed):
    text = svg(timed, "evaluations")
    assert text.startswith("<svg")
    assert text == svg(timed, "evaluations")
    assert png(timed)[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = (int.from_bytes(png(timed)[at : at + 4], "big") for at in (16, 20))
    assert (width, height) == (pytest.approx(12.4 * 130, abs=1), pytest.approx(10.2 * 130, abs=1))
