"""The report on decisions of a small book, whose best combinations are known by hand."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from live_books import book_with_decisions

from xlmc.analysis.studies.decisions import decide
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.document.parts import Figure, Paragraph, Table
from xlmc.outputs.studies.decide import _losing_text, decide_report


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """`sum` is limit · u + lanes², at most 1.3 limits; `way` is a share of the limit above 55, else u over lanes."""
    model = load(book_with_decisions(tmp_path_factory.mktemp("decide") / "book.xlsx"))
    return decide_report(decide(model, trials=200, seed=5))


def of(report, kind):
    return [each for each in report.blocks if isinstance(each, kind)]


def test_its_title_says_how_many_were_run(report):
    assert report.below == "book.xlsx: 15 combinations of limit, lanes, 200 trials each, seed 5"


def test_the_largest_and_the_smallest_are_named_with_the_next(report):
    texts = [each.text for each in of(report, Paragraph)]
    assert len(texts) == 5
    assert texts[0].startswith("The mean of sum is largest, ")
    assert "with limit = 70, lanes = 4; that is " in texts[0]
    assert " above the next, limit = 70, lanes = 3" in texts[0]
    assert "with limit = 30, lanes = 2; that is " in texts[1]
    assert " below the next, limit = 30, lanes = 3" in texts[1]
    # 70 times the same v for any number of lanes: which trials are accepted decides alone
    assert "limit = 70" in texts[2]
    assert "with limit = 30, lanes = 4; that is " in texts[3]
    assert texts[4].startswith("Each combination is run over the same random numbers")


def test_a_row_for_each_combination_below_the_workbook_as_it_is(report):
    tables = of(report, Table)
    assert [table.title for table in tables] == ["sum", "way"]
    for table in tables:
        assert table.heads[:3] == ("limit", "lanes", "Mean")
        assert table.rows[0][:2] == ("as it is", "")
        wanted = [(str(limit), str(lanes)) for limit in (30, 40, 50, 60, 70) for lanes in (2, 3, 4)]
        assert [row[:2] for row in table.rows[1:]] == wanted


def test_a_line_for_each_value_of_the_second_decision(report):
    figure, _ = of(report, Figure)
    lines = figure.drawing.data.lines
    assert [line.name for line in lines] == ["lanes = 2", "lanes = 3", "lanes = 4"]
    assert [[point[0] for point in line.points] for line in lines] == [[30, 40, 50, 60, 70]] * 3
    assert (figure.drawing.across, figure.caption) == ("limit", "sum for the values of limit and lanes")
    first, last = lines[0].points[0], lines[-1].points[-1]
    assert first[1] < last[1]
    assert first[2] > 0


def test_lines_of_one_decision_are_its_mean_and_range(tmp_path):
    model = load(book_with_decisions(tmp_path / "book.xlsx"))
    report = decide_report(decide(model, ["limit"], trials=200, seed=5))
    figure = of(report, Figure)[0]
    assert [line.name for line in figure.drawing.data.lines] == [
        "Mean", "Central range, low end", "Central range, high end"
    ]  # fmt: skip
    mean, low, high = (line.points for line in figure.drawing.data.lines)
    assert all(a[1] < b[1] < c[1] for a, b, c in zip(low, mean, high, strict=True))


@pytest.mark.parametrize(("count", "more"), [(1, ""), (4, ""), (5, "; and 1 more"), (7, "; and 3 more")])
def test_combinations_that_lose_trials(count, more):
    run = SimpleNamespace(lost_share=lambda forecast: 0.0345)
    losing = [SimpleNamespace(answers=SimpleNamespace(name=f"c{number}", run=run)) for number in range(count)]
    text = _losing_text(losing, "x")
    named = "; ".join(f"c{number} (3.5 %)" for number in range(min(count, 4)))
    assert text.startswith("Left out of the largest and smallest of x, since errors in cells take more than ")
    assert text.endswith(f" of the trials: {named}{more}.")
