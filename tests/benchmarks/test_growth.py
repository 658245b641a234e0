"""The cost over the size of a book: points, slopes, table and picture."""

from __future__ import annotations

import json

import compare
import figures
import growth
import pytest
import tables


@pytest.fixture(scope="module")
def results(tmp_path_factory, at_hand):
    """Two series, of one small book each."""
    folder = tmp_path_factory.mktemp("growth")
    given = ["--quick", "--parts", "growth", "--books", "skid", "--output", str(folder)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(growth, "ENGINES", ("numpy",))
        patch.setattr(growth, "ASSUMPTIONS", 3)
        with patch.context() as apart:
            apart.setattr(compare, "draw", lambda _: None)
            compare.main([*given, "--series", "forecasts", "--most", "1"])
        compare.main([*given, "--series", "trials", "--most", "1000"])
    return folder


def test_a_series_that_is_not_measured_keeps_its_points(results):
    result = json.loads((results / "growth.json").read_text(encoding="utf-8"))["found"]
    assert list(result) == ["trials", "forecasts"]
    assert list(result["forecasts"]) == ["numpy"]
    for points in result["forecasts"].values():
        assert [point["size"] for point in points] == [1]
        assert all(point[column] > 0 for point in points for column in growth.COLUMNS)
    assert list(result["trials"]) == ["numpy"]
    assert [point["size"] for point in result["trials"]["numpy"]] == [1000]
    assert result["trials"]["numpy"][0]["run"] > 0
    assert (results / "growth.png").read_bytes().startswith(b"\x89PNG")


def test_the_slope_is_that_of_the_last_decade():
    assert growth.slope((1, 10, 100), (7.0, 1.0, 100.0)) == pytest.approx(2)
    assert growth.slope((1, 100), (1.0, 2.0)) is None


def test_a_point_without_an_answer_is_named():
    points = [{"size": 1_000, "run": 0.5}, {"size": 2_000, "absent": "no answer within 9 s"}]
    table = tables.TABLES["growth"]({"trials": {"numpy": points}})
    assert "| 1,000 | 0.5 |" in table
    assert "| 2,000 | – |" in table
    assert table.endswith("numpy, 2,000: no answer within 9 s.")


def test_every_series_has_a_panel():
    assert tuple(figures.GROWTH) == growth.SERIES
