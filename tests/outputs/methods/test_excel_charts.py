"""The charts in the workbook: their points, from a closed form where there is one, and what they look like."""

from __future__ import annotations

import io
import re
from itertools import pairwise
from zipfile import ZipFile

import numpy as np
import openpyxl
import pytest

from xlmc.analysis.studies.methods import STATISTICS
from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.methods import methods_report
from xlmc.outputs.methods.matplotlib_figure import STYLES
from xlmc.outputs.methods.speed_chart import column_of, guides_of, picture_of
from xlmc.outputs.study_report import book_parts


@pytest.fixture(scope="module")
def data(timed):
    return package_bytes(book_parts(methods_report(timed, figures=False)))


@pytest.fixture(scope="module")
def book(data):
    return openpyxl.load_workbook(io.BytesIO(data))


@pytest.fixture(scope="module")
def charts(data):
    with ZipFile(io.BytesIO(data)) as package:
        parts = [package.read(f"xl/charts/chart{n}.xml").decode() for n in range(1, 7)]
        drawing = package.read("xl/drawings/drawing1.xml").decode()
    return parts, drawing


@pytest.fixture(scope="module")
def picture(timed):
    return picture_of(timed, "seconds")


@pytest.fixture(scope="module")
def series(book):
    """Name -> the points of each series of that name, in order."""
    result = {}
    for name, *point in book["Chart data"].iter_rows(min_row=5, values_only=True):
        result.setdefault(name, []).append([each for each in point if each is not None])
    return result


SYMBOLS = {
    "v": "dash",
    "o": "circle",
    "s": "square",
    "^": "triangle",
    "D": "diamond",
    "P": "plus",
    "X": "x",
    "*": "star",
}
DASHES = {"mc": "solid", "mc/jit": "solid", "lhs": "dash", "sobol": "sysDot", "grid": "dashDot", "surrogate": "dashDot"}


def log(values):
    return np.log10(np.array(values, float))


def test_measured_points_stand_with_their_bars(series, picture):
    for line in picture.lines:
        points = series[line.name][: len(line.points)]
        for (x, y, down, up), point in zip(points, line.points, strict=True):
            assert (x, y) == (point.x, point.y)
            assert (down, up) == (
                pytest.approx(max(point.y - point.low, 0.0)),
                pytest.approx(max(point.high - point.y, 0.0)),
            )
        more = series[line.name][len(line.points) :]
        if line.once:
            assert more == [[line.points[0].x, line.points[0].y], [picture.frame[1], line.points[0].y]]
        if line.ahead and not line.once:
            assert series[f"{line.name}, carried on"] == [list(each) for each in line.ahead]


def test_level_lines_and_their_words(series, picture):
    left, right, bottom, top = picture.frame
    bottom = 10.0 ** np.floor(log(bottom) + 1e-9)
    start = left / 10.0 ** np.ceil(0.3 * log(right / left))
    for mark in picture.marks:
        (first, second, *_), words = series[mark.words[0]], mark.words
        assert first == pytest.approx([start, mark.y])
        assert second == pytest.approx([right, mark.y])
        heights = [log(series[each][-1][1] / mark.y) / log(top / bottom) for each in words]
        steps = [above - below for above, below in pairwise(heights)]  # from the top line of words down
        assert steps == pytest.approx([0.033] * len(steps))
        assert heights[-1] == pytest.approx(0.022)
        assert [series[each][-1][0] for each in words] == pytest.approx([start] * len(words))


@pytest.mark.parametrize(("text", "slope"), [("slope −½: four times the work, half the error", -0.5), ("slope −1", -1)])
def test_guides_fall_as_they_say(series, picture, text, slope):
    (x0, y0), (x1, y1) = series[text][:2]
    assert log(y1 / y0) / log(x1 / x0) == pytest.approx(slope)
    high, fall = guides_of(picture, 10.0 ** np.floor(log(picture.frame[2]) + 1e-9))
    assert y0 == pytest.approx(high)
    assert log(y0 / y1) == pytest.approx(fall)
    left, right = picture.frame[:2]
    assert log(x0) == pytest.approx(log(left) - np.ceil(0.3 * log(right / left)) + 0.15)


def test_a_ring_stands_about_the_recommended_run(series, picture):
    x, y, text = picture.chosen
    ring = np.array([each for each in series[text] if len(each) == 2][:25])
    across, upwards = log(ring[:, 0] / x), log(ring[:, 1] / y)
    assert ((across / across.max()) ** 2 + (upwards / upwards.max()) ** 2) == pytest.approx(np.ones(25))
    assert ring[0] == pytest.approx(ring[-1])
    left, right, bottom, top = picture.frame
    wide, high = log(right / left), log(top / (10.0 ** np.floor(log(bottom) + 1e-9)))
    pixels = 1180 * across.max() / (wide + np.ceil(0.3 * wide) + np.ceil(0.55 * wide)), 640 * upwards.max() / high
    assert pixels == (pytest.approx(11.0), pytest.approx(11.0))  # round on the screen


