from __future__ import annotations

import itertools
import math
import re
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.outputs.document.drawings import drawn, scale_of
from xlmc.outputs.document.html_writer import picture_html
from xlmc.outputs.document.parts import Bar, Bars, Chart, Line, Lines

SVG = "{http://www.w3.org/2000/svg}"


def read(drawing):
    return ElementTree.fromstring(drawing.svg)


def bars(*shown, title="T", across="share"):
    return drawn(Chart(title, across, Bars(shown), ", ".join(bar.name for bar in shown)))


def lines(*shown, **options):
    return drawn(Chart("T", "across", Lines(shown, "upwards", **options), "said"))


def texts(root):
    return [node.text for node in root.iter(SVG + "text")]


def test_bars_reach_from_zero_to_their_values():
    root = read(bars(Bar("a", ((0.0, 40.0, "dark"),), (38.0, 42.0)), Bar("b", ((0.0, -20.0, "light"),))))
    first, second = root.iter(SVG + "rect")
    assert float(first.get("width")) == pytest.approx(2 * float(second.get("width")), abs=0.15)
    assert float(second.get("x")) + float(second.get("width")) == pytest.approx(float(first.get("x")), abs=0.15)
    assert first.get("fill") != second.get("fill")
    assert {"T", "share", "a", "b"} <= set(texts(root))


def test_a_tornado_bar_has_two_pieces():
    root = read(bars(Bar("a", ((0.0, -1.0, "light"), (0.0, 2.0, "dark")))))
    low, high = root.iter(SVG + "rect")
    assert float(low.get("x")) < float(high.get("x"))


def test_names_are_escaped_and_cut_where_they_have_no_room():
    evil = "</text><script>alert(1)</script>" + "x" * 60
    chart = Chart(evil, evil, Bars((Bar(evil, ()),)), evil)
    html = picture_html(chart).source
    assert "<script" not in html
    assert ElementTree.fromstring(html).get("aria-label") == evil
    (name,) = [text for text in texts(read(drawn(chart))) if text.endswith("…")]
    assert evil.startswith(name[:-1])


def test_lines_go_through_their_points_and_are_named_beside_them():
    shown = [
        Line("one", ((0.0, 0.0, 0.0), (1.0, 2.0, 0.5))),
        Line("two", ((0.0, 0.0, None), (0.5, math.nan, None), (1.0, -2.0))),
    ]
    root = read(lines(*shown, dots=True, now=0.0))
    paths = [re.findall(r"[ML][\d.]+ [\d.]+", path.get("d")) for path in root.iter(SVG + "path")]
    assert [len(path) for path in paths] == [2, 2]  # the point without a value is left out
    first, second = ([float(part.split(" ")[1]) for part in path] for path in paths)
    assert first[1] < first[0] == second[0] < second[1]
    assert {"one", "two", "across", "upwards"} <= set(texts(root))
    assert len(list(root.iter(SVG + "circle"))) == 4
    assert len([line for line in root.iter(SVG + "line") if line.get("stroke-dasharray")]) == 1


@pytest.mark.parametrize("points", [(), ((0.0, math.nan, None),), ((1.0, 0.0, None),)])
def test_lines_of_nothing_are_drawn(points):
    assert read(lines(Line("a", points), now=1.0)).tag == SVG + "svg"


numbers = st.floats(-1e12, 1e12).filter(lambda x: x == 0 or abs(x) > 1e-12)


@given(st.lists(numbers, min_size=1, max_size=8))
def test_every_value_and_tick_stands_between_the_ends(values):
    scale = scale_of(values, 100.0, 500.0)
    assert all(100.0 - 1e-6 <= scale(value) <= 500.0 + 1e-6 for value in values)
    assert all(100.0 - 1e-6 <= scale(tick) <= 500.0 + 1e-6 for tick in scale.ticks)
    assert 1 <= len(scale.ticks) <= 7


@pytest.mark.parametrize("values", [[], [math.nan], [math.inf, -math.inf], [0.0], [5.0, 5.0]])
def test_what_has_no_width_is_given_one(values):
    scale = scale_of(values, 0.0, 1.0)
    assert scale.low < scale.high
    assert scale.ticks


@pytest.mark.parametrize(
    ("values", "ticks"),
    [
        ([0.0, 71.0], [0.0, 20.0, 40.0, 60.0]),
        ([-0.3, 0.2], [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2]),
        ([0.0, 3e-7], [0.0, 1e-7, 2e-7, 3e-7]),
    ],
)
def test_ticks_are_round(values, ticks):
    assert scale_of(values, 0.0, 1.0).ticks == ticks


def test_it_may_run_upwards():
    scale = scale_of([0.0, 10.0], 200.0, 20.0)
    assert scale(0.0) > scale(5.0) > scale(10.0)


@pytest.mark.parametrize(
    ("values", "form", "texts"),
    [
        ([-0.6, 0.6], Form(), ["−0.5", "0.0", "0.5"]),
        ([242_500.0, 252_500.0], Form(Kind.CURRENCY, '"$"#,##0'), ["$244,000", "$252,000"]),
        ([0.25, 0.4], Form(Kind.PERCENT, "0%"), ["25 %"]),
        ([46_100.0, 46_300.0], Form(Kind.DATE, "yyyy-mm-dd"), ["2026-03-19"]),
        ([0.0, 1.2e12], Form(), ["0", "500,000,000,000"]),
        ([1e-9, 3e-9], Form(), ["1e−09", "1.5e−09"]),
    ],
)
def test_ticks_are_written_in_the_form_of_the_numbers(values, form, texts):
    marks = [text for _, text in scale_of(values, 0.0, 1.0, form=form).marks]
    assert set(texts) <= set(marks)


def test_texts_of_ticks_do_not_overlap():
    scale = scale_of([46_100.0, 46_300.0], 0.0, 300.0, form=Form(Kind.DATE, "yyyy-mm-dd"))
    at = [scale(tick) for tick, _ in scale.apart]
    assert len(at) > 1
    assert min(b - a for a, b in itertools.pairwise(at)) > 5.0 * len("2026-03-31")
