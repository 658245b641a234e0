"""Where things stand in the drawings: dots and bars at their numbers, on one scale, names beside their lines."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest

from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.outputs.document.colours import COLOURS
from xlmc.outputs.document.drawings import drawn
from xlmc.outputs.document.parts import Bar, Bars, Chart, Line, Lines, Shape

NAME = "{http://www.w3.org/2000/svg}"
SHAPE = Shape((0.0, 1.0, 3.0, 4.0), (0.5, 0.25, 0.0), (0.1, 1.0, 0.2))


def read(chart):
    """The elements of a drawing, each with its attributes as numbers where they are numbers."""
    root = ElementTree.fromstring(drawn(chart).svg)
    result = SimpleNamespace(width=float(root.get("width")), height=float(root.get("height")))
    for kind in ("rect", "circle", "line", "path", "text"):
        setattr(result, kind, [{**numbers(each.attrib), "said": each.text} for each in root.iter(f"{NAME}{kind}")])
    return result


def numbers(attributes):
    return {key: float(value) if re.fullmatch(r"-?[\d.]+", value) else value for key, value in attributes.items()}


def points(path):
    return np.array([float(each) for each in re.findall(r"-?\d+(?:\.\d+)?", path["d"])]).reshape(-1, 2)


def is_affine(values, places):
    slope, start = np.polyfit(values, places, 1)
    return slope if np.allclose(np.array(values) * slope + start, places, atol=0.02) else None


def test_a_shape_has_bars_and_an_outline_on_one_scale():
    result = read(Chart("", "", SHAPE, "said"))
    bars = result.rect
    assert [(each["x"], each["width"]) for each in bars] == [(1.0, 37.0), (38.0, 74.0), (112.0, 37.0)]
    assert [each["height"] for each in bars] == pytest.approx([16.0, 8.0, 0.0])  # of 32 for the most
    assert {each["y"] + each["height"] for each in bars} == {34.0}
    (outline,) = result.path
    heights = [34.0, *np.repeat([34.0 - 3.2, 2.0, 34.0 - 6.4], 2), 34.0]
    assert points(outline) == pytest.approx(
        np.column_stack([[1.0, 1.0, 38.0, 38.0, 112.0, 112.0, 149.0, 149.0], heights])
    )
    assert [(each["said"], each["x"], each["text-anchor"]) for each in result.text] == [
        ("0", 1.0, "start"),
        ("4", 149.0, "end"),
    ]
    assert {each["y"] for each in result.text} == {46.0}
    assert (result.width, result.height) == (150.0, 48.0)
    (ground,) = result.line
    assert (ground["x1"], ground["x2"], ground["y1"], ground["y2"]) == (1.0, 149.0, 34.0, 34.0)


def test_a_shape_of_nothing_and_one_of_percentages():
    assert {each["height"] for each in read(Chart("", "", Shape((0.0, 1.0), (0.0,), (0.0,)), "said")).rect} == {0.0}
    shown = Shape((0.25, 0.5), (1.0,), (1.0,), Form(Kind.PERCENT))
    assert [each["said"] for each in read(Chart("", "", shown, "said")).text] == ["25 %", "50 %"]


TWO = Lines(
    (
        Line("first", ((0.0, 1.0, 0.5), (2.0, 3.0, 0.0), (4.0, 2.0, None))),
        Line("second", ((0.0, 2.0), (4.0, math.nan))),
    ),
    "height, m",
    dots=True,
    now=1.0,
)


def test_dots_stand_at_their_numbers_with_their_errors():
    result = read(Chart("", "width, m", TWO, "said"))
    assert [each["r"] for each in result.circle] == [2.5] * 4  # none for the point that is no number
    x, y = [0.0, 2.0, 4.0, 0.0], [1.0, 3.0, 2.0, 2.0]
    across = is_affine(x, [each["cx"] for each in result.circle])
    up = is_affine(y, [each["cy"] for each in result.circle])
    assert across > 0 > up
    first = result.circle[0]
    (bar,) = [each for each in result.line if each["x1"] == each["x2"] == first["cx"]]
    assert sorted((bar["y1"], bar["y2"])) == pytest.approx([first["cy"] + 0.5 * up, first["cy"] - 0.5 * up], abs=0.02)
    (now,) = [each for each in result.line if each.get("stroke-dasharray")]
    assert now["x1"] == now["x2"] == pytest.approx(first["cx"] + across, abs=0.02)
    assert [each["fill"] for each in result.circle] == [COLOURS[0]] * 3 + [COLOURS[1]]
    for path, dots in zip(result.path, (result.circle[:3], result.circle[3:]), strict=True):
        assert points(path) == pytest.approx(np.array([[each["cx"], each["cy"]] for each in dots]), abs=0.06)
    grid = [each for each in result.line if each["y1"] == each["y2"] and each["x2"] == 420.0]
    assert max(each["y1"] for each in grid) == 250.0
    assert min(each["cy"] for each in result.circle) >= 10.0
    assert result.height == 292.0


def test_names_stand_beside_their_lines_and_numbers_at_their_ticks():
    result = read(Chart("T", "width, m", TWO, "said"))
    names = [each for each in result.text if each["said"] in ("first", "second")]
    assert [(each["x"], each["y"]) for each in names] == [(460.0, 44.0), (460.0, 62.0)]
    keys = [each for each in result.line if each["x1"] == 432.0]
    assert [(each["x2"], each["y1"], each["y2"]) for each in keys] == [(454.0, 40.0, 40.0), (454.0, 58.0, 58.0)]
    assert [each["stroke-width"] for each in keys] == [2.2, 1.4]
    ticks = {float(each["said"]): each["y"] - 4 for each in result.text if each.get("text-anchor") == "end"}
    levels = {each["y1"] for each in result.line if each["x2"] == 420.0}
    assert set(ticks.values()) <= levels
    assert is_affine([*ticks], [*ticks.values()]) < 0
    (title,) = [each for each in result.text if each["said"] == "T"]
    assert (title["x"], title["y"]) == (0.0, 14.0)
    (across,) = [each for each in result.text if each["said"] == "width, m"]
    assert across["y"] == 284.0


@pytest.mark.parametrize(("share", "from_zero", "least"), [(True, False, 0.0), (False, True, 0.0), (False, False, 0.4)])
def test_the_vertical_axis_reaches_to_where_it_is_asked_to(share, from_zero, least):
    shown = Lines((Line("a", ((0.0, 0.4), (1.0, 0.6))),), "y", share=share, from_zero=from_zero, dots=True)
    result = read(Chart("", "x", shown, "said"))
    slope, start = np.polyfit([0.4, 0.6], [each["cy"] for each in result.circle], 1)
    bottom = (250.0 - start) / slope
    assert bottom <= least + 1e-9
    assert bottom > least - 0.1
    texts = [each["said"] for each in result.text if each.get("text-anchor") == "end"]
    assert any("%" in text for text in texts) is share


def test_bars_and_whiskers():
    shown = Bars((Bar("one", ((0.0, 2.0, "dark"),), (1.0, 3.0)), Bar("two", ((0.0, -1.0, "light"),), None)))
    result = read(Chart("", "size", shown, "said"))
    first, second = result.rect
    zero = [each for each in result.line if each["x1"] == each["x2"] and each["y1"] == 6.0][-1]["x1"]
    unit = first["width"] / 2.0
    assert first["x"] == pytest.approx(zero, abs=0.02)
    assert second["x"] + second["width"] == pytest.approx(zero, abs=0.02)
    assert second["width"] == pytest.approx(unit, abs=0.02)
    assert [(each["y"], each["height"]) for each in result.rect] == [(9.0, 11.0), (26.0, 11.0)]
    (whisker,) = [each for each in result.line if each["y1"] == each["y2"]]
    assert whisker["y1"] == 14.5
    assert (whisker["x1"], whisker["x2"]) == (
        pytest.approx(zero + unit, abs=0.02),
        pytest.approx(zero + 3 * unit, abs=0.02),
    )
    caps = [each for each in result.line if (each["y1"], each["y2"]) == (11.5, 17.5)]
    assert [each["x1"] for each in caps] == [whisker["x1"], whisker["x2"]]
    names = [(each["x"], each["y"]) for each in result.text if each["said"] in ("one", "two")]
    assert names == [(214.0, 18.0), (214.0, 35.0)]
    assert (result.width, result.height) == (570.0, 74.0)
    ticks = [each["x1"] for each in result.line if each["x1"] == each["x2"] and (each["y1"], each["y2"]) == (6.0, 40.0)]
    steps = [right - left for left, right in pairwise(sorted({*ticks}))]
    assert steps == pytest.approx([steps[0]] * len(steps), abs=0.02)
    assert all(220.0 <= each <= 548.0 for each in ticks)