def test_labels_stand_in_a_column_apart_and_lead_to_their_lines(series, picture):
    left, right, bottom, top = picture.frame
    bottom = 10.0 ** np.floor(log(bottom) + 1e-9)
    ends = []
    for each in column_of(picture):
        leader = [point for point in series[each.brief] if len(point) == 2][-4:]
        assert leader[0] == pytest.approx([each.x, each.y])
        assert leader[1][0] == pytest.approx(right)
        assert leader[2] == pytest.approx(leader[3])  # where the words stand
        assert leader[1][1] == leader[2][1]
        assert leader[2][0] == pytest.approx(right * 10.0 ** (0.04 * log(right / left)))
        ends.append(log(leader[2][1] / bottom) / log(top / bottom))
    assert all(above - below > 0.052 - 1e-9 for above, below in pairwise(ends))
    assert 0.03 - 1e-9 <= min(ends) < max(ends) <= 0.92 + 1e-9
    heading = series[picture.brief][0]
    assert log(heading[1] / bottom) / log(top / bottom) == pytest.approx(0.975)


def test_lines_look_as_in_the_figure(charts, picture):
    (main, *_), _ = charts
    for line in picture.lines:
        style = STYLES[line.curve.method.key]
        part = next(each for each in main.split("<c:ser>") if f"<c:v>{line.name}</c:v>" in each.partition("</c:tx>")[0])
        marker = part.partition("<c:marker>")[2].partition("</c:marker>")[0]
        assert f'<c:symbol val="{SYMBOLS[style.marker]}"/>' in marker
        assert set(re.findall(r'srgbClr val="(\w+)"', marker)) == {style.colour[1:]}
        assert ("<c:errBars>" in part) is not line.once
        drawn = part.partition("</c:spPr>")[0]
        assert re.findall(r'prstDash val="(\w+)"', drawn) == ([] if line.once else [DASHES[line.curve.method.key]])


def test_axes_are_decades_that_hold_all(charts, picture, series):
    (main, *_), _ = charts
    left, right, bottom, top = picture.frame
    wide = log(right / left)
    ends = [float(each) for each in re.findall(r'<c:(?:max|min) val="([^"]+)"', main)]
    expected = [right * 10 ** np.ceil(0.55 * wide), left / 10 ** np.ceil(0.3 * wide)]
    expected += [top, 10.0 ** np.floor(log(bottom) + 1e-9)]
    assert ends == pytest.approx(expected)
    assert len(re.findall(r'<c:logBase val="10"/>', main)) == 2
    points = [point for result in series.values() for point in result]
    assert all(
        expected[1] * 0.999 <= x <= expected[0] and expected[3] * 0.99 <= y <= top * 1.001 for x, y, *_ in points
    )


def test_small_charts_draw_the_errors_of_the_sheet_of_runs(charts, book, timed):
    (_, *small), drawing = charts
    titles = [*(f"{name}, % of the 5–95 % range" for name in STATISTICS.values()), "Accepted share, % of it"]
    for number, part in enumerate(small):
        letter = "FGHIJ"[number]
        references = set(re.findall(r"<c:f>Runs!\$([A-Z]+)\$\d+:\$[A-Z]+\$\d+</c:f>", part))
        assert references == {"B", letter}
        named = re.search(r"<a:t>([^<]*)</a:t>", part)[1]
        assert named == titles[number]
        assert part.count("<c:ser>") == len([curve for curve in timed.curves if curve.answers])
    places = re.findall(r"<xdr:from><xdr:col>(\d+)</xdr:col><xdr:colOff>(\d+)</xdr:colOff><xdr:row>(\d+)", drawing)
    rows = [int(row) for *_, row in places]
    assert rows == [rows[0]] + [rows[0] + 29] * 5  # below the large one
    ends = re.findall(r"<xdr:to><xdr:col>(\d+)</xdr:col><xdr:colOff>(\d+)</xdr:colOff>", drawing)
    assert [(column, offset) for column, offset, _ in places[2:]] == ends[1:5]  # side by side


def test_runs_are_written_as_numbers(book, timed):
    sheet = book["Runs"]
    heads = [cell.value for cell in sheet[4]]
    rows = [dict(zip(heads, row, strict=False)) for row in sheet.iter_rows(min_row=5, values_only=True) if row[0]]
    expected = [(curve, runs) for curve in timed.every if curve.answers for runs in curve.lengths]
    assert len(rows) == len(expected) + 1
    accepted = timed.reference.acceptance
    for row, (curve, runs) in zip(rows[:-1], expected, strict=True):
        assert row["Method"] == curve.method.name
        assert row["Trials"] == (None if curve in timed.once else runs.budget)
        assert row["Time, s"] == pytest.approx(runs.seconds)
        assert row["Evaluations"] == pytest.approx(runs.evaluations)
        assert row["Runs"] == max(each.n for each in runs.errors.values())
        for each, name in STATISTICS.items():
            share = 100.0 * runs.shares[each]
            assert row[f"{name}, % of 5–95 %"] == (pytest.approx(share) if np.isfinite(share) else None)
        shown = None if runs.acceptance is None else 100.0 * runs.acceptance.value / accepted.value
        assert row["Accepted, % of it"] == (None if shown is None else pytest.approx(shown))
        assert row["Failed runs"] == runs.failed
        assert row["Measured"] == ("yes" if runs.measured else "by rate")
    own = rows[-1]
    assert own["Method"] == "The reference's own error"
    assert own["Accepted, % of it"] == pytest.approx(100.0 * accepted.error / accepted.value)
    widths = [round(sheet.column_dimensions[column].width) for column in "ABC"]
    assert widths == [35, 13, 9]
