"""The chart of speed against accuracy: what it shows, on the page and in the workbook."""

from __future__ import annotations

import io
from dataclasses import replace
from itertools import pairwise
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.analysis.studies.methods import recommendation, study
from xlmc.analysis.studies.methods.need import choice
from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.methods import methods_report
from xlmc.outputs.methods.matplotlib_figure import STYLES, draw
from xlmc.outputs.methods.speed_chart import HOW_TO_READ, column_of, picture_of, spread
from xlmc.outputs.study_report import book_parts


@pytest.fixture(scope="module")
def picture(timed):
    return picture_of(timed, "seconds")


def test_no_line_runs_backwards(picture):
    for line in picture.lines:
        across = [each.x for each in line.points]
        assert across == sorted(across)
        ahead = [x for x, _ in line.ahead]
        assert ahead == sorted(ahead)
        assert all(below <= above for (_, above), (_, below) in pairwise(line.ahead))


def test_every_error_has_a_bar_that_holds_it(picture):
    for line in picture.lines:
        for point in line.points:
            assert point.low <= point.y <= point.high
            assert line.once or point.low < point.high


def test_the_words_alone_answer(picture, timed):
    """Which is cheapest at 1 %, at 0.1 %, and which never gets there."""
    result = choice(timed)
    assert [mark.y for mark in picture.marks] == [1.0, pytest.approx(0.1)]
    asked, finer = (" ".join(mark.words) for mark in picture.marks)
    assert asked.startswith("1 %, as asked for; cheapest: ")
    assert result.cheapest[0].method.name in asked
    assert finer.startswith("0.1 %; cheapest: ")
    message = {each.text for each in column_of(picture)}
    assert {"Taylor, first order: never", "Taylor, second order: never"} <= message
    assert any(each.startswith("Recommended: Monte Carlo, ") for each in message)
    assert any(each.startswith("Monte Carlo: 1 % in ") and ", 0.1 % in " in each for each in message)
    assert picture.absent[0].startswith("Monte Carlo, engine formulas is not drawn: 1 % in ")


@pytest.fixture
def straight(sum_of_normals):
    """Of a book without filters, whose forecast is a sum of normals: Taylor's first order is exact."""
    return study(sum_of_normals, reference_trials=1 << 18, trials=1 << 10, replicates=2, patience=0.1)


def test_without_filters_one_panel_alone_says_that_every_trial_is_accepted(straight):
    message = {axis.get_title(loc="left"): [text.get_text() for text in axis.texts] for axis in draw(straight).axes[1:]}
    assert {title for title, texts in message.items() if "every trial is accepted" in texts} == {
        "Accepted share, % of it"
    }


def test_a_method_that_states_no_error_is_never_the_cheapest(straight, timed):
    """Exact or biased: only the reference tells, which costs more than any method."""
    asked = picture_of(straight, "seconds").marks[0]
    cheapest = choice(straight).cheapest[0].method.name
    assert asked.words[1].startswith(f"{cheapest}, ")
    assert not any("Taylor" in words for words in asked.words if "reference" not in words)
    assert "near enough, as the reference shows: Taylor, first order" in asked.words
    assert any(
        "Taylor, first order" in message and "only the reference shows" in message
        for message in recommendation(straight)
    )
    assert not any("Taylor" in words for mark in picture_of(timed, "seconds").marks for words in mark.words)


def test_an_accuracy_in_units_is_drawn_as_a_multiple_of_it(timed):
    picture = picture_of(replace(timed, accuracy=("0.2", 0.2, False)), "evaluations")
    assert picture.upwards == "error of the worst number, over the 0.2 asked for"
    assert picture.across == "evaluations of the workbook in a run"
    assert picture.marks[0].words[0] == "0.2, as asked for; cheapest:"
    assert picture.marks[1].words[0] == "0.02; cheapest:"


def test_lines_are_told_apart_without_colour():
    assert len({(style.marker, style.dashes) for style in STYLES.values()}) == len(STYLES) - 1  # formulas is not drawn


def test_the_figure_has_one_panel_that_answers_and_five_small_ones(timed):
    figure = draw(timed)
    main, *others = figure.axes
    assert [axis.get_title(loc="left") for axis in others] == [
        "Mean", "SD", "Lower end", "Upper end", "Accepted share, % of it",
    ]  # fmt: skip
    assert all(axis.get_legend() is None for axis in figure.axes)
    written = " ".join(text.get_text() for text in main.texts)
    assert "slope −½" in written
    assert "slope −1" in written
    above = " ".join(figure.subfigs[0].get_suptitle().split())
    assert all(message in above for message in HOW_TO_READ)
    assert not draw(timed, words=False).subfigs[0].get_suptitle()


def test_the_workbook_has_the_same_chart(timed, picture):
    with ZipFile(io.BytesIO(package_bytes(book_parts(methods_report(timed, figures=False))))) as package:
        charts = [package.read(name).decode() for name in sorted(package.namelist()) if name.startswith("xl/charts/ch")]
    assert len(charts) == 6
    assert not any("<c:legend>" in chart for chart in charts)
    (main,) = (chart for chart in charts if "<c:errBars>" in chart)
    for each in column_of(picture):
        assert each.brief in main
    for mark in picture.marks:
        assert all(words in main for words in mark.words)


@given(
    st.lists(st.floats(0.0, 1.0), min_size=1, max_size=15).map(lambda result: sorted(result, reverse=True)),
    st.floats(0.01, 0.06),
)
def test_labels_keep_their_order_and_distance(heights, apart):
    result = spread(heights, apart, 0.0, 1.0)
    assert all(above - below > apart - 1e-9 for above, below in pairwise(result))
    assert -1e-9 <= min(result) <= max(result) <= 1.0 + 1e-9
    if len(heights) == 1:
        assert result == pytest.approx(heights)


def test_labels_stay_where_they_have_room():
    assert np.allclose(spread([0.9, 0.5, 0.1], 0.05, 0.0, 1.0), [0.9, 0.5, 0.1])
